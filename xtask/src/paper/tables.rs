//! Tables 1 and 2.

use fladder_stability::{FlightMode, SweepResult};

use super::PaperError;
use super::published::Published;
use super::words::{Table, amplitude, number};
use super::work::{LONGITUDINAL, Work, at, dutch_roll, is_longitudinal};

/// A ratio of amplitudes with its phase.
fn ratio(motion: &FlightMode, name: &str) -> String {
    let found = motion.ratios.iter().find(|ratio| ratio.name == name);
    found.map_or_else(
        || "–".to_owned(),
        |ratio| {
            format!("{} at {:.0}°", number(ratio.magnitude), ratio.phase_deg).replace('-', "−")
        },
    )
}

fn period(motion: &FlightMode) -> String {
    motion.period.map_or_else(
        || "aperiodic".to_owned(),
        |period| format!("{} s", number(period)),
    )
}

/// Table 1: the Dutch roll at 30 m/s.
pub(super) fn dutch(work: &Work, published: &Published) -> Result<Table, PaperError> {
    let paper = published.get("dutch_period_p2")?;
    let mut table = Table::new(&[
        "Dutch roll at 30 m/s",
        "period",
        "amplitude",
        "ψ : φ",
        "β : ψ",
    ]);
    let none = || "–".to_owned();
    let growth = std::f64::consts::LN_2 / published.get("dutch_growth")?.value;
    table.push([
        "paper, p2".to_owned(),
        format!("{} s", number(paper.value)),
        amplitude(growth),
        none(),
        none(),
    ]);
    table.push([
        "paper, p-k".to_owned(),
        format!("{} s", number(published.get("dutch_period_pk")?.value)),
        none(),
        none(),
        none(),
    ]);
    let rigid = work.main.rigid_aircraft.as_slice();
    let here = work.flying().into_iter();
    let here = here.map(|(name, result)| (name, result.flight_modes.as_slice()));
    for (name, motions) in here.chain([("rigid aircraft by derivatives", rigid)]) {
        let found = dutch_roll(motions, paper.value);
        let cells = found.map_or_else(
            || ["none at this speed".to_owned(), none(), none(), none()],
            |motion| {
                [
                    period(motion),
                    amplitude(motion.sigma),
                    ratio(motion, "psi:phi"),
                    ratio(motion, "beta:psi"),
                ]
            },
        );
        table.push([format!("here, {name}")].into_iter().chain(cells));
    }
    Ok(table)
}

/// Table 2: motions of the plane of symmetry at 45 m/s.
pub(super) fn longitudinal(work: &Work, published: &Published) -> Result<Table, PaperError> {
    let mut table = Table::new(&[
        "longitudinal motions at 45 m/s",
        "name",
        "period",
        "amplitude",
        "u : α",
        "θ : α",
    ]);
    let paper = published.get("longitudinal_period")?;
    table.push(
        [
            "paper, p2",
            "neither short period nor phugoid",
            &format!("{} s", number(paper.value)),
            "–",
            "–",
            "–",
        ]
        .map(str::to_owned),
    );
    for (heading, result) in [
        ("without speed terms, as in the paper", &work.without_speed),
        ("with speed terms", &work.with_speed),
    ] {
        let refined = result.methods.polished.as_ref();
        let motions = refined.map_or(&[][..], |refined| &refined.flight_modes);
        push(&mut table, &format!("here, {heading}"), motions);
    }
    push(
        &mut table,
        "rigid aircraft, with speed terms",
        rigid(&work.with_speed),
    );
    Ok(table)
}

fn rigid(result: &SweepResult) -> &[FlightMode] {
    &result.rigid_aircraft
}

fn push(table: &mut Table, heading: &str, motions: &[FlightMode]) {
    let mut found: Vec<&FlightMode> = at(motions, LONGITUDINAL)
        .filter(|motion| is_longitudinal(motion))
        .collect();
    found.sort_by(|a, b| {
        let size = |motion: &FlightMode| motion.sigma.hypot(motion.omega);
        size(b).total_cmp(&size(a))
    });
    for motion in found {
        table.push([
            heading.to_owned(),
            motion.motion.to_owned(),
            period(motion),
            amplitude(motion.sigma),
            ratio(motion, "u:alpha"),
            ratio(motion, "theta:alpha"),
        ]);
    }
}
