//! The fuselage, a body of revolution, and its conformal plane.
//!
//! In the plane of $m=\int\mathrm ds/r$ and the angle θ about the axis cells keep their
//! shape: smoothing there is smoothing on the body.

use fladder_mesh::Vec3;
use libm::{cos, hypot, sin, sqrt};

use super::params::Fuselage;

/// Points of the table of m.
const NOSE_POINTS: usize = 4000;
const POINTS: usize = 20_000;

/// The body with its table.
pub(super) struct Body {
    fuselage: Fuselage,
    stations: Vec<f64>,
    conformal: Vec<f64>,
}

impl Body {
    pub(super) fn new(fuselage: &Fuselage) -> Self {
        let quarter = std::f64::consts::FRAC_PI_2;
        let curved = (0..NOSE_POINTS).map(|i| {
            let angle = quarter * i as f64 / (NOSE_POINTS - 1) as f64;
            fuselage.nose * (1.0 - cos(angle))
        });
        let even = (0..=POINTS).map(|i| fuselage.length * i as f64 / POINTS as f64);
        let mut stations: Vec<f64> = curved.chain(even).collect();
        stations.sort_by(f64::total_cmp);
        stations.dedup();
        let mut body = Self {
            fuselage: fuselage.clone(),
            stations,
            conformal: Vec::new(),
        };
        let mut sum = 0.0;
        let mut conformal = vec![0.0];
        for pair in body.stations.windows(2) {
            let [low, high] = [body.radius(pair[0]), body.radius(pair[1])];
            let mean = f64::midpoint(low, high).max(1e-9);
            sum += hypot(pair[1] - pair[0], high - low) / mean;
            conformal.push(sum);
        }
        body.conformal = conformal;
        body
    }

    pub(super) fn length(&self) -> f64 {
        self.fuselage.length
    }

    /// Elliptic nose, cylinder, a cubic taper without a kink, elliptic spinner.
    pub(super) fn radius(&self, x: f64) -> f64 {
        let body = &self.fuselage;
        let ellipse = |part: f64| sqrt((1.0 - part * part).max(0.0));
        let spinner = body.length - body.spinner;
        if x > spinner {
            let part = ((x - spinner) / body.spinner).clamp(0.0, 1.0);
            return body.tail_radius * ellipse(part);
        }
        if x > body.tail_begin {
            let u = ((x - body.tail_begin) / (spinner - body.tail_begin)).clamp(0.0, 1.0);
            let blend = u * u * (3.0 - 2.0 * u);
            return body.radius + (body.tail_radius - body.radius) * blend;
        }
        body.radius * ellipse((1.0 - x / body.nose).clamp(0.0, 1.0))
    }

    /// m at a station.
    pub(super) fn conformal(&self, x: f64) -> f64 {
        interpolate(&self.stations, &self.conformal, x)
    }

    /// Station at m.
    pub(super) fn station(&self, m: f64) -> f64 {
        interpolate(&self.conformal, &self.stations, m)
    }

    /// Stations at which the caps of nose and tail begin.
    pub(super) fn caps(&self) -> [f64; 2] {
        let body = &self.fuselage;
        let nose = |x: f64| self.radius(x) - body.nose_cap;
        let tail = |x: f64| body.tail_cap - self.radius(x);
        [
            root(0.0, body.nose, nose),
            root(body.length - body.spinner, body.length, tail),
        ]
    }

    pub(super) fn point(&self, x: f64, angle: f64) -> Vec3 {
        let radius = self.radius(x);
        Vec3::new(x, radius * cos(angle), radius * sin(angle))
    }
}

/// Place between two ends where an ascending function passes zero.
pub(super) fn root(mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if function(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    f64::midpoint(low, high)
}

/// Linear between ascending places; beyond them the ends.
fn interpolate(places: &[f64], values: &[f64], at: f64) -> f64 {
    let next = places.partition_point(|place| *place <= at);
    if next == 0 {
        return values[0];
    }
    if next == places.len() {
        return values[next - 1];
    }
    let part = (at - places[next - 1]) / (places[next] - places[next - 1]);
    values[next - 1] + part * (values[next] - values[next - 1])
}
