//! The reduced transfer model: Q at any complex s from small blocks.
//!
//! With A₀ the body operator, K the selector κ = Kᵀφ, W(s) = Σ_r e^{−sξ_r} W_r the wake and
//! L = A₀⁻ᵀ [K, P0, P1], everything of the size of the mesh is contracted once:
//!
//! H(s) = Σ_r e^{−sξ_r} Lᵀ T W_r, b(s) = A₀⁻¹(−S[σ(s)]) = s b₁ + b₀,
//! κ(s) = (I − H_K)⁻¹ Kᵀ b(s),
//! Q(s) = 2 { [P0 + s P1]ᵀ b(s) + [H_P0 + s H_P1] κ(s) + s C1 + C0 }.
//!
//! It is an identity (Woodbury), not an approximation: the test against the complex
//! solve of the whole system gives 1e-14.

use crate::contour::{Path, SECTOR_LIMIT_DEG};
use crate::error::LaplaceError;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par, c64};
use serde::{Deserialize, Serialize};

/// Pressure coefficient against the pressure in units of ρU²: c_p = 2p.
const COEFFICIENT: f64 = 2.0;

/// A real matrix by columns, as it is stored.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Block {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

impl Block {
    pub(crate) fn new(matrix: MatRef<'_, f64>) -> Self {
        let values = (0..matrix.ncols())
            .flat_map(|j| (0..matrix.nrows()).map(move |i| matrix[(i, j)]))
            .collect();
        Self {
            rows: matrix.nrows(),
            columns: matrix.ncols(),
            values,
        }
    }

    fn view(&self) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice(&self.values, self.rows, self.columns)
    }

    fn is_sound(&self, rows: usize, columns: usize) -> bool {
        self.rows == rows && self.columns == columns && self.values.len() == rows * columns
    }
}

/// Near rows of the wake: the columns of H that go with e^{−sξ}.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct NearBlocks {
    pub(crate) stations: Vec<f64>,
    /// Column and station of each entry.
    pub(crate) entries: Vec<(u32, u32)>,
    /// One functional vector an entry.
    pub(crate) values: Vec<f64>,
}

/// The far wake on one path.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct FarBlocks {
    /// ξ of each node.
    nodes: Vec<(f64, f64)>,
    /// Real parts, node by node, column by column, one functional vector each.
    re: Vec<f64>,
    /// Imaginary parts.
    im: Vec<f64>,
}

impl FarBlocks {
    /// `re` and `im` in the order of the fields.
    pub(crate) fn new(path: &Path, re: Vec<f64>, im: Vec<f64>) -> Self {
        let nodes = path.nodes.iter().map(|n| (n.re, n.im)).collect();
        Self { nodes, re, im }
    }

    /// Adds Σ e^{−sξ} (re + i im) to `sum`, whose two columns are real and imaginary part.
    fn add(&self, s: c64, sum: &mut Mat<f64>) {
        let (rows, nodes) = (sum.nrows(), self.nodes.len());
        let decay = |i: usize| (-s * c64::new(self.nodes[i].0, self.nodes[i].1)).exp();
        let real = Mat::from_fn(
            nodes,
            2,
            |i, j| if j == 0 { decay(i).re } else { decay(i).im },
        );
        let turned = Mat::from_fn(
            nodes,
            2,
            |i, j| if j == 0 { -decay(i).im } else { decay(i).re },
        );
        for (part, weights) in [(&self.re, &real), (&self.im, &turned)] {
            let part = MatRef::from_column_major_slice(part, rows, nodes);
            matmul(sum.as_mut(), Accum::Add, part, weights, 1.0, Par::Seq);
        }
    }
}

/// Everything that Q(s) needs, free of the mesh.
///
/// Serialisable; after reading one from elsewhere ask [`Self::is_sound`] first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TransferModel {
    pub(crate) semichord: f64,
    pub(crate) modes: usize,
    pub(crate) columns: usize,
    /// Kᵀ b₁ and Kᵀ b₀.
    pub(crate) jump1: Block,
    pub(crate) jump0: Block,
    /// P0ᵀ b₁, P0ᵀ b₀, P1ᵀ b₁, P1ᵀ b₀.
    pub(crate) p0_b1: Block,
    pub(crate) p0_b0: Block,
    pub(crate) p1_b1: Block,
    pub(crate) p1_b0: Block,
    pub(crate) c1: Block,
    pub(crate) c0: Block,
    pub(crate) near: NearBlocks,
    pub(crate) oscillating: FarBlocks,
    pub(crate) decaying: FarBlocks,
}

impl TransferModel {
    /// Number of modes, the size of Q.
    pub fn n_modes(&self) -> usize {
        self.modes
    }

    /// Reference semichord b in p = s b / U, m.
    pub fn semichord(&self) -> f64 {
        self.semichord
    }

    /// Whether all blocks have the sizes they must have and finite values.
    pub fn is_sound(&self) -> bool {
        let (m, n, f) = (self.modes, self.columns, self.functionals());
        let finite = |values: &[f64]| values.iter().all(|v| v.is_finite());
        let square = [
            &self.p0_b1,
            &self.p0_b0,
            &self.p1_b1,
            &self.p1_b0,
            &self.c1,
            &self.c0,
        ];
        let near = &self.near;
        self.semichord.is_finite()
            && self.semichord > 0.0
            && self.jump1.is_sound(n, m)
            && self.jump0.is_sound(n, m)
            && square.iter().all(|b| b.is_sound(m, m) && finite(&b.values))
            && finite(&self.jump1.values)
            && finite(&self.jump0.values)
            && finite(&near.stations)
            && finite(&near.values)
            && near.values.len() == near.entries.len() * f
            && near
                .entries
                .iter()
                .all(|&(c, s)| (c as usize) < n && (s as usize) < near.stations.len())
            && [&self.oscillating, &self.decaying].iter().all(|far| {
                let size = far.nodes.len() * n * f;
                far.re.len() == size
                    && far.im.len() == size
                    && far
                        .nodes
                        .iter()
                        .all(|(re, im)| re.is_finite() && im.is_finite())
                    && finite(&far.re)
                    && finite(&far.im)
            })
    }

    fn functionals(&self) -> usize {
        self.columns + 2 * self.modes
    }

    /// Q(p), whole aircraft, m² for unit-metre modes: row force, column motion.
    ///
    /// p = g + ik = s b / U, anywhere but on the branch cut g < 0, k = 0; for k < 0 the
    /// conjugate; on the real axis real.
    ///
    /// # Errors
    /// [`LaplaceError`] on the cut, for values that are no numbers, at a pole, and where the
    /// motion decays too fast (beyond about |g| = 12 b / reach, reach the wake's width).
    pub fn q(&self, p: c64) -> Result<Mat<c64>, LaplaceError> {
        let (g, k) = (p.re, p.im);
        if !g.is_finite() || !k.is_finite() {
            return Err(LaplaceError::NotFinite { g, k });
        }
        if k == 0.0 && g < 0.0 {
            return Err(LaplaceError::BranchCut { g });
        }
        let s = c64::new(g, k.abs()) / self.semichord;
        if self.columns > 0 && !Path::keeps_digits(&self.far(s).nodes, s) {
            return Err(LaplaceError::TooDamped { g, k });
        }
        let mut q = self.evaluate(s).ok_or(LaplaceError::Singular { g, k })?;
        for j in 0..self.modes {
            for i in 0..self.modes {
                if k == 0.0 {
                    q[(i, j)].im = 0.0;
                } else if k < 0.0 {
                    q[(i, j)].im = -q[(i, j)].im;
                }
            }
        }
        Ok(q)
    }

    fn evaluate(&self, s: c64) -> Option<Mat<c64>> {
        let (m, n) = (self.modes, self.columns);
        let linear = |one: &Block, zero: &Block| {
            let (one, zero) = (one.view(), zero.view());
            Mat::from_fn(one.nrows(), one.ncols(), |i, j| {
                s * one[(i, j)] + zero[(i, j)]
            })
        };
        let quadratic = linear(&self.p1_b1, &self.p1_b0);
        let mut q = linear(&self.p0_b1, &self.p0_b0) + linear(&self.c1, &self.c0);
        q += Mat::from_fn(m, m, |i, j| s * quadratic[(i, j)]);
        if n > 0 {
            let h = self.wake_response(s);
            let system = Mat::from_fn(n, n, |i, j| {
                let unit = if i == j { 1.0 } else { 0.0 };
                unit - h[(i, j)]
            });
            let jumps = solve_complex(system, linear(&self.jump1, &self.jump0))?;
            let rows = Mat::from_fn(m, n, |i, j| h[(n + i, j)] + s * h[(n + m + i, j)]);
            matmul(
                &mut q,
                Accum::Add,
                &rows,
                &jumps,
                c64::new(1.0, 0.0),
                Par::Seq,
            );
        }
        for j in 0..m {
            for i in 0..m {
                q[(i, j)] *= COEFFICIENT;
            }
        }
        Some(q)
    }

    /// H(s): functionals × columns.
    fn wake_response(&self, s: c64) -> Mat<c64> {
        let f = self.functionals();
        let mut h = Mat::<f64>::zeros(f * self.columns, 2);
        self.far(s).add(s, &mut h);
        let decay: Vec<c64> = self
            .near
            .stations
            .iter()
            .map(|xi| (-s * xi).exp())
            .collect();
        let (mut re, mut im) = (vec![0.0; f * self.columns], vec![0.0; f * self.columns]);
        for (&(column, station), values) in self
            .near
            .entries
            .iter()
            .zip(self.near.values.chunks_exact(f))
        {
            let factor = decay[station as usize];
            let range = column as usize * f..(column as usize + 1) * f;
            for (total, value) in re[range.clone()].iter_mut().zip(values) {
                *total += factor.re * value;
            }
            for (total, value) in im[range].iter_mut().zip(values) {
                *total += factor.im * value;
            }
        }
        Mat::from_fn(f, self.columns, |i, j| {
            let at = j * f + i;
            c64::new(h[(at, 0)] + re[at], h[(at, 1)] + im[at])
        })
    }

    /// The path whose sector holds arg s.
    fn far(&self, s: c64) -> &FarBlocks {
        if s.arg().to_degrees() <= SECTOR_LIMIT_DEG {
            &self.oscillating
        } else {
            &self.decaying
        }
    }
}

/// X with A X = B, or none where A is singular to working precision.
pub(crate) fn solve_complex(mut a: Mat<c64>, mut b: Mat<c64>) -> Option<Mat<c64>> {
    let n = a.nrows();
    let mut forward = vec![0usize; n];
    let mut inverse = vec![0usize; n];
    let mut memory = MemBuffer::new(faer::dyn_stack::StackReq::any_of(&[
        factor::lu_in_place_scratch::<usize, c64>(n, n, Par::Seq, faer::Spec::default()),
        solve::solve_in_place_scratch::<usize, c64>(n, b.ncols(), Par::Seq),
    ]));
    let stack = MemStack::new(&mut memory);
    let (_, permutation) = factor::lu_in_place(
        a.as_mut(),
        &mut forward,
        &mut inverse,
        Par::Seq,
        stack,
        faer::Spec::default(),
    );
    let smallest = (0..n)
        .map(|i| a[(i, i)].norm())
        .fold(f64::INFINITY, f64::min);
    if n > 0 && (smallest.is_nan() || smallest < f64::MIN_POSITIVE) {
        return None;
    }
    solve::solve_in_place(
        a.as_ref(),
        a.as_ref(),
        permutation,
        b.as_mut(),
        Par::Seq,
        stack,
    );
    Some(b)
}
