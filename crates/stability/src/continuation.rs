//! Refined roots over a sweep by continuation, each speed certified.
//!
//! A few speeds are solved from every cell. From each the roots are followed
//! to both sides: the parabola through the last three speeds is the seed,
//! Newton's iteration gives the root, and the count tells whether the list is still
//! complete. Where it is not (a root came in over the border, a pair turned
//! into two real roots) the search of [`complete`](crate::complete) finds what
//! is missing; where that fails too, the speed is solved from every cell.
//!
//! The chains depend on the number of speeds alone, so that the outcome has
//! the same bits at any number of threads.

use faer::c64;
use rayon::prelude::*;

use crate::aerodynamics::Aerodynamics;
use crate::complete::{List, SEED_TOLERANCE, Search};
use crate::count::Claim;
use crate::linalg::NoConvergence;
use crate::p2::{PiecewiseQuadratic, free_modes, low_candidates};
use crate::pencil::Pencil;
use crate::polish::Seed;
use crate::refined::RefinedRoots;
use crate::structure::Reduced;

/// Speeds of one chain; each chain costs one solution from every cell.
const CHAIN: usize = 100;

/// Roots at every speed, or the number of the speed that failed.
pub(crate) struct Continuation<'a> {
    pub(crate) fit: &'a PiecewiseQuadratic,
    pub(crate) smooth: &'a dyn Aerodynamics,
    pub(crate) reduced: &'a [Reduced],
}

/// A speed that could not be solved, by its number.
pub(crate) type Fault = (usize, NoConvergence);

/// Roots of the last speeds of a chain, in units of 1/s.
#[derive(Default)]
struct Trail {
    last: Vec<Past>,
}

/// One root at the last speeds, the latest first.
struct Past {
    rates: Vec<c64>,
    vector: Vec<c64>,
}

/// Speeds through which the next root is foretold.
const MEMORY: usize = 3;

impl Past {
    fn last(&self) -> c64 {
        self.rates[0]
    }

    /// Polynomial through the last speeds, one step on.
    fn ahead(&self) -> c64 {
        match self.rates.as_slice() {
            [last, before, first, ..] => (last - before) * 3.0 + first,
            [last, before] => last * 2.0 - before,
            _ => self.last(),
        }
    }
}

impl Continuation<'_> {
    /// Solves all speeds; `tick` is called at each and says whether to go on.
    pub(crate) fn run(
        &self,
        tick: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<Vec<RefinedRoots>>, Fault> {
        let claim = Claim::new(self.smooth, self.fit.region());
        let count = self.reduced.len();
        let chains = count.div_ceil(CHAIN).max(1);
        let chunks: Vec<(usize, usize)> = (0..chains)
            .map(|chain| (chain * count / chains, (chain + 1) * count / chains))
            .collect();
        let seeded: Vec<(RefinedRoots, List)> = chunks
            .par_iter()
            .map(|&(first, end)| self.search_all_cells(first.midpoint(end), &claim))
            .collect::<Result<_, _>>()?;
        let arms: Vec<(usize, Vec<usize>)> = chunks
            .iter()
            .enumerate()
            .flat_map(|(chain, &(first, end))| {
                let middle = first.midpoint(end);
                [
                    (chain, (first..middle).rev().collect()),
                    (chain, (middle + 1..end).collect()),
                ]
            })
            .collect();
        let followed: Vec<Option<Vec<RefinedRoots>>> = arms
            .par_iter()
            .map(|(chain, speeds)| {
                let middle = chunks[*chain].0.midpoint(chunks[*chain].1);
                self.follow(&seeded[*chain].1, middle, speeds, &claim, tick)
            })
            .collect::<Result<_, _>>()?;
        let mut places: Vec<Option<RefinedRoots>> = (0..count).map(|_| None).collect();
        for (&(first, end), (roots, _)) in chunks.iter().zip(seeded) {
            places[first.midpoint(end)] = Some(roots);
            if !tick() {
                return Ok(None);
            }
        }
        for ((_, speeds), solved) in arms.iter().zip(followed) {
            let Some(solved) = solved else {
                return Ok(None);
            };
            for (speed, roots) in speeds.iter().zip(solved) {
                places[*speed] = Some(roots);
            }
        }
        Ok(places.into_iter().collect())
    }

    fn search_all_cells(
        &self,
        speed: usize,
        claim: &Claim,
    ) -> Result<(RefinedRoots, List), Fault> {
        let pencil = Pencil::new(&self.reduced[speed], self.smooth);
        let search = self.search(&pencil, claim);
        let (list, found) = search.search_all_cells().map_err(|error| (speed, error))?;
        Ok((search.finish(&list, &found), list))
    }

    fn search<'b>(&'b self, pencil: &'b Pencil<'b>, claim: &'b Claim) -> Search<'b> {
        Search {
            pencil,
            fit: self.fit,
            claim,
        }
    }

    /// Solves speeds one after the other, from a list at another.
    fn follow(
        &self,
        start: &List,
        from: usize,
        speeds: &[usize],
        claim: &Claim,
        tick: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<Vec<RefinedRoots>>, Fault> {
        let mut trail = Trail::default();
        trail.advance(start, &self.reduced[from]);
        let mut solved = Vec::with_capacity(speeds.len());
        for &speed in speeds {
            if !tick() {
                return Ok(None);
            }
            let fault = |error| (speed, error);
            let reduced = &self.reduced[speed];
            let pencil = Pencil::new(reduced, self.smooth);
            let search = self.search(&pencil, claim);
            let (low, zeros) = if claim.has_cut() {
                low_candidates(self.fit, reduced, SEED_TOLERANCE).map_err(fault)?
            } else {
                (Vec::new(), free_modes(self.fit, reduced))
            };
            let mut list = search.list(trail.seeds(reduced), zeros);
            if !list.is_complete() {
                search.complete(&mut list).map_err(fault)?;
            }
            if list.is_complete() {
                solved.push(search.finish(&list, &low));
            } else {
                let (all, found) = search.search_all_cells().map_err(fault)?;
                solved.push(search.finish(&all, &found));
                list = all;
            }
            trail.advance(&list, reduced);
        }
        Ok(Some(solved))
    }
}

impl Trail {
    /// Where the roots are expected.
    fn seeds(&self, reduced: &Reduced) -> Vec<Seed> {
        let seed = |(number, past): (usize, &Past)| {
            let mut p = past.ahead() / reduced.rate;
            let last = past.last();
            if last.im == 0.0 || p.im <= 0.0 {
                p.im = last.im / reduced.rate;
            }
            Seed {
                p,
                vector: Some(past.vector.clone()),
                parent: Some(number),
            }
        };
        self.last.iter().enumerate().map(seed).collect()
    }

    /// Takes the roots of the next speed; one of another kind, real or complex,
    /// than its parent begins anew.
    fn advance(&mut self, list: &List, reduced: &Reduced) {
        let next = list
            .roots
            .iter()
            .map(|root| {
                let rate = root.p * reduced.rate;
                let parent = root.parent.and_then(|number| self.last.get(number));
                let before = parent
                    .filter(|past| (past.last().im == 0.0) == (rate.im == 0.0))
                    .map_or(&[][..], |past| &past.rates);
                let mut rates = vec![rate];
                rates.extend(before.iter().take(MEMORY - 1));
                Past {
                    rates,
                    vector: root.vector.clone(),
                }
            })
            .collect();
        self.last = next;
    }
}
