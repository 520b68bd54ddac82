//! Distance of a speed from the first instability, and its least damped root.

use serde::Serialize;

use crate::results::{Branch, MethodResult};

/// How far a speed is from instability.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Margin {
    /// The speed in question, m/s.
    pub speed: f64,
    /// Speed at which something first grows, m/s: a crossing, or the first
    /// speed of the sweep where a root grows from the beginning; none within
    /// the sweep.
    pub first_instability: Option<f64>,
    /// Branch that grows there.
    pub branch: Option<String>,
    /// First instability over the speed, less one; negative where the speed
    /// is beyond it.
    pub speed_margin: Option<f64>,
    /// Branch with the least damping ratio among the oscillations at that
    /// speed, linear between the speeds of the sweep.
    pub least_damped: Option<String>,
    /// Its damping ratio.
    pub damping_ratio: Option<f64>,
    /// Its frequency in Hz.
    pub frequency_hz: Option<f64>,
}

impl MethodResult {
    /// The margin at a speed.
    pub fn margin(&self, speed: f64) -> Margin {
        let flutter = self.flutter.iter().map(|one| (one.speed, &one.branch));
        let divergence = self.divergence.iter().map(|one| (one.speed, &one.branch));
        let start = self
            .unstable_at_start
            .iter()
            .map(|one| (one.speed, &one.branch));
        let first = flutter
            .chain(divergence)
            .chain(start)
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let least = self
            .branches
            .iter()
            .filter_map(|branch| Some((branch, oscillation_at(branch, speed)?)))
            .min_by(|a, b| a.1[0].total_cmp(&b.1[0]));
        Margin {
            speed,
            first_instability: first.map(|(at, _)| at),
            branch: first.map(|(_, branch)| branch.clone()),
            speed_margin: first.map(|(at, _)| at / speed - 1.0),
            least_damped: least.map(|(branch, _)| branch.name.clone()),
            damping_ratio: least.map(|(_, [ratio, _])| ratio),
            frequency_hz: least.map(|(_, [_, frequency])| frequency),
        }
    }
}

/// Damping ratio and frequency of an oscillation at a speed on the branch.
fn oscillation_at(branch: &Branch, speed: f64) -> Option<[f64; 2]> {
    let at = branch
        .speed
        .windows(2)
        .position(|pair| (pair[0]..=pair[1]).contains(&speed) && pair[0] < pair[1]);
    let (start, fraction) = match at {
        Some(start) => {
            let (low, high) = (branch.speed[start], branch.speed[start + 1]);
            (start, (speed - low) / (high - low))
        }
        None => (branch.speed.iter().position(|own| *own == speed)?, 0.0),
    };
    let between = |list: &[f64]| {
        let next = list[(start + 1).min(list.len() - 1)];
        list[start] + fraction * (next - list[start])
    };
    let (sigma, omega) = (between(&branch.sigma), between(&branch.omega));
    (omega > 0.0).then(|| [-sigma / sigma.hypot(omega), omega / std::f64::consts::TAU])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Divergence, Kind};

    /// Two branches whose damping is linear in speed.
    #[test]
    fn the_margin_is_read_between_the_speeds() {
        let branch = |name: &str, sigma: [f64; 2]| Branch {
            name: name.to_owned(),
            speed: vec![40.0, 50.0],
            sigma: sigma.to_vec(),
            omega: vec![8.0, 8.0],
            ..Branch::default()
        };
        let result = MethodResult {
            branches: vec![branch("a", [-6.0, -6.0]), branch("b", [-12.0, 0.0])],
            divergence: vec![Divergence {
                speed: 60.0,
                dynamic_pressure: 0.0,
                branch: "c".to_owned(),
                kind: Kind::Elastic,
                altitude: None,
            }],
            ..MethodResult::default()
        };
        let margin = result.margin(42.5);
        assert_eq!(margin.least_damped.as_deref(), Some("a"));
        assert!((margin.damping_ratio.unwrap() - 0.6).abs() < 1e-15);
        let margin = result.margin(47.5);
        assert_eq!(margin.least_damped.as_deref(), Some("b"));
        assert!((margin.damping_ratio.unwrap() - 3.0 / 73.0_f64.sqrt()).abs() < 1e-15);
        assert_eq!(margin.branch.as_deref(), Some("c"));
        assert!((margin.speed_margin.unwrap() - (60.0 / 47.5 - 1.0)).abs() < 1e-15);
        assert_eq!(MethodResult::default().margin(10.0).speed_margin, None);
    }
}
