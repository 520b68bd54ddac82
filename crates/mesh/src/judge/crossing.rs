//! Triangles that cross others, found through a tree of boxes.

use super::fault::counted;
use super::predicates::triangles_cross;
use super::{Code, Element, Fault, Surface};
use crate::Vec3;

/// Pairs after which the search ends: a mesh with so many is beyond repair by
/// hand, and the number of pairs can grow with the square of the triangles.
const MAX_PAIRS: usize = 10_000;

/// Triangles in a leaf of the tree.
const LEAF: usize = 4;

/// Raises `self_crossing`, also where a half model on y ≥ 0 reaches its mirror
/// image.
pub(super) fn check(surface: &Surface, is_half: bool, faults: &mut Vec<Fault>) {
    let mut pairs = Tree::new(surface).crossing_pairs(surface);
    pairs.sort_unstable();
    let across = if is_half {
        across_symmetry_plane(surface)
    } else {
        Vec::new()
    };
    if pairs.is_empty() && across.is_empty() {
        return;
    }
    let number = |t: u32| surface.triangle[t as usize];
    let own = pairs
        .iter()
        .map(|pair| Element::TrianglePair(pair.map(number)));
    let mirrored = across.iter().map(|&t| Element::Triangle(number(t)));
    let elements: Vec<Element> = own.chain(mirrored).collect();
    let mut what = Vec::new();
    if !pairs.is_empty() {
        let at_least = if pairs.len() == MAX_PAIRS {
            "at least "
        } else {
            ""
        };
        let pairs = counted(
            pairs.len(),
            "pair of crossing triangles",
            "pairs of crossing triangles",
        );
        what.push(format!("{at_least}{pairs}"));
    }
    if !across.is_empty() {
        let triangles = counted(across.len(), "triangle", "triangles");
        what.push(format!(
            "{triangles} of the half model in or beyond its symmetry plane y = 0"
        ));
    }
    let what = what.join(" and ");
    let remedy = if pairs.is_empty() {
        "cut the surface at y = 0 and leave it open there, without a wall in the plane"
    } else {
        "unite the parts in the mesh generator, so that no triangle is inside the body"
    };
    let why = "a surface through another has no inside";
    let fault = Fault::new(Code::SelfCrossing, what, why, remedy);
    let place = |k: usize| {
        pairs
            .get(k)
            .map_or_else(|| across[k - pairs.len()], |pair| pair[0])
    };
    faults.push(fault.at(elements, |k| Some(surface.centroid(place(k) as usize))));
}

fn across_symmetry_plane(surface: &Surface) -> Vec<u32> {
    let is_across = |&t: &u32| {
        let corners = surface.mesh.triangles[t as usize];
        let is_beyond = corners
            .iter()
            .any(|&v| surface.mesh.vertices[v as usize].y < -surface.tolerance);
        is_beyond || corners.iter().all(|&v| surface.is_in_symmetry_plane(v))
    };
    (0..surface.mesh.triangles.len() as u32)
        .filter(is_across)
        .collect()
}

/// An axis-parallel box.
#[derive(Clone, Copy)]
struct Bounds {
    low: Vec3,
    high: Vec3,
}

impl Bounds {
    fn join(self, other: Self) -> Self {
        Self {
            low: self.low.inf(&other.low),
            high: self.high.sup(&other.high),
        }
    }

    fn meets(&self, other: &Self) -> bool {
        (0..3).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }
}

/// A node: its box, and its two children or its range of triangles.
struct Node {
    bounds: Bounds,
    content: Content,
}

enum Content {
    Children([usize; 2]),
    Triangles(std::ops::Range<usize>),
}

/// A binary tree of boxes, split at the median along the longest side.
struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
    boxes: Vec<Bounds>,
}

impl Tree {
    fn new(surface: &Surface) -> Self {
        let n = surface.mesh.triangles.len();
        let boxes = (0..n)
            .map(|t| {
                let [a, b, c] = surface.mesh.corners(t);
                Bounds {
                    low: a.inf(&b).inf(&c),
                    high: a.sup(&b).sup(&c),
                }
            })
            .collect();
        let order = (0..n as u32)
            .filter(|&t| surface.is_finite[t as usize])
            .collect();
        let mut tree = Self {
            nodes: Vec::new(),
            order,
            boxes,
        };
        if !tree.order.is_empty() {
            tree.build(0..tree.order.len());
        }
        tree
    }

    /// Adds the node of a range and all below it; returns its number.
    fn build(&mut self, range: std::ops::Range<usize>) -> usize {
        let members = &self.order[range.clone()];
        let bounds = members
            .iter()
            .map(|&t| self.boxes[t as usize])
            .reduce(Bounds::join)
            .expect("ranges are never empty");
        let number = self.nodes.len();
        self.nodes.push(Node {
            bounds,
            content: Content::Triangles(range.clone()),
        });
        if range.len() > LEAF {
            let axis = (bounds.high - bounds.low).imax();
            let middle = range.start + range.len() / 2;
            let centre =
                |t: u32| self.boxes[t as usize].low[axis] + self.boxes[t as usize].high[axis];
            self.order[range.clone()].select_nth_unstable_by(range.len() / 2, |&s, &t| {
                centre(s).total_cmp(&centre(t)).then(s.cmp(&t))
            });
            let children = [
                self.build(range.start..middle),
                self.build(middle..range.end),
            ];
            self.nodes[number].content = Content::Children(children);
        }
        number
    }

    /// Pairs that cross and share no vertex, lower number first.
    fn crossing_pairs(&self, surface: &Surface) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        let mut open = if self.nodes.is_empty() {
            Vec::new()
        } else {
            vec![(0, 0)]
        };
        while let Some((a, b)) = open.pop() {
            let (first, second) = (&self.nodes[a], &self.nodes[b]);
            if !first.bounds.meets(&second.bounds) {
                continue;
            }
            match (&first.content, &second.content) {
                (&Content::Children([left, right]), _) if a == b => {
                    open.extend([(left, left), (left, right), (right, right)]);
                }
                (&Content::Children([left, right]), _) => open.extend([(left, b), (right, b)]),
                (_, &Content::Children([left, right])) => open.extend([(a, left), (a, right)]),
                (Content::Triangles(of_first), Content::Triangles(of_second)) => {
                    for i in of_first.clone() {
                        let from = if a == b { i + 1 } else { of_second.start };
                        for j in from..of_second.end {
                            let pair = [self.order[i], self.order[j]];
                            if self.cross(surface, pair) {
                                pairs.push([pair[0].min(pair[1]), pair[0].max(pair[1])]);
                            }
                        }
                    }
                    if pairs.len() >= MAX_PAIRS {
                        pairs.truncate(MAX_PAIRS);
                        return pairs;
                    }
                }
            }
        }
        pairs
    }

    fn cross(&self, surface: &Surface, [s, t]: [u32; 2]) -> bool {
        let (first, second) = (
            surface.mesh.triangles[s as usize],
            surface.mesh.triangles[t as usize],
        );
        self.boxes[s as usize].meets(&self.boxes[t as usize])
            && !first.iter().any(|v| second.contains(v))
            && triangles_cross(
                surface.mesh.corners(s as usize),
                surface.mesh.corners(t as usize),
            )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TriMesh;
    use crate::judge::Settings;
    use crate::judge::elements::welded_surface;
    use crate::shapes::icosphere;

    /// The tree finds what looking at every pair finds.
    #[test]
    fn the_tree_misses_no_pair() {
        let mut mesh = icosphere(5);
        let n = mesh.vertices.len() as u32;
        let second = icosphere(4);
        mesh.vertices.extend(
            second
                .vertices
                .iter()
                .map(|p| 0.9 * p + Vec3::new(0.7, 0.11, 0.05)),
        );
        mesh.triangles
            .extend(second.triangles.iter().map(|t| t.map(|v| v + n)));
        let mesh = TriMesh {
            surfaces: Vec::new(),
            ..mesh
        };
        let surface = welded_surface(&mesh, Settings::default(), &mut Vec::new());
        let tree = Tree::new(&surface);
        let mut found = tree.crossing_pairs(&surface);
        found.sort_unstable();
        let n_triangles = mesh.triangles.len() as u32;
        let all = (0..n_triangles).flat_map(|s| (s + 1..n_triangles).map(move |t| [s, t]));
        let expected: Vec<[u32; 2]> = all.filter(|&pair| tree.cross(&surface, pair)).collect();
        assert!(expected.len() > 20);
        assert_eq!(found, expected);
    }
}
