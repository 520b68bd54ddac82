//! The surface with its trailing-edge vertices doubled.
//!
//! The potential jumps across a trailing edge, so that each vertex on it has an upper
//! and a lower value; their difference is the wake's jump κ. A free tip keeps one value:
//! the jump is zero there. A junction with a body is doubled too, by the first edge of
//! the body line; along the rest of the line the vertices stay single and the jump is
//! added on the corners of their upper triangles.

use crate::adjacency::{Adjacency, undirected};
use crate::body_path::{BodyPaths, end_vertex};
use crate::error::BemError;
use crate::image::on_plane;
use fladder_mesh::{TrailingEdge, TriMesh, Vec3};
use std::collections::HashSet;

/// One doubled vertex: κ = φ(upper) − φ(lower).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Column {
    pub(crate) upper: u32,
    pub(crate) lower: u32,
}

/// The corners on the upper side of one vertex of a body line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct UpperCorners {
    pub(crate) vertex: u32,
    /// Triangle and corner number.
    pub(crate) corners: Vec<(u32, usize)>,
}

/// Surface cut open along its trailing edges.
#[derive(Clone, Debug)]
pub(crate) struct CutSurface {
    pub(crate) vertices: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Mesh vertex of each vertex.
    pub(crate) source: Vec<u32>,
    pub(crate) columns: Vec<Column>,
    /// Column of each vertex of each chain; none at free tips.
    pub(crate) chain_columns: Vec<Vec<Option<usize>>>,
    /// Upper corners along each body cut, junctions left out.
    pub(crate) cut_corners: Vec<Vec<UpperCorners>>,
}

impl CutSurface {
    pub(crate) fn new(
        mesh: &TriMesh,
        adjacency: &Adjacency<'_>,
        chains: &[TrailingEdge],
        paths: &BodyPaths,
        half: bool,
    ) -> Result<Self, BemError> {
        let mut surface = Self {
            vertices: mesh.vertices.clone(),
            triangles: mesh.triangles.clone(),
            source: (0..mesh.vertices.len() as u32).collect(),
            columns: Vec::new(),
            chain_columns: Vec::new(),
            cut_corners: Vec::new(),
        };
        let cuts = cut_edges(chains, paths);
        for (c, chain) in chains.iter().enumerate() {
            let columns = (0..chain.vertices.len())
                .map(|i| surface.double((c, i), chain, adjacency, paths, &cuts, half))
                .collect::<Result<_, _>>()?;
            surface.chain_columns.push(columns);
        }
        surface.cut_corners = (0..paths.cuts.len())
            .map(|i| upper_corners(i, adjacency, chains, paths))
            .collect::<Result<_, _>>()?;
        Ok(surface)
    }

    /// Doubles one vertex of a chain, unless it is a free tip. On the plane of symmetry of
    /// a half model the edge goes on.
    fn double(
        &mut self,
        (c, i): (usize, usize),
        chain: &TrailingEdge,
        adjacency: &Adjacency<'_>,
        paths: &BodyPaths,
        cuts: &HashSet<(u32, u32)>,
        half: bool,
    ) -> Result<Option<usize>, BemError> {
        let vertex = chain.vertices[i];
        let n = chain.vertices.len();
        let is_end = !chain.closed && (i == 0 || i == n - 1);
        let is_junction = paths
            .paths
            .iter()
            .any(|p| p.end.chain == c && p.vertices[0] == vertex);
        let goes_on = half && on_plane(&self.vertices[vertex as usize]);
        if is_end && !is_junction && !goes_on {
            return Ok(None);
        }
        let groups = adjacency.fan_groups(vertex, cuts);
        if groups.len() != 2 {
            let p = self.vertices[vertex as usize];
            return Err(BemError::TrailingFan {
                vertex,
                x: p.x,
                y: p.y,
                z: p.z,
                groups: groups.len(),
            });
        }
        let beside = chain.upper[if i < chain.upper.len() { i } else { i - 1 }];
        let upper = self.vertices.len() as u32;
        self.vertices.push(self.vertices[vertex as usize]);
        self.source.push(vertex);
        for group in groups.iter().filter(|g| g.contains(&beside)) {
            for &t in group {
                for v in &mut self.triangles[t as usize] {
                    if *v == vertex {
                        *v = upper;
                    }
                }
            }
        }
        self.columns.push(Column {
            upper,
            lower: vertex,
        });
        Ok(Some(self.columns.len() - 1))
    }
}

/// Trailing edges, and at junctions the first edge of the body line.
fn cut_edges(chains: &[TrailingEdge], paths: &BodyPaths) -> HashSet<(u32, u32)> {
    let mut cuts = HashSet::new();
    for chain in chains {
        let n = chain.vertices.len();
        for i in 0..chain.upper.len() {
            cuts.insert(undirected(chain.vertices[i], chain.vertices[(i + 1) % n]));
        }
    }
    for path in &paths.paths {
        cuts.insert(undirected(path.vertices[0], path.vertices[1]));
    }
    cuts
}

/// Upper corners along one body cut.
///
/// The side is handed on from triangle to triangle: at the junction it is the side of
/// the trailing edge's upper triangles, at each further vertex the side that holds the
/// upper triangle of the edge just passed.
fn upper_corners(
    cut: usize,
    adjacency: &Adjacency<'_>,
    chains: &[TrailingEdge],
    paths: &BodyPaths,
) -> Result<Vec<UpperCorners>, BemError> {
    let body_cut = &paths.cuts[cut];
    let line = cut_line(cut, paths);
    // A line alone is walked from its junction; its last vertex has no second side.
    let walk: Vec<u32> = if body_cut.before.is_some() {
        line.clone()
    } else {
        line.iter().rev().copied().collect()
    };
    let start = body_cut
        .before
        .or(body_cut.after)
        .expect("a cut has a line");
    let end = paths.paths[start].end;
    let chain = &chains[end.chain];
    let mut cuts = HashSet::from([undirected(walk[0], walk[1])]);
    let (te_index, te_other) = if end.last {
        (
            chain.upper.len() - 1,
            chain.vertices[chain.vertices.len() - 2],
        )
    } else {
        (0, chain.vertices[1])
    };
    cuts.insert(undirected(end_vertex(chain, end.last), te_other));
    let mut seed = chain.upper[te_index];
    let mut upper = Vec::new();
    for i in 0..walk.len() - 1 {
        let vertex = walk[i];
        if i > 0 {
            cuts = HashSet::from([
                undirected(walk[i - 1], vertex),
                undirected(vertex, walk[i + 1]),
            ]);
        }
        let groups = adjacency.fan_groups(vertex, &cuts);
        if groups.len() != 2 {
            return Err(BemError::PathFan {
                vertex,
                groups: groups.len(),
            });
        }
        let side = groups
            .iter()
            .find(|g| g.contains(&seed))
            .unwrap_or(&groups[0]);
        if i > 0 {
            let corners = side
                .iter()
                .filter_map(|&t| adjacency.corner(t, vertex).map(|c| (t, c)))
                .collect();
            upper.push(UpperCorners { vertex, corners });
        }
        seed = [
            adjacency.left_of(vertex, walk[i + 1]),
            adjacency.left_of(walk[i + 1], vertex),
        ]
        .into_iter()
        .flatten()
        .find(|t| side.contains(t))
        .ok_or(BemError::PathFan {
            vertex,
            groups: groups.len(),
        })?;
    }
    Ok(upper)
}

/// Vertices of a body cut from the junction of `before` to that of `after`.
pub(crate) fn cut_line(cut: usize, paths: &BodyPaths) -> Vec<u32> {
    let body_cut = &paths.cuts[cut];
    let mut line = Vec::new();
    if let Some(before) = body_cut.before {
        line.extend(&paths.paths[before].vertices);
    }
    for &v in &body_cut.bridge {
        if line.last() != Some(&v) {
            line.push(v);
        }
    }
    if let Some(after) = body_cut.after {
        for &v in paths.paths[after].vertices.iter().rev() {
            if line.last() != Some(&v) {
                line.push(v);
            }
        }
    }
    line
}
