//! Displacement between scattered points: a polyharmonic spline over one patch.
//!
//! What a rigid motion explains of the points' displacements is carried as that
//! rigid motion; the rest by the spline
//!
//! $$ \mathbf u(\mathbf p) = \sum_i N_i(\mathbf p)\,\mathbf u_i, \qquad
//!    N = \left[\phi(|\xi - \xi_i|),\ 1,\ \xi\right]
//!    \begin{bmatrix} \Phi & P \\ P^T & 0 \end{bmatrix}^{-1}_{\text{first } n}, $$
//!
//! with φ = r² ln r (the thin plate; Harder & Desmarais, Journal of Aircraft 9,
//! 1972) or φ = r³ (Duchon 1977). Both are conditionally positive definite of
//! order two in any number of dimensions, so that the linear polynomial P makes
//! the system regular wherever the points span their space.
//!
//! Points of one sheet, such as the transducers of a ground vibration test, say
//! nothing across it. There ξ are the two coordinates in the plane of the sheet,
//! and a vertex off the sheet follows its rotation as it does off a face
//! ([`crate::offset`]). Points on one line need rotations ([`crate::rod`]).

use crate::offset::turning;
use fladder_mesh::Vec3;
use nalgebra::{DMatrix, DVector, Matrix3, Matrix3x6, Matrix6, Matrix6x3, SymmetricEigen};

/// The radial function of a spline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// r² ln r.
    ThinPlate,
    /// r³.
    #[default]
    Polyharmonic,
}

impl Kernel {
    /// Value, and the factor that makes the gradient of the difference vector.
    fn of(self, distance: f64) -> (f64, f64) {
        match self {
            Self::Polyharmonic => (distance.powi(3), 3.0 * distance),
            Self::ThinPlate if distance > 0.0 => {
                let logarithm = distance.ln();
                (distance * distance * logarithm, 2.0 * logarithm + 1.0)
            }
            Self::ThinPlate => (0.0, 0.0),
        }
    }
}

/// Points whose rigid motions cannot be told apart: all on one line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Degenerate;

/// Share of the largest eigenvalue of the rigid normal matrix under which a
/// motion moves none of the points.
const RANK_TOLERANCE: f64 = 1e-8;

/// Points are one sheet where each keeps at least this share of the distance to
/// its nearest neighbour when all are pressed into their plane; the two skins of
/// a wing fall onto each other.
const SHEET: f64 = 0.7;

/// One patch of points and its spline.
pub(crate) struct Patch {
    kernel: Kernel,
    positions: Vec<Vec3>,
    centre: Vec3,
    size: f64,
    /// Directions of the coordinates ξ, two for a sheet.
    axes: Vec<Vec3>,
    /// Of a sheet.
    normal: Option<Vec3>,
    /// First columns of the inverse of the spline's matrix.
    inverse: DMatrix<f64>,
    /// Least-squares rigid motion from the displacement of each point.
    rigid: Vec<Matrix6x3<f64>>,
}

impl Patch {
    /// The spline through points that are apart from each other.
    pub(crate) fn new(positions: Vec<Vec3>, kernel: Kernel) -> Result<Self, Degenerate> {
        let count = positions.len() as f64;
        let centre = positions.iter().sum::<Vec3>() / count;
        let square: f64 = positions.iter().map(|p| (p - centre).norm_squared()).sum();
        let size = (square / count).sqrt();
        if positions.len() < 3 || size.is_nan() || size <= 0.0 {
            return Err(Degenerate);
        }
        let rigid = rigid_fit(&positions, &centre, size)?;
        let spread: Matrix3<f64> = positions
            .iter()
            .map(|p| (p - centre) * (p - centre).transpose())
            .sum();
        let eigen = SymmetricEigen::new(spread);
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
        let axes = order.map(|k| eigen.eigenvectors.column(k).into_owned());
        let is_sheet = is_sheet(&positions, &axes[2]);
        let mut patch = Self {
            kernel,
            centre,
            size,
            axes: axes[..if is_sheet { 2 } else { 3 }].to_vec(),
            normal: is_sheet.then_some(axes[2]),
            inverse: DMatrix::zeros(0, 0),
            rigid,
            positions,
        };
        patch.inverse = patch.inverted().ok_or(Degenerate)?;
        Ok(patch)
    }

    fn coordinates(&self, point: &Vec3) -> Vec<f64> {
        let arm = (point - self.centre) / self.size;
        self.axes.iter().map(|axis| axis.dot(&arm)).collect()
    }

    fn inverted(&self) -> Option<DMatrix<f64>> {
        let (n, d) = (self.positions.len(), self.axes.len());
        let at: Vec<Vec<f64>> = self.positions.iter().map(|p| self.coordinates(p)).collect();
        let mut matrix = DMatrix::zeros(n + d + 1, n + d + 1);
        for i in 0..n {
            for j in 0..i {
                let value = self.kernel.of(distance(&at[i], &at[j])).0;
                (matrix[(i, j)], matrix[(j, i)]) = (value, value);
            }
            (matrix[(i, n)], matrix[(n, i)]) = (1.0, 1.0);
            for (k, x) in at[i].iter().enumerate() {
                (matrix[(i, n + 1 + k)], matrix[(n + 1 + k, i)]) = (*x, *x);
            }
        }
        let inverse = matrix.try_inverse()?;
        let finite = inverse.iter().all(|value| value.is_finite());
        finite.then(|| inverse.columns(0, n).into_owned())
    }

    /// The block of each point that gives the displacement of `point`.
    pub(crate) fn blocks(&self, point: &Vec3) -> Vec<Matrix3<f64>> {
        let n = self.positions.len();
        let at = self.coordinates(point);
        let d = at.len();
        let mut rows = vec![DVector::zeros(n + d + 1); d + 1];
        for (i, position) in self.positions.iter().enumerate() {
            let other = self.coordinates(position);
            let (value, slope) = self.kernel.of(distance(&at, &other));
            rows[0][i] = value;
            for k in 0..d {
                rows[k + 1][i] = slope * (at[k] - other[k]);
            }
        }
        rows[0][n] = 1.0;
        for k in 0..d {
            rows[0][n + 1 + k] = at[k];
            rows[k + 1][n + 1 + k] = 1.0;
        }
        let value = self.inverse.tr_mul(&rows[0]);
        let mut blocks: Vec<Matrix3<f64>> =
            value.iter().map(|v| Matrix3::identity() * *v).collect();
        if let Some(normal) = &self.normal {
            let slopes: Vec<DVector<f64>> = rows[1..]
                .iter()
                .map(|row| self.inverse.tr_mul(row))
                .collect();
            let on_sheet: Vec3 = self
                .positions
                .iter()
                .zip(value.iter())
                .map(|(x, v)| x * *v)
                .sum();
            let offset = (point - on_sheet).cross_matrix();
            for (i, block) in blocks.iter_mut().enumerate() {
                let gradient =
                    (self.axes[0] * slopes[0][i] + self.axes[1] * slopes[1][i]) / self.size;
                *block -= offset * turning(normal, &gradient);
            }
        }
        self.with_rigid_part(point, blocks)
    }

    /// Lets the blocks act on what the rigid fit leaves.
    fn with_rigid_part(
        &self,
        point: &Vec3,
        mut blocks: Vec<Matrix3<f64>>,
    ) -> Vec<Matrix3<f64>> {
        let mut rest = motion_at(&((point - self.centre) / self.size));
        for (block, position) in blocks.iter().zip(&self.positions) {
            rest -= block * motion_at(&((position - self.centre) / self.size));
        }
        for (block, rigid) in blocks.iter_mut().zip(&self.rigid) {
            *block += rest * rigid;
        }
        blocks
    }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b) * (a - b))
        .sum::<f64>()
        .sqrt()
}

/// Displacement at an arm from a translation and a rotation.
fn motion_at(arm: &Vec3) -> Matrix3x6<f64> {
    let mut matrix = Matrix3x6::zeros();
    matrix
        .fixed_view_mut::<3, 3>(0, 0)
        .copy_from(&Matrix3::identity());
    matrix
        .fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&-arm.cross_matrix());
    matrix
}

fn rigid_fit(
    positions: &[Vec3],
    centre: &Vec3,
    size: f64,
) -> Result<Vec<Matrix6x3<f64>>, Degenerate> {
    let motions: Vec<Matrix3x6<f64>> = positions
        .iter()
        .map(|p| motion_at(&((p - centre) / size)))
        .collect();
    let normal: Matrix6<f64> = motions.iter().map(|m| m.transpose() * m).sum();
    let eigen = SymmetricEigen::new(normal);
    let (low, high) = (eigen.eigenvalues.min(), eigen.eigenvalues.max());
    if low.is_nan() || low <= RANK_TOLERANCE * high {
        return Err(Degenerate);
    }
    let inverted = Matrix6::from_diagonal(&eigen.eigenvalues.map(|v| 1.0 / v));
    let inverse = eigen.eigenvectors * inverted * eigen.eigenvectors.transpose();
    Ok(motions.iter().map(|m| inverse * m.transpose()).collect())
}

fn is_sheet(positions: &[Vec3], normal: &Vec3) -> bool {
    let nearest = |i: usize, length: &dyn Fn(Vec3) -> f64| {
        let others = positions.iter().enumerate().filter(|other| other.0 != i);
        others
            .map(|(_, other)| length(other - positions[i]))
            .fold(f64::INFINITY, f64::min)
    };
    (0..positions.len()).all(|i| {
        let in_space = nearest(i, &|d| d.norm());
        let in_plane = nearest(i, &|d| (d - normal * normal.dot(&d)).norm());
        in_plane >= SHEET * in_space
    })
}
