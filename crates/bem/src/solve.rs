//! From a surface and its modes to the transfer model.

use crate::assembly::{PARTS_AT_ONCE, STRIP, STRIPS_AT_ONCE};
use crate::cut::CutSurface;
use crate::dense::{BodyOperator, Solver};
use crate::error::BemError;
use crate::image::Image;
use crate::onset::OnsetBasis;
use crate::prepare::{Prepared, concatenate};
use crate::pressure::Functionals;
use crate::progress::Progress;
use crate::reduce::Reduction;
use crate::shape_change::ShapeChange;
use crate::steady::{SteadyReport, SteadyState};
use crate::transfer::TransferModel;
use crate::wake::{Wake, cut_and_wake};
use crate::wake_sheet::WakeSheet;
use faer::Mat;
use fladder_mesh::{SurfaceMode, Symmetry, TrailingEdge, TriMesh, Vec3};
use serde::{Deserialize, Serialize};

/// Incidence of the stream.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Flow {
    /// Angle of attack, rad; nose up positive.
    pub alpha: f64,
    /// Sideslip, rad; wind from starboard positive.
    pub beta: f64,
}

impl Flow {
    /// Unit vector (cos α cos β, −sin β, sin α cos β) of the stream in mesh axes.
    pub fn stream(self) -> Vec3 {
        let (sa, ca) = self.alpha.sin_cos();
        let (sb, cb) = self.beta.sin_cos();
        Vec3::new(ca * cb, -sb, sa * cb)
    }
}

/// Where the wake goes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum WakeDirection {
    /// Along the free stream.
    #[default]
    Freestream,
    /// Along the mesh axis x, whatever the incidence.
    X,
    /// Along the free stream of [`Problem::flow`], and left there at other incidences.
    Held,
}

/// A boundary-element problem at M = 0.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// Closed surface, judged before; with a plane of symmetry open there, its vertices on
    /// the plane at y = 0 exactly.
    pub mesh: &'a TriMesh,
    /// Whole or half model. Q, forces and moments are those of the whole aircraft; the
    /// modes must have the symmetry, and the stream lies in the plane.
    pub symmetry: Symmetry,
    /// Where wakes leave; empty for none.
    pub trailing_edges: &'a [TrailingEdge],
    /// Rows and columns of Q.
    pub modes: &'a [SurfaceMode],
    /// Columns in which the steady pressure turns and stretches with the surface: elastic
    /// modes. May be empty for none.
    pub turning: &'a [bool],
    /// How columns with turning follow the shape.
    pub shape_change: ShapeChange,
    /// Incidence.
    pub flow: Flow,
    /// Wake direction.
    pub wake_direction: WakeDirection,
    /// Edges of named lines along which a wake's inner edge lies on a body; empty: the
    /// lines are found from the mesh.
    pub body_lines: &'a [[u32; 2]],
    /// Reference semichord b, m.
    pub semichord: f64,
    /// Point about which steady moments are taken, m.
    pub moment_point: Vec3,
    /// How the equations are solved.
    pub solver: Solver,
}

impl<'a> Problem<'a> {
    /// A whole surface at zero incidence, the wake along the stream, lines on bodies found
    /// from the mesh, moments about the origin, no turning of the steady pressure.
    pub fn new(
        mesh: &'a TriMesh,
        trailing_edges: &'a [TrailingEdge],
        modes: &'a [SurfaceMode],
        semichord: f64,
    ) -> Self {
        Self {
            mesh,
            symmetry: Symmetry::None,
            trailing_edges,
            modes,
            turning: &[],
            shape_change: ShapeChange::Attached,
            flow: Flow::default(),
            wake_direction: WakeDirection::Freestream,
            body_lines: &[],
            semichord,
            moment_point: Vec3::zeros(),
            solver: Solver::default(),
        }
    }
}

/// Sizes of a problem.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sizes {
    /// Unknown potentials.
    pub unknowns: usize,
    /// Triangles of the surface.
    pub triangles: usize,
    /// Doubled trailing-edge vertices, the wake's unknowns.
    pub wake_columns: usize,
    /// Triangles of the near wake.
    pub wake_elements: usize,
    /// Rows of the near wake.
    pub wake_rows: usize,
    /// Streamlines of the far wake.
    pub wake_streamlines: usize,
}

/// What a computation gives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Solution {
    /// Q anywhere in the Laplace plane.
    pub transfer: TransferModel,
    /// The steady flow it is linearised about.
    pub steady: SteadyState,
    /// How large it was.
    pub sizes: Sizes,
    /// Things the user should know.
    pub notes: Vec<String>,
}

/// What can be said before anything large is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Sizes.
    pub sizes: Sizes,
    /// Peak memory, bytes.
    pub memory_bytes: u64,
    /// Floating-point work in units of one panel evaluation and one multiply-add, made
    /// into seconds on `cores` cores by measured rates.
    pub core_seconds: f64,
    /// The wake's near part, to be looked at.
    pub wake: WakeSheet,
    /// Things the user should know.
    pub notes: Vec<String>,
}

/// Seconds of one core at 2.1 GHz with AVX-512; `benches/RESULTS.md` has the measurements.
/// With sources, tested and multiplied by them.
const SECONDS_PER_BODY_PAIR: f64 = 7.5e-9;
/// Most pairs of the wake are far and taken at few points.
const SECONDS_PER_WAKE_PAIR: f64 = 1.8e-9;
const SECONDS_PER_FAR_NODE: f64 = 1.4e-9;
/// Chosen points of clusters and regions.
const SECONDS_PER_TRIANGLE: f64 = 1e-4;
const SINGLE_FLOPS_PER_SECOND: f64 = 9e10;
const DOUBLE_FLOPS_PER_SECOND: f64 = 4e10;

/// Of the hierarchical operator, by n log₂ n: its entries, and making them and the
/// right-hand sides.
const HIERARCHICAL_BYTES: f64 = 5000.0;
const SECONDS_OF_EVALUATION: f64 = 5.5e-5;
/// All iterations for one right-hand side, by n to this power: 17 000 to 94 000 unknowns.
const SECONDS_OF_ITERATION: f64 = 8.2e-10;
const GROWTH_OF_ITERATION: f64 = 1.95;
/// A thread's Krylov spaces, by n.
const KRYLOV_BYTES: f64 = 32.0 * 32.0 * 8.0;

/// Chosen points of a region or cluster, about.
const CHOSEN: usize = 170;

/// Lays out the wake and counts.
///
/// # Errors
/// [`BemError`] where the trailing edges allow no wake.
pub fn plan(problem: &Problem<'_>) -> Result<Plan, BemError> {
    let (surface, wake) = lay_out(problem, Image::of_motion(problem.symmetry))?;
    let sizes = sizes(&surface, &wake);
    let n = sizes.unknowns as f64;
    let points = 3.0 * sizes.triangles as f64;
    let modes = problem.modes.len();
    let onsets = OnsetBasis::of(problem).len();
    let functionals = (sizes.wake_columns + (onsets + 1) * modes) as f64;
    // Each point of a half model is taken with its image; antisymmetric motion about a
    // symmetric flow needs two operators, one after the other.
    let images = if problem.symmetry == Symmetry::None {
        1.0
    } else {
        2.0
    };
    let operators = if problem.symmetry == Symmetry::Antisymmetric {
        2.0
    } else {
        1.0
    };
    let nodes =
        (wake.paths.oscillating.nodes.len() * 2 + wake.paths.decaying.nodes.len()) as f64;
    let far = images * points * sizes.wake_streamlines as f64 * nodes;
    let body_pairs = images * points * operators * sizes.triangles as f64;
    let wake_pairs = images * points * 2.0 * sizes.wake_elements as f64;
    let solved = functionals + ((1 + onsets) * modes + 6) as f64;
    let factorisation = operators * 2.0 / 3.0 * n.powi(3);
    let substitution = 2.0 * n * n * solved;
    let growth = n * n.max(2.0).log2();
    let (operator_bytes, algebra) = match problem.solver {
        Solver::Refined => (
            12.0 * n * n,
            (factorisation + 3.0 * substitution) / SINGLE_FLOPS_PER_SECOND
                + 2.0 * substitution / DOUBLE_FLOPS_PER_SECOND,
        ),
        Solver::Double => (
            8.0 * n * n,
            (factorisation + substitution) / DOUBLE_FLOPS_PER_SECOND,
        ),
        Solver::Hierarchical { .. } => (
            HIERARCHICAL_BYTES * growth + rayon_threads() * KRYLOV_BYTES * n,
            operators
                * (growth * SECONDS_OF_EVALUATION
                    + solved * SECONDS_OF_ITERATION * n.powf(GROWTH_OF_ITERATION)),
        ),
    };
    let held = PARTS_AT_ONCE * CHOSEN + STRIPS_AT_ONCE * STRIP;
    let batch = held as f64 * n * 8.0;
    let sources = 6.0 * sizes.triangles as f64 * ((1 + onsets) * modes) as f64 * 8.0;
    let columns = wake.slots.len() as f64 + 3.0 * sizes.wake_streamlines as f64 * nodes;
    let is_dense = !matches!(problem.solver, Solver::Hierarchical { .. });
    let (batch, body) = if is_dense {
        (batch, body_pairs * SECONDS_PER_BODY_PAIR)
    } else {
        (0.0, 0.0)
    };
    // The operator is gone when the wake's blocks are made.
    let at_most = (operator_bytes + batch + sources).max(16.0 * functionals * columns);
    Ok(Plan {
        memory_bytes: (at_most + 24.0 * n * solved) as u64,
        core_seconds: body
            + sizes.triangles as f64 * SECONDS_PER_TRIANGLE
            + wake_pairs * SECONDS_PER_WAKE_PAIR
            + far * SECONDS_PER_FAR_NODE
            + algebra,
        sizes,
        wake: wake.sheet,
        notes: wake.notes,
    })
}

fn rayon_threads() -> f64 {
    rayon::current_num_threads() as f64
}

/// The cut surface and the wake of a problem.
pub(crate) fn lay_out(
    problem: &Problem<'_>,
    image: Image,
) -> Result<(CutSurface, Wake), BemError> {
    cut_and_wake(
        problem.mesh,
        problem.trailing_edges,
        wake_direction(problem),
        problem.body_lines,
        problem.semichord,
        image,
    )
}

fn wake_direction(problem: &Problem<'_>) -> Vec3 {
    match problem.wake_direction {
        WakeDirection::Freestream | WakeDirection::Held => problem.flow.stream(),
        WakeDirection::X => Vec3::x(),
    }
}

fn sizes(surface: &CutSurface, wake: &Wake) -> Sizes {
    Sizes {
        unknowns: surface.vertices.len(),
        triangles: surface.triangles.len(),
        wake_columns: surface.columns.len(),
        wake_elements: wake.near.len(),
        wake_rows: wake.stations,
        wake_streamlines: wake.far.anchors.len(),
    }
}

pub(crate) fn check(problem: &Problem<'_>) -> Result<(), BemError> {
    let is_hierarchical = matches!(problem.solver, Solver::Hierarchical { .. });
    if is_hierarchical && problem.shape_change == ShapeChange::Exact {
        return Err(BemError::ShapeChangeHierarchical);
    }
    if problem.symmetry != Symmetry::None && problem.flow.beta != 0.0 {
        return Err(BemError::SideslipOnHalf {
            beta_deg: problem.flow.beta.to_degrees(),
        });
    }
    for mode in problem.modes {
        if mode.displacement.len() != problem.mesh.vertices.len() {
            return Err(BemError::ModeLength {
                mode: mode.name.clone(),
                found: mode.displacement.len(),
                expected: problem.mesh.vertices.len(),
            });
        }
        let bad = mode
            .displacement
            .iter()
            .position(|u| !u.iter().all(|x| x.is_finite()));
        if let Some(vertex) = bad {
            return Err(BemError::ModeNotFinite {
                mode: mode.name.clone(),
                vertex,
            });
        }
    }
    Ok(())
}

/// Computes the transfer model and the steady flow.
///
/// One real factorisation of the body operator (two for antisymmetric motion, whose steady
/// flow is symmetric); cost O(n³) for n vertices, memory 12 n² bytes, or 8 n² with
/// [`Solver::Double`]. Same bits at any number of threads.
///
/// # Errors
/// [`BemError`]: modes that do not fit the mesh, trailing edges that allow no wake, a
/// singular operator, sideslip on a half model, an interruption.
pub fn solve(problem: &Problem<'_>, progress: &dyn Progress) -> Result<Solution, BemError> {
    let prepared = Prepared::new(problem, progress)?;
    let functionals = Functionals::new(
        &prepared.body.galerkin,
        &prepared.fields,
        &prepared.onsets,
        &prepared.wake,
        problem.shape_change,
    );
    let parts: Vec<&Mat<f64>> = functionals.p0.iter().chain([&functionals.p1]).collect();
    let mut adjoint = concatenate(&parts);
    prepared
        .body
        .operator
        .solve_transpose(&mut adjoint, progress)?;
    let adjoint = concatenate(&[&prepared.body.jump_adjoint, &adjoint]);
    let prepared = prepared.without_operator();
    let blocks = prepared.influence().blocks(adjoint.as_ref(), progress)?;
    let reduction = Reduction {
        problem,
        wake: &prepared.wake,
        fields: &prepared.fields,
        functionals: &functionals,
        potentials: &prepared.body.potentials,
        selector: &prepared.selector,
    };
    let transfer = reduction.transfer(blocks);
    check_finite(problem, &transfer)?;
    let report = SteadyReport {
        galerkin: &prepared.body.galerkin,
        surface: &prepared.surface,
        wake: prepared.flow_wake(),
        onsets: &prepared.onsets,
        fields: &prepared.fields,
        stream: problem.flow.stream(),
        moment_point: problem.moment_point,
        symmetry: problem.symmetry,
    };
    Ok(Solution {
        transfer,
        steady: report.build(problem.trailing_edges),
        sizes: sizes(&prepared.surface, &prepared.wake),
        notes: prepared.wake.notes,
    })
}

fn check_finite(problem: &Problem<'_>, transfer: &TransferModel) -> Result<(), BemError> {
    if transfer.is_sound() {
        return Ok(());
    }
    let mode = problem
        .modes
        .first()
        .map_or_else(String::new, |m| m.name.clone());
    Err(BemError::NotFinite { mode })
}
