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

use crate::panels::{CornerValues, PanelScratch, PanelSet, sphere};
use fladder_mesh::Vec3;

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
const NEAR: f64 = 2.0;

/// Times a near triangle is quartered. Another level changes the lift of a coarse 3 %
/// wing by 0.3 % and costs four times as much.
const LEVEL: u32 = 1;

/// Points and barycentric coordinates of a divided test triangle.
#[derive(Clone, Debug)]
struct Division {
    points: Vec<Vec3>,
    coordinates: Vec<[f64; 3]>,
}

/// One test triangle.
#[derive(Clone, Debug)]
pub(crate) struct TestTriangle {
    pub(crate) points: [Vec3; 3],
    centre: Vec3,
    radius: f64,
    division: Division,
}

/// Where the panels of a set are.
#[derive(Clone, Debug)]
pub(crate) struct Spheres {
    centres: Vec<Vec3>,
    radii: Vec<f64>,
}

impl Spheres {
    pub(crate) fn new(panels: &PanelSet) -> Self {
        let (centres, radii) = (0..panels.len()).map(|t| panels.sphere(t)).unzip();
        Self { centres, radii }
    }

    /// Triangles near the test triangle.
    fn near<'a>(&'a self, test: &'a TestTriangle) -> impl Iterator<Item = usize> + 'a {
        self.centres
            .iter()
            .zip(&self.radii)
            .enumerate()
            .filter_map(|(t, (centre, radius))| {
                let reach = NEAR * (radius + test.radius);
                ((centre - test.centre).norm_squared() < reach * reach).then_some(t)
            })
    }
}

impl TestTriangle {
    pub(crate) fn new(corners: &[Vec3; 3]) -> Self {
        let at = |b: &[f64; 3]| b[0] * corners[0] + b[1] * corners[1] + b[2] * corners[2];
        let coordinates = divided(LEVEL);
        let division = Division {
            points: coordinates.iter().map(at).collect(),
            coordinates,
        };
        let (centre, radius) = sphere(corners);
        Self {
            points: POINTS.map(|b| at(&b)),
            centre,
            radius,
            division,
        }
    }

    /// D at the three points, or values with the same moments where a panel is near.
    pub(crate) fn doublets(
        &self,
        panels: &PanelSet,
        spheres: &Spheres,
        scratch: &mut PanelScratch,
        out: &mut [Vec<CornerValues>; 3],
    ) {
        for (point, values) in self.points.iter().zip(out.iter_mut()) {
            panels.doublets(*point, scratch, values);
        }
        for t in spheres.near(self) {
            let (d, _) = self.moments(panels, t);
            for q in 0..3 {
                out[q][t] = d[q];
            }
        }
    }

    /// As [`Self::doublets`], with S into rows of `sources`.
    pub(crate) fn doublets_and_sources(
        &self,
        panels: &PanelSet,
        spheres: &Spheres,
        scratch: &mut PanelScratch,
        out: &mut [Vec<CornerValues>; 3],
        sources: &mut [&mut [CornerValues]; 3],
    ) {
        for ((point, d), s) in self
            .points
            .iter()
            .zip(out.iter_mut())
            .zip(sources.iter_mut())
        {
            panels.doublets_and_sources(*point, scratch, d, s);
        }
        for t in spheres.near(self) {
            let (d, s) = self.moments(panels, t);
            for q in 0..3 {
                out[q][t] = d[q];
                sources[q][t] = s[q];
            }
        }
    }

    /// Values at the three points with the moments of the divided triangle.
    fn moments(&self, panels: &PanelSet, t: usize) -> ([CornerValues; 3], [CornerValues; 3]) {
        let weight = 1.0 / self.division.points.len() as f64;
        let mut d = [[0.0; 3]; 3];
        let mut s = [[0.0; 3]; 3];
        for (point, shape) in self.division.points.iter().zip(&self.division.coordinates) {
            let (doublet, source) = panels.one(t, *point);
            for i in 0..3 {
                for c in 0..3 {
                    d[i][c] += weight * shape[i] * doublet[c];
                    s[i][c] += weight * shape[i] * source[c];
                }
            }
        }
        (from_moments(&d), from_moments(&s))
    }
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
