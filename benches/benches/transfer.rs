//! Transfer of modes: 17 000 vertices of a surface against 4000 nodes of a
//! structure, to be built within a second.
//!
//! `cargo bench -p fladder-benches --bench transfer`

use divan::{Bencher, black_box};
use fladder_mesh::TriMesh;
use fladder_mesh::shapes::NacaWing;
use fladder_modal::{
    Element, ElementKind, Format, Kernel, Method, ModalResult, Node, TransferSettings,
    build_transfer,
};

fn main() {
    divan::main();
}

fn wing(n_chord: usize, n_half_span: usize) -> TriMesh {
    NacaWing {
        n_chord,
        n_half_span,
        ..NacaWing::default()
    }
    .structured()
    .expect("a wing")
}

/// A coarser surface of the same wing as shells.
fn structure() -> ModalResult {
    let mesh = wing(24, 41);
    let nodes = mesh.vertices.iter().zip(1..);
    let elements = mesh.triangles.iter().zip(1..);
    ModalResult {
        format: Format::Neutral,
        nodes: nodes
            .map(|(position, id)| Node {
                id,
                position: *position,
            })
            .collect(),
        elements: elements
            .map(|(nodes, id)| Element {
                id,
                kind: ElementKind::Tri3,
                nodes: nodes.to_vec(),
            })
            .collect(),
        element_sets: Vec::new(),
        node_sets: Vec::new(),
        modes: Vec::new(),
        stated_mass: None,
        notes: Vec::new(),
    }
}

fn build(bencher: Bencher<'_, '_>, method: Method) {
    let (mesh, structure) = (wing(50, 85), structure());
    let settings = TransferSettings {
        default_method: method,
        ..TransferSettings::default()
    };
    println!(
        "{} vertices, {} nodes",
        mesh.vertices.len(),
        structure.nodes.len()
    );
    bencher.bench_local(|| {
        build_transfer(black_box(&structure), &mesh, &settings).expect("they fit")
    });
}

/// Nearest faces.
#[divan::bench(sample_count = 5, sample_size = 1)]
fn faces(bencher: Bencher<'_, '_>) {
    build(bencher, Method::Faces);
}

/// Splines over patches of nodes.
#[divan::bench(sample_count = 5, sample_size = 1)]
fn polyharmonic(bencher: Bencher<'_, '_>) {
    build(bencher, Method::Spline(Kernel::Polyharmonic));
}
