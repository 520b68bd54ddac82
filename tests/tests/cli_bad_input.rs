//! What a user can get wrong: exit code 2, and a message that says what,
//! where, why it matters and what to do.

mod cli_support;

use cli_support::{Place, WING_CASE, obj, output, small_wing, wing_place};
use fladder_mesh::shapes::icosphere;

#[test]
fn a_missing_case_and_a_folder_without_one_are_refused() {
    let place = Place::new();
    assert!(
        place
            .refused(&["run", "nowhere.toml"])
            .contains("nowhere.toml")
    );
    assert!(place.refused(&["run", "."]).contains("holds no case.toml"));
}

#[test]
fn a_missing_mesh_is_named_with_the_line_of_its_key() {
    let place = Place::new();
    place.write("wing.toml", WING_CASE);
    let text = place.refused(&["run", "wing.toml"]);
    assert!(
        text.contains("wing.toml:7") && text.contains("`wing.obj`"),
        "{text}"
    );
}

#[test]
fn a_misspelt_key_is_named_with_its_line_and_a_suggestion() {
    let place = wing_place();
    place.write("wing.toml", WING_CASE.replace("density", "denstiy"));
    let text = place.refused(&["run", "wing.toml"]);
    assert!(
        text.contains("wing.toml:5") && text.contains("`flow.density`"),
        "{text}"
    );
}

#[test]
fn a_misspelt_override_is_named_as_it_was_given() {
    let text = wing_place().refused(&["run", "wing.toml", "--set", "flow.alpha=2"]);
    assert!(
        text.contains("--set flow.alpha=2") && text.contains("`flow.alpha_deg`"),
        "{text}"
    );
}

#[test]
fn wrong_kinds_of_values_are_placed() {
    let place = wing_place();
    place.write(
        "wing.toml",
        WING_CASE.replace("semichord = 0.5", "semichord = \"half\""),
    );
    let text = place.refused(&["run", "wing.toml"]);
    assert!(
        text.contains("wing.toml:3") && text.contains("string"),
        "{text}"
    );
    place.write("wing.toml", WING_CASE.replace("semichord = 0.5", ""));
    let text = place.refused(&["run", "wing.toml"]);
    assert!(
        text.contains("missing field `semichord`") && text.contains("wing.toml:2"),
        "{text}"
    );
}

#[test]
fn values_without_meaning_are_refused_with_their_key() {
    let place = wing_place();
    let cases = [
        ("reference.semichord=0", "reference.semichord"),
        ("flow.mach=0.5", "incompressible"),
        ("flow.altitude=1000", "flow.altitude"),
        ("flow.density=nan", "flow.density"),
        ("gaf.k=[0.0, 0.2, 0.1]", "gaf.k"),
        ("gaf.k=[]", "gaf.k"),
        ("gaf.g=[0.1]", "gaf.g"),
        ("mesh.scale=-1", "mesh.scale"),
        (
            "structure.matrices.mass=[[1.0, 0.0]]",
            "structure.matrices.mass",
        ),
        (
            "structure.matrices.stiffness=[[1.0]]",
            "structure.matrices.stiffness",
        ),
        ("stability.speed=[30.0, 20.0]", "stability.speed"),
        ("stability.speed.count=0", "stability.speed.count"),
        ("modes.analytic.0.name=pitch", "named `pitch`"),
        ("modes.analytic.1.rotation.axis=[0, 0, 0]", "no length"),
        ("flight.trim=level", "rigid_body"),
        ("mesh.symmetry=y", "both sides of y = 0"),
        ("structure.damping=0.02", "structure.damping"),
        ("flow.alpha_deg=steep", "expected a number"),
        ("stability.matched=true", "stability.matched"),
    ];
    for (given, said) in cases {
        let text = place.refused(&["run", "wing.toml", "--set", given]);
        assert!(text.contains(said), "{given}: `{said}` is not in\n{text}");
    }
}

#[test]
fn an_open_mesh_is_refused_with_its_edges_and_the_findings_are_written() {
    let place = wing_place();
    let mut mesh = small_wing();
    mesh.triangles.pop();
    place.write("wing.obj", obj(&mesh));
    let text = place.refused(&["run", "wing.toml"]);
    assert!(
        text.contains("edge ") && text.contains("wing.obj"),
        "{text}"
    );
    let text = place.refused(&["check", "wing.toml", "--json", "check.json"]);
    assert!(text.contains("edge "), "{text}");
    let found: serde_json::Value = serde_json::from_str(&place.read("check.json")).unwrap();
    assert_eq!(found["ok"], false);
    let codes: Vec<&str> = found["faults"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| f["code"].as_str().unwrap())
        .collect();
    assert!(codes.contains(&"open_edge"), "{codes:?}");
}

#[test]
fn a_mesh_without_a_trailing_edge_is_refused_where_a_wake_is_required() {
    let place = wing_place();
    place.write("wing.obj", obj(&icosphere(3)));
    let text = place.refused(&["run", "wing.toml"]);
    assert!(
        text.contains("trailing edge") && text.contains("max_wedge_deg"),
        "{text}"
    );
    place
        .run(&["check", "wing.toml", "--set", "wake.mode=auto"])
        .code(0);
}

#[test]
fn a_truncated_result_file_is_refused() {
    let place = wing_place();
    let case = WING_CASE.replace(
        "[structure.matrices]\nmass = [[40.0, -4.0], [-4.0, 4.0]]\n\
         stiffness = [[40000.0, 0.0], [0.0, 16000.0]]",
        "[structure]\nfile = \"modes.frd.gz\"",
    );
    let cases = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/scaneagle");
    let whole = std::fs::read(cases.join("modes.frd.gz")).unwrap();
    place
        .write("modes.frd.gz", &whole[..whole.len() / 2])
        .write("wing.toml", case);
    let text = place.refused(&["run", "wing.toml"]);
    assert!(text.contains("modes.frd.gz"), "{text}");
    let text = place.refused(&["modes", "modes.frd.gz"]);
    assert!(text.contains("modes.frd.gz"), "{text}");
}

#[test]
fn matrices_must_be_of_the_modes() {
    let place = wing_place();
    let one = "structure.matrices.mass=[[1.0]]";
    let other = "structure.matrices.stiffness=[[1.0]]";
    place
        .run(&["gaf", "wing.toml", "--set", one, "--set", other, "-q"])
        .code(0);
    let text = place.refused(&["sweep", "wing.toml", "--set", one, "--set", other]);
    assert!(text.contains("plunge, pitch"), "{text}");
}

#[test]
fn faults_of_a_file_of_forces_are_placed() {
    let place = Place::new();
    let case = WING_CASE.replace("[mesh]\nfile = \"wing.obj\"\n", "");
    let case = case.split("[[modes").next().unwrap().to_owned()
        + "[gaf]\nfile = \"q.json\"\n[stability]\nspeed = [20.0, 30.0]\n";
    place.write("wing.toml", case);
    assert!(place.refused(&["sweep", "wing.toml"]).contains("q.json"));
    place.write("q.json", "{\"schema\": \"fladder.gaf/1\", \"mach\": 0.0");
    let text = place.refused(&["sweep", "wing.toml"]);
    assert!(text.contains("q.json: line 1"), "{text}");
    place.write("q.json", "{\"schema\": \"fladder.gaf/2\"}");
    assert!(
        place
            .refused(&["sweep", "wing.toml"])
            .contains("fladder.gaf/2")
    );
}

#[test]
fn usage_errors_end_with_code_two_and_a_suggestion() {
    let place = wing_place();
    let typo = place.run(&["sweep", "wing.toml", "--methd", "pk"]).code(2);
    assert!(cli_support::errors(&typo).contains("--method"));
    place.run(&["gaf", "wing.toml", "--at", "1"]).code(2);
    place.run(&["gaf", "wing.toml", "--at", "-0.1,0.0"]).code(2);
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let place = wing_place();
    let command = place.command(&["check", "wing.toml"]);
    let mut child = std::process::Command::new(command.get_program())
        .args(command.get_args())
        .current_dir(place.path(""))
        .stdout(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    assert!(child.wait().unwrap().success());
}

#[test]
fn check_names_mesh_modes_and_cost() {
    let place = wing_place();
    let text = output(
        &place
            .run(&["check", "wing.toml", "--json", "c.json"])
            .code(0),
    );
    assert!(
        text.contains("trailing edge") && text.contains("no errors found"),
        "{text}"
    );
    let found: serde_json::Value = serde_json::from_str(&place.read("c.json")).unwrap();
    assert_eq!(found["schema"], "fladder.check/1");
    assert_eq!(found["ok"], true);
    assert_eq!(found["trailing_edges"].as_array().unwrap().len(), 1);
    assert!((found["trailing_edges"][0]["length"].as_f64().unwrap() - 4.0).abs() < 1e-9);
    assert!(found["estimate"]["memory_bytes"].as_u64().unwrap() > 0);
    assert!(found["wake"]["elements"].as_u64().unwrap() > 0);
    // A mesh by itself is judged with the defaults.
    place.run(&["check", "wing.obj"]).code(0);
}
