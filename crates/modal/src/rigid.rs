//! Six rigid modes from mass properties.
//!
//! About the centre of mass, each divided by the square root of its own mass
//! or moment of inertia:
//!
//! $$ \varphi_x = \frac{\mathbf e_x}{\sqrt m},\; \dots\quad
//!    \varphi_\theta = \frac{\mathbf e_y \times (\mathbf r - \mathbf r_{cg})}{\sqrt{I_{yy}}} $$
//!
//! Axes x aft, y to starboard, z up and right-handed rotations: θ > 0 is nose
//! up, φ > 0 starboard wing up, ψ > 0 nose to port.

use fladder_mesh::{Frame, SurfaceMode, Symmetry, Vec3};
use serde::{Deserialize, Serialize};

/// Moments of inertia about the centre of mass, kg m²; the plane y = 0 is a
/// plane of symmetry of the mass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Inertia {
    /// ∫ (y² + z²) dm.
    pub xx: f64,
    /// ∫ (x² + z²) dm.
    pub yy: f64,
    /// ∫ (x² + y²) dm.
    pub zz: f64,
    /// ∫ x z dm; the entry of the inertia tensor is its negative.
    #[serde(default)]
    pub xz: f64,
}

/// Mass, centre of mass and inertia of the whole aircraft.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigidBody {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in mesh axes, m.
    pub cg: Vec3,
    /// Inertia about the centre of mass.
    pub inertia: Inertia,
}

/// Mass properties no body can have.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RigidBodyError {
    /// A mass or principal moment that is not positive.
    #[error("{name} is {value:e}, and must be positive")]
    NotPositive {
        /// `mass`, `inertia.xx` and so on.
        name: &'static str,
        /// Value found.
        value: f64,
    },
    /// Moments that break the triangle inequality of inertia.
    #[error(
        "inertia.{largest} = {value:e} exceeds the sum {sum:e} of the other two moments, \
         which no mass distribution allows"
    )]
    Triangle {
        /// The largest of the three.
        largest: &'static str,
        /// Its value.
        value: f64,
        /// The sum of the other two.
        sum: f64,
    },
    /// A product of inertia too large for its moments.
    #[error("inertia.xz = {value:e} exceeds √(xx·zz) = {limit:e}")]
    Product {
        /// ∫ x z dm.
        value: f64,
        /// Its bound.
        limit: f64,
    },
    /// A property neither given nor recoverable from the file.
    #[error(
        "rigid modes need {name}: the case does not give it and the result file holds {rigid} \
         rigid modes, where six are needed to recover it"
    )]
    Missing {
        /// `mass`, `cg` or `inertia`.
        name: &'static str,
        /// Rigid modes in the file.
        rigid: usize,
    },
}

/// Rounding of given inertias: a flat body fulfils the triangle inequality
/// with equality, and users give three digits.
const TRIANGLE_SLACK: f64 = 1.0 + 1e-3;

impl RigidBody {
    /// Unit mass and moments at a point: its [`rigid_modes`] are one metre and one radian.
    pub fn unit(cg: Vec3) -> Self {
        Self {
            mass: 1.0,
            cg,
            inertia: Inertia {
                xx: 1.0,
                yy: 1.0,
                zz: 1.0,
                xz: 0.0,
            },
        }
    }

    /// Refuses mass properties no body can have.
    ///
    /// # Errors
    /// [`RigidBodyError`] names the offending value.
    pub fn check(&self) -> Result<(), RigidBodyError> {
        let Inertia { xx, yy, zz, xz } = self.inertia;
        let positive = [
            ("mass", self.mass),
            ("inertia.xx", xx),
            ("inertia.yy", yy),
            ("inertia.zz", zz),
        ];
        for (name, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Err(RigidBodyError::NotPositive { name, value });
            }
        }
        for (largest, value, sum) in [
            ("xx", xx, yy + zz),
            ("yy", yy, xx + zz),
            ("zz", zz, xx + yy),
        ] {
            if value > sum * TRIANGLE_SLACK {
                return Err(RigidBodyError::Triangle {
                    largest,
                    value,
                    sum,
                });
            }
        }
        let limit = (xx * zz).sqrt();
        if xz.abs() >= limit || xz.is_nan() {
            return Err(RigidBodyError::Product { value: xz, limit });
        }
        Ok(())
    }
}

impl RigidBody {
    /// Two halves counted in the place of one, the second moved to its mirror
    /// image: the centre of mass moves to y = 0, and the distance of each half
    /// from there adds to the moments about x and z.
    pub(crate) fn parted(mut self) -> Self {
        let added = self.mass * self.cg.y * self.cg.y;
        self.inertia.xx += added;
        self.inertia.zz += added;
        self.cg.y = 0.0;
        self
    }
}

/// Which kind of motion each rigid mode is, in their order: x, z and θ are
/// symmetric about y = 0.
pub const RIGID_KINDS: [Symmetry; 6] = [
    Symmetry::Symmetric,
    Symmetry::Antisymmetric,
    Symmetry::Symmetric,
    Symmetry::Antisymmetric,
    Symmetry::Symmetric,
    Symmetry::Antisymmetric,
];

/// The six rigid modes at the given points, in the order x, y, z, φ, θ, ψ.
///
/// Frame [`Frame::Body`]; displacements in m per √kg·m or √(kg m²)·rad. `I_xz`
/// does not enter the shapes: it couples φ and ψ in the generalised masses.
pub fn rigid_modes(body: &RigidBody, points: &[Vec3]) -> Vec<SurfaceMode> {
    let translation = |axis: Vec3| points.iter().map(|_| axis / body.mass.sqrt()).collect();
    let rotation = |axis: Vec3, inertia: f64| {
        let scaled = axis / inertia.sqrt();
        points
            .iter()
            .map(|point| scaled.cross(&(point - body.cg)))
            .collect()
    };
    let shapes: [(&str, Vec<Vec3>); 6] = [
        ("rigid:x", translation(Vec3::x())),
        ("rigid:y", translation(Vec3::y())),
        ("rigid:z", translation(Vec3::z())),
        ("rigid:phi", rotation(Vec3::x(), body.inertia.xx)),
        ("rigid:theta", rotation(Vec3::y(), body.inertia.yy)),
        ("rigid:psi", rotation(Vec3::z(), body.inertia.zz)),
    ];
    shapes
        .into_iter()
        .map(|(name, displacement)| SurfaceMode {
            name: name.to_owned(),
            frame: Frame::Body,
            displacement,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body() -> RigidBody {
        RigidBody {
            mass: 4.0,
            cg: Vec3::new(0.5, 0.0, 0.1),
            inertia: Inertia {
                xx: 1.0,
                yy: 4.0,
                zz: 4.5,
                xz: 0.2,
            },
        }
    }

    #[test]
    fn positive_rotations_lift_the_nose_the_starboard_wing_and_turn_the_nose_to_port() {
        let nose = Vec3::new(-0.5, 0.0, 0.1);
        let starboard = Vec3::new(0.5, 1.0, 0.1);
        let modes = rigid_modes(&body(), &[nose, starboard]);
        let names: Vec<_> = modes.iter().map(|mode| mode.name.as_str()).collect();
        let expected = [
            "rigid:x",
            "rigid:y",
            "rigid:z",
            "rigid:phi",
            "rigid:theta",
            "rigid:psi",
        ];
        assert_eq!(names, expected);
        assert!(modes.iter().all(|mode| mode.frame == Frame::Body));
        assert_eq!(modes[4].displacement[0], Vec3::new(0.0, 0.0, 0.5));
        assert_eq!(modes[3].displacement[1], Vec3::new(0.0, 0.0, 1.0));
        assert!(modes[5].displacement[0].y < 0.0);
    }

    #[test]
    fn impossible_bodies_are_refused_by_name() {
        assert_eq!(body().check(), Ok(()));
        let mut wrong = body();
        wrong.inertia.zz = 6.0;
        assert!(matches!(
            wrong.check(),
            Err(RigidBodyError::Triangle { largest: "zz", .. })
        ));
        wrong = body();
        wrong.inertia.xz = 2.2;
        assert!(matches!(wrong.check(), Err(RigidBodyError::Product { .. })));
        wrong.mass = f64::NAN;
        assert!(matches!(
            wrong.check(),
            Err(RigidBodyError::NotPositive { name: "mass", .. })
        ));
    }
}
