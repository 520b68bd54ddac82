//! Streamwise stations of the wake's near rows.
//!
//! The first row is as long as the last chordwise cell; rows grow by about 1.2 up to a
//! largest length. A line of the sheet has points of its own besides: the vertices of a
//! body line, also where they follow each other closely at a tail. An inner edge that cuts
//! such a corner runs inside the body and puts c_p = −100 beside it.

/// Growth of row length with distance: h(ξ) = h₀ + 0.2 ξ is a ratio of 1.2.
const GROWTH: f64 = 0.2;

/// Longest row in reference semichords: the jump is linear along a row, and the error
/// of Q is 1e-3 at k = 0.2 and 3e-3 at k = 1 with rows of 0.2 b.
const LONGEST_ROW: f64 = 0.2;

/// Stations closer than this part of a row to a point of a line's own are left out there.
const CLOSE: f64 = 0.3;

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

    pub(crate) fn length(&self, xi: f64) -> f64 {
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

/// Stations from 0 to `end`.
pub(crate) fn stations(law: RowLaw, end: f64) -> Vec<f64> {
    let rows = law.rows(end);
    let pieces = (rows - 1e-9).ceil().max(1.0) as usize;
    let mut all: Vec<f64> = (0..pieces)
        .map(|i| law.distance(rows * i as f64 / pieces as f64))
        .collect();
    all.push(end);
    all
}

/// The stations behind a line's first own point (`own` ascending) that are not close to
/// one of its own; the last station always.
pub(crate) fn between(law: RowLaw, own: &[f64], stations: &[f64]) -> Vec<f64> {
    let Some((&end, inner)) = stations.split_last() else {
        return Vec::new();
    };
    let is_apart = |x: f64| {
        let gap = CLOSE * law.length(x);
        let next = own.partition_point(|o| *o < x);
        next > 0 && x - own[next - 1] > gap && own.get(next).is_none_or(|o| o - x > gap)
    };
    inner
        .iter()
        .copied()
        .filter(|&x| is_apart(x))
        .chain([end])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_start_with_the_first_length_and_never_exceed_the_longest() {
        let law = RowLaw::new(0.01, 0.5);
        let all = stations(law, 2.0);
        assert!(all[0] == 0.0 && all[1] <= 0.0125 && all.last() == Some(&2.0));
        for pair in all.windows(2) {
            let row = pair[1] - pair[0];
            assert!(row > 0.0 && row <= 0.1 * 1.0001, "{pair:?}");
        }
    }

    #[test]
    fn stations_close_to_a_lines_own_points_are_left_out() {
        let law = RowLaw::new(0.1, 0.5);
        let line = between(law, &[0.32, 0.33, 0.5], &[0.0, 0.1, 0.3, 0.4, 0.52, 0.6]);
        assert_eq!(line, [0.4, 0.6]);
    }
}
