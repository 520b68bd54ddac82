//! Which faces of the structure are outer skin.
//!
//! Candidates are the faces of shells, or, where a structure has no shells, the
//! faces of solids that belong to one solid alone. A candidate is skin when its
//! middle lies on the wetted surface, or near it with a normal along the
//! surface's; webs, ribs and bulkheads end at the skin but stand across it.

use crate::closest::{FLAT_FACET, has_normal};
use crate::element::ElementKind;
use crate::face::{Face, solid_faces};
use crate::result::ModalResult;
use fladder_mesh::{TriMesh, Vec3};
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::TriMesh as SearchMesh;
use rayon::prelude::*;
use std::collections::HashMap;

/// Cosine between the normals of skin and surface that a skin face reaches:
/// coarse faces round a leading edge are off by some 30°, webs and ribs by 90°.
const NORMAL_COSINE: f64 = 0.5;

/// Distance of a skin face's middle from the surface relative to the square root
/// of its area; a flat face on a curved surface stays well under this.
const NEAR: f64 = 0.5;

/// Distance, relative as above, at which a face is skin whatever its normal: the
/// middle of a web is half its height away, which is more unless it is a hundred
/// times as long as high. Strongly warped skin faces have useless normals.
const ON: f64 = 0.05;

/// The wetted surface, to be asked for its nearest triangle.
pub(crate) struct SurfaceSearch {
    search: SearchMesh,
    normals: Vec<Vec3>,
}

impl SurfaceSearch {
    /// `None` where no triangle has any area.
    pub(crate) fn new(mesh: &TriMesh) -> Option<Self> {
        let (mut triangles, mut normals) = (Vec::new(), Vec::new());
        for (index, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = mesh.corners(index);
            let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
            let area = mesh.area_vector(index);
            if area.norm() > FLAT_FACET * longest * longest {
                triangles.push(*triangle);
                normals.push(area.normalize());
            }
        }
        let vertices = mesh.vertices.iter().map(|v| Vector::from(*v)).collect();
        Some(Self {
            search: SearchMesh::new(vertices, triangles).ok()?,
            normals,
        })
    }

    /// Distance and normal of the nearest triangle.
    fn nearest(&self, point: &Vec3) -> (f64, Vec3) {
        let point = Vector::from(*point);
        let projection = self.search.project_local_point(point, false);
        let triangle = projection.subshape as usize;
        ((projection.point - point).length(), self.normals[triangle])
    }
}

/// Candidate faces, and which of them are outer skin.
pub(crate) struct Skin {
    pub(crate) faces: Vec<Face>,
    pub(crate) outer: Vec<bool>,
    /// Connected piece of the structure each face belongs to.
    pub(crate) piece: Vec<u32>,
}

impl Skin {
    /// Judges the candidates by the wetted surface.
    pub(crate) fn judge(faces: Vec<Face>, positions: &[Vec3], surface: &SurfaceSearch) -> Self {
        let outer = faces
            .par_iter()
            .map(|face| lies_on(face, positions, surface))
            .collect();
        let piece = pieces(&faces, positions.len());
        Self {
            faces,
            outer,
            piece,
        }
    }
}

fn lies_on(face: &Face, positions: &[Vec3], surface: &SurfaceSearch) -> bool {
    let middle = face.point(face.middle(), positions);
    let across = middle.tangent_r.cross(&middle.tangent_s);
    let (distance, normal) = surface.nearest(&middle.position);
    let size = face.area(positions).sqrt();
    let along = across.dot(&normal).abs() >= NORMAL_COSINE * across.norm();
    distance <= ON * size || (distance <= NEAR * size && along)
}

/// Faces of some area, and with a normal in the middle, that can be outer skin.
pub(crate) fn candidates(result: &ModalResult, positions: &[Vec3]) -> Vec<Face> {
    let shells: Vec<Face> = result
        .elements
        .iter()
        .enumerate()
        .filter(|(_, element)| element.kind.is_shell())
        .map(|(index, element)| Face {
            nodes: element.nodes.clone(),
            element: index as u32,
        })
        .collect();
    let mut faces = if shells.is_empty() {
        free_solid_faces(result)
    } else {
        shells
    };
    faces.retain(|face| {
        face.area(positions) > 0.0 && has_normal(face, face.middle(), positions)
    });
    faces
}

/// Faces that one solid alone has.
fn free_solid_faces(result: &ModalResult) -> Vec<Face> {
    let mut count: HashMap<Vec<u32>, u32> = HashMap::new();
    let mut faces = Vec::new();
    for (index, element) in result.elements.iter().enumerate() {
        for local in solid_faces(element.kind) {
            let nodes: Vec<u32> = local.iter().map(|k| element.nodes[*k]).collect();
            *count.entry(key(&nodes)).or_default() += 1;
            faces.push(Face {
                nodes,
                element: index as u32,
            });
        }
    }
    faces.retain(|face| count[&key(&face.nodes)] == 1);
    faces
}

fn key(nodes: &[u32]) -> Vec<u32> {
    let mut sorted = nodes.to_vec();
    sorted.sort_unstable();
    sorted
}

/// Numbers the pieces that faces form through shared nodes, in the order of
/// their first face.
fn pieces(faces: &[Face], node_count: usize) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..node_count as u32).collect();
    for face in faces {
        let root = find(&mut parent, face.nodes[0]);
        for node in &face.nodes[1..] {
            let other = find(&mut parent, *node);
            parent[other as usize] = root;
        }
    }
    let mut number = HashMap::new();
    faces
        .iter()
        .map(|face| {
            let root = find(&mut parent, face.nodes[0]);
            let next = number.len() as u32;
            *number.entry(root).or_insert(next)
        })
        .collect()
}

fn find(parent: &mut [u32], node: u32) -> u32 {
    let mut root = node;
    while parent[root as usize] != root {
        let up = parent[root as usize];
        parent[root as usize] = parent[up as usize];
        root = up;
    }
    root
}

/// Why an element carries no surface.
pub(crate) fn reason(kind: ElementKind, judged: bool) -> &'static str {
    if kind.is_shell() || judged {
        "not on the wetted surface, or of no component"
    } else if kind.is_solid() {
        "solids beside shells"
    } else {
        "bars, springs and points"
    }
}
