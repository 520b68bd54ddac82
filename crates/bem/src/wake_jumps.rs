//! Threads and slots of a wake: which jumps there are, and how far they have come.

use crate::cut::Jump;
use crate::wake::{NO_SLOT, Slot};
use crate::wake_builder::Builder;
use fladder_mesh::Vec3;
use std::collections::BTreeMap;

/// Origins closer than this part of the margin are one.
pub(crate) const SAME_ORIGIN: f64 = 1e-9;

/// Jumps that started at one distance, as weights of the lines' jumps.
pub(crate) struct Origin {
    pub(crate) xi: f64,
    pub(crate) shares: Vec<(usize, f64)>,
}

impl Builder<'_> {
    /// ξ of a point for the jump of a body line.
    pub(crate) fn distance(&self, path: usize, point: Vec3) -> f64 {
        let junction = self.position(self.paths.paths[path].vertices[0]);
        (point - junction).dot(&self.direction)
    }

    /// The jump that a body line carries, as weights of columns.
    fn path_jump(&self, path: usize) -> &Jump {
        let end = self.paths.paths[path].end;
        let jumps = &self.surface.chain_jumps[end.chain];
        &jumps[if end.last { jumps.len() - 1 } else { 0 }]
    }

    /// Number of the thread with this jump.
    pub(crate) fn thread(&mut self, jump: &[(usize, f64)]) -> usize {
        let mut sum: BTreeMap<usize, f64> = BTreeMap::new();
        for &(column, weight) in jump {
            *sum.entry(column).or_insert(0.0) += weight;
        }
        let jump: Jump = sum.into_iter().filter(|(_, w)| *w != 0.0).collect();
        let key = jump.iter().map(|&(c, w)| (c, w.to_bits())).collect();
        let threads = &mut self.threads;
        *self.thread_of.entry(key).or_insert_with(|| {
            threads.push(jump);
            threads.len() - 1
        })
    }

    /// Thread of a sum of body lines' jumps.
    pub(crate) fn shared_thread(&mut self, shares: &[(usize, f64)]) -> usize {
        let jump: Jump = shares
            .iter()
            .flat_map(|&(path, share)| {
                self.path_jump(path)
                    .iter()
                    .map(move |&(column, weight)| (column, share * weight))
            })
            .collect();
        self.thread(&jump)
    }

    pub(crate) fn slot(&mut self, thread: usize, xi: f64) -> u32 {
        if self.threads[thread].is_empty() {
            return NO_SLOT;
        }
        let slots = &mut self.slots;
        *self
            .slot_of
            .entry((thread, xi.to_bits()))
            .or_insert_with(|| {
                slots.push(Slot { thread, xi });
                slots.len() as u32 - 1
            })
    }

    /// Sorts jumps at a point by how far they have come.
    pub(crate) fn origins(&self, point: Vec3, shares: &[(usize, f64)]) -> Vec<Origin> {
        let mut origins: Vec<Origin> = Vec::new();
        for &(path, share) in shares {
            let xi = self.distance(path, point);
            let same = origins
                .iter_mut()
                .find(|o| (o.xi - xi).abs() < SAME_ORIGIN * self.margin);
            match same {
                Some(origin) => origin.shares.push((path, share)),
                None => origins.push(Origin {
                    xi,
                    shares: vec![(path, share)],
                }),
            }
        }
        origins
    }

    /// Slots on the corners of the body's triangles, a triangle as often as one of its
    /// corners has slots.
    pub(crate) fn body_jumps(&mut self) -> Vec<(u32, [u32; 3])> {
        let mut at: BTreeMap<(u32, usize), Vec<(usize, f64)>> = BTreeMap::new();
        for share in &self.surface.carried {
            at.entry((share.triangle, share.corner))
                .or_default()
                .push((share.path, share.weight));
        }
        let mut layers: BTreeMap<u32, Vec<[u32; 3]>> = BTreeMap::new();
        for ((triangle, corner), shares) in at {
            let point = self.mesh.corners(triangle as usize)[corner];
            for origin in self.origins(point, &shares) {
                let thread = self.shared_thread(&origin.shares);
                let slot = self.slot(thread, origin.xi);
                let own = layers.entry(triangle).or_default();
                let free = own.iter().position(|slots| slots[corner] == NO_SLOT);
                let layer = free.unwrap_or(own.len());
                if layer == own.len() {
                    own.push([NO_SLOT; 3]);
                }
                own[layer][corner] = slot;
            }
        }
        layers
            .into_iter()
            .flat_map(|(t, slots)| slots.into_iter().map(move |s| (t, s)))
            .collect()
    }
}
