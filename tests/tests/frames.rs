//! The same free wing in inertial and in body axes has the same roots.
//!
//! Inertial: rigid motions as displacements in axes that do not turn, mass matrix alone.
//! Body: quasi-coordinates, whose columns of Q come from s u alone and whose equations
//! have the rotation-rate terms C6. Any error of frame, sign or scale in either moves
//! the roots apart.

mod common;

use common::{edges, mode, solved};
use faer::{Mat, c64};
use fladder_bem::{Flow, TransferModel};
use fladder_mesh::shapes::NacaWing;
use fladder_mesh::{Frame, SurfaceMode, TriMesh, Vec3};
use fladder_stability::{
    DEFAULT_DAMPING_LIMIT, FromFunction, GafPoint, GafTable, Method, OperatingPoint,
    PiecewiseQuadratic, RigidBody, Structure, Sweep, System,
};

const SEMICHORD: f64 = 0.125;
const DENSITY: f64 = 1.225;
const BODY: RigidBody = RigidBody {
    mass: 3.0,
    ixx: 1.1,
    iyy: 0.03,
    izz: 1.12,
    ixz: 0.004,
};
const CENTRE: [f64; 3] = [0.07, 0.0, 0.0];

/// Rigid unit motions about the centre of mass, then bending and torsion.
fn modes(mesh: &TriMesh, frame: Frame) -> Vec<SurfaceMode> {
    let centre = Vec3::from(CENTRE);
    let names = [
        "rigid:x",
        "rigid:y",
        "rigid:z",
        "rigid:phi",
        "rigid:theta",
        "rigid:psi",
    ];
    let scale = [
        BODY.mass, BODY.mass, BODY.mass, BODY.ixx, BODY.iyy, BODY.izz,
    ];
    let mut all: Vec<SurfaceMode> = (0..6)
        .map(|i| {
            let mut axis = Vec3::zeros();
            axis[i % 3] = 1.0 / scale[i].sqrt();
            mode(mesh, names[i], frame, move |x| {
                if i < 3 {
                    axis
                } else {
                    axis.cross(&(x - centre))
                }
            })
        })
        .collect();
    if frame == Frame::Inertial {
        for (mode, name) in all.iter_mut().zip(["x", "y", "z", "roll", "pitch", "yaw"]) {
            mode.name = name.into();
        }
    }
    all.push(mode(mesh, "elastic:1", Frame::Inertial, |x| {
        Vec3::z() * (x.y * x.y - 0.2)
    }));
    all.push(mode(mesh, "elastic:2", Frame::Inertial, move |x| {
        2.0 * x.y.abs() * Vec3::new(x.z, 0.0, centre.x - x.x)
    }));
    all
}

fn transfer(frame: Frame) -> (TransferModel, Vec<String>) {
    let wing = NacaWing {
        chord: 0.25,
        span: 2.0,
        n_chord: 10,
        n_half_span: 8,
        ..NacaWing::default()
    };
    let mesh = wing.structured().expect("a wing");
    let modes = modes(&mesh, frame);
    let names = modes.iter().map(|m| m.name.clone()).collect();
    (
        solved(&mesh, &edges(&mesh), &modes, Flow::default(), SEMICHORD).transfer,
        names,
    )
}

/// Unit generalised masses; 6 and 11 Hz; the product of inertia couples roll and yaw.
fn structure(names: Vec<String>, body_axes: bool) -> System {
    let tau = std::f64::consts::TAU;
    let stiffness = [
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        (6.0 * tau).powi(2),
        (11.0 * tau).powi(2),
    ];
    let product = -BODY.ixz / (BODY.ixx * BODY.izz).sqrt();
    let mass = Mat::from_fn(8, 8, |i, j| match (i, j) {
        (3, 5) | (5, 3) => product,
        _ if i == j => 1.0,
        _ => 0.0,
    });
    let stiffness = Mat::from_fn(8, 8, |i, j| if i == j { stiffness[i] } else { 0.0 });
    let system = System::from_matrices(names, mass, Mat::zeros(8, 8), stiffness)
        .expect("symmetric matrices");
    if body_axes {
        system
            .with_rigid_body_checked(BODY)
            .expect("the same masses")
    } else {
        system
    }
}

/// Polished roots that are not zero, at every speed, by the transfer model itself.
fn roots(frame: Frame, speeds: &[f64]) -> Vec<Vec<c64>> {
    let (transfer, names) = transfer(frame);
    let k: Vec<f64> = (0..=30)
        .map(|i| 1.5 * (f64::from(i) / 30.0).powf(1.5))
        .collect();
    let points = k
        .iter()
        .map(|&k| GafPoint {
            g: 0.0,
            k,
            q: transfer.q(c64::new(0.0, k)).expect("Q"),
        })
        .collect();
    let table =
        GafTable::new(SEMICHORD, 0.0, names.clone(), points, Vec::new()).expect("table");
    let fit = PiecewiseQuadratic::centred(&table, DEFAULT_DAMPING_LIMIT).expect("fit");
    // Newton may step onto the cut g < 0, k = 0; just above it Q is the limit from above.
    let exact = FromFunction::new(8, |p: c64| {
        let p = if p.im == 0.0 && p.re < 0.0 {
            c64::new(p.re, 1e-12)
        } else {
            p
        };
        transfer.q(p).expect("off the branch cut")
    });
    let system = structure(names, frame == Frame::Body);
    let structure: &dyn Structure = &system;
    let schedule: Vec<OperatingPoint> = speeds
        .iter()
        .map(|&u| OperatingPoint::new(u, DENSITY))
        .collect();
    let sweep = Sweep {
        smooth: Some(&exact),
        method: Method::P2,
        ..Sweep::new(structure, &schedule, &table, &fit)
    };
    let result = sweep.run(&()).expect("a sweep");
    let polished = result.methods.polished.expect("polished roots");
    speeds
        .iter()
        .map(|&speed| {
            polished
                .branches
                .iter()
                .filter_map(|b| {
                    let i = b.speed.iter().position(|u| *u == speed)?;
                    Some(c64::new(b.g[i], b.k[i]))
                })
                .filter(|p| p.norm() > 1e-4 && p.im > 1e-3)
                .collect()
        })
        .collect()
}

#[test]
fn inertial_and_body_axes_give_the_same_roots() {
    let speeds = [12.0, 16.0, 20.0];
    let (body, inertial) = (roots(Frame::Body, &speeds), roots(Frame::Inertial, &speeds));
    for ((speed, a), b) in speeds.iter().zip(&body).zip(&inertial) {
        println!(
            "{speed} m/s: {} roots in body, {} in inertial axes",
            a.len(),
            b.len()
        );
        assert!(
            a.len() >= 3,
            "short period, bending and torsion at least: {a:?}"
        );
        assert_eq!(a.len(), b.len(), "{a:?} {b:?}");
        for p in a {
            let nearest = b
                .iter()
                .map(|q| (p - q).norm())
                .fold(f64::INFINITY, f64::min);
            println!("  p = {p:.7}: apart by {nearest:.1e}");
            assert!(nearest < 1e-6);
        }
    }
}
