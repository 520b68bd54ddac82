//! Divergence pressures placed on the sweep.

use crate::divergence::static_divergence;
use crate::report::{kind_of, leading_mode};
use crate::results::Divergence;
use crate::spline::AxisForces;
use crate::structure::OperatingPoint;
use crate::sweep::{Sweep, SweepError, q_at_rest, reduced_at};

/// Halvings of a step of the sweep: 1e-15 of a step.
const HALVINGS: usize = 50;

/// Static divergences within the sweep, lowest speed first.
pub(crate) fn divergences(
    sweep: &Sweep<'_>,
    points: &[OperatingPoint],
    forces: &dyn AxisForces,
) -> Result<Vec<Divergence>, SweepError> {
    let reduced = reduced_at(sweep, 0.0);
    let rigid = sweep.structure.rigid_modes();
    let found = static_divergence(&reduced.stiffness, &q_at_rest(forces), &rigid).map_err(
        |source| SweepError::Numerical {
            airspeed: points[0].airspeed,
            source,
        },
    )?;
    let mut listed = Vec::new();
    for divergence in found {
        let shares = reduced.energy_shares(&divergence.shape);
        for step in 0..points.len().saturating_sub(1) {
            let excess = |parameter: f64| {
                sweep.schedule.at(parameter).dynamic_pressure() - divergence.pressure
            };
            let start = step as f64;
            if (excess(start) > 0.0) == (excess(start + 1.0) > 0.0) {
                continue;
            }
            let point = sweep
                .schedule
                .at(change_of_sign(&excess, start, start + 1.0));
            listed.push(Divergence {
                speed: point.airspeed,
                dynamic_pressure: divergence.pressure,
                branch: leading_mode(sweep.structure.modes(), &shares).to_owned(),
                kind: kind_of(&shares, &rigid),
                altitude: point.altitude,
            });
        }
    }
    listed.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    Ok(listed)
}

fn change_of_sign(function: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let is_positive = function(high) > 0.0;
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if (function(middle) > 0.0) == is_positive {
            high = middle;
        } else {
            low = middle;
        }
    }
    f64::midpoint(low, high)
}
