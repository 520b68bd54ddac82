//! Integration path of the far wake in the complex plane.
//!
//! Behind the last body point the wake's influence is
//! $$ \int_{\xi_0}^{\infty} e^{-s\xi}\, f(P,\xi)\,\mathrm d\xi , $$
//! with f analytic but for branch points at ξ = X ± iρ, X the streamwise distance of
//! P from the strip's start and ρ its distance from a streamline through a strip end.
//! The integral converges for Re s > 0 on the real axis; turning the path keeps the
//! value and makes it converge for other s: that is the analytic continuation to
//! decaying motion. Two paths cover the upper half plane 0 ≤ arg s ≤ 180°:
//!
//! * up to [`SECTOR_LIMIT_DEG`]: a ray at −60°;
//! * beyond: straight down (−90°) until below every branch point, then a ray at −120°.
//!
//! Both need ξ₀ > X for every P; the second needs a depth above every ρ, so that no
//! branch point lies between it and the first. The ray is mapped to 0 ≤ y < 1 by
//! ξ = start + L e^{iθ} y/(1 − y) and integrated by Gauss–Legendre.

use faer::c64;
use std::f64::consts::PI;

/// Argument of s in degrees up to which the first path is used.
pub(crate) const SECTOR_LIMIT_DEG: f64 = 105.0;

const FIRST_RAY_DEG: f64 = -60.0;
const SECOND_RAY_DEG: f64 = -120.0;

/// Gauss points of a ray: 40 leave 1e-7 or less of Q for |arg s| in the sector.
const RAY_POINTS: usize = 40;
/// Gauss points of one piece of the straight leg.
const LEG_POINTS: usize = 8;

/// Depth of the second path in largest distances ρ: safely below all branch points.
const DEPTH_FACTOR: f64 = 1.25;

/// Nodes ξ and weights of one path.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Path {
    pub(crate) nodes: Vec<c64>,
    pub(crate) weights: Vec<c64>,
}

/// The two paths of a wake whose far part starts at ξ₀.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Paths {
    pub(crate) oscillating: Path,
    pub(crate) decaying: Path,
}

impl Paths {
    /// Paths from `start` = ξ₀, which lies `margin` behind the last body point;
    /// `reach` is the largest distance ρ of a body point from a wake streamline.
    pub(crate) fn new(start: f64, margin: f64, reach: f64) -> Self {
        let mut oscillating = Path { nodes: Vec::new(), weights: Vec::new() };
        oscillating.add_ray(c64::new(start, 0.0), FIRST_RAY_DEG, 0.5 * reach);
        let mut decaying = Path { nodes: Vec::new(), weights: Vec::new() };
        let depth = DEPTH_FACTOR * reach;
        decaying.add_leg(start, margin, depth);
        decaying.add_ray(c64::new(start, -depth), SECOND_RAY_DEG, reach);
        Self { oscillating, decaying }
    }
}

impl Path {
    fn add_ray(&mut self, start: c64, angle_deg: f64, length: f64) {
        let direction = c64::from_polar(length, angle_deg.to_radians());
        for (y, w) in gauss_legendre(RAY_POINTS) {
            let rest = 1.0 - y;
            self.nodes.push(start + direction * (y / rest));
            self.weights.push(direction * (w / (rest * rest)));
        }
    }

    /// Straight down from the real axis, in pieces that double in length.
    fn add_leg(&mut self, start: f64, first: f64, depth: f64) {
        let mut from = 0.0;
        let mut length = first.min(depth);
        while from < depth {
            let piece = if from + 1.5 * length > depth { depth - from } else { length };
            for (y, w) in gauss_legendre(LEG_POINTS) {
                self.nodes.push(c64::new(start, -(from + piece * y)));
                self.weights.push(c64::new(0.0, -piece * w));
            }
            from += piece;
            length *= 2.0;
        }
    }
}

/// Gauss–Legendre nodes and weights on (0, 1).
///
/// Newton's iteration on the Legendre polynomial from the Chebyshev guess
/// cos(π(i − 1/4)/(n + 1/2)); Abramowitz & Stegun 25.4.29–30.
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (1..=n)
        .map(|i| {
            let mut x = (PI * (i as f64 - 0.25) / (n as f64 + 0.5)).cos();
            let mut slope = 0.0;
            for _ in 0..8 {
                let (value, derivative) = legendre(n, x);
                slope = derivative;
                x -= value / derivative;
            }
            (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// P_n(x) and its derivative by the three-term recurrence.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut current) = (1.0, x);
    for j in 2..=n {
        let j = j as f64;
        (previous, current) =
            (current, ((2.0 * j - 1.0) * x * current - (j - 1.0) * previous) / j);
    }
    (current, n as f64 * (x * current - previous) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The n-point rule is exact for polynomials of degree 2n − 1.
    #[test]
    fn gauss_legendre_is_exact_to_degree_2n_minus_1() {
        for n in [8, 40] {
            for degree in 0..2 * n as i32 {
                let sum: f64 =
                    gauss_legendre(n).iter().map(|(y, w)| w * y.powi(degree)).sum();
                assert!((sum - 1.0 / f64::from(degree + 1)).abs() < 1e-13);
            }
        }
    }

    /// ∫ e^{−sξ} dξ/((ξ − X)² + ρ²) from ξ₀ by both paths where both converge, and by
    /// its own conjugate symmetry on the real axis.
    #[test]
    fn both_paths_give_the_same_integral() {
        let paths = Paths::new(1.0, 0.3, 4.0);
        let integral = |path: &Path, s: c64| -> c64 {
            path.nodes
                .iter()
                .zip(&path.weights)
                .map(|(xi, w)| {
                    let zeta = xi - 0.7;
                    w * (-s * xi).exp() / (zeta * zeta + 3.5 * 3.5)
                })
                .sum()
        };
        for degrees in [70.0_f64, 90.0, 105.0, 120.0, 130.0] {
            for size in [0.05, 0.5, 3.0] {
                let s = c64::from_polar(size, degrees.to_radians());
                let (a, b) = (integral(&paths.oscillating, s), integral(&paths.decaying, s));
                let difference = (a - b).norm() / a.norm();
                println!("arg s = {degrees}°, |s| = {size}: {difference:.1e}");
                assert!(difference < 3e-6, "{a} {b}");
            }
        }
    }
}
