//! Displacement fields in closed form: translation, rotation, polynomial.

use fladder_mesh::{Frame, SurfaceMode, Symmetry, Vec3};
use serde::{Deserialize, Serialize};

/// A component of a displacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Component {
    /// Aft.
    X,
    /// To starboard.
    Y,
    /// Up.
    Z,
}

/// `coefficient · x^i |y|^j z^l` in one component, metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PolynomialTerm {
    /// Component that is displaced.
    pub component: Component,
    /// Factor.
    pub coefficient: f64,
    /// Powers i, j, l of x, |y| and z.
    pub powers: [u32; 3],
    /// Multiplies by sign(y), which is 0 at y = 0.
    #[serde(default)]
    pub odd_y: bool,
}

/// How the points of the surface move.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// The same displacement everywhere, metres.
    Translation(Vec3),
    /// Right-handed rotation by 1 rad; the axis need not be a unit vector.
    Rotation {
        /// Direction of the axis.
        axis: Vec3,
        /// A point on the axis, metres.
        point: Vec3,
    },
    /// Sum of polynomial terms.
    Polynomial(Vec<PolynomialTerm>),
}

/// A mode given by a formula.
#[derive(Clone, Debug, PartialEq)]
pub struct AnalyticMode {
    /// Name in results.
    pub name: String,
    /// The formula.
    pub motion: Motion,
}

/// A formula that gives no displacement field.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AnalyticError {
    /// A rotation about nothing.
    #[error("mode {name}: the rotation axis has length {length:e}")]
    NoAxis {
        /// Name of the mode.
        name: String,
        /// Length of the axis given.
        length: f64,
    },
    /// A field that moves no point of the surface, or moves one beyond bounds.
    #[error("mode {name}: the largest displacement on the surface is {largest:e} m")]
    Size {
        /// Name of the mode.
        name: String,
        /// Largest displacement found.
        largest: f64,
    },
}

impl AnalyticMode {
    /// Evaluates the formula at the points; frame [`Frame::Inertial`].
    ///
    /// # Errors
    /// [`AnalyticError`] for an axis of no length and for a field that is zero
    /// or not finite on all of the surface.
    pub fn on(&self, points: &[Vec3]) -> Result<SurfaceMode, AnalyticError> {
        let displacement: Vec<Vec3> = match &self.motion {
            Motion::Translation(vector) => vec![*vector; points.len()],
            Motion::Rotation { axis, point } => {
                let unit = self.unit(*axis)?;
                points.iter().map(|p| unit.cross(&(p - point))).collect()
            }
            Motion::Polynomial(terms) => points.iter().map(|p| polynomial(terms, p)).collect(),
        };
        let largest = displacement.iter().map(Vec3::norm).fold(0.0, f64::max);
        let finite = displacement
            .iter()
            .all(|u| u.iter().all(|value| value.is_finite()));
        if !finite || (largest == 0.0 && !points.is_empty()) {
            let largest = if finite { largest } else { f64::INFINITY };
            return Err(AnalyticError::Size {
                name: self.name.clone(),
                largest,
            });
        }
        Ok(SurfaceMode {
            name: self.name.clone(),
            frame: Frame::Inertial,
            displacement,
        })
    }

    /// The kind of motion about y = 0 that the formula is, told from its
    /// coefficients; `None` where it is a mixture.
    ///
    /// A rotation is symmetric about an axis along y, antisymmetric about an
    /// axis in the plane. A polynomial term is even in y, or odd with `odd_y`.
    pub fn symmetry(&self) -> Symmetry {
        let [even, odd] = match &self.motion {
            Motion::Translation(v) => [v.x.hypot(v.z), v.y.abs()],
            Motion::Rotation { axis, point } => {
                let across = axis.x.hypot(axis.z);
                [axis.y.abs() + across * point.y.abs(), across]
            }
            Motion::Polynomial(terms) => parts(terms),
        };
        let whole = even.hypot(odd);
        if odd <= KIND_TOLERANCE * whole {
            Symmetry::Symmetric
        } else if even <= KIND_TOLERANCE * whole {
            Symmetry::Antisymmetric
        } else {
            Symmetry::None
        }
    }

    fn unit(&self, axis: Vec3) -> Result<Vec3, AnalyticError> {
        let length = axis.norm();
        if length > 0.0 && length.is_finite() {
            return Ok(axis / length);
        }
        Err(AnalyticError::NoAxis {
            name: self.name.clone(),
            length,
        })
    }
}

/// Rounding of coefficients that were meant to be zero.
const KIND_TOLERANCE: f64 = 1e-9;

/// Sizes of the symmetric and the antisymmetric terms: symmetric motion has
/// u_x and u_z even in y, and u_y odd.
fn parts(terms: &[PolynomialTerm]) -> [f64; 2] {
    let mut sizes = [0.0; 2];
    for term in terms {
        let is_across = term.component == Component::Y;
        sizes[usize::from(is_across != term.odd_y)] += term.coefficient.abs();
    }
    sizes
}

fn polynomial(terms: &[PolynomialTerm], point: &Vec3) -> Vec3 {
    let mut sum = Vec3::zeros();
    for term in terms {
        let [i, j, l] = term
            .powers
            .map(|power| i32::try_from(power).unwrap_or(i32::MAX));
        let side = if term.odd_y { sign(point.y) } else { 1.0 };
        let value =
            term.coefficient * side * point.x.powi(i) * point.y.abs().powi(j) * point.z.powi(l);
        sum[term.component as usize] += value;
    }
    sum
}

fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}
