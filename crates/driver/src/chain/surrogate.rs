//! A rational interpolant of the computed $Q(p)$, for evaluating it often.
//!
//! $$ r(p) = \sum_j \frac{w_j}{p - z_j} Q(z_j) \Big/ \sum_j \frac{w_j}{p - z_j} $$
//!
//! with all entries of $Q$ sharing the support points $z_j$ and the weights
//! $w_j$: the adaptive Antoulas–Anderson algorithm (Nakatsukasa, Sète &
//! Trefethen 2018) for sets of functions. Points and weights come in conjugate
//! pairs, so that $r(\bar p) = \overline{r(p)}$. The wake's branch cut becomes
//! a row of poles beside the negative real axis; near it $Q$ itself is taken.

use super::exact::ExactForces;
use faer::{Mat, c64};
use fladder_stability::{Aerodynamics, GafTable};
use rayon::prelude::*;

/// Half width of the region in $g$: a little more than the region of p2.
const DAMPING: f64 = 0.22;
/// Height of the region over the largest $k$ of the grid.
const HEIGHT: f64 = 1.15;
/// Heights of samples, close together near the origin.
const ROWS: usize = 36;
/// Power that crowds them there: the lowest lies at 2e-4 of the height.
const CROWDING: f64 = 2.4;
/// Left of this slope, $k < |g|/2$ at $g < 0$, the poles of the interpolant
/// stand in for the cut and $Q$ itself is taken.
const CUT_SLOPE: f64 = 0.5;
/// Pairs of support points.
const MOST_PAIRS: usize = 16;
/// Misfit, as a part of the largest value of an entry, that is good enough:
/// the accuracy of the far wake's quadrature. Less would follow its errors.
const GOOD: f64 = 3e-7;
/// Misfit above which the forces are not interpolated at all.
const USABLE: f64 = 1e-4;
/// An entry that never exceeds this part of the largest is noise.
const NOISE: f64 = 1e-5;
/// Mixtures of entries that stand for all of them.
const MIXTURES: usize = 24;

/// The interpolant, with the forces it stands for.
pub(crate) struct Surrogate<'a> {
    exact: &'a ExactForces<'a>,
    support: Vec<Support>,
    /// Largest misfit at points between the samples.
    pub(crate) misfit: f64,
}

/// A support point of a conjugate pair.
struct Support {
    point: c64,
    weight: c64,
    value: Mat<c64>,
}

impl<'a> Surrogate<'a> {
    /// Samples the forces and interpolates; `None` where that is not accurate.
    pub(crate) fn new(exact: &'a ExactForces<'a>, table: &GafTable) -> Option<Self> {
        let k_max = table.k().last()?;
        let samples = Samples::new(exact, &points(HEIGHT * k_max, 0.0));
        let support = samples.interpolate()?;
        let mut surrogate = Self {
            exact,
            support,
            misfit: 0.0,
        };
        let between = Samples::new(exact, &points(HEIGHT * k_max, 0.5));
        surrogate.misfit = between.misfit(&surrogate, &samples.scales);
        (surrogate.misfit < USABLE).then_some(surrogate)
    }

    /// Factors of $Q(z_j)$ and of its conjugate, with what divides them.
    fn fractions(&self, p: c64) -> (Vec<[c64; 2]>, c64) {
        let fractions: Vec<[c64; 2]> = self
            .support
            .iter()
            .map(|s| {
                [
                    s.weight / (p - s.point),
                    s.weight.conj() / (p - s.point.conj()),
                ]
            })
            .collect();
        let sum = fractions.iter().map(|[a, b]| a + b).sum();
        (fractions, sum)
    }

    fn blend(&self, fractions: &[[c64; 2]], sum: c64) -> Mat<c64> {
        let order = self.exact.order();
        let mut q = Mat::zeros(order, order);
        for (s, [own, conjugate]) in self.support.iter().zip(fractions) {
            let (own, conjugate) = (own / sum, conjugate / sum);
            for j in 0..order {
                for i in 0..order {
                    let value = s.value[(i, j)];
                    q[(i, j)] += own * value + conjugate * value.conj();
                }
            }
        }
        q
    }

    /// The support point that is met exactly.
    fn met(&self, p: c64) -> Option<&Support> {
        self.support
            .iter()
            .find(|s| (p - s.point).norm() < f64::EPSILON)
    }
}

fn beside_cut(p: c64) -> bool {
    p.re < 0.0 && p.im.abs() < CUT_SLOPE * -p.re
}

impl Aerodynamics for Surrogate<'_> {
    fn order(&self) -> usize {
        self.exact.order()
    }

    fn q(&self, p: c64) -> Mat<c64> {
        if beside_cut(p) {
            return self.exact.q(p);
        }
        if let Some(support) = self.met(p) {
            return support.value.clone();
        }
        let (fractions, sum) = self.fractions(p);
        self.blend(&fractions, sum)
    }

    /// With the divided differences of Schneider & Werner (1986).
    fn q_and_slope(&self, p: c64) -> (Mat<c64>, Mat<c64>) {
        if beside_cut(p) || self.met(p).is_some() {
            return self.exact.q_and_slope(p);
        }
        let (fractions, sum) = self.fractions(p);
        let q = self.blend(&fractions, sum);
        let divided: Vec<[c64; 2]> = self
            .support
            .iter()
            .zip(&fractions)
            .map(|(s, [a, b])| [a / (p - s.point), b / (p - s.point.conj())])
            .collect();
        let total: c64 = divided.iter().map(|[a, b]| a + b).sum();
        let pulled = self.blend(&divided, sum);
        let order = self.exact.order();
        let slope = Mat::from_fn(order, order, |i, j| {
            q[(i, j)] * total / sum - pulled[(i, j)]
        });
        (q, slope)
    }
}

/// Points of the upper half of the region, away from the cut; `shift` moves
/// the rows by parts of their distance.
fn points(height: f64, shift: f64) -> Vec<c64> {
    let mut points = Vec::new();
    for row in 0..ROWS {
        let k = height * ((row as f64 + 1.0 - shift) / ROWS as f64).powf(CROWDING);
        for g in [
            0.0,
            0.7 * k,
            -0.7 * k,
            2.0 * k,
            -2.0 * k,
            0.5 * DAMPING,
            DAMPING,
        ] {
            points.push(c64::new(g, k));
        }
        for g in [-0.5 * DAMPING, -DAMPING] {
            points.push(c64::new(g, k));
        }
    }
    points.retain(|p| p.re.abs() <= DAMPING && !beside_cut(*p * c64::new(1.0, 0.01)));
    points.sort_by(|a, b| a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re)));
    points.dedup();
    points
}

/// Plus and minus one, the same in every run (xorshift).
struct Signs(u64);

impl Signs {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        if self.0 >> 63 == 0 { 1.0 } else { -1.0 }
    }
}

/// Forces at many points.
struct Samples {
    points: Vec<c64>,
    values: Vec<Mat<c64>>,
    /// What each entry is divided by.
    scales: Mat<f64>,
}

impl Samples {
    fn new(exact: &ExactForces<'_>, points: &[c64]) -> Self {
        let values: Vec<Mat<c64>> = points.par_iter().map(|p| exact.q(*p)).collect();
        let order = exact.order();
        let size =
            |i: usize, j: usize| values.iter().map(|q| q[(i, j)].norm()).fold(0.0, f64::max);
        let sizes = Mat::from_fn(order, order, size);
        let mut largest = f64::MIN_POSITIVE;
        for j in 0..order {
            for i in 0..order {
                largest = largest.max(sizes[(i, j)]);
            }
        }
        let scales = Mat::from_fn(order, order, |i, j| sizes[(i, j)].max(NOISE * largest));
        Self {
            points: points.to_vec(),
            values,
            scales,
        }
    }

    /// Largest misfit of an interpolant, entry by entry.
    fn misfit(&self, surrogate: &Surrogate<'_>, scales: &Mat<f64>) -> f64 {
        let order = scales.nrows();
        let at = |(p, q): (&c64, &Mat<c64>)| {
            let r = surrogate.q(*p);
            let mut worst = 0.0f64;
            for j in 0..order {
                for i in 0..order {
                    worst = worst.max((r[(i, j)] - q[(i, j)]).norm() / scales[(i, j)]);
                }
            }
            worst
        };
        self.points
            .par_iter()
            .zip(&self.values)
            .map(at)
            .reduce(|| 0.0, f64::max)
    }

    /// The samples seen through a few fixed mixtures of their scaled entries,
    /// with signs at random: sums of squares over mixtures stand for those
    /// over entries, and real factors keep conjugates conjugate.
    fn mixtures(&self) -> Mat<c64> {
        let order = self.scales.nrows();
        let mut signs = Signs(1);
        let factors: Vec<Vec<f64>> = (0..MIXTURES)
            .map(|_| (0..order * order).map(|_| signs.next()).collect())
            .collect();
        Mat::from_fn(self.points.len(), MIXTURES, |sample, mixture| {
            let entry = |(e, sign): (usize, &f64)| {
                let (i, j) = (e % order, e / order);
                self.values[sample][(i, j)] * (sign / self.scales[(i, j)])
            };
            factors[mixture].iter().enumerate().map(entry).sum()
        })
    }

    /// Adds pairs of support points where the misfit is largest.
    fn interpolate(&self) -> Option<Vec<Support>> {
        let data = self.mixtures();
        let scale = (0..data.nrows())
            .map(|s| row_size(&data, s))
            .fold(0.0, f64::max);
        let mut chosen: Vec<usize> = Vec::new();
        let mut weights: Vec<c64> = Vec::new();
        let mut next = (0..data.nrows())
            .max_by(|&a, &b| row_size(&data, a).total_cmp(&row_size(&data, b)))?;
        for _ in 0..MOST_PAIRS {
            chosen.push(next);
            weights = self.weights(&data, &chosen)?;
            let (worst, misfit) = self.worst(&data, &chosen, &weights)?;
            if misfit < GOOD * scale {
                break;
            }
            next = worst;
        }
        let support = chosen.iter().zip(weights).map(|(&sample, weight)| Support {
            point: self.points[sample],
            weight,
            value: self.values[sample].clone(),
        });
        Some(support.collect())
    }

    /// Weights of unit length that make numerator and denominator times the
    /// data agree best: the last right singular vector of the Loewner matrix,
    /// over real and imaginary parts.
    fn weights(&self, data: &Mat<c64>, chosen: &[usize]) -> Option<Vec<c64>> {
        let others: Vec<usize> = (0..data.nrows())
            .filter(|sample| !chosen.contains(sample))
            .collect();
        let (pairs, directions) = (chosen.len(), data.ncols());
        let entry = |row: usize, column: usize| {
            let (row, is_imaginary_row) = (row / 2, row % 2 == 1);
            let (sample, direction) = (others[row / directions], row % directions);
            let (pair, is_imaginary) = (column / 2, column % 2 == 1);
            let (z, p) = (self.points[chosen[pair]], self.points[sample]);
            let (at, here) = (data[(chosen[pair], direction)], data[(sample, direction)]);
            let own = (here - at) / (p - z);
            let conjugate = (here - at.conj()) / (p - z.conj());
            let value = if is_imaginary {
                c64::new(0.0, 1.0) * (own - conjugate)
            } else {
                own + conjugate
            };
            if is_imaginary_row { value.im } else { value.re }
        };
        let loewner = Mat::from_fn(2 * directions * others.len(), 2 * pairs, entry);
        let triangle = loewner.qr().thin_R().to_owned();
        let svd = triangle.thin_svd().ok()?;
        let last = svd.V().col(2 * pairs - 1).to_owned();
        Some(
            (0..pairs)
                .map(|j| c64::new(last[2 * j], last[2 * j + 1]))
                .collect(),
        )
    }

    /// The sample of the largest misfit.
    fn worst(
        &self,
        data: &Mat<c64>,
        chosen: &[usize],
        weights: &[c64],
    ) -> Option<(usize, f64)> {
        let misfit = |sample: usize| {
            let p = self.points[sample];
            let mut sums = vec![c64::new(0.0, 0.0); data.ncols()];
            let mut below = c64::new(0.0, 0.0);
            for (&at, weight) in chosen.iter().zip(weights) {
                let z = self.points[at];
                let (own, other) = (weight / (p - z), weight.conj() / (p - z.conj()));
                below += own + other;
                for (direction, sum) in sums.iter_mut().enumerate() {
                    let value = data[(at, direction)];
                    *sum += own * value + other * value.conj();
                }
            }
            let square = |(direction, sum): (usize, &c64)| {
                (sum / below - data[(sample, direction)]).norm_sqr()
            };
            sums.iter().enumerate().map(square).sum::<f64>().sqrt()
        };
        (0..data.nrows())
            .filter(|sample| !chosen.contains(sample))
            .map(|sample| (sample, misfit(sample)))
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

fn row_size(data: &Mat<c64>, row: usize) -> f64 {
    (0..data.ncols())
        .map(|column| data[(row, column)].norm_sqr())
        .sum::<f64>()
        .sqrt()
}
