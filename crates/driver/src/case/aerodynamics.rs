//! Reference lengths, free stream, wetted surface, wake, analytic modes, and
//! the grid of the generalised aerodynamic forces.

use super::one_or_many::OneOrMany;
use fladder_mesh::Symmetry;
use serde::Deserialize;
use std::path::PathBuf;

/// Reference lengths.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// $b$ in m, half of the reference chord.
    pub semichord: f64,
    /// Area for coefficients, m².
    pub area: Option<f64>,
    /// Span for coefficients, m.
    pub span: Option<f64>,
    /// Chord for coefficients, m.
    pub chord: Option<f64>,
    /// Point of moments, m.
    #[serde(default)]
    pub moment_point: [f64; 3],
}

/// Free stream.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Flow {
    /// Mach number.
    pub mach: f64,
    /// Angle of attack in degrees, positive nose up.
    pub alpha_deg: f64,
    /// Sideslip in degrees, positive with wind from starboard.
    pub beta_deg: f64,
    /// Air density in kg/m³.
    pub density: Option<f64>,
    /// Geopotential altitude in m of the standard atmosphere.
    pub altitude: Option<f64>,
}

/// Wetted surface.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// Mesh file.
    pub file: PathBuf,
    /// Metres per unit of the file.
    #[serde(default = "one")]
    pub scale: f64,
    /// Half model or whole.
    #[serde(default)]
    pub symmetry: Symmetry,
    /// What counts as a trailing edge.
    #[serde(default)]
    pub trailing_edge: TrailingEdges,
}

fn one() -> f64 {
    1.0
}

/// What counts as a trailing edge.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TrailingEdges {
    /// An edge is sharp when its wedge angle is below this, degrees.
    pub max_wedge_deg: f64,
    /// A sharp edge is trailing when the unit sum of its two normals has at
    /// least this component along x.
    pub min_downstream: f64,
    /// Curve groups of the mesh file to take instead.
    pub groups: Option<Vec<String>>,
}

impl Default for TrailingEdges {
    fn default() -> Self {
        Self {
            max_wedge_deg: 60.0,
            min_downstream: 0.3,
            groups: None,
        }
    }
}

/// Wake.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Wake {
    /// Whether there is one.
    pub mode: WakeMode,
    /// Where it goes.
    pub direction: WakeDirection,
    /// Curve groups along which a wake's inner edge lies on a body.
    pub body_lines: Vec<String>,
}

/// Whether there is a wake.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum WakeMode {
    /// Where there are trailing edges.
    #[default]
    Auto,
    /// No trailing edge is an error.
    Required,
    /// None, whatever the edges.
    None,
}

/// Direction of the wake.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum WakeDirection {
    /// Along the free stream.
    #[default]
    Freestream,
    /// Along x.
    X,
}

/// Modes given by formulae.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Modes {
    /// In the order of their rows and columns.
    pub analytic: Vec<AnalyticMode>,
    /// Control surfaces, behind them.
    pub control: Vec<ControlMode>,
}

impl Modes {
    /// The formulae of all, in order, with the keys they stand at.
    pub fn formulae(&self) -> Vec<(String, AnalyticMode)> {
        let analytic = self.analytic.iter().cloned().enumerate();
        let control = self.control.iter().enumerate();
        analytic
            .map(|(number, mode)| (format!("modes.analytic.{number}"), mode))
            .chain(control.map(|(n, mode)| (format!("modes.control.{n}"), mode.formula())))
            .collect()
    }
}

/// A control surface turned by one radian about its hinge.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ControlMode {
    /// Name in tables and files; left out: `control:` and the first group.
    pub name: Option<String>,
    /// Surface groups of the mesh that turn.
    pub group: OneOrMany<String>,
    /// Hinge.
    pub hinge: Rotation,
}

impl ControlMode {
    fn formula(&self) -> AnalyticMode {
        let named = self.group.as_slice().first();
        let own = || format!("control:{}", named.map_or("", String::as_str));
        AnalyticMode {
            name: self.name.clone().unwrap_or_else(own),
            translation: None,
            rotation: Some(self.hinge.clone()),
            polynomial: None,
            group: Some(self.group.clone()),
        }
    }
}

/// One mode given by a formula: one of the three kinds.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AnalyticMode {
    /// Name in tables and files.
    pub name: String,
    /// The same displacement everywhere, m.
    pub translation: Option<[f64; 3]>,
    /// Right-handed rotation by one radian.
    pub rotation: Option<Rotation>,
    /// Sum of polynomial terms.
    pub polynomial: Option<Vec<Term>>,
    /// Surface groups of the mesh that it moves, a control for example; left
    /// out: the whole surface.
    pub group: Option<OneOrMany<String>>,
}

/// An axis of rotation.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// Direction; its length does not matter.
    pub axis: [f64; 3],
    /// A point on it, m.
    pub point: [f64; 3],
}

/// $c\,x^i|y|^jz^l$ in one component.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Term {
    /// `x`, `y` or `z`.
    pub component: Axis,
    /// $c$.
    pub coefficient: f64,
    /// $(i, j, l)$.
    pub powers: [u32; 3],
    /// Whether the term changes its sign with $y$.
    #[serde(default)]
    pub odd_y: bool,
}

/// One of the mesh axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// Aft.
    X,
    /// Starboard.
    Y,
    /// Up.
    Z,
}

/// Grid of the generalised aerodynamic forces, or a file that holds them.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gaf {
    /// Reduced frequencies, ascending.
    #[serde(default)]
    pub k: Vec<f64>,
    /// Reduced dampings.
    #[serde(default = "only_zero")]
    pub g: Vec<f64>,
    /// Generalised forces from elsewhere, one file a Mach number.
    pub file: Option<OneOrMany<PathBuf>>,
    /// Factorise in double precision, instead of single precision refined twice.
    #[serde(default)]
    pub exact: bool,
    /// How the equations are solved.
    #[serde(default)]
    pub solver: SolverChoice,
    /// Relative error of a hierarchical matrix and of its iteration.
    #[serde(default = "hierarchical_tolerance")]
    pub tolerance: f64,
}

/// How the aerodynamic equations are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SolverChoice {
    /// Dense up to 20 000 vertices, hierarchical beyond.
    #[default]
    Auto,
    /// Factors of the full matrix.
    Dense,
    /// A hierarchical matrix and an iteration.
    Hierarchical,
}

fn hierarchical_tolerance() -> f64 {
    fladder_bem::Solver::TOLERANCE
}

fn only_zero() -> Vec<f64> {
    vec![0.0]
}
