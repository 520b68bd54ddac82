//! $Q(p)$ itself where roots are refined.

use faer::{Mat, c64};
use fladder_bem::{Flow, TransferModel};
use fladder_stability::{Aerodynamics, RationalFit};

/// Forces of the swept modes, which come first, evaluated without any fit.
///
/// The derivative is that of the rational model: a Newton iteration converges
/// to the roots of the exact $Q$ whatever the slope, and evaluating $Q$ is what
/// costs.
pub(crate) struct ExactForces<'a> {
    pub(crate) transfer: &'a TransferModel,
    /// Incidences whose forces stand side by side.
    pub(crate) flows: &'a [Flow],
    pub(crate) slopes: &'a RationalFit,
}

impl ExactForces<'_> {
    /// $Q(p)$ for $k \ge 0$; on the branch cut its limit from above. `None`
    /// where there is no value.
    pub(crate) fn above(&self, p: c64) -> Option<Mat<c64>> {
        let on_cut = p.im == 0.0 && p.re < 0.0;
        let at = if on_cut {
            c64::new(p.re, BESIDE_CUT * -p.re)
        } else {
            p
        };
        let order = self.slopes.order();
        let parts = self.transfer.q_at_each(at, self.flows).ok()?;
        Some(Mat::from_fn(order, order * parts.len(), |i, j| {
            parts[j / order][(i, j % order)]
        }))
    }
}

impl Aerodynamics for ExactForces<'_> {
    fn order(&self) -> usize {
        self.slopes.order()
    }

    fn is_exact(&self) -> bool {
        true
    }

    /// On the branch cut the real part of the limit from above is taken; where
    /// $Q$ has no value every entry is NaN, which no iteration takes for a
    /// root.
    fn q(&self, p: c64) -> Mat<c64> {
        let (order, columns) = (self.order(), self.order() * self.flows.len());
        match self.above(p) {
            Some(q) if p.im == 0.0 => {
                Mat::from_fn(order, columns, |i, j| c64::new(q[(i, j)].re, 0.0))
            }
            Some(q) => q,
            None => Mat::from_fn(order, columns, |_, _| c64::new(f64::NAN, f64::NAN)),
        }
    }

    /// The slope is the surrogate's, but on the branch cut, where that has poles, a central
    /// difference along it.
    fn q_and_slope(&self, p: c64) -> (Mat<c64>, Mat<c64>) {
        if p.im == 0.0 && p.re < 0.0 {
            let step = DIFFERENCE * p.re.abs();
            let (ahead, behind) = (self.q(p + step), self.q(p - step));
            return (
                self.q(p),
                (ahead - behind) * faer::Scale(c64::from(0.5 / step)),
            );
        }
        let (_, slope) = self.slopes.q_and_slope(p);
        (self.q(p), slope)
    }
}

/// Step of the difference on the cut relative to $|g|$: truncation and rounding both leave
/// some 1e-9 of the slope.
const DIFFERENCE: f64 = 1e-4;

/// Distance from the cut relative to $|g|$ at which its limit is taken; the
/// forces change by as little.
const BESIDE_CUT: f64 = 1e-12;
