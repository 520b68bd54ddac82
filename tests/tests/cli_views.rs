//! What an engineer is shown of surface, wake, steady loads and derivatives.

#![allow(
    clippy::unwrap_used,
    reason = "the helpers of these tests unwrap as the tests do"
)]

mod cli_support;

use cli_support::{Place, WING_CASE, obj, output, small_wing, wing_place};
use fladder_mesh::read::read_mesh;
use serde_json::{Value, json};

fn parsed(place: &Place, name: &str) -> Value {
    serde_json::from_str(&place.read(name)).unwrap()
}

/// The small wing with its rear quarter as a group, by faces of an OBJ file.
fn wing_with_flap() -> String {
    let mesh = small_wing();
    let all = obj(&mesh);
    let is_flap = |t: usize| mesh.corners(t).iter().all(|p| p.x > 0.7);
    let lines = |kind: char| all.lines().filter(move |line| line.starts_with(kind));
    let mut text: Vec<&str> = lines('v').collect();
    for (name, wanted) in [("g wing", false), ("g flap", true)] {
        text.push(name);
        let faces = lines('f').enumerate();
        text.extend(
            faces
                .filter(|(t, _)| is_flap(*t) == wanted)
                .map(|(_, line)| line),
        );
    }
    text.join("\n") + "\n"
}

#[test]
fn check_draws_surface_trailing_edges_and_wake() {
    let place = wing_place();
    let arguments = [
        "check",
        "wing.toml",
        "--vtu",
        "views",
        "--json",
        "check.json",
    ];
    let said = output(&place.run(&arguments).code(0));
    let found = parsed(&place, "check.json");
    assert_eq!(found["trailing_edges"][0]["ends"], json!(["free", "free"]));
    assert!(said.contains("longest row"), "{said}");
    let surface = read_mesh(place.path("views/surface.vtu"), 1.0).unwrap();
    let wing = small_wing();
    assert_eq!(
        (surface.vertices, surface.triangles),
        (wing.vertices, wing.triangles)
    );
    let wake = read_mesh(place.path("views/wake.vtu"), 1.0).unwrap();
    assert_eq!(json!(wake.triangles.len()), found["wake"]["elements"]);
    let last = wake.vertices.iter().map(|p| p.x).fold(0.0, f64::max);
    assert!(last > 1.0, "{last}");
    let edges = std::fs::read(place.path("views/trailing_edges.vtu")).unwrap();
    assert!(String::from_utf8_lossy(&edges).contains("NumberOfCells=\"10\""));
}

#[test]
fn derivatives_are_written_and_change_no_other_result() {
    let place = wing_place();
    place
        .run(&["gaf", "wing.toml", "--json", "plain.json"])
        .code(0);
    let lengths = [
        "--set",
        "reference.area=4",
        "--set",
        "reference.span=4",
        "--set",
        "reference.chord=1",
    ];
    let mut arguments = vec!["gaf", "wing.toml", "--json", "with.json", "--out", "out"];
    arguments.extend(lengths);
    let said = output(&place.run(&arguments).code(0));
    assert!(said.contains("derivatives in stability axes"), "{said}");
    let (plain, with) = (parsed(&place, "plain.json"), parsed(&place, "with.json"));
    assert_eq!(plain["modes"], with["modes"]);
    for (a, b) in plain["points"]
        .as_array()
        .unwrap()
        .iter()
        .zip(with["points"].as_array().unwrap())
    {
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let part = |point: &Value, k: usize| point["q"][i][j][k].as_f64().unwrap();
            for k in 0..2 {
                assert!((part(a, k) - part(b, k)).abs() < 1e-11, "{a} {b}");
            }
        }
    }
    let found = parsed(&place, "out/derivatives.json");
    assert_eq!(found["schema"], "fladder.derivatives/1");
    // Turning by θ in the stream is the same as sinking at θ: both give the same load.
    let sinking = found["body"]["CZw"].as_f64().unwrap();
    let at_rest = plain["points"][0]["q"][0][1][0].as_f64().unwrap() / 4.0;
    println!("CZw {sinking}, force of the pitch at rest {at_rest}");
    assert!((sinking / at_rest + 1.0).abs() < 1e-7);
    assert!(found["stability"]["Clp"].as_f64().unwrap() < 0.0);
    assert!(
        place
            .read("out/derivatives.csv")
            .contains("\nstability,CLa,")
    );
}

#[test]
fn a_mode_of_a_group_is_a_control() {
    let place = Place::new();
    let flap = "[[modes.analytic]]\nname = \"flap\"\ngroup = \"flap\"\n\
                rotation = { axis = [0.0, 1.0, 0.0], point = [0.75, 0.0, 0.0] }\n[gaf]";
    let case = WING_CASE
        .replace(
            "semichord = 0.5",
            "semichord = 0.5\narea = 4\nspan = 4\nchord = 1",
        )
        .replace("[gaf]", flap);
    place
        .write("wing.obj", wing_with_flap())
        .write("flap.toml", &case);
    let said = output(&place.run(&["gaf", "flap.toml", "--out", "out"]).code(0));
    assert!(said.contains("d1: flap"), "{said}");
    let found = parsed(&place, "out/derivatives.json");
    let of = |name: &str| found["stability"][name].as_f64().unwrap();
    // Trailing edge down: more lift, by about 0.6 of the slope, nose down about the nose.
    let effect = of("CLd1") / of("CLa");
    println!("flap effect {effect}");
    assert!((0.5..0.75).contains(&effect));
    assert!(of("Cmd1") < 0.0 && of("Cld1").abs() < 1e-6);
    place.write(
        "wrong.toml",
        case.replace("group = \"flap\"", "group = \"flaps\""),
    );
    let message = place.refused(&["gaf", "wrong.toml"]);
    assert!(
        message.contains("no surface group `flaps`; it has [\"wing\", \"flap\"]"),
        "{message}"
    );
}
