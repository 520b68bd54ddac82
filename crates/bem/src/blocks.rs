//! Storage of the transfer model: matrices and the wake's contracted rows.

use crate::contour::Path;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par, c64};
use serde::{Deserialize, Serialize};

/// A real matrix by columns, as it is stored.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Block {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

impl Block {
    pub(crate) fn new(matrix: MatRef<'_, f64>) -> Self {
        let values = (0..matrix.ncols())
            .flat_map(|j| (0..matrix.nrows()).map(move |i| matrix[(i, j)]))
            .collect();
        Self {
            rows: matrix.nrows(),
            columns: matrix.ncols(),
            values,
        }
    }

    pub(crate) fn view(&self) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice(&self.values, self.rows, self.columns)
    }

    /// Whether it has this size and finite values.
    pub(crate) fn is_sound(&self, rows: usize, columns: usize) -> bool {
        self.rows == rows
            && self.columns == columns
            && self.values.len() == rows * columns
            && self.values.iter().all(|v| v.is_finite())
    }
}

/// Near rows of the wake: the columns of H that go with e^{−sξ}.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct NearBlocks {
    pub(crate) stations: Vec<f64>,
    /// Column and station of each entry.
    pub(crate) entries: Vec<(u32, u32)>,
    /// One functional vector an entry.
    pub(crate) values: Vec<f64>,
}

impl NearBlocks {
    /// Whether indices and sizes fit `columns` columns of `functionals` each.
    pub(crate) fn is_sound(&self, functionals: usize, columns: usize) -> bool {
        let finite = |values: &[f64]| values.iter().all(|v| v.is_finite());
        finite(&self.stations)
            && finite(&self.values)
            && self.values.len() == self.entries.len() * functionals
            && self
                .entries
                .iter()
                .all(|&(c, s)| (c as usize) < columns && (s as usize) < self.stations.len())
    }

    /// Σ e^{−sξ} values, as [`FarBlocks::add`].
    pub(crate) fn add(&self, s: c64, functionals: usize, sum: &mut Mat<f64>) {
        let decay: Vec<c64> = self.stations.iter().map(|xi| (-s * xi).exp()).collect();
        let (re, im) = sum.as_mut().split_at_col_mut(1);
        let (re, im) = (re.col_mut(0), im.col_mut(0));
        let (re, im) = (re.try_as_col_major_mut(), im.try_as_col_major_mut());
        let (Some(re), Some(im)) = (re, im) else {
            unreachable!("an owned matrix has contiguous columns");
        };
        let (re, im) = (re.as_slice_mut(), im.as_slice_mut());
        for (&(column, station), values) in self
            .entries
            .iter()
            .zip(self.values.chunks_exact(functionals))
        {
            let factor = decay[station as usize];
            let from = column as usize * functionals;
            let range = from..from + functionals;
            for (total, value) in re[range.clone()].iter_mut().zip(values) {
                *total += factor.re * value;
            }
            for (total, value) in im[range].iter_mut().zip(values) {
                *total += factor.im * value;
            }
        }
    }
}

/// The far wake on one path.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct FarBlocks {
    /// ξ of each node.
    pub(crate) nodes: Vec<(f64, f64)>,
    /// Real parts, node by node, column by column, one functional vector each.
    re: Vec<f64>,
    /// Imaginary parts.
    im: Vec<f64>,
}

impl FarBlocks {
    /// `re` and `im` in the order of the fields.
    pub(crate) fn new(path: &Path, re: Vec<f64>, im: Vec<f64>) -> Self {
        let nodes = path.nodes.iter().map(|n| (n.re, n.im)).collect();
        Self { nodes, re, im }
    }

    /// Adds Σ e^{−sξ} (re + i im) to `sum`, whose two columns are real and imaginary part.
    pub(crate) fn add(&self, s: c64, sum: &mut Mat<f64>) {
        let (rows, nodes) = (sum.nrows(), self.nodes.len());
        let decay = |i: usize| (-s * c64::new(self.nodes[i].0, self.nodes[i].1)).exp();
        let real = Mat::from_fn(
            nodes,
            2,
            |i, j| if j == 0 { decay(i).re } else { decay(i).im },
        );
        let turned = Mat::from_fn(
            nodes,
            2,
            |i, j| if j == 0 { -decay(i).im } else { decay(i).re },
        );
        for (part, weights) in [(&self.re, &real), (&self.im, &turned)] {
            let part = MatRef::from_column_major_slice(part, rows, nodes);
            matmul(sum.as_mut(), Accum::Add, part, weights, 1.0, Par::Seq);
        }
    }

    /// Whether sizes fit and values are finite.
    pub(crate) fn is_sound(&self, functionals: usize, columns: usize) -> bool {
        let size = self.nodes.len() * columns * functionals;
        let finite = |values: &[f64]| values.iter().all(|v| v.is_finite());
        self.re.len() == size
            && self.im.len() == size
            && self
                .nodes
                .iter()
                .all(|(re, im)| re.is_finite() && im.is_finite())
            && finite(&self.re)
            && finite(&self.im)
    }
}
