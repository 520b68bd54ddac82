//! Test triangles: three points, and more where a panel is near.
//!
//! The Galerkin integrals ∫ Nᵢ D[Nⱼ] over a test triangle are taken with three points
//! where the panel is far. Close by, above all on the other side of a thin section, D[Nⱼ]
//! has kinks at the panel's edges inside the test triangle; three points then leave 1 to
//! 1.5 % of the lift of a 3 % wing. There the triangle is divided into parts of three
//! points each, and the moments
//!
//! $$ m_i = \sum_f w_f N_i(f) D(f) $$
//!
//! are turned back into values at the three points that have the same moments: with
//! Nᵢ(q) = ½ δ_iq + 1/6 and weights 1/3, D_q = 3 Σᵢ (2 δ_qi − 1/3) mᵢ. Everything after
//! goes on as if there were three points.

use crate::panel_block::{NEAR_POINTS, NearValues};
use crate::panels::{CornerValues, sphere};
use fladder_mesh::Vec3;
use std::sync::LazyLock;

/// Barycentric coordinates of the three test points.
pub(crate) const POINTS: [[f64; 3]; 3] = [
    [2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0],
    [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0],
    [1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0],
];

/// A panel is near when the centres are closer than this many sums of radii.
///
/// All near panels must be integrated at the same points: the errors of single panels
/// are large and cancel between neighbours. So there is one kind of division only, and
/// the border lies where panels look smooth: the lift of a 3 % wing is then within 5e-4
/// of that with all panels divided (1: 1e-3; 3: 2e-4).
pub(crate) const NEAR: f64 = 2.0;

/// Points of a near triangle: three in each of its quarters. Another level of quarters
/// changes the lift of a coarse 3 % wing by 0.3 % and costs four times as much.
const DIVIDED: usize = 12;
const _: () = assert!(DIVIDED + 3 <= NEAR_POINTS);

/// Their barycentric coordinates.
static DIVISION: LazyLock<Vec<[f64; 3]>> = LazyLock::new(|| divided(1));

/// One test triangle.
#[derive(Clone, Debug)]
pub(crate) struct TestTriangle {
    pub(crate) points: [Vec3; 3],
    centre: Vec3,
    pub(crate) radius: f64,
    /// Points of the divided triangle, then the three test points, by coordinate.
    pub(crate) near_points: [[f64; NEAR_POINTS]; 3],
}

/// What the divided triangle changes at the three points.
pub(crate) struct Change {
    pub(crate) doublets: [CornerValues; 3],
    pub(crate) sources: [CornerValues; 3],
}

impl TestTriangle {
    pub(crate) fn new(corners: &[Vec3; 3]) -> Self {
        let at = |b: &[f64; 3]| b[0] * corners[0] + b[1] * corners[1] + b[2] * corners[2];
        let points = POINTS.map(|b| at(&b));
        let mut near_points = [[0.0; NEAR_POINTS]; 3];
        for i in 0..NEAR_POINTS {
            let point = match i.checked_sub(DIVIDED) {
                None => at(&DIVISION[i]),
                Some(q) => points[q.min(2)],
            };
            for (axis, values) in near_points.iter_mut().enumerate() {
                values[i] = point[axis];
            }
        }
        let (centre, radius) = sphere(corners);
        Self {
            points,
            centre,
            radius,
            near_points,
        }
    }

    /// Numbers of the spheres near the test triangle.
    pub(crate) fn near<'a>(
        &'a self,
        spheres: &'a [(Vec3, f64)],
    ) -> impl Iterator<Item = usize> + 'a {
        spheres
            .iter()
            .enumerate()
            .filter_map(|(t, (centre, radius))| {
                let reach = NEAR * (radius + self.radius);
                ((centre - self.centre).norm_squared() < reach * reach).then_some(t)
            })
    }

    /// Values with the moments of the divided triangle less those at the points.
    #[expect(
        clippy::unused_self,
        reason = "the values belong to this triangle's points"
    )]
    pub(crate) fn change(&self, values: &NearValues) -> Change {
        Change {
            doublets: change(&values.doublets),
            sources: change(&values.sources),
        }
    }
}

fn change(corners: &[[f64; NEAR_POINTS]; 3]) -> [CornerValues; 3] {
    let mut moments = [[0.0; 3]; 3];
    for (f, shape) in DIVISION.iter().enumerate() {
        for i in 0..3 {
            for c in 0..3 {
                moments[i][c] += shape[i] * corners[c][f] / DIVIDED as f64;
            }
        }
    }
    let mut values = from_moments(&moments);
    for (q, value) in values.iter_mut().enumerate() {
        for (v, corner) in value.iter_mut().zip(corners) {
            *v -= corner[DIVIDED + q];
        }
    }
    values
}

/// Values at the three points with the moments that a function on the triangle has at the
/// points of the divided one.
pub(crate) fn point_values(function: impl Fn(&[f64; 3]) -> f64) -> [f64; 3] {
    let mut moments = [[0.0; 3]; 3];
    for shape in DIVISION.iter() {
        let value = function(shape) / DIVIDED as f64;
        for (moment, weight) in moments.iter_mut().zip(shape) {
            moment[0] += weight * value;
        }
    }
    from_moments(&moments).map(|values| values[0])
}

/// D_q = 3 Σᵢ (2 δ_qi − 1/3) mᵢ.
fn from_moments(moments: &[CornerValues; 3]) -> [CornerValues; 3] {
    std::array::from_fn(|q| {
        std::array::from_fn(|c| {
            let sum = moments[0][c] + moments[1][c] + moments[2][c];
            6.0 * moments[q][c] - sum
        })
    })
}

/// Three points in each of 4^level similar parts.
fn divided(level: u32) -> Vec<[f64; 3]> {
    let corners = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut parts = vec![corners];
    for _ in 0..level {
        parts = parts.iter().flat_map(quarters).collect();
    }
    let point = |part: &[[f64; 3]; 3], b: &[f64; 3]| {
        std::array::from_fn(|c| (0..3).map(|i| b[i] * part[i][c]).sum())
    };
    parts
        .iter()
        .flat_map(|part| POINTS.iter().map(move |b| point(part, b)))
        .collect()
}

fn quarters(part: &[[f64; 3]; 3]) -> [[[f64; 3]; 3]; 4] {
    let middle = |a: usize, b: usize| std::array::from_fn(|c| 0.5 * (part[a][c] + part[b][c]));
    let (ab, bc, ca) = (middle(0, 1), middle(1, 2), middle(2, 0));
    [
        [part[0], ab, ca],
        [ab, part[1], bc],
        [ca, bc, part[2]],
        [ab, bc, ca],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values made from the moments of a linear function are the function's own.
    #[test]
    fn a_linear_function_keeps_its_values() {
        let f = |b: &[f64; 3]| 0.3 * b[0] - 1.2 * b[1] + 2.5 * b[2];
        for level in [1, 2] {
            let points = divided(level);
            let mut moments = [[0.0; 3]; 3];
            for b in &points {
                for (i, moment) in moments.iter_mut().enumerate() {
                    moment[0] += b[i] * f(b) / points.len() as f64;
                }
            }
            let values = from_moments(&moments);
            for (q, b) in POINTS.iter().enumerate() {
                assert!((values[q][0] - f(b)).abs() < 1e-14);
            }
        }
    }
}
