//! Files of a run for other programs hold what its JSON holds.

#![allow(
    clippy::unwrap_used,
    reason = "the helpers of these tests unwrap as the tests do"
)]

mod cli_support;

use cli_support::{Place, wing_place};
use npyz::NpyFile;
use npyz::num_complex::Complex64;
use serde_json::Value;
use std::fs;

/// An array of an archive: its shape and its values.
fn array<T: npyz::Deserialize>(place: &Place, file: &str, name: &str) -> (Vec<u64>, Vec<T>) {
    let archive = fs::File::open(place.path(file)).unwrap();
    let mut archive = zip::ZipArchive::new(archive).unwrap();
    let entry = archive.by_name(&format!("{name}.npy")).unwrap();
    let array = NpyFile::new(entry).unwrap();
    (array.shape().to_vec(), array.into_vec().unwrap())
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// Forces of all points, row by row.
fn forces(place: &Place) -> Vec<Vec<[f64; 2]>> {
    let document: Value = serde_json::from_str(&place.read("out/gaf.json")).unwrap();
    let points = document["points"].as_array().unwrap().iter();
    points
        .map(|point| {
            let rows = point["q"].as_array().unwrap().iter();
            rows.flat_map(|row| row.as_array().unwrap())
                .map(|entry| [number(&entry[0]), number(&entry[1])])
                .collect()
        })
        .collect()
}

#[test]
fn files_for_other_programs_hold_the_same_forces() {
    let place = wing_place();
    place
        .run(&["run", "wing.toml", "-q", "--out", "out"])
        .code(0);
    let expected = forces(&place);

    let (shape, values) = array::<Complex64>(&place, "out/gaf.npz", "q");
    assert_eq!(shape, [expected.len() as u64, 2, 2]);
    let flat: Vec<Complex64> = expected
        .iter()
        .flatten()
        .map(|[re, im]| Complex64::new(*re, *im))
        .collect();
    assert_eq!(values, flat);
    let (_, k) = array::<f64>(&place, "out/gaf.npz", "k");
    assert_eq!(k, [0.0, 0.05, 0.1, 0.2, 0.4, 0.8, 1.5]);

    let matrices = fladder_modal::read_op4(&place.path("out/gaf.op4")).unwrap();
    assert_eq!(matrices.len(), expected.len() + 1);
    for (matrix, point) in matrices[1..].iter().zip(&expected) {
        let mut full = vec![[0.0; 2]; 4];
        for (row, column, value) in matrix.entries() {
            full[2 * row + column] = value;
        }
        assert_eq!(&full, point);
    }

    // Two real roots or a pair a mode, and lags: as many as A has rows.
    let (shape, values) = array::<f64>(&place, "out/state_space.npz", "A");
    assert!(values.iter().all(|value| value.is_finite()));
    assert_eq!((shape[0], shape[1]), (3, shape[2]));
    assert_eq!(shape[1] % 2, 0);
    // M, C and K at every point; as many states as modes, rates and lags.
    let (masses, _) = array::<f64>(&place, "out/state_space.npz", "M");
    for name in ["C", "K"] {
        let (others, values) = array::<f64>(&place, "out/state_space.npz", name);
        assert_eq!(others, masses);
        assert!(values.iter().all(|value| value.is_finite()));
    }
    assert_eq!((masses[0], masses[1]), (shape[0], masses[2]));
    let (poles, values) = array::<Complex64>(&place, "out/state_space.npz", "poles");
    assert!(values.iter().all(|pole| pole.re < 0.0 && pole.im >= 0.0));
    let lags: u64 = values.iter().map(|pole| 1 + u64::from(pole.im > 0.0)).sum();
    assert_eq!(poles[0], values.len() as u64);
    assert_eq!(shape[1], masses[1] * (2 + lags));

    let summary = place.read("out/flutter_summary.f06");
    assert_eq!(
        summary.matches("FLUTTER  SUMMARY").count(),
        summary.matches("POINT =").count()
    );
    let frames = place.read("out/flutter_mode.pvd");
    let named = frames.split("file=\"").skip(1);
    for name in named.filter_map(|rest| rest.split('"').next()) {
        assert!(place.path("out").join(name).is_file(), "{name}");
    }
    assert!(place.read("out/crossings.csv").lines().count() > 1);

    // The same bytes again, by `report` from stored forces.
    let files = [
        "gaf.npz",
        "gaf.op4",
        "state_space.npz",
        "flutter_summary.f06",
        "roots.csv",
    ];
    let bytes = |name: &str| fs::read(place.path("out").join(name)).unwrap();
    let before: Vec<Vec<u8>> = files.iter().map(|name| bytes(name)).collect();
    place
        .run(&["report", "wing.toml", "-q", "--out", "out"])
        .code(0);
    for (name, before) in files.iter().zip(before) {
        assert!(bytes(name) == before, "{name}");
    }
}

/// A run without flutter leaves none of an earlier one beside its files.
#[test]
fn files_of_an_earlier_run_do_not_stay() {
    let place = wing_place();
    place
        .run(&["run", "wing.toml", "-q", "--out", "out"])
        .code(0);
    assert!(place.path("out/flutter_mode.pvd").is_file());
    let slow = ["--set", "stability.speed=[5.0, 6.0]"];
    let mut again = vec!["run", "wing.toml", "-q", "--out", "out"];
    again.extend(slow);
    place.run(&again).code(0);
    assert_eq!(place.read("out/crossings.csv").lines().count(), 1);
    let left = fs::read_dir(place.path("out")).unwrap().flatten();
    let names = left.map(|entry| entry.file_name().to_string_lossy().into_owned());
    assert!(
        names
            .filter(|name| name.starts_with("flutter_mode"))
            .count()
            == 0
    );
}

/// `report` computes nothing long, and says what to do.
#[test]
fn a_report_needs_stored_forces() {
    let place = wing_place();
    let text = place.refused(&["report", "wing.toml"]);
    assert!(text.contains("fladder gaf wing.toml"), "{text}");
}

/// A new case runs as it is; nothing is written over.
#[test]
fn a_new_case_runs_as_it_is() {
    let place = Place::new();
    place.run(&["new", "first"]).code(0);
    place.run(&["check", "first"]).code(0);
    place.run(&["run", "first", "-q", "--out", "out"]).code(0);
    let roots: Value = serde_json::from_str(&place.read("out/flutter.json")).unwrap();
    assert!(
        !roots["methods"]["polished"]["flutter"]
            .as_array()
            .unwrap()
            .is_empty()
    );
    assert!(place.read("first/case.toml").contains("title = \"first\""));
    let text = place.refused(&["new", "first"]);
    assert!(text.contains("there already"), "{text}");
    place.refused(&["new", "a\"b"]);
    place.refused(&["new", "a\nb"]);
    place
        .run(&[
            "sweep",
            "first",
            "-q",
            "--set",
            "stability.speed=[10.0, 20.0]",
        ])
        .code(0);
}
