//! Splines between the nodes of beams, test points and skins and the surface.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use common::{HINGE, SPAN, largest_error, mapping, sample, stations, surface, wing};
use fladder_mesh::{TriMesh, Vec3};
use fladder_modal::{
    Kernel, Mapping, Method, ModalResult, Mode, NamedSet, Node, Transfer, TransferError,
    TransferSettings, build_transfer,
};

const KERNELS: [Kernel; 2] = [Kernel::Polyharmonic, Kernel::ThinPlate];

fn rigid(p: &Vec3) -> Vec3 {
    Vec3::new(1.0, -5.0, 2.0) + Vec3::new(0.3, -0.2, 0.7).cross(p)
}

/// Classical bending, w = (y/L)² with sections turned by w'.
fn bend(p: &Vec3) -> Vec3 {
    Vec3::new(0.0, -p.z * 2.0 * p.y / (SPAN * SPAN), (p.y / SPAN).powi(2))
}

/// Rotation of the sections in that bending.
fn bend_rotation(p: &Vec3) -> Vec3 {
    Vec3::new(2.0 * p.y / (SPAN * SPAN), 0.0, 0.0)
}

fn splines(kernel: Kernel) -> TransferSettings {
    TransferSettings {
        default_method: Method::Spline(kernel),
        ..TransferSettings::default()
    }
}

/// Nodes without elements, as a ground vibration test leaves them.
fn points(positions: Vec<Vec3>) -> ModalResult {
    let mut result = wing().result();
    result.elements.clear();
    result.element_sets.clear();
    result.nodes = positions
        .into_iter()
        .enumerate()
        .map(|(k, position)| Node {
            id: k as u64 + 1,
            position,
        })
        .collect();
    result
}

fn with_rotations(mut result: ModalResult) -> ModalResult {
    let count = result.nodes.len();
    result.modes = vec![Mode {
        index: 1,
        frequency_hz: 1.0,
        eigenvalue: 1.0,
        generalised_mass: 1.0,
        generalised_stiffness: 1.0,
        displacement: vec![Vec3::z(); count],
        rotation: Some(vec![Vec3::zeros(); count]),
        participation: None,
    }];
    result
}

fn errors(transfer: &Transfer, result: &ModalResult, mesh: &TriMesh) -> [f64; 2] {
    let fields: [fn(&Vec3) -> Vec3; 2] = [rigid, bend];
    let rotations: [fn(&Vec3) -> Vec3; 2] = [|_| Vec3::new(0.3, -0.2, 0.7), bend_rotation];
    [0, 1].map(|k| {
        let mut nodal = sample(&result.positions(), fields[k]);
        if transfer.matrix.columns() > nodal.len() {
            nodal.extend(sample(&result.positions(), rotations[k]));
        }
        let found = transfer.matrix.displacement(&nodal);
        largest_error(&found, &sample(&mesh.vertices, fields[k]))
    })
}

#[test]
fn skins_carry_rigid_motion_to_1e_12_and_bending_to_1e_3() {
    let (result, mesh) = (wing().result(), surface());
    for kernel in KERNELS {
        let settings = TransferSettings {
            components: mapping(),
            ..splines(kernel)
        };
        let transfer = build_transfer(&result, &mesh, &settings).unwrap();
        let [rigid, bent] = errors(&transfer, &result, &mesh);
        println!("{kernel:?} on skins: rigid {rigid:.1e}, bending {bent:.1e}");
        assert!(rigid < 1e-12 && bent < 1e-3);
    }
}

#[test]
fn a_hinge_rotation_moves_its_surface_exactly_and_nothing_else() {
    let (result, mesh) = (wing().result(), surface());
    let hinge = Vec3::new(HINGE, 0.0, 0.0);
    let turned = |p: &Vec3| Vec3::y().cross(&(p - hinge));
    let settings = TransferSettings {
        components: mapping(),
        ..splines(Kernel::Polyharmonic)
    };
    let transfer = build_transfer(&result, &mesh, &settings).unwrap();
    let nodal = sample(&result.positions(), |p| {
        if p.x > HINGE - 0.01 {
            turned(p)
        } else {
            Vec3::zeros()
        }
    });
    let found = transfer.matrix.displacement(&nodal);
    let (mut worst, mut flap) = (0.0_f64, 0);
    for (vertex, u) in mesh.vertices.iter().zip(&found) {
        if vertex.x > HINGE + 1e-9 {
            worst = worst.max((u - turned(vertex)).norm());
            flap += 1;
        } else {
            assert_eq!(*u, Vec3::zeros(), "{vertex:?}");
        }
    }
    println!("{flap} vertices turn with the flap, largest error {worst:.1e}");
    assert!(worst < 1e-13 && flap > 300);
}

/// Transducers on the mean plane, none on the skin: vertices above and
/// below turn with the plane.
#[test]
fn test_points_on_one_sheet_carry_the_surface_about_them() {
    let mesh = surface();
    let sheet = |count| {
        let lines = stations(0.0, SPAN, count).into_iter();
        points(
            lines
                .flat_map(|y| [0.0, 0.35, 0.7, 1.0].map(|x| Vec3::new(x, y, 0.0)))
                .collect(),
        )
    };
    // The thin plate bends less willingly near an edge and takes twice the points.
    for (kernel, count) in [(Kernel::Polyharmonic, 14), (Kernel::ThinPlate, 28)] {
        let result = sheet(count);
        let transfer = build_transfer(&result, &mesh, splines(kernel)).unwrap();
        let [rigid, bent] = errors(&transfer, &result, &mesh);
        println!("{kernel:?} on a sheet of {count}: rigid {rigid:.1e}, bending {bent:.1e}");
        assert!(rigid < 1e-12 && bent < 1e-3);
        let part = &transfer.report.components[0];
        assert_eq!(part.mapping, Mapping::AllNodes);
        assert_eq!((part.faces, part.uncovered), (4 * (count + 1), 0));
    }
}

#[test]
fn a_beam_with_rotations_carries_a_wing_and_one_without_is_refused() {
    let mesh = surface();
    let line = stations(0.0, SPAN, 24)
        .into_iter()
        .map(|y| Vec3::new(0.4, y, 0.0));
    let beam = points(line.collect());
    match build_transfer(&beam, &mesh, splines(Kernel::Polyharmonic)) {
        Err(TransferError::OnOneLine { points: 25, .. }) => {}
        other => panic!("{other:?}"),
    }
    let beam = with_rotations(beam);
    for kernel in KERNELS {
        let transfer = build_transfer(&beam, &mesh, splines(kernel)).unwrap();
        let [rigid, bent] = errors(&transfer, &beam, &mesh);
        println!("{kernel:?} on a beam: rigid {rigid:.1e}, bending {bent:.1e}");
        assert!(rigid < 1e-12 && bent < 1e-3);
    }
}

#[test]
fn forces_and_displacements_do_the_same_work_on_both_sides() {
    let mesh = surface();
    let line = stations(0.0, SPAN, 24)
        .into_iter()
        .map(|y| Vec3::new(0.4, y, 0.0));
    let beam = with_rotations(points(line.collect()));
    let transfer = build_transfer(&beam, &mesh, splines(Kernel::ThinPlate)).unwrap();
    let columns: Vec<Vec3> = (0..transfer.matrix.columns())
        .map(|k| {
            Vec3::new(
                1.0 + (0.3 * k as f64).sin(),
                0.1 * k as f64,
                (k as f64).cos(),
            )
        })
        .collect();
    let forces = sample(&mesh.vertices, |p| {
        Vec3::new(p.z, (2.0 * p.x).cos(), p.y * p.y - 3.0)
    });
    let work = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| a.dot(b)).sum::<f64>();
    let on_surface = work(&forces, &transfer.matrix.displacement(&columns));
    let on_structure = work(&transfer.matrix.force(&forces), &columns);
    assert!((on_surface / on_structure - 1.0).abs() < 1e-12);
}

#[test]
fn a_method_is_chosen_for_a_group_and_its_points_by_a_node_set() {
    let (mut result, mesh) = (wing().result(), surface());
    let flap = (0..result.nodes.len() as u32)
        .filter(|node| result.nodes[*node as usize].position.x > HINGE)
        .collect();
    result.node_sets.push(NamedSet {
        name: "FLAP NODES".to_owned(),
        members: flap,
    });
    let mut settings = TransferSettings::from(&mapping());
    let method = Method::Spline(Kernel::ThinPlate);
    settings.methods.insert("elevon".to_owned(), method);
    let sets = vec!["FLAP NODES".to_owned()];
    settings.components.insert("elevon".to_owned(), sets);
    let transfer = build_transfer(&result, &mesh, &settings).unwrap();
    let methods: Vec<Method> = transfer
        .report
        .components
        .iter()
        .map(|part| part.method)
        .collect();
    assert!(
        methods.contains(&method) && methods.contains(&Method::Faces),
        "{methods:?}"
    );
    assert!(errors(&transfer, &result, &mesh)[0] < 1e-12);

    settings.methods.insert("rudder".to_owned(), method);
    let refused = build_transfer(&result, &mesh, &settings).unwrap_err();
    assert!(
        matches!(refused, TransferError::NoSuchGroup { .. }),
        "{refused}"
    );
}
