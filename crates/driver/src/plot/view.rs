//! From where surfaces and structures are seen, and where that lies on the page.

use super::svg::{Anchor, GREY, Svg, Type};
use fladder_mesh::Vec3;

pub(super) const WIDTH: f64 = 900.0;
pub(super) const HEIGHT: f64 = 560.0;
pub(super) const MARGIN: f64 = 30.0;
const TOP: f64 = 74.0;
const BOTTOM: f64 = 46.0;

/// To the eye, from the middle of the surface.
const EYE: [f64; 3] = [-0.62, -0.42, 0.66];

/// From where light falls, in the axes of the picture: right, up, to the eye.
pub(super) const LIGHT: [f64; 3] = [-0.35, 0.5, 0.79];

/// Axes of the picture.
pub(super) struct View {
    right: Vec3,
    up: Vec3,
    eye: Vec3,
}

impl View {
    pub(super) fn new() -> Self {
        let eye = Vec3::from(EYE).normalize();
        let right = Vec3::z().cross(&eye).normalize();
        Self {
            right,
            up: eye.cross(&right),
            eye,
        }
    }

    /// Right, up, towards the eye.
    pub(super) fn turn(&self, p: &Vec3) -> Vec3 {
        Vec3::new(self.right.dot(p), self.up.dot(p), self.eye.dot(p))
    }
}

/// Where points of the view lie on the page.
pub(super) struct Page {
    scale: f64,
    low: [f64; 2],
    corner: [f64; 2],
}

impl Page {
    pub(super) fn around<'a>(points: impl Iterator<Item = &'a Vec3>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points {
            for k in 0..2 {
                low[k] = low[k].min(point[k]);
                high[k] = high[k].max(point[k]);
            }
        }
        let size = [high[0] - low[0], high[1] - low[1]];
        let room = [WIDTH - 2.0 * MARGIN, HEIGHT - TOP - BOTTOM];
        let scale = (room[0] / size[0]).min(room[1] / size[1]);
        let corner = [
            MARGIN + 0.5 * (room[0] - scale * size[0]),
            HEIGHT - BOTTOM - 0.5 * (room[1] - scale * size[1]),
        ];
        Self { scale, low, corner }
    }

    pub(super) fn place(&self, p: &Vec3) -> [f64; 2] {
        [
            self.corner[0] + self.scale * (p.x - self.low[0]),
            self.corner[1] - self.scale * (p.y - self.low[1]),
        ]
    }
}

/// Title, and a line under it.
pub(super) fn heading(svg: &mut Svg, title: &str, caption: &str) {
    let bold = Type {
        is_bold: true,
        ..Type::new(18.0, Anchor::Start)
    };
    svg.text([MARGIN, 34.0], title, bold);
    let grey = Type {
        colour: GREY,
        ..Type::new(12.0, Anchor::Start)
    };
    svg.text([MARGIN, 56.0], caption, grey);
}
