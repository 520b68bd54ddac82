//! The fit as the paper words it, for the record.
//!
//! Intervals of $k$ around each sample times the two signs of $g$; the samples
//! lie on the edge $g = 0$ and belong to both cells; the values of neighbours
//! are asked to agree at three points of every shared edge, with weight one.
//! Nothing is pinned or mirrored, and a cell edge runs where flutter lives:
//! roots near the axis come out a hundred times worse than with
//! [`centred`](super::PiecewiseQuadratic::centred) cells.

use faer::{Mat, c64};

use super::patches::{Datum, Join, Patch, fit_patches};
use super::{Cell, FitError, FitReport, PiecewiseQuadratic};
use crate::gaf::GafTable;
use crate::linalg::largest;

pub(super) fn fit(
    table: &GafTable,
    damping_limit: f64,
) -> Result<PiecewiseQuadratic, FitError> {
    let edges = edges(table.k());
    let rows = edges.len() - 1;
    let patches: Vec<Patch> = [[-damping_limit, 0.0], [0.0, damping_limit]]
        .into_iter()
        .flat_map(|g| edges.windows(2).map(move |k| Patch { g, k: [k[0], k[1]] }))
        .collect();
    let samples: Vec<(f64, &Mat<c64>)> = table.k().iter().copied().zip(table.axis()).collect();
    let data: Vec<Datum<'_>> = [0, rows]
        .into_iter()
        .flat_map(|offset| {
            samples.iter().enumerate().map(move |(row, &(k, q))| Datum {
                cell: offset + row,
                p: c64::new(0.0, k),
                q,
                is_mirror: false,
            })
        })
        .collect();
    let joins = joins(&patches, rows);
    let fitted = fit_patches(&patches, &data, &joins, table.shape())?;
    let cells: Vec<Cell> = patches
        .iter()
        .zip(fitted.coefficients)
        .map(|(patch, coefficients)| Cell {
            g: patch.g,
            k: patch.k,
            coefficients,
            is_mirrored: false,
        })
        .collect();
    let scale = samples
        .iter()
        .map(|(_, q)| largest(q.as_ref()))
        .fold(0.0, f64::max);
    let residual = data
        .iter()
        .map(|datum| largest((cells[datum.cell].q(datum.p) - datum.q).as_ref()))
        .fold(0.0, f64::max)
        / scale.max(f64::MIN_POSITIVE);
    let report = FitReport {
        equations: fitted.equations,
        unknowns: 3 * cells.len(),
        rank: fitted.rank,
        residual,
        is_pinned: false,
    };
    Ok(PiecewiseQuadratic {
        cells,
        report,
        shape: table.shape(),
        notes: Vec::new(),
    })
}

/// Half-way between samples; the first interval straddles its sample.
fn edges(k: &[f64]) -> Vec<f64> {
    let middles: Vec<f64> = k.windows(2).map(|p| f64::midpoint(p[0], p[1])).collect();
    let last = k.len() - 1;
    let mut edges = vec![2.0 * k[0] - middles[0]];
    edges.extend(&middles);
    edges.push(2.0 * k[last] - middles[last - 1]);
    edges
}

fn joins(patches: &[Patch], rows: usize) -> Vec<Join> {
    const PARTS: [f64; 3] = [0.0, 0.5, 1.0];
    let along = |ends: [f64; 2], part: f64| ends[0] + part * (ends[1] - ends[0]);
    let mut joins = Vec::new();
    for (cell, patch) in patches.iter().enumerate() {
        for part in PARTS {
            if cell % rows + 1 < rows {
                let p = c64::new(along(patch.g, part), patch.k[1]);
                joins.push(Join {
                    cells: [cell, cell + 1],
                    p,
                    weight: 1.0,
                });
            }
            if cell < rows {
                let p = c64::new(0.0, along(patch.k, part));
                joins.push(Join {
                    cells: [cell, cell + rows],
                    p,
                    weight: 1.0,
                });
            }
        }
    }
    joins
}
