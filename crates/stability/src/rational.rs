//! A rational model of $Q$ with common stable poles.
//!
//! $$ Q(p) = Q(0) + R_1p + R_2p^2 + \sum_j R_{2+j}\,\frac{p}{p - a_j},
//!    \qquad \operatorname{Re}a_j < 0 $$
//!
//! with real coefficient matrices and poles that are real or come in
//! conjugate pairs, so that $Q(\bar p) = \overline{Q(p)}$ and $Q(0)$ is exact.

use faer::{Mat, c64};

use crate::aerodynamics::{Aerodynamics, Expansion};
use crate::gaf::GafTable;
use crate::linalg::NoConvergence;
use crate::vector_fit;

/// A rational model of $Q$, smooth everywhere right of its poles.
#[derive(Clone, Debug)]
pub struct RationalFit {
    pub(crate) at_rest: Mat<f64>,
    pub(crate) poles: Vec<Pole>,
    /// Coefficients of $p$, $p^2$ and of the pole functions in order.
    pub(crate) coefficients: Vec<Mat<f64>>,
    pub(crate) error: f64,
    pub(crate) notes: Vec<String>,
}

/// A real pole or a conjugate pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Pole {
    /// $a$.
    Real(f64),
    /// $a$ and $\bar a$, $\operatorname{Im}a>0$.
    Pair(c64),
}

impl RationalFit {
    /// Fits all samples of a table, off the axis too.
    ///
    /// # Errors
    /// A decomposition that fails.
    pub fn new(table: &GafTable) -> Result<Self, NoConvergence> {
        vector_fit::fit(table)
    }

    /// Largest misfit at a fitted sample, as a fraction of the largest entry.
    pub fn residual(&self) -> f64 {
        self.error
    }

    /// Poles in the upper half plane and on the real axis.
    pub fn poles(&self) -> Vec<c64> {
        self.poles
            .iter()
            .map(|pole| match pole {
                Pole::Real(a) => c64::new(*a, 0.0),
                Pole::Pair(a) => *a,
            })
            .collect()
    }

    /// What a user should know, one sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    fn combine(&self, constant: f64, weights: &[c64]) -> Mat<c64> {
        let (rows, columns) = (self.at_rest.nrows(), self.at_rest.ncols());
        let mut out = Mat::from_fn(rows, columns, |i, j| {
            c64::new(constant * self.at_rest[(i, j)], 0.0)
        });
        for (coefficient, weight) in self.coefficients.iter().zip(weights) {
            for j in 0..columns {
                for i in 0..rows {
                    out[(i, j)] += weight * coefficient[(i, j)];
                }
            }
        }
        out
    }
}

impl Aerodynamics for RationalFit {
    fn order(&self) -> usize {
        self.at_rest.nrows()
    }

    fn q(&self, p: c64) -> Mat<c64> {
        self.combine(1.0, &functions(p, &self.poles))
    }

    fn q_and_slope(&self, p: c64) -> (Mat<c64>, Mat<c64>) {
        (self.q(p), self.combine(0.0, &slopes(p, &self.poles)))
    }

    fn rightmost_pole(&self) -> Option<f64> {
        let real_parts = self.poles().into_iter().map(|pole| pole.re);
        real_parts.reduce(f64::max)
    }

    fn expansion(&self) -> Option<&dyn Expansion> {
        Some(self)
    }

    fn as_rational(&self) -> Option<&RationalFit> {
        Some(self)
    }
}

/// $Q(0)$ and the coefficients.
impl Expansion for RationalFit {
    fn matrices(&self) -> Vec<&Mat<f64>> {
        std::iter::once(&self.at_rest)
            .chain(&self.coefficients)
            .collect()
    }

    fn weights(&self, p: c64) -> Vec<c64> {
        let mut weights = functions(p, &self.poles);
        weights.insert(0, c64::new(1.0, 0.0));
        weights
    }

    fn slopes(&self, p: c64) -> Vec<c64> {
        let mut weights = slopes(p, &self.poles);
        weights.insert(0, c64::new(0.0, 0.0));
        weights
    }
}

/// $p$, $p^2$, $p/(p-a)$; for a pair the sum with its conjugate and $\mathrm i$
/// times the difference, which have real coefficients.
pub(crate) fn functions(p: c64, poles: &[Pole]) -> Vec<c64> {
    let mut values = vec![p, p * p];
    append(&mut values, poles, |a| p / (p - a));
    values
}

/// Derivatives of the [`functions`].
fn slopes(p: c64, poles: &[Pole]) -> Vec<c64> {
    let mut values = vec![c64::new(1.0, 0.0), p * 2.0];
    append(&mut values, poles, |a| -a / ((p - a) * (p - a)));
    values
}

pub(crate) fn append(values: &mut Vec<c64>, poles: &[Pole], function: impl Fn(c64) -> c64) {
    for pole in poles {
        match *pole {
            Pole::Real(a) => values.push(function(c64::new(a, 0.0))),
            Pole::Pair(a) => {
                let (one, other) = (function(a), function(a.conj()));
                values.push(one + other);
                values.push(c64::new(0.0, 1.0) * (one - other));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gaf::GafPoint;
    use crate::linalg::largest;

    /// A function with a real pole and a pair is found exactly.
    #[test]
    fn a_rational_function_is_recovered() {
        let pair = c64::new(-0.3, 0.7);
        let exact = |p: c64| {
            Mat::from_fn(2, 2, |i, j| {
                let weight = 1.0 + i as f64 - 2.0 * j as f64;
                p * p * weight
                    + p * (0.3 + j as f64)
                    + 0.5 * weight
                    + p / (p + 0.2) * (1.0 - i as f64 * 0.5)
                    + (p / (p - pair) + p / (p - pair.conj())) * 0.4 * weight
            })
        };
        let points: Vec<GafPoint> = (0..=20)
            .map(|i| 1.5 * (f64::from(i) / 20.0).powf(1.5))
            .map(|k| GafPoint {
                g: 0.0,
                k,
                q: exact(c64::new(0.0, k)),
            })
            .collect();
        let modes = vec!["a".to_owned(), "b".to_owned()];
        let table = GafTable::new(1.0, 0.0, modes, points, vec![]).unwrap();
        let fit = RationalFit::new(&table).unwrap();
        println!("poles {:?}, residual {:.1e}", fit.poles(), fit.residual());
        assert!(fit.residual() < 1e-11);
        let p = c64::new(-0.1, 0.33);
        assert!(largest((fit.q(p) - exact(p)).as_ref()) < 1e-9);
        let (_, slope) = fit.q_and_slope(p);
        let step = 1e-6;
        let difference =
            (fit.q(p + step) - fit.q(p - step)) * faer::Scale(c64::new(0.5 / step, 0.0));
        assert!(largest((slope - difference).as_ref()) < 1e-8);
    }
}
