//! Exactly the true trailing edges are found, and nothing else.
//!
//! The hard places: the leading edge of a thin section is as sharp as its
//! trailing edge, a sharp tip is sharp along the chord, a swept square tip
//! meets the skin at an angle other than 90°, and irregular triangles near the
//! nose fold strongly.

use std::collections::BTreeSet;

use fladder_mesh::shapes::{NacaWing, Tip};
use fladder_mesh::trailing_edge::{Settings, find_by_shape, find_from_groups};
use fladder_mesh::{Topology, TrailingEdge, TriMesh};

/// The edges along which both ends lie at x = |y| tan Λ + c.
fn true_edges(mesh: &TriMesh, topology: &Topology, wing: &NacaWing) -> BTreeSet<[u32; 2]> {
    let slope = wing.sweep_deg.to_radians().tan();
    let is_aft = |v: u32| {
        let p = mesh.vertices[v as usize];
        (p.x - p.y.abs() * slope - wing.chord).abs() < 1e-9 * wing.chord
    };
    topology
        .edges
        .iter()
        .filter(|edge| edge.iter().all(|&v| is_aft(v)))
        .copied()
        .collect()
}

/// Panics when the edges found are not those of the wing.
fn assert_finds_the_trailing_edge(mesh: &TriMesh, wing: &NacaWing) {
    let topology = Topology::new(mesh);
    let chains = find_by_shape(mesh, &topology, Settings::default());
    let sorted = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    let found: BTreeSet<[u32; 2]> = chains
        .iter()
        .flat_map(TrailingEdge::edges)
        .map(sorted)
        .collect();
    let expected = true_edges(mesh, &topology, wing);
    let extra: Vec<_> = found.difference(&expected).collect();
    let lost: Vec<_> = expected.difference(&found).collect();
    assert!(
        extra.is_empty() && lost.is_empty(),
        "{wing:?}: extra {extra:?}, lost {lost:?}"
    );
    assert_eq!(expected.len(), 2 * wing.n_half_span);
    assert_eq!(chains.len(), 1, "{wing:?}");
    assert_eq!(
        find_from_groups(mesh, &topology, &["te"]).as_ref(),
        Ok(&chains)
    );
}

#[test]
fn naca_wings_have_their_trailing_edge_and_no_other() {
    let mut n_cases = 0;
    for thickness in [0.02, 0.03, 0.04, 0.12] {
        for n_chord in [8, 12, 16, 24, 32, 40] {
            for n_half_span in [6, n_chord] {
                for sweep_deg in [0.0, 45.0] {
                    let wing = NacaWing {
                        thickness,
                        sweep_deg,
                        n_chord,
                        n_half_span,
                        ..NacaWing::default()
                    };
                    for tip in [Tip::Flat, Tip::Sharp] {
                        let wing = NacaWing { tip, ..wing };
                        let mesh = wing.structured().expect("dimensions in range");
                        assert_finds_the_trailing_edge(&mesh, &wing);
                        n_cases += 1;
                    }
                    for seed in 1..=3 {
                        let mesh = wing.unstructured(seed).expect("dimensions in range");
                        assert_finds_the_trailing_edge(&mesh, &wing);
                        n_cases += 1;
                    }
                }
            }
        }
    }
    println!("{n_cases} wings");
    assert_eq!(n_cases, 480);
}
