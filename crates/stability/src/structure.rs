//! The eigenvalue problem of one flight condition.
//!
//! $$ T(p)\,x = \bigl[\tilde M p^2 + \tilde C p + K - q_\infty Q(p)\bigr]x = 0,
//!    \qquad \tilde M = M (U/b)^2,\quad \tilde C = C\,U/b $$
//!
//! with $p = sb/U$. Eller, IFASD-2009-119, eq. (1), written in $p$. Hysteretic
//! damping multiplies the stiffness of mode $i$ by $1 + \mathrm ig_{s,i}$, which
//! holds for $\operatorname{Im}p>0$ only: it breaks the conjugate symmetry and
//! would make real roots complex.

use std::ops::Range;

use faer::traits::ComplexField;
use faer::{Mat, c64};

use crate::eigenpair::Eigenpair;
use crate::flight_modes::FlyingBody;
use crate::lane_lu::{LaneMatrices, WIDTH};
use crate::pencil::Place;

/// Air and speed at one point of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OperatingPoint {
    /// True airspeed $U$ in m/s.
    pub airspeed: f64,
    /// Air density in kg/m³.
    pub density: f64,
    /// Incidence of the structural x axis in radians.
    pub alpha: f64,
    /// Sideslip in radians.
    pub beta: f64,
    /// Mach number, where the sweep has one.
    pub mach: Option<f64>,
    /// Geopotential altitude in m, where the sweep has one.
    pub altitude: Option<f64>,
}

impl OperatingPoint {
    /// A point at zero incidence, with no altitude and no Mach number.
    pub fn new(airspeed: f64, density: f64) -> Self {
        Self {
            airspeed,
            density,
            alpha: 0.0,
            beta: 0.0,
            mach: None,
            altitude: None,
        }
    }

    /// $q_\infty = \rho U^2/2$ in Pa.
    pub fn dynamic_pressure(&self) -> f64 {
        0.5 * self.density * self.airspeed * self.airspeed
    }

    /// Point between two others, every number linear in `fraction`.
    #[must_use]
    pub fn between(&self, other: &Self, fraction: f64) -> Self {
        let blend = |from: f64, to: f64| from + fraction * (to - from);
        let optional = |from: Option<f64>, to: Option<f64>| Some(blend(from?, to?));
        Self {
            airspeed: blend(self.airspeed, other.airspeed),
            density: blend(self.density, other.density),
            alpha: blend(self.alpha, other.alpha),
            beta: blend(self.beta, other.beta),
            mach: optional(self.mach, other.mach),
            altitude: optional(self.altitude, other.altitude),
        }
    }
}

/// The points of a sweep and the way between them.
///
/// Crossings lie between points; they are found by solving there, so a
/// schedule answers for any real parameter in `0 ..= count - 1`.
pub trait Schedule: Sync {
    /// Number of points.
    fn count(&self) -> usize;
    /// Flight condition at `parameter`; whole numbers are the points.
    fn at(&self, parameter: f64) -> OperatingPoint;
}

/// Points in order, joined by straight lines.
impl Schedule for [OperatingPoint] {
    fn count(&self) -> usize {
        self.len()
    }

    fn at(&self, parameter: f64) -> OperatingPoint {
        let last = self.len() - 1;
        let start = (parameter.max(0.0).floor() as usize).min(last);
        let end = (start + 1).min(last);
        let fraction = parameter - start as f64;
        if fraction == 0.0 {
            self[start]
        } else {
            self[start].between(&self[end], fraction)
        }
    }
}

impl Schedule for Vec<OperatingPoint> {
    fn count(&self) -> usize {
        self.len()
    }

    fn at(&self, parameter: f64) -> OperatingPoint {
        self.as_slice().at(parameter)
    }
}

/// Structural side of the problem at one flight condition.
#[derive(Clone, Debug)]
pub struct StructuralMatrices {
    /// $M$, symmetric and positive.
    pub mass: Mat<f64>,
    /// $C$, with the rotation-rate and speed-derivative terms where there are
    /// rigid modes.
    pub damping: Mat<f64>,
    /// $K$, with gravity where it acts.
    pub stiffness: Mat<f64>,
    /// $g_s$ of every mode for the hysteretic model; `None` without it.
    pub hysteretic: Option<Vec<f64>>,
    /// Present when the row and column of `rigid:x` in $Q$ give way to the
    /// quasi-steady terms.
    pub flight_path: Option<FlightPath>,
}

/// What a sweep needs to know of a structure.
pub trait Structure: Sync {
    /// Names of the modes, in order.
    fn modes(&self) -> &[String];
    /// Numbers of the rigid modes.
    fn rigid_modes(&self) -> Vec<usize>;
    /// The rigid body that flies, where motions are to have the names of
    /// flight mechanics.
    fn flying_body(&self) -> Option<FlyingBody> {
        None
    }
    /// Matrices at a flight condition.
    fn at(&self, point: &OperatingPoint) -> StructuralMatrices;
}

/// Replaces the row and column of `rigid:x` in $Q$.
///
/// Unsteady loads are taken normal to the flight path, and a motion along it
/// makes none: at incidence α the entries of `rigid:x` become −tan α times
/// those of `rigid:z`, zero at α = 0. What acts along the path comes from the
/// quasi-steady terms instead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightPath {
    /// Number of the mode `rigid:x`.
    pub x: usize,
    /// Number of the mode `rigid:z`, where there is one.
    pub z: Option<usize>,
    /// Tangent of the incidence.
    pub tan_alpha: f64,
}

impl FlightPath {
    pub(crate) fn apply<T>(&self, q: &mut Mat<T>)
    where
        T: ComplexField + std::ops::Mul<f64, Output = T> + Copy,
    {
        for row in 0..q.nrows() {
            let across = self.z.map_or_else(T::zero_impl, |z| q[(row, z)]);
            q[(row, self.x)] = across * -self.tan_alpha;
        }
        for column in 0..q.ncols() {
            let across = self.z.map_or_else(T::zero_impl, |z| q[(z, column)]);
            q[(self.x, column)] = across * -self.tan_alpha;
        }
    }
}

/// Whether hysteretic damping takes part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Hysteresis {
    /// For oscillations: $K_{ii}(1+\mathrm ig_{s,i})$.
    Included,
    /// For real roots and the cell around $k = 0$.
    LeftOut,
}

/// The matrices of $T(p)$ without the aerodynamics.
#[derive(Clone, Debug)]
pub(crate) struct Reduced {
    /// $\tilde M$.
    pub(crate) mass: Mat<f64>,
    /// $\tilde C$.
    pub(crate) damping: Mat<f64>,
    /// $K$ without hysteretic damping.
    pub(crate) stiffness: Mat<f64>,
    hysteretic: Option<Vec<f64>>,
    flight_path: Option<FlightPath>,
    /// Weights of the parts of a wide $Q$; `None` where it has one.
    weights: Option<Vec<f64>>,
    /// $q_\infty$.
    pub(crate) pressure: f64,
    /// $U/b$, which turns $p$ into $s$.
    pub(crate) rate: f64,
}

impl Reduced {
    pub(crate) fn new(
        structure: &dyn Structure,
        point: &OperatingPoint,
        semichord: f64,
    ) -> Self {
        let matrices = structure.at(point);
        let rate = point.airspeed / semichord;
        let scaled = |matrix: &Mat<f64>, factor: f64| {
            Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
                matrix[(i, j)] * factor
            })
        };
        Self {
            mass: scaled(&matrices.mass, rate * rate),
            damping: scaled(&matrices.damping, rate),
            stiffness: matrices.stiffness,
            hysteretic: matrices.hysteretic,
            flight_path: matrices.flight_path,
            weights: None,
            pressure: point.dynamic_pressure(),
            rate,
        }
    }

    /// With a $Q$ of several parts side by side.
    #[must_use]
    pub(crate) fn mixed(self, weights: Vec<f64>) -> Self {
        Self {
            weights: Some(weights),
            ..self
        }
    }

    pub(crate) fn order(&self) -> usize {
        self.mass.nrows()
    }

    /// The problem of some modes alone, without aerodynamics of its own.
    pub(crate) fn restricted(&self, modes: &[usize]) -> Self {
        let part = |matrix: &Mat<f64>| {
            Mat::from_fn(modes.len(), modes.len(), |i, j| {
                matrix[(modes[i], modes[j])]
            })
        };
        Self {
            mass: part(&self.mass),
            damping: part(&self.damping),
            stiffness: part(&self.stiffness),
            hysteretic: None,
            flight_path: None,
            weights: None,
            ..*self
        }
    }

    /// Sum of the parts of a wide matrix.
    fn mix<T>(&self, wide: &Mat<T>) -> Mat<T>
    where
        T: ComplexField + std::iter::Sum + std::ops::Mul<f64, Output = T> + Copy,
    {
        let order = self.order();
        match &self.weights {
            None => wide.clone(),
            Some(weights) => Mat::from_fn(order, order, |i, j| {
                let parts = weights.iter().enumerate();
                parts.map(|(a, w)| wide[(i, a * order + j)] * *w).sum()
            }),
        }
    }

    /// $q_\infty Q$ as it enters the problem.
    pub(crate) fn loads(&self, q: &Mat<c64>) -> Mat<c64> {
        let mut loads = self.mix(q);
        if let Some(path) = &self.flight_path {
            path.apply(&mut loads);
        }
        Mat::from_fn(loads.nrows(), loads.ncols(), |i, j| {
            loads[(i, j)] * self.pressure
        })
    }

    /// $q_\infty R$ for a real part $R$ of $Q$.
    pub(crate) fn real_loads(&self, part: &Mat<f64>) -> Mat<f64> {
        let mut loads = self.mix(part);
        if let Some(path) = &self.flight_path {
            path.apply(&mut loads);
        }
        Mat::from_fn(loads.nrows(), loads.ncols(), |i, j| {
            loads[(i, j)] * self.pressure
        })
    }

    /// Whether hysteretic damping is in the problem.
    pub(crate) fn is_hysteretic(&self) -> bool {
        self.hysteretic.is_some()
    }

    /// Adds $\mathrm ig_{s,i}K_{ii}$.
    pub(crate) fn add_hysteresis(&self, operator: &mut Mat<c64>) {
        let factors = self.hysteretic.iter().flatten().enumerate();
        for (mode, factor) in factors {
            operator[(mode, mode)].im += factor * self.stiffness[(mode, mode)];
        }
    }

    /// The same in every lane, rows and columns in the order and scale given.
    pub(crate) fn add_hysteresis_to_lanes(&self, lanes: &mut LaneMatrices, places: &[Place]) {
        let Some(factors) = &self.hysteretic else {
            return;
        };
        let order = self.order();
        for (place, Place { mode, scale }) in places.iter().enumerate() {
            let at = place * (order + 1) * WIDTH;
            let added = factors[*mode] * self.stiffness[(*mode, *mode)] * scale * scale;
            lanes.im[at..at + WIDTH]
                .iter_mut()
                .for_each(|value| *value += added);
        }
    }

    /// $K$ with or without hysteretic damping.
    pub(crate) fn stiffness(&self, hysteresis: Hysteresis) -> Mat<c64> {
        let order = self.order();
        let mut stiffness =
            Mat::from_fn(order, order, |i, j| c64::new(self.stiffness[(i, j)], 0.0));
        if let (Some(factors), Hysteresis::Included) = (&self.hysteretic, hysteresis) {
            for (mode, factor) in factors.iter().enumerate() {
                stiffness[(mode, mode)] *= c64::new(1.0, *factor);
            }
        }
        stiffness
    }

    /// Hysteresis that belongs to a root: none on the real axis.
    pub(crate) fn hysteresis_at(p: c64) -> Hysteresis {
        if p.im > 0.0 {
            Hysteresis::Included
        } else {
            Hysteresis::LeftOut
        }
    }

    /// $T(p)$ for given $Q(p)$.
    pub(crate) fn operator(&self, p: c64, q: &Mat<c64>, hysteresis: Hysteresis) -> Mat<c64> {
        let loads = self.loads(q);
        let mut operator = self.stiffness(hysteresis);
        let square = p * p;
        for j in 0..self.order() {
            for i in 0..self.order() {
                operator[(i, j)] +=
                    square * self.mass[(i, j)] + p * self.damping[(i, j)] - loads[(i, j)];
            }
        }
        operator
    }

    /// $T'(p)$ for given $Q'(p)$.
    pub(crate) fn operator_slope(&self, p: c64, q_slope: &Mat<c64>) -> Mat<c64> {
        let loads = self.loads(q_slope);
        Mat::from_fn(self.order(), self.order(), |i, j| {
            p * 2.0 * self.mass[(i, j)] + self.damping[(i, j)] - loads[(i, j)]
        })
    }

    /// $y^H(T_2 - T_1)x$ at a root of this problem, where the other differs in
    /// its matrices and in $q_\infty$ but not in $Q(p)$: with
    /// $q_1Qx = (\tilde M_1p^2 + \tilde C_1p + K_1)x$ it is
    /// $y^H(S_2 - S_1q_2/q_1)x$ of the structural parts.
    pub(crate) fn change_to(&self, other: &Self, pair: &Eigenpair) -> c64 {
        let hysteresis = Self::hysteresis_at(pair.p);
        let form = |reduced: &Self| {
            let stiffness = reduced.stiffness(hysteresis);
            let square = pair.p * pair.p;
            let mut sum = c64::new(0.0, 0.0);
            for (j, x) in pair.right.iter().enumerate() {
                for (i, y) in pair.left.iter().enumerate() {
                    let entry = square * reduced.mass[(i, j)]
                        + pair.p * reduced.damping[(i, j)]
                        + stiffness[(i, j)];
                    sum += y.conj() * entry * x;
                }
            }
            sum
        };
        form(other) - form(self) * (other.pressure / self.pressure)
    }

    /// Share of every mode in the kinetic energy of a motion,
    /// $\operatorname{Re}(\bar x_i (Mx)_i)/x^HMx$.
    pub(crate) fn energy_shares(&self, vector: &[c64]) -> Vec<f64> {
        let order: Range<usize> = 0..self.order();
        let momentum: Vec<c64> = order
            .clone()
            .map(|i| order.clone().map(|j| vector[j] * self.mass[(i, j)]).sum())
            .collect();
        let parts: Vec<f64> = vector
            .iter()
            .zip(&momentum)
            .map(|(x, m)| (x.conj() * m).re)
            .collect();
        let total: f64 = parts.iter().sum();
        parts.into_iter().map(|part| part / total).collect()
    }
}
