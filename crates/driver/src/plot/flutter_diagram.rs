//! Frequency and damping over airspeed.

use super::axis::Axis;
use super::label::Labels;
use super::layout::{LEFT, TOP, WIDTH, footer, heading, legend, marker_stride, right_edge};
use super::panel::Panel;
use super::style::{Styles, crosses};
use super::svg::{GREY, Svg};
use super::{MethodResult, Subject};
use crate::figures::three_digits;
use fladder_stability::Branch;

const HEIGHT: f64 = 900.0;
/// Damping outside of this is cut off: strongly damped roots say nothing of
/// flutter and would flatten the rest.
const SHOWN_DAMPING: [f64; 2] = [-0.6, 0.6];

/// The V-g-f diagram: above the frequency, below the structural damping
/// $2\sigma/\omega$, both over true airspeed.
pub fn flutter_diagram(subject: &Subject<'_>) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT);
    let Some((lines, method)) = subject.lines() else {
        heading(&mut svg, subject, "V-g-f diagram", "no roots");
        return svg.finish();
    };
    heading(&mut svg, subject, "V-g-f diagram", method);
    let (upper, lower) = panels(lines);
    let styles = Styles::of(lines.branches.iter().map(|branch| branch.name.as_str()));
    let beside = subject.crosses();
    for (panel, quantity, name) in [
        (&upper, Quantity::Frequency, "frequency"),
        (&lower, Quantity::Damping, "damping"),
    ] {
        panel.draw_axes(&mut svg);
        let [left, top, width, height] = panel.area;
        svg.open_clip(name, [left, top], [width, height]);
        let mut curves = Vec::new();
        for branch in &lines.branches {
            curves.extend(draw_branch(&mut svg, panel, quantity, branch, &styles));
        }
        for branch in beside.iter().flat_map(|pk| &pk.branches) {
            let colour = styles.get(&branch.name).map_or(GREY, |style| style.colour);
            let points = quantity.of(branch).step_by(2);
            let places = points.map(|(speed, value)| panel.at(speed, value));
            let places: Vec<[f64; 2]> = places.filter(|at| panel.reaches(*at)).collect();
            crosses(&mut svg, &places, colour);
        }
        svg.close();
        crossings(&mut svg, panel, quantity, lines, &curves);
    }
    legend(&mut svg, lines, &styles, beside.is_some(), HEIGHT);
    footer(
        &mut svg,
        HEIGHT,
        "Positive damping grows. Real roots have no structural damping and are shown at 0 Hz only. \
         Rings: crossings into growth.",
    );
    svg.finish()
}

/// What is drawn over airspeed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Quantity {
    Frequency,
    Damping,
}

impl Quantity {
    fn of(self, branch: &Branch) -> impl Iterator<Item = (f64, f64)> + '_ {
        let values = branch.frequency_hz.iter().zip(&branch.structural_damping);
        branch
            .speed
            .iter()
            .zip(values)
            .filter_map(move |(speed, (frequency, damping))| {
                let value = match self {
                    Self::Frequency => Some(*frequency),
                    Self::Damping => *damping,
                };
                value.map(|value| (*speed, value))
            })
    }
}

fn panels(lines: &MethodResult) -> (Panel<'static>, Panel<'static>) {
    let (mut speed, mut frequency) = ([f64::INFINITY, f64::NEG_INFINITY], 1e-3f64);
    let mut damping = [-0.05f64, 0.05f64];
    for branch in &lines.branches {
        for (at, value) in Quantity::Frequency.of(branch) {
            speed = [speed[0].min(at), speed[1].max(at)];
            frequency = frequency.max(value);
        }
        for (_, value) in Quantity::Damping.of(branch) {
            let value = value.clamp(SHOWN_DAMPING[0], SHOWN_DAMPING[1]);
            damping = [damping[0].min(value), damping[1].max(value)];
        }
    }
    if speed[0] > speed[1] {
        speed = [0.0, 1.0];
    }
    let width = right_edge(lines) - LEFT;
    let height = (HEIGHT - TOP - 150.0) / 2.0;
    let panel = |top: f64, y: Axis, y_label: &'static str| Panel {
        area: [LEFT, top, width, height],
        x: Axis::exact(speed[0], speed[1], 10),
        y,
        x_label: "true airspeed  V  [m/s]",
        y_label,
    };
    let upper = panel(
        TOP,
        Axis::exact(-0.03 * frequency, 1.08 * frequency, 7),
        "frequency  f  [Hz]",
    );
    let lower = panel(
        TOP + height + 62.0,
        Axis::exact(1.05 * damping[0], 1.05 * damping[1], 7),
        "structural damping  2σ/ω  [–]",
    );
    (upper, lower)
}

fn draw_branch(
    svg: &mut Svg,
    panel: &Panel<'_>,
    quantity: Quantity,
    branch: &Branch,
    styles: &Styles,
) -> Vec<[f64; 2]> {
    let points: Vec<[f64; 2]> = quantity
        .of(branch)
        .map(|(speed, value)| panel.at(speed, value))
        .collect();
    let Some(style) = styles.get(&branch.name) else {
        return points;
    };
    if points.is_empty() {
        return points;
    }
    for run in points.chunk_by(|a, b| panel.reaches(*a) && panel.reaches(*b)) {
        svg.polyline(run, style.colour, 1.8);
    }
    for point in points.iter().step_by(marker_stride(points.len())) {
        style.mark(svg, *point, 3.2);
    }
    points
}

fn crossings(
    svg: &mut Svg,
    panel: &Panel<'_>,
    quantity: Quantity,
    lines: &MethodResult,
    curves: &[[f64; 2]],
) {
    let mut marked: Vec<([f64; 2], String)> = Vec::new();
    for crossing in &lines.flutter {
        let (value, text) = match quantity {
            Quantity::Frequency => (
                crossing.frequency_hz,
                format!(
                    "{} m/s, {} Hz",
                    three_digits(crossing.speed),
                    three_digits(crossing.frequency_hz)
                ),
            ),
            Quantity::Damping => (0.0, format!("{} m/s", three_digits(crossing.speed))),
        };
        if panel.contains(crossing.speed, value) {
            marked.push((panel.at(crossing.speed, value), text));
        }
    }
    for divergence in &lines.divergence {
        if quantity == Quantity::Frequency && panel.x.contains(divergence.speed) {
            let text = format!("{} m/s, divergence", three_digits(divergence.speed));
            marked.push((panel.at(divergence.speed, 0.0), text));
        }
    }
    let mut labels = Labels::new(panel.area, curves);
    let rings: Vec<[f64; 2]> = marked.iter().map(|(at, _)| *at).collect();
    labels.keep_free(&rings);
    for (at, text) in &marked {
        labels.place(svg, *at, text);
    }
}
