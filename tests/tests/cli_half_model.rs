//! Half models through the whole chain: half mesh and half structure give what
//! the whole gives, and what is no half is refused.
//!
//! The wing is its own mirror image bit for bit, and so are its modes: nodes and
//! shells of the structure are vertices and triangles of the surface, so that
//! the transfer adds nothing of its own.

#![allow(
    clippy::unwrap_used,
    reason = "the helpers of these tests unwrap as the tests do"
)]

mod cli_support;

use cli_support::{Place, obj};
use fladder_mesh::shapes::{Extent, NacaWing};
use fladder_mesh::{CurveGroup, SurfaceGroup, TriMesh, Vec3, mirrored};
use serde_json::{Value, json};

const CHORD: f64 = 0.25;
const AXIS: f64 = 0.35 * CHORD;

fn wing(extent: Extent) -> TriMesh {
    let wing = NacaWing {
        thickness: 0.12,
        chord: CHORD,
        span: 2.0,
        n_chord: 8,
        n_half_span: 5,
        extent,
        ..NacaWing::default()
    };
    wing.structured().unwrap()
}

/// Bending and torsion of both wings, in phase and in antiphase: frequency in
/// Hz, generalised mass of the whole wing, symmetric or not, shape.
///
/// For each kind the two modes of M = [[0.48, −0.012], [−0.012, 0.00512]] and
/// K = diag(k_b, k_t) in the fields w = y² and θ = |y| about the elastic axis.
struct Mode {
    frequency: f64,
    mass: f64,
    is_symmetric: bool,
    bending: f64,
    torsion: f64,
}

impl Mode {
    fn shape(&self, p: &Vec3) -> Vec3 {
        let side = if self.is_symmetric || p.y == 0.0 {
            1.0
        } else {
            p.y.signum()
        };
        let twist = self.torsion * p.y.abs();
        let z = self.bending * p.y * p.y - twist * (p.x - AXIS);
        Vec3::new(twist * p.z, 0.0, z) * side
    }
}

fn modes() -> Vec<Mode> {
    let (m_b, s, m_t) = (0.48, -0.012, 0.005_12);
    let mut modes = Vec::new();
    for (is_symmetric, k_b, k_t) in [(true, 1200.0, 80.0), (false, 1300.0, 86.0)] {
        // det(K − λ M) = 0, a quadratic in λ = ω².
        let (a, b, c) = (m_b * m_t - s * s, -(m_b * k_t + m_t * k_b), k_b * k_t);
        let root = f64::sqrt(b * b - 4.0 * a * c);
        for lambda in [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)] {
            let (bending, torsion) = (1.0, (k_b - lambda * m_b) / (lambda * s));
            let mass = m_b + 2.0 * s * torsion + m_t * torsion * torsion;
            modes.push(Mode {
                frequency: lambda.sqrt() / std::f64::consts::TAU,
                mass,
                is_symmetric,
                bending,
                torsion,
            });
        }
    }
    modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    modes
}

/// The neutral file of a structure on the vertices of a surface.
fn structure(mesh: &TriMesh, modes: &[&Mode], share: f64) -> String {
    let nodes: Vec<Value> = (1..)
        .zip(&mesh.vertices)
        .map(|(id, p)| json!({"id": id, "position": [p.x, p.y, p.z]}))
        .collect();
    let elements: Vec<Value> = (1..)
        .zip(&mesh.triangles)
        .map(|(id, t)| json!({"id": id, "kind": "tri3", "nodes": t.map(|v| v + 1)}))
        .collect();
    let shapes: Vec<Value> = (1..)
        .zip(modes)
        .map(|(index, mode)| {
            let shape: Vec<[f64; 3]> =
                mesh.vertices.iter().map(|p| mode.shape(p).into()).collect();
            json!({"index": index, "frequency_hz": mode.frequency,
                   "generalised_mass": share * mode.mass, "displacement": shape})
        })
        .collect();
    json!({"schema": "fladder.structure/1", "nodes": nodes, "elements": elements,
           "modes": shapes})
    .to_string()
}

const COMMON: &str = r#"[reference]
semichord = 0.125
[flow]
alpha_deg = 2.0
density = 1.225
[wake]
mode = "required"
[gaf]
k = [0.0, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.1, 1.5]
[stability]
speed = { from = 10.0, to = 50.0, count = 9 }
refine = "exact"
"#;

/// Mass and inertia of the whole wing.
const BODY: &str = "[structure.rigid_body]
mass = 2.4
cg = [0.1, 0.0, 0.01]
inertia = { xx = 0.8, yy = 0.02, zz = 0.81, xz = 0.004 }
";

const FLIGHT: &str = "[flight]
parasite_drag_area = 0.01
induced_drag_factor = 0.1
";

/// Meshes, structures and cases of the whole wing and of its halves.
fn place(more: &str) -> Place {
    let place = Place::new();
    let all = modes();
    let of = |is_symmetric: bool| -> Vec<&Mode> {
        let is_kind = |mode: &&Mode| mode.is_symmetric == is_symmetric;
        all.iter().filter(is_kind).collect()
    };
    let (whole, half) = (wing(Extent::Full), wing(Extent::Half));
    let both: Vec<&Mode> = all.iter().collect();
    place
        .write("whole.obj", obj(&whole))
        .write("half.obj", obj(&half))
        .write("whole.json", structure(&whole, &both, 1.0))
        .write("whole_y.json", structure(&whole, &of(true), 1.0))
        .write("half_y.json", structure(&half, &of(true), 0.5))
        .write("half_-y.json", structure(&half, &of(false), 0.5));
    let case = |mesh: &str, symmetry: &str, structure: &str, is_half: bool| {
        format!(
            "{COMMON}[mesh]\nfile = \"{mesh}.obj\"\nsymmetry = \"{symmetry}\"\n[structure]\n\
             file = \"{structure}.json\"\nhalf = {is_half}\n{more}"
        )
    };
    place
        .write("whole.toml", case("whole", "none", "whole", false))
        .write("whole_y.toml", case("whole", "none", "whole_y", false))
        .write("y.toml", case("half", "y", "half_y", true))
        .write("-y.toml", case("half", "-y", "half_-y", true))
        .write("mixed.toml", case("half", "y", "whole", false));
    place
}

fn results(place: &Place, case: &str) -> Value {
    place.run(&["run", &format!("./{case}.toml"), "-q"]).code(0);
    serde_json::from_str(&place.read(&format!("results/{case}/flutter.json"))).unwrap()
}

/// Speed and frequency of the crossings of one kind.
fn crossings(found: &Value, method: &str, kind: &str) -> Vec<[f64; 2]> {
    let listed = found["methods"][method][kind].as_array().unwrap();
    listed
        .iter()
        .map(|crossing| {
            let value = |key: &str| crossing[key].as_f64().unwrap_or(0.0);
            [value("speed"), value("frequency_hz")]
        })
        .collect()
}

/// Largest relative difference of two lists in order of speed.
fn difference(mut a: Vec<[f64; 2]>, mut b: Vec<[f64; 2]>) -> f64 {
    assert_eq!(a.len(), b.len(), "{a:?}\n{b:?}");
    a.sort_by(|x, y| x[0].total_cmp(&y[0]));
    b.sort_by(|x, y| x[0].total_cmp(&y[0]));
    a.iter()
        .flatten()
        .zip(b.iter().flatten())
        .map(|(x, y)| (x - y).abs() / x.abs().max(y.abs()).max(1.0))
        .fold(0.0, f64::max)
}

#[test]
fn half_mesh_and_half_structure_flutter_at_the_speed_of_the_whole() {
    let place = place("");
    let symmetric_alone = results(&place, "whole_y");
    let [whole, even, odd] = ["whole", "y", "-y"].map(|case| results(&place, case));
    for method in ["p2", "polished", "pk"] {
        for kind in ["flutter", "restabilised"] {
            let of_even = crossings(&even, method, kind);
            let of_odd = crossings(&odd, method, kind);
            if kind == "flutter" {
                assert!(!of_even.is_empty(), "no flutter in {method}");
            }
            let alone = difference(of_even.clone(), crossings(&symmetric_alone, method, kind));
            let together = difference(
                [of_even.clone(), of_odd.clone()].concat(),
                crossings(&whole, method, kind),
            );
            println!(
                "{method} {kind}: y {of_even:?}, -y {of_odd:?}; half against whole {alone:.1e}, \
                 both halves against whole {together:.1e}"
            );
            assert!(alone < 1e-8 && together < 1e-8);
        }
    }
}

/// Speed, g and k of all refined roots that are not at rest, without those on the
/// branch cut's shores far from the origin: which of them are found is not claimed.
fn roots(found: &Value) -> Vec<[f64; 3]> {
    let mut roots = Vec::new();
    for branch in found["methods"]["polished"]["branches"].as_array().unwrap() {
        let value = |name: &str, i: usize| branch[name][i].as_f64().unwrap();
        for i in 0..branch["speed"].as_array().unwrap().len() {
            roots.push([value("speed", i), value("g", i), value("k", i)]);
        }
    }
    roots.retain(|[_, g, k]| g.hypot(*k) > 1e-5 && (*g > -0.1 || *k > 0.02));
    roots
}

/// Three rigid modes each, with gravity, drag, thrust and the lift tilt on
/// those they concern.
#[test]
fn free_halves_have_together_the_roots_of_the_free_whole() {
    let place = place(&format!("{BODY}{FLIGHT}"));
    let [whole, even, odd] = ["whole", "y", "-y"].map(|case| results(&place, case));
    let names = |case: &str| -> Vec<String> {
        let gaf: Value =
            serde_json::from_str(&place.read(&format!("results/{case}/gaf.json"))).unwrap();
        serde_json::from_value(gaf["modes"].clone()).unwrap()
    };
    assert_eq!(
        names("y"),
        [
            "rigid:x",
            "rigid:z",
            "rigid:theta",
            "elastic:1",
            "elastic:2"
        ]
    );
    assert_eq!(
        names("-y"),
        [
            "rigid:y",
            "rigid:phi",
            "rigid:psi",
            "elastic:1",
            "elastic:2"
        ]
    );
    let (of_whole, halves) = (roots(&whole), [roots(&even), roots(&odd)].concat());
    assert!(of_whole.len() > 9 * 6, "{} roots", of_whole.len());
    let mut worst: f64 = 0.0;
    for (ours, theirs) in [(&of_whole, &halves), (&halves, &of_whole)] {
        for [speed, g, k] in ours {
            let nearest = theirs
                .iter()
                .filter(|other| other[0] == *speed)
                .map(|other| (other[1] - g).hypot(other[2] - k))
                .fold(f64::INFINITY, f64::min);
            assert!(
                nearest < 1e-9,
                "{speed} m/s: {g} {k:+}i is {nearest:e} from any other"
            );
            worst = worst.max(nearest);
        }
    }
    println!(
        "{} roots, both halves against whole: {worst:.1e}",
        of_whole.len()
    );
    from_a_file(&place, &even);
}

/// Forces of a half model, read back, are those of three rigid modes.
fn from_a_file(place: &Place, computed: &Value) {
    let common = COMMON
        .replace("refine = \"exact\"\n", "")
        .replace("[gaf]\n", "[gaf]\nfile = \"results/y/gaf.json\"\n");
    let case =
        format!("{common}[structure]\nfile = \"half_y.json\"\nhalf = true\n{BODY}{FLIGHT}");
    place.write("given.toml", case);
    let arguments = [
        "sweep",
        "given.toml",
        "-q",
        "--method",
        "p2",
        "--json",
        "given.roots.json",
    ];
    place.run(&arguments).code(0);
    let given: Value = serde_json::from_str(&place.read("given.roots.json")).unwrap();
    let branches = |found: &Value| found["methods"]["p2"]["branches"].clone();
    assert_eq!(branches(&given), branches(computed));
}

/// Real and imaginary parts of a matrix.
type Matrix = Vec<Vec<[f64; 2]>>;

/// Names of the modes, and Q at every point.
fn q(place: &Place, case: &str, at: &[&str]) -> (Vec<String>, Vec<Matrix>) {
    let (case_file, json) = (format!("./{case}.toml"), format!("./{case}.gaf.json"));
    let mut arguments = vec!["gaf", &case_file, "-q", "--json", &json];
    for point in at {
        arguments.extend(["--at", point]);
    }
    place.run(&arguments).code(0);
    let found: Value = serde_json::from_str(&place.read(&json)).unwrap();
    let points = found["points"].as_array().unwrap();
    let q = |point: &Value| serde_json::from_value(point["q"].clone()).unwrap();
    (
        serde_json::from_value(found["modes"].clone()).unwrap(),
        points.iter().map(q).collect(),
    )
}

/// Largest difference of entries over the largest entry of the whole; `places` are
/// the modes of the half among those of the whole.
fn worst_difference(whole: &[Vec<[f64; 2]>], half: &[Vec<[f64; 2]>], places: &[usize]) -> f64 {
    let size = |entry: &[f64; 2]| entry[0].hypot(entry[1]);
    let scale = whole.iter().flatten().map(size).fold(0.0, f64::max);
    let mut worst: f64 = 0.0;
    for (row, &i) in half.iter().zip(places) {
        for (entry, &j) in row.iter().zip(places) {
            let difference = [0, 1].map(|part| entry[part] - whole[i][j][part]);
            worst = worst.max(size(&difference) / scale);
        }
    }
    worst
}

/// Rigid, elastic and analytic modes of each kind.
#[test]
fn q_of_a_half_model_is_that_of_the_whole() {
    let points = ["0,0", "0,0.3", "0.1,0.8", "-0.05,0.2", "0.2,0"];
    let analytic = |kind: &str| {
        let even = "[[modes.analytic]]\nname = \"flap\"\npolynomial = [\n\
             { component = \"z\", coefficient = 1.0, powers = [1, 1, 0] },\n\
             { component = \"y\", coefficient = 0.2, powers = [0, 1, 1], odd_y = true },\n]\n";
        let odd = "[[modes.analytic]]\nname = \"sway\"\npolynomial = [\n\
             { component = \"z\", coefficient = 1.0, powers = [0, 3, 0], odd_y = true },\n\
             { component = \"y\", coefficient = 0.2, powers = [1, 0, 0] },\n]\n";
        match kind {
            "y" => even.to_owned(),
            "-y" => odd.to_owned(),
            _ => format!("{even}{odd}"),
        }
    };
    let place = place(BODY);
    for (case, kind) in [("whole", "none"), ("y", "y"), ("-y", "-y")] {
        let text = place.read(&format!("{case}.toml")) + &analytic(kind);
        place.write(&format!("{case}.toml"), text);
    }
    let (names, whole) = q(&place, "whole", &points);
    let all = modes();
    for (case, is_symmetric) in [("y", true), ("-y", false)] {
        let (own_names, half) = q(&place, case, &points);
        // Elastic modes are numbered in each file by itself.
        let elastic: Vec<String> = (1..)
            .zip(&all)
            .filter(|(_, mode)| mode.is_symmetric == is_symmetric)
            .map(|(number, _)| format!("elastic:{number}"))
            .collect();
        let place_in_whole: Vec<usize> = own_names
            .iter()
            .map(|name| {
                let number = name.strip_prefix("elastic:");
                let number: Option<usize> = number.map(|n| n.parse().unwrap());
                let name = number.map_or(name, |number| &elastic[number - 1]);
                names.iter().position(|other| other == name).unwrap()
            })
            .collect();
        for (point, (whole, half)) in points.iter().zip(whole.iter().zip(&half)) {
            let worst = worst_difference(whole, half, &place_in_whole);
            println!("{case} at {point}: half against whole {worst:.1e} of max |Q|");
            assert!(worst < 1e-9, "{case} at {point}: {worst:e}");
        }
    }
}

/// A whole structure moves a half mesh too, and its modes of the other kind
/// are left out when asked for.
#[test]
fn a_whole_structure_on_a_half_mesh_gives_the_same_forces() {
    let place = place("");
    let text = place.refused(&["gaf", "mixed.toml"]);
    assert!(
        text.contains("elastic:2") && text.contains("other_symmetry"),
        "{text}"
    );
    let case = place.read("mixed.toml") + "other_symmetry = \"leave-out\"\n";
    place.write("mixed.toml", case);
    let (names, mixed) = q(&place, "mixed", &["0.05,0.4"]);
    assert_eq!(names, ["elastic:1", "elastic:3"]);
    let (_, half) = q(&place, "y", &["0.05,0.4"]);
    for (a, b) in mixed[0].iter().flatten().zip(half[0].iter().flatten()) {
        let error = (a[0] - b[0]).hypot(a[1] - b[1]);
        assert!(error < 1e-12 * b[0].hypot(b[1]).max(1e-3), "{a:?} {b:?}");
    }
}

#[test]
fn what_a_half_model_cannot_carry_is_refused() {
    let place = place("");
    let with = |case: &str, set: &str| place.refused(&["check", case, "--set", set]);
    let text = with("y.toml", "flow.beta_deg=3");
    assert!(text.contains("flow.beta_deg"), "{text}");
    let text = with("y.toml", "mesh.file=whole.obj");
    assert!(text.contains("both sides of y = 0"), "{text}");
    let text = with("y.toml", "mesh.symmetry=none");
    assert!(text.contains("structure.half"), "{text}");
    let mut port = wing(Extent::Half);
    for p in &mut port.vertices {
        *p = mirrored(*p);
    }
    port.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    place.write("port.obj", obj(&port));
    let text = with("y.toml", "mesh.file=port.obj");
    assert!(
        text.contains("lies on y ≤ 0") && text.contains("mirror the file"),
        "{text}"
    );
    let body = place.read("y.toml") + &BODY.replace("[0.1, 0.0, 0.01]", "[0.1, 0.3, 0.01]");
    place.write("body.toml", body);
    let text = place.refused(&["check", "body.toml"]);
    assert!(text.contains("centre of mass is at y = 0.3"), "{text}");
}

#[test]
fn a_mode_of_the_other_symmetry_is_refused_by_name() {
    let place = place("");
    let cases = [
        ("y", "translation = [0.0, 1.0, 0.0]", "antisymmetric"),
        ("-y", "translation = [0.0, 0.0, 1.0]", "symmetric"),
        (
            "y",
            "rotation = { axis = [1.0, 0.0, 0.0], point = [0.0, 0.0, 0.0] }",
            "antisymmetric",
        ),
        ("-y", "translation = [0.0, 1.0, 1.0]", "neither"),
    ];
    for (case, mode, kind) in cases {
        let text = place.read(&format!("{case}.toml"));
        let text = format!("{text}[[modes.analytic]]\nname = \"wrong\"\n{mode}\n");
        place.write("wrong.toml", text);
        let text = place.refused(&["check", "wrong.toml"]);
        assert!(
            text.contains("`wrong`") && text.contains(kind) && text.contains("wrong.toml:"),
            "{text}"
        );
    }
}

/// A fin cut by the plane: half of it carries symmetric motion only.
#[test]
fn a_fin_in_the_plane_needs_the_whole_model_for_antisymmetric_motion() {
    let place = Place::new();
    let mut fin = wing(Extent::Full);
    for p in &mut fin.vertices {
        *p = Vec3::new(p.x, p.z, -p.y);
    }
    let is_starboard = |t: &[u32; 3]| t.iter().all(|v| fin.vertices[*v as usize].y >= 0.0);
    let mut half = fin.clone();
    half.triangles.retain(is_starboard);
    close_tips(&mut half);
    let case = |symmetry: &str, mode: &str| {
        format!(
            "[reference]\nsemichord = 0.125\n[mesh]\nfile = \"fin.obj\"\n\
             symmetry = \"{symmetry}\"\n[gaf]\nk = [0.0, 0.1]\n[[modes.analytic]]\n\
             name = \"mode\"\ntranslation = {mode}\n"
        )
    };
    place
        .write("fin.obj", obj(&half))
        .write("y.toml", case("y", "[0.0, 0.0, 1.0]"))
        .write("-y.toml", case("-y", "[0.0, 1.0, 0.0]"));
    let text = place.refused(&["check", "./-y.toml", "--json", "check.json"]);
    assert!(
        text.contains("central fin") && text.contains("whole aircraft"),
        "{text}"
    );
    let found: Value = serde_json::from_str(&place.read("check.json")).unwrap();
    let faults = found["faults"].as_array().unwrap();
    let is_fin = |fault: &Value| fault["code"] == "plane_trailing_edge";
    assert!(faults.iter().any(is_fin), "{faults:?}");
    assert_eq!(found["symmetry"], "-y");
}

/// Fans from the leading edge over the open tip sections of the half fin.
fn close_tips(half: &mut TriMesh) {
    for side in [-1.0, 1.0] {
        let tip = |v: &u32| (half.vertices[*v as usize].z - side).abs() < 1e-12;
        let mut section: Vec<u32> = (0..half.vertices.len() as u32)
            .filter(|v| tip(v) && half.vertices[*v as usize].y >= 0.0)
            .collect();
        section.sort_by(|a, b| {
            let x = |v: &u32| half.vertices[*v as usize].x;
            x(a).total_cmp(&x(b))
        });
        for pair in section[1..].windows(2) {
            let mut triangle = [section[0], pair[1], pair[0]];
            if side > 0.0 {
                triangle.swap(1, 2);
            }
            half.triangles.push(triangle);
        }
    }
}

/// The starboard half of the aircraft of `cases/scaneagle`, with the modes of
/// its whole structure: half of them are of each kind, none of neither.
#[test]
fn half_an_aircraft_is_moved_by_its_whole_structure() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mesh = root.join("meshes/scaneagle_3k.msh");
    let whole = fladder_mesh::read::load(&mesh, 1.0).unwrap().mesh;
    let place = Place::new();
    let mut file = Vec::new();
    fladder_mesh::write::msh41(&mut file, &starboard(&whole)).unwrap();
    let structure = root.join("cases/scaneagle");
    place.write("half.msh", file).write(
        "case.toml",
        format!(
            "[reference]\nsemichord = 0.115\n[mesh]\nfile = \"half.msh\"\nsymmetry = \"y\"\n\
             [wake]\nbody_lines = [\"bodywake_r\"]\n[gaf]\nk = [0.0, 0.1]\n[structure]\n\
             file = \"{0}/modes.frd.gz\"\ngeometry = \"{0}/modes.inp.gz\"\n\
             other_symmetry = \"leave-out\"\ntransfer_limit = 0.02\n[structure.components]\n\
             wing_r = [\"WLE\", \"WCAP\", \"WBOX\", \"WTE\"]\nelevon_r = [\"WCS\"]\n\
             winglet_r = [\"LLE\", \"LCAP\", \"LBOX\", \"LTE\"]\nrudder_r = [\"LCS\"]\n\
             fuselage_r = [\"FUS\", \"FUSZ0\", \"FUSZ1\", \"FUSZ2\", \"FUSZ3\", \"FUSN\", \"FUST\"]\n\
             [structure.rigid_body]\n",
            structure.display()
        ),
    );
    let mut elastic = 0;
    for symmetry in ["y", "-y"] {
        let set = format!("mesh.symmetry={symmetry}");
        let run = place.run(&["check", "case.toml", "--json", "check.json", "--set", &set]);
        let text = cli_support::output(&run.code(0));
        for line in text.lines().filter(|line| line.contains("symmetric")) {
            println!("{line}");
        }
        assert!(!text.contains("neither symmetric"), "{text}");
        let found: Value = serde_json::from_str(&place.read("check.json")).unwrap();
        assert_eq!(found["ok"], true);
        assert_eq!(found["symmetry"], symmetry);
        let area = found["area"].as_f64().unwrap();
        assert!((area / whole.area() - 1.0).abs() < 1e-9, "{area}");
        let modes = found["modes"].as_array().unwrap();
        elastic += modes.len() - 3;
    }
    assert_eq!(elastic, 20);
}

#[test]
fn half_an_aircraft_without_a_wake_has_the_forces_of_the_whole() {
    aircraft_against_halves("none");
}

/// Where the lines of port and starboard meet at the tail, the sheet of a half ends
/// in the plane with the mean of its jump and that of its image.
#[test]
fn half_an_aircraft_has_the_forces_of_the_whole() {
    aircraft_against_halves("required");
}

/// The same aircraft, rigid.
fn aircraft_against_halves(wake: &str) {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mesh = root.join("meshes/scaneagle_3k.msh");
    let whole = fladder_mesh::read::load(&mesh, 1.0).unwrap().mesh;
    let place = Place::new();
    let case = |mesh: &str, symmetry: &str, lines: &str| {
        format!(
            "[reference]\nsemichord = 0.115\n[flow]\nalpha_deg = 2.914\n[mesh]\n\
             file = \"{mesh}\"\nsymmetry = \"{symmetry}\"\n[wake]\nmode = \"{wake}\"\n\
             body_lines = {lines}\n[gaf]\nk = [0.0, 0.1]\n[structure.rigid_body]\n\
             mass = 17.86\ncg = [0.6615, 0.0, 0.001]\n\
             inertia = {{ xx = 0.976, yy = 1.329, zz = 2.190, xz = 0.00715 }}\n"
        )
    };
    let mut file = Vec::new();
    fladder_mesh::write::msh41(&mut file, &starboard(&whole)).unwrap();
    let both = "[\"bodywake_r\", \"bodywake_l\"]";
    let one = "[\"bodywake_r\"]";
    place
        .write("half.msh", file)
        .write(
            "whole.toml",
            case(&mesh.display().to_string(), "none", both),
        )
        .write("y.toml", case("half.msh", "y", one))
        .write("-y.toml", case("half.msh", "-y", one));
    let points = ["0,0.3", "-0.05,0.2"];
    let (names, of_whole) = q(&place, "whole", &points);
    let numbers = |name: &String| names.iter().position(|other| other == name).unwrap();
    for case in ["y", "-y"] {
        let (own_names, of_half) = q(&place, case, &points);
        let places: Vec<usize> = own_names.iter().map(numbers).collect();
        for (point, (whole, half)) in points.iter().zip(of_whole.iter().zip(&of_half)) {
            let worst = worst_difference(whole, half, &places);
            println!("{case} at {point}: half against whole {worst:.1e} of max |Q|");
            assert!(worst < 1e-9, "{case} at {point}: {worst:e}");
        }
    }
}

/// What belongs to the groups of the starboard side.
fn starboard(whole: &TriMesh) -> TriMesh {
    let mut half = TriMesh::default();
    let mut number = vec![None; whole.vertices.len()];
    let mut kept = |half: &mut TriMesh, v: u32| {
        *number[v as usize].get_or_insert_with(|| {
            half.vertices.push(whole.vertices[v as usize]);
            half.vertices.len() as u32 - 1
        })
    };
    for group in whole.surfaces.iter().filter(|g| g.name.ends_with("_r")) {
        let first = half.triangles.len() as u32;
        for &t in &group.triangles {
            let corners = whole.triangles[t as usize].map(|v| kept(&mut half, v));
            half.triangles.push(corners);
        }
        half.surfaces.push(SurfaceGroup {
            name: group.name.clone(),
            triangles: (first..half.triangles.len() as u32).collect(),
        });
    }
    for group in whole.curves.iter().filter(|g| g.name.ends_with("_r")) {
        let edges = group
            .edges
            .iter()
            .map(|edge| edge.map(|v| kept(&mut half, v)));
        let edges = edges.collect();
        half.curves.push(CurveGroup {
            name: group.name.clone(),
            edges,
        });
    }
    half
}
