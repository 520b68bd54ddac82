//! Pieces of the computation by themselves, for measurements of their speed.
//!
//! Nothing else needs them; they may change with any version.

use crate::blocked_lu::BlockedLu;
use crate::galerkin::Galerkin;
use crate::image::Image;
use crate::lanes::WIDTH;
use crate::panel_block::{BlockScratch, PanelBlock, Points, enclosing};
use crate::panels::PanelSet;
use crate::tiles::{Tile, TileScratch, vertex_blocks};
use crate::wake::cut_and_wake;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use fladder_mesh::{TrailingEdge, TriMesh, Vec3};
use pulp::Arch;
use rayon::prelude::*;

/// Instructions for which the kernel was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instructions {
    /// One number at a time.
    Scalar,
    /// AVX2 with fused multiply-add: four.
    Avx2,
    /// AVX-512: eight.
    Avx512,
}

impl Instructions {
    /// Those that this processor has.
    pub fn available() -> Vec<Self> {
        [Self::Scalar, Self::Avx2, Self::Avx512]
            .into_iter()
            .filter(|i| *i == Self::Scalar || i.arch().is_some())
            .collect()
    }

    #[cfg(target_arch = "x86_64")]
    fn arch(self) -> Option<Arch> {
        match self {
            Self::Scalar => Some(Arch::Scalar),
            Self::Avx2 => pulp::x86::V3::try_new().map(Arch::V3),
            Self::Avx512 => pulp::x86::V4::try_new().map(Arch::V4),
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn arch(self) -> Option<Arch> {
        (self == Self::Scalar).then(Arch::new)
    }
}

/// A block of panels seen from eight points, near or far.
#[derive(Debug)]
pub struct PanelPairs {
    scalar: PanelSet,
    block: PanelBlock,
    points: Points,
    far: bool,
    scratch: BlockScratch,
    doublets: Vec<f64>,
    sources: Vec<f64>,
}

impl PanelPairs {
    /// The first block of a mesh; `distance` in its radii from its centre.
    pub fn new(mesh: &TriMesh, distance: f64) -> Self {
        let order: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
        let block = vertex_blocks(&mesh.vertices, &mesh.triangles, &order).swap_remove(0);
        let first = &mesh.triangles[..block.triangles.len()];
        let at: Vec<Vec3> = (0..WIDTH)
            .map(|l| {
                let angle = l as f64 * 0.1;
                block.centre
                    + distance * block.radius * Vec3::new(angle.cos(), angle.sin(), 0.3)
            })
            .collect();
        let (centre, radius) = enclosing(&at);
        Self {
            scalar: PanelSet::compact(&mesh.vertices, first),
            points: std::array::from_fn(|a| std::array::from_fn(|l| at[l][a])),
            far: block.is_far(centre, radius),
            scratch: BlockScratch::default(),
            doublets: vec![0.0; block.places() * WIDTH],
            sources: vec![0.0; 3 * block.triangles.len() * WIDTH],
            block,
        }
    }

    /// Pairs of a point and a triangle in one evaluation.
    pub fn len(&self) -> usize {
        WIDTH * self.block.triangles.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the series for far blocks serve.
    pub fn is_far(&self) -> bool {
        self.far
    }

    /// D and S of all pairs by the scalar functions; their sum.
    pub fn scalar(&self) -> f64 {
        let mut scratch = self.scalar.scratch();
        let mut doublets = vec![[0.0; 3]; self.scalar.len()];
        let mut sources = doublets.clone();
        let mut sum = 0.0;
        for l in 0..WIDTH {
            let point = Vec3::new(self.points[0][l], self.points[1][l], self.points[2][l]);
            self.scalar
                .doublets_and_sources(point, &mut scratch, &mut doublets, &mut sources);
            sum += doublets[0][0] + sources[0][0];
        }
        sum
    }

    /// D and S of all pairs in lanes; `None` where the processor cannot.
    pub fn in_lanes(&mut self, instructions: Instructions) -> Option<f64> {
        let arch = instructions.arch()?;
        self.doublets.fill(0.0);
        self.block.evaluate(
            arch,
            &self.points,
            self.far,
            &mut self.scratch,
            &mut self.doublets,
            &mut self.sources,
        );
        Some(self.doublets[0] + self.sources[0])
    }
}

/// The equations of a surface, up to the tiles of a few clusters.
#[derive(Debug)]
pub struct Equations {
    galerkin: Galerkin,
    blocks: Vec<PanelBlock>,
}

impl Equations {
    /// Of a whole surface with its trailing edges.
    ///
    /// # Errors
    /// Trailing edges that allow no wake.
    pub fn new(
        mesh: &TriMesh,
        trailing_edges: &[TrailingEdge],
        semichord: f64,
    ) -> Result<Self, crate::BemError> {
        let (surface, _) =
            cut_and_wake(mesh, trailing_edges, Vec3::x(), &[], semichord, Image::None)?;
        let order: Vec<u32> = (0..surface.triangles.len() as u32).collect();
        Ok(Self {
            blocks: vertex_blocks(&surface.vertices, &surface.triangles, &order),
            galerkin: Galerkin::new(&surface, Image::None),
        })
    }

    /// Pairs of a test point and a triangle for one cluster.
    pub fn pairs_of_a_cluster(&self) -> usize {
        self.galerkin.clusters.first().map_or(0, |c| {
            3 * c.groups.iter().map(|g| g.triangles.len()).sum::<usize>()
        }) * self.galerkin.n_triangles()
    }

    /// Tested doublets and sources of all blocks on the first cluster.
    pub fn one_cluster(&self) -> f64 {
        let Some(cluster) = self.galerkin.clusters.first() else {
            return 0.0;
        };
        let (mut scratch, mut tile) = (TileScratch::default(), Tile::default());
        let mut sums = vec![[[0.0; WIDTH]; 3]; cluster.groups.len()];
        self.blocks
            .iter()
            .map(|block| {
                scratch.fill(&self.galerkin, cluster, block, true, &mut tile, &mut sums);
                tile.doublets[0] + tile.sources[0]
            })
            .sum()
    }
}

/// Factorisation of a matrix of size n, and the product that it is measured by.
#[derive(Debug)]
pub struct Factorisation<T> {
    columns: Vec<T>,
    size: usize,
}

impl Factorisation<f32> {
    /// A matrix with a heavy diagonal and irregular entries.
    pub fn new(size: usize) -> Self {
        let mut columns = vec![0.0; size * size];
        columns
            .par_chunks_exact_mut(size.max(1))
            .enumerate()
            .for_each(|(j, column)| {
                let mut state = j as u32 ^ 0x9e37_79b9;
                for (i, value) in column.iter_mut().enumerate() {
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    *value = (state >> 8) as f32 / 16_777_216.0 - 0.5;
                    if i == j {
                        *value += 30.0;
                    }
                }
            });
        Self { columns, size }
    }

    /// Floating-point operations of the factorisation.
    pub fn flops(&self) -> f64 {
        2.0 / 3.0 * (self.size as f64).powi(3)
    }

    /// Factorises a copy; the time is that of the copy too.
    pub fn factorise(&self) {
        let _ = BlockedLu::new(self.columns.clone(), self.size, &|_| {});
    }

    /// Floating-point operations of [`Self::product`].
    pub fn product_flops(&self) -> f64 {
        2.0 * (self.size as f64).powi(2) * self.product_columns() as f64
    }

    fn product_columns(&self) -> usize {
        self.size / 4
    }

    /// A times a quarter of its columns, on all threads.
    pub fn product(&self) {
        let n = self.size;
        let matrix = faer::MatRef::from_column_major_slice(&self.columns, n, n);
        let right = matrix.subcols(0, self.product_columns());
        let mut out = Mat::<f32>::zeros(n, right.ncols());
        let width = right.ncols().div_ceil(rayon::current_num_threads()).max(1);
        out.par_col_chunks_mut(width)
            .enumerate()
            .for_each(|(chunk, mut part)| {
                let right = right.subcols(chunk * width, part.ncols());
                matmul(&mut part, Accum::Replace, matrix, right, 1.0, Par::Seq);
            });
    }
}
