//! Bodies inside other bodies.
//!
//! A point is inside a closed surface when the surface subtends 4π at it:
//!
//! $$ \tan\frac{\Omega}{2} = \frac{\mathbf a\cdot(\mathbf b\times\mathbf c)}
//!    {abc + (\mathbf a\cdot\mathbf b)c + (\mathbf b\cdot\mathbf c)a + (\mathbf c\cdot\mathbf a)b} $$
//!
//! Van Oosterom & Strackee (1983), eq. (8).

use std::f64::consts::PI;

use super::fault::{counted, short};
use super::{Body, Code, Element, Fault, Settings, Surface};
use crate::Vec3;

/// Raises `nested_bodies`; bodies that cross are the crossing check's matter.
pub(super) fn check(
    surface: &Surface,
    bodies: &[Body],
    settings: Settings,
    faults: &mut Vec<Fault>,
) {
    let closed: Vec<Shell> = (0..)
        .zip(bodies)
        .filter_map(|(number, body)| {
            Some(Shell::new(surface, number, body, body.volume?, settings))
        })
        .collect();
    let mut nested = Vec::new();
    for outer in &closed {
        for inner in closed.iter().filter(|inner| outer.surrounds(inner)) {
            nested.push((outer, inner));
        }
    }
    let Some(&(outer, inner)) = nested.first() else {
        return;
    };
    let what = format!(
        "{} inside another, the first of {} m³ in one of {} m³",
        counted(nested.len(), "body", "bodies"),
        short(inner.volume),
        short(outer.volume)
    );
    let elements = nested
        .iter()
        .map(|(o, i)| Element::BodyPair([o.number, i.number]))
        .collect();
    let why = "the inner one feels no stream and only costs time";
    let fault = Fault::new(Code::NestedBodies, what, why, "remove the inner body");
    faults.push(fault.at(elements, |k| Some(nested[k].1.point)));
}

/// A closed body with its box.
struct Shell<'a> {
    surface: &'a Surface,
    number: u32,
    triangles: Vec<usize>,
    volume: f64,
    low: Vec3,
    high: Vec3,
    /// One of its vertices.
    point: Vec3,
    is_half: bool,
}

impl<'a> Shell<'a> {
    fn new(
        surface: &'a Surface,
        number: u32,
        body: &Body,
        volume: f64,
        settings: Settings,
    ) -> Self {
        let triangles: Vec<usize> = body
            .triangles
            .iter()
            .map(|t| {
                surface
                    .triangle
                    .binary_search(t)
                    .expect("bodies are made of these triangles")
            })
            .collect();
        let point = surface.mesh.corners(triangles[0])[0];
        let (mut low, mut high) = (point, point);
        for p in triangles.iter().flat_map(|&t| surface.mesh.corners(t)) {
            (low, high) = (low.inf(&p), high.sup(&p));
        }
        if settings.symmetry_plane {
            low.y = low.y.min(-high.y);
        }
        let is_half = settings.symmetry_plane;
        Self {
            surface,
            number,
            triangles,
            volume,
            low,
            high,
            point,
            is_half,
        }
    }

    fn surrounds(&self, other: &Shell) -> bool {
        let is_larger =
            (0..3).all(|k| self.low[k] <= other.low[k] && other.high[k] <= self.high[k]);
        self.number != other.number && is_larger && self.solid_angle(other.point) > 2.0 * PI
    }

    /// Solid angle at a point, of the whole body also when half is given: the
    /// mirror image subtends there what the half subtends at the image point.
    fn solid_angle(&self, p: Vec3) -> f64 {
        let of_half = |p: Vec3| -> f64 {
            self.triangles
                .iter()
                .map(|&t| subtended(self.surface.mesh.corners(t).map(|q| q - p)))
                .sum()
        };
        if self.is_half {
            of_half(p) + of_half(Vec3::new(p.x, -p.y, p.z))
        } else {
            of_half(p)
        }
    }
}

/// Solid angle of a triangle at the origin; 0 where the origin is a corner.
fn subtended([a, b, c]: [Vec3; 3]) -> f64 {
    let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
    let base = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
    2.0 * a.dot(&b.cross(&c)).atan2(base)
}
