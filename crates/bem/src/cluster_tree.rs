//! Bisection of things in space, and which pairs of clusters are far from each other.

use fladder_mesh::Vec3;

/// Things of a leaf, about: smaller ones keep blocks whose two factors cost as much as they
/// save.
const LEAF: usize = 64;

/// A pair of clusters is far when the smaller one's diameter is below so many distances.
const FAR: f64 = 1.5;

/// Clusters of clusters; the first is the whole.
#[derive(Clone, Debug)]
pub(crate) struct ClusterTree {
    /// The things, those of a cluster side by side.
    pub(crate) order: Vec<u32>,
    pub(crate) clusters: Vec<Cluster>,
}

/// A run of [`ClusterTree::order`].
#[derive(Clone, Debug)]
pub(crate) struct Cluster {
    pub(crate) first: usize,
    pub(crate) end: usize,
    halves: Option<[usize; 2]>,
    centre: Vec3,
    radius: f64,
}

/// A block of a matrix over two trees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pair {
    pub(crate) row: usize,
    pub(crate) column: usize,
    pub(crate) is_far: bool,
}

impl ClusterTree {
    /// Of things inside spheres.
    pub(crate) fn new(spheres: &[(Vec3, f64)]) -> Self {
        let mut tree = Self {
            order: (0..spheres.len() as u32).collect(),
            clusters: Vec::new(),
        };
        if !spheres.is_empty() {
            tree.grow(spheres, 0, spheres.len());
        }
        tree
    }

    /// Things of a cluster.
    pub(crate) fn of(&self, cluster: usize) -> &[u32] {
        let cluster = &self.clusters[cluster];
        &self.order[cluster.first..cluster.end]
    }

    fn grow(&mut self, spheres: &[(Vec3, f64)], first: usize, end: usize) -> usize {
        let part = &mut self.order[first..end];
        let at = |i: &u32| spheres[*i as usize].0;
        let (low, high) = part
            .iter()
            .map(at)
            .fold((at(&part[0]), at(&part[0])), |(l, h), p| {
                (l.inf(&p), h.sup(&p))
            });
        let centre = 0.5 * (low + high);
        let radius = part
            .iter()
            .map(|&i| (spheres[i as usize].0 - centre).norm() + spheres[i as usize].1)
            .fold(0.0, f64::max);
        let own = self.clusters.len();
        self.clusters.push(Cluster {
            first,
            end,
            halves: None,
            centre,
            radius,
        });
        if end - first > LEAF {
            let axis = (high - low).imax();
            let middle = (end - first) / 2;
            part.select_nth_unstable_by(middle, |&a, &b| {
                spheres[a as usize].0[axis]
                    .total_cmp(&spheres[b as usize].0[axis])
                    .then(a.cmp(&b))
            });
            let left = self.grow(spheres, first, first + middle);
            let right = self.grow(spheres, first + middle, end);
            self.clusters[own].halves = Some([left, right]);
        }
        own
    }
}

/// Pairs that cover the product of two trees once, in a fixed order.
pub(crate) fn pairs(rows: &ClusterTree, columns: &ClusterTree) -> Vec<Pair> {
    let mut found = Vec::new();
    if !rows.order.is_empty() && !columns.order.is_empty() {
        divide(rows, columns, 0, 0, &mut found);
    }
    found
}

fn divide(
    rows: &ClusterTree,
    columns: &ClusterTree,
    row: usize,
    column: usize,
    found: &mut Vec<Pair>,
) {
    let (r, c) = (&rows.clusters[row], &columns.clusters[column]);
    let distance = (r.centre - c.centre).norm() - r.radius - c.radius;
    let is_far = 2.0 * r.radius.min(c.radius) < FAR * distance;
    match (r.halves, c.halves) {
        _ if is_far => found.push(Pair {
            row,
            column,
            is_far,
        }),
        (Some(halves), other) if other.is_none() || r.radius >= c.radius => {
            for half in halves {
                divide(rows, columns, half, column, found);
            }
        }
        (_, Some(halves)) => {
            for half in halves {
                divide(rows, columns, row, half, found);
            }
        }
        (_, None) => found.push(Pair {
            row,
            column,
            is_far,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_cover_every_entry_once() {
        let spheres: Vec<(Vec3, f64)> = (0..700)
            .map(|i| {
                let t = f64::from(i) * 0.01;
                (Vec3::new(t, (3.0 * t).sin(), 0.0), 0.01)
            })
            .collect();
        let tree = ClusterTree::new(&spheres);
        let n = spheres.len();
        let mut covered = vec![0_u8; n * n];
        let mut far = 0;
        for pair in pairs(&tree, &tree) {
            far += usize::from(pair.is_far);
            for &i in tree.of(pair.row) {
                for &j in tree.of(pair.column) {
                    covered[i as usize * n + j as usize] += 1;
                }
            }
        }
        println!("{far} far pairs");
        assert!(far > 10 && covered.iter().all(|&c| c == 1));
    }
}
