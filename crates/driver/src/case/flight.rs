//! Trimmed flight, and what is swept.

use super::OneOrMany;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use std::fmt;

/// Gravity, drag, thrust and speed derivatives.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Flight {
    /// m/s².
    pub gravity: f64,
    /// Climb angle in degrees.
    pub climb_deg: f64,
    /// Whether each speed has its own incidence.
    pub trim: Trim,
    /// Controls, by the names of their modes, whose deflection balances the
    /// pitching moment; all turn by the same angle.
    pub trim_control: Option<OneOrMany<String>>,
    /// How thrust answers to speed.
    pub thrust: Thrust,
    /// $D_0/q_\infty$ in m².
    pub parasite_drag_area: f64,
    /// $D_iq_\infty/L^2$ in 1/m².
    pub induced_drag_factor: f64,
    /// Whether trim loads change with speed.
    pub speed_derivative: bool,
}

/// Standard gravity, m/s².
const STANDARD_GRAVITY: f64 = 9.806_65;

impl Default for Flight {
    fn default() -> Self {
        Self {
            gravity: STANDARD_GRAVITY,
            climb_deg: 0.0,
            trim: Trim::None,
            trim_control: None,
            thrust: Thrust::ConstantPower,
            parasite_drag_area: 0.0,
            induced_drag_factor: 0.0,
            speed_derivative: true,
        }
    }
}

/// Incidence over the sweep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Trim {
    /// `flow.alpha_deg` throughout.
    #[default]
    None,
    /// Every speed its own.
    Level,
}

/// How thrust answers to speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Thrust {
    /// Propeller.
    #[default]
    ConstantPower,
    /// Jet.
    ConstantThrust,
    /// Glider.
    None,
}

/// What is swept.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stability {
    /// Airspeeds, m/s.
    pub speed: Option<Speeds>,
    /// Altitudes, m, at `flow.mach`.
    pub altitude: Option<Range>,
    /// Whether the Mach number follows the speed.
    #[serde(default)]
    pub matched: bool,
    /// How p2 fits the samples.
    #[serde(default)]
    pub fit: Fit,
    /// How p-k puts damping into the forces.
    #[serde(default)]
    pub pk: PkDamping,
    /// Speed whose margin to instability is told, m/s.
    pub margin_speed: Option<f64>,
    /// On which forces roots are refined.
    #[serde(default)]
    pub refine: Refine,
}

/// How p2 fits the samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Fit {
    /// A quadratic spline along the imaginary axis, edges half-way between samples.
    #[default]
    Centred,
    /// As the paper words it, for comparison.
    Literal,
    /// Rectangles of a grid in g and k.
    Laplace,
}

/// How p-k puts damping into the forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PkDamping {
    /// Q(ik) complex as it is.
    #[default]
    Complex,
    /// Re Q + (p/k) Im Q.
    Real,
}

/// On which forces roots are refined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Refine {
    /// A rational model of the samples.
    #[default]
    Model,
    /// The computed forces themselves, at every step: slower.
    Exact,
}

/// Airspeeds as a range or a list.
#[derive(Clone, Debug, PartialEq)]
pub enum Speeds {
    /// Evenly spaced, both ends included.
    Range(Range),
    /// One by one.
    List(Vec<f64>),
}

impl Speeds {
    /// All of them in order, m/s.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Self::Range(range) => range.values(),
            Self::List(list) => list.clone(),
        }
    }
}

/// Evenly spaced values, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// First.
    pub from: f64,
    /// Last.
    pub to: f64,
    /// How many.
    pub count: usize,
}

impl Range {
    /// All of them in order; the last is exactly `to`.
    pub fn values(&self) -> Vec<f64> {
        let last = self.count.saturating_sub(1);
        let step = (self.to - self.from) / last.max(1) as f64;
        (0..self.count)
            .map(|i| {
                if i == last && last > 0 {
                    self.to
                } else {
                    self.from + step * i as f64
                }
            })
            .collect()
    }
}

struct RangeOrList;

impl<'de> Visitor<'de> for RangeOrList {
    type Value = Speeds;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a range { from, to, count } or a list of speeds")
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Speeds, A::Error> {
        Range::deserialize(MapAccessDeserializer::new(map)).map(Speeds::Range)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<Speeds, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(sequence)).map(Speeds::List)
    }
}

impl<'de> Deserialize<'de> for Speeds {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(RangeOrList)
    }
}
