//! The structure of the ScanEagle-like aircraft changed through its modes.

mod common;

use fladder_mesh::{Vec3, read::read_mesh};
use fladder_modal::{
    Edits, HingeChange, HingeRotation, PointMass, StructuralModel, StructureSettings, load,
    transfer,
};
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn model(edits: Edits) -> StructuralModel {
    let case = root().join("cases/scaneagle");
    let settings = StructureSettings {
        file: case.join("modes.frd.gz"),
        geometry: Some(case.join("modes.inp.gz")),
        edits,
        ..StructureSettings::default()
    };
    load(&settings).expect("the case's structure")
}

/// Scalar nodes whose x displacement is the rotation of control against wing.
const ELEVONS: [u64; 2] = [4017, 4055];
const RUDDERS: [u64; 2] = [4036, 4074];

/// Elevon hinges 10.0 → 9.0, rudder hinges 0.25 → 0.35 N m/rad: frequencies of
/// elastic modes 5 to 14 after a new run of CalculiX 2.20 with these springs.
const NEW_RUN: [f64; 10] = [
    32.10, 37.35, 41.21, 41.21, 53.75, 53.89, 59.12, 60.46, 68.78, 68.93,
];

/// Elastic modes 1 to 14 by the same change of the eigenvalue problem outside
/// this program: a dense eigensolver on Λ + Σ Δk θθᵀ, with the frequencies (seven
/// digits) and hinge rotations (six) of the twenty elastic modes.
const MODAL_UPDATE: [f64; 14] = [
    7.701_029, 17.610_322, 18.914_006, 22.613_420, 32.100_305, 37.346_089, 41.212_676,
    41.214_702, 53.760_861, 53.905_758, 59.120_769, 60.461_421, 68.820_156, 68.968_005,
];

#[test]
fn softer_hinges_give_the_frequencies_of_a_new_run() {
    let hinge = |node: u64, change: f64| HingeChange {
        name: format!("hinge {node}"),
        stiffness_change: change,
        rotation: HingeRotation::Scalar { node, component: 0 },
    };
    let elevons = ELEVONS.map(|node| hinge(node, -1.0));
    let rudders = RUDDERS.map(|node| hinge(node, 0.1));
    let before = model(Edits::default());
    let after = model(Edits {
        hinges: [elevons, rudders].concat(),
        ..Edits::default()
    });
    for (k, expected) in MODAL_UPDATE.into_iter().enumerate() {
        let new = after.elastic[k].frequency_hz;
        let error = new / expected - 1.0;
        println!(
            "elastic:{}: {new:.5} Hz, {error:+.1e} off the update",
            k + 1
        );
        assert!(error.abs() < 1e-7);
    }
    for (k, exact) in (4..14).zip(NEW_RUN) {
        let (old, new) = (
            before.elastic[k].frequency_hz,
            after.elastic[k].frequency_hz,
        );
        let error = new / exact - 1.0;
        println!(
            "elastic:{}: {old:.2} Hz, now {new:.2} Hz, new run {exact} Hz ({error:+.1e})",
            k + 1
        );
        // Twenty modes and the springs' share of the static shape: 0.25 %.
        assert!(error.abs() < 2.5e-3);
    }
}

#[test]
fn a_mass_at_the_nose_moves_the_centre_and_keeps_the_modes_apart_from_rigid_motion() {
    let position = Vec3::new(0.05, 0.0, 0.0);
    let before = model(Edits::default());
    let after = model(Edits {
        masses: vec![PointMass {
            name: "camera".to_owned(),
            mass: 0.5,
            position,
            node: None,
            inertia: None,
        }],
        ..Edits::default()
    });
    let (old, new) = (
        before.rigid_body.expect("masses"),
        after.rigid_body.expect("masses"),
    );
    let mass = old.mass + 0.5;
    assert!((new.mass - mass).abs() < 1e-12);
    let centre = (old.cg * old.mass + position * 0.5) / mass;
    assert!((new.cg - centre).norm() < 1e-12);
    for (a, b) in before.elastic.iter().zip(&after.elastic) {
        println!(
            "{}: {:.3} Hz, now {:.3} Hz",
            a.name, a.frequency_hz, b.frequency_hz
        );
        assert!(
            b.frequency_hz < a.frequency_hz * (1.0 + 1e-9),
            "a mass lowers {}",
            a.name
        );
    }
}

/// The way there and back, on the meshes of the case.
#[test]
fn real_modes_keep_their_shape_on_the_surface() {
    let model = model(Edits::default());
    for name in ["scaneagle_3k.msh", "scaneagle_10k.msh"] {
        let mesh = read_mesh(root().join("meshes").join(name), 1.0).expect("the case's mesh");
        let (_, report) =
            transfer(&model, &mesh, &common::scaneagle_components()).expect("a fit");
        for (mode, error) in model.elastic.iter().zip(&report.errors) {
            let error = error.expect("skin nodes");
            let node = &model.result.nodes[error.node as usize];
            println!(
                "{name} {}: {:.2} % at {:?}",
                mode.name,
                100.0 * error.relative,
                node.position
            );
        }
    }
}
