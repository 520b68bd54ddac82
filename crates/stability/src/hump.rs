//! Branches that touch growth between two speeds.
//!
//! A hump mode grows over a short range of speeds only; where both of its
//! crossings lie between two neighbouring speeds no sign changes. The lines on
//! both sides, tangents where the method has them and the secants through the
//! speeds beyond, bound a concave damping from above: where they meet above
//! zero the top is searched for by golden section, and where it is positive
//! there are two crossings. A dip of a growing branch below zero is the same
//! upside down. A hump much narrower than a step, of which the neighbouring
//! speeds know nothing, is not seen.

use crate::crossing::{Bracketed, Resolver, between};
use crate::eigenpair::Eigenpair;
use crate::track::Track;

/// Sections of the search: the top is then known to 1e-4 of a step.
const SECTIONS: usize = 20;

/// Tangents are worth their cost for roots this near to the axis.
pub(crate) const NEAR_AXIS: f64 = 0.02;

/// Shorter part of the golden section.
const SHORT: f64 = 0.381_966_011_250_105;

/// Two crossings between neighbouring speeds, wherever there may be some.
///
/// `tangents` are the changes of $g$ a step at the speeds of the track, where
/// they are known.
pub(crate) fn hidden_crossings(
    number: usize,
    track: &Track,
    tangents: &[Option<f64>],
    resolver: &dyn Resolver,
) -> Vec<Bracketed> {
    let roots = &track.roots;
    let mut found = Vec::new();
    for step in 0..roots.len().saturating_sub(1) {
        let (near, far) = (&roots[step], &roots[step + 1]);
        if (near.p.re > 0.0) != (far.p.re > 0.0) {
            continue;
        }
        let side = if near.p.re > 0.0 { -1.0 } else { 1.0 };
        let value = |root: &Eigenpair| side * root.p.re;
        let values = [value(near), value(far)];
        let rise = step.checked_sub(1).map(|at| values[0] - value(&roots[at]));
        let fall = roots.get(step + 2).map(|after| values[1] - value(after));
        let tangent = |at: usize| tangents.get(at).copied().flatten().map(|rise| side * rise);
        let is_worth = bound(rise, values, fall) > 0.0
            || bound(tangent(step), values, tangent(step + 1).map(|slope| -slope)) > 0.0;
        if !is_worth {
            continue;
        }
        let start = (track.first + step) as f64;
        let ends = [(start, near.clone()), (start + 1.0, far.clone())];
        if let Some(top) = search(&ends, side, resolver) {
            let [low, high] = ends;
            found.push(Bracketed::new(number, low, top.clone()));
            found.push(Bracketed::new(number, top, high));
        }
    }
    found
}

/// Highest value that a concave function may take between two places: `rise`
/// a step away from the first, `fall` a step back from the second.
fn bound(rise: Option<f64>, [near, far]: [f64; 2], fall: Option<f64>) -> f64 {
    match (rise, fall) {
        (None, None) => near.max(far),
        (Some(rise), None) => near + rise.max(0.0),
        (None, Some(fall)) => far + fall.max(0.0),
        (Some(rise), Some(fall)) => {
            // near + rise t = far + fall (1 − t)
            let meeting = (far + fall - near) / (rise + fall);
            if rise + fall > 0.0 && (0.0..=1.0).contains(&meeting) {
                near + rise * meeting
            } else {
                near.max(far)
            }
        }
    }
}

/// A place between the ends where `side` times the damping is positive.
fn search(
    ends: &[(f64, Eigenpair); 2],
    side: f64,
    resolver: &dyn Resolver,
) -> Option<(f64, Eigenpair)> {
    let [low, high] = ends;
    let root = |fraction: f64| {
        let parameter = low.0 + fraction * (high.0 - low.0);
        let guess = between(low, high, parameter);
        let pair = resolver.near(parameter, &guess)?;
        Some((parameter, pair))
    };
    let [mut from, mut to] = [0.0, 1.0];
    let mut inner = [SHORT, 1.0 - SHORT];
    let mut places = [root(inner[0])?, root(inner[1])?];
    for _ in 0..SECTIONS {
        if let Some(place) = places.iter().find(|place| side * place.1.p.re > 0.0) {
            return Some(place.clone());
        }
        let is_first_higher = side * places[0].1.p.re > side * places[1].1.p.re;
        if is_first_higher {
            to = inner[1];
            inner = [from + SHORT * (to - from), inner[0]];
            places = [root(inner[0])?, places[0].clone()];
        } else {
            from = inner[0];
            inner = [inner[1], to - SHORT * (to - from)];
            places = [places[1].clone(), root(inner[1])?];
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::c64;

    /// Damping $-0.01 + 0.012\,e^{-((t-2.45)/0.5)^2}$: above zero between two
    /// speeds only.
    struct Hump;

    fn damping(t: f64) -> f64 {
        -0.01 + 0.012 * (-((t - 2.45) / 0.5).powi(2)).exp()
    }

    fn pair(t: f64) -> Eigenpair {
        Eigenpair {
            p: c64::new(damping(t), 0.5),
            right: vec![c64::new(1.0, 0.0)],
            left: vec![c64::new(1.0, 0.0)],
        }
    }

    impl Resolver for Hump {
        fn near(&self, parameter: f64, _: &Eigenpair) -> Option<Eigenpair> {
            Some(pair(parameter))
        }
    }

    /// Both crossings are found although no speed lies between them; a branch
    /// that stays below zero has none.
    #[test]
    fn two_crossings_between_neighbouring_speeds_are_found() {
        let track = |places: &[f64]| Track {
            first: 0,
            roots: places.iter().map(|t| pair(*t)).collect(),
        };
        let rise = |t: f64| -2.0 * (t - 2.45) / 0.25 * (damping(t) + 0.01);
        let places: Vec<f64> = (0..6).map(f64::from).collect();
        let sampled = track(&places);
        assert!(sampled.roots.iter().all(|root| root.p.re < 0.0));
        let tangents: Vec<Option<f64>> = places.iter().map(|t| Some(rise(*t))).collect();
        let half = 0.5 * (0.012_f64 / 0.01).ln().sqrt();
        let brackets = hidden_crossings(0, &sampled, &tangents, &Hump);
        assert_eq!(brackets.len(), 2);
        let found: Vec<f64> = brackets
            .iter()
            .map(|bracket| crate::crossing::locate(bracket, &Hump).unwrap().parameter)
            .collect();
        println!("crossings at {found:?}");
        assert!((found[0] - (2.45 - half)).abs() < 1e-9);
        assert!((found[1] - (2.45 + half)).abs() < 1e-9);
        let stable = track(&[0.0, 0.5, 1.0, 1.5]);
        assert!(hidden_crossings(0, &stable, &[], &Hump).is_empty());
    }
}
