//! Rigid modes: recognised by shape, and the mass properties they hold.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use common::{file, frd, mode};
use fladder_mesh::Vec3;
use fladder_modal::{
    AnalyticMode, Axes, Inertia, ModalResult, Motion, RigidBody, RigidBodyError,
    RigidBodySettings, StructureError, StructureSettings, Units, load, rigid_modes, survey,
    write_neutral,
};
use nalgebra::{Matrix6, Vector6};

fn body() -> RigidBody {
    RigidBody {
        mass: 17.9,
        cg: Vec3::new(0.35, 2.1, 0.02),
        inertia: Inertia {
            xx: 21.0,
            yy: 1.4,
            zz: 22.0,
            xz: 0.3,
        },
    }
}

/// Six modes of unit mass for a body: `R M^{-1/2} Q` with Q orthogonal, so that
/// every mode mixes all motions, as solvers return them.
fn six(points: &[Vec3], body: &RigidBody, masses: [f64; 6]) -> Vec<Vec<Vec3>> {
    let Inertia { xx, yy, zz, xz } = body.inertia;
    let mut matrix =
        Matrix6::from_diagonal(&Vector6::new(body.mass, body.mass, body.mass, xx, yy, zz));
    matrix[(3, 5)] = -xz;
    matrix[(5, 3)] = -xz;
    let eigen = matrix.symmetric_eigen();
    let root = eigen.eigenvectors
        * Matrix6::from_diagonal(&eigen.eigenvalues.map(|v| 1.0 / v.sqrt()))
        * eigen.eigenvectors.transpose();
    let seed = Matrix6::from_fn(|i, j| ((3 * i + 7 * j + i * j) as f64).sin());
    let mixed = root * seed.qr().q();
    (0..6)
        .map(|k| {
            let column = mixed.column(k) * masses[k].sqrt();
            let (t, w) = (column.fixed_rows::<3>(0), column.fixed_rows::<3>(3));
            points.iter().map(|p| t + w.cross(&(p - body.cg))).collect()
        })
        .collect()
}

fn structure(masses: [f64; 6]) -> ModalResult {
    let mut result = common::wing().result();
    let positions = result.positions();
    for (k, shape) in six(&positions, &body(), masses).into_iter().enumerate() {
        result
            .modes
            .push(mode(k as u32 + 1, 0.001 * k as f64, masses[k], shape));
    }
    // A flap free about its hinge: at 0 Hz, and no rigid motion of the whole.
    let flap = |p: &Vec3| {
        if p.x > common::HINGE {
            Vec3::new(0.0, 0.0, common::HINGE - p.x)
        } else {
            Vec3::zeros()
        }
    };
    result
        .modes
        .push(mode(7, 0.0, 0.5, common::sample(&positions, flap)));
    let bend = |p: &Vec3| Vec3::new(0.0, 0.0, p.y * p.y);
    result
        .modes
        .push(mode(8, 12.0, 4.0, common::sample(&positions, bend)));
    result
}

fn assert_body(found: &RigidBody, expected: &RigidBody, tolerance: f64) {
    let near = |a: f64, b: f64, scale: f64| (a - b).abs() <= tolerance * scale;
    assert!(near(found.mass, expected.mass, expected.mass), "{found:?}");
    assert!(
        (found.cg - expected.cg).norm() <= tolerance * 4.0,
        "{found:?}"
    );
    let (a, b) = (found.inertia, expected.inertia);
    for (a, b) in [(a.xx, b.xx), (a.yy, b.yy), (a.zz, b.zz), (a.xz, b.xz)] {
        assert!(near(a, b, expected.inertia.zz), "{found:?}");
    }
}

#[test]
fn six_mixed_modes_hold_mass_centre_and_inertia() {
    for masses in [[1.0; 6], [0.5, 2.0, 1.0, 3.0, 0.1, 7.0]] {
        let survey = survey(&structure(masses));
        let rigid: Vec<bool> = survey.fits.iter().map(|fit| fit.rigid).collect();
        assert_eq!(rigid, [true, true, true, true, true, true, false, false]);
        let recovered = survey.recovered.unwrap();
        assert_body(&recovered.body, &body(), 1e-11);
        assert!(recovered.mass_spread < 1e-11);
    }
}

#[test]
fn nodes_that_stay_behind_do_not_spoil_the_fit() {
    let mut result = structure([1.0; 6]);
    result.elements.clear();
    result.element_sets.clear();
    let strays = [3, 77, 200];
    for stray in strays {
        result
            .modes
            .iter_mut()
            .for_each(|mode| mode.displacement[stray] = Vec3::zeros());
    }
    let survey = survey(&result);
    assert_eq!(survey.rigid_count(), 6);
    assert_body(&survey.recovered.unwrap().body, &body(), 1e-11);
    assert!(
        survey
            .notes
            .iter()
            .any(|note| note.starts_with("3 nodes do not follow"))
    );
}

fn loaded(
    name: &str,
    result: &ModalResult,
    change: impl Fn(&mut StructureSettings),
) -> Result<fladder_modal::StructuralModel, StructureError> {
    let mut bytes = Vec::new();
    write_neutral(result, &mut bytes).unwrap();
    let mut settings = StructureSettings {
        file: file(name, "model.json", bytes),
        ..StructureSettings::default()
    };
    change(&mut settings);
    load(&settings)
}

#[test]
fn elastic_modes_have_unit_generalised_mass_and_come_by_frequency() {
    let mut result = structure([1.0; 6]);
    result.modes[6].frequency_hz = 20.0;
    let model = loaded("elastic", &result, |_| {}).unwrap();
    let names: Vec<_> = model
        .elastic
        .iter()
        .map(|mode| (&*mode.name, mode.index))
        .collect();
    assert_eq!(names, [("elastic:1", 8), ("elastic:2", 7)]);
    assert_eq!(model.elastic[0].generalised_mass, 4.0);
    let node = 50;
    let expected = result.modes[7].displacement[node] * 0.5;
    assert!((model.elastic[0].shape[node] - expected).norm() < 1e-15);
    assert!((model.elastic[0].omega / (24.0 * std::f64::consts::PI) - 1.0).abs() < 1e-15);
    let second = loaded("elastic", &result, |s| s.modes = Some([2, 2])).unwrap();
    assert_eq!(second.elastic.len(), 1);
    assert_eq!(second.elastic[0].name, "elastic:2");
    for range in [[0, 1], [2, 3], [2, 1]] {
        let failed = loaded("elastic", &result, |s| s.modes = Some(range)).unwrap_err();
        assert!(
            failed.to_string().contains("elastic modes 1 to 2"),
            "{failed}"
        );
    }
}

/// The same wing in inches and lbf s²/in, its axes turned, gives the same body
/// and the same normalised modes.
#[test]
fn units_and_axes_of_the_file_do_not_show_in_the_model() {
    let metric = structure([1.0; 6]);
    let expected = loaded("units_si", &metric, |_| {}).unwrap();
    let units = Units::InchPoundForce;
    let origin = Vec3::new(0.5, -1.0, 2.0);
    let mut other = metric.clone();
    // Structure axes (−x, y, −z) of the mesh.
    let turn = |v: &Vec3| Vec3::new(-v.x, v.y, -v.z);
    for node in &mut other.nodes {
        node.position = turn(&(node.position - origin)) / units.length();
    }
    for mode in &mut other.modes {
        mode.generalised_mass /= units.mass();
        mode.displacement.iter_mut().for_each(|u| *u = turn(u));
    }
    let found = loaded("units_in", &other, |settings| {
        settings.units = units;
        settings.axes = Axes::from_names(["-x", "y", "-z"]).unwrap();
        settings.origin = origin;
    })
    .unwrap();
    assert_body(
        &found.rigid_body.unwrap(),
        &expected.rigid_body.unwrap(),
        1e-11,
    );
    for (a, b) in found.elastic.iter().zip(&expected.elastic) {
        assert!(common::largest_error(&a.shape, &b.shape) < 1e-12);
    }
}

/// Two bodies, mirror images at y = ±2.1 m: Steiner's theorem.
#[test]
fn a_half_model_stands_for_itself_and_its_mirror_image() {
    let result = structure([1.0; 6]);
    let model = loaded("half", &result, |settings| settings.half = true).unwrap();
    let half = body();
    let added = 2.0 * half.mass * half.cg.y.powi(2);
    let Inertia { xx, yy, zz, xz } = half.inertia;
    let whole = RigidBody {
        mass: 2.0 * half.mass,
        cg: Vec3::new(half.cg.x, 0.0, half.cg.z),
        inertia: Inertia {
            xx: 2.0 * xx + added,
            yy: 2.0 * yy,
            zz: 2.0 * zz + added,
            xz: 2.0 * xz,
        },
    };
    assert_body(&model.rigid_body.unwrap(), &whole, 1e-11);
    assert_eq!(model.elastic[1].generalised_mass, 8.0);
}

#[test]
fn products_of_inertia_without_a_place_are_named() {
    let mut result = structure([1.0; 6]);
    result.stated_mass = Some(body());
    let named = |model: &fladder_modal::StructuralModel| {
        model
            .notes
            .iter()
            .any(|note| note.contains("across the plane y = 0"))
    };
    assert!(!named(&loaded("products", &result, |_| {}).unwrap()));
    let turned = loaded("products", &result, |settings| {
        settings.axes = Axes::from_names(["y", "-x", "z"]).unwrap();
    });
    let turned = turned.unwrap();
    assert!(named(&turned));
    assert_eq!(turned.rigid_body.unwrap().inertia.xx, body().inertia.yy);
}

/// The fields of schema `fladder.modes/1`.
#[test]
fn the_summary_serialises_to_the_fields_scripts_read() {
    let result = structure([1.0; 6]);
    let path = file("summary", "model.frd", frd(&result));
    let summary = fladder_modal::modes_summary(&path, None, None).unwrap();
    let json = serde_json::to_value(&summary).unwrap();
    assert_eq!(json["schema"], "fladder.modes/1");
    assert_eq!(json["format"], "calculix-frd");
    assert_eq!(json["nodes"], result.nodes.len());
    assert_eq!(json["modes"][7]["index"], 8);
    assert_eq!(json["modes"][7]["frequency_hz"], 12.0);
    assert_eq!(json["modes"][7]["generalised_mass"], 4.0);
    assert_eq!(
        (&json["modes"][5]["rigid"], &json["modes"][7]["rigid"]),
        (&true.into(), &false.into())
    );
    assert!((json["mass"].as_f64().unwrap() / body().mass - 1.0).abs() < 1e-4);
    assert!((json["cg"][1].as_f64().unwrap() - body().cg.y).abs() < 1e-3);
    for key in ["xx", "yy", "zz", "xz"] {
        assert!(json["inertia"][key].is_number(), "{key}");
    }
}

#[test]
fn given_mass_properties_win_and_both_are_kept() {
    let result = structure([1.0; 6]);
    let given = RigidBodySettings {
        mass: Some(20.0),
        ..RigidBodySettings::default()
    };
    let model = loaded("given", &result, |settings| settings.rigid_body = given).unwrap();
    let used = model.rigid_body.unwrap();
    assert_eq!(used.mass, 20.0);
    assert!((used.inertia.yy - body().inertia.yy).abs() < 1e-10);
    assert!((model.rigid_body_from_file.unwrap().body.mass - body().mass).abs() < 1e-10);
    let mut five = result.clone();
    five.modes.remove(3);
    assert_eq!(loaded("given", &five, |_| {}).unwrap().rigid_body, None);
    match loaded("given", &five, |settings| settings.rigid_body = given) {
        Err(StructureError::RigidBody(RigidBodyError::Missing {
            name: "cg",
            rigid: 5,
        })) => {}
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_mechanism_is_named() {
    let model = loaded("mechanism", &structure([1.0; 6]), |_| {}).unwrap();
    let note = "elastic:1 (mode 7) has no stiffness and is no rigid motion: a mechanism";
    assert!(
        model.notes.iter().any(|found| found == note),
        "{:?}",
        model.notes
    );
}

#[test]
fn left_handed_and_unknown_axes_are_refused() {
    let refused = Axes::from_names(["-x", "y", "z"]).unwrap_err();
    assert!(refused.to_string().contains("mirror"), "{refused}");
    assert!(Axes::from_names(["x", "x", "z"]).is_err());
    assert!(Axes::from_names(["x", "w", "z"]).is_err());
    let turned = Axes::from_names(["y", "-x", "z"]).unwrap().turn(&Vec3::x());
    assert_eq!(turned, Vec3::y());
}

/// The definitions: 1 lbf = 0.453 592 37 kg × 9.806 65 m/s²; 1 slug = 1 lbf s²/ft.
#[test]
fn units_are_those_of_the_standards() {
    assert!((Units::FootSlug.mass() / 14.593_902_937_206 - 1.0).abs() < 1e-12);
    assert!((Units::InchPoundForce.mass() / (12.0 * 14.593_902_937_206) - 1.0).abs() < 1e-12);
    assert_eq!(Units::MillimetreTonne.length() * 1000.0, 1.0);
    for name in ["m-kg-s", "mm-t-s", "in-lbf-s", "ft-slug-s"] {
        assert_eq!(Units::from_name(name).unwrap().name(), name);
    }
}

/// Six rigid modes by formula are those of the analytic rotations and
/// translations, scaled.
#[test]
fn rigid_modes_are_scaled_analytic_motions() {
    let points = common::surface().vertices;
    let body = body();
    let modes = rigid_modes(&body, &points);
    let Inertia { xx, yy, zz, .. } = body.inertia;
    for (k, inertia) in [xx, yy, zz].into_iter().enumerate() {
        let axis = Vec3::ith(k, 3.0);
        let turn = AnalyticMode {
            name: "turn".to_owned(),
            motion: Motion::Rotation {
                axis,
                point: body.cg,
            },
        };
        let turned: Vec<Vec3> = turn
            .on(&points)
            .unwrap()
            .displacement
            .iter()
            .map(|u| u / inertia.sqrt())
            .collect();
        assert!(common::largest_error(&modes[3 + k].displacement, &turned) < 1e-14);
        let shift = Vec3::ith(k, 1.0 / body.mass.sqrt());
        assert!(
            modes[k]
                .displacement
                .iter()
                .all(|u| (u - shift).norm() < 1e-15)
        );
    }
}

/// Six digits, as a `.frd` file has them, leave the rigid modes recognisable.
#[test]
fn six_printed_digits_are_enough_to_recognise_rigid_modes() {
    let result = structure([1.0; 6]);
    let path = file("six_digits", "model.frd", frd(&result));
    let settings = StructureSettings {
        file: path,
        ..StructureSettings::default()
    };
    let model = load(&settings).unwrap();
    assert_eq!(model.survey.rigid_count(), 6);
    assert_body(&model.rigid_body.unwrap(), &body(), 1e-4);
}
