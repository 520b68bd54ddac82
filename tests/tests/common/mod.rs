//! What several whole-chain tests need.
#![allow(dead_code, reason = "each test file uses its part")]
#![allow(unused_imports, reason = "each test file uses its part")]

use fladder_bem::{Flow, Solution};
use fladder_mesh::{SurfaceMode, TrailingEdge, TriMesh};
use fladder_tests::case::Setup;

pub(crate) use fladder_tests::case::{edges, mode};

/// Solution with the given modes at an incidence.
pub(crate) fn solved(
    mesh: &TriMesh,
    edges: &[TrailingEdge],
    modes: &[SurfaceMode],
    flow: Flow,
    semichord: f64,
) -> Solution {
    let setup = Setup {
        flow,
        semichord,
        trailing_edges: Some(edges),
        ..Setup::new(mesh, modes)
    };
    setup.solve().expect("a sound problem")
}
