//! The aircraft meshes against the figures of the program that made them.
#![allow(clippy::unwrap_used, reason = "a failed read fails the test")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use fladder_mesh::judge::{Settings, judge};
use fladder_mesh::read::load;
use fladder_mesh::trailing_edge::{self, find_by_shape, find_from_groups};
use fladder_mesh::{Topology, TrailingEdge};

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

#[test]
fn the_aircraft_meshes_have_no_faults_and_the_published_figures() {
    let table = std::fs::read_to_string(workspace("tests/data/scaneagle_meshes.csv")).unwrap();
    let rows = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    let mut n_meshes = 0;
    for row in rows {
        let fields: Vec<&str> = row.split(',').collect();
        let count = |k: usize| fields[k].parse::<usize>().unwrap();
        let loaded = load(workspace("meshes").join(fields[0]), 1.0).unwrap();
        assert_eq!(loaded.notes, Vec::<String>::new());
        let judgement = judge(loaded.mesh.clone(), Settings::default());
        assert_eq!(judgement.faults, []);
        assert_eq!(judgement.mesh, loaded.mesh);
        assert_eq!(judgement.bodies.len(), 1);
        assert_eq!(judgement.bodies[0].euler, count(3) as i64);
        assert_eq!(judgement.bodies[0].genus, Some(0));
        let mesh = judgement.mesh;
        assert_eq!(
            (mesh.vertices.len(), mesh.triangles.len()),
            (count(1), count(2))
        );
        for (value, text) in [(judgement.area, fields[5]), (judgement.volume, fields[6])] {
            let expected: f64 = text.parse().unwrap();
            assert!(
                (value - expected).abs() <= last_digit(text),
                "{value} against {text}"
            );
        }
        let topology = Topology::new(&mesh);
        let found = find_by_shape(&mesh, &topology, trailing_edge::Settings::default());
        let named = find_from_groups(&mesh, &topology, &["te_r", "te_l"]).unwrap();
        assert_eq!(edge_set(&found), edge_set(&named));
        assert_eq!(edge_set(&found).len(), count(4));
        assert_eq!(found, named);
        assert_eq!(found.len(), 2);
        n_meshes += 1;
    }
    assert_eq!(n_meshes, 2);
}
