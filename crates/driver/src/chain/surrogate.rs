//! A rational interpolant of the computed $Q(p)$, for evaluating it often.
//!
//! $$ r(p) = \sum_j \frac{w_j}{p - z_j} Q(z_j) \Big/ \sum_j \frac{w_j}{p - z_j} $$
//!
//! with all entries of $Q$ sharing the support points $z_j$ and the weights
//! $w_j$: the adaptive Antoulas–Anderson algorithm (Nakatsukasa, Sète &
//! Trefethen 2018) for sets of functions. $p = 0$ is a support point, so that
//! what vanishes there does so exactly. There are two interpolants:
//!
//! * away from the wake's branch cut, points and weights in conjugate pairs,
//!   so that $r(\bar p) = \overline{r(p)}$ and roots on the positive real axis
//!   are real;
//! * beside the cut, samples with $k \ge 0$ alone, its upper side among them:
//!   from there $Q$ continues smoothly across, and the poles lie beyond. On
//!   the cut the real part is taken, as for the forces themselves.

use super::exact::ExactForces;
use faer::{Mat, MatRef, c64};
use fladder_stability::{Aerodynamics, GafTable};
use rayon::prelude::*;

/// Half width of the region in $g$: a little more than the region of p2.
const DAMPING: f64 = 0.22;
/// Height of the region over the largest $k$ of the grid.
const HEIGHT: f64 = 1.15;
/// Rows of samples, close together near the origin.
const ROWS: usize = 36;
/// Power that crowds them there: the lowest lies at 2e-4 of the height.
const CROWDING: f64 = 2.4;
/// Support points.
const MOST_POINTS: usize = 40;
/// Misfit, as a part of the largest sample, that is good enough: slow modes
/// near the origin then agree with the forces themselves to 2e-6, the others
/// to 1e-8 (26 modes of the ScanEagle-like case).
const GOOD: f64 = 3e-8;
/// Misfit above which the forces are not interpolated at all.
const USABLE: f64 = 1e-4;
/// An entry that never exceeds this part of the largest is judged by it.
const NOISE: f64 = 1e-5;
/// Mixtures of entries that stand for all of them.
const MIXTURES: usize = 24;

/// Both interpolants.
#[derive(Debug)]
pub(crate) struct Surrogate {
    regular: Interpolant,
    beside_cut: Interpolant,
    /// Largest misfit at points between the samples.
    pub(crate) misfit: f64,
}

#[derive(Debug)]
struct Interpolant {
    /// Rows and columns of the values.
    shape: [usize; 2],
    support: Vec<Support>,
}

#[derive(Debug)]
struct Support {
    point: c64,
    weight: c64,
    value: Mat<c64>,
}

impl Surrogate {
    /// Samples the forces and interpolates; `None` where that is not accurate.
    pub(crate) fn new(exact: &ExactForces<'_>, table: &GafTable) -> Option<Self> {
        let height = HEIGHT * table.k().last()?;
        let samples = Samples::new(exact, &points(height, 0.0));
        let (near, far) = samples.divided();
        let mut surrogate = Self {
            regular: far.interpolate(Symmetry::Conjugate)?,
            beside_cut: near.interpolate(Symmetry::None)?,
            misfit: 0.0,
        };
        let between = Samples::new(exact, &points(height, 0.5));
        surrogate.misfit = between.misfit(&surrogate, &samples.scales());
        (surrogate.misfit < USABLE).then_some(surrogate)
    }

    /// The interpolant for a point of the closed upper half plane.
    fn at(&self, p: c64) -> &Interpolant {
        if is_beside_cut(p) {
            &self.beside_cut
        } else {
            &self.regular
        }
    }
}

/// Whether a point of the closed upper half plane lies within 27° of the cut.
fn is_beside_cut(p: c64) -> bool {
    p.re < 0.0 && p.im < CUT_SLOPE * -p.re
}

/// Slope of the line between the two interpolants.
const CUT_SLOPE: f64 = 0.5;
/// Each interpolant has samples somewhat beyond that line.
const OVERLAP: f64 = 1.6;

impl Interpolant {
    /// $w_j/(p - z_j)$; the limit where a support point is met.
    fn fractions(&self, p: c64) -> Vec<c64> {
        let met = self.support.iter().position(|s| (p - s.point).norm() < MET);
        let unit = |is_met: bool| c64::new(if is_met { 1.0 } else { 0.0 }, 0.0);
        match met {
            Some(met) => (0..self.support.len()).map(|j| unit(j == met)).collect(),
            None => self
                .support
                .iter()
                .map(|s| s.weight / (p - s.point))
                .collect(),
        }
    }

    fn blend(&self, factors: &[c64], divisor: c64) -> Mat<c64> {
        let [rows, columns] = self.shape;
        let mut q = vec![c64::new(0.0, 0.0); rows * columns];
        for (s, factor) in self.support.iter().zip(factors) {
            let factor = factor / divisor;
            for (j, sum) in q.chunks_exact_mut(rows).enumerate() {
                for (total, value) in sum.iter_mut().zip(s.value.col_as_slice(j)) {
                    total.re += factor.re * value.re - factor.im * value.im;
                    total.im += factor.re * value.im + factor.im * value.re;
                }
            }
        }
        MatRef::from_column_major_slice(&q, rows, columns).to_owned()
    }

    fn value(&self, p: c64) -> Mat<c64> {
        let fractions = self.fractions(p);
        self.blend(&fractions, fractions.iter().sum())
    }

    /// With the divided differences of Schneider & Werner (1986).
    fn value_and_slope(&self, p: c64) -> (Mat<c64>, Mat<c64>) {
        // Beside a support point the differences are 0/0; a step away of the
        // square root of rounding costs half the digits of a slope.
        let is_met = self.support.iter().any(|s| (p - s.point).norm() < BESIDE);
        let at = if is_met { p + BESIDE } else { p };
        let fractions = self.fractions(at);
        let sum: c64 = fractions.iter().sum();
        let q = self.blend(&fractions, sum);
        let divide = |(s, fraction): (&Support, &c64)| fraction / (at - s.point);
        let divided: Vec<c64> = self.support.iter().zip(&fractions).map(divide).collect();
        let total: c64 = divided.iter().sum::<c64>() / sum;
        let pulled = self.blend(&divided, sum);
        let slope = Mat::from_fn(q.nrows(), q.ncols(), |i, j| {
            q[(i, j)] * total - pulled[(i, j)]
        });
        (if is_met { self.value(p) } else { q }, slope)
    }
}

/// Distance at which a support point counts as met.
const MET: f64 = 1e-15;
/// Distance within which its slope is taken beside it.
const BESIDE: f64 = 1e-8;

/// The part that holds on this side of the real axis: the conjugate below it,
/// the real part on it.
fn on_side(p: c64, mut q: Mat<c64>) -> Mat<c64> {
    for j in 0..q.ncols() {
        for i in 0..q.nrows() {
            if p.im == 0.0 {
                q[(i, j)].im = 0.0;
            } else if p.im < 0.0 {
                q[(i, j)].im = -q[(i, j)].im;
            }
        }
    }
    q
}

impl Aerodynamics for Surrogate {
    /// Its samples lie all over the region.
    fn is_exact(&self) -> bool {
        true
    }

    fn order(&self) -> usize {
        self.regular.shape[0]
    }

    fn q(&self, p: c64) -> Mat<c64> {
        let above = c64::new(p.re, p.im.abs());
        on_side(p, self.at(above).value(above))
    }

    fn q_and_slope(&self, p: c64) -> (Mat<c64>, Mat<c64>) {
        let above = c64::new(p.re, p.im.abs());
        let (q, slope) = self.at(above).value_and_slope(above);
        (on_side(p, q), on_side(p, slope))
    }
}

/// Points of the upper half of the region; `shift` moves rows and columns by
/// parts of their distance.
fn points(height: f64, shift: f64) -> Vec<c64> {
    let row = |number: f64, size: f64| size * (number / ROWS as f64).powf(CROWDING);
    let mut points = vec![c64::new(0.0, 0.0)];
    for number in 0..ROWS {
        let number = number as f64 + 1.0 - shift;
        let k = row(number, height);
        for g in [
            0.0,
            0.7 * k,
            -0.7 * k,
            2.0 * k,
            -2.0 * k,
            0.5 * DAMPING,
            -0.5 * DAMPING,
        ] {
            points.push(c64::new(g, k));
        }
        points.extend([c64::new(DAMPING, k), c64::new(-DAMPING, k)]);
        let g = row(number, DAMPING);
        points.extend([c64::new(g, 0.0), c64::new(-g, 0.0), c64::new(-g, 0.25 * g)]);
    }
    points.retain(|p| p.re.abs() <= DAMPING);
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

/// Forces at many points with $k \ge 0$.
struct Samples {
    points: Vec<c64>,
    values: Vec<Mat<c64>>,
    shape: [usize; 2],
}

impl Samples {
    /// Points where the forces have no value are left out.
    fn new(exact: &ExactForces<'_>, points: &[c64]) -> Self {
        let values: Vec<Option<Mat<c64>>> =
            points.par_iter().map(|p| exact.above(*p)).collect();
        let (points, values): (_, Vec<Mat<c64>>) = points
            .iter()
            .zip(values)
            .filter_map(|(point, value)| Some((*point, value?)))
            .unzip();
        let first = values.first();
        Self {
            points,
            shape: first.map_or([exact.order(); 2], |q| [q.nrows(), q.ncols()]),
            values,
        }
    }

    /// Places of all entries, column by column.
    fn places(&self) -> impl Iterator<Item = (usize, usize)> {
        let [rows, columns] = self.shape;
        (0..columns).flat_map(move |j| (0..rows).map(move |i| (i, j)))
    }

    /// What each entry is divided by.
    fn scales(&self) -> Mat<f64> {
        let size = |i: usize, j: usize| {
            self.values
                .iter()
                .map(|q| q[(i, j)].norm())
                .fold(0.0, f64::max)
        };
        let [rows, columns] = self.shape;
        let sizes = Mat::from_fn(rows, columns, size);
        let largest = self
            .places()
            .map(|place| sizes[place])
            .fold(f64::MIN_POSITIVE, f64::max);
        Mat::from_fn(rows, columns, |i, j| sizes[(i, j)].max(NOISE * largest))
    }

    /// Largest misfit of an interpolant, entry by entry.
    fn misfit(&self, surrogate: &Surrogate, scales: &Mat<f64>) -> f64 {
        let at = |(p, q): (&c64, &Mat<c64>)| {
            let r = surrogate.at(*p).value(*p);
            let entry = |i: usize, j: usize| (r[(i, j)] - q[(i, j)]).norm() / scales[(i, j)];
            self.places().map(|(i, j)| entry(i, j)).fold(0.0, f64::max)
        };
        self.points
            .par_iter()
            .zip(&self.values)
            .map(at)
            .reduce(|| 0.0, f64::max)
    }

    /// The samples seen through a few fixed mixtures of their scaled entries,
    /// with signs at random: sums of squares over mixtures stand for those
    /// over entries.
    fn mixtures(&self) -> Mat<c64> {
        let ([rows, columns], scales) = (self.shape, self.scales());
        let mut signs = Signs(1);
        let factors: Vec<Vec<f64>> = (0..MIXTURES)
            .map(|_| (0..rows * columns).map(|_| signs.next()).collect())
            .collect();
        Mat::from_fn(self.points.len(), MIXTURES, |sample, mixture| {
            let entry = |(e, sign): (usize, &f64)| {
                let (i, j) = (e % rows, e / rows);
                self.values[sample][(i, j)] * (sign / scales[(i, j)])
            };
            factors[mixture].iter().enumerate().map(entry).sum()
        })
    }

    /// Samples for the interpolant beside the cut, and for the other.
    fn divided(&self) -> (Self, Self) {
        let part = |keep: &dyn Fn(c64) -> bool| {
            let kept = self
                .points
                .iter()
                .zip(&self.values)
                .filter(|(p, _)| keep(**p));
            let (points, values) = kept.map(|(p, q)| (*p, q.clone())).unzip();
            Self {
                points,
                values,
                shape: self.shape,
            }
        };
        let near = part(&|p| p.re <= 0.0 && p.im <= OVERLAP * CUT_SLOPE * -p.re);
        let far = part(&|p| !(p.re < 0.0 && p.im < CUT_SLOPE / OVERLAP * -p.re));
        (near, far)
    }

    /// Begins at $p = 0$ and adds support points where the misfit is largest.
    fn interpolate(&self, symmetry: Symmetry) -> Option<Interpolant> {
        let data = self.mixtures();
        let sizes = (0..data.nrows()).map(|sample| row_size(&data, sample));
        let scale = sizes.fold(0.0, f64::max);
        let mut next = self.points.iter().position(|p| p.norm() == 0.0)?;
        let mut chosen: Vec<usize> = Vec::new();
        let mut support: Vec<Node> = Vec::new();
        while support.len() < MOST_POINTS.min(data.nrows() / 2) {
            chosen.push(next);
            support = self.weighted(&data, &chosen, symmetry)?;
            let (worst, misfit) = self.worst(&data, &chosen, &support)?;
            if misfit < GOOD * scale {
                break;
            }
            next = worst;
        }
        let support = support.into_iter().map(|node| Support {
            point: node.point(self),
            weight: node.weight,
            value: self.value(node),
        });
        Some(Interpolant {
            shape: self.shape,
            support: support.collect(),
        })
    }

    fn value(&self, node: Node) -> Mat<c64> {
        let q = &self.values[node.sample];
        let side = |value: c64| {
            if node.is_conjugate {
                value.conj()
            } else {
                value
            }
        };
        Mat::from_fn(q.nrows(), q.ncols(), |i, j| side(q[(i, j)]))
    }

    /// Support points with weights of unit length that make the numerator and
    /// the denominator times the data agree best: the last right singular
    /// vector of the Loewner matrix, over real and imaginary parts of the
    /// weights, so that pairs can share one.
    fn weighted(
        &self,
        data: &Mat<c64>,
        chosen: &[usize],
        symmetry: Symmetry,
    ) -> Option<Vec<Node>> {
        let mut unknowns = Vec::new();
        for &sample in chosen {
            let is_real = symmetry == Symmetry::Conjugate && self.points[sample].im == 0.0;
            unknowns.push((sample, false, is_real));
            if !is_real {
                unknowns.push((sample, true, is_real));
            }
        }
        let others: Vec<usize> = (0..data.nrows())
            .filter(|sample| !chosen.contains(sample))
            .collect();
        let mixtures = data.ncols();
        let entry = |row: usize, column: usize| {
            let (sample, mixture) = (others[row / 2 / mixtures], row / 2 % mixtures);
            let (at, is_imaginary, is_real) = unknowns[column];
            let (p, z) = (self.points[sample], self.points[at]);
            let (here, there) = (data[(sample, mixture)], data[(at, mixture)]);
            let own = (here - there) / (p - z);
            let value = match symmetry {
                Symmetry::None => own * unit(is_imaginary),
                Symmetry::Conjugate if is_real => own,
                Symmetry::Conjugate => {
                    let other = (here - there.conj()) / (p - z.conj());
                    own * unit(is_imaginary) + other * unit(is_imaginary).conj()
                }
            };
            if row.is_multiple_of(2) {
                value.re
            } else {
                value.im
            }
        };
        let loewner = Mat::from_fn(2 * mixtures * others.len(), unknowns.len(), entry);
        let triangle = loewner.qr().thin_R().to_owned();
        let svd = triangle.thin_svd().ok()?;
        let last = svd.V().col(unknowns.len() - 1).to_owned();
        let mut nodes: Vec<Node> = Vec::new();
        for (&(sample, is_imaginary, _), part) in unknowns.iter().zip(last.iter()) {
            let added = unit(is_imaginary) * *part;
            match nodes.last_mut().filter(|node| node.sample == sample) {
                Some(node) => node.weight += added,
                None => nodes.push(Node {
                    sample,
                    weight: added,
                    is_conjugate: false,
                }),
            }
        }
        if symmetry == Symmetry::Conjugate {
            nodes = nodes
                .into_iter()
                .flat_map(|node| node.with_mirror(self))
                .collect();
        }
        Some(nodes)
    }

    /// The sample of the largest misfit.
    fn worst(&self, data: &Mat<c64>, chosen: &[usize], nodes: &[Node]) -> Option<(usize, f64)> {
        let misfit = |sample: usize| {
            let p = self.points[sample];
            let fractions: Vec<c64> = nodes
                .iter()
                .map(|node| node.weight / (p - node.point(self)))
                .collect();
            let sum: c64 = fractions.iter().sum();
            let square = |mixture: usize| {
                let term = |(node, fraction): (&Node, &c64)| {
                    let value = data[(node.sample, mixture)];
                    fraction
                        * if node.is_conjugate {
                            value.conj()
                        } else {
                            value
                        }
                };
                let above: c64 = nodes.iter().zip(&fractions).map(term).sum();
                (above / sum - data[(sample, mixture)]).norm_sqr()
            };
            (0..data.ncols()).map(square).sum::<f64>().sqrt()
        };
        (0..data.nrows())
            .filter(|sample| !chosen.contains(sample))
            .map(|sample| (sample, misfit(sample)))
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Whether support points come in conjugate pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Symmetry {
    None,
    Conjugate,
}

/// A support point by the sample it is, or is the conjugate of.
#[derive(Clone, Copy, Debug)]
struct Node {
    sample: usize,
    weight: c64,
    is_conjugate: bool,
}

impl Node {
    fn point(&self, samples: &Samples) -> c64 {
        let point = samples.points[self.sample];
        if self.is_conjugate {
            point.conj()
        } else {
            point
        }
    }

    /// With its mirror image, unless it is real.
    fn with_mirror(self, samples: &Samples) -> impl Iterator<Item = Self> {
        let mirror = Self {
            weight: self.weight.conj(),
            is_conjugate: true,
            ..self
        };
        let has_mirror = samples.points[self.sample].im != 0.0;
        std::iter::once(self).chain(has_mirror.then_some(mirror))
    }
}

fn unit(is_imaginary: bool) -> c64 {
    if is_imaginary {
        c64::new(0.0, 1.0)
    } else {
        c64::new(1.0, 0.0)
    }
}

fn row_size(data: &Mat<c64>, row: usize) -> f64 {
    (0..data.ncols())
        .map(|column| data[(row, column)].norm_sqr())
        .sum::<f64>()
        .sqrt()
}
