//! Refined roots at one speed, counted.
//!
//! Seeds are the candidates of all cells up to half a cell outside; each is
//! refined on the smooth $Q(p)$ and copies are merged. The count tells whether
//! one is missing; where one is and the model is rational, its own roots are
//! the next seeds. What then is still missing is reported, never hidden.
//!
//! Beside the negative real axis $Q$ has a branch cut, and a rational model
//! poles in its place, around which false roots crowd. There a root of p2 is
//! kept: refined where the refinement stays with it, as it is where not.

use faer::c64;

use crate::aerodynamics::Aerodynamics;
use crate::count::{Claim, missing_roots};
use crate::eigenpair::Eigenpair;
use crate::linalg::NoConvergence;
use crate::p2::{Candidate, PiecewiseQuadratic, candidates, within_cells};
use crate::polish::{add_new, polish, polish_all, sort};
use crate::state_space::all_roots;
use crate::structure::Reduced;
use crate::track::alikeness;

/// Candidates this far outside their cell, in parts of its size, are worth a
/// refinement.
const SEED_TOLERANCE: f64 = 0.5;

/// Least likeness of a refined root beside the cut to the one it came from.
const LEAST_LIKENESS: f64 = 0.8;

/// Roots of one speed.
pub(crate) struct RefinedRoots {
    pub(crate) roots: Vec<Eigenpair>,
    pub(crate) zeros: usize,
    pub(crate) is_complete: bool,
}

/// Finds, refines and counts.
pub(crate) fn refined_roots(
    reduced: &Reduced,
    fit: &PiecewiseQuadratic,
    smooth: &dyn Aerodynamics,
) -> Result<RefinedRoots, NoConvergence> {
    let region = fit.region();
    let claim = Claim::new(smooth, region);
    let (found, zeros) = candidates(fit, reduced, SEED_TOLERANCE)?;
    let clear: Vec<c64> = found
        .iter()
        .map(|candidate| candidate.p)
        .filter(|p| !claim.is_beside_cut(*p))
        .collect();
    let refine = |seeds: &[c64]| {
        let mut roots = polish_all(reduced, smooth, seeds);
        roots.retain(|root| !claim.is_beside_cut(root.p));
        roots
    };
    let mut roots = refine(&clear);
    let count =
        |roots: &[Eigenpair]| missing_roots(reduced, smooth, roots, zeros, &claim) == Some(0);
    let mut is_complete = count(&roots);
    if let (false, Some(rational)) = (is_complete, smooth.as_rational()) {
        let mut seeds = all_roots(reduced, rational)?;
        seeds.retain(|p| {
            !claim.is_beside_cut(*p)
                && p.re > 2.0 * region.g[0]
                && p.re < 2.0 * region.g[1]
                && p.im < 1.2 * region.k_max
        });
        seeds.extend(clear);
        roots = refine(&seeds);
        is_complete = count(&roots);
    }
    for root in beside_the_cut(reduced, fit, smooth, &claim, &found) {
        add_new(&mut roots, root);
    }
    roots.retain(|root| region.holds(root.p));
    sort(&mut roots);
    Ok(RefinedRoots {
        roots,
        zeros,
        is_complete,
    })
}

/// The roots of p2 beside the cut, refined where that is possible.
fn beside_the_cut(
    reduced: &Reduced,
    fit: &PiecewiseQuadratic,
    smooth: &dyn Aerodynamics,
    claim: &Claim,
    found: &[Candidate],
) -> Vec<Eigenpair> {
    within_cells(fit, reduced, found)
        .into_iter()
        .filter(|root| claim.is_beside_cut(root.p))
        .map(|root| {
            let refined = polish(reduced, smooth, root.p, Some(&root.right));
            let reach = 0.02 + 0.2 * root.p.re.abs();
            refined
                .filter(|other| {
                    (other.p.im == 0.0) == (root.p.im == 0.0)
                        && (other.p - root.p).norm() < reach
                        && alikeness(&other.right, &root.right, &reduced.mass) > LEAST_LIKENESS
                })
                .unwrap_or(root)
        })
        .collect()
}
