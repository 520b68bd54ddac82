//! Theodorsen's function at any complex argument off the negative real axis.
//!
//! $$ C(p) = \frac{K_1(p)}{K_0(p) + K_1(p)} $$
//!
//! with the modified Bessel functions by their ascending series (Abramowitz &
//! Stegun 9.6.10–13), whose cancellation costs $e^{2|p|}$: 13 digits are left
//! at $|p| = 3$.

use faer::c64;

const EULER: f64 = 0.577_215_664_901_532_9;

/// $C(p)$, 1 at the origin.
pub fn theodorsen(p: c64) -> c64 {
    if p.norm() == 0.0 {
        return c64::new(1.0, 0.0);
    }
    let [k0, k1] = modified_bessel(p);
    k1 / (k0 + k1)
}

/// $K_0$ and $K_1$ on the principal branch.
fn modified_bessel(z: c64) -> [c64; 2] {
    let square = z * z * 0.25;
    let logarithm = c64::new(z.norm().ln() - 2.0_f64.ln(), z.im.atan2(z.re));
    let (mut term, mut harmonic) = (c64::new(1.0, 0.0), 0.0);
    let (mut i0, mut i1) = (c64::new(0.0, 0.0), c64::new(0.0, 0.0));
    let (mut k0, mut k1) = (c64::new(0.0, 0.0), c64::new(0.0, 0.0));
    for m in 0..80 {
        let order = f64::from(m);
        if m > 0 {
            term *= square / (order * order);
            harmonic += 1.0 / order;
        }
        let next = term / (order + 1.0);
        i0 += term;
        i1 += next;
        // ψ(m+1) = −γ + H_m, ψ(m+2) = −γ + H_{m+1}.
        k0 += term * (harmonic - EULER);
        k1 += next * (2.0 * (harmonic - EULER) + 1.0 / (order + 1.0));
        if next.norm() < 1e-18 * i1.norm() {
            break;
        }
    }
    let half = z * 0.5;
    [
        k0 - logarithm * i0,
        1.0 / z + half * (logarithm * i1 - k1 * 0.5),
    ]
}
