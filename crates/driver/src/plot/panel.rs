//! One diagram: axes, grid, and the map from values to pixels.

use super::axis::Axis;
use super::svg::{Anchor, GREY, GRID, INK, Svg, Type};

/// Rectangle of a diagram with its two axes.
#[derive(Clone, Debug)]
pub(super) struct Panel<'a> {
    /// Left, top, width, height in pixels.
    pub(super) area: [f64; 4],
    pub(super) x: Axis,
    pub(super) y: Axis,
    pub(super) x_label: &'a str,
    pub(super) y_label: &'a str,
}

const TICK_SIZE: f64 = 12.0;
const LABEL_SIZE: f64 = 14.0;

impl Panel<'_> {
    /// Pixel of a pair of values.
    pub(super) fn at(&self, x: f64, y: f64) -> [f64; 2] {
        let [left, top, width, height] = self.area;
        [
            left + width * self.x.fraction(x),
            top + height * (1.0 - self.y.fraction(y)),
        ]
    }

    pub(super) fn contains(&self, x: f64, y: f64) -> bool {
        self.x.contains(x) && self.y.contains(y)
    }

    /// Whether a pixel is on the diagram or within its height of it: lines are
    /// drawn up to there, and not to what lies far outside.
    pub(super) fn reaches(&self, [_, y]: [f64; 2]) -> bool {
        let [_, top, _, height] = self.area;
        (top - height..=top + 2.0 * height).contains(&y)
    }

    /// Grid, ticks, labels and the lines at zero.
    pub(super) fn draw_axes(&self, svg: &mut Svg) {
        let [left, top, width, height] = self.area;
        let (right, bottom) = (left + width, top + height);
        for (value, text) in self.x.ticks() {
            let [x, _] = self.at(value, self.y.from);
            svg.line([x, top], [x, bottom], GRID, 1.0);
            svg.line([x, bottom], [x, bottom + 5.0], INK, 1.0);
            let look = Type::new(TICK_SIZE, Anchor::Middle);
            svg.text([x, bottom + 19.0], &text, look);
        }
        for (value, text) in self.y.ticks() {
            let [_, y] = self.at(self.x.from, value);
            svg.line([left, y], [right, y], GRID, 1.0);
            svg.line([left - 5.0, y], [left, y], INK, 1.0);
            let look = Type::new(TICK_SIZE, Anchor::End);
            svg.text([left - 9.0, y + 4.0], &text, look);
        }
        if self.x.from < 0.0 && self.x.to > 0.0 {
            let [x, _] = self.at(0.0, self.y.from);
            svg.line([x, top], [x, bottom], GREY, 1.5);
        }
        if self.y.from < 0.0 && self.y.to > 0.0 {
            let [_, y] = self.at(self.x.from, 0.0);
            svg.line([left, y], [right, y], GREY, 1.5);
        }
        let frame = format!(r#"fill="none" stroke="{INK}" stroke-width="1""#);
        svg.rectangle([left, top], [width, height], &frame);
        let look = Type::new(LABEL_SIZE, Anchor::Middle);
        svg.text([left + width / 2.0, bottom + 42.0], self.x_label, look);
        svg.turned_text([left - 58.0, top + height / 2.0], self.y_label, look, -90.0);
    }
}
