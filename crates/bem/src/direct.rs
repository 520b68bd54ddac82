//! The whole complex system at one s, solved without reduction: oracle of the transfer
//! model. Everything of the wake is summed at every test point before it is tested.

use crate::Symmetry;
use crate::boundary::{ModeFields, onset_sources};
use crate::dense::Solver;
use crate::galerkin::Galerkin;
use crate::image::Image;
use crate::near_field::POINTS;
use crate::onset::OnsetBasis;
use crate::pressure::Functionals;
use crate::progress::Silent;
use crate::shape_change::ShapeChange;
use crate::solve::{Flow, Problem, WakeDirection, lay_out, solve};
use crate::steady::UnitOnsets;
use crate::surface_flow::surface_flow;
use crate::transfer::solve_complex;
use crate::wake_influence::WakeInfluence;
use faer::{Mat, c64};
use fladder_mesh::shapes::{Extent, NacaWing};
use fladder_mesh::{Frame, SurfaceMode, Topology, TrailingEdge, TriMesh, Vec3, trailing_edge};

fn complex(matrix: &Mat<f64>) -> Mat<c64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
        c64::new(matrix[(i, j)], 0.0)
    })
}

/// Q(p) of a problem whose surface has no body lines, by the full complex system.
fn direct(problem: &Problem<'_>, p: c64) -> Mat<c64> {
    let (surface, wake) = lay_out(problem, Image::None).expect("wake");
    let stream = problem.flow.stream();
    let galerkin = Galerkin::new(&surface, Image::None);
    let fields = ModeFields::new(
        &galerkin,
        &surface.source,
        problem.modes,
        problem.turning,
        OnsetBasis::single(stream),
    );
    let (motion, onset) = (fields.sources(&galerkin), onset_sources(&galerkin));
    let split = motion.ncols();
    let sources = Mat::from_fn(motion.nrows(), split + 3, |i, j| {
        if j < split {
            motion[(i, j)]
        } else {
            onset[(i, j - split)]
        }
    });
    let assembly = galerkin
        .assemble(sources.as_ref(), &Silent)
        .expect("assembled");
    let n = galerkin.n_vertices;
    let body = Mat::from_fn(n, n, |i, j| assembly.rows[i * n + j]);
    let influence = WakeInfluence {
        galerkin: &galerkin,
        wake: &wake,
        free_terms: &assembly.free_terms,
        slopes: &assembly.slopes,
    };
    let system_at = |s: c64| {
        let tested = influence
            .tested(s, surface.columns.len(), &Silent)
            .expect("not interrupted");
        let mut system = complex(&body);
        for (j, column) in surface.columns.iter().enumerate() {
            for i in 0..n {
                system[(i, column.upper as usize)] -= tested[(i, j)];
                system[(i, column.lower as usize)] += tested[(i, j)];
            }
        }
        system
    };
    let m = fields.count;
    let steady = solve_complex(
        system_at(c64::new(0.0, 0.0)),
        complex(&assembly.right_hand_sides.subcols(split, 3).to_owned()),
    )
    .expect("regular");
    let steady = Mat::from_fn(n, 3, |i, j| steady[(i, j)].re);
    let jumps = Mat::from_fn(surface.columns.len(), 3, |j, a| {
        let column = surface.columns[j];
        steady[(column.upper as usize, a)] - steady[(column.lower as usize, a)]
    });
    let onsets = UnitOnsets::new(&galerkin, &wake, steady, jumps);
    let functionals =
        Functionals::new(&galerkin, &fields, &onsets, &wake, ShapeChange::Attached);
    let s = p / problem.semichord;
    let right = Mat::from_fn(n, m, |i, j| {
        let zero = fields.inertial.iter().position(|&k| k == j);
        let zero = zero.map_or(0.0, |k| assembly.right_hand_sides[(i, m + k)]);
        s * assembly.right_hand_sides[(i, j)] + zero
    });
    let phi = solve_complex(system_at(s), right).expect("regular");
    Mat::from_fn(m, m, |i, j| {
        let mut sum = s * functionals.c1[0][(i, j)] + functionals.c0[0][(i, j)];
        for v in 0..n {
            sum += (functionals.p0[0][(v, i)] + s * functionals.p1[(v, i)]) * phi[(v, j)];
        }
        2.0 * sum
    })
}

fn modes(vertices: &[Vec3]) -> Vec<SurfaceMode> {
    let mode = |name: &str, frame, field: fn(&Vec3) -> Vec3| SurfaceMode {
        name: name.into(),
        frame,
        displacement: vertices.iter().map(field).collect(),
    };
    vec![
        mode("plunge", Frame::Body, |_| Vec3::z()),
        mode("pitch", Frame::Inertial, |x| Vec3::new(x.z, 0.0, 0.5 - x.x)),
        mode("bending", Frame::Inertial, |x| {
            Vec3::new(0.0, 0.0, x.y * x.y / 16.0)
        }),
    ]
}

/// A coarse wing with its trailing edge and three modes.
fn wing(sweep_deg: f64) -> (TriMesh, Vec<TrailingEdge>, Vec<SurfaceMode>) {
    let wing = NacaWing {
        n_chord: 6,
        n_half_span: 4,
        sweep_deg,
        ..NacaWing::default()
    };
    let mesh = wing.structured().expect("wing");
    let edges = edges(&mesh);
    let modes = modes(&mesh.vertices);
    (mesh, edges, modes)
}

fn edges(mesh: &TriMesh) -> Vec<TrailingEdge> {
    trailing_edge::find_by_shape(
        mesh,
        &Topology::new(mesh),
        trailing_edge::Settings::default(),
    )
}

fn problem(
    (mesh, edges, modes): &(TriMesh, Vec<TrailingEdge>, Vec<SurfaceMode>),
    flow: Flow,
) -> Problem<'_> {
    problem_of(mesh, edges, modes, flow)
}

fn problem_of<'a>(
    mesh: &'a TriMesh,
    edges: &'a [TrailingEdge],
    modes: &'a [SurfaceMode],
    flow: Flow,
) -> Problem<'a> {
    Problem {
        turning: &[false, false, true],
        flow,
        ..Problem::new(mesh, edges, modes, 0.5)
    }
}

#[test]
fn the_reduced_model_equals_the_complex_solve() {
    let wing = wing(20.0);
    let problem = problem(
        &wing,
        Flow {
            alpha: 0.05,
            beta: 0.02,
        },
    );
    let solution = solve(&problem, &Silent).expect("solved");
    for p in [
        c64::new(0.0, 0.3),
        c64::new(-0.1, 0.3),
        c64::new(-0.1, 0.02),
        c64::new(0.1, 0.05),
        c64::new(0.0, 0.0),
    ] {
        let (reduced, full) = (solution.transfer.q(p).expect("Q"), direct(&problem, p));
        let difference = (&reduced - &full).norm_max() / full.norm_max();
        println!("p = {p}: reduced against direct {difference:.1e}");
        assert!(difference < 1e-10);
    }
}

/// The pressures for pictures have the generalised forces of a plunge, u·n being constant
/// on a triangle.
#[test]
fn pressures_on_the_surface_add_up_to_q() {
    let wing = wing(20.0);
    let problem = Problem {
        turning: &[],
        ..problem(
            &wing,
            Flow {
                alpha: 0.05,
                beta: 0.02,
            },
        )
    };
    let points = [c64::new(0.0, 0.3), c64::new(-0.1, 0.05)];
    let transfer = solve(&problem, &Silent).expect("solved").transfer;
    let flow = surface_flow(&problem, &points, &Silent).expect("solved");
    let area: Vec<f64> = (0..wing.0.triangles.len())
        .map(|t| wing.0.area_vector(t).z)
        .collect();
    for unsteady in &flow.unsteady {
        let q = transfer.q(unsteady.p).expect("Q");
        for (mode, pressure) in unsteady.pressure.iter().enumerate() {
            let force: c64 = pressure.iter().zip(&area).map(|(c, a)| -c * a).sum();
            let difference = (force - q[(0, mode)]).norm() / q.norm_max();
            println!("p = {}, mode {mode}: {difference:.1e}", unsteady.p);
            assert!(difference < 1e-11);
        }
    }
    assert!(surface_flow(&problem, &[c64::new(-0.1, 0.0)], &Silent).is_err());
}

/// With the wake along x one model holds at every incidence.
#[test]
fn one_model_serves_every_incidence() {
    let wing = wing(20.0);
    let at = |alpha_deg: f64| Flow {
        alpha: alpha_deg.to_radians(),
        beta: 0.02,
    };
    let along_x = |flow| Problem {
        wake_direction: WakeDirection::X,
        ..problem(&wing, flow)
    };
    let solution = solve(&along_x(at(1.0)), &Silent).expect("solved");
    for alpha_deg in [-2.0, 6.0] {
        let flow = at(alpha_deg);
        let other = solve(&along_x(flow), &Silent).expect("solved").steady;
        let forces = solution.steady.generalised_forces_at(flow.stream().into());
        for (here, there) in forces.iter().zip(&other.generalised_forces) {
            assert!((here - there).abs() < 1e-12, "{here} {there}");
        }
        for p in [c64::new(0.0, 0.3), c64::new(-0.1, 0.3), c64::new(0.0, 0.0)] {
            let (one, full) = (
                solution.transfer.q_at(p, flow).expect("Q"),
                direct(&along_x(flow), p),
            );
            let difference = (&one - &full).norm_max() / full.norm_max();
            println!("α = {alpha_deg}°, p = {p}: one model against direct {difference:.1e}");
            assert!(difference < 1e-10);
        }
    }
    let following = solve(&problem(&wing, at(1.0)), &Silent).expect("solved");
    assert!(
        following
            .transfer
            .q_at(c64::new(0.0, 0.3), at(2.0))
            .is_err()
    );
}

/// Q of a half model is that of the whole, symmetric and antisymmetric.
#[test]
fn half_models_have_the_forces_of_the_whole() {
    let shape = NacaWing {
        n_chord: 6,
        n_half_span: 4,
        sweep_deg: 25.0,
        ..NacaWing::default()
    };
    let half_shape = NacaWing {
        extent: Extent::Half,
        ..shape
    };
    let (whole, half) = (
        shape.structured().expect("wing"),
        half_shape.structured().expect("half wing"),
    );
    let (whole_edges, half_edges) = (edges(&whole), edges(&half));
    let flow = Flow {
        alpha: 0.07,
        beta: 0.0,
    };
    let mode = |name: &str, frame, field: fn(&Vec3) -> Vec3, mesh: &TriMesh| SurfaceMode {
        name: name.into(),
        frame,
        displacement: mesh.vertices.iter().map(field).collect(),
    };
    let symmetric = |mesh: &TriMesh| modes(&mesh.vertices);
    let antisymmetric = |mesh: &TriMesh| {
        vec![
            mode("roll", Frame::Body, |x| Vec3::new(0.0, -x.z, x.y), mesh),
            mode("yaw", Frame::Body, |x| Vec3::new(-x.y, x.x, 0.0), mesh),
            mode(
                "bending",
                Frame::Inertial,
                |x| Vec3::new(0.0, 0.0, x.y * x.y.abs() / 16.0),
                mesh,
            ),
        ]
    };
    for (symmetry, whole_modes, half_modes) in [
        (Symmetry::Symmetric, symmetric(&whole), symmetric(&half)),
        (
            Symmetry::Antisymmetric,
            antisymmetric(&whole),
            antisymmetric(&half),
        ),
    ] {
        let reference = problem_of(&whole, &whole_edges, &whole_modes, flow);
        let model = Problem {
            symmetry,
            ..problem_of(&half, &half_edges, &half_modes, flow)
        };
        let (reference, model) = (
            solve(&reference, &Silent).expect("whole"),
            solve(&model, &Silent).expect("half"),
        );
        assert!(model.sizes.unknowns < reference.sizes.unknowns / 2 + 20);
        for p in [
            c64::new(0.0, 0.3),
            c64::new(-0.1, 0.3),
            c64::new(0.1, 0.05),
            c64::new(0.0, 0.0),
        ] {
            let (q, wanted) = (
                model.transfer.q(p).expect("Q"),
                reference.transfer.q(p).expect("Q"),
            );
            let difference = (&q - &wanted).norm_max() / wanted.norm_max();
            println!("{symmetry:?}, p = {p}: half against whole {difference:.1e}");
            assert!(difference < 1e-9, "{q:?} {wanted:?}");
        }
        let (a, b) = (&model.steady, &reference.steady);
        for axis in 0..3 {
            assert!((a.loads.force[axis] - b.loads.force[axis]).abs() < 1e-9);
            assert!((a.loads.moment[axis] - b.loads.moment[axis]).abs() < 1e-9);
        }
        assert!((a.lift_by_wake_jump - b.lift_by_wake_jump).abs() < 1e-9);
        let drag = [a, b].map(|s| s.induced_drag.expect("a closed sheet"));
        assert!(drag[1] > 0.0 && (drag[0] - drag[1]).abs() < 1e-9);
        for (x, y) in a.generalised_forces.iter().zip(&b.generalised_forces) {
            assert!((x - y).abs() < 1e-9, "{x} {y}");
        }
    }
}

/// Q is analytic: its derivatives along g and along k agree (Cauchy–Riemann).
#[test]
fn q_is_analytic_in_the_laplace_plane() {
    let wing = wing(0.0);
    let problem = problem(&wing, Flow::default());
    let transfer = solve(&problem, &Silent).expect("solved").transfer;
    let h = 1e-4;
    for (p, limit) in [
        (c64::new(0.0, 0.3), 1e-5),
        (c64::new(-0.05, 0.3), 1e-5),
        (c64::new(0.1, 0.3), 1e-5),
        (c64::new(-0.1, 0.3), 1e-5),
        (c64::new(-0.1, 0.06), 1e-4),
    ] {
        let q = |p: c64| transfer.q(p).expect("Q");
        let along_g = (q(p + h) - q(p - h)) * faer::Scale(c64::new(0.5 / h, 0.0));
        let along_k = (q(p + c64::new(0.0, h)) - q(p - c64::new(0.0, h)))
            * faer::Scale(c64::new(0.0, -0.5 / h));
        let residual = (&along_g - &along_k).norm_max() / along_g.norm_max();
        println!("p = {p}: Cauchy–Riemann residual {residual:.1e}");
        assert!(residual < limit);
        let conjugate = q(p.conj());
        for j in 0..3 {
            for i in 0..3 {
                assert_eq!(conjugate[(i, j)], q(p)[(i, j)].conj());
            }
        }
    }
}

/// A closed surface has Σ D = −1/2 at interior points of its triangles.
#[test]
fn double_layer_row_sums_are_minus_one_half() {
    for mesh in [
        fladder_mesh::shapes::icosphere(6),
        NacaWing {
            thickness: 0.03,
            n_chord: 12,
            n_half_span: 6,
            ..NacaWing::default()
        }
        .structured()
        .expect("wing"),
    ] {
        let panels = crate::panels::PanelSet::new(&mesh.vertices, &mesh.triangles);
        let mut scratch = panels.scratch();
        let mut values = vec![[0.0; 3]; panels.len()];
        let mut worst = 0.0_f64;
        for t in 0..mesh.triangles.len() {
            let p = mesh.corners(t);
            for b in POINTS {
                let point = b[0] * p[0] + b[1] * p[1] + b[2] * p[2];
                panels.doublets(point, &mut scratch, &mut values);
                let sum: f64 = values.as_flattened().iter().sum();
                worst = worst.max((sum + 0.5).abs());
            }
        }
        println!(
            "{} triangles: row sums to {worst:.1e}",
            mesh.triangles.len()
        );
        assert!(worst < 1e-12);
    }
}

/// One panel by itself is what it is among all.
#[test]
fn a_panel_alone_gives_what_it_gives_in_the_set() {
    let mesh = fladder_mesh::shapes::icosphere(2);
    let panels = crate::panels::PanelSet::new(&mesh.vertices, &mesh.triangles);
    let mut scratch = panels.scratch();
    let mut d = vec![[0.0; 3]; panels.len()];
    let mut s = d.clone();
    for point in [
        Vec3::new(0.2, 0.1, -0.9),
        Vec3::new(1.3, -0.2, 0.4),
        Vec3::zeros(),
    ] {
        panels.doublets_and_sources(point, &mut scratch, &mut d, &mut s);
        for t in 0..panels.len() {
            let (one_d, one_s) = panels.one(t, point);
            for c in 0..3 {
                assert!(
                    (one_d[c] - d[t][c]).abs() < 1e-14 && (one_s[c] - s[t][c]).abs() < 1e-14
                );
            }
        }
    }
}

/// Hierarchical against dense, whole and half: thin wing in incidence, steady flow too.
#[test]
fn the_hierarchical_solver_gives_the_forces_of_the_dense_one() {
    let shape = NacaWing {
        n_chord: 16,
        n_half_span: 14,
        sweep_deg: 20.0,
        ..NacaWing::default()
    };
    let half_shape = NacaWing {
        extent: Extent::Half,
        ..shape
    };
    let flow = Flow {
        alpha: 0.05,
        beta: 0.0,
    };
    for (shape, symmetry) in [(shape, Symmetry::None), (half_shape, Symmetry::Symmetric)] {
        let mesh = shape.structured().expect("wing");
        let (edges, modes) = (edges(&mesh), modes(&mesh.vertices));
        let dense = Problem {
            symmetry,
            ..problem_of(&mesh, &edges, &modes, flow)
        };
        let exact = solve(&dense, &Silent).expect("solved");
        for tolerance in [1e-4, 1e-6] {
            let solver = Solver::Hierarchical { tolerance };
            let found = solve(&Problem { solver, ..dense }, &Silent).expect("solved");
            for p in [c64::new(0.0, 0.0), c64::new(0.0, 0.4), c64::new(-0.1, 0.3)] {
                let (a, b) = (
                    exact.transfer.q(p).expect("in range"),
                    found.transfer.q(p).expect("in range"),
                );
                let error = (&a - &b).norm_max() / a.norm_max();
                let lift = found.steady.lift_by_pressure / exact.steady.lift_by_pressure - 1.0;
                println!(
                    "{} unknowns, {symmetry:?}, tolerance {tolerance:.0e}, p = {p}: Q off by \
                     {error:.1e}, lift by {lift:.1e}",
                    exact.sizes.unknowns
                );
                // Single precision of the blocks leaves some 1e-6 of it.
                let limit = 10.0 * tolerance + 1e-5;
                assert!(error < limit && lift.abs() < 2.0 * limit);
            }
        }
    }
}
