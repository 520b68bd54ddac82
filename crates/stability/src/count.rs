//! Is a root missing? The argument principle around the region.
//!
//! The change of phase of
//! $$ \frac{\det T(p)}{p^{n_0}\prod_i(p-\lambda_i)(p-\bar\lambda_i)} $$
//! along a closed curve, over $2\pi$, is the number of roots inside that are
//! not among the $\lambda_i$, less that of false ones: zero when the list is
//! right. Dividing by the known roots makes the phase smooth.
//!
//! Two curves: a rectangle above $k = k_0$, and a box around the real axis to
//! the right of the poles of $Q$, of which conjugate symmetry leaves the upper
//! half. Left of the poles and below $k_0$ nothing is claimed: there the roots
//! of the wake's lags crowd around the poles. Where the poles are not known
//! the box lies right of the origin.

use faer::c64;

use crate::aerodynamics::Aerodynamics;
use crate::eigenpair::Eigenpair;
use crate::linalg::Lu;
use crate::p2::Region;
use crate::structure::{Hysteresis, Reduced};

/// Heights $k_0$ that are tried, and parts of the way from the origin to the
/// first pole; those farthest from any root are taken.
const HEIGHTS: [f64; 5] = [0.005, 0.004, 0.0062, 0.0033, 0.0075];
const LEFT_PARTS: [f64; 5] = [0.5, 0.4, 0.62, 0.3, 0.75];

/// Pieces into which each long side of a curve is cut at first.
const PIECES: usize = 12;

/// Pieces of a short side.
const FEW_PIECES: usize = 3;

/// A piece is halved until its phase turns by less than this.
const LARGEST_TURN: f64 = std::f64::consts::FRAC_PI_3;

/// Two halves and the whole must agree to this.
const AGREEMENT: f64 = 1e-6;

/// Halvings before a piece is given up: a root lies on the curve.
const MOST_HALVINGS: u32 = 24;

/// Where roots are claimed to be complete.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Claim {
    region: Region,
    /// Real part of the rightmost pole; the origin where it is not known.
    pole: Option<f64>,
}

impl Claim {
    pub(crate) fn new(aerodynamics: &dyn Aerodynamics, region: Region) -> Self {
        Self {
            region,
            pole: aerodynamics.rightmost_pole(),
        }
    }

    /// Beside the cut, or left of the first pole near the real axis.
    pub(crate) fn is_beside_cut(&self, p: c64) -> bool {
        match self.pole {
            Some(pole) => p.re < CUT_PART * pole && p.im < CUT_HEIGHT,
            None => p.re < 0.0 && p.im < CUT_HEIGHT.min(CUT_OPENING * -p.re),
        }
    }
}

/// The cut begins at this part of the way to the first pole.
const CUT_PART: f64 = 0.8;

/// Roots lower than this are beside the cut.
const CUT_HEIGHT: f64 = 1e-3;

/// Where the cut begins at the origin, roots below this slope are beside it.
const CUT_OPENING: f64 = 0.1;

/// Counts the roots that are inside the curves but not in the list; `None`
/// where a curve runs through a root.
pub(crate) fn missing_roots(
    reduced: &Reduced,
    aerodynamics: &dyn Aerodynamics,
    roots: &[Eigenpair],
    zeros: usize,
    claim: &Claim,
) -> Option<i64> {
    let region = claim.region;
    let floor = clearest(&HEIGHTS, |height| {
        roots
            .iter()
            .map(|root| (root.p.im - height).abs() / height)
            .fold(1.0, f64::min)
    });
    let [left, right] = region.g;
    let corner = c64::new;
    let sides = [
        corner(right, floor),
        corner(right, region.k_max),
        corner(left, region.k_max),
        corner(left, floor),
    ];
    let upper = Curve {
        reduced,
        aerodynamics,
        roots,
        zeros,
        hysteresis: Hysteresis::Included,
    };
    let lower = Curve {
        hysteresis: Hysteresis::LeftOut,
        ..upper
    };
    let edge = clearest(&LEFT_PARTS, |part| {
        let edge = claim.left_edge(part);
        roots
            .iter()
            .map(|root| (root.p.re - edge).abs() / edge.abs())
            .fold(1.0, f64::min)
    });
    let edge = claim.left_edge(edge);
    let end = [corner(edge, floor), corner(edge, 0.0)];
    let start = [corner(right, 0.0), corner(right, floor)];
    let box_top = lower.turn(&over_the_origin(right, edge, floor), FEW_PIECES)?;
    let half = lower.turn(&start, FEW_PIECES)? + box_top + lower.turn(&end, FEW_PIECES)?;
    let bottom = upper.turn(&over_the_origin(left, right, floor), FEW_PIECES)?;
    let turns = upper.turn(&sides, PIECES)? + bottom + 2.0 * half;
    Some((turns / std::f64::consts::TAU).round() as i64)
}

impl Claim {
    /// Left end of the box on the real axis: between the origin and the first
    /// pole, or right of the origin where a cut begins there.
    fn left_edge(&self, part: f64) -> f64 {
        match self.pole {
            Some(pole) => (part * pole).max(self.region.g[0]),
            None => part * RIGHT_OF_CUT,
        }
    }
}

/// Distance from the origin at which the box ends where a cut begins there.
const RIGHT_OF_CUT: f64 = 2e-3;

/// Corners on the line $k =$ `height` from `from` to `to`, close together near
/// the origin: the roots of slow motions sit below, and would turn the phase
/// by whole circles between two distant samples.
fn over_the_origin(from: f64, to: f64, height: f64) -> Vec<c64> {
    let (low, high) = (from.min(to), from.max(to));
    let mut places = vec![low, high];
    let mut distance = 0.5 * height;
    while distance < low.abs().max(high.abs()) {
        places.extend(
            [-distance, distance]
                .into_iter()
                .filter(|g| *g > low && *g < high),
        );
        distance *= 2.0;
    }
    if low < 0.0 && high > 0.0 {
        places.push(0.0);
    }
    places.sort_by(f64::total_cmp);
    if from > to {
        places.reverse();
    }
    places.into_iter().map(|g| c64::new(g, height)).collect()
}

/// The choice with the largest clearance, the first among equals.
fn clearest(choices: &[f64], clearance: impl Fn(f64) -> f64) -> f64 {
    let mut best = (choices[0], clearance(choices[0]));
    for &choice in &choices[1..] {
        let room = clearance(choice);
        if room > best.1 {
            best = (choice, room);
        }
    }
    best.0
}

#[derive(Clone, Copy)]
struct Curve<'a> {
    reduced: &'a Reduced,
    aerodynamics: &'a dyn Aerodynamics,
    roots: &'a [Eigenpair],
    zeros: usize,
    hysteresis: Hysteresis,
}

impl Curve<'_> {
    /// Direction of the deflated determinant.
    fn direction(&self, p: c64) -> c64 {
        let operator = self
            .reduced
            .operator(p, &self.aerodynamics.q(p), self.hysteresis);
        let (_, mut direction) = Lu::new(operator).determinant();
        let mut divide = |root: c64| {
            let factor = p - root;
            direction *= factor.conj() / factor.norm();
        };
        for root in self.roots {
            divide(root.p);
            if root.p.im != 0.0 {
                divide(root.p.conj());
            }
        }
        (0..self.zeros).for_each(|_| divide(c64::new(0.0, 0.0)));
        direction
    }

    /// Change of phase along a chain of straight lines.
    fn turn(&self, corners: &[c64], pieces: usize) -> Option<f64> {
        let mut total = 0.0;
        for ends in corners.windows(2) {
            let place = |piece: usize| ends[0] + (ends[1] - ends[0]) * graded(piece, pieces);
            let mut start = (ends[0], self.direction(ends[0]));
            for piece in 1..=pieces {
                let end = (place(piece), self.direction(place(piece)));
                total += self.turn_between(start, end, MOST_HALVINGS)?;
                start = end;
            }
        }
        Some(total)
    }

    fn turn_between(&self, start: (c64, c64), end: (c64, c64), halvings: u32) -> Option<f64> {
        let middle = (start.0 + end.0) * 0.5;
        let middle = (middle, self.direction(middle));
        let [first, second] = [phase(start.1, middle.1), phase(middle.1, end.1)];
        let whole = phase(start.1, end.1);
        let is_smooth = first.abs() < LARGEST_TURN
            && second.abs() < LARGEST_TURN
            && (first + second - whole).abs() < AGREEMENT;
        if is_smooth {
            return Some(first + second);
        }
        let left = halvings.checked_sub(1)?;
        Some(self.turn_between(start, middle, left)? + self.turn_between(middle, end, left)?)
    }
}

/// Places along a side, 0 … 1, denser at both ends, where poles and zeros of
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
    use crate::FromFunction;
    use crate::structure::{OperatingPoint, StructuralMatrices, Structure};
    use faer::Mat;

    struct Oscillators(Vec<String>);

    impl Structure for Oscillators {
        fn modes(&self) -> &[String] {
            &self.0
        }

        fn rigid_modes(&self) -> Vec<usize> {
            Vec::new()
        }

        /// Frequencies 0.3, 0.7 and 1.1, a free mode and a real pair, with
        /// light damping.
        fn at(&self, _: &OperatingPoint) -> StructuralMatrices {
            let stiffness = [0.09, 0.49, 1.21, 0.0, -0.01];
            let pick = |i: usize, j: usize, value: f64| if i == j { value } else { 0.0 };
            StructuralMatrices {
                mass: Mat::from_fn(5, 5, |i, j| pick(i, j, 1.0)),
                damping: Mat::from_fn(5, 5, |i, j| pick(i, j, 0.02)),
                stiffness: Mat::from_fn(5, 5, |i, j| pick(i, j, stiffness[i])),
                hysteretic: None,
                flight_path: None,
            }
        }
    }

    fn oscillator_roots() -> Vec<Eigenpair> {
        let decay = 0.01_f64;
        let pair = |p: c64| Eigenpair {
            p,
            right: Vec::new(),
            left: Vec::new(),
        };
        let mut roots: Vec<Eigenpair> = [0.09, 0.49, 1.21]
            .map(|k: f64| pair(c64::new(-decay, (k - decay * decay).sqrt())))
            .into();
        let real = (decay * decay + 0.01).sqrt();
        roots.push(pair(c64::new(-decay + real, 0.0)));
        roots.push(pair(c64::new(-decay - real, 0.0)));
        roots.push(pair(c64::new(-0.02, 0.0)));
        roots
    }

    /// No aerodynamics, with a pole far to the left.
    struct Still;

    impl Aerodynamics for Still {
        fn order(&self) -> usize {
            5
        }
        fn q(&self, _: c64) -> Mat<c64> {
            Mat::zeros(5, 5)
        }
        fn rightmost_pole(&self) -> Option<f64> {
            Some(-1.0)
        }
    }

    /// The full list passes; a root taken out, complex or real, is missed
    /// once or twice; a false one is noticed too.
    #[test]
    fn every_change_of_the_list_is_noticed() {
        let structure = Oscillators((0..5).map(|i| i.to_string()).collect());
        let reduced = Reduced::new(&structure, &OperatingPoint::new(1.0, 1.0), 1.0);
        let region = Region {
            g: [-0.2, 0.2],
            k_max: 1.5,
        };
        let roots = oscillator_roots();
        let count = |roots: &[Eigenpair]| {
            missing_roots(&reduced, &Still, roots, 1, &Claim::new(&Still, region)).unwrap()
        };
        assert_eq!(count(&roots), 0);
        for index in 0..roots.len() {
            let mut fewer = roots.clone();
            fewer.remove(index);
            assert_eq!(count(&fewer), 1, "without {}", roots[index].p);
        }
        let mut more = roots.clone();
        more.push(Eigenpair {
            p: c64::new(0.05, 0.5),
            ..roots[0].clone()
        });
        assert_eq!(count(&more), -1);
        let unknown = FromFunction::new(5, |_| Mat::zeros(5, 5));
        let claim = Claim::new(&unknown, region);
        assert_eq!(
            missing_roots(&reduced, &unknown, &roots, 1, &claim),
            Some(0)
        );
    }
}
