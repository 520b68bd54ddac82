//! From the units and axes of a structure's files to SI and mesh axes.
//!
//! A shape φ is a displacement per unit generalised coordinate of the same
//! unit of length, so that its numbers stay; generalised masses and stiffnesses
//! change with the unit of mass.

use crate::result::ModalResult;
use crate::rigid::{Inertia, RigidBody};
use fladder_mesh::Vec3;
use nalgebra::Matrix3;

/// Units of a structure's files; time is in seconds in all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Units {
    /// Metre, kilogram.
    #[default]
    MetreKilogram,
    /// Millimetre, tonne.
    MillimetreTonne,
    /// Inch, pound-force: masses in lbf s²/in.
    InchPoundForce,
    /// Foot, slug.
    FootSlug,
}

/// Pound-force in newton: 0.453 592 37 kg × 9.806 65 m/s², both exact.
const POUND_FORCE: f64 = 0.453_592_37 * 9.806_65;
const INCH: f64 = 0.0254;
const FOOT: f64 = 0.3048;

impl Units {
    /// Name in the case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::MetreKilogram => "m-kg-s",
            Self::MillimetreTonne => "mm-t-s",
            Self::InchPoundForce => "in-lbf-s",
            Self::FootSlug => "ft-slug-s",
        }
    }

    /// The units of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        [
            Self::MetreKilogram,
            Self::MillimetreTonne,
            Self::InchPoundForce,
            Self::FootSlug,
        ]
        .into_iter()
        .find(|units| units.name() == name)
    }

    /// Metres a unit of length.
    pub fn length(self) -> f64 {
        match self {
            Self::MetreKilogram => 1.0,
            Self::MillimetreTonne => 1e-3,
            Self::InchPoundForce => INCH,
            Self::FootSlug => FOOT,
        }
    }

    /// Kilograms a unit of mass.
    pub fn mass(self) -> f64 {
        match self {
            Self::MetreKilogram => 1.0,
            Self::MillimetreTonne => 1e3,
            Self::InchPoundForce => POUND_FORCE / INCH,
            Self::FootSlug => POUND_FORCE / FOOT,
        }
    }
}

/// Directions of the structure's axes in mesh axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes(Matrix3<f64>);

impl Default for Axes {
    fn default() -> Self {
        Self(Matrix3::identity())
    }
}

/// Axis names that are no right-handed set.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AxesError {
    /// A word other than x, y, z with an optional sign.
    #[error("axis {0:?} is none of x, y, z, -x, -y, -z")]
    Name(String),
    /// The three are parallel or form a left-handed set.
    #[error(
        "the axes {0:?} are no right-handed set, so that they would mirror the structure; turn \
         the sign of one"
    )]
    NotRightHanded([String; 3]),
}

impl Axes {
    /// From the case file's `structure.axes`, for example `["-x", "y", "-z"]`:
    /// the structure's first axis points against the mesh's x, and so on.
    ///
    /// # Errors
    /// [`AxesError`] for unknown names and left-handed sets.
    pub fn from_names(names: [&str; 3]) -> Result<Self, AxesError> {
        let mut matrix = Matrix3::<f64>::zeros();
        for (column, name) in names.iter().enumerate() {
            let (sign, letter) = match name.trim().strip_prefix('-') {
                Some(letter) => (-1.0, letter),
                None => (1.0, name.trim().trim_start_matches('+')),
            };
            let row = match letter {
                "x" | "X" => 0,
                "y" | "Y" => 1,
                "z" | "Z" => 2,
                _ => return Err(AxesError::Name((*name).to_owned())),
            };
            matrix[(row, column)] = sign;
        }
        if (matrix.determinant() - 1.0).abs() > 1e-12 {
            return Err(AxesError::NotRightHanded(names.map(str::to_owned)));
        }
        Ok(Self(matrix))
    }

    /// A vector of the structure in mesh axes.
    pub fn turn(&self, vector: &Vec3) -> Vec3 {
        self.0 * vector
    }

    /// Inertia in mesh axes, and the larger of its products xy and yz, which
    /// [`Inertia`] has no place for: zero where y = 0 is the plane of symmetry in
    /// both sets of axes.
    fn inertia(&self, inertia: &Inertia) -> (Inertia, f64) {
        let Inertia { xx, yy, zz, xz } = *inertia;
        let tensor = Matrix3::new(xx, 0.0, -xz, 0.0, yy, 0.0, -xz, 0.0, zz);
        let turned = self.0 * tensor * self.0.transpose();
        let [xx, yy, zz] = [turned[(0, 0)], turned[(1, 1)], turned[(2, 2)]];
        let lost = turned[(0, 1)].abs().max(turned[(1, 2)].abs());
        (
            Inertia {
                xx,
                yy,
                zz,
                xz: -turned[(0, 2)],
            },
            lost,
        )
    }
}

impl ModalResult {
    /// In metres, kilograms and mesh axes; `origin` is the structure's origin
    /// in mesh axes, metres.
    #[must_use]
    pub fn to_si_mesh_axes(mut self, units: Units, axes: &Axes, origin: &Vec3) -> Self {
        let place = |position: &Vec3| origin + axes.turn(position) * units.length();
        for node in &mut self.nodes {
            node.position = place(&node.position);
        }
        for mode in &mut self.modes {
            mode.generalised_mass *= units.mass();
            mode.generalised_stiffness *= units.mass();
            mode.displacement.iter_mut().for_each(|u| *u = axes.turn(u));
            for rotation in mode.rotation.iter_mut().flatten() {
                *rotation = axes.turn(rotation) / units.length();
            }
            let per_mass = units.mass();
            mode.participation = mode.participation.map(|p| axes.turn(&p) * per_mass);
        }
        if let Some(body) = self.stated_mass {
            let factor = units.mass() * units.length().powi(2);
            let (Inertia { xx, yy, zz, xz }, lost) = axes.inertia(&body.inertia);
            if lost > 0.0 {
                self.notes.push(format!(
                    "a product of inertia of {:e} kg m² across the plane y = 0 of the mesh is \
                     dropped",
                    lost * factor
                ));
            }
            let [xx, yy, zz, xz] = [xx, yy, zz, xz].map(|moment| moment * factor);
            self.stated_mass = Some(RigidBody {
                mass: body.mass * units.mass(),
                cg: place(&body.cg),
                inertia: Inertia { xx, yy, zz, xz },
            });
        }
        self
    }
}
