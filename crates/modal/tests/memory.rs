//! Memory while a file is read: whole files take at most three times the modes
//! kept, damaged ones at most ten times the file, whatever counts they state.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;
mod writers;

use common::{file, mode};
use fladder_mesh::Vec3;
use fladder_modal::{ModalResult, Node, read_structure};
use peak_alloc::PeakAlloc;
use std::path::Path;
use writers::{Fields, WAYS, Way, bdf};

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

const NODES: usize = 2000;
const MODES: u32 = 16;

/// Damaged variants of every format.
const VARIANTS: u64 = 24;

/// Bytes that every reading takes: its buffers, and the start of the file by
/// which the format is told.
const BUFFERS: usize = 1 << 19;

fn contents() -> ModalResult {
    let mut result = common::Shells::default().result();
    for k in 0..NODES {
        let x = k as f64;
        result.nodes.push(Node {
            id: 3 * k as u64 + 1,
            position: Vec3::new(x.sin(), x.cos(), 0.01 * x),
        });
    }
    for index in 1..=MODES {
        let f = f64::from(index);
        let shape = result.nodes.iter().map(|node| {
            let x = node.position.z;
            Vec3::new(2.0 + (f * x).sin(), (f + x).cos(), 1e-9 * x)
        });
        let shape = shape.collect();
        result.modes.push(mode(index, f, 2.0, shape));
    }
    result
}

/// Bytes beyond those in use when the reading began, and whether it succeeded.
fn peak(path: &Path, geometry: Option<&Path>) -> (usize, bool) {
    let before = ALLOCATOR.current_usage();
    ALLOCATOR.reset_peak_usage();
    let read = read_structure(path, geometry, None);
    (ALLOCATOR.peak_usage().saturating_sub(before), read.is_ok())
}

/// A fixed sequence of numbers (Marsaglia 2003).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit as u64) as usize
    }
}

/// Bytes of the modes in memory.
fn kept(way: Way) -> usize {
    let vectors = if way.has_rotations() { 2 } else { 1 };
    NODES * MODES as usize * vectors * size_of::<Vec3>()
}

/// One test alone, since the allocator counts for all threads.
#[test]
fn memory_is_bounded_by_the_modes_and_by_the_file() {
    let contents = contents();
    let nodes = file("memory", "nodes.bdf", bdf(&contents, Fields::Free));
    let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15);
    for way in WAYS {
        let bytes = way.write(&contents);
        let geometry = way.needs_geometry().then_some(nodes.as_path());
        let path = file("memory", "whole", &bytes);
        let (whole, is_read) = peak(&path, geometry);
        assert!(is_read, "{way:?}");
        let of_modes = whole as f64 / kept(way) as f64;
        let mut worst = 0.0_f64;
        for variant in 0..VARIANTS {
            let mut damaged = bytes.clone();
            // Half of them in the first lines and records, where counts are.
            let reach = if variant % 2 == 0 { 600 } else { bytes.len() };
            for _ in 0..4 {
                let place = numbers.below(reach.min(bytes.len()));
                damaged[place] = [0xff, 0x7f, b'9', 0x00, b'7'][numbers.below(5)];
            }
            let path = file("memory", "damaged", &damaged);
            let (used, _) = peak(&path, geometry);
            worst = worst.max(used.saturating_sub(BUFFERS) as f64 / bytes.len() as f64);
        }
        println!(
            "{way:?}: {} kB, whole {of_modes:.2} × the modes, damaged {worst:.2} × the file",
            bytes.len() / 1000
        );
        assert!(of_modes <= 3.0, "{way:?}");
        assert!(worst <= 10.0, "{way:?}");
    }
}
