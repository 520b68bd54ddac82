//! Fit of the cells to samples on the imaginary axis.
//!
//! On the axis $p = \mathrm i\kappa$ the model is a quadratic spline in the
//! real variable $\kappa$, fitted to the samples and their mirror images
//! $Q(-\mathrm i\kappa) = \overline{Q(\mathrm i\kappa)}$. With $N$ samples,
//! $k_1 = 0$ among them, there are $2N-3$ cells and as many equations as
//! unknowns, $6N-9$.

use faer::{Mat, c64};

use super::{Cell, FitError, FitReport, PiecewiseQuadratic};
use crate::gaf::GafTable;
use crate::linalg::{largest, least_squares};

/// Cells and samples of the mirrored problem on the line.
struct Line {
    /// Samples, ascending, with the number of the sample and whether it is a
    /// mirror image.
    samples: Vec<(f64, usize, bool)>,
    /// Edges of the cells, ascending.
    edges: Vec<f64>,
}

impl Line {
    fn new(k: &[f64]) -> Self {
        let mut samples: Vec<(f64, usize, bool)> = k
            .iter()
            .enumerate()
            .rev()
            .filter(|(_, k)| **k > 0.0)
            .map(|(index, k)| (-k, index, true))
            .collect();
        samples.extend(k.iter().enumerate().map(|(index, &k)| (k, index, false)));
        let middles: Vec<f64> = samples
            .windows(2)
            .map(|pair| f64::midpoint(pair[0].0, pair[1].0))
            .collect();
        let inner = middles
            .get(1..middles.len().saturating_sub(1))
            .unwrap_or_default();
        let last = k[k.len() - 1];
        let mut edges = vec![-last];
        edges.extend(inner.iter().filter(|edge| **edge != 0.0));
        edges.push(last);
        Self { samples, edges }
    }

    fn cells(&self) -> usize {
        self.edges.len() - 1
    }

    fn centre(&self, cell: usize) -> f64 {
        f64::midpoint(self.edges[cell], self.edges[cell + 1])
    }

    fn half_width(&self, cell: usize) -> f64 {
        0.5 * (self.edges[cell + 1] - self.edges[cell])
    }

    fn cell_of(&self, kappa: f64) -> usize {
        (0..self.cells())
            .find(|&cell| kappa <= self.edges[cell + 1])
            .unwrap_or(self.cells() - 1)
    }

    /// $1, t, t^2$ with $t$ the place in the cell, −1 … 1.
    fn powers(&self, cell: usize, kappa: f64) -> [f64; 3] {
        let t = (kappa - self.centre(cell)) / self.half_width(cell);
        [1.0, t, t * t]
    }

    /// Derivative of the powers, in units of `scale` over length.
    fn slopes(&self, cell: usize, kappa: f64, scale: f64) -> [f64; 3] {
        let t = (kappa - self.centre(cell)) / self.half_width(cell);
        let factor = scale / self.half_width(cell);
        [0.0, factor, 2.0 * t * factor]
    }

    fn equations(&self) -> usize {
        self.samples.len() + 2 * (self.cells() - 1)
    }

    fn design(&self) -> Mat<c64> {
        let mut design = Mat::zeros(self.equations(), 3 * self.cells());
        let mut write = |row: usize, cell: usize, sign: f64, values: [f64; 3]| {
            for (power, value) in values.into_iter().enumerate() {
                design[(row, 3 * cell + power)] = c64::new(sign * value, 0.0);
            }
        };
        for (row, &(kappa, _, _)) in self.samples.iter().enumerate() {
            let cell = self.cell_of(kappa);
            write(row, cell, 1.0, self.powers(cell, kappa));
        }
        for left in 0..self.cells() - 1 {
            let (row, edge) = (self.samples.len() + 2 * left, self.edges[left + 1]);
            let scale = self.half_width(left).min(self.half_width(left + 1));
            for (cell, sign) in [(left, 1.0), (left + 1, -1.0)] {
                write(row, cell, sign, self.powers(cell, edge));
                write(row + 1, cell, sign, self.slopes(cell, edge, scale));
            }
        }
        design
    }
}

pub(super) fn fit(
    table: &GafTable,
    damping_limit: f64,
) -> Result<PiecewiseQuadratic, FitError> {
    let (line, shape) = (Line::new(table.k()), table.shape());
    let data: Vec<&Mat<c64>> = table.axis().collect();
    let mut rhs = Mat::zeros(line.equations(), shape[0] * shape[1]);
    for (row, &(_, sample, is_mirror)) in line.samples.iter().enumerate() {
        for entry in 0..shape[0] * shape[1] {
            let value = data[sample][(entry % shape[0], entry / shape[0])];
            rhs[(row, entry)] = if is_mirror { value.conj() } else { value };
        }
    }
    let solved = least_squares(line.design().as_ref(), rhs.as_ref())?;
    let is_pinned = table.k()[0] == 0.0;
    let mut cells: Vec<Cell> = (0..line.cells())
        .filter(|&cell| line.edges[cell + 1] > 0.0)
        .map(|cell| cell_of_solution(&line, cell, &solved.solution, shape, damping_limit))
        .collect();
    if is_pinned {
        cells[0].coefficients[0] = data[0].clone();
    }
    let mut notes = Vec::new();
    if !is_pinned {
        notes.push(
            "no sample at k = 0: the lowest cell is not pinned to Q(0), so zero, spiral and \
             divergence roots are extrapolated"
                .to_owned(),
        );
    }
    if table.g().len() > 1 {
        notes.push("samples off the imaginary axis were not used by the fit".to_owned());
    }
    let mut fit = PiecewiseQuadratic {
        cells,
        report: FitReport {
            equations: line.equations(),
            unknowns: 3 * line.cells(),
            rank: solved.rank,
            residual: 0.0,
            is_pinned,
        },
        shape,
        notes,
    };
    fit.report.residual = misfit(&fit, table.k(), &data);
    Ok(fit)
}

/// Coefficients in powers of $p$: with $\kappa = -\mathrm ip$ the local
/// variable is $t = \alpha p + \beta$.
fn cell_of_solution(
    line: &Line,
    cell: usize,
    solution: &Mat<c64>,
    [rows, columns]: [usize; 2],
    damping_limit: f64,
) -> Cell {
    let alpha = c64::new(0.0, -1.0 / line.half_width(cell));
    let beta = -line.centre(cell) / line.half_width(cell);
    let is_mirrored = line.edges[cell] < 0.0;
    let power = |exponent: usize| {
        Mat::from_fn(rows, columns, |row, column| {
            let local = |index: usize| solution[(3 * cell + index, column * rows + row)];
            let value = match exponent {
                0 => local(0) + local(1) * beta + local(2) * beta * beta,
                1 => (local(1) + local(2) * 2.0 * beta) * alpha,
                _ => local(2) * alpha * alpha,
            };
            if is_mirrored {
                c64::new(value.re, 0.0)
            } else {
                value
            }
        })
    };
    Cell {
        g: [-damping_limit, damping_limit],
        k: [line.edges[cell], line.edges[cell + 1]],
        coefficients: [power(0), power(1), power(2)],
        is_mirrored,
    }
}

fn misfit(fit: &PiecewiseQuadratic, k: &[f64], data: &[&Mat<c64>]) -> f64 {
    let scale = data.iter().map(|q| largest(q.as_ref())).fold(0.0, f64::max);
    let worst = k
        .iter()
        .zip(data)
        .map(|(&k, q)| {
            let p = c64::new(0.0, k);
            largest((fit.cell_at(p).q(p) - *q).as_ref())
        })
        .fold(0.0, f64::max);
    if scale > 0.0 { worst / scale } else { 0.0 }
}
