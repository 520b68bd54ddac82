//! The p-k method and its relatives, for comparison.
//!
//! $$ \bigl[\tilde M p^2 + \tilde C p + K - q_\infty Q_*(p, k)\bigr]x = 0,
//!    \qquad \operatorname{Im}p = k $$
//!
//! | form | $Q_*(p,k)$ |
//! |---|---|
//! | [`PkForm::Complex`] | $Q(\mathrm ik)$ as it is |
//! | [`PkForm::RealMatrices`] | $\operatorname{Re}Q + (p/k)\operatorname{Im}Q$ |
//! | [`PkForm::GMethod`] | $Q(\mathrm ik) + (p-\mathrm ik)\,\mathrm dQ/\mathrm dp$ |
//!
//! $\tilde C$ multiplies $p$ and not $\mathrm ik$: it carries the rotation
//! rates of the rigid body, and Eller's (26) is wrong for them. At fixed $k$
//! the problem is quadratic; its roots sorted by imaginary part are
//! continuous in $k$, so that $h_i(k) = \operatorname{Im}p_i(k) - k$ changes
//! sign at every solution.

use faer::{Mat, c64};

use crate::eigenpair::{Eigenpair, inverse_iteration};
use crate::linalg::{Lu, NoConvergence, apply, eigenvalues, inner, least_squares};
use crate::spline::AxisForces;
use crate::structure::{Hysteresis, Reduced};

/// How damping enters the aerodynamic matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PkForm {
    /// $Q(\mathrm ik)$ complex.
    #[default]
    Complex,
    /// Imaginary part as a real damping matrix.
    RealMatrices,
    /// First-order continuation in $g$.
    GMethod,
}

/// $|h|$ at which a root counts as found.
const TOLERANCE: f64 = 1e-10;

/// Steps below this that no longer shrink are rounding.
const ROUNDING: f64 = 1e-9;

/// Steps after which the safeguarded iteration gives up; bisection alone
/// needs 34 for the tolerance.
const MAX_STEPS: usize = 60;

/// Step in $k$ for derivatives of the matrices.
const DIFFERENCE_STEP: f64 = 1e-6;

/// Roots below this frequency are aperiodic.
const APERIODIC: f64 = 1e-9;

/// Two solutions closer than this are one.
const SAME_ROOT: f64 = 1e-7;

/// Oscillatory roots of the p-k problem and the zero roots at $k = 0$.
#[derive(Clone, Debug, Default)]
pub(crate) struct PkRoots {
    pub(crate) roots: Vec<Eigenpair>,
    pub(crate) zeros: usize,
}

/// The problem at one speed.
pub(crate) struct PkProblem<'a> {
    pub(crate) reduced: &'a Reduced,
    pub(crate) forces: &'a dyn AxisForces,
    pub(crate) form: PkForm,
}

/// $A_0 + A_1p$ beside $\tilde Mp^2$.
struct Pencil {
    a0: Mat<c64>,
    a1: Mat<c64>,
}

impl PkProblem<'_> {
    fn pencil(&self, k: f64) -> Pencil {
        let order = self.reduced.order();
        let q = self.forces.q(k);
        let (constant, linear) = match self.form {
            PkForm::Complex => {
                let none = Mat::zeros(q.nrows(), q.ncols());
                (q, none)
            }
            PkForm::RealMatrices => {
                let slope = (k.abs() < APERIODIC).then(|| self.forces.slope(k));
                let damping = Mat::from_fn(q.nrows(), q.ncols(), |i, j| {
                    let value = slope
                        .as_ref()
                        .map_or_else(|| q[(i, j)].im / k, |s| s[(i, j)].im);
                    c64::new(value, 0.0)
                });
                (
                    Mat::from_fn(q.nrows(), q.ncols(), |i, j| c64::new(q[(i, j)].re, 0.0)),
                    damping,
                )
            }
            PkForm::GMethod => {
                let slope = self.forces.slope(k);
                (
                    Mat::from_fn(q.nrows(), q.ncols(), |i, j| q[(i, j)] - slope[(i, j)] * k),
                    Mat::from_fn(q.nrows(), q.ncols(), |i, j| {
                        slope[(i, j)] * c64::new(0.0, -1.0)
                    }),
                )
            }
        };
        let (constant, linear) = (self.reduced.loads(&constant), self.reduced.loads(&linear));
        let stiffness = self.reduced.stiffness(Hysteresis::Included);
        Pencil {
            a0: &stiffness - &constant,
            a1: Mat::from_fn(order, order, |i, j| {
                self.reduced.damping[(i, j)] - linear[(i, j)]
            }),
        }
    }

    fn operator(&self, pencil: &Pencil, p: c64) -> Mat<c64> {
        let square = p * p;
        Mat::from_fn(pencil.a0.nrows(), pencil.a0.ncols(), |i, j| {
            square * self.reduced.mass[(i, j)] + p * pencil.a1[(i, j)] + pencil.a0[(i, j)]
        })
    }

    /// All $2n$ roots at fixed $k$.
    fn eigenvalues(&self, k: f64) -> Result<Vec<c64>, NoConvergence> {
        let (order, pencil) = (self.reduced.order(), self.pencil(k));
        let mut right = Mat::from_fn(order, 2 * order, |i, j| {
            if j < order {
                -pencil.a0[(i, j)]
            } else {
                -pencil.a1[(i, j - order)]
            }
        });
        let mass = Mat::from_fn(order, order, |i, j| {
            c64::new(self.reduced.mass[(i, j)], 0.0)
        });
        Lu::new(mass).solve(right.as_mut());
        let companion = Mat::from_fn(2 * order, 2 * order, |i, j| {
            if i >= order {
                right[(i - order, j)]
            } else if j == i + order {
                c64::new(1.0, 0.0)
            } else {
                c64::new(0.0, 0.0)
            }
        });
        eigenvalues(companion.as_ref())
    }

    /// The $n$ roots of largest imaginary part, ascending.
    fn upper(&self, k: f64) -> Result<Vec<c64>, NoConvergence> {
        let mut values = self.eigenvalues(k)?;
        values.sort_by(|a, b| a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re)));
        Ok(values.split_off(self.reduced.order()))
    }

    /// Every oscillatory root with $k$ up to the last sample.
    pub(crate) fn roots(&self, samples: &[f64]) -> Result<PkRoots, NoConvergence> {
        let grid = scan_grid(samples);
        let scan: Vec<Vec<c64>> = grid
            .iter()
            .map(|&k| self.upper(k))
            .collect::<Result<_, _>>()?;
        let mut brackets = Vec::new();
        for branch in 0..self.reduced.order() {
            let places: Vec<(f64, c64)> = grid
                .iter()
                .zip(&scan)
                .map(|(&k, values)| (k, values[branch]))
                .collect();
            brackets.extend(
                places
                    .windows(2)
                    .filter_map(|ends| Bracket::new(branch, ends[0], ends[1])),
            );
        }
        let mut roots: Vec<Eigenpair> = Vec::with_capacity(brackets.len());
        for bracket in &brackets {
            let quick = self.newton(bracket);
            let is_new = |pair: &Eigenpair| {
                roots
                    .iter()
                    .all(|root| (root.p - pair.p).norm() > SAME_ROOT)
            };
            match quick.filter(is_new) {
                Some(pair) => roots.push(pair),
                None => roots.extend(self.enclose(bracket)?.filter(|pair| is_new(pair))),
            }
        }
        let first = samples.iter().copied().find(|k| *k > 0.0).unwrap_or(0.0);
        roots.retain(|root| is_oscillation(root.p, first));
        roots.sort_by(|a, b| a.p.im.total_cmp(&b.p.im).then(a.p.re.total_cmp(&b.p.re)));
        Ok(PkRoots {
            roots,
            zeros: self.displacements_without_force()?,
        })
    }

    /// Dimension of the displacements at rest that meet no force: the zero
    /// roots of a body in flight.
    fn displacements_without_force(&self) -> Result<usize, NoConvergence> {
        let order = self.reduced.order();
        let at_rest = self.reduced.loads(&self.forces.q(0.0));
        let weight = |mode: usize| 1.0 / self.reduced.mass[(mode, mode)].sqrt();
        let stiffness = Mat::from_fn(order, order, |i, j| {
            c64::new(self.reduced.stiffness[(i, j)] - at_rest[(i, j)].re, 0.0)
                * weight(i)
                * weight(j)
        });
        let empty = Mat::zeros(order, 1);
        Ok(order - least_squares(stiffness.as_ref(), empty.as_ref())?.rank)
    }

    /// Newton's iteration in $k$ with left and right vectors,
    /// $h' = \operatorname{Im}\bigl(-y^H\partial_kTx / y^H\partial_pTx\bigr) - 1$,
    /// bisection where it leaves the bracket.
    fn newton(&self, bracket: &Bracket) -> Option<Eigenpair> {
        let [mut low, mut high] = [bracket.low, bracket.high];
        let mut k = bracket.guess;
        let mut p = bracket.guess_root;
        for _ in 0..MAX_STEPS {
            let pencil = self.pencil(k);
            let pair = self.settle(&pencil, p)?;
            p = pair.p;
            let miss = p.im - k;
            if miss.abs() < TOLERANCE {
                return (p.im >= bracket.low && p.im <= bracket.high).then_some(pair);
            }
            if (miss > 0.0) == bracket.is_falling {
                low = k;
            } else {
                high = k;
            }
            let slope = self.root_slope(k, &pencil, &pair);
            let mut next = k - miss / (slope.im - 1.0);
            if !(next > low && next < high) {
                next = f64::midpoint(low, high);
            }
            p += slope * (next - k);
            k = next;
        }
        None
    }

    /// The root that a plain Newton iteration finds from a guess.
    pub(crate) fn near(&self, guess: c64) -> Option<Eigenpair> {
        const STEPS: usize = 15;
        let (mut k, mut p) = (guess.im, guess);
        for _ in 0..STEPS {
            let pencil = self.pencil(k);
            let pair = self.settle(&pencil, p)?;
            let miss = pair.p.im - k;
            if miss.abs() < TOLERANCE {
                return Some(pair);
            }
            let slope = self.root_slope(k, &pencil, &pair);
            let step = -miss / (slope.im - 1.0);
            p = pair.p + slope * step;
            k += step;
            if !k.is_finite() || k < 0.0 {
                return None;
            }
        }
        None
    }

    /// Two-sided Rayleigh iteration for the root of the pencil nearest `p`.
    fn settle(&self, pencil: &Pencil, mut p: c64) -> Option<Eigenpair> {
        const STEPS: usize = 12;
        let mut last = f64::INFINITY;
        for _ in 0..STEPS {
            let operator = self.operator(pencil, p);
            let image = operator.clone();
            let pair = inverse_iteration(p, operator);
            let slope = self.operator_slope(pencil, p);
            let denominator = inner(&pair.left, &apply(slope.as_ref(), &pair.right));
            let change = inner(&pair.left, &apply(image.as_ref(), &pair.right)) / denominator;
            let step = change.norm();
            if !step.is_finite() {
                return None;
            }
            p -= change;
            let is_rounding = step < ROUNDING && step > 0.1 * last;
            if step < 1e-3 * TOLERANCE || is_rounding {
                return Some(Eigenpair { p, ..pair });
            }
            last = step;
        }
        None
    }

    fn operator_slope(&self, pencil: &Pencil, p: c64) -> Mat<c64> {
        Mat::from_fn(pencil.a1.nrows(), pencil.a1.ncols(), |i, j| {
            p * 2.0 * self.reduced.mass[(i, j)] + pencil.a1[(i, j)]
        })
    }

    /// $\mathrm dp/\mathrm dk$ of a root of the pencil.
    fn root_slope(&self, k: f64, pencil: &Pencil, pair: &Eigenpair) -> c64 {
        let (ahead, behind) = (
            self.pencil(k + DIFFERENCE_STEP),
            self.pencil(k - DIFFERENCE_STEP),
        );
        let change = self.operator(&ahead, pair.p) - self.operator(&behind, pair.p);
        let numerator = inner(&pair.left, &apply(change.as_ref(), &pair.right));
        let slope = self.operator_slope(pencil, pair.p);
        let denominator = inner(&pair.left, &apply(slope.as_ref(), &pair.right));
        -numerator / (denominator * 2.0 * DIFFERENCE_STEP)
    }

    /// False position (Illinois) on the sorted eigenvalue itself, with every
    /// fourth step a bisection: slow, certain.
    fn enclose(&self, bracket: &Bracket) -> Result<Option<Eigenpair>, NoConvergence> {
        let [mut low, mut high] = [bracket.low, bracket.high];
        let mut weights = bracket.misses;
        let mut last_side = 2;
        for step in 0..MAX_STEPS {
            let fraction = if step % 4 == 3 {
                0.5
            } else {
                weights[0] / (weights[0] - weights[1])
            };
            let k = low + fraction.clamp(1e-6, 1.0 - 1e-6) * (high - low);
            let p = self.upper(k)?[bracket.branch];
            let miss = p.im - k;
            if miss.abs() < TOLERANCE || high - low < TOLERANCE {
                return Ok(Some(inverse_iteration(
                    p,
                    self.operator(&self.pencil(k), p),
                )));
            }
            let side = usize::from((miss > 0.0) != bracket.is_falling);
            weights[side] = miss;
            if last_side == side {
                weights[1 - side] *= 0.5;
            }
            last_side = side;
            if side == 0 {
                low = k;
            } else {
                high = k;
            }
        }
        Ok(None)
    }
}

/// At $k>0$ the interpolated $Q$ moves the zero roots of a free body away from
/// zero, and some of them then meet $\operatorname{Im}p = k$ below the first
/// sample, damped or growing faster than they turn. They are artefacts of the
/// method and are left out.
fn is_oscillation(p: c64, first_sample: f64) -> bool {
    p.im > APERIODIC && (p.im >= first_sample || p.re.abs() < p.im)
}

/// An interval of $k$ in which $h$ of one sorted branch changes sign.
struct Bracket {
    branch: usize,
    low: f64,
    high: f64,
    /// $h$ falls from positive to negative.
    is_falling: bool,
    /// $h$ at both ends.
    misses: [f64; 2],
    guess: f64,
    guess_root: c64,
}

impl Bracket {
    fn new(
        branch: usize,
        (low, first): (f64, c64),
        (high, second): (f64, c64),
    ) -> Option<Self> {
        let settle = |h: f64| if h.abs() < APERIODIC { 0.0 } else { h };
        let (at_low, at_high) = (settle(first.im - low), settle(second.im - high));
        let starts_real = low == 0.0 && at_low == 0.0;
        if starts_real || (at_low > 0.0) == (at_high > 0.0) {
            return None;
        }
        let fraction = (at_low / (at_low - at_high)).clamp(0.0, 1.0);
        Some(Self {
            branch,
            low,
            high,
            is_falling: at_low > 0.0,
            misses: [at_low, at_high],
            guess: low + fraction * (high - low),
            guess_root: first + (second - first) * fraction,
        })
    }
}

/// Places below the first sample where $h$ is looked at: slow rigid motions
/// have several roots there.
const LOW_PLACES: i32 = 10;

/// Each is this much lower than the one before.
const LOW_RATIO: f64 = 2.0;

/// Zero, places below the first sample, and the samples.
fn scan_grid(samples: &[f64]) -> Vec<f64> {
    let first = samples.iter().copied().find(|k| *k > 0.0).unwrap_or(1.0);
    let mut grid = vec![0.0];
    grid.extend(
        (1..=LOW_PLACES)
            .rev()
            .map(|step| first * LOW_RATIO.powi(-step)),
    );
    grid.extend(samples.iter().filter(|k| **k > 0.0));
    grid
}
