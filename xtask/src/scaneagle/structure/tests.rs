//! The model before CalculiX sees it.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Read;
use std::path::Path;

use libm::{cos, sin};

use super::deck::deck;
use super::frame::Frame;
use super::mesh::PORT;
use super::model::Model;
use super::solver::solve;
use super::table::Table;
use super::{CASE, TABLE};
use crate::scaneagle::params::Parameters;

fn tables() -> (Parameters, Table) {
    let parameters = Parameters::read(Path::new(crate::scaneagle::TABLE)).unwrap();
    (parameters, Table::read(Path::new(TABLE)).unwrap())
}

fn model(refine: usize) -> Model {
    let (parameters, table) = tables();
    Model::new(&parameters, &table, refine).unwrap()
}

/// The input in the case's folder is what the tables make, byte by byte.
#[test]
fn the_input_of_the_case_comes_out_again() {
    let made = deck(&model(1));
    assert!(made == deck(&model(1)));
    let mut there = String::new();
    let file = std::fs::File::open(Path::new(CASE).join("modes.inp.gz")).unwrap();
    flate2::read::GzDecoder::new(file)
        .read_to_string(&mut there)
        .unwrap();
    let differs = made.lines().zip(there.lines()).find(|(a, b)| a != b);
    assert!(made == there, "first difference: {differs:?}");
}

/// Elements have nodes that are there, each once, and every node has an element.
#[test]
fn elements_and_nodes_belong_together() {
    let model = model(1);
    let mut used = BTreeSet::new();
    for cell in &model.mesh.cells {
        assert!(cell.len() == 8 || cell.len() == 6);
        let nodes: BTreeSet<usize> = cell.iter().copied().collect();
        assert_eq!(nodes.len(), cell.len(), "{cell:?}");
        used.extend(nodes);
    }
    let all: BTreeSet<usize> = (1..=model.mesh.nodes.len()).collect();
    assert_eq!(used, all);
    let count: usize = model.mesh.sets.values().map(Vec::len).sum();
    assert_eq!(count, model.mesh.cells.len());
    let joints = &model.joints;
    let last = model.mesh.nodes.len() + joints.nodes.len();
    let named = joints
        .rigid
        .iter()
        .flat_map(|rigid| {
            rigid
                .nodes
                .iter()
                .chain([&rigid.reference, &rigid.rotation])
        })
        .chain(joints.equations.iter().flatten().map(|(node, ..)| node));
    for node in named {
        assert!((1..=last).contains(node));
    }
}

/// Port is the mirror image of starboard, bit by bit.
#[test]
fn halves_are_images() {
    let model = model(1);
    let bits = |side: f64| -> BTreeSet<[u64; 3]> {
        let nodes = model.mesh.nodes.iter().filter(|node| node.y * side > 0.0);
        nodes
            .map(|node| [node.x, node.y * side, node.z].map(f64::to_bits))
            .collect()
    };
    assert_eq!(bits(1.0), bits(-1.0));
    for (set, cells) in &model.mesh.sets {
        if let Some(name) = set.strip_suffix(PORT) {
            assert_eq!(cells.len(), model.mesh.sets[name].len(), "{set}");
        }
    }
}

/// Hinges lie on the hinge line at the table's parts of the span, with three ties at the first
/// and two at the others, on both sides alike.
#[test]
fn hinges_are_where_the_table_says() {
    let (parameters, table) = tables();
    let frame = Frame::new(&parameters, &table).unwrap();
    let model = Model::new(&parameters, &table, 1).unwrap();
    let first = model.mesh.nodes.len() + 1;
    let places: Vec<_> = model
        .joints
        .equations
        .iter()
        .filter(|equation| equation.len() == 2)
        .map(|equation| model.joints.nodes[equation[0].0 - first])
        .collect();
    let mut expected = Vec::new();
    for side in [1.0, -1.0] {
        let ends = [parameters.controls.elevon, frame.wing.rudder()];
        for [a, b] in ends {
            for (number, part) in table.hinges.stations.iter().enumerate() {
                let mut place =
                    frame
                        .wing
                        .point(parameters.controls.hinge, 0.0, a + part * (b - a));
                place.y *= side;
                expected.extend(vec![place; if number == 0 { 3 } else { 2 }]);
            }
        }
    }
    assert_eq!(places, expected);
    let springs: BTreeMap<&str, f64> = model
        .joints
        .springs
        .iter()
        .map(|spring| (&*spring.name, spring.stiffness))
        .collect();
    for side in ["r", "l"] {
        assert_eq!(springs[&*format!("elevon_{side}")], table.elevon.stiffness);
        assert_eq!(springs[&*format!("rudder_{side}")], table.rudder.stiffness);
    }
}

/// A parabola through both ends and the middle of an arc is shorter by this part.
fn arc_error(half_angle: f64) -> f64 {
    let (half, rise) = (sin(half_angle), 1.0 - cos(half_angle));
    let steps = 1000;
    let length: f64 = (0..steps)
        .map(|i| (f64::from(i) + 0.5) / f64::from(steps))
        .map(|part| (half * half + 4.0 * rise * rise * part * part).sqrt() / f64::from(steps))
        .sum();
    1.0 - length / half_angle
}

/// What zones carry does not depend on the elements at all. The shells do no more than the
/// length of a quadratic element on the most curved arc, that of a leading edge: half a circle
/// in four. Every halving takes away most of what is left.
#[test]
fn mass_does_not_depend_on_refinement() {
    let (_, table) = tables();
    let models = [1, 2, 4].map(model);
    let bound = arc_error(std::f64::consts::FRAC_PI_8);
    for set in models[0].masses.keys() {
        let number = set
            .strip_prefix("FUSZ")
            .and_then(|number| number.parse::<usize>().ok());
        let carried = number.map_or(0.0, |number| table.zone[number].mass);
        let [coarse, fine, finest] =
            [0, 1, 2].map(|refined: usize| models[refined].masses[set] - carried);
        let (first, second) = ((coarse / fine - 1.0).abs(), (fine / finest - 1.0).abs());
        println!("{set}: {first:.1e}, then {second:.1e}; bound {bound:.1e}");
        // The caps of the body are one row of triangles, curved both ways.
        assert!(first < bound || ["FUSN", "FUST"].contains(&&**set), "{set}");
        assert!(second < first / 4.0 || second < 1e-9, "{set}");
    }
    let [coarse, _, finest] = models.each_ref().map(|model| model.body.mass);
    let shells = 1.0 - table.zone.iter().map(|zone| zone.mass).sum::<f64>() / finest;
    println!("whole: {:.1e}", (coarse / finest - 1.0).abs());
    assert!((coarse / finest - 1.0).abs() < bound * shells);
}

/// Tables that make no structure are refused by name.
#[test]
fn impossible_structures_are_named() {
    let text = std::fs::read_to_string(TABLE).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let (parameters, _) = tables();
    let refused = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        std::fs::write(&path, text.replacen(from, to, 1)).unwrap();
        match Table::read(&path) {
            Err(error) => error.to_string(),
            Ok(table) => match Model::new(&parameters, &table, 1) {
                Err(error) => error,
                Ok(_) => "accepted".to_owned(),
            },
        }
    };
    assert!(refused("rear_spar = 0.70", "rear_spar = 0.80").contains("must ascend"));
    assert!(refused("rear_spar", "rear_spur").contains("rear_spur"));
    assert!(refused("[\"foam\", 2.0e-3]", "[\"cork\", 2.0e-3]").contains("[material.cork]"));
    assert!(refused("driven = 1", "driven = 4").contains("[hinges]"));
    assert!(refused("{ hinge = 1,", "{ hinge = 7,").contains("elevon.balance"));
    assert!(refused("from = 0.30", "from = 0.20").contains("[[zone]]"));
    assert!(refused("0.53, 0.63]", "0.53, 0.73]").contains("places.stations"));
    assert!(refused("count = 26", "count = 6").contains("modes.count"));
    assert!(refused("ribs = [0.095,", "ribs = [0.1,").contains("places.ribs"));
}

#[test]
fn calculix_missing_is_said_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("no-such-ccx");
    let said = solve(&program, folder.path(), "").unwrap_err().to_string();
    assert!(
        said.contains("calculix-ccx") && said.contains("--ccx"),
        "{said}"
    );
}
