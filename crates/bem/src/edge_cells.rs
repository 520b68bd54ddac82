//! The potential in the cells along trailing edges.
//!
//! Towards a trailing edge the jump approaches its value there with the power 3/2 of the
//! distance d. A potential that is linear over the last cell, of length h, acts as if the
//! section ended behind its edge: thin sections have 0.42 h/c too much lift and a flap of
//! four cells a third too much hinge moment. So edges of triangles that leave the trailing
//! edge are divided in their middle, where the potential is that of the power law,
//!
//! $$ \varphi = \varphi_e + \frac{d}{2}\sigma s\kappa
//!    + 2^{-3/2}\left(\varphi_w - \varphi_e - d\,\sigma s\kappa\right), $$
//!
//! w the far end, e where the stream through w meets the trailing edge, d the distance from
//! it and σ = ±½ above and below: with the slope s κ of the oscillating wake the jump begins.
//! Against what is linear over the cells this is a hat function of height
//! (½ − 2^{−3/2}) (φ_e − φ_w + d σ s κ). Its influence goes to the columns of e and w and, by
//! s, to that of κ; no unknowns come with it, and test functions stay as they are. Halves of
//! edges, because test triangles near a panel are divided there ([`crate::near_field`]).

use crate::cut::{CutSurface, Jump};
use crate::image::on_plane;
use crate::near_field::point_values;
use crate::ordering::spatial_order;
use crate::panel_block::{BLOCK, PanelBlock};
use fladder_mesh::{TrailingEdge, Vec3};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Height of a hat function by the deviation over the whole edge: ½ − 2^{−3/2}.
const HEIGHT: f64 = 0.5 * (1.0 - std::f64::consts::FRAC_1_SQRT_2);

/// Barycentric coordinate of a point that rounding has put outside.
const ON_EDGE: f64 = 1e-12;

/// How much farther from its middle the stream may pass the next edge, in its lengths, to
/// pass between the two.
const BETWEEN: f64 = 1e-6;

/// Distance from an edge's middle, in its lengths, within which its line is gone on along.
const BESIDE: f64 = 1.5;

/// Largest ratio of distances over which the power law is gone on along.
const ALIKE: f64 = 2.0;

/// Cosine of the angle between normals up to which triangles belong to the same side.
const SAME_SIDE: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// An edge that leaves the trailing edge.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DividedEdge {
    /// Its vertex on the trailing edge and the other one.
    pub(crate) ends: [u32; 2],
    /// Height of its hat function by 1 − 2^{−1/2} over 2: vertices with weights.
    pub(crate) height: Vec<(u32, f64)>,
    /// The same by s: columns of jumps with weights.
    pub(crate) slope: Jump,
}

/// A hat function and its values at the three points of a triangle.
type HatValues = (u32, [f64; 3]);

/// Divided edges of a cut surface and what belongs to them.
#[derive(Clone, Debug, Default)]
pub(crate) struct EdgeCells {
    /// Vertices of the surface and columns of jumps. The slope of a jump has the number
    /// that follows the vertices by its column, the hat function of a divided edge the one
    /// that follows those by its place.
    n_vertices: u32,
    n_columns: u32,
    divided: Vec<DividedEdge>,
    /// Values of the hat functions in each triangle in parts.
    inside: HashMap<u32, Vec<HatValues>>,
}

/// Two vertices, the smaller first.
type Edge = (u32, u32);

fn edge(a: u32, b: u32) -> Edge {
    (a.min(b), a.max(b))
}

fn sides_of([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

impl EdgeCells {
    /// Of the surface's divided edges; adds blocks of the parts of triangles, whose corners'
    /// columns are hat functions.
    pub(crate) fn new(surface: &CutSurface, blocks: &mut Vec<PanelBlock>) -> Self {
        let divided = surface.divided.clone();
        let (n_vertices, n_columns) = (surface.vertices.len(), surface.columns.len());
        let mut middles = Middles::new(&divided, n_vertices);
        let mut cells = Self {
            n_vertices: n_vertices as u32,
            n_columns: n_columns as u32,
            divided,
            inside: HashMap::new(),
        };
        let mut all = Vec::new();
        for (t, &corners) in surface.triangles.iter().enumerate() {
            let parts = middles.parts(corners);
            if parts.len() > 1 {
                let values = cells.hats_inside(corners, &parts, &middles);
                cells.inside.insert(t as u32, values);
                all.extend(parts);
            }
        }
        let mut vertices = surface.vertices.clone();
        for ends in &middles.ends {
            let [p, q] = ends.map(|v| vertices[v as usize]);
            vertices.push(0.5 * (p + q));
        }
        let centres: Vec<Vec3> = all
            .iter()
            .map(|part| part.iter().map(|&v| vertices[v as usize]).sum::<Vec3>() / 3.0)
            .collect();
        let order = spatial_order(&centres, [BLOCK]);
        blocks.extend(order.chunks(BLOCK).map(|which| {
            let hat = |t: u32, c: usize| cells.hat(all[t as usize][c]);
            let mut block = PanelBlock::new(&vertices, &all, which, hat);
            // They have no sources of their own.
            block.triangles.clear();
            block
        }));
        cells
    }

    /// Column of a hat function, by the vertex it is one at.
    fn hat(&self, vertex: u32) -> Option<u32> {
        let hats = self.n_vertices..self.n_vertices + self.divided.len() as u32;
        hats.contains(&vertex).then_some(vertex + self.n_columns)
    }

    /// A column with factors: a vertex itself, or vertices and slopes of jumps that make the
    /// height of a hat function.
    pub(crate) fn made_of(&self, column: u32) -> impl Iterator<Item = (u32, f64)> {
        let vertex = (column < self.n_vertices).then_some((column, 1.0));
        let hat = column.checked_sub(self.n_vertices + self.n_columns);
        let edge = hat.map(|hat| &self.divided[hat as usize]);
        let height = edge.into_iter().flat_map(|edge| {
            let slope = edge.slope.iter();
            let slopes = slope.map(|&(column, w)| (self.n_vertices + column as u32, w));
            edge.height
                .iter()
                .copied()
                .chain(slopes)
                .map(|(v, weight)| (v, HEIGHT * weight))
        });
        vertex.into_iter().chain(height)
    }

    /// Columns of jumps.
    pub(crate) fn n_columns(&self) -> usize {
        self.n_columns as usize
    }

    /// Vertices of the surface: their columns come first.
    pub(crate) fn n_vertices(&self) -> u32 {
        self.n_vertices
    }

    /// Hat functions that reach into a triangle, by their columns.
    pub(crate) fn inside(&self, triangle: u32) -> &[HatValues] {
        self.inside.get(&triangle).map_or(&[], Vec::as_slice)
    }

    /// Values of the hat functions at the three points of a triangle, taken as the influences
    /// of near panels are: on thin sections the two all but cancel.
    fn hats_inside(
        &self,
        corners: [u32; 3],
        parts: &[[u32; 3]],
        middles: &Middles,
    ) -> Vec<HatValues> {
        let unit = |v: u32| corners.map(|c| if c == v { 1.0 } else { 0.0 });
        let coordinates = |v: u32| -> [f64; 3] {
            let [a, b] = middles.ends_of(v).unwrap_or([v, v]).map(unit);
            std::array::from_fn(|i| 0.5 * (a[i] + b[i]))
        };
        let placed: Vec<_> = parts.iter().map(|p| (p, p.map(coordinates))).collect();
        let mut hats: Vec<u32> = parts.iter().flatten().copied().collect();
        hats.retain(|v| self.hat(*v).is_some());
        hats.sort_unstable();
        hats.dedup();
        let value = |hat: u32, point: &[f64; 3]| {
            let inside = placed.iter().find_map(|(part, at)| {
                let shape = shape_in(at, point);
                shape.iter().all(|x| *x > -ON_EDGE).then_some((part, shape))
            });
            inside.map_or(0.0, |(part, shape)| {
                let own = part.iter().zip(shape).find(|(v, _)| **v == hat);
                own.map_or(0.0, |(_, x)| x)
            })
        };
        hats.iter()
            .filter_map(|&v| Some((self.hat(v)?, point_values(|x| value(v, x)))))
            .collect()
    }
}

/// Barycentric coordinates of a point in a part, both given in those of the whole triangle.
fn shape_in(part: &[[f64; 3]; 3], point: &[f64; 3]) -> [f64; 3] {
    let det = |a: &[f64; 3], b: &[f64; 3], c: &[f64; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    let [a, b, c] = part;
    let whole = det(a, b, c);
    [det(point, b, c), det(a, point, c), det(a, b, point)].map(|x| x / whole)
}

/// A trailing edge's edge on one side of it.
#[derive(Clone, Copy)]
struct EdgeSide {
    chain: usize,
    edge: usize,
    /// 1 above, −1 below.
    sign: f64,
    /// Vertices of the side.
    ends: [u32; 2],
}

/// Edges to divide: on each side of a trailing edge those round each of its vertices, up to
/// another trailing edge or a ridge. Edges of triangles that touch a body line stay whole: jumps
/// are carried there.
pub(crate) fn divided_edges(
    surface: &CutSurface,
    chains: &[TrailingEdge],
    stream: Vec3,
    half: bool,
) -> Vec<DividedEdge> {
    let on_edge: BTreeSet<u32> = chains
        .iter()
        .flat_map(|chain| chain.vertices.iter().copied())
        .collect();
    let is_on_edge = |v: u32| on_edge.contains(&surface.source[v as usize]);
    let normal = |t: u32| {
        let [a, b, c] = surface.triangles[t as usize].map(|v| surface.vertices[v as usize]);
        (b - a).cross(&(c - a)).normalize()
    };
    let carrying: BTreeSet<u32> = surface
        .carried
        .iter()
        .map(|c| surface.triangles[c.triangle as usize][c.corner])
        .collect();
    let carries = |t: &u32| {
        let corners = surface.triangles[*t as usize];
        corners.iter().any(|v| carrying.contains(v))
    };
    let mut triangles: HashMap<Edge, Vec<u32>> = HashMap::new();
    for (t, corners) in surface.triangles.iter().enumerate() {
        for [a, b] in sides_of(*corners) {
            triangles.entry(edge(a, b)).or_default().push(t as u32);
        }
    }
    let mut found: BTreeMap<Edge, [u32; 2]> = BTreeMap::new();
    let mut behind: HashMap<u32, Vec<EdgeSide>> = HashMap::new();
    for (first, side) in edge_sides(surface, chains) {
        let own = normal(first);
        let [start, end] = side.ends;
        for (near, other) in [(start, end), (end, start)] {
            // Round the vertex, away from the trailing edge.
            let (mut triangle, mut passed) = (first, other);
            loop {
                let corners = surface.triangles[triangle as usize];
                let ahead = corners.into_iter().find(|&v| v != near && v != passed);
                let Some(far) = ahead.filter(|&v| !is_on_edge(v)) else {
                    break;
                };
                let both = &triangles[&edge(near, far)];
                if both.iter().any(carries) {
                    break;
                }
                found.insert(edge(near, far), [near, far]);
                behind.entry(far).or_default().push(side);
                let next = both.iter().copied().find(|&t| t != triangle && t != first);
                let Some(next) = next.filter(|&t| normal(t).dot(&own) > SAME_SIDE) else {
                    break;
                };
                (triangle, passed) = (next, far);
            }
        }
    }
    let deviations: BTreeMap<u32, Deviation> = found
        .values()
        .filter_map(|&ends| {
            let own = Deviation::new(surface, ends, &behind[&ends[1]], stream, half)?;
            Some((ends[1], own))
        })
        .collect();
    found
        .into_values()
        .filter_map(|ends| {
            let (height, slope) = deviations.get(&ends[1])?.of_jump(&deviations);
            Some(DividedEdge {
                ends,
                height,
                slope,
            })
        })
        .collect()
}

/// Every edge of the trailing edges from both sides, with its triangle.
fn edge_sides(surface: &CutSurface, chains: &[TrailingEdge]) -> Vec<(u32, EdgeSide)> {
    let mut sides = Vec::new();
    for (c, chain) in chains.iter().enumerate() {
        for (e, (&upper, &lower)) in chain.upper.iter().zip(&chain.lower).enumerate() {
            for (triangle, sign) in [(upper, 1.0), (lower, -1.0)] {
                let corners = surface.triangles[triangle as usize];
                let corner = |v: u32| {
                    corners
                        .into_iter()
                        .find(|&own| surface.source[own as usize] == v)
                };
                let ends = [corner(chain.vertices[e]), corner(chain.vertices[e + 1])];
                if let [Some(start), Some(end)] = ends {
                    let side = EdgeSide {
                        chain: c,
                        edge: e,
                        sign,
                        ends: [start, end],
                    };
                    sides.push((triangle, side));
                }
            }
        }
    }
    sides
}

/// How far the potential at a vertex is from that where the stream takes it to the trailing
/// edge: φ_e − φ_w + d σ s κ.
#[derive(Clone, Debug)]
struct Deviation {
    chain: usize,
    sign: f64,
    /// Place of e along the chain, in edges.
    place: f64,
    /// d.
    distance: f64,
    vertices: Vec<(u32, f64)>,
    slope: Jump,
}

impl Deviation {
    /// `behind`: edges of the trailing edge that may lie downstream of the vertex; `near`: a
    /// vertex on it.
    fn new(
        surface: &CutSurface,
        [near, vertex]: [u32; 2],
        behind: &[EdgeSide],
        stream: Vec3,
        half: bool,
    ) -> Option<Self> {
        // Reached from more it lies in the corner between trailing edges, or on a ridge
        // beyond the end of one.
        let from = |side: &EdgeSide| (side.chain, side.sign > 0.0);
        if behind.iter().any(|side| from(side) != from(&behind[0])) {
            return None;
        }
        let at = |v: u32| surface.vertices[v as usize];
        // Where the stream through the vertex comes closest to an edge's line.
        let across = |x: Vec3| x - x.dot(&stream) * stream;
        let mut placed: Vec<(&EdgeSide, f64)> = behind
            .iter()
            .map(|side| {
                let [p, q] = side.ends.map(at);
                let line = across(q - p);
                (side, line.dot(&(at(vertex) - p)) / line.norm_squared())
            })
            .collect();
        let from_middle = |part: f64| (part - 0.5).abs();
        placed.sort_by(|a, b| from_middle(a.1).total_cmp(&from_middle(b.1)));
        let &(side, mut part) = placed.first()?;
        // Between two edges it is their common vertex, as it is on a plane of symmetry of
        // which the other edge is an image.
        let beside = placed.iter().find(|(other, _)| other.ends != side.ends);
        let is_between = beside.is_some_and(|(other, own)| {
            from_middle(*own) - from_middle(part) < BETWEEN
                && other.ends.iter().any(|v| side.ends.contains(v))
        });
        if is_between || half && on_plane(&at(near)) && on_plane(&at(vertex)) {
            part = part.clamp(0.0, 1.0).round_ties_even();
        }
        let weights = [1.0 - part, part];
        let foot = weights[0] * at(side.ends[0]) + weights[1] * at(side.ends[1]);
        let distance = (foot - at(vertex)).dot(&stream);
        // Not so of an edge along the stream, or of a vertex far beside all edges.
        let is_downstream = distance > 0.0 && from_middle(part) < BESIDE;
        if !is_downstream {
            return None;
        }
        let jumps = &surface.chain_jumps[side.chain][side.edge..=side.edge + 1];
        let slope = 0.5 * side.sign * distance;
        Some(Self {
            chain: side.chain,
            sign: side.sign,
            place: side.edge as f64 + part,
            distance,
            vertices: std::iter::once((vertex, -1.0))
                .chain(side.ends.into_iter().zip(weights))
                .collect(),
            slope: jumps
                .iter()
                .zip(weights)
                .flat_map(|(jump, own)| jump.iter().map(move |(c, w)| (*c, slope * own * w)))
                .collect(),
        })
    }

    /// Half of its difference from that on the other side at the same place, which is the
    /// jump's; of those beside the place by the power law where the meshes do not match,
    /// itself where they are all too unlike.
    fn of_jump(&self, all: &BTreeMap<u32, Self>) -> (Vec<(u32, f64)>, Jump) {
        let mut others: Vec<&Self> = all
            .values()
            .filter(|o| o.chain == self.chain && o.sign != self.sign)
            .collect();
        others.sort_by(|a, b| a.place.total_cmp(&b.place));
        let is_opposite = |o: &&&Self| {
            (o.place - self.place).abs() < BETWEEN
                && (o.distance - self.distance).abs() < BETWEEN * self.distance.abs()
        };
        let next = others.partition_point(|o| o.place < self.place);
        let (before, after) = others.split_at(next);
        let beside: Vec<(&Self, f64)> = match (before.last(), after.first()) {
            _ if let Some(opposite) = others.iter().find(is_opposite) => vec![(opposite, 1.0)],
            (Some(before), Some(after)) => {
                let part = (self.place - before.place) / (after.place - before.place);
                vec![(before, 1.0 - part), (after, part)]
            }
            (Some(only), None) | (None, Some(only)) => vec![(only, 1.0)],
            (None, None) => return (self.vertices.clone(), self.slope.clone()),
        };
        let ratio = |other: &Self| self.distance / other.distance;
        if beside
            .iter()
            .any(|(o, _)| !(1.0 / ALIKE..=ALIKE).contains(&ratio(o)))
        {
            return (self.vertices.clone(), self.slope.clone());
        }
        let shares = beside.into_iter().map(|(other, weight)| {
            let ratio = ratio(other);
            (other, -0.5 * weight * ratio * ratio.sqrt())
        });
        let (mut vertices, mut slope) = (Vec::new(), Jump::new());
        for (deviation, share) in std::iter::once((self, 0.5)).chain(shares) {
            vertices.extend(deviation.vertices.iter().map(|(v, w)| (*v, share * w)));
            slope.extend(deviation.slope.iter().map(|(c, w)| (*c, share * w)));
        }
        (vertices, slope)
    }
}

/// Middles of edges as vertices behind those of the surface, those with a hat function first.
struct Middles {
    n_vertices: u32,
    ends: Vec<[u32; 2]>,
    of_edge: HashMap<Edge, u32>,
}

impl Middles {
    fn new(divided: &[DividedEdge], n_vertices: usize) -> Self {
        let n_vertices = n_vertices as u32;
        let ends: Vec<[u32; 2]> = divided.iter().map(|edge| edge.ends).collect();
        let number = |(k, [a, b]): (usize, &[u32; 2])| (edge(*a, *b), n_vertices + k as u32);
        Self {
            n_vertices,
            of_edge: ends.iter().enumerate().map(number).collect(),
            ends,
        }
    }

    /// Ends of the edge whose middle a vertex is.
    fn ends_of(&self, vertex: u32) -> Option<[u32; 2]> {
        let middle = vertex.checked_sub(self.n_vertices)?;
        Some(self.ends[middle as usize])
    }

    /// A triangle divided at the middles of its edges, in quarters where two are divided:
    /// the middle of the third is added.
    fn parts(&mut self, corners: [u32; 3]) -> Vec<[u32; 3]> {
        let at = |[a, b]: [u32; 2]| self.of_edge.get(&edge(a, b)).copied();
        // Turned so that an undivided edge comes first.
        let sides = sides_of(corners);
        let Some(whole) = (0..3).find(|&e| at(sides[e]).is_none()) else {
            return vec![corners];
        };
        let [a, b, c] = std::array::from_fn(|i| corners[(whole + i) % 3]);
        match (at([b, c]), at([c, a])) {
            (None, None) => vec![corners],
            (Some(m), None) => vec![[a, b, m], [a, m, c]],
            (None, Some(m)) => vec![[a, b, m], [m, b, c]],
            (Some(m), Some(n)) => {
                let own = self.n_vertices + self.ends.len() as u32;
                self.ends.push([a, b]);
                vec![[a, own, n], [own, b, m], [n, m, c], [own, m, n]]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Silent;
    use crate::image::Image;
    use crate::solve::{Flow, Problem, lay_out, solve};
    use fladder_mesh::shapes::NacaWing;
    use fladder_mesh::{Frame, SurfaceMode, Topology, TriMesh, trailing_edge};

    fn edges(mesh: &TriMesh) -> Vec<TrailingEdge> {
        let settings = trailing_edge::Settings::default();
        trailing_edge::find_by_shape(mesh, &Topology::new(mesh), settings)
    }

    /// A steady jump that goes with the span, and anything alike on both sides, raise no hat
    /// function; the slope of the wake is s κ d.
    #[test]
    fn what_is_linear_along_the_edge_stays_linear() {
        let shape = NacaWing {
            n_chord: 6,
            n_half_span: 4,
            ..NacaWing::default()
        };
        for mesh in [
            shape.structured().expect("wing"),
            shape.unstructured(1).expect("wing"),
        ] {
            let chains = edges(&mesh);
            let problem = Problem::new(&mesh, &chains, &[], 0.5);
            let (surface, _) = lay_out(&problem, Image::None).expect("wake");
            let mut upper: Vec<f64> = vec![-0.5; surface.vertices.len()];
            for column in &surface.columns {
                upper[column.upper as usize] = 0.5;
            }
            for (side, vertex) in upper.iter_mut().zip(&surface.vertices) {
                if vertex.z > 0.0 {
                    *side = 0.5;
                }
            }
            assert!(surface.divided.len() > 3 * surface.columns.len());
            for edge in &surface.divided {
                let sum = |field: &dyn Fn(usize) -> f64| -> f64 {
                    let terms = edge.height.iter();
                    terms.map(|(v, w)| w * field(*v as usize)).sum()
                };
                let y = |v: usize| surface.vertices[v].y;
                assert!(sum(&|_| 1.0).abs() < 1e-12);
                // Tips have one vertex for both sides, and no jump.
                if edge.ends.iter().all(|v| y(*v as usize).abs() < 2.5) {
                    assert!(sum(&|v| upper[v]).abs() < 1e-12);
                    assert!(sum(&|v| upper[v] * y(v)).abs() < 1e-9);
                }
            }
        }
    }

    /// Lift of a thin wing on few cells against that on many.
    #[test]
    fn few_cells_have_the_lift_of_many() {
        let lift = |n_chord: usize| {
            let shape = NacaWing {
                thickness: 0.02,
                span: 6.0,
                n_chord,
                n_half_span: 6,
                chord_clustering: 0.0,
                nose_clustering: 0.7,
                ..NacaWing::default()
            };
            let mesh = shape.structured().expect("wing");
            let chains = edges(&mesh);
            let plunge = SurfaceMode {
                name: "plunge".into(),
                frame: Frame::Inertial,
                displacement: vec![Vec3::z(); mesh.vertices.len()],
            };
            let modes = [plunge];
            let problem = Problem {
                flow: Flow {
                    alpha: 0.05,
                    beta: 0.0,
                },
                ..Problem::new(&mesh, &chains, &modes, 0.5)
            };
            let solution = solve(&problem, &Silent).expect("a solution");
            solution.steady.lift_by_wake_jump
        };
        let (few, many) = (lift(10), lift(60));
        let error = few / many - 1.0;
        println!(
            "ten equal cells against sixty: {:.2} % of the lift",
            100.0 * error
        );
        // Linear elements: 0.42 of the last cell's length too much, about 5 % here.
        assert!(error.abs() < 0.01);
    }
}
