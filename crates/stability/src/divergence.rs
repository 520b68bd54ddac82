//! Static divergence of the restrained structure.
//!
//! $$ \bigl[K_{ee} - q_D\,Q_{ee}(0)\bigr]x = 0 $$
//!
//! over the modes that have a stiffness: rigid modes and free analytic ones
//! are left out. Divergence is where a real root passes through zero.

use faer::{Mat, c64};

use crate::eigenpair::inverse_iteration;
use crate::linalg::{Lu, NoConvergence, eigenvalues_real};

/// Imaginary part, relative to the eigenvalue, up to which it counts as real.
const REAL_TOLERANCE: f64 = 1e-9;

/// One divergence pressure and its mode.
#[derive(Clone, Debug)]
pub(crate) struct StaticDivergence {
    /// $q_D$ in Pa.
    pub(crate) pressure: f64,
    /// Shape over all modes.
    pub(crate) shape: Vec<c64>,
}

/// Divergence pressures, ascending.
///
/// `q_zero` is $Q(0)$; `free` are modes to leave out beside those without
/// stiffness.
pub(crate) fn static_divergence(
    stiffness: &Mat<f64>,
    q_zero: &Mat<c64>,
    free: &[usize],
) -> Result<Vec<StaticDivergence>, NoConvergence> {
    let order = stiffness.nrows();
    let block: Vec<usize> = (0..order)
        .filter(|mode| !free.contains(mode) && stiffness[(*mode, *mode)] > 0.0)
        .collect();
    let size = block.len();
    if size == 0 {
        return Ok(Vec::new());
    }
    let part = |i: usize, j: usize| c64::new(stiffness[(block[i], block[j])], 0.0);
    let loads = |i: usize, j: usize| c64::new(q_zero[(block[i], block[j])].re, 0.0);
    let mut flexibility = Mat::from_fn(size, size, loads);
    Lu::new(Mat::from_fn(size, size, part)).solve(flexibility.as_mut());
    let real = Mat::from_fn(size, size, |i, j| flexibility[(i, j)].re);
    let mut found: Vec<StaticDivergence> = eigenvalues_real(real.as_ref())?
        .into_iter()
        .filter(|value| value.re > 0.0 && value.im.abs() <= REAL_TOLERANCE * value.re)
        .map(|value| {
            let pressure = 1.0 / value.re;
            let operator = Mat::from_fn(size, size, |i, j| part(i, j) - loads(i, j) * pressure);
            let pair = inverse_iteration(c64::new(0.0, 0.0), operator);
            let mut shape = vec![c64::new(0.0, 0.0); order];
            for (entry, &mode) in pair.right.iter().zip(&block) {
                shape[mode] = *entry;
            }
            StaticDivergence { pressure, shape }
        })
        .collect();
    found.sort_by(|a, b| a.pressure.total_cmp(&b.pressure));
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A section that may only pitch diverges at $q_D = K/Q$; plunge without
    /// stiffness is left out.
    #[test]
    fn a_pitching_section_diverges_where_stiffness_is_spent() {
        let stiffness = Mat::from_fn(2, 2, |i, j| if i == 1 && j == 1 { 12.0 } else { 0.0 });
        let q = Mat::from_fn(2, 2, |i, j| {
            c64::new(if j == 1 { 2.0 + i as f64 } else { 0.0 }, 0.0)
        });
        let found = static_divergence(&stiffness, &q, &[]).unwrap();
        assert_eq!(found.len(), 1);
        assert!((found[0].pressure - 4.0).abs() < 1e-12);
    }
}
