//! The line of mesh edges down a body that stays closest to the plane of a wake.
//!
//! Through the junction runs the plane of the stream and of the trailing edge. Of all lines
//! of edges that run downstream or, where they lead back to the plane, across, the one is
//! taken with the least
//!
//! $$ \sum L\,\big(1 + (d/\ell)^2 + F\max(0, -\mathbf n\cdot\mathbf e)^2\big)
//!    - \Gamma\,\mathbf u\cdot(\mathbf x_{end} - \mathbf x_J) , $$
//!
//! L the edge's length, d its end's distance from the plane (and, outboard of the junction,
//! from the junction), ℓ the mean length of the edges and n the normal at that end, e the
//! direction of the trailing edge away from the junction, across the stream: where the
//! normal points against it the sheet would start inside the body. On a mesh whose edges
//! follow the plane it is that row of edges; on any other it stays within a cell or two of
//! the plane where the body does. It ends where no edge runs downstream, or on a trailing
//! edge; Γ decides between several ends: a line goes on rather than end on a bump or a fin
//! as long as that leads it less than √Γ cells off.

use crate::adjacency::Adjacency;
use fladder_mesh::Vec3;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap, HashSet};

/// Smallest cosine between stream and mesh edge with which a line goes on: above the slope
/// of a base that is cut square, at the incidences of linear theory.
const FOLLOW_COSINE: f64 = 0.2;

/// Smallest cosine of an edge across: no way back upstream but for the incidence.
const ACROSS_COSINE: f64 = -0.1;

/// What an edge across costs, in edges downstream.
const ACROSS_PRICE: f64 = 2.0;

/// Γ: gain per length of advance.
const ADVANCE: f64 = 10.0;

/// F: what a line on the far side of the body costs, as much as ten cells off its plane.
const FAR_SIDE: f64 = 100.0;

/// Search over the edges that run downstream.
pub(crate) struct Downstream<'a> {
    pub(crate) vertices: &'a [Vec3],
    pub(crate) adjacency: &'a Adjacency<'a>,
    pub(crate) stream: Vec3,
    /// Vertices of the trailing edge from which the line comes: it never returns there.
    pub(crate) own: &'a [u32],
    /// Vertices of trailing edges, where a line ends.
    pub(crate) barrier: &'a HashSet<u32>,
}

/// The least cost known of a vertex and the vertex before it.
type Known = HashMap<u32, (f64, u32)>;

impl Downstream<'_> {
    /// The line from `junction`, whose trailing edge goes on to `beside`.
    pub(crate) fn line(&self, junction: u32, beside: u32) -> Option<Vec<u32>> {
        let origin = self.position(junction);
        let outward = self.position(beside) - origin;
        let outward = outward - self.stream * outward.dot(&self.stream);
        let outward = outward.try_normalize(0.0)?;
        let across = self.stream.cross(&outward);
        let mut known: Known = HashMap::from([(junction, (0.0, junction))]);
        let mut open = BinaryHeap::from([Reverse((Ordered(0.0), junction))]);
        let mut end: Option<(f64, u32)> = None;
        while let Some(Reverse((Ordered(cost), v))) = open.pop() {
            if cost > known[&v].0 {
                continue;
            }
            match self.steps(v) {
                Steps::DeadEnd => {}
                Steps::End if v == junction => {}
                Steps::End => {
                    let advance = (self.position(v) - origin).dot(&self.stream);
                    let score = cost - ADVANCE * advance;
                    if end.is_none_or(|(least, _)| score < least) {
                        end = Some((score, v));
                    }
                }
                Steps::On(next) => {
                    for w in next {
                        let total = cost + self.price(v, w, origin, outward, across);
                        let is_better = match known.get(&w) {
                            None => true,
                            Some(&(least, _)) => total < least,
                        };
                        if is_better {
                            known.insert(w, (total, v));
                            open.push(Reverse((Ordered(total), w)));
                        }
                    }
                }
            }
        }
        end.map(|(_, v)| trace_back(&known, junction, v))
    }

    /// What the edge from `v` to `w` costs.
    fn price(&self, v: u32, w: u32, origin: Vec3, outward: Vec3, across: Vec3) -> f64 {
        let step = self.position(w) - self.position(v);
        let offset = self.position(w) - origin;
        let outside = offset.dot(&outward).max(0.0);
        let off = offset.dot(&across).hypot(outside) / self.cell(w);
        let inward = (-self.normal(w).dot(&outward)).max(0.0);
        let runs_down = step.dot(&self.stream) > FOLLOW_COSINE * step.norm();
        let factor = if runs_down { 1.0 } else { ACROSS_PRICE };
        factor * step.norm() * (1.0 + off * off + FAR_SIDE * inward * inward)
    }

    fn position(&self, vertex: u32) -> Vec3 {
        self.vertices[vertex as usize]
    }

    fn steps(&self, v: u32) -> Steps {
        if self.barrier.contains(&v) {
            return Steps::End;
        }
        let here = self.position(v);
        let cosine = |w: u32| {
            let step = self.position(w) - here;
            step.dot(&self.stream) / step.norm()
        };
        let neighbours = self.adjacency.neighbours(v);
        let mut on = neighbours.iter().filter(|&&w| cosine(w) > FOLLOW_COSINE);
        if on.clone().next().is_none() {
            return Steps::End;
        }
        if on.all(|w| self.own.contains(w)) {
            return Steps::DeadEnd;
        }
        let is_open = |w: &u32| cosine(*w) > ACROSS_COSINE && !self.own.contains(w);
        Steps::On(neighbours.into_iter().filter(is_open).collect())
    }

    /// Mean normal of the triangles at a vertex, by area.
    fn normal(&self, v: u32) -> Vec3 {
        let sum: Vec3 = self
            .adjacency
            .triangles_of(v)
            .iter()
            .map(|&t| {
                let [a, b, c] = self.adjacency.corners(t).map(|w| self.position(w));
                (b - a).cross(&(c - a))
            })
            .sum();
        sum.try_normalize(0.0).unwrap_or_default()
    }

    /// Mean length of the edges at a vertex.
    fn cell(&self, v: u32) -> f64 {
        mean_edge(self.vertices, self.adjacency, v)
    }
}

/// Mean length of the edges at a vertex.
pub(crate) fn mean_edge(vertices: &[Vec3], adjacency: &Adjacency<'_>, v: u32) -> f64 {
    let neighbours = adjacency.neighbours(v);
    let sum: f64 = neighbours
        .iter()
        .map(|&w| (vertices[w as usize] - vertices[v as usize]).norm())
        .sum();
    sum / neighbours.len() as f64
}

/// The line to `end` from the vertices before each.
pub(crate) fn trace_back(known: &Known, start: u32, end: u32) -> Vec<u32> {
    let mut line = vec![end];
    let mut current = end;
    while current != start {
        current = known[&current].1;
        line.push(current);
    }
    line.reverse();
    line
}

/// Where a line can go from a vertex.
enum Steps {
    On(Vec<u32>),
    End,
    /// Only back to its own trailing edge.
    DeadEnd,
}

/// A number in its total order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ordered(pub(crate) f64);

impl PartialEq for Ordered {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Ordered {}
impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}
