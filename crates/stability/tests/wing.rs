//! The free-flying wing with 26 modes: six rigid, twenty elastic, gravity, and
//! aerodynamics in closed form, so that every root is known.

#![allow(
    clippy::unwrap_used,
    reason = "a fault in the reference data must stop the test"
)]

mod common;

use std::time::Instant;

use common::{Wing, number, range, roots, speeds};
use faer::{Mat, c64};
use fladder_stability::{
    Aerodynamics, DEFAULT_DAMPING_LIMIT, DampingModel, Flight, FromFunction, GafPoint,
    GafTable, Method, MethodResult, OperatingPoint, PiecewiseQuadratic, RationalFit, RigidBody,
    Structure, Sweep, SweepResult, System, Thrust,
};

fn sweep(
    wing: &Wing,
    values: impl IntoIterator<Item = f64>,
    method: Method,
    smooth: Option<&dyn Aerodynamics>,
) -> SweepResult {
    let table = wing.table(&[0.0]);
    let fit = PiecewiseQuadratic::centred(&table, DEFAULT_DAMPING_LIMIT).unwrap();
    assert_eq!(fit.report().rank, fit.report().unknowns);
    let schedule = speeds(values, wing.density());
    Sweep {
        smooth,
        method,
        ..Sweep::new(wing, &schedule, &table, &fit)
    }
    .run(&())
    .unwrap()
}

/// The closed form of the file is the one evaluated here.
#[test]
fn closed_form_agrees_with_its_check_values() {
    let wing = Wing::read();
    for check in wing.file["Q_check"].as_array().unwrap() {
        let place = common::numbers(&check["p"]);
        let q = wing.q(c64::new(place[0], place[1]));
        let (re, im) = (
            common::matrix(&check["Q"]["re"]),
            common::matrix(&check["Q"]["im"]),
        );
        for i in 0..26 {
            for j in 0..26 {
                let exact = c64::new(re[(i, j)], im[(i, j)]);
                assert!((q[(i, j)] - exact).norm() <= 1e-12 * (1.0 + exact.norm()));
            }
        }
    }
}

fn found_at(result: &MethodResult, number: usize) -> Vec<c64> {
    result
        .branches
        .iter()
        .filter(|branch| branch.first <= number && number < branch.first + branch.g.len())
        .map(|branch| {
            c64::new(
                branch.g[number - branch.first],
                branch.k[number - branch.first],
            )
        })
        .collect()
}

fn distance(to: c64, among: &[c64]) -> f64 {
    among
        .iter()
        .map(|root| (root - to).norm())
        .fold(f64::INFINITY, f64::min)
}

/// Errors of a method against the truth at the twelve speeds.
fn errors(wing: &Wing, result: &MethodResult, wanted: impl Fn(c64) -> bool) -> Vec<f64> {
    let mut errors = Vec::new();
    for (number, truth) in wing.truth().iter().enumerate() {
        let found = found_at(result, number);
        for root in roots(&truth["roots"])
            .into_iter()
            .filter(|root| wanted(*root))
        {
            errors.push(distance(root, &found));
        }
    }
    errors.sort_by(f64::total_cmp);
    errors
}

fn truth_speeds(wing: &Wing) -> Vec<f64> {
    wing.truth()
        .iter()
        .map(|truth| number(&truth["U"]))
        .collect()
}

/// The g-method continues forces to first order in $g$: near the axis two
/// digits better than p-k, whose errors there are 3e-4 and 7e-3.
#[test]
fn the_g_method_is_of_second_order_in_damping() {
    let wing = Wing::read();
    let result = sweep(&wing, truth_speeds(&wing), Method::G, None).methods;
    let near = |p: c64| p.re.abs() < 0.02 && p.im > 0.05 && p.im < 1.4;
    let errors = errors(&wing, &result.g.unwrap(), near);
    let (median, largest) = (errors[errors.len() / 2], errors[errors.len() - 1]);
    println!("g-method near the axis: median error {median:.1e}, largest {largest:.1e}");
    assert!(median < 1e-5 && largest < 2e-4);
    let pk = sweep(&wing, truth_speeds(&wing), Method::Pk, None)
        .methods
        .pk;
    let pk = self::errors(&wing, &pk.unwrap(), near);
    println!(
        "p-k: median error {:.1e}, largest {:.1e}",
        pk[pk.len() / 2],
        pk[pk.len() - 1]
    );
    assert!(median < 0.1 * pk[pk.len() / 2]);
}

/// Roots far from the samples are marked, those near them are not.
#[test]
fn roots_beyond_the_samples_are_marked() {
    let wing = Wing::read();
    let result = sweep(&wing, [30.0, 40.0], Method::P2, None)
        .methods
        .p2
        .unwrap();
    let mut marked = 0;
    for branch in &result.branches {
        for (i, g) in branch.g.iter().enumerate() {
            let is_marked = branch.extrapolated.as_ref().is_some_and(|list| list[i]);
            assert_eq!(is_marked, g.abs() > 0.05, "{} at g = {g}", branch.name);
            marked += usize::from(is_marked);
        }
    }
    assert!(marked > 0);
    let exact = FromFunction::new(26, |p| wing.q(p));
    let result = sweep(&wing, [30.0], Method::Refined, Some(&exact));
    let branches = result.methods.polished.unwrap().branches;
    assert!(branches.iter().all(|branch| branch.extrapolated.is_none()));
}

/// Near the axis ($|g| < 0.02$, $0.05 < k < 1.5$) every root is within 5e-5 of
/// the truth, and at every speed there are exactly four zero roots.
#[test]
fn p2_roots_near_the_axis_agree_with_the_truth() {
    let wing = Wing::read();
    let result = sweep(&wing, truth_speeds(&wing), Method::P2, None)
        .methods
        .p2
        .unwrap();
    let near = |p: c64| p.re.abs() < 0.02 && p.im > 0.05 && p.im < 1.5;
    let errors = errors(&wing, &result, near);
    println!(
        "{} roots near the axis: median error {:.1e}, largest {:.1e}",
        errors.len(),
        errors[errors.len() / 2],
        errors[errors.len() - 1]
    );
    assert!(errors[errors.len() - 1] < 5e-5);
    assert!(
        result.zero_roots.iter().all(|zeros| *zeros == 4),
        "{:?}",
        result.zero_roots
    );
}

/// No root of p2 with |g| < 0.1 is invented: each has a true one beside it.
/// Further from the axis a quadratic continued from it is a guess.
#[test]
fn p2_invents_no_root() {
    let wing = Wing::read();
    let result = sweep(&wing, truth_speeds(&wing), Method::P2, None)
        .methods
        .p2
        .unwrap();
    for (number, truth) in wing.truth().iter().enumerate() {
        let exact = roots(&truth["roots"]);
        let found = found_at(&result, number);
        for root in found.iter().filter(|root| root.re.abs() < 0.1) {
            let miss = distance(*root, &exact);
            assert!(
                miss < 0.02 + 0.2 * root.re.abs(),
                "speed {number}: {root} has no partner"
            );
        }
        let wanted = exact
            .iter()
            .filter(|p| p.re.abs() < 0.1 && p.im < 1.49 && p.norm() > 1e-9)
            .count();
        let inside = found
            .iter()
            .filter(|p| p.re.abs() < 0.1 && p.im < 1.49)
            .count();
        println!("speed {number}: {inside} roots with |g| < 0.1, true {wanted}");
    }
}

fn check_crossings(wing: &Wing, result: &MethodResult, tolerance: f64, name: &str) {
    let exact = wing.file["crossings"].as_array().unwrap();
    let speeds: Vec<f64> = result
        .flutter
        .iter()
        .map(|crossing| crossing.speed)
        .collect();
    assert_eq!(speeds.len(), exact.len(), "{speeds:?}");
    for (found, exact) in result.flutter.iter().zip(exact) {
        let (speed, hertz) = (number(&exact["U"]), number(&exact["f_hz"]));
        println!(
            "{name}: {:.5} m/s (exact {speed:.5}, error {:.1e}), {:.4} Hz (exact {hertz:.4}), {} {:?}",
            found.speed,
            found.speed / speed - 1.0,
            found.frequency_hz,
            found.branch,
            found.kind
        );
        assert!((found.speed / speed - 1.0).abs() < tolerance);
        assert!((found.frequency_hz / hertz - 1.0).abs() < 10.0 * tolerance);
    }
}

/// Four crossings by p2 from 21 samples, within 1e-4.
#[test]
fn p2_crossings_agree_with_the_truth() {
    let wing = Wing::read();
    let result = sweep(&wing, range(20.0, 75.0, 56), Method::P2, None)
        .methods
        .p2
        .unwrap();
    check_crossings(&wing, &result, 1e-4, "p2");
}

/// The same from the p-k method: at a crossing $g = 0$ and it is exact but
/// for the interpolation.
#[test]
fn pk_crossings_agree_with_the_truth() {
    let wing = Wing::read();
    let result = sweep(&wing, range(20.0, 75.0, 56), Method::Pk, None)
        .methods
        .pk
        .unwrap();
    check_crossings(&wing, &result, 1e-5, "p-k");
}

/// Refined on the closed form the crossings are exact, and so are the roots.
#[test]
fn polished_roots_and_crossings_are_exact() {
    let wing = Wing::read();
    let smooth = FromFunction::new(26, |p| wing.q(p));
    let result = sweep(&wing, truth_speeds(&wing), Method::P2, Some(&smooth));
    let result = result.methods.polished.unwrap();
    let inside = |p: c64| p.re.abs() < 0.2 && p.im < 1.5 && p.norm() > 1e-9;
    let errors = errors(&wing, &result, inside);
    println!(
        "{} polished roots: median error {:.1e}, largest {:.1e}",
        errors.len(),
        errors[errors.len() / 2],
        errors[errors.len() - 1]
    );
    assert!(errors[errors.len() - 1] < 1e-9);
    let result = sweep(&wing, range(20.0, 75.0, 56), Method::P2, Some(&smooth));
    check_crossings(&wing, &result.methods.polished.unwrap(), 1e-10, "polished");
}

/// p-k roots at the speeds where the file lists them; the 21 samples limit
/// the agreement. Zero roots that p-k moves away from zero are in the file but
/// not in ours.
#[test]
fn pk_roots_agree_with_the_reference() {
    let wing = Wing::read();
    let table = wing.table(&[0.0]);
    let result = sweep(&wing, truth_speeds(&wing), Method::Pk, None)
        .methods
        .pk
        .unwrap();
    let mut worst: f64 = 0.0;
    let mut count = 0;
    for (number, truth) in wing.truth().iter().enumerate() {
        let found = found_at(&result, number);
        for root in roots(&truth["pk_roots"]) {
            let is_artefact = root.im < table.k()[1] && root.re.abs() >= root.im;
            if root.im < 1.5 && !is_artefact {
                count += 1;
                worst = worst.max(distance(root, &found));
            }
        }
    }
    println!("{count} p-k roots, largest error {worst:.1e}");
    assert!(count > 40 && worst < 1e-5);
}

/// Branches do not depend on the step in speed: the roots at 20 and 75 m/s
/// that one branch joins are the same for steps from 0.5 to 8 m/s.
#[test]
fn steps_in_speed_give_the_same_branches() {
    let wing = Wing::read();
    let mut ends: Vec<Vec<(f64, f64)>> = Vec::new();
    for step in [0.5, 1.0, 2.0, 4.0, 8.0] {
        let count = 1 + (48.0 / step) as usize;
        let result = sweep(&wing, range(20.0, 68.0, count), Method::P2, None)
            .methods
            .p2
            .unwrap();
        let mut joined: Vec<(f64, f64)> = result
            .branches
            .iter()
            .filter(|branch| branch.first == 0 && branch.g.len() == count && branch.k[0] > 0.01)
            .map(|branch| (branch.omega[0], branch.omega[count - 1]))
            .collect();
        joined.sort_by(|a, b| a.0.total_cmp(&b.0));
        println!(
            "step {step}: {} branches over the whole range, {} in all",
            joined.len(),
            result.branches.len()
        );
        ends.push(joined);
    }
    for joined in &ends {
        assert_eq!(joined.len(), ends[0].len());
        for (one, other) in joined.iter().zip(&ends[0]) {
            assert!(
                (one.0 - other.0).abs() < 1e-9 && (one.1 - other.1).abs() < 1e-9,
                "{one:?} {other:?}"
            );
        }
    }
}

/// The bits of the outcome do not depend on the number of threads.
#[test]
fn thread_count_leaves_every_bit() {
    let wing = Wing::read();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let result = sweep(&wing, range(20.0, 75.0, 12), Method::Both, None);
            serde_json::to_string(&result).unwrap()
        })
    };
    let one = with(1);
    assert!(!one.contains("NaN"));
    assert_eq!(one, with(3));
}

/// Time of the size a whole aircraft has; printed, not judged.
#[test]
fn two_hundred_speeds_are_timed() {
    let wing = Wing::read();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .build()
        .unwrap();
    for (method, name) in [(Method::P2, "p2"), (Method::Pk, "p-k")] {
        let start = Instant::now();
        let result = pool.install(|| sweep(&wing, range(20.0, 75.0, 200), method, None));
        println!(
            "{name}: 200 speeds, 26 modes, 2 threads: {:.2} s",
            start.elapsed().as_secs_f64()
        );
        let outcome = result.methods.p2.or(result.methods.pk).unwrap();
        assert!(outcome.branches.len() > 10);
    }
}

/// From the 21 samples alone: the rational fit finds every root in the region
/// within 1e-7, proves by its count that none is missing, and its crossings
/// are good to 1e-8.
#[test]
fn polished_roots_from_samples_are_complete() {
    let wing = Wing::read();
    let fit = RationalFit::new(&wing.table(&[0.0])).unwrap();
    println!("poles {:?}, residual {:.1e}", fit.poles(), fit.residual());
    let result = sweep(&wing, truth_speeds(&wing), Method::P2, Some(&fit));
    let result = result.methods.polished.unwrap();
    let inside = |p: c64| p.re.abs() < 0.2 && p.im < 1.5 && p.norm() > 1e-9;
    let errors = errors(&wing, &result, inside);
    println!(
        "{} polished roots: median error {:.1e}, largest {:.1e}",
        errors.len(),
        errors[errors.len() / 2],
        errors[errors.len() - 1]
    );
    let complete = result.complete.as_ref().unwrap();
    println!("complete: {complete:?}");
    assert!(errors[errors.len() - 1] < 1e-7);
    assert!(complete.iter().all(|complete| *complete));
    for (number, truth) in wing.truth().iter().enumerate() {
        let exact = roots(&truth["roots"]);
        for root in found_at(&result, number) {
            assert!(distance(root, &exact) < 1e-7, "{root} is not a root");
        }
    }
    let result = sweep(&wing, range(20.0, 75.0, 56), Method::P2, Some(&fit));
    check_crossings(&wing, &result.methods.polished.unwrap(), 1e-8, "rational");
}

/// A part of the plane.
type Band = fn(c64) -> bool;

/// With samples at g = 0, ±0.04, ±0.1, ±0.2 the roots away from the axis are
/// better than from the axis alone, and those near it no worse.
#[test]
fn samples_off_the_axis_improve_damped_roots() {
    let wing = Wing::read();
    let schedule = speeds(truth_speeds(&wing), wing.density());
    let table = wing.table(&[0.0, -0.04, 0.04, -0.1, 0.1, -0.2, 0.2]);
    let run = |fit: &PiecewiseQuadratic| {
        println!("{:?}", fit.report());
        let sweep = Sweep {
            method: Method::P2,
            ..Sweep::new(&wing, &schedule, &table, fit)
        };
        sweep.run(&()).unwrap().methods.p2.unwrap()
    };
    let outcomes = [
        (
            "centred",
            run(&PiecewiseQuadratic::centred(&table, 0.2).unwrap()),
        ),
        ("laplace", run(&PiecewiseQuadratic::of(&table).unwrap())),
        (
            "literal",
            run(&PiecewiseQuadratic::literal(&table, 0.2).unwrap()),
        ),
    ];
    let bands: [(&str, Band); 3] = [
        ("near", |p| p.re.abs() < 0.02 && p.im > 0.05 && p.im < 1.5),
        ("far", |p| {
            p.re.abs() > 0.06 && p.re.abs() < 0.19 && p.im > 0.05 && p.im < 1.5
        }),
        ("real", |p| {
            p.im == 0.0 && p.re.abs() > 0.05 && p.re.abs() < 0.19
        }),
    ];
    let mut table = Vec::new();
    for (name, outcome) in &outcomes {
        for (band, wanted) in bands {
            let errors = errors(&wing, outcome, wanted);
            let (median, worst) = (errors[errors.len() / 2], errors[errors.len() - 1]);
            println!(
                "{name} {band}: {} roots, median {median:.1e}, largest {worst:.1e}",
                errors.len()
            );
            table.push(median);
        }
        println!("{name}: zero roots {:?}", outcome.zero_roots);
    }
    assert!(table[3] <= table[0] * 1.001);
    assert!(table[4] < 0.3 * table[1]);
    assert!(table[5] < 0.3 * table[2]);
    assert!(table[6] > 10.0 * table[0]);
    assert!(outcomes[1].1.zero_roots.iter().all(|zeros| *zeros == 4));
}

/// Rotation rates, gravity, drag, speed derivative and lift tilt put together
/// by [`System`] give the damping matrix of the file. Drag area and induced
/// drag factor are read off C(x,x), the steady elastic forces off C(i,x), the
/// lift slope off C(x,z) at one speed; the rest of column x, C(x,z) at other
/// speeds, C(z,theta), K and M are predictions.
#[test]
fn flight_terms_reproduce_the_damping_matrix() {
    let wing = Wing::read();
    let value = |name: &str| number(&wing.file[name]);
    let (mass, density, gravity, semichord) =
        (value("m"), value("rho"), value("g"), value("b"));
    let [linear, _, cubic] = wing.damping_powers();
    let weight = mass * gravity;
    let parasite_drag_area = linear[(0, 0)] / 50.0 * mass / (1.5 * density);
    let induced_drag_factor =
        cubic[(0, 0)] * 50.0_f64.powi(3) * mass * density / (6.0 * weight * weight);
    println!("drag area {parasite_drag_area:.5} m2, induced factor {induced_drag_factor:.5}");
    // The file takes its lift slope from the planform, not from Q_zz: read off
    // C(x,z) at the first speed.
    let first = OperatingPoint::new(number(&wing.truth()[0]["U"]), density);
    let momentum = mass * first.airspeed;
    let drag_slope = momentum * wing.at(&first).damping[(0, 2)] + weight;
    let heave_slope = -drag_slope / (2.0 * induced_drag_factor * weight * mass * semichord);
    println!("lift slope {:.4} m2", -heave_slope * mass * semichord);
    let steady: Vec<Option<f64>> = (0..26)
        .map(|i| Some(linear[(i, 0)] / 50.0 * mass.sqrt() / density))
        .collect();
    let body = RigidBody {
        mass,
        ixx: value("Ixx"),
        iyy: value("Iyy"),
        izz: value("Izz"),
        ixz: value("Ixz"),
    };
    let mut frequencies = vec![0.0; 6];
    frequencies.extend(common::numbers(&wing.file["omega_elastic"]));
    let flight = Flight {
        gravity,
        climb: 0.0,
        parasite_drag_area,
        induced_drag_factor,
        thrust: Thrust::ConstantPower,
        speed_derivative: true,
    };
    let undamped = DampingModel::Viscous(vec![0.0; 26]);
    let system = System::from_frequencies(wing.modes.clone(), &frequencies, undamped)
        .unwrap()
        .with_rigid_body(body)
        .with_flight(flight, semichord, heave_slope, &steady)
        .unwrap();
    for truth in wing.truth() {
        let point = OperatingPoint::new(number(&truth["U"]), density);
        let (ours, theirs) = (system.at(&point), wing.at(&point));
        let everything = |_: usize, _: usize| true;
        // The file's lateral derivatives that follow the lift are not ours.
        let longitudinal = |i: usize, j: usize| j == 0 || (i, j) == (0, 2) || (i, j) == (2, 4);
        compare("C", &ours.damping, &theirs.damping, &longitudinal);
        compare("K", &ours.stiffness, &theirs.stiffness, &everything);
        // Nor are the small couplings of its mass matrix outside the body's.
        let inertia = |i: usize, j: usize| i == j || (i, j) == (3, 5);
        compare("M", &ours.mass, &theirs.mass, &inertia);
    }
}

fn compare(
    name: &str,
    ours: &Mat<f64>,
    theirs: &Mat<f64>,
    wanted: &dyn Fn(usize, usize) -> bool,
) {
    for i in 0..26 {
        for j in (0..26).filter(|j| wanted(i, *j)) {
            let (one, other) = (ours[(i, j)], theirs[(i, j)]);
            let miss = (one - other).abs() / (1.0 + other.abs());
            assert!(miss < 1e-7, "{name}({i}, {j}): {one}, file {other}");
        }
    }
}

/// The free wing without gravity has the same non-zero roots whether its rigid
/// modes are body quasi-coordinates with rotation rates, or displacements in
/// inertial axes without them and with the columns
/// $Q_{\theta,I} = Q_\theta - (b/p)Q_z$, $Q_{\psi,I} = Q_\psi + (b/p)Q_y$.
#[test]
fn inertial_and_body_frame_give_the_same_roots() {
    let wing = Wing::read();
    let value = |name: &str| number(&wing.file[name]);
    let pitch = (value("m") / value("Iyy")).sqrt() * wing.semichord();
    let yaw = (value("m") / value("Izz")).sqrt() * wing.semichord();
    let inertial = |p: c64| {
        let mut q = wing.q(p);
        let step = c64::new(1e-9, 0.0);
        let slope = if p.norm() > 0.0 {
            q.clone()
        } else {
            wing.q(step)
        };
        let p = if p.norm() > 0.0 { p } else { step };
        for row in 0..26 {
            q[(row, 4)] -= slope[(row, 2)] / p * pitch;
            q[(row, 5)] += slope[(row, 1)] / p * yaw;
        }
        q
    };
    let body = System::from_frequencies(
        wing.modes.clone(),
        &[vec![0.0; 6], common::numbers(&wing.file["omega_elastic"])].concat(),
        DampingModel::Viscous(vec![0.0; 26]),
    )
    .unwrap()
    .with_rigid_body(RigidBody {
        mass: value("m"),
        ixx: value("Ixx"),
        iyy: value("Iyy"),
        izz: value("Izz"),
        ixz: value("Ixz"),
    });
    let matrices = body.at(&OperatingPoint::new(1.0, 1.0));
    let still = Mat::zeros(26, 26);
    let floating =
        System::from_matrices(wing.modes.clone(), matrices.mass, still, matrices.stiffness)
            .unwrap();
    let run = |structure: &dyn Structure, q: &(dyn Fn(c64) -> Mat<c64> + Sync)| {
        let points = (0..=20)
            .map(|i| 1.5 * (f64::from(i) / 20.0).powf(1.5))
            .map(|k| GafPoint {
                g: 0.0,
                k,
                q: q(c64::new(0.0, k)),
            })
            .collect();
        let table =
            GafTable::new(wing.semichord(), 0.0, wing.modes.clone(), points, vec![]).unwrap();
        let fit = PiecewiseQuadratic::of(&table).unwrap();
        let schedule = speeds([30.0, 50.0], wing.density());
        let smooth = FromFunction::new(26, q);
        let sweep = Sweep {
            smooth: Some(&smooth),
            method: Method::P2,
            ..Sweep::new(structure, &schedule, &table, &fit)
        };
        sweep.run(&()).unwrap().methods.polished.unwrap()
    };
    let one = run(&body, &|p| wing.q(p));
    let other = run(&floating, &inertial);
    for number in 0..2 {
        let wanted = |roots: Vec<c64>| -> Vec<c64> {
            roots
                .into_iter()
                .filter(|p| p.re.abs() < 0.1 && p.norm() > 1e-5)
                .collect()
        };
        let (one, other) = (
            wanted(found_at(&one, number)),
            wanted(found_at(&other, number)),
        );
        assert_eq!(one.len(), other.len(), "{one:?} {other:?}");
        let worst = one
            .iter()
            .map(|root| distance(*root, &other))
            .fold(0.0, f64::max);
        println!(
            "{} roots in both frames, largest difference {worst:.1e}",
            one.len()
        );
        assert!(one.len() > 10 && worst < 1e-9);
    }
}
