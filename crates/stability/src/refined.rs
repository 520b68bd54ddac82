//! Refined roots at one speed, counted.
//!
//! Seeds are the candidates of all cells up to half a cell outside; each is
//! refined on the smooth $Q(p)$ and copies are merged; the list is searched
//! further until its count is met.
//!
//! Beside the negative real axis $Q$ has a branch cut, and a rational model
//! poles in its place, around which false roots crowd. There a root of p2 is
//! kept: refined where the refinement stays with it, as it is where not.

use crate::complete::{List, SEED_TOLERANCE, Search};
use crate::eigenpair::Eigenpair;
use crate::linalg::NoConvergence;
use crate::p2::{Candidate, candidates, within_cells};
use crate::polish::{Root, Seed, is_same, polish, sort};
use crate::results::Count;
use crate::track::alikeness;

/// Least likeness of a refined root beside the cut to the one it came from.
const LEAST_LIKENESS: f64 = 0.8;

/// Roots of one speed.
pub(crate) struct RefinedRoots {
    pub(crate) roots: Vec<Eigenpair>,
    pub(crate) zeros: usize,
    pub(crate) is_complete: bool,
    pub(crate) count: Option<Count>,
}

impl Search<'_> {
    /// The list from the candidates of every cell, and the candidates.
    pub(crate) fn search_all_cells(&self) -> Result<(List, Vec<Candidate>), NoConvergence> {
        let (found, zeros) = candidates(self.fit, self.pencil.reduced, SEED_TOLERANCE)?;
        let clear = found
            .iter()
            .map(|candidate| candidate.p)
            .filter(|p| !self.claim.is_beside_cut(*p));
        let mut list = self.list(clear.map(Seed::new).collect(), zeros);
        self.complete(&mut list)?;
        Ok((list, found))
    }

    /// The roots of a list that lie in the region with their vectors, and
    /// those of p2 beside the cut.
    pub(crate) fn finish(&self, list: &List, low: &[Candidate]) -> RefinedRoots {
        let region = self.claim.region;
        let roots = list.roots.iter();
        let inside: Vec<&Root> = roots.filter(|root| region.holds(root.p)).collect();
        let mut roots = self.pencil.pairs(&inside);
        for root in self.beside_the_cut(low) {
            let is_new = roots.iter().all(|other| !is_same(other.p, root.p));
            if is_new && region.holds(root.p) {
                roots.push(root);
            }
        }
        sort(&mut roots);
        RefinedRoots {
            roots,
            zeros: list.zeros,
            is_complete: list.is_complete(),
            count: list.tally.map(Count::from),
        }
    }

    /// The roots of p2 beside the cut, refined where that is possible.
    fn beside_the_cut(&self, found: &[Candidate]) -> Vec<Eigenpair> {
        let (reduced, smooth) = (self.pencil.reduced, self.pencil.aerodynamics);
        within_cells(self.fit, reduced, found)
            .into_iter()
            .filter(|root| self.claim.is_beside_cut(root.p))
            .map(|root| {
                let refined = polish(reduced, smooth, root.p, Some(&root.right));
                let reach = 0.02 + 0.2 * root.p.re.abs();
                refined
                    .filter(|other| {
                        (other.p.im == 0.0) == (root.p.im == 0.0)
                            && (other.p - root.p).norm() < reach
                            && alikeness(&other.right, &root.right, &reduced.mass)
                                > LEAST_LIKENESS
                    })
                    .unwrap_or(root)
            })
            .collect()
    }
}
