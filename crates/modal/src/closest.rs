//! The nearest point of curved faces.
//!
//! The faces are cut into flat facets, of which a bounding-volume hierarchy
//! (parry) finds the nearest; from there a Gauss-Newton iteration on the
//! element's own parameters finds the nearest point of the curved face, kept
//! inside it by the active sides of its parameter range.

use crate::face::Face;
use fladder_mesh::Vec3;
use nalgebra::{Matrix2, Vector2};
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQueryWithLocation;
use parry3d_f64::shape::TriMesh;

/// Gauss-Newton converges in four steps where the offset is small against the
/// radius of curvature, and keeps its last point otherwise.
const ITERATIONS: usize = 20;

/// Step in the parameters, which are of order one, below which the point stays.
const STEP_TOLERANCE: f64 = 1e-12;

/// Facets thinner than this (area over longest edge squared) have no normal.
pub(crate) const FLAT_FACET: f64 = 1e-9;

/// Sine of the angle between the tangents below which a collapsed corner is too
/// near for a surface normal.
const SMALLEST_ANGLE: f64 = 1e-3;

/// A place on a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    /// Index of the face in the search.
    pub(crate) face: u32,
    /// Parameters in the face.
    pub(crate) at: [f64; 2],
    /// Distance from the point that was asked for.
    pub(crate) distance: f64,
}

/// A set of faces that can be asked for the nearest point.
pub(crate) struct FaceSearch {
    faces: Vec<Face>,
    facets: TriMesh,
    /// Face and parameters of the corners of each facet.
    origin: Vec<(u32, [[f64; 2]; 3])>,
}

impl FaceSearch {
    /// `None` where no face has any area.
    pub(crate) fn new(faces: Vec<Face>, positions: &[Vec3]) -> Option<Self> {
        let (mut vertices, mut triangles, mut origin) = (Vec::new(), Vec::new(), Vec::new());
        for (index, face) in faces.iter().enumerate() {
            let (points, cut) = face.facets();
            let first = vertices.len() as u32;
            let corners: Vec<Vec3> = points
                .iter()
                .map(|at| face.point(*at, positions).position)
                .collect();
            for facet in cut {
                let [a, b, c] = facet.map(|k| corners[k as usize]);
                let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
                let area = 0.5 * (b - a).cross(&(c - a)).norm();
                if area > FLAT_FACET * longest * longest {
                    triangles.push(facet.map(|k| first + k));
                    origin.push((index as u32, facet.map(|k| points[k as usize])));
                }
            }
            vertices.extend(corners.into_iter().map(Vector::from));
        }
        let facets = TriMesh::new(vertices, triangles).ok()?;
        Some(Self {
            faces,
            facets,
            origin,
        })
    }

    pub(crate) fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// The nearest point of the faces.
    pub(crate) fn nearest(&self, point: &Vec3, positions: &[Vec3]) -> Hit {
        let (_, (facet, location)) = self
            .facets
            .project_local_point_and_get_location(Vector::from(*point), false);
        let (index, corners) = self.origin[facet as usize];
        let weights = location.barycentric_coordinates().unwrap_or([1.0 / 3.0; 3]);
        let mut at = [0.0; 2];
        for (corner, weight) in corners.iter().zip(weights) {
            at[0] += weight * corner[0];
            at[1] += weight * corner[1];
        }
        let face = &self.faces[index as usize];
        let at = regular(face, refine(face, at, point, positions), positions);
        let distance = (point - face.point(at, positions).position).norm();
        Hit {
            face: index,
            at,
            distance,
        }
    }
}

/// Gauss-Newton on `½ |x(r, s) − p|²` inside the face.
fn refine(face: &Face, start: [f64; 2], point: &Vec3, positions: &[Vec3]) -> [f64; 2] {
    let mut at = Vector2::from(start);
    let mut best = (point - face.point(at.into(), positions).position).norm_squared();
    for _ in 0..ITERATIONS {
        let step = step(face, at, point, positions);
        let length = step.norm();
        if length <= STEP_TOLERANCE || length.is_nan() {
            break;
        }
        let next = inside(face, at, step);
        let value = (point - face.point(next.into(), positions).position).norm_squared();
        if value >= best {
            break;
        }
        (at, best) = (next, value);
    }
    at.into()
}

fn step(face: &Face, at: Vector2<f64>, point: &Vec3, positions: &[Vec3]) -> Vector2<f64> {
    let patch = face.point(at.into(), positions);
    let rest = point - patch.position;
    let (t, u) = (patch.tangent_r, patch.tangent_s);
    let slope = Vector2::new(t.dot(&rest), u.dot(&rest));
    let metric = Matrix2::new(t.dot(&t), t.dot(&u), t.dot(&u), u.dot(&u));
    let free = metric
        .try_inverse()
        .map_or_else(Vector2::zeros, |inverse| inverse * slope);
    let pressed: Vec<Vector2<f64>> = face
        .sides()
        .iter()
        .map(|(normal, limit)| (Vector2::from(*normal), *limit))
        .filter(|(normal, limit)| normal.dot(&at) > limit - STEP_TOLERANCE)
        .map(|side| side.0)
        .collect();
    if pressed.iter().all(|normal| normal.dot(&free) <= 0.0) {
        return free;
    }
    // Along one of the sides it is pressed against, away from the others.
    for normal in pressed.iter().filter(|normal| normal.dot(&free) > 0.0) {
        let along = Vector2::new(-normal.y, normal.x);
        let length = (along.transpose() * metric * along)[0];
        if length > 0.0 {
            let slide = along * (along.dot(&slope) / length);
            if pressed
                .iter()
                .all(|other| other.dot(&slide) <= STEP_TOLERANCE)
            {
                return slide;
            }
        }
    }
    Vector2::zeros()
}

/// The longest part of the step that stays in the face.
fn inside(face: &Face, at: Vector2<f64>, step: Vector2<f64>) -> Vector2<f64> {
    let mut share: f64 = 1.0;
    for (normal, limit) in face.sides() {
        let normal = Vector2::from(*normal);
        let (gap, rate) = (limit - normal.dot(&at), normal.dot(&step));
        if rate > 0.0 {
            share = share.min((gap / rate).max(0.0));
        }
    }
    at + step * share
}

/// Steps back from collapsed corners, where the face has no normal, to the middle
/// at last.
fn regular(face: &Face, at: [f64; 2], positions: &[Vec3]) -> [f64; 2] {
    let middle = Vector2::from(face.middle());
    let mut at = Vector2::from(at);
    for _ in 0..40 {
        if has_normal(face, at.into(), positions) {
            return at.into();
        }
        at = middle + (at - middle) * 0.95;
    }
    middle.into()
}

/// The tangents span a plane there.
pub(crate) fn has_normal(face: &Face, at: [f64; 2], positions: &[Vec3]) -> bool {
    let patch = face.point(at, positions);
    let (t, u) = (patch.tangent_r, patch.tangent_s);
    let size = t.norm().max(u.norm());
    t.cross(&u).norm() > SMALLEST_ANGLE * size * size
}
