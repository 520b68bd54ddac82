//! From a surface and its modes to the transfer model.

use crate::boundary::ModeFields;
use crate::cut::CutSurface;
use crate::dense::{BodyOperator, DenseOperator};
use crate::error::BemError;
use crate::galerkin::Galerkin;
use crate::pressure::Functionals;
use crate::progress::Progress;
use crate::steady::{SteadyReport, SteadyState, UnitOnsets};
use crate::transfer::{Block, FarBlocks, NearBlocks, TransferModel};
use crate::wake::{Wake, cut_and_wake};
use crate::wake_influence::{WakeBlocks, WakeInfluence};
use faer::{Mat, MatRef, c64};
pub use fladder_mesh::Symmetry;
use fladder_mesh::{SurfaceMode, TrailingEdge, TriMesh, Vec3};
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
}

/// A boundary-element problem at M = 0.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// Closed surface, judged before.
    pub mesh: &'a TriMesh,
    /// Where wakes leave; empty for none.
    pub trailing_edges: &'a [TrailingEdge],
    /// Rows and columns of Q.
    pub modes: &'a [SurfaceMode],
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
    /// Whether the mesh is the half on y ≥ 0, and of which motion.
    pub symmetry: Symmetry,
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
    /// Things the user should know.
    pub notes: Vec<String>,
}

/// Measured on one core at 4.2 GHz: see `benches/RESULTS.md`.
const SECONDS_PER_PANEL_PAIR: f64 = 45e-9;
const SECONDS_PER_FAR_NODE: f64 = 45e-9;
const FLOPS_PER_SECOND: f64 = 8e10;

/// Lays out the wake and counts.
///
/// # Errors
/// [`BemError`] where the trailing edges allow no wake.
pub fn plan(problem: &Problem<'_>) -> Result<Plan, BemError> {
    let (surface, wake) = lay_out(problem)?;
    let sizes = sizes(&surface, &wake);
    let n = sizes.unknowns as f64;
    let points = 3.0 * sizes.triangles as f64;
    let functionals = (sizes.wake_columns + 2 * problem.modes.len()) as f64;
    let nodes =
        (wake.paths.oscillating.nodes.len() * 2 + wake.paths.decaying.nodes.len()) as f64;
    let far = points * sizes.wake_streamlines as f64 * nodes;
    let pairs = points * (sizes.triangles as f64 + 2.0 * sizes.wake_elements as f64);
    let flops = 2.0 / 3.0 * n.powi(3)
        + 2.0 * n * n * (functionals + problem.modes.len() as f64)
        + 2.0 * points * functionals * (wake.slots.len() as f64)
        + 4.0 * far * functionals;
    let batch = 32.0 * 48.0 * n * 8.0;
    let influences = 48.0 * 3.0 * sizes.triangles as f64 * 8.0 * rayon_threads();
    let blocks = 16.0 * functionals * (wake.slots.len() as f64 * 8.0)
        + 16.0 * functionals * (sizes.wake_streamlines as f64 * nodes * 16.0);
    Ok(Plan {
        memory_bytes: (n * n * 8.0 + batch + influences + blocks + n * functionals * 16.0)
            as u64,
        core_seconds: pairs * SECONDS_PER_PANEL_PAIR
            + far * SECONDS_PER_FAR_NODE
            + flops / FLOPS_PER_SECOND,
        sizes,
        notes: wake.notes,
    })
}

fn rayon_threads() -> f64 {
    rayon::current_num_threads() as f64
}

/// The cut surface and the wake of a problem.
pub(crate) fn lay_out(problem: &Problem<'_>) -> Result<(CutSurface, Wake), BemError> {
    if problem.symmetry.is_half() {
        return Err(BemError::HalfModel);
    }
    cut_and_wake(
        problem.mesh,
        problem.trailing_edges,
        wake_direction(problem),
        problem.body_lines,
        problem.semichord,
    )
}

fn wake_direction(problem: &Problem<'_>) -> Vec3 {
    match problem.wake_direction {
        WakeDirection::Freestream => problem.flow.stream(),
        WakeDirection::X => Vec3::x(),
    }
}

fn sizes(surface: &CutSurface, wake: &Wake) -> Sizes {
    Sizes {
        unknowns: surface.vertices.len(),
        triangles: surface.triangles.len(),
        wake_columns: surface.columns.len(),
        wake_elements: wake.near.panels.len(),
        wake_rows: wake.stations,
        wake_streamlines: wake.far.anchors.len(),
    }
}

fn check_modes(problem: &Problem<'_>) -> Result<(), BemError> {
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
/// One real factorisation of the body operator; cost O(n³) for n vertices, memory 8 n²
/// bytes. Same bits at any number of threads.
///
/// # Errors
/// [`BemError`]: modes that do not fit the mesh, trailing edges that allow no wake, a
/// singular operator, an interruption.
pub fn solve(problem: &Problem<'_>, progress: &dyn Progress) -> Result<Solution, BemError> {
    check_modes(problem)?;
    let (surface, wake) = lay_out(problem)?;
    let stream = problem.flow.stream();
    let galerkin = Galerkin::new(&surface);
    let fields = ModeFields::new(&galerkin, &surface.source, problem.modes, stream);
    let sources = fields.sources(&galerkin);
    let assembly = galerkin.assemble(sources.as_ref(), progress)?;
    drop(sources);
    let stage = "factorising";
    progress.stage(stage, 1);
    let operator = DenseOperator::new(assembly.rows, galerkin.n_vertices)?;
    progress.advance(1);
    if progress.cancelled() {
        return Err(BemError::Interrupted { stage });
    }
    let mut potentials = assembly.right_hand_sides;
    operator.solve(&mut potentials);
    let influence = WakeInfluence {
        galerkin: &galerkin,
        wake: &wake,
        free_terms: &assembly.free_terms,
    };
    let selector = selector(&surface);
    let onsets = steady_onsets(
        &influence,
        &operator,
        &selector,
        &fields,
        &potentials,
        progress,
    )?;
    let functionals = Functionals::new(&galerkin, &fields, &onsets, &wake, stream);
    let mut adjoint = concatenate(&[&selector, &functionals.p0, &functionals.p1]);
    operator.solve_transpose(&mut adjoint);
    drop(operator);
    let mut blocks = influence.blocks(adjoint.as_ref(), progress)?;
    add_carried(&mut blocks, &functionals, surface.columns.len());
    let transfer = reduce(
        problem,
        &surface,
        &wake,
        &fields,
        &functionals,
        &potentials,
        &blocks,
    );
    check_finite(problem, &transfer)?;
    let report = SteadyReport {
        galerkin: &galerkin,
        surface: &surface,
        wake: &wake,
        onsets: &onsets,
        stream,
        moment_point: problem.moment_point,
    };
    let steady = report.build(problem.trailing_edges, functionals.steady);
    Ok(Solution {
        transfer,
        steady,
        sizes: sizes(&surface, &wake),
        notes: wake.notes,
    })
}

/// K: +1 at upper, −1 at lower vertices.
fn selector(surface: &CutSurface) -> Mat<f64> {
    let mut k = Mat::zeros(surface.vertices.len(), surface.columns.len());
    for (j, column) in surface.columns.iter().enumerate() {
        k[(column.upper as usize, j)] = 1.0;
        k[(column.lower as usize, j)] = -1.0;
    }
    k
}

/// Kᵀ φ.
fn jumps_of(surface_selector: &Mat<f64>, potentials: MatRef<'_, f64>) -> Mat<f64> {
    surface_selector.transpose() * potentials
}

/// Steady potentials and jumps for the three unit onsets.
fn steady_onsets(
    influence: &WakeInfluence<'_>,
    operator: &dyn BodyOperator,
    selector: &Mat<f64>,
    fields: &ModeFields,
    potentials: &Mat<f64>,
    progress: &dyn Progress,
) -> Result<UnitOnsets, BemError> {
    let n = selector.ncols();
    let first = fields.count + fields.inertial.len();
    let mut phi = potentials.subcols(first, 3).to_owned();
    let mut jumps = Mat::zeros(n, 3);
    if n > 0 {
        let mut response = influence.steady(n, progress)?;
        operator.solve(&mut response);
        let h = jumps_of(selector, response.as_ref());
        let system = Mat::from_fn(n, n, |i, j| {
            let unit = if i == j { 1.0 } else { 0.0 };
            c64::new(unit - h[(i, j)], 0.0)
        });
        let right = jumps_of(selector, phi.as_ref());
        let right = Mat::from_fn(n, 3, |i, j| c64::new(right[(i, j)], 0.0));
        let solved =
            crate::transfer::solve_complex(system, right).ok_or(BemError::Singular {
                pivot: 0,
                size: n,
                value: 0.0,
            })?;
        jumps = Mat::from_fn(n, 3, |i, j| solved[(i, j)].re);
        phi += &response * &jumps;
    }
    Ok(UnitOnsets::new(
        influence.galerkin,
        influence.wake,
        &phi,
        jumps,
    ))
}

fn concatenate(parts: &[&Mat<f64>]) -> Mat<f64> {
    let rows = parts[0].nrows();
    let columns = parts.iter().map(|p| p.ncols()).sum();
    let mut all = Mat::zeros(rows, columns);
    let mut from = 0;
    for part in parts {
        all.subcols_mut(from, part.ncols()).copy_from(part);
        from += part.ncols();
    }
    all
}

/// Adds the direct share of the jump on bodies to the rows of P0 and P1.
fn add_carried(blocks: &mut WakeBlocks, functionals: &Functionals, columns: usize) {
    let m = functionals.steady.len();
    for (slot, p0, p1) in &functionals.carried {
        for i in 0..m {
            blocks.near[(columns + i, *slot)] += p0[i];
            blocks.near[(columns + m + i, *slot)] += p1[i];
        }
    }
}

fn reduce(
    problem: &Problem<'_>,
    surface: &CutSurface,
    wake: &Wake,
    fields: &ModeFields,
    functionals: &Functionals,
    potentials: &Mat<f64>,
    blocks: &WakeBlocks,
) -> TransferModel {
    let m = fields.count;
    let b1 = potentials.subcols(0, m);
    let mut b0 = Mat::<f64>::zeros(potentials.nrows(), m);
    for (e, &mode) in fields.inertial.iter().enumerate() {
        b0.col_mut(mode).copy_from(potentials.col(m + e));
    }
    let selector = selector(surface);
    let block = |matrix: Mat<f64>| Block::new(matrix.as_ref());
    TransferModel {
        semichord: problem.semichord,
        modes: m,
        columns: surface.columns.len(),
        jump1: block(jumps_of(&selector, b1)),
        jump0: block(jumps_of(&selector, b0.as_ref())),
        p0_b1: block(functionals.p0.transpose() * b1),
        p0_b0: block(functionals.p0.transpose() * &b0),
        p1_b1: block(functionals.p1.transpose() * b1),
        p1_b0: block(functionals.p1.transpose() * &b0),
        c1: Block::new(functionals.c1.as_ref()),
        c0: Block::new(functionals.c0.as_ref()),
        near: near_blocks(wake, &blocks.near),
        oscillating: far_blocks(
            wake,
            &wake.paths.oscillating,
            &blocks.far[0],
            surface.columns.len(),
        ),
        decaying: far_blocks(
            wake,
            &wake.paths.decaying,
            &blocks.far[1],
            surface.columns.len(),
        ),
    }
}

fn near_blocks(wake: &Wake, near: &Mat<f64>) -> NearBlocks {
    let mut stations: Vec<f64> = wake.slots.iter().map(|s| s.xi).collect();
    stations.sort_by(f64::total_cmp);
    stations.dedup();
    let mut blocks = NearBlocks {
        stations,
        ..NearBlocks::default()
    };
    for (r, slot) in wake.slots.iter().enumerate() {
        let station = blocks.stations.partition_point(|x| *x < slot.xi);
        for &(column, weight) in &wake.threads[slot.thread] {
            blocks.entries.push((column as u32, station as u32));
            blocks
                .values
                .extend((0..near.nrows()).map(|i| weight * near[(i, r)]));
        }
    }
    blocks
}

fn far_blocks(
    wake: &Wake,
    path: &crate::contour::Path,
    far: &Mat<c64>,
    columns: usize,
) -> FarBlocks {
    let (f, n) = (far.nrows(), path.nodes.len());
    let mut re = vec![0.0; f * columns * n];
    let mut im = re.clone();
    for (line, &thread) in wake.far_threads.iter().enumerate() {
        for &(column, weight) in &wake.threads[thread] {
            for node in 0..n {
                let from = (node * columns + column) * f;
                for i in 0..f {
                    let entry = far[(i, line * n + node)];
                    re[from + i] += weight * entry.re;
                    im[from + i] += weight * entry.im;
                }
            }
        }
    }
    FarBlocks::new(path, re, im)
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
