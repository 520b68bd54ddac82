//! Half models of wings on bodies against the whole.

#[allow(dead_code, reason = "each test file uses its part")]
mod wake_cases;

use faer::c64;
use fladder_bem::{Problem, Silent, Solution, Symmetry, WakeDirection, solve};
use fladder_mesh::shapes::Tail;
use fladder_mesh::trailing_edge::{Settings, find_by_shape};
use fladder_mesh::{Frame, SurfaceMode, Topology, TriMesh, Vec3, read};
use std::path::Path;
use wake_cases::{wing_body, wings};

/// The part on y ≥ 0 of a mesh with vertices in y = 0.
fn half_of(mesh: &TriMesh) -> TriMesh {
    let mut half = TriMesh::default();
    let mut number = vec![u32::MAX; mesh.vertices.len()];
    for t in 0..mesh.triangles.len() {
        if mesh.corners(t).iter().map(|v| v.y).sum::<f64>() <= 0.0 {
            continue;
        }
        half.triangles.push(mesh.triangles[t].map(|v| {
            let place = &mut number[v as usize];
            if *place == u32::MAX {
                let mut vertex = mesh.vertices[v as usize];
                assert!(vertex.y > -1e-12, "no line of edges in the plane");
                if vertex.y < 1e-12 {
                    vertex.y = 0.0;
                }
                *place = half.vertices.len() as u32;
                half.vertices.push(vertex);
            }
            *place
        }));
    }
    half
}

fn solved(mesh: &TriMesh, modes: &[SurfaceMode], symmetry: Symmetry) -> Solution {
    let edges = find_by_shape(mesh, &Topology::new(mesh), Settings::default());
    let problem = Problem {
        symmetry,
        flow: fladder_bem::Flow {
            alpha: 0.05,
            beta: 0.0,
        },
        wake_direction: WakeDirection::X,
        ..Problem::new(mesh, &edges, modes, 0.3)
    };
    solve(&problem, &Silent).expect("a solution")
}

fn modes(mesh: &TriMesh, symmetry: Symmetry) -> Vec<SurfaceMode> {
    let mode = |name: &str, frame, field: fn(&Vec3) -> Vec3| SurfaceMode {
        name: name.into(),
        frame,
        displacement: mesh.vertices.iter().map(field).collect(),
    };
    if symmetry == Symmetry::Antisymmetric {
        vec![
            mode("sway", Frame::Body, |_| Vec3::y()),
            mode("roll", Frame::Body, |x| Vec3::new(0.0, -x.z, x.y)),
            mode("bending", Frame::Inertial, |x| Vec3::z() * x.y * x.y.abs()),
        ]
    } else {
        vec![
            mode("heave", Frame::Body, |_| Vec3::z()),
            mode("pitch", Frame::Body, |x| Vec3::new(x.z, 0.0, -x.x)),
            mode("bending", Frame::Inertial, |x| Vec3::z() * x.y * x.y),
        ]
    }
}

fn assert_equal(name: &str, whole: &TriMesh, kinds: &[Symmetry], limit: f64) {
    let half = half_of(whole);
    for &symmetry in kinds {
        let reference = solved(whole, &modes(whole, symmetry), Symmetry::None);
        let model = solved(&half, &modes(&half, symmetry), symmetry);
        for p in [c64::new(0.0, 0.3), c64::new(-0.1, 0.2), c64::new(0.05, 0.0)] {
            let (q, wanted) = (
                model.transfer.q(p).expect("Q"),
                reference.transfer.q(p).expect("Q"),
            );
            let difference = (&q - &wanted).norm_max() / wanted.norm_max();
            println!("{name}, {symmetry:?}, p = {p}: half against whole {difference:.1e}");
            assert!(difference < limit, "{q:?} {wanted:?}");
        }
        let (a, b) = (&model.steady, &reference.steady);
        let scale = b.loads.force[2].abs();
        for axis in [0, 2] {
            assert!((a.loads.force[axis] - b.loads.force[axis]).abs() < limit * scale);
        }
        assert!((a.lift_by_wake_jump - b.lift_by_wake_jump).abs() < limit * scale);
        let drag = [a, b].map(|s| s.induced_drag.expect("a closed sheet"));
        assert!((drag[0] - drag[1]).abs() < limit * scale, "{drag:?}");
    }
}

/// Body lines that end in the plane in a point, or over a base.
#[test]
fn half_a_wing_and_body() {
    let both = [Symmetry::Symmetric, Symmetry::Antisymmetric];
    assert_equal("pointed", &wing_body(Tail::Pointed, wings()), &both, 1e-9);
    assert_equal("blunt", &wing_body(Tail::Blunt, wings()), &both, 1e-9);
    // A knife's edge lies in the plane: it carries no jump in symmetric motion.
    let knife = wing_body(Tail::Knife, wings());
    assert_equal("knife", &knife, &[Symmetry::Symmetric], 1e-9);
}

/// The mesh of the aircraft is symmetric to the digits of its file.
#[test]
fn half_an_aircraft() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes/scaneagle_3k.msh");
    let whole = read::read_mesh(path, 1.0).expect("the committed mesh");
    let both = [Symmetry::Symmetric, Symmetry::Antisymmetric];
    assert_equal("aircraft", &whole, &both, 1e-9);
}
