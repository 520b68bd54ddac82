//! The generator against the meshes of the case, which another program made.

use std::path::Path;

use fladder_mesh::read::read_mesh;

use super::params::Parameters;
use super::surface::surface;
use super::{TABLE, msh41};

fn parameters() -> Parameters {
    Parameters::read(Path::new(TABLE)).unwrap()
}

/// Counts and groups are those of the committed meshes, every vertex lies on one of theirs,
/// and area and volume agree.
#[test]
fn the_meshes_of_the_case_come_out_again() {
    let parameters = parameters();
    for size in ["3k", "10k"] {
        let made = surface(&parameters, parameters.size[size]).unwrap();
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../meshes");
        let there =
            read_mesh(Path::new(file).join(format!("scaneagle_{size}.msh")), 1.0).unwrap();
        assert_eq!(made.vertices.len(), there.vertices.len());
        assert_eq!(made.triangles.len(), there.triangles.len());
        let apart = made
            .vertices
            .iter()
            .map(|own| {
                let distances = there.vertices.iter().map(|other| (own - other).norm());
                distances.fold(f64::INFINITY, f64::min)
            })
            .fold(0.0, f64::max);
        let (area, volume) = (made.area() / there.area(), made.volume() / there.volume());
        println!(
            "{size}: vertices at most {apart:.1e} m apart, area {:.1e}, volume {:.1e} off",
            area - 1.0,
            volume - 1.0
        );
        assert!(apart < 1e-5);
        assert!((area - 1.0).abs() < 1e-6 && (volume - 1.0).abs() < 1e-6);
        for group in &there.surfaces {
            let own = made
                .surfaces
                .iter()
                .find(|own| own.name == group.name)
                .unwrap();
            assert_eq!(own.triangles.len(), group.triangles.len(), "{}", group.name);
        }
        for group in &there.curves {
            let own = made
                .curves
                .iter()
                .find(|own| own.name == group.name)
                .unwrap();
            assert_eq!(own.edges.len(), group.edges.len(), "{}", group.name);
        }
    }
}

/// Port is the mirror image of starboard, bit by bit; every edge has two triangles that pass
/// it in opposite directions; the same bytes come out again.
#[test]
fn halves_are_images_and_the_surface_is_closed() {
    let parameters = parameters();
    let made = surface(&parameters, parameters.size["10k"]).unwrap();
    let mut edges = std::collections::BTreeMap::new();
    for [a, b, c] in &made.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let way = if from < to { 1 } else { -1 };
            let entry = edges.entry((from.min(to), from.max(to))).or_insert((0, 0));
            entry.0 += 1;
            entry.1 += way;
        }
    }
    assert!(edges.values().all(|passed| *passed == (2, 0)));
    assert!(made.volume() > 0.0);
    let bits = |side: f64| -> Vec<[u64; 3]> {
        let mut all: Vec<[u64; 3]> = made
            .vertices
            .iter()
            .filter(|vertex| vertex.y * side > 0.0)
            .map(|vertex| [vertex.x, vertex.y * side, vertex.z].map(f64::to_bits))
            .collect();
        all.sort_unstable();
        all
    };
    assert_eq!(bits(1.0), bits(-1.0));
    let bytes = || {
        let mut bytes = Vec::new();
        let mesh = surface(&parameters, parameters.size["3k"]).unwrap();
        msh41(&mut bytes, &mesh).unwrap();
        bytes
    };
    assert!(bytes() == bytes());
}

/// Dimensions that make no aircraft are refused by name.
#[test]
fn impossible_dimensions_are_named() {
    let text = std::fs::read_to_string(TABLE).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let refused = |from: &str, to: &str| {
        std::fs::write(&path, text.replacen(from, to, 1)).unwrap();
        match Parameters::read(&path) {
            Err(error) => error.to_string(),
            Ok(parameters) => match surface(&parameters, parameters.size["3k"]) {
                Err(error) => error.to_string(),
                Ok(_) => "accepted".to_owned(),
            },
        }
    };
    assert!(refused("span = 3.11", "span = -1.0").contains("wing.span"));
    assert!(refused("span = 3.11", "spam = 3.11").contains("spam"));
    assert!(refused("elevon = [0.72, 1.40]", "elevon = [1.40, 0.72]").contains("elevon"));
    assert!(refused("chord = 12 ", "chord = 3 ").contains("size.3k"));
    assert!(refused("radius = 0.089\n", "radius = 0.01\n").contains("nose_cap"));
    assert!(refused("radius = 0.089\n", "radius = 0.23\n").contains("blend_to"));
    assert!(refused("radius = 0.089\n", "radius = 0.21\n").contains("pierce"));
}
