//! Ellipsoids in a stream against Kirchhoff's equations, and their roots when free.
//!
//! A body with added masses A and moments J moves through fluid at rest with −U. A small
//! motion with velocity v and rate ω in body axes meets, exactly and for every complex s,
//!
//! $$ \mathbf F = -sA\mathbf v + \boldsymbol\omega\times A\mathbf U,\qquad
//!    \mathbf M = -sJ\boldsymbol\omega + \mathbf v\times A\mathbf U
//!              + \mathbf U\times A\mathbf v , $$
//!
//! with v = s u, ω = s θ for modes in frame `body`, and v = s u + θ × U in frame
//! `inertial`. With U along x the second gives the entries in the head of
//! `ellipsoid_added_mass_open.csv`, among them the Munk moment U² (A_z − A_x).

use faer::{Mat, c64};
use fladder_bem::{Flow, TransferModel};
use fladder_mesh::shapes::ellipsoid;
use fladder_mesh::{Frame, TriMesh, Vec3};
use fladder_stability::{
    FromFunction, GafPoint, GafTable, Method, OperatingPoint, PiecewiseQuadratic, RIGID_NAMES,
    RigidBody, Sweep, System,
};

use crate::case::{Fault, Setup, rigid_modes};
use crate::reference;
use crate::row::{Row, mesh_size};

const FILE: &str = "ellipsoid_added_mass_open.csv";

/// Points of the Laplace plane; at rest only the inertial columns are not zero.
const POINTS: [c64; 4] = [
    c64::new(0.0, 0.0),
    c64::new(0.0, 0.5),
    c64::new(0.3, 1.0),
    c64::new(-0.2, 0.1),
];

/// Incidences in degrees, α and β.
const FLOWS_DEG: [[f64; 2]; 3] = [[0.0, 0.0], [10.0, 4.0], [30.0, -15.0]];

/// Semichord of the free bodies, m: their roots then lie at |g| ≤ 0.2.
const FREE_SEMICHORD: f64 = 0.25;

/// A semi-axis below this part of the longest is a disc, which needs more vertices.
const THICK: f64 = 0.2;

/// Added masses and moments of a body.
#[derive(Clone, Copy, Debug)]
struct Added {
    mass: Vec3,
    moment: Vec3,
}

/// 2 F: columns of motion, rows of force and moment, about the centre.
fn kirchhoff(added: &Added, stream: Vec3, s: c64, frame: Frame) -> Mat<c64> {
    let momentum = added.mass.component_mul(&stream);
    let mut q = Mat::zeros(6, 6);
    for j in 0..6 {
        let mut axis = Vec3::zeros();
        axis[j % 3] = 1.0;
        let (shift, turn) = if j < 3 {
            (axis, Vec3::zeros())
        } else {
            (Vec3::zeros(), axis)
        };
        let convected = match frame {
            Frame::Body => Vec3::zeros(),
            Frame::Inertial => turn.cross(&stream),
        };
        // v = s shift + convected, term by term in powers of s.
        let moment = |v: Vec3| v.cross(&momentum) + stream.cross(&added.mass.component_mul(&v));
        for i in 0..3 {
            let square = -added.mass[i] * shift[i];
            let linear = turn.cross(&momentum)[i] - added.mass[i] * convected[i];
            q[(i, j)] = 2.0 * (s * s * square + s * linear);
            let square = -added.moment[i] * turn[i];
            q[(3 + i, j)] =
                2.0 * (s * s * square + s * moment(shift)[i] + moment(convected)[i]);
        }
    }
    q
}

fn added(name: &str) -> Result<([f64; 3], Added), Fault> {
    let line = reference::line(FILE, name)?;
    let added = Added {
        mass: Vec3::from(line.numbers(["A_x", "A_y", "A_z"])?),
        moment: Vec3::from(line.numbers(["J_x", "J_y", "J_z"])?),
    };
    Ok((line.numbers(["a", "b", "c"])?, added))
}

/// Q of rigid modes, body frame first, then inertial.
fn both_frames(mesh: &TriMesh, flow: Flow, semichord: f64) -> Result<TransferModel, Fault> {
    let mut modes = rigid_modes(mesh, Frame::Body, Vec3::zeros());
    modes.extend(rigid_modes(mesh, Frame::Inertial, Vec3::zeros()));
    let setup = Setup {
        flow,
        semichord,
        trailing_edges: Some(&[]),
        ..Setup::new(mesh, &modes)
    };
    Ok(setup.solve()?.transfer)
}

/// Error of all 6 × 6 entries in both frames, relative to the largest, worst of all p and of
/// `flows` incidences.
fn stream_error(axes: [f64; 3], added: &Added, n: usize, flows: usize) -> Result<f64, Fault> {
    let mesh = ellipsoid(axes, n);
    let mut worst = 0.0_f64;
    for [alpha, beta] in FLOWS_DEG.into_iter().take(flows) {
        let flow = Flow {
            alpha: alpha.to_radians(),
            beta: beta.to_radians(),
        };
        let transfer = both_frames(&mesh, flow, 1.0)?;
        for p in POINTS {
            let q = transfer.q(p)?;
            for (from, frame) in [(0, Frame::Body), (6, Frame::Inertial)] {
                let exact = kirchhoff(added, flow.stream(), p, frame);
                let largest = exact.norm_max();
                if largest > 0.0 {
                    let found = q.as_ref().submatrix(from, from, 6, 6);
                    worst = worst.max((found - &exact).norm_max() / largest);
                }
            }
        }
    }
    Ok(worst)
}

/// Bodies of the reference file in a stream, on meshes of n triangles along the edges of the
/// icosahedron, ascending: error on the finest, and that it falls.
///
/// # Errors
/// Reference file or solver.
pub fn munk(n: &[usize], flows: usize, goal: f64) -> Result<Vec<Row>, Fault> {
    let mut rows = Vec::new();
    for line in reference::lines(FILE)? {
        let name = line.text("name");
        let (axes, added) = added(name)?;
        if axes[2] < THICK * axes[0] {
            continue;
        }
        let mut errors = Vec::new();
        for &n in n {
            errors.push(stream_error(axes, &added, n, flows)?);
        }
        let finest = n.last().copied().unwrap_or(1);
        rows.push(Row {
            case: format!("{name} in a stream, {flows} incidences, both frames"),
            mesh: mesh_size(&ellipsoid(axes, finest)),
            figure: "largest error of Q, 6 × 6, by the largest entry".into(),
            error: errors.last().copied().unwrap_or(f64::NAN),
            goal,
        });
        if let [.., coarse, fine] = errors[..] {
            rows.push(Row {
                case: format!("{name} in a stream, converging"),
                mesh: format!("n = {n:?}"),
                figure: "error by that of the mesh before".into(),
                error: fine / coarse,
                goal: 0.75,
            });
        }
    }
    Ok(rows)
}

/// Roots of a free ellipsoid from mesh, Q and eigenproblem; density 1, U = 1.
///
/// # Errors
/// Reference file, solver, eigenproblem.
pub fn free_roots(n: usize, goal: f64) -> Result<Vec<Row>, Fault> {
    let mut rows = Vec::new();
    for line in reference::lines("free_ellipsoid_eigenvalues_open.csv")? {
        let name = line.text("name").to_owned();
        let [a, b, c] = line.numbers(["a", "b", "c"])?;
        let [mass, iyy, izz] = line.numbers(["m", "Iy", "Iz"])?;
        let body = RigidBody {
            mass,
            ixx: mass * (b * b + c * c) / 5.0,
            iyy,
            izz,
            ixz: 0.0,
        };
        let mesh = ellipsoid([a, b, c], n);
        let found = roots(&mesh, body)?;
        let [pitch, yaw] = line.numbers(["s_pitch_abs", "s_yaw_abs"])?;
        let mut exact = [-pitch, -yaw, yaw, pitch];
        exact.sort_by(f64::total_cmp);
        let error = if found.len() == exact.len() {
            let errors = found
                .iter()
                .zip(exact)
                .map(|(s, e)| (s - e).norm() / e.abs());
            errors.fold(0.0, f64::max)
        } else {
            f64::NAN
        };
        rows.push(Row {
            case: format!("free {name}: roots s = ±{pitch:.4}, ±{yaw:.4}"),
            mesh: mesh_size(&mesh),
            figure: "largest error of a root; eight roots are zero".into(),
            error,
            goal,
        });
    }
    Ok(rows)
}

/// Roots that are not zero, by real part.
fn roots(mesh: &TriMesh, body: RigidBody) -> Result<Vec<c64>, Fault> {
    let stability = |error: &dyn std::fmt::Display| Fault::Stability(error.to_string());
    let transfer = both_frames(mesh, Flow::default(), FREE_SEMICHORD)?;
    let scales = body.scales();
    let q = |p: c64| {
        // Without a wake there is no branch cut; just above the axis Q is the same.
        let p = c64::new(p.re, p.im.max(1e-12));
        transfer
            .q(p)
            .map(|q| Mat::from_fn(6, 6, |i, j| q[(i, j)] * scales[i] * scales[j]))
    };
    let mut points = Vec::new();
    for k in (0..=8).map(|i| 0.05 * f64::from(i)) {
        let q = if k == 0.0 {
            q(c64::new(0.0, 0.0))?
        } else {
            q(c64::new(0.0, k))?
        };
        points.push(GafPoint { g: 0.0, k, q });
    }
    let names: Vec<String> = RIGID_NAMES.map(str::to_owned).to_vec();
    let table = GafTable::new(FREE_SEMICHORD, 0.0, names.clone(), points, vec![])
        .map_err(|e| stability(&e))?;
    let fit = PiecewiseQuadratic::centred(&table, 1.0).map_err(|e| stability(&e))?;
    let unit = Mat::from_fn(6, 6, |i, j| if i == j { 1.0 } else { 0.0 });
    let system = System::from_matrices(names, unit, Mat::zeros(6, 6), Mat::zeros(6, 6))
        .map_err(|e| stability(&e))?
        .with_rigid_body(body);
    let exact = FromFunction::new(6, |p: c64| {
        q(p).unwrap_or_else(|_| Mat::from_fn(6, 6, |_, _| c64::new(f64::NAN, 0.0)))
    });
    let schedule = vec![OperatingPoint::new(1.0, 1.0)];
    let sweep = Sweep {
        smooth: Some(&exact),
        method: Method::P2,
        ..Sweep::new(&system, &schedule, &table, &fit)
    };
    let result = sweep.run(&()).map_err(|e| stability(&e))?;
    let p2 = result.methods.p2.ok_or_else(|| stability(&"no p2 roots"))?;
    let mut roots: Vec<c64> = p2
        .branches
        .iter()
        .map(|branch| c64::new(branch.sigma[0], branch.omega[0]))
        .collect();
    roots.sort_by(|a, b| a.re.total_cmp(&b.re));
    Ok(roots)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The entries in the head of the reference file, U along x.
    #[test]
    fn with_the_stream_along_x_kirchhoff_gives_the_entries_of_the_file() {
        let (_, added) = added("triaxial_2_1_0.5").expect("reference");
        let s = c64::new(0.3, -0.7);
        let q = kirchhoff(&added, Vec3::x(), s, Frame::Inertial);
        let (a, j) = (added.mass, added.moment);
        let mut exact = Mat::<c64>::zeros(6, 6);
        for i in 0..3 {
            exact[(i, i)] = -s * s * a[i];
            exact[(3 + i, 3 + i)] = -s * s * j[i];
        }
        exact[(4, 2)] = -s * (a.z - a.x);
        exact[(2, 4)] = s * (a.z - a.x);
        exact[(4, 4)] += c64::new(a.z - a.x, 0.0);
        exact[(5, 1)] = s * (a.y - a.x);
        exact[(1, 5)] = -s * (a.y - a.x);
        exact[(5, 5)] += c64::new(a.y - a.x, 0.0);
        for i in 0..6 {
            for k in 0..6 {
                assert!((q[(i, k)] - 2.0 * exact[(i, k)]).norm() < 1e-14, "{i} {k}");
            }
        }
    }
}
