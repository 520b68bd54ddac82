//! Whether the wake's near sheet strikes a body.
//!
//! A sheet that enters a body carries its jump into the inside, and the potential beside the
//! cut is one no surface flow has: such a wake is refused. A sheet that passes a body closer
//! than the body's triangles there resolve is reported.
//!
//! A sheet is attached to its own trailing edge and to the lines along which its ends are
//! carried down a body. There it touches the surface or, where mesh lines and streamlines
//! differ, cuts it by less than a cell: what lies within [`ATTACHED`] longest edges of the
//! body's triangle from an attachment is passed over. Behind the last body point, where the
//! far part starts, nothing is left to strike.

use crate::adjacency::Adjacency;
use crate::body_path::BodyPaths;
use crate::body_trace::mean_edge;
use crate::error::BemError;
use crate::sheet_lines::Layer;
use fladder_mesh::{TrailingEdge, TriMesh, Vec3};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQueryWithLocation;
use parry3d_f64::shape::TriMesh as SearchMesh;

/// Distance from an attachment, in longest edges of the body's triangle, within which a cut
/// counts as touching: lines of mesh edges lie up to a cell beside the streamline.
const ATTACHED: f64 = 1.0;

/// As [`ATTACHED`] for what passes close by: a sheet leaves its edge at a small angle.
const LEAVING: f64 = 2.0;

/// Distance in mean edges below which a passing sheet is reported: linear panels resolve a
/// doublet sheet's field down to about their size.
const CLOSE: f64 = 1.0;

/// Looks for strikes.
pub(crate) struct Strikes<'a> {
    pub(crate) mesh: &'a TriMesh,
    pub(crate) adjacency: &'a Adjacency<'a>,
    pub(crate) chains: &'a [TrailingEdge],
    pub(crate) paths: &'a BodyPaths,
    pub(crate) direction: Vec3,
}

/// Where a sheet cuts a body.
struct Cut {
    point: Vec3,
    triangle: u32,
    edge: usize,
    start: u32,
}

/// Segments to which a sheet is attached.
type Attachment = Vec<[Vec3; 2]>;

impl Strikes<'_> {
    /// Notes on sheets that pass close by.
    ///
    /// # Errors
    /// [`BemError::WakeStrikes`] where one enters a body.
    pub(crate) fn check(&self, sheet: &Layer) -> Result<Vec<String>, BemError> {
        let vertices = self
            .mesh
            .vertices
            .iter()
            .map(|p| Vector::from(*p))
            .collect();
        let Ok(search) = SearchMesh::new(vertices, self.mesh.triangles.clone()) else {
            return Ok(Vec::new());
        };
        let attachments: Vec<Attachment> =
            (0..self.chains.len()).map(|c| self.attachment(c)).collect();
        let first = sheet
            .seen()
            .filter_map(|(corners, edge, start)| {
                self.cut(&search, corners, edge, start, &attachments[edge])
            })
            .min_by(|a, b| {
                let along = |cut: &Cut| cut.point.dot(&self.direction);
                along(a).total_cmp(&along(b))
            });
        if let Some(cut) = first {
            return Err(self.strike(&cut));
        }
        Ok(self.close(&search, sheet, &attachments))
    }

    fn position(&self, vertex: u32) -> Vec3 {
        self.mesh.vertices[vertex as usize]
    }

    fn attachment(&self, chain: usize) -> Attachment {
        let mut segments: Attachment = self.chains[chain]
            .edges()
            .map(|e| e.map(|v| self.position(v)))
            .collect();
        for path in self.paths.paths.iter().filter(|p| p.end.chain == chain) {
            segments.extend(
                path.vertices
                    .windows(2)
                    .map(|e| [self.position(e[0]), self.position(e[1])]),
            );
        }
        segments
    }

    fn longest_edge(&self, triangle: u32) -> f64 {
        let [a, b, c] = self.mesh.corners(triangle as usize);
        (b - a).norm().max((c - b).norm()).max((a - c).norm())
    }

    /// The first cut of a triangle of the sheet that is no touch.
    fn cut(
        &self,
        search: &SearchMesh,
        corners: [Vec3; 3],
        edge: usize,
        start: u32,
        attachment: &Attachment,
    ) -> Option<Cut> {
        let low = corners[0].inf(&corners[1]).inf(&corners[2]);
        let high = corners[0].sup(&corners[1]).sup(&corners[2]);
        let bounds = Aabb::new(Vector::from(low), Vector::from(high));
        let mut found: Option<Cut> = None;
        for triangle in search.bvh().intersect_aabb(&bounds) {
            let body = self.mesh.corners(triangle as usize);
            let reach = ATTACHED * self.longest_edge(triangle);
            for point in crossings(&corners, &body) {
                let is_first = found
                    .as_ref()
                    .is_none_or(|cut| (point - cut.point).dot(&self.direction) < 0.0);
                if is_first && distance(attachment, point) > reach {
                    found = Some(Cut {
                        point,
                        triangle,
                        edge,
                        start,
                    });
                }
            }
        }
        found
    }

    fn strike(&self, cut: &Cut) -> BemError {
        BemError::WakeStrikes {
            edge: cut.edge,
            start: cut.start,
            from: self.position(cut.start).into(),
            triangle: cut.triangle,
            at: cut.point.into(),
        }
    }

    /// One note for each trailing edge whose sheet passes a body within its cells for more
    /// than a point.
    fn close(
        &self,
        search: &SearchMesh,
        sheet: &Layer,
        attachments: &[Attachment],
    ) -> Vec<String> {
        let mut nearest: Vec<Option<(f64, Vec3, u32)>> = vec![None; attachments.len()];
        let mut count = vec![0; attachments.len()];
        for (point, edge) in sheet.seen_points() {
            let (projection, (triangle, _)) =
                search.project_local_point_and_get_location(Vector::from(point), false);
            let foot = Vec3::from(projection.point);
            let corner = self.mesh.triangles[triangle as usize][0];
            let cell = mean_edge(&self.mesh.vertices, self.adjacency, corner);
            let ratio = (foot - point).norm() / cell;
            if ratio >= CLOSE || distance(&attachments[edge], point) <= LEAVING * cell {
                continue;
            }
            count[edge] += 1;
            if nearest[edge].is_none_or(|(least, _, _)| ratio < least) {
                nearest[edge] = Some((ratio, point, triangle));
            }
        }
        nearest
            .into_iter()
            .zip(count)
            .enumerate()
            .filter(|(_, (_, count))| *count > 1)
            .filter_map(|(edge, (nearest, _))| nearest.map(|n| (edge, n)))
            .map(|(edge, (ratio, p, triangle))| {
                format!(
                    "the wake of trailing edge {edge} passes triangle {triangle} of the body at {ratio:.2} of the triangles' size, near ({:.4}, {:.4}, {:.4}) m: forces there hang on the mesh; refine it, or lead the wake elsewhere by wake.direction",
                    p.x, p.y, p.z
                )
            })
            .collect()
    }
}

/// Points in which edges of one triangle go through the other.
fn crossings(first: &[Vec3; 3], second: &[Vec3; 3]) -> Vec<Vec3> {
    let pierce = |edges: &[Vec3; 3], face: &[Vec3; 3]| -> Vec<Vec3> {
        (0..3)
            .filter_map(|i| through(edges[i], edges[(i + 1) % 3], face))
            .collect()
    };
    let mut points = pierce(first, second);
    points.extend(pierce(second, first));
    points
}

/// Where a segment goes through a triangle (Möller and Trumbore, 1997).
fn through(from: Vec3, to: Vec3, [a, b, c]: &[Vec3; 3]) -> Option<Vec3> {
    let (along, u, v) = (to - from, b - a, c - a);
    let normal = along.cross(&v);
    let determinant = u.dot(&normal);
    // Parallel to the plane within round-off.
    if determinant.abs() <= 1e-12 * u.norm() * v.norm() * along.norm() {
        return None;
    }
    let offset = from - a;
    let s = offset.dot(&normal) / determinant;
    let turned = offset.cross(&u);
    let t = along.dot(&turned) / determinant;
    let share = v.dot(&turned) / determinant;
    let inside = s >= 0.0 && t >= 0.0 && s + t <= 1.0 && (0.0..=1.0).contains(&share);
    inside.then(|| from + share * along)
}

/// Distance of a point from the nearest of several segments.
fn distance(segments: &[[Vec3; 2]], point: Vec3) -> f64 {
    segments
        .iter()
        .map(|[a, b]| {
            let along = b - a;
            let share = (point - a).dot(&along) / along.norm_squared();
            (point - a - along * share.clamp(0.0, 1.0)).norm()
        })
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_goes_through_a_triangle_or_past_it() {
        let face = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        let at = |x: f64, y: f64| through(Vec3::new(x, y, -1.0), Vec3::new(x, y, 3.0), &face);
        assert!((at(0.2, 0.3).expect("inside") - Vec3::new(0.2, 0.3, 0.0)).norm() < 1e-15);
        assert!(at(0.6, 0.6).is_none() && at(-0.1, 0.5).is_none());
        assert!(through(Vec3::z(), Vec3::new(0.2, 0.2, 0.1), &face).is_none());
    }
}
