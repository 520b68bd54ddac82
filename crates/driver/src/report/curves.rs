//! Curves beside the roots: the fit of the forces, and the wake jump over the span.

use super::mode_pictures::Named;
use crate::plot::{Curve, Curves, Drawn, curves};
use faer::{Mat, c64};
use fladder_bem::SteadyState;
use fladder_stability::{Aerodynamics, GafTable, PiecewiseQuadratic};

/// Points of a fitted curve.
const POINTS: usize = 300;

/// One entry of $Q$ over $k$ at $g = 0$: samples, and the piecewise quadratic between them,
/// as figure 1 of the paper. The entry is the diagonal one of a mode.
pub(crate) fn fit_picture(
    table: &GafTable,
    fit: &PiecewiseQuadratic,
    mode: Option<&str>,
) -> Option<Named> {
    let names = table.modes();
    let chosen = mode
        .and_then(|mode| names.iter().position(|name| name == mode))
        .unwrap_or(names.len().checked_sub(1)?);
    let last = *table.k().last()?;
    let part = |is_real: bool, value: c64| if is_real { value.re } else { value.im };
    let mut drawn = Vec::new();
    for (group, is_real) in [(0, true), (1, false)] {
        let word = if is_real { "Re" } else { "Im" };
        let samples = table.k().iter().zip(table.axis());
        let entry = |q: &Mat<c64>| part(is_real, q[(chosen, chosen)]);
        drawn.push(Curve {
            name: format!("{word} Q, samples"),
            drawn: Drawn::Dots,
            group,
            points: samples.map(|(k, q)| [*k, entry(q)]).collect(),
        });
        drawn.push(Curve {
            name: format!("{word} Q, piecewise quadratic"),
            drawn: Drawn::Line,
            group,
            points: (0..=POINTS)
                .map(|i| last * i as f64 / POINTS as f64)
                .map(|k| [k, entry(&fit.q(c64::new(0.0, k)))])
                .collect(),
        });
    }
    let report = fit.report();
    let title = format!(
        "Q of {0} on {0}, g = 0; rank {1} of {2}, misfit {3:.0e}",
        names[chosen], report.rank, report.unknowns, report.residual
    );
    let picture = curves(&Curves {
        title: &title,
        labels: ["reduced frequency  k = ωb/U  [–]", "Q  [m²/kg or m²]"],
        curves: &drawn,
    });
    Some(Named::new("Fit of the aerodynamic forces", picture))
}

/// The wake jump of the steady flow along every trailing edge.
pub(crate) fn jump_picture(steady: &SteadyState) -> Option<Named> {
    let drawn: Vec<Curve> = (0..)
        .zip(&steady.wake_jumps)
        .map(|(number, edge)| Curve {
            name: format!("trailing edge {}", number + 1),
            drawn: Drawn::Line,
            group: number,
            points: edge
                .positions
                .iter()
                .zip(&edge.jumps)
                .map(|(at, jump)| [at[1], *jump])
                .collect(),
        })
        .collect();
    if drawn.is_empty() {
        return None;
    }
    let picture = curves(&Curves {
        title: "Wake jump of the steady flow: circulation over the speed",
        labels: ["y  [m]", "jump of the potential  [m]"],
        curves: &drawn,
    });
    Some(Named::new("Spanwise wake jump", picture))
}
