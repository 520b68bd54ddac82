//! All roots of a rational model at once.
//!
//! With $Q = Q_0 + R_1p + R_2p^2 + \sum_jR_{2+j}\,p/(p-a_j)$ and lag states
//! $\dot w_j = a_jw_j + \dot x$ the problem is linear in the states
//! $(x, v, w)$: one standard eigenproblem of order $n(2 + m)$, dear but
//! complete. It gives the seeds where the count says that a root is missing.

use faer::{Mat, c64};

use crate::linalg::{Lu, NoConvergence, eigenvalues_real};
use crate::rational::{Pole, RationalFit};
use crate::structure::{Hysteresis, Reduced};

/// A state-space model of the aircraft at one flight condition.
#[derive(Clone, Debug)]
pub struct StateMatrix {
    /// True airspeed in m/s.
    pub airspeed: f64,
    /// Air density in kg/m³.
    pub density: f64,
    /// $A$ of $\dot x = Ax$ in 1/s, $x = (\xi, (b/U)\dot\xi, w_1, …)$.
    pub matrix: Mat<f64>,
    /// $M$.
    pub mass: Mat<f64>,
    /// $C$ of this flight condition, without the air, without hysteretic damping.
    pub damping: Mat<f64>,
    /// $K$, with gravity where it acts.
    pub stiffness: Mat<f64>,
    /// Poles $a_j$ of the rational model, of $p$: on the real axis and above it.
    pub poles: Vec<c64>,
}

impl StateMatrix {
    /// Names of the states for modes with these names: `NAME`, `rate of NAME`, and for each
    /// pole `lag J of NAME`, for a pair `lag J re of NAME`, `lag J im of NAME`.
    pub fn states(&self, modes: &[String]) -> Vec<String> {
        let mut prefixes = vec![String::new(), "rate of ".to_owned()];
        for (number, pole) in (1..).zip(&self.poles) {
            if pole.im > 0.0 {
                prefixes.push(format!("lag {number} re of "));
                prefixes.push(format!("lag {number} im of "));
            } else {
                prefixes.push(format!("lag {number} of "));
            }
        }
        prefixes
            .iter()
            .flat_map(|prefix| modes.iter().map(move |mode| format!("{prefix}{mode}")))
            .collect()
    }
}

/// Every root of the rational model with $\operatorname{Im}p\ge0$, without
/// hysteretic damping.
pub(crate) fn all_roots(
    reduced: &Reduced,
    fit: &RationalFit,
) -> Result<Vec<c64>, NoConvergence> {
    let values = eigenvalues_real(state_matrix(reduced, fit).as_ref())?;
    Ok(values.into_iter().filter(|value| value.im >= 0.0).collect())
}

/// The matrix whose eigenvalues are the roots $p$ of the rational model, without
/// hysteretic damping.
pub(crate) fn state_matrix(reduced: &Reduced, fit: &RationalFit) -> Mat<f64> {
    let order = reduced.order();
    let loads = |matrix: &Mat<f64>| {
        let real = reduced.real_loads(matrix);
        Mat::from_fn(order, order, |i, j| c64::new(real[(i, j)], 0.0))
    };
    let coefficients: Vec<Mat<c64>> = fit.coefficients.iter().map(loads).collect();
    let (rest, lags) = (loads(&fit.at_rest), coefficients.len() - 2);
    let stiffness = reduced.stiffness(Hysteresis::LeftOut);
    let size = order * (2 + lags);
    let mut right = Mat::from_fn(order, size, |i, column| {
        let (block, j) = (column / order, column % order);
        match block {
            0 => rest[(i, j)] - stiffness[(i, j)],
            1 => coefficients[0][(i, j)] - reduced.damping[(i, j)],
            _ => coefficients[block][(i, j)] * lag_factor(fit, block - 2),
        }
    });
    let leading = Mat::from_fn(order, order, |i, j| {
        reduced.mass[(i, j)] - coefficients[1][(i, j)]
    });
    Lu::new(leading).solve(right.as_mut());
    let mut matrix = Mat::<f64>::zeros(size, size);
    for j in 0..size {
        for i in 0..order {
            matrix[(order + i, j)] = right[(i, j)].re;
        }
    }
    for i in 0..order {
        matrix[(i, order + i)] = 1.0;
    }
    fill_lags(&mut matrix, fit, order);
    matrix
}

/// The pair functions are $w+\bar w$ and $\mathrm i(w-\bar w)$: twice the real
/// part and minus twice the imaginary part of the lag.
fn lag_factor(fit: &RationalFit, lag: usize) -> f64 {
    let mut factors = Vec::new();
    for pole in &fit.poles {
        match pole {
            Pole::Real(_) => factors.push(1.0),
            Pole::Pair(_) => factors.extend([2.0, -2.0]),
        }
    }
    factors[lag]
}

fn fill_lags(matrix: &mut Mat<f64>, fit: &RationalFit, order: usize) {
    let mut block = 2;
    for pole in &fit.poles {
        for i in 0..order {
            let at = block * order + i;
            matrix[(at, order + i)] = 1.0;
            match *pole {
                Pole::Real(a) => matrix[(at, at)] = a,
                Pole::Pair(a) => {
                    let beside = at + order;
                    matrix[(at, at)] = a.re;
                    matrix[(at, beside)] = -a.im;
                    matrix[(beside, at)] = a.im;
                    matrix[(beside, beside)] = a.re;
                }
            }
        }
        block += match pole {
            Pole::Real(_) => 1,
            Pole::Pair(_) => 2,
        };
    }
}
