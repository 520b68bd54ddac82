//! The flow on the surface, for pictures: steady velocity and pressure, and the unsteady
//! pressure of every mode at chosen points of the Laplace plane.
//!
//! With κ(s) = (I − KᵀR)⁻¹ Kᵀb(s), R(s) = A₀⁻¹ T W(s), the potential is φ = b + R κ, on the
//! upper corners along a body line with the carried jump added, and on a triangle
//!
//! c_p = −2 [ s φ + V₀·(∇_s φ − q) + U·q ], q = s u + ∂u,
//!
//! the pressure on the moving surface's material points per unit of the mode.

use crate::dense::{BodyOperator, Operator};
use crate::error::BemError;
use crate::prepare::Prepared;
use crate::progress::Progress;
use crate::solve::Problem;
use crate::transfer::solve_complex;
use faer::{Mat, c64};
use fladder_mesh::Vec3;
use std::collections::HashMap;

/// Flow on the triangles of the mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceFlow {
    /// V₀/U on every triangle.
    pub velocity: Vec<[f64; 3]>,
    /// Steady pressure coefficient 1 − |V₀|².
    pub pressure: Vec<f64>,
    /// One for every point asked for.
    pub unsteady: Vec<UnsteadyPressure>,
}

/// Pressure of all modes at one point of the Laplace plane.
#[derive(Clone, Debug, PartialEq)]
pub struct UnsteadyPressure {
    /// p = g + ik.
    pub p: c64,
    /// c_p per unit of the mode, 1/m for unit-metre modes: one list a mode, one value a
    /// triangle.
    pub pressure: Vec<Vec<c64>>,
}

/// Solves again with the whole potential kept; cost of [`crate::solve`] and as much as its
/// wake for every point.
///
/// # Errors
/// As [`crate::solve`]; a point on the branch cut or with k < 0 is a [`BemError::Point`].
pub fn surface_flow(
    problem: &Problem<'_>,
    points: &[c64],
    progress: &dyn Progress,
) -> Result<SurfaceFlow, BemError> {
    for p in points {
        let on_cut = p.im == 0.0 && p.re < 0.0;
        if !p.re.is_finite() || !p.im.is_finite() || p.im < 0.0 || on_cut {
            return Err(BemError::Point { g: p.re, k: p.im });
        }
    }
    let prepared = Prepared::new(problem, progress)?;
    let stream = problem.flow.stream();
    let velocity: Vec<Vec3> = (0..prepared.body.galerkin.n_triangles())
        .map(|t| prepared.onsets.velocity(t, stream))
        .collect();
    let unsteady = points
        .iter()
        .map(|&p| unsteady(&prepared, problem, &velocity, p, progress))
        .collect::<Result<_, _>>()?;
    Ok(SurfaceFlow {
        pressure: velocity.iter().map(|v| 1.0 - v.norm_squared()).collect(),
        velocity: velocity.iter().map(|&v| v.into()).collect(),
        unsteady,
    })
}

fn unsteady(
    prepared: &Prepared<Operator>,
    problem: &Problem<'_>,
    velocity: &[Vec3],
    p: c64,
    progress: &dyn Progress,
) -> Result<UnsteadyPressure, BemError> {
    let s = p / problem.semichord;
    let stream = problem.flow.stream();
    let (phi, jumps) = potentials(prepared, problem, s, progress)?;
    let fields = &prepared.fields;
    let galerkin = &prepared.body.galerkin;
    let components = fields
        .basis
        .components(stream)
        .expect("the problem's own stream is a combination of its onsets");
    let carried = carried(prepared, &jumps, s);
    let pressure = (0..fields.count)
        .map(|mode| {
            (0..galerkin.n_triangles())
                .map(|t| {
                    let corners = fields.corners(galerkin, mode, t);
                    let mean = corners.iter().sum::<Vec3>() / 3.0;
                    let convected: Vec3 = components
                        .iter()
                        .enumerate()
                        .map(|(a, u)| *u * fields.convected(a, mode, t))
                        .sum();
                    let slip = stream - velocity[t];
                    let motion = s * slip.dot(&mean) + slip.dot(&convected);
                    let mut sum = motion;
                    for (c, &v) in galerkin.triangles[t].iter().enumerate() {
                        let jump = carried.get(&(t as u32, c));
                        let value = phi[(v as usize, mode)]
                            + jump.map_or(c64::new(0.0, 0.0), |k| k[mode]);
                        sum += value * (s / 3.0 + galerkin.gradients[t][c].dot(&velocity[t]));
                    }
                    -2.0 * sum
                })
                .collect()
        })
        .collect();
    Ok(UnsteadyPressure { p, pressure })
}

/// φ and κ of every mode.
fn potentials(
    prepared: &Prepared<Operator>,
    problem: &Problem<'_>,
    s: c64,
    progress: &dyn Progress,
) -> Result<(Mat<c64>, Mat<c64>), BemError> {
    let (fields, body) = (&prepared.fields, &prepared.body);
    let (m, e) = (fields.count, fields.inertial.len());
    let components = fields
        .basis
        .components(problem.flow.stream())
        .expect("the problem's own stream is a combination of its onsets");
    let mut phi = Mat::from_fn(body.potentials.nrows(), m, |v, j| {
        s * body.potentials[(v, j)]
    });
    for (k, &mode) in fields.inertial.iter().enumerate() {
        for (a, u) in components.iter().enumerate() {
            for v in 0..phi.nrows() {
                phi[(v, mode)] += u * body.potentials[(v, m + a * e + k)];
            }
        }
    }
    let n = prepared.selector.ncols();
    if n == 0 {
        return Ok((phi, Mat::zeros(0, m)));
    }
    let tested = prepared.influence().tested(s, n, progress)?;
    let mut parts = Mat::from_fn(tested.nrows(), 2 * n, |i, j| {
        let value = tested[(i, j % n)];
        if j < n { value.re } else { value.im }
    });
    body.operator.solve(&mut parts, progress)?;
    let response = Mat::from_fn(tested.nrows(), n, |i, j| {
        c64::new(parts[(i, j)], parts[(i, j + n)])
    });
    let jump = |values: &Mat<c64>| {
        Mat::from_fn(n, values.ncols(), |j, c| {
            let column = prepared.surface.columns[j];
            values[(column.upper as usize, c)] - values[(column.lower as usize, c)]
        })
    };
    let h = jump(&response);
    let system = Mat::from_fn(n, n, |i, j| {
        let unit = if i == j { 1.0 } else { 0.0 };
        unit - h[(i, j)]
    });
    let jumps = solve_complex(system, jump(&phi)).ok_or(BemError::Singular {
        pivot: 0,
        size: n,
        value: 0.0,
    })?;
    phi += &response * &jumps;
    Ok((phi, jumps))
}

/// Jumps carried on corners of triangles, one value a mode.
fn carried<O>(
    prepared: &Prepared<O>,
    jumps: &Mat<c64>,
    s: c64,
) -> HashMap<(u32, usize), Vec<c64>> {
    let wake = &prepared.wake;
    let mut carried: HashMap<(u32, usize), Vec<c64>> = HashMap::new();
    for (triangle, corner, slot) in wake.body_corners() {
        let slot = wake.slots[slot];
        let decay = (-s * slot.xi).exp();
        let values = carried
            .entry((triangle, corner))
            .or_insert_with(|| vec![c64::new(0.0, 0.0); jumps.ncols()]);
        for (mode, value) in values.iter_mut().enumerate() {
            for &(column, weight) in &wake.threads[slot.thread] {
                *value += weight * decay * jumps[(column, mode)];
            }
        }
    }
    carried
}
