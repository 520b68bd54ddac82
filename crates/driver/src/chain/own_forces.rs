//! Forces computed here: from the cache where they are there.
//!
//! What is stored is the transfer model of one surface, one set of modes and
//! one incidence; grids of $(g, k)$ are views of it.

use super::aircraft::Aircraft;
use crate::cache::{Cache, Key, KeyBuilder, Stored};
use crate::case::{self, CaseFile, SolverChoice, WakeDirection};
use crate::failure::Failure;
use crate::gaf_json::{self, Document, Frame, Sample};
use crate::memory::{bytes_in_words, usable_bytes};
use crate::terminal::{Bar, Console, Effort, warn};
use faer::c64;
use fladder_bem::{BemError, Flow, LaplaceError, Plan, Problem, Solution, Solver};
use fladder_mesh::Vec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Word of meaning of stored forces. It changes when the same inputs would
/// give other numbers, or when the layout of what is stored changes.
const MEANING: &str = "gaf/6";

/// An entry of the cache.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct StoredForces {
    pub(crate) mach: f64,
    pub(crate) alpha_deg: f64,
    pub(crate) beta_deg: f64,
    pub(crate) solution: Solution,
}

impl Stored for StoredForces {
    fn is_sound(&self) -> bool {
        let transfer = &self.solution.transfer;
        let steady = &self.solution.steady;
        let angles = [self.mach, self.alpha_deg, self.beta_deg];
        transfer.is_sound()
            && steady.generalised_forces.len() == transfer.n_modes()
            && steady
                .generalised_forces
                .iter()
                .chain(&angles)
                .all(|value| value.is_finite())
    }
}

/// How the forces were come by.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Origin {
    Cache,
    Computed(Effort),
}

/// Forces with their place in the cache.
#[derive(Clone, Debug)]
pub(crate) struct OwnForces {
    pub(crate) key: Key,
    pub(crate) origin: Origin,
    pub(crate) stored: StoredForces,
}

/// The boundary-element problem of a case.
pub(crate) fn problem<'a>(file: &CaseFile, aircraft: &'a Aircraft) -> Problem<'a> {
    let case = &file.case;
    Problem {
        turning: &aircraft.turning,
        shape_change: match case.structure.as_ref().map(|given| given.shape_change) {
            Some(case::ShapeChange::Exact) => fladder_bem::ShapeChange::Exact,
            _ => fladder_bem::ShapeChange::Attached,
        },
        flow: Flow {
            alpha: case.flow.alpha_deg.to_radians(),
            beta: case.flow.beta_deg.to_radians(),
        },
        wake_direction: match case.wake.direction {
            // One model serves every incidence of a trimmed sweep.
            WakeDirection::Freestream if is_level(case) => fladder_bem::WakeDirection::Held,
            WakeDirection::Freestream => fladder_bem::WakeDirection::Freestream,
            WakeDirection::X => fladder_bem::WakeDirection::X,
        },
        body_lines: &aircraft.surface.body_lines,
        moment_point: Vec3::from(case.reference.moment_point),
        symmetry: aircraft.surface.symmetry,
        solver: solver(&case.gaf, aircraft.surface.mesh.vertices.len()),
        ..Problem::new(
            &aircraft.surface.mesh,
            &aircraft.surface.trailing_edges,
            &aircraft.modes,
            case.reference.semichord,
        )
    }
}

fn is_level(case: &case::Case) -> bool {
    let flight = case.flight.as_ref();
    flight.is_some_and(|flight| flight.trim == case::Trim::Level)
}

fn solver(gaf: &case::Gaf, vertices: usize) -> Solver {
    let is_hierarchical = match gaf.solver {
        SolverChoice::Auto => vertices > Solver::LARGEST_DENSE && !gaf.exact,
        SolverChoice::Dense => false,
        SolverChoice::Hierarchical => true,
    };
    if is_hierarchical {
        Solver::Hierarchical {
            tolerance: gaf.tolerance,
        }
    } else if gaf.exact {
        Solver::Double
    } else {
        Solver::Refined
    }
}

/// Hash of all that can change the numbers; names, paths and threads cannot.
pub(crate) fn key(file: &CaseFile, problem: &Problem<'_>) -> Key {
    let mesh = problem.mesh;
    let coordinates: Vec<f64> = mesh.vertices.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
    let corners: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
    let lines: Vec<u32> = problem.body_lines.iter().flatten().copied().collect();
    let direction: &[u8] = match problem.wake_direction {
        fladder_bem::WakeDirection::Freestream => b"freestream",
        fladder_bem::WakeDirection::X => b"x",
        fladder_bem::WakeDirection::Held => b"held",
    };
    let mut builder = KeyBuilder::new(MEANING)
        .numbers("vertices", coordinates.into_iter())
        .indices("triangles", corners.into_iter())
        .numbers("mach", [file.case.flow.mach].into_iter())
        .numbers(
            "incidence",
            [problem.flow.alpha, problem.flow.beta].into_iter(),
        )
        .numbers("semichord", [problem.semichord].into_iter())
        .numbers(
            "moment point",
            problem
                .moment_point
                .iter()
                .copied()
                .collect::<Vec<_>>()
                .into_iter(),
        )
        .field("wake direction", direction)
        .indices("body lines", lines.into_iter());
    // A whole model has the key it had before there were halves.
    if problem.symmetry.is_half() {
        builder = builder.field("symmetry", problem.symmetry.word().as_bytes());
    }
    match problem.solver {
        Solver::Refined => {}
        Solver::Double => builder = builder.field("factors", b"double"),
        Solver::Hierarchical { tolerance } => {
            builder = builder.numbers("hierarchical", [tolerance].into_iter());
        }
    }
    if problem.shape_change == fladder_bem::ShapeChange::Exact {
        builder = builder.field("shape change", b"exact");
    }
    for chain in problem.trailing_edges {
        builder = builder
            .indices("trailing edge", chain.vertices.iter().copied())
            .indices("upper", chain.upper.iter().copied())
            .indices("lower", chain.lower.iter().copied())
            .field("closed", &[u8::from(chain.closed)]);
    }
    for (index, mode) in problem.modes.iter().enumerate() {
        let turns = problem.turning.get(index).copied().unwrap_or(false);
        let frame: &[u8] = match mode.frame {
            fladder_mesh::Frame::Inertial => b"inertial",
            fladder_mesh::Frame::Body => b"body",
        };
        let shape: Vec<f64> = mode
            .displacement
            .iter()
            .flat_map(|u| [u.x, u.y, u.z])
            .collect();
        builder = builder
            .field("frame", frame)
            .field("turning", &[u8::from(turns)])
            .numbers("mode", shape.into_iter());
    }
    builder.finish()
}

/// Forces from the cache, if they are there.
pub(crate) fn cached(cache: &Cache, key: Key) -> Option<OwnForces> {
    let loaded = cache.load::<StoredForces>(&key);
    if let Some(warning) = loaded.warning {
        warn(warning);
    }
    loaded.value.map(|stored| OwnForces {
        key,
        origin: Origin::Cache,
        stored,
    })
}

/// Forces from the cache or computed and stored.
///
/// # Errors
/// Too little memory, a problem that cannot be solved, an interruption.
pub(crate) fn obtain(
    file: &CaseFile,
    aircraft: &Aircraft,
    cache: &Cache,
    console: &Console,
) -> Result<OwnForces, Failure> {
    let problem = problem(file, aircraft);
    let key = key(file, &problem);
    if let Some(forces) = cached(cache, key) {
        console.notes(&guarded(file, &problem, None)?);
        return Ok(forces);
    }
    let plan = fladder_bem::plan(&problem).map_err(|error| unsolved(file, &error))?;
    refuse_too_large(file, &plan)?;
    console.notes(&guarded(file, &problem, Some(&plan))?);
    let seconds = plan.core_seconds / rayon::current_num_threads() as f64;
    console.say(format!(
        "computing forces: {} unknowns, {} wake elements, about {} and {:.0} s",
        plan.sizes.unknowns,
        plan.sizes.wake_elements,
        bytes_in_words(plan.memory_bytes),
        seconds.max(1.0)
    ));
    let bar = Bar::new(console.is_quiet());
    let solution =
        fladder_bem::solve(&problem, &bar).map_err(|error| unsolved(file, &error))?;
    let effort = bar.effort();
    let stored = StoredForces {
        mach: file.case.flow.mach,
        alpha_deg: file.case.flow.alpha_deg,
        beta_deg: file.case.flow.beta_deg,
        solution,
    };
    if let Some(warning) = cache.publish(&key, &stored) {
        warn(warning);
    }
    Ok(OwnForces {
        key,
        origin: Origin::Computed(effort),
        stored,
    })
}

/// What the mesh does not resolve of the case's grid, as warnings.
///
/// # Errors
/// A motion too fast for the mesh.
pub(crate) fn guarded(
    file: &CaseFile,
    problem: &Problem<'_>,
    plan: Option<&Plan>,
) -> Result<Vec<String>, Failure> {
    let largest = grid(file)
        .iter()
        .map(|[g, k]| g.hypot(*k))
        .fold(0.0, f64::max);
    fladder_bem::guards(problem, plan, largest).map_err(|error| {
        Failure::input(
            error.to_string(),
            file.places.of("gaf.k"),
            "forces that the mesh does not resolve look like any others",
            "do what the message says, and look at the mesh with `fladder check --vtu`",
        )
    })
}

fn refuse_too_large(file: &CaseFile, plan: &Plan) -> Result<(), Failure> {
    match usable_bytes() {
        Some(usable) if plan.memory_bytes > usable => Err(Failure::input(
            format!(
                "the computation needs {}, {} can be used",
                bytes_in_words(plan.memory_bytes),
                bytes_in_words(usable)
            ),
            format!(
                "{}: {} triangles",
                file.places.of("mesh.file"),
                plan.sizes.triangles
            ),
            "the system would kill the program half-way",
            "set gaf.solver = \"hierarchical\", take a coarser mesh, or a machine with more memory",
        )),
        _ => Ok(()),
    }
}

pub(crate) fn unsolved(file: &CaseFile, error: &BemError) -> Failure {
    let place = file.places.of("mesh.file");
    match error {
        BemError::Interrupted { stage } => Failure::interrupted(stage),
        BemError::Point { .. } => Failure::input(
            error.to_string(),
            "--at",
            "the pressure has no value there",
            "give k > 0, or k = 0 with g ≥ 0",
        ),
        BemError::Singular { .. } | BemError::NotFinite { .. } => Failure::numerical(
            error.to_string(),
            place,
            "no forces can be had from this surface",
            "look at the mesh with `fladder check`; thin or touching parts are the usual cause",
        ),
        _ => Failure::input(
            error.to_string(),
            place,
            "the wake could not be laid out, so there are no forces",
            "look at the trailing edges with `fladder check`",
        ),
    }
}

/// Samples of $Q$ in parallel, in the order of the points.
///
/// # Errors
/// A point on the branch cut or at a pole.
pub(crate) fn samples(
    aircraft: &Aircraft,
    forces: &StoredForces,
    points: &[[f64; 2]],
) -> Result<Vec<Sample>, Failure> {
    let asked = aircraft.asked;
    let transfer = &forces.solution.transfer;
    points
        .par_iter()
        .map(|[g, k]| {
            let q = transfer
                .q(c64::new(*g, *k))
                .map_err(|error| not_evaluated(&error))?;
            let q = q.submatrix(0, 0, asked, asked).to_owned();
            Ok(Sample::new(*g, *k, &q))
        })
        .collect()
}

pub(crate) fn not_evaluated(error: &LaplaceError) -> Failure {
    let place = "the point asked for with --at or [gaf]";
    match error {
        LaplaceError::Singular { .. } => Failure::numerical(
            error.to_string(),
            place,
            "Q has no value there",
            "take a point beside it",
        ),
        _ => Failure::input(
            error.to_string(),
            place,
            "Q has no value there",
            "take another point",
        ),
    }
}

/// Points of the grid that are computed: those on the branch cut are not.
pub(crate) fn grid(file: &CaseFile) -> Vec<[f64; 2]> {
    let gaf = &file.case.gaf;
    let all = gaf
        .g
        .iter()
        .flat_map(|g| gaf.k.iter().map(move |k| [*g, *k]));
    all.filter(|[g, k]| *k > 0.0 || *g >= 0.0).collect()
}

/// The forces of all modes as a document of the exchange format.
pub(crate) fn document(
    aircraft: &Aircraft,
    forces: &StoredForces,
    points: Vec<Sample>,
) -> Document {
    let steady = &forces.solution.steady.generalised_forces;
    Document {
        schema: gaf_json::SCHEMA.to_owned(),
        mach: forces.mach,
        semichord: forces.solution.transfer.semichord(),
        alpha_deg: forces.alpha_deg,
        beta_deg: forces.beta_deg,
        modes: aircraft.mode_names(),
        frames: aircraft
            .asked_modes()
            .iter()
            .map(|mode| Frame::from(mode.frame))
            .collect(),
        steady: steady[..aircraft.asked].iter().copied().map(Some).collect(),
        points,
    }
}
