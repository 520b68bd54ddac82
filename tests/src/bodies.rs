//! Closed bodies without a wake: row sums and added masses.
//!
//! A translation u = e^{st} e_i of a body in body axes meets the force −s² A_i, a rotation
//! about the centre the moment −s² J_i, for every complex s; with b = 1 and U = ρ = 1,
//! Q = 2 F, so A_i = −Q_ii / (2 p²). Lamb, Hydrodynamics, art. 92 and 114–115.

use faer::c64;
use fladder_bem::panels::PanelSet;
use fladder_mesh::shapes::{NacaWing, ellipsoid, icosphere};
use fladder_mesh::{Frame, TriMesh, Vec3};

use crate::case::{Fault, Setup, rigid_modes};
use crate::reference;
use crate::row::{Row, mesh_size};

/// Points of the Laplace plane at which masses are taken.
const POINTS: [c64; 4] = [
    c64::new(0.0, 0.3),
    c64::new(0.3, 2.0),
    c64::new(-0.2, 1.0),
    c64::new(0.5, 0.0),
];

/// Interior points of a triangle, barycentric.
const INTERIOR: [[f64; 3]; 3] = [
    [2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0],
    [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0],
    [1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0],
];

/// Σ D = −1/2 at interior points of the triangles of closed surfaces.
///
/// # Errors
/// None for the shapes used here.
pub fn row_sums(cells: usize, goal: f64) -> Result<Vec<Row>, Fault> {
    let wing = NacaWing {
        thickness: 0.03,
        n_chord: cells,
        n_half_span: cells,
        ..NacaWing::default()
    };
    let meshes = [
        ("sphere", icosphere(cells)),
        ("3 % wing", wing.structured()?),
        ("3 % wing, unstructured", wing.unstructured(1)?),
    ];
    Ok(meshes
        .iter()
        .map(|(name, mesh)| Row {
            case: format!("{name}: row sums of the double layer"),
            mesh: mesh_size(mesh),
            figure: "largest distance from −1/2".into(),
            error: worst_row_sum(mesh),
            goal,
        })
        .collect())
}

fn worst_row_sum(mesh: &TriMesh) -> f64 {
    let panels = PanelSet::new(&mesh.vertices, &mesh.triangles);
    let mut scratch = panels.scratch();
    let mut values = vec![[0.0; 3]; panels.len()];
    let mut worst = 0.0_f64;
    for t in 0..mesh.triangles.len() {
        let p = mesh.corners(t);
        for b in INTERIOR {
            let point = b[0] * p[0] + b[1] * p[1] + b[2] * p[2];
            panels.doublets(point, &mut scratch, &mut values);
            let sum: f64 = values.as_flattened().iter().sum();
            worst = worst.max((sum + 0.5).abs());
        }
    }
    worst
}

/// Three translational and three rotational masses at each of several p.
fn masses(mesh: &TriMesh) -> Result<Vec<[f64; 6]>, Fault> {
    let modes = rigid_modes(mesh, Frame::Body, Vec3::zeros());
    let solution = Setup {
        trailing_edges: Some(&[]),
        ..Setup::new(mesh, &modes)
    }
    .solve()?;
    POINTS
        .iter()
        .map(|&p| {
            let q = solution.transfer.q(p)?;
            Ok(std::array::from_fn(|i| (-q[(i, i)] / (2.0 * p * p)).re))
        })
        .collect()
}

/// Largest error of a mass at any p, relative to its own size for translations and to the
/// largest moment for rotations; and the largest difference between values of p.
fn error_of(found: &[[f64; 6]], exact: &[f64; 6]) -> (f64, f64) {
    let largest_moment = exact[3..].iter().copied().fold(0.0, f64::max);
    let mut error = 0.0_f64;
    let mut spread = 0.0_f64;
    for masses in found {
        for i in 0..6 {
            let scale = if i < 3 { exact[i] } else { largest_moment };
            if scale > 0.0 {
                error = error.max((masses[i] - exact[i]).abs() / scale);
                spread = spread.max((masses[i] - found[0][i]).abs() / scale);
            }
        }
    }
    (error, spread)
}

/// Added masses of a body named in the reference file on meshes of n triangles along the
/// edges of the icosahedron: error on the finest, order between the two finest, and
/// independence of s.
///
/// # Errors
/// Reference file or solver.
pub fn added_mass(name: &str, n: &[usize], goal: f64) -> Result<Vec<Row>, Fault> {
    let line = reference::line("ellipsoid_added_mass_open.csv", name)?;
    let axes = line.numbers(["a", "b", "c"])?;
    let exact = line.numbers(["A_x", "A_y", "A_z", "J_x", "J_y", "J_z"])?;
    let mut errors = Vec::new();
    let mut spread = 0.0;
    let mut mesh = TriMesh::default();
    for &n in n {
        mesh = ellipsoid(axes, n);
        let (error, between) = error_of(&masses(&mesh)?, &exact);
        errors.push((error, n as f64));
        spread = between;
    }
    let mut rows = vec![Row {
        case: format!("{name}: added masses at four p"),
        mesh: mesh_size(&mesh),
        figure: "largest error of A (own size) and J (largest J)".into(),
        error: errors.last().map_or(f64::NAN, |e| e.0),
        goal,
    }];
    if let [.., (coarse, few), (fine, many)] = errors[..] {
        let order = (coarse / fine).ln() / (many / few).ln();
        rows.push(Row {
            case: format!("{name}: order of convergence in h"),
            mesh: format!("n = {few} and {many}"),
            figure: format!("order {order:.2}; error is its distance from 2"),
            error: (order - 2.0).abs(),
            goal: 0.2,
        });
    }
    rows.push(Row {
        case: format!("{name}: added masses are the same at every p"),
        mesh: mesh_size(&mesh),
        figure: "largest difference".into(),
        error: spread,
        goal: 1e-12,
    });
    Ok(rows)
}
