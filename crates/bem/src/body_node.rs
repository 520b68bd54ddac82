//! Nodes: vertices in which several body lines end.
//!
//! Behind a node the sheets of its lines hang together in one streamline, so that their
//! jumps, counted one way round, sum to zero. The jumps that arrive, j_i = o_i κ_i e^{−sξ},
//! do so by themselves only in symmetric flow; they leave as the nearest that do,
//!
//! $$ \tilde\jmath_i = j_i - \tfrac1n \textstyle\sum_k j_k , $$
//!
//! for the lines of a port and a starboard wing the mean of both jumps. Lines that end
//! apart on one base are led over it, along shortest lines of mesh edges, to the vertex with
//! the least sum of squares of their lengths.

use crate::adjacency::Turn;
use crate::body_path::{BodyPath, BodyPaths, Finish, Node, Tracer};
use crate::body_trace::{Ordered, mean_edge, trace_back};
use crate::image::{Image, on_plane};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap, HashMap, HashSet};

/// Joins the lines that end alone where others end near.
pub(crate) fn gather_nodes(
    tracer: &Tracer<'_>,
    paths: Vec<BodyPath>,
    trailing: &HashSet<(u32, u32)>,
) -> BodyPaths {
    let mut all = BodyPaths {
        paths,
        nodes: Vec::new(),
    };
    let trailing: HashSet<u32> = trailing.iter().flat_map(|&(a, b)| [a, b]).collect();
    let alone: Vec<usize> = (0..all.paths.len())
        .filter(|&p| all.paths[p].finish == Finish::Alone)
        .collect();
    if tracer.image != Image::None {
        add_plane_nodes(tracer, &mut all, &alone, &trailing);
        return all;
    }
    for group in groups(tracer, &all.paths, &alone, &trailing) {
        if group.len() > 1 {
            add_node(tracer, &mut all, group, &trailing);
        }
    }
    all
}

/// Sets of lines whose ends hang together downstream of the foremost of them.
fn groups(
    tracer: &Tracer<'_>,
    paths: &[BodyPath],
    alone: &[usize],
    trailing: &HashSet<u32>,
) -> Vec<Vec<usize>> {
    let mut group_of: BTreeMap<usize, usize> = alone.iter().map(|&p| (p, p)).collect();
    for (i, &p) in alone.iter().enumerate() {
        for &q in &alone[i + 1..] {
            let (from, to) = (paths[p].last(), paths[q].last());
            let base = Base::new(tracer, &[from, to], trailing);
            if base.distances(from).contains_key(&to) {
                let (keep, drop) = (group_of[&p], group_of[&q]);
                for group in group_of.values_mut() {
                    if *group == drop {
                        *group = keep;
                    }
                }
            }
        }
    }
    let mut sets: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (path, group) in group_of {
        sets.entry(group).or_default().push(path);
    }
    sets.into_values().collect()
}

/// The part of the surface on which lines may be led to a node.
struct Base<'a> {
    tracer: &'a Tracer<'a>,
    /// Vertices of trailing edges.
    trailing: &'a HashSet<u32>,
    /// Distance downstream from which on it reaches.
    front: f64,
    ends: Vec<u32>,
}

impl<'a> Base<'a> {
    fn new(tracer: &'a Tracer<'a>, ends: &[u32], trailing: &'a HashSet<u32>) -> Self {
        let front = ends
            .iter()
            .map(|&v| {
                // A rim is not even: one cell of play.
                tracer.vertices[v as usize].dot(&tracer.downstream)
                    - mean_edge(tracer.vertices, tracer.adjacency, v)
            })
            .fold(f64::INFINITY, f64::min);
        Self {
            tracer,
            trailing,
            front,
            ends: ends.to_vec(),
        }
    }

    /// Off trailing edges and the cells beside them, which a line must not run along.
    fn holds(&self, v: u32) -> bool {
        let beside = || {
            self.tracer
                .adjacency
                .neighbours(v)
                .iter()
                .any(|w| self.trailing.contains(w))
        };
        self.ends.contains(&v)
            || (self.tracer.vertices[v as usize].dot(&self.tracer.downstream) >= self.front
                && !self.trailing.contains(&v)
                && !beside())
    }

    /// Length of the shortest line of edges to every vertex within reach, and the vertex
    /// before it (Dijkstra).
    fn distances(&self, from: u32) -> HashMap<u32, (f64, u32)> {
        let mut known = HashMap::from([(from, (0.0, from))]);
        let mut queue = BinaryHeap::from([Reverse((Ordered(0.0), from))]);
        while let Some(Reverse((Ordered(length), v))) = queue.pop() {
            if length > known[&v].0 {
                continue;
            }
            for w in self.tracer.adjacency.neighbours(v) {
                if !self.holds(w) {
                    continue;
                }
                let [a, b] = [v, w].map(|x| self.tracer.vertices[x as usize]);
                let total = length + (b - a).norm();
                let is_better = match known.get(&w) {
                    None => true,
                    Some(&(least, _)) => total < least,
                };
                if is_better {
                    known.insert(w, (total, v));
                    queue.push(Reverse((Ordered(total), w)));
                }
            }
        }
        known
    }
}

fn add_node(
    tracer: &Tracer<'_>,
    all: &mut BodyPaths,
    group: Vec<usize>,
    trailing: &HashSet<u32>,
) {
    let ends: Vec<u32> = group.iter().map(|&p| all.paths[p].last()).collect();
    let base = Base::new(tracer, &ends, trailing);
    let reach: Vec<HashMap<u32, (f64, u32)>> =
        ends.iter().map(|&v| base.distances(v)).collect();
    let mut candidates: Vec<u32> = reach[0].keys().copied().collect();
    candidates.sort_unstable();
    let spread = |v: u32| -> Option<f64> {
        reach
            .iter()
            .map(|known| known.get(&v).map(|(length, _)| length * length))
            .sum()
    };
    let best = candidates
        .into_iter()
        .filter_map(|v| spread(v).map(|sum| (sum, v)))
        .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let Some((_, vertex)) = best else {
        return;
    };
    for (&p, known) in group.iter().zip(&reach) {
        let start = all.paths[p].last();
        extend(&mut all.paths[p], &trace_back(known, start, vertex));
        all.paths[p].finish = Finish::Node(all.nodes.len());
    }
    let shares = shares(&all.paths, &group, 2);
    all.nodes.push(Node {
        vertex,
        paths: group,
        shares,
    });
}

/// Nodes of a half model: lines end in its plane, led there over a base by the shortest
/// line of mesh edges, and their images come from the other side. Of symmetric motion the
/// jumps of a line and its image sum to zero by themselves and leave as they are; of
/// antisymmetric motion the mean is that of the half's lines alone, all of it for one line.
fn add_plane_nodes(
    tracer: &Tracer<'_>,
    all: &mut BodyPaths,
    alone: &[usize],
    trailing: &HashSet<u32>,
) {
    let is_in_plane = |v: u32| on_plane(&tracer.vertices[v as usize]);
    let mut groups: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for &p in alone {
        let end = all.paths[p].last();
        if !is_in_plane(end) {
            let known = Base::new(tracer, &[end], trailing).distances(end);
            let nearest = known
                .iter()
                .filter(|(v, _)| is_in_plane(**v))
                .map(|(&v, &(length, _))| (length, v))
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let Some((_, vertex)) = nearest else {
                continue;
            };
            extend(&mut all.paths[p], &trace_back(&known, end, vertex));
        }
        groups.entry(all.paths[p].last()).or_default().push(p);
    }
    for (vertex, group) in groups {
        let shares = match tracer.image {
            Image::Odd => shares(&all.paths, &group, 1),
            Image::None | Image::Even => group.iter().map(|&p| vec![(p, 1.0)]).collect(),
        };
        for &p in &group {
            all.paths[p].finish = Finish::Node(all.nodes.len());
        }
        all.nodes.push(Node {
            vertex,
            paths: group,
            shares,
        });
    }
}

/// Leads a line on, without loops.
fn extend(path: &mut BodyPath, further: &[u32]) {
    let mut first = 1;
    for (i, v) in further.iter().enumerate().skip(1) {
        if let Some(at) = path.vertices.iter().position(|w| w == v) {
            path.vertices.truncate(at + 1);
            first = i + 1;
        }
    }
    path.whole = path.vertices.len() - 1;
    path.vertices.extend(&further[first..]);
}

/// ȷ̃ of each line in terms of all. Lines that arrive along one edge act as one; the first
/// of them takes the difference; fewer edges than `least` leave as they arrive.
fn shares(paths: &[BodyPath], group: &[usize], least: usize) -> Vec<Vec<(usize, f64)>> {
    let edge = |p: usize| paths[p].vertices[paths[p].vertices.len() - 2];
    let mut edges: Vec<u32> = group.iter().map(|&p| edge(p)).collect();
    edges.sort_unstable();
    edges.dedup();
    let n = edges.len() as f64;
    group
        .iter()
        .enumerate()
        .map(|(i, &p)| {
            let is_first = group[..i].iter().all(|&q| edge(q) != edge(p));
            group
                .iter()
                .filter_map(|&k| {
                    let own = if k == p { 1.0 } else { 0.0 };
                    let mean = if is_first && edges.len() >= least {
                        sign(&paths[p]) * sign(&paths[k]) / n
                    } else {
                        0.0
                    };
                    (own != mean).then_some((k, own - mean))
                })
                .collect()
        })
        .collect()
}

/// o: the jump met at a line's last edge, going counter-clockwise round its last vertex,
/// is o κ. Left of a line that arrives lies clockwise of it.
pub(crate) fn sign(path: &BodyPath) -> f64 {
    match path.upper() {
        Turn::Left => -1.0,
        Turn::Right => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body_path::ChainEnd;

    fn line(chain: usize, last: bool, before: u32) -> BodyPath {
        BodyPath {
            end: ChainEnd { chain, last },
            vertices: vec![100 + before, before, 0],
            whole: 2,
            finish: Finish::Alone,
        }
    }

    /// Port (its chain's last vertex on the body), fin and starboard: whatever arrives, what
    /// leaves sums to zero the one way round, and what does already is left alone.
    #[test]
    fn what_leaves_a_node_sums_to_zero() {
        let paths = [line(0, true, 1), line(1, false, 2), line(2, true, 3)];
        let shares = shares(&paths, &[0, 1, 2], 2);
        let leaving = |kappa: [f64; 3]| -> Vec<f64> {
            shares
                .iter()
                .map(|s| s.iter().map(|&(k, w)| w * kappa[k]).sum())
                .collect()
        };
        let sum: f64 = leaving([0.3, -0.7, 1.1])
            .iter()
            .zip(&paths)
            .map(|(j, p)| sign(p) * j)
            .sum();
        assert!(sum.abs() < 1e-15, "{sum}");
        for (a, b) in leaving([0.5, 0.5, 0.0]).iter().zip([0.5, 0.5, 0.0]) {
            assert!((a - b).abs() < 1e-15);
        }
        // Two lines: the mean of both.
        let pair = super::shares(&paths[..2], &[0, 1], 2);
        assert_eq!(pair, [[(0, 0.5), (1, 0.5)], [(0, 0.5), (1, 0.5)]]);
    }
}
