//! Steady velocity on ellipsoids against its exact value.
//!
//! The solver has one velocity a triangle. The mean of those round a vertex, by their areas,
//! is taken as the vertex's, and between vertices the velocity is linear on the triangle
//! that the ray from the centre through the reference point meets.

use fladder_bem::{Flow, Problem, Silent, surface_flow};
use fladder_mesh::shapes::ellipsoid;
use fladder_mesh::{Frame, TriMesh, Vec3};
use nalgebra::Matrix3;

use crate::case::{Fault, rigid_modes};
use crate::reference::{self, Line};
use crate::row::{Row, mesh_size};

const FILE: &str = "ellipsoid_surface_velocity_open.csv";

/// Root mean square and largest error of all points of a body in the file, by the stream, on
/// an icosahedron of n triangles along its edges.
///
/// # Errors
/// Reference file or solver.
pub fn rows(name: &str, n: usize, goal: f64) -> Result<Vec<Row>, Fault> {
    let axes =
        reference::line("ellipsoid_added_mass_open.csv", name)?.numbers(["a", "b", "c"])?;
    let mesh = ellipsoid(axes, n);
    let lines: Vec<Line> = reference::lines(FILE)?
        .into_iter()
        .filter(|line| line.text("name") == name)
        .collect();
    let mut flows: Vec<[f64; 2]> = Vec::new();
    let (mut squares, mut largest) = (0.0, 0.0_f64);
    for line in &lines {
        let flow = line.numbers(["alpha_deg", "beta_deg"])?;
        if !flows.contains(&flow) {
            flows.push(flow);
        }
    }
    for flow in flows {
        let velocity = on_vertices(&mesh, flow)?;
        for line in &lines {
            if line.numbers(["alpha_deg", "beta_deg"])? != flow {
                continue;
            }
            let exact = Vec3::from(line.numbers(["vx", "vy", "vz"])?);
            let point = Vec3::from(line.numbers(["x", "y", "z"])?);
            let found = at(&mesh, &velocity, &point).ok_or_else(|| Fault::Reference {
                file: FILE.to_owned(),
                what: format!("no triangle of {name} lies before ({point:.3})"),
            })?;
            let error = (found - exact).norm();
            squares += error * error;
            largest = largest.max(error);
        }
    }
    let row = |figure: &str, error: f64, goal: f64| Row {
        case: format!("{name}: surface velocity, three streams"),
        mesh: mesh_size(&mesh),
        figure: figure.to_owned(),
        error,
        goal,
    };
    let mean = (squares / lines.len() as f64).sqrt();
    Ok(vec![
        row("root mean square error by the stream", mean, goal),
        row("largest", largest, f64::INFINITY),
    ])
}

/// V₀/U of every vertex.
fn on_vertices(mesh: &TriMesh, [alpha, beta]: [f64; 2]) -> Result<Vec<Vec3>, Fault> {
    let modes = rigid_modes(mesh, Frame::Body, Vec3::zeros());
    let problem = Problem {
        flow: Flow {
            alpha: alpha.to_radians(),
            beta: beta.to_radians(),
        },
        ..Problem::new(mesh, &[], &modes, 1.0)
    };
    let flow = surface_flow(&problem, &[], &Silent)?;
    let mut sums = vec![Vec3::zeros(); mesh.vertices.len()];
    let mut areas = vec![0.0; mesh.vertices.len()];
    for (t, velocity) in flow.velocity.iter().enumerate() {
        let [a, b, c] = mesh.corners(t);
        let area = (b - a).cross(&(c - a)).norm();
        for &v in &mesh.triangles[t] {
            sums[v as usize] += area * Vec3::from(*velocity);
            areas[v as usize] += area;
        }
    }
    Ok(sums
        .iter()
        .zip(areas)
        .map(|(sum, area)| sum / area)
        .collect())
}

/// Value where the ray from the centre through `point` meets the surface.
fn at(mesh: &TriMesh, values: &[Vec3], point: &Vec3) -> Option<Vec3> {
    const EDGE: f64 = -1e-9;
    (0..mesh.triangles.len()).find_map(|t| {
        let corners = Matrix3::from_columns(&mesh.corners(t));
        let shares = corners.try_inverse()? * point;
        let total = shares.sum();
        (total > 0.0 && shares.min() >= EDGE * total).then(|| {
            mesh.triangles[t]
                .iter()
                .zip(shares.iter())
                .map(|(&v, share)| values[v as usize] * (share / total))
                .sum()
        })
    })
}
