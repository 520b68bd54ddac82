//! What a root and a flutter speed owe to one property of the structure.
//!
//! With the left and right vectors of a root, $y^HT = 0$ and $Tx = 0$,
//! $$ \frac{\partial p}{\partial\theta} = -\frac{y^HT_\theta x}{y^HT_px},\qquad
//!    T_\theta = \tilde M_\theta p^2 + \tilde C_\theta p + K_\theta . $$
//! Along a sweep the same holds for the place $t$. At a crossing
//! $\operatorname{Re}p = 0$ stays, so that
//! $$ \frac{\mathrm dt}{\mathrm d\theta} =
//!    -\frac{\operatorname{Re}p_\theta}{\operatorname{Re}p_t},\qquad
//!    \frac{\mathrm dk}{\mathrm d\theta} =
//!    \operatorname{Im}\Bigl(p_\theta + p_t\frac{\mathrm dt}{\mathrm d\theta}\Bigr). $$
//! The vectors of the basis of modes stay as they are: a point mass or a hinge
//! enters through the modes given.

use faer::{Mat, c64};
use serde::Serialize;

use crate::eigenpair::Eigenpair;
use crate::linalg::{apply, inner};
use crate::structure::Reduced;

/// Derivatives of $M$, $C$ and $K$ with respect to one property.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// What it is, for tables.
    pub name: String,
    /// Unit of the property.
    pub unit: &'static str,
    /// Its present value, where it has one.
    pub value: Option<f64>,
    /// $\partial M/\partial\theta$.
    pub mass: Mat<f64>,
    /// $\partial C/\partial\theta$.
    pub damping: Mat<f64>,
    /// $\partial K/\partial\theta$; complex with hysteretic damping.
    pub stiffness: Mat<c64>,
}

impl Parameter {
    /// A property that changes nothing yet.
    pub fn new(name: impl Into<String>, unit: &'static str, order: usize) -> Self {
        Self {
            name: name.into(),
            unit,
            value: None,
            mass: Mat::zeros(order, order),
            damping: Mat::zeros(order, order),
            stiffness: Mat::zeros(order, order),
        }
    }

    /// A mass at a point whose displacements in all modes are given, one
    /// vector a mode: $M_\theta = \sum_{xyz}\varphi\varphi^T$. Weight and
    /// rotation of the added mass in flight are left out.
    pub fn point_mass(name: impl Into<String>, displacement: &[[f64; 3]]) -> Self {
        let order = displacement.len();
        let mass = Mat::from_fn(order, order, |i, j| {
            let pairs = displacement[i].iter().zip(displacement[j]);
            pairs.map(|(a, b)| a * b).sum()
        });
        Self {
            mass,
            ..Self::new(name, "kg", order)
        }
    }

    /// The stiffness of a hinge whose rotation in every mode is given:
    /// $K_\theta = rr^T$.
    pub fn hinge(name: impl Into<String>, rotation: &[f64]) -> Self {
        let order = rotation.len();
        let stiffness = Mat::from_fn(order, order, |i, j| {
            c64::new(rotation[i] * rotation[j], 0.0)
        });
        Self {
            stiffness,
            ..Self::new(name, "N m/rad", order)
        }
    }
}

/// Derivatives at one crossing with respect to one property.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sensitivity {
    /// Name of the property.
    pub parameter: String,
    /// Its unit; derivatives are per this unit.
    pub unit: &'static str,
    /// Its present value, where it has one.
    pub value: Option<f64>,
    /// Of the speed of the crossing, m/s.
    pub speed: f64,
    /// Of the frequency there, Hz.
    pub frequency_hz: f64,
}

/// $\partial p/\partial\theta$ of a root at fixed speed.
pub(crate) fn root_sensitivity(
    reduced: &Reduced,
    slope: &Mat<c64>,
    pair: &Eigenpair,
    parameter: &Parameter,
) -> c64 {
    let (p, rate) = (pair.p, reduced.rate);
    let order = reduced.order();
    let has_hysteresis = p.im > 0.0;
    let change = Mat::from_fn(order, order, |i, j| {
        let mut stiffness = parameter.stiffness[(i, j)];
        if !has_hysteresis {
            stiffness.im = 0.0;
        }
        p * p * parameter.mass[(i, j)] * (rate * rate)
            + p * parameter.damping[(i, j)] * rate
            + stiffness
    });
    quotient(slope, pair, &change)
}

/// $-y^HT_\theta x/y^HT_px$.
pub(crate) fn quotient(slope: &Mat<c64>, pair: &Eigenpair, change: &Mat<c64>) -> c64 {
    let form = |matrix: &Mat<c64>| inner(&pair.left, &apply(matrix.as_ref(), &pair.right));
    -form(change) / form(slope)
}
