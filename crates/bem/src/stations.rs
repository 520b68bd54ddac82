//! Streamwise stations of the wake's near rows.
//!
//! The first row is as long as the last chordwise cell; rows grow by about 1.2 up to a
//! largest length, and vertices of body lines are stations, so that the sheet's inner
//! edge lies on the body.

/// Growth of row length with distance: h(ξ) = h₀ + 0.2 ξ is a ratio of 1.2.
const GROWTH: f64 = 0.2;

/// Longest row in reference semichords: the jump is linear along a row, and the error
/// of Q is 1e-3 at k = 0.2 and 3e-3 at k = 1 with rows of 0.2 b.
const LONGEST_ROW: f64 = 0.2;

/// Stations closer than this part of a row are one. Body vertices must be stations, also
/// where they follow each other closely at a tail: an inner edge that cuts such a corner
/// runs inside the body and puts c_p = −100 beside it.
const CLOSE: f64 = 1e-3;

/// Row length as a function of distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RowLaw {
    first: f64,
    longest: f64,
}

impl RowLaw {
    pub(crate) fn new(first: f64, semichord: f64) -> Self {
        let longest = LONGEST_ROW * semichord;
        Self {
            first: first.min(longest),
            longest,
        }
    }

    fn length(&self, xi: f64) -> f64 {
        (self.first + GROWTH * xi).min(self.longest)
    }

    /// Distance where rows stop growing.
    fn knee(&self) -> f64 {
        (self.longest - self.first) / GROWTH
    }

    /// Number of rows up to ξ: ∫ dξ / h.
    fn rows(&self, xi: f64) -> f64 {
        let grown = xi.min(self.knee());
        let steady = (xi - self.knee()).max(0.0);
        (1.0 + GROWTH * grown / self.first).ln() / GROWTH + steady / self.longest
    }

    /// Inverse of [`Self::rows`].
    fn distance(&self, rows: f64) -> f64 {
        let at_knee = self.rows(self.knee());
        if rows <= at_knee {
            ((GROWTH * rows).exp() - 1.0) * self.first / GROWTH
        } else {
            self.knee() + (rows - at_knee) * self.longest
        }
    }
}

/// Stations from 0 to `end`, through all of `fixed` and the `wanted` ones that are not
/// too close to another.
pub(crate) fn stations(law: RowLaw, wanted: &[f64], fixed: &[f64], end: f64) -> Vec<f64> {
    let mut knots: Vec<f64> = fixed
        .iter()
        .copied()
        .filter(|&x| x > 0.0 && x < end)
        .collect();
    knots.push(0.0);
    knots.push(end);
    for &x in wanted {
        let gap = CLOSE * law.length(x);
        if x > 0.0 && x < end && knots.iter().all(|k| (k - x).abs() > gap) {
            knots.push(x);
        }
    }
    knots.sort_by(f64::total_cmp);
    knots.dedup_by(|b, a| *b - *a < 1e-9 * end);
    let mut all = vec![0.0];
    for pair in knots.windows(2) {
        let [from, to] = [law.rows(pair[0]), law.rows(pair[1])];
        let pieces = (to - from - 1e-9).ceil().max(1.0) as usize;
        for i in 1..pieces {
            all.push(law.distance(from + (to - from) * i as f64 / pieces as f64));
        }
        all.push(pair[1]);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_start_with_the_first_length_and_never_exceed_the_longest() {
        let law = RowLaw::new(0.01, 0.5);
        let all = stations(law, &[0.3, 0.31, 0.310_01], &[0.7], 2.0);
        assert!(all.contains(&0.7) && all.contains(&0.3) && all.contains(&0.31));
        assert!(!all.contains(&0.310_01));
        assert!(all[1] <= 0.0125 && all.last() == Some(&2.0));
        for pair in all.windows(2) {
            let row = pair[1] - pair[0];
            assert!(row > 0.0 && row <= 0.1 * 1.0001, "{pair:?}");
        }
    }
}
