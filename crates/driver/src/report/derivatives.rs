//! Coefficients and derivatives in words, as JSON and as comma-separated values.

use crate::case::CaseFile;
use crate::chain::derivatives::{
    BODY_COLUMNS, BODY_ROWS, Derivatives, Row, STABILITY_COLUMNS, STABILITY_ROWS, Scales,
};
use crate::figures::fixed;
use crate::terminal::{Align, Console, Table};
use serde::Serialize;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fmt::Write;

const SCHEMA: &str = "fladder.derivatives/1";
const DECIMALS: usize = 5;

/// The file `derivatives.json`; undefined values are null.
#[derive(Debug, Serialize)]
pub(crate) struct Document {
    schema: &'static str,
    alpha_deg: f64,
    beta_deg: f64,
    area: Option<f64>,
    span: Option<f64>,
    chord: Option<f64>,
    moment_point: [f64; 3],
    neutral_point: f64,
    /// Mode of each control, d1 first.
    controls: Vec<String>,
    steady: BTreeMap<String, f64>,
    stability: BTreeMap<String, f64>,
    body: BTreeMap<String, f64>,
}

/// As a document with the names of AVL.
pub(crate) fn document(file: &CaseFile, found: &Derivatives) -> Document {
    let reference = &file.case.reference;
    let steady = steady_pairs(found);
    Document {
        schema: SCHEMA,
        alpha_deg: file.case.flow.alpha_deg,
        beta_deg: file.case.flow.beta_deg,
        area: reference.area,
        span: reference.span,
        chord: reference.chord,
        moment_point: reference.moment_point,
        neutral_point: found.neutral_point,
        controls: found.controls.clone(),
        steady: steady.into_iter().collect(),
        stability: pairs(&STABILITY_ROWS, &STABILITY_COLUMNS, &found.stability).collect(),
        body: pairs(&BODY_ROWS, &BODY_COLUMNS, &found.body).collect(),
    }
}

/// One line a value: axes, name, value; undefined values are empty.
pub(crate) fn derivatives_csv(found: &Derivatives) -> String {
    let mut text = "axes,name,value\n".to_owned();
    let steady = steady_pairs(found).into_iter();
    let stability = pairs(&STABILITY_ROWS, &STABILITY_COLUMNS, &found.stability);
    let body = pairs(&BODY_ROWS, &BODY_COLUMNS, &found.body);
    let lines = steady
        .map(|pair| ("steady", pair))
        .chain(stability.map(|pair| ("stability", pair)))
        .chain(body.map(|pair| ("body", pair)));
    for (axes, (name, value)) in lines {
        let value = if value.is_finite() {
            value.to_string()
        } else {
            String::new()
        };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{axes},{name},{value}");
    }
    text
}

/// Steady coefficients: CL … Cn in stability axes, CX, CY, CZ and moments in body axes.
fn steady_pairs(found: &Derivatives) -> Vec<(String, f64)> {
    let mut pairs: Vec<(String, f64)> = Vec::new();
    for (name, value) in STABILITY_ROWS.iter().zip(found.steady_stability) {
        let moved = ["Cl", "Cn"].contains(name);
        pairs.push((format!("{name}{}", if moved { "'" } else { "" }), value));
    }
    pairs.push(("CLff".to_owned(), found.lift_by_wake));
    pairs.push(("CDi".to_owned(), found.induced_drag.unwrap_or(f64::NAN)));
    for (name, value) in BODY_ROWS.iter().zip(found.steady_body) {
        if !["CY", "Cm"].contains(name) {
            pairs.push(((*name).to_owned(), value));
        }
    }
    pairs
}

fn column_names<'a>(first: &'a [&'a str], count: usize) -> impl Iterator<Item = String> + 'a {
    let controls = (1..=count.saturating_sub(first.len())).map(|number| format!("d{number}"));
    first.iter().map(|name| (*name).to_owned()).chain(controls)
}

/// Row and column make the name, as in `CLa`.
fn pairs<'a>(
    rows: &'a [&'a str; 6],
    columns: &'a [&'a str],
    values: &'a [Row],
) -> impl Iterator<Item = (String, f64)> + 'a {
    column_names(columns, values.len())
        .zip(values)
        .flat_map(|(column, values)| {
            rows.iter()
                .zip(values)
                .map(move |(row, value)| (format!("{row}{column}"), *value))
        })
}

/// Tables of steady coefficients and derivatives.
pub(crate) fn derivatives(console: &Console, file: &CaseFile, found: &Derivatives) {
    let reference = &file.case.reference;
    let Some(scales) = Scales::of(reference) else {
        return;
    };
    let [x, y, z] = reference.moment_point.map(|c| fixed(c, 4));
    console.say(format!(
        "coefficients: area {} m², span {} m, chord {} m, moments about ({x}, {y}, {z}) m",
        scales.area, scales.span, scales.chord
    ));
    steady(console, scales, found);
    console.say(
        "derivatives in stability axes: angles and controls per rad, rates as pB/2V, qC/2V, \
         rB/2V; roll starboard wing down, pitch nose up, yaw nose to starboard",
    );
    console.say(table(&STABILITY_ROWS, &STABILITY_COLUMNS, &found.stability));
    console.say(
        "derivatives in body axes, X forward, Y starboard, Z down: velocities over V, rates and \
         controls as above",
    );
    console.say(table(&BODY_ROWS, &BODY_COLUMNS, &found.body));
    for (number, mode) in (1..).zip(&found.controls) {
        console.say(format!("  d{number}: {mode}"));
    }
    if found.neutral_point.is_finite() {
        let margin = (found.neutral_point - reference.moment_point[0]) / scales.chord;
        console.say(format!(
            "  neutral point at x = {} m, {} chords behind the moment point",
            fixed(found.neutral_point, 4),
            fixed(margin, 4)
        ));
    }
}

fn steady(console: &Console, scales: Scales, found: &Derivatives) {
    let [lift, side, drag, roll, pitch, yaw] = found.steady_stability;
    let show = |value: f64| fixed(value, DECIMALS);
    let induced = found.induced_drag.map_or_else(
        || "CDi undefined: the wake has a free edge with a jump".to_owned(),
        |induced| {
            let ratio = scales.span.powi(2) / scales.area;
            // Of the same wake as the drag.
            let efficiency = found.lift_by_wake.powi(2) / (PI * ratio * induced);
            let word = if induced > 0.0 && efficiency.is_finite() {
                format!(", span efficiency {}", fixed(efficiency, 4))
            } else {
                String::new()
            };
            format!("CDi {} in the Trefftz plane{word}", show(induced))
        },
    );
    console.say(format!(
        "  stability axes: CL {} by pressure, {} by wake jump; CY {}, CD {} by pressure, {induced}; Cl' {}, Cm {}, Cn' {}",
        show(lift),
        show(found.lift_by_wake),
        show(side),
        show(drag),
        show(roll),
        show(pitch),
        show(yaw)
    ));
    let [x, y, z, l, m, n] = found.steady_body.map(show);
    console.say(format!(
        "  body axes: CX {x}, CY {y}, CZ {z}; Cl {l}, Cm {m}, Cn {n}"
    ));
}

fn table(rows: &[&str; 6], columns: &[&str], values: &[Row]) -> String {
    let names: Vec<String> = column_names(columns, values.len()).collect();
    let mut headings = vec![("", Align::Left)];
    headings.extend(names.iter().map(|name| (name.as_str(), Align::Right)));
    let mut table = Table::new(&headings);
    for (i, row) in rows.iter().enumerate() {
        let mut cells = vec![(*row).to_owned()];
        cells.extend(values.iter().map(|column| {
            if column[i].is_finite() {
                fixed(column[i], DECIMALS)
            } else {
                "–".to_owned()
            }
        }));
        table.row(cells);
    }
    table.text()
}
