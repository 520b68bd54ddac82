//! The classical rigid aircraft, to compare.
//!
//! With derivatives alone, $Q(p)\approx p\,\mathrm dQ/\mathrm dp(0)$ of the
//! six rigid modes, the problem
//! $$ \bigl[\tilde M_6p^2 + (\tilde C_6 - q_\infty Q_1)p + K_6\bigr]x = 0 $$
//! falls into the two models of the textbooks for a symmetric aircraft: four
//! states $u, w, q, \theta$ and four states $v, p, r, \varphi$ (Etkin & Reid,
//! *Dynamics of Flight*, eqs. 4.9,18 and 4.9,19), with the same gravity, drag
//! and thrust as the elastic aircraft. Elastic modes and the memory of the
//! wake are what it lacks.

use faer::{Mat, c64};

use crate::eigenpair::inverse_iteration;
use crate::flight_modes::{FlightMode, FlyingBody, Motion, Named, names};
use crate::linalg::NoConvergence;
use crate::p2::{Cell, PiecewiseQuadratic, ZERO_ROOT, cell_eigenvalues};
use crate::rigid::RigidModes;
use crate::structure::{Hysteresis, OperatingPoint, Reduced};

/// Motions of the rigid aircraft at one flight condition, fastest first.
pub(crate) fn rigid_aircraft(
    flying: &FlyingBody,
    fit: &PiecewiseQuadratic,
    reduced: &Reduced,
    point: &OperatingPoint,
    semichord: f64,
) -> Result<Vec<FlightMode>, NoConvergence> {
    let rigid = flying.modes.numbers();
    let home = fit.cell_at(c64::new(0.0, 0.0));
    let loads = reduced.loads(&home.coefficients[1]);
    let small = reduced.restricted(&rigid);
    let zero = Mat::zeros(rigid.len(), rigid.len());
    let slope = Mat::from_fn(rigid.len(), rigid.len(), |i, j| {
        c64::new(loads[(rigid[i], rigid[j])].re / reduced.pressure, 0.0)
    });
    let cell = Cell {
        g: [-1.0, 1.0],
        k: [-1.0, 1.0],
        coefficients: [zero.clone(), slope, zero],
        is_mirrored: true,
    };
    let place = |mode: Option<usize>| rigid.iter().position(|number| Some(*number) == mode);
    let flying = FlyingBody {
        modes: RigidModes(flying.modes.0.map(place)),
        ..*flying
    };
    let mut values: Vec<c64> = cell_eigenvalues(&cell, &small)?
        .values
        .into_iter()
        .filter(|p| p.im >= 0.0 && p.norm() > NEARLY_ZERO)
        .collect();
    values.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
    let motions: Vec<Motion> = values
        .into_iter()
        .map(|p| {
            let operator = small.operator(p, &cell.q(p), Hysteresis::LeftOut);
            let pair = inverse_iteration(p, operator);
            Motion::new(&flying, point, semichord, p, &pair.right, 0.0)
        })
        .collect();
    let named = names(&motions);
    let listed = motions.iter().zip(named).map(|(motion, name)| {
        Named {
            motion,
            name,
            branch: String::new(),
            elastic_share: 0.0,
            elastic_mode: None,
        }
        .at(point, semichord)
    });
    Ok(listed.collect())
}

/// A zero root whose vector is no single mode is met to rounding only: heading
/// at an attitude is bank and yaw together.
const NEARLY_ZERO: f64 = 1e3 * ZERO_ROOT;
