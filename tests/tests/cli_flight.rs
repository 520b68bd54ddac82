//! Level flight, altitude and Mach number in a sweep, from the command line.

#![allow(
    clippy::unwrap_used,
    reason = "the helpers of these tests unwrap as the tests do"
)]

mod cli_support;

use cli_support::{Place, obj, small_wing};
use serde_json::Value;

const SHARED: &str = r"[reference]
semichord = 0.5
[structure.rigid_body]
mass = 60.0
cg = [0.15, 0.0, 0.0]
inertia = { xx = 50.0, yy = 20.0, zz = 65.0, xz = 3.0 }
[flight]
parasite_drag_area = 0.03
induced_drag_factor = 0.02
";

/// A wing with forces of its own, the wake along x.
fn own_case() -> String {
    format!(
        "{SHARED}[flow]\ndensity = 1.225\nalpha_deg = 2.0\n[mesh]\nfile = \"wing.obj\"\n\
         [wake]\ndirection = \"x\"\n[gaf]\n\
         k = [0.0, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.1, 1.5]\n\
         [stability]\nspeed = [30.0, 50.0]\nrefine = \"exact\"\n\
         [[modes.analytic]]\nname = \"camber\"\n\
         polynomial = [ {{ component = \"z\", coefficient = 1.0, powers = [2, 0, 0] }} ]\n"
    )
}

/// The same without its control.
fn rigid_case() -> String {
    let all = own_case();
    all.split("[[modes.analytic]]").next().unwrap().to_owned()
}

/// The same wing with forces from files.
fn given_case(files: &[&str], flow: &str, stability: &str) -> String {
    format!("{SHARED}[flow]\n{flow}\n[gaf]\nfile = {files:?}\n[stability]\n{stability}\n")
}

fn document(place: &Place, name: &str) -> Value {
    serde_json::from_str(&place.read(name)).unwrap()
}

/// A sweep's JSON, computing what is missing.
fn swept(place: &Place, case: &str, set: &[&str]) -> Value {
    let with = |first: &[&str]| {
        let mut all: Vec<String> = first.iter().map(ToString::to_string).collect();
        for set in set {
            all.extend(["--set".to_owned(), (*set).to_owned()]);
        }
        let all: Vec<&str> = all.iter().map(String::as_str).collect();
        place.run(&all).code(0);
    };
    if case == "own.toml" {
        with(&["gaf", case, "-q"]);
    }
    with(&["sweep", case, "-q", "--json", "sweep.json"]);
    document(place, "sweep.json")
}

/// g and k of the refined roots at one speed.
fn roots_at(sweep: &Value, speed: f64) -> Vec<[f64; 2]> {
    let mut roots = Vec::new();
    for branch in sweep["methods"]["polished"]["branches"].as_array().unwrap() {
        for (i, there) in branch["speed"].as_array().unwrap().iter().enumerate() {
            if (there.as_f64().unwrap() - speed).abs() < 1e-9 * speed {
                roots.push(["g", "k"].map(|name| branch[name][i].as_f64().unwrap()));
            }
        }
    }
    roots
}

/// Largest distance of a root of one list from the nearest of the other.
fn distance(ours: &[[f64; 2]], theirs: &[[f64; 2]]) -> f64 {
    assert!(ours.len() >= 3 && ours.len() == theirs.len());
    ours.iter()
        .map(|[g, k]| {
            theirs
                .iter()
                .map(|other| (other[0] - g).hypot(other[1] - k))
                .fold(f64::INFINITY, f64::min)
        })
        .fold(0.0, f64::max)
}

/// Incidence at one speed, degrees.
fn alpha_at(sweep: &Value, speed: f64) -> f64 {
    let modes = sweep["methods"]["polished"]["flight_modes"]
        .as_array()
        .unwrap();
    let there = modes
        .iter()
        .find(|mode| mode["speed"].as_f64() == Some(speed));
    there.unwrap()["alpha_deg"].as_f64().unwrap()
}

/// A trimmed sweep is, at every speed, the sweep at the incidence of that
/// speed; with a control both lift and moment are balanced.
#[test]
fn every_speed_of_level_flight_has_its_own_forces() {
    let place = Place::new();
    place
        .write("wing.obj", obj(&small_wing()))
        .write("own.toml", own_case());
    for control in [&[][..], &["flight.trim_control=camber"]] {
        let mut set = vec!["flight.trim=level"];
        set.extend(control);
        let level = swept(&place, "own.toml", &set);
        for speed in [30.0, 50.0] {
            let alpha = alpha_at(&level, speed);
            let incidence = format!("flow.alpha_deg={alpha}");
            let fixed = swept(&place, "own.toml", &[incidence.as_str()]);
            let apart = distance(&roots_at(&level, speed), &roots_at(&fixed, speed));
            println!("{control:?} {speed} m/s: α = {alpha:.4}°, roots {apart:.1e} apart");
            assert!(apart < 1e-8);
        }
        assert!(alpha_at(&level, 30.0) > 2.0 * alpha_at(&level, 50.0));
    }
    let text = place.refused(&[
        "sweep",
        "own.toml",
        "--set",
        "flight.trim=level",
        "--set",
        "flight.trim_control=elevon",
    ]);
    assert!(
        text.contains("camber") && text.contains("trim_control"),
        "{text}"
    );
    place
        .run(&["gaf", "own.toml", "-q", "--set", "flight.trim=level"])
        .code(0);
    let text = place.refused(&[
        "sweep",
        "own.toml",
        "--set",
        "flight.trim=level",
        "--set",
        "stability.speed=[5.0, 30.0]",
    ]);
    assert!(
        text.contains("no incidence") && text.contains("5.0"),
        "{text}"
    );
}

/// From a file the lift is continued along its slope: close to the incidence
/// that the surface itself gives.
#[test]
fn level_flight_from_a_file_follows_the_slope_of_its_lift() {
    let place = Place::new();
    place
        .write("wing.obj", obj(&small_wing()))
        .write("own.toml", rigid_case());
    place
        .run(&["gaf", "own.toml", "-q", "--json", "q.json"])
        .code(0);
    let level = swept(&place, "own.toml", &["flight.trim=level"]);
    let flow = "density = 1.225";
    let speeds = "speed = [30.0, 50.0]";
    place.write("given.toml", given_case(&["q.json"], flow, speeds));
    let given = swept(&place, "given.toml", &["flight.trim=level"]);
    for speed in [30.0, 50.0] {
        let (own, other) = (alpha_at(&level, speed), alpha_at(&given, speed));
        println!("{speed} m/s: own {own:.4}°, from the file {other:.4}°");
        assert!((own - other).abs() < 0.02 * own.abs());
    }
}

/// A point of an altitude sweep is a point of a plain sweep at the speed and
/// density of the standard atmosphere; Mach numbers that the files do not
/// enclose are refused.
#[test]
fn altitude_and_mach_number_follow_the_standard_atmosphere() {
    let place = Place::new();
    place
        .write("wing.obj", obj(&small_wing()))
        .write("own.toml", rigid_case());
    place
        .run(&["gaf", "own.toml", "-q", "--json", "q.json"])
        .code(0);
    let mut faster = document(&place, "q.json");
    faster["mach"] = 0.4.into();
    for point in faster["points"].as_array_mut().unwrap() {
        for row in point["q"].as_array_mut().unwrap() {
            for entry in row.as_array_mut().unwrap() {
                for part in entry.as_array_mut().unwrap() {
                    *part = (1.1 * part.as_f64().unwrap()).into();
                }
            }
        }
    }
    place.write("fast.json", faster.to_string());

    let over = "altitude = { from = 0.0, to = 8000.0, count = 5 }";
    place.write("altitude.toml", given_case(&["q.json"], "mach = 0.2", over));
    let altitude = swept(&place, "altitude.toml", &[]);
    assert!(altitude["density"].is_null());
    let branch = &altitude["methods"]["polished"]["branches"][0];
    for (i, height) in [0.0, 2000.0, 4000.0, 6000.0, 8000.0]
        .into_iter()
        .enumerate()
    {
        // T = 288.15 − 0.0065 h, p ∝ T^5.25588 (ISO 2533).
        let ratio = 1.0 - 0.0065 * height / 288.15;
        let density = 1.225 * f64::powf(ratio, 4.255_88);
        let sound = 340.294 * f64::sqrt(ratio);
        let value = |name: &str| branch[name][i].as_f64().unwrap();
        assert_eq!(value("altitude"), height);
        assert!((value("density") / density - 1.0).abs() < 1e-4);
        assert!((value("speed") / (0.2 * sound) - 1.0).abs() < 1e-5);
        assert!((value("mach") - 0.2).abs() < 1e-12);
        let (speed, density) = (value("speed"), value("density"));
        let plain = given_case(
            &["q.json"],
            &format!("density = {density}"),
            &format!("speed = [{speed}]"),
        );
        place.write("plain.toml", plain);
        let plain = swept(&place, "plain.toml", &[]);
        let apart = distance(&roots_at(&altitude, speed), &roots_at(&plain, speed));
        println!("{height} m: roots {apart:.1e} apart");
        assert!(apart < 1e-9);
    }
    let said = place.run(&["sweep", "altitude.toml"]).code(0);
    let said = String::from_utf8_lossy(&said.get_output().stdout).into_owned();
    assert!(
        said.contains("M = 0") && said.contains("left out"),
        "{said}"
    );

    let both = &["fast.json", "q.json"];
    let matched = |speeds: &str| {
        let rest = format!("speed = {speeds}\nmatched = true");
        given_case(both, "altitude = 1000.0", &rest)
    };
    place.write("matched.toml", matched("[30.0, 60.0, 90.0, 120.0]"));
    let found = swept(&place, "matched.toml", &[]);
    let branch = &found["methods"]["polished"]["branches"][0];
    let sound = 340.294 * f64::sqrt(1.0 - 6.5 / 288.15);
    let mach = branch["mach"][0].as_f64().unwrap();
    assert!((mach - branch["speed"][0].as_f64().unwrap() / sound).abs() < 1e-5);
    place.write("matched.toml", matched("[30.0, 90.0, 150.0]"));
    let text = place.refused(&["sweep", "matched.toml"]);
    assert!(text.contains("enclose") && text.contains("0.4"), "{text}");
    place.write(
        "matched.toml",
        given_case(
            &["q.json"],
            "density = 1.0",
            "speed = [30.0]\nmatched = true",
        ),
    );
    let text = place.refused(&["sweep", "matched.toml"]);
    assert!(text.contains("flow.altitude"), "{text}");
    place.write(
        "matched.toml",
        given_case(
            &["q.json"],
            "altitude = 0.0",
            "speed = [30.0, 120.0]\nmatched = true",
        ),
    );
    let text = place.refused(&["sweep", "matched.toml"]);
    assert!(text.contains("not extrapolated"), "{text}");
}
