//! Roots, crossings and the verdict in words.

use super::flight;
use crate::case::CaseFile;
use crate::chain::conditions::Conditions;
use crate::figures::three_digits;
use crate::terminal::{Align, Console, Table};
use fladder_stability::{Crossing, Kind, Margin, MethodResult, Methods, REACH, SweepResult};

/// Two crossings further apart than this in speed or frequency, relative, are
/// not the same crossing.
const SAME_CROSSING: f64 = 0.05;

/// What a sweep was made at, on one line.
pub(crate) fn conditions(file: &CaseFile, conditions: &Conditions) -> String {
    let flow = &file.case.flow;
    let alpha = if conditions.is_trimmed() {
        "alpha of level flight".to_owned()
    } else {
        format!("alpha {}°", flow.alpha_deg)
    };
    let mach = if conditions.is_matched() {
        String::new()
    } else {
        format!(", M {}", flow.mach)
    };
    format!(
        "{}, semichord {} m, {alpha}{mach}",
        conditions.words(),
        file.case.reference.semichord
    )
}

/// The most accurate result there is.
pub(crate) fn best(methods: &Methods) -> Option<&MethodResult> {
    methods
        .polished
        .as_ref()
        .or(methods.p2.as_ref())
        .or(methods.pk.as_ref())
        .or(methods.g.as_ref())
}

/// Crossings, agreement of the methods, rigid roots, and the verdict.
pub(crate) fn roots(console: &Console, result: &SweepResult, speeds: &[f64]) {
    let methods = &result.methods;
    let Some(best) = best(methods) else {
        return;
    };
    let (head, rows) = crossing_table(methods);
    if !rows.is_empty() {
        let aligned = |(i, name): (usize, &String)| {
            let align = if i < 3 { Align::Left } else { Align::Right };
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
    flight::sensitivities(console, best);
    flight::flight_modes(console, best, result);
    completeness(console, best, speeds);
    extrapolated(console, methods);
    console.say("");
    for line in verdicts(methods, speeds) {
        console.say(line);
    }
    if let Some(margin) = &result.margin {
        console.say(margin_words(margin));
    }
}

/// A margin in a sentence.
pub(crate) fn margin_words(margin: &Margin) -> String {
    let speed = three_digits(margin.speed);
    let first = match (
        margin.first_instability,
        margin.speed_margin,
        &margin.branch,
    ) {
        (Some(at), Some(part), Some(branch)) => format!(
            "at {speed} m/s the margin of speed to the first instability ({branch}, {} m/s) is \
             {:+.1} %",
            three_digits(at),
            100.0 * part
        ),
        _ => format!("at {speed} m/s: no instability within the sweep"),
    };
    match (
        &margin.least_damped,
        margin.damping_ratio,
        margin.frequency_hz,
    ) {
        (Some(branch), Some(ratio), Some(frequency)) => format!(
            "{first}; least damped there is {branch}, damping ratio {ratio:.4} at {} Hz",
            three_digits(frequency)
        ),
        _ => first,
    }
}

/// The verdict in words, most urgent first.
pub(crate) fn verdicts(methods: &Methods, speeds: &[f64]) -> Vec<String> {
    match (best(methods), speeds) {
        (Some(best), [first, .., last] | [first @ last]) => verdict(best, *first, *last),
        _ => Vec::new(),
    }
}

/// Names of the columns, and a row a crossing: the first three are words.
pub(crate) fn crossing_table(methods: &Methods) -> (Vec<String>, Vec<Vec<String>>) {
    let (other, word) = match (&methods.pk, &methods.g) {
        (None, Some(_)) => (&methods.g, "g-method"),
        _ => (&methods.pk, "p-k"),
    };
    let head = [
        "crossing",
        "branch",
        "kind",
        "V [m/s]",
        "q [Pa]",
        "f [Hz]",
        "k",
        "p2 V [m/s]",
    ];
    let mut head = head.map(str::to_owned).to_vec();
    head.extend([format!("{word} V [m/s]"), format!("{word} to p2")]);
    let mut rows = Vec::new();
    let Some(best) = best(methods) else {
        return (head, rows);
    };
    let beside = |result: &Option<MethodResult>, crossing: &Crossing, back: bool| {
        let result = result.as_ref()?;
        let list = if back {
            &result.restabilised
        } else {
            &result.flutter
        };
        counterpart(list, crossing)
    };
    let mut add = |word: &str, crossing: &Crossing, back: bool| {
        let p2 = beside(&methods.p2, crossing, back);
        let pk = beside(other, crossing, back);
        let speed =
            |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:.3}"));
        let difference = p2.zip(pk).map_or_else(
            || "–".to_owned(),
            |(p2, pk)| format!("{:+.3} %", 100.0 * (pk - p2) / p2),
        );
        rows.push(vec![
            word.to_owned(),
            crossing.branch.clone(),
            kind(crossing.kind).to_owned(),
            format!("{:.3}", crossing.speed),
            format!("{:.1}", crossing.dynamic_pressure),
            format!("{:.3}", crossing.frequency_hz),
            format!("{:.4}", crossing.k),
            speed(p2),
            speed(pk),
            difference,
        ]);
    };
    best.flutter
        .iter()
        .for_each(|crossing| add("flutter", crossing, false));
    best.restabilised
        .iter()
        .for_each(|crossing| add("stable again", crossing, true));
    for divergence in &best.divergence {
        rows.push(vec![
            "divergence".to_owned(),
            divergence.branch.clone(),
            kind(divergence.kind).to_owned(),
            format!("{:.3}", divergence.speed),
            format!("{:.1}", divergence.dynamic_pressure),
        ]);
    }
    (head, rows)
}

/// Speed of the crossing of another method that is the same one.
fn counterpart(list: &[Crossing], wanted: &Crossing) -> Option<f64> {
    let distance = |other: &Crossing| {
        let speed = (other.speed - wanted.speed).abs() / wanted.speed;
        let scale = wanted.frequency_hz.max(f64::MIN_POSITIVE);
        speed.max((other.frequency_hz - wanted.frequency_hz).abs() / scale)
    };
    let nearest = list
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    (distance(nearest) <= SAME_CROSSING).then_some(nearest.speed)
}

fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Rigid => "rigid",
        Kind::Elastic => "elastic",
    }
}

/// How many roots were counted in the region and found, with every defect.
fn completeness(console: &Console, best: &MethodResult, speeds: &[f64]) {
    let (Some(complete), Some(counts)) = (&best.complete, &best.count) else {
        return;
    };
    let met = complete.iter().filter(|met| **met).count();
    let counted = || counts.iter().flatten().map(|count| count.counted);
    if let (Some(least), Some(most)) = (counted().min(), counted().max()) {
        console.say(format!(
            "  roots in the region: {least} to {most} counted along its border; all of them found at \
             {met} of {} speeds",
            complete.len()
        ));
    }
    let missed = (0..complete.len()).filter(|speed| !complete[*speed]);
    for speed in missed {
        let at = speeds.get(speed).copied().unwrap_or_default();
        let words = counts[speed].map_or_else(
            || "not counted: the border runs through a root".to_owned(),
            |count| format!("{} counted, {} found", count.counted, count.found),
        );
        console.say(format!("  note: at {} m/s {words}", three_digits(at)));
    }
}

/// Roots whose forces are continued beyond the samples.
fn extrapolated(console: &Console, methods: &Methods) {
    let named = [
        ("p2", &methods.p2),
        ("refined", &methods.polished),
        ("p-k", &methods.pk),
        ("g-method", &methods.g),
    ];
    let told: Vec<String> = named
        .into_iter()
        .filter_map(|(name, result)| {
            let lists = result.as_ref()?.branches.iter();
            let all = lists.filter_map(|branch| branch.extrapolated.as_ref());
            let count = all.flatten().filter(|outside| **outside).count();
            (count > 0).then(|| format!("{count} of {name}"))
        })
        .collect();
    if !told.is_empty() {
        console.say(format!(
            "  note: roots with forces continued beyond the samples (k above the last, or more \
             than {REACH} from their g): {}; the JSON and roots.csv mark them as extrapolated",
            told.join(", ")
        ));
    }
}

/// Sentences that say what the sweep means.
fn verdict(best: &MethodResult, first: f64, last: f64) -> Vec<String> {
    let mut lines: Vec<(f64, String)> = Vec::new();
    for start in &best.unstable_at_start {
        let motion = if start.k > 0.0 {
            "oscillation"
        } else {
            "aperiodic motion"
        };
        let since = if start.speed > first {
            "from"
        } else {
            "already at the first speed,"
        };
        let line = format!(
            "unstable {since} {} m/s: branch {} ({}), {motion}, g {:+.5}, k {:.4}",
            three_digits(start.speed),
            start.branch,
            kind(start.kind),
            start.g,
            start.k
        );
        lines.push((start.speed, line));
    }
    for crossing in &best.flutter {
        let word = match crossing.kind {
            Kind::Elastic => "flutter",
            Kind::Rigid => "a rigid motion becomes unstable",
        };
        let line = format!(
            "{word} at {} m/s, {} Hz, k {:.2}, branch {}",
            three_digits(crossing.speed),
            three_digits(crossing.frequency_hz),
            crossing.k,
            crossing.branch
        );
        lines.push((crossing.speed, line));
    }
    for divergence in &best.divergence {
        let word = match divergence.kind {
            Kind::Elastic => "divergence",
            Kind::Rigid => "a rigid motion becomes aperiodically unstable",
        };
        let speed = three_digits(divergence.speed);
        let line = format!("{word} at {speed} m/s, branch {}", divergence.branch);
        lines.push((divergence.speed, line));
    }
    if lines.is_empty() {
        lines.push((first, format!("stable from {first:.1} to {last:.1} m/s")));
    }
    lines.sort_by(|a, b| a.0.total_cmp(&b.0));
    lines.into_iter().map(|(_, line)| line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crossing(speed: f64, frequency_hz: f64) -> Crossing {
        Crossing {
            speed,
            dynamic_pressure: 0.0,
            frequency_hz,
            k: 0.5,
            branch: "elastic:5".to_owned(),
            kind: Kind::Elastic,
            altitude: None,
            sensitivities: None,
            shape: Vec::new(),
        }
    }

    #[test]
    fn the_verdict_names_speed_frequency_and_branch() {
        let result = MethodResult {
            flutter: vec![crossing(46.41, 56.02)],
            ..MethodResult::default()
        };
        let lines = verdict(&result, 20.0, 75.0);
        assert_eq!(
            lines,
            ["flutter at 46.4 m/s, 56.0 Hz, k 0.50, branch elastic:5"]
        );
        let stable = verdict(&MethodResult::default(), 20.0, 75.0);
        assert_eq!(stable, ["stable from 20.0 to 75.0 m/s"]);
    }

    #[test]
    fn crossings_of_two_methods_meet_by_speed_and_frequency() {
        let list = [
            crossing(40.0, 10.0),
            crossing(46.5, 30.0),
            crossing(46.6, 56.1),
        ];
        assert_eq!(counterpart(&list, &crossing(46.4, 56.0)), Some(46.6));
        assert_eq!(counterpart(&list, &crossing(60.0, 56.0)), None);
    }
}
