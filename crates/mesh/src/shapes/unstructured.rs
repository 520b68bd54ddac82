//! The wing on irregular points, upper and lower side not matched.
//!
//! Each side is developed onto the rectangle of its cell coordinates
//! (u chordwise, v spanwise), where a cell of the structured mesh is a unit
//! square. A staggered lattice is jittered there and triangulated by Delaunay's
//! criterion, so that the triangles inherit the stretch of the structured
//! cells: finer at the leading and trailing edge, longer along the span.

use spade::{DelaunayTriangulation, InsertionError, Point2, Triangulation};

use super::parts::{add_trailing_edge, cap_strip, with_wing_group};
use super::wing::{Extent, NacaWing, ShapeError, Side, Tip};
use crate::TriMesh;

/// Largest displacement of a lattice point, in cells. Above about 0.3 points
/// come so close to each other that needles appear.
const JITTER: f64 = 0.22;

/// Congruential generator with Knuth's MMIX constants: the same points on
/// every machine.
struct Jitter(u64);

impl Jitter {
    /// Uniform in ±[`JITTER`].
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        // The upper bits are the random ones.
        let unit = (self.0 >> 11) as f64 / (1_u64 << 53) as f64;
        JITTER * (2.0 * unit - 1.0)
    }
}

const SIDES: [Side; 2] = [Side::Upper, Side::Lower];

/// A vertex in cell coordinates, with its number in the mesh.
type SheetPoint = (Point2<f64>, u32);

impl NacaWing {
    /// Unstructured mesh with about as many vertices as the structured one.
    ///
    /// Closed (open at y = 0 for [`Extent::Half`]), outward, not symmetric in
    /// any plane. The seed chooses the points. The root section is a line of
    /// edges, because a swept wing has a kink there.
    ///
    /// # Errors
    /// As [`structured`](Self::structured); a sharp tip is refused.
    pub fn unstructured(&self, seed: u64) -> Result<TriMesh, ShapeError> {
        self.check()?;
        if self.tip == Tip::Sharp {
            return Err(ShapeError::Unsupported(
                "an unstructured wing with a sharp tip",
            ));
        }
        let mut sheet = Sheet {
            wing: self,
            mesh: TriMesh::default(),
            jitter: Jitter(seed),
        };
        let tip = self.n_half_span as i64;
        let first = if self.extent == Extent::Full { -tip } else { 0 };
        let leading = sheet.shared_edge(0.0, first, tip);
        let trailing = sheet.shared_edge(self.n_chord as f64, first, tip);
        let ends = |v: i64| [&leading, &trailing].map(|edge| edge[(v - first) as usize]);
        let roots = SIDES.map(|side| sheet.section(side, 0, ends(0)));
        for outer in if first < 0 {
            vec![tip, first]
        } else {
            vec![tip]
        } {
            let range = outer.min(0)..=outer.max(0);
            let on_range = |point: &&SheetPoint| range.contains(&(point.0.y.round() as i64));
            let edges: Vec<SheetPoint> = leading
                .iter()
                .chain(&trailing)
                .filter(on_range)
                .copied()
                .collect();
            sheet.add_half(outer, &edges, &roots, ends(outer))?;
        }
        for pair in trailing.windows(2) {
            add_trailing_edge(&mut sheet.mesh, pair[0].1, pair[1].1);
        }
        Ok(with_wing_group(sheet.mesh))
    }
}

/// The developed wing while it is being filled with points.
struct Sheet<'a> {
    wing: &'a NacaWing,
    mesh: TriMesh,
    jitter: Jitter,
}

impl Sheet<'_> {
    fn add_vertex(&mut self, side: Side, at: Point2<f64>) -> SheetPoint {
        let wing = self.wing;
        let xi = if at.x == wing.n_chord as f64 {
            1.0
        } else {
            wing.chord_fraction(at.x)
        };
        self.mesh
            .vertices
            .push(wing.point(side, xi, wing.span_position(at.y), wing.thickness));
        (at, self.mesh.vertices.len() as u32 - 1)
    }

    /// Vertices of the leading or trailing edge, which both sides share.
    fn shared_edge(&mut self, u: f64, first: i64, last: i64) -> Vec<SheetPoint> {
        (first..=last)
            .map(|j| {
                let is_fixed = j == first || j == last || j == 0;
                let v = j as f64 + if is_fixed { 0.0 } else { self.jitter.next() };
                self.add_vertex(Side::Upper, Point2::new(u, v))
            })
            .collect()
    }

    /// A section at integer `v` between its leading and trailing edge.
    fn section(
        &mut self,
        side: Side,
        v: i64,
        [leading, trailing]: [SheetPoint; 2],
    ) -> Vec<SheetPoint> {
        let mut section = vec![leading];
        for i in 1..self.wing.n_chord {
            let at = Point2::new(i as f64 + self.jitter.next(), v as f64);
            section.push(self.add_vertex(side, at));
        }
        section.push(trailing);
        section
    }

    /// Both sides between the root and the tip at `outer`, and the cap there.
    ///
    /// `edges` are the vertices of the leading and trailing edge in that half.
    fn add_half(
        &mut self,
        outer: i64,
        edges: &[SheetPoint],
        roots: &[Vec<SheetPoint>; 2],
        ends: [SheetPoint; 2],
    ) -> Result<(), ShapeError> {
        let inside = |line: &[SheetPoint]| line[1..line.len() - 1].to_vec();
        let mut tips = Vec::new();
        for (side, root) in SIDES.into_iter().zip(roots) {
            let section = self.section(side, outer, ends);
            let border = [edges.to_vec(), inside(root), inside(&section)].concat();
            self.fill(side, outer, border)?;
            tips.push(section.iter().map(|point| point.1).collect::<Vec<u32>>());
        }
        let cap = cap_strip(&self.mesh.vertices, &tips[0], &tips[1]);
        let outward = |[a, b, c]: [u32; 3]| if outer > 0 { [a, b, c] } else { [a, c, b] };
        self.mesh.triangles.extend(cap.into_iter().map(outward));
        Ok(())
    }

    /// Points and triangles of one side between the root and `outer`.
    fn fill(
        &mut self,
        side: Side,
        outer: i64,
        border: Vec<SheetPoint>,
    ) -> Result<(), ShapeError> {
        let mut points = border;
        let (low, high) = (outer.min(0), outer.max(0));
        for i in 1..self.wing.n_chord {
            let (stagger, start) = if i % 2 == 0 {
                (0.0, low + 1)
            } else {
                (0.5, low)
            };
            for j in start..high {
                let (du, dv) = (self.jitter.next(), self.jitter.next());
                let at = Point2::new(i as f64 + du, j as f64 + stagger + dv);
                points.push(self.add_vertex(side, at));
            }
        }
        let triangles = delaunay(&points).map_err(|_| ShapeError::Unsupported("this wing"))?;
        self.mesh
            .triangles
            .extend(triangles.into_iter().map(|[a, b, c]| match side {
                Side::Upper => [a, b, c],
                Side::Lower => [a, c, b],
            }));
        Ok(())
    }
}

/// Counter-clockwise Delaunay triangles of the points, as vertex numbers.
fn delaunay(points: &[SheetPoint]) -> Result<Vec<[u32; 3]>, InsertionError> {
    let mut triangulation = DelaunayTriangulation::<Point2<f64>>::new();
    // Points are distinct, so that the handles count up with the points.
    for (at, _) in points {
        triangulation.insert(*at)?;
    }
    Ok(triangulation
        .inner_faces()
        .map(|face| face.vertices().map(|v| points[v.fix().index()].1))
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Topology, Vec3};

    /// Smallest angle of a triangle after the stretch is taken out is not
    /// available here; the ratio 2 r_in / r_out of the plane triangle is, and
    /// a 4:1 triangle has 0.22.
    fn radius_ratio([a, b, c]: [Vec3; 3]) -> f64 {
        let (la, lb, lc) = ((b - c).norm(), (c - a).norm(), (a - b).norm());
        let area = 0.5 * (b - a).cross(&(c - a)).norm();
        16.0 * area * area / ((la + lb + lc) * la * lb * lc)
    }

    #[test]
    fn unstructured_wings_are_closed_manifold_and_well_shaped() {
        for thickness in [0.03, 0.12] {
            for (n_chord, n_half_span) in [(7, 8), (12, 16), (20, 36)] {
                for (sweep_deg, seed) in [(0.0, 1), (45.0, 2)] {
                    let wing = NacaWing {
                        thickness,
                        sweep_deg,
                        n_chord,
                        n_half_span,
                        ..NacaWing::default()
                    };
                    let mesh = wing.unstructured(seed).unwrap();
                    let topology = Topology::new(&mesh);
                    assert!(
                        (0..topology.edges.len())
                            .all(|e| topology.edge_triangles(e).len() == 2)
                    );
                    let euler =
                        mesh.vertices.len() + mesh.triangles.len() - topology.edges.len();
                    assert_eq!(euler, 2);
                    let structured = wing.structured().unwrap();
                    assert!((mesh.volume() / structured.volume() - 1.0).abs() < 0.03);
                    let mut ratios: Vec<f64> = (0..mesh.triangles.len())
                        .map(|t| radius_ratio(mesh.corners(t)))
                        .collect();
                    ratios.sort_by(f64::total_cmp);
                    let (worst, median) = (ratios[0], ratios[ratios.len() / 2]);
                    println!(
                        "t {thickness} sweep {sweep_deg}: {} vertices, radius ratio min {worst:.4}, median {median:.3}",
                        mesh.vertices.len()
                    );
                    assert!(worst > 0.005, "needle in {wing:?}");
                }
            }
        }
    }

    #[test]
    fn upper_and_lower_side_are_not_matched() {
        let mesh = NacaWing::default().unstructured(3).unwrap();
        let matched = mesh.vertices.iter().filter(|p| p.z > 0.0).any(|p| {
            mesh.vertices
                .iter()
                .any(|q| q.z < 0.0 && (q.xy() - p.xy()).norm() < 1e-9)
        });
        assert!(!matched);
    }

    #[test]
    fn the_same_seed_gives_the_same_mesh() {
        let wing = NacaWing::default();
        assert_eq!(wing.unstructured(5).unwrap(), wing.unstructured(5).unwrap());
        assert_ne!(wing.unstructured(5).unwrap(), wing.unstructured(6).unwrap());
    }
}
