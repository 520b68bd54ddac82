//! Cells for samples off the imaginary axis.
//!
//! The column $|g|\le0.05$ keeps the spline of the axis, which is better there
//! than any rectangle; outside it each rectangle between neighbouring lines
//! of $g$ and of $k$ meets the samples at its corners, and neighbours are
//! asked to agree there with weight 0.1 (a larger weight pushes the misfit of
//! one cell into the next; below 0.1 nothing changes).

use faer::{Mat, c64};

use super::patches::{Datum, Join, Patch, cell_of, fit_patches};
use super::{Cell, FitError, PiecewiseQuadratic, axis};
use crate::gaf::GafTable;
use crate::linalg::largest;

/// Half width of the inner column.
const INNER: f64 = 0.05;

/// Weight of the joins.
const JOIN_WEIGHT: f64 = 0.1;

pub(super) fn fit(table: &GafTable) -> Result<PiecewiseQuadratic, FitError> {
    let mut fit = axis::fit(table, INNER)?;
    fit.notes
        .retain(|note| !note.contains("off the imaginary axis"));
    let sides = [-1.0, 1.0].map(|side| (side, side_lines(table.g(), side)));
    let inner = sides.each_ref().map(|(_, lines)| inner_edge(lines));
    for cell in &mut fit.cells {
        cell.g = [-inner[0], inner[1]];
    }
    for ((side, lines), inner_edge) in sides.iter().zip(inner) {
        let first = lines.iter().rposition(|g| *g <= inner_edge).unwrap_or(0);
        if first + 1 < lines.len() {
            let column = Side {
                table,
                sign: *side,
                lines: &lines[first..],
                inner_edge,
            };
            let (cells, equations, rank) = column.cells()?;
            fit.report.equations += equations;
            fit.report.unknowns += 3 * column.patches().len();
            fit.report.rank += rank;
            fit.cells.extend(cells);
        }
    }
    fit.report.residual = misfit(&fit, table);
    Ok(fit)
}

/// The last line within the inner column, or its full half width where none
/// is.
fn inner_edge(lines: &[f64]) -> f64 {
    let within = lines
        .iter()
        .copied()
        .filter(|g| *g <= INNER)
        .fold(0.0, f64::max);
    if within > 0.0 { within } else { INNER }
}

/// Distances of the lines on one side, the axis first.
fn side_lines(g: &[f64], side: f64) -> Vec<f64> {
    let mut lines: Vec<f64> = g
        .iter()
        .map(|value| value * side)
        .filter(|value| *value >= 0.0)
        .collect();
    lines.sort_by(f64::total_cmp);
    lines
}

/// The rectangles on one side of the inner column.
struct Side<'a> {
    table: &'a GafTable,
    sign: f64,
    /// Distances from the axis, ascending.
    lines: &'a [f64],
    inner_edge: f64,
}

impl Side<'_> {
    fn columns(&self) -> usize {
        self.lines.len() - 1
    }

    /// Edges in $k$ of the mirrored problem.
    fn edges(&self) -> Vec<f64> {
        let positive: Vec<f64> = self
            .table
            .k()
            .iter()
            .copied()
            .filter(|k| *k > 0.0)
            .collect();
        positive
            .iter()
            .rev()
            .map(|k| -k)
            .chain(positive.iter().copied())
            .collect()
    }

    fn bounds(&self, column: usize, start: f64) -> [f64; 2] {
        let (near, far) = (start.max(self.lines[column]), self.lines[column + 1]);
        if self.sign > 0.0 {
            [near, far]
        } else {
            [-far, -near]
        }
    }

    fn patches(&self) -> Vec<Patch> {
        let edges = self.edges();
        (0..self.columns())
            .flat_map(|column| {
                let g = self.bounds(column, 0.0);
                edges
                    .windows(2)
                    .map(move |k| Patch { g, k: [k[0], k[1]] })
                    .collect::<Vec<_>>()
            })
            .collect()
    }

    /// Samples on the border of each patch, with their mirror images.
    fn data(&self, patches: &[Patch]) -> Vec<Datum<'_>> {
        let mut data = Vec::new();
        for (cell, patch) in patches.iter().enumerate() {
            for (i, &g) in self.table.g().iter().enumerate() {
                if g < patch.g[0] || g > patch.g[1] {
                    continue;
                }
                for (j, &k) in self.table.k().iter().enumerate() {
                    let Some(q) = self.table.sample(i, j) else {
                        continue;
                    };
                    let holds = |k: f64| k >= patch.k[0] && k <= patch.k[1];
                    if holds(k) {
                        data.push(Datum {
                            cell,
                            p: c64::new(g, k),
                            q,
                            is_mirror: false,
                        });
                    }
                    if k > 0.0 && holds(-k) {
                        data.push(Datum {
                            cell,
                            p: c64::new(g, -k),
                            q,
                            is_mirror: true,
                        });
                    }
                }
            }
        }
        data
    }

    fn joins(&self, patches: &[Patch]) -> Vec<Join> {
        let rows = self.edges().len() - 1;
        let mut joins = Vec::new();
        let weight = JOIN_WEIGHT;
        for (cell, patch) in patches.iter().enumerate() {
            if cell % rows + 1 < rows {
                let ends = patch.g.map(|g| c64::new(g, patch.k[1]));
                joins.extend(ends.map(|p| Join {
                    cells: [cell, cell + 1],
                    p,
                    weight,
                }));
            }
            if cell + rows < patches.len() {
                let outer = if self.sign > 0.0 {
                    patch.g[1]
                } else {
                    patch.g[0]
                };
                let ends = patch.k.map(|k| c64::new(outer, k));
                joins.extend(ends.map(|p| Join {
                    cells: [cell, cell + rows],
                    p,
                    weight,
                }));
            }
        }
        joins
    }

    fn cells(&self) -> Result<(Vec<Cell>, usize, usize), FitError> {
        let patches = self.patches();
        let data = self.data(&patches);
        let fitted = fit_patches(&patches, &data, &self.joins(&patches), self.table.shape())?;
        let rows = self.edges().len() - 1;
        let cells = patches
            .iter()
            .zip(fitted.coefficients)
            .enumerate()
            .filter(|(_, (patch, _))| patch.k[1] > 0.0)
            .map(|(number, (patch, coefficients))| {
                cell_of(
                    patch,
                    self.bounds(number / rows, self.inner_edge),
                    coefficients,
                )
            })
            .filter(|cell| cell.g[1] > cell.g[0])
            .collect();
        Ok((cells, fitted.equations, fitted.rank))
    }
}

fn misfit(fit: &PiecewiseQuadratic, table: &GafTable) -> f64 {
    let (mut worst, mut scale): (f64, f64) = (0.0, f64::MIN_POSITIVE);
    for (i, &g) in table.g().iter().enumerate() {
        for (j, &k) in table.k().iter().enumerate() {
            if let Some(q) = table.sample(i, j) {
                let p = c64::new(g, k);
                let model: Mat<c64> = fit.cell_at(p).q(p);
                scale = scale.max(largest(q.as_ref()));
                worst = worst.max(largest((model - q).as_ref()));
            }
        }
    }
    worst / scale
}
