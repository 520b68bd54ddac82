//! Outcome of a sweep, with the field names of the stability JSON.
//!
//! Plain data: numbers are finite, what is undefined is absent (`null`).

use serde::Serialize;

use faer::c64;

use crate::count::Tally;
use crate::flight_modes::FlightMode;
use crate::margin::Margin;
use crate::sensitivity::Sensitivity;

/// Version of the layout.
pub const SCHEMA: &str = "fladder.stability/1";

/// A whole sweep by one or more methods.
#[derive(Clone, Debug, Serialize)]
pub struct SweepResult {
    /// Version of the layout.
    pub schema: &'static str,
    /// Air density where it is one for all points.
    pub density: Option<f64>,
    /// Reference semichord $b$ in m.
    pub semichord: f64,
    /// Outcome by method.
    pub methods: Methods,
    /// Margin at a speed, of the most accurate method, where it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin: Option<Margin>,
    /// The same motions of the rigid aircraft by its derivatives alone.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rigid_aircraft: Vec<FlightMode>,
}

/// Outcome by method; what did not run is left out.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Methods {
    /// Roots of the piecewise quadratic as they are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub p2: Option<MethodResult>,
    /// Roots refined on a smooth $Q(p)$ and counted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub polished: Option<MethodResult>,
    /// Oscillatory roots of the p-k problem.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pk: Option<MethodResult>,
    /// Oscillatory roots of the g-method.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub g: Option<MethodResult>,
}

/// What one method found.
#[derive(Clone, Debug, Default, Serialize)]
pub struct MethodResult {
    /// Roots followed over speed.
    pub branches: Vec<Branch>,
    /// Roots with $|p| < 10^{-9}$ at each speed; they are in no branch.
    pub zero_roots: Vec<usize>,
    /// Crossings into $g > 0$ with $\omega > 0$, lowest speed first.
    pub flutter: Vec<Crossing>,
    /// Crossings of a real root into $g > 0$, lowest speed first.
    pub divergence: Vec<Divergence>,
    /// Ways back into $g < 0$, lowest speed first.
    pub restabilised: Vec<Crossing>,
    /// Roots with $g > 0$ where their branch begins, without a crossing; a
    /// growing pair that turns into real roots is not told again.
    pub unstable_at_start: Vec<UnstableStart>,
    /// Branches that grow over a range of speeds inside the sweep.
    pub humps: Vec<Hump>,
    /// Rigid motions by their names in flight mechanics, speed by speed; only
    /// with a rigid body.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub flight_modes: Vec<FlightMode>,
    /// Pairs that turn into two real roots, and back.
    pub turns: Vec<TurnOfPair>,
    /// Whether the count of roots was met at each speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub complete: Option<Vec<bool>>,
    /// Roots counted and found at each speed; none where a curve of the count
    /// runs through a root.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub count: Option<Vec<Option<Count>>>,
}

/// A branch that grows between two speeds and decays on both sides.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Hump {
    /// Name of the branch.
    pub branch: String,
    /// Speed of its crossing into growth in m/s.
    pub from: f64,
    /// Speed of the way back.
    pub to: f64,
}

/// A complex pair that becomes two real roots (`split`) or the reverse
/// (`join`): one motion with three branches.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TurnOfPair {
    /// `split` or `join`.
    pub kind: &'static str,
    /// Branch of the pair.
    pub pair: String,
    /// Branches of the real roots; one where the other lies outside the
    /// region.
    pub real: Vec<String>,
    /// The speeds between which it happens, m/s.
    pub between: [f64; 2],
}

/// Roots inside the curves of the argument principle at one speed: the zero
/// roots and both of a pair near the real axis count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Count {
    /// By the change of phase along the curves.
    pub counted: i64,
    /// In the list.
    pub found: i64,
}

impl From<Tally> for Count {
    fn from(tally: Tally) -> Self {
        Self {
            counted: tally.listed + tally.missing(),
            found: tally.listed,
        }
    }
}

/// One root over consecutive speeds.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Branch {
    /// Mode with the largest share of kinetic energy at the first speed; `#2`
    /// and so on where the name is taken.
    pub name: String,
    /// True airspeed in m/s.
    pub speed: Vec<f64>,
    /// $g = \sigma b/U$.
    pub g: Vec<f64>,
    /// $k = \omega b/U$, zero for a real root.
    pub k: Vec<f64>,
    /// σ in 1/s.
    pub sigma: Vec<f64>,
    /// ω in rad/s.
    pub omega: Vec<f64>,
    /// ω/2π.
    pub frequency_hz: Vec<f64>,
    /// $\zeta = -\sigma/|s|$.
    pub damping_ratio: Vec<Option<f64>>,
    /// $2\sigma/\omega$ of the V-g plot; none for a real root.
    pub structural_damping: Vec<Option<f64>>,
    /// Whether each root lies where forces are continued from the samples
    /// rather than between them; absent where none does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub extrapolated: Option<Vec<bool>>,
    /// Altitude in m, in sweeps that have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub altitude: Option<Vec<f64>>,
    /// Density in kg/m³, in sweeps where it changes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density: Option<Vec<f64>>,
    /// Mach number, in sweeps where density changes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mach: Option<Vec<f64>>,
    /// Whether the six rigid modes hold more than half of the kinetic energy
    /// at the first speed.
    pub kind: Kind,
    /// Number of the first speed of the sweep on the branch.
    #[serde(skip)]
    pub first: usize,
    /// Right eigenvectors, of unit length.
    #[serde(skip)]
    pub shapes: Vec<Vec<c64>>,
}

/// What moves most.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// The six rigid modes hold more than half of the kinetic energy.
    Rigid,
    /// They do not.
    #[default]
    Elastic,
}

/// A crossing of the imaginary axis.
#[derive(Clone, Debug, Serialize)]
pub struct Crossing {
    /// True airspeed in m/s.
    pub speed: f64,
    /// $\rho U^2/2$ in Pa.
    pub dynamic_pressure: f64,
    /// Frequency; zero for a real root.
    pub frequency_hz: f64,
    /// Reduced frequency.
    pub k: f64,
    /// Name of the branch.
    pub branch: String,
    /// What moves.
    pub kind: Kind,
    /// Derivatives of speed and frequency with respect to properties of the
    /// structure, where they were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sensitivities: Option<Vec<Sensitivity>>,
    /// Altitude in m, in sweeps that have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub altitude: Option<f64>,
    /// Right eigenvector at the crossing.
    #[serde(skip)]
    pub shape: Vec<c64>,
}

impl Crossing {
    /// Modes, and by how many m/s one per cent more frequency of each moves the crossing,
    /// $0.01\,f_i\,\partial U/\partial f_i$, the largest first. Empty where derivatives
    /// were not asked for.
    pub fn owed_to_frequencies(&self) -> Vec<(&str, f64)> {
        let mut owed: Vec<(&str, f64)> = self
            .sensitivities
            .iter()
            .flatten()
            .filter_map(|found| {
                let mode = found.parameter.strip_prefix("frequency of ")?;
                Some((mode, 0.01 * found.value? * found.speed))
            })
            .collect();
        owed.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        owed
    }
}

/// A real root through zero.
#[derive(Clone, Debug, Serialize)]
pub struct Divergence {
    /// True airspeed in m/s.
    pub speed: f64,
    /// $\rho U^2/2$ in Pa.
    pub dynamic_pressure: f64,
    /// Name of the branch; of the leading mode in the static problem.
    pub branch: String,
    /// What moves.
    pub kind: Kind,
    /// Altitude in m, in sweeps that have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub altitude: Option<f64>,
}

/// A root that grows where its branch begins.
#[derive(Clone, Debug, Serialize)]
pub struct UnstableStart {
    /// Name of the branch.
    pub branch: String,
    /// $g$ at its first speed.
    pub g: f64,
    /// $k$ at its first speed.
    pub k: f64,
    /// First speed of the branch in m/s; above the first of the sweep where
    /// the root came in from outside the region.
    pub speed: f64,
    /// What moves.
    pub kind: Kind,
}
