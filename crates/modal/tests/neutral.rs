//! The neutral JSON file.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use common::{file, mode};
use fladder_mesh::Vec3;
use fladder_modal::{
    Format, Inertia, ModalResult, NamedSet, ReadError, RigidBody, read_structure, write_neutral,
};

fn whole() -> ModalResult {
    let mut result = common::wing().result();
    let count = result.nodes.len();
    let shape = |k: f64| {
        (0..count)
            .map(|n| Vec3::new(k, n as f64 / 3.0, 0.1 * k))
            .collect()
    };
    let mut first = mode(1, 0.0, 1.0, shape(1.0));
    first.eigenvalue = -3.0e-5;
    first.generalised_stiffness = -3.0e-5;
    first.participation = Some(Vec3::new(1.0, 2.0, 3.0));
    let mut second = mode(4, 7.5, 2.5, shape(0.3));
    second.rotation = Some(shape(0.7));
    result.modes = vec![first, second];
    result.node_sets = vec![NamedSet {
        name: "TIP".to_owned(),
        members: vec![1, 5],
    }];
    let inertia = Inertia {
        xx: 1.0,
        yy: 2.0,
        zz: 2.5,
        xz: 0.1,
    };
    result.stated_mass = Some(RigidBody {
        mass: 3.0,
        cg: Vec3::new(0.1, 0.0, 0.2),
        inertia,
    });
    result.format = Format::Neutral;
    result
}

fn text(result: &ModalResult) -> String {
    let mut bytes = Vec::new();
    write_neutral(result, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

fn read(folder: &str, content: impl AsRef<[u8]>) -> Result<ModalResult, ReadError> {
    read_structure(&file(folder, "model.json", content), None, None)
}

#[test]
fn a_written_result_is_read_back_bit_for_bit() {
    assert_eq!(read("neutral", text(&whole())).unwrap(), whole());
}

#[test]
fn a_file_cut_short_anywhere_is_refused() {
    let text = text(&whole());
    for length in (0..text.len()).step_by(101) {
        let failed = read("neutral_cut", &text[..length]).unwrap_err();
        assert!(
            matches!(failed, ReadError::Truncated { .. }),
            "{length}: {failed}"
        );
    }
}

#[test]
fn faults_are_refused_by_name() {
    let text = text(&whole());
    let refused = |content: String, words: &str| {
        let message = read("neutral_fault", content).unwrap_err().to_string();
        println!("{message}");
        assert!(message.contains(words), "{words:?} is not in: {message}");
    };
    refused(
        text.replacen("\"frequency_hz\"", "\"frequency\"", 1),
        "unknown field `frequency`",
    );
    refused(
        text.replacen("structure/1", "structure/9", 1),
        "schema \"fladder.structure/9\"",
    );
    refused(
        text.replacen("\"kind\":\"quad8\"", "\"kind\":\"quad9\"", 1),
        "unknown kind \"quad9\"",
    );
    refused(
        text.replacen("\"kind\":\"quad8\"", "\"kind\":\"quad4\"", 1),
        "has 8 nodes and needs 4",
    );
    refused(
        text.replacen("{\"id\":2,", "{\"id\":1,", 1),
        "node 1 appears twice",
    );
    refused(
        text.replacen("\"generalised_mass\":2.5", "\"generalised_mass\":-2.5", 1),
        "mode 4",
    );
    refused(
        text.replacen("\"frequency_hz\":7.5", "\"frequency_hz\":1e999", 1),
        "out of range",
    );
    refused(
        text.replacen("[0.3,0.0,0.03]", "[0.3,0.0]", 1),
        "invalid length 2",
    );
    let mut short = whole();
    short.modes[1].displacement.pop();
    let nodes = short.nodes.len();
    refused(
        self::text(&short),
        &format!("mode 4 has {} vectors on {nodes} nodes", nodes - 1),
    );
    let mut none = whole();
    none.modes.clear();
    refused(self::text(&none), "it holds no mode");
}

#[test]
fn defaults_stand_for_what_is_left_out() {
    let text = r#"{"schema": "fladder.structure/1",
        "nodes": [{"id": 3, "position": [0, 0, 1]}, {"id": 1, "position": [2, 0, 0]}],
        "modes": [{"index": 1, "frequency_hz": 0.5, "displacement": [[0, 0, 1], [0, 0, 2]]}]}"#;
    let read = read("neutral_small", text).unwrap();
    // Nodes come by ascending number, shapes with them.
    assert_eq!(read.nodes[0].id, 1);
    assert_eq!(
        read.modes[0].displacement,
        [Vec3::new(0.0, 0.0, 2.0), Vec3::new(0.0, 0.0, 1.0)]
    );
    assert_eq!(read.modes[0].generalised_mass, 1.0);
    let omega_squared = std::f64::consts::PI.powi(2);
    assert!((read.modes[0].generalised_stiffness / omega_squared - 1.0).abs() < 1e-15);
    assert!(
        read.notes
            .iter()
            .any(|note| note.contains("count as mass-normalised"))
    );
}
