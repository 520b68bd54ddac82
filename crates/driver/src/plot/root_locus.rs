//! Roots in the plane of reduced damping and reduced frequency.

use super::axis::Axis;
use super::label::Labels;
use super::layout::{LEFT, TOP, WIDTH, footer, heading, legend, marker_stride, right_edge};
use super::panel::Panel;
use super::style::{Styles, crosses};
use super::svg::{Anchor, GREY, Svg, Type};
use super::{MethodResult, Subject};
use crate::figures::three_digits;
use fladder_stability::Branch;

const HEIGHT: f64 = 780.0;

/// The root locus: $g = \sigma b/U$ to the right, $k = \omega b/U$ upward.
///
/// Lines are the refined roots (or p2, or p-k, whichever is the best that was
/// computed), crosses p-k beside them; a large marker is the highest speed.
pub fn root_locus(subject: &Subject<'_>) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT);
    let Some((lines, method)) = subject.lines() else {
        heading(&mut svg, subject, "root locus", "no roots");
        return svg.finish();
    };
    heading(&mut svg, subject, "root locus", method);
    let panel = panel(lines);
    panel.draw_axes(&mut svg);
    growing_side(&mut svg, &panel);
    let styles = Styles::of(lines.branches.iter().map(|branch| branch.name.as_str()));
    let [left, top, width, height] = panel.area;
    svg.open_clip("locus", [left, top], [width, height]);
    let mut curves = Vec::new();
    for branch in &lines.branches {
        curves.extend(draw_branch(&mut svg, &panel, branch, &styles));
    }
    for branch in subject.crosses().iter().flat_map(|pk| &pk.branches) {
        let colour = styles.get(&branch.name).map_or(GREY, |style| style.colour);
        let points = branch.g.iter().zip(&branch.k).step_by(2);
        let places: Vec<[f64; 2]> = points.map(|(g, k)| panel.at(*g, *k)).collect();
        crosses(&mut svg, &places, colour);
    }
    svg.close();
    crossings(&mut svg, &panel, lines, &curves);
    legend(
        &mut svg,
        lines,
        &styles,
        subject.crosses().is_some(),
        HEIGHT,
    );
    footer(
        &mut svg,
        HEIGHT,
        "g > 0 grows. Markers are spread over each branch, the large one is its highest speed. \
         Rings: crossings into growth.",
    );
    svg.finish()
}

fn panel(lines: &MethodResult) -> Panel<'static> {
    let (mut g, mut k) = ([-0.01f64, 0.01f64], 0.05f64);
    for branch in &lines.branches {
        for (damping, frequency) in branch.g.iter().zip(&branch.k) {
            g = [g[0].min(*damping), g[1].max(*damping)];
            k = k.max(*frequency);
        }
    }
    let margin = 0.04 * (g[1] - g[0]);
    Panel {
        area: [LEFT, TOP, right_edge(lines) - LEFT, HEIGHT - TOP - 88.0],
        x: Axis::covering(g[0] - margin, g[1] + margin, 8),
        y: Axis::exact(-0.03 * k, 1.05 * k, 8),
        x_label: "reduced damping  g = σb/U  [–]",
        y_label: "reduced frequency  k = ωb/U  [–]",
    }
}

fn growing_side(svg: &mut Svg, panel: &Panel<'_>) {
    let [x, _] = panel.at(0.0, 0.0);
    let y = panel.area[1] - 4.0;
    let look = |anchor| Type {
        colour: GREY,
        ..Type::new(11.0, anchor)
    };
    svg.text([x - 6.0, y], "decays", look(Anchor::End));
    svg.text([x + 6.0, y], "grows", look(Anchor::Start));
}

fn draw_branch(
    svg: &mut Svg,
    panel: &Panel<'_>,
    branch: &Branch,
    styles: &Styles,
) -> Vec<[f64; 2]> {
    let points: Vec<[f64; 2]> = branch
        .g
        .iter()
        .zip(&branch.k)
        .map(|(g, k)| panel.at(*g, *k))
        .collect();
    let (Some(style), Some(last)) = (styles.get(&branch.name), points.last()) else {
        return points;
    };
    svg.polyline(&points, style.colour, 1.8);
    for point in points.iter().step_by(marker_stride(points.len())) {
        style.mark(svg, *point, 3.2);
    }
    style.mark(svg, *last, 5.2);
    points
}

fn crossings(svg: &mut Svg, panel: &Panel<'_>, lines: &MethodResult, curves: &[[f64; 2]]) {
    let mut marked: Vec<([f64; 2], String)> = Vec::new();
    for crossing in &lines.flutter {
        let text = format!(
            "{} m/s, {} Hz",
            three_digits(crossing.speed),
            three_digits(crossing.frequency_hz)
        );
        marked.push((panel.at(0.0, crossing.k), text));
    }
    for divergence in &lines.divergence {
        marked.push((
            panel.at(0.0, 0.0),
            format!("{} m/s, divergence", three_digits(divergence.speed)),
        ));
    }
    let mut labels = Labels::new(panel.area, curves);
    let rings: Vec<[f64; 2]> = marked.iter().map(|(at, _)| *at).collect();
    labels.keep_free(&rings);
    for (at, text) in &marked {
        labels.place(svg, *at, text);
    }
}
