//! Where lines of elements run: stations along the wing and rings of the fuselage.

use std::f64::consts::FRAC_PI_2;

use super::table::Table;
use crate::scaneagle::body::Body;
use crate::scaneagle::params::Parameters;
use crate::scaneagle::wing::Wing;

/// Angles round the starboard half of the fuselage: six elements.
const AROUND: usize = 6;
/// Stations closer than this are one, m.
pub(super) const SAME: f64 = 1e-9;

/// A control surface and its place.
#[derive(Clone, Debug)]
pub(super) struct ControlFrame {
    /// Its name in the table.
    pub(super) name: &'static str,
    /// First letter of its element sets: W for the wing, L for the winglet.
    pub(super) letter: char,
    /// Ends by arc length.
    pub(super) ends: [f64; 2],
    /// Hinges by arc length.
    pub(super) hinges: Vec<f64>,
}

/// All lines.
pub(super) struct Frame<'a> {
    pub(super) wing: Wing<'a>,
    pub(super) body: Body,
    /// Stations of the wing, of bend and winglet.
    pub(super) stations: [Vec<f64>; 2],
    pub(super) controls: [ControlFrame; 2],
    /// Part of the chord at which they are hinged.
    pub(super) hinge: f64,
    /// Rings of the fuselage, by x.
    pub(super) rings: Vec<f64>,
    /// x at which front and rear spar go through the side of the body.
    pub(super) spars: [f64; 2],
    pub(super) angles: Vec<f64>,
}

impl<'a> Frame<'a> {
    /// # Errors
    /// Stations that do not ascend from the root to the elevon.
    pub(super) fn new(parameters: &'a Parameters, table: &Table) -> Result<Self, String> {
        let (wing, body) = (Wing::new(parameters), Body::new(&parameters.fuselage));
        let control = |name, letter, ends: [f64; 2]| {
            let at = |part: &f64| ends[0] + part * (ends[1] - ends[0]);
            ControlFrame {
                name,
                letter,
                ends,
                hinges: table.hinges.stations.iter().map(at).collect(),
            }
        };
        let controls = [
            control("elevon", 'W', parameters.controls.elevon),
            control("rudder", 'L', wing.rudder()),
        ];
        let [begin, end, tip] = wing.marks;
        let places = &table.places;
        let mut inner = vec![0.0];
        inner.extend(&places.stations);
        inner.push(controls[0].ends[0]);
        // Between the hinges of the elevon one more line.
        for (i, hinge) in controls[0].hinges.iter().enumerate() {
            if i > 0 {
                inner.push(f64::midpoint(controls[0].hinges[i - 1], *hinge));
            }
            inner.push(*hinge);
        }
        inner.extend([controls[0].ends[1], begin]);
        let mut outer = vec![begin, f64::midpoint(begin, end), end, controls[1].ends[0]];
        outer.extend(&controls[1].hinges);
        outer.extend([controls[1].ends[1], tip]);
        for stations in [&inner, &outer] {
            if stations.windows(2).any(|pair| pair[1] - pair[0] < SAME) {
                return Err(format!("places.stations: {stations:?} must ascend"));
            }
        }
        let spars = [places.front_spar, places.rear_spar]
            .map(|place| wing.point(place, 0.0, parameters.fuselage.radius).x);
        let rings = rings(table, &spars);
        let angles = (0..=AROUND)
            .map(|i| FRAC_PI_2 * (2.0 * i as f64 / AROUND as f64 - 1.0))
            .collect();
        Ok(Self {
            wing,
            body,
            stations: [inner, outer],
            controls,
            hinge: parameters.controls.hinge,
            rings,
            spars,
            angles,
        })
    }
}

/// Stations that must be rings, and even ones between.
fn rings(table: &Table, spars: &[f64; 2]) -> Vec<f64> {
    let shell = &table.fuselage;
    let mut fixed = vec![shell.nose, shell.tail];
    fixed.extend(&shell.bulkheads);
    fixed.extend(spars);
    fixed.extend(table.zone.iter().flat_map(|zone| [zone.from, zone.to]));
    fixed.sort_by(f64::total_cmp);
    fixed.dedup_by(|a, b| (*a - *b).abs() < SAME);
    let mut rings = vec![fixed[0]];
    for pair in fixed.windows(2) {
        let parts = ((pair[1] - pair[0]) / shell.step - SAME).ceil().max(1.0);
        let inner = (1..parts as usize).map(|i| i as f64 / parts);
        rings.extend(inner.map(|part| pair[0] + part * (pair[1] - pair[0])));
        rings.push(pair[1]);
    }
    rings
}
