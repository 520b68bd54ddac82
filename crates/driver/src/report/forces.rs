//! Steady loads, wake jump and samples of $Q$ in words.

use crate::case::CaseFile;
use crate::chain::aircraft::Aircraft;
use crate::chain::conditions;
use crate::chain::own_forces::{Origin, OwnForces};
use crate::figures::fixed;
use crate::gaf_json::Sample;
use crate::memory::bytes_in_words;
use crate::terminal::{Align, Console, Effort, Table};
use fladder_bem::SteadyState;

/// Larger matrices are for files.
const LARGEST_PRINTED: usize = 8;
/// Stations of a trailing edge that are printed.
const PRINTED_STATIONS: usize = 13;

/// Key, cost, and the loads of the steady flow.
pub(crate) fn own_forces(
    console: &Console,
    file: &CaseFile,
    aircraft: &Aircraft,
    forces: &OwnForces,
) {
    let solution = &forces.stored.solution;
    let how = match &forces.origin {
        Origin::Cache => "from the cache".to_owned(),
        Origin::Computed(effort) => format!(
            "computed in {:.1} s ({} unknowns, matrix of {})",
            effort.total().as_secs_f64(),
            solution.sizes.unknowns,
            bytes_in_words(8 * (solution.sizes.unknowns as u64).pow(2))
        ),
    };
    console.say(format!(
        "forces of {} modes {how}, key {}",
        aircraft.asked,
        forces.key.to_hex()
    ));
    if let Origin::Computed(effort) = &forces.origin {
        console.say(format!("  {}", in_words(effort)));
    }
    console.notes(&solution.notes);
    steady_loads(console, file, aircraft, &solution.steady);
}

/// Size of the surface and effort, by name.
pub(crate) fn facts(aircraft: &Aircraft, forces: &OwnForces) -> Vec<(String, String)> {
    let sizes = &forces.stored.solution.sizes;
    let effort = match &forces.origin {
        Origin::Cache => "forces from the cache".to_owned(),
        Origin::Computed(effort) => {
            format!(
                "{:.1} s: {}",
                effort.total().as_secs_f64(),
                in_words(effort)
            )
        }
    };
    [
        (
            "surface",
            format!(
                "{} triangles, {} unknowns, {} wake elements",
                aircraft.surface.mesh.triangles.len(),
                sizes.unknowns,
                sizes.wake_elements
            ),
        ),
        ("effort", effort),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .to_vec()
}

/// Time of every stage, and the most memory.
fn in_words(effort: &Effort) -> String {
    let mut parts: Vec<String> = effort
        .stages
        .iter()
        .map(|(stage, time)| format!("{stage} {:.1} s", time.as_secs_f64()))
        .collect();
    if let Some(bytes) = effort.peak_bytes {
        parts.push(format!("at most {} of memory", bytes_in_words(bytes)));
    }
    parts.join(", ")
}

fn steady_loads(console: &Console, file: &CaseFile, aircraft: &Aircraft, steady: &SteadyState) {
    let flow = &file.case.flow;
    let [_, side, _] = steady.loads.force;
    let [roll, pitch, yaw] = steady.loads.moment;
    console.say(format!(
        "steady flow at alpha {}°, beta {}°: lift {} m² by pressure, {} m² by wake jump (times \
         dynamic pressure)",
        flow.alpha_deg,
        flow.beta_deg,
        fixed(steady.lift_by_pressure, 5),
        fixed(steady.lift_by_wake_jump, 5)
    ));
    console.say(format!(
        "  drag {} m² by pressure, {} in the Trefftz plane",
        fixed(drag(steady), 5),
        steady.induced_drag.map_or_else(
            || "undefined".to_owned(),
            |drag| format!("{} m²", fixed(drag, 5))
        )
    ));
    if let Some(area) = file.case.reference.area {
        console.say(format!(
            "  lift coefficient {}",
            fixed(steady.lift_by_pressure / area, 4)
        ));
    }
    console.say(format!(
        "  flight-mechanics signs: side force to starboard {} m²; moments about the moment point: \
         roll (starboard wing down) {}, pitch (nose up) {}, yaw (nose to starboard) {} m³",
        fixed(side, 5),
        fixed(-roll, 5),
        fixed(pitch, 5),
        fixed(-yaw, 5)
    ));
    let (pressure, triangle) = steady.lowest_pressure;
    console.say(format!(
        "  lowest pressure coefficient {pressure:.3} on triangle {triangle}"
    ));
    level_flight(console, file, aircraft, steady.lift_by_pressure);
}

/// Along the stream, per dynamic pressure.
fn drag(steady: &SteadyState) -> f64 {
    let products = steady.loads.force.iter().zip(steady.stream);
    products.map(|(force, stream)| force * stream).sum()
}

/// Speed at which the lift carries the weight.
fn level_flight(console: &Console, file: &CaseFile, aircraft: &Aircraft, lift: f64) {
    let (Some(body), Ok(density)) = (&aircraft.structure.body, conditions::density(file))
    else {
        return;
    };
    let gravity = file
        .case
        .flight
        .as_ref()
        .map_or(STANDARD_GRAVITY, |flight| flight.gravity);
    let climb = file
        .case
        .flight
        .as_ref()
        .map_or(0.0, |flight| flight.climb_deg);
    let weight = body.mass * gravity * climb.to_radians().cos();
    if lift > 0.0 {
        let speed = (2.0 * weight / (density * lift)).sqrt();
        console.say(format!(
            "  the lift carries the weight of {weight:.1} N at {speed:.2} m/s and {density} kg/m³"
        ));
    }
}

/// m/s², where the case gives none.
const STANDARD_GRAVITY: f64 = 9.806_65;

/// Steady generalised force of every mode the case asks for.
pub(crate) fn steady_forces(console: &Console, aircraft: &Aircraft, steady: &SteadyState) {
    let mut table = Table::new(&[
        ("mode", Align::Left),
        ("steady generalised force / q∞", Align::Right),
    ]);
    let modes = aircraft.asked_modes().iter();
    for (mode, force) in modes.zip(&steady.generalised_forces) {
        table.row([mode.name.clone(), fixed(*force, 6)]);
    }
    console.say(table.text());
}

/// Spanwise wake jump of the steady flow along every trailing edge.
pub(crate) fn wake_jumps(console: &Console, steady: &SteadyState) {
    for (number, edge) in steady.wake_jumps.iter().enumerate() {
        console.say(format!(
            "wake jump of the steady flow along trailing edge {}, per unit speed{}",
            number + 1,
            ends_in_words(edge.on_body)
        ));
        let mut table = Table::new(&[
            ("x [m]", Align::Right),
            ("y [m]", Align::Right),
            ("z [m]", Align::Right),
            ("jump [m]", Align::Right),
        ]);
        let count = edge.positions.len();
        let rows = count.min(PRINTED_STATIONS);
        for row in 0..rows {
            let station = if rows < 2 {
                0
            } else {
                row * (count - 1) / (rows - 1)
            };
            let [x, y, z] = edge.positions[station];
            let mut cells: Vec<String> = [x, y, z].iter().map(|c| fixed(*c, 4)).collect();
            cells.push(fixed(edge.jumps[station], 6));
            table.row(cells);
        }
        console.say(table.text());
        if rows < count {
            console.say(format!("  {rows} of {count} stations"));
        }
    }
}

fn ends_in_words(on_body: [bool; 2]) -> &'static str {
    match on_body {
        [true, true] => " (both ends on a body)",
        [true, false] => " (begins on a body)",
        [false, true] => " (ends on a body)",
        [false, false] => "",
    }
}

/// One sample of $Q$, where it is small enough to read.
pub(crate) fn sample(console: &Console, modes: &[String], sample: &Sample) {
    console.say(format!(
        "Q at g = {}, k = {} [m² for unit-metre modes]",
        sample.g, sample.k
    ));
    if modes.len() > LARGEST_PRINTED {
        console.say(format!(
            "  {} × {} entries; --json writes them",
            modes.len(),
            modes.len()
        ));
        return;
    }
    let mut columns = vec![("force on", Align::Left)];
    columns.extend(modes.iter().map(|mode| (mode.as_str(), Align::Right)));
    let mut table = Table::new(&columns);
    for (mode, row) in modes.iter().zip(&sample.q) {
        let mut cells = vec![mode.clone()];
        cells.extend(row.iter().map(|[re, im]| format!("{re:.5} {im:+.5}i")));
        table.row(cells);
    }
    console.say(table.text());
}
