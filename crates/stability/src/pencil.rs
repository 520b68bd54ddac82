//! $T(p)$ at many points at once.
//!
//! Where $Q(p) = \sum_jw_j(p)R_j$ with real matrices $R_j$,
//! $$ T(p) = p^2\tilde M + p\,\tilde C + K - q_\infty\sum_jw_j(p)R_j $$
//! is a combination of real matrices with complex factors, and its values at
//! $m$ points are one real matrix product: entries × matrices times matrices ×
//! $2m$. Where only the determinant is wanted, as in a count of roots, eight
//! points go through one factorisation side by side.

use faer::{Mat, c64};

use pulp::Arch;

use crate::aerodynamics::{Aerodynamics, Expansion};
use crate::lane_lu::{LaneMatrices, WIDTH};
use crate::linalg::real_product;
use crate::structure::{Hysteresis, Reduced};

/// Size of $p$ at which inertia and stiffness are weighed against each other.
const MIDDLE: f64 = 0.5;

/// Points of one product: enough for the product to run at full rate, few
/// enough to stay in the cache.
const BATCH: usize = 32;

/// The problem at one flight condition, ready for evaluation.
pub(crate) struct Pencil<'a> {
    pub(crate) reduced: &'a Reduced,
    pub(crate) aerodynamics: &'a dyn Aerodynamics,
    expanded: Option<Expanded<'a>>,
}

struct Expanded<'a> {
    expansion: &'a dyn Expansion,
    /// One column each for $\tilde M$, $\tilde C$, $K$ and the $q_\infty R_j$,
    /// entries column by column.
    matrices: Mat<f64>,
    /// The same, those of one entry side by side, rows and columns in the order
    /// and scale of the places: the direction of the determinant stays, and
    /// few rows need an exchange.
    terms: Vec<f64>,
    places: Vec<Place>,
}

/// A mode in the order of elimination.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) mode: usize,
    /// Factor of its row and of its column.
    pub(crate) scale: f64,
}

/// Stiff modes first, whose diagonals are large at any $p$ of interest; the
/// rigid ones, whose diagonals vanish with $p$, last.
fn places(reduced: &Reduced) -> Vec<Place> {
    let stiffness = |mode: usize| {
        let inertia = reduced.mass[(mode, mode)].max(f64::MIN_POSITIVE);
        reduced.stiffness[(mode, mode)].abs() / inertia
    };
    let mut modes: Vec<usize> = (0..reduced.order()).collect();
    modes.sort_by(|a, b| stiffness(*b).total_cmp(&stiffness(*a)).then(a.cmp(b)));
    let place = |mode: usize| {
        let inertia = reduced.mass[(mode, mode)] * MIDDLE * MIDDLE;
        let size = inertia + reduced.stiffness[(mode, mode)].abs();
        let scale = 1.0 / size.max(f64::MIN_POSITIVE).sqrt();
        Place { mode, scale }
    };
    modes.into_iter().map(place).collect()
}

/// $T$ or $T'$.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    Value,
    Slope,
}

impl<'a> Pencil<'a> {
    pub(crate) fn new(reduced: &'a Reduced, aerodynamics: &'a dyn Aerodynamics) -> Self {
        let expanded = aerodynamics
            .expansion()
            .map(|expansion| Expanded::new(reduced, expansion));
        Self {
            reduced,
            aerodynamics,
            expanded,
        }
    }

    /// $T(p)$.
    pub(crate) fn operator(&self, p: c64, hysteresis: Hysteresis) -> Mat<c64> {
        self.reduced
            .operator(p, &self.aerodynamics.q(p), hysteresis)
    }

    /// Calls `visit` with the number of every point and $T$ there.
    pub(crate) fn each_operator(
        &self,
        points: &[c64],
        hysteresis: Hysteresis,
        mut visit: impl FnMut(usize, Mat<c64>),
    ) {
        let Some(expanded) = &self.expanded else {
            for (number, &p) in points.iter().enumerate() {
                visit(number, self.operator(p, hysteresis));
            }
            return;
        };
        for (batch, points) in points.chunks(BATCH).enumerate() {
            let values = expanded.combine(points, Wanted::Value);
            for (at, _) in points.iter().enumerate() {
                let mut operator = self.matrix(&values, at);
                if hysteresis == Hysteresis::Included {
                    self.reduced.add_hysteresis(&mut operator);
                }
                visit(batch * BATCH + at, operator);
            }
        }
    }

    /// Direction of $\det T$ in the complex plane at every point; NaN where it
    /// vanishes.
    pub(crate) fn directions(&self, points: &[c64], hysteresis: Hysteresis) -> Vec<c64> {
        let arch = Arch::new();
        let mut lanes = LaneMatrices::new(self.reduced.order());
        let mut directions = Vec::with_capacity(points.len());
        for group in points.chunks(WIDTH) {
            match &self.expanded {
                Some(expanded) => {
                    let weights = expanded.lane_weights(group);
                    lanes.combine(arch, &expanded.terms, &weights);
                    if hysteresis == Hysteresis::Included {
                        self.reduced
                            .add_hysteresis_to_lanes(&mut lanes, &expanded.places);
                    }
                }
                None => self.fill(&mut lanes, group, hysteresis),
            }
            let found = lanes.determinants(arch);
            directions.extend(&found[..group.len()]);
        }
        directions
    }

    /// One point a lane, the last in those that are left.
    fn fill(&self, lanes: &mut LaneMatrices, points: &[c64], hysteresis: Hysteresis) {
        let order = self.reduced.order();
        let operators: Vec<Mat<c64>> = points
            .iter()
            .map(|p| self.operator(*p, hysteresis))
            .collect();
        for lane in 0..WIDTH {
            let operator = &operators[lane.min(operators.len() - 1)];
            for column in 0..order {
                for row in 0..order {
                    lanes.set(row, column, lane, operator[(row, column)]);
                }
            }
        }
    }

    /// Calls `visit` with the number of every point, $T$ and $T'$ there; each
    /// point has the hysteresis that belongs to it.
    pub(crate) fn each_operator_and_slope(
        &self,
        points: &[c64],
        mut visit: impl FnMut(usize, Mat<c64>, Mat<c64>),
    ) {
        let Some(expanded) = &self.expanded else {
            for (number, &p) in points.iter().enumerate() {
                let (q, slope) = self.aerodynamics.q_and_slope(p);
                let hysteresis = Reduced::hysteresis_at(p);
                visit(
                    number,
                    self.reduced.operator(p, &q, hysteresis),
                    self.reduced.operator_slope(p, &slope),
                );
            }
            return;
        };
        for (batch, points) in points.chunks(BATCH).enumerate() {
            let values = expanded.combine(points, Wanted::Value);
            let slopes = expanded.combine(points, Wanted::Slope);
            for (at, &p) in points.iter().enumerate() {
                let mut operator = self.matrix(&values, at);
                if Reduced::hysteresis_at(p) == Hysteresis::Included {
                    self.reduced.add_hysteresis(&mut operator);
                }
                visit(batch * BATCH + at, operator, self.matrix(&slopes, at));
            }
        }
    }

    /// Columns `2 at` and `2 at + 1` as a complex matrix.
    fn matrix(&self, values: &Mat<f64>, at: usize) -> Mat<c64> {
        let order = self.reduced.order();
        let real = values.col_as_slice(2 * at);
        let imaginary = values.col_as_slice(2 * at + 1);
        let mut out = Mat::zeros(order, order);
        for column in 0..order {
            let span = column * order..(column + 1) * order;
            let parts = real[span.clone()].iter().zip(&imaginary[span]);
            let target = out.col_as_slice_mut(column).iter_mut();
            for (entry, (re, im)) in target.zip(parts) {
                *entry = c64::new(*re, *im);
            }
        }
        out
    }
}

impl<'a> Expanded<'a> {
    fn new(reduced: &Reduced, expansion: &'a dyn Expansion) -> Self {
        let order = reduced.order();
        let loads: Vec<Mat<f64>> = expansion
            .matrices()
            .iter()
            .map(|matrix| reduced.real_loads(matrix))
            .collect();
        let mut columns: Vec<&Mat<f64>> =
            vec![&reduced.mass, &reduced.damping, &reduced.stiffness];
        columns.extend(&loads);
        let matrices = Mat::from_fn(order * order, columns.len(), |entry, column| {
            columns[column][(entry % order, entry / order)]
        });
        let places = places(reduced);
        let mut terms = Vec::with_capacity(order * order * columns.len());
        for column in &places {
            for row in &places {
                let scale = row.scale * column.scale;
                let entry = (row.mode, column.mode);
                terms.extend(columns.iter().map(|matrix| matrix[entry] * scale));
            }
        }
        Self {
            expansion,
            matrices,
            terms,
            places,
        }
    }

    /// Factors of the matrices at up to eight points; the last point fills the
    /// lanes that are left.
    fn lane_weights(&self, points: &[c64]) -> Vec<[[f64; WIDTH]; 2]> {
        let mut weights = vec![[[0.0; WIDTH]; 2]; self.matrices.ncols()];
        for lane in 0..WIDTH {
            let p = points[lane.min(points.len() - 1)];
            let head = [p * p, p, c64::new(1.0, 0.0)];
            let loads = self.expansion.weights(p).into_iter().map(|w| -w);
            for (weight, factor) in weights.iter_mut().zip(head.into_iter().chain(loads)) {
                weight[0][lane] = factor.re;
                weight[1][lane] = factor.im;
            }
        }
        weights
    }

    /// Real and imaginary parts of the combination at every point.
    fn combine(&self, points: &[c64], wanted: Wanted) -> Mat<f64> {
        let mut factors = Mat::<f64>::zeros(self.matrices.ncols(), 2 * points.len());
        for (at, &p) in points.iter().enumerate() {
            let (head, weights) = match wanted {
                Wanted::Value => ([p * p, p, c64::new(1.0, 0.0)], self.expansion.weights(p)),
                Wanted::Slope => (
                    [p * 2.0, c64::new(1.0, 0.0), c64::new(0.0, 0.0)],
                    self.expansion.slopes(p),
                ),
            };
            let all = head.into_iter().chain(weights.into_iter().map(|w| -w));
            for (row, factor) in all.enumerate() {
                factors[(row, 2 * at)] = factor.re;
                factors[(row, 2 * at + 1)] = factor.im;
            }
        }
        real_product(self.matrices.as_ref(), factors.as_ref())
    }
}
