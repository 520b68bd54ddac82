//! Incidence of steady flight at every dynamic pressure.
//!
//! The lift across the stream balances the weight, and a control the pitching
//! moment about the centre of mass:
//! $$ q_\infty\bigl[L(\alpha) + L_\delta(\alpha)\,\delta\bigr] = mg\cos\gamma,
//!    \qquad M(\alpha) + M_\delta(\alpha)\,\delta = 0 . $$
//! $L$ and $M$ are those of the steady flow of the undeformed aircraft,
//! quadratic forms of the stream, $L_\delta$ and $M_\delta$ columns of $Q(0)$.
//! Thrust adds to neither; without a control the moment stays unbalanced.

use fladder_stability::{Incidences, Mixture, OperatingPoint};

/// Incidences between which a trim is sought, rad.
const LIMIT: f64 = 25.0 * std::f64::consts::PI / 180.0;

/// Incidence above which potential flow is doubtful, rad.
pub(crate) const STALL: f64 = 12.0 * std::f64::consts::PI / 180.0;

/// Halvings of the range of incidence.
const HALVINGS: usize = 60;

/// Forces per unit dynamic pressure on the whole aircraft: along x and z, and
/// the moment about the centre of mass, nose up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PlaneLoads {
    pub(crate) x: f64,
    pub(crate) z: f64,
    pub(crate) moment: f64,
}

impl PlaneLoads {
    fn lift(self, alpha: f64) -> f64 {
        let (sine, cosine) = alpha.sin_cos();
        self.z * cosine - self.x * sine
    }
}

/// Where lift and moment come from.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Loads {
    /// Steady flow and, where there is one, the control at five incidences.
    Everywhere {
        nodes: Incidences,
        steady: Vec<PlaneLoads>,
        control: Option<Vec<PlaneLoads>>,
    },
    /// Lift per unit dynamic pressure at one incidence, and its slope.
    Line { alpha: f64, lift: f64, slope: f64 },
}

/// What is balanced.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Trim {
    /// $mg\cos\gamma$ in N.
    pub(crate) weight: f64,
    pub(crate) loads: Loads,
}

/// A state of balance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Balance {
    /// rad.
    pub(crate) alpha: f64,
    /// Deflection of the control, rad; none without one.
    pub(crate) deflection: Option<f64>,
}

impl Trim {
    /// The state at a dynamic pressure in Pa; `None` where no incidence within
    /// 25 degrees carries the weight.
    pub(crate) fn at(&self, pressure: f64) -> Option<Balance> {
        let wanted = self.weight / pressure;
        let alpha = match &self.loads {
            Loads::Line { alpha, lift, slope } => {
                let found = alpha + (wanted - lift) / slope;
                (found.abs() <= LIMIT).then_some(found)?
            }
            Loads::Everywhere { .. } => {
                let excess = |alpha: f64| self.lift(alpha) - wanted;
                let (mut low, mut high) = (-LIMIT, LIMIT);
                if excess(low) > 0.0 || excess(high) < 0.0 {
                    return None;
                }
                for _ in 0..HALVINGS {
                    let middle = f64::midpoint(low, high);
                    if excess(middle) < 0.0 {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                f64::midpoint(low, high)
            }
        };
        Some(Balance {
            alpha,
            deflection: self.deflection(alpha),
        })
    }

    /// Lift per unit dynamic pressure with the moment balanced.
    fn lift(&self, alpha: f64) -> f64 {
        match &self.loads {
            Loads::Line {
                alpha: at,
                lift,
                slope,
            } => lift + slope * (alpha - at),
            Loads::Everywhere {
                nodes,
                steady,
                control,
            } => {
                let own = mixed(nodes, steady, alpha).lift(alpha);
                let added = control
                    .as_ref()
                    .zip(self.deflection(alpha))
                    .map_or(0.0, |(control, angle)| {
                        mixed(nodes, control, alpha).lift(alpha) * angle
                    });
                own + added
            }
        }
    }

    fn deflection(&self, alpha: f64) -> Option<f64> {
        let Loads::Everywhere {
            nodes,
            steady,
            control: Some(control),
        } = &self.loads
        else {
            return None;
        };
        let effect = mixed(nodes, control, alpha).moment;
        Some(-mixed(nodes, steady, alpha).moment / effect)
    }
}

fn mixed(nodes: &Incidences, loads: &[PlaneLoads], alpha: f64) -> PlaneLoads {
    let point = OperatingPoint {
        alpha,
        ..OperatingPoint::new(1.0, 1.0)
    };
    let weights = nodes.weights(&point);
    let sum = |part: &dyn Fn(&PlaneLoads) -> f64| {
        loads.iter().zip(&weights).map(|(l, w)| part(l) * w).sum()
    };
    PlaneLoads {
        x: sum(&|l| l.x),
        z: sum(&|l| l.z),
        moment: sum(&|l| l.moment),
    }
}

/// Incidences at which loads are taken: the whole range of the search.
pub(crate) fn nodes() -> Incidences {
    Incidences::over(-LIMIT, LIMIT)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wing with $C_N = a\sin\alpha$ normal to itself and a tail: closed
    /// form $L = a\sin\alpha\cos\alpha$ at zero deflection.
    #[test]
    fn lift_and_moment_are_balanced() {
        let nodes = nodes();
        let normal = |alpha: f64| 3.0 * alpha.sin() * alpha.cos();
        let steady = nodes.values().map(|alpha| PlaneLoads {
            x: 0.0,
            z: normal(alpha) + 0.1,
            moment: -0.5 * normal(alpha) + 0.02,
        });
        let control = nodes.values().map(|alpha| PlaneLoads {
            x: 0.0,
            z: 0.4 * alpha.cos(),
            moment: -0.8 * alpha.cos(),
        });
        let trim = Trim {
            weight: 180.0,
            loads: Loads::Everywhere {
                nodes,
                steady: steady.to_vec(),
                control: Some(control.to_vec()),
            },
        };
        for pressure in [300.0, 1000.0, 5000.0] {
            let Balance { alpha, deflection } = trim.at(pressure).unwrap();
            let angle = deflection.unwrap();
            let moment = -0.5 * normal(alpha) + 0.02 - 0.8 * alpha.cos() * angle;
            let z = normal(alpha) + 0.1 + 0.4 * alpha.cos() * angle;
            assert!(moment.abs() < 1e-12, "{moment}");
            assert!((pressure * z * alpha.cos() - 180.0).abs() < 1e-9);
        }
        assert_eq!(trim.at(50.0), None);
        let line = Trim {
            weight: 100.0,
            loads: Loads::Line {
                alpha: 0.01,
                lift: 0.05,
                slope: 2.0,
            },
        };
        let found = line.at(1000.0).unwrap();
        assert!((found.alpha - 0.035).abs() < 1e-15 && found.deflection.is_none());
    }
}
