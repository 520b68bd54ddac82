//! A cover of scattered structural points by overlapping splines.
//!
//! Few points share one spline. Many are covered by patches of near points,
//! whose splines are blended with the weights of Franke and Little,
//!
//! $$ w_j(\mathbf p) \propto \left(\frac{R - d_j}{R\,d_j}\right)^2_{+}, $$
//!
//! d_j the distance from the middle of patch j and R that of the first patch
//! that takes no part; every patch carries rigid motion exactly, and so does
//! their mean. Rows of the matrix stay sparse, and the cost is linear in the
//! number of vertices.

use crate::error::TransferError;
use crate::spline::{Kernel, Patch};
use fladder_mesh::Vec3;
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Up to so many points share one spline.
const WHOLE: usize = 80;

/// Points of a patch where there are more.
const PATCH: usize = 40;

/// Points a patch.
const SPACING: usize = 8;

/// Patches blended at a vertex.
const BLENDED: usize = 3;

/// Points nearer to each other than this share of their extent are one.
const SAME: f64 = 1e-7;

/// The points of one component and the splines over them.
pub(crate) struct Scatter {
    nodes: Vec<u32>,
    positions: Vec<Vec3>,
    patches: Vec<Laid>,
}

/// A patch, the point it is laid about, and its points.
struct Laid {
    middle: Vec3,
    points: Vec<u32>,
    patch: Patch,
}

/// What a component's points are asked for.
pub(crate) struct Wanted<'a> {
    pub(crate) group: &'a str,
    pub(crate) nodes: &'a [u32],
    pub(crate) kernel: Kernel,
}

impl Scatter {
    pub(crate) fn new(wanted: &Wanted<'_>, all: &[Vec3]) -> Result<Self, TransferError> {
        let nodes = apart(wanted.nodes, all);
        let mut scatter = Self {
            positions: nodes.iter().map(|node| all[*node as usize]).collect(),
            patches: Vec::new(),
            nodes,
        };
        if scatter.cover(wanted.kernel) {
            return Ok(scatter);
        }
        Err(TransferError::OnOneLine {
            group: wanted.group.to_owned(),
            points: scatter.nodes.len(),
        })
    }

    /// Lays the patches; false where one cannot tell rigid motions apart.
    fn cover(&mut self, kernel: Kernel) -> bool {
        let count = self.positions.len();
        let laid: Option<Vec<Laid>> = if count <= WHOLE {
            let middle = self.positions.iter().sum::<Vec3>();
            let everything = (0..count as u32).collect();
            self.lay(middle, everything, kernel).map(|laid| vec![laid])
        } else {
            self.middles()
                .into_par_iter()
                .map(|middle| self.lay_about(middle, kernel))
                .collect()
        };
        self.patches = laid.unwrap_or_default();
        !self.patches.is_empty()
    }

    /// Points to lay patches about, each the farthest from all before it.
    fn middles(&self) -> Vec<Vec3> {
        let count = self.positions.len();
        let mut nearest = vec![f64::INFINITY; count];
        let mut next = 0;
        (0..count / SPACING)
            .map(|_| {
                let middle = self.positions[next];
                for (distance, position) in nearest.iter_mut().zip(&self.positions) {
                    *distance = distance.min((position - middle).norm_squared());
                }
                next = (0..count)
                    .max_by(|a, b| nearest[*a].total_cmp(&nearest[*b]).then(b.cmp(a)))
                    .unwrap_or(0);
                middle
            })
            .collect()
    }

    /// The patch of the nearest points, of more of them where they lie on a line.
    fn lay_about(&self, middle: Vec3, kernel: Kernel) -> Option<Laid> {
        let most = (4 * PATCH).min(self.positions.len());
        let squares = self.positions.iter().zip(0..);
        let near: Vec<(u32, f64)> = squares
            .map(|(position, k)| (k, (position - middle).norm_squared()))
            .collect();
        let near = nearest_first(near, most);
        let mut size = PATCH;
        loop {
            let points = near.iter().take(size).map(|(k, _)| *k).collect();
            let laid = self.lay(middle, points, kernel);
            if laid.is_some() || size >= most {
                return laid;
            }
            size *= 2;
        }
    }

    fn lay(&self, middle: Vec3, points: Vec<u32>, kernel: Kernel) -> Option<Laid> {
        let positions = points.iter().map(|k| self.positions[*k as usize]).collect();
        Some(Laid {
            middle,
            patch: Patch::new(positions, kernel).ok()?,
            points,
        })
    }

    /// Distance to the nearest node.
    pub(crate) fn distance(&self, point: &Vec3) -> f64 {
        let squares = self
            .positions
            .iter()
            .map(|position| (position - point).norm_squared());
        squares.fold(f64::INFINITY, f64::min).sqrt()
    }

    /// The blocks that give the displacement of a point.
    pub(crate) fn blocks(&self, point: &Vec3) -> Vec<(u32, Matrix3<f64>)> {
        let mut row: BTreeMap<u32, Matrix3<f64>> = BTreeMap::new();
        for (patch, weight) in self.weights(point) {
            let Laid { points, patch, .. } = &self.patches[patch];
            for (k, block) in points.iter().zip(patch.blocks(point)) {
                *row.entry(self.nodes[*k as usize]).or_default() += block * weight;
            }
        }
        row.into_iter().collect()
    }

    fn weights(&self, point: &Vec3) -> Vec<(usize, f64)> {
        let near: Vec<(usize, f64)> = self
            .patches
            .iter()
            .enumerate()
            .map(|(k, patch)| (k, (patch.middle - point).norm()))
            .collect();
        if near.len() <= 1 {
            return near.into_iter().map(|(k, _)| (k, 1.0)).collect();
        }
        let mut near = nearest_first(near, BLENDED + 1);
        let reach = near.get(BLENDED).unwrap_or(&near[near.len() - 1]).1;
        near.truncate(BLENDED);
        if near[0].1 <= SAME * reach {
            return vec![(near[0].0, 1.0)];
        }
        for (_, distance) in &mut near {
            *distance = ((reach - *distance) / (reach * *distance)).powi(2);
        }
        let sum: f64 = near.iter().map(|(_, weight)| weight).sum();
        if sum > 0.0 {
            near.into_iter()
                .map(|(k, weight)| (k, weight / sum))
                .collect()
        } else {
            vec![(near[0].0, 1.0)]
        }
    }
}

/// The so many nearest in order of distance, of equal ones by number.
fn nearest_first<K: Ord>(mut near: Vec<(K, f64)>, count: usize) -> Vec<(K, f64)> {
    let order = |a: &(K, f64), b: &(K, f64)| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0));
    if count < near.len() {
        near.select_nth_unstable_by(count, order);
        near.truncate(count);
    }
    near.sort_unstable_by(order);
    near
}

/// The nodes without those that lie where an earlier one does.
pub(crate) fn apart(nodes: &[u32], all: &[Vec3]) -> Vec<u32> {
    let mut order = nodes.to_vec();
    order.sort_unstable();
    order.dedup();
    let extent = crate::read::diagonal(order.iter().map(|node| &all[*node as usize]));
    let cell = (SAME * extent).max(f64::MIN_POSITIVE);
    let mut seen = std::collections::BTreeSet::new();
    order.retain(|node| {
        let key = all[*node as usize] / cell;
        seen.insert([key.x, key.y, key.z].map(|v| v.round() as i64))
    });
    order
}
