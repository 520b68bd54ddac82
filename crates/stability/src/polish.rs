//! Newton's iteration on the nonlinear eigenproblem.
//!
//! Unknowns $x$ and $p$, equations $T(p)x = 0$ and $y^Hx = 1$:
//! $$ \begin{bmatrix} T & T'x\\ y^H & 0\end{bmatrix}
//!    \begin{bmatrix}\Delta x\\ \Delta p\end{bmatrix} =
//!    -\begin{bmatrix} Tx\\ y^Hx - 1\end{bmatrix} $$
//! with the rows of $T$ scaled to unit size. It wants a $Q(p)$ that is smooth,
//! not the piecewise one: there it never settles across an edge.

use faer::{Mat, c64};

use crate::aerodynamics::Aerodynamics;
use crate::eigenpair::{Eigenpair, inverse_iteration, turned_to_unit};
use crate::linalg::{Lu, inner};
use crate::p2::{REAL_ROOT, ZERO_ROOT};
use crate::structure::{Hysteresis, Reduced};

/// Steps of $p$ are cut to this length.
const LONGEST_STEP: f64 = 0.3;

/// A root found further than this from its seed belongs to another seed.
const LONGEST_WAY: f64 = 0.1;

/// Step at which the iteration has converged, relative to $1 + |p|$.
const CONVERGED: f64 = 1e-13;

/// Step that is good enough when rounding keeps the iteration from the limit
/// above.
const ACCEPTABLE: f64 = 1e-10;

const MAX_STEPS: usize = 20;

/// Roots closer than this, relative to $1+|p|$, are one.
const SAME_ROOT: f64 = 1e-8;

/// Improves one root; `None` where the iteration fails or leaves the
/// neighbourhood.
pub(crate) fn polish(
    reduced: &Reduced,
    aerodynamics: &dyn Aerodynamics,
    seed: c64,
    start: Option<&[c64]>,
) -> Option<Eigenpair> {
    let hysteresis = Reduced::hysteresis_at(seed);
    let mut p = seed;
    let (mut q, mut slope) = aerodynamics.q_and_slope(p);
    let mut x: Vec<c64> = match start {
        Some(vector) => vector.to_vec(),
        None => inverse_iteration(p, reduced.operator(p, &q, hysteresis)).right,
    };
    let scale = turned_to_unit(&x);
    for value in &mut x {
        *value *= scale;
    }
    let anchor = x.clone();
    let mut last_step = f64::INFINITY;
    for _ in 0..MAX_STEPS {
        let operator = reduced.operator(p, &q, hysteresis);
        let step = newton_step(&operator, &reduced.operator_slope(p, &slope), &x, &anchor);
        let length = step.1.norm();
        if !length.is_finite() {
            return None;
        }
        let cut = if length > LONGEST_STEP {
            LONGEST_STEP / length
        } else {
            1.0
        };
        x.iter_mut()
            .zip(&step.0)
            .for_each(|(value, change)| *value += change * cut);
        p += step.1 * cut;
        let has_stalled = length >= 0.5 * last_step && length < ACCEPTABLE;
        if length < CONVERGED * (1.0 + p.norm()) || has_stalled {
            return finish(reduced, aerodynamics, p, seed, hysteresis);
        }
        if (p - seed).norm() > 3.0 * LONGEST_WAY {
            return None;
        }
        last_step = length;
        (q, slope) = aerodynamics.q_and_slope(p);
    }
    None
}

/// Changes of $x$ and $p$.
fn newton_step(
    operator: &Mat<c64>,
    slope: &Mat<c64>,
    x: &[c64],
    anchor: &[c64],
) -> (Vec<c64>, c64) {
    let order = operator.nrows();
    let mut bordered = Mat::zeros(order + 1, order + 1);
    let mut rhs = Mat::zeros(order + 1, 1);
    for i in 0..order {
        let size = (0..order)
            .map(|j| operator[(i, j)].norm())
            .fold(0.0, f64::max);
        let scale = 1.0 / size.max(f64::MIN_POSITIVE.sqrt());
        for j in 0..order {
            bordered[(i, j)] = operator[(i, j)] * scale;
            bordered[(i, order)] += slope[(i, j)] * x[j] * scale;
            rhs[(i, 0)] -= operator[(i, j)] * x[j] * scale;
        }
        bordered[(order, i)] = anchor[i].conj();
    }
    rhs[(order, 0)] = c64::new(1.0, 0.0) - inner(anchor, x);
    Lu::new(bordered).solve(rhs.as_mut());
    ((0..order).map(|i| rhs[(i, 0)]).collect(), rhs[(order, 0)])
}

fn finish(
    reduced: &Reduced,
    aerodynamics: &dyn Aerodynamics,
    p: c64,
    seed: c64,
    hysteresis: Hysteresis,
) -> Option<Eigenpair> {
    if (p - seed).norm() > LONGEST_WAY {
        return None;
    }
    let mut p = p;
    if p.im.abs() < REAL_ROOT {
        p = c64::new(p.re, 0.0);
    }
    if p.im < 0.0 {
        if hysteresis == Hysteresis::Included {
            return None;
        }
        p = p.conj();
    }
    Some(inverse_iteration(
        p,
        reduced.operator(p, &aerodynamics.q(p), hysteresis),
    ))
}

/// Polishes seeds, drops zero roots and merges the ones that meet; sorted by
/// $k$, then $g$.
pub(crate) fn polish_all(
    reduced: &Reduced,
    aerodynamics: &dyn Aerodynamics,
    seeds: &[c64],
) -> Vec<Eigenpair> {
    let mut roots: Vec<Eigenpair> = Vec::new();
    for &seed in seeds {
        if let Some(root) = polish(reduced, aerodynamics, seed, None)
            && root.p.norm() >= ZERO_ROOT
        {
            add_new(&mut roots, root);
        }
    }
    sort(&mut roots);
    roots
}

/// Adds a root unless it is in the list already.
pub(crate) fn add_new(roots: &mut Vec<Eigenpair>, root: Eigenpair) {
    let radius = SAME_ROOT * (1.0 + root.p.norm());
    if roots
        .iter()
        .all(|other| (other.p - root.p).norm() >= radius)
    {
        roots.push(root);
    }
}

/// By $k$, then by $g$.
pub(crate) fn sort(roots: &mut [Eigenpair]) {
    roots.sort_by(|a, b| a.p.im.total_cmp(&b.p.im).then(a.p.re.total_cmp(&b.p.re)));
}
