//! The p2 method: $Q$ as a quadratic in $p$ on each rectangle of the plane.
//!
//! $$ Q(p) \approx Q_0 + Q_1 p + Q_2 p^2,\qquad p\in S_{ij} $$
//!
//! turns the nonlinear eigenproblem into one quadratic eigenproblem a
//! rectangle, without iteration. Eller, IFASD-2009-119, sec. 2.

mod axis;
mod laplace;
mod literal;
mod patches;
mod roots;

pub use roots::Candidate;
pub(crate) use roots::{
    REAL_ROOT, ZERO_ROOT, candidates, candidates_of, cell_eigenvalues, free_modes,
    low_candidates, roots, roots_near, within_cells,
};

use faer::{Mat, c64};

use crate::aerodynamics::Aerodynamics;
use crate::gaf::GafTable;
use crate::linalg::{NoConvergence, largest};

/// Roots are sought for $|g|$ up to this where the samples lie on the
/// imaginary axis alone: beyond it a quadratic continued from the axis is no
/// more than a guess.
pub const DEFAULT_DAMPING_LIMIT: f64 = 0.2;

/// One rectangle and its quadratic.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Lower and upper edge in $g$.
    pub g: [f64; 2],
    /// Lower and upper edge in $k$.
    pub k: [f64; 2],
    /// $Q_0, Q_1, Q_2$.
    pub coefficients: [Mat<c64>; 3],
    /// The cell straddles $k = 0$ and its coefficients are real.
    pub is_mirrored: bool,
}

impl Cell {
    /// $Q_0 + Q_1 p + Q_2 p^2$.
    pub fn q(&self, p: c64) -> Mat<c64> {
        let [q0, q1, q2] = &self.coefficients;
        Mat::from_fn(q0.nrows(), q0.ncols(), |i, j| {
            q0[(i, j)] + p * (q1[(i, j)] + p * q2[(i, j)])
        })
    }

    /// $Q_1 + 2Q_2p$.
    pub fn slope(&self, p: c64) -> Mat<c64> {
        let [_, q1, q2] = &self.coefficients;
        Mat::from_fn(q1.nrows(), q1.ncols(), |i, j| {
            q1[(i, j)] + p * 2.0 * q2[(i, j)]
        })
    }

    /// Whether two cells share an edge or a corner.
    pub(crate) fn touches(&self, other: &Self) -> bool {
        let meet = |a: [f64; 2], b: [f64; 2]| a[0] <= b[1] && b[0] <= a[1];
        meet(self.g, other.g) && meet(self.k, other.k)
    }

    /// How far `p` lies outside, in parts of the cell's width and height;
    /// negative inside.
    pub fn overshoot(&self, p: c64) -> f64 {
        let outside =
            |value: f64, [low, high]: [f64; 2]| (low - value).max(value - high) / (high - low);
        outside(p.re, self.g).max(outside(p.im, self.k))
    }
}

/// What the fit of the coefficients met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitReport {
    /// Equations for each entry of $Q$.
    pub equations: usize,
    /// Unknown coefficients for each entry.
    pub unknowns: usize,
    /// Rank of the design matrix.
    pub rank: usize,
    /// Largest misfit at a sample, as a fraction of the largest entry.
    pub residual: f64,
    /// Whether $Q(0)$ is met exactly in the cell around the origin.
    pub is_pinned: bool,
}

/// Why no fit was made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// The decomposition of the design matrix failed.
    #[error("the fit of Q failed: {0}")]
    Decomposition(#[from] NoConvergence),
    /// The limit of damping is not positive.
    #[error("the limit of |g| is {0}, it must be positive")]
    DampingLimit(f64),
}

/// A piecewise quadratic model of $Q$ on the upper half plane.
#[derive(Clone, Debug)]
pub struct PiecewiseQuadratic {
    cells: Vec<Cell>,
    report: FitReport,
    shape: [usize; 2],
    notes: Vec<String>,
}

impl PiecewiseQuadratic {
    /// One cell for every sample on the imaginary axis, edges half-way between
    /// samples.
    ///
    /// Value and slope are continuous across the edges on the axis, the last
    /// two cells are one, the lowest cell is mirrored about $k = 0$ with real
    /// coefficients and $Q(0)$ exact: a quadratic spline in $p$ with its knots
    /// half-way between the data (knots *at* the data oscillate). Samples off
    /// the axis are not used.
    ///
    /// # Errors
    /// A damping limit that is not positive, a decomposition that fails.
    pub fn centred(table: &GafTable, damping_limit: f64) -> Result<Self, FitError> {
        if !(damping_limit > 0.0 && damping_limit.is_finite()) {
            return Err(FitError::DampingLimit(damping_limit));
        }
        axis::fit(table, damping_limit)
    }

    /// Rectangles for a grid in $g$ and $k$; the inner column $|g|\le0.05$ is
    /// that of [`centred`](Self::centred).
    ///
    /// Roots with $g < -0.05$ come out ten to a hundred times better than from
    /// samples on the axis alone. The region is that of the samples.
    ///
    /// # Errors
    /// A decomposition that fails.
    pub fn laplace(table: &GafTable) -> Result<Self, FitError> {
        laplace::fit(table)
    }

    /// The fit as the paper words it, from samples on the axis, for
    /// comparison: not continuous enough to place a flutter point better than
    /// 0.3 %.
    ///
    /// # Errors
    /// As [`centred`](Self::centred).
    pub fn literal(table: &GafTable, damping_limit: f64) -> Result<Self, FitError> {
        if !(damping_limit > 0.0 && damping_limit.is_finite()) {
            return Err(FitError::DampingLimit(damping_limit));
        }
        literal::fit(table, damping_limit)
    }

    /// [`laplace`](Self::laplace) where the table has samples off the axis,
    /// [`centred`](Self::centred) up to [`DEFAULT_DAMPING_LIMIT`] otherwise.
    ///
    /// # Errors
    /// A decomposition that fails.
    pub fn of(table: &GafTable) -> Result<Self, FitError> {
        if table.g().len() > 1 {
            Self::laplace(table)
        } else {
            Self::centred(table, DEFAULT_DAMPING_LIMIT)
        }
    }

    /// The rectangles.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// What the fit met.
    pub fn report(&self) -> FitReport {
        self.report
    }

    /// What a user should know, one sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Bounds of the region: $|g|$ up to the first, $k$ up to the second.
    pub fn region(&self) -> Region {
        let fold = |values: &dyn Fn(&Cell) -> f64, pick: fn(f64, f64) -> f64| {
            self.cells
                .iter()
                .map(values)
                .fold(values(&self.cells[0]), pick)
        };
        Region {
            g: [
                fold(&|cell| cell.g[0], f64::min),
                fold(&|cell| cell.g[1], f64::max),
            ],
            k_max: fold(&|cell| cell.k[1], f64::max),
        }
    }

    /// Largest jump of $Q$ between cells above each other, at one $g$, as a
    /// fraction of the largest entry met there.
    pub fn jump_at(&self, g: f64) -> f64 {
        let (mut jump, mut scale) = (0.0_f64, f64::MIN_POSITIVE);
        let holds = |cell: &&Cell| (cell.g[0]..=cell.g[1]).contains(&g);
        let cells: Vec<&Cell> = self.cells.iter().filter(holds).collect();
        for lower in &cells {
            for upper in cells.iter().filter(|upper| upper.k[0] == lower.k[1]) {
                let p = c64::new(g, lower.k[1]);
                let (here, there) = (lower.q(p), upper.q(p));
                scale = scale.max(largest(here.as_ref()));
                jump = jump.max(largest((here - there).as_ref()));
            }
        }
        jump / scale
    }

    /// $\mathrm dQ_{ij}/\mathrm dp$ at the origin, from the lowest cell.
    pub fn slope_at_origin(&self, row: usize, column: usize) -> f64 {
        self.cell_at(c64::new(0.0, 0.0)).coefficients[1][(row, column)].re
    }

    /// The cell that holds `p`, or the nearest one.
    pub fn cell_at(&self, p: c64) -> &Cell {
        self.cells
            .iter()
            .min_by(|a, b| a.overshoot(p).total_cmp(&b.overshoot(p)))
            .expect("a fit has at least one cell")
    }
}

/// The part of the plane in which roots are sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Lower and upper bound of $g$.
    pub g: [f64; 2],
    /// Upper bound of $k$.
    pub k_max: f64,
}

impl Region {
    /// Whether a root lies inside or on the border.
    pub fn holds(&self, p: c64) -> bool {
        p.re >= self.g[0] && p.re <= self.g[1] && p.im >= 0.0 && p.im <= self.k_max
    }
}

/// The piecewise model is discontinuous across edges off the axis: fit for
/// evaluation, not for a Newton iteration across an edge.
impl Aerodynamics for PiecewiseQuadratic {
    fn order(&self) -> usize {
        self.shape[0]
    }

    fn q(&self, p: c64) -> Mat<c64> {
        if p.im < 0.0 {
            let mirrored = self.cell_at(p.conj()).q(p.conj());
            let [rows, columns] = self.shape;
            return Mat::from_fn(rows, columns, |i, j| mirrored[(i, j)].conj());
        }
        self.cell_at(p).q(p)
    }
}
