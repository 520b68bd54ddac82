//! Motion of a point that is fixed to the structure: a store, a balance weight,
//! a pick-up.
//!
//! The point follows the nearest node and the rotation there: the node's own
//! where the modes have rotations, else that of the rigid motion which fits the
//! nodes around it best.

use crate::model::ElasticMode;
use fladder_mesh::Vec3;
use nalgebra::{Matrix3, Matrix6, SymmetricEigen, Vector6};

/// Nodes by whose displacements a rotation is told.
const AROUND: usize = 12;

/// Share of the largest eigenvalue under which the nodes around leave a rotation
/// open; it is then taken as zero.
const OPEN: f64 = 1e-8;

/// The place where something is fixed.
#[derive(Clone, Debug)]
pub(crate) struct Attachment {
    node: usize,
    arm: Vec3,
    around: Vec<usize>,
    inverse: Matrix6<f64>,
    centre: Vec3,
    /// The nodes around leave a rotation open.
    pub(crate) is_open: bool,
}

impl Attachment {
    /// At a position, among candidate nodes, of which there is at least one; on a
    /// node of them where one is named.
    pub(crate) fn new(
        position: &Vec3,
        node: Option<usize>,
        candidates: &[usize],
        positions: &[Vec3],
    ) -> Option<Self> {
        let from = node.map_or(*position, |node| positions[node]);
        let mut order: Vec<usize> = candidates.to_vec();
        let far = |k: &usize| (positions[*k] - from).norm_squared();
        order.sort_by(|a, b| far(a).total_cmp(&far(b)).then(a.cmp(b)));
        let nearest = node.or_else(|| order.first().copied())?;
        order.truncate(AROUND);
        let centre = order.iter().map(|k| positions[*k]).sum::<Vec3>() / order.len() as f64;
        let mut normal = Matrix6::zeros();
        for k in &order {
            let arm = (positions[*k] - centre).cross_matrix();
            let mut add = |row, column, block: Matrix3<f64>| {
                let mut view = normal.fixed_view_mut::<3, 3>(row, column);
                view += block;
            };
            add(0, 0, Matrix3::identity());
            add(0, 3, -arm);
            add(3, 0, arm);
            add(3, 3, -arm * arm);
        }
        let eigen = SymmetricEigen::new(normal);
        let floor = OPEN * eigen.eigenvalues.max();
        let is_open = eigen.eigenvalues.iter().any(|value| *value <= floor);
        let inverted = eigen
            .eigenvalues
            .map(|v| if v > floor { 1.0 / v } else { 0.0 });
        Some(Self {
            node: nearest,
            arm: position - positions[nearest],
            around: order,
            inverse: eigen.eigenvectors
                * Matrix6::from_diagonal(&inverted)
                * eigen.eigenvectors.transpose(),
            centre,
            is_open,
        })
    }

    /// Index of the node it follows, and the distance from there.
    pub(crate) fn place(&self) -> (usize, f64) {
        (self.node, self.arm.norm())
    }

    /// Displacement and rotation in a mode.
    pub(crate) fn motion(&self, mode: &ElasticMode, positions: &[Vec3]) -> [Vec3; 2] {
        let rotation = match &mode.rotation {
            Some(rotations) => rotations[self.node],
            None => self.rotation(&mode.shape, positions),
        };
        [mode.shape[self.node] + rotation.cross(&self.arm), rotation]
    }

    fn rotation(&self, shape: &[Vec3], positions: &[Vec3]) -> Vec3 {
        let mut right = Vector6::zeros();
        for k in &self.around {
            let u = shape[*k];
            let moment = (positions[*k] - self.centre).cross(&u);
            right += Vector6::new(u.x, u.y, u.z, moment.x, moment.y, moment.z);
        }
        (self.inverse * right).fixed_rows::<3>(3).into_owned()
    }
}

/// Rotation of some nodes, least squares, in a shape.
pub(crate) fn mean_rotation(
    nodes: &[usize],
    shape: &[Vec3],
    positions: &[Vec3],
) -> Option<Vec3> {
    let middle = nodes.iter().map(|k| positions[*k]).sum::<Vec3>() / nodes.len().max(1) as f64;
    let attachment = Attachment::around(&middle, nodes, positions)?;
    (!attachment.is_open).then(|| attachment.rotation(shape, positions))
}

impl Attachment {
    /// On all of the nodes instead of those around the nearest.
    fn around(middle: &Vec3, nodes: &[usize], positions: &[Vec3]) -> Option<Self> {
        let mut spread = Matrix6::zeros();
        for k in nodes {
            let arm = (positions[*k] - middle).cross_matrix();
            let mut view = spread.fixed_view_mut::<3, 3>(3, 3);
            view -= arm * arm;
        }
        let count = nodes.len() as f64;
        let mut view = spread.fixed_view_mut::<3, 3>(0, 0);
        view += Matrix3::identity() * count;
        let eigen = SymmetricEigen::new(spread.fixed_view::<3, 3>(3, 3).into_owned());
        let is_open = eigen.eigenvalues.min() <= OPEN * eigen.eigenvalues.max();
        Some(Self {
            node: *nodes.first()?,
            arm: Vec3::zeros(),
            around: nodes.to_vec(),
            inverse: spread.try_inverse().unwrap_or_default(),
            centre: *middle,
            is_open,
        })
    }
}
