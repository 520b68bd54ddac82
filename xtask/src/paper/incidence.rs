//! Figure 10: how the forces of sideslip and of heave depend on the incidence.
//!
//! In body axes $\beta=py/b$ and $\Delta\alpha=-pz/b$, so that $Q_{ij}/p$ of a rigid column
//! $j$ is a derivative. The paper adds $(\alpha-\alpha_0)R_i$ to it, $R$ real and the same at
//! every k, in rigid columns only.

use faer::{Mat, c64};
use fladder::plot::{Graph, Mark, Series, Sheet, sheet};
use fladder_bem::Flow;

use super::PaperError;
use super::work::Work;

/// Incidences shown, degrees.
const ALPHAS: [f64; 5] = [-2.0, 0.0, 2.0, 4.0, 6.0];
/// The one from which the shift counts.
const FROM: usize = 2;
/// Rigid columns of the paper: sideslip and heave.
const COLUMNS: [(usize, &str); 2] = [(1, "y, sideslip"), (2, "z, heave")];
const RIGID: usize = 6;
const POINTS: usize = 31;
const K: [f64; 2] = [0.02, 1.5];

/// The three claims, measured.
#[derive(Clone, Debug, Default)]
pub(super) struct Claims {
    /// Largest part of the shift out of phase with the incidence.
    pub(super) out_of_phase: f64,
    /// Largest change of the shift over k, part of it.
    pub(super) drift: f64,
    /// Largest change of an elastic column, part of it, and its mode.
    pub(super) elastic: (f64, String),
}

/// Figure and claims.
pub(super) fn figure(work: &Work) -> Result<(String, Claims), PaperError> {
    let transfer = work.study.transfer();
    let order = work.study.swept_modes();
    let flows = ALPHAS.map(|alpha| Flow {
        alpha: f64::to_radians(alpha),
        beta: 0.0,
    });
    let step = (K[1] / K[0]).powf(1.0 / (POINTS - 1) as f64);
    let k: Vec<f64> = (0..POINTS).map(|i| K[0] * step.powi(i as i32)).collect();
    let mut q: Vec<Vec<Mat<c64>>> = Vec::new();
    for k in &k {
        q.push(transfer.q_at_each(c64::new(0.0, *k), &flows)?);
    }
    let mut graphs = Vec::new();
    for (column, name) in COLUMNS {
        graphs.extend(graphs_of(&k, &q, column, name));
    }
    let groups = ALPHAS.map(|alpha| format!("α = {alpha}°").replace('-', "−"));
    let picture = sheet(&Sheet {
        title: "Figure 10: load dependency on incidence",
        note: "In phase with the incidence: real part of Q/ik; out of phase: imaginary part. The paper's \
               shift is constant over k and in phase. Row: the rigid mode whose force changes most.",
        groups: &groups,
        marks: &[(Mark::Line, "in phase"), (Mark::Dots, "out of phase")],
        graphs: &graphs,
    });
    Ok((picture, claims(work, &k, &q, order)))
}

fn graphs_of(k: &[f64], q: &[Vec<Mat<c64>>], column: usize, name: &str) -> [Graph; 2] {
    let change = |row: &usize| {
        let all = &q[0];
        (all[ALPHAS.len() - 1][(*row, column)] - all[0][(*row, column)]).norm()
    };
    let row = (0..RIGID)
        .max_by(|a, b| change(a).total_cmp(&change(b)))
        .unwrap_or_default();
    let derivative =
        |at: usize, alpha: usize| q[at][alpha][(row, column)] / c64::new(0.0, k[at]);
    let series = |mark, alpha: usize, value: &dyn Fn(usize) -> f64| Series {
        mark,
        group: Some(alpha),
        points: (0..k.len()).map(|at| [k[at], value(at)]).collect(),
    };
    let (mut whole, mut shift) = (Vec::new(), Vec::new());
    for alpha in 0..ALPHAS.len() {
        let own = |at| derivative(at, alpha);
        whole.push(series(Mark::Line, alpha, &|at| own(at).re));
        whole.push(series(Mark::Dots, alpha, &|at| own(at).im));
        if alpha != FROM {
            let moved = |at| own(at) - derivative(at, FROM);
            shift.push(series(Mark::Line, alpha, &|at| moved(at).re));
            shift.push(series(Mark::Dots, alpha, &|at| moved(at).im));
        }
    }
    let rows = fladder_stability::RIGID_NAMES[row];
    let graph = |title: String, what: &str, series| Graph {
        title,
        labels: ["reduced frequency  k  [–]".to_owned(), what.to_owned()],
        ranges: [Some([0.0, K[1]]), None],
        series,
    };
    [
        graph(format!("column {name}; row {rows}"), "Q / ik  [m²]", whole),
        graph(
            format!("shift from α = {}°", ALPHAS[FROM]),
            "δ(Q / ik)  [m²]",
            shift,
        ),
    ]
}

fn claims(work: &Work, k: &[f64], q: &[Vec<Mat<c64>>], order: usize) -> Claims {
    let mut claims = Claims::default();
    let size = |at: usize, column: usize, difference: Option<usize>| {
        (0..order)
            .map(|row| {
                let own = q[at][FROM][(row, column)];
                difference.map_or(own.norm(), |alpha| {
                    (q[at][alpha][(row, column)] - own).norm()
                })
            })
            .fold(0.0, f64::max)
    };
    for alpha in [0, ALPHAS.len() - 1] {
        for (column, _) in COLUMNS {
            let constant = size(0, column, Some(alpha)) / k[0];
            let shift = |at: usize, row: usize| {
                (q[at][alpha][(row, column)] - q[at][FROM][(row, column)])
                    / c64::new(0.0, k[at])
            };
            for at in 0..k.len() {
                for row in 0..RIGID {
                    let (here, first) = (shift(at, row), shift(0, row));
                    claims.out_of_phase = claims.out_of_phase.max(here.im.abs() / constant);
                    claims.drift = claims.drift.max((here - first).norm() / constant);
                }
            }
        }
        for column in RIGID..order {
            for at in 0..k.len() {
                let part = size(at, column, Some(alpha)) / size(at, column, None);
                if part > claims.elastic.0 {
                    claims.elastic = (part, work.study.modes()[column].name.clone());
                }
            }
        }
    }
    claims
}
