//! The wake on surfaces whose trailing edges join, end on bodies, or lie behind each other.

mod wake_cases;

use faer::{Mat, c64};
use fladder_bem::{BemError, WakeDirection};
use fladder_mesh::shapes::Tail;
use fladder_mesh::{TriMesh, Vec3};
use wake_cases::{
    Case, arm, finer_wing_body, jump_into, scrambled, star, wing, wing_body, wings,
};

/// Counted one way round, the jumps of the sheets that meet in a line sum to zero.
#[test]
fn jumps_at_a_common_vertex_sum_to_zero() {
    for (name, arms) in [
        ("T-tail", vec![(0.0, 2.0), (180.0, 2.0), (270.0, 2.0)]),
        (
            "winglet inboard of the tip",
            vec![(0.0, 1.0), (70.0, 0.8), (180.0, 3.0)],
        ),
    ] {
        let mut case = Case::new(star(&arms), 0.5, 4.0);
        case.flow.beta = 0.05;
        let solution = case.solve();
        case.report(name, &solution);
        let jumps: Vec<f64> = (0..case.edges.len())
            .flat_map(|edge| jump_into(&case, &solution, edge))
            .collect();
        let sum: f64 = jumps.iter().sum();
        let largest = jumps.iter().fold(0.0_f64, |l, j| l.max(j.abs()));
        println!("{name}: {jumps:.3?} sum to {sum:.1e}");
        assert_eq!(jumps.len(), 3);
        assert!(largest > 0.05 && sum.abs() < 1e-12);
        // The jump next to the common vertex is close to the one in it: a jump left out, or
        // with the wrong sign, is off by its own size.
        for jump in &solution.steady.wake_jumps {
            let n = jump.jumps.len();
            let (end, next) = if jump.jumps[0] == 0.0 {
                (n - 1, n - 2)
            } else {
                (0, 1)
            };
            assert!((jump.jumps[end] - jump.jumps[next]).abs() < 0.25 * largest);
        }
        assert_closed(&solution);
        let ratio = solution.steady.lift_by_pressure / solution.steady.lift_by_wake_jump;
        assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    }
}

/// A cross with four equal arms, turned by a right angle, is itself: what incidence does
/// along z, sideslip does along y, though the trailing edges' upper sides and the reference
/// of the common vertex are others then.
#[test]
fn a_cruciform_tail_feels_incidence_as_it_feels_sideslip() {
    let arms = [(0.0, 1.5), (90.0, 1.5), (180.0, 1.5), (270.0, 1.5)];
    let mut case = Case::new(star(&arms), 0.5, 4.0);
    case.modes.truncate(2);
    let pitched = case.solve();
    case.report("cross", &pitched);
    let force = |stream: [f64; 3]| pitched.steady.loads_at(stream).force;
    let (sin, cos) = 4_f64.to_radians().sin_cos();
    let (at_alpha, at_beta) = (force([cos, 0.0, sin]), force([cos, -sin, 0.0]));
    println!("C_z(α) {:.12}, −C_y(β) {:.12}", at_alpha[2], -at_beta[1]);
    assert!(at_alpha[2] > 0.1);
    // The sheets' quadrilaterals are cut alike in port and starboard, not above and below.
    assert!((at_alpha[2] + at_beta[1]).abs() < 1e-4 * at_alpha[2]);
    assert!(at_alpha[1].abs() < 1e-9 * at_alpha[2]);
    let q = pitched.transfer.q(c64::new(0.1, 0.5)).expect("Q");
    let difference = (q[(0, 0)] - q[(1, 1)]).norm() / q[(0, 0)].norm();
    // The flow is linearised about 4° of incidence, which the two do not share.
    println!("Q_zz against Q_yy: {difference:.1e}");
    assert!(difference < 0.03);
}

/// Far downstream every edge of a sheet with a jump joins others whose jumps make up for it:
/// the wake has a finite energy.
fn assert_closed(solution: &fladder_bem::Solution) {
    let drag = solution.steady.induced_drag;
    println!("  induced drag {drag:?} m²");
    assert!(drag.is_some_and(|d| d > 0.0));
}

/// What has to hold wherever wings end on a body.
fn assert_sound(name: &str, mesh: TriMesh, notes: usize, suction: f64) -> Case {
    let case = Case::new(mesh, 0.4, 3.0);
    let solution = case.solve();
    case.report(name, &solution);
    let steady = &solution.steady;
    let ratio = steady.lift_by_pressure / steady.lift_by_wake_jump;
    assert!((ratio - 1.0).abs() < 0.07, "{ratio}");
    assert!(steady.lowest_pressure.0 > suction);
    assert_eq!(solution.notes.len(), notes);
    assert_closed(&solution);
    for (edge, jump) in steady.wake_jumps.iter().enumerate() {
        let n = jump.jumps.len();
        let is_fin = case.at(edge, 0).y.abs().max(case.at(edge, n - 1).y.abs()) < 1e-9;
        if is_fin {
            // Symmetric flow about a symmetric aircraft.
            let largest = jump.jumps.iter().fold(0.0_f64, |l, k| l.max(k.abs()));
            println!("  largest jump of the fin {largest:.1e}");
            assert!(largest < 1e-9);
        } else {
            let (root, next) = if jump.on_body[0] {
                (0, 1)
            } else {
                (n - 1, n - 2)
            };
            assert!((jump.jumps[root] / jump.jumps[next] - 1.0).abs() < 0.1);
        }
    }
    let q = solution.transfer.q(c64::new(0.0, 0.3)).expect("Q");
    assert!(q[(1, 0)].norm() < 1e-9 * q[(0, 0)].norm());
    case
}

/// Lines of wings and a fin that end in one tail, at a blunt base, on a trailing edge, or
/// alone.
#[test]
fn body_lines_end_soundly() {
    let with_fin = || [wings(), vec![arm(90.0, 2.9, 0.5, 1.2)]].concat();
    let case = assert_sound(
        "pointed, fin",
        wing_body(Tail::Pointed, with_fin()),
        0,
        -1.0,
    );
    let tail = case.line_ends();
    assert_eq!(tail.len(), 3);
    assert!(
        tail.iter()
            .all(|p| (p - Vec3::new(4.0, 0.0, 0.0)).norm() < 1e-9)
    );
    // At the rim of a square base the stream turns sharply.
    let case = assert_sound("blunt, fin", wing_body(Tail::Blunt, with_fin()), 0, -1.8);
    assert!(
        case.line_ends()
            .iter()
            .all(|p| (p - Vec3::new(4.0, 0.0, 0.0)).norm() < 1e-9)
    );
    let case = assert_sound("knife, fin", wing_body(Tail::Knife, with_fin()), 0, -1.0);
    assert!(
        case.line_ends()
            .iter()
            .all(|p| (p.x - 4.0).abs() < 1e-9 && p.y == 0.0)
    );
}

/// A fin by itself: its line ends alone, and sideslip loads it.
#[test]
fn the_line_of_a_single_fin_ends_alone() {
    let mesh = wing_body(Tail::Pointed, vec![arm(90.0, 2.4, 0.8, 1.5)]);
    let mut case = Case::new(mesh, 0.4, 0.0);
    case.flow.beta = 0.05;
    let solution = case.solve();
    case.report("fin alone", &solution);
    assert_eq!(solution.notes.len(), 1);
    assert!(solution.notes[0].contains("ends alone"));
    assert_eq!(solution.steady.induced_drag, None);
    let jumps = &solution.steady.wake_jumps[0].jumps;
    assert!(jumps.iter().filter(|k| k.abs() > 0.01).count() >= jumps.len() - 2);
    assert!(solution.steady.lowest_pressure.0 > -1.5);
}

/// One wing on a body that ends in an upright edge: all of the junction's jump goes into
/// the sheet of that edge. Without it a vortex would leave the body at the vertex where the
/// line ends. And Q goes on across the change of the far path.
#[test]
fn a_jump_that_meets_a_trailing_edge_goes_into_its_sheet() {
    let mesh = wing_body(Tail::Knife, vec![arm(0.0, 1.2, 0.8, 2.2)]);
    let case = Case::new(mesh, 0.4, 3.0);
    let solution = case.solve();
    case.report("one wing, knife", &solution);
    assert_closed(&solution);
    let steady = &solution.steady;
    let ratio = steady.lift_by_pressure / steady.lift_by_wake_jump;
    assert!((ratio - 1.0).abs() < 0.07, "{ratio}");
    assert!(steady.lowest_pressure.0 > -1.0);
    let at = |degrees: f64| {
        let p = c64::from_polar(0.3, degrees.to_radians());
        solution.transfer.q(p).expect("Q")
    };
    let (below, middle, above) = (at(94.98), at(95.02), at(95.06));
    for i in 0..case.modes.len() {
        let step = (above[(i, i)] - middle[(i, i)]).norm();
        let across = (middle[(i, i)] - below[(i, i)]).norm();
        let size = middle[(i, i)].norm();
        println!(
            "Q_{i}{i}: step {:.1e}, across the paths {:.1e}",
            step / size,
            across / size
        );
        assert!((across - step).abs() < 2e-5 * size);
    }
}

/// Cauchy and Riemann: ∂Q/∂k = i ∂Q/∂g, by central differences.
fn cauchy_riemann(solution: &fladder_bem::Solution, p: c64) -> f64 {
    let h = 1e-4;
    let q = |dg: f64, dk: f64| {
        let at = p + c64::new(dg, dk);
        solution.transfer.q(at).expect("Q")
    };
    let by_g = q(h, 0.0) - q(-h, 0.0);
    let by_k = q(0.0, h) - q(0.0, -h);
    let residual = Mat::from_fn(by_g.nrows(), by_g.ncols(), |i, j| {
        by_k[(i, j)] - c64::new(0.0, 1.0) * by_g[(i, j)]
    });
    residual.norm_l2() / by_g.norm_l2()
}

/// Wing and tail: the change of the tail's lift is that of the downwash of the wing's own
/// jumps as horseshoe vortices,
///
/// w(P) = Σ_j Δκ_j/(4π) · y-distance/ρ² · (1 + x/r) + bound part,
///
/// within the accuracy of lifting-line theory for what a finite chord adds.
#[test]
fn a_tail_feels_the_downwash_of_the_wing() {
    let (front, back) = (wing(1.0, 6.0, 0.0, 0.0), wing(0.6, 2.4, 4.0, 0.5));
    let alpha = 3_f64;
    let lone_wing = Case::new(front.clone(), 0.5, alpha).solve();
    let lone_tail = Case::new(back.clone(), 0.5, alpha).solve();
    let both = Case::new(merged(&front, &back), 0.5, alpha);
    assert_eq!(both.edges.len(), 2);
    let solution = both.solve();
    both.report("wing and tail", &solution);
    let lift = |jump: &fladder_bem::SpanwiseJump| -> f64 {
        (1..jump.jumps.len())
            .map(|i| {
                let dy = jump.positions[i][1] - jump.positions[i - 1][1];
                (jump.jumps[i] + jump.jumps[i - 1]) * dy
            })
            .sum()
    };
    let tail = solution
        .steady
        .wake_jumps
        .iter()
        .find(|j| j.positions[0][0] > 3.0)
        .expect("the tail's edge");
    let ratio = lift(tail) / lift(&lone_tail.steady.wake_jumps[0]);
    let measured = alpha * (1.0 - ratio);
    let jump = &lone_wing.steady.wake_jumps[0];
    // Mean over the tail's span, at its quarter chord, weighted as its lift is.
    let (mut sum, mut weight) = (0.0, 0.0);
    for i in -20..=20 {
        let y = 1.2 * f64::from(i) / 20.5;
        let w = (1.0 - (y / 1.2).powi(2)).sqrt();
        sum += w * downwash(jump, Vec3::new(4.15, y, 0.5));
        weight += w;
    }
    let estimate = (sum / weight).to_degrees();
    println!("downwash at the tail {measured:.3}°, by horseshoes {estimate:.3}°");
    assert!(measured > 0.3 && (measured / estimate - 1.0).abs() < 0.15);
    for p in [
        c64::new(0.05, 0.3),
        c64::new(-0.05, 0.3),
        c64::new(-0.3, 0.2),
    ] {
        let residual = cauchy_riemann(&solution, p);
        println!("Cauchy–Riemann at {p}: {residual:.1e}");
        assert!(residual < 1e-5);
    }
}

/// −w/U of a lifting line at x = 0.25 with the given jumps.
fn downwash(jump: &fladder_bem::SpanwiseJump, p: Vec3) -> f64 {
    let four_pi = 4.0 * std::f64::consts::PI;
    let x = p.x - 0.25;
    let mut w = 0.0;
    for i in 1..jump.jumps.len() {
        let strength = 0.5 * (jump.jumps[i] + jump.jumps[i - 1]);
        for (y, sign) in [
            (jump.positions[i - 1][1], 1.0),
            (jump.positions[i][1], -1.0),
        ] {
            // Trailing leg from (0.25, y, 0) to infinity; with +1 it turns so that
            // air goes down to starboard of it.
            let (dy, dz) = (p.y - y, p.z);
            let rho = dy * dy + dz * dz;
            let r = (x * x + rho).sqrt();
            w += sign * strength * dy / (four_pi * rho) * (1.0 + x / r);
        }
        // Bound leg along y.
        let rho = x * x + p.z * p.z;
        let [a, b] = [jump.positions[i - 1][1], jump.positions[i][1]].map(|y| {
            let dy = p.y - y;
            dy / (dy * dy + rho).sqrt()
        });
        w += strength * x / (four_pi * rho) * (a - b);
    }
    w
}

fn merged(a: &TriMesh, b: &TriMesh) -> TriMesh {
    let n = a.vertices.len() as u32;
    let mut mesh = TriMesh {
        vertices: [a.vertices.clone(), b.vertices.clone()].concat(),
        triangles: a.triangles.clone(),
        ..TriMesh::default()
    };
    let shifted = b.triangles.iter().map(|t| t.map(|v| v + n));
    mesh.triangles.extend(shifted);
    mesh
}

/// The nearer the wake comes to the tail, the more is said; when it strikes, it is named.
#[test]
fn a_wake_that_strikes_the_tail_is_named() {
    let front = wing(1.0, 4.0, 0.0, 0.0);
    let at = |z: f64| Case::new(merged(&front, &wing(0.6, 2.4, 2.5, z)), 0.5, 0.0);
    let far = at(0.3);
    assert!(far.plan().notes.is_empty());
    let near = at(0.06);
    let notes = near.plan().notes;
    println!("{notes:?}");
    assert_eq!(notes.len(), 1);
    assert!(notes[0].contains("of the triangles' size"));
    // Close, but finite: linear in between.
    let lift = |case: &Case| case.solve().steady.loads_at([0.9986, 0.0, 0.0523]).force[2];
    let (far, near) = (lift(&far), lift(&near));
    println!("lift at 0.3 m {far:.4}, at 0.06 m {near:.4}");
    assert!((near / far - 1.0).abs() < 0.05);
    let error = fladder_bem::plan(&at(0.01).problem()).expect_err("a strike");
    println!("{error}");
    let BemError::WakeStrikes {
        at: [x, _, z],
        from,
        ..
    } = error
    else {
        panic!("{error}");
    };
    // The tail's nose is at 2.5 m, the sheet on z = 0.
    assert!((2.49..2.55).contains(&x) && z.abs() < 1e-9 && (from[0] - 1.0).abs() < 1e-9);
    // Wing and tail plane at one height on one body: the wing's wake hits it.
    let level = [
        wings(),
        vec![arm(0.0, 2.9, 0.5, 1.2), arm(180.0, 2.9, 0.5, 1.2)],
    ]
    .concat();
    let case = Case::new(wing_body(Tail::Pointed, level), 0.4, 3.0);
    let error = fladder_bem::plan(&case.problem()).expect_err("a strike");
    assert!(matches!(error, BemError::WakeStrikes { .. }), "{error}");
    // At incidence the wake along the stream passes above it.
    let mut case = case;
    case.direction = WakeDirection::Freestream;
    case.flow.alpha = 12_f64.to_radians();
    assert!(fladder_bem::plan(&case.problem()).is_ok());
}

/// Wing and V-tail on one body: four lines meet in its tail.
#[test]
fn wing_and_v_tail_share_a_tail() {
    let arms = [
        wings(),
        vec![arm(40.0, 3.0, 0.5, 1.2), arm(140.0, 3.0, 0.5, 1.2)],
    ]
    .concat();
    let case = assert_sound("V-tail", wing_body(Tail::Pointed, arms), 0, -1.0);
    assert_eq!(case.line_ends().len(), 4);
    assert!(
        case.line_ends()
            .iter()
            .all(|p| (p - Vec3::new(4.0, 0.0, 0.0)).norm() < 1e-9)
    );
}

/// Where the lines of a wing run on a body: number of vertices, the largest distance from
/// their plane z = 0, and whether all stay on their own side.
fn courses(case: &Case) -> Vec<(usize, f64, bool)> {
    let lines = case.plan().wake.junction_lines;
    lines
        .iter()
        .map(|line| {
            let at = |v: u32| case.mesh.vertices[v as usize];
            let side = at(line.vertices[0]).y.signum();
            let off = line
                .vertices
                .iter()
                .fold(0.0_f64, |o, &v| o.max(at(v).z.abs()));
            let stays = line.vertices.iter().all(|&v| side * at(v).y > -1e-9);
            (line.vertices.len(), off, stays)
        })
        .collect()
}

/// On a body whose triangles follow no line, the wake's inner edge stays on its own side
/// within about a cell of its plane, ends in the tail, and Q hardly changes.
#[test]
fn a_body_without_lines_gives_the_same_forces() {
    let mesh = wing_body(Tail::Pointed, wings());
    let structured = Case::new(mesh.clone(), 0.4, 3.0);
    let reference = structured.solve();
    structured.report("structured", &reference);
    let q = reference.transfer.q(c64::new(0.0, 0.3)).expect("Q");
    for seed in [1, 2] {
        let case = Case::new(scrambled(&mesh, seed, 0.2), 0.4, 3.0);
        // Cells are 0.16 m long.
        for (count, off, stays) in courses(&case) {
            println!("seed {seed}: {count} vertices, at most {off:.3} m off");
            assert!(off < 0.16 && stays);
        }
        let solution = case.solve();
        case.report("scrambled", &solution);
        assert_closed(&solution);
        let other = solution.transfer.q(c64::new(0.0, 0.3)).expect("Q");
        let difference = (other[(0, 0)] - q[(0, 0)]).norm() / q[(0, 0)].norm();
        println!("seed {seed}: Q_zz {difference:.1e} from the structured body's");
        assert!(difference < 0.03);
        assert!(solution.steady.lowest_pressure.0 > -1.2);
    }
    let finer = finer_wing_body(Tail::Pointed, wings(), 2);
    // Without shifts whole rows of vertices lie across the stream.
    for (seed, shift) in [(1, 0.0), (2, 0.0), (3, 0.2), (4, 0.2)] {
        let case = Case::new(scrambled(&finer, seed, shift), 0.4, 3.0);
        for (count, off, stays) in courses(&case) {
            println!("finer, seed {seed}: {count} vertices, at most {off:.3} m off");
            assert!(off < 0.1 && stays);
        }
        for end in case.line_ends() {
            assert!((end - Vec3::new(4.0, 0.0, 0.0)).norm() < 1e-9);
        }
    }
}
