//! Rigid-body roots: a Boeing 747 from its derivatives, a free ellipsoid from
//! the exact potential flow.

#![allow(
    clippy::unwrap_used,
    reason = "a fault in the reference data must stop the test"
)]

mod common;

use common::{data_path, matrix, number, read_json, roots, speeds};
use faer::{Mat, c64};
use fladder_stability::{
    DEFAULT_DAMPING_LIMIT, FlyingBody, Frame, GafPoint, GafTable, Method, OperatingPoint,
    PiecewiseQuadratic, RIGID_NAMES, RigidBody, RigidModes, StructuralMatrices, Structure,
    Sweep, System, to_body_frame,
};
use serde_json::Value;

fn names() -> Vec<String> {
    RIGID_NAMES.iter().map(ToString::to_string).collect()
}

fn body_of(file: &Value) -> RigidBody {
    let value = |name: &str| number(&file[name]);
    RigidBody {
        mass: value("m"),
        ixx: value("Ixx"),
        iyy: value("Iyy"),
        izz: value("Izz"),
        ixz: value("Ixz"),
    }
}

/// The 747's derivatives as $Q = Q_1p + Q_2p^2$, sampled on a grid.
struct Airliner {
    names: Vec<String>,
    body: RigidBody,
    gravity: f64,
}

impl Structure for Airliner {
    fn modes(&self) -> &[String] {
        &self.names
    }

    fn rigid_modes(&self) -> Vec<usize> {
        (0..6).collect()
    }

    fn flying_body(&self) -> Option<FlyingBody> {
        Some(FlyingBody {
            modes: RigidModes::among(&self.names),
            body: self.body,
            climb: 0.0,
        })
    }

    fn at(&self, point: &OperatingPoint) -> StructuralMatrices {
        let full = |block: fladder_stability::Matrix6| Mat::from_fn(6, 6, |i, j| block[i][j]);
        StructuralMatrices {
            mass: full(self.body.mass_matrix()),
            damping: full(self.body.rotation_rate(point)),
            stiffness: full(self.body.gravity(self.gravity, 0.0)),
            hysteretic: None,
            flight_path: None,
        }
    }
}

fn airliner_table(file: &Value, body: &RigidBody) -> GafTable {
    let (rate, acceleration) = (
        matrix(&file["F_per_velocity"]),
        matrix(&file["F_per_acceleration"]),
    );
    let scales = body.scales();
    let airspeed = number(&file["U"]);
    let pressure = OperatingPoint::new(airspeed, 1.0).dynamic_pressure();
    let q = |k: f64| {
        let s = c64::new(0.0, k * airspeed);
        Mat::from_fn(6, 6, |i, j| {
            (s * rate[(i, j)] + s * s * acceleration[(i, j)]) * scales[i] * scales[j] / pressure
        })
    };
    let points = (0..=10)
        .map(|i| f64::from(i) * 4e-4)
        .map(|k| GafPoint { g: 0.0, k, q: q(k) })
        .collect();
    GafTable::new(1.0, 0.0, names(), points, vec![]).unwrap()
}

/// Phugoid, short period, Dutch roll, roll and spiral to 1e-6; four zero roots
/// with gravity, six without.
#[test]
fn jumbo_roots_agree_with_the_reference() {
    let file = read_json("stability_flightmech_b747.json");
    let body = body_of(&file);
    let table = airliner_table(&file, &body);
    let fit = PiecewiseQuadratic::centred(&table, DEFAULT_DAMPING_LIMIT).unwrap();
    let airspeed = number(&file["U"]);
    for (gravity, key, zero_key) in [
        (number(&file["g"]), "eigenvalues", "n_zero_with_gravity"),
        (0.0, "eigenvalues_no_gravity", "n_zero_no_gravity"),
    ] {
        let structure = Airliner {
            names: names(),
            body,
            gravity,
        };
        let schedule = speeds([airspeed], 1.0);
        let result = Sweep {
            method: Method::P2,
            ..Sweep::new(&structure, &schedule, &table, &fit)
        }
        .run(&())
        .unwrap()
        .methods
        .p2
        .unwrap();
        assert_eq!(
            result.zero_roots[0] as u64,
            file[zero_key].as_u64().unwrap()
        );
        let expected: Vec<c64> = roots(&file[key])
            .into_iter()
            .filter(|root| root.norm() > 1e-9 && root.im >= 0.0)
            .collect();
        assert_eq!(result.branches.len(), expected.len());
        for root in expected {
            let nearest = result
                .branches
                .iter()
                .map(|branch| (c64::new(branch.sigma[0], branch.omega[0]) - root).norm())
                .fold(f64::INFINITY, f64::min);
            println!(
                "{:+.8}{:+.8}i: relative error {:.1e}",
                root.re,
                root.im,
                nearest / root.norm()
            );
            assert!(nearest / root.norm() < 1e-6, "{root}");
        }
    }
}

/// Every motion has its name, and the ratios obey the equations of motion:
/// $\dot\theta = q$ with level flight at zero incidence gives for the heave
/// $\dot w = \dots$; here the kinematic one, side force against heading:
/// in a Dutch roll $\beta\approx-\psi$ within a third, in a phugoid
/// $|u/U|\gg|\alpha|$, in the short period the reverse. The rigid aircraft by
/// derivatives, without the terms of acceleration, has the same motions.
#[test]
fn jumbo_motions_have_their_names() {
    let file = read_json("stability_flightmech_b747.json");
    let body = body_of(&file);
    let table = airliner_table(&file, &body);
    let fit = PiecewiseQuadratic::centred(&table, DEFAULT_DAMPING_LIMIT).unwrap();
    let structure = Airliner {
        names: names(),
        body,
        gravity: number(&file["g"]),
    };
    let schedule = speeds([number(&file["U"])], 1.0);
    let result = Sweep {
        method: Method::Unrefined,
        ..Sweep::new(&structure, &schedule, &table, &fit)
    }
    .run(&())
    .unwrap();
    let modes = result.methods.p2.unwrap().flight_modes;
    let named: Vec<&str> = modes.iter().map(|mode| mode.motion).collect();
    let ratio = |motion: &str, name: &str| {
        let mode = modes.iter().find(|mode| mode.motion == motion).unwrap();
        let ratio = mode.ratios.iter().find(|ratio| ratio.name == name).unwrap();
        println!(
            "{motion}: {name} {:.4} at {:+.1}°",
            ratio.magnitude, ratio.phase_deg
        );
        ratio.clone()
    };
    assert_eq!(
        named,
        ["short period", "Dutch roll", "roll", "phugoid", "spiral"]
    );
    let turn = ratio("Dutch roll", "beta:psi");
    assert!((turn.magnitude - 1.0).abs() < 0.3 && (turn.phase_deg.abs() - 180.0).abs() < 30.0);
    assert!(ratio("phugoid", "u:alpha").magnitude > 10.0);
    assert!(ratio("short period", "u:alpha").magnitude < 0.2);
    assert!(ratio("roll", "psi:phi").magnitude < 0.2);
    let phugoid = modes.iter().find(|mode| mode.motion == "phugoid").unwrap();
    // Lanchester: period about 2^½ π U/g.
    let lanchester =
        2.0_f64.sqrt() * std::f64::consts::PI * number(&file["U"]) / number(&file["g"]);
    println!(
        "phugoid {:.1} s, Lanchester {lanchester:.1} s",
        phugoid.period.unwrap()
    );
    assert!((phugoid.period.unwrap() / lanchester - 1.0).abs() < 0.2);
    for rigid in &result.rigid_aircraft {
        let own = modes
            .iter()
            .find(|mode| mode.motion == rigid.motion)
            .unwrap();
        let distance = (own.sigma - rigid.sigma).hypot(own.omega - rigid.omega);
        println!(
            "{} without acceleration terms: {distance:.1e} 1/s off",
            rigid.motion
        );
        assert!(distance < 0.1 * own.sigma.hypot(own.omega));
    }
    assert_eq!(result.rigid_aircraft.len(), 5);
}

/// Columns of a comma-separated file by name, for the row of a body.
fn row(name: &str, body: &str) -> impl Fn(&str) -> f64 {
    let text = std::fs::read_to_string(data_path(name)).unwrap();
    let lines: Vec<String> = text
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(str::to_owned)
        .collect();
    let found = lines
        .iter()
        .find(|line| line.starts_with(&format!("{body},")))
        .unwrap()
        .clone();
    let head = lines[0].clone();
    move |column: &str| {
        let place = head.split(',').position(|name| name == column).unwrap();
        found.split(',').nth(place).unwrap().parse().unwrap()
    }
}

/// Exact forces on an ellipsoid in a stream, columns in the inertial frame,
/// mass-normalised; $U = 1$, $b = 1$, unit density.
fn ellipsoid_table(added: &dyn Fn(&str) -> f64, body: &RigidBody) -> GafTable {
    let scales = body.scales();
    let (ax, ay, az) = (added("A_x"), added("A_y"), added("A_z"));
    let moments = [added("J_x"), added("J_y"), added("J_z")];
    let force = |s: c64| {
        let mut f = Mat::<c64>::zeros(6, 6);
        let real = |value: f64| c64::new(value, 0.0);
        for (axis, mass) in [ax, ay, az].into_iter().enumerate() {
            f[(axis, axis)] = -s * s * mass;
            f[(3 + axis, 3 + axis)] = -s * s * moments[axis];
        }
        f[(4, 2)] = -s * (az - ax);
        f[(2, 4)] = s * (az - ax);
        f[(4, 4)] += real(az - ax);
        f[(5, 1)] = s * (ay - ax);
        f[(1, 5)] = -s * (ay - ax);
        f[(5, 5)] += real(ay - ax);
        Mat::from_fn(6, 6, |i, j| f[(i, j)] * scales[i] * scales[j] * 2.0)
    };
    let points = (0..=8)
        .map(|i| f64::from(i) * 0.1)
        .map(|k| GafPoint {
            g: 0.0,
            k,
            q: force(c64::new(0.0, k)),
        })
        .collect();
    GafTable::new(1.0, 0.0, names(), points, vec![]).unwrap()
}

/// Kirchhoff's free ellipsoid: 8 zero roots and two pairs of real ones, in
/// the body frame after conversion, with the rotation-rate terms.
#[test]
fn free_ellipsoid_has_the_exact_roots() {
    for name in ["spheroid_4to1", "triaxial_2_1_0.5"] {
        let exact = row("free_ellipsoid_eigenvalues_open.csv", name);
        let added = row("ellipsoid_added_mass_open.csv", name);
        let (mass, a, b) = (exact("m"), exact("a"), exact("b"));
        let c = exact("c");
        let body = RigidBody {
            mass,
            ixx: mass * (b * b + c * c) / 5.0,
            iyy: exact("Iy"),
            izz: exact("Iz"),
            ixz: 0.0,
        };
        assert!((exact("Iy") - mass * (a * a + c * c) / 5.0).abs() < 1e-9);
        let table = ellipsoid_table(&added, &body);
        let table = to_body_frame(table, &[Frame::Inertial; 6], &body, 0.0).unwrap();
        assert!(table.notes().is_empty(), "{:?}", table.notes());
        let fit = PiecewiseQuadratic::centred(&table, 1.0).unwrap();
        let system = System::from_frequencies(
            names(),
            &[0.0; 6],
            fladder_stability::DampingModel::Viscous(vec![0.0; 6]),
        )
        .unwrap()
        .with_rigid_body(body);
        let schedule = speeds([1.0], 1.0);
        let result = Sweep {
            method: Method::P2,
            ..Sweep::new(&system, &schedule, &table, &fit)
        }
        .run(&())
        .unwrap()
        .methods
        .p2
        .unwrap();
        assert_eq!(result.zero_roots, [8], "{name}");
        let mut found: Vec<f64> = result
            .branches
            .iter()
            .map(|branch| branch.sigma[0])
            .collect();
        found.sort_by(f64::total_cmp);
        let (pitch, yaw) = (exact("s_pitch_abs"), exact("s_yaw_abs"));
        let mut expected = vec![-pitch, -yaw, yaw, pitch];
        expected.sort_by(f64::total_cmp);
        println!("{name}: {found:?}, exact {expected:?}");
        assert!(result.branches.iter().all(|branch| branch.k[0] == 0.0));
        assert_eq!(found.len(), 4);
        for (root, exact) in found.iter().zip(&expected) {
            assert!((root / exact - 1.0).abs() < 1e-9);
        }
    }
}
