//! Figures 8 and 9: all roots, and those of low frequency.

use fladder::plot::{Graph, Mark, Series, Sheet, Subject, flutter_diagram, root_locus, sheet};
use fladder_stability::{FlightMode, Kind, MethodResult};

use super::work::{Work, as_in_the_paper};

/// Figure 8: root locus and V-g diagram, p2 as lines, p-k as crosses.
pub(super) fn figure_8(work: &Work, conditions: &str) -> [String; 2] {
    let methods = as_in_the_paper(&work.main.methods);
    let subject = Subject {
        title: "Figure 8",
        conditions,
        methods: &methods,
    };
    [root_locus(&subject), flutter_diagram(&subject)]
}

/// Names of motions in the order of their looks.
const MOTIONS: [&str; 8] = [
    "Dutch roll",
    "lateral phugoid",
    "roll",
    "spiral",
    "short period",
    "phugoid",
    "coupled, symmetric",
    "coupled, lateral",
];
/// Ends of the axis of k in the paper's two diagrams.
const K: [f64; 2] = [0.05, 0.025];
/// Damping outside of this is left out.
const G: [f64; 2] = [-0.03, 0.03];

/// Figure 9: rigid motions by name. p2 on axis data as lines, on Laplace data as rings,
/// p-k as crosses.
pub(super) fn figure_9(work: &Work) -> String {
    let methods = &work.main.methods;
    let semichord = work.main.semichord;
    let sources = [
        (Mark::Line, &methods.p2),
        (Mark::Rings, &work.laplace.methods.p2),
        (Mark::Crosses, &methods.pk),
    ];
    let there: Vec<(Mark, &MethodResult)> = sources
        .into_iter()
        .filter_map(|(mark, result)| Some((mark, result.as_ref()?)))
        .collect();
    low_frequencies(&there, semichord)
}

/// Elastic roots that oscillate below the upper end of the axis.
fn elastic(mark: Mark, result: &MethodResult, group: usize) -> Vec<Series> {
    let branches = result.branches.iter();
    let branches = branches.filter(|branch| branch.kind == Kind::Elastic);
    branches
        .map(|branch| {
            let named = |speed: f64| {
                let mut motions = result.flight_modes.iter();
                motions.any(|mode| {
                    mode.branch == branch.name && (mode.speed - speed).abs() < 1e-6 * speed
                })
            };
            let roots = branch.speed.iter().zip(branch.g.iter().zip(&branch.k));
            let roots =
                roots.filter(|(speed, (_, k))| **k > 0.0 && **k <= K[0] && !named(**speed));
            Series {
                mark,
                group: Some(group),
                points: roots.map(|(_, (g, k))| [*g, *k]).collect(),
            }
        })
        .filter(|series| !series.points.is_empty())
        .collect()
}

fn low_frequencies(methods: &[(Mark, &MethodResult)], semichord: f64) -> String {
    let mut series: Vec<Series> = Vec::new();
    let mut names: Vec<String> = Vec::new();
    for motion in MOTIONS {
        let mut own = Vec::new();
        for (mark, result) in methods {
            let those = result.flight_modes.iter();
            let those: Vec<&FlightMode> = those.filter(|mode| mode.motion == motion).collect();
            own.extend(drawn(*mark, &those, names.len(), semichord));
        }
        let is_seen = |[g, k]: &[f64; 2]| (G[0]..=G[1]).contains(g) && (0.0..=K[0]).contains(k);
        if own.iter().flat_map(|series| &series.points).any(is_seen) {
            series.extend(own);
            names.push(motion.to_owned());
        }
    }
    let own: Vec<Series> = methods
        .iter()
        .flat_map(|(mark, result)| elastic(*mark, result, names.len()))
        .collect();
    let is_seen = |[g, _]: &[f64; 2]| (G[0]..=G[1]).contains(g);
    if own.iter().flat_map(|series| &series.points).any(is_seen) {
        series.extend(own);
        names.push("elastic".to_owned());
    }
    let graphs = K.map(|top| Graph {
        title: format!("k up to {top}"),
        labels: [
            "reduced damping  g  [–]".to_owned(),
            "reduced frequency  k  [–]".to_owned(),
        ],
        ranges: [Some(damping(&series, top)), Some([-0.02 * top, top])],
        series: series.clone(),
    });
    sheet(&Sheet {
        title: "Figure 9: low frequencies",
        note: "g > 0 grows. Rigid motions by name, 20 to 75 m/s in steps of 1 m/s; real roots lie on k = 0. \
               A motion whose name changes with speed changes its colour.",
        groups: &names,
        marks: &[
            (Mark::Line, "p2, axis data"),
            (Mark::Rings, "p2, Laplace data"),
            (Mark::Crosses, "p-k"),
        ],
        graphs: &graphs,
    })
}

/// Ends of the axis of g around what oscillates below a reduced frequency.
fn damping(series: &[Series], top: f64) -> [f64; 2] {
    let points = series.iter().flat_map(|series| &series.points);
    let seen = points.filter(|[g, k]| *k > 0.0 && *k <= top && (G[0]..=G[1]).contains(g));
    let [low, high] = seen.fold([-0.005_f64, 0.002_f64], |[low, high], [g, _]| {
        [low.min(*g), high.max(*g)]
    });
    let margin = 0.06 * (high - low);
    [low - margin, high + margin]
}

/// Lines run along a branch as long as its speeds follow each other.
fn drawn(mark: Mark, modes: &[&FlightMode], group: usize, semichord: f64) -> Vec<Series> {
    let place = |mode: &FlightMode| {
        let scale = semichord / mode.speed;
        [mode.sigma * scale, mode.omega * scale]
    };
    let series = |points| Series {
        mark,
        group: Some(group),
        points,
    };
    if mark != Mark::Line {
        // Rings at every second speed leave the line between them to be seen.
        let step = if mark == Mark::Rings { 2 } else { 1 };
        let speeds = |mode: &&&FlightMode| (mode.speed.round() as i64) % step == 0;
        let shown = modes.iter().filter(speeds).map(|mode| place(mode));
        return vec![series(shown.collect())];
    }
    let mut branches: Vec<&str> = modes.iter().map(|mode| mode.branch.as_str()).collect();
    branches.sort_unstable();
    branches.dedup();
    let mut lines = Vec::new();
    for branch in branches {
        let own: Vec<&&FlightMode> =
            modes.iter().filter(|mode| mode.branch == branch).collect();
        for run in own.chunk_by(|a, b| b.speed - a.speed < LONGEST_STEP) {
            lines.push(series(run.iter().map(|mode| place(mode)).collect()));
        }
    }
    lines
}

/// Speeds further apart do not belong to one line, m/s.
const LONGEST_STEP: f64 = 1.5;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_of_made_up_outcomes_are_drawn() {
        let mode = |speed: f64, motion, omega| FlightMode {
            speed,
            alpha_deg: 2.0,
            branch: "a".to_owned(),
            motion,
            sigma: -0.1,
            omega,
            period: None,
            damping_ratio: 0.1,
            time_to_double: None,
            time_to_halve: None,
            elastic_share: 0.0,
            elastic_mode: None,
            ratios: Vec::new(),
        };
        let result = MethodResult {
            flight_modes: vec![
                mode(20.0, "Dutch roll", 3.0),
                mode(21.0, "Dutch roll", 3.0),
                mode(40.0, "Dutch roll", 3.0),
                mode(20.0, "spiral", 0.0),
            ],
            ..MethodResult::default()
        };
        let text = low_frequencies(&[(Mark::Line, &result), (Mark::Crosses, &result)], 0.1);
        assert!(text.contains("Dutch roll") && text.contains("spiral"));
        assert!(!text.contains("phugoid") && text.ends_with("</svg>\n"));
    }
}
