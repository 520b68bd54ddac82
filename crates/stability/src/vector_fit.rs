//! Poles of a rational model from samples.
//!
//! The poles are found by vector fitting (Gustavsen & Semlyen 1999) on the
//! leading directions of all entries; a pole that wanders into
//! $\operatorname{Re}p>0$ is reflected. Their number is the smallest whose
//! error at samples left out is within twice the best.

use faer::{Mat, c64};

use crate::aerodynamics::Aerodynamics;
use crate::gaf::GafTable;
use crate::linalg::{NoConvergence, eigenvalues_real, largest, least_squares};
use crate::rational::{Pole, RationalFit, append, functions};

/// Numbers of poles that are tried. Noisy samples settle for the smallest;
/// clean ones of a whole aircraft have asked for thirteen.
const ORDERS: std::ops::RangeInclusive<usize> = 3..=14;

/// Samples there must be beyond the number of poles.
const SPARE_SAMPLES: usize = 6;

/// Rounds of pole relocation; clean data settle within ten.
const ROUNDS: usize = 15;

/// Directions under this part of the first are noise to the poles.
const DIRECTION_TOLERANCE: f64 = 1e-10;

/// Entries under this part of the largest are not scaled up to it: they may be
/// noise.
const SMALLEST_SCALE: f64 = 1e-3;

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

/// Fits a table with the smallest adequate number of poles.
pub(crate) fn fit(table: &GafTable) -> Result<RationalFit, NoConvergence> {
    let data = Samples::new(table);
    let spare = data.points.len().saturating_sub(SPARE_SAMPLES);
    let most = spare.clamp(1, *ORDERS.end());
    let least = most.min(*ORDERS.start());
    let tried: Vec<(f64, usize)> = (least..=most)
        .map(|order| Ok((data.validation_error(order)?, order)))
        .collect::<Result<_, _>>()?;
    let best = tried
        .iter()
        .map(|(error, _)| *error)
        .fold(f64::INFINITY, f64::min);
    let order = tried
        .iter()
        .find(|(error, _)| *error <= WORTH_A_POLE * best)
        .map_or(most, |(_, order)| *order);
    let all: Vec<usize> = (0..data.points.len()).collect();
    let poles = data.poles(order, &all)?;
    data.solve(poles, table)
}

/// More poles must better the error by this factor.
const WORTH_A_POLE: f64 = 2.0;

/// Samples of $(Q(p) - Q(0))/p$, real and imaginary parts below each other.
///
/// Divided by $p$ slow and fast motions count alike: forces on a rigid body
/// vanish with $p$, and without the division its slow roots would be lost in
/// the misfit of the large entries at high $k$.
struct Samples {
    points: Vec<c64>,
    at_rest: Mat<f64>,
    /// Rows 2i and 2i+1: real and imaginary part at point i; one column for
    /// each entry of the matrix.
    values: Mat<c64>,
    /// The same for the leading directions.
    directions: Vec<Vec<f64>>,
    nearest_pole: f64,
    is_pinned: bool,
}

impl Samples {
    fn new(table: &GafTable) -> Self {
        let [rows, columns] = table.shape();
        let is_pinned = table.k()[0] == 0.0;
        let at_rest = match table.axis().next() {
            Some(q) if is_pinned => Mat::from_fn(rows, columns, |i, j| q[(i, j)].re),
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
        let values = Mat::from_fn(2 * points.len(), rows * columns, |row, entry| {
            let place = (entry % rows, entry / rows);
            let p = points[row / 2];
            let value = (matrices[row / 2][place] - at_rest[place]) / p;
            c64::new(if row % 2 == 0 { value.re } else { value.im }, 0.0)
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
            let out: Vec<usize> = (0..=last).filter(is_out).collect();
            if out.is_empty() {
                continue;
            }
            let poles = self.poles(order, &kept)?;
            for direction in &self.directions {
                let rows = |points: &[usize]| -> Vec<f64> {
                    points
                        .iter()
                        .flat_map(|&point| [direction[2 * point], direction[2 * point + 1]])
                        .collect()
                };
                let weights = real_fit(&self.design(&kept, &poles), &rows(&kept))?;
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

    /// The basis functions over $p$ at some points, real and imaginary parts.
    fn design(&self, points: &[usize], poles: &[Pole]) -> Mat<f64> {
        let columns: Vec<Vec<c64>> = points
            .iter()
            .map(|&point| {
                let p = self.points[point];
                functions(p, poles)
                    .into_iter()
                    .map(|value| value / p)
                    .collect()
            })
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
        let [rows, columns] = table.shape();
        let all: Vec<usize> = (0..self.points.len()).collect();
        let design = self.design(&all, &poles);
        let wide = Mat::from_fn(design.nrows(), design.ncols(), |i, j| {
            c64::new(design[(i, j)], 0.0)
        });
        let solved = least_squares(wide.as_ref(), self.values.as_ref())?.solution;
        let coefficients = (0..design.ncols())
            .map(|row| Mat::from_fn(rows, columns, |i, j| solved[(row, j * rows + i)].re))
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
    let [rows, columns] = table.shape();
    Mat::from_fn(rows, columns, |i, j| {
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

/// Directions that span the entries, each entry scaled to one, largest
/// remainder first.
fn leading_directions(values: &Mat<c64>) -> Vec<Vec<f64>> {
    let rows = values.nrows();
    let size = |column: &[f64]| column.iter().map(|v| v * v).sum::<f64>().sqrt();
    let mut residual: Vec<Vec<f64>> = (0..values.ncols())
        .map(|column| (0..rows).map(|row| values[(row, column)].re).collect())
        .collect();
    let largest = residual
        .iter()
        .map(|column| size(column))
        .fold(f64::MIN_POSITIVE, f64::max);
    for column in &mut residual {
        let scale = size(column).max(SMALLEST_SCALE * largest);
        for value in column {
            *value /= scale;
        }
    }
    let mut directions: Vec<Vec<f64>> = Vec::new();
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
