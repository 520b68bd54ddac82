//! Generalised aerodynamic forces on a grid of the Laplace plane.
//!
//! $Q(g_i + \mathrm ik_j)$ for ascending $k_j\ge0$ and ascending $g_i$ with
//! $g = 0$ among them. Points with $k = 0$ and $g < 0$ lie on the branch cut
//! of the wake and are left out. At $k = 0$ and $g \ge 0$ the matrix is real.

use faer::{Mat, c64};

/// Two grid values closer than this (relative to the larger of 1 and the
/// value) are one: text formats rarely keep more digits.
const SAME_POINT: f64 = 1e-9;

/// Distance in $g$ over which a continuation from the imaginary axis keeps four
/// digits.
pub const REACH: f64 = 0.05;

/// An imaginary part at $k = 0$ above this fraction of the largest entry is
/// said in the notes; rounding stays below.
const REAL_TOLERANCE: f64 = 1e-10;

/// One sample of $Q$.
#[derive(Clone, Debug)]
pub struct GafPoint {
    /// Reduced damping $g = \sigma b/U$.
    pub g: f64,
    /// Reduced frequency $k = \omega b/U$.
    pub k: f64,
    /// $Q$, rows force, columns motion.
    pub q: Mat<c64>,
}

/// Why a set of samples is no table.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GafError {
    /// The semichord is zero, negative or not finite.
    #[error("semichord is {0}, it must be positive")]
    Semichord(f64),
    /// No mode was named.
    #[error("there is no mode")]
    NoModes,
    /// No sample at all, or none at $g = 0$.
    #[error("no sample at g = 0: the imaginary axis is where damping vanishes")]
    NoAxis,
    /// Fewer than two reduced frequencies.
    #[error("only {0} reduced frequency, at least 2 are needed")]
    TooFewFrequencies(usize),
    /// A grid value is not finite, or $k$ is negative.
    #[error("sample {index} lies at g = {g}, k = {k}: both must be finite and k not negative")]
    Place {
        /// Number of the sample, from 1.
        index: usize,
        /// Its reduced damping.
        g: f64,
        /// Its reduced frequency.
        k: f64,
    },
    /// A matrix is not square of the order of the modes.
    #[error(
        "Q at g = {g}, k = {k} has {rows} rows and {columns} columns, {modes} modes are named"
    )]
    Shape {
        /// Reduced damping of the sample.
        g: f64,
        /// Reduced frequency of the sample.
        k: f64,
        /// Rows found.
        rows: usize,
        /// Columns found.
        columns: usize,
        /// Number of modes.
        modes: usize,
    },
    /// An entry is not finite.
    #[error("Q at g = {g}, k = {k} is not finite in row {row}, column {column}")]
    NotFinite {
        /// Reduced damping of the sample.
        g: f64,
        /// Reduced frequency of the sample.
        k: f64,
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
    },
    /// A point is there twice with different values.
    #[error(
        "g = {g}, k = {k} is there twice with different values, first in row {row}, column {column}"
    )]
    Conflict {
        /// Reduced damping of the sample.
        g: f64,
        /// Reduced frequency of the sample.
        k: f64,
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
    },
    /// The grid has a hole.
    #[error("the grid has a hole: no sample at g = {g}, k = {k}")]
    Hole {
        /// Reduced damping of the missing sample.
        g: f64,
        /// Reduced frequency of the missing sample.
        k: f64,
    },
    /// Tables that are to stand side by side differ.
    #[error("table {table} has other {what} than the first")]
    Differs {
        /// Number of the table, from 1.
        table: usize,
        /// What differs.
        what: &'static str,
    },
    /// The steady vector has the wrong length or a value that is not finite.
    #[error("steady forces: {found} values for {modes} modes, or one of them is not finite")]
    Steady {
        /// Values found.
        found: usize,
        /// Number of modes.
        modes: usize,
    },
}

/// Samples of $Q$ on a complete grid, checked.
#[derive(Clone, Debug)]
pub struct GafTable {
    semichord: f64,
    mach: f64,
    modes: Vec<String>,
    k: Vec<f64>,
    g: Vec<f64>,
    samples: Vec<Option<Mat<c64>>>,
    steady: Vec<Option<f64>>,
    notes: Vec<String>,
    parts: usize,
}

impl GafTable {
    /// Sorts the samples into a grid and checks them.
    ///
    /// # Errors
    /// See [`GafError`]: each names the place. Samples in any order are
    /// sorted, exact doubles are dropped, samples at $k = 0$, $g < 0$ are
    /// ignored with a note.
    pub fn new(
        semichord: f64,
        mach: f64,
        modes: Vec<String>,
        points: Vec<GafPoint>,
        steady: Vec<Option<f64>>,
    ) -> Result<Self, GafError> {
        if !(semichord.is_finite() && semichord > 0.0) {
            return Err(GafError::Semichord(semichord));
        }
        if modes.is_empty() {
            return Err(GafError::NoModes);
        }
        check_steady(&steady, modes.len())?;
        for (number, point) in points.iter().enumerate() {
            check_point(number + 1, point, modes.len())?;
        }
        let mut notes = Vec::new();
        let on_the_cut = points.iter().filter(|p| is_on_cut(p.g, p.k)).count();
        if on_the_cut > 0 {
            notes.push(format!(
                "{on_the_cut} samples at k = 0 and g < 0 lie on the branch cut and were ignored"
            ));
        }
        let points: Vec<GafPoint> = points
            .into_iter()
            .filter(|p| !is_on_cut(p.g, p.k))
            .collect();
        let k = distinct(points.iter().map(|p| p.k));
        let g = distinct(points.iter().map(|p| p.g));
        if !g.contains(&0.0) {
            return Err(GafError::NoAxis);
        }
        if k.len() < 2 {
            return Err(GafError::TooFewFrequencies(k.len()));
        }
        let mut table = Self {
            semichord,
            mach,
            steady: if steady.is_empty() {
                vec![None; modes.len()]
            } else {
                steady
            },
            samples: vec![None; k.len() * g.len()],
            modes,
            k,
            g,
            notes,
            parts: 1,
        };
        table.fill(points)?;
        table.check_holes()?;
        table.make_real_at_zero();
        Ok(table)
    }

    fn fill(&mut self, points: Vec<GafPoint>) -> Result<(), GafError> {
        for point in points {
            let slot = self.slot(nearest(&self.g, point.g), nearest(&self.k, point.k));
            match &self.samples[slot] {
                None => self.samples[slot] = Some(point.q),
                Some(present) => {
                    if let Some((row, column)) = first_difference(present, &point.q) {
                        let (g, k) = (point.g, point.k);
                        return Err(GafError::Conflict { g, k, row, column });
                    }
                }
            }
        }
        Ok(())
    }

    fn check_holes(&self) -> Result<(), GafError> {
        for (i, &g) in self.g.iter().enumerate() {
            for (j, &k) in self.k.iter().enumerate() {
                if !is_on_cut(g, k) && self.samples[self.slot(i, j)].is_none() {
                    return Err(GafError::Hole { g, k });
                }
            }
        }
        Ok(())
    }

    /// $Q$ is real on the real axis; what is not is rounding or a fault of
    /// the source, and in the second case it is said.
    fn make_real_at_zero(&mut self) {
        if self.k[0] != 0.0 {
            return;
        }
        let mut worst: f64 = 0.0;
        for i in 0..self.g.len() {
            let slot = self.slot(i, 0);
            if let Some(q) = &mut self.samples[slot] {
                let scale = crate::linalg::largest(q.as_ref()).max(f64::MIN_POSITIVE);
                for column in 0..q.ncols() {
                    for row in 0..q.nrows() {
                        worst = worst.max(q[(row, column)].im.abs() / scale);
                        q[(row, column)].im = 0.0;
                    }
                }
            }
        }
        if worst > REAL_TOLERANCE {
            self.notes.push(format!(
                "Q at k = 0 had imaginary parts up to {worst:.1e} of its largest entry; \
                 they were dropped, because Q is real there"
            ));
        }
    }

    fn slot(&self, damping: usize, frequency: usize) -> usize {
        damping * self.k.len() + frequency
    }

    /// Sample number (`damping`, `frequency`) of the grid; `None` on the
    /// branch cut.
    pub fn sample(&self, damping: usize, frequency: usize) -> Option<&Mat<c64>> {
        self.samples[self.slot(damping, frequency)].as_ref()
    }

    /// Samples on the imaginary axis, in order of $k$.
    pub fn axis(&self) -> impl Iterator<Item = &Mat<c64>> {
        let axis = nearest(&self.g, 0.0);
        (0..self.k.len()).filter_map(move |j| self.sample(axis, j))
    }

    /// The samples on the imaginary axis as a table of their own.
    #[must_use]
    pub fn axis_alone(&self) -> Self {
        Self {
            g: vec![0.0],
            samples: self.axis().cloned().map(Some).collect(),
            ..self.clone()
        }
    }

    /// Whether a root lies where forces are continued beyond the samples: above
    /// the last $k$, or farther than [`REACH`] from the lines of $g$.
    pub fn is_outside(&self, p: c64) -> bool {
        let [low, high] = [self.g[0], self.g[self.g.len() - 1]];
        let last = self.k[self.k.len() - 1];
        p.im > last * (1.0 + SAME_POINT) || p.re < low - REACH || p.re > high + REACH
    }

    /// Applies a change to every sample, with its $p$.
    pub(crate) fn change(&mut self, mut change: impl FnMut(c64, &mut Mat<c64>)) {
        for i in 0..self.g.len() {
            for j in 0..self.k.len() {
                let (slot, p) = (self.slot(i, j), c64::new(self.g[i], self.k[j]));
                if let Some(q) = &mut self.samples[slot] {
                    change(p, q);
                }
            }
        }
    }

    /// Adds a remark for the user.
    pub(crate) fn note(&mut self, note: String) {
        self.notes.push(note);
    }

    /// Reference semichord $b$ in m.
    pub fn semichord(&self) -> f64 {
        self.semichord
    }

    /// Mach number of the samples.
    pub fn mach(&self) -> f64 {
        self.mach
    }

    /// Names of the modes, in order.
    pub fn modes(&self) -> &[String] {
        &self.modes
    }

    /// Number of modes.
    pub fn order(&self) -> usize {
        self.modes.len()
    }

    /// Number of parts side by side in every sample.
    pub fn parts(&self) -> usize {
        self.parts
    }

    /// Rows and columns of every sample: the modes, and those of all parts.
    pub(crate) fn shape(&self) -> [usize; 2] {
        [self.order(), self.order() * self.parts]
    }

    /// Several tables as the parts of one, for a
    /// [`Mixture`](crate::Mixture). Mach number and steady forces are those of
    /// the first.
    ///
    /// # Errors
    /// [`GafError::Differs`] where a table has another grid, other modes or
    /// another semichord than the first; [`GafError::NoAxis`] for no table.
    pub fn side_by_side(tables: &[Self]) -> Result<Self, GafError> {
        let Some((first, others)) = tables.split_first() else {
            return Err(GafError::NoAxis);
        };
        let mut whole = first.clone();
        for (number, other) in others.iter().enumerate() {
            let what = [
                ("modes", first.modes == other.modes),
                ("k", first.k == other.k),
                ("g", first.g == other.g),
                ("semichord", first.semichord == other.semichord),
            ];
            if let Some((what, _)) = what.into_iter().find(|(_, is_same)| !is_same) {
                let table = number + 2;
                return Err(GafError::Differs { table, what });
            }
            whole.notes.extend(other.notes.iter().cloned());
        }
        whole.notes.sort();
        whole.notes.dedup();
        whole.parts = tables.len();
        let [rows, columns] = whole.shape();
        for (slot, sample) in whole.samples.iter_mut().enumerate() {
            let parts: Vec<&Mat<c64>> = tables
                .iter()
                .filter_map(|table| table.samples[slot].as_ref())
                .collect();
            if parts.len() == tables.len() {
                let entry = |i: usize, j: usize| parts[j / rows][(i, j % rows)];
                *sample = Some(Mat::from_fn(rows, columns, entry));
            }
        }
        Ok(whole)
    }

    /// Reduced frequencies, ascending.
    pub fn k(&self) -> &[f64] {
        &self.k
    }

    /// Reduced dampings, ascending; 0 is among them.
    pub fn g(&self) -> &[f64] {
        &self.g
    }

    /// Steady generalised forces per unit dynamic pressure, where known.
    pub fn steady(&self) -> &[Option<f64>] {
        &self.steady
    }

    /// What was ignored or mended, one sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }
}

fn is_on_cut(g: f64, k: f64) -> bool {
    k.abs() <= SAME_POINT && g < -SAME_POINT
}

fn check_steady(steady: &[Option<f64>], modes: usize) -> Result<(), GafError> {
    let finite = steady.iter().flatten().all(|value| value.is_finite());
    if finite && (steady.is_empty() || steady.len() == modes) {
        return Ok(());
    }
    Err(GafError::Steady {
        found: steady.len(),
        modes,
    })
}

fn check_point(index: usize, point: &GafPoint, modes: usize) -> Result<(), GafError> {
    let (g, k, q) = (point.g, point.k, &point.q);
    if !g.is_finite() || !k.is_finite() || k < -SAME_POINT {
        return Err(GafError::Place { index, g, k });
    }
    if q.nrows() != modes || q.ncols() != modes {
        return Err(GafError::Shape {
            g,
            k,
            rows: q.nrows(),
            columns: q.ncols(),
            modes,
        });
    }
    for column in 0..modes {
        for row in 0..modes {
            if !(q[(row, column)].re.is_finite() && q[(row, column)].im.is_finite()) {
                return Err(GafError::NotFinite {
                    g,
                    k,
                    row: row + 1,
                    column: column + 1,
                });
            }
        }
    }
    Ok(())
}

/// Distinct values, ascending; values within the tolerance of zero become
/// zero.
fn distinct(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sorted: Vec<f64> = values
        .map(|value| {
            if value.abs() <= SAME_POINT {
                0.0
            } else {
                value
            }
        })
        .collect();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup_by(|later, earlier| {
        (*later - *earlier).abs() <= SAME_POINT * later.abs().max(1.0)
    });
    sorted
}

fn nearest(values: &[f64], wanted: f64) -> usize {
    let distance = |index: usize| (values[index] - wanted).abs();
    (0..values.len())
        .min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
        .expect("the grid was built from at least one sample")
}

fn first_difference(left: &Mat<c64>, right: &Mat<c64>) -> Option<(usize, usize)> {
    (0..left.ncols())
        .flat_map(|column| (0..left.nrows()).map(move |row| (row, column)))
        .find(|&place| left[place] != right[place])
        .map(|(row, column)| (row + 1, column + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(g: f64, k: f64, value: f64) -> GafPoint {
        GafPoint {
            g,
            k,
            q: Mat::from_fn(1, 1, |_, _| c64::new(value, k * value)),
        }
    }

    fn table(points: Vec<GafPoint>) -> Result<GafTable, GafError> {
        GafTable::new(0.5, 0.0, vec!["heave".to_owned()], points, vec![])
    }

    /// Samples in any order make the same ascending grid, an exact double
    /// changes nothing, and one on the branch cut is ignored with a note.
    #[test]
    fn order_doubles_and_the_cut_do_not_matter() {
        let shuffled = vec![
            point(0.1, 0.4, 5.0),
            point(0.0, 0.4, 2.0),
            point(-0.1, 0.0, 9.0),
            point(0.0, 0.0, 1.0),
            point(0.1, 0.0, 4.0),
            point(0.0, 0.4, 2.0),
            point(-0.1, 0.4, 3.0),
        ];
        let table = table(shuffled).unwrap();
        assert_eq!(table.k(), [0.0, 0.4]);
        assert_eq!(table.g(), [-0.1, 0.0, 0.1]);
        let axis: Vec<f64> = table.axis().map(|q| q[(0, 0)].re).collect();
        assert_eq!(axis, [1.0, 2.0]);
        assert!(table.sample(0, 0).is_none());
        assert_eq!(table.notes().len(), 1);
        assert!(table.notes()[0].contains("branch cut"));
    }

    /// Each fault is refused with its place.
    #[test]
    fn faults_are_named_with_their_place() {
        let good = || {
            vec![
                point(0.0, 0.0, 1.0),
                point(0.0, 0.4, 2.0),
                point(0.0, 0.8, 3.0),
            ]
        };
        assert!(table(good()).is_ok());
        let with = |extra: GafPoint| {
            let mut points = good();
            points.push(extra);
            table(points).unwrap_err()
        };
        assert_eq!(
            with(point(0.0, 0.4, 2.5)),
            GafError::Conflict {
                g: 0.0,
                k: 0.4,
                row: 1,
                column: 1
            }
        );
        assert_eq!(
            with(point(0.1, 0.4, 2.5)),
            GafError::Hole { g: 0.1, k: 0.0 }
        );
        assert_eq!(
            with(point(0.0, 1.2, f64::NAN)),
            GafError::NotFinite {
                g: 0.0,
                k: 1.2,
                row: 1,
                column: 1
            }
        );
        assert_eq!(
            with(point(0.0, -0.4, 1.0)),
            GafError::Place {
                index: 4,
                g: 0.0,
                k: -0.4
            }
        );
        let wide = GafPoint {
            g: 0.0,
            k: 1.2,
            q: Mat::zeros(2, 1),
        };
        assert!(matches!(
            with(wide),
            GafError::Shape {
                rows: 2,
                columns: 1,
                ..
            }
        ));
        let off_axis = vec![point(0.1, 0.1, 1.0), point(0.1, 0.2, 1.0)];
        assert_eq!(table(off_axis).unwrap_err(), GafError::NoAxis);
        assert_eq!(table(Vec::new()).unwrap_err(), GafError::NoAxis);
        let lone = vec![point(0.0, 0.1, 1.0)];
        assert_eq!(table(lone).unwrap_err(), GafError::TooFewFrequencies(1));
        let modes = vec!["heave".to_owned()];
        let steady = GafTable::new(0.5, 0.0, modes, good(), vec![None, None]).unwrap_err();
        assert_eq!(steady, GafError::Steady { found: 2, modes: 1 });
    }
}
