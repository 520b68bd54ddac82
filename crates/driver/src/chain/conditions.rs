//! The flight conditions of a sweep, one after the other and in between.

use super::trim::Trim;
use crate::atmosphere;
use crate::case::{self, CaseFile};
use crate::failure::Failure;
use fladder_stability::{OperatingPoint, Schedule};

/// Speeds at one density, or altitudes at one Mach number.
#[derive(Clone, Debug)]
pub(crate) struct Conditions {
    kind: Kind,
    alpha: f64,
    beta: f64,
    /// Carried by forces that are mixed by it.
    mach: f64,
    trim: Option<Trim>,
}

#[derive(Clone, Debug)]
enum Kind {
    Speeds {
        speeds: Vec<f64>,
        density: f64,
        /// In matched sweeps.
        altitude: Option<f64>,
    },
    Altitudes {
        altitudes: Vec<f64>,
        mach: f64,
    },
}

impl Conditions {
    /// Of the case, at one incidence throughout.
    ///
    /// # Errors
    /// The case has no [stability] or no density.
    pub(crate) fn of(file: &CaseFile) -> Result<Self, Failure> {
        let swept = file.case.stability.as_ref();
        let flow = &file.case.flow;
        let kind = match swept.and_then(|swept| swept.altitude) {
            Some(altitudes) => Kind::Altitudes {
                altitudes: altitudes.values(),
                mach: flow.mach,
            },
            None => Kind::Speeds {
                speeds: speeds_of(file)?,
                density: density(file)?,
                altitude: flow
                    .altitude
                    .filter(|_| swept.is_some_and(|swept| swept.matched)),
            },
        };
        Ok(Self {
            kind,
            alpha: flow.alpha_deg.to_radians(),
            beta: flow.beta_deg.to_radians(),
            mach: flow.mach,
            trim: None,
        })
    }

    /// At the incidence the forces hold for.
    #[must_use]
    pub(crate) fn at_incidence(self, alpha: f64, beta: f64) -> Self {
        Self {
            alpha,
            beta,
            ..self
        }
    }

    /// With the incidence that carries the weight at every point.
    #[must_use]
    pub(crate) fn trimmed(self, trim: Option<Trim>) -> Self {
        Self { trim, ..self }
    }

    /// True airspeeds in order, m/s.
    pub(crate) fn speeds(&self) -> Vec<f64> {
        self.points().iter().map(|point| point.airspeed).collect()
    }

    /// All points in order.
    pub(crate) fn points(&self) -> Vec<OperatingPoint> {
        let count = self.count();
        (0..count).map(|number| self.at(number as f64)).collect()
    }

    /// What is balanced at every point, if anything.
    pub(super) fn trim(&self) -> Option<&Trim> {
        self.trim.as_ref()
    }

    /// Whether every point has its own incidence.
    pub(crate) fn is_trimmed(&self) -> bool {
        self.trim.is_some()
    }

    /// Whether the Mach number follows speed and altitude.
    pub(crate) fn is_matched(&self) -> bool {
        match &self.kind {
            Kind::Speeds { altitude, .. } => altitude.is_some(),
            Kind::Altitudes { .. } => true,
        }
    }

    /// What the sweep was made at, in words.
    pub(crate) fn words(&self) -> String {
        match &self.kind {
            Kind::Speeds {
                speeds,
                density,
                altitude,
            } => {
                let place = altitude.map_or_else(
                    || format!("density {density:.4} kg/m³"),
                    |altitude| format!("altitude {altitude} m, Mach number matched"),
                );
                let (first, last) = ends(speeds);
                format!("{place}, {first}–{last} m/s")
            }
            Kind::Altitudes { altitudes, mach } => {
                let (first, last) = ends(altitudes);
                format!("M {mach}, altitude {first} to {last} m (standard atmosphere)")
            }
        }
    }

    /// Without incidence.
    fn bare(&self, parameter: f64) -> OperatingPoint {
        match &self.kind {
            Kind::Speeds {
                speeds,
                density,
                altitude,
            } => {
                let airspeed = at(speeds, parameter);
                let mach =
                    altitude.map(|altitude| airspeed / atmosphere::sound_speed(altitude));
                OperatingPoint {
                    mach: mach.or(Some(self.mach)),
                    altitude: *altitude,
                    ..OperatingPoint::new(airspeed, *density)
                }
            }
            Kind::Altitudes { altitudes, mach } => {
                let altitude = at(altitudes, parameter);
                let airspeed = mach * atmosphere::sound_speed(altitude);
                OperatingPoint {
                    mach: Some(*mach),
                    altitude: Some(altitude),
                    ..OperatingPoint::new(airspeed, atmosphere::density(altitude))
                }
            }
        }
    }
}

impl Schedule for Conditions {
    fn count(&self) -> usize {
        match &self.kind {
            Kind::Speeds { speeds, .. } => speeds.len(),
            Kind::Altitudes { altitudes, .. } => altitudes.len(),
        }
    }

    /// Speed or altitude linear between the points, all else from it.
    fn at(&self, parameter: f64) -> OperatingPoint {
        let point = self.bare(parameter);
        let balance = self
            .trim
            .as_ref()
            .and_then(|trim| trim.at(point.dynamic_pressure()));
        OperatingPoint {
            alpha: balance.map_or(self.alpha, |balance| balance.alpha),
            beta: self.beta,
            ..point
        }
    }
}

/// A list read between its entries.
fn at(list: &[f64], parameter: f64) -> f64 {
    let last = list.len().saturating_sub(1);
    let start = (parameter.max(0.0).floor() as usize).min(last);
    let end = (start + 1).min(last);
    let fraction = parameter - start as f64;
    if fraction == 0.0 {
        list[start]
    } else {
        list[start] + fraction * (list[end] - list[start])
    }
}

fn ends(list: &[f64]) -> (f64, f64) {
    (
        list.first().copied().unwrap_or_default(),
        list.last().copied().unwrap_or_default(),
    )
}

/// Air density of the case, kg/m³.
///
/// # Errors
/// The case gives none.
pub(crate) fn density(file: &CaseFile) -> Result<f64, Failure> {
    let flow = &file.case.flow;
    flow.density
        .or_else(|| flow.altitude.map(atmosphere::density))
        .ok_or_else(|| {
            Failure::input(
                "neither `flow.density` nor `flow.altitude` is given",
                file.places.of("flow.density"),
                "the dynamic pressure of a speed needs the density",
                "add density = 1.225 (kg/m³) or altitude = 0.0 (m) to [flow]",
            )
        })
}

/// Speeds of the case, m/s.
fn speeds_of(file: &CaseFile) -> Result<Vec<f64>, Failure> {
    let swept = file.case.stability.as_ref();
    let speeds = swept.and_then(|swept| swept.speed.as_ref());
    speeds.map(case::Speeds::values).ok_or_else(|| {
        Failure::input(
            "the case has no [stability] with speeds",
            file.places.of("stability"),
            "there is nothing to sweep",
            "add [stability] with speed = { from = 20.0, to = 75.0, count = 56 }",
        )
    })
}
