//! A crossing of the imaginary axis by Newton's iteration.
//!
//! Unknowns are the vector $x$, $p$ with $\operatorname{Re}p = 0$, and the
//! place $t$ in the sweep. With $v = T^{-1}T_px$, $w = T^{-1}T_tx$ and
//! $y^Hx = 1$ the linearised equations $T\,\Delta x + T_px\,\Delta p +
//! T_tx\,\Delta t = -Tx$, $y^H\Delta x = 0$ give
//!
//! $$ \Delta p = -\frac{1 + y^Hw\,\Delta t}{y^Hv},\qquad
//!    \operatorname{Re}(p + \Delta p) = 0\ \Rightarrow\
//!    \Delta t = \frac{\operatorname{Re}\bigl(p - 1/y^Hv\bigr)}
//!                    {\operatorname{Re}\bigl(y^Hw/y^Hv\bigr)} $$
//!
//! Four or five steps reach rounding. It wants a $Q(p)$ that is smooth.

use faer::{Mat, c64};

use crate::eigenpair::{Eigenpair, turned_to_unit};
use crate::linalg::{Lu, apply, inner};

/// $T$, $T_p$ and $T_t$ at one place.
pub(crate) struct Local {
    pub(crate) operator: Mat<c64>,
    pub(crate) slope: Mat<c64>,
    pub(crate) change: Mat<c64>,
}

/// The problem as a function of $p$ and of the place in the sweep.
pub(crate) trait Moving {
    /// $T$, $T_p$, $T_t$.
    fn local(&self, parameter: f64, p: c64) -> Local;
}

/// Steps in $t$ and in $p$ at which the iteration has converged.
const CONVERGED: f64 = 1e-12;

const MAX_STEPS: usize = 12;

/// Where a root crosses the axis.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    pub(crate) parameter: f64,
    pub(crate) k: f64,
}

/// The crossing near a start, within `bounds`; `None` where the iteration
/// leaves them or does not settle.
pub(crate) fn flutter_point(
    problem: &dyn Moving,
    start: &Eigenpair,
    parameter: f64,
    bounds: [f64; 2],
) -> Option<Point> {
    let scale = turned_to_unit(&start.right);
    let anchor: Vec<c64> = start.right.iter().map(|value| value * scale).collect();
    let (mut x, mut p, mut t) = (anchor.clone(), start.p, parameter);
    for _ in 0..MAX_STEPS {
        let Local {
            operator,
            slope,
            change,
        } = problem.local(t, p);
        let mut lu = Lu::new(operator);
        lu.guard_pivots();
        let images = [apply(slope.as_ref(), &x), apply(change.as_ref(), &x)];
        let mut solution = Mat::from_fn(x.len(), 2, |i, j| images[j][i]);
        lu.solve(solution.as_mut());
        let [v, w] = [0, 1].map(|column| solution.col_as_slice(column));
        let (a, b) = (inner(&anchor, v), inner(&anchor, w));
        let step = (p - 1.0 / a).re / (b / a).re;
        let turn = -(1.0 + b * step) / a;
        if !(step.is_finite() && turn.norm().is_finite()) {
            return None;
        }
        x = v
            .iter()
            .zip(w)
            .map(|(v, w)| -(v * turn + w * step))
            .collect();
        p = c64::new(0.0, (p + turn).im);
        t += step;
        if t < bounds[0] || t > bounds[1] || p.im <= 0.0 {
            return None;
        }
        if step.abs() < CONVERGED * (1.0 + t.abs()) && turn.norm() < CONVERGED * (1.0 + p.im) {
            return Some(Point {
                parameter: t,
                k: p.im,
            });
        }
    }
    None
}

/// Step in $t$ for $T_t$; the limit of the iteration does not depend on it.
const DIFFERENCE_STEP: f64 = 1e-5;

/// $T_t$ by a central difference.
pub(crate) fn change_along(
    operator_at: impl Fn(f64) -> Mat<c64>,
    parameter: f64,
    last: f64,
) -> Mat<c64> {
    let low = (parameter - DIFFERENCE_STEP).max(0.0);
    let high = (parameter + DIFFERENCE_STEP).min(last);
    let (behind, ahead) = (operator_at(low), operator_at(high));
    let width = high - low;
    Mat::from_fn(ahead.nrows(), ahead.ncols(), |i, j| {
        (ahead[(i, j)] - behind[(i, j)]) / width
    })
}
