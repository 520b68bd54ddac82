//! The commands in order, the cache between them, and what they write.

#![allow(
    clippy::unwrap_used,
    reason = "the helpers of these tests unwrap as the tests do"
)]

mod cli_support;

use cli_support::{Place, errors, output, wing_place};
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::path::Path;

fn parsed(place: &Place, name: &str) -> Value {
    serde_json::from_str(&place.read(name)).unwrap()
}

/// Reference file of the classic section: mass, stiffness and Q by the exact
/// Theodorsen function, the flutter speed found with thirty digits.
fn section() -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("data")
        .join("stability_section2_theodorsen.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// The samples of the reference in the exchange format.
fn forces(section: &Value) -> Value {
    let point = |sample: &Value| {
        let part = |name: &str, i: usize, j: usize| sample[name][i][j].clone();
        let entry = |i, j| json!([part("re", i, j), part("im", i, j)]);
        let row = |i| json!([entry(i, 0), entry(i, 1)]);
        json!({"g": sample["g"], "k": sample["k"], "q": [row(0), row(1)]})
    };
    let points: Vec<Value> = section["Q_samples"]
        .as_array()
        .unwrap()
        .iter()
        .map(point)
        .collect();
    json!({
        "schema": "fladder.gaf/1", "mach": 0.0, "semichord": 1.0,
        "modes": ["plunge", "pitch"], "frames": ["inertial", "inertial"], "points": points,
    })
}

/// The section's equation [M U² p² + K − U²/(2πμ) Q] x = 0 is that of the
/// program for b = 1 and ρ = 1/(πμ); speeds are then U/(b ω_α).
#[test]
fn flutter_of_the_classic_section_is_found_from_a_file_of_forces() {
    let section = section();
    let density = 1.0 / (PI * section["mu"].as_f64().unwrap());
    let (mass, stiffness) = (&section["M"], &section["K"]);
    let place = Place::new();
    place.write("q.json", forces(&section).to_string()).write(
        "section.toml",
        format!(
            "[reference]\nsemichord = 1.0\n[flow]\ndensity = {density}\n\
             [structure.matrices]\nmass = {mass}\nstiffness = {stiffness}\n\
             [gaf]\nfile = \"q.json\"\n\
             [stability]\nspeed = {{ from = 1.0, to = 2.6, count = 33 }}\n"
        ),
    );
    let run = place
        .run(&["sweep", "section.toml", "--json", "s.json"])
        .code(0);
    assert!(
        output(&run).contains("flutter at 2.18 m/s"),
        "{}",
        output(&run)
    );
    let found = parsed(&place, "s.json");
    let truth = section["flutter"][0]["U"].as_f64().unwrap();
    for method in ["p2", "polished", "pk"] {
        let speed = found["methods"][method]["flutter"][0]["speed"]
            .as_f64()
            .unwrap();
        assert!(
            (speed - truth).abs() < 1e-3,
            "{method}: {speed} instead of {truth}"
        );
    }
    assert_eq!(found["schema"], "fladder.stability/1");
}

#[test]
fn a_run_leaves_a_report_and_the_second_is_the_same_from_the_cache() {
    let place = wing_place();
    let first = output(&place.run(&["run", "wing.toml"]).code(0));
    assert!(
        first.contains("computed in") && first.contains("flutter at"),
        "{first}"
    );
    let names = [
        "gaf.json",
        "flutter.json",
        "roots.csv",
        "root_locus.svg",
        "vgf.svg",
    ];
    let read = |folder: &str| names.map(|name| place.read(&format!("{folder}/{name}")));
    let cold = read("results/wing");
    // The page tells how long it took, so it is not the same twice.
    let page = place.read("results/wing/report.html");
    assert!(page.contains("flutter at") && page.ends_with("</html>\n"));
    let second = place
        .run(&["run", "wing.toml", "--out", "again", "--threads", "1"])
        .code(0);
    assert!(
        output(&second).contains("from the cache"),
        "{}",
        output(&second)
    );
    assert!(
        cold == read("again"),
        "the results of the second run differ"
    );
    place
        .run(&["sweep", "wing.toml", "--json", "sweep.json", "-q"])
        .code(0);
    assert_eq!(place.read("sweep.json"), cold[1]);
    for text in [&cold[0], &cold[1]] {
        assert!(!text.contains("NaN") && !text.contains("wing.toml"));
    }
}

#[test]
fn branches_have_arrays_of_one_length_and_k_is_never_negative() {
    let place = wing_place();
    place.run(&["run", "wing.toml", "-q"]).code(0);
    let found = parsed(&place, "results/wing/flutter.json");
    for method in ["p2", "polished", "pk"] {
        let result = &found["methods"][method];
        assert_eq!(result["zero_roots"].as_array().unwrap().len(), 13);
        let mut names = Vec::new();
        for branch in result["branches"].as_array().unwrap() {
            let length = branch["speed"].as_array().unwrap().len();
            for array in ["g", "k", "sigma", "omega", "frequency_hz", "damping_ratio"] {
                assert_eq!(branch[array].as_array().unwrap().len(), length, "{array}");
            }
            let k = branch["k"].as_array().unwrap();
            assert!(k.iter().all(|value| value.as_f64().unwrap() >= 0.0));
            names.push(branch["name"].as_str().unwrap().to_owned());
        }
        names.sort();
        names.dedup();
        assert_eq!(names.len(), result["branches"].as_array().unwrap().len());
    }
}

#[test]
fn one_thread_and_two_compute_the_same_bits() {
    let place = wing_place();
    for threads in ["1", "2"] {
        let cache = format!("cache{threads}");
        let json = format!("q{threads}.json");
        let arguments = [
            "gaf",
            "wing.toml",
            "-q",
            "--cache",
            &cache,
            "--json",
            &json,
            "--threads",
            threads,
        ];
        place.run(&arguments).code(0);
    }
    assert_eq!(place.read("q1.json"), place.read("q2.json"));
}

#[test]
fn a_sweep_computes_no_forces_and_says_how_to_make_them() {
    let place = wing_place();
    let text = place.refused(&["sweep", "wing.toml"]);
    assert!(
        text.contains("not in the cache") && text.contains("fladder gaf wing.toml"),
        "{text}"
    );
    assert!(!place.path(".fladder").exists());
    // Overrides enter the key.
    place
        .run(&["gaf", "wing.toml", "-q", "--set", "flow.alpha_deg=2"])
        .code(0);
    place.refused(&["sweep", "wing.toml"]);
    place
        .run(&["sweep", "wing.toml", "-q", "--set", "flow.alpha_deg=2"])
        .code(0);
}

#[test]
fn names_do_not_enter_the_key() {
    let place = wing_place();
    place.run(&["gaf", "wing.toml", "-q"]).code(0);
    place
        .run(&[
            "sweep",
            "wing.toml",
            "-q",
            "--set",
            "modes.analytic.0.name=heave",
        ])
        .code(0);
}

#[test]
fn q_is_evaluated_at_any_point() {
    let place = wing_place();
    let points = ["-0.1,0.2", "0.05,-0.3", "0.05,0.3", "0.0,0.0"];
    let mut arguments = vec!["gaf", "wing.toml", "-q", "--json", "q.json"];
    for point in &points {
        arguments.extend(["--at", point]);
    }
    place.run(&arguments).code(0);
    let found = parsed(&place, "q.json");
    let points = found["points"].as_array().unwrap();
    assert_eq!(points.len(), 4);
    assert_eq!(
        (points[0]["g"].as_f64(), points[0]["k"].as_f64()),
        (Some(-0.1), Some(0.2))
    );
    let part = |point: usize, part: usize| points[point]["q"][0][1][part].as_f64().unwrap();
    assert_eq!((part(1, 0), part(1, 1)), (part(2, 0), -part(2, 1)));
    assert_eq!(part(3, 1), 0.0);
}

fn only_entry(place: &Place) -> std::path::PathBuf {
    let folder = place.path(".fladder/gaf");
    let mut entries = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    entries
        .find(|path| path.extension().is_some_and(|e| e == "gaf"))
        .expect("one entry")
}

#[test]
fn a_damaged_entry_is_found_moved_away_and_computed_again() {
    let place = wing_place();
    place.run(&["gaf", "wing.toml", "-q"]).code(0);
    place.run(&["cache", "verify", "wing.toml"]).code(0);
    let listed = output(&place.run(&["cache", "list", "wing.toml"]).code(0));
    assert!(
        listed.contains("modes") && !listed.contains("bad"),
        "{listed}"
    );
    let entry = only_entry(&place);
    let mut bytes = std::fs::read(&entry).unwrap();
    let whole = bytes.clone();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 4;
    std::fs::remove_file(&entry).unwrap();
    std::fs::write(&entry, &bytes).unwrap();
    let verified = place.run(&["cache", "verify", "wing.toml"]).code(4);
    assert!(
        output(&verified).contains("checksum"),
        "{}",
        output(&verified)
    );
    let text = place.refused(&["sweep", "wing.toml", "-q"]);
    assert!(text.contains("checksum"), "{text}");
    place.run(&["run", "wing.toml", "-q"]).code(0);
    assert_eq!(std::fs::read(only_entry(&place)).unwrap(), whole);
    place.run(&["cache", "prune", "wing.toml"]).code(0);
    place.run(&["cache", "verify", "wing.toml"]).code(0);
    assert!(only_entry(&place).is_file());
}

#[test]
fn every_truncation_of_an_entry_is_refused() {
    let place = wing_place();
    place.run(&["gaf", "wing.toml", "-q"]).code(0);
    let entry = only_entry(&place);
    let whole = std::fs::read(&entry).unwrap();
    for part in 0..12 {
        let length = whole.len() * part / 12;
        std::fs::remove_file(&entry).unwrap_or_default();
        std::fs::write(&entry, &whole[..length]).unwrap();
        let refused = place.run(&["cache", "verify", "wing.toml"]).code(4);
        assert!(
            output(&refused).contains("BAD"),
            "{length} bytes: {}",
            output(&refused)
        );
    }
}

#[test]
fn a_cache_that_cannot_be_made_costs_a_warning_and_nothing_else() {
    let place = wing_place();
    place.write("file", "");
    let run = place
        .run(&["gaf", "wing.toml", "--cache", "file/gaf"])
        .code(0);
    assert_eq!(
        errors(&run).matches("warning:").count(),
        1,
        "{}",
        errors(&run)
    );
}

#[test]
fn a_results_folder_that_cannot_be_made_is_an_output_failure() {
    let place = wing_place();
    place.write("file", "");
    let run = place
        .run(&["run", "wing.toml", "--out", "file/out"])
        .code(4);
    assert!(errors(&run).contains("file/out"), "{}", errors(&run));
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_ends_with_130_and_goes_on_when_repeated() {
    let place = wing_place();
    let case = place
        .read("wing.toml")
        .replace("count = 13", "count = 20000");
    place.write("wing.toml", case);
    let command = place.command(&["run", "wing.toml", "-q"]);
    let child = std::process::Command::new(command.get_program())
        .args(command.get_args())
        .current_dir(place.path(""))
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let started = std::time::Instant::now();
    while started.elapsed().as_secs() < 60 && !place.path("results/wing/gaf.json").exists() {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let id = child.id().to_string();
    assert!(
        std::process::Command::new("kill")
            .args(["-INT", &id])
            .status()
            .unwrap()
            .success()
    );
    let ended = child.wait_with_output().unwrap();
    assert_eq!(
        ended.status.code(),
        Some(130),
        "{}",
        String::from_utf8_lossy(&ended.stderr)
    );
    place.run(&["cache", "verify", "wing.toml"]).code(0);
    place
        .run(&[
            "sweep",
            "wing.toml",
            "-q",
            "--set",
            "stability.speed=[20.0, 30.0]",
        ])
        .code(0);
}
