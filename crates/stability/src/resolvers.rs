//! The root of a branch between two speeds, by each method.

use crate::aerodynamics::Aerodynamics;
use crate::crossing::Resolver;
use crate::eigenpair::Eigenpair;
use crate::pk::PkProblem;
use crate::spline::AxisSpline;
use crate::structure::Reduced;
use crate::sweep::{Sweep, reduced_at};
use crate::track::{SMALL_RATE, alikeness};

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
    pub(crate) spline: &'a AxisSpline,
}

impl Resolver for PkResolver<'_> {
    fn near(&self, parameter: f64, guess: &Eigenpair) -> Option<Eigenpair> {
        let reduced = reduced_at(self.sweep, parameter);
        let problem = PkProblem {
            reduced: &reduced,
            spline: self.spline,
            form: self.sweep.pk_form,
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
    fn near(&self, parameter: f64, guess: &Eigenpair) -> Option<Eigenpair> {
        let reduced = reduced_at(self.sweep, parameter);
        crate::polish::polish(&reduced, self.smooth, guess.p, Some(&guess.right))
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
