//! Rigid motions by the names of flight mechanics, and what crossings depend on.

use crate::figures::three_digits;
use crate::terminal::{Align, Console, Table};
use fladder_stability::{FlightMode, MethodResult, SweepResult};
use std::fmt::Write;

/// Strongly decaying motions with less frequency than this part of their rate
/// lie on the branch cut of the forces, where digits mean little.
const NEAR_CUT: f64 = 1e-3;

/// Columns of the table of motions; the first three are words.
const HEAD: [&str; 9] = [
    "rigid motion",
    "branch",
    "amplitude",
    "V [m/s]",
    "period [s]",
    "damping ratio",
    "first ratio",
    "second ratio",
    "elastic share",
];

/// Motions at the first, the middle and the last speed, each followed by that of the rigid
/// aircraft with the same name.
pub(crate) fn flight_table(
    best: &MethodResult,
    result: &SweepResult,
) -> (Vec<String>, Vec<Vec<String>>) {
    let mut speeds: Vec<f64> = best.flight_modes.iter().map(|mode| mode.speed).collect();
    speeds.dedup();
    let chosen: Vec<f64> = match speeds.as_slice() {
        [] => Vec::new(),
        [first, .., last] if speeds.len() > 2 => vec![*first, speeds[speeds.len() / 2], *last],
        all => all.to_vec(),
    };
    let mut rows = Vec::new();
    for speed in chosen {
        let there = |mode: &&FlightMode| mode.speed == speed;
        let mut told: Vec<&str> = Vec::new();
        for mode in best.flight_modes.iter().filter(there) {
            rows.push(row(mode, mode.motion.to_owned(), mode.branch.clone()));
            if told.contains(&mode.motion) {
                continue;
            }
            told.push(mode.motion);
            let is_same = |other: &&FlightMode| other.motion == mode.motion;
            for rigid in result.rigid_aircraft.iter().filter(there).filter(is_same) {
                rows.push(row(rigid, "  as a rigid body".to_owned(), String::new()));
            }
        }
    }
    (HEAD.map(str::to_owned).to_vec(), rows)
}

fn row(mode: &FlightMode, name: String, branch: String) -> Vec<String> {
    let is_aperiodic =
        mode.period.is_none() || (mode.omega < NEAR_CUT * mode.sigma.abs() && mode.sigma < 0.0);
    let period = mode
        .period
        .filter(|_| !is_aperiodic)
        .map_or_else(|| "–".to_owned(), three_digits);
    let mut ratios = mode.ratios.iter().map(|ratio| {
        if is_aperiodic {
            let sign = if ratio.phase_deg.abs() > 90.0 {
                "-"
            } else {
                ""
            };
            format!("{} {sign}{}", ratio.name, three_digits(ratio.magnitude))
        } else {
            format!(
                "{} {} at {:+.0}°",
                ratio.name,
                three_digits(ratio.magnitude),
                ratio.phase_deg
            )
        }
    });
    let mut next = || ratios.next().unwrap_or_else(|| "–".to_owned());
    let (first, second) = (next(), next());
    let elastic = match &mode.elastic_mode {
        Some(_) if mode.elastic_share.abs() < 0.005 => "0 %".to_owned(),
        Some(leading) => format!("{:.0} % ({leading})", 100.0 * mode.elastic_share),
        None => "–".to_owned(),
    };
    vec![
        name,
        branch,
        amplitude(mode),
        format!("{:.1}", mode.speed),
        period,
        format!("{:.4}", mode.damping_ratio),
        first,
        second,
        elastic,
    ]
}

fn amplitude(mode: &FlightMode) -> String {
    match (mode.time_to_double, mode.time_to_halve) {
        (Some(time), _) => format!("doubles in {} s", three_digits(time)),
        (None, Some(time)) => format!("halves in {} s", three_digits(time)),
        (None, None) => "neither grows nor decays".to_owned(),
    }
}

/// Prints the motions; nothing without a rigid body.
pub(crate) fn flight_modes(console: &Console, best: &MethodResult, result: &SweepResult) {
    let (head, rows) = flight_table(best, result);
    if rows.is_empty() {
        return;
    }
    let aligned = |(i, name): (usize, &String)| {
        let is_words = !(3..=5).contains(&i);
        let align = if is_words { Align::Left } else { Align::Right };
        (name.clone(), align)
    };
    let columns: Vec<(String, Align)> = head.iter().enumerate().map(aligned).collect();
    let columns: Vec<(&str, Align)> = columns
        .iter()
        .map(|(name, align)| (name.as_str(), *align))
        .collect();
    let mut table = Table::new(&columns);
    for row in rows {
        table.row(row);
    }
    console.say(table.text());
}

/// Every motion at every speed as comma-separated values.
pub(crate) fn flight_csv(best: &MethodResult, result: &SweepResult) -> String {
    let mut text = "aircraft,motion,branch,speed_m_s,alpha_deg,sigma_1_s,omega_rad_s,period_s,\
                    damping_ratio,time_to_double_s,time_to_halve_s,elastic_share,ratio_1,\
                    magnitude_1,phase_deg_1,ratio_2,magnitude_2,phase_deg_2,ratio_3,magnitude_3,\
                    phase_deg_3\n"
        .to_owned();
    let elastic = best.flight_modes.iter().map(|mode| ("elastic", mode));
    let rigid = result.rigid_aircraft.iter().map(|mode| ("rigid", mode));
    for (aircraft, mode) in elastic.chain(rigid) {
        let optional = |value: Option<f64>| value.map_or_else(String::new, |v| v.to_string());
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "{aircraft},{},{},{},{},{},{},{},{},{},{},{}",
            mode.motion,
            mode.branch,
            mode.speed,
            mode.alpha_deg,
            mode.sigma,
            mode.omega,
            optional(mode.period),
            mode.damping_ratio,
            optional(mode.time_to_double),
            optional(mode.time_to_halve),
            mode.elastic_share,
        );
        for at in 0..3 {
            match mode.ratios.get(at) {
                Some(ratio) => {
                    let _ = write!(
                        text,
                        ",{},{},{}",
                        ratio.name, ratio.magnitude, ratio.phase_deg
                    );
                }
                None => text.push_str(",,,"),
            }
        }
        text.push('\n');
    }
    text
}

/// Frequencies told for each crossing.
const TOLD: usize = 3;

/// What each flutter speed owes to the frequencies of the modes, the strongest first.
pub(crate) fn sensitivities(console: &Console, best: &MethodResult) {
    let mut table = Table::new(&[
        ("flutter", Align::Left),
        ("V [m/s]", Align::Right),
        ("1 % more frequency of … changes V by … m/s", Align::Left),
    ]);
    for crossing in &best.flutter {
        let words: Vec<String> = crossing
            .owed_to_frequencies()
            .iter()
            .take(TOLD)
            .map(|(mode, change)| format!("{mode} {change:+.3}"))
            .collect();
        if !words.is_empty() {
            table.row([
                crossing.branch.clone(),
                format!("{:.3}", crossing.speed),
                words.join(", "),
            ]);
        }
    }
    if !table.is_empty() {
        console.say(table.text());
    }
}
