//! How well the surface moves as the skin of the structure does.
//!
//! The way back: every node that carries the surface is carried in turn by the
//! nearest triangle of its own part of the surface (of the nearest of them, where
//! parts meet), with the same offset by rotation ([`crate::offset`]). What a mode loses on the way there and back,
//! relative to its largest displacement, holds the faceting of both meshes,
//! wrong carriers and missing skins.

use crate::block_matrix::BlockMatrix;
use crate::closest::FaceSearch;
use crate::components::Plan;
use crate::face::Face;
use crate::offset;
use fladder_mesh::{TriMesh, Vec3};
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The way back from surface to structure.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct WayBack {
    /// Nodes compared.
    nodes: Vec<u32>,
    /// Vertices of the mesh to these nodes.
    matrix: BlockMatrix,
}

/// The largest error of one mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkinError {
    /// Difference over the largest displacement of the mode.
    pub relative: f64,
    /// Index of the node where it is.
    pub node: u32,
}

/// One node carried back, and its distance from the triangle.
struct Row {
    node: u32,
    distance: f64,
    blocks: Vec<(u32, Matrix3<f64>)>,
}

impl WayBack {
    /// `nodes` holds those of each target of the plan.
    pub(crate) fn new(
        plan: &Plan,
        nodes: &[Vec<u32>],
        positions: &[Vec3],
        mesh: &TriMesh,
    ) -> Self {
        let mut nearest: BTreeMap<u32, Row> = BTreeMap::new();
        for (target, nodes) in nodes.iter().enumerate() {
            let Some(search) = FaceSearch::new(triangles(plan, target, mesh), &mesh.vertices)
            else {
                continue;
            };
            for row in carried(&search, nodes, positions, mesh) {
                let known = nearest.get(&row.node);
                if known.is_none_or(|known| row.distance < known.distance) {
                    nearest.insert(row.node, row);
                }
            }
        }
        let rows = nearest.into_values().map(|row| (row.node, row.blocks));
        let (nodes, blocks) = rows.unzip();
        Self {
            nodes,
            matrix: BlockMatrix::from_rows(mesh.vertices.len(), blocks),
        }
    }

    /// `None` where no node lies at the surface.
    pub(crate) fn error(
        &self,
        on_surface: &[Vec3],
        on_structure: &[Vec3],
    ) -> Option<SkinError> {
        let largest = on_structure.iter().map(Vec3::norm).fold(0.0, f64::max);
        let back = self.matrix.displacement(on_surface);
        let differences = self.nodes.iter().zip(back).map(|(node, back)| SkinError {
            relative: (back - on_structure[*node as usize]).norm() / largest,
            node: *node,
        });
        differences.max_by(|a, b| a.relative.total_cmp(&b.relative))
    }
}

/// Triangles of one target with all of their vertices.
fn triangles(plan: &Plan, target: usize, mesh: &TriMesh) -> Vec<Face> {
    let is_own = |vertex: &u32| {
        plan.of_vertex[*vertex as usize]
            .is_some_and(|component| plan.components[component as usize].target == target)
    };
    let own = mesh
        .triangles
        .iter()
        .enumerate()
        .filter(|(_, triangle)| triangle.iter().all(is_own));
    own.map(|(index, triangle)| Face {
        nodes: triangle.to_vec(),
        element: index as u32,
    })
    .collect()
}

/// Nodes farther from their triangle than it is long are inside, or beyond an
/// open end: nothing there says how the skin moves.
fn carried(search: &FaceSearch, nodes: &[u32], positions: &[Vec3], mesh: &TriMesh) -> Vec<Row> {
    nodes
        .par_iter()
        .filter_map(|node| {
            let point = &positions[*node as usize];
            let hit = search.nearest(point, &mesh.vertices);
            let face = &search.faces()[hit.face as usize];
            let [a, b, c] = mesh.corners(face.element as usize);
            let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
            (hit.distance <= longest).then(|| Row {
                node: *node,
                distance: hit.distance,
                blocks: offset::blocks(face, hit.at, point, &mesh.vertices),
            })
        })
        .collect()
}
