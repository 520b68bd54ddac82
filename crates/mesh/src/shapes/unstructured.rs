//! The wing on irregular points, upper and lower side not matched.
//!
//! Each side is developed onto the rectangle of its cell coordinates
//! (u chordwise, v spanwise), where a cell of the structured mesh is a unit
//! square. A staggered lattice is jittered there and triangulated by Delaunay's
//! criterion, so that the triangles inherit the stretch of the structured
//! cells: finer at the leading and trailing edge, longer along the span.

use spade::{DelaunayTriangulation, InsertionError, Point2, Triangulation};

use super::wing::{
    Extent, NacaWing, ShapeError, Side, Tip, add_trailing_edge, cap_strip, with_wing_group,
};
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

/// A vertex of one side in cell coordinates, with its number in the mesh.
type SidePoint = (Point2<f64>, u32);

impl NacaWing {
    /// Unstructured mesh with about as many vertices as the structured one.
    ///
    /// Closed (open at y = 0 for [`Extent::Half`]), outward, not symmetric in
    /// any plane. The seed chooses the points.
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
        let mut jitter = Jitter(seed);
        let mut mesh = TriMesh::default();
        let (leading, trailing) = self.shared_edges(&mut mesh, &mut jitter);
        let upper =
            self.add_side(&mut mesh, &mut jitter, Side::Upper, [&leading, &trailing])?;
        let lower =
            self.add_side(&mut mesh, &mut jitter, Side::Lower, [&leading, &trailing])?;
        mesh.triangles
            .extend(cap_strip(&mesh.vertices, &upper[1], &lower[1]));
        if self.extent == Extent::Full {
            let port = cap_strip(&mesh.vertices, &upper[0], &lower[0]);
            mesh.triangles
                .extend(port.into_iter().map(|[a, b, c]| [a, c, b]));
        }
        for pair in trailing.windows(2) {
            add_trailing_edge(&mut mesh, pair[0].1, pair[1].1);
        }
        Ok(with_wing_group(mesh))
    }

    /// First and last spanwise cell coordinate.
    fn span_range(&self) -> (i64, i64) {
        let tip = self.n_half_span as i64;
        (if self.extent == Extent::Full { -tip } else { 0 }, tip)
    }

    /// Vertices of the leading and of the trailing edge, which both sides share.
    fn shared_edges(
        &self,
        mesh: &mut TriMesh,
        jitter: &mut Jitter,
    ) -> (Vec<SidePoint>, Vec<SidePoint>) {
        let (first, last) = self.span_range();
        let mut edge = |u: f64| {
            (first..=last)
                .map(|j| {
                    let inside = j != first && j != last;
                    let v = j as f64 + if inside { jitter.next() } else { 0.0 };
                    self.add_vertex(mesh, Side::Upper, Point2::new(u, v))
                })
                .collect()
        };
        let leading = edge(0.0);
        (leading, edge(self.n_chord as f64))
    }

    fn add_vertex(&self, mesh: &mut TriMesh, side: Side, at: Point2<f64>) -> SidePoint {
        let xi = if at.x == self.n_chord as f64 {
            1.0
        } else {
            self.chord_fraction(at.x)
        };
        mesh.vertices
            .push(self.point(side, xi, self.span_position(at.y), self.thickness));
        (at, mesh.vertices.len() as u32 - 1)
    }

    /// Adds the points and triangles of one side between the shared edges.
    ///
    /// Returns the vertices of its first and last section, leading edge first.
    fn add_side(
        &self,
        mesh: &mut TriMesh,
        jitter: &mut Jitter,
        side: Side,
        [leading, trailing]: [&[SidePoint]; 2],
    ) -> Result<[Vec<u32>; 2], ShapeError> {
        let (first, last) = self.span_range();
        let mut points: Vec<SidePoint> = leading.to_vec();
        let mut ends = [vec![leading[0].1], vec![leading[leading.len() - 1].1]];
        for i in 1..self.n_chord {
            for (end, v) in ends.iter_mut().zip([first, last]) {
                let at = Point2::new(i as f64 + jitter.next(), v as f64);
                points.push(self.add_vertex(mesh, side, at));
                end.push(points[points.len() - 1].1);
            }
            let (stagger, start) = if i % 2 == 0 {
                (0.0, first + 1)
            } else {
                (0.5, first)
            };
            for j in start..last {
                let (du, dv) = (jitter.next(), jitter.next());
                let at = Point2::new(i as f64 + du, j as f64 + stagger + dv);
                points.push(self.add_vertex(mesh, side, at));
            }
        }
        points.extend(trailing);
        ends[0].push(trailing[0].1);
        ends[1].push(trailing[trailing.len() - 1].1);
        let triangles = delaunay(&points).map_err(|_| ShapeError::Unsupported("this wing"))?;
        mesh.triangles
            .extend(triangles.into_iter().map(|[a, b, c]| match side {
                Side::Upper => [a, b, c],
                Side::Lower => [a, c, b],
            }));
        Ok(ends)
    }
}

/// Counter-clockwise Delaunay triangles of the points, as vertex numbers.
fn delaunay(points: &[SidePoint]) -> Result<Vec<[u32; 3]>, InsertionError> {
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
                    assert!(worst > 0.001, "needle in {wing:?}");
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
