//! Several diagrams on one sheet with one legend.

use super::axis::Axis;
use super::panel::Panel;
use super::style::{Style, crosses};
use super::svg::{Anchor, GREY, INK, Svg, Type, text_width};

/// How the points of a series are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Joined.
    Line,
    /// Each with the marker of its group.
    Points,
    /// Each as a cross.
    Crosses,
    /// Each as a ring.
    Rings,
    /// Each as a small dot, black where there is no group.
    Dots,
}

/// Points that look alike.
#[derive(Clone, Debug)]
pub struct Series {
    /// How they are drawn.
    pub mark: Mark,
    /// Number of the group, which has a colour, a pattern of dashes and a marker; none:
    /// grey.
    pub group: Option<usize>,
    /// Points; those that are not finite are left out.
    pub points: Vec<[f64; 2]>,
}

/// A diagram.
#[derive(Clone, Debug)]
pub struct Graph {
    /// A line above it.
    pub title: String,
    /// Quantity, symbol and unit of both axes.
    pub labels: [String; 2],
    /// Ends of both axes; none: around the points.
    pub ranges: [Option<[f64; 2]>; 2],
    /// What is drawn.
    pub series: Vec<Series>,
}

/// A sheet of diagrams.
#[derive(Clone, Copy, Debug)]
pub struct Sheet<'a> {
    /// Heading.
    pub title: &'a str,
    /// Remark below.
    pub note: &'a str,
    /// Names of the groups.
    pub groups: &'a [String],
    /// What marks mean.
    pub marks: &'a [(Mark, &'a str)],
    /// Diagrams, row by row.
    pub graphs: &'a [Graph],
}

const WIDTH: f64 = 1000.0;
const COLUMNS: usize = 2;
const LEFT: f64 = 84.0;
const BETWEEN: f64 = 96.0;
const PANEL: [f64; 2] = [390.0, 280.0];
/// Title above and axis below a diagram.
const ROOM: f64 = 88.0;
const LETTERS: f64 = 13.0;
const DASHES: [&str; 6] = ["", "8 4", "2 3", "10 3 2 3", "14 4", "5 2 1 2 1 2"];

/// The sheet as an SVG file, two diagrams a row.
pub fn sheet(picture: &Sheet<'_>) -> String {
    let entries = entries(picture);
    let rows = entries.last().map_or(0, |entry| entry.row + 1);
    let top = 58.0 + 21.0 * rows as f64;
    let notes = wrapped(picture.note, 150);
    let panels = picture.graphs.len().div_ceil(COLUMNS);
    let height = top + panels as f64 * (PANEL[1] + ROOM) + 16.0 * notes.len() as f64 + 8.0;
    let mut svg = Svg::new(WIDTH, height);
    let heading = Type {
        is_bold: true,
        ..Type::new(17.0, Anchor::Start)
    };
    svg.text([20.0, 28.0], picture.title, heading);
    for entry in &entries {
        entry.draw(&mut svg);
    }
    for (number, graph) in picture.graphs.iter().enumerate() {
        let column = (number % COLUMNS) as f64;
        let row = (number / COLUMNS) as f64;
        let corner = [
            LEFT + column * (PANEL[0] + BETWEEN),
            top + 28.0 + row * (PANEL[1] + ROOM),
        ];
        draw(&mut svg, graph, corner, number);
    }
    let grey = Type {
        colour: GREY,
        ..Type::new(12.0, Anchor::Start)
    };
    for (line, text) in notes.iter().enumerate() {
        let above = 16.0 * (notes.len() - line) as f64;
        svg.text([20.0, height - above + 6.0], text, grey);
    }
    svg.finish()
}

/// A place of the legend.
struct Entry<'a> {
    has_marker: bool,
    place: f64,
    row: usize,
    text: &'a str,
    group: Option<usize>,
    mark: Option<Mark>,
}

impl Entry<'_> {
    fn draw(&self, svg: &mut Svg) {
        let y = 52.0 + 21.0 * self.row as f64;
        let middle = [self.place + 15.0, y];
        match (self.group, self.mark) {
            (Some(group), _) => {
                line(svg, &[[self.place, y], [self.place + 30.0, y]], group);
                if self.has_marker {
                    Style::numbered(group).mark(svg, middle, 4.0);
                }
            }
            (None, Some(mark)) => one(svg, middle, mark, None),
            (None, None) => {}
        }
        let look = Type::new(LETTERS, Anchor::Start);
        svg.text([self.place + 37.0, y + 4.5], self.text, look);
    }
}

fn entries<'a>(picture: &Sheet<'a>) -> Vec<Entry<'a>> {
    let groups = picture.groups.iter().enumerate();
    let groups = groups.map(|(number, name)| (name.as_str(), Some(number), None));
    let marks = picture.marks.iter();
    let all = groups.chain(marks.map(|(mark, name)| (*name, None, Some(*mark))));
    let (mut place, mut row) = (20.0, 0);
    let mut entries = Vec::new();
    for (text, group, mark) in all {
        let width = 55.0 + text_width(text, LETTERS);
        if place + width > WIDTH - 10.0 && place > 20.0 {
            (place, row) = (20.0, row + 1);
        }
        entries.push(Entry {
            has_marker: group.is_some_and(|group| has_points(picture, group)),
            place,
            row,
            text,
            group,
            mark,
        });
        place += width;
    }
    entries
}

/// Whether points of a group are drawn with its marker anywhere.
fn has_points(picture: &Sheet<'_>, group: usize) -> bool {
    let mut all = picture.graphs.iter().flat_map(|graph| &graph.series);
    all.any(|series| series.mark == Mark::Points && series.group == Some(group))
}

fn draw(svg: &mut Svg, graph: &Graph, corner: [f64; 2], number: usize) {
    let finite = |point: &&[f64; 2]| point.iter().all(|x| x.is_finite());
    let all = || graph.series.iter().flat_map(|series| &series.points);
    let ends = |axis: usize| {
        graph.ranges[axis].unwrap_or_else(|| {
            let inside = |point: &&[f64; 2]| {
                graph.ranges[1 - axis]
                    .is_none_or(|[low, high]| (low..=high).contains(&point[1 - axis]))
            };
            let points = all().filter(finite).filter(inside);
            let [low, high] = points
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| {
                    [low.min(point[axis]), high.max(point[axis])]
                });
            if low > high {
                return [0.0, 1.0];
            }
            let margin = if axis == 0 { 0.0 } else { 0.06 * (high - low) };
            [low - margin, high + margin]
        })
    };
    let ([left, right], [bottom, top]) = (ends(0), ends(1));
    let panel = Panel {
        area: [corner[0], corner[1], PANEL[0], PANEL[1]],
        x: Axis::exact(left, right, 5),
        y: Axis::exact(bottom, top, 6),
        x_label: &graph.labels[0],
        y_label: &graph.labels[1],
    };
    let look = Type {
        is_bold: true,
        ..Type::new(LETTERS, Anchor::Start)
    };
    svg.text([corner[0], corner[1] - 9.0], &graph.title, look);
    panel.draw_axes(svg);
    svg.open_clip(&format!("panel{number}"), corner, PANEL);
    for series in &graph.series {
        let points: Vec<[f64; 2]> = series
            .points
            .iter()
            .filter(finite)
            .map(|[x, y]| panel.at(*x, *y))
            .collect();
        match (series.mark, series.group) {
            (Mark::Line, Some(group)) => line(svg, &points, group),
            (Mark::Line, None) => svg.polyline(&points, GREY, 1.2),
            (Mark::Crosses, group) => {
                let colour = group.map_or(GREY, |group| Style::numbered(group).colour);
                crosses(svg, &points, colour);
            }
            (mark, group) => points.iter().for_each(|at| one(svg, *at, mark, group)),
        }
    }
    svg.close();
}

fn line(svg: &mut Svg, points: &[[f64; 2]], group: usize) {
    let colour = Style::numbered(group).colour;
    svg.dashed(points, colour, 2.0, DASHES[group % DASHES.len()]);
}

fn one(svg: &mut Svg, at: [f64; 2], mark: Mark, group: Option<usize>) {
    let style = group.map(Style::numbered);
    let colour = style.map_or(GREY, |style| style.colour);
    match (mark, style) {
        (Mark::Points, Some(style)) => style.mark(svg, at, 3.6),
        (Mark::Points, None) => svg.circle(at, 3.6, GREY, GREY, 1.0),
        (Mark::Crosses, _) => crosses(svg, &[at], colour),
        (Mark::Rings, _) => svg.circle(at, 4.2, "none", colour, 1.4),
        (Mark::Dots, None) => svg.circle(at, 1.7, INK, "#ffffff", 0.6),
        (Mark::Dots, Some(_)) => svg.circle(at, 1.5, colour, colour, 0.5),
        (Mark::Line, _) => {
            let [x, y] = at;
            svg.line([x - 15.0, y], [x + 15.0, y], colour, 1.2);
        }
    }
}

/// Lines of at most so many letters, cut between words.
fn wrapped(text: &str, letters: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + word.chars().count() < letters => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph(points: &[[f64; 2]]) -> Graph {
        let marks = [
            Mark::Line,
            Mark::Points,
            Mark::Crosses,
            Mark::Rings,
            Mark::Dots,
        ];
        Graph {
            title: "one <entry>".to_owned(),
            labels: ["k".to_owned(), "Q".to_owned()],
            ranges: [None, None],
            series: marks
                .map(|mark| Series {
                    mark,
                    group: Some(1),
                    points: points.to_vec(),
                })
                .to_vec(),
        }
    }

    #[test]
    fn every_mark_is_drawn_and_what_is_not_finite_is_left_out() {
        let graphs = [
            graph(&[[0.0, 1.0], [f64::NAN, 2.0], [1.0, 3.0]]),
            graph(&[]),
        ];
        let names: Vec<String> = (0..30).map(|n| format!("group {n}")).collect();
        let text = sheet(&Sheet {
            title: "a & b",
            note: "a remark",
            groups: &names,
            marks: &[(Mark::Crosses, "p-k")],
            graphs: &graphs,
        });
        assert!(text.contains("a &amp; b") && text.contains("one &lt;entry&gt;"));
        assert!(!text.contains("NaN") && text.ends_with("</svg>\n"));
        let count = |part: &str| text.matches(part).count();
        assert_eq!(count("<g "), count("</g>"));
        assert_eq!(count("<text"), count("</text>"));
        assert!(text.contains("stroke-dasharray"));
    }
}
