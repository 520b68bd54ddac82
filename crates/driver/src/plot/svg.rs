//! Writes SVG elements; all text is escaped.

use std::fmt::Write;

/// A drawing that grows element by element.
#[derive(Debug)]
pub(super) struct Svg {
    body: String,
    width: f64,
    height: f64,
}

/// Where a text is anchored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text looks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Type {
    pub(super) size: f64,
    pub(super) anchor: Anchor,
    pub(super) colour: &'static str,
    pub(super) is_bold: bool,
}

impl Type {
    pub(super) fn new(size: f64, anchor: Anchor) -> Self {
        Self {
            size,
            anchor,
            colour: INK,
            is_bold: false,
        }
    }
}

/// Colour of text and axes.
pub(super) const INK: &str = "#222222";
/// Colour of grid lines.
pub(super) const GRID: &str = "#e3e3e3";
/// Colour of what is secondary.
pub(super) const GREY: &str = "#777777";

impl Svg {
    pub(super) fn new(width: f64, height: f64) -> Self {
        Self {
            body: String::new(),
            width,
            height,
        }
    }

    fn push(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], colour: &str, width: f64) {
        let (x1, y1, x2, y2) = (px(from[0]), px(from[1]), px(to[0]), px(to[1]));
        self.push(&format!(
            r#"<line x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}" stroke="{colour}" stroke-width="{width}"/>"#
        ));
    }

    pub(super) fn polyline(&mut self, points: &[[f64; 2]], colour: &str, width: f64) {
        let mut list = String::new();
        for [x, y] in points {
            // Writing to a string cannot fail.
            let _ = write!(list, "{},{} ", px(*x), px(*y));
        }
        self.push(&format!(
            r#"<polyline points="{}" fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round" stroke-linecap="round"/>"#,
            list.trim_end()
        ));
    }

    /// A polyline with a pattern of dashes, for example `7 4`; empty: solid.
    pub(super) fn dashed(
        &mut self,
        points: &[[f64; 2]],
        colour: &str,
        width: f64,
        pattern: &str,
    ) {
        let list: Vec<String> = points
            .iter()
            .map(|[x, y]| format!("{},{}", px(*x), px(*y)))
            .collect();
        let dashes = if pattern.is_empty() {
            String::new()
        } else {
            format!(r#" stroke-dasharray="{pattern}""#)
        };
        self.push(&format!(
            r#"<polyline points="{}" fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round"{dashes}/>"#,
            list.join(" ")
        ));
    }

    pub(super) fn polygon(&mut self, points: &[[f64; 2]], fill: &str, stroke: &str) {
        let list: Vec<String> = points
            .iter()
            .map(|[x, y]| format!("{},{}", px(*x), px(*y)))
            .collect();
        self.push(&format!(
            r#"<polygon points="{}" fill="{fill}" stroke="{stroke}" stroke-width="1.2"/>"#,
            list.join(" ")
        ));
    }

    /// Triangles of one colour; a thin border closes the seams between them.
    pub(super) fn triangles(&mut self, triangles: &[[[i32; 2]; 3]], colour: &str) {
        let mut path = String::new();
        for [[x, y], [x1, y1], [x2, y2]] in triangles {
            // Writing to a string cannot fail.
            let _ = write!(path, "M{x} {y}L{x1} {y1} {x2} {y2}z");
        }
        self.push(&format!(
            r#"<path d="{path}" fill="{colour}" stroke="{colour}" stroke-width="0.6"/>"#
        ));
    }

    /// Triangles with borders, corners in units of `unit` pixels.
    pub(super) fn outlined_triangles(
        &mut self,
        triangles: &[[[i32; 2]; 3]],
        unit: f64,
        fill: &str,
        stroke: &str,
        width: f64,
    ) {
        let mut path = String::new();
        for [[x, y], [x1, y1], [x2, y2]] in triangles {
            // Relative steps are shorter; writing to a string cannot fail.
            let _ = write!(
                path,
                "M{x} {y}l{} {} {} {}z",
                x1 - x,
                y1 - y,
                x2 - x1,
                y2 - y1
            );
        }
        self.push(&format!(
            r#"<path transform="scale({unit})" d="{path}" fill="{fill}" stroke="{stroke}" stroke-width="{}" stroke-linejoin="round"/>"#,
            width / unit
        ));
    }

    /// Diagonal crosses, all in one path.
    pub(super) fn crosses(
        &mut self,
        centres: &[[f64; 2]],
        half: f64,
        colour: &str,
        width: f64,
    ) {
        if centres.is_empty() {
            return;
        }
        let mut path = String::new();
        let (size, back) = (px(2.0 * half), px(-2.0 * half));
        for [x, y] in centres {
            // Writing to a string cannot fail.
            let _ = write!(
                path,
                "M{} {}l{size} {size}m0 {back}l{back} {size}",
                px(x - half),
                px(y - half)
            );
        }
        self.push(&format!(
            r#"<path d="{path}" fill="none" stroke="{colour}" stroke-width="{width}"/>"#
        ));
    }

    pub(super) fn circle(
        &mut self,
        centre: [f64; 2],
        radius: f64,
        fill: &str,
        stroke: &str,
        width: f64,
    ) {
        let (x, y) = (px(centre[0]), px(centre[1]));
        self.push(&format!(
            r#"<circle cx="{x}" cy="{y}" r="{radius}" fill="{fill}" stroke="{stroke}" stroke-width="{width}"/>"#
        ));
    }

    pub(super) fn rectangle(&mut self, corner: [f64; 2], size: [f64; 2], look: &str) {
        let (x, y, w, h) = (px(corner[0]), px(corner[1]), px(size[0]), px(size[1]));
        self.push(&format!(
            r#"<rect x="{x}" y="{y}" width="{w}" height="{h}" {look}/>"#
        ));
    }

    pub(super) fn text(&mut self, at: [f64; 2], text: &str, look: Type) {
        self.turned_text(at, text, look, 0.0);
    }

    pub(super) fn turned_text(&mut self, at: [f64; 2], text: &str, look: Type, degrees: f64) {
        let (x, y) = (px(at[0]), px(at[1]));
        let anchor = match look.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let weight = if look.is_bold {
            r#" font-weight="bold""#
        } else {
            ""
        };
        let turned = if degrees == 0.0 {
            String::new()
        } else {
            format!(r#" transform="rotate({degrees} {x} {y})""#)
        };
        self.push(&format!(
            r#"<text x="{x}" y="{y}" font-size="{}" text-anchor="{anchor}" fill="{}"{weight}{turned}>{}</text>"#,
            look.size,
            look.colour,
            escape(text)
        ));
    }

    /// Opens a group that is clipped to a rectangle; close it with
    /// [`close`](Self::close).
    pub(super) fn open_clip(&mut self, name: &str, corner: [f64; 2], size: [f64; 2]) {
        self.push(&format!(
            r#"<clipPath id="{name}"><rect x="{}" y="{}" width="{}" height="{}"/></clipPath><g clip-path="url(#{name})">"#,
            px(corner[0]),
            px(corner[1]),
            px(size[0]),
            px(size[1])
        ));
    }

    pub(super) fn close(&mut self) {
        self.push("</g>");
    }

    /// The whole file.
    pub(super) fn finish(self) -> String {
        let (width, height) = (self.width, self.height);
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
             <svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" \
             font-family=\"DejaVu Sans, Verdana, Helvetica, Arial, sans-serif\">\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            self.body
        )
    }
}

/// A coordinate with a hundredth of a pixel; deterministic and short.
fn px(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

/// Text that cannot be taken for markup.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&apos;"),
            control if control.is_control() => escaped.push(' '),
            other => escaped.push(other),
        }
    }
    escaped
}

/// Width of a text in pixels, estimated from the mean advance of sans-serif
/// letters (0.56 of the size; digits take more, points less).
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    0.56 * size * text.chars().count() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_names_stays_text() {
        let mut svg = Svg::new(10.0, 10.0);
        svg.text(
            [0.0, 0.0],
            "<script>&\"\u{1}",
            Type::new(10.0, Anchor::Start),
        );
        let text = svg.finish();
        assert!(text.contains("&lt;script&gt;&amp;&quot; </text>"), "{text}");
    }

    #[test]
    fn coordinates_are_short() {
        assert_eq!([px(1.0), px(1.256), px(-0.001)], ["1", "1.26", "0"]);
    }
}
