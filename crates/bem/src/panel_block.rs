//! Influence of a small block of triangles at eight points at once.
//!
//! The formulae are those of [`crate::panels`]; its scalar functions are the oracle. Lanes
//! are field points, so that a triangle's constants are the same in all of them; distances
//! are taken once a vertex and logarithms once an edge of the block. Where the block is
//! farther than [`FAR_EDGES`] edges, (r_a + r_b + l)/(r_a + r_b − l) is so near to one that
//! L = 2 atanh(l/(r_a + r_b)) is a short series, and so is the solid angle.

use crate::lanes::{Lanes, SERIES_LIMIT, WIDTH};
use crate::panels::{EDGE_FLOOR, INVERSE_FOUR_PI, Panel, SharedEdge, edges_of, sphere};
use fladder_mesh::Vec3;
use pulp::{Arch, Simd, WithSimd};
use std::collections::HashMap;

/// Triangles of a block: vertices and edges of so many stay in the first cache.
pub(crate) const BLOCK: usize = 64;

/// Distance in longest edges from which the series serve: l/(r_a + r_b) < [`SERIES_LIMIT`]
/// and 2A z/(…) < 0.04 then.
const FAR_EDGES: f64 = 3.0;
const _: () = assert!(1.0 / (2.0 * FAR_EDGES) < SERIES_LIMIT);

/// Points of the divided test triangle and its three test points, filled to two widths.
pub(crate) const NEAR_POINTS: usize = 2 * WIDTH;

/// Eight points by coordinate.
pub(crate) type Points = [[f64; WIDTH]; 3];

/// A few triangles close together.
#[derive(Clone, Debug)]
pub(crate) struct PanelBlock {
    vertices: Vec<Vec3>,
    edges: Vec<SharedEdge>,
    panels: Vec<Panel>,
    /// What each corner's doublet is added to, in [`Self::columns`].
    corners: Vec<[u32; 3]>,
    /// Columns in use; corners without one are added to the place after the last.
    pub(crate) columns: Vec<u32>,
    /// Numbers of the triangles.
    pub(crate) triangles: Vec<u32>,
    pub(crate) spheres: Vec<(Vec3, f64)>,
    pub(crate) centre: Vec3,
    pub(crate) radius: f64,
    /// Largest radius of a triangle.
    pub(crate) largest: f64,
    longest_edge: f64,
}

/// Working space of one thread.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockScratch {
    /// Offsets and distance of each vertex.
    vertices: Vec<[f64; 4 * WIDTH]>,
    /// Logarithm and source term of each edge.
    edges: Vec<[f64; 2 * WIDTH]>,
}

impl PanelBlock {
    /// Triangles `which` of a surface; `column` of each corner, or none.
    pub(crate) fn new(
        vertices: &[Vec3],
        triangles: &[[u32; 3]],
        which: &[u32],
        column: impl Fn(u32, usize) -> Option<u32>,
    ) -> Self {
        let mut local = HashMap::new();
        let mut kept = Vec::new();
        let renumbered: Vec<[u32; 3]> = which
            .iter()
            .map(|&t| {
                triangles[t as usize].map(|v| {
                    *local.entry(v).or_insert_with(|| {
                        kept.push(vertices[v as usize]);
                        kept.len() as u32 - 1
                    })
                })
            })
            .collect();
        let (panels, edges) = edges_of(&kept, &renumbered);
        let mut columns = Vec::new();
        for &t in which {
            columns.extend((0..3).filter_map(|c| column(t, c)));
        }
        columns.sort_unstable();
        columns.dedup();
        let place = |t: u32, c: usize| {
            column(t, c).map_or(columns.len(), |v| columns.partition_point(|&x| x < v)) as u32
        };
        let corners = which
            .iter()
            .map(|&t| std::array::from_fn(|c| place(t, c)))
            .collect();
        let spheres: Vec<(Vec3, f64)> = renumbered
            .iter()
            .map(|t| sphere(&t.map(|v| kept[v as usize])))
            .collect();
        let (centre, radius) = enclosing(&kept);
        Self {
            longest_edge: edges.iter().map(|e| e.length).fold(0.0, f64::max),
            largest: spheres.iter().map(|s| s.1).fold(0.0, f64::max),
            vertices: kept,
            edges,
            panels,
            corners,
            columns,
            triangles: which.to_vec(),
            spheres,
            centre,
            radius,
        }
    }

    /// Places of doublet sums: one a column and one for corners without.
    pub(crate) fn places(&self) -> usize {
        self.columns.len() + 1
    }

    /// Where the doublet of a triangle's corner goes.
    pub(crate) fn place(&self, panel: usize, corner: usize) -> usize {
        self.corners[panel][corner] as usize
    }

    /// Whether points within `radius` of `centre` are far in the sense of the series.
    pub(crate) fn is_far(&self, centre: Vec3, radius: f64) -> bool {
        (centre - self.centre).norm() - radius - self.radius > FAR_EDGES * self.longest_edge
    }

    /// Adds D of the corners to `doublets` (places × [`WIDTH`]) and puts S of the corners
    /// into `sources` (3 triangles × [`WIDTH`]), or leaves S out where it is empty.
    pub(crate) fn evaluate(
        &self,
        arch: Arch,
        points: &Points,
        far: bool,
        scratch: &mut BlockScratch,
        doublets: &mut [f64],
        sources: &mut [f64],
    ) {
        arch.dispatch(Evaluation {
            block: self,
            points,
            far,
            scratch,
            doublets,
            sources,
        });
    }

    /// D and S of one triangle's corners at [`NEAR_POINTS`] points.
    pub(crate) fn near(
        &self,
        arch: Arch,
        panel: usize,
        points: &[[f64; NEAR_POINTS]; 3],
    ) -> NearValues {
        arch.dispatch(NearEvaluation {
            block: self,
            panel,
            points,
        })
    }
}

/// Centre of the box and distance of the farthest point.
pub(crate) fn enclosing(points: &[Vec3]) -> (Vec3, f64) {
    let Some(first) = points.first() else {
        return (Vec3::zeros(), 0.0);
    };
    let (low, high) = points
        .iter()
        .fold((*first, *first), |(l, h), p| (l.inf(p), h.sup(p)));
    let centre = 0.5 * (low + high);
    let radius = points
        .iter()
        .map(|p| (p - centre).norm())
        .fold(0.0, f64::max);
    (centre, radius)
}

/// D and S of three corners at every near point.
#[derive(Clone, Debug)]
pub(crate) struct NearValues {
    pub(crate) doublets: [[f64; NEAR_POINTS]; 3],
    pub(crate) sources: [[f64; NEAR_POINTS]; 3],
}

/// Constants of one call.
struct Evaluation<'a> {
    block: &'a PanelBlock,
    points: &'a Points,
    far: bool,
    scratch: &'a mut BlockScratch,
    doublets: &'a mut [f64],
    sources: &'a mut [f64],
}

impl WithSimd for Evaluation<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match (self.far, self.sources.is_empty()) {
            (true, true) => self.run::<S, true, false>(simd),
            (true, false) => self.run::<S, true, true>(simd),
            (false, true) => self.run::<S, false, false>(simd),
            (false, false) => self.run::<S, false, true>(simd),
        }
    }
}

/// One vertex seen from the points of a vector.
#[derive(Clone, Copy)]
struct Seen<S: Simd> {
    offset: [Lanes<S>; 3],
    distance: Lanes<S>,
}

#[inline(always)]
fn seen<S: Simd>(simd: S, vertex: &Vec3, point: [Lanes<S>; 3]) -> Seen<S> {
    let x = Lanes::splat(simd, vertex.x) - point[0];
    let y = Lanes::splat(simd, vertex.y) - point[1];
    let z = Lanes::splat(simd, vertex.z) - point[2];
    Seen {
        offset: [x, y, z],
        distance: x.mul_add(x, y.mul_add(y, z * z)).sqrt(),
    }
}

#[inline(always)]
pub(crate) fn dot<S: Simd>(a: [Lanes<S>; 3], b: [Lanes<S>; 3]) -> Lanes<S> {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

#[inline(always)]
pub(crate) fn splat3<S: Simd>(simd: S, v: &Vec3) -> [Lanes<S>; 3] {
    [
        Lanes::splat(simd, v.x),
        Lanes::splat(simd, v.y),
        Lanes::splat(simd, v.z),
    ]
}

/// L/4π of an edge.
#[inline(always)]
fn logarithm<S: Simd, const FAR: bool>(
    simd: S,
    edge: &SharedEdge,
    ends: &[Seen<S>; 2],
) -> Lanes<S> {
    let c = |value| Lanes::splat(simd, value);
    let (sum, length) = (ends[0].distance + ends[1].distance, c(edge.length));
    if FAR {
        c(2.0 * INVERSE_FOUR_PI) * (length / sum).small_atanh()
    } else {
        let gap = (sum - length).max(c(EDGE_FLOOR * edge.length));
        c(INVERSE_FOUR_PI) * (sum + length).ln_ratio(gap)
    }
}

/// L/4π of two edges of a far block, by one division.
#[inline(always)]
fn far_logarithms<S: Simd>(
    simd: S,
    edges: [&SharedEdge; 2],
    ends: [&[Seen<S>; 2]; 2],
) -> [Lanes<S>; 2] {
    let c = |value| Lanes::splat(simd, value);
    let first = ends[0][0].distance + ends[0][1].distance;
    let second = ends[1][0].distance + ends[1][1].distance;
    let inverse = c(1.0) / (first * second);
    let scale = c(2.0 * INVERSE_FOUR_PI);
    [
        scale * (c(edges[0].length) * (second * inverse)).small_atanh(),
        scale * (c(edges[1].length) * (first * inverse)).small_atanh(),
    ]
}

/// Both ends of an edge as they were kept.
#[inline(always)]
fn ends_of<S: Simd>(simd: S, edge: &SharedEdge, vertices: &[[f64; 4 * WIDTH]]) -> [Seen<S>; 2] {
    [
        kept(simd, &vertices[edge.ends[0] as usize]),
        kept(simd, &vertices[edge.ends[1] as usize]),
    ]
}

/// Keeps logarithm and, with sources, source term of an edge.
#[inline(always)]
fn keep_edge<S: Simd, const SOURCES: bool>(
    simd: S,
    edge: &SharedEdge,
    ends: &[Seen<S>; 2],
    logarithm: Lanes<S>,
    out: &mut [f64; 2 * WIDTH],
) {
    let (out, _) = S::as_mut_simd_f64s(out);
    out[0] = logarithm.values();
    if SOURCES {
        out[WIDTH / S::F64_LANES] =
            source_term(simd, edge, &ends[0], ends[1].distance, logarithm).values();
    }
}

/// J/4π of an edge from L/4π.
#[inline(always)]
fn source_term<S: Simd>(
    simd: S,
    edge: &SharedEdge,
    a: &Seen<S>,
    b: Lanes<S>,
    logarithm: Lanes<S>,
) -> Lanes<S> {
    let c = |value| Lanes::splat(simd, value);
    let along = dot(splat3(simd, &edge.tangent), a.offset);
    let across_squared = a.distance.mul_add(a.distance, -(along * along)).max(c(0.0));
    let ends = (along + c(edge.length)).mul_add(b, -(along * a.distance));
    c(0.5) * across_squared.mul_add(logarithm, c(INVERSE_FOUR_PI) * ends)
}

/// D and S of the three corners; the third of each from the sum over all.
#[inline(always)]
fn corner_values<S: Simd, const FAR: bool, const SOURCES: bool>(
    simd: S,
    panel: &Panel,
    corners: [&Seen<S>; 3],
    logarithms: [Lanes<S>; 3],
    terms: [Lanes<S>; 3],
) -> ([Lanes<S>; 3], [Lanes<S>; 3]) {
    let c = |value| Lanes::splat(simd, value);
    let [d0, d1, d2] = corners.map(|s| s.offset);
    let [r0, r1, r2] = corners.map(|s| s.distance);
    let height = -dot(splat3(simd, &panel.normal), d0);
    let first = c(1.0) - dot(splat3(simd, &panel.gradients[0]), d0);
    let second = -dot(splat3(simd, &panel.gradients[1]), d0);
    let base = (r0 * r1).mul_add(
        r2,
        dot(d0, d1).mul_add(r2, dot(d1, d2).mul_add(r0, dot(d2, d0) * r1)),
    );
    let raised = c(panel.twice_area) * height;
    let angle = if FAR {
        c(2.0 * INVERSE_FOUR_PI) * (raised / base).small_atan()
    } else {
        c(2.0 * INVERSE_FOUR_PI) * raised.atan2(base)
    };
    let coplanar = c(panel.coplanar);
    let angle = height.abs().where_less(coplanar, c(0.0), angle);
    let height = height.abs().where_less(coplanar, c(0.0), height);
    let a = first.mul_add(
        angle,
        -(height * weighted(simd, &panel.slopes[0], logarithms)),
    );
    let b = second.mul_add(
        angle,
        -(height * weighted(simd, &panel.slopes[1], logarithms)),
    );
    let doublets = [a, b, angle - a - b];
    if !SOURCES {
        return (doublets, doublets);
    }
    let third = c(1.0) - first - second;
    let heights = &panel.heights;
    let whole = (first * c(heights[0])).mul_add(
        logarithms[0],
        (second * c(heights[1])).mul_add(
            logarithms[1],
            (third * c(heights[2])).mul_add(logarithms[2], -(height * angle)),
        ),
    );
    let a = first.mul_add(whole, weighted(simd, &panel.slopes[0], terms));
    let b = second.mul_add(whole, weighted(simd, &panel.slopes[1], terms));
    (doublets, [a, b, whole - a - b])
}

/// Σ wᵢ xᵢ.
#[inline(always)]
fn weighted<S: Simd>(simd: S, weights: &[f64; 3], values: [Lanes<S>; 3]) -> Lanes<S> {
    let c = |value| Lanes::splat(simd, value);
    c(weights[0]).mul_add(
        values[0],
        c(weights[1]).mul_add(values[1], c(weights[2]) * values[2]),
    )
}

/// The `chunk`-th vector of points.
#[inline(always)]
pub(crate) fn points_of<S: Simd, const N: usize>(
    simd: S,
    points: &[[f64; N]; 3],
    chunk: usize,
) -> [Lanes<S>; 3] {
    let lanes = |values: &[f64; N]| Lanes::new(simd, S::as_simd_f64s(values).0[chunk]);
    [lanes(&points[0]), lanes(&points[1]), lanes(&points[2])]
}

/// A vertex as it was kept.
#[inline(always)]
fn kept<S: Simd>(simd: S, values: &[f64; 4 * WIDTH]) -> Seen<S> {
    let chunks = WIDTH / S::F64_LANES;
    let (v, _) = S::as_simd_f64s(values);
    let lanes = |values: S::f64s| Lanes::new(simd, values);
    Seen {
        offset: [lanes(v[0]), lanes(v[chunks]), lanes(v[2 * chunks])],
        distance: lanes(v[3 * chunks]),
    }
}

/// Logarithm and source term of an edge of a panel whose corners are seen.
#[inline(always)]
fn edge_terms<S: Simd>(
    simd: S,
    edge: &SharedEdge,
    [a, b]: [&Seen<S>; 2],
    a_vertex: u32,
) -> [Lanes<S>; 2] {
    let ends = if a_vertex == edge.ends[0] {
        [*a, *b]
    } else {
        [*b, *a]
    };
    let l = logarithm::<S, false>(simd, edge, &ends);
    [l, source_term(simd, edge, &ends[0], ends[1].distance, l)]
}

impl Evaluation<'_> {
    #[inline(always)]
    fn run<S: Simd, const FAR: bool, const SOURCES: bool>(self, simd: S) {
        let Self {
            block,
            points,
            scratch,
            doublets,
            sources,
            ..
        } = self;
        scratch.vertices.resize(
            scratch.vertices.len().max(block.vertices.len()),
            [0.0; 4 * WIDTH],
        );
        scratch
            .edges
            .resize(scratch.edges.len().max(block.edges.len()), [0.0; 2 * WIDTH]);
        let chunks = WIDTH / S::F64_LANES;
        let lanes = |values: S::f64s| Lanes::new(simd, values);
        for chunk in 0..chunks {
            let point = points_of(simd, points, chunk);
            for (vertex, out) in block.vertices.iter().zip(&mut scratch.vertices) {
                let s = seen(simd, vertex, point);
                let (out, _) = S::as_mut_simd_f64s(out);
                out[0] = s.offset[0].values();
                out[chunks] = s.offset[1].values();
                out[2 * chunks] = s.offset[2].values();
                out[3 * chunks] = s.distance.values();
            }
            let vertices = &scratch.vertices;
            let mut edges = block.edges.iter();
            let mut kept_edges = scratch.edges.iter_mut();
            while let (Some(edge), Some(out)) = (edges.next(), kept_edges.next()) {
                let ends = ends_of(simd, edge, vertices);
                // A division serves two edges: dividers are what the lanes wait for.
                let next = if FAR {
                    edges.next().zip(kept_edges.next())
                } else {
                    None
                };
                let Some((other, other_out)) = next else {
                    let l = logarithm::<S, FAR>(simd, edge, &ends);
                    keep_edge::<S, SOURCES>(simd, edge, &ends, l, out);
                    continue;
                };
                let other_ends = ends_of(simd, other, vertices);
                let [l, other_l] = far_logarithms(simd, [edge, other], [&ends, &other_ends]);
                keep_edge::<S, SOURCES>(simd, edge, &ends, l, out);
                keep_edge::<S, SOURCES>(simd, other, &other_ends, other_l, other_out);
            }
            let (doublets, _) = S::as_mut_simd_f64s(doublets);
            let (sources, _) = S::as_mut_simd_f64s(sources);
            for (p, (panel, places)) in block.panels.iter().zip(&block.corners).enumerate() {
                let [i, j, k] = panel.corners;
                let first = kept(simd, &vertices[i as usize]);
                let second = kept(simd, &vertices[j as usize]);
                let third = kept(simd, &vertices[k as usize]);
                let (e0, _) = S::as_simd_f64s(&scratch.edges[panel.edges[0] as usize]);
                let (e1, _) = S::as_simd_f64s(&scratch.edges[panel.edges[1] as usize]);
                let (e2, _) = S::as_simd_f64s(&scratch.edges[panel.edges[2] as usize]);
                let (d, s) = corner_values::<S, FAR, SOURCES>(
                    simd,
                    panel,
                    [&first, &second, &third],
                    [lanes(e0[0]), lanes(e1[0]), lanes(e2[0])],
                    [lanes(e0[chunks]), lanes(e1[chunks]), lanes(e2[chunks])],
                );
                for i in 0..3 {
                    let at = places[i] as usize * chunks + chunk;
                    doublets[at] = (lanes(doublets[at]) + d[i]).values();
                    if SOURCES {
                        sources[(3 * p + i) * chunks + chunk] = s[i].values();
                    }
                }
            }
        }
    }
}

struct NearEvaluation<'a> {
    block: &'a PanelBlock,
    panel: usize,
    points: &'a [[f64; NEAR_POINTS]; 3],
}

impl WithSimd for NearEvaluation<'_> {
    type Output = NearValues;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> NearValues {
        let panel = &self.block.panels[self.panel];
        let mut out = NearValues {
            doublets: [[0.0; NEAR_POINTS]; 3],
            sources: [[0.0; NEAR_POINTS]; 3],
        };
        let vertices = &self.block.vertices;
        let edges = &self.block.edges;
        let [i, j, k] = panel.corners;
        let [e0, e1, e2] = panel.edges;
        for chunk in 0..NEAR_POINTS / S::F64_LANES {
            let point = points_of(simd, self.points, chunk);
            let first = seen(simd, &vertices[i as usize], point);
            let second = seen(simd, &vertices[j as usize], point);
            let third = seen(simd, &vertices[k as usize], point);
            let e0 = edge_terms(simd, &edges[e0 as usize], [&second, &third], j);
            let e1 = edge_terms(simd, &edges[e1 as usize], [&third, &first], k);
            let e2 = edge_terms(simd, &edges[e2 as usize], [&first, &second], i);
            let (d, s) = corner_values::<S, false, true>(
                simd,
                panel,
                [&first, &second, &third],
                [e0[0], e1[0], e2[0]],
                [e0[1], e1[1], e2[1]],
            );
            for i in 0..3 {
                let (doublets, _) = S::as_mut_simd_f64s(&mut out.doublets[i]);
                doublets[chunk] = d[i].values();
                let (sources, _) = S::as_mut_simd_f64s(&mut out.sources[i]);
                sources[chunk] = s[i].values();
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panels::PanelSet;
    use fladder_mesh::shapes::NacaWing;

    /// Largest difference from the scalar twin over the largest value, for points of the
    /// surface itself and of a cloud round it, near and far.
    #[test]
    fn blocks_give_what_the_scalar_functions_give() {
        let mesh = NacaWing {
            thickness: 0.04,
            n_chord: 10,
            n_half_span: 6,
            ..NacaWing::default()
        }
        .structured()
        .expect("wing");
        let panels = PanelSet::new(&mesh.vertices, &mesh.triangles);
        let order: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
        let blocks = crate::tiles::vertex_blocks(&mesh.vertices, &mesh.triangles, &order);
        let cloud = |i: usize| {
            let angle = i as f64 * 0.7;
            Vec3::new(
                0.5 + 2.0 * angle.cos(),
                3.0 * angle.sin(),
                0.3 * (angle * 1.3).sin(),
            )
        };
        let own = |i: usize| {
            mesh.corners(i * 7 % mesh.triangles.len())
                .iter()
                .sum::<Vec3>()
                / 3.0
        };
        let mut worst = [0.0_f64; 2];
        let mut used = [0, 0];
        for group in 0..24 {
            let at: Vec<Vec3> = (0..WIDTH)
                .map(|l| {
                    let i = group * WIDTH + l;
                    if group % 2 == 0 { cloud(i) } else { own(i) }
                })
                .collect();
            let points: Points = std::array::from_fn(|a| std::array::from_fn(|l| at[l][a]));
            let (centre, radius) = enclosing(&at);
            let mut scratch = BlockScratch::default();
            for block in &blocks {
                let far = block.is_far(centre, radius);
                used[usize::from(far)] += 1;
                let mut d = vec![0.0; block.places() * WIDTH];
                let mut s = vec![0.0; 3 * block.triangles.len() * WIDTH];
                block.evaluate(Arch::new(), &points, far, &mut scratch, &mut d, &mut s);
                for (l, point) in at.iter().enumerate() {
                    let mut expected = vec![0.0; block.places()];
                    for (p, &t) in block.triangles.iter().enumerate() {
                        let (one_d, one_s) = panels.one(t as usize, *point);
                        for c in 0..3 {
                            expected[block.place(p, c)] += one_d[c];
                            let found = s[(3 * p + c) * WIDTH + l];
                            worst[1] = worst[1].max((found - one_s[c]).abs());
                        }
                    }
                    for (place, value) in expected.iter().enumerate() {
                        worst[0] = worst[0].max((d[place * WIDTH + l] - value).abs());
                    }
                }
            }
        }
        println!(
            "near and far blocks {used:?}; D, S off by {:.1e}, {:.1e}",
            worst[0], worst[1]
        );
        assert!(used[0] > 20 && used[1] > 20);
        // Corner values are differences of terms up to (distance/size)² larger: 3e3 roundings.
        assert!(worst[0] < 5e-13 && worst[1] < 5e-13);
    }
}
