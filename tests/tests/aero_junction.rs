//! The wake of a wing that ends on a fuselage, on the ScanEagle-like surface.

use fladder_bem::{Flow, Solution};
use fladder_mesh::{Frame, TriMesh, Vec3, read};
use fladder_tests::case::{Setup, mode};
use std::path::Path;

fn aircraft() -> TriMesh {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../meshes/scaneagle_3k.msh");
    read::read_mesh(path, 1.0).expect("the committed mesh")
}

/// With the body lines named in the mesh, or traced.
fn at_three_degrees(mesh: &TriMesh, body_lines: Option<&str>) -> Solution {
    let modes = [
        mode(mesh, "rigid:z", Frame::Body, |_| Vec3::z()),
        mode(mesh, "rigid:y", Frame::Body, |_| Vec3::y()),
    ];
    let setup = Setup {
        flow: Flow {
            alpha: 3_f64.to_radians(),
            beta: 0.0,
        },
        body_lines,
        semichord: 0.115,
        ..Setup::new(mesh, &modes)
    };
    setup.solve().expect("a sound aircraft")
}

/// The jump is carried along the body: no suction peak at junction or tail, no pressure
/// drag beyond the induced, lift by pressure equal to that of the wake.
#[test]
fn a_junction_leaves_no_false_suction() {
    let mesh = aircraft();
    let (named, traced) = (
        at_three_degrees(&mesh, Some("bodywake")),
        at_three_degrees(&mesh, None),
    );
    let steady = &named.steady;
    let ratio = steady.lift_by_pressure / steady.lift_by_wake_jump;
    println!(
        "lowest c_p {:.3}, lift by pressure / by wake {ratio:.4}",
        steady.lowest_pressure.0
    );
    // The section at 3° has its peak near −0.8 at the wing's nose; at a wrong junction
    // it is below −6.
    assert!((-1.2..-0.4).contains(&steady.lowest_pressure.0));
    assert!((ratio - 1.0).abs() < 0.02);
    for jump in &steady.wake_jumps {
        let at_body = if jump.on_body[0] {
            0
        } else {
            jump.jumps.len() - 1
        };
        let next = if jump.on_body[0] { 1 } else { at_body - 1 };
        let (root, inner) = (jump.jumps[at_body], jump.jumps[next]);
        println!("wake jump at the junction {root:.4} m, at the next vertex {inner:.4} m");
        assert!(root > 0.0 && (root / inner - 1.0).abs() < 0.1);
    }
    let slope = |s: &Solution| s.transfer.q(faer::c64::new(0.0, 0.1)).expect("Q")[(0, 0)];
    let difference = (slope(&named) - slope(&traced)).norm() / slope(&named).norm();
    println!("Q_zz with named and traced body lines: apart by {difference:.1e}");
    assert!(difference < 1e-3);
    // Symmetric aircraft, symmetric flow: plunge and sway do not see each other.
    let q = named.transfer.q(faer::c64::new(0.0, 0.1)).expect("Q");
    println!("Q_yz / Q_zz {:.1e}", q[(1, 0)].norm() / q[(0, 0)].norm());
    assert!(q[(1, 0)].norm() < 1e-9 * q[(0, 0)].norm());
}
