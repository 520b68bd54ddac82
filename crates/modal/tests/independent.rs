//! Files that other programs wrote, read and compared node by node; what must
//! be found is in `tests/data/expected.json`, written beside them.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use common::folder;
use fladder_mesh::Vec3;
use fladder_modal::{ElementKind, Format, ModalResult, Op4Matrix, read_op4, read_structure};
use serde_json::Value;
use std::f64::consts::TAU;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// One set of matrices in text and binary, dense and sparse, both byte orders.
const MATRICES: [&str; 6] = [
    "patch_text_dense.op4",
    "patch_text_sparse.op4",
    "patch_binary_dense.op4",
    "patch_binary_sparse.op4",
    "patch_binary_big.op4",
    "patch_binary_big_endian.op4",
];

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

fn expected() -> Value {
    serde_json::from_slice(&fs::read(data("expected.json")).unwrap()).unwrap()
}

fn vector(value: &Value) -> Vec3 {
    Vec3::from_iterator((0..3).map(|k| value[k].as_f64().unwrap()))
}

fn read(name: &str, geometry: Option<&str>) -> ModalResult {
    let geometry = geometry.map(data);
    read_structure(&data(name), geometry.as_deref(), None).unwrap()
}

/// Largest difference between the patch's modes and the rigid motions they are,
/// of displacements and rotations.
fn motion_error(result: &ModalResult, patch: &Value) -> f64 {
    let mut worst = 0.0_f64;
    for (mode, motion) in result
        .modes
        .iter()
        .zip(patch["motions"].as_array().unwrap())
    {
        let (translation, turn) = (vector(&motion[0]), vector(&motion[1]));
        for (k, node) in result.nodes.iter().enumerate() {
            let wanted = translation + turn.cross(&node.position);
            worst = worst.max((mode.displacement[k] - wanted).amax());
            let rotation = mode.rotation.as_ref().unwrap()[k];
            worst = worst.max((rotation - turn).amax());
        }
    }
    worst
}

fn check_patch(result: &ModalResult, tolerance: f64, masses: bool) {
    let expected = expected();
    let patch = &expected["patch"];
    let nodes = patch["nodes"].as_object().unwrap();
    assert_eq!(result.nodes.len(), nodes.len());
    let mut worst = 0.0_f64;
    for node in &result.nodes {
        let place = vector(&nodes[&node.id.to_string()]);
        worst = worst.max((node.position - place).amax());
    }
    let elements = patch["elements"].as_object().unwrap();
    assert_eq!(result.elements.len(), elements.len());
    for element in &result.elements {
        let found: Vec<u64> = element
            .nodes
            .iter()
            .map(|n| result.nodes[*n as usize].id)
            .collect();
        let wanted = elements[&element.id.to_string()].as_array().unwrap();
        let wanted: Vec<u64> = wanted.iter().map(|n| n.as_u64().unwrap()).collect();
        assert_eq!(found, wanted, "element {}", element.id);
    }
    let error = motion_error(result, patch);
    println!(
        "{:?}: places {worst:.1e}, motions {error:.1e} (limit {tolerance:e})",
        result.format
    );
    assert!(worst < 1e-13 && error < tolerance);
    for (k, mode) in result.modes.iter().enumerate() {
        let lambda = patch["eigenvalues"][k].as_f64().unwrap();
        assert!((mode.frequency_hz - lambda.sqrt() / TAU).abs() < 1e-6 * mode.frequency_hz);
        let mass = patch["masses"][k].as_f64().unwrap();
        assert_eq!(mode.generalised_mass, if masses { mass } else { 1.0 });
    }
    assert_eq!(result.modes.len(), 3);
}

/// Nodes in rectangular, cylindrical and spherical frames, displacements in
/// others; six digits in text, and axes found by differences in the file.
#[test]
fn motions_in_the_frames_of_nodes_are_turned_to_basic_axes() {
    for geometry in ["patch_small.bdf", "patch_large.bdf"] {
        let punch = read("patch.pch", Some(geometry));
        assert_eq!(punch.format, Format::NastranPunch);
        check_patch(&punch, 2e-6, false);
        let notes = punch.notes.join("\n");
        assert!(notes.contains("mass-normalised"), "{notes}");
        assert!(notes.contains("turned from their own axes"), "{notes}");
        assert!(notes.contains("1 RBE2"), "{notes}");
        let printed = read("patch.f06", Some(geometry));
        assert_eq!(printed.format, Format::NastranF06);
        check_patch(&printed, 2e-6, true);
        for name in MATRICES {
            let matrices = read(name, Some(geometry));
            assert_eq!(matrices.format, Format::NastranOp4);
            check_patch(&matrices, 2e-9, false);
        }
    }
}

#[test]
fn shells_are_grouped_by_property() {
    let patch = read("patch.f06", Some("patch_small.bdf"));
    let sets: Vec<(&str, usize)> = patch
        .element_sets
        .iter()
        .map(|set| (set.name.as_str(), set.members.len()))
        .collect();
    assert_eq!(sets, [("pbar_3", 1), ("pshell_1", 2), ("pshell_2", 4)]);
    let kinds: Vec<ElementKind> = patch.elements.iter().map(|e| e.kind).collect();
    assert_eq!(kinds[..2], [ElementKind::Quad8, ElementKind::Tri6]);
}

/// Gzipped, with Windows line ends, a byte order mark, and other exponents.
#[test]
fn text_comes_in_every_wrapping() {
    let home = folder("wrappings");
    let reads = |name: &str, bytes: &[u8]| {
        let path = home.join(name);
        fs::write(&path, bytes).unwrap();
        read_structure(&path, Some(&data("patch_large.bdf")), None).unwrap()
    };
    for name in ["patch.pch", "patch.f06", "patch_text_dense.op4"] {
        let text = fs::read_to_string(data(name)).unwrap();
        let plain = reads(name, text.as_bytes());
        let mut zip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        zip.write_all(text.as_bytes()).unwrap();
        let zipped = zip.finish().unwrap();
        let windows = format!("\u{feff}{}", text.replace('\n', "\r\n"));
        let double = text.replace("E+0", "D+0").replace("E-0", "D-0");
        for bytes in [zipped, windows.into_bytes(), double.into_bytes()] {
            let wrapped = reads(&format!("wrapped_{name}"), &bytes);
            assert_eq!(wrapped.modes, plain.modes);
        }
    }
}

#[test]
fn bulk_data_beside_a_result_are_found_and_includes_followed() {
    let home = folder("beside");
    fs::copy(data("patch.pch"), home.join("run.pch")).unwrap();
    let text = fs::read_to_string(data("patch_small.bdf")).unwrap();
    let (grids, rest) = text.split_once("$ELEMENTS").unwrap();
    fs::write(home.join("grids.inc"), grids).unwrap();
    let whole = format!("SOL 103\nCEND\nBEGIN BULK\nINCLUDE 'grids.inc'\n{rest}ENDDATA\n");
    fs::write(home.join("run.bdf"), &whole).unwrap();
    let found = read_structure(&home.join("run.pch"), None, None).unwrap();
    check_patch(&found, 2e-6, false);
    fs::write(home.join("run.bdf"), whole.replace("ENDDATA", "")).unwrap();
    let cut = read_structure(&home.join("run.pch"), None, None).unwrap_err();
    assert!(cut.to_string().contains("ENDDATA"), "{cut}");
    fs::remove_file(home.join("run.bdf")).unwrap();
    let alone = read_structure(&home.join("run.pch"), None, None).unwrap_err();
    assert!(alone.to_string().contains("structure.geometry"), "{alone}");
}

/// Free fields, and circles of files and frames.
#[test]
fn bulk_data_in_free_fields_and_with_faults() {
    let home = folder("free");
    let reads = |text: &str| {
        let path = home.join("model.bdf");
        fs::write(&path, text).unwrap();
        read_structure(&data("patch.pch"), Some(&path), None).map(|read| read.nodes.len())
    };
    let small = fs::read_to_string(data("patch_small.bdf")).unwrap();
    let in_free_fields = |line: &str| {
        if line.starts_with('$') {
            return line.to_owned();
        }
        let field = |k: usize| line.get(8 * k..(8 * k + 8).min(line.len())).unwrap_or("");
        let fields: Vec<&str> = (0..9).map(|k| field(k).trim()).collect();
        fields.join(",")
    };
    let lines: Vec<String> = small.lines().map(in_free_fields).collect();
    let free = lines.join("\n");
    assert_eq!(reads(&free).unwrap(), 25);
    for (from, to, words) in [
        (
            "GRID           5",
            "GRID           1",
            "node 1 is given in two ways",
        ),
        (
            "GRID           5        ",
            "GRID           5     x.y",
            "GRID: field 3",
        ),
        (
            "      40       1       2       3",
            "      41       1       2       3",
            "coordinate system 40",
        ),
        (
            "CORD2R        10        ",
            "CORD2R        10      30",
            "rests on itself",
        ),
        (
            "CQUAD4        13       2       3",
            "CQUAD4        13       2        ",
            "lacks one of its 4 corners",
        ),
        (
            "CQUAD4        13       2       3",
            "CQUAD4        13       2     999",
            "node 999",
        ),
    ] {
        assert!(small.contains(from), "{from:?}");
        let message = reads(&small.replacen(from, to, 1)).unwrap_err().to_string();
        println!("{message}");
        assert!(message.contains(words), "{words:?} is not in {message}");
    }
    let circle = format!("INCLUDE 'model.bdf'\n{small}");
    assert!(reads(&circle).unwrap_err().to_string().contains("nested"));
}

fn check_plate(result: &ModalResult, tolerance: f64) {
    let expected = expected();
    let plate = &expected["plate"];
    let points = plate["points"].as_array().unwrap();
    assert_eq!(result.nodes.len(), points.len());
    assert_eq!(result.modes.len(), 3);
    let mut worst = 0.0_f64;
    for (k, node) in result.nodes.iter().enumerate() {
        assert_eq!(node.id, k as u64 + 1);
        worst = worst.max((node.position - vector(&points[k])).amax());
        for (m, mode) in result.modes.iter().enumerate() {
            let wanted = vector(&plate["shapes"][m][k]);
            worst = worst.max((mode.displacement[k] - wanted).amax());
        }
    }
    for (k, mode) in result.modes.iter().enumerate() {
        let lambda = expected["patch"]["eigenvalues"][k].as_f64().unwrap();
        let error = mode.frequency_hz / (lambda.sqrt() / TAU) - 1.0;
        assert!(error.abs() < 1e-5, "{error:e}");
    }
    println!("{:?}: {worst:.1e} (limit {tolerance:e})", result.format);
    assert!(worst <= tolerance);
}

#[test]
fn meshio_writes_node_data_of_both_versions() {
    let expected = expected();
    for name in [
        "plate_22_text.msh",
        "plate_22_binary.msh",
        "plate_41_text.msh",
        "plate_41_binary.msh",
    ] {
        let plate = read(name, None);
        assert_eq!(plate.format, Format::Gmsh);
        check_plate(&plate, 1e-15);
        let cells = expected["plate"]["cells"].as_array().unwrap();
        assert_eq!(plate.elements.len(), cells.len());
        for (element, cell) in plate.elements.iter().zip(cells) {
            assert_eq!(element.kind, ElementKind::Quad8);
            let cell: Vec<u32> = (0..8).map(|k| cell[k].as_u64().unwrap() as u32).collect();
            assert_eq!(element.nodes, cell);
        }
    }
}

#[test]
fn pyuff_writes_nodes_and_modes() {
    for name in ["plate_55.unv", "plate_2414.unv"] {
        let plate = read(name, None);
        assert_eq!(plate.format, Format::Universal);
        // Six digits of numbers up to four.
        check_plate(&plate, 5e-6);
        let passed_over = plate.notes.iter().any(|note| note.contains("58b"));
        assert_eq!(passed_over, name == "plate_55.unv", "{:?}", plate.notes);
        let masses: Vec<f64> = plate.modes.iter().map(|m| m.generalised_mass).collect();
        assert_eq!(masses, [1.0, 2.5, 0.125]);
    }
}

/// One run of CalculiX for each form; shapes of repeated rigid modes may turn,
/// so that elastic ones are compared.
#[test]
fn calculix_writes_text_and_binary() {
    let (text, binary) = (read("plate_text.frd", None), read("plate_binary.frd", None));
    assert_eq!(text.elements, binary.elements);
    assert_eq!((text.nodes.len(), text.modes.len()), (21, 9));
    for (a, b) in text.nodes.iter().zip(&binary.nodes) {
        assert_eq!(a.id, b.id);
        assert!((a.position - b.position).amax() < 1e-9);
    }
    let mut worst = 0.0_f64;
    for (a, b) in text.modes.iter().zip(&binary.modes).skip(6) {
        assert!((a.frequency_hz / b.frequency_hz - 1.0).abs() < 1e-6);
        let sign = a.displacement[0].dot(&b.displacement[0]).signum();
        let size = a.displacement.iter().map(Vec3::amax).fold(0.0, f64::max);
        for (u, v) in a.displacement.iter().zip(&b.displacement) {
            worst = worst.max((u - v * sign).amax() / size);
        }
    }
    println!("elastic modes of both runs differ by {worst:.1e} (six digits: 5e-6)");
    assert!(worst < 5e-6);
}

#[test]
fn matrices_are_alike_in_every_form() {
    let first = read_op4(&data(MATRICES[0])).unwrap();
    assert_eq!(first.len(), 2);
    for name in &MATRICES[1..] {
        let other = read_op4(&data(name)).unwrap();
        assert_eq!(other.len(), 2);
        for a in &first {
            let b = other.iter().find(|b| b.name == a.name).unwrap();
            assert_eq!((a.rows, a.columns), (b.rows, b.columns));
            let nonzero = |m: &Op4Matrix| -> Vec<(usize, usize, f64)> {
                let entries = m.entries().map(|(row, column, [x, _])| (row, column, x));
                entries.filter(|entry| entry.2 != 0.0).collect()
            };
            let (ours, theirs) = (nonzero(a), nonzero(b));
            assert!(ours.len() >= 3 && ours.len() == theirs.len(), "{name}");
            for (x, y) in ours.iter().zip(&theirs) {
                assert_eq!((x.0, x.1), (y.0, y.1), "{name}");
                assert!((x.2 - y.2).abs() <= 1e-15 * y.2.abs(), "{name}");
            }
        }
    }
}
