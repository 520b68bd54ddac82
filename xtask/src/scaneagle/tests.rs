//! The generator against the meshes of the case, and against one that another program made.

use std::path::Path;

use fladder_mesh::Vec3;
use fladder_mesh::read::read_mesh;

use super::params::Parameters;
use super::surface::surface;
use super::{TABLE, msh41};

fn parameters() -> Parameters {
    Parameters::read(Path::new(TABLE)).unwrap()
}

/// The committed meshes come out again byte by byte.
#[test]
fn the_meshes_of_the_case_come_out_again() {
    let parameters = parameters();
    for size in ["3k", "10k"] {
        let mut bytes = Vec::new();
        let made = surface(&parameters, parameters.size[size]).unwrap();
        msh41(&mut bytes, &made).unwrap();
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../meshes");
        let there = Path::new(file).join(format!("scaneagle_{size}.msh"));
        assert!(bytes == std::fs::read(there).unwrap(), "{size}");
    }
}

/// Vertices of a mesh that another program made after the same dimensions, with other cells,
/// lie on the surface to the arc of a cell over its chord.
#[test]
fn the_surface_is_that_of_another_program() {
    let parameters = parameters();
    let made = surface(&parameters, parameters.size["34k"]).unwrap();
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data");
    let other = read_mesh(Path::new(file).join("scaneagle_surface.msh"), 1.0).unwrap();
    let corners: Vec<[Vec3; 3]> = made
        .triangles
        .iter()
        .map(|t| t.map(|v| made.vertices[v as usize]))
        .collect();
    let distances: Vec<f64> = other
        .vertices
        .iter()
        .map(|p| {
            let distance = |t: &[Vec3; 3]| distance(p, t);
            corners.iter().map(distance).fold(f64::INFINITY, f64::min)
        })
        .collect();
    let largest = distances.iter().copied().fold(0.0, f64::max);
    let mean = distances.iter().sum::<f64>() / distances.len() as f64;
    println!("vertices of another program: {largest:.1e} m from the surface, mean {mean:.1e}");
    assert!(largest < 1.5e-3 && mean < 1e-4);
    // The spinner is round over 50 mm and has few cells.
    let spinner = parameters.fuselage.length - parameters.fuselage.spinner;
    let elsewhere = other.vertices.iter().zip(&distances);
    assert!(
        elsewhere
            .filter(|(p, _)| p.x < spinner)
            .all(|(_, d)| *d < 6e-4)
    );
}

/// Controls reach to the same places on every mesh: the outer edges of the strips that shear.
#[test]
fn controls_are_as_large_on_every_mesh() {
    let parameters = parameters();
    let extent = |size: &str, group: &str| {
        let made = surface(&parameters, parameters.size[size]).unwrap();
        let own = made.surfaces.iter().find(|own| own.name == group).unwrap();
        let points = own
            .triangles
            .iter()
            .flat_map(|t| made.triangles[*t as usize])
            .map(|v| made.vertices[v as usize]);
        // Along the wing for elevons, up for rudders.
        let along = points.map(|p| {
            if group.starts_with("elevon") {
                p.y
            } else {
                p.z
            }
        });
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        })
    };
    for group in ["elevon_r", "rudder_r"] {
        let coarse = extent("3k", group);
        for size in ["10k", "34k"] {
            let fine = extent(size, group);
            println!("{group}: {coarse:.5?} m on 3k, {fine:.5?} m on {size}");
            let off = [0, 1].map(|end| (coarse[end] - fine[end]).abs());
            assert!(off.iter().all(|off| *off < 1e-9), "{off:?}");
        }
    }
}

/// Distance of a point from a triangle.
fn distance(p: &Vec3, [a, b, c]: &[Vec3; 3]) -> f64 {
    let to_edge = |a: &Vec3, b: &Vec3| {
        let side = b - a;
        let part = ((p - a).dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
        (a + part * side - p).norm()
    };
    let normal = (b - a).cross(&(c - a));
    let is_inside = [(a, b), (b, c), (c, a)]
        .iter()
        .all(|(a, b)| (*b - *a).cross(&(p - *a)).dot(&normal) >= 0.0);
    if is_inside {
        return (p - a).dot(&normal).abs() / normal.norm();
    }
    to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a))
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
