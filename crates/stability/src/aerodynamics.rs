//! What the eigenvalue problem asks of an aerodynamic model.
//!
//! Generalised forces on the structure are $f = q_\infty Q(p)\,\xi$ with the
//! reduced Laplace variable $p = sb/U = g + \mathrm ik$ and the dynamic
//! pressure $q_\infty = \rho U^2/2$. A model is any function $Q(p)$, analytic
//! away from the negative real axis, with $Q(\bar p) = \overline{Q(p)}$.

use faer::{Mat, c64};

use crate::rational::RationalFit;

/// A source of generalised aerodynamic forces at any point of the Laplace
/// plane: a fit to samples, or the aerodynamic solver itself.
pub trait Aerodynamics: Sync {
    /// Number of generalised coordinates.
    fn order(&self) -> usize;

    /// $Q(p)$, rows force, columns motion; real where $p$ is real and $g\ge0$.
    fn q(&self, p: c64) -> Mat<c64>;

    /// $Q(p)$ and $\mathrm dQ/\mathrm dp$.
    ///
    /// The default takes a one-sided difference along the real direction with
    /// an error of about 1e-6 of $|Q|$: enough for a Newton iteration, whose
    /// limit does not depend on it.
    fn q_and_slope(&self, p: c64) -> (Mat<c64>, Mat<c64>) {
        let step = DIFFERENCE_STEP * (1.0 + p.norm());
        let (here, ahead) = (self.q(p), self.q(p + step));
        let slope = Mat::from_fn(here.nrows(), here.ncols(), |i, j| {
            (ahead[(i, j)] - here[(i, j)]) / step
        });
        (here, slope)
    }

    /// Largest real part of a pole or branch point, where it is known; roots
    /// are counted to the right of it near the real axis.
    fn rightmost_pole(&self) -> Option<f64> {
        None
    }

    /// Whether the forces are evaluated anywhere rather than continued from
    /// samples.
    fn is_exact(&self) -> bool {
        false
    }

    /// The model as a combination of fixed real matrices, where it is one:
    /// then many points are evaluated together.
    fn expansion(&self) -> Option<&dyn Expansion> {
        None
    }

    /// The model itself where it is rational: then all its roots can be had
    /// from one standard eigenproblem.
    fn as_rational(&self) -> Option<&RationalFit> {
        None
    }
}

/// $Q(p) = \sum_jw_j(p)\,R_j$ with real matrices $R_j$ and scalar functions
/// $w_j$.
pub trait Expansion: Sync {
    /// $R_j$ in order.
    fn matrices(&self) -> Vec<&Mat<f64>>;
    /// $w_j(p)$ in the same order.
    fn weights(&self, p: c64) -> Vec<c64>;
    /// $\mathrm dw_j/\mathrm dp$.
    fn slopes(&self, p: c64) -> Vec<c64>;
}

/// Balances truncation (proportional to the step) against cancellation
/// (rounding over step).
const DIFFERENCE_STEP: f64 = 1e-7;

/// Aerodynamics given by a function.
pub struct FromFunction<F> {
    order: usize,
    function: F,
}

impl<F: Fn(c64) -> Mat<c64> + Sync> FromFunction<F> {
    /// Wraps a function that returns `order` × `order` matrices.
    pub fn new(order: usize, function: F) -> Self {
        Self { order, function }
    }
}

impl<F: Fn(c64) -> Mat<c64> + Sync> Aerodynamics for FromFunction<F> {
    fn order(&self) -> usize {
        self.order
    }

    fn q(&self, p: c64) -> Mat<c64> {
        (self.function)(p)
    }

    fn is_exact(&self) -> bool {
        true
    }
}
