//! Where the jumps of body lines are carried: corners of the body's triangles, and sheets
//! of trailing edges that take them up.
//!
//! Along a line the potential is φ_c + Σ_m κ e^{−sξ_m} N_m, N_m the hat function on the
//! upper corners of vertex m alone. At a node the corners of each sector carry the sum of
//! the jumps crossed on the way there. At a vertex of another trailing edge the upper
//! corners are those between the line and the first trailing edge on its upper side: across
//! that edge the body's potential jumps by κ e^{−sξ} more, and so does its sheet.

use crate::adjacency::{Adjacency, Turn};
use crate::body_node::sign;
use crate::body_path::{BodyPaths, Finish, Node};
use crate::error::BemError;
use fladder_mesh::{TrailingEdge, Vec3};

/// A share of a line's jump on one corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CarriedCorner {
    pub(crate) triangle: u32,
    pub(crate) corner: usize,
    pub(crate) path: usize,
    pub(crate) weight: f64,
}

/// A body line that ends on another trailing edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Join {
    pub(crate) path: usize,
    pub(crate) chain: usize,
    /// Number of the edge whose strip of the sheet takes the jump up.
    pub(crate) edge: usize,
    /// Whether the line's upper corners lie on the edge's upper side.
    pub(crate) on_upper: bool,
}

/// Walks all lines.
pub(crate) struct Carrier<'a> {
    pub(crate) vertices: &'a [Vec3],
    pub(crate) adjacency: &'a Adjacency<'a>,
    pub(crate) chains: &'a [TrailingEdge],
    pub(crate) paths: &'a BodyPaths,
}

impl Carrier<'_> {
    /// All corners with a share, and all joins.
    pub(crate) fn carry(&self) -> Result<(Vec<CarriedCorner>, Vec<Join>), BemError> {
        let mut corners = Vec::new();
        let mut joins = Vec::new();
        for path in 0..self.paths.paths.len() {
            self.along(path, &mut corners)?;
            if self.paths.paths[path].finish == Finish::TrailingEdge {
                joins.push(self.join(path, &mut corners)?);
            }
        }
        for node in &self.paths.nodes {
            self.at_node(node, &mut corners)?;
        }
        Ok((corners, joins))
    }

    fn fan(&self, vertex: u32) -> BemError {
        let p = self.vertices[vertex as usize];
        BemError::PathFan {
            vertex,
            x: p.x,
            y: p.y,
            z: p.z,
        }
    }

    /// Vertices between the first and the last.
    fn along(&self, path: usize, out: &mut Vec<CarriedCorner>) -> Result<(), BemError> {
        let line = &self.paths.paths[path];
        for i in 1..line.vertices.len() - 1 {
            let [before, vertex, after] = [i - 1, i, i + 1].map(|j| line.vertices[j]);
            // Left of the line lies counter-clockwise from the edge that goes on.
            let (sector, _) = self
                .adjacency
                .sector(vertex, after, line.upper(), |v| v == before)
                .ok_or_else(|| self.fan(vertex))?;
            let jump = self.paths.jump_at(path, i, self.vertices);
            self.add(&sector, vertex, &jump, out);
        }
        Ok(())
    }

    fn add(
        &self,
        sector: &[u32],
        vertex: u32,
        jump: &[(usize, f64)],
        out: &mut Vec<CarriedCorner>,
    ) {
        for &triangle in sector {
            if let Some(corner) = self.adjacency.corner(triangle, vertex) {
                out.extend(jump.iter().map(|&(path, weight)| CarriedCorner {
                    triangle,
                    corner,
                    path,
                    weight,
                }));
            }
        }
    }

    fn join(&self, path: usize, out: &mut Vec<CarriedCorner>) -> Result<Join, BemError> {
        let line = &self.paths.paths[path];
        let vertex = line.last();
        let before = line.vertices[line.vertices.len() - 2];
        // Left of a line that arrives lies clockwise from it.
        let turn = match line.upper() {
            Turn::Left => Turn::Right,
            Turn::Right => Turn::Left,
        };
        let edge_to = |v: u32| {
            self.chains.iter().enumerate().find_map(|(chain, c)| {
                c.edges()
                    .position(|e| e == [vertex, v] || e == [v, vertex])
                    .map(|edge| (chain, edge))
            })
        };
        let (sector, stop) = self
            .adjacency
            .sector(vertex, before, turn, |v| edge_to(v).is_some())
            .ok_or_else(|| self.fan(vertex))?;
        let (chain, edge) = edge_to(stop).ok_or_else(|| self.fan(vertex))?;
        self.add(&sector, vertex, &[(path, 1.0)], out);
        let last = sector.last();
        Ok(Join {
            path,
            chain,
            edge,
            on_upper: last == Some(&self.chains[chain].upper[edge]),
        })
    }

    /// Sectors of a node, once round; in the plane of a half model from rim to rim.
    fn at_node(&self, node: &Node, out: &mut Vec<CarriedCorner>) -> Result<(), BemError> {
        let lines = &self.paths.paths;
        let edge = |p: usize| lines[p].vertices[lines[p].vertices.len() - 2];
        let rim = self.adjacency.rim(node.vertex);
        let first = rim.unwrap_or_else(|| edge(node.paths[0]));
        if rim.is_none() && node.paths.iter().all(|&p| edge(p) == first) {
            return Ok(());
        }
        let is_rim = |v: u32| self.adjacency.left_of(node.vertex, v).is_none();
        let mut potential = vec![0.0; lines.len()];
        let mut from = first;
        loop {
            let (sector, next) = self
                .adjacency
                .sector(node.vertex, from, Turn::Left, |v| {
                    is_rim(v) || node.paths.iter().any(|&p| edge(p) == v)
                })
                .ok_or_else(|| self.fan(node.vertex))?;
            let jump: Vec<(usize, f64)> = potential
                .iter()
                .copied()
                .enumerate()
                .filter(|(_, weight)| *weight != 0.0)
                .collect();
            self.add(&sector, node.vertex, &jump, out);
            if next == first || is_rim(next) {
                return Ok(());
            }
            for (place, &p) in node.paths.iter().enumerate() {
                if edge(p) == next {
                    for &(k, weight) in &node.shares[place] {
                        potential[k] += sign(&lines[p]) * weight;
                    }
                }
            }
            from = next;
        }
    }
}
