//! Is a root missing? The argument principle around the region.
//!
//! The change of phase of
//! $$ \frac{\det T(p)}{p^{n_0}\prod_i(p-\lambda_i)(p-\bar\lambda_i)} $$
//! along a closed curve, over $2\pi$, is the number of roots inside that are
//! not among the $\lambda_i$, less that of false ones: zero when the list is
//! right. Dividing by the known roots makes the phase smooth; the number of
//! roots inside the curve is that change plus the number of $\lambda_i$ in it.
//!
//! Two curves: a rectangle above $k = k_0$, and a box around the real axis to
//! the right of the poles of $Q$, of which conjugate symmetry leaves the upper
//! half. Left of the poles and below $k_0$ nothing is claimed: there the roots
//! of the wake's lags crowd around the poles. Where the poles are not known
//! the box lies right of the origin.

use faer::c64;

use crate::aerodynamics::Aerodynamics;
use crate::p2::Region;
use crate::pencil::Pencil;
use crate::structure::Hysteresis;
use crate::winding::{Leg, winding};

/// Heights $k_0$ that are tried, and parts of the way from the origin to the
/// first pole; those farthest from any root are taken.
const HEIGHTS: [f64; 5] = [0.005, 0.004, 0.0062, 0.0033, 0.0075];
const LEFT_PARTS: [f64; 5] = [0.5, 0.4, 0.62, 0.3, 0.75];

/// Pieces into which each long side of a curve is cut at first.
const PIECES: usize = 12;

/// Pieces of the top and of short sides.
const TOP_PIECES: usize = 6;
const FEW_PIECES: usize = 2;

/// Pieces between corners that are close together already.
const ONE_PIECE: usize = 1;

/// Where roots are claimed to be complete.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Claim {
    pub(crate) region: Region,
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

    /// The part of the real axis that is free of poles, cut and what lies
    /// beside them.
    pub(crate) fn real_range(&self) -> [f64; 2] {
        let left = match self.pole {
            Some(pole) => (CUT_PART * pole).max(self.region.g[0]),
            None => RIGHT_OF_CUT,
        };
        [left, self.region.g[1]]
    }

    /// Whether a part of the region lies beside the cut.
    pub(crate) fn has_cut(&self) -> bool {
        self.real_range()[0] > self.region.g[0]
    }

    /// Left end of the box on the real axis: between the origin and the first
    /// pole, or right of the origin where a cut begins there.
    fn left_edge(&self, part: f64) -> f64 {
        match self.pole {
            Some(pole) => (part * pole).max(self.region.g[0]),
            None => part * RIGHT_OF_CUT,
        }
    }
}

/// The cut begins at this part of the way to the first pole.
const CUT_PART: f64 = 0.8;

/// Roots lower than this are beside the cut.
const CUT_HEIGHT: f64 = 1e-3;

/// Where the cut begins at the origin, roots below this slope are beside it.
const CUT_OPENING: f64 = 0.1;

/// Distance from the origin at which the box ends where a cut begins there.
const RIGHT_OF_CUT: f64 = 2e-3;

/// Outcome of a count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    /// Roots in the rectangle that are not in the list, less false ones.
    pub(crate) above: i64,
    /// The same for the box on the real axis; a complex pair counts twice.
    pub(crate) beside_axis: i64,
    /// Roots of the list inside the curves, a complex pair in the box twice.
    pub(crate) listed: i64,
}

impl Tally {
    /// Roots inside the curves that are not in the list, less false ones.
    pub(crate) fn missing(&self) -> i64 {
        self.above + self.beside_axis
    }
}

/// A list of roots to be judged.
#[derive(Clone, Copy)]
pub(crate) struct Census<'a> {
    pub(crate) pencil: &'a Pencil<'a>,
    pub(crate) claim: &'a Claim,
    /// The list: real roots and the upper ones of pairs.
    pub(crate) roots: &'a [c64],
    /// Multiplicity of the root at the origin.
    pub(crate) zeros: usize,
}

impl Census<'_> {
    /// Counts; `None` where a curve runs through a root.
    pub(crate) fn tally(&self) -> Option<Tally> {
        let region = self.claim.region;
        let floor = self.floor();
        let edge = clearest(&LEFT_PARTS, |part| {
            let edge = self.claim.left_edge(part);
            let room = |root: &c64| (root.re - edge).abs() / edge.abs();
            self.roots.iter().map(room).fold(1.0, f64::min)
        });
        let edge = self.claim.left_edge(edge);
        let [left, right] = region.g;
        let beside_cut = [Leg::new(over_the_origin(left, edge, floor), ONE_PIECE)];
        let box_top = [Leg::new(over_the_origin(edge, right, floor), ONE_PIECE)];
        let ends = [
            Leg::new(
                vec![c64::new(right, 0.0), c64::new(right, floor)],
                FEW_PIECES,
            ),
            Leg::new(vec![c64::new(edge, floor), c64::new(edge, 0.0)], FEW_PIECES),
        ];
        let (upper, lower) = (Hysteresis::Included, Hysteresis::LeftOut);
        let shared = self.turns(&box_top, upper)?;
        let above = self.turns(&sides([left, right], [floor, region.k_max]), upper)?
            + self.turns(&beside_cut, upper)?
            + shared;
        let along_box = if self.pencil.reduced.is_hysteretic() {
            self.turns(&box_top, lower)?
        } else {
            shared
        };
        let half = self.turns(&ends, lower)? - along_box;
        Some(Tally {
            above: above.round() as i64,
            beside_axis: (2.0 * half).round() as i64,
            listed: self.listed(floor, edge),
        })
    }

    /// Roots in a rectangle above the real axis that are not in the list.
    pub(crate) fn rectangle(&self, g: [f64; 2], k: [f64; 2]) -> Option<i64> {
        let bottom = over_the_origin(g[0], g[1], k[0]);
        let pieces = if bottom.len() > 3 { ONE_PIECE } else { PIECES };
        let bottom = [Leg::new(bottom, pieces)];
        let turns = self.turns(&sides(g, k), Hysteresis::Included)?
            + self.turns(&bottom, Hysteresis::Included)?;
        Some(turns.round() as i64)
    }

    /// Height of the lower edge of the rectangle.
    pub(crate) fn floor(&self) -> f64 {
        clearest(&HEIGHTS, |height| {
            let room = |root: &c64| (root.im - height).abs() / height;
            self.roots.iter().map(room).fold(1.0, f64::min)
        })
    }

    /// Roots of the list inside rectangle and box.
    fn listed(&self, floor: f64, edge: f64) -> i64 {
        let region = self.claim.region;
        let is_within = |root: &&c64| root.re < region.g[1] && root.im < region.k_max;
        self.roots
            .iter()
            .filter(is_within)
            .map(|root| match root.im {
                im if im > floor => i64::from(root.re > region.g[0]),
                im if root.re <= edge || im < 0.0 => 0,
                0.0 => 1,
                _ => 2,
            })
            .sum::<i64>()
            + self.zeros_in_box(edge)
    }

    /// The zero roots, where the box holds the origin.
    fn zeros_in_box(&self, edge: f64) -> i64 {
        if edge < 0.0 { self.zeros as i64 } else { 0 }
    }

    /// Change of phase of the deflated determinant, in turns.
    fn turns(&self, legs: &[Leg], hysteresis: Hysteresis) -> Option<f64> {
        let directions = |points: &[c64]| self.directions(points, hysteresis);
        Some(winding(legs, &directions)? / std::f64::consts::TAU)
    }

    /// Direction of the deflated determinant at every point.
    fn directions(&self, points: &[c64], hysteresis: Hysteresis) -> Vec<c64> {
        let mut directions = self.pencil.directions(points, hysteresis);
        for (direction, p) in directions.iter_mut().zip(points) {
            let mut divide = |root: c64| {
                let factor = p - root;
                *direction *= factor.conj() / factor.norm_sqr().sqrt();
            };
            for &root in self.roots {
                divide(root);
                if root.im != 0.0 {
                    divide(root.conj());
                }
            }
            (0..self.zeros).for_each(|_| divide(c64::new(0.0, 0.0)));
        }
        directions
    }
}

/// Right side upwards, top to the left, left side downwards.
fn sides(g: [f64; 2], k: [f64; 2]) -> [Leg; 3] {
    let corner = c64::new;
    [
        Leg::new(vec![corner(g[1], k[0]), corner(g[1], k[1])], PIECES),
        Leg::new(vec![corner(g[1], k[1]), corner(g[0], k[1])], TOP_PIECES),
        Leg::new(vec![corner(g[0], k[1]), corner(g[0], k[0])], PIECES),
    ]
}

/// Corners on the line $k =$ `height` between two places, close together near
/// the origin: the roots of slow motions sit below, and would turn the phase
/// by whole circles between two distant samples.
fn over_the_origin(low: f64, high: f64, height: f64) -> Vec<c64> {
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
    places.into_iter().map(|g| c64::new(g, height)).collect()
}

/// The choice with the largest clearance, the first among equals.
pub(crate) fn clearest(choices: &[f64], clearance: impl Fn(f64) -> f64) -> f64 {
    let mut best = (choices[0], clearance(choices[0]));
    for &choice in &choices[1..] {
        let room = clearance(choice);
        if room > best.1 {
            best = (choice, room);
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FromFunction;
    use crate::structure::{OperatingPoint, Reduced, StructuralMatrices, Structure};
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

    fn oscillator_roots() -> Vec<c64> {
        let decay = 0.01_f64;
        let mut roots: Vec<c64> = [0.09, 0.49, 1.21]
            .map(|k: f64| c64::new(-decay, (k - decay * decay).sqrt()))
            .into();
        let real = (decay * decay + 0.01).sqrt();
        roots.push(c64::new(-decay + real, 0.0));
        roots.push(c64::new(-decay - real, 0.0));
        roots.push(c64::new(-0.02, 0.0));
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
    /// once or twice; a false one is noticed too. The number of roots inside
    /// is the same whatever the list.
    #[test]
    fn every_change_of_the_list_is_noticed() {
        let structure = Oscillators((0..5).map(|i| i.to_string()).collect());
        let reduced = Reduced::new(&structure, &OperatingPoint::new(1.0, 1.0), 1.0);
        let region = Region {
            g: [-0.2, 0.2],
            k_max: 1.5,
        };
        let roots = oscillator_roots();
        let (still, unknown) = (Still, FromFunction::new(5, |_| Mat::zeros(5, 5)));
        let tally = |aerodynamics: &dyn Aerodynamics, roots: &[c64]| {
            let pencil = Pencil::new(&reduced, aerodynamics);
            let claim = Claim::new(aerodynamics, region);
            let census = Census {
                pencil: &pencil,
                claim: &claim,
                roots,
                zeros: 1,
            };
            census.tally().unwrap()
        };
        let count = |roots: &[c64]| {
            let tally = tally(&still, roots);
            assert_eq!(tally.missing() + tally.listed, 7, "roots and the zero");
            tally.missing()
        };
        assert_eq!(count(&roots), 0);
        for index in 0..roots.len() {
            let mut fewer = roots.clone();
            fewer.remove(index);
            assert_eq!(count(&fewer), 1, "without {}", roots[index]);
        }
        let mut more = roots.clone();
        more.push(c64::new(0.05, 0.5));
        assert_eq!(count(&more), -1);
        assert_eq!(tally(&unknown, &roots).missing(), 0);
    }
}
