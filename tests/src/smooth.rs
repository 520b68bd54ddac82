//! Whether Q is smooth over its grid: each sample against what the others say of it.
//!
//! A rational function in barycentric form through the other samples and their mirror
//! images, Q(−k) = conj Q(k),
//!
//! $$ r(k) = \sum_j \frac{w_j f_j}{k - k_j} \Big/ \sum_j \frac{w_j}{k - k_j} , $$
//!
//! support points added one by one where r is worst, weights from the smallest singular
//! vector of the Loewner matrix. Nakatsukasa, Sète, Trefethen: The AAA algorithm for rational
//! approximation. SIAM J. Sci. Comput. 40 (2018).

use faer::{Mat, c64};
use rayon::prelude::*;

/// Misfit by the largest sample at which no more support points are added: rounding of Q.
const FITTED: f64 = 1e-11;

/// Largest distance, by max |Q_ij| over the grid, between a left-out sample and its
/// prediction; and the entry and grid value where it is. Entries below `floor` times the
/// largest are rounding and left out; so is the last sample, beyond which there is none.
pub fn worst_prediction(k: &[f64], q: &[Mat<c64>], floor: f64) -> (f64, [usize; 2], f64) {
    let (rows, columns) = q.first().map_or((0, 0), |q| (q.nrows(), q.ncols()));
    let largest = q.iter().map(Mat::norm_max).fold(0.0, f64::max);
    let entries: Vec<[usize; 2]> = (0..rows * columns).map(|e| [e % rows, e / rows]).collect();
    let worst: Vec<(f64, [usize; 2], f64)> = entries
        .par_iter()
        .filter_map(|&[i, j]| {
            let values: Vec<c64> = q.iter().map(|q| q[(i, j)]).collect();
            let size = values.iter().map(|v| v.norm()).fold(0.0, f64::max);
            if size <= floor * largest {
                return None;
            }
            let (error, at) = worst_of_entry(k, &values);
            Some((error / size, [i, j], at))
        })
        .collect();
    worst
        .into_iter()
        .fold((0.0, [0, 0], 0.0), |a, b| if b.0 > a.0 { b } else { a })
}

fn worst_of_entry(k: &[f64], values: &[c64]) -> (f64, f64) {
    (0..k.len().saturating_sub(1))
        .map(|left_out| {
            let mut points = Vec::new();
            for (i, (&k, &v)) in k.iter().zip(values).enumerate() {
                if i == left_out {
                    continue;
                }
                points.push((k, v));
                if k != 0.0 {
                    points.push((-k, v.conj()));
                }
            }
            let error = (predict(&points, k[left_out]) - values[left_out]).norm();
            (error, k[left_out])
        })
        .fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a })
}

/// Value at `k` of the rational function through the points.
fn predict(points: &[(f64, c64)], k: f64) -> c64 {
    let size = points.iter().map(|p| p.1.norm()).fold(0.0, f64::max);
    let mean = points.iter().map(|p| p.1).sum::<c64>() / points.len() as f64;
    let mut support: Vec<usize> = Vec::new();
    let mut weights: Vec<c64> = Vec::new();
    while 2 * support.len() < points.len() {
        let misfit = |i: usize| {
            let fit = if support.is_empty() {
                mean
            } else {
                barycentric(points, &support, &weights, points[i].0)
            };
            (fit - points[i].1).norm()
        };
        let worst = (0..points.len())
            .filter(|i| !support.contains(i))
            .map(|i| (misfit(i), i))
            .fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a });
        if worst.0 <= FITTED * size {
            break;
        }
        support.push(worst.1);
        weights = loewner_weights(points, &support);
    }
    if support.is_empty() {
        return mean;
    }
    barycentric(points, &support, &weights, k)
}

fn barycentric(points: &[(f64, c64)], support: &[usize], weights: &[c64], k: f64) -> c64 {
    let (mut above, mut below) = (c64::new(0.0, 0.0), c64::new(0.0, 0.0));
    for (&j, w) in support.iter().zip(weights) {
        let share = w / (k - points[j].0);
        above += share * points[j].1;
        below += share;
    }
    above / below
}

/// The right singular vector of the smallest singular value of (f_i − f_j)/(k_i − k_j).
fn loewner_weights(points: &[(f64, c64)], support: &[usize]) -> Vec<c64> {
    let others: Vec<usize> = (0..points.len()).filter(|i| !support.contains(i)).collect();
    let loewner = Mat::from_fn(others.len(), support.len(), |i, j| {
        let (a, b) = (points[others[i]], points[support[j]]);
        (a.1 - b.1) / (a.0 - b.0)
    });
    match loewner.svd() {
        Ok(svd) => {
            let last = support.len() - 1;
            (0..=last).map(|j| svd.V()[(j, last)]).collect()
        }
        Err(_) => vec![c64::new(f64::NAN, 0.0); support.len()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rational function is predicted to rounding; one wrong sample stands out.
    #[test]
    fn a_rational_function_is_predicted_and_a_wrong_sample_seen() {
        let k: Vec<f64> = (0..=20)
            .map(|i| 1.5 * (f64::from(i) / 20.0).powf(1.5))
            .collect();
        let exact = |k: f64| {
            let p = c64::new(0.0, k);
            p * p + 0.3 * p / (p + 0.2) + p / ((p + 0.3) * (p + 0.3) + 0.5)
        };
        let mut q: Vec<Mat<c64>> = k
            .iter()
            .map(|&k| Mat::from_fn(1, 1, |_, _| exact(k)))
            .collect();
        let (smooth, ..) = worst_prediction(&k, &q, 0.0);
        q[7][(0, 0)] *= 1.01;
        let (wrong, _, at) = worst_prediction(&k, &q, 0.0);
        println!("smooth {smooth:.1e}; with one sample off by 1 %, {wrong:.1e} at k = {at}");
        assert!(smooth < 1e-8);
        assert!(wrong > 1e-3);
    }
}
