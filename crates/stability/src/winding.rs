//! Change of phase of a function along a curve.
//!
//! The curve is sampled, and a piece is halved until its two halves turn by
//! less than 60° each and add up to the whole. All pieces of one generation
//! are evaluated together.

use faer::c64;

/// A piece is halved until its phase turns by less than this.
const LARGEST_TURN: f64 = std::f64::consts::FRAC_PI_3;

/// Two halves and the whole must agree to this.
const AGREEMENT: f64 = 1e-6;

/// Halvings before a piece is given up: a root lies on the curve.
const MOST_HALVINGS: usize = 24;

/// Part of a curve: straight lines between corners.
#[derive(Clone, Debug)]
pub(crate) struct Leg {
    corners: Vec<c64>,
    /// Pieces into which each line is cut at first.
    pieces: usize,
}

impl Leg {
    pub(crate) fn new(corners: Vec<c64>, pieces: usize) -> Self {
        Self { corners, pieces }
    }

    /// Ends of the first pieces.
    fn places(&self) -> Vec<c64> {
        let mut places = vec![self.corners[0]];
        for ends in self.corners.windows(2) {
            let place = |piece| ends[0] + (ends[1] - ends[0]) * graded(piece, self.pieces);
            places.extend((1..=self.pieces).map(place));
        }
        places
    }
}

/// A place and the direction of the function there.
type Sample = (c64, c64);

/// Sum of the changes of phase along all legs; `None` where a root lies on the
/// curve. `directions` gives the function at several points, of unit size.
pub(crate) fn winding(legs: &[Leg], directions: &dyn Fn(&[c64]) -> Vec<c64>) -> Option<f64> {
    let places: Vec<Vec<c64>> = legs.iter().map(Leg::places).collect();
    let flat: Vec<c64> = places.iter().flatten().copied().collect();
    let samples: Vec<Sample> = flat.iter().copied().zip(directions(&flat)).collect();
    let mut open: Vec<[Sample; 2]> = Vec::with_capacity(flat.len());
    let mut first = 0;
    for leg in &places {
        let along = &samples[first..first + leg.len()];
        open.extend(along.windows(2).map(|ends| [ends[0], ends[1]]));
        first += leg.len();
    }
    let mut total = 0.0;
    for _ in 0..MOST_HALVINGS {
        let middles: Vec<c64> = open.iter().map(|[a, b]| (a.0 + b.0) * 0.5).collect();
        let values = directions(&middles);
        let mut next = Vec::new();
        for ([start, end], middle) in open.into_iter().zip(middles.into_iter().zip(values)) {
            match smooth_turn(start.1, middle.1, end.1) {
                Some(turn) => total += turn,
                None => next.extend([[start, middle], [middle, end]]),
            }
        }
        if next.is_empty() {
            return Some(total);
        }
        open = next;
    }
    None
}

/// Turn from start over the middle to the end, where it is certain.
fn smooth_turn(start: c64, middle: c64, end: c64) -> Option<f64> {
    let [first, second] = [phase(start, middle), phase(middle, end)];
    let is_smooth = first.abs() < LARGEST_TURN
        && second.abs() < LARGEST_TURN
        && (first + second - phase(start, end)).abs() < AGREEMENT;
    is_smooth.then_some(first + second)
}

/// Places along a line, 0 … 1, denser at both ends, where poles and zeros of
/// the real axis are near.
fn graded(piece: usize, pieces: usize) -> f64 {
    let t = piece as f64 / pieces as f64;
    if piece == pieces {
        1.0
    } else {
        t * t * (3.0 - 2.0 * t)
    }
}

fn phase(from: c64, to: c64) -> f64 {
    let turn = to * from.conj();
    turn.im.atan2(turn.re)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Zeros inside a square count one turn each, a pole minus one, those
    /// outside nothing; a zero on the curve is told.
    #[test]
    fn zeros_less_poles_are_counted() {
        let corner = |g, k| c64::new(g, k);
        let square = Leg::new(
            vec![
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
            ],
            4,
        );
        let turns = |zeros: &[c64], poles: &[c64]| {
            let direction = |p: &c64| {
                let up: c64 = zeros.iter().map(|zero| p - zero).product();
                let down: c64 = poles.iter().map(|pole| p - pole).product();
                let value = up / down;
                value / value.norm()
            };
            let directions = |points: &[c64]| points.iter().map(direction).collect();
            winding(std::slice::from_ref(&square), &directions)
        };
        let inside = [
            c64::new(0.3, 0.2),
            c64::new(-0.97, 0.9),
            c64::new(0.999, 0.1),
        ];
        let total = turns(&inside, &[c64::new(0.0, -0.5)]).unwrap();
        assert!((total / TAU - 2.0).abs() < 1e-9, "{total}");
        let total = turns(&[c64::new(1.001, 0.4)], &[]).unwrap();
        assert!(total.abs() < 1e-9, "{total}");
        assert_eq!(turns(&[c64::new(1.0, 0.123)], &[]), None);
    }
}
