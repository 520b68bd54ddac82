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
use crate::linalg::Lu;
use crate::structure::Hysteresis;

/// Nearest place to the origin; slower motions are told from zero roots by the
/// quadratic problem alone.
const NEAREST: f64 = 1e-7;

/// Each place is this much farther from the origin than the one before.
const RATIO: f64 = 1.8;

/// Halvings of an interval that holds a root; Newton's iteration does the rest.
const HALVINGS: usize = 14;

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
                seeds.push(self.halve([ends[0], ends[1]], first));
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
        let mut signs = vec![None; points.len()];
        self.pencil
            .each_operator(&points, Hysteresis::LeftOut, |number, operator| {
                let (size, direction) = Lu::new(operator).determinant();
                let mut value = direction.re;
                let real = self.roots.iter().filter(|root| root.im == 0.0);
                for root in real {
                    value *= (points[number].re - root.re).signum();
                }
                if !self.zeros.is_multiple_of(2) {
                    value *= points[number].re.signum();
                }
                signs[number] = size.is_finite().then_some(value > 0.0);
            });
        signs
    }

    fn halve(&self, [mut low, mut high]: [f64; 2], at_low: bool) -> c64 {
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(low, high);
            if self.signs(&[middle])[0] == Some(at_low) {
                low = middle;
            } else {
                high = middle;
            }
        }
        c64::new(f64::midpoint(low, high), 0.0)
    }
}
