//! Elastic columns in a loaded steady flow, against steady solutions on deformed meshes.

mod common;

use common::{edges, mode};
use fladder_bem::{Flow, Problem, Silent, WakeDirection, solve};
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

#[test]
fn turning_of_the_steady_pressure() {
    for thickness in [0.12, 0.06] {
        let mesh = NacaWing {
            thickness,
            n_chord: 12,
            n_half_span: 8,
            ..NacaWing::default()
        }
        .structured()
        .expect("wing");
        let (edges, modes) = (edges(&mesh), modes(&mesh));
        let elastic: Vec<bool> = (0..modes.len()).map(|i| i > 1).collect();
        let q = |turning: &[bool]| {
            solve(&problem(&mesh, &edges, &modes, turning), &Silent)
                .expect("solved")
                .transfer
                .q(faer::c64::new(0.0, 0.0))
                .expect("Q")
        };
        let (turned, fixed) = (q(&elastic), q(&[]));
        for (j, mode) in modes.iter().enumerate() {
            let step = 1e-3;
            let forces = |amplitude: f64| {
                let mesh = moved(&mesh, mode, amplitude);
                solve(&problem(&mesh, &edges, &modes, &[]), &Silent)
                    .expect("solved")
                    .steady
                    .generalised_forces
            };
            let (up, down) = (forces(step), forces(-step));
            let truth: Vec<f64> = up
                .iter()
                .zip(&down)
                .map(|(a, b)| (a - b) / (2.0 * step))
                .collect();
            let size = truth.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            let error = |q: &faer::Mat<faer::c64>| {
                truth
                    .iter()
                    .enumerate()
                    .map(|(i, t)| (q[(i, j)].re - t).abs())
                    .fold(0.0, f64::max)
                    / size
            };
            println!(
                "{thickness} {}: size {size:.4}, error without turning {:.4}, with {:.4}",
                mode.name,
                error(&fixed),
                error(&turned)
            );
            println!("   truth  {truth:.4?}");
            println!(
                "   turned {:.4?}",
                (0..modes.len())
                    .map(|i| turned[(i, j)].re)
                    .collect::<Vec<_>>()
            );
            println!(
                "   fixed  {:.4?}",
                (0..modes.len())
                    .map(|i| fixed[(i, j)].re)
                    .collect::<Vec<_>>()
            );
        }
    }
}
