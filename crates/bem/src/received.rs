//! Which parts of the surface receive which blocks of panels.
//!
//! A block of panels goes to the largest regions that are far from it, and to the clusters
//! in none of them, far or near ([`crate::regions`]).

use crate::edge_cells::EdgeCells;
use crate::galerkin::Galerkin;
use crate::panel_block::PanelBlock;
use crate::receiver::Receiver;
use crate::regions::Part;
use crate::tiles::TestCluster;

/// A block and the place of its first triangle in the order of all blocks.
pub(crate) struct Placed<'a> {
    pub(crate) block: &'a PanelBlock,
    pub(crate) first: usize,
}

/// What one region or cluster receives.
pub(crate) struct Received<'a> {
    /// Test functions, ascending.
    pub(crate) rows: &'a [u32],
    /// A cluster's test triangles; none of a region, which is far from all of its blocks.
    pub(crate) cluster: Option<&'a TestCluster>,
    pub(crate) receiver: Option<&'a Receiver>,
    pub(crate) far: Vec<Placed<'a>>,
    pub(crate) near: Vec<Placed<'a>>,
}

/// Of all regions and clusters, in this order.
pub(crate) fn received(galerkin: &Galerkin) -> Vec<Received<'_>> {
    let regions = &galerkin.regions.all;
    let mut all: Vec<Received<'_>> = regions
        .iter()
        .map(|region| Received::new(&region.rows, None, Some(&region.receiver)))
        .chain(galerkin.clusters.iter().map(|cluster| {
            Received::new(&cluster.rows, Some(cluster), cluster.receiver.as_ref())
        }))
        .collect();
    let mut first = 0;
    for block in &galerkin.blocks {
        for part in galerkin.regions.receiving(|r| r.is_far_from(block)) {
            let placed = Placed { block, first };
            match part {
                Part::Region(r) => all[r].far.push(placed),
                Part::Cluster(c) => {
                    let part = &mut all[regions.len() + c];
                    if galerkin.clusters[c].receiver_of(block).is_some() {
                        part.far.push(placed);
                    } else {
                        part.near.push(placed);
                    }
                }
            }
        }
        first += block.triangles.len();
    }
    all
}

impl<'a> Received<'a> {
    fn new(
        rows: &'a [u32],
        cluster: Option<&'a TestCluster>,
        receiver: Option<&'a Receiver>,
    ) -> Self {
        Self {
            rows,
            cluster,
            receiver,
            far: Vec::new(),
            near: Vec::new(),
        }
    }
}

/// Vertices and slopes of jumps on which the influence of some blocks depends, ascending.
pub(crate) fn columns_of(blocks: &[Placed<'_>], cells: &EdgeCells) -> Vec<u32> {
    let mut columns: Vec<u32> = blocks
        .iter()
        .flat_map(|placed| &placed.block.columns)
        .flat_map(|&column| cells.made_of(column))
        .map(|(v, _)| v)
        .collect();
    columns.sort_unstable();
    columns.dedup();
    columns
}
