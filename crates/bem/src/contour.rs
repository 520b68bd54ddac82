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
//! * up to [`SECTOR_LIMIT_DEG`]: a ray at −50°, its first part in pieces where the wing is
//!   long ([`RAY_RATIO`]);
//! * beyond: at −60° until below every branch point, then a ray at −130°.
//!
//! Both need ξ₀ > X for every P; the second needs a depth above every ρ, so that no
//! branch point lies between it and the first. A straight way down would pass the branch
//! points at the distance ξ₀ − X only and need many nodes; at −60° they stay away by more
//! than half the length gone. On that finite leg e^{−sξ} grows for arg s > 150°, by e⁴
//! for s = −2/b and a span of 20 b, which costs two of nine digits. The ray is mapped to 0 ≤ y < 1 by
//! ξ = start + L e^{iθ} y/(1 − y) and integrated by Gauss–Legendre.

use faer::c64;
use std::f64::consts::PI;

/// Argument of s in degrees up to which the first path is used.
pub(crate) const SECTOR_LIMIT_DEG: f64 = 95.0;

const FIRST_RAY_DEG: f64 = -50.0;
const LEG_DEG: f64 = -60.0;
const SECOND_RAY_DEG: f64 = -130.0;

/// Gauss points of a ray: 40 leave 1e-6 of the far integral for |s| reach = 0.08, 1e-10
/// for 2 (measured against 400 on 1/((ξ − X)² + ρ²), which decays as the kernel does).
const RAY_POINTS: usize = 40;
/// Length scale of a ray in largest distances ρ: 2 is ten to a hundred times better than
/// 1/2 for slow motion and costs nothing for fast motion.
const RAY_LENGTH: f64 = 2.0;
/// A ray of [`RAY_POINTS`] resolves the kernel of the nearest streamline from 1/24 of the
/// largest ρ behind it on. Nearer its nodes are too far apart, and a straight leg in pieces
/// comes before it: without one the error is 3e-8 for a ratio of 27, 5e-5 for 67 and 3 %
/// for 333 (wings of aspect ratio 8, 20 and 100).
const RAY_RATIO: f64 = 24.0;
/// Gauss points of one piece of the straight leg.
const LEG_POINTS: usize = 8;

/// Depth of the second path in largest distances ρ: safely below all branch points.
const DEPTH_FACTOR: f64 = 1.25;

/// Largest growth of e^{−sξ} along the leg, as an exponent: beyond it the result loses
/// more than five of its nine digits.
const LARGEST_GROWTH: f64 = 12.0;

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
        let mut oscillating = Path {
            nodes: Vec::new(),
            weights: Vec::new(),
        };
        let mut from = c64::new(start, 0.0);
        let graded = reach / RAY_RATIO;
        if margin < graded {
            from = oscillating.add_leg(start, margin, graded, FIRST_RAY_DEG);
        }
        oscillating.add_ray(from, FIRST_RAY_DEG, RAY_LENGTH * reach);
        let mut decaying = Path {
            nodes: Vec::new(),
            weights: Vec::new(),
        };
        let length = DEPTH_FACTOR * reach / LEG_DEG.to_radians().sin().abs();
        let corner = decaying.add_leg(start, margin, length, LEG_DEG);
        decaying.add_ray(corner, SECOND_RAY_DEG, RAY_LENGTH * reach);
        Self {
            oscillating,
            decaying,
        }
    }

    /// The path whose sector holds arg s, Im s ≥ 0: 0 for oscillating, 1 for decaying
    /// motion.
    pub(crate) fn number_of(s: c64) -> usize {
        usize::from(s.arg().to_degrees() > SECTOR_LIMIT_DEG)
    }
}

impl Path {
    /// Whether e^{−sξ} stays small enough on the path for the sum to keep its digits.
    pub(crate) fn keeps_digits(nodes: &[(f64, f64)], s: c64) -> bool {
        nodes
            .iter()
            .all(|&(re, im)| -(s * c64::new(re, im)).re < LARGEST_GROWTH)
    }

    fn add_ray(&mut self, start: c64, angle_deg: f64, length: f64) {
        let direction = c64::from_polar(length, angle_deg.to_radians());
        for (y, w) in gauss_legendre(RAY_POINTS) {
            let rest = 1.0 - y;
            self.nodes.push(start + direction * (y / rest));
            self.weights.push(direction * (w / (rest * rest)));
        }
    }

    /// Along a leg in pieces that double in length; returns its end.
    fn add_leg(&mut self, start: f64, first: f64, length: f64, angle_deg: f64) -> c64 {
        let direction = c64::from_polar(1.0, angle_deg.to_radians());
        let mut from = 0.0;
        let mut size = first.min(length);
        while from < length {
            let piece = if from + 1.5 * size > length {
                length - from
            } else {
                size
            };
            for (y, w) in gauss_legendre(LEG_POINTS) {
                self.nodes.push(start + direction * (from + piece * y));
                self.weights.push(direction * (piece * w));
            }
            from += piece;
            size *= 2.0;
        }
        start + direction * length
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
        (previous, current) = (
            current,
            ((2.0 * j - 1.0) * x * current - (j - 1.0) * previous) / j,
        );
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
                let sum: f64 = gauss_legendre(n)
                    .iter()
                    .map(|(y, w)| w * y.powi(degree))
                    .sum();
                assert!((sum - 1.0 / f64::from(degree + 1)).abs() < 1e-13);
            }
        }
    }

    /// ∫ e^{−sξ} dξ/((ξ − X)² + ρ²) from ξ₀ by both paths where one takes over from the
    /// other: they share no node but the start.
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
        for degrees in [85.0_f64, 90.0, 95.0, 100.0] {
            for size in [0.05, 0.5, 3.0] {
                let s = c64::from_polar(size, degrees.to_radians());
                let (a, b) = (
                    integral(&paths.oscillating, s),
                    integral(&paths.decaying, s),
                );
                let difference = (a - b).norm() / a.norm();
                println!("arg s = {degrees}°, |s| = {size}: {difference:.1e}");
                assert!(difference < 2e-6, "{a} {b}");
            }
        }
    }

    /// The same near the middle of wings of any length, where ρ is small and the largest
    /// distance long.
    #[test]
    fn both_paths_resolve_a_near_streamline_of_a_long_wing() {
        let (start, margin) = (1.0, 0.3);
        let s = c64::from_polar(0.3, SECTOR_LIMIT_DEG.to_radians());
        for reach in [2.0, 8.0, 20.0, 100.0] {
            let paths = Paths::new(start, margin, reach);
            for rho in [0.01, 0.1, 1.0] {
                let integral = |path: &Path| -> c64 {
                    let pairs = path.nodes.iter().zip(&path.weights);
                    pairs
                        .map(|(xi, w)| {
                            let zeta = xi - (start - margin);
                            w * (-s * xi).exp() / (zeta * zeta + rho * rho)
                        })
                        .sum()
                };
                let (a, b) = (integral(&paths.oscillating), integral(&paths.decaying));
                let difference = (a - b).norm() / a.norm();
                println!("reach {reach}, ρ = {rho}: {difference:.1e}");
                assert!(difference < 1e-7, "{a} {b}");
            }
        }
    }
}
