//! Gravity, drag, thrust and speed derivatives of a trimmed aircraft.
//!
//! In flight-path directions $d = (\cos\alpha, 0, \sin\alpha)$ along the wind
//! and $n = (-\sin\alpha, 0, \cos\alpha)$ along the lift, with
//! $L = mg\cos\gamma$, $D_0 = q_\infty S_0$, $D_i = \kappa L^2/q_\infty$,
//! $D = D_0 + D_i$ (damping on the left-hand side, per unit mass):
//!
//! $$ C_{dd} = \frac{2D + T}{mU},\quad C_{nd} = \frac{2L}{mU},\quad
//!    C_{id} = \frac{2f_{i0}}{\sqrt m\,U},\quad
//!    C_{dn} = -\frac{L - D_\alpha}{mU},\quad
//!    D_\alpha = \frac{2\kappa L L_\alpha}{q_\infty} $$
//!
//! $T$ enters for thrust of constant power only. Without the speed derivative
//! drag is differentiated at constant lift, so that $C_{dd}$ becomes
//! $(2D_0 - 2D_i + T)/(mU)$, and $C_{nd}$ and $C_{id}$ go. Eller,
//! IFASD-2009-119, eqs. (23)–(25); printed (25) has the opposite sign. The
//! last term tilts the lift with the incidence that a vertical speed makes.

use crate::rigid::{RigidBody, RigidModes};
use crate::structure::OperatingPoint;
use faer::Mat;

/// How thrust answers to speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Thrust {
    /// $T \propto 1/U$: a propeller.
    #[default]
    ConstantPower,
    /// $T$ does not depend on speed: a jet.
    ConstantThrust,
    /// No thrust: a glider.
    None,
}

/// Trimmed flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// Acceleration of gravity in m/s².
    pub gravity: f64,
    /// Climb angle γ in radians.
    pub climb: f64,
    /// $S_0 = D_0/q_\infty$ in m².
    pub parasite_drag_area: f64,
    /// $\kappa = D_iq_\infty/L^2$ in 1/m².
    pub induced_drag_factor: f64,
    /// Thrust model.
    pub thrust: Thrust,
    /// Whether trim loads change with speed.
    pub speed_derivative: bool,
}

/// Trim loads at one flight condition, in N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrimLoads {
    /// $L = mg\cos\gamma$.
    pub lift: f64,
    /// $D_0$.
    pub parasite_drag: f64,
    /// $D_i$.
    pub induced_drag: f64,
    /// $T = D + mg\sin\gamma$; zero for a glider.
    pub thrust: f64,
}

impl Flight {
    /// Lift, drag and thrust that balance the weight.
    pub fn trim(&self, body: &RigidBody, point: &OperatingPoint) -> TrimLoads {
        let weight = body.mass * self.gravity;
        let pressure = point.dynamic_pressure();
        let lift = weight * self.climb.cos();
        let parasite_drag = pressure * self.parasite_drag_area;
        let induced_drag = self.induced_drag_factor * lift * lift / pressure;
        let thrust = match self.thrust {
            Thrust::None => 0.0,
            _ => parasite_drag + induced_drag + weight * self.climb.sin(),
        };
        TrimLoads {
            lift,
            parasite_drag,
            induced_drag,
            thrust,
        }
    }

    /// Damping terms in the directions $d$ and $n$, mass-normalised.
    ///
    /// `lift_slope` is $L_\alpha$ in N per radian.
    fn path_damping(
        &self,
        body: &RigidBody,
        point: &OperatingPoint,
        lift_slope: f64,
    ) -> PathDamping {
        let trim = self.trim(body, point);
        let momentum = body.mass * point.airspeed;
        let power = match self.thrust {
            Thrust::ConstantPower => trim.thrust,
            Thrust::ConstantThrust | Thrust::None => 0.0,
        };
        let induced_change = if self.speed_derivative { 2.0 } else { -2.0 };
        let drag = 2.0 * trim.parasite_drag + induced_change * trim.induced_drag + power;
        let lift = if self.speed_derivative {
            2.0 * trim.lift
        } else {
            0.0
        };
        let drag_slope =
            2.0 * self.induced_drag_factor * trim.lift * lift_slope / point.dynamic_pressure();
        PathDamping {
            along_along: drag / momentum,
            normal_along: lift / momentum,
            along_normal: -(trim.lift - drag_slope) / momentum,
        }
    }

    /// Adds the speed-derivative, thrust, drag and lift-tilt terms to $C$.
    ///
    /// With $\alpha = -pz/b$ the slope of the lift is
    /// $L_\alpha = -q_\infty\,mb\,\mathrm dQ_{zz}/\mathrm dp$ at $p = 0$, for
    /// $Q_{zz}$ of the mass-normalised mode.
    pub(crate) fn add_damping(
        &self,
        body: &RigidBody,
        modes: &RigidModes,
        loads: &TrimAerodynamics<'_>,
        point: &OperatingPoint,
        damping: &mut Mat<f64>,
    ) {
        let lift_slope =
            -point.dynamic_pressure() * body.mass * loads.semichord * loads.heave_slope;
        let path = self.path_damping(body, point, lift_slope);
        let (sin, cos) = point.alpha.sin_cos();
        let along = [(modes.0[0], cos), (modes.0[2], sin)];
        let normal = [(modes.0[0], -sin), (modes.0[2], cos)];
        add_outer(damping, &along, &along, path.along_along);
        add_outer(damping, &normal, &along, path.normal_along);
        add_outer(damping, &along, &normal, path.along_normal);
        if !self.speed_derivative {
            return;
        }
        let per_force = 2.0 / (body.mass.sqrt() * point.airspeed);
        for &(mode, force) in loads.elastic {
            let force = force * point.dynamic_pressure() * per_force;
            add_outer(damping, &[(Some(mode), 1.0)], &along, force);
        }
    }
}

/// What the aerodynamics tell of the trimmed state.
pub(crate) struct TrimAerodynamics<'a> {
    /// $b$ in m.
    pub(crate) semichord: f64,
    /// $\mathrm dQ_{zz}/\mathrm dp$ at $p = 0$, mass-normalised.
    pub(crate) heave_slope: f64,
    /// Steady force per unit dynamic pressure on each elastic mode that has
    /// one.
    pub(crate) elastic: &'a [(usize, f64)],
}

struct PathDamping {
    along_along: f64,
    normal_along: f64,
    along_normal: f64,
}

/// Adds `factor` times the outer product of two sparse vectors.
fn add_outer(
    matrix: &mut Mat<f64>,
    rows: &[(Option<usize>, f64)],
    columns: &[(Option<usize>, f64)],
    factor: f64,
) {
    for &(row, row_weight) in rows {
        for &(column, column_weight) in columns {
            if let (Some(row), Some(column)) = (row, column) {
                matrix[(row, column)] += factor * row_weight * column_weight;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Damping of speed vanishes where $3D_0 = D_i$, the speed of least
    /// power, for thrust of constant power without the speed derivative.
    #[test]
    fn speed_damping_vanishes_at_minimum_power() {
        let body = RigidBody {
            mass: 20.0,
            ixx: 1.0,
            iyy: 1.0,
            izz: 1.0,
            ixz: 0.0,
        };
        let flight = Flight {
            gravity: 9.81,
            climb: 0.0,
            parasite_drag_area: 0.02,
            induced_drag_factor: 0.05,
            thrust: Thrust::ConstantPower,
            speed_derivative: false,
        };
        let weight: f64 = 20.0 * 9.81;
        let pressure = (0.05 * weight * weight / (3.0 * 0.02)).sqrt();
        let point = OperatingPoint::new((2.0 * pressure / 1.225).sqrt(), 1.225);
        let path = flight.path_damping(&body, &point, 0.0);
        assert!(path.along_along.abs() < 1e-14, "{}", path.along_along);
        let trim = flight.trim(&body, &point);
        assert!((trim.induced_drag / trim.parasite_drag - 3.0).abs() < 1e-12);
    }
}
