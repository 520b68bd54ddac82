//! Several field points at once: arithmetic, logarithm and arc tangent in SIMD lanes.
//!
//! The instruction set (AVX-512, AVX2 with FMA, none) is chosen at run time by `pulp`;
//! each lane goes through the same operations whatever the width, so that results do not
//! depend on it where fused multiply-add is there.
//!
//! Both functions are series about a reduced argument,
//!
//! * ln(a/b) = k ln 2 + 2 atanh t, t = (a − b)/(a + b) of the mantissas, |t| ≤ 3 − 2√2,
//! * atan(y/x) = {0, π/4, π/2, π} ± atan t, |t| ≤ √2 − 1,
//!
//! cut where the next term is below half a unit of rounding.

use pulp::Simd;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Field points evaluated together; a multiple of every width of instructions.
pub(crate) const WIDTH: usize = 8;

/// tan²(π/8) bounds t² of both series: 3 − 2√2.
pub(crate) const SERIES_LIMIT: f64 = 3.0 - 2.0 * std::f64::consts::SQRT_2;

/// 1/(2k + 1): SERIES_LIMIT^(2·10)/21 = 2e-17.
const ATANH: [f64; 10] = odd_reciprocals(false);
/// (−1)^k/(2k + 1): SERIES_LIMIT^20/41 = 1e-17.
const ATAN: [f64; 20] = odd_reciprocals(true);

/// Terms of the arc tangent for |t| ≤ 0.04: 0.04^12/13 = 1e-18.
const SMALL_ATAN: usize = 6;

const MANTISSA: u64 = 0x000f_ffff_ffff_ffff;
const ONE: u64 = 0x3ff0_0000_0000_0000;
/// 2^52: a small integer in its last bits is that number added.
const MAGIC: u64 = 0x4330_0000_0000_0000;
const MAGIC_VALUE: f64 = 4_503_599_627_370_496.0;

const fn odd_reciprocals<const N: usize>(alternating: bool) -> [f64; N] {
    let mut out = [0.0; N];
    let mut k = 0;
    while k < N {
        let value = 1.0 / (2 * k + 1) as f64;
        out[k] = if alternating && k % 2 == 1 {
            -value
        } else {
            value
        };
        k += 1;
    }
    out
}

/// One value a lane.
pub(crate) struct Lanes<S: Simd> {
    simd: S,
    values: S::f64s,
}

impl<S: Simd> Clone for Lanes<S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Simd> Copy for Lanes<S> {}

macro_rules! operator {
    ($name:ident, $method:ident, $operation:ident) => {
        impl<S: Simd> $name for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self {
                    simd: self.simd,
                    values: self.simd.$operation(self.values, other.values),
                }
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.wrap(self.simd.neg_f64s(self.values))
    }
}

impl<S: Simd> Lanes<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, values: S::f64s) -> Self {
        Self { simd, values }
    }

    #[inline(always)]
    pub(crate) fn splat(simd: S, value: f64) -> Self {
        Self::new(simd, simd.splat_f64s(value))
    }

    #[inline(always)]
    pub(crate) fn values(self) -> S::f64s {
        self.values
    }

    #[inline(always)]
    fn wrap(self, values: S::f64s) -> Self {
        Self::new(self.simd, values)
    }

    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }

    /// self · factor + term.
    #[inline(always)]
    pub(crate) fn mul_add(self, factor: Self, term: Self) -> Self {
        self.wrap(
            self.simd
                .mul_add_e_f64s(self.values, factor.values, term.values),
        )
    }

    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        self.wrap(self.simd.sqrt_f64s(self.values))
    }

    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        self.wrap(self.simd.abs_f64s(self.values))
    }

    #[inline(always)]
    pub(crate) fn max(self, other: Self) -> Self {
        self.wrap(self.simd.max_f64s(self.values, other.values))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.wrap(self.simd.min_f64s(self.values, other.values))
    }

    /// `yes` where self < bound, else `no`.
    #[inline(always)]
    pub(crate) fn where_less(self, bound: Self, yes: Self, no: Self) -> Self {
        let mask = self.simd.less_than_f64s(self.values, bound.values);
        self.wrap(self.simd.select_f64s(mask, yes.values, no.values))
    }

    #[inline(always)]
    fn polynomial(self, coefficients: &[f64]) -> Self {
        let mut sum = self.constant(0.0);
        for c in coefficients.iter().rev() {
            sum = sum.mul_add(self, self.constant(*c));
        }
        sum
    }

    /// atanh t for |t| ≤ [`SERIES_LIMIT`].
    #[inline(always)]
    pub(crate) fn small_atanh(self) -> Self {
        self * (self * self).polynomial(&ATANH)
    }

    /// atan t for |t| ≤ 0.04.
    #[inline(always)]
    pub(crate) fn small_atan(self) -> Self {
        self * (self * self).polynomial(&ATAN[..SMALL_ATAN])
    }

    /// Mantissa in 1 … 2 and exponent of a positive, normal number.
    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let s = self.simd;
        let bits = s.transmute_u64s_f64s(self.values);
        let mantissa = s.or_u64s(s.and_u64s(bits, s.splat_u64s(MANTISSA)), s.splat_u64s(ONE));
        let mut exponent = bits;
        for lane in pulp::bytemuck::cast_slice_mut(std::slice::from_mut(&mut exponent)) {
            let value: u64 = *lane;
            *lane = (value >> 52) | MAGIC;
        }
        (
            self.wrap(s.transmute_f64s_u64s(mantissa)),
            self.wrap(s.transmute_f64s_u64s(exponent)) - self.constant(MAGIC_VALUE),
        )
    }

    /// ln(self/other) of positive, normal numbers.
    #[inline(always)]
    pub(crate) fn ln_ratio(self, other: Self) -> Self {
        let c = |value| self.constant(value);
        let ((mut a, ea), (b, eb)) = (self.split(), other.split());
        let mut exponent = ea - eb;
        let root = c(std::f64::consts::SQRT_2);
        let too_large = b * root;
        exponent = too_large.where_less(a, exponent + c(1.0), exponent);
        let halved = too_large.where_less(a, a * c(0.5), a);
        let small = a * root;
        exponent = small.where_less(b, exponent - c(1.0), exponent);
        a = small.where_less(b, a * c(2.0), halved);
        let t = (a - b) / (a + b);
        exponent.mul_add(c(std::f64::consts::LN_2), c(2.0) * t.small_atanh())
    }

    /// The angle of (x, y) = (other, self) in −π … π.
    #[inline(always)]
    pub(crate) fn atan2(self, x: Self) -> Self {
        use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
        let c = |value| self.constant(value);
        let (ax, ay) = (x.abs(), self.abs());
        let (low, high) = (ax.min(ay), ax.max(ay));
        // Beyond π/8 the angle is taken from π/4.
        let far = high * c(std::f64::consts::SQRT_2 - 1.0);
        let above = far.where_less(low, low - high, low);
        let below = far.where_less(low, low + high, high);
        let offset = far.where_less(low, c(FRAC_PI_4), c(0.0));
        let t = above / below;
        let mut angle = t.mul_add((t * t).polynomial(&ATAN), offset);
        angle = ax.where_less(ay, c(FRAC_PI_2) - angle, angle);
        angle = x.where_less(c(0.0), c(PI) - angle, angle);
        self.where_less(c(0.0), -angle, angle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulp::WithSimd;

    struct Both<'a> {
        pairs: &'a [(f64, f64)],
    }

    impl WithSimd for Both<'_> {
        type Output = (f64, f64);
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let mut worst = (0.0f64, 0.0f64);
            let first = |lanes: Lanes<S>| lanes.simd.reduce_max_f64s(lanes.values);
            for &(a, b) in self.pairs {
                let (la, lb) = (Lanes::splat(simd, a), Lanes::splat(simd, b));
                let angle = first(la.atan2(lb));
                worst.1 = worst.1.max((angle - a.atan2(b)).abs() / a.atan2(b).abs());
                if a > 0.0 && b > 0.0 {
                    let exact = if (a / b - 1.0).abs() < 0.5 {
                        ((a - b) / b).ln_1p()
                    } else {
                        (a / b).ln()
                    };
                    let found = first(la.ln_ratio(lb));
                    worst.0 = worst.0.max((found - exact).abs() / exact.abs().max(1e-3));
                }
            }
            worst
        }
    }

    #[test]
    fn logarithm_and_angle_have_fifteen_digits_in_every_instruction_set() {
        let mut pairs = Vec::new();
        for i in 1..400 {
            let a = f64::from(i) * 0.037;
            for j in -40..40 {
                pairs.push((a, f64::from(j) * 0.31 + 0.013));
                pairs.push((-a, f64::from(j) * 0.31 + 0.013));
            }
            pairs.push((a, a * (1.0 + 1e-9)));
            pairs.push((2.0, 2.0 - 1e-12 * a));
            pairs.push((1e13 * a, 0.7));
        }
        let both = || Both { pairs: &pairs };
        let scalar = pulp::Scalar.vectorize(both());
        let best = pulp::Arch::new().dispatch(both());
        for (ln, angle) in [scalar, best] {
            println!("logarithm off by {ln:.1e}, angle by {angle:.1e}");
            assert!(ln < 1e-15 && angle < 1e-15);
        }
    }
}
