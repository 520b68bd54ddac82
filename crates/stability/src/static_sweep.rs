//! Divergence pressures placed on the sweep.

use faer::Mat;

use crate::divergence::{StaticDivergence, static_divergence};
use crate::report::{kind_of, leading_mode};
use crate::results::Divergence;
use crate::spline::AxisForces;
use crate::structure::OperatingPoint;
use crate::sweep::{Sweep, SweepError, q_at_rest, reduced_at};

/// Halvings of a step of the sweep: 1e-15 of a step.
const HALVINGS: usize = 50;

/// Static divergences within the sweep, lowest speed first.
///
/// Where the number of divergence pressures below the sweep's own changes
/// between two speeds, the place is found by halving.
pub(crate) fn divergences(
    sweep: &Sweep<'_>,
    points: &[OperatingPoint],
    forces: &dyn AxisForces,
) -> Result<Vec<Divergence>, SweepError> {
    let at_rest = q_at_rest(forces);
    let rigid = sweep.structure.rigid_modes();
    let spent = |parameter: f64| -> Result<Vec<StaticDivergence>, SweepError> {
        let reduced = reduced_at(sweep, parameter);
        let per_pressure = 1.0 / reduced.pressure;
        let loads = reduced.loads(&at_rest);
        let q = Mat::from_fn(loads.nrows(), loads.ncols(), |i, j| {
            loads[(i, j)] * per_pressure
        });
        let found = static_divergence(&reduced.stiffness, &q, &rigid).map_err(|source| {
            SweepError::Numerical {
                airspeed: sweep.schedule.at(parameter).airspeed,
                source,
            }
        })?;
        let is_spent = |one: &StaticDivergence| one.pressure < reduced.pressure;
        Ok(found.into_iter().filter(is_spent).collect())
    };
    let mut listed = Vec::new();
    let mut before = spent(0.0)?.len();
    for step in 0..points.len().saturating_sub(1) {
        let start = step as f64;
        let after = spent(start + 1.0)?.len();
        for number in before.min(after)..before.max(after) {
            let (mut low, mut high) = (start, start + 1.0);
            for _ in 0..HALVINGS {
                let middle = f64::midpoint(low, high);
                if (spent(middle)?.len() > number) == (after > number) {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            // The side where it is spent has its shape.
            let side = if after > number { high } else { low };
            let Some(divergence) = spent(side)?.into_iter().nth(number) else {
                continue;
            };
            let shares = reduced_at(sweep, side).energy_shares(&divergence.shape);
            let point = sweep.schedule.at(side);
            listed.push(Divergence {
                speed: point.airspeed,
                dynamic_pressure: point.dynamic_pressure(),
                branch: leading_mode(sweep.structure.modes(), &shares).to_owned(),
                kind: kind_of(&shares, &rigid),
                altitude: point.altitude,
            });
        }
        before = after;
    }
    listed.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    Ok(listed)
}
