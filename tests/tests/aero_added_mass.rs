//! Added mass of closed bodies without a wake, against exact values.

mod common;

use common::{csv, mode, solved};
use fladder_bem::Flow;
use fladder_mesh::shapes::{ellipsoid, icosphere};
use fladder_mesh::{Frame, TriMesh, Vec3};

/// Added masses along x, y, z at ρ = 1: the force on a unit translation in body axes at
/// large s is −s² A, and Q = 2 F, s = p / b with b = 1.
fn added_mass(mesh: &TriMesh, p: faer::c64) -> [f64; 3] {
    let modes = [Vec3::x(), Vec3::y(), Vec3::z()]
        .map(|e| mode(mesh, "translation", Frame::Body, move |_| e));
    let solution = solved(mesh, &[], &modes, Flow::default(), 1.0);
    let q = solution.transfer.q(p).expect("no cut without a wake");
    std::array::from_fn(|i| (-q[(i, i)] / (2.0 * p * p)).re)
}

#[test]
fn added_mass_of_a_sphere_converges_at_second_order() {
    // Exact: half the displaced mass (Lamb, Hydrodynamics, art. 92).
    let exact = 2.0 / 3.0 * std::f64::consts::PI;
    let errors: Vec<f64> = [4, 8, 16]
        .iter()
        .map(|&n| {
            let mesh = icosphere(n);
            let error = 1.0 - added_mass(&mesh, faer::c64::new(0.3, 2.0))[2] / exact;
            println!(
                "sphere, {} vertices: added mass {:+.3} %",
                mesh.vertices.len(),
                -100.0 * error
            );
            error
        })
        .collect();
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        println!("order {order:.2}");
        assert!((1.8..2.3).contains(&order));
    }
    assert!(errors[2].abs() < 5e-3);
}

#[test]
fn added_mass_of_ellipsoids() {
    for row in csv("ellipsoid_added_mass_open.csv") {
        let number = |key: &str| row[key].parse::<f64>().expect("number");
        let axes = [number("a"), number("b"), number("c")];
        let mesh = ellipsoid(axes, 12);
        let found = added_mass(&mesh, faer::c64::new(-0.2, 1.0));
        let exact = [number("A_x"), number("A_y"), number("A_z")];
        let largest = exact.iter().copied().fold(0.0, f64::max);
        for (axis, (a, b)) in ["x", "y", "z"].iter().zip(found.iter().zip(&exact)) {
            let error = (a - b) / largest;
            println!(
                "{} {axis}: {a:.4}, exact {b:.4}, {:+.2} % of the largest",
                row["name"],
                100.0 * error
            );
            assert!(error.abs() < 0.02);
        }
    }
}
