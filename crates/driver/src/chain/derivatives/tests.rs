//! Derivatives against steady loads and simple theory.

use super::*;
use crate::chain::control;
use fladder_bem::{Flow, Problem, Silent, Solution, WakeDirection};
use fladder_mesh::shapes::NacaWing;
use fladder_mesh::trailing_edge::{Settings, find_by_shape};
use fladder_mesh::{Frame, SurfaceGroup, Topology, TriMesh};
use fladder_modal::{Inertia, rigid_modes};

const SEMICHORD: f64 = 0.5;
const SCALES: Scales = Scales {
    area: 8.0,
    span: 8.0,
    chord: 1.0,
};

fn wing() -> TriMesh {
    let wing = NacaWing {
        n_chord: 10,
        n_half_span: 8,
        ..NacaWing::default()
    };
    wing.structured().unwrap()
}

fn solved(mesh: &TriMesh, modes: &[SurfaceMode], flow: Flow, about: Vec3) -> Solution {
    let edges = find_by_shape(mesh, &Topology::new(mesh), Settings::default());
    let problem = Problem {
        flow,
        wake_direction: WakeDirection::X,
        moment_point: about,
        ..Problem::new(mesh, &edges, modes, SEMICHORD)
    };
    fladder_bem::solve(&problem, &Silent).unwrap()
}

fn near_zero(solution: &Solution, p: f64) -> Mat<c64> {
    solution.transfer.q(c64::new(p, 0.0)).unwrap()
}

fn largest(rows: &[Row]) -> f64 {
    rows.iter().flatten().fold(0.0, |size, x| size.max(x.abs()))
}

/// A wing at incidence and sideslip: columns of the rigid modes of an odd body, scaled
/// by its mass, are those of unit modes about the moment point; those of velocities are
/// the derivatives of the steady loads, which are a quadratic form of the stream.
#[test]
fn columns_are_derivatives_of_the_steady_loads_about_any_point() {
    let mesh = wing();
    let body = RigidBody {
        mass: 3.0,
        cg: Vec3::new(0.4, 0.1, -0.2),
        inertia: Inertia {
            xx: 2.0,
            yy: 1.5,
            zz: 3.0,
            xz: 0.0,
        },
    };
    let about = Vec3::new(0.2, 0.0, 0.1);
    let mut modes = rigid_modes(&body, &mesh.vertices);
    let flow = Flow {
        alpha: 0.07,
        beta: 0.05,
    };
    let of_body = RigidColumns::of(&modes, Some(&body), about);
    modes.extend(rigid_modes(&RigidBody::unit(about), &mesh.vertices));
    let unit = RigidColumns::of(&modes[6..], None, about);
    let solution = solved(&mesh, &modes, flow, about);
    let q = near_zero(&solution, SMALL_P);
    let factor = SEMICHORD / SMALL_P;
    let found = of_body.rigid(&q, factor);
    let size = largest(&found);
    let direct = unit.rigid(&q.submatrix(6, 6, 6, 6).to_owned(), factor);
    let apart = |a: &[Row], b: &[Row]| {
        let pairs = a.iter().flatten().zip(b.iter().flatten());
        pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / size
    };
    let about_points = apart(&found, &direct);
    // Exact differences of a quadratic form; the stream is against the velocity, and
    // starboard and down are turned.
    let stream = flow.stream();
    let form = |axis: usize, sign: f64| -> Row {
        let load = |step: f64| {
            let mut onset: [f64; 3] = stream.into();
            onset[axis] += step;
            let loads = solution.steady.loads_at(onset);
            [loads.force, loads.moment]
        };
        let (up, down) = (load(0.5), load(-0.5));
        std::array::from_fn(|i| sign * TO_BODY[i] * (up[i / 3][i % 3] - down[i / 3][i % 3]))
    };
    let steady = [form(0, 1.0), form(1, -1.0), form(2, 1.0)];
    let against_steady = apart(&found[..3], &steady);
    let coarser = of_body.rigid(&near_zero(&solution, 100.0 * SMALL_P), factor / 100.0);
    let with_p = apart(&found, &coarser);
    println!(
        "two centres {about_points:.1e}, steady loads {against_steady:.1e}, p of 1e-6 {with_p:.1e}"
    );
    assert!(about_points < 1e-10);
    assert!(against_steady < 1e-7);
    assert!(with_p < 1e-5);
}

/// A wing at 3° with flaps of 25 % chord over its starboard half and over all of it.
#[test]
fn signs_and_sizes_are_those_of_simple_theory() {
    let mut mesh = wing();
    let centroid = |t: usize| mesh.corners(t).iter().sum::<Vec3>() / 3.0;
    let behind = (0..mesh.triangles.len()).filter(|&t| centroid(t).x > 0.75);
    let flap: Vec<u32> = behind.map(|t| t as u32).collect();
    let starboard = flap
        .iter()
        .copied()
        .filter(|&t| centroid(t as usize).y > 0.0);
    let starboard = starboard.collect();
    for (name, triangles) in [("both", flap), ("starboard", starboard)] {
        let name = name.to_owned();
        mesh.surfaces.push(SurfaceGroup { name, triangles });
    }
    let about = Vec3::new(0.25, 0.0, 0.0);
    let mut modes = rigid_modes(&RigidBody::unit(about), &mesh.vertices);
    for name in ["both", "starboard"] {
        let turned = |p: &Vec3| Vec3::y().cross(&(p - Vec3::new(0.75, 0.0, 0.0)));
        let mut mode = SurfaceMode {
            name: name.to_owned(),
            frame: Frame::Inertial,
            displacement: mesh.vertices.iter().map(turned).collect(),
        };
        control::restrict(&mut mode, &mesh, &[name.to_owned()]).unwrap();
        modes.push(mode);
    }
    let alpha_deg = 3.0_f64;
    let flow = Flow {
        alpha: alpha_deg.to_radians(),
        beta: 0.0,
    };
    let solution = solved(&mesh, &modes, flow, about);
    let columns = RigidColumns::of(&modes, None, about);
    let rest = near_zero(&solution, 0.0);
    let loads = Loads {
        steady: body_loads(&solution.steady),
        rigid: columns.rigid(&near_zero(&solution, SMALL_P), SEMICHORD / SMALL_P),
        controls: vec![columns.control(&rest, 6), columns.control(&rest, 7)],
    };
    let found = loads.coefficients(SCALES, alpha_deg, 0.0);
    let [a, b, p, q, r, both, starboard] = found.stability[..] else {
        panic!("five columns and two controls")
    };
    println!("{found:.4?}");
    let [lift, _, drag, roll, pitch, yaw] = [0, 1, 2, 3, 4, 5];
    let slope = a[lift];
    // Uncambered: lift is nearly proportional to the incidence.
    let steady = found.steady_stability;
    assert!((steady[lift] / slope / flow.alpha - 1.0).abs() < 5e-3);
    assert!(a[drag] > 0.0);
    // Symmetric motion has no lateral loads and the other way round.
    for column in [a, q, both] {
        assert!(
            [1, roll, yaw]
                .iter()
                .all(|&i| column[i].abs() < 1e-6 * slope)
        );
    }
    for column in [b, p, r] {
        assert!(
            [lift, drag, pitch]
                .iter()
                .all(|&i| column[i].abs() < 1e-6 * slope)
        );
    }
    // Aerodynamic centre at the quarter chord within 2 %.
    assert!((found.neutral_point / SCALES.chord).abs() < 0.02);
    // The lift of a pitch rate is that of the incidence at three quarters of the chord.
    assert!(
        (q[lift] / (2.0 * 0.5 * slope) - 1.0).abs() < 0.06,
        "{}",
        q[lift]
    );
    assert!(q[pitch] < 0.0);
    // Roll is damped by less than the strips' own lift, −a/6, more than half of it.
    assert!(
        (-slope / 6.0..-slope / 12.0).contains(&p[roll]),
        "{}",
        p[roll]
    );
    // At positive lift yaw lifts the advancing wing, roll drops the nose's side.
    assert!(r[roll] > 0.0 && p[yaw] < 0.0);
    // Flap: trailing edge down lifts, pitches down about the quarter chord; thin section
    // with the hinge at θ = 120°: dCL/dδ = (1 − (θ − sin θ)/π) dCL/dα.
    let theta = 2.0 * std::f64::consts::FRAC_PI_3;
    let effect = 1.0 - (theta - theta.sin()) / std::f64::consts::PI;
    println!(
        "flap: {} of the lift slope, thin section {effect}",
        both[lift] / slope
    );
    assert!((both[lift] / slope / effect - 1.0).abs() < 0.1);
    assert!(both[pitch] < 0.0);
    // The vertices on y = 0 belong to it, so that it is wider by half of a cell's shear.
    let share = 2.0 * starboard[lift] / both[lift];
    assert!((1.0..1.125).contains(&share), "{share}");
    // Starboard wing up is a negative rolling moment.
    assert!(starboard[roll] < 0.0);
}
