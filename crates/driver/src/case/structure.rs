//! Structure: a finite-element result, mass properties, or matrices.

use super::one_or_many::OneOrMany;
use super::structure_edits::{AddedMass, HingeChange, ModeOverride, TransferChoice};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Structure.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Structure {
    /// Finite-element result.
    pub file: Option<PathBuf>,
    /// Its format, when the content does not tell.
    pub format: Option<String>,
    /// Nodes, elements or sets that the result file lacks.
    pub geometry: Option<PathBuf>,
    /// Units of the structure's files.
    #[serde(default)]
    pub units: Units,
    /// Structure axes in mesh axes.
    pub axes: Option<[String; 3]>,
    /// Origin of the structure axes in mesh axes, m.
    #[serde(default)]
    pub origin: [f64; 3],
    /// Whether the file is a half model.
    #[serde(default)]
    pub half: bool,
    /// What becomes of modes of the other symmetry than that of a half mesh.
    #[serde(default)]
    pub other_symmetry: OtherSymmetry,
    /// Whether the steady pressure turns and stretches with the surface in the columns of
    /// elastic modes.
    #[serde(default = "yes")]
    pub pressure_turning: bool,
    /// Whether elastic columns have the influences of the deformed surface.
    #[serde(default)]
    pub shape_change: ShapeChange,
    /// First and last elastic mode, from 1.
    pub modes: Option<[usize; 2]>,
    /// Structural damping coefficient, one or one per elastic mode.
    pub damping: Option<OneOrMany<f64>>,
    /// How damping enters.
    #[serde(default)]
    pub damping_model: DampingModel,
    /// Mesh groups and the sets of the structure that carry them.
    pub components: Option<BTreeMap<String, Vec<String>>>,
    /// What carries the surface; left out: the nearest faces.
    pub transfer: Option<TransferChoice>,
    /// Largest error of a mode on the surface, relative to its largest displacement.
    #[serde(default = "a_tenth")]
    pub transfer_limit: f64,
    /// Masses added through the modes.
    #[serde(default)]
    pub added_mass: Vec<AddedMass>,
    /// Hinge stiffnesses changed through the modes.
    #[serde(default)]
    pub hinge: Vec<HingeChange>,
    /// Frequencies and dampings of single modes.
    #[serde(default, rename = "override")]
    pub overrides: Vec<ModeOverride>,
    /// Six rigid modes.
    pub rigid_body: Option<RigidBody>,
    /// Matrices given outright.
    pub matrices: Option<Matrices>,
}

impl Structure {
    /// Whether the modes are not those of the file.
    pub(crate) fn is_changed(&self) -> bool {
        let masses_or_hinges = !(self.added_mass.is_empty() && self.hinge.is_empty());
        masses_or_hinges
            || self
                .overrides
                .iter()
                .any(|mode| mode.frequency_hz.is_some())
    }
}

fn yes() -> bool {
    true
}

fn a_tenth() -> f64 {
    0.1
}

/// Units of the structure's files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum Units {
    /// Metre, kilogram, second.
    #[default]
    #[serde(rename = "m-kg-s")]
    MetreKilogram,
    /// Millimetre, tonne, second.
    #[serde(rename = "mm-t-s")]
    MillimetreTonne,
    /// Inch, pound-force, second.
    #[serde(rename = "in-lbf-s")]
    InchPound,
    /// Foot, slug, second.
    #[serde(rename = "ft-slug-s")]
    FootSlug,
}

/// What becomes of elastic modes that a half mesh cannot carry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OtherSymmetry {
    /// They are refused by name.
    #[default]
    Refuse,
    /// They are left out.
    LeaveOut,
}

/// How the columns of elastic modes follow the shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ShapeChange {
    /// Unknowns carried with the surface, influences unchanged.
    #[default]
    Attached,
    /// Influences of the deformed surface, by differences: two assemblies more a mode.
    Exact,
}

/// How structural damping enters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DampingModel {
    /// $C_{ii} = g_s\omega_i$.
    #[default]
    Viscous,
    /// $K_{ii}(1 + \mathrm i g_s)$.
    Hysteretic,
}

/// Mass properties; what is left out is taken from the result file.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigidBody {
    /// kg.
    pub mass: Option<f64>,
    /// Centre of mass in mesh axes, m.
    pub cg: Option<[f64; 3]>,
    /// About the centre of mass, kg m².
    pub inertia: Option<Inertia>,
}

/// Moments of inertia about the centre of mass, kg m².
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Inertia {
    /// $I_{xx}$.
    pub xx: f64,
    /// $I_{yy}$.
    pub yy: f64,
    /// $I_{zz}$.
    pub zz: f64,
    /// $\int xz\,\mathrm dm$.
    #[serde(default)]
    pub xz: f64,
}

/// Generalised matrices of all modes in order.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Matrices {
    /// $M$.
    pub mass: Vec<Vec<f64>>,
    /// $C$; zero when left out.
    pub damping: Option<Vec<Vec<f64>>>,
    /// $K$.
    pub stiffness: Vec<Vec<f64>>,
}
