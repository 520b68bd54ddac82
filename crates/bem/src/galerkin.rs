//! Galerkin rows of the boundary integral equation.
//!
//! On the surface, with n out of the body and σ = ∂φ/∂n,
//! $$ c\,\varphi - D[\varphi] - W[\kappa] = -S[\sigma], \qquad c = 1 + D[1]. $$
//! The free term c follows from the row sum of D over the closed surface, at vertices,
//! sharp edges and inside triangles alike. The equation is taken at three interior
//! points q of each triangle, (2/3, 1/6, 1/6) and its turns, and tested with the hat
//! functions: Σ_t A_t/3 Σ_q Nᵢ(q) {…}, divided by the test function's weight.
//! With a plane of symmetry D and S are those of both halves, the other half being seen as
//! the given one from the point's image ([`crate::image`]).
//! One point a triangle has a null space on right-angled meshes; collocation at the
//! vertices loses lift on thin wings. Panels near a test triangle are integrated with more
//! points ([`crate::near_field`]).

use crate::cut::CutSurface;
use crate::edge_cells::EdgeCells;
use crate::image::{self, Image};
use crate::lanes::WIDTH;
use crate::near_field::{POINTS, TestTriangle};
use crate::ordering::spatial_order;
use crate::panel_block::{BLOCK, PanelBlock};
use crate::regions::{Regions, TOGETHER};
use crate::skeleton::TOLERANCE;
use crate::tiles::vertex_blocks;
use crate::tiles::{CLUSTER, TestCluster};
use fladder_mesh::Vec3;
use rayon::prelude::*;

/// Triangles of a surface up to which every influence is evaluated at every test point: it
/// takes a second or two, and what is zero by symmetry stays zero to rounding.
const EVALUATED_EVERYWHERE: usize = 4096;

/// Test triangles of the regions' levels, of a cluster, of a block of panels, of a group.
const RUNS: [usize; 5] = [
    TOGETHER * TOGETHER * CLUSTER,
    TOGETHER * CLUSTER,
    CLUSTER,
    BLOCK,
    WIDTH,
];

/// Normals, areas, gradients and test points of a cut surface.
#[derive(Clone, Debug)]
pub(crate) struct Galerkin {
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) n_vertices: usize,
    pub(crate) normals: Vec<Vec3>,
    pub(crate) areas: Vec<f64>,
    /// ∇Nᵢ of each triangle.
    pub(crate) gradients: Vec<[Vec3; 3]>,
    /// Weight of each test function: a third of the areas round its vertex.
    pub(crate) weights: Vec<f64>,
    /// Where each triangle is tested.
    pub(crate) tests: Vec<TestTriangle>,
    /// The other half of the surface, if only one is given.
    pub(crate) image: Image,
    /// The test points' images: what they see of the given half, the points see of the
    /// other. Empty without image.
    pub(crate) image_tests: Vec<TestTriangle>,
    /// Vertices whose potential is zero by antisymmetry.
    constrained: Vec<bool>,
    /// Test triangles, close ones together.
    pub(crate) clusters: Vec<TestCluster>,
    /// Of far influences.
    pub(crate) tolerance: f64,
    /// Clusters together, for what is far from them.
    pub(crate) regions: Regions,
    /// The surface in blocks of close triangles, and behind them the parts of the cells
    /// along trailing edges.
    pub(crate) blocks: Vec<PanelBlock>,
    /// What the cells along trailing edges have besides.
    pub(crate) edge_cells: EdgeCells,
}

impl Galerkin {
    /// With far influences to the rounding of what is done with them.
    pub(crate) fn new(surface: &CutSurface, image: Image) -> Self {
        Self::with_tolerance(surface, image, TOLERANCE)
    }

    /// `tolerance`: that of [`crate::skeleton`].
    pub(crate) fn with_tolerance(surface: &CutSurface, image: Image, tolerance: f64) -> Self {
        let n_vertices = surface.vertices.len();
        let mut weights = vec![0.0; n_vertices];
        let mut normals = Vec::new();
        let mut areas = Vec::new();
        let mut gradients = Vec::new();
        let mut tests = Vec::new();
        let mut image_tests = Vec::new();
        for corners in &surface.triangles {
            let p = corners.map(|v| surface.vertices[v as usize]);
            let vector = (p[1] - p[0]).cross(&(p[2] - p[0]));
            let twice_area = vector.norm();
            let normal = vector / twice_area;
            normals.push(normal);
            areas.push(0.5 * twice_area);
            gradients.push(std::array::from_fn(|i| {
                normal.cross(&(p[(i + 2) % 3] - p[(i + 1) % 3])) / twice_area
            }));
            tests.push(TestTriangle::new(&p));
            if image.sign().is_some() {
                image_tests.push(TestTriangle::new(&p.map(|x| image::mirrored(&x))));
            }
            for &v in corners {
                weights[v as usize] += twice_area / 6.0;
            }
        }
        let centres: Vec<Vec3> = surface
            .triangles
            .iter()
            .map(|t| {
                t.iter()
                    .map(|&v| surface.vertices[v as usize])
                    .sum::<Vec3>()
                    / 3.0
            })
            .collect();
        let order = spatial_order(&centres, RUNS);
        let mut blocks = vertex_blocks(&surface.vertices, &surface.triangles, &order);
        let edge_cells = EdgeCells::new(surface, &mut blocks);
        let mut galerkin = Self {
            triangles: surface.triangles.clone(),
            n_vertices,
            normals,
            areas,
            gradients,
            weights,
            tests,
            image,
            image_tests,
            constrained: surface
                .vertices
                .iter()
                .map(|v| image == Image::Odd && image::on_plane(v))
                .collect(),
            clusters: Vec::new(),
            tolerance,
            regions: Regions::default(),
            blocks,
            edge_cells,
        };
        let is_large = order.len() > EVALUATED_EVERYWHERE;
        galerkin.clusters = order
            .par_chunks(CLUSTER)
            .map(|triangles| {
                if is_large {
                    TestCluster::receiving(&galerkin, triangles)
                } else {
                    TestCluster::new(&galerkin, triangles)
                }
            })
            .collect();
        galerkin.regions = Regions::new(&galerkin.clusters, image, tolerance);
        galerkin
    }

    pub(crate) fn n_triangles(&self) -> usize {
        self.triangles.len()
    }

    /// Vertices whose potential is zero.
    pub(crate) fn constrained(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.n_vertices).filter(|&v| self.constrained[v])
    }

    /// Weight of test function `corner` of a triangle at test point `q`; zero where the
    /// potential is given.
    pub(crate) fn test_weight(&self, triangle: usize, q: usize, corner: usize) -> f64 {
        let vertex = self.triangles[triangle][corner] as usize;
        if self.constrained[vertex] {
            return 0.0;
        }
        self.areas[triangle] / 3.0 * POINTS[q][corner] / self.weights[vertex]
    }
}
