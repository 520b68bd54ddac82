//! Least-squares fit of neighbouring rectangles.
//!
//! Each cell meets its samples; where two cells share an edge their values
//! are asked to agree at some points, with a weight. One design matrix serves
//! all entries of $Q$.

use faer::{Mat, c64};

use super::{Cell, FitError};
use crate::linalg::least_squares;

/// A rectangle before it has coefficients.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    pub(super) g: [f64; 2],
    pub(super) k: [f64; 2],
}

impl Patch {
    fn centre(&self) -> c64 {
        c64::new(
            f64::midpoint(self.g[0], self.g[1]),
            f64::midpoint(self.k[0], self.k[1]),
        )
    }

    fn half_diagonal(&self) -> f64 {
        0.5 * (self.g[1] - self.g[0]).hypot(self.k[1] - self.k[0])
    }

    /// $1, t, t^2$ with $t$ the place in the cell.
    fn powers(&self, p: c64) -> [c64; 3] {
        let t = (p - self.centre()) / self.half_diagonal();
        [c64::new(1.0, 0.0), t, t * t]
    }
}

/// A sample that a cell must meet.
pub(super) struct Datum<'a> {
    pub(super) cell: usize,
    pub(super) p: c64,
    pub(super) q: &'a Mat<c64>,
    /// The sample is the mirror image of `q` at $\bar p$.
    pub(super) is_mirror: bool,
}

/// A point at which two cells should agree.
pub(super) struct Join {
    pub(super) cells: [usize; 2],
    pub(super) p: c64,
    pub(super) weight: f64,
}

/// Outcome: cells, equations and rank.
pub(super) struct Fitted {
    pub(super) coefficients: Vec<[Mat<c64>; 3]>,
    pub(super) equations: usize,
    pub(super) rank: usize,
}

/// Solves for the coefficients of all patches, in powers of $p$.
pub(super) fn fit_patches(
    patches: &[Patch],
    data: &[Datum<'_>],
    joins: &[Join],
    shape: [usize; 2],
) -> Result<Fitted, FitError> {
    let equations = data.len() + joins.len();
    let mut design = Mat::<c64>::zeros(equations, 3 * patches.len());
    let mut rhs = Mat::<c64>::zeros(equations, shape[0] * shape[1]);
    for (row, datum) in data.iter().enumerate() {
        for (power, value) in patches[datum.cell].powers(datum.p).into_iter().enumerate() {
            design[(row, 3 * datum.cell + power)] = value;
        }
        for entry in 0..shape[0] * shape[1] {
            let value = datum.q[(entry % shape[0], entry / shape[0])];
            rhs[(row, entry)] = if datum.is_mirror { value.conj() } else { value };
        }
    }
    for (number, join) in joins.iter().enumerate() {
        for (cell, sign) in join.cells.into_iter().zip([1.0, -1.0]) {
            for (power, value) in patches[cell].powers(join.p).into_iter().enumerate() {
                design[(data.len() + number, 3 * cell + power)] = value * (sign * join.weight);
            }
        }
    }
    let solved = least_squares(design.as_ref(), rhs.as_ref())?;
    let coefficients = patches
        .iter()
        .enumerate()
        .map(|(cell, patch)| in_powers_of_p(patch, &solved.solution, cell, shape))
        .collect();
    Ok(Fitted {
        coefficients,
        equations,
        rank: solved.rank,
    })
}

fn in_powers_of_p(
    patch: &Patch,
    solution: &Mat<c64>,
    cell: usize,
    [rows, columns]: [usize; 2],
) -> [Mat<c64>; 3] {
    let (alpha, beta) = (
        1.0 / patch.half_diagonal(),
        -patch.centre() / patch.half_diagonal(),
    );
    [0, 1, 2].map(|exponent| {
        Mat::from_fn(rows, columns, |row, column| {
            let local = |index: usize| solution[(3 * cell + index, column * rows + row)];
            match exponent {
                0 => local(0) + local(1) * beta + local(2) * beta * beta,
                1 => (local(1) + local(2) * 2.0 * beta) * alpha,
                _ => local(2) * alpha * alpha,
            }
        })
    })
}

/// A cell from a patch, cut to the columns where it is valid; one that
/// straddles $k = 0$ gets real coefficients.
pub(super) fn cell_of(patch: &Patch, g: [f64; 2], coefficients: [Mat<c64>; 3]) -> Cell {
    let is_mirrored = patch.k[0] < 0.0;
    let coefficients = if is_mirrored {
        coefficients.map(|matrix| {
            Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
                c64::new(matrix[(i, j)].re, 0.0)
            })
        })
    } else {
        coefficients
    };
    Cell {
        g,
        k: patch.k,
        coefficients,
        is_mirrored,
    }
}
