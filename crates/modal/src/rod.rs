//! A beam that carries the surface about it.
//!
//! Nodes with rotations that form one chain are a beam whose sections stay
//! plane. A vertex follows all nodes rigidly, each with its share,
//!
//! $$ \mathbf u(\mathbf p) = \sum_i N_i(s)\,\bigl[\mathbf u_i
//!    + \boldsymbol\theta_i \times (\mathbf p - \mathbf x_i)\bigr], $$
//!
//! s the arc length of the nearest point of the chain and N_i the natural cubic
//! spline that is one at node i and zero at the others. As the N_i add up to
//! one, rigid motion is exact wherever the vertex lies.

use fladder_mesh::Vec3;
use nalgebra::{DMatrix, DVector, Matrix3};

/// Nodes beyond which a set is no beam: finding the chain costs their square.
const MOST_NODES: usize = 1000;

/// A chain of nodes.
pub(crate) struct Rod {
    /// In the order along the chain.
    nodes: Vec<u32>,
    positions: Vec<Vec3>,
    arc: Vec<f64>,
    /// Columns of the inverse of the spline's matrix, one a node.
    inverse: DMatrix<f64>,
    /// Where rotations stand: behind so many columns.
    columns: usize,
}

impl Rod {
    /// The beam through the nodes; `None` where they form no single chain.
    pub(crate) fn new(nodes: &[u32], all: &[Vec3]) -> Option<Self> {
        let place: Vec<Vec3> = nodes.iter().map(|node| all[*node as usize]).collect();
        let chain = chain(&place)?;
        let positions: Vec<Vec3> = chain.iter().map(|k| place[*k]).collect();
        let mut arc = vec![0.0];
        for pair in positions.windows(2) {
            arc.push(arc[arc.len() - 1] + (pair[1] - pair[0]).norm());
        }
        let length = arc[arc.len() - 1];
        if length > 0.0 {
            for s in &mut arc {
                *s /= length;
            }
        }
        let count = arc.len();
        let inverse = if count > 1 {
            let matrix =
                DMatrix::from_fn(count + 2, count + 2, |i, j| match (i < count, j < count) {
                    (true, true) => (arc[i] - arc[j]).abs().powi(3),
                    (true, false) => arc[i].powi((j - count) as i32),
                    (false, true) => arc[j].powi((i - count) as i32),
                    (false, false) => 0.0,
                });
            matrix.try_inverse()?.columns(0, count).into_owned()
        } else {
            DMatrix::zeros(0, 0)
        };
        Some(Self {
            nodes: chain.iter().map(|k| nodes[*k]).collect(),
            positions,
            arc,
            inverse,
            columns: all.len(),
        })
    }

    /// Distance from the chain.
    pub(crate) fn distance(&self, point: &Vec3) -> f64 {
        self.nearest(point).0
    }

    /// The blocks of displacements and, behind all nodes, of rotations.
    pub(crate) fn blocks(&self, point: &Vec3) -> Vec<(u32, Matrix3<f64>)> {
        let shares = self.shares(self.nearest(point).1);
        let nodes = self.nodes.iter().zip(&self.positions).zip(&shares);
        nodes
            .flat_map(|((node, position), share)| {
                let arm = (point - position).cross_matrix();
                [
                    (*node, Matrix3::identity() * *share),
                    (node + self.columns as u32, arm * -share),
                ]
            })
            .collect()
    }

    /// N_i at an arc length.
    fn shares(&self, s: f64) -> Vec<f64> {
        let count = self.arc.len();
        if count == 1 {
            return vec![1.0];
        }
        let row = DVector::from_fn(count + 2, |i, _| {
            if i < count {
                (s - self.arc[i]).abs().powi(3)
            } else {
                s.powi((i - count) as i32)
            }
        });
        let mut shares: Vec<f64> = self.inverse.tr_mul(&row).iter().copied().collect();
        // Rounding of the inverse must not stretch rigid motion.
        let sum: f64 = shares.iter().sum();
        for share in &mut shares {
            *share /= sum;
        }
        shares
    }

    /// Distance from the chain, and arc length of the nearest point.
    fn nearest(&self, point: &Vec3) -> (f64, f64) {
        let mut best = ((point - self.positions[0]).norm(), 0.0);
        for (ends, arc) in self.positions.windows(2).zip(self.arc.windows(2)) {
            let along = ends[1] - ends[0];
            let share = (along.dot(&(point - ends[0])) / along.norm_squared()).clamp(0.0, 1.0);
            let distance = (point - ends[0] - along * share).norm();
            if distance < best.0 {
                best = (distance, arc[0] + share * (arc[1] - arc[0]));
            }
        }
        best
    }
}

/// The order of points along their shortest tree, where it has no branch.
fn chain(points: &[Vec3]) -> Option<Vec<usize>> {
    let count = points.len();
    if count == 0 || count > MOST_NODES {
        return None;
    }
    let mut neighbours = vec![Vec::new(); count];
    let mut nearest: Vec<(f64, usize)> = points
        .iter()
        .map(|point| ((point - points[0]).norm_squared(), 0))
        .collect();
    let mut is_in = vec![false; count];
    is_in[0] = true;
    for _ in 1..count {
        let outside = (0..count).filter(|k| !is_in[*k]);
        let next = outside.min_by(|a, b| nearest[*a].0.total_cmp(&nearest[*b].0))?;
        let (distance, from) = nearest[next];
        if distance.is_nan() || distance <= 0.0 {
            return None;
        }
        is_in[next] = true;
        neighbours[next].push(from);
        neighbours[from].push(next);
        for k in 0..count {
            let distance = (points[k] - points[next]).norm_squared();
            if distance < nearest[k].0 {
                nearest[k] = (distance, next);
            }
        }
    }
    if neighbours.iter().any(|joined| joined.len() > 2) {
        return None;
    }
    let mut order = vec![neighbours.iter().position(|joined| joined.len() < 2)?];
    while let Some(next) = neighbours[order[order.len() - 1]]
        .iter()
        .find(|next| order.len() < 2 || **next != order[order.len() - 2])
    {
        order.push(*next);
    }
    Some(order)
}
