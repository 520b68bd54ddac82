//! $T(p)$ at many points at once.
//!
//! Where $Q(p) = \sum_jw_j(p)R_j$ with real matrices $R_j$,
//! $$ T(p) = p^2\tilde M + p\,\tilde C + K - q_\infty\sum_jw_j(p)R_j $$
//! is a combination of real matrices with complex factors, and its values at
//! $m$ points are one real matrix product: entries × matrices times matrices ×
//! $2m$. That is several times faster than one point after the other, and is
//! what a count of roots and a continuation over speed spend their time on.

use faer::{Mat, c64};

use crate::aerodynamics::{Aerodynamics, Expansion};
use crate::linalg::real_product;
use crate::structure::{Hysteresis, Reduced};

/// Points of one product: enough for the product to run at full rate, few
/// enough to stay in the cache.
const BATCH: usize = 32;

/// The problem at one flight condition, ready for evaluation.
pub(crate) struct Pencil<'a> {
    pub(crate) reduced: &'a Reduced,
    pub(crate) aerodynamics: &'a dyn Aerodynamics,
    expanded: Option<Expanded<'a>>,
}

struct Expanded<'a> {
    expansion: &'a dyn Expansion,
    /// One column each for $\tilde M$, $\tilde C$, $K$ and the $q_\infty R_j$,
    /// entries column by column.
    matrices: Mat<f64>,
}

/// $T$ or $T'$.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    Value,
    Slope,
}

impl<'a> Pencil<'a> {
    pub(crate) fn new(reduced: &'a Reduced, aerodynamics: &'a dyn Aerodynamics) -> Self {
        let expanded = aerodynamics
            .expansion()
            .map(|expansion| Expanded::new(reduced, expansion));
        Self {
            reduced,
            aerodynamics,
            expanded,
        }
    }

    /// $T(p)$.
    pub(crate) fn operator(&self, p: c64, hysteresis: Hysteresis) -> Mat<c64> {
        self.reduced
            .operator(p, &self.aerodynamics.q(p), hysteresis)
    }

    /// Calls `visit` with the number of every point and $T$ there.
    pub(crate) fn each_operator(
        &self,
        points: &[c64],
        hysteresis: Hysteresis,
        mut visit: impl FnMut(usize, Mat<c64>),
    ) {
        let Some(expanded) = &self.expanded else {
            for (number, &p) in points.iter().enumerate() {
                visit(number, self.operator(p, hysteresis));
            }
            return;
        };
        for (batch, points) in points.chunks(BATCH).enumerate() {
            let values = expanded.combine(points, Wanted::Value);
            for (at, _) in points.iter().enumerate() {
                let mut operator = self.matrix(&values, at);
                if hysteresis == Hysteresis::Included {
                    self.reduced.add_hysteresis(&mut operator);
                }
                visit(batch * BATCH + at, operator);
            }
        }
    }

    /// Calls `visit` with the number of every point, $T$ and $T'$ there; each
    /// point has the hysteresis that belongs to it.
    pub(crate) fn each_operator_and_slope(
        &self,
        points: &[c64],
        mut visit: impl FnMut(usize, Mat<c64>, Mat<c64>),
    ) {
        let Some(expanded) = &self.expanded else {
            for (number, &p) in points.iter().enumerate() {
                let (q, slope) = self.aerodynamics.q_and_slope(p);
                let hysteresis = Reduced::hysteresis_at(p);
                visit(
                    number,
                    self.reduced.operator(p, &q, hysteresis),
                    self.reduced.operator_slope(p, &slope),
                );
            }
            return;
        };
        for (batch, points) in points.chunks(BATCH).enumerate() {
            let values = expanded.combine(points, Wanted::Value);
            let slopes = expanded.combine(points, Wanted::Slope);
            for (at, &p) in points.iter().enumerate() {
                let mut operator = self.matrix(&values, at);
                if Reduced::hysteresis_at(p) == Hysteresis::Included {
                    self.reduced.add_hysteresis(&mut operator);
                }
                visit(batch * BATCH + at, operator, self.matrix(&slopes, at));
            }
        }
    }

    /// Columns `2 at` and `2 at + 1` as a complex matrix.
    fn matrix(&self, values: &Mat<f64>, at: usize) -> Mat<c64> {
        let order = self.reduced.order();
        let real = values.col_as_slice(2 * at);
        let imaginary = values.col_as_slice(2 * at + 1);
        let mut out = Mat::zeros(order, order);
        for column in 0..order {
            let span = column * order..(column + 1) * order;
            let parts = real[span.clone()].iter().zip(&imaginary[span]);
            let target = out.col_as_slice_mut(column).iter_mut();
            for (entry, (re, im)) in target.zip(parts) {
                *entry = c64::new(*re, *im);
            }
        }
        out
    }
}

impl<'a> Expanded<'a> {
    fn new(reduced: &Reduced, expansion: &'a dyn Expansion) -> Self {
        let order = reduced.order();
        let loads: Vec<Mat<f64>> = expansion
            .matrices()
            .iter()
            .map(|matrix| reduced.real_loads(matrix))
            .collect();
        let mut columns: Vec<&Mat<f64>> =
            vec![&reduced.mass, &reduced.damping, &reduced.stiffness];
        columns.extend(&loads);
        let matrices = Mat::from_fn(order * order, columns.len(), |entry, column| {
            columns[column][(entry % order, entry / order)]
        });
        Self {
            expansion,
            matrices,
        }
    }

    /// Real and imaginary parts of the combination at every point.
    fn combine(&self, points: &[c64], wanted: Wanted) -> Mat<f64> {
        let mut factors = Mat::<f64>::zeros(self.matrices.ncols(), 2 * points.len());
        for (at, &p) in points.iter().enumerate() {
            let (head, weights) = match wanted {
                Wanted::Value => ([p * p, p, c64::new(1.0, 0.0)], self.expansion.weights(p)),
                Wanted::Slope => (
                    [p * 2.0, c64::new(1.0, 0.0), c64::new(0.0, 0.0)],
                    self.expansion.slopes(p),
                ),
            };
            let all = head.into_iter().chain(weights.into_iter().map(|w| -w));
            for (row, factor) in all.enumerate() {
                factors[(row, 2 * at)] = factor.re;
                factors[(row, 2 * at + 1)] = factor.im;
            }
        }
        real_product(self.matrices.as_ref(), factors.as_ref())
    }
}
