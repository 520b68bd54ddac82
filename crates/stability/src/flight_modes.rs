//! Rigid motions by the names of flight mechanics, with what moves in them.
//!
//! Of a motion $\xi e^{st}$ with the body quasi-coordinates $q_6$ of
//! [`rigid`](crate::rigid), structural axes, $p = sb/U = g + \mathrm ik$:
//!
//! $$ \frac uU = -\frac pb(x\cos\alpha + z\sin\alpha),\quad
//!    \Delta\alpha = -\frac pb(z\cos\alpha - x\sin\alpha),\quad
//!    \beta = \frac pb\,y,\quad \Delta\theta = \theta, $$
//! $$ \psi_E = -\frac\psi{\cos\vartheta},\qquad
//!    \varphi_E = -(\varphi + \psi\tan\vartheta),\qquad
//!    \vartheta = \alpha+\gamma, $$
//!
//! Eller, IFASD-2009-119, tables 1 and 2, with Euler angles from
//! $p = \dot\varphi_E - \dot\psi_E\sin\vartheta$, $r = \dot\psi_E\cos\vartheta$
//! and the signs of flight mechanics: bank with the starboard wing down,
//! heading with the nose to starboard, nose up, wind from starboard.
//!
//! A motion in the plane of symmetry is a *phugoid* where the speed changes
//! more than the incidence, else a *short period*. Across it an oscillation
//! is a *Dutch roll*, the slower one of two a *lateral phugoid*; a real root
//! or one beside the branch cut is a *roll* where it banks more than it
//! turns, else a *spiral*. Where elastic modes hold more than a quarter of the
//! kinetic energy it is *coupled*, and none of these.

use faer::c64;
use serde::Serialize;

use crate::rigid::{RigidBody, RigidModes};
use crate::structure::OperatingPoint;

/// What flies: the part of a structure that names need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlyingBody {
    /// Where the rigid modes stand.
    pub modes: RigidModes,
    /// Mass properties that normalise them.
    pub body: RigidBody,
    /// Climb angle γ in radians.
    pub climb: f64,
}

/// A rigid motion at one flight condition.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FlightMode {
    /// True airspeed in m/s.
    pub speed: f64,
    /// Incidence in degrees.
    pub alpha_deg: f64,
    /// Name of the branch; empty for the rigid aircraft.
    pub branch: String,
    /// Name in flight mechanics.
    pub motion: &'static str,
    /// σ in 1/s.
    pub sigma: f64,
    /// ω in rad/s, zero for a real root.
    pub omega: f64,
    /// $2\pi/\omega$ in s; none for a real root.
    pub period: Option<f64>,
    /// $\zeta = -\sigma/|s|$.
    pub damping_ratio: f64,
    /// Time in which the amplitude doubles, s; none where it decays.
    pub time_to_double: Option<f64>,
    /// Time in which it halves, s; none where it grows.
    pub time_to_halve: Option<f64>,
    /// Share of elastic modes in the kinetic energy.
    pub elastic_share: f64,
    /// Elastic mode with the largest share, where there is one.
    pub elastic_mode: Option<String>,
    /// Ratios of amplitudes.
    pub ratios: Vec<Ratio>,
}

/// One amplitude over another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ratio {
    /// `u:alpha` (with $u/U$), `theta:alpha`, `u:theta`, `psi:phi`,
    /// `beta:phi`, `beta:psi`.
    pub name: &'static str,
    /// Of the amplitudes; angles in rad.
    pub magnitude: f64,
    /// By which the first is ahead, degrees, −180 … 180.
    pub phase_deg: f64,
}

/// Amplitudes of a motion.
#[derive(Clone, Copy, Debug)]
struct Amplitudes {
    u: c64,
    alpha: c64,
    theta: c64,
    beta: c64,
    phi: c64,
    psi: c64,
}

/// A root before it has a name.
pub(crate) struct Motion {
    pub(crate) p: c64,
    amplitudes: Amplitudes,
    is_lateral: bool,
    is_coupled: bool,
}

/// Share of elastic modes above which a rigid motion has no name of its own.
const COUPLED: f64 = 0.25;

/// An amplitude below this part of the largest is rounding, and divides nothing.
const ROUNDING: f64 = 1e-9;

/// Damping ratio above which an oscillation is no more than a bent decay.
const OVERDAMPED: f64 = 0.5;

impl Motion {
    /// Of a root and its vector over all modes.
    pub(crate) fn new(
        flying: &FlyingBody,
        point: &OperatingPoint,
        semichord: f64,
        p: c64,
        vector: &[c64],
        elastic_share: f64,
    ) -> Self {
        let scales = flying.body.scales();
        let at = |mode: usize| {
            flying.modes.0[mode].map_or(c64::new(0.0, 0.0), |place| vector[place])
        };
        let [x, y, z, phi, theta, psi] = std::array::from_fn(|mode| at(mode) * scales[mode]);
        let (sine, cosine) = point.alpha.sin_cos();
        let attitude = point.alpha + flying.climb;
        let rate = p / semichord;
        let amplitudes = Amplitudes {
            u: -rate * (x * cosine + z * sine),
            alpha: -rate * (z * cosine - x * sine),
            theta,
            beta: rate * y,
            phi: -(phi + psi * attitude.tan()),
            psi: -psi / attitude.cos(),
        };
        let share =
            |modes: [usize; 3]| -> f64 { modes.iter().map(|mode| at(*mode).norm_sqr()).sum() };
        Self {
            p,
            amplitudes,
            is_lateral: share([1, 3, 5]) > share([0, 2, 4]),
            is_coupled: elastic_share > COUPLED,
        }
    }

    fn is_oscillation(&self) -> bool {
        self.p.im > 0.0 && -self.p.re < OVERDAMPED * self.p.norm()
    }

    fn is_fast(&self) -> bool {
        let Amplitudes { u, alpha, .. } = self.amplitudes;
        u.norm() < alpha.norm()
    }

    fn ratios(&self) -> Vec<Ratio> {
        let a = &self.amplitudes;
        let pairs: [(&'static str, c64, c64); 3] = if self.is_lateral {
            [
                ("psi:phi", a.psi, a.phi),
                ("beta:phi", a.beta, a.phi),
                ("beta:psi", a.beta, a.psi),
            ]
        } else {
            [
                ("u:alpha", a.u, a.alpha),
                ("theta:alpha", a.theta, a.alpha),
                ("u:theta", a.u, a.theta),
            ]
        };
        let largest = [a.u, a.alpha, a.theta, a.beta, a.phi, a.psi]
            .iter()
            .map(|amplitude| amplitude.norm())
            .fold(0.0, f64::max);
        let is_there = |below: c64| below.norm() > ROUNDING * largest;
        let pairs = pairs.into_iter().filter(|(_, _, below)| is_there(*below));
        pairs
            .map(|(name, above, below)| {
                let quotient = above / below;
                Ratio {
                    name,
                    magnitude: quotient.norm(),
                    phase_deg: quotient.arg().to_degrees(),
                }
            })
            .filter(|ratio| ratio.magnitude.is_finite())
            .collect()
    }
}

/// Names of the motions of one flight condition, in their order.
pub(crate) fn names(motions: &[Motion]) -> Vec<&'static str> {
    let slower_exists = |own: usize, lateral: bool| {
        motions.iter().enumerate().any(|(number, other)| {
            number != own
                && other.is_lateral == lateral
                && !other.is_coupled
                && other.is_oscillation()
                && other.p.norm() > motions[own].p.norm()
        })
    };
    motions
        .iter()
        .enumerate()
        .map(
            |(own, motion)| match (motion.is_lateral, motion.is_oscillation()) {
                (false, _) if motion.is_coupled => "coupled, symmetric",
                (true, _) if motion.is_coupled => "coupled, lateral",
                (false, _) if motion.is_fast() => "short period",
                (false, _) => "phugoid",
                (true, true) if slower_exists(own, true) => "lateral phugoid",
                (true, true) => "Dutch roll",
                (true, false) => {
                    let Amplitudes { phi, psi, .. } = motion.amplitudes;
                    if phi.norm() > psi.norm() {
                        "roll"
                    } else {
                        "spiral"
                    }
                }
            },
        )
        .collect()
}

/// What a report needs of a named motion.
pub(crate) struct Named<'a> {
    pub(crate) motion: &'a Motion,
    pub(crate) name: &'static str,
    pub(crate) branch: String,
    pub(crate) elastic_share: f64,
    pub(crate) elastic_mode: Option<String>,
}

impl Named<'_> {
    /// In dimensional form.
    pub(crate) fn at(self, point: &OperatingPoint, semichord: f64) -> FlightMode {
        let rate = point.airspeed / semichord;
        let s = self.motion.p * rate;
        let doubling = std::f64::consts::LN_2 / s.re.abs();
        FlightMode {
            speed: point.airspeed,
            alpha_deg: point.alpha.to_degrees(),
            branch: self.branch,
            motion: self.name,
            sigma: s.re,
            omega: s.im,
            period: (s.im > 0.0).then(|| std::f64::consts::TAU / s.im),
            damping_ratio: -s.re / s.norm(),
            time_to_double: (s.re > 0.0).then_some(doubling),
            time_to_halve: (s.re < 0.0).then_some(doubling),
            elastic_share: self.elastic_share,
            elastic_mode: self.elastic_mode,
            ratios: self.motion.ratios(),
        }
    }
}
