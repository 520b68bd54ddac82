//! Q of a rectangular wing of aspect ratio 8 in the thickness limit, in the Laplace plane.

mod common;

use common::{csv, edges, mode, solved};
use faer::{Mat, c64};
use fladder_bem::{Flow, TransferModel};
use fladder_mesh::shapes::NacaWing;
use fladder_mesh::{Frame, SurfaceMode, TriMesh, Vec3};

/// The reference's modes: plunge, pitch about mid-chord, bending, torsion; s = 4.
fn modes(mesh: &TriMesh) -> Vec<SurfaceMode> {
    let shape = |y: f64| (y / 4.0) * (y / 4.0);
    vec![
        mode(mesh, "plunge", Frame::Inertial, |_| Vec3::z()),
        mode(mesh, "pitch", Frame::Inertial, |x| {
            Vec3::new(x.z, 0.0, 0.5 - x.x)
        }),
        mode(mesh, "bending", Frame::Inertial, move |x| {
            shape(x.y) * Vec3::z()
        }),
        mode(mesh, "torsion", Frame::Inertial, move |x| {
            shape(x.y) * Vec3::new(x.z, 0.0, 0.5 - x.x)
        }),
    ]
}

fn transfer(thickness: f64) -> TransferModel {
    let wing = NacaWing {
        thickness,
        n_chord: 20,
        n_half_span: 12,
        ..NacaWing::default()
    };
    let mesh = wing.structured().expect("a wing");
    solved(&mesh, &edges(&mesh), &modes(&mesh), Flow::default(), 0.5).transfer
}

/// Reference matrices by point.
fn reference(file: &str, keep: impl Fn(f64, f64, f64) -> bool) -> Vec<(c64, Mat<c64>)> {
    let mut points: Vec<(c64, Mat<c64>)> = Vec::new();
    for row in csv(file) {
        let number = |key: &str| row.get(key).map_or(0.0, |v| v.parse().expect("number"));
        let (g, k) = (number("g"), number("k"));
        if !keep(g, k, number("Mach")) {
            continue;
        }
        let p = c64::new(g, k);
        let at = points.iter().position(|(q, _)| *q == p).unwrap_or_else(|| {
            points.push((p, Mat::zeros(4, 4)));
            points.len() - 1
        });
        let (i, j) = (number("i") as usize - 1, number("j") as usize - 1);
        points[at].1[(i, j)] = c64::new(number("ReQ"), number("ImQ"));
    }
    points
}

#[test]
fn q_of_a_plate_anywhere_in_the_laplace_plane() {
    let (thick, thin) = (transfer(0.04), transfer(0.02));
    let mut points = reference("laplace_gaf_rect_ar8.csv", |g, k, _| {
        [-0.1, 0.0, 0.1].contains(&g) && [0.2, 0.8].contains(&k)
    });
    assert_eq!(points.len(), 6);
    let steady = reference("dlm_gaf_rect_ar8.csv", |_, k, mach| k == 0.0 && mach == 0.0);
    assert_eq!(steady.len(), 1);
    points.extend(steady);
    for (p, exact) in points {
        let limit = |model: &TransferModel| model.q(p).expect("Q");
        // Linear in thickness: t → 0 from 4 % and 2 %.
        let plate = Mat::from_fn(4, 4, |i, j| {
            2.0 * limit(&thin)[(i, j)] - limit(&thick)[(i, j)]
        });
        let error = (&plate - &exact).norm_max() / exact.norm_max();
        println!(
            "g = {:+.1}, k = {:.1}: {:.2} % of max |Q|",
            p.re,
            p.im,
            100.0 * error
        );
        assert!(error < 0.05);
    }
}
