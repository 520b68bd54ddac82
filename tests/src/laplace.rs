//! Q is analytic off its branch cut, and conjugate at conjugate points.

use faer::{Mat, c64};
use fladder_bem::TransferModel;

use crate::case::Fault;
use crate::row::Row;

/// Sizes of p at which the derivatives are compared.
const SIZES: [f64; 3] = [0.05, 0.2, 0.5];

/// Step of the differences: truncation is h²|Q'''|, rounding ε |Q|/h.
const STEP: f64 = 1e-4;

/// Residual of the Cauchy–Riemann equations by the size of the derivative, on arcs up to
/// 110° and from there to 150°, and the symmetry.
///
/// # Errors
/// A point the transfer model refuses.
pub fn analytic(case: &str, mesh: &str, transfer: &TransferModel) -> Result<Vec<Row>, Fault> {
    let row = |what: &str, figure: &str, error: f64, goal: f64| Row {
        case: format!("{case}: {what}"),
        mesh: mesh.to_owned(),
        figure: figure.to_owned(),
        error,
        goal,
    };
    let difference = "difference of the derivatives along g and k, by their size";
    Ok(vec![
        row(
            "Cauchy–Riemann, arg p = 10 … 110°",
            difference,
            worst(transfer, (1..=11).map(|i| 10.0 * f64::from(i)))?,
            1e-5,
        ),
        row(
            "Cauchy–Riemann, arg p = 115 … 150°",
            difference,
            worst(transfer, (0..=7).map(|i| 115.0 + 5.0 * f64::from(i)))?,
            1e-4,
        ),
        row(
            "one function along arcs, arg p = 10 … 150°",
            "fourth difference over steps of 0.25°: a jump where the path of the far wake changes",
            jump(transfer)?,
            1e-6,
        ),
        row(
            "Q at conjugate points",
            "largest difference, must be none",
            asymmetry(transfer)?,
            0.0,
        ),
    ])
}

fn worst(
    transfer: &TransferModel,
    angles_deg: impl IntoIterator<Item = f64>,
) -> Result<f64, Fault> {
    let mut worst = 0.0_f64;
    for angle in angles_deg {
        for size in SIZES {
            let p = c64::from_polar(size, angle.to_radians());
            worst = worst.max(residual(transfer, p)?);
        }
    }
    Ok(worst)
}

/// Largest fourth difference of Q along arcs, by the largest entry: about (0.0044)⁴ for a
/// smooth function, up to six times its jump for one that has one.
fn jump(transfer: &TransferModel) -> Result<f64, Fault> {
    const WEIGHTS: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];
    let mut worst = 0.0_f64;
    for size in SIZES {
        let along: Result<Vec<Mat<c64>>, Fault> = (40..=600)
            .map(|i| f64::from(i) * 0.25)
            .map(|degrees| Ok(transfer.q(c64::from_polar(size, degrees.to_radians()))?))
            .collect();
        for five in along?.windows(5) {
            let mut difference = Mat::zeros(five[0].nrows(), five[0].ncols());
            for (q, weight) in five.iter().zip(WEIGHTS) {
                difference += q * faer::Scale(c64::new(weight, 0.0));
            }
            worst = worst.max(difference.norm_max() / five[2].norm_max());
        }
    }
    Ok(worst)
}

fn residual(transfer: &TransferModel, p: c64) -> Result<f64, Fault> {
    let step = STEP * p.norm().max(0.1);
    let slope = |direction: c64| -> Result<Mat<c64>, Fault> {
        let ahead = transfer.q(p + direction * step)?;
        let behind = transfer.q(p - direction * step)?;
        let scale = 0.5 / (direction * step);
        Ok(Mat::from_fn(ahead.nrows(), ahead.ncols(), |i, j| {
            (ahead[(i, j)] - behind[(i, j)]) * scale
        }))
    };
    let along_g = slope(c64::new(1.0, 0.0))?;
    let along_k = slope(c64::new(0.0, 1.0))?;
    Ok((&along_g - &along_k).norm_max() / along_g.norm_max())
}

fn asymmetry(transfer: &TransferModel) -> Result<f64, Fault> {
    let mut worst = 0.0_f64;
    for p in [c64::new(0.0, 0.3), c64::new(-0.1, 0.4), c64::new(0.2, 0.05)] {
        let (above, below) = (transfer.q(p)?, transfer.q(p.conj())?);
        for j in 0..above.ncols() {
            for i in 0..above.nrows() {
                worst = worst.max((above[(i, j)].conj() - below[(i, j)]).norm());
            }
        }
    }
    Ok(worst)
}
