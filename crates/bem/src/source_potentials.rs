//! Right-hand sides −S σ without a matrix.
//!
//! Every block of panels is evaluated at the chosen points of the largest regions that are
//! far from it ([`crate::regions`]), and at the test points of the clusters near it. Work
//! grows as n log n.

use crate::error::BemError;
use crate::galerkin::Galerkin;
use crate::lanes::WIDTH;
use crate::progress::Progress;
use crate::regions::Part;
use crate::source_columns::{SourceColumns, SourceSums};
use crate::tiles::{PointValues, Tile, TileScratch, free_terms};
use faer::{Mat, MatRef};
use rayon::prelude::*;

/// −S σ tested: vertices × source columns; and the free term c at every test point, row
/// 3 t + q, of the closed surface.
pub(crate) fn source_potentials(
    galerkin: &Galerkin,
    sources: MatRef<'_, f64>,
    progress: &dyn Progress,
) -> Result<(Mat<f64>, Vec<f64>), BemError> {
    let columns = SourceColumns::new(sources, &galerkin.blocks);
    let received = Received::new(galerkin);
    let parts: Vec<Part> = (0..galerkin.regions.all.len())
        .map(Part::Region)
        .chain((0..galerkin.clusters.len()).map(Part::Cluster))
        .collect();
    let stage = "evaluating sources";
    progress.stage(stage, parts.len() as u64);
    let found: Vec<(Mat<f64>, Vec<PointValues>)> = parts
        .par_iter()
        .map_init(Default::default, |working, &part| {
            let found = if progress.cancelled() {
                (Mat::new(), Vec::new())
            } else {
                received.at(part, galerkin, &columns, working)
            };
            progress.advance(1);
            found
        })
        .collect();
    if progress.cancelled() {
        return Err(BemError::Interrupted { stage });
    }
    let mut potentials = Mat::zeros(galerkin.n_vertices, columns.len());
    let mut free = vec![0.0; 3 * galerkin.n_triangles()];
    for (&part, (values, changes)) in parts.iter().zip(&found) {
        let rows = match part {
            Part::Region(r) => &galerkin.regions.all[r].rows,
            Part::Cluster(c) => &galerkin.clusters[c].rows,
        };
        for j in 0..values.ncols() {
            for (r, &v) in rows.iter().enumerate() {
                potentials[(v as usize, j)] -= values[(r, j)];
            }
        }
        if let Part::Cluster(c) = part {
            for (group, changes) in galerkin.clusters[c].groups.iter().zip(changes) {
                for (q, values) in free_terms(changes).iter().enumerate() {
                    for (&t, value) in group.triangles.iter().zip(values) {
                        free[3 * t as usize + q] = *value;
                    }
                }
            }
        }
    }
    Ok((potentials, free))
}

/// Blocks, and the first triangle of each in their order, that each region and each cluster
/// has to do with.
struct Received {
    regions: Vec<Vec<(usize, usize)>>,
    clusters: Vec<Vec<(usize, usize)>>,
}

impl Received {
    fn new(galerkin: &Galerkin) -> Self {
        let mut received = Self {
            regions: vec![Vec::new(); galerkin.regions.all.len()],
            clusters: vec![Vec::new(); galerkin.clusters.len()],
        };
        let mut first = 0;
        for (b, block) in galerkin.blocks.iter().enumerate() {
            for part in galerkin.regions.receiving(|r| r.is_far_from(block)) {
                match part {
                    Part::Region(r) => received.regions[r].push((b, first)),
                    Part::Cluster(c) => received.clusters[c].push((b, first)),
                }
            }
            first += block.triangles.len();
        }
        received
    }

    /// S σ at the rows of a part, and what divided triangles change of Σ D.
    fn at(
        &self,
        part: Part,
        galerkin: &Galerkin,
        columns: &SourceColumns,
        (scratch, tile): &mut (TileScratch, Tile),
    ) -> (Mat<f64>, Vec<PointValues>) {
        match part {
            Part::Region(r) => {
                let receiver = &galerkin.regions.all[r].receiver;
                let mut sums = columns.zeros(receiver.width());
                for &(b, first) in &self.regions[r] {
                    scratch.fill_far(receiver, &galerkin.blocks[b], true, tile);
                    columns.add_by_columns(first, &tile.sources, &mut sums);
                }
                (&receiver.tested * columns.in_order(&sums), Vec::new())
            }
            Part::Cluster(c) => {
                let cluster = &galerkin.clusters[c];
                let mut near = columns.zeros(cluster.rows.len());
                let mut far: Option<SourceSums> = None;
                let mut changes = vec![[[0.0; WIDTH]; 3]; cluster.groups.len()];
                for &(b, first) in &self.clusters[c] {
                    let block = &galerkin.blocks[b];
                    if let Some(receiver) = cluster.receiver_of(block) {
                        scratch.fill_far(receiver, block, true, tile);
                        let sums = far.get_or_insert_with(|| columns.zeros(receiver.width()));
                        columns.add_by_columns(first, &tile.sources, sums);
                    } else {
                        scratch.fill(galerkin, cluster, block, true, tile, &mut changes);
                        columns.add_by_rows(first, &tile.sources, &mut near);
                    }
                }
                let mut sum = columns.in_order(&near);
                if let Some((receiver, far)) = cluster.receiver.as_ref().zip(far) {
                    sum += &receiver.tested * columns.in_order(&far);
                }
                (sum, changes)
            }
        }
    }
}
