//! The transfer of displacements and forces between structure and surface.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use common::{HINGE, SPAN, largest_error, mapping, sample, surface, wing};
use fladder_mesh::{TriMesh, Vec3};
use fladder_modal::{
    ElementKind, Mapping, ModalResult, Transfer, TransferError, build_transfer,
};
use std::collections::BTreeMap;

fn carried() -> (ModalResult, TriMesh, Transfer) {
    let (result, mesh) = (wing().result(), surface());
    let transfer = build_transfer(&result, &mesh, &mapping()).unwrap();
    (result, mesh, transfer)
}

#[test]
fn rigid_motion_is_carried_to_1e_12() {
    let (result, mesh, transfer) = carried();
    let (turn, shift) = (Vec3::new(0.3, -0.2, 0.7), Vec3::new(1.0, -5.0, 2.0));
    let rigid = |p: &Vec3| shift + turn.cross(p);
    let found = transfer
        .matrix
        .displacement(&sample(&result.positions(), rigid));
    let error = largest_error(&found, &sample(&mesh.vertices, rigid));
    println!("rigid motion: relative error {error:.1e}");
    assert!(error < 1e-12, "{error:e}");
}

/// Classical bending, w = (y/L)² with sections turned by w'.
#[test]
fn parabolic_bending_is_carried_to_1e_3() {
    let (result, mesh, transfer) = carried();
    let bend =
        |p: &Vec3| Vec3::new(0.0, -p.z * 2.0 * p.y / (SPAN * SPAN), (p.y / SPAN).powi(2));
    let found = transfer
        .matrix
        .displacement(&sample(&result.positions(), bend));
    let error = largest_error(&found, &sample(&mesh.vertices, bend));
    println!("parabolic bending: relative error {error:.1e}");
    assert!(error < 1e-3, "{error:e}");
}

/// The flap turned by 1 rad about its hinge, the wing at rest.
#[test]
fn a_hinge_rotation_moves_its_surface_exactly_and_nothing_else() {
    let (result, mesh, transfer) = carried();
    let hinge = Vec3::new(HINGE, 0.0, 0.0);
    let turned = |p: &Vec3| Vec3::y().cross(&(p - hinge));
    let on_flap = |p: &Vec3| {
        if p.x > HINGE - 0.01 {
            turned(p)
        } else {
            Vec3::zeros()
        }
    };
    let found = transfer
        .matrix
        .displacement(&sample(&result.positions(), on_flap));
    let (mut flap, mut rest) = (0, 0);
    for (vertex, u) in mesh.vertices.iter().zip(&found) {
        if vertex.x > HINGE + 1e-9 {
            assert!((u - turned(vertex)).norm() < 1e-14, "{vertex:?}");
            flap += 1;
        } else {
            assert_eq!(*u, Vec3::zeros(), "{vertex:?}");
            rest += 1;
        }
    }
    println!("{flap} vertices turn with the flap, {rest} rest");
    assert!(flap > 300 && rest > 700);
}

#[test]
fn forces_and_displacements_do_the_same_work_on_both_sides() {
    let (result, mesh, transfer) = carried();
    let nodal = sample(&result.positions(), |p| {
        Vec3::new(p.y.sin(), p.x * p.y, (3.0 * p.x).cos())
    });
    let forces = sample(&mesh.vertices, |p| {
        Vec3::new(p.z, (2.0 * p.x).cos(), p.y * p.y - 3.0)
    });
    let work = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| a.dot(b)).sum::<f64>();
    let on_surface = work(&forces, &transfer.matrix.displacement(&nodal));
    let on_structure = work(&transfer.matrix.force(&forces), &nodal);
    let error = (on_surface / on_structure - 1.0).abs();
    println!("virtual work: {on_surface} and {on_structure}, relative error {error:.1e}");
    assert!(error < 1e-12);
}

/// Forces keep their resultant, because translations are carried exactly.
#[test]
fn the_resultant_force_and_moment_are_kept() {
    let (result, mesh, transfer) = carried();
    let forces = sample(&mesh.vertices, |p| Vec3::new(0.1, p.x, 1.0 + p.y));
    let moment = |points: &[Vec3], forces: &[Vec3]| {
        points
            .iter()
            .zip(forces)
            .map(|(p, f)| p.cross(f))
            .sum::<Vec3>()
    };
    let nodal = transfer.matrix.force(&forces);
    let (before, after) = (forces.iter().sum::<Vec3>(), nodal.iter().sum::<Vec3>());
    assert!((before - after).norm() < 1e-12 * before.norm());
    let (before, after) = (
        moment(&mesh.vertices, &forces),
        moment(&result.positions(), &nodal),
    );
    assert!((before - after).norm() < 1e-12 * before.norm());
}

/// A field in the space of an element is that element's field at its own points.
#[test]
fn a_point_of_the_structure_takes_the_displacement_of_the_structure() {
    let shells = wing();
    let mut result = shells.result();
    result.elements.retain(|element| element.id <= 40);
    result.element_sets.clear();
    let mut mesh = TriMesh {
        vertices: result.positions(),
        ..TriMesh::default()
    };
    for element in &result.elements {
        let n = &element.nodes;
        mesh.triangles.push([n[0], n[1], n[2]]);
        mesh.triangles.push([n[4], n[5], n[6]]);
    }
    let transfer = build_transfer(&result, &mesh, &BTreeMap::new()).unwrap();
    let field = sample(&result.positions(), |p| {
        Vec3::new(p.x.sin(), p.y.cos(), p.x * p.y)
    });
    let found = transfer.matrix.displacement(&field);
    let mut compared = 0;
    for vertex in mesh.triangles.iter().flatten() {
        let vertex = *vertex as usize;
        assert!(
            (found[vertex] - field[vertex]).norm() < 1e-13,
            "node {vertex}"
        );
        compared += 1;
    }
    assert!(compared > 200);
}

#[test]
fn webs_and_ribs_carry_no_surface_and_are_named() {
    let (_, _, transfer) = carried();
    let report = &transfer.report;
    println!("{report:#?}");
    assert_eq!(report.left_out.len(), 1);
    for set in ["WEB (8)", "RIB ("] {
        assert!(report.left_out[0].contains(set), "{:?}", report.left_out);
    }
    assert!(!report.left_out[0].contains("TOP") && !report.left_out[0].contains("FLAP"));
    assert!(report.overlap > 0.99 && report.largest_distance < 0.06);
    assert!(
        report
            .components
            .iter()
            .all(|part| part.mapping == Mapping::Given)
    );
}

#[test]
fn connectivity_finds_the_same_structure_as_the_given_sets() {
    let (result, mesh, given) = carried();
    let found = build_transfer(&result, &mesh, &BTreeMap::new()).unwrap();
    assert!(
        found
            .report
            .components
            .iter()
            .all(|p| p.mapping == Mapping::Connectivity)
    );
    let flap = found
        .report
        .components
        .iter()
        .find(|part| part.name == "elevon")
        .unwrap();
    assert_eq!(flap.sets, ["FLAP"]);
    let field = sample(&result.positions(), |p| {
        Vec3::new(p.x, p.y * p.y, p.x * p.y)
    });
    let (a, b) = (
        given.matrix.displacement(&field),
        found.matrix.displacement(&field),
    );
    // The ribs at the two tips do lie on the surface, so that only they differ.
    for ((a, b), vertex) in a.iter().zip(&b).zip(&mesh.vertices) {
        let inside = vertex.y > 0.01 && vertex.y < SPAN - 0.01;
        assert!(!inside || (a - b).norm() < 1e-14, "{vertex:?}");
    }
}

#[test]
fn sets_of_the_same_name_as_a_group_carry_it() {
    let (mut result, mesh, _) = carried();
    for set in &mut result.element_sets {
        if set.name == "FLAP" {
            set.name = "ELEVON".to_owned();
        }
    }
    let found = build_transfer(&result, &mesh, &BTreeMap::new()).unwrap();
    let how: Vec<_> = found
        .report
        .components
        .iter()
        .map(|p| (&*p.name, p.mapping))
        .collect();
    assert_eq!(
        how,
        [
            ("wing", Mapping::Connectivity),
            ("elevon", Mapping::EqualName)
        ]
    );
}

/// Without groups in the mesh every triangle follows the piece nearest to it.
#[test]
fn a_mesh_without_groups_is_parted_by_the_structure() {
    let (result, mut mesh, _) = carried();
    mesh.surfaces.clear();
    let found = build_transfer(&result, &mesh, &BTreeMap::new()).unwrap();
    let names: Vec<_> = found
        .report
        .components
        .iter()
        .map(|part| &*part.name)
        .collect();
    assert_eq!(names, ["no group 1", "no group 2"]);
}

#[test]
fn the_skin_of_solids_is_their_free_faces() {
    let mut result = wing().result();
    let mesh = surface();
    let positions = result.positions();
    result.elements.clear();
    result.element_sets.clear();
    let find = |target: Vec3| {
        positions
            .iter()
            .position(|p| (p - target).norm() < 1e-9)
            .map(|k| k as u32)
            .unwrap()
    };
    let (chord, span) = (
        common::stations(0.0, 0.7, 5),
        common::stations(0.0, SPAN, 8),
    );
    for x in chord[1..].windows(2) {
        for y in span.windows(2) {
            let corner = |x: f64, y: f64, side: f64| {
                find(Vec3::new(x, y, side * common::half_thickness(x)))
            };
            let ring = |s: f64| {
                [
                    corner(x[0], y[0], s),
                    corner(x[1], y[0], s),
                    corner(x[1], y[1], s),
                    corner(x[0], y[1], s),
                ]
            };
            let id = result.elements.len() as u64 + 1;
            let nodes = [ring(-1.0), ring(1.0)].concat();
            result.elements.push(fladder_modal::Element {
                id,
                kind: ElementKind::Hex8,
                nodes,
            });
        }
    }
    let transfer = build_transfer(&result, &mesh, &BTreeMap::new()).unwrap();
    // 4 × 8 bricks: top and bottom lie on the surface, and the ends at the tips.
    let faces: usize = transfer.report.components[0].faces;
    assert_eq!(faces, 2 * 4 * 8 + 2 * 4);
    let rigid = |p: &Vec3| Vec3::new(0.1, 0.2, 0.3).cross(p);
    let found = transfer.matrix.displacement(&sample(&positions, rigid));
    assert!(largest_error(&found, &sample(&mesh.vertices, rigid)) < 1e-12);
}

#[test]
fn a_structure_in_other_units_is_refused_with_the_ratio() {
    let (mut result, mesh) = (wing().result(), surface());
    result
        .nodes
        .iter_mut()
        .for_each(|node| node.position *= 1000.0);
    match build_transfer(&result, &mesh, &mapping()) {
        Err(TransferError::Size { ratio, .. }) => {
            println!("ratio {ratio:e}");
            assert!((ratio - 1e-3).abs() < 1e-5);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_structure_in_other_axes_is_refused_with_the_axes_that_match() {
    let (mut result, mesh) = (wing().result(), surface());
    for node in &mut result.nodes {
        let p = node.position;
        node.position = Vec3::new(p.y, -p.x, p.z);
    }
    match build_transfer(&result, &mesh, &BTreeMap::new()) {
        Err(TransferError::Apart { overlap, hint }) => {
            println!("overlap {overlap:.2}: {hint}");
            assert!(hint.contains(r#"["y", "-x", "z"]"#));
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn unknown_groups_and_sets_are_named_with_those_that_exist() {
    let (result, mesh) = (wing().result(), surface());
    let mut wrong = mapping();
    wrong.insert("rudder".to_owned(), vec!["FLAP".to_owned()]);
    let message = build_transfer(&result, &mesh, &wrong)
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("rudder") && message.contains("wing"),
        "{message}"
    );
    let mut wrong = mapping();
    wrong.insert("elevon".to_owned(), vec!["FLAPS".to_owned()]);
    let message = build_transfer(&result, &mesh, &wrong)
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("FLAPS") && message.contains("\"FLAP\""),
        "{message}"
    );
}

#[test]
fn a_structure_of_beams_is_refused() {
    let mut result = wing().result();
    for element in &mut result.elements {
        element.kind = ElementKind::Line2;
        element.nodes.truncate(2);
    }
    let failed = build_transfer(&result, &surface(), &mapping()).unwrap_err();
    assert!(matches!(failed, TransferError::NoSkin { .. }), "{failed}");
}

#[test]
fn the_matrix_has_the_same_bits_at_one_and_at_four_threads() {
    let (result, mesh) = (wing().result(), surface());
    let build = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| build_transfer(&result, &mesh, &mapping()).unwrap())
    };
    assert_eq!(build(1), build(4));
}
