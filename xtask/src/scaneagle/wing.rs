//! Wing, bend and winglet: sections along an arc.
//!
//! Sections are NACA four-digit ones with a closed trailing edge, placed along a spine that is
//! straight, bends by the cant angle over an arc, and goes on straight.
//! Functions of `libm` give the same bits on every machine.

use fladder_mesh::Vec3;
use libm::{cos, sin, sqrt, tan};

use super::params::Parameters;

/// The starboard wing.
pub(super) struct Wing<'a> {
    parameters: &'a Parameters,
    cant: f64,
    /// Arc length at the begin of the bend, its end, and the tip.
    pub(super) marks: [f64; 3],
}

impl<'a> Wing<'a> {
    pub(super) fn new(parameters: &'a Parameters) -> Self {
        let (bend, winglet) = (&parameters.bend, &parameters.winglet);
        let cant = bend.cant_deg.to_radians();
        let begin =
            parameters.wing.span / 2.0 - bend.radius * sin(cant) - winglet.length * cos(cant);
        let end = begin + bend.radius * cant;
        Self {
            parameters,
            cant,
            marks: [begin, end, end + winglet.length],
        }
    }

    /// Ends of the rudder by arc length.
    pub(super) fn rudder(&self) -> [f64; 2] {
        let length = self.parameters.winglet.length;
        self.parameters
            .controls
            .rudder
            .map(|part| self.marks[1] + part * length)
    }

    /// A quantity given at the root and at the three marks, linear between.
    fn along(&self, s: f64, values: [f64; 4]) -> f64 {
        let [a, b, c] = self.marks;
        let stations = [0.0, a, b, c];
        let start = (0..2)
            .rev()
            .find(|&i| s >= stations[i + 1])
            .map_or(0, |i| i + 1);
        let part = (s - stations[start]) / (stations[start + 1] - stations[start]);
        values[start] + part.clamp(0.0, 1.0) * (values[start + 1] - values[start])
    }

    fn chord(&self, s: f64) -> f64 {
        let (wing, bend) = (&self.parameters.wing, &self.parameters.bend);
        let end = wing.tip_chord * bend.chord_ratio;
        let tip = self.parameters.winglet.tip_chord;
        self.along(s, [wing.root_chord, wing.tip_chord, end, tip])
    }

    /// Place of the spine in the plane across the stream, and its dihedral.
    fn spine(&self, s: f64) -> (f64, f64, f64) {
        let [begin, end, _] = self.marks;
        let radius = self.parameters.bend.radius;
        let angle = ((s - begin) / radius).clamp(0.0, self.cant);
        let beyond = (s - end).max(0.0);
        (
            s.min(begin) + radius * sin(angle) + beyond * cos(self.cant),
            radius * (1.0 - cos(angle)) + beyond * sin(self.cant),
            angle,
        )
    }

    /// x of the leading edge; over the bend its slope changes evenly.
    fn leading_edge(&self, s: f64) -> f64 {
        let wing = &self.parameters.wing;
        let [begin, end, _] = self.marks;
        let quarter = tan(wing.sweep_quarter_deg.to_radians());
        let inner = s.min(begin);
        let straight = wing.leading_edge + 0.25 * wing.root_chord + inner * quarter
            - 0.25 * self.chord(inner);
        let slope = quarter + 0.25 * (wing.root_chord - wing.tip_chord) / begin;
        let last = tan(self.parameters.winglet.sweep_leading_deg.to_radians());
        let (length, on_bend) = (end - begin, (s - begin).clamp(0.0, end - begin));
        straight
            + slope * on_bend
            + (last - slope) * on_bend * on_bend / (2.0 * length)
            + last * (s - end).max(0.0)
    }

    /// Height of a section over its chord: `side` 1 above, −1 below, 0 the mean line.
    fn height(&self, place: f64, side: f64, s: f64) -> f64 {
        let wing = &self.parameters.wing;
        let thickness = self.along(
            s,
            [
                wing.thickness_root,
                wing.thickness_tip,
                wing.thickness_tip,
                self.parameters.winglet.thickness,
            ],
        );
        let camber = self.along(s, [wing.camber, wing.camber, 0.0, 0.0]);
        let x = place;
        let half = 5.0
            * thickness
            * (0.2969 * sqrt(x) + x * (-0.1260 + x * (-0.3516 + x * (0.2843 - 0.1036 * x))));
        let m = wing.camber_place;
        let mean = if x < m {
            camber / (m * m) * x * (2.0 * m - x)
        } else {
            camber / ((1.0 - m) * (1.0 - m)) * (1.0 - 2.0 * m + x * (2.0 * m - x))
        };
        mean + side * half
    }

    /// A point of the surface, twisted about its quarter chord.
    pub(super) fn point(&self, place: f64, side: f64, s: f64) -> Vec3 {
        let height = self.height(place, side, s);
        let tip = self.parameters.wing.twist_tip_deg.to_radians();
        let twist = self.along(s, [0.0, tip, tip * self.parameters.bend.twist_ratio, 0.0]);
        let (sine, cosine) = (sin(twist), cos(twist));
        let chord = self.chord(s);
        let along = 0.25 + (place - 0.25) * cosine + height * sine;
        let normal = height * cosine - (place - 0.25) * sine;
        let (y, z, angle) = self.spine(s);
        Vec3::new(
            self.leading_edge(s) + chord * along,
            y - chord * normal * sin(angle),
            z + chord * normal * cos(angle),
        )
    }
}
