//! What the surface-attached form leaves out of elastic columns: the change of the steady
//! potential with the shape.
//!
//! The potential carried by the surface would keep its values if every part only moved
//! rigidly. Bending and stretching change the influence of one part on another. With the
//! steady residual R(ξ) = T{ c φ₀ − D φ₀ + S σ₀ − W(0) κ₀ } on the surface deformed by
//! mode j, at the potentials of the undeformed one, the exact first-order potential is
//!
//! b₀ = −A₀⁻¹ dR/dξ,
//!
//! by central differences over a small amplitude; σ₀ = −n·U turns with the surface, so that
//! dR/dξ holds the boundary condition ∂u·n too, and the wake's sheet moves with its edge.
//! The velocity V₀ = U − n (n·U) + ∇_s φ₀ changes by the metric,
//!
//! V₀·δV = −(V₀·δn)(n·U) − ((V₀·∇_s) u)·∇_s φ₀ + V₀·∇_s φ,
//!
//! which takes the place of (U − V₀)·∂u in C0. For rigid rotation both forms are one.

use crate::boundary::{ModeFields, onset_sources};
use crate::dense::BodyOperator;
use crate::error::BemError;
use crate::galerkin::Galerkin;
use crate::image::Image;
use crate::prepare::Prepared;
use crate::progress::{Progress, Silent};
use crate::solve::{Problem, lay_out};
use crate::wake_influence::WakeInfluence;
use faer::Mat;
use fladder_mesh::{TriMesh, Vec3};

/// Largest displacement of the differences in semichords: truncation 1e-6 and rounding
/// 1e-9 of the column.
const AMPLITUDE: f64 = 1e-3;

/// How elastic columns follow the shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ShapeChange {
    /// Unknowns carried with the surface, influences unchanged.
    #[default]
    Attached,
    /// Influences of the deformed surface, by differences: two more assemblies a mode.
    Exact,
}

/// Replaces the convected potentials of the elastic modes by the exact ones.
pub(crate) fn correct_potentials<O: BodyOperator>(
    prepared: &mut Prepared<O>,
    problem: &Problem<'_>,
    progress: &dyn Progress,
) -> Result<(), BemError> {
    let (m, e, onsets) = {
        let fields = &prepared.fields;
        (fields.count, fields.inertial.len(), fields.basis.len())
    };
    let stage = "deforming the surface";
    let elastic: Vec<(usize, usize)> = (0..e)
        .map(|k| (k, prepared.fields.inertial[k]))
        .filter(|&(_, mode)| prepared.fields.turning[mode])
        .collect();
    progress.stage(stage, elastic.len() as u64);
    let steady = steady_solutions(prepared);
    for (k, mode) in elastic {
        if progress.cancelled() {
            return Err(BemError::Interrupted { stage });
        }
        let largest = problem.modes[mode]
            .displacement
            .iter()
            .map(Vec3::norm)
            .fold(0.0, f64::max);
        if largest > 0.0 {
            let amplitude = AMPLITUDE * problem.semichord / largest;
            let up = residual(problem, &steady, mode, amplitude)?;
            let down = residual(problem, &steady, mode, -amplitude)?;
            let mut change = (down - up) * faer::Scale(0.5 / amplitude);
            prepared.body.operator.solve(&mut change, &Silent)?;
            for a in 0..onsets {
                let column = m + a * e + k;
                prepared
                    .body
                    .potentials
                    .col_mut(column)
                    .copy_from(change.col(a));
            }
        }
        progress.advance(1);
    }
    Ok(())
}

/// Steady potential without carried jumps, and jump, of the onsets of the basis.
struct Steady {
    potentials: Mat<f64>,
    jumps: Mat<f64>,
    /// Rows x, y, z; one column an onset.
    onsets: Mat<f64>,
}

fn steady_solutions<O>(prepared: &Prepared<O>) -> Steady {
    let axes: Vec<Vec3> = prepared.fields.basis.axes().collect();
    let onsets = Mat::from_fn(3, axes.len(), |i, a| axes[a][i]);
    Steady {
        potentials: &prepared.onsets.potentials * &onsets,
        jumps: &prepared.onsets.jumps * &onsets,
        onsets,
    }
}

/// R of the surface moved by `amplitude` of a mode, one column an onset.
fn residual(
    problem: &Problem<'_>,
    steady: &Steady,
    mode: usize,
    amplitude: f64,
) -> Result<Mat<f64>, BemError> {
    let mut mesh: TriMesh = problem.mesh.clone();
    for (vertex, u) in mesh
        .vertices
        .iter_mut()
        .zip(&problem.modes[mode].displacement)
    {
        *vertex += amplitude * u;
    }
    let moved = Problem {
        mesh: &mesh,
        ..*problem
    };
    let image = Image::of_flow(problem.symmetry);
    let (surface, wake) = lay_out(&moved, image)?;
    let galerkin = Galerkin::new(&surface, image);
    let sources = onset_sources(&galerkin) * &steady.onsets;
    let assembly = galerkin.assemble(sources.as_ref(), &Silent)?;
    let n = galerkin.n_vertices;
    let rows = faer::MatRef::from_row_major_slice(&assembly.rows, n, n);
    let mut residual = rows * &steady.potentials - &assembly.right_hand_sides;
    if steady.jumps.nrows() > 0 {
        let influence = WakeInfluence {
            galerkin: &galerkin,
            wake: &wake,
            free_terms: &assembly.free_terms,
            slopes: &assembly.slopes,
        };
        residual -= influence.steady(steady.jumps.nrows(), &Silent)? * &steady.jumps;
    }
    Ok(residual)
}

/// The metric part of C0 on one triangle for onsets a (of V₀) and b (of U and φ₀).
pub(crate) fn metric_change(
    galerkin: &Galerkin,
    fields: &ModeFields,
    mode: usize,
    t: usize,
    velocities: (Vec3, Vec3),
    onset: Vec3,
) -> f64 {
    let (normal, gradients) = (galerkin.normals[t], &galerkin.gradients[t]);
    let corners = fields.corners(galerkin, mode, t);
    let (velocity, other) = velocities;
    let mut turned = Vec3::zeros();
    let mut along = Vec3::zeros();
    for (u, g) in corners.iter().zip(gradients) {
        turned -= g * u.dot(&normal);
        along += g.dot(&velocity) * u;
    }
    let normal_speed = normal.dot(&onset);
    let perturbation = other - (onset - normal * normal_speed);
    -velocity.dot(&turned) * normal_speed - along.dot(&perturbation)
}

/// The body whose potentials are corrected must have the flow's symmetry.
pub(crate) fn check_symmetry(problem: &Problem<'_>) -> Result<(), BemError> {
    let same = Image::of_flow(problem.symmetry) == Image::of_motion(problem.symmetry);
    if problem.shape_change == ShapeChange::Exact && !same {
        return Err(BemError::ShapeChangeOnHalf);
    }
    Ok(())
}
