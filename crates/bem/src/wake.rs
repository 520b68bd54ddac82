//! The wake: near rows as triangles, the far part on streamlines, the jump on bodies.
//!
//! A *thread* is a line along which a jump is convected: from every trailing-edge vertex
//! one, and one from every vertex where body lines meet. Its jump at distance ξ is
//! e^{−sξ} Σ wⱼ κⱼ. A *slot* is a thread at a station, with its hat function.

use crate::adjacency::Adjacency;
use crate::body_path::Tracer;
use crate::contour::Paths;
use crate::cut::CutSurface;
use crate::divided_edges::divided_edges;
use crate::error::BemError;
use crate::far_wake::FarWake;
use crate::image::Image;
use crate::lanes::WIDTH;
use crate::ordering::spatial_order;
use crate::panel_block::{BLOCK, PanelBlock};
use crate::strike::Strikes;
use crate::wake_builder::Builder;
use crate::wake_sheet::WakeSheet;
use fladder_mesh::{TrailingEdge, TriMesh, Vec3};

/// Marks a corner whose jump is zero.
pub(crate) const NO_SLOT: u32 = u32::MAX;

/// A thread at a station.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slot {
    pub(crate) thread: usize,
    pub(crate) xi: f64,
}

/// Triangles whose corners carry slots.
#[derive(Clone, Debug)]
pub(crate) struct JumpSheet {
    /// Close triangles together; a block's columns are slots.
    pub(crate) blocks: Vec<PanelBlock>,
    pub(crate) corner_slots: Vec<[u32; 3]>,
    /// Triangles of the body under them; empty for the free sheet.
    pub(crate) body_triangles: Vec<u32>,
}

impl JumpSheet {
    /// Triangles given by vertex indices, and the slot of each corner.
    pub(crate) fn new(
        vertices: &[Vec3],
        triangles: &[[u32; 3]],
        corner_slots: Vec<[u32; 3]>,
        body_triangles: Vec<u32>,
    ) -> Self {
        let centres: Vec<Vec3> = triangles
            .iter()
            .map(|t| t.iter().map(|&v| vertices[v as usize]).sum::<Vec3>() / 3.0)
            .collect();
        let slot = |t: u32, c: usize| {
            let slot = corner_slots[t as usize][c];
            (slot != NO_SLOT).then_some(slot)
        };
        let blocks = spatial_order(&centres, [BLOCK, WIDTH])
            .chunks(BLOCK)
            .map(|which| PanelBlock::new(vertices, triangles, which, slot))
            .collect();
        Self {
            blocks,
            corner_slots,
            body_triangles,
        }
    }

    /// Number of triangles.
    pub(crate) fn len(&self) -> usize {
        self.corner_slots.len()
    }
}

/// The whole wake of a surface.
#[derive(Clone, Debug)]
pub(crate) struct Wake {
    /// Jump of each thread as weights of the columns' κ.
    pub(crate) threads: Vec<Vec<(usize, f64)>>,
    pub(crate) slots: Vec<Slot>,
    pub(crate) near: JumpSheet,
    pub(crate) body: JumpSheet,
    pub(crate) far: FarWake,
    /// Thread of each streamline of the far part.
    pub(crate) far_threads: Vec<usize>,
    pub(crate) paths: Paths,
    /// Warnings for the user.
    pub(crate) notes: Vec<String>,
    pub(crate) stations: usize,
    /// The near part as it is seen.
    pub(crate) sheet: WakeSheet,
}

impl Wake {
    /// Body triangle, corner and slot of every corner that carries a jump.
    pub(crate) fn body_corners(&self) -> impl Iterator<Item = (u32, usize, usize)> + '_ {
        self.body
            .body_triangles
            .iter()
            .zip(&self.body.corner_slots)
            .flat_map(|(&t, slots)| {
                slots
                    .iter()
                    .enumerate()
                    .filter(|(_, slot)| **slot != NO_SLOT)
                    .map(move |(corner, &slot)| (t, corner, slot as usize))
            })
    }
}

/// The cut surface and its wake; `image`: whether the other half is an image in y = 0,
/// and what the motion does there.
pub(crate) fn cut_and_wake(
    mesh: &TriMesh,
    chains: &[TrailingEdge],
    direction: Vec3,
    body_lines: &[[u32; 2]],
    semichord: f64,
    image: Image,
) -> Result<(CutSurface, Wake), BemError> {
    let adjacency = Adjacency::new(mesh.vertices.len(), &mesh.triangles);
    let tracer = Tracer {
        vertices: &mesh.vertices,
        adjacency: &adjacency,
        chains,
        downstream: direction,
        named: body_lines,
        image,
    };
    let half = image != Image::None;
    let paths = tracer.trace()?;
    let mut surface = CutSurface::new(mesh, &adjacency, chains, &paths, half)?;
    surface.divided = divided_edges(&surface, chains, direction, half);
    let strikes = Strikes {
        mesh,
        adjacency: &adjacency,
        chains,
        paths: &paths,
        direction,
    };
    let wake = Builder::new(mesh, chains, &surface, &paths, direction, semichord, half)
        .build(&strikes)?;
    Ok((surface, wake))
}
