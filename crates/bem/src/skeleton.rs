//! The few points of a cluster at which a far influence has to be known.
//!
//! Influences of doublets, sources and far wakes are harmonic in the field point. Those
//! whose singularities lie outside the ball of [`REACH`] radii round a cluster of test
//! points form, to a tolerance, a space of small dimension on them: with chosen points
//! P_k of the cluster there is a matrix W, the same for all of them,
//!
//! $$ f(P_i) = \sum_k W_{ik}\, f(P_k) . $$
//!
//! It follows from unit charges spread over the sphere of that radius, which represent any
//! such f inside: their potentials at the points are eliminated one charge after the other,
//! and the point with the largest rest becomes the next P_k, until no charge leaves a rest
//! (interpolative decomposition; Martinsson & Rokhlin, J. Comput. Phys. 205, 2005, use
//! such proxies). A cluster of 768 test points has some 150 to 200 chosen ones.
//!
//! Tested, the far influence is T W f: the influences of a panel are evaluated at the
//! chosen points only, and the matrix T W of the cluster does the rest.

use crate::panel_block::enclosing;
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_unit_lower_triangular_in_place, solve_unit_upper_triangular_in_place,
};
use faer::{Accum, Mat, Par};
use fladder_mesh::Vec3;

/// Distance from which singularities are far, in radii of the cluster. Less makes more of
/// the surface far and needs more points.
pub(crate) const REACH: f64 = 2.5;

/// Charges on the sphere. Harmonics up to degree L take (L + 1)² of them, and what is
/// beyond has decayed by [`REACH`]^−L: 2.5^−25 = 1e-10.
const CHARGES: usize = 640;

/// Rest of a charge's potential that ends the elimination, of the largest potential.
/// Influences of panels are then interpolated to some 1e-8 of their largest value, with
/// signs that do not add up.
pub(crate) const TOLERANCE: f64 = 1e-10;

/// A cluster is worth it when the chosen points are at most this part of all.
const WORTH: f64 = 0.6;

/// Chosen points and the weights of their values.
#[derive(Clone, Debug)]
pub(crate) struct Skeleton {
    /// Ball round all points.
    pub(crate) centre: Vec3,
    pub(crate) radius: f64,
    /// Numbers of the chosen points.
    pub(crate) chosen: Vec<u32>,
    /// W: points × chosen points.
    pub(crate) weights: Mat<f64>,
}

impl Skeleton {
    /// Rests up to `tolerance`; none where the points are too few to gain anything.
    pub(crate) fn new(points: &[Vec3], tolerance: f64) -> Option<Self> {
        let (centre, radius) = enclosing(points);
        let most = (WORTH * points.len() as f64) as usize;
        let (chosen, weights) = interpolation(points, centre, REACH * radius, most, tolerance)?;
        Some(Self {
            centre,
            radius,
            chosen,
            weights,
        })
    }
}

/// Charges eliminated together: those chosen before are taken off by one product.
const BLOCK: usize = 32;

/// Chosen points and W, points × chosen; none if there would be more than `most`.
///
/// Elimination with the largest rest over the points as pivot leaves K = L U with
/// unit columns in L; on the chosen points L is triangular, and W = L L_chosen⁻¹.
fn interpolation(
    points: &[Vec3],
    centre: Vec3,
    radius: f64,
    most: usize,
    tolerance: f64,
) -> Option<(Vec<u32>, Mat<f64>)> {
    let charges: Vec<Vec3> = charges().map(|c| centre + radius * c).collect();
    let mut chosen: Vec<u32> = Vec::new();
    // L, and its rows at the chosen points.
    let mut lower = Mat::<f64>::zeros(points.len(), most);
    let mut pivots = Mat::<f64>::zeros(most, most);
    let mut largest = 0.0_f64;
    for block in charges.chunks(BLOCK) {
        let mut rest = Mat::from_fn(points.len(), block.len(), |i, j| {
            1.0 / (points[i] - block[j]).norm()
        });
        largest = largest.max(rest.norm_max());
        let before = chosen.len();
        let mut upper = Mat::from_fn(before, block.len(), |k, j| rest[(chosen[k] as usize, j)]);
        solve_unit_lower_triangular_in_place(
            pivots.submatrix(0, 0, before, before),
            upper.as_mut(),
            Par::Seq,
        );
        let done = lower.subcols(0, before);
        matmul(&mut rest, Accum::Add, done, &upper, -1.0, Par::Seq);
        for j in 0..block.len() {
            let mut column: Vec<f64> = rest.col(j).iter().copied().collect();
            for k in before..chosen.len() {
                let factor = column[chosen[k] as usize];
                for (x, l) in column.iter_mut().zip(lower.col(k).iter()) {
                    *x -= factor * l;
                }
            }
            for &pivot in &chosen {
                column[pivot as usize] = 0.0;
            }
            let (pivot, size) = column.iter().enumerate().fold((0, 0.0), |best, (i, x)| {
                if x.abs() > best.1 { (i, x.abs()) } else { best }
            });
            if size <= tolerance * largest {
                continue;
            }
            let k = chosen.len();
            if k == most {
                return None;
            }
            let inverse = 1.0 / column[pivot];
            for (l, x) in lower.col_mut(k).iter_mut().zip(&column) {
                *l = x * inverse;
            }
            for (i, &earlier) in chosen.iter().enumerate() {
                pivots[(k, i)] = lower[(pivot, i)];
                debug_assert!(lower[(earlier as usize, k)] == 0.0);
            }
            pivots[(k, k)] = 1.0;
            chosen.push(pivot as u32);
        }
    }
    let count = chosen.len();
    let mut weights = lower.subcols(0, count).to_owned();
    solve_unit_upper_triangular_in_place(
        pivots.submatrix(0, 0, count, count).transpose(),
        weights.transpose_mut(),
        Par::Seq,
    );
    Some((chosen, weights))
}

/// Points spread evenly over the unit sphere along a spiral, taken so that neighbours in
/// the list are far apart.
fn charges() -> impl Iterator<Item = Vec3> {
    // Coprime to the number of charges and near its golden section.
    const STRIDE: usize = 397;
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..CHARGES).map(move |i| {
        let k = (i * STRIDE) % CHARGES;
        let z = 1.0 - (2 * k + 1) as f64 / CHARGES as f64;
        let across = (1.0 - z * z).sqrt();
        let angle = golden * k as f64;
        Vec3::new(across * angle.cos(), across * angle.sin(), z)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two layers of a thin, slightly bent wing; doublets of any direction outside of the
    /// ball, close to it and far.
    #[test]
    fn harmonic_functions_follow_from_the_chosen_points() {
        let points: Vec<Vec3> = (0..768)
            .map(|i| {
                let (u, v) = (f64::from(i % 24) / 24.0, f64::from(i / 24 % 16) / 16.0);
                let side = if i < 384 { 1.0 } else { -1.0 };
                Vec3::new(u, v + 0.2 * u, 0.04 * side * u * (1.0 - u) + 0.1 * v * v)
            })
            .collect();
        let skeleton = Skeleton::new(&points, TOLERANCE).expect("enough points");
        let mut worst = 0.0_f64;
        for i in 0..200 {
            let t = f64::from(i);
            let away = Vec3::new(t.sin(), (1.7 * t).cos(), (0.6 * t).sin()).normalize();
            let moment = Vec3::new((2.1 * t).cos(), (0.3 * t).sin(), 0.4).normalize();
            let distance = REACH * skeleton.radius * (1.001 + 0.05 * t);
            let at = skeleton.centre + distance * away;
            let field = |p: &Vec3| (p - at).dot(&moment) / (p - at).norm().powi(3);
            let exact: Vec<f64> = points.iter().map(field).collect();
            let mut found = vec![0.0; points.len()];
            for (k, &chosen) in skeleton.chosen.iter().enumerate() {
                let value = field(&points[chosen as usize]);
                for (i, sum) in found.iter_mut().enumerate() {
                    *sum += skeleton.weights[(i, k)] * value;
                }
            }
            let size = exact.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
            for (a, b) in found.iter().zip(&exact) {
                worst = worst.max((a - b).abs() / size);
            }
        }
        println!(
            "{} of {} points; doublets off by {worst:.1e} of their largest",
            skeleton.chosen.len(),
            points.len()
        );
        assert!(skeleton.chosen.len() < points.len() / 2 && worst < 1e-8);
    }

    #[test]
    fn few_points_have_no_skeleton() {
        let points: Vec<Vec3> = (0..24)
            .map(|i| Vec3::new(f64::from(i % 6), f64::from(i / 6), 0.0))
            .collect();
        assert!(Skeleton::new(&points, TOLERANCE).is_none());
    }
}
