//! `fladder modes`, changes of a structure by keys, and control surfaces.

#![allow(
    clippy::unwrap_used,
    reason = "the helpers of these tests unwrap as the tests do"
)]

mod cli_support;

use cli_support::{Place, obj, output, small_wing};
use fladder_mesh::read::read_mesh;
use serde_json::Value;
use std::path::{Path, PathBuf};

fn aircraft() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/scaneagle")
}

/// First number behind a name at the start of a line.
fn frequency(text: &str, mode: &str) -> f64 {
    let line = text
        .lines()
        .find(|line| line.trim_start().starts_with(&format!("{mode} ")));
    let words = line.unwrap().split_whitespace().nth(1);
    words.unwrap().parse().unwrap()
}

#[test]
fn a_case_shows_file_modes_and_errors_and_draws_them() {
    let place = Place::new();
    let case = aircraft();
    let case = case.to_str().unwrap();
    let said = output(
        &place
            .run(&["modes", case, "--vtu", "views", "--json", "m.json"])
            .code(0),
    );
    for words in [
        "from its rigid modes: mass 18.113",
        "largest error on the skin [%]",
        "nearest face",
    ] {
        assert!(said.contains(words), "{words} in\n{said}");
    }
    let found: Value = serde_json::from_str(&place.read("m.json")).unwrap();
    assert_eq!(found["schema"], "fladder.modes/1");
    assert_eq!(found["modes"].as_array().unwrap().len(), 26);
    assert!((found["recovered"]["inertia"]["xz"].as_f64().unwrap() - 0.0079).abs() < 1e-5);
    assert_eq!(found["stated"], Value::Null);
    let stiffness = found["modes"][6]["generalised_stiffness"].as_f64().unwrap();
    assert!((stiffness.sqrt() / std::f64::consts::TAU - 7.701_07).abs() < 1e-4);
    let surface = read_mesh(place.path("views/surface_modes.vtu"), 1.0).unwrap();
    assert_eq!(surface.triangles.len(), 3532);
    let structure = read_mesh(place.path("views/structure_modes.vtu"), 1.0).unwrap();
    // Outer skins alone: 1104 elements of eight nodes, 24 of six at nose and tail.
    assert_eq!(structure.triangles.len(), 6 * 1104 + 4 * 24);
    assert!(
        place
            .read("views/elastic_20.svg")
            .contains("elastic:20, 129.90 Hz")
    );
    // The file alone, in its own units.
    let file = aircraft().join("modes.frd.gz");
    let said = output(
        &place
            .run(&["modes", file.to_str().unwrap(), "--vtu", "file"])
            .code(0),
    );
    assert!(said.contains("26 modes") && place.path("file/structure_modes.vtu").is_file());
}

#[test]
fn modes_that_the_surface_does_not_follow_are_refused_unless_told() {
    let place = Place::new();
    let case = aircraft();
    let case = case.to_str().unwrap();
    let limit = "structure.transfer_limit=0.009";
    let text = place.refused(&["check", case, "--set", limit]);
    for words in [
        "elastic:15",
        "0.9 % of its largest displacement, 0.9",
        "above that: elastic:15 (0.9 %)",
        "node",
        "structure.transfer_limit",
    ] {
        assert!(text.contains(words), "{words} in\n{text}");
    }
    place
        .run(&[
            "modes",
            case,
            "--set",
            limit,
            "--set",
            "structure.modes=[1,14]",
        ])
        .code(0);
}

#[test]
fn keys_change_hinges_masses_and_frequencies() {
    let place = Place::new();
    let case = aircraft();
    let case = case.to_str().unwrap();
    let hinges = "structure.hinge=[{name=\"r\",stiffness_change=-2.5,node=4017,direction=\"x\"},\
                  {name=\"l\",stiffness_change=-2.5,node=4055,direction=\"x\"}]";
    let over = "structure.override=[{mode=1,frequency_hz=8.0}]";
    let said = output(
        &place
            .run(&["modes", case, "--set", hinges, "--set", over])
            .code(0),
    );
    assert_eq!(frequency(&said, "elastic:1"), 8.0);
    assert!(frequency(&said, "elastic:13") < 70.0, "{said}");
    let mass = "structure.added_mass=[{name=\"camera\",mass=0.5,position=[0.05,0.0,0.0]}]";
    let said = output(&place.run(&["modes", case, "--set", mass]).code(0));
    assert!(said.contains("rigid body: 18.6138 kg"), "{said}");
    assert!(
        said.contains("the file's own rigid modes give 18.1138 kg"),
        "{said}"
    );
    for (set, words) in [
        ("structure.transfer=nearest", "polyharmonic"),
        (
            "structure.override=[{mode=40,frequency_hz=8.0}]",
            "elastic mode 40 is not there",
        ),
        (
            "structure.hinge=[{name=\"r\",stiffness_change=1.0}]",
            "control, base",
        ),
        ("structure.transfr=faces", "`structure.transfer`"),
        ("structure.transfer={wing=\"faces\"}", "wing_r"),
    ] {
        let text = place.refused(&["modes", case, "--set", set]);
        assert!(text.contains(words), "{words} in\n{text}");
    }
}

/// The small wing with its rear quarter as the group `flap`.
fn wing_with_flap() -> String {
    let mesh = small_wing();
    let text = obj(&mesh);
    let is_flap = |t: usize| mesh.corners(t).iter().all(|p| p.x > 0.7);
    let faces: Vec<&str> = text.lines().filter(|line| line.starts_with('f')).collect();
    let vertices = text.lines().filter(|line| line.starts_with('v'));
    let mut lines: Vec<&str> = vertices.collect();
    for (name, wanted) in [("g wing", false), ("g flap", true)] {
        lines.push(name);
        lines.extend(
            (0..faces.len())
                .filter(|t| is_flap(*t) == wanted)
                .map(|t| faces[t]),
        );
    }
    lines.join("\n") + "\n"
}

/// By its keys a control is the analytic rotation of its group.
#[test]
fn a_control_is_the_rotation_of_its_group() {
    let place = Place::new();
    place.write("wing.obj", wing_with_flap());
    let forces = |key: &str, shape: &str| {
        let case = format!(
            "[reference]\nsemichord = 0.5\n[mesh]\nfile = \"wing.obj\"\n[gaf]\nk = [0.0, 0.1]\n\
             [[modes.{key}]]\nname = \"flap\"\ngroup = \"flap\"\n\
             {shape} = {{ axis = [0.0, 1.0, 0.0], point = [0.75, 0.0, 0.0] }}\n"
        );
        let name = format!("{key}.toml");
        place.write(&name, case);
        place
            .run(&["gaf", &name, "--json", "gaf.json", "-q"])
            .code(0);
        place.read("gaf.json")
    };
    let control = forces("control", "hinge");
    assert_eq!(control, forces("analytic", "rotation"));
    let found: Value = serde_json::from_str(&control).unwrap();
    assert!(found["points"][0]["q"][0][0][0].as_f64().unwrap().abs() > 1e-3);
    let text = place.refused(&[
        "check",
        "control.toml",
        "--set",
        "modes.control.0.group=flaps",
    ]);
    assert!(text.contains("no surface group `flaps`"), "{text}");
    let axis = "modes.control.0.hinge.axis=[0.0,0.0,0.0]";
    let text = place.refused(&["check", "control.toml", "--set", axis]);
    assert!(
        text.contains("where: --set modes.control.0.hinge.axis") && text.contains("no length"),
        "{text}"
    );
}
