//! Labels of crossings, placed where they hide neither each other nor a ring.

use super::svg::{Anchor, INK, Svg, Type, text_width};

const SIZE: f64 = 12.0;
const HEIGHT: f64 = 16.0;
const RING: f64 = 7.0;

/// Rectangle in pixels: left, top, right, bottom.
type Box4 = [f64; 4];

/// Rings and labels of one diagram.
#[derive(Debug)]
pub(super) struct Labels {
    bounds: Box4,
    taken: Vec<Box4>,
}

impl Labels {
    /// `area` is left, top, width, height; `curves` are pixels that labels
    /// should not cover.
    pub(super) fn new(area: [f64; 4], curves: &[[f64; 2]]) -> Self {
        let [left, top, width, height] = area;
        let near = |[x, y]: &[f64; 2]| [x - 2.0, y - 2.0, x + 2.0, y + 2.0];
        Self {
            bounds: [left, top, left + width, top + height],
            taken: curves.iter().map(near).collect(),
        }
    }

    /// Keeps the rings free before labels are placed.
    pub(super) fn keep_free(&mut self, rings: &[[f64; 2]]) {
        let around = |[x, y]: &[f64; 2]| [x - RING, y - RING, x + RING, y + RING];
        self.taken.extend(rings.iter().map(around));
    }

    /// Rings a point and writes beside it, with a line to the text when that
    /// had to move away.
    pub(super) fn place(&mut self, svg: &mut Svg, at: [f64; 2], text: &str) {
        svg.circle(at, RING, "none", INK, 1.8);
        let width = text_width(text, SIZE);
        let place = self.best_place(at, width);
        self.taken.push(place);
        let [left, top, _, bottom] = place;
        let centre = [left + width / 2.0, f64::midpoint(top, bottom)];
        let (dx, dy) = (centre[0] - at[0], centre[1] - at[1]);
        if dy.abs() > 2.0 * HEIGHT {
            let end = if dy > 0.0 { top } else { bottom };
            let direction = dx.hypot(dy).max(1.0);
            let start = [at[0] + RING * dx / direction, at[1] + RING * dy / direction];
            svg.line(start, [centre[0], end], INK, 0.7);
        }
        let look = r##"fill="#ffffff" fill-opacity="0.8""##;
        svg.rectangle([left - 2.0, top], [width + 4.0, HEIGHT], look);
        svg.text([left, bottom - 4.0], text, Type::new(SIZE, Anchor::Start));
    }

    /// The place nearest to the ring that covers least.
    fn best_place(&self, at: [f64; 2], width: f64) -> Box4 {
        const GAP: f64 = RING + 5.0;
        let mut best = ([0.0; 4], f64::INFINITY);
        for level in 0..12i32 {
            for sign in [-1.0, 1.0] {
                for left in [at[0] + GAP, at[0] - GAP - width, at[0] - width / 2.0] {
                    let middle = at[1] + sign * 1.25 * HEIGHT * f64::from(level);
                    let candidate = [
                        left,
                        middle - HEIGHT / 2.0,
                        left + width,
                        middle + HEIGHT / 2.0,
                    ];
                    let cost = self.covered(candidate) + 0.4 * f64::from(level);
                    if cost < best.1 {
                        best = (candidate, cost);
                    }
                }
            }
        }
        best.0
    }

    fn covered(&self, place: Box4) -> f64 {
        let inside = place[0] > self.bounds[0] + 4.0
            && place[2] < self.bounds[2] - 4.0
            && place[1] > self.bounds[1] + 2.0
            && place[3] < self.bounds[3] - 2.0;
        let outside = if inside { 0.0 } else { 1000.0 };
        let overlaps = |other: &&Box4| {
            place[0] < other[2]
                && other[0] < place[2]
                && place[1] < other[3]
                && other[1] < place[3]
        };
        let weight = |other: &Box4| {
            if other[2] - other[0] > 5.0 {
                50.0
            } else {
                0.25
            }
        };
        outside + self.taken.iter().filter(overlaps).map(weight).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_one_point_do_not_cover_each_other() {
        let mut labels = Labels::new([0.0, 0.0, 600.0, 400.0], &[]);
        let mut svg = Svg::new(600.0, 400.0);
        labels.keep_free(&[[300.0, 200.0]]);
        (0..5).for_each(|_| labels.place(&mut svg, [300.0, 200.0], "46.4 m/s, 56.0 Hz"));
        let placed = &labels.taken[1..];
        for (i, a) in placed.iter().enumerate() {
            assert!(a[0] > 0.0 && a[2] < 600.0);
            for b in &placed[i + 1..] {
                let apart = a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
                assert!(apart, "{a:?} covers {b:?}");
            }
        }
    }
}
