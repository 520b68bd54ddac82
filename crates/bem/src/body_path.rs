//! Lines along which a wake's inner edge lies on a body.
//!
//! Where a trailing edge ends on a body, the jump of its last vertex is carried along
//! the body: a line of mesh edges is followed downstream from the junction, and its
//! vertices divide the body's triangles into an upper and a lower side. Each line carries
//! its own jump, and jumps of lines that share vertices or edges add. A line ends
//!
//! * at a vertex of another trailing edge, whose sheet takes the jump up;
//! * at a tail where others end too, or at a blunt base over which shortest lines of mesh
//!   edges join them in one vertex: a *node*;
//! * in the plane of symmetry of a half model, where its image ends too: a node as well;
//! * alone.

use crate::adjacency::{Adjacency, Turn, undirected};
use crate::body_node::gather_nodes;
use crate::body_trace::Downstream;
use crate::error::BemError;
use crate::image::Image;
use fladder_mesh::{TrailingEdge, Vec3};
use std::collections::{HashMap, HashSet};

/// Cosine between the stream and the nearest direction on the surface, above which a
/// trailing edge's end is a junction: the surface goes on downstream there. At a free
/// tip it turns back; half-way is 45°.
const JUNCTION_COSINE: f64 = 0.82;

/// Which end of a trailing edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct ChainEnd {
    pub(crate) chain: usize,
    /// Whether it is the last vertex of the chain rather than the first.
    pub(crate) last: bool,
}

/// How a body line ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Finish {
    /// At a vertex of another trailing edge.
    TrailingEdge,
    /// In a node, by its number.
    Node(usize),
    /// At a vertex of its own.
    Alone,
}

/// The line from one junction down the body.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BodyPath {
    pub(crate) end: ChainEnd,
    /// Mesh vertices from the junction on, to the node where the line ends in one.
    pub(crate) vertices: Vec<u32>,
    /// Index of the vertex up to which the line runs downstream; what follows crosses a
    /// base.
    pub(crate) whole: usize,
    pub(crate) finish: Finish,
}

impl BodyPath {
    /// The side of the line, going downstream, on which the trailing edge's upper side
    /// lies.
    pub(crate) fn upper(&self) -> Turn {
        if self.end.last {
            Turn::Left
        } else {
            Turn::Right
        }
    }

    /// The last vertex.
    pub(crate) fn last(&self) -> u32 {
        self.vertices[self.vertices.len() - 1]
    }
}

/// A vertex in which several lines end.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) vertex: u32,
    pub(crate) paths: Vec<usize>,
    /// For each of the paths, the jump with which its sheet leaves the node, as weights
    /// of the paths' own jumps.
    pub(crate) shares: Vec<Vec<(usize, f64)>>,
}

/// All lines on bodies.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct BodyPaths {
    pub(crate) paths: Vec<BodyPath>,
    pub(crate) nodes: Vec<Node>,
}

impl BodyPaths {
    /// The line from an end of a chain.
    pub(crate) fn of_end(&self, chain: usize, last: bool) -> Option<usize> {
        self.paths
            .iter()
            .position(|p| p.end == ChainEnd { chain, last })
    }

    /// Jump at vertex number `index` of a line, as weights of the lines' jumps: whole
    /// down to the tail, then linear in length to the node's share.
    pub(crate) fn jump_at(
        &self,
        path: usize,
        index: usize,
        vertices: &[Vec3],
    ) -> Vec<(usize, f64)> {
        let line = &self.paths[path];
        let Finish::Node(node) = line.finish else {
            return vec![(path, 1.0)];
        };
        let length = |to: usize| -> f64 {
            (line.whole..to)
                .map(|i| {
                    let [a, b] = [i, i + 1].map(|j| vertices[line.vertices[j] as usize]);
                    (b - a).norm()
                })
                .sum()
        };
        let last = line.vertices.len() - 1;
        let share = if index == last {
            1.0
        } else if index <= line.whole {
            return vec![(path, 1.0)];
        } else {
            length(index) / length(last)
        };
        let node = &self.nodes[node];
        let place = node.paths.iter().position(|&p| p == path).unwrap_or(0);
        node.shares[place]
            .iter()
            .map(|&(k, weight)| {
                let own = if k == path { 1.0 - share } else { 0.0 };
                (k, own + share * weight)
            })
            .collect()
    }
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
    /// What the motion does under reflection, for half models.
    pub(crate) image: Image,
}

impl Tracer<'_> {
    /// Finds the junctions and the lines from them.
    pub(crate) fn trace(&self) -> Result<BodyPaths, BemError> {
        let trailing: HashSet<(u32, u32)> = self.trailing_edges().collect();
        let degree = edges_at(&trailing);
        let named = self.named_neighbours();
        let mut ends = Vec::new();
        for (chain, edge) in self.chains.iter().enumerate().filter(|(_, c)| !c.closed) {
            for last in [false, true] {
                let junction = end_vertex(edge, last);
                // Where several trailing edges meet, each sector has its own potential
                // and the sheets need no line.
                if degree[&junction] == 1
                    && (named.contains_key(&junction)
                        || self.surface_goes_on(junction, &trailing))
                {
                    ends.push((ChainEnd { chain, last }, junction));
                }
            }
        }
        let junctions: HashSet<u32> = ends.iter().map(|&(_, v)| v).collect();
        let barrier: HashSet<u32> = degree
            .keys()
            .copied()
            .filter(|v| !junctions.contains(v))
            .collect();
        let mut paths = Vec::new();
        for (end, junction) in ends {
            let vertices = if named.contains_key(&junction) {
                self.follow_named(junction, &named, &barrier)?
            } else {
                self.follow(end, junction, &barrier)?
            };
            let meets = barrier.contains(&vertices[vertices.len() - 1]);
            paths.push(BodyPath {
                end,
                whole: vertices.len() - 1,
                vertices,
                finish: if meets {
                    Finish::TrailingEdge
                } else {
                    Finish::Alone
                },
            });
        }
        Ok(gather_nodes(self, paths, &trailing))
    }

    fn trailing_edges(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.chains
            .iter()
            .flat_map(|c| c.edges().map(|[a, b]| undirected(a, b)))
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

    /// The line that keeps closest to the plane of the wake at the junction.
    fn follow(
        &self,
        end: ChainEnd,
        junction: u32,
        barrier: &HashSet<u32>,
    ) -> Result<Vec<u32>, BemError> {
        let chain = &self.chains[end.chain].vertices;
        let n = chain.len();
        let beside = if end.last { chain[n - 2] } else { chain[1] };
        let search = Downstream {
            vertices: self.vertices,
            adjacency: self.adjacency,
            stream: self.downstream,
            own: chain,
            barrier,
        };
        search.line(junction, beside).ok_or_else(|| {
            let p = self.vertices[junction as usize];
            BemError::PathNotFound {
                junction,
                x: p.x,
                y: p.y,
                z: p.z,
            }
        })
    }

    fn named_neighbours(&self) -> HashMap<u32, Vec<u32>> {
        let mut map: HashMap<u32, Vec<u32>> = HashMap::new();
        for &[a, b] in self.named {
            map.entry(a).or_default().push(b);
            map.entry(b).or_default().push(a);
        }
        map
    }

    /// A named line from the junction; where it forks, at the tail, or meets a trailing
    /// edge, it ends.
    fn follow_named(
        &self,
        junction: u32,
        named: &HashMap<u32, Vec<u32>>,
        barrier: &HashSet<u32>,
    ) -> Result<Vec<u32>, BemError> {
        let mut line = vec![junction];
        let mut current = junction;
        while !barrier.contains(&current) {
            let origin = self.vertices[current as usize];
            let next = named
                .get(&current)
                .into_iter()
                .flatten()
                .copied()
                .filter(|v| !line.contains(v))
                .map(|v| {
                    let step = self.vertices[v as usize] - origin;
                    (v, step.dot(&self.downstream))
                })
                .max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
            match next {
                Some((v, advance)) if advance > 0.0 => {
                    line.push(v);
                    current = v;
                }
                // At the tail the line of the other side leads back upstream.
                Some(_) if line.len() > 1 => break,
                Some((vertex, _)) => {
                    return Err(BemError::PathNotDownstream { junction, vertex });
                }
                None => break,
            }
        }
        Ok(line)
    }
}

/// Number of trailing edges at each of their vertices.
fn edges_at(trailing: &HashSet<(u32, u32)>) -> HashMap<u32, usize> {
    let mut degree = HashMap::new();
    for &(a, b) in trailing {
        *degree.entry(a).or_insert(0) += 1;
        *degree.entry(b).or_insert(0) += 1;
    }
    degree
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
