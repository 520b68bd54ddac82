//! Wings of symmetric NACA four-digit section with a closed trailing edge.
//!
//! Half thickness over chord at ξ = x/c, for thickness ratio t:
//!
//! $$ y_t = 5t\,(0.2969\sqrt\xi - 0.1260\,\xi - 0.3516\,\xi^2
//!          + 0.2843\,\xi^3 - 0.1036\,\xi^4) $$
//!
//! Abbott & von Doenhoff, *Theory of Wing Sections*, eq. (6.2), with the last
//! coefficient −0.1036 in place of −0.1015, which closes the trailing edge.

use super::parts::{add_trailing_edge, cap_strip, mirrored, with_wing_group};
use crate::{TriMesh, Vec3};

/// Why a shape cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// A dimension out of its range.
    #[error("{name} is {value}, but {rule}")]
    Dimension {
        /// The dimension.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        rule: &'static str,
    },
    /// A combination that is not built.
    #[error("{0} is not built")]
    Unsupported(&'static str),
}

/// How the wing ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tip {
    /// Cut off square and closed by a strip that joins upper and lower side.
    Flat,
    /// Upper and lower side meet in the chord line of the tip section.
    Sharp,
}

/// How much of the wing is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Both halves, exact mirror images of each other when structured.
    Full,
    /// The half on y ≥ 0, open along the plane y = 0.
    Half,
}

/// A straight-tapered wing, leading edge at the origin of the root section.
///
/// The fields say what is built; [`structured`](Self::structured) and
/// [`unstructured`](Self::unstructured) build it. Surface group `wing`,
/// curve group `te`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NacaWing {
    /// Thickness over chord, 0 < t < 0.5.
    pub thickness: f64,
    /// Chord of the root section, m.
    pub chord: f64,
    /// Span of the whole wing, m.
    pub span: f64,
    /// Sweep of the leading edge, degrees, positive aft; every chord line of
    /// an untapered wing has it.
    pub sweep_deg: f64,
    /// Tip chord over root chord.
    pub taper: f64,
    /// Cells from leading to trailing edge, on each side.
    pub n_chord: usize,
    /// Cells from root to tip.
    pub n_half_span: usize,
    /// 0: equal chordwise steps; 1: full cosine spacing.
    pub chord_clustering: f64,
    /// c ≥ 0: ξ of those steps is raised to the power 1 + c, so that the cells at the nose
    /// get shorter and those at the trailing edge longer. Lift by pressure needs a first
    /// cell about as long as the nose's radius, 1.1 t² c.
    pub nose_clustering: f64,
    /// 0: equal spanwise steps; 1: full cosine spacing towards the tip.
    pub span_clustering: f64,
    /// How the wing ends. [`unstructured`](Self::unstructured) makes flat tips only.
    pub tip: Tip,
    /// Whole wing or half.
    pub extent: Extent,
}

impl Default for NacaWing {
    /// NACA 0012, unit chord, aspect ratio 8, unswept, untapered, flat tips.
    fn default() -> Self {
        Self {
            thickness: 0.12,
            chord: 1.0,
            span: 8.0,
            sweep_deg: 0.0,
            taper: 1.0,
            n_chord: 12,
            n_half_span: 12,
            chord_clustering: 0.75,
            nose_clustering: 0.0,
            span_clustering: 0.5,
            tip: Tip::Flat,
            extent: Extent::Full,
        }
    }
}

/// Half thickness over chord of the closed four-digit section at ξ = x/c.
///
/// `thickness` is the full thickness ratio; ξ in [0, 1].
pub fn naca_half_thickness(thickness: f64, xi: f64) -> f64 {
    let polynomial = -0.1260 + xi * (-0.3516 + xi * (0.2843 - 0.1036 * xi));
    5.0 * thickness * (0.2969 * xi.sqrt() + xi * polynomial)
}

/// Side of the wing.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Upper,
    Lower,
}

impl NacaWing {
    /// Structured mesh: closed (open at y = 0 for [`Extent::Half`]), outward.
    ///
    /// Every quadrilateral is cut along the diagonal that is shorter in plan,
    /// alike on the upper and lower side and mirrored to port.
    ///
    /// # Errors
    /// A dimension or count out of the range its field states.
    pub fn structured(&self) -> Result<TriMesh, ShapeError> {
        self.check()?;
        let mut half = self.half_skin();
        if self.tip == Tip::Flat {
            self.add_cap(&mut half);
        }
        let mesh = match self.extent {
            Extent::Half => half,
            Extent::Full => mirrored(half),
        };
        Ok(with_wing_group(mesh))
    }

    pub(super) fn check(&self) -> Result<(), ShapeError> {
        let rules: [(&'static str, f64, bool, &'static str); 9] = [
            (
                "thickness",
                self.thickness,
                self.thickness > 0.0 && self.thickness < 0.5,
                "it must lie between 0 and 0.5",
            ),
            ("chord", self.chord, self.chord > 0.0, "it must be positive"),
            ("span", self.span, self.span > 0.0, "it must be positive"),
            (
                "sweep_deg",
                self.sweep_deg,
                self.sweep_deg.abs() < 80.0,
                "it must lie within 80 degrees",
            ),
            ("taper", self.taper, self.taper > 0.0, "it must be positive"),
            (
                "n_chord",
                self.n_chord as f64,
                self.n_chord >= 3,
                "at least 3 cells are needed",
            ),
            (
                "n_half_span",
                self.n_half_span as f64,
                self.n_half_span >= 1,
                "at least 1 cell is needed",
            ),
            (
                "nose_clustering",
                self.nose_clustering,
                (0.0..=4.0).contains(&self.nose_clustering),
                "it must lie between 0 and 4",
            ),
            (
                "clustering",
                self.chord_clustering.max(self.span_clustering),
                [self.chord_clustering, self.span_clustering]
                    .iter()
                    .all(|c| (0.0..=1.0).contains(c)),
                "it must lie between 0 and 1",
            ),
        ];
        for (name, value, holds, rule) in rules {
            if !(holds && value.is_finite()) {
                return Err(ShapeError::Dimension { name, value, rule });
            }
        }
        Ok(())
    }

    /// ξ = x/c after `u` of `n_chord` cells.
    pub(super) fn chord_fraction(&self, u: f64) -> f64 {
        let t = u / self.n_chord as f64;
        let cosine = 0.5 * (1.0 - (std::f64::consts::PI * t).cos());
        (t + self.chord_clustering * (cosine - t)).powf(1.0 + self.nose_clustering)
    }

    /// y after `v` of `n_half_span` cells; odd in v.
    pub(super) fn span_position(&self, v: f64) -> f64 {
        let t = v.abs() / self.n_half_span as f64;
        let sine = (0.5 * std::f64::consts::PI * t).sin();
        (0.5 * self.span * (t + self.span_clustering * (sine - t))).copysign(v)
    }

    /// Surface point at chord fraction `xi` and spanwise position `y`.
    pub(super) fn point(&self, side: Side, xi: f64, y: f64, thickness: f64) -> Vec3 {
        let eta = y.abs() / (0.5 * self.span);
        let chord = self.chord * (1.0 - (1.0 - self.taper) * eta);
        let leading_edge = y.abs() * self.sweep_deg.to_radians().tan();
        // The four-digit polynomial closes at ξ = 1 only to round-off.
        let z = if xi < 1.0 {
            chord * naca_half_thickness(thickness, xi)
        } else {
            0.0
        };
        let z = if side == Side::Upper { z } else { 0.0 - z };
        Vec3::new(leading_edge + chord * xi, y, z)
    }

    /// Index of the vertex after `i` chordwise and `j` spanwise cells.
    ///
    /// A ring runs trailing edge, lower side forward, leading edge, upper side
    /// aft; the pinched ring of a sharp tip has the upper side's points only.
    fn vertex(&self, side: Side, i: usize, j: usize) -> u32 {
        let n = self.n_chord;
        let base = j * 2 * n;
        let pinched = self.tip == Tip::Sharp && j == self.n_half_span;
        let offset = match side {
            _ if pinched => i,
            _ if i == n => 0,
            Side::Lower => n - i,
            Side::Upper => n + i,
        };
        (base + offset) as u32
    }

    /// Upper and lower skin of the starboard half.
    fn half_skin(&self) -> TriMesh {
        let (n, m) = (self.n_chord, self.n_half_span);
        let mut mesh = TriMesh::default();
        let fractions: Vec<f64> = (0..=n).map(|i| self.chord_fraction(i as f64)).collect();
        for j in 0..=m {
            let y = self.span_position(j as f64);
            if self.tip == Tip::Sharp && j == m {
                mesh.vertices.extend(
                    fractions
                        .iter()
                        .map(|&xi| self.point(Side::Upper, xi, y, 0.0)),
                );
                continue;
            }
            let lower = fractions.iter().rev().map(|&xi| (Side::Lower, xi));
            let upper = fractions[1..n].iter().map(|&xi| (Side::Upper, xi));
            mesh.vertices.extend(
                lower
                    .chain(upper)
                    .map(|(side, xi)| self.point(side, xi, y, self.thickness)),
            );
        }
        for j in 0..m {
            for i in 0..n {
                let falling = self.diagonal_falls(&mesh, i, j);
                for side in [Side::Upper, Side::Lower] {
                    let corner = |di: usize, dj: usize| self.vertex(side, i + di, j + dj);
                    let quad = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                    let [a, b, c, d] = quad;
                    let cut = if falling {
                        [[a, b, d], [b, c, d]]
                    } else {
                        [[a, b, c], [a, c, d]]
                    };
                    let outward = |[p, q, r]: [u32; 3]| {
                        if side == Side::Upper {
                            [p, q, r]
                        } else {
                            [p, r, q]
                        }
                    };
                    mesh.triangles.extend(cut.map(outward));
                }
            }
            let (inner, outer) = (
                self.vertex(Side::Upper, n, j),
                self.vertex(Side::Upper, n, j + 1),
            );
            add_trailing_edge(&mut mesh, inner, outer);
        }
        mesh
    }

    /// Whether cell (i, j) is cut from (i + 1, j) to (i, j + 1).
    fn diagonal_falls(&self, mesh: &TriMesh, i: usize, j: usize) -> bool {
        if self.tip == Tip::Sharp && j + 1 == self.n_half_span {
            // The other diagonal would leave a triangle without thickness
            // between the tip chord and the leading or trailing edge.
            if i == 0 {
                return true;
            }
            if i + 1 == self.n_chord {
                return false;
            }
        }
        let plan = |i, j| mesh.vertices[self.vertex(Side::Upper, i, j) as usize].xy();
        let falling = (plan(i + 1, j) - plan(i, j + 1)).norm();
        let rising = (plan(i, j) - plan(i + 1, j + 1)).norm();
        // Round-off must not choose between equal diagonals.
        falling < rising * (1.0 - 1e-9)
    }

    /// Closes the flat tip at +y by triangles between upper and lower side.
    fn add_cap(&self, mesh: &mut TriMesh) {
        let m = self.n_half_span;
        let chain = |side| {
            (0..=self.n_chord)
                .map(|i| self.vertex(side, i, m))
                .collect::<Vec<u32>>()
        };
        mesh.triangles.extend(cap_strip(
            &mesh.vertices,
            &chain(Side::Upper),
            &chain(Side::Lower),
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Topology;

    fn wings() -> Vec<NacaWing> {
        let mut wings = Vec::new();
        for tip in [Tip::Flat, Tip::Sharp] {
            for (sweep_deg, taper) in [(0.0, 1.0), (45.0, 1.0), (20.0, 0.5)] {
                for thickness in [0.02, 0.12] {
                    wings.push(NacaWing {
                        thickness,
                        sweep_deg,
                        taper,
                        tip,
                        ..NacaWing::default()
                    });
                }
            }
        }
        wings
    }

    #[test]
    fn a_wing_is_closed_and_faces_outward() {
        for wing in wings() {
            let mesh = wing.structured().unwrap();
            let topology = Topology::new(&mesh);
            for edge in 0..topology.edges.len() {
                assert_eq!(topology.edge_triangles(edge).len(), 2, "{wing:?}");
            }
            let euler = mesh.vertices.len() + mesh.triangles.len() - topology.edges.len();
            assert_eq!(euler, 2);
            assert!(mesh.volume() > 0.0);
            let closure: Vec3 = (0..mesh.triangles.len()).map(|t| mesh.area_vector(t)).sum();
            assert!(closure.norm() < 1e-14 * mesh.area());
            assert_eq!(mesh.curves[0].edges.len(), 2 * wing.n_half_span);
        }
    }

    /// Every vertex and triangle has its image at −y, bit for bit.
    #[test]
    fn a_structured_wing_is_its_own_mirror_image() {
        for wing in wings() {
            let mesh = wing.structured().unwrap();
            let bits = |p: Vec3| [p.x.to_bits(), (p.y + 0.0).to_bits(), (p.z + 0.0).to_bits()];
            let corners = |t: &[u32; 3], sign: f64| {
                let mut corners = t.map(|v| {
                    let p = mesh.vertices[v as usize];
                    bits(Vec3::new(p.x, sign * p.y, p.z))
                });
                corners.sort_unstable();
                corners
            };
            let mut own: Vec<_> = mesh.triangles.iter().map(|t| corners(t, 1.0)).collect();
            let mut image: Vec<_> = mesh.triangles.iter().map(|t| corners(t, -1.0)).collect();
            own.sort_unstable();
            image.sort_unstable();
            assert!(own == image, "{wing:?}");
        }
    }

    /// Section area of the closed four-digit section, integrated in closed
    /// form from the thickness polynomial, times span.
    #[test]
    fn the_volume_is_section_area_times_span() {
        let integral =
            0.2969 * 2.0 / 3.0 - 0.1260 / 2.0 - 0.3516 / 3.0 + 0.2843 / 4.0 - 0.1036 / 5.0;
        let wing = NacaWing {
            n_chord: 80,
            ..NacaWing::default()
        };
        let exact = 10.0 * wing.thickness * integral * wing.span;
        let volume = wing.structured().unwrap().volume();
        assert!(
            (volume / exact - 1.0).abs() < 1e-3,
            "{volume} against {exact}"
        );
    }

    #[test]
    fn a_half_wing_is_open_along_the_root_section_only() {
        let wing = NacaWing {
            extent: Extent::Half,
            ..NacaWing::default()
        };
        let mesh = wing.structured().unwrap();
        let topology = Topology::new(&mesh);
        let open: Vec<usize> = (0..topology.edges.len())
            .filter(|&e| topology.edge_triangles(e).len() == 1)
            .collect();
        assert_eq!(open.len(), 2 * wing.n_chord);
        for edge in open {
            assert!(
                topology.edges[edge]
                    .iter()
                    .all(|&v| mesh.vertices[v as usize].y == 0.0)
            );
        }
    }

    #[test]
    fn a_negative_chord_is_refused_by_name() {
        let error = NacaWing {
            chord: -1.0,
            ..NacaWing::default()
        }
        .structured()
        .unwrap_err();
        assert_eq!(error.to_string(), "chord is -1, but it must be positive");
    }
}
