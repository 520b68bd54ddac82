//! Forces of a doublet-lattice program, swept without a mesh.

#![allow(
    clippy::unwrap_used,
    reason = "the helpers of these tests unwrap as the tests do"
)]

mod cli_support;

use cli_support::Place;
use serde_json::Value;
use std::path::Path;

fn place() -> Place {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/dlm_wing");
    let place = Place::new();
    for name in ["case.toml", "q.json"] {
        place.write(name, std::fs::read(folder.join(name)).unwrap());
    }
    place
}

/// Refined roots, p2 and p-k agree on where the wing flutters.
#[test]
fn a_lattice_flutters_alike_by_three_methods() {
    let place = place();
    place
        .run(&["sweep", "case.toml", "-q", "--json", "sweep.json"])
        .code(0);
    let found: Value = serde_json::from_str(&place.read("sweep.json")).unwrap();
    let speed = |method: &str| {
        let list = found["methods"][method]["flutter"].as_array().unwrap();
        assert_eq!(list.len(), 1, "{method}");
        list[0]["speed"].as_f64().unwrap()
    };
    let speeds = ["p2", "polished", "pk"].map(speed);
    println!("flutter at {speeds:?} m/s");
    for other in speeds {
        assert!((other / speeds[0] - 1.0).abs() < 1e-4);
    }
    let complete = found["methods"]["polished"]["complete"].as_array().unwrap();
    assert!(complete.iter().all(|met| met.as_bool() == Some(true)));
}

/// Pitch at rest lifts, plunge is damped: the signs of the file.
#[test]
fn the_lattice_has_the_signs_of_the_contract() {
    let file: Value = serde_json::from_str(&place().read("q.json")).unwrap();
    let entry = |point: usize, row: usize, column: usize, part: usize| {
        file["points"][point]["q"][row][column][part]
            .as_f64()
            .unwrap()
    };
    assert!(entry(0, 0, 1, 0) > 0.0);
    assert!(entry(3, 0, 0, 1) < 0.0);
    assert_eq!(entry(0, 0, 0, 0), 0.0);
}

/// Each fault of a file is refused, naming the file and the place.
#[test]
fn faults_of_a_file_are_named() {
    let place = place();
    let good: Value = serde_json::from_str(&place.read("q.json")).unwrap();
    let refused = |change: &dyn Fn(&mut Value), words: &[&str]| {
        let mut file = good.clone();
        change(&mut file);
        place.write("q.json", file.to_string());
        let text = place.refused(&["sweep", "case.toml"]);
        for word in words.iter().chain(&["q.json"]) {
            assert!(text.contains(word), "`{word}` is missing in:\n{text}");
        }
    };
    refused(
        &|file| {
            let mut again = file["points"][3].clone();
            again["q"][1][2][0] = 99.0.into();
            file["points"].as_array_mut().unwrap().push(again);
        },
        &["twice", "row 2", "column 3"],
    );
    refused(
        &|file| {
            let mut other = file["points"][3].clone();
            other["g"] = 0.1.into();
            file["points"].as_array_mut().unwrap().push(other);
        },
        &["hole"],
    );
    refused(
        &|file| {
            for point in file["points"].as_array_mut().unwrap() {
                point["g"] = 0.1.into();
            }
        },
        &["g = 0"],
    );
    refused(
        &|file| {
            file["points"][2]["q"][0].as_array_mut().unwrap().pop();
        },
        &["q"],
    );
    refused(
        &|file| file["points"][2]["q"][0][0][0] = Value::Null,
        &["line"],
    );
    let text = good.to_string().replacen("\"mach\":0.0", "\"mach\":NaN", 1);
    place.write("q.json", text);
    place.refused(&["sweep", "case.toml"]);

    // Another order of the points changes nothing; without k = 0 it is said.
    let mut shuffled = good.clone();
    shuffled["points"].as_array_mut().unwrap().reverse();
    place.write("q.json", shuffled.to_string());
    place
        .run(&["sweep", "case.toml", "-q", "--json", "a.json"])
        .code(0);
    place.write("q.json", good.to_string());
    place
        .run(&["sweep", "case.toml", "-q", "--json", "b.json"])
        .code(0);
    assert!(place.read("a.json") == place.read("b.json"));
    let mut without = good;
    without["points"].as_array_mut().unwrap().remove(0);
    place.write("q.json", without.to_string());
    let said = place.run(&["sweep", "case.toml"]).code(0);
    let said = cli_support::output(&said);
    assert!(said.contains("not pinned"), "{said}");
}
