//! The reduced transfer model: Q at any complex s, in any stream, from small blocks.
//!
//! With A₀ the body operator, K the selector κ = Kᵀφ, W(s) = Σ_r e^{−sξ_r} W_r the wake and
//! L = A₀⁻ᵀ [K, P0, P1], everything of the size of the mesh is contracted once:
//!
//! H(s) = Σ_r e^{−sξ_r} Lᵀ T W_r + s E, b(s) = A₀⁻¹(−S[σ(s)]) = s b₁ + b₀,
//! κ(s) = (I − H_K)⁻¹ Kᵀ b(s),
//! Q(s) = 2 { [P0 + s P1]ᵀ b(s) + [H_P0 + s H_P1] κ(s) + s C1 + C0 }.
//!
//! It is an identity (Woodbury), not an approximation: the test against the complex
//! solve of the whole system gives 1e-14.
//!
//! P0, b₀ and C1 are linear and C0 is quadratic in the stream U. Where the wake does not
//! follow the stream they are kept for the unit onsets, P0 = Σ_a U_a P0_a, and Q(s; U) is
//! as exact at every incidence as at the one computed.

use crate::blocks::{Block, FarBlocks, NearBlocks};
use crate::contour::{Path, SECTOR_LIMIT_DEG};
use crate::error::LaplaceError;
use crate::onset::OnsetBasis;
use crate::solve::Flow;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par, c64};
use serde::{Deserialize, Serialize};

/// Everything that Q(s) needs, free of the mesh.
///
/// Serialisable; after reading one from elsewhere ask [`Self::is_sound`] first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TransferModel {
    pub(crate) semichord: f64,
    pub(crate) modes: usize,
    pub(crate) columns: usize,
    pub(crate) basis: OnsetBasis,
    /// Incidence computed for.
    pub(crate) flow: Flow,
    /// 2 of c_p = 2p, twice that for half models.
    pub(crate) factor: f64,
    /// Kᵀ b₁, and Kᵀ b₀ of each onset.
    pub(crate) jump1: Block,
    pub(crate) jump0: Vec<Block>,
    /// P0_aᵀ b₁, P0_aᵀ b₀_b (at a · onsets + b), P1ᵀ b₁, P1ᵀ b₀_a.
    pub(crate) p0_b1: Vec<Block>,
    pub(crate) p0_b0: Vec<Block>,
    pub(crate) p1_b1: Block,
    pub(crate) p1_b0: Vec<Block>,
    pub(crate) c1: Vec<Block>,
    /// At a · onsets + b.
    pub(crate) c0: Vec<Block>,
    /// Functionals: columns, then modes of P0 for each onset, then modes of P1.
    pub(crate) near: NearBlocks,
    /// By s: slopes of the jumps at trailing edges.
    pub(crate) slopes: Block,
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

    /// Incidence at which [`Self::q`] is taken.
    pub fn flow(&self) -> Flow {
        self.flow
    }

    /// Whether [`Self::q_at`] can be asked for other incidences.
    pub fn serves(&self, flow: Flow) -> bool {
        self.basis.components(flow.stream()).is_some()
    }

    /// Whether all blocks have the sizes they must have and finite values.
    pub fn is_sound(&self) -> bool {
        let (m, n, f, onsets) = (
            self.modes,
            self.columns,
            self.functionals(),
            self.basis.len(),
        );
        let all = |blocks: &[Block], count: usize, rows: usize| {
            blocks.len() == count && blocks.iter().all(|b| b.is_sound(rows, m))
        };
        self.semichord.is_finite()
            && self.semichord > 0.0
            && self.factor.is_finite()
            && self.basis.is_sound()
            && self.serves(self.flow)
            && self.jump1.is_sound(n, m)
            && all(&self.jump0, onsets, n)
            && all(&self.p0_b1, onsets, m)
            && all(&self.p0_b0, onsets * onsets, m)
            && self.p1_b1.is_sound(m, m)
            && all(&self.p1_b0, onsets, m)
            && all(&self.c1, onsets, m)
            && all(&self.c0, onsets * onsets, m)
            && self.near.is_sound(f, n)
            && self.slopes.is_sound(f, n)
            && self.oscillating.is_sound(f, n)
            && self.decaying.is_sound(f, n)
    }

    fn functionals(&self) -> usize {
        self.columns + (self.basis.len() + 1) * self.modes
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
        self.q_at(p, self.flow)
    }

    /// Q(p) at another incidence, from the same factorisation and as exact.
    ///
    /// The wake stays where it is: it must lie along x, or be none (sideslip only where
    /// the model was made with some).
    ///
    /// # Errors
    /// As [`Self::q`], and [`LaplaceError::OtherIncidence`] where [`Self::serves`] says no.
    pub fn q_at(&self, p: c64, flow: Flow) -> Result<Mat<c64>, LaplaceError> {
        let mut each = self.q_at_each(p, &[flow])?;
        Ok(each.remove(0))
    }

    /// Q(p) at several incidences: the response of the wake, which is most of the work, is
    /// evaluated once.
    ///
    /// # Errors
    /// As [`Self::q_at`].
    pub fn q_at_each(&self, p: c64, flows: &[Flow]) -> Result<Vec<Mat<c64>>, LaplaceError> {
        let (g, k) = (p.re, p.im);
        if !g.is_finite() || !k.is_finite() {
            return Err(LaplaceError::NotFinite { g, k });
        }
        if k == 0.0 && g < 0.0 {
            return Err(LaplaceError::BranchCut { g });
        }
        let stream = |flow: &Flow| {
            self.basis
                .components(flow.stream())
                .ok_or(LaplaceError::OtherIncidence {
                    alpha_deg: flow.alpha.to_degrees(),
                    beta_deg: flow.beta.to_degrees(),
                })
        };
        let streams: Vec<Vec<f64>> = flows.iter().map(stream).collect::<Result<_, _>>()?;
        let s = c64::new(g, k.abs()) / self.semichord;
        if self.columns > 0 && !Path::keeps_digits(&self.far(s).nodes, s) {
            return Err(LaplaceError::TooDamped { g, k });
        }
        let response = (self.columns > 0).then(|| self.wake_response(s));
        let evaluate = |stream: &Vec<f64>| {
            let mut q = self
                .evaluate(s, stream, response.as_ref())
                .ok_or(LaplaceError::Singular { g, k })?;
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
        };
        streams.iter().map(evaluate).collect()
    }

    /// Q(s) for a stream given by its components along the onsets and H(s), where there is
    /// a wake.
    fn evaluate(
        &self,
        s: c64,
        stream: &[f64],
        response: Option<&Mat<c64>>,
    ) -> Option<Mat<c64>> {
        let (m, n) = (self.modes, self.columns);
        let once = |blocks: &[Block]| combine(blocks, stream);
        let pairs: Vec<f64> = stream
            .iter()
            .flat_map(|a| stream.iter().map(move |b| a * b))
            .collect();
        let twice = |blocks: &[Block]| combine(blocks, &pairs);
        let constant = twice(&self.p0_b0) + twice(&self.c0);
        let linear = once(&self.p0_b1) + once(&self.p1_b0) + once(&self.c1);
        let quadratic = self.p1_b1.view();
        let mut q = Mat::from_fn(m, m, |i, j| {
            s * (s * quadratic[(i, j)] + linear[(i, j)]) + constant[(i, j)]
        });
        if let Some(h) = response {
            let system = Mat::from_fn(n, n, |i, j| {
                let unit = if i == j { 1.0 } else { 0.0 };
                unit - h[(i, j)]
            });
            let (jump1, jump0) = (self.jump1.view(), once(&self.jump0));
            let jumps = Mat::from_fn(n, m, |i, j| s * jump1[(i, j)] + jump0[(i, j)]);
            let jumps = solve_complex(system, jumps)?;
            let last = n + stream.len() * m;
            let rows = Mat::from_fn(m, n, |i, j| {
                let mut row = s * h[(last + i, j)];
                for (a, u) in stream.iter().enumerate() {
                    row += h[(n + a * m + i, j)] * *u;
                }
                row
            });
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
                q[(i, j)] *= self.factor;
            }
        }
        Some(q)
    }

    /// H(s): functionals × columns.
    fn wake_response(&self, s: c64) -> Mat<c64> {
        let f = self.functionals();
        let mut h = Mat::<f64>::zeros(f * self.columns, 2);
        self.far(s).add(s, &mut h);
        self.near.add(s, f, &mut h);
        let slopes = self.slopes.view();
        Mat::from_fn(f, self.columns, |i, j| {
            s * slopes[(i, j)] + c64::new(h[(j * f + i, 0)], h[(j * f + i, 1)])
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

/// Σ weight · block.
fn combine(blocks: &[Block], weights: &[f64]) -> Mat<f64> {
    let first = blocks[0].view();
    Mat::from_fn(first.nrows(), first.ncols(), |i, j| {
        blocks
            .iter()
            .zip(weights)
            .map(|(block, weight)| weight * block.view()[(i, j)])
            .sum()
    })
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
