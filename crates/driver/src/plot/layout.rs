//! Heading, legend and footer common to both pictures.

use super::style::{Styles, crosses};
use super::svg::{Anchor, GREY, Svg, Type, text_width};
use super::{MethodResult, Subject};

/// Width of both pictures in pixels.
pub(super) const WIDTH: f64 = 1000.0;
/// Left edge of the diagrams.
pub(super) const LEFT: f64 = 84.0;
/// Top of the first diagram.
pub(super) const TOP: f64 = 70.0;
const LEGEND_ROW: f64 = 17.0;
const LEGEND_SIZE: f64 = 12.0;
/// Longer names are cut in the legend.
const LONGEST_NAME: usize = 24;

/// Heading and conditions.
pub(super) fn heading(svg: &mut Svg, subject: &Subject<'_>, what: &str, method: &str) {
    let title = match subject.title {
        "" => what.to_owned(),
        title => format!("{title}: {what}"),
    };
    // The heading shrinks so that a long title stays on the sheet.
    let size = (18.0 * 960.0 / text_width(&title, 18.0)).clamp(9.0, 18.0);
    svg.text(
        [20.0, 30.0],
        &title,
        Type {
            is_bold: true,
            ..Type::new(size, Anchor::Start)
        },
    );
    let line = format!("{method}; {}", subject.conditions);
    svg.text(
        [20.0, 52.0],
        &line,
        Type {
            colour: GREY,
            ..Type::new(12.0, Anchor::Start)
        },
    );
}

/// Right edge of the diagrams, which leaves room for the legend.
pub(super) fn right_edge(lines: &MethodResult) -> f64 {
    let longest = lines
        .branches
        .iter()
        .map(|b| shortened(&b.name).chars().count())
        .max();
    let width = text_width(&"x".repeat(longest.unwrap_or(0).max(14)), LEGEND_SIZE);
    WIDTH - width - 62.0
}

/// Names beside the diagrams, each with its line and marker.
pub(super) fn legend(
    svg: &mut Svg,
    lines: &MethodResult,
    styles: &Styles,
    has_crosses: bool,
    height: f64,
) {
    let left = right_edge(lines) + 18.0;
    let room = ((height - TOP - 60.0) / LEGEND_ROW) as usize;
    let shown = lines.branches.len().min(room);
    let mut y = TOP + 8.0;
    for branch in &lines.branches[..shown] {
        let Some(style) = styles.get(&branch.name) else {
            continue;
        };
        svg.line([left, y], [left + 26.0, y], style.colour, 1.8);
        style.mark(svg, [left + 13.0, y], 4.0);
        let look = Type::new(LEGEND_SIZE, Anchor::Start);
        svg.text([left + 34.0, y + 4.0], &shortened(&branch.name), look);
        y += LEGEND_ROW;
    }
    let look = Type {
        colour: GREY,
        ..Type::new(LEGEND_SIZE, Anchor::Start)
    };
    let more = lines.branches.len() - shown;
    if more > 0 {
        svg.text([left, y + 4.0], &format!("and {more} more"), look);
        y += LEGEND_ROW;
    }
    if has_crosses {
        crosses(svg, &[[left + 13.0, y + 4.0]], GREY);
        svg.text([left + 34.0, y + 8.0], "p-k", look);
    }
}

fn shortened(name: &str) -> String {
    if name.chars().count() <= LONGEST_NAME {
        return name.to_owned();
    }
    let start: String = name.chars().take(LONGEST_NAME - 1).collect();
    format!("{start}…")
}

/// Remarks under the diagrams.
pub(super) fn footer(svg: &mut Svg, height: f64, text: &str) {
    let look = Type {
        colour: GREY,
        ..Type::new(11.0, Anchor::Start)
    };
    svg.text([20.0, height - 12.0], text, look);
}

/// Every n-th point gets a marker, so that about this many are on a branch.
pub(super) fn marker_stride(points: usize) -> usize {
    points.div_ceil(8).max(1)
}
