//! Real roots by their own search.
//!
//! On the real axis $\det T$ is real. Divided by the known real roots,
//! $$ \frac{\det T(g)}{g^{n_0}\prod_i(g-\lambda_i)} $$
//! keeps its sign between the border of the cut and that of the region; where
//! it changes there is one more root (or three), even where another is beside
//! it. Two missing ones between neighbouring places are not seen, and left to
//! the count.

use faer::c64;

use crate::count::Census;
use crate::structure::Hysteresis;

/// Nearest place to the origin; slower motions are told from zero roots by the
/// quadratic problem alone.
const NEAREST: f64 = 1e-6;

/// Each place is this much farther from the origin than the one before.
const RATIO: f64 = 2.0;

/// Divisions of an interval that holds a root, each into as many parts as are
/// evaluated together; Newton's iteration does the rest.
const DIVISIONS: usize = 4;
const PARTS: usize = 9;

impl Census<'_> {
    /// A seed for every real root that the list lacks.
    pub(crate) fn missing_on_real_axis(&self) -> Vec<c64> {
        let places = self.places();
        let signs = self.signs(&places);
        let mut seeds = Vec::new();
        for (ends, sides) in places.windows(2).zip(signs.windows(2)) {
            let both = (sides[0], sides[1]);
            if let (Some(first), Some(second)) = both
                && first != second
            {
                seeds.push(self.divide([ends[0], ends[1]], first));
            }
        }
        seeds
    }

    /// Ascending, denser towards the origin.
    fn places(&self) -> Vec<f64> {
        let [left, right] = self.claim.real_range();
        let mut sizes = Vec::new();
        let mut size = NEAREST;
        while size < right.max(-left) {
            sizes.push(size);
            size *= RATIO;
        }
        let below = sizes.iter().rev().map(|size| -size);
        let mut places: Vec<f64> = std::iter::once(left)
            .chain(below.filter(|g| *g > left))
            .chain(sizes.iter().copied().filter(|g| *g > left && *g < right))
            .collect();
        places.push(right);
        places
    }

    /// Whether the deflated determinant is positive; none at a known root.
    fn signs(&self, places: &[f64]) -> Vec<Option<bool>> {
        let points: Vec<c64> = places.iter().map(|g| c64::new(*g, 0.0)).collect();
        let directions = self.pencil.directions(&points, Hysteresis::LeftOut);
        let real: Vec<f64> = self
            .roots
            .iter()
            .filter(|root| root.im == 0.0)
            .map(|root| root.re)
            .collect();
        let deflated = |(g, direction): (&f64, c64)| {
            let mut value = direction.re;
            for root in &real {
                value *= (g - root).signum();
            }
            if !self.zeros.is_multiple_of(2) {
                value *= g.signum();
            }
            value.is_finite().then_some(value > 0.0)
        };
        places.iter().zip(directions).map(deflated).collect()
    }

    /// The middle of a small interval in which the sign changes.
    fn divide(&self, [mut low, mut high]: [f64; 2], at_low: bool) -> c64 {
        for _ in 0..DIVISIONS {
            let step = (high - low) / PARTS as f64;
            let inner: Vec<f64> = (1..PARTS).map(|part| low + step * part as f64).collect();
            let change = self
                .signs(&inner)
                .iter()
                .position(|sign| *sign != Some(at_low))
                .unwrap_or(PARTS - 1);
            (low, high) = (low + step * change as f64, low + step * (change + 1) as f64);
        }
        c64::new(f64::midpoint(low, high), 0.0)
    }
}
