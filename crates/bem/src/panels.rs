//! Influence of flat triangles with linearly varying doublet and source strength.
//!
//! For a triangle with corners v₀ v₁ v₂, unit normal n, shape functions Nᵢ and a
//! field point P,
//!
//! $$ D_i(P) = \frac1{4\pi}\int N_i \frac{\mathbf n\cdot(P-Q)}{r^3}\,\mathrm dS,
//!    \qquad S_i(P) = \frac1{4\pi}\int \frac{N_i}{r}\,\mathrm dS . $$
//!
//! With z = n·(P − v₀), P₀ the foot of P in the plane, gᵢ = ∇Nᵢ, edge e opposite
//! corner e with length l, outward in-plane normal mₑ and end distances rₐ, r_b:
//!
//! | integral | closed form |
//! |---|---|
//! | solid angle | Ω = 2 atan2(2Az, r₀r₁r₂ + (d₀·d₁)r₂ + (d₁·d₂)r₀ + (d₂·d₀)r₁) |
//! | edge | Lₑ = ln((rₐ + r_b + l)/(rₐ + r_b − l)) |
//! | edge | Jₑ = (s_b r_b − s_a r_a + (r_a² − s_a²) Lₑ)/2 |
//! | doublet | 4π Dᵢ = Nᵢ(P₀) Ω − z Σₑ (gᵢ·mₑ) Lₑ |
//! | ∫ dS/r | I = Σₑ hₑ Lₑ − zΩ, hₑ = Nₑ(P₀) 2A/l |
//! | source | 4π Sᵢ = Nᵢ(P₀) I + Σₑ (gᵢ·mₑ) Jₑ |
//!
//! Solid angle: Van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30 (1983), eq. (8);
//! the rest by integration by parts in the plane, as in Newman, J. Eng. Math. 20 (1986).
//! A point as close to the plane as rounding (`COPLANAR`, `ROUNDING`) counts as lying in it:
//! then z = Ω = 0, the principal value. The logarithm is bounded on an edge by
//! `EDGE_FLOOR`.

use fladder_mesh::Vec3;
use std::collections::HashMap;

pub(crate) const INVERSE_FOUR_PI: f64 = 0.25 * std::f64::consts::FRAC_1_PI;

/// Distance from the plane, in longest edges, below which a point lies in it; [`ROUNDING`] is
/// added to it.
///
/// On irregular meshes some pair of triangle and point lies this close by chance, and Ω is
/// wrong by as much: a row sum was 1.5e-9 off with 1e-9 here.
const COPLANAR: f64 = 1e-12;

/// Rounding of a point in its own triangle, by the largest coordinate: it is a sum of three
/// products, from which a corner is taken.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// Smallest rₐ + r_b − l, in edge lengths; it is zero for a point on the edge.
pub(crate) const EDGE_FLOOR: f64 = 1e-14;

/// Constants of one triangle.
#[derive(Clone, Debug)]
pub(crate) struct Panel {
    pub(crate) corners: [u32; 3],
    /// Edge opposite each corner.
    pub(crate) edges: [u32; 3],
    pub(crate) normal: Vec3,
    pub(crate) twice_area: f64,
    pub(crate) coplanar: f64,
    /// gᵢ.
    pub(crate) gradients: [Vec3; 3],
    /// gᵢ·mₑ.
    pub(crate) slopes: [[f64; 3]; 3],
    /// 2A/lₑ.
    pub(crate) heights: [f64; 3],
}

/// An edge shared by up to two triangles, so that its logarithm is taken once.
#[derive(Clone, Debug)]
pub(crate) struct SharedEdge {
    pub(crate) ends: [u32; 2],
    pub(crate) length: f64,
    /// Unit vector from the first end to the second.
    pub(crate) tangent: Vec3,
}

impl SharedEdge {
    /// Lₑ from the distances of the ends.
    fn logarithm(&self, a: f64, b: f64) -> f64 {
        let sum = a + b;
        let gap = (sum - self.length).max(EDGE_FLOOR * self.length);
        ((sum + self.length) / gap).ln()
    }

    /// Jₑ; `offset` is the first end seen from the point.
    fn source_term(&self, offset: &Vec3, a: f64, b: f64, logarithm: f64) -> f64 {
        let along = self.tangent.dot(offset);
        let across_squared = (a * a - along * along).max(0.0);
        0.5 * ((along + self.length) * b - along * a + across_squared * logarithm)
    }
}

/// Centroid and distance of the farthest corner.
pub(crate) fn sphere(corners: &[Vec3; 3]) -> (Vec3, f64) {
    let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
    let radius = corners
        .iter()
        .map(|p| (p - centre).norm())
        .fold(0.0, f64::max);
    (centre, radius)
}

/// Constants of triangles and of the edges they share.
pub(crate) fn edges_of(
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
) -> (Vec<Panel>, Vec<SharedEdge>) {
    let mut edge_index = HashMap::new();
    let mut edges = Vec::new();
    let panels = triangles
        .iter()
        .map(|&corners| Panel::new(vertices, corners, &mut edge_index, &mut edges))
        .collect();
    (panels, edges)
}

/// Flat triangles prepared for evaluation at many points, one after the other; the
/// scalar twin of the blocks in which the solver evaluates them.
#[derive(Clone, Debug)]
pub struct PanelSet {
    vertices: Vec<Vec3>,
    edges: Vec<SharedEdge>,
    panels: Vec<Panel>,
}

/// Corner integrals of one triangle at one point.
pub type CornerValues = [f64; 3];

/// Working space of one thread.
#[derive(Clone, Debug)]
pub struct PanelScratch {
    offsets: Vec<Vec3>,
    distances: Vec<f64>,
    logarithms: Vec<f64>,
    source_edges: Vec<f64>,
}

impl PanelSet {
    /// Prepares triangles given by vertex indices.
    ///
    /// A triangle of zero area carries no potential and no gradient; the mesh judge
    /// refuses it before it comes here.
    pub fn new(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let (panels, edges) = edges_of(vertices, triangles);
        Self {
            vertices: vertices.to_vec(),
            edges,
            panels,
        }
    }

    /// As [`Self::new`] for a small part of a surface: only vertices in use are kept.
    pub fn compact(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let mut kept = Vec::new();
        let mut new_index = HashMap::new();
        let renumbered: Vec<[u32; 3]> = triangles
            .iter()
            .map(|corners| {
                corners.map(|v| {
                    *new_index.entry(v).or_insert_with(|| {
                        kept.push(vertices[v as usize]);
                        kept.len() as u32 - 1
                    })
                })
            })
            .collect();
        Self::new(&kept, &renumbered)
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.panels.len()
    }

    /// Whether there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.panels.is_empty()
    }

    /// Working space for [`Self::doublets`] and [`Self::doublets_and_sources`].
    pub fn scratch(&self) -> PanelScratch {
        PanelScratch {
            offsets: vec![Vec3::zeros(); self.vertices.len()],
            distances: vec![0.0; self.vertices.len()],
            logarithms: vec![0.0; self.edges.len()],
            source_edges: vec![0.0; self.edges.len()],
        }
    }

    /// D of every triangle's corners at `point`; `out` has one entry a triangle.
    pub fn doublets(&self, point: Vec3, scratch: &mut PanelScratch, out: &mut [CornerValues]) {
        self.distances_and_logarithms(point, scratch);
        for (panel, value) in self.panels.iter().zip(out) {
            *value = panel.doublet(&panel.foot(&scratch.view(panel)));
        }
    }

    /// D and S of every triangle's corners at `point`.
    pub fn doublets_and_sources(
        &self,
        point: Vec3,
        scratch: &mut PanelScratch,
        doublets: &mut [CornerValues],
        sources: &mut [CornerValues],
    ) {
        self.distances_and_logarithms(point, scratch);
        self.source_edge_terms(scratch);
        for ((panel, d), s) in self.panels.iter().zip(doublets).zip(sources) {
            let foot = panel.foot(&scratch.view(panel));
            *d = panel.doublet(&foot);
            *s = panel.source(&foot, panel.edges.map(|e| scratch.source_edges[e as usize]));
        }
    }

    /// D and S of one triangle's corners at `point`, without working space.
    pub fn one(&self, triangle: usize, point: Vec3) -> (CornerValues, CornerValues) {
        let panel = &self.panels[triangle];
        let offsets = panel.corners.map(|v| self.vertices[v as usize] - point);
        let distances = offsets.map(|d| d.norm());
        let edges = panel.edges.map(|e| &self.edges[e as usize]);
        let mut logarithms = [0.0; 3];
        let mut source_edges = [0.0; 3];
        for (i, edge) in edges.iter().enumerate() {
            let (mut a, mut b) = ((i + 1) % 3, (i + 2) % 3);
            if panel.corners[a] != edge.ends[0] {
                (a, b) = (b, a);
            }
            logarithms[i] = edge.logarithm(distances[a], distances[b]);
            source_edges[i] =
                edge.source_term(&offsets[a], distances[a], distances[b], logarithms[i]);
        }
        let foot = panel.foot(&View {
            offsets,
            distances,
            logarithms,
        });
        (panel.doublet(&foot), panel.source(&foot, source_edges))
    }

    fn distances_and_logarithms(&self, point: Vec3, scratch: &mut PanelScratch) {
        for ((vertex, d), r) in self
            .vertices
            .iter()
            .zip(&mut scratch.offsets)
            .zip(&mut scratch.distances)
        {
            *d = vertex - point;
            *r = d.norm();
        }
        for (edge, logarithm) in self.edges.iter().zip(&mut scratch.logarithms) {
            let [a, b] = edge.ends.map(|v| scratch.distances[v as usize]);
            *logarithm = edge.logarithm(a, b);
        }
    }

    fn source_edge_terms(&self, scratch: &mut PanelScratch) {
        let PanelScratch {
            offsets,
            distances,
            logarithms,
            source_edges,
        } = scratch;
        for ((edge, l), j) in self.edges.iter().zip(logarithms).zip(source_edges) {
            let [a, b] = edge.ends.map(|v| v as usize);
            *j = edge.source_term(&offsets[a], distances[a], distances[b], *l);
        }
    }
}

/// Corners and edges of one triangle seen from a point.
struct View {
    offsets: [Vec3; 3],
    distances: [f64; 3],
    logarithms: [f64; 3],
}

impl PanelScratch {
    fn view(&self, panel: &Panel) -> View {
        View {
            offsets: panel.corners.map(|v| self.offsets[v as usize]),
            distances: panel.corners.map(|v| self.distances[v as usize]),
            logarithms: panel.edges.map(|e| self.logarithms[e as usize]),
        }
    }
}

/// Foot of a field point in the plane of one triangle.
struct Foot {
    height: f64,
    solid_angle: f64,
    shape: [f64; 3],
    logarithms: [f64; 3],
}

impl Panel {
    fn new(
        vertices: &[Vec3],
        corners: [u32; 3],
        edge_index: &mut HashMap<(u32, u32), u32>,
        edges: &mut Vec<SharedEdge>,
    ) -> Self {
        let p = corners.map(|v| vertices[v as usize]);
        let area_vector = (p[1] - p[0]).cross(&(p[2] - p[0]));
        let twice_area = area_vector.norm();
        let normal = area_vector / twice_area;
        let sides: [Vec3; 3] = std::array::from_fn(|e| p[(e + 2) % 3] - p[(e + 1) % 3]);
        let lengths = sides.map(|s| s.norm());
        let outward: [Vec3; 3] =
            std::array::from_fn(|e| (sides[e] / lengths[e]).cross(&normal));
        let gradients: [Vec3; 3] =
            std::array::from_fn(|i| outward[i] * (-lengths[i] / twice_area));
        let edge_ids = std::array::from_fn(|e| {
            let (a, b) = (corners[(e + 1) % 3], corners[(e + 2) % 3]);
            let ends = [a.min(b), a.max(b)];
            *edge_index.entry((ends[0], ends[1])).or_insert_with(|| {
                let [first, second] = ends.map(|v| vertices[v as usize]);
                edges.push(SharedEdge {
                    ends,
                    length: lengths[e],
                    tangent: (second - first) / lengths[e],
                });
                edges.len() as u32 - 1
            })
        });
        Self {
            corners,
            edges: edge_ids,
            normal,
            twice_area,
            coplanar: COPLANAR * lengths.into_iter().fold(0.0, f64::max)
                + ROUNDING * p.iter().map(Vec3::amax).fold(0.0, f64::max),
            gradients,
            slopes: std::array::from_fn(|i| {
                std::array::from_fn(|e| gradients[i].dot(&outward[e]))
            }),
            heights: lengths.map(|l| twice_area / l),
        }
    }

    fn foot(&self, view: &View) -> Foot {
        let [r0, r1, r2] = view.distances;
        let [d0, d1, d2] = view.offsets;
        let logarithms = view.logarithms;
        // Everything is measured from a corner: n·P − n·v₀ would lose digits far from
        // the origin.
        let height = -self.normal.dot(&d0);
        let first = 1.0 - self.gradients[0].dot(&d0);
        let second = -self.gradients[1].dot(&d0);
        let shape = [first, second, 1.0 - first - second];
        if height.abs() < self.coplanar {
            return Foot {
                height: 0.0,
                solid_angle: 0.0,
                shape,
                logarithms,
            };
        }
        let base = r0 * r1 * r2 + d0.dot(&d1) * r2 + d1.dot(&d2) * r0 + d2.dot(&d0) * r1;
        let solid_angle = 2.0 * (self.twice_area * height).atan2(base);
        Foot {
            height,
            solid_angle,
            shape,
            logarithms,
        }
    }

    fn doublet(&self, foot: &Foot) -> CornerValues {
        std::array::from_fn(|i| {
            let edges = weighted_sum(&self.slopes[i], &foot.logarithms);
            INVERSE_FOUR_PI * (foot.shape[i] * foot.solid_angle - foot.height * edges)
        })
    }

    fn source(&self, foot: &Foot, j: [f64; 3]) -> CornerValues {
        let inverse_distance = (0..3)
            .map(|e| foot.shape[e] * self.heights[e] * foot.logarithms[e])
            .sum::<f64>()
            - foot.height * foot.solid_angle;
        std::array::from_fn(|i| {
            INVERSE_FOUR_PI
                * (foot.shape[i] * inverse_distance + weighted_sum(&self.slopes[i], &j))
        })
    }
}

fn weighted_sum(weights: &[f64; 3], values: &[f64; 3]) -> f64 {
    weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2]
}
