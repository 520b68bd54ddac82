//! Elastic columns in a loaded steady flow, against steady solutions on deformed meshes.

mod common;

use common::{edges, mode};
use fladder_bem::{Flow, Problem, ShapeChange, Silent, WakeDirection, solve};
use fladder_mesh::shapes::NacaWing;
use fladder_mesh::{Frame, SurfaceMode, TriMesh, Vec3};

const HALF_SPAN: f64 = 4.0;

/// Rows and columns: bending, torsion about the quarter chord, in-plane bending, and a
/// thickening of the section.
fn modes(mesh: &TriMesh) -> Vec<SurfaceMode> {
    let shape = |y: f64| (y / HALF_SPAN) * (y / HALF_SPAN);
    let slope = |y: f64| 2.0 * y / (HALF_SPAN * HALF_SPAN);
    let inertial =
        |name: &str, field: &dyn Fn(&Vec3) -> Vec3| mode(mesh, name, Frame::Inertial, field);
    vec![
        inertial("plunge", &|_| Vec3::z()),
        inertial("pitch", &|x| Vec3::new(x.z, 0.0, 0.25 - x.x)),
        // Sections stay plane and normal to the bent axis.
        inertial("bending", &|x| {
            Vec3::new(0.0, -x.z * slope(x.y), shape(x.y))
        }),
        inertial("torsion", &|x| {
            let twist = shape(x.y);
            Vec3::new(x.z * twist, 0.0, (0.25 - x.x) * twist)
        }),
        inertial("in-plane", &|x| {
            Vec3::new(shape(x.y), -(x.x - 0.5) * slope(x.y), 0.0)
        }),
        inertial("breathing", &|x| Vec3::new(0.0, 0.0, x.z * shape(x.y))),
    ]
}

fn moved(mesh: &TriMesh, mode: &SurfaceMode, amplitude: f64) -> TriMesh {
    let mut moved = mesh.clone();
    for (vertex, u) in moved.vertices.iter_mut().zip(&mode.displacement) {
        *vertex += amplitude * u;
    }
    moved
}

fn problem<'a>(
    mesh: &'a TriMesh,
    edges: &'a [fladder_mesh::TrailingEdge],
    modes: &'a [SurfaceMode],
    turning: &'a [bool],
) -> Problem<'a> {
    Problem {
        turning,
        flow: Flow {
            alpha: 4_f64.to_radians(),
            beta: 0.0,
        },
        wake_direction: WakeDirection::X,
        ..Problem::new(mesh, edges, modes, 0.5)
    }
}

/// Q(0) of one way of computing elastic columns.
fn forces(problem: &Problem<'_>) -> faer::Mat<faer::c64> {
    let transfer = solve(problem, &Silent).expect("solved").transfer;
    transfer.q(faer::c64::new(0.0, 0.0)).expect("Q")
}

/// Derivatives of the generalised forces by steady solutions on deformed meshes.
fn truth(
    mesh: &TriMesh,
    edges: &[fladder_mesh::TrailingEdge],
    modes: &[SurfaceMode],
    j: usize,
) -> Vec<f64> {
    let step = 1e-3;
    let forces = |amplitude: f64| {
        let mesh = moved(mesh, &modes[j], amplitude);
        solve(&problem(&mesh, edges, modes, &[]), &Silent)
            .expect("solved")
            .steady
            .generalised_forces
    };
    let (up, down) = (forces(step), forces(-step));
    up.iter()
        .zip(&down)
        .map(|(a, b)| (a - b) / (2.0 * step))
        .collect()
}

#[test]
fn elastic_columns_against_steady_solutions_on_deformed_meshes() {
    let mesh = NacaWing {
        n_chord: 8,
        n_half_span: 5,
        ..NacaWing::default()
    }
    .structured()
    .expect("wing");
    let (edges, modes) = (edges(&mesh), modes(&mesh));
    let elastic: Vec<bool> = (0..modes.len()).map(|i| i > 1).collect();
    let fixed = forces(&problem(&mesh, &edges, &modes, &[]));
    let attached = forces(&problem(&mesh, &edges, &modes, &elastic));
    let exact = forces(&Problem {
        shape_change: ShapeChange::Exact,
        ..problem(&mesh, &edges, &modes, &elastic)
    });
    let largest = attached.norm_max();
    for (j, mode) in modes.iter().enumerate().skip(2) {
        let truth = truth(&mesh, &edges, &modes, j);
        let size = truth.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let error = |q: &faer::Mat<faer::c64>| {
            truth
                .iter()
                .enumerate()
                .map(|(i, t)| (q[(i, j)].re - t).abs())
                .fold(0.0, f64::max)
        };
        println!(
            "{}: column {size:.3}; error without turning {:.4}, with {:.4}, exact {:.1e}",
            mode.name,
            error(&fixed),
            error(&attached),
            error(&exact)
        );
        assert!(error(&attached) < 0.01 * largest);
        assert!(error(&exact) < 1e-4 * size.max(1e-3 * largest));
    }
}
