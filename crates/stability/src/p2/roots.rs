//! Roots of the quadratic eigenproblems, one a cell.
//!
//! $$ \bigl[(\tilde M - qQ_2)p^2 + (\tilde C - qQ_1)p + (K - qQ_0)\bigr]x = 0 $$
//!
//! as a standard eigenproblem of twice the order after division by the
//! leading matrix. In the cell around the origin a column of $K - qQ_0$ that
//! is exactly zero is a zero root with a known vector; its displacement is
//! taken out of the problem and the root counted, so that zeros are exact and
//! cannot be mistaken for slow motions.

use faer::{Mat, c64};

use super::{Cell, PiecewiseQuadratic};
use crate::eigenpair::{Eigenpair, inverse_iteration};
use crate::linalg::{Lu, NoConvergence, eigenvalues, eigenvalues_real, inner, largest, length};
use crate::structure::{Hysteresis, Reduced};

/// Roots closer to the origin than this are zero.
pub(crate) const ZERO_ROOT: f64 = 1e-9;

/// Imaginary parts below this are rounding: the root is real.
pub(crate) const REAL_ROOT: f64 = 1e-9;

/// Two candidates of neighbouring cells closer than this many times the
/// effect of the jump between the cells are one root.
const JUMP_RADIUS: f64 = 3.0;

/// A root proposed by one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// The root.
    pub p: c64,
    /// Number of the cell.
    pub cell: usize,
    /// How far outside the cell it lies, in parts of the cell's size.
    pub overshoot: f64,
}

/// Eigenvalues of one cell.
pub(crate) struct CellRoots {
    pub(crate) values: Vec<c64>,
    /// Zero roots taken out beforehand.
    pub(crate) zeros: usize,
}

/// All roots at one speed.
#[derive(Clone, Debug, Default)]
pub(crate) struct SpeedRoots {
    pub(crate) roots: Vec<Eigenpair>,
    pub(crate) zeros: usize,
}

/// Every eigenvalue of the cell's problem, wherever it lies.
pub(crate) fn cell_eigenvalues(
    cell: &Cell,
    reduced: &Reduced,
) -> Result<CellRoots, NoConvergence> {
    let order = reduced.order();
    let [q0, q1, q2] = cell.coefficients.each_ref().map(|q| reduced.loads(q));
    let stiffness = reduced.stiffness(hysteresis_of(cell));
    let a0 = &stiffness - &q0;
    let kept: Vec<usize> = if cell.is_mirrored {
        (0..order)
            .filter(|&mode| (0..order).any(|row| a0[(row, mode)].norm() != 0.0))
            .collect()
    } else {
        (0..order).collect()
    };
    let a2 = Mat::from_fn(order, order, |i, j| reduced.mass[(i, j)] - q2[(i, j)]);
    let mut right = Mat::from_fn(order, kept.len() + order, |i, j| {
        if let Some(&mode) = kept.get(j) {
            -a0[(i, mode)]
        } else {
            let mode = j - kept.len();
            q1[(i, mode)] - reduced.damping[(i, mode)]
        }
    });
    Lu::new(a2).solve(right.as_mut());
    let companion = companion(&kept, &right);
    let values = if cell.is_mirrored {
        let size = companion.nrows();
        eigenvalues_real(Mat::from_fn(size, size, |i, j| companion[(i, j)].re).as_ref())?
    } else {
        eigenvalues(companion.as_ref())?
    };
    Ok(CellRoots {
        values,
        zeros: order - kept.len(),
    })
}

/// State: the kept displacements, then all velocities.
fn companion(kept: &[usize], accelerations: &Mat<c64>) -> Mat<c64> {
    let (positions, order) = (kept.len(), accelerations.nrows());
    Mat::from_fn(positions + order, positions + order, |i, j| {
        if i >= positions {
            accelerations[(i - positions, j)]
        } else if j >= positions && j - positions == kept[i] {
            c64::new(1.0, 0.0)
        } else {
            c64::new(0.0, 0.0)
        }
    })
}

fn hysteresis_of(cell: &Cell) -> Hysteresis {
    if cell.is_mirrored {
        Hysteresis::LeftOut
    } else {
        Hysteresis::Included
    }
}

/// Candidates of all cells that lie outside their cell by no more than
/// `tolerance` of its size, and the number of zero roots.
pub(crate) fn candidates(
    fit: &PiecewiseQuadratic,
    reduced: &Reduced,
    tolerance: f64,
) -> Result<(Vec<Candidate>, usize), NoConvergence> {
    candidates_where(fit, reduced, tolerance, |_| true)
}

/// Candidates of the cells that straddle $k = 0$ alone, and the number of zero
/// roots.
pub(crate) fn low_candidates(
    fit: &PiecewiseQuadratic,
    reduced: &Reduced,
    tolerance: f64,
) -> Result<(Vec<Candidate>, usize), NoConvergence> {
    candidates_where(fit, reduced, tolerance, |cell| cell.is_mirrored)
}

/// Number of modes that meet no force at rest: zero roots whose vectors are
/// known.
pub(crate) fn free_modes(fit: &PiecewiseQuadratic, reduced: &Reduced) -> usize {
    let home = fit.cell_at(c64::new(0.0, 0.0));
    let at_rest = reduced.loads(&home.coefficients[0]);
    let stiffness = reduced.stiffness(hysteresis_of(home));
    let order = reduced.order();
    let is_free =
        |mode: &usize| (0..order).all(|row| stiffness[(row, *mode)] == at_rest[(row, *mode)]);
    if home.is_mirrored {
        (0..order).filter(is_free).count()
    } else {
        0
    }
}

/// Candidates of one cell that are not zero.
pub(crate) fn candidates_of(
    cell: &Cell,
    reduced: &Reduced,
    tolerance: f64,
) -> Result<Vec<c64>, NoConvergence> {
    let roots = cell_eigenvalues(cell, reduced)?;
    let values = roots.values.into_iter().filter(|p| p.norm() >= ZERO_ROOT);
    Ok(values
        .filter_map(|p| accept(cell, 0, p, tolerance))
        .map(|candidate| candidate.p)
        .collect())
}

fn candidates_where(
    fit: &PiecewiseQuadratic,
    reduced: &Reduced,
    tolerance: f64,
    wanted: impl Fn(&Cell) -> bool,
) -> Result<(Vec<Candidate>, usize), NoConvergence> {
    let (mut found, mut zeros) = (Vec::new(), 0);
    let cells = fit.cells.iter().enumerate();
    for (index, cell) in cells.filter(|(_, cell)| wanted(cell)) {
        let roots = cell_eigenvalues(cell, reduced)?;
        let is_home = cell.is_mirrored && cell.g[0] < 0.0 && cell.g[1] > 0.0;
        let is_zero = |p: &&c64| p.norm() < ZERO_ROOT;
        if is_home {
            zeros += roots.zeros + roots.values.iter().filter(is_zero).count();
        }
        found.extend(
            roots
                .values
                .into_iter()
                .filter(|p| !is_zero(&p))
                .filter_map(|p| accept(cell, index, p, tolerance)),
        );
    }
    Ok((found, zeros))
}

fn accept(cell: &Cell, index: usize, p: c64, tolerance: f64) -> Option<Candidate> {
    let p = if p.im.abs() < REAL_ROOT {
        c64::new(p.re, 0.0)
    } else {
        p
    };
    let overshoot = cell.overshoot(p);
    let wanted = p.im >= 0.0 && overshoot <= tolerance;
    wanted.then_some(Candidate {
        p,
        cell: index,
        overshoot,
    })
}

/// Roots at one speed: candidates within 5 % of their cells, each once.
pub(crate) fn roots(
    fit: &PiecewiseQuadratic,
    reduced: &Reduced,
) -> Result<SpeedRoots, NoConvergence> {
    let (found, zeros) = candidates(fit, reduced, EDGE_TOLERANCE)?;
    Ok(SpeedRoots {
        roots: deduplicate(fit, reduced, &found),
        zeros,
    })
}

/// Roots among wider candidates: those within 5 % of their cells, each once.
pub(crate) fn within_cells(
    fit: &PiecewiseQuadratic,
    reduced: &Reduced,
    found: &[Candidate],
) -> Vec<Eigenpair> {
    let near: Vec<Candidate> = found
        .iter()
        .copied()
        .filter(|c| c.overshoot <= EDGE_TOLERANCE)
        .collect();
    deduplicate(fit, reduced, &near)
}

/// Roots of the cells near a place, for the search of a crossing; those that
/// pass through zero are among them.
pub(crate) fn roots_near(
    fit: &PiecewiseQuadratic,
    reduced: &Reduced,
    place: c64,
    distance: f64,
) -> Result<Vec<Eigenpair>, NoConvergence> {
    let mut found = Vec::new();
    for (index, cell) in fit.cells.iter().enumerate() {
        if cell.overshoot(place) > distance {
            continue;
        }
        let roots = cell_eigenvalues(cell, reduced)?;
        found.extend(
            roots
                .values
                .into_iter()
                .filter_map(|p| accept(cell, index, p, EDGE_TOLERANCE)),
        );
    }
    Ok(deduplicate(fit, reduced, &found))
}

/// No root was lost at this tolerance with a fit that is continuous on the
/// axis; a larger one only adds copies.
const EDGE_TOLERANCE: f64 = 0.05;

/// Gives every candidate its vectors and drops the copies that neighbouring
/// cells make of one root, keeping the one that lies inside its own cell.
pub(crate) fn deduplicate(
    fit: &PiecewiseQuadratic,
    reduced: &Reduced,
    found: &[Candidate],
) -> Vec<Eigenpair> {
    let mut ordered = found.to_vec();
    ordered.sort_by(|a, b| a.overshoot.max(0.0).total_cmp(&b.overshoot.max(0.0)));
    let mut kept: Vec<(Candidate, Eigenpair)> = Vec::new();
    for candidate in ordered {
        let cell = &fit.cells[candidate.cell];
        let operator = reduced.operator(candidate.p, &cell.q(candidate.p), hysteresis_of(cell));
        let pair = inverse_iteration(candidate.p, operator);
        let is_copy = kept.iter().any(|(other, other_pair)| {
            other.cell != candidate.cell
                && cell.touches(&fit.cells[other.cell])
                && is_same_root(fit, reduced, (&candidate, &pair), (other, other_pair))
        });
        if !is_copy {
            kept.push((candidate, pair));
        }
    }
    let mut roots: Vec<Eigenpair> = kept.into_iter().map(|(_, pair)| pair).collect();
    roots.sort_by(|a, b| a.p.im.total_cmp(&b.p.im).then(a.p.re.total_cmp(&b.p.re)));
    roots
}

/// The jump $\Delta Q$ between two cells moves a root by
/// $|qy^H\Delta Qx|/|y^HT'x|$.
fn is_same_root(
    fit: &PiecewiseQuadratic,
    reduced: &Reduced,
    (first, first_pair): (&Candidate, &Eigenpair),
    (second, second_pair): (&Candidate, &Eigenpair),
) -> bool {
    let distance = (first.p - second.p).norm();
    let (near, far) = (&fit.cells[first.cell], &fit.cells[second.cell]);
    let jump = reduced.loads(&(near.q(first.p) - far.q(first.p)));
    if largest(jump.as_ref()) == 0.0 {
        return distance < REAL_ROOT;
    }
    let slope = reduced.operator_slope(first.p, &near.slope(first.p));
    let (x, y) = (&first_pair.right, &first_pair.left);
    let effect = inner(y, &crate::linalg::apply(jump.as_ref(), x)).norm();
    let stiffness = inner(y, &crate::linalg::apply(slope.as_ref(), x)).norm();
    let hysteresis_step = match (hysteresis_of(near), hysteresis_of(far)) {
        (a, b) if a == b => 0.0,
        _ => {
            let change = reduced.stiffness(Hysteresis::Included)
                - reduced.stiffness(Hysteresis::LeftOut);
            inner(y, &crate::linalg::apply(change.as_ref(), x)).norm()
        }
    };
    let radius =
        JUMP_RADIUS * (effect + hysteresis_step) / stiffness.max(f64::MIN_POSITIVE) + REAL_ROOT;
    let alike = inner(x, &second_pair.right).norm() / (length(x) * length(&second_pair.right));
    distance < radius && alike > 0.5
}
