//! A rational model of $Q$ with common stable poles.
//!
//! $$ Q(p) = Q(0) + R_1p + R_2p^2 + \sum_j R_{2+j}\,\frac{p}{p - a_j},
//!    \qquad \operatorname{Re}a_j < 0 $$
//!
//! with real coefficient matrices and poles that are real or come in
//! conjugate pairs, so that $Q(\bar p) = \overline{Q(p)}$ and $Q(0)$ is exact.
//! The poles are found by vector fitting (Gustavsen & Semlyen 1999) on the
//! leading singular directions of all entries; a pole that wanders into
//! $\operatorname{Re}p>0$ is reflected. Their number is the smallest whose
//! error at samples left out is within twice the best.

use faer::{Mat, c64};

use crate::aerodynamics::Aerodynamics;
use crate::gaf::GafTable;
use crate::linalg::{NoConvergence, eigenvalues_real, largest, least_squares};

/// Numbers of poles that are tried.
const ORDERS: std::ops::RangeInclusive<usize> = 3..=8;

/// Rounds of pole relocation; clean data settle within ten.
const ROUNDS: usize = 15;

/// Singular directions under this part of the first are noise to the poles.
const DIRECTION_TOLERANCE: f64 = 1e-10;

/// More directions add cost and no poles.
const MOST_DIRECTIONS: usize = 20;

/// Samples are left out in this many turns.
const FOLDS: usize = 4;

/// Samples with $g<0$ and $k$ below this many times $|g|$ are too near the
/// branch cut of the wake for a few poles, and are not fitted.
const CUT_SLOPE: f64 = 2.0;

/// A pole nearer to the origin than this part of the first positive $k$ has
/// no sample that could tell it from a constant.
const NEAREST_POLE: f64 = 0.25;

/// A rational model of $Q$, smooth everywhere right of its poles.
#[derive(Clone, Debug)]
pub struct RationalFit {
    at_rest: Mat<f64>,
    poles: Vec<Pole>,
    /// Coefficients of $p$, $p^2$ and of the pole functions in order.
    coefficients: Vec<Mat<f64>>,
    error: f64,
    notes: Vec<String>,
}

/// A real pole or a conjugate pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Pole {
    /// $a$.
    Real(f64),
    /// $a$ and $\bar a$, $\operatorname{Im}a>0$.
    Pair(c64),
}

impl RationalFit {
    /// Fits all samples of a table, off the axis too.
    ///
    /// # Errors
    /// A decomposition that fails.
    pub fn new(table: &GafTable) -> Result<Self, NoConvergence> {
        let data = Samples::new(table);
        let mut best: Option<(f64, Vec<Pole>)> = None;
        let mut tried = Vec::new();
        let most = ORDERS
            .end()
            .to_owned()
            .min(data.points.len().saturating_sub(3) / 2)
            .max(1);
        let least = ORDERS.start().to_owned().min(most);
        for order in least..=most {
            tried.push((data.validation_error(order)?, order));
        }
        let least_error = tried
            .iter()
            .map(|(error, _)| *error)
            .fold(f64::INFINITY, f64::min);
        for (error, order) in tried {
            if error <= 2.0 * least_error && best.is_none() {
                let all: Vec<usize> = (0..data.points.len()).collect();
                best = Some((error, data.poles(order, &all)?));
            }
        }
        let (_, poles) = best.unwrap_or((0.0, Vec::new()));
        data.solve(poles, table)
    }

    /// Largest misfit at a fitted sample, as a fraction of the largest entry.
    pub fn residual(&self) -> f64 {
        self.error
    }

    /// Poles in the upper half plane and on the real axis.
    pub fn poles(&self) -> Vec<c64> {
        self.poles
            .iter()
            .map(|pole| match pole {
                Pole::Real(a) => c64::new(*a, 0.0),
                Pole::Pair(a) => *a,
            })
            .collect()
    }

    /// What a user should know, one sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    pub(crate) fn pole_list(&self) -> &[Pole] {
        &self.poles
    }

    pub(crate) fn at_rest(&self) -> &Mat<f64> {
        &self.at_rest
    }

    pub(crate) fn coefficients(&self) -> &[Mat<f64>] {
        &self.coefficients
    }

    fn combine(&self, constant: f64, weights: &[c64]) -> Mat<c64> {
        let order = self.at_rest.nrows();
        let mut out = Mat::from_fn(order, order, |i, j| {
            c64::new(constant * self.at_rest[(i, j)], 0.0)
        });
        for (coefficient, weight) in self.coefficients.iter().zip(weights) {
            for j in 0..order {
                for i in 0..order {
                    out[(i, j)] += weight * coefficient[(i, j)];
                }
            }
        }
        out
    }
}

impl Aerodynamics for RationalFit {
    fn order(&self) -> usize {
        self.at_rest.nrows()
    }

    fn q(&self, p: c64) -> Mat<c64> {
        self.combine(1.0, &functions(p, &self.poles))
    }

    fn q_and_slope(&self, p: c64) -> (Mat<c64>, Mat<c64>) {
        (self.q(p), self.combine(0.0, &slopes(p, &self.poles)))
    }

    fn rightmost_pole(&self) -> Option<f64> {
        let real_parts = self.poles().into_iter().map(|pole| pole.re);
        real_parts.reduce(f64::max)
    }

    fn as_rational(&self) -> Option<&RationalFit> {
        Some(self)
    }
}

/// $p$, $p^2$, $p/(p-a)$; for a pair the sum with its conjugate and $\mathrm i$
/// times the difference, which have real coefficients.
fn functions(p: c64, poles: &[Pole]) -> Vec<c64> {
    let mut values = vec![p, p * p];
    append(&mut values, poles, |a| p / (p - a));
    values
}

fn slopes(p: c64, poles: &[Pole]) -> Vec<c64> {
    let mut values = vec![c64::new(1.0, 0.0), p * 2.0];
    append(&mut values, poles, |a| -a / ((p - a) * (p - a)));
    values
}

fn append(values: &mut Vec<c64>, poles: &[Pole], function: impl Fn(c64) -> c64) {
    for pole in poles {
        match *pole {
            Pole::Real(a) => values.push(function(c64::new(a, 0.0))),
            Pole::Pair(a) => {
                let (one, other) = (function(a), function(a.conj()));
                values.push(one + other);
                values.push(c64::new(0.0, 1.0) * (one - other));
            }
        }
    }
}

/// Samples of $Q(p) - Q(0)$, real and imaginary parts below each other.
struct Samples {
    points: Vec<c64>,
    at_rest: Mat<f64>,
    /// Rows 2i and 2i+1: real and imaginary part at point i; a column an
    /// entry of the matrix.
    values: Mat<c64>,
    /// The same for the leading singular directions.
    directions: Vec<Vec<f64>>,
    nearest_pole: f64,
    is_pinned: bool,
}

impl Samples {
    fn new(table: &GafTable) -> Self {
        let order = table.order();
        let is_pinned = table.k()[0] == 0.0;
        let at_rest = match table.axis().next() {
            Some(q) if is_pinned => Mat::from_fn(order, order, |i, j| q[(i, j)].re),
            _ => extrapolated_rest(table),
        };
        let (mut points, mut matrices) = (Vec::new(), Vec::new());
        for (i, &g) in table.g().iter().enumerate() {
            for (j, &k) in table.k().iter().enumerate() {
                let p = c64::new(g, k);
                let wanted = p.norm() > 0.0 && is_clear_of_cut(p);
                if let Some(q) = table.sample(i, j).filter(|_| wanted) {
                    points.push(p);
                    matrices.push(q);
                }
            }
        }
        let values = Mat::from_fn(2 * points.len(), order * order, |row, entry| {
            let (i, j) = (entry % order, entry / order);
            let value = matrices[row / 2][(i, j)];
            let part = if row % 2 == 0 {
                value.re - at_rest[(i, j)]
            } else {
                value.im
            };
            c64::new(part, 0.0)
        });
        let directions = leading_directions(&values);
        let first = table.k().iter().copied().find(|k| *k > 0.0).unwrap_or(1.0);
        let nearest_pole = NEAREST_POLE * first;
        Self {
            points,
            at_rest,
            values,
            directions,
            nearest_pole,
            is_pinned,
        }
    }

    /// Root mean square error of the directions at samples left out in turn.
    fn validation_error(&self, order: usize) -> Result<f64, NoConvergence> {
        let mut sum = 0.0;
        for fold in 0..FOLDS {
            let last = self.points.len() - 1;
            let is_out = |point: &usize| *point != last && point % FOLDS == fold;
            let kept: Vec<usize> = (0..=last).filter(|point| !is_out(point)).collect();
            let poles = self.poles(order, &kept)?;
            for direction in &self.directions {
                let rows = |points: &[usize]| -> Vec<f64> {
                    points
                        .iter()
                        .flat_map(|&point| [direction[2 * point], direction[2 * point + 1]])
                        .collect()
                };
                let weights = real_fit(&self.design(&kept, &poles), &rows(&kept))?;
                let out: Vec<usize> = (0..=last).filter(is_out).collect();
                let design = self.design(&out, &poles);
                let misfit = rows(&out).into_iter().enumerate().map(|(row, value)| {
                    let model: f64 = weights
                        .iter()
                        .enumerate()
                        .map(|(c, w)| design[(row, c)] * w)
                        .sum();
                    (model - value) * (model - value)
                });
                sum += misfit.sum::<f64>();
            }
        }
        Ok(sum.sqrt())
    }

    /// The basis functions at some points, real and imaginary parts.
    fn design(&self, points: &[usize], poles: &[Pole]) -> Mat<f64> {
        let columns: Vec<Vec<c64>> = points
            .iter()
            .map(|&point| functions(self.points[point], poles))
            .collect();
        Mat::from_fn(2 * points.len(), columns[0].len(), |row, column| {
            let value = columns[row / 2][column];
            if row % 2 == 0 { value.re } else { value.im }
        })
    }

    /// Vector fitting of the poles to some of the points.
    fn poles(&self, order: usize, points: &[usize]) -> Result<Vec<Pole>, NoConvergence> {
        let k_max = self.points.iter().map(|p| p.im).fold(0.0, f64::max);
        let spread = |index: usize| 0.1 + 0.9 * index as f64 / (order.max(2) - 1) as f64;
        let mut poles: Vec<Pole> = (0..order)
            .map(|index| Pole::Real(-k_max * spread(index)))
            .collect();
        for _ in 0..ROUNDS {
            let weights = self.relocation_weights(points, &poles)?;
            poles = self.zeros(&poles, &weights)?;
        }
        Ok(poles)
    }

    /// Coefficients of $\sigma(p) = 1 + \sum c_j/(p-a_j)$ for which
    /// $\sigma(p)\,Q(p)$ is best represented by the poles.
    fn relocation_weights(
        &self,
        points: &[usize],
        poles: &[Pole],
    ) -> Result<Vec<f64>, NoConvergence> {
        let basis = orthonormal(&self.design(points, poles));
        let fractions: Vec<Vec<c64>> = points
            .iter()
            .map(|&point| {
                let mut values = Vec::new();
                append(&mut values, poles, |a| 1.0 / (self.points[point] - a));
                values
            })
            .collect();
        let (rows, columns) = (2 * points.len(), fractions[0].len());
        let total = rows * self.directions.len();
        let (mut design, mut rhs) = (Mat::zeros(total, columns), vec![0.0; total]);
        for (block, direction) in self.directions.iter().enumerate() {
            let value = |point: usize| c64::new(direction[2 * point], direction[2 * point + 1]);
            let split = |numbers: Vec<c64>| -> Vec<f64> {
                numbers
                    .into_iter()
                    .flat_map(|number| [number.re, number.im])
                    .collect()
            };
            let target = split(points.iter().map(|&point| value(point)).collect());
            for (row, part) in reject(&basis, target).into_iter().enumerate() {
                rhs[block * rows + row] = part;
            }
            for column in 0..columns {
                let products = points.iter().zip(&fractions);
                let product = split(products.map(|(&p, f)| -f[column] * value(p)).collect());
                for (row, part) in reject(&basis, product).into_iter().enumerate() {
                    design[(block * rows + row, column)] = part;
                }
            }
        }
        real_fit(&design, &rhs)
    }

    /// Zeros of σ, the next poles: eigenvalues of $A - bc^T$.
    fn zeros(&self, poles: &[Pole], weights: &[f64]) -> Result<Vec<Pole>, NoConvergence> {
        let size = weights.len();
        let mut matrix = Mat::<f64>::zeros(size, size);
        let mut at = 0;
        for pole in poles {
            match *pole {
                Pole::Real(a) => {
                    matrix[(at, at)] = a;
                    (0..size).for_each(|column| matrix[(at, column)] -= weights[column]);
                    at += 1;
                }
                Pole::Pair(a) => {
                    matrix[(at, at)] = a.re;
                    matrix[(at, at + 1)] = a.im;
                    matrix[(at + 1, at)] = -a.im;
                    matrix[(at + 1, at + 1)] = a.re;
                    (0..size).for_each(|column| matrix[(at, column)] -= 2.0 * weights[column]);
                    at += 2;
                }
            }
        }
        let mut next: Vec<Pole> = eigenvalues_real(matrix.as_ref())?
            .into_iter()
            .filter(|value| value.im >= 0.0)
            .map(|value| self.settle(value))
            .collect();
        next.sort_by(|a, b| real_part(*a).total_cmp(&real_part(*b)));
        Ok(next)
    }

    /// Reflects into the left half plane and keeps off the origin.
    fn settle(&self, value: c64) -> Pole {
        let real = -value.re.abs();
        if value.im > 0.0 {
            return Pole::Pair(c64::new(real.min(-self.nearest_pole), value.im));
        }
        Pole::Real(real.min(-self.nearest_pole))
    }

    fn solve(&self, poles: Vec<Pole>, table: &GafTable) -> Result<RationalFit, NoConvergence> {
        let order = table.order();
        let all: Vec<usize> = (0..self.points.len()).collect();
        let design = self.design(&all, &poles);
        let wide = Mat::from_fn(design.nrows(), design.ncols(), |i, j| {
            c64::new(design[(i, j)], 0.0)
        });
        let solved = least_squares(wide.as_ref(), self.values.as_ref())?.solution;
        let coefficients = (0..design.ncols())
            .map(|row| Mat::from_fn(order, order, |i, j| solved[(row, j * order + i)].re))
            .collect();
        let mut notes = Vec::new();
        if !self.is_pinned {
            notes.push("no sample at k = 0: the rational fit extrapolates Q(0)".to_owned());
        }
        let at_rest = self.at_rest.clone();
        let mut fit = RationalFit {
            at_rest,
            poles,
            coefficients,
            error: 0.0,
            notes,
        };
        fit.error = misfit(&fit, table);
        Ok(fit)
    }
}

fn is_clear_of_cut(p: c64) -> bool {
    p.im >= -CUT_SLOPE * p.re
}

fn real_part(pole: Pole) -> f64 {
    match pole {
        Pole::Real(a) => a,
        Pole::Pair(a) => a.re,
    }
}

/// $Q(0)$ of a table without $k = 0$: the real part, even in $k$, continued by
/// the parabola through the first two samples.
fn extrapolated_rest(table: &GafTable) -> Mat<f64> {
    let samples: Vec<&Mat<c64>> = table.axis().take(2).collect();
    let (first, second) = (table.k()[0], table.k()[1]);
    let weight = first * first / (second * second - first * first);
    Mat::from_fn(table.order(), table.order(), |i, j| {
        let (one, other) = (samples[0][(i, j)].re, samples[1][(i, j)].re);
        one - (other - one) * weight
    })
}

fn misfit(fit: &RationalFit, table: &GafTable) -> f64 {
    let (mut worst, mut scale): (f64, f64) = (0.0, f64::MIN_POSITIVE);
    for (i, &g) in table.g().iter().enumerate() {
        for (j, &k) in table.k().iter().enumerate() {
            let p = c64::new(g, k);
            if let Some(q) = table.sample(i, j).filter(|_| is_clear_of_cut(p)) {
                scale = scale.max(largest(q.as_ref()));
                worst = worst.max(largest((fit.q(p) - q).as_ref()));
            }
        }
    }
    worst / scale
}

/// Left singular directions times their singular values, from the Gram matrix
/// of the rows.
fn leading_directions(values: &Mat<c64>) -> Vec<Vec<f64>> {
    let rows = values.nrows();
    let scale = largest(values.as_ref()).max(f64::MIN_POSITIVE);
    let mut residual: Vec<Vec<f64>> = (0..values.ncols())
        .map(|column| {
            (0..rows)
                .map(|row| values[(row, column)].re / scale)
                .collect()
        })
        .collect();
    let mut directions: Vec<Vec<f64>> = Vec::new();
    let size = |column: &[f64]| column.iter().map(|v| v * v).sum::<f64>().sqrt();
    let mut first = 0.0;
    while directions.len() < MOST_DIRECTIONS.min(rows) {
        let pivot = (0..residual.len())
            .max_by(|&a, &b| size(&residual[a]).total_cmp(&size(&residual[b])));
        let Some(pivot) = pivot else { break };
        let length = size(&residual[pivot]);
        if directions.is_empty() {
            first = length;
        }
        if length <= DIRECTION_TOLERANCE * first || length == 0.0 {
            break;
        }
        let direction: Vec<f64> = residual[pivot].clone();
        let unit: Vec<f64> = direction.iter().map(|v| v / length).collect();
        for column in &mut residual {
            let part: f64 = column.iter().zip(&unit).map(|(a, b)| a * b).sum();
            column
                .iter_mut()
                .zip(&unit)
                .for_each(|(value, u)| *value -= part * u);
        }
        directions.push(direction);
    }
    directions
}

/// Orthonormal columns that span those of a matrix (Gram–Schmidt, twice).
fn orthonormal(matrix: &Mat<f64>) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for column in 0..matrix.ncols() {
        let raw: Vec<f64> = (0..matrix.nrows())
            .map(|row| matrix[(row, column)])
            .collect();
        let before = raw.iter().map(|v| v * v).sum::<f64>().sqrt();
        let once = reject(&basis, raw);
        let rest = reject(&basis, once);
        let length = rest.iter().map(|v| v * v).sum::<f64>().sqrt();
        if length > 1e-13 * before {
            basis.push(rest.into_iter().map(|v| v / length).collect());
        }
    }
    basis
}

/// What is left of a vector after its parts along the basis are taken off.
fn reject(basis: &[Vec<f64>], mut vector: Vec<f64>) -> Vec<f64> {
    for unit in basis {
        let part: f64 = unit.iter().zip(&vector).map(|(a, b)| a * b).sum();
        vector
            .iter_mut()
            .zip(unit)
            .for_each(|(value, u)| *value -= part * u);
    }
    vector
}

/// Real least squares with columns scaled to unit length.
fn real_fit(design: &Mat<f64>, rhs: &[f64]) -> Result<Vec<f64>, NoConvergence> {
    let (rows, columns) = (design.nrows(), design.ncols());
    let scales: Vec<f64> = (0..columns)
        .map(|column| {
            let sum: f64 = (0..rows).map(|row| design[(row, column)].powi(2)).sum();
            sum.sqrt().max(f64::MIN_POSITIVE)
        })
        .collect();
    let scaled = Mat::from_fn(rows, columns, |i, j| {
        c64::new(design[(i, j)] / scales[j], 0.0)
    });
    let target = Mat::from_fn(rows, 1, |i, _| c64::new(rhs[i], 0.0));
    let solved = least_squares(scaled.as_ref(), target.as_ref())?.solution;
    Ok((0..columns)
        .map(|column| solved[(column, 0)].re / scales[column])
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gaf::GafPoint;

    /// A function with a real pole and a pair is found exactly.
    #[test]
    fn a_rational_function_is_recovered() {
        let pair = c64::new(-0.3, 0.7);
        let exact = |p: c64| {
            Mat::from_fn(2, 2, |i, j| {
                let weight = 1.0 + i as f64 - 2.0 * j as f64;
                p * p * weight
                    + p * (0.3 + j as f64)
                    + 0.5 * weight
                    + p / (p + 0.2) * (1.0 - i as f64 * 0.5)
                    + (p / (p - pair) + p / (p - pair.conj())) * 0.4 * weight
            })
        };
        let points: Vec<GafPoint> = (0..=20)
            .map(|i| 1.5 * (f64::from(i) / 20.0).powf(1.5))
            .map(|k| GafPoint {
                g: 0.0,
                k,
                q: exact(c64::new(0.0, k)),
            })
            .collect();
        let modes = vec!["a".to_owned(), "b".to_owned()];
        let table = GafTable::new(1.0, 0.0, modes, points, vec![]).unwrap();
        let fit = RationalFit::new(&table).unwrap();
        println!("poles {:?}, residual {:.1e}", fit.poles(), fit.residual());
        assert!(fit.residual() < 1e-11);
        let p = c64::new(-0.1, 0.33);
        assert!(largest((fit.q(p) - exact(p)).as_ref()) < 1e-9);
        let (_, slope) = fit.q_and_slope(p);
        let step = 1e-6;
        let difference =
            (fit.q(p + step) - fit.q(p - step)) * faer::Scale(c64::new(0.5 / step, 0.0));
        assert!(largest((slope - difference).as_ref()) < 1e-8);
    }
}
