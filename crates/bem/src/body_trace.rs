//! The line of mesh edges down a body that stays closest to the plane of a wake.
//!
//! Through the junction runs the plane of the stream and of the trailing edge. Of all lines
//! whose every edge runs downstream, the one is taken with the least
//!
//! $$ \sum L\,\big(1 + (d/\ell)^2\big) - \Gamma\,\mathbf u\cdot\Delta\mathbf x , $$
//!
//! L the edge's length, d its end's distance from the plane (and, outboard of the junction,
//! from the junction), ℓ the mean length of the edges at that end. On a mesh whose edges
//! follow the plane it is that row of edges; on any other it stays within a cell of the
//! plane where the body does. It ends where no edge runs downstream, or on a trailing edge;
//! Γ decides between several ends: a line goes on rather than end on a bump or a fin as
//! long as that leads it less than √Γ cells off.

use crate::adjacency::Adjacency;
use fladder_mesh::Vec3;
use std::collections::{BTreeSet, HashMap, HashSet};

/// Smallest cosine between stream and mesh edge with which a line is followed on: above
/// the slope of a base that is cut square, at the incidences of linear theory.
const FOLLOW_COSINE: f64 = 0.2;

/// Γ: gain per length of advance.
const ADVANCE: f64 = 10.0;

/// Search over the edges that run downstream.
pub(crate) struct Downstream<'a> {
    pub(crate) vertices: &'a [Vec3],
    pub(crate) adjacency: &'a Adjacency<'a>,
    pub(crate) downstream: Vec3,
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
        let outward = outward - self.downstream * outward.dot(&self.downstream);
        let outward = outward.try_normalize(0.0)?;
        let across = self.downstream.cross(&outward);
        // Every edge advances, so that in the order of distance each vertex is final when
        // its turn comes.
        let mut known: Known = HashMap::from([(junction, (0.0, junction))]);
        let mut open = BTreeSet::from([(Ordered(0.0), junction)]);
        let mut end: Option<(f64, u32)> = None;
        while let Some((Ordered(_), v)) = open.pop_first() {
            let cost = known[&v].0;
            match self.steps(v) {
                Steps::DeadEnd => {}
                Steps::End if v == junction => {}
                Steps::End => {
                    if end.is_none_or(|(least, _)| cost < least) {
                        end = Some((cost, v));
                    }
                }
                Steps::On(next) => {
                    for w in next {
                        let step = self.position(w) - self.position(v);
                        let offset = self.position(w) - origin;
                        let outside = offset.dot(&outward).max(0.0);
                        let off = offset.dot(&across).hypot(outside) / self.cell(w);
                        let total = cost + step.norm() * (1.0 + off * off)
                            - ADVANCE * step.dot(&self.downstream);
                        let is_better = match known.get(&w) {
                            None => true,
                            Some(&(least, _)) => total < least,
                        };
                        if is_better {
                            known.insert(w, (total, v));
                            open.insert((Ordered(offset.dot(&self.downstream)), w));
                        }
                    }
                }
            }
        }
        end.map(|(_, v)| trace_back(&known, junction, v))
    }

    fn position(&self, vertex: u32) -> Vec3 {
        self.vertices[vertex as usize]
    }

    fn steps(&self, v: u32) -> Steps {
        if self.barrier.contains(&v) {
            return Steps::End;
        }
        let here = self.position(v);
        let next: Vec<u32> = self
            .adjacency
            .neighbours(v)
            .into_iter()
            .filter(|&w| {
                let step = self.position(w) - here;
                step.dot(&self.downstream) > FOLLOW_COSINE * step.norm()
            })
            .collect();
        if next.is_empty() {
            return Steps::End;
        }
        let free: Vec<u32> = next.into_iter().filter(|w| !self.own.contains(w)).collect();
        if free.is_empty() {
            Steps::DeadEnd
        } else {
            Steps::On(free)
        }
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
