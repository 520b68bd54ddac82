//! $Q$ that changes with the flight condition.
//!
//! Over incidence and Mach number
//! $$ Q(p;\text{condition}) = \sum_a w_a(\text{condition})\,Q_a(p) $$
//! with parts $Q_a$ that depend on $p$ alone. The parts stand side by side in
//! one wide table ([`GafTable::side_by_side`](crate::GafTable::side_by_side)),
//! so that fits, splines and rational models treat them as one, and the
//! eigenvalue problem of a flight condition mixes their coefficients once.

use crate::structure::OperatingPoint;

/// Weights of the parts.
pub trait Mixture: std::fmt::Debug + Send + Sync {
    /// Number of parts.
    fn parts(&self) -> usize;
    /// Weight of every part at a flight condition; they add up to one.
    fn weights(&self, point: &OperatingPoint) -> Vec<f64>;
}

/// Parts at five incidences.
///
/// Forces linearised about a steady flow are a quadratic form of the stream
/// $(\cos\alpha, 0, \sin\alpha)$ where the wake stays in place, with linear
/// and constant terms: a combination of $1, \cos\alpha, \sin\alpha,
/// \cos2\alpha, \sin2\alpha$. Five incidences give all of them, by
/// trigonometric interpolation:
/// $$ w_a = \prod_{b\ne a}\frac{\sin\tfrac12(\alpha-\alpha_b)}
///                             {\sin\tfrac12(\alpha_a-\alpha_b)} . $$
#[derive(Clone, Debug, PartialEq)]
pub struct Incidences([f64; 5]);

impl Incidences {
    /// Five incidences in radians spread over a range as the zeros of a
    /// Chebyshev polynomial; a range narrower than a degree is widened to one.
    pub fn over(low: f64, high: f64) -> Self {
        let half = (0.5 * (high - low)).max(LEAST_HALF_WIDTH);
        let middle = f64::midpoint(low, high);
        let node = |a: usize| {
            let angle = std::f64::consts::PI * (2 * a + 1) as f64 / 10.0;
            middle - half * angle.cos()
        };
        Self(std::array::from_fn(node))
    }

    /// The incidences, ascending.
    pub fn values(&self) -> [f64; 5] {
        self.0
    }
}

/// Half of the narrowest range, rad.
const LEAST_HALF_WIDTH: f64 = 0.5 * std::f64::consts::PI / 180.0;

impl Mixture for Incidences {
    fn parts(&self) -> usize {
        self.0.len()
    }

    fn weights(&self, point: &OperatingPoint) -> Vec<f64> {
        let half_sine = |a: f64, b: f64| (0.5 * (a - b)).sin();
        let weight = |own: &f64| {
            let others = self.0.iter().filter(|other| *other != own);
            others
                .map(|other| half_sine(point.alpha, *other) / half_sine(*own, *other))
                .product()
        };
        self.0.iter().map(weight).collect()
    }
}

/// Parts at ascending Mach numbers, joined by straight lines.
#[derive(Clone, Debug, PartialEq)]
pub struct MachNumbers(Vec<f64>);

impl MachNumbers {
    /// Two or more ascending Mach numbers; `None` for any other list.
    pub fn new(values: Vec<f64>) -> Option<Self> {
        let ascend = values.windows(2).all(|pair| pair[0] < pair[1]);
        (values.len() > 1 && ascend).then_some(Self(values))
    }
}

impl Mixture for MachNumbers {
    fn parts(&self) -> usize {
        self.0.len()
    }

    /// Beyond the first and the last the nearest line is continued; a
    /// condition without a Mach number has that of the first part.
    fn weights(&self, point: &OperatingPoint) -> Vec<f64> {
        let mach = point.mach.unwrap_or(self.0[0]);
        let last = self.0.len() - 2;
        let start = (1..=last)
            .rev()
            .find(|&start| mach >= self.0[start])
            .unwrap_or(0);
        let fraction = (mach - self.0[start]) / (self.0[start + 1] - self.0[start]);
        let mut weights = vec![0.0; self.0.len()];
        weights[start] = 1.0 - fraction;
        weights[start + 1] = fraction;
        weights
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quadratic form of the stream with linear and constant terms is met
    /// everywhere in the range and beside it.
    #[test]
    fn five_incidences_give_every_quadratic_form() {
        let nodes = Incidences::over(-0.03, 0.16);
        let form = |alpha: f64| {
            let (s, c) = alpha.sin_cos();
            0.3 + 1.7 * c - 0.9 * s + 2.1 * c * c - 0.4 * c * s + 5.0 * s * s
        };
        let mut worst: f64 = 0.0;
        for alpha in [-0.05, -0.03, 0.0, 0.07, 0.16, 0.2] {
            let point = OperatingPoint {
                alpha,
                ..OperatingPoint::new(1.0, 1.0)
            };
            let weights = nodes.weights(&point);
            let mixed: f64 = weights
                .iter()
                .zip(nodes.values())
                .map(|(weight, node)| weight * form(node))
                .sum();
            worst = worst.max((mixed - form(alpha)).abs());
        }
        println!("largest difference {worst:.1e}");
        assert!(worst < 1e-12);
    }

    #[test]
    fn mach_numbers_are_joined_by_lines() {
        let nodes = MachNumbers::new(vec![0.0, 0.4, 0.6]).unwrap();
        let at = |mach: f64| {
            nodes.weights(&OperatingPoint {
                mach: Some(mach),
                ..OperatingPoint::new(1.0, 1.0)
            })
        };
        assert_eq!(at(0.1), [0.75, 0.25, 0.0]);
        assert_eq!(at(0.4), [0.0, 1.0, 0.0]);
        let between = at(0.5);
        assert!((between[1] - 0.5).abs() < 1e-12 && (between[2] - 0.5).abs() < 1e-12);
        assert_eq!(MachNumbers::new(vec![0.3]), None);
        assert_eq!(MachNumbers::new(vec![0.3, 0.3]), None);
    }
}
