//! Source strengths in the order of the blocks, and products with them.
//!
//! Half of the columns are constant on every triangle (streams through flat triangles,
//! convected displacements): of them a product needs the sums over the corners only.

use crate::panel_block::PanelBlock;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par};

/// σ at the corners of all triangles, those of a block side by side.
#[derive(Debug)]
pub(crate) struct SourceColumns {
    varying: Vec<usize>,
    constant: Vec<usize>,
    /// 3 triangles × varying columns.
    corners: Mat<f64>,
    /// Triangles × constant columns.
    triangles: Mat<f64>,
}

/// S σ at some points, for columns of both kinds.
#[derive(Debug)]
pub(crate) struct SourceSums {
    varying: Mat<f64>,
    constant: Mat<f64>,
}

impl SourceColumns {
    /// `sources` holds σ in row 3 t + corner, one column a source.
    pub(crate) fn new(sources: MatRef<'_, f64>, blocks: &[PanelBlock]) -> Self {
        let order: Vec<usize> = blocks
            .iter()
            .flat_map(|block| &block.triangles)
            .map(|&t| t as usize)
            .collect();
        let is_constant = |column: &usize| {
            (0..order.len()).all(|t| {
                let at = |corner| sources[(3 * t + corner, *column)];
                at(0) == at(1) && at(1) == at(2)
            })
        };
        let (constant, varying): (Vec<usize>, Vec<usize>) =
            (0..sources.ncols()).partition(is_constant);
        Self {
            corners: Mat::from_fn(3 * order.len(), varying.len(), |i, j| {
                sources[(3 * order[i / 3] + i % 3, varying[j])]
            }),
            triangles: Mat::from_fn(order.len(), constant.len(), |i, j| {
                sources[(3 * order[i], constant[j])]
            }),
            varying,
            constant,
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.varying.len() + self.constant.len()
    }

    /// No sums yet at so many points.
    pub(crate) fn zeros(&self, points: usize) -> SourceSums {
        SourceSums {
            varying: Mat::zeros(points, self.varying.len()),
            constant: Mat::zeros(points, self.constant.len()),
        }
    }

    /// Adds S σ of the triangles from `first` on; `influence` is points × their corners, by
    /// columns.
    pub(crate) fn add_by_columns(
        &self,
        first: usize,
        influence: &[f64],
        sums: &mut SourceSums,
    ) {
        let points = sums.points();
        let mut whole = vec![0.0; influence.len() / 3];
        for (whole, corners) in whole
            .chunks_exact_mut(points)
            .zip(influence.chunks_exact(3 * points))
        {
            let (a, rest) = corners.split_at(points);
            let (b, c) = rest.split_at(points);
            for (((w, a), b), c) in whole.iter_mut().zip(a).zip(b).zip(c) {
                *w = a + b + c;
            }
        }
        let by_columns = |values| {
            MatRef::from_column_major_slice(values, points, <[f64]>::len(values) / points)
        };
        self.add(first, by_columns(influence), by_columns(&whole), sums);
    }

    /// The same by rows.
    pub(crate) fn add_by_rows(&self, first: usize, influence: &[f64], sums: &mut SourceSums) {
        let points = sums.points();
        let corners = influence.as_chunks::<3>().0;
        let whole: Vec<f64> = corners.iter().map(|c| c[0] + c[1] + c[2]).collect();
        let by_rows = |values| {
            MatRef::from_row_major_slice(values, points, <[f64]>::len(values) / points)
        };
        self.add(first, by_rows(influence), by_rows(&whole), sums);
    }

    /// `corners` is points × corners, `whole` points × triangles.
    fn add(
        &self,
        first: usize,
        corners: MatRef<'_, f64>,
        whole: MatRef<'_, f64>,
        sums: &mut SourceSums,
    ) {
        let sources = self.corners.subrows(3 * first, corners.ncols());
        matmul(
            &mut sums.varying,
            Accum::Add,
            corners,
            sources,
            1.0,
            Par::Seq,
        );
        let sources = self.triangles.subrows(first, whole.ncols());
        matmul(
            &mut sums.constant,
            Accum::Add,
            whole,
            sources,
            1.0,
            Par::Seq,
        );
    }

    /// Sums with the columns in their first order.
    pub(crate) fn in_order(&self, sums: &SourceSums) -> Mat<f64> {
        let mut out = Mat::zeros(sums.varying.nrows(), self.len());
        for (columns, values) in [
            (&self.varying, &sums.varying),
            (&self.constant, &sums.constant),
        ] {
            for (j, &column) in columns.iter().enumerate() {
                out.col_mut(column).copy_from(values.col(j));
            }
        }
        out
    }
}

impl SourceSums {
    fn points(&self) -> usize {
        self.varying.nrows()
    }
}
