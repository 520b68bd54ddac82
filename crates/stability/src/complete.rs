//! A complete list of roots at one flight condition.
//!
//! Seeds are refined on the smooth $Q(p)$ and counted. Where the count says
//! that one is missing, the part of the region that holds it is found by
//! halving, with a count of each half; the quadratic problems of the cells
//! there are the next seeds, then a rational model's own roots. What then is
//! still missing is reported, never hidden.

use faer::c64;

use crate::count::{Census, Claim, Tally, clearest};
use crate::linalg::NoConvergence;
use crate::p2::{Cell, PiecewiseQuadratic, candidates_of};
use crate::pencil::Pencil;
use crate::polish::{Root, Seed, add_new, newton};
use crate::state_space::all_roots;

/// Candidates this far outside their cell, in parts of its size, are worth a
/// refinement.
pub(crate) const SEED_TOLERANCE: f64 = 0.5;

/// Roots this far outside the region, in parts of its size, are kept: they
/// turn the phase on its border, and at the next speed they may be inside.
const MARGIN: f64 = 0.3;

/// Places where a rectangle is halved, as parts of its longer side; the one
/// farthest from any root is taken.
const CUTS: [f64; 5] = [0.5, 0.46, 0.54, 0.42, 0.58];

/// Halvings before a rectangle is small enough.
const MOST_HALVINGS: usize = 7;

/// Rounds of search before the list is given up.
const ROUNDS: usize = 3;

/// Rounds of search on the real axis: the second finds what lies beside what
/// the first found.
const REAL_ROUNDS: usize = 2;

/// Roots of one flight condition, inside the region and somewhat outside.
#[derive(Clone, Debug, Default)]
pub(crate) struct List {
    pub(crate) roots: Vec<Root>,
    pub(crate) zeros: usize,
    pub(crate) tally: Option<Tally>,
}

impl List {
    /// Whether the count has confirmed the list.
    pub(crate) fn is_complete(&self) -> bool {
        self.tally.is_some_and(|tally| tally.missing() == 0)
    }

    pub(crate) fn values(&self) -> Vec<c64> {
        self.roots.iter().map(|root| root.p).collect()
    }
}

/// Everything a search needs at one flight condition.
pub(crate) struct Search<'a> {
    pub(crate) pencil: &'a Pencil<'a>,
    pub(crate) fit: &'a PiecewiseQuadratic,
    pub(crate) claim: &'a Claim,
}

impl Search<'_> {
    /// Refines seeds into a list and counts it.
    pub(crate) fn list(&self, seeds: Vec<Seed>, zeros: usize) -> List {
        let mut list = List {
            zeros,
            ..List::default()
        };
        self.extend(&mut list, seeds);
        list
    }

    /// Adds what the seeds lead to and the real roots between them, and counts.
    fn extend(&self, list: &mut List, seeds: Vec<Seed>) {
        self.add(list, seeds);
        for _ in 0..REAL_ROUNDS {
            let values = list.values();
            let missing = self.census(&values, list.zeros).missing_on_real_axis();
            if missing.is_empty() {
                break;
            }
            self.add(list, missing.into_iter().map(Seed::new).collect());
        }
        list.tally = self.census(&list.values(), list.zeros).tally();
    }

    fn add(&self, list: &mut List, seeds: Vec<Seed>) {
        for root in newton(self.pencil, seeds).into_iter().flatten() {
            if self.is_kept(root.p) {
                add_new(&mut list.roots, root);
            }
        }
    }

    fn is_kept(&self, p: c64) -> bool {
        let [left, right] = self.claim.region.g;
        let room = MARGIN * (right - left);
        !self.claim.is_beside_cut(p)
            && p.re > left - room
            && p.re < right + room
            && p.im < (1.0 + MARGIN) * self.claim.region.k_max
    }

    fn census<'b>(&'b self, roots: &'b [c64], zeros: usize) -> Census<'b> {
        Census {
            pencil: self.pencil,
            claim: self.claim,
            roots,
            zeros,
        }
    }

    /// Searches until the count is met or nothing is left to try.
    pub(crate) fn complete(&self, list: &mut List) -> Result<(), NoConvergence> {
        for _ in 0..ROUNDS {
            if list.is_complete() {
                return Ok(());
            }
            let before = list.roots.len();
            let seeds = self.seeds_near_the_missing(list)?;
            self.extend(list, seeds);
            if list.roots.len() == before {
                break;
            }
        }
        if list.is_complete() {
            return Ok(());
        }
        if let Some(rational) = self.pencil.aerodynamics.as_rational() {
            let seeds = all_roots(self.pencil.reduced, rational)?;
            let seeds = seeds.into_iter().filter(|p| self.is_kept(*p));
            self.extend(list, seeds.map(Seed::new).collect());
        }
        Ok(())
    }

    fn seeds_near_the_missing(&self, list: &List) -> Result<Vec<Seed>, NoConvergence> {
        let roots = list.values();
        let census = self.census(&roots, list.zeros);
        let region = self.claim.region;
        let mut places = Vec::new();
        let above = list.tally.map_or(1, |tally| tally.above);
        if above != 0 {
            let whole = Rectangle {
                g: region.g,
                k: [census.floor(), region.k_max],
            };
            self.halve(&census, whole, above, MOST_HALVINGS, &mut places);
        }
        if list.tally.is_none_or(|tally| tally.beside_axis != 0) {
            places.push(Rectangle {
                g: region.g,
                k: [0.0, census.floor()],
            });
        }
        let mut seeds: Vec<Seed> = places
            .iter()
            .flat_map(Rectangle::spread)
            .map(Seed::new)
            .collect();
        for cell in self.fit.cells() {
            if places.iter().any(|place| place.meets(cell)) {
                let found = candidates_of(cell, self.pencil.reduced, SEED_TOLERANCE)?;
                seeds.extend(found.into_iter().map(Seed::new));
            }
        }
        Ok(seeds)
    }

    /// Halves a rectangle until its parts are small, following the parts whose
    /// count is not met.
    fn halve(
        &self,
        census: &Census<'_>,
        whole: Rectangle,
        missing: i64,
        halvings: usize,
        out: &mut Vec<Rectangle>,
    ) {
        let touched = self.fit.cells().iter().filter(|cell| whole.meets(cell));
        if halvings == 0 || touched.count() <= 2 {
            out.push(whole);
            return;
        }
        let [first, second] = whole.halves(census.roots);
        let Some(part) = census.rectangle(first.g, first.k) else {
            out.push(whole);
            return;
        };
        for (half, count) in [(first, part), (second, missing - part)] {
            if count != 0 {
                self.halve(census, half, count, halvings - 1, out);
            }
        }
    }
}

/// A part of the region.
#[derive(Clone, Copy, Debug)]
struct Rectangle {
    g: [f64; 2],
    k: [f64; 2],
}

impl Rectangle {
    fn meets(&self, cell: &Cell) -> bool {
        let meet = |a: [f64; 2], b: [f64; 2]| a[0] < b[1] && b[0] < a[1];
        meet(self.g, cell.g) && meet(self.k, cell.k)
    }

    /// Two halves, cut across the longer side clear of the given roots.
    fn halves(&self, roots: &[c64]) -> [Self; 2] {
        let is_tall = self.k[1] - self.k[0] > self.g[1] - self.g[0];
        let [low, high] = if is_tall { self.k } else { self.g };
        let place = |part: f64| low + part * (high - low);
        let part = clearest(&CUTS, |part| {
            let room = |root: &c64| {
                let value = if is_tall { root.im } else { root.re };
                (value - place(part)).abs()
            };
            roots.iter().map(room).fold(f64::INFINITY, f64::min)
        });
        let cut = place(part);
        if is_tall {
            [[low, cut], [cut, high]].map(|k| Self { k, ..*self })
        } else {
            [[low, cut], [cut, high]].map(|g| Self { g, ..*self })
        }
    }

    /// The centre and points around it.
    fn spread(&self) -> Vec<c64> {
        const PARTS: [f64; 3] = [0.2, 0.5, 0.8];
        let at = |[low, high]: [f64; 2], part: f64| low + part * (high - low);
        PARTS
            .iter()
            .flat_map(|x| PARTS.map(|y| c64::new(at(self.g, *x), at(self.k, y))))
            .collect()
    }
}
