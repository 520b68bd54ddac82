//! Steady lift of wings with thickness against limits of grid refinement.

mod common;

use common::{csv, edges, mode, solved};
use fladder_bem::Flow;
use fladder_mesh::shapes::NacaWing;
use fladder_mesh::{Frame, TriMesh, Vec3};

/// Lift slope per rad, and the ratio of lift by pressure to lift by wake jump at 4°.
///
/// The slope is a difference: an unstructured mesh, not symmetric about its chord plane,
/// has a little lift at no incidence.
fn lift(mesh: &TriMesh, area: f64) -> (f64, f64) {
    let plunge = mode(mesh, "plunge", Frame::Inertial, |_| Vec3::z());
    let flow = Flow {
        alpha: 4_f64.to_radians(),
        beta: 0.0,
    };
    let steady = solved(mesh, &edges(mesh), &[plunge], flow, 0.5).steady;
    let force_at = |alpha: f64| steady.loads_at([alpha.cos(), 0.0, alpha.sin()]).force[2];
    let step = 1e-3;
    (
        (force_at(step) - force_at(-step)) / (2.0 * step * area),
        steady.lift_by_pressure / steady.lift_by_wake_jump,
    )
}

#[test]
fn lift_slope_of_aspect_ratio_8_with_thickness() {
    for row in csv("wing_ar8_thick_lift_slope.csv") {
        let thickness: f64 = row["thickness"].parse().expect("number");
        let reference: f64 = row["CL_alpha"].parse().expect("number");
        let wing = NacaWing {
            thickness,
            n_chord: 24,
            n_half_span: 18,
            ..NacaWing::default()
        };
        for (kind, mesh) in [
            ("structured", wing.structured()),
            ("unstructured", wing.unstructured(1)),
        ] {
            let mesh = mesh.expect("a wing");
            let (slope, ratio) = lift(&mesh, 8.0);
            println!(
                "AR 8, {:.0} %, {kind}, {} vertices: CL_α = {slope:.3}, reference {reference}, {:+.2} %; pressure / Kutta–Joukowski {ratio:.4}",
                100.0 * thickness,
                mesh.vertices.len(),
                100.0 * (slope / reference - 1.0)
            );
            assert!((slope / reference - 1.0).abs() < 0.02);
            assert!((ratio - 1.0).abs() < 0.02);
        }
    }
}
