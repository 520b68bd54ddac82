//! The aircraft meshes against the figures of the program that made them.
#![allow(clippy::unwrap_used, reason = "a failed read fails the test")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use fladder_mesh::judge::{Settings, judge};
use fladder_mesh::read::load;
use fladder_mesh::trailing_edge::{self, find_by_shape, find_from_groups};
use fladder_mesh::{Topology, TrailingEdge, TriMesh};

fn workspace(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(path)
}

fn edge_set(chains: &[TrailingEdge]) -> BTreeSet<[u32; 2]> {
    chains
        .iter()
        .flat_map(TrailingEdge::edges)
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect()
}

/// Half a unit of the last digit written.
fn last_digit(text: &str) -> f64 {
    let digits = text.split_once('.').map_or(0, |(_, digits)| digits.len());
    0.5 * 10_f64.powi(-(digits as i32)) * 1.000_001
}

/// Judges a mesh of the aircraft: no faults, one body, and the trailing edges found by shape are
/// those named in the file. Area, volume and the mesh.
fn sound(path: &str) -> (f64, f64, TriMesh, usize) {
    let loaded = load(workspace(path), 1.0).unwrap();
    assert_eq!(loaded.notes, Vec::<String>::new());
    let judgement = judge(loaded.mesh.clone(), Settings::default());
    assert_eq!(judgement.faults, []);
    assert_eq!(judgement.mesh, loaded.mesh);
    assert_eq!(judgement.bodies.len(), 1);
    assert_eq!(judgement.bodies[0].euler, 2);
    assert_eq!(judgement.bodies[0].genus, Some(0));
    let mesh = judgement.mesh;
    let topology = Topology::new(&mesh);
    let found = find_by_shape(&mesh, &topology, trailing_edge::Settings::default());
    let named = find_from_groups(&mesh, &topology, &["te_r", "te_l"]).unwrap();
    assert_eq!(edge_set(&found), edge_set(&named));
    assert_eq!(found, named);
    assert_eq!(found.len(), 2);
    let edges = edge_set(&found).len();
    (judgement.area, judgement.volume, mesh, edges)
}

#[test]
fn the_aircraft_meshes_have_no_faults() {
    for name in ["scaneagle_3k", "scaneagle_10k"] {
        let (area, volume, mesh, edges) = sound(&format!("meshes/{name}.msh"));
        println!(
            "{name}: {} triangles, {edges} trailing edges, {area} m², {volume} m³",
            mesh.triangles.len()
        );
    }
}

#[test]
fn a_mesh_of_another_program_has_its_published_figures() {
    let table = std::fs::read_to_string(workspace("tests/data/scaneagle_meshes.csv")).unwrap();
    let row = table.lines().filter(|line| !line.starts_with('#')).nth(1);
    let fields: Vec<&str> = row.unwrap().split(',').collect();
    let count = |k: usize| fields[k].parse::<usize>().unwrap();
    let (area, volume, mesh, edges) = sound(&format!("tests/data/{}", fields[0]));
    assert_eq!(
        (mesh.vertices.len(), mesh.triangles.len(), 2, edges),
        (count(1), count(2), count(3), count(4))
    );
    for (value, text) in [(area, fields[5]), (volume, fields[6])] {
        let expected: f64 = text.parse().unwrap();
        assert!(
            (value - expected).abs() <= last_digit(text),
            "{value} against {text}"
        );
    }
}
