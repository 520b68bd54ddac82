//! Lines along which a wake's inner edge lies on a body.
//!
//! Where a trailing edge ends on a body, the jump of its last vertex is carried along
//! the body: a line of mesh edges is followed downstream from the junction to the tail,
//! and its vertices divide the body's triangles into an upper and a lower side. Lines of
//! two trailing edges (port and starboard wing) meet at the tail; where they end apart,
//! at a blunt base, a shortest line of mesh edges joins them.

use crate::adjacency::{Adjacency, undirected};
use crate::error::BemError;
use fladder_mesh::{TrailingEdge, Vec3};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap, HashSet};

/// Cosine between the stream and the nearest direction on the surface, above which a
/// trailing edge's end is a junction: the surface goes on downstream there. At a free
/// tip it turns back; half-way is 45°.
const JUNCTION_COSINE: f64 = 0.82;

/// Smallest cosine between stream and mesh edge with which a line is followed on.
const FOLLOW_COSINE: f64 = 0.05;

/// Which end of a trailing edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct ChainEnd {
    pub(crate) chain: usize,
    /// Whether it is the last vertex of the chain rather than the first.
    pub(crate) last: bool,
}

/// The line from one junction down the body.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BodyPath {
    pub(crate) end: ChainEnd,
    /// Mesh vertices from the junction on.
    pub(crate) vertices: Vec<u32>,
}

/// Two lines that meet, or one alone.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BodyCut {
    /// Line whose trailing edge comes before it in the sheet's direction (index of the
    /// path), if any, and the line whose trailing edge goes on from it.
    pub(crate) before: Option<usize>,
    pub(crate) after: Option<usize>,
    /// Mesh vertices from the end of `before` to the end of `after`; one vertex where
    /// they meet, none for a line alone.
    pub(crate) bridge: Vec<u32>,
}

/// All lines on bodies.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct BodyPaths {
    pub(crate) paths: Vec<BodyPath>,
    pub(crate) cuts: Vec<BodyCut>,
}

/// What is needed to follow lines over the surface.
pub(crate) struct Tracer<'a> {
    pub(crate) vertices: &'a [Vec3],
    pub(crate) adjacency: &'a Adjacency<'a>,
    pub(crate) chains: &'a [TrailingEdge],
    pub(crate) downstream: Vec3,
    /// Edges of named body lines; they take the place of tracing where they start at a
    /// junction.
    pub(crate) named: &'a [[u32; 2]],
}

impl Tracer<'_> {
    /// Finds the junctions and the lines from them.
    pub(crate) fn trace(&self) -> Result<BodyPaths, BemError> {
        let trailing: HashSet<(u32, u32)> = self.trailing_edges().collect();
        let trailing_vertices: HashSet<u32> = self
            .chains
            .iter()
            .flat_map(|c| c.vertices.iter().copied())
            .collect();
        let named = self.named_neighbours();
        let mut paths = Vec::new();
        for (chain, edge) in self.chains.iter().enumerate() {
            if edge.closed {
                continue;
            }
            for last in [false, true] {
                let junction = end_vertex(edge, last);
                let start_named = named.contains_key(&junction);
                if !start_named && !self.surface_goes_on(junction, &trailing) {
                    continue;
                }
                let vertices = if start_named {
                    self.follow_named(junction, &named)?
                } else {
                    self.follow(junction, &trailing, &trailing_vertices)?
                };
                paths.push(BodyPath {
                    end: ChainEnd { chain, last },
                    vertices,
                });
            }
        }
        Ok(self.join(paths, &trailing))
    }

    fn trailing_edges(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.chains.iter().flat_map(|c| {
            let n = c.vertices.len();
            let edges = if c.closed { n } else { n.saturating_sub(1) };
            (0..edges).map(move |i| undirected(c.vertices[i], c.vertices[(i + 1) % n]))
        })
    }

    /// Whether some direction on the surface at `vertex`, off the trailing edge itself,
    /// lies close to the stream.
    fn surface_goes_on(&self, vertex: u32, trailing: &HashSet<(u32, u32)>) -> bool {
        let origin = self.vertices[vertex as usize];
        let mut best = -1.0_f64;
        for &t in self.adjacency.triangles_of(vertex) {
            let Some([a, b]) = self.opposite(t, vertex) else {
                continue;
            };
            let ends = [a, b].map(|v| (self.vertices[v as usize] - origin).normalize());
            for (v, end) in [a, b].into_iter().zip(&ends) {
                if !trailing.contains(&undirected(vertex, v)) {
                    best = best.max(end.dot(&self.downstream));
                }
            }
            best = best.max(inner_cosine(&ends, &self.downstream));
        }
        best > JUNCTION_COSINE
    }

    fn opposite(&self, triangle: u32, vertex: u32) -> Option<[u32; 2]> {
        let neighbours = self.adjacency.corners(triangle);
        let i = neighbours.iter().position(|&v| v == vertex)?;
        Some([neighbours[(i + 1) % 3], neighbours[(i + 2) % 3]])
    }

    /// The next mesh edge with the largest cosine to the stream, until none goes
    /// downstream.
    fn follow(
        &self,
        junction: u32,
        trailing: &HashSet<(u32, u32)>,
        trailing_vertices: &HashSet<u32>,
    ) -> Result<Vec<u32>, BemError> {
        let mut line = vec![junction];
        let mut current = junction;
        loop {
            let origin = self.vertices[current as usize];
            let best = self
                .adjacency
                .neighbours(current)
                .into_iter()
                .filter(|&v| !trailing.contains(&undirected(current, v)))
                .map(|v| {
                    let step = self.vertices[v as usize] - origin;
                    (v, step.normalize().dot(&self.downstream))
                })
                .max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
            match best {
                Some((next, cosine)) if cosine > FOLLOW_COSINE => {
                    if trailing_vertices.contains(&next) {
                        return Err(BemError::PathMeetsTrailingEdge {
                            junction,
                            vertex: next,
                        });
                    }
                    line.push(next);
                    current = next;
                }
                _ => break,
            }
        }
        if line.len() < 2 {
            return Err(BemError::PathNotFound { junction });
        }
        Ok(line)
    }

    fn named_neighbours(&self) -> HashMap<u32, Vec<u32>> {
        let mut map: HashMap<u32, Vec<u32>> = HashMap::new();
        for &[a, b] in self.named {
            map.entry(a).or_default().push(b);
            map.entry(b).or_default().push(a);
        }
        map
    }

    /// A named line from the junction; where it forks, at the tail, it ends.
    fn follow_named(
        &self,
        junction: u32,
        named: &HashMap<u32, Vec<u32>>,
    ) -> Result<Vec<u32>, BemError> {
        let mut line = vec![junction];
        let mut current = junction;
        loop {
            let origin = self.vertices[current as usize];
            let next = named
                .get(&current)
                .into_iter()
                .flatten()
                .copied()
                .filter(|v| !line.contains(v))
                .map(|v| {
                    (
                        v,
                        (self.vertices[v as usize] - origin).dot(&self.downstream),
                    )
                })
                .max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
            match next {
                Some((v, advance)) if advance > 0.0 => {
                    line.push(v);
                    current = v;
                }
                // At the tail the line of the other side leads back upstream.
                Some(_) if line.len() > 1 => break,
                Some((v, _)) => {
                    return Err(BemError::PathNotDownstream {
                        junction,
                        vertex: v,
                    });
                }
                None => break,
            }
        }
        if line.len() < 2 {
            return Err(BemError::PathNotFound { junction });
        }
        Ok(line)
    }

    /// Pairs the line of a chain's last vertex with the nearest line of a chain's first
    /// vertex: the sheet then runs on in one direction with one upper side.
    fn join(&self, mut paths: Vec<BodyPath>, trailing: &HashSet<(u32, u32)>) -> BodyPaths {
        let mut pairs = Vec::new();
        for before in (0..paths.len()).filter(|&p| paths[p].end.last) {
            for after in (0..paths.len()).filter(|&p| !paths[p].end.last) {
                if let Some(meeting) = self.meet(&paths[before], &paths[after], trailing) {
                    pairs.push((before, after, meeting));
                }
            }
        }
        pairs.sort_by(|x, y| x.2.length.total_cmp(&y.2.length));
        let mut taken = vec![false; paths.len()];
        let mut cuts = Vec::new();
        for (before, after, meeting) in pairs {
            if taken[before] || taken[after] {
                continue;
            }
            taken[before] = true;
            taken[after] = true;
            paths[before].vertices.truncate(meeting.keep_before);
            paths[after].vertices.truncate(meeting.keep_after);
            cuts.push(BodyCut {
                before: Some(before),
                after: Some(after),
                bridge: meeting.bridge,
            });
        }
        for alone in (0..paths.len()).filter(|&p| !taken[p]) {
            let last = paths[alone].end.last;
            cuts.push(BodyCut {
                before: last.then_some(alone),
                after: (!last).then_some(alone),
                bridge: Vec::new(),
            });
        }
        BodyPaths { paths, cuts }
    }

    fn meet(
        &self,
        before: &BodyPath,
        after: &BodyPath,
        trailing: &HashSet<(u32, u32)>,
    ) -> Option<Meeting> {
        for (i, v) in before.vertices.iter().enumerate().skip(1) {
            if let Some(j) = after.vertices.iter().skip(1).position(|w| w == v) {
                return Some(Meeting {
                    keep_before: i + 1,
                    keep_after: j + 2,
                    bridge: vec![*v],
                    length: 0.0,
                });
            }
        }
        let from = *before.vertices.last()?;
        let to = *after.vertices.last()?;
        let (bridge, length) = self.shortest(from, to, trailing)?;
        Some(Meeting {
            keep_before: before.vertices.len(),
            keep_after: after.vertices.len(),
            bridge,
            length,
        })
    }

    /// Shortest line of mesh edges off the trailing edges (Dijkstra).
    fn shortest(
        &self,
        from: u32,
        to: u32,
        trailing: &HashSet<(u32, u32)>,
    ) -> Option<(Vec<u32>, f64)> {
        let mut best: HashMap<u32, (f64, u32)> = HashMap::from([(from, (0.0, from))]);
        let mut queue = BinaryHeap::from([(Reverse(OrderedLength(0.0)), Reverse(from))]);
        while let Some((Reverse(OrderedLength(length)), Reverse(v))) = queue.pop() {
            if v == to {
                let mut line = vec![to];
                let mut current = to;
                while current != from {
                    current = best.get(&current)?.1;
                    line.push(current);
                }
                line.reverse();
                return Some((line, length));
            }
            if length > best.get(&v)?.0 {
                continue;
            }
            for w in self.adjacency.neighbours(v) {
                if trailing.contains(&undirected(v, w)) {
                    continue;
                }
                let step = (self.vertices[w as usize] - self.vertices[v as usize]).norm();
                let total = length + step;
                if best.get(&w).is_none_or(|&(known, _)| total < known) {
                    best.insert(w, (total, v));
                    queue.push((Reverse(OrderedLength(total)), Reverse(w)));
                }
            }
        }
        None
    }
}

struct Meeting {
    keep_before: usize,
    keep_after: usize,
    bridge: Vec<u32>,
    length: f64,
}

#[derive(Clone, Copy, Debug)]
struct OrderedLength(f64);

impl PartialEq for OrderedLength {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for OrderedLength {}
impl PartialOrd for OrderedLength {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for OrderedLength {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// The vertex at one end of an open trailing edge.
pub(crate) fn end_vertex(chain: &TrailingEdge, last: bool) -> u32 {
    let index = if last { chain.vertices.len() - 1 } else { 0 };
    chain.vertices[index]
}

/// Cosine between `direction` and its projection on a triangle's sector, −1 where the
/// projection falls outside the sector.
fn inner_cosine(ends: &[Vec3; 2], direction: &Vec3) -> f64 {
    let normal = ends[0].cross(&ends[1]);
    let size = normal.norm();
    if size == 0.0 {
        return -1.0;
    }
    let normal = normal / size;
    let flat = direction - normal * normal.dot(direction);
    let inside =
        ends[0].cross(&flat).dot(&normal) > 0.0 && flat.cross(&ends[1]).dot(&normal) > 0.0;
    if inside { flat.norm() } else { -1.0 }
}
