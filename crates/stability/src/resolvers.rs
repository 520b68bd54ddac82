//! The root of a branch between two speeds, by each method.

use faer::c64;
use rayon::prelude::*;

use crate::aerodynamics::Aerodynamics;
use crate::crossing::Resolver;
use crate::eigenpair::Eigenpair;
use crate::flutter_point::{Local, Moving, change_along, flutter_point};
use crate::hump::NEAR_AXIS;
use crate::linalg::{apply, inner};
use crate::pencil::Pencil;
use crate::pk::{PkForm, PkProblem};
use crate::sensitivity::{Parameter, Sensitivity, quotient, root_sensitivity};
use crate::spline::AxisForces;
use crate::structure::Reduced;
use crate::sweep::{Sweep, reduced_at};
use crate::track::{SMALL_RATE, Track, alikeness};

/// Cells whose border is within this part of their size of the expected root
/// are solved.
const REACH: f64 = 0.5;

/// Roots of the piecewise quadratic.
pub(crate) struct P2Resolver<'a> {
    pub(crate) sweep: &'a Sweep<'a>,
}

impl Resolver for P2Resolver<'_> {
    fn near(&self, parameter: f64, guess: &Eigenpair) -> Option<Eigenpair> {
        let reduced = reduced_at(self.sweep, parameter);
        let roots = crate::p2::roots_near(self.sweep.fit, &reduced, guess.p, REACH).ok()?;
        nearest(&reduced, roots, guess)
    }
}

/// Roots of the p-k problem.
pub(crate) struct PkResolver<'a> {
    pub(crate) sweep: &'a Sweep<'a>,
    pub(crate) forces: &'a dyn AxisForces,
    pub(crate) form: PkForm,
}

impl Resolver for PkResolver<'_> {
    fn near(&self, parameter: f64, guess: &Eigenpair) -> Option<Eigenpair> {
        let reduced = reduced_at(self.sweep, parameter);
        let problem = PkProblem {
            reduced: &reduced,
            forces: self.forces,
            form: self.form,
        };
        nearest(&reduced, vec![problem.near(guess.p)?], guess)
    }
}

/// Roots on a smooth $Q(p)$.
pub(crate) struct PolishedResolver<'a> {
    pub(crate) sweep: &'a Sweep<'a>,
    pub(crate) smooth: &'a dyn Aerodynamics,
}

impl Resolver for PolishedResolver<'_> {
    fn continues_samples(&self) -> bool {
        !self.smooth.is_exact()
    }

    fn near(&self, parameter: f64, guess: &Eigenpair) -> Option<Eigenpair> {
        let reduced = reduced_at(self.sweep, parameter);
        crate::polish::polish(&reduced, self.smooth, guess.p, Some(&guess.right))
    }

    /// By Newton's iteration; a root of another shape is another root.
    fn crossing(
        &self,
        parameter: f64,
        guess: &Eigenpair,
        bounds: [f64; 2],
    ) -> Option<(f64, Eigenpair)> {
        let point = flutter_point(self, guess, parameter, bounds)?;
        let reduced = reduced_at(self.sweep, point.parameter);
        let p = c64::new(0.0, point.k);
        let pair = Pencil::new(&reduced, self.smooth).pair(p);
        let likeness = alikeness(&pair.right, &guess.right, &reduced.mass);
        (likeness > LEAST_LIKENESS).then_some((point.parameter, pair))
    }

    /// Roots near the axis of one speed together.
    fn tangents(&self, tracks: &[Track]) -> Vec<Vec<Option<f64>>> {
        let mut tangents: Vec<Vec<Option<f64>>> = tracks
            .iter()
            .map(|track| vec![None; track.roots.len()])
            .collect();
        let mut stations: Vec<Vec<(usize, usize)>> =
            vec![Vec::new(); self.sweep.schedule.count()];
        for (number, track) in tracks.iter().enumerate() {
            for (at, root) in track.roots.iter().enumerate() {
                if root.p.re.abs() < NEAR_AXIS && root.p.im > 0.0 {
                    stations[track.first + at].push((number, at));
                }
            }
        }
        if stations.len() < 2 {
            return tangents;
        }
        let solved: Vec<Vec<Option<f64>>> = stations
            .par_iter()
            .enumerate()
            .map(|(station, places)| {
                let pairs: Vec<&Eigenpair> = places
                    .iter()
                    .map(|(track, at)| &tracks[*track].roots[*at])
                    .collect();
                self.tangents_at(station, &pairs)
            })
            .collect();
        for (places, solved) in stations.iter().zip(solved) {
            for ((track, at), tangent) in places.iter().zip(solved) {
                tangents[*track][*at] = tangent;
            }
        }
        tangents
    }

    fn sensitivities(&self, parameter: f64, pair: &Eigenpair) -> Vec<Sensitivity> {
        let local = self.local(parameter, pair.p);
        let along = quotient(&local.slope, pair, &local.change);
        let reduced = reduced_at(self.sweep, parameter);
        let [airspeed, airspeed_change] = airspeed_and_change(self.sweep, parameter);
        let semichord = self.sweep.table.semichord();
        let each = |property: &Parameter| {
            let p = root_sensitivity(&reduced, &local.slope, pair, property);
            let place = -p.re / along.re;
            let k = (p + along * place).im;
            let speed = airspeed_change * place;
            let omega = (k * airspeed + pair.p.im * speed) / semichord;
            Sensitivity {
                parameter: property.name.clone(),
                unit: property.unit,
                value: property.value,
                speed,
                frequency_hz: omega / std::f64::consts::TAU,
            }
        };
        self.sweep.parameters.iter().map(each).collect()
    }
}

impl PolishedResolver<'_> {
    /// $\operatorname{Re}p_t$ of roots at one speed. Because $Tx = 0$ gives
    /// $Q(p)x$, no force is evaluated for $T_tx$.
    fn tangents_at(&self, station: usize, pairs: &[&Eigenpair]) -> Vec<Option<f64>> {
        let here = reduced_at(self.sweep, station as f64);
        let is_last = station + 1 == self.sweep.schedule.count();
        let step = if is_last { -TANGENT_STEP } else { TANGENT_STEP };
        let beside = reduced_at(self.sweep, station as f64 + step);
        let points: Vec<c64> = pairs.iter().map(|pair| pair.p).collect();
        let mut tangents = vec![None; pairs.len()];
        Pencil::new(&here, self.smooth).each_operator_and_slope(&points, |number, _, slope| {
            let pair = pairs[number];
            let change = match self.sweep.mixture {
                None => here.change_to(&beside, pair),
                Some(_) => self.whole_change(&here, &beside, pair),
            };
            let slope = inner(&pair.left, &apply(slope.as_ref(), &pair.right));
            let tangent = -(change / slope).re / step;
            tangents[number] = tangent.is_finite().then_some(tangent);
        });
        tangents
    }

    /// $y^H(T_2 - T_1)x$ with forces that change too.
    fn whole_change(&self, here: &Reduced, beside: &Reduced, pair: &Eigenpair) -> c64 {
        let q = self.smooth.q(pair.p);
        let image = |reduced: &Reduced| {
            let operator = reduced.operator(pair.p, &q, Reduced::hysteresis_at(pair.p));
            inner(&pair.left, &apply(operator.as_ref(), &pair.right))
        };
        image(beside) - image(here)
    }
}

/// Part of a step of the sweep for a tangent.
const TANGENT_STEP: f64 = 1e-4;

/// Airspeed at a place of the sweep and its change per step.
fn airspeed_and_change(sweep: &Sweep<'_>, parameter: f64) -> [f64; 2] {
    const HALF_STEP: f64 = 1e-4;
    let last = (sweep.schedule.count() - 1) as f64;
    let airspeed = |parameter: f64| sweep.schedule.at(parameter).airspeed;
    let low = (parameter - HALF_STEP).max(0.0);
    let high = (parameter + HALF_STEP).min(last);
    [
        airspeed(parameter),
        (airspeed(high) - airspeed(low)) / (high - low),
    ]
}

/// Least likeness of a crossing to the root at the nearer speed.
const LEAST_LIKENESS: f64 = 0.5;

impl Moving for PolishedResolver<'_> {
    fn local(&self, parameter: f64, p: c64) -> Local {
        let (q, q_slope) = self.smooth.q_and_slope(p);
        let operator_at = |parameter: f64| {
            let reduced = reduced_at(self.sweep, parameter);
            reduced.operator(p, &q, Reduced::hysteresis_at(p))
        };
        let last = (self.sweep.schedule.count() - 1) as f64;
        Local {
            operator: operator_at(parameter),
            slope: reduced_at(self.sweep, parameter).operator_slope(p, &q_slope),
            change: change_along(operator_at, parameter, last),
        }
    }
}

/// A root whose distance and unlikeness add up to more does not continue the
/// branch.
const DEAREST: f64 = 0.5;

/// The root that continues `guess`: near in $p$ and alike in shape, and of
/// its kind, real or complex.
fn nearest(reduced: &Reduced, roots: Vec<Eigenpair>, guess: &Eigenpair) -> Option<Eigenpair> {
    let cost = |root: &Eigenpair| {
        let scale = f64::midpoint(guess.p.norm(), root.p.norm()) + SMALL_RATE / reduced.rate;
        1.0 - alikeness(&root.right, &guess.right, &reduced.mass)
            + (root.p - guess.p).norm() / scale
    };
    roots
        .into_iter()
        .filter(|root| (root.p.im == 0.0) == (guess.p.im == 0.0))
        .map(|root| (cost(&root), root))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(cost, _)| *cost < DEAREST)
        .map(|(_, root)| root)
}
