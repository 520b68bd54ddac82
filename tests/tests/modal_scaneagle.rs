//! The modal results of the ScanEagle-like aircraft: read, judged, carried to
//! the wetted surface.

mod common;

use fladder_mesh::{TriMesh, Vec3, read::read_mesh};
use fladder_modal::{
    Axes, Mapping, RigidBody, StructuralModel, StructureSettings, Transfer, TransferError,
    Units, build_transfer, load, read_structure, rigid_modes, transfer,
};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("the workspace")
}

fn case(name: &str) -> PathBuf {
    root().join("cases/scaneagle").join(name)
}

fn settings() -> StructureSettings {
    StructureSettings {
        file: case("modes.frd.gz"),
        geometry: Some(case("modes.inp.gz")),
        ..StructureSettings::default()
    }
}

fn model() -> StructuralModel {
    load(&settings()).expect("the case's structure")
}

fn mesh(name: &str) -> TriMesh {
    read_mesh(root().join("meshes").join(name), 1.0).expect("the case's mesh")
}

fn reference() -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scaneagle_modal.json");
    let text = std::fs::read_to_string(path).expect("reference file");
    serde_json::from_str(&text).expect("JSON")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn carried(mesh: &TriMesh, model: &StructuralModel) -> Transfer {
    build_transfer(&model.result, mesh, &common::scaneagle_components())
        .expect("structure and mesh fit")
}

fn sample(points: &[Vec3], field: impl Fn(&Vec3) -> Vec3) -> Vec<Vec3> {
    points.iter().map(field).collect()
}

/// Largest difference relative to the largest of the exact field.
fn largest_error(found: &[Vec3], exact: &[Vec3]) -> f64 {
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    largest(&mut found.iter().zip(exact).map(|(a, b)| (a - b).norm()))
        / largest(&mut exact.iter().map(Vec3::norm))
}

/// Column 4 of the eigenvalue table, read here without the importer.
fn frequencies_of_dat() -> Vec<f64> {
    let text = std::fs::read_to_string(case("modes.dat")).expect("eigenvalues");
    let table = text
        .split("P A R T I C I P A T I O N")
        .next()
        .expect("a table");
    table
        .lines()
        .map(|line| line.split_whitespace().collect::<Vec<_>>())
        .filter(|words| words.len() == 5 && words[0].parse::<u32>().is_ok())
        .map(|words| words[3].parse().expect("a frequency"))
        .collect()
}

#[test]
fn six_rigid_and_twenty_elastic_modes_with_the_frequencies_of_the_dat_file() {
    let model = model();
    let frequencies = frequencies_of_dat();
    assert_eq!(model.result.modes.len(), 26);
    assert_eq!(frequencies.len(), 26);
    for (k, mode) in model.result.modes.iter().enumerate() {
        assert_eq!(mode.frequency_hz, frequencies[k], "mode {}", mode.index);
        assert_eq!(model.survey.fits[k].rigid, k < 6, "mode {}", mode.index);
    }
    let elastic: Vec<f64> = model.elastic.iter().map(|mode| mode.frequency_hz).collect();
    assert_eq!(elastic, frequencies[6..]);
    assert!(
        model.result.modes[0].eigenvalue < 0.0 && model.result.modes[0].frequency_hz == 0.0
    );
    let rest = model.survey.fits[..6]
        .iter()
        .map(|fit| fit.residual)
        .fold(0.0, f64::max);
    let least = model.survey.fits[6..]
        .iter()
        .map(|fit| fit.residual)
        .fold(1.0, f64::min);
    println!(
        "rigid fit leaves at most {rest:.1e} of a rigid mode, at least {least:.2} of others"
    );
}

#[test]
fn shapes_are_those_of_an_independent_reader_node_by_node() {
    let (reference, model) = (reference(), model());
    let ids: Vec<u64> = reference["nodes"]
        .as_array()
        .expect("nodes")
        .iter()
        .map(|id| id.as_u64().expect("a number"))
        .collect();
    let mut compared = 0;
    for (mode, expected) in model
        .result
        .modes
        .iter()
        .zip(reference["modes"].as_array().expect("modes"))
    {
        assert_eq!(expected["index"], mode.index);
        let scale = mode.displacement.iter().map(Vec3::amax).fold(0.0, f64::max);
        for (id, vector) in ids
            .iter()
            .zip(expected["displacement"].as_array().expect("shapes"))
        {
            let place = model
                .result
                .nodes
                .iter()
                .position(|node| node.id == *id)
                .expect("node");
            for axis in 0..3 {
                let (a, b) = (mode.displacement[place][axis], number(&vector[axis]));
                assert!(
                    (a - b).abs() <= 1e-7 * scale,
                    "mode {} node {id}: {a} {b}",
                    mode.index
                );
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 26 * 7 * 3);
}

#[test]
fn mass_centre_and_inertia_follow_from_the_rigid_modes() {
    let reference = reference();
    let tolerance = number(&reference["tolerance"]["mass_properties"]);
    let recovered = model().rigid_body_from_file.expect("six rigid modes");
    let RigidBody { mass, cg, inertia } = recovered.body;
    println!("{recovered:?}");
    let near = |found: f64, expected: &Value, scale: f64, what: &str| {
        let error = (found - number(expected)).abs() / scale;
        println!("{what}: {found:.6}, by integration {expected}, difference {error:.1e}");
        assert!(error < tolerance, "{what}");
    };
    near(mass, &reference["mass"], mass, "mass");
    for axis in 0..3 {
        near(cg[axis], &reference["cg"][axis], 1.0, "cg");
    }
    let given = &reference["inertia"];
    near(inertia.xx, &given["xx"], inertia.xx, "xx");
    near(inertia.yy, &given["yy"], inertia.yy, "yy");
    near(inertia.zz, &given["zz"], inertia.zz, "zz");
    // Its own digits are five decimals; the scale is that of the other moments.
    near(inertia.xz, &given["xz"], inertia.xx, "xz");
}

/// Largest measured: 2.4e-3 of √mass, in x.
#[test]
fn elastic_modes_are_orthogonal_to_rigid_motion() {
    let model = model();
    let largest = model
        .elastic
        .iter()
        .filter_map(|mode| mode.participation)
        .fold(0.0, f64::max);
    println!("largest participation {largest:.2e} of √mass");
    assert!(largest > 1e-3 && largest < 3e-3);
    assert!(!model.notes.iter().any(|note| note.contains("orthogonal")));
}

#[test]
fn rigid_motion_and_bending_reach_the_surface() {
    let model = model();
    let nodes = model.result.positions();
    for (name, vertices) in [("scaneagle_3k.msh", 1768), ("scaneagle_10k.msh", 5712)] {
        let mesh = mesh(name);
        assert_eq!(mesh.vertices.len(), vertices);
        let transfer = carried(&mesh, &model);
        // Everywhere, and outboard of the fuselage alone.
        let errors = |field: &dyn Fn(&Vec3) -> Vec3| {
            let found = transfer.matrix.displacement(&sample(&nodes, field));
            let exact = sample(&mesh.vertices, field);
            let outboard = mesh.vertices.iter().map(|p| p.y.abs() > 0.1);
            let rest: Vec<Vec3> = exact
                .iter()
                .zip(&found)
                .zip(outboard)
                .map(|((exact, found), outboard)| if outboard { *found } else { *exact })
                .collect();
            [largest_error(&found, &exact), largest_error(&rest, &exact)]
        };
        let w = |y: f64| (y / 1.5).powi(2);
        let slope = |y: f64| 2.0 * y / 2.25;
        let axis = |y: f64| 0.42 + 0.40 * (y * y + 0.04).sqrt();
        let rigid = errors(&|p| Vec3::new(1.0, -2.0, 3.0) + Vec3::new(0.4, 0.7, -0.2).cross(p));
        let bending = errors(&|p| Vec3::new(0.0, -p.z * slope(p.y), w(p.y)));
        let twist =
            errors(&|p| Vec3::new(p.z * 0.5 * w(p.y), 0.0, -(p.x - axis(p.y)) * 0.5 * w(p.y)));
        let in_plane = errors(&|p| Vec3::new(w(p.y), -(p.x - axis(p.y)) * slope(p.y), 0.0));
        let all = [
            ("rigid", rigid),
            ("bending", bending),
            ("twist", twist),
            ("in-plane", in_plane),
        ];
        for (field, [everywhere, outboard]) in all {
            println!("{name}: {field} {everywhere:.1e}, outboard {outboard:.1e}");
        }
        assert!(rigid[0] < 1e-12 && bending[0] < 1e-3 && twist[0] < 1e-3);
        // In-plane bending has its largest error on the body, whose elements are long.
        assert!(in_plane[0] < 3e-3 && in_plane[1] < 2.2e-3);
    }
}

/// One radian of the starboard elevon about its hinge, all else at rest.
#[test]
fn an_elevon_turns_alone() {
    let (model, mesh) = (model(), mesh("scaneagle_10k.msh"));
    let transfer = carried(&mesh, &model);
    let result = &model.result;
    let set = result
        .element_sets
        .iter()
        .find(|set| set.name == "WCS")
        .expect("the elevon");
    let mut on_elevon = vec![false; result.nodes.len()];
    for element in &set.members {
        for node in &result.elements[*element as usize].nodes {
            on_elevon[*node as usize] = true;
        }
    }
    let (hinge, axis) = (
        Vec3::new(0.85, 0.72, 0.0),
        Vec3::new(0.35, 0.93, 0.05).normalize(),
    );
    let turned = |p: &Vec3| axis.cross(&(p - hinge));
    let nodal: Vec<Vec3> = result
        .nodes
        .iter()
        .zip(&on_elevon)
        .map(|(node, on)| {
            if *on {
                turned(&node.position)
            } else {
                Vec3::zeros()
            }
        })
        .collect();
    let found = transfer.matrix.displacement(&nodal);
    let mut uses: Vec<(usize, usize)> = vec![(0, 0); mesh.vertices.len()];
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        let elevon = mesh
            .surfaces
            .iter()
            .find(|group| group.name == "elevon_r")
            .expect("group");
        let inside = elevon.triangles.binary_search(&(index as u32)).is_ok();
        for vertex in triangle {
            let count = &mut uses[*vertex as usize];
            count.0 += 1;
            count.1 += usize::from(inside);
        }
    }
    let (mut moved, mut error) = (0, 0.0_f64);
    for ((vertex, u), (all, elevon)) in mesh.vertices.iter().zip(&found).zip(uses) {
        if all == elevon {
            error = error.max((u - turned(vertex)).norm());
            moved += 1;
        } else {
            assert_eq!(*u, Vec3::zeros(), "{vertex:?}");
        }
    }
    println!("{moved} vertices turn with the elevon, largest error {error:.1e} m");
    assert!(moved > 100 && error < 1e-14);
}

#[test]
fn work_is_conserved_between_surface_and_structure() {
    let (model, mesh) = (model(), mesh("scaneagle_3k.msh"));
    let transfer = carried(&mesh, &model);
    let work = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| a.dot(b)).sum::<f64>();
    let forces = sample(&mesh.vertices, |p| {
        Vec3::new((9.0 * p.y).sin(), p.x, 2.0 + p.z)
    });
    let nodal = transfer.matrix.force(&forces);
    for mode in &model.elastic {
        let on_surface = work(&forces, &transfer.matrix.displacement(&mode.shape));
        let on_structure = work(&nodal, &mode.shape);
        let scale: f64 = forces.iter().map(Vec3::norm).sum::<f64>()
            * mode.shape.iter().map(Vec3::norm).fold(0.0, f64::max);
        assert!(
            (on_surface - on_structure).abs() < 1e-12 * scale,
            "{}",
            mode.name
        );
    }
}

/// The file's own rigid modes on the surface lie in the space of the six made
/// from the mass properties, but for the six digits of the file.
#[test]
fn rigid_modes_of_the_file_are_those_of_the_mass_properties() {
    let (model, mesh) = (model(), mesh("scaneagle_3k.msh"));
    let transfer = carried(&mesh, &model);
    let rigid = rigid_modes(&model.rigid_body.expect("six rigid modes"), &mesh.vertices);
    let columns: Vec<f64> = rigid
        .iter()
        .flat_map(|mode| mode.displacement.iter().flatten().copied())
        .collect();
    let basis = nalgebra::DMatrix::from_vec(3 * mesh.vertices.len(), 6, columns);
    let normal = (basis.transpose() * &basis)
        .try_inverse()
        .expect("independent modes");
    for mode in &model.result.modes[..6] {
        let shape = transfer.matrix.displacement(&mode.displacement);
        let shape =
            nalgebra::DVector::from_iterator(basis.nrows(), shape.iter().flatten().copied());
        let part = &normal * (basis.transpose() * &shape);
        let rest = (&shape - &basis * &part).norm() / shape.norm();
        // Mass-normalised on both sides: the parts are an orthonormal mix, but for the
        // small product of inertia.
        println!(
            "mode {}: {rest:.1e} left, mix of norm {:.5}",
            mode.index,
            part.norm()
        );
        assert!(rest < 3e-5 && (part.norm() - 1.0).abs() < 5e-3);
    }
}

#[test]
fn what_does_not_carry_the_surface_is_named_and_left_out() {
    let (model, mesh) = (model(), mesh("scaneagle_3k.msh"));
    let (modes, report) = transfer(&model, &mesh, &common::scaneagle_components())
        .expect("structure and mesh fit");
    assert_eq!(modes.len(), 20);
    assert_eq!(
        (&*modes[0].name, &*modes[19].name),
        ("elastic:1", "elastic:20")
    );
    let left_out = report.left_out.join("\n");
    println!("{left_out}");
    // Caps go on inside the fuselage; webs, ribs, bulkheads and joints have no displacements
    // in the file at all.
    for set in ["WCAP (8 of 72)", "WCAP_P (8 of 72)"] {
        assert!(left_out.contains(set), "{set}");
    }
    for part in &report.components {
        println!(
            "{}: {} vertices, {:.4} m",
            part.name, part.vertices, part.largest_distance
        );
    }
    println!("ratio {}, overlap {}", report.size_ratio, report.overlap);
    assert_eq!(report.components.len(), 10);
    assert!((report.size_ratio - 1.0).abs() < 0.01 && report.overlap == 1.0);
    // Nowhere farther than from the rear spar at 70 % of the chord to the hinge line at 75 %,
    // where the elevon begins: 0.2316 m of chord.
    assert!(report.largest_distance < 0.05 * 0.2316);
    assert!(
        model
            .notes
            .iter()
            .any(|note| note.starts_with("483 nodes carry no displacements"))
    );
}

#[test]
fn connectivity_alone_finds_the_control_surfaces() {
    let (model, mesh) = (model(), mesh("scaneagle_3k.msh"));
    let found = build_transfer(&model.result, &mesh, &BTreeMap::new()).expect("a fit");
    let sets: BTreeMap<&str, &[String]> = found
        .report
        .components
        .iter()
        .map(|part| (&*part.name, &*part.sets))
        .collect();
    assert!(
        found
            .report
            .components
            .iter()
            .all(|part| part.mapping == Mapping::Connectivity)
    );
    for (group, set) in [
        ("elevon_r", "WCS"),
        ("elevon_l", "WCS_P"),
        ("rudder_r", "LCS"),
        ("rudder_l", "LCS_P"),
    ] {
        assert_eq!(sets[group], [set], "{group}");
    }
    assert!(sets["fuselage_r"].iter().all(|set| set.starts_with("FUS")));
    let given = carried(&mesh, &model);
    for mode in &model.elastic[..14] {
        let (a, b) = (
            found.matrix.displacement(&mode.shape),
            given.matrix.displacement(&mode.shape),
        );
        let error = largest_error(&a, &b);
        println!("{}: {error:.1e} from the given mapping", mode.name);
        assert!(error < 2e-2);
    }
}

#[test]
fn other_units_and_axes_are_refused() {
    let mesh = mesh("scaneagle_3k.msh");
    let wrong = StructureSettings {
        units: Units::MillimetreTonne,
        ..settings()
    };
    let wrong = load(&wrong).expect("readable");
    match build_transfer(&wrong.result, &mesh, &BTreeMap::new()) {
        Err(TransferError::Size { ratio, .. }) => {
            let report = carried(&mesh, &model()).report;
            assert!((ratio / report.size_ratio / 1e3 - 1.0).abs() < 1e-9);
        }
        other => panic!("{:?}", other.map(|transfer| transfer.report)),
    }
    let axes = Axes::from_names(["y", "-x", "z"]).expect("right-handed");
    let wrong = load(&StructureSettings { axes, ..settings() }).expect("readable");
    match build_transfer(&wrong.result, &mesh, &BTreeMap::new()) {
        Err(error @ TransferError::Apart { .. }) => {
            println!("{error}");
            assert!(error.to_string().contains(r#"["-y", "x", "z"]"#));
        }
        other => panic!("{:?}", other.map(|transfer| transfer.report)),
    }
}

#[test]
fn the_compressed_result_cut_anywhere_is_refused() {
    let bytes = std::fs::read(case("modes.frd.gz")).expect("the case's result");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("modes.frd.gz");
    for length in (0..bytes.len())
        .step_by(bytes.len() / 23)
        .chain([bytes.len() - 1])
    {
        std::fs::write(&path, &bytes[..length]).expect("a file");
        let message = read_structure(&path, None, None)
            .expect_err("cut")
            .to_string();
        assert!(message.contains("cut short"), "{length}: {message}");
    }
}
