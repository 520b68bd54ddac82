//! Where the cells of wing, bend and winglet lie: round a section, and along the arc.
//!
//! Loads vary fast at leading edges, trailing edges, hinges, ends of controls and tips: cells
//! are small there and grow away from them. With one cell from a rudder's end to the tip the
//! yawing moment of sideslip is 5 % off. What this comes to is the table of refinement in
//! docs/validation.md.

use libm::cos;

use super::params::Parameters;
use super::wing::Wing;

/// Share of the cells of a section that lie aft of the hinge.
const AFT_SHARE: f64 = 0.42;

/// Part of cosine spacing, which closes up at both ends of a stretch; the rest is even.
const COSINE_PART: f64 = 0.9;

/// Lengths of cells in steps: along the wing, over the bend, along the winglet.
const STEPS: [f64; 3] = [1.0, 0.4, 0.7];

/// Lengths in steps of the cells beside the end of a control and at the tip.
const STEPS_AT_CONTROL: f64 = 0.2;
const STEPS_AT_TIP: f64 = 0.06;

/// How much longer cells become per length away from such a place.
const GROWTH: f64 = 0.8;

/// Points of the sum over 1/length in a stretch.
const POINTS: usize = 2000;

/// Places round a section: along the chord, and 1 above, −1 below, 0 at the edges.
pub(super) struct Ring {
    pub(super) place: Vec<f64>,
    pub(super) side: Vec<f64>,
}

impl Ring {
    /// `cells` on each side, with a place on the hinge line.
    pub(super) fn new(cells: usize, hinge: f64) -> Self {
        let aft = ((cells as f64 * AFT_SHARE).round_ties_even() as usize).max(2);
        let fore = cells - aft;
        let spread = |i: usize, count: usize| {
            let t = i as f64 / count as f64;
            COSINE_PART * 0.5 * (1.0 - cos(std::f64::consts::PI * t)) + (1.0 - COSINE_PART) * t
        };
        let towards_hinge = (0..=fore).map(|i| hinge * spread(i, fore));
        let towards_tail = (1..=aft).map(|i| hinge + (1.0 - hinge) * spread(i, aft));
        let chord: Vec<f64> = towards_hinge.chain(towards_tail).collect();
        let below = chord.iter().rev().copied();
        let above = chord[1..cells].iter().copied();
        let mut side = vec![-1.0; cells];
        side[0] = 0.0;
        side.push(0.0);
        side.resize(2 * cells, 1.0);
        Self {
            place: below.chain(above).collect(),
            side,
        }
    }

    pub(super) fn len(&self) -> usize {
        self.place.len()
    }
}

/// Arc lengths of plane sections, with one narrow cell at each end of a control.
pub(super) fn sections(parameters: &Parameters, wing: &Wing<'_>, step: f64) -> Vec<f64> {
    let gap = parameters.controls.gap / 2.0;
    let [begin, end, tip] = wing.marks;
    let [[e0, e1], [r0, r1]] = [parameters.controls.elevon, wing.rudder()];
    let ends = [e0, e1, r0, r1].map(|at| (at, STEPS_AT_CONTROL, gap));
    let small = ends.into_iter().chain([(tip, STEPS_AT_TIP, 0.0)]);
    let length = |s: f64| {
        let part = [begin, end].iter().filter(|mark| s >= **mark).count();
        let grown = |(at, own, clear): (f64, f64, f64)| {
            own * step + GROWTH * ((s - at).abs() - clear).max(0.0)
        };
        small.clone().map(grown).fold(STEPS[part] * step, f64::min)
    };
    let mut out = vec![parameters.junction.blend_to];
    let mut stretch = |to: f64, is_gap: bool| {
        let from = out[out.len() - 1];
        if is_gap {
            out.push(to);
        } else {
            out.extend(divided(from, to, length));
        }
    };
    for at in [e0, e1] {
        stretch(at - gap, false);
        stretch(at + gap, true);
    }
    stretch(begin, false);
    stretch(end, false);
    for at in [r0, r1] {
        stretch(at - gap, false);
        stretch(at + gap, true);
    }
    stretch(tip, false);
    out
}

/// Ends of cells between two places, of lengths that go as the given ones.
fn divided(from: f64, to: f64, length: impl Fn(f64) -> f64) -> Vec<f64> {
    let width = (to - from) / POINTS as f64;
    let mut passed = vec![0.0];
    for i in 0..POINTS {
        passed.push(passed[i] + width / length(from + width * (i as f64 + 0.5)));
    }
    let cells = (passed[POINTS].round_ties_even() as usize).max(1);
    let inner = (1..cells).map(|cell| {
        let wanted = passed[POINTS] * cell as f64 / cells as f64;
        let next = passed.partition_point(|sum| *sum < wanted);
        let part = (wanted - passed[next - 1]) / (passed[next] - passed[next - 1]);
        from + width * ((next - 1) as f64 + part)
    });
    inner.chain([to]).collect()
}
