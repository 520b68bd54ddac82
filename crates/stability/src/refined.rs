//! Refined roots at one speed, counted.
//!
//! Seeds are the candidates of all cells up to half a cell outside; each is
//! refined on the smooth $Q(p)$ and copies are merged. The count tells whether
//! one is missing; where one is and the model is rational, all its roots are
//! the next seeds. What then is still missing is reported, never hidden.

use faer::c64;

use crate::aerodynamics::Aerodynamics;
use crate::count::missing_roots;
use crate::eigenpair::Eigenpair;
use crate::linalg::NoConvergence;
use crate::p2::{PiecewiseQuadratic, candidates};
use crate::polish::polish_all;
use crate::state_space::all_roots;
use crate::structure::Reduced;

/// Candidates this far outside their cell, in parts of its size, are worth a
/// refinement.
const SEED_TOLERANCE: f64 = 0.5;

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
    let (found, zeros) = candidates(fit, reduced, SEED_TOLERANCE)?;
    let mut seeds: Vec<c64> = found.iter().map(|candidate| candidate.p).collect();
    let mut roots = polish_all(reduced, smooth, &seeds);
    let count = |roots: &[Eigenpair]| {
        missing_roots(reduced, smooth, roots, zeros, region).is_some_and(|c| c.missing == 0)
    };
    let mut is_complete = count(&roots);
    if let (false, Some(rational)) = (is_complete, smooth.as_rational()) {
        seeds.splice(0..0, all_roots(reduced, rational)?);
        seeds.retain(|p| {
            p.re > 2.0 * region.g[0] && p.re < 2.0 * region.g[1] && p.im < 1.2 * region.k_max
        });
        roots = polish_all(reduced, smooth, &seeds);
        is_complete = count(&roots);
    }
    roots.retain(|root| region.holds(root.p));
    Ok(RefinedRoots {
        roots,
        zeros,
        is_complete,
    })
}
