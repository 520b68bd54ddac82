//! One free wing described in two ways has one set of roots.
//!
//! Body quasi-coordinates need the rotation-rate terms C6 and forces that
//! vanish at rest; displacements in axes that do not turn need neither, but
//! carry an incidence with every rotation. Roots are refined on the forces
//! themselves, so that no fit stands between the two. An error in either frame, in a sign
//! or in C6 moves the roots.

#![allow(
    clippy::unwrap_used,
    reason = "the helpers of these tests unwrap as the tests do"
)]

mod cli_support;

use cli_support::{Place, obj, small_wing};
use serde_json::Value;
use std::fmt::Write as _;

const COMMON: &str = r#"[reference]
semichord = 0.5
[flow]
density = 1.225
[mesh]
file = "wing.obj"
[gaf]
k = [0.0, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.1, 1.5]
[stability]
speed = [20.0, 35.0, 50.0]
refine = "exact"
"#;

const MASS: f64 = 60.0;
const INERTIA: [f64; 3] = [50.0, 20.0, 65.0];
const XZ: f64 = 3.0;
const CENTRE: [f64; 3] = [0.15, 0.0, 0.0];

fn body_case() -> String {
    let [xx, yy, zz] = INERTIA;
    format!(
        "{COMMON}[structure.rigid_body]\nmass = {MASS}\ncg = {CENTRE:?}\n\
         inertia = {{ xx = {xx}, yy = {yy}, zz = {zz}, xz = {XZ} }}\n"
    )
}

/// Unit translations and rotations, in axes that do not turn: M is the mass
/// matrix in metres and radians, C and K are zero.
fn inertial_case() -> String {
    let mut mass = [[0.0; 6]; 6];
    for axis in 0..3 {
        mass[axis][axis] = MASS;
        mass[axis + 3][axis + 3] = INERTIA[axis];
    }
    (mass[3][5], mass[5][3]) = (-XZ, -XZ);
    let mut text = format!(
        "{COMMON}[structure.matrices]\nmass = {mass:?}\nstiffness = {:?}\n",
        [[0.0; 6]; 6]
    );
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        let unit: [f64; 3] = std::array::from_fn(|i| if i == axis { 1.0 } else { 0.0 });
        writeln!(
            text,
            "[[modes.analytic]]\nname = \"along {name}\"\ntranslation = {unit:?}"
        )
        .unwrap();
    }
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        let unit: [f64; 3] = std::array::from_fn(|i| if i == axis { 1.0 } else { 0.0 });
        writeln!(
            text,
            "[[modes.analytic]]\nname = \"about {name}\"\n\
             rotation = {{ axis = {unit:?}, point = {CENTRE:?} }}"
        )
        .unwrap();
    }
    text
}

/// Speed, g and k of all refined roots that are not at rest.
fn roots(place: &Place, case: &str) -> Vec<[f64; 3]> {
    let json = format!("{case}.json");
    place
        .run(&["run", &format!("{case}.toml"), "-q", "--method", "p2"])
        .code(0);
    place
        .run(&["sweep", &format!("{case}.toml"), "-q", "--json", &json])
        .code(0);
    let found: Value = serde_json::from_str(&place.read(&json)).unwrap();
    let mut roots = Vec::new();
    for branch in found["methods"]["polished"]["branches"].as_array().unwrap() {
        let value = |name: &str, i: usize| branch[name][i].as_f64().unwrap();
        for i in 0..branch["speed"].as_array().unwrap().len() {
            roots.push([value("speed", i), value("g", i), value("k", i)]);
        }
    }
    roots.retain(|[_, g, k]| g.hypot(*k) > 1e-5);
    roots
}

#[test]
fn body_axes_and_inertial_axes_give_the_same_roots() {
    let place = Place::new();
    place
        .write("wing.obj", obj(&small_wing()))
        .write("body.toml", body_case())
        .write("inertial.toml", inertial_case());
    let (body, inertial) = (roots(&place, "body"), roots(&place, "inertial"));
    assert!(body.len() >= 9, "only {} roots at three speeds", body.len());
    for (name, ours, theirs) in [("body", &body, &inertial), ("inertial", &inertial, &body)] {
        for [speed, g, k] in ours {
            let nearest = theirs
                .iter()
                .filter(|other| other[0] == *speed)
                .map(|other| (other[1] - g).hypot(other[2] - k))
                .fold(f64::INFINITY, f64::min);
            assert!(
                nearest < 1e-6,
                "{name}, {speed} m/s: {g} {k:+}i is {nearest:e} from any other"
            );
        }
    }
}
