//! Surfaces of NACA section that meet in one line: T-tails, cruciform tails, winglets.

use super::soup::Soup;
use super::wing::{ShapeError, naca_half_thickness};
use crate::{TriMesh, Vec3};

/// Untapered, unswept surfaces that leave the x axis at different angles; their leading
/// edges meet in one vertex, and so do their trailing edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Star {
    /// Angle about x (0 starboard, 90 up, degrees), ascending, and length in m of each.
    pub arms: Vec<(f64, f64)>,
    /// Chord, m.
    pub chord: f64,
    /// Thickness over chord; it falls to zero at the tips like an ellipse.
    pub thickness: f64,
    /// Cells from leading to trailing edge, at equal angles of a half circle.
    pub n_chord: usize,
    /// Cells along each arm.
    pub n_span: usize,
}

impl Star {
    /// Structured mesh, closed, outward.
    ///
    /// # Errors
    /// Fewer than two arms.
    pub fn structured(&self) -> Result<TriMesh, ShapeError> {
        if self.arms.len() < 2 {
            return Err(ShapeError::Unsupported("a star with one arm"));
        }
        let mut soup = Soup::default();
        let fraction = |i: usize| {
            let angle = std::f64::consts::PI * i as f64 / self.n_chord as f64;
            0.5 * (1.0 - angle.cos())
        };
        for i in 0..self.n_chord {
            let [fore, aft] = [fraction(i), fraction(i + 1)];
            for (arm, &(_, reach)) in self.arms.iter().enumerate() {
                for k in 0..self.n_span {
                    for side in [1.0, -1.0] {
                        let point = |xi: f64, k: usize| self.point(arm, reach, xi, k, side);
                        let [a, b] = [point(fore, k), point(aft, k)];
                        let [c, d] = [point(aft, k + 1), point(fore, k + 1)];
                        if side > 0.0 {
                            soup.quadrilateral([a, b, c, d]);
                        } else {
                            soup.quadrilateral([a, d, c, b]);
                        }
                    }
                }
            }
        }
        Ok(soup.closed())
    }

    /// A point of the side that faces the next arm (side 1) or the one before (−1).
    fn point(&self, arm: usize, reach: f64, xi: f64, k: usize, side: f64) -> Vec3 {
        let half = if xi > 1.0 - 1e-12 {
            0.0
        } else {
            self.chord * naca_half_thickness(self.thickness, xi)
        };
        let along = Vec3::x() * (self.chord * xi);
        let (out, up) = self.directions(arm);
        if k == 0 {
            let n = self.arms.len();
            let other = if side > 0.0 {
                (arm + 1) % n
            } else {
                (arm + n - 1) % n
            };
            let (_, other_up) = self.directions(other);
            // p·up = side h and p·other_up = −side h.
            let (s, t) = (side * up, -side * other_up);
            return along + half * (s + t) / (1.0 + s.dot(&t));
        }
        let eta = k as f64 / self.n_span as f64;
        along + out * (reach * eta) + up * (side * half * (1.0 - eta * eta).sqrt())
    }

    /// Unit vectors out along an arm and towards the next.
    fn directions(&self, arm: usize) -> (Vec3, Vec3) {
        let exact = |v: f64| if v.abs() < 1e-15 { 0.0 } else { v };
        let (sin, cos) = self.arms[arm].0.to_radians().sin_cos();
        let out = Vec3::new(0.0, exact(cos), exact(sin));
        (out, Vec3::new(0.0, -out.z, out.y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Topology;
    use crate::judge::{self, judge};
    use crate::trailing_edge::{self, find_by_shape};

    #[test]
    fn stars_are_sound_and_their_trailing_edges_meet() {
        for (arms, edges) in [
            (vec![(0.0, 2.0), (180.0, 2.0)], 1),
            (vec![(0.0, 1.0), (180.0, 1.0), (270.0, 1.5)], 3),
            (vec![(0.0, 1.0), (90.0, 1.0), (180.0, 1.0), (270.0, 0.5)], 4),
        ] {
            let mesh = Star {
                arms,
                chord: 1.0,
                thickness: 0.1,
                n_chord: 10,
                n_span: 6,
            }
            .structured()
            .expect("a star");
            let topology = Topology::new(&mesh);
            assert!((0..topology.edges.len()).all(|e| topology.edge_triangles(e).len() == 2));
            assert!(mesh.volume() > 0.0);
            let verdict = judge(mesh.clone(), judge::Settings::default());
            assert!(!verdict.has_errors(), "{:?}", verdict.faults);
            let found = find_by_shape(&mesh, &topology, trailing_edge::Settings::default());
            assert_eq!(found.len(), edges);
        }
    }
}
