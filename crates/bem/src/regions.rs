//! Clusters of test triangles gathered into regions, and regions into larger ones.
//!
//! What is far from a region is received by all of its clusters together
//! ([`crate::receiver`]): the farther a part of the wake, the fewer points it is evaluated
//! at.

use crate::image::Image;
use crate::receiver::Receiver;
use crate::tiles::TestCluster;
use rayon::prelude::*;

/// Clusters or regions of a region. Aligned runs of so many are compact in the order of
/// the test triangles.
pub(crate) const TOGETHER: usize = 4;

/// A cluster or a region by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    Cluster(usize),
    Region(usize),
}

/// Clusters or smaller regions together.
#[derive(Clone, Debug)]
pub(crate) struct Region {
    /// Vertices, ascending.
    pub(crate) rows: Vec<u32>,
    pub(crate) receiver: Receiver,
    parts: Vec<Part>,
}

/// All regions; clusters without receiver are in none.
#[derive(Clone, Debug, Default)]
pub(crate) struct Regions {
    pub(crate) all: Vec<Region>,
    roots: Vec<Part>,
}

impl Regions {
    pub(crate) fn new(clusters: &[TestCluster], image: Image, tolerance: f64) -> Self {
        let mut regions = Self {
            all: Vec::new(),
            roots: (0..clusters.len()).map(Part::Cluster).collect(),
        };
        loop {
            let before = regions.roots.len();
            let parts = std::mem::take(&mut regions.roots);
            let gathered: Vec<Option<Region>> = parts
                .par_chunks(TOGETHER)
                .map(|group| regions.gather(clusters, group, image, tolerance))
                .collect();
            for (group, region) in parts.chunks(TOGETHER).zip(gathered) {
                match region {
                    Some(region) => {
                        regions.roots.push(Part::Region(regions.all.len()));
                        regions.all.push(region);
                    }
                    None => regions.roots.extend(group),
                }
            }
            if regions.roots.len() == before {
                return regions;
            }
        }
    }

    /// A region of some parts, if each has a receiver and they are better off together.
    fn gather(
        &self,
        clusters: &[TestCluster],
        parts: &[Part],
        image: Image,
        tolerance: f64,
    ) -> Option<Region> {
        if parts.len() < 2 {
            return None;
        }
        let received: Vec<(&Receiver, &[u32])> = parts
            .iter()
            .map(|part| match *part {
                Part::Cluster(c) => {
                    let cluster = &clusters[c];
                    Some((cluster.receiver.as_ref()?, cluster.rows.as_slice()))
                }
                Part::Region(r) => Some((&self.all[r].receiver, self.all[r].rows.as_slice())),
            })
            .collect::<Option<_>>()?;
        let mut rows: Vec<u32> = received
            .iter()
            .flat_map(|(_, rows)| *rows)
            .copied()
            .collect();
        rows.sort_unstable();
        rows.dedup();
        Some(Region {
            receiver: Receiver::of_all(&received, image, &rows, tolerance)?,
            rows,
            parts: parts.to_vec(),
        })
    }

    /// The largest regions of which `is_far` holds, and the clusters in none of them.
    pub(crate) fn receiving(&self, is_far: impl Fn(&Receiver) -> bool) -> Vec<Part> {
        let mut found = Vec::new();
        let mut open: Vec<Part> = self.roots.iter().rev().copied().collect();
        while let Some(part) = open.pop() {
            match part {
                Part::Region(r) if !is_far(&self.all[r].receiver) => {
                    open.extend(self.all[r].parts.iter().rev());
                }
                part => found.push(part),
            }
        }
        found
    }
}
