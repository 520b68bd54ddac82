//! Rigid-body and control derivatives from $Q$ at $p\to0$.
//!
//! A rigid mode in frame `body` has the boundary condition of $\mathbf q=s\mathbf u$
//! alone: its column of $Q$ is $p$ times the load of a steady velocity or rate of turn,
//! counted in axes that turn with the surface, and $Q(0)=0$ exactly. With unit modes about
//! the moment point (metres, radians)
//!
//! $$ D_{ij}=\lim_{p\to0}\frac{Q_{ij}(p)}{p},\qquad
//!    \frac{f_i}{q_\infty}=F_{0,i}+b\sum_jD_{ij}\frac{\dot\xi_j}{U}
//!    +\sum_cQ_{ic}(0)\,\delta_c , $$
//!
//! because $p\,\xi=(b/U)\dot\xi$. The quotient loses no digits as $p$ falls, and its
//! distance from the limit goes as $p\ln p$, the first effect of the wake's memory: on a wing, 4e-9 of the largest entry. Rates
//! of change of incidence are not in it. Modes about another point, and of other scale,
//! are combined to those about the moment point: $D=A^TD'A$.
//!
//! *Axes*, those of AVL with its default signs. Body: X forward, Y starboard, Z down, a
//! half turn about Y from the mesh axes; u, v, w and p, q, r are velocity and rate about
//! them over $V$, with $pB/2V$, $qC/2V$, $rB/2V$. Stability: turned by α about Y,
//! $C_L=C_X\sin\alpha-C_Z\cos\alpha$, $C_D=-C_X\cos\alpha-C_Z\sin\alpha$; derivatives with
//! respect to α include the turning of these axes, and all are at constant speed.

use super::aircraft::Aircraft;
use super::own_forces::StoredForces;
use crate::case::{CaseFile, Reference};
use faer::{Mat, c64};
use fladder_bem::{LaplaceError, SteadyState};
use fladder_mesh::{SurfaceMode, Vec3};
use fladder_modal::RigidBody;
use fladder_stability::RIGID_NAMES;

/// Where the limit is taken: $p\ln p$ is 2e-7 there.
const SMALL_P: f64 = 1e-8;
/// From mesh axes to body axes, forces and moments, velocities and rates alike.
const TO_BODY: [f64; 6] = [-1.0, 1.0, -1.0, -1.0, 1.0, -1.0];

/// Rows of the table in body axes.
pub(crate) const BODY_ROWS: [&str; 6] = ["CX", "CY", "CZ", "Cl", "Cm", "Cn"];
/// Its columns before those of controls.
pub(crate) const BODY_COLUMNS: [&str; 6] = ["u", "v", "w", "p", "q", "r"];
/// Rows of the table in stability axes.
pub(crate) const STABILITY_ROWS: [&str; 6] = ["CL", "CY", "CD", "Cl", "Cm", "Cn"];
/// Its columns before those of controls.
pub(crate) const STABILITY_COLUMNS: [&str; 5] = ["a", "b", "p", "q", "r"];

/// Lengths that make coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scales {
    pub(crate) area: f64,
    pub(crate) span: f64,
    pub(crate) chord: f64,
}

impl Scales {
    /// Those of `[reference]`, when all three are given.
    pub(crate) fn of(reference: &Reference) -> Option<Self> {
        Some(Self {
            area: reference.area?,
            span: reference.span?,
            chord: reference.chord?,
        })
    }

    /// What loads per $q_\infty$ are divided by.
    fn rows(self) -> [f64; 6] {
        let Self { area, span, chord } = self;
        [area, area, area, area * span, area * chord, area * span]
    }
}

/// Six coefficients a row; undefined ones are NaN.
pub(crate) type Row = [f64; 6];

/// Coefficients and derivatives about the moment point.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Derivatives {
    /// $C_X$ … $C_n$ of the steady flow in body axes.
    pub(crate) steady_body: Row,
    /// $C_L$, $C_Y$, $C_D$, $C_l$, $C_m$, $C_n$ in stability axes.
    pub(crate) steady_stability: Row,
    /// $C_L$ from the jump far downstream.
    pub(crate) lift_by_wake: f64,
    /// Induced drag coefficient in the Trefftz plane.
    pub(crate) induced_drag: Option<f64>,
    /// One row of coefficients for each of [`BODY_COLUMNS`], then for each control, per rad.
    pub(crate) body: Vec<Row>,
    /// The same for [`STABILITY_COLUMNS`] and the controls.
    pub(crate) stability: Vec<Row>,
    /// Modes that are controls, in the order of d1, d2, …
    pub(crate) controls: Vec<String>,
    /// x of the neutral point, m.
    pub(crate) neutral_point: f64,
}

impl Derivatives {
    /// Of a case that gives area, span and chord; none where it does not.
    ///
    /// # Errors
    /// [`LaplaceError`] where $Q$ has no value.
    pub(crate) fn of(
        file: &CaseFile,
        aircraft: &Aircraft,
        forces: &StoredForces,
    ) -> Result<Option<Self>, LaplaceError> {
        let reference = &file.case.reference;
        let Some(scales) = Scales::of(reference) else {
            return Ok(None);
        };
        let transfer = &forces.solution.transfer;
        let about = Vec3::from(reference.moment_point);
        let columns =
            RigidColumns::of(&aircraft.modes, aircraft.structure.body.as_ref(), about);
        let near = transfer.q(c64::new(SMALL_P, 0.0))?;
        let rest = transfer.q(c64::new(0.0, 0.0))?;
        let controls: Vec<usize> = control_modes(file, aircraft);
        let loads = Loads {
            steady: body_loads(&forces.solution.steady),
            rigid: columns.rigid(&near, transfer.semichord() / SMALL_P),
            controls: controls
                .iter()
                .map(|&j| columns.control(&rest, j))
                .collect(),
        };
        let mut made = loads.coefficients(scales, forces.alpha_deg, forces.beta_deg);
        made.lift_by_wake = forces.solution.steady.lift_by_wake_jump / scales.area;
        made.induced_drag = forces.solution.steady.induced_drag.map(|d| d / scales.area);
        made.controls = controls
            .iter()
            .map(|&j| aircraft.modes[j].name.clone())
            .collect();
        made.neutral_point += reference.moment_point[0];
        Ok(Some(made))
    }
}

/// Analytic modes that move named groups of the surface.
fn control_modes(file: &CaseFile, aircraft: &Aircraft) -> Vec<usize> {
    let formulae = file.case.modes.formulae();
    let is_control = |name: &str| {
        let mode = formulae
            .iter()
            .map(|formula| &formula.1)
            .find(|mode| mode.name == name);
        mode.is_some_and(|mode| mode.group.is_some())
    };
    (0..aircraft.modes.len())
        .filter(|&j| is_control(&aircraft.modes[j].name))
        .collect()
}

/// Steady loads in body axes, per $q_\infty$.
fn body_loads(steady: &SteadyState) -> Row {
    let ([x, y, z], [l, m, n]) = (steady.loads.force, steady.loads.moment);
    let loads = [x, y, z, l, m, n];
    std::array::from_fn(|i| TO_BODY[i] * loads[i])
}

/// Which columns of $Q$ are rigid, and how unit modes about the moment point are made of
/// them.
struct RigidColumns {
    /// Column of each rigid mode, where there is one.
    index: [Option<usize>; 6],
    /// Unit modes about the moment point in terms of the columns' modes.
    combination: [Row; 6],
}

impl RigidColumns {
    fn of(modes: &[SurfaceMode], body: Option<&RigidBody>, moment_point: Vec3) -> Self {
        let place = |name: &str| modes.iter().position(|mode| mode.name == name);
        let (centre, scale) = match body {
            Some(body) => {
                let (mass, moments) = (body.mass.sqrt(), body.inertia);
                let [xx, yy, zz] = [moments.xx, moments.yy, moments.zz].map(f64::sqrt);
                (body.cg, [mass, mass, mass, xx, yy, zz])
            }
            None => (moment_point, [1.0; 6]),
        };
        let arm = centre - moment_point;
        let mut combination = [[0.0; 6]; 6];
        for axis in 0..3 {
            combination[axis][axis] = scale[axis];
            combination[3 + axis][3 + axis] = scale[3 + axis];
            let mut turn = Vec3::zeros();
            turn[axis] = 1.0;
            // t + ω × (r − r_m) = t + ω × (r_c − r_m) + ω × (r − r_c)
            let shift = turn.cross(&arm);
            for row in 0..3 {
                combination[row][3 + axis] = scale[row] * shift[row];
            }
        }
        Self {
            index: RIGID_NAMES.map(place),
            combination,
        }
    }

    /// $A^TQA$ times `factor` in body axes: one row of loads for each of u, v, w, p, q, r.
    fn rigid(&self, q: &Mat<c64>, factor: f64) -> [Row; 6] {
        let entry = |i: usize, j: usize| match (self.index[i], self.index[j]) {
            (Some(i), Some(j)) => factor * q[(i, j)].re,
            _ => f64::NAN,
        };
        std::array::from_fn(|j| {
            let forces: Row = std::array::from_fn(|k| {
                sparse((0..6).map(|m| (self.combination[m][j], entry(k, m))))
            });
            let loads = self.loads(forces);
            std::array::from_fn(|i| TO_BODY[j] * loads[i])
        })
    }

    /// Loads of one column in body axes, per radian.
    fn control(&self, q: &Mat<c64>, column: usize) -> Row {
        let force = |i: Option<usize>| i.map_or(f64::NAN, |i| q[(i, column)].re);
        self.loads(self.index.map(force))
    }

    /// From generalised forces of the columns' modes to loads in body axes.
    fn loads(&self, forces: Row) -> Row {
        std::array::from_fn(|i| {
            TO_BODY[i] * sparse((0..6).map(|k| (self.combination[k][i], forces[k])))
        })
    }
}

/// Σ a b in which a zero factor meets nothing, be the other undefined.
fn sparse(products: impl Iterator<Item = (f64, f64)>) -> f64 {
    products
        .filter(|(a, _)| *a != 0.0)
        .map(|(a, b)| a * b)
        .sum()
}

/// Loads per $q_\infty$ in body axes about the moment point, m² and m³.
struct Loads {
    steady: Row,
    /// Per velocity and rate over the speed of flight.
    rigid: [Row; 6],
    controls: Vec<Row>,
}

impl Loads {
    /// The neutral point is left relative to the moment point.
    fn coefficients(&self, scales: Scales, alpha_deg: f64, beta_deg: f64) -> Derivatives {
        let (sa, ca) = alpha_deg.to_radians().sin_cos();
        let (sb, cb) = beta_deg.to_radians().sin_cos();
        let rows = scales.rows();
        let divided = |loads: &Row| -> Row { std::array::from_fn(|i| loads[i] / rows[i]) };
        let stability = |c: &Row| turned(c, sa, ca);
        let rates = [2.0 / scales.span, 2.0 / scales.chord, 2.0 / scales.span];
        let rigid: [Row; 6] = std::array::from_fn(|j| {
            let reduced = if j < 3 { 1.0 } else { rates[j - 3] };
            divided(&self.rigid[j]).map(|c| reduced * c)
        });
        let controls: Vec<Row> = self.controls.iter().map(divided).collect();
        let along = |weights: [f64; 6]| -> Row {
            std::array::from_fn(|i| sparse((0..6).map(|j| (weights[j], rigid[j][i]))))
        };
        let steady = divided(&self.steady);
        let mut alpha = stability(&along([-sa * cb, 0.0, ca * cb, 0.0, 0.0, 0.0]));
        let turning = turned(&steady, ca, -sa);
        // Side force and pitching moment keep their axis.
        for i in [0, 2, 3, 5] {
            alpha[i] += turning[i];
        }
        let mut columns = vec![
            alpha,
            stability(&along([-ca * sb, cb, -sa * sb, 0.0, 0.0, 0.0])),
            // Roll and yaw about stability axes, both reduced by the span.
            stability(&along([0.0, 0.0, 0.0, ca, 0.0, sa])),
            stability(&along([0.0, 0.0, 0.0, 0.0, 1.0, 0.0])),
            stability(&along([0.0, 0.0, 0.0, -sa, 0.0, ca])),
        ];
        let neutral_point = -scales.chord * alpha[4] / alpha[0];
        columns.extend(controls.iter().map(stability));
        let mut body = rigid.to_vec();
        body.extend(controls);
        Derivatives {
            steady_stability: stability(&steady),
            steady_body: steady,
            lift_by_wake: f64::NAN,
            induced_drag: None,
            body,
            stability: columns,
            controls: Vec::new(),
            neutral_point,
        }
    }
}

/// Body-axis coefficients in stability axes, turned by the angle of this sine and cosine;
/// with (cos, −sin) for (sin, cos) the derivative of it.
fn turned(body: &Row, sine: f64, cosine: f64) -> Row {
    let [x, y, z, l, m, n] = *body;
    [
        sparse([(sine, x), (-cosine, z)].into_iter()),
        y,
        sparse([(-cosine, x), (-sine, z)].into_iter()),
        sparse([(cosine, l), (sine, n)].into_iter()),
        m,
        sparse([(cosine, n), (-sine, l)].into_iter()),
    ]
}

#[cfg(test)]
mod tests;
