//! `fladder check`: all that can be said before computing.

use super::Session;
use crate::case::CaseFile;
use crate::chain::aircraft::Aircraft;
use crate::chain::memory::{bytes_in_words, usable_bytes};
use crate::chain::own_forces;
use crate::chain::surface::{Surface, Wanted, refusal};
use crate::failure::Failure;
use crate::report;
use fladder_bem::{Plan, Problem};
use fladder_mesh::Symmetry;
use fladder_mesh::judge::{Code, Fault, Severity};
use serde::Serialize;
use std::path::Path;

const SCHEMA: &str = "fladder.check/1";

/// The findings, as they are written.
#[derive(Debug, Serialize)]
struct Findings {
    schema: &'static str,
    ok: bool,
    symmetry: Symmetry,
    vertices: usize,
    triangles: usize,
    bodies: usize,
    area: f64,
    volume: f64,
    trailing_edges: Vec<Edge>,
    wake: WakeSize,
    faults: Vec<Finding>,
    estimate: Estimate,
    modes: Vec<String>,
    notes: Vec<String>,
}

#[derive(Debug, Serialize)]
struct Edge {
    edges: usize,
    length: f64,
}

#[derive(Debug, Default, Serialize)]
struct WakeSize {
    elements: usize,
}

#[derive(Debug, Serialize)]
struct Finding {
    code: &'static str,
    severity: Severity,
    message: String,
    elements: usize,
}

#[derive(Debug, Default, Serialize)]
struct Estimate {
    memory_bytes: u64,
    seconds: f64,
}

pub(crate) fn check(
    session: &Session,
    input: &Path,
    json: Option<&Path>,
) -> Result<(), Failure> {
    let is_case = input.is_dir() || input.extension().is_some_and(|e| e == "toml");
    let case = if is_case {
        Some(session.case(input)?)
    } else {
        None
    };
    let wanted = match &case {
        Some(file) if file.case.mesh.is_none() => return check_given_forces(session, file),
        Some(file) => Wanted::by(file)?,
        None if input.is_file() => Wanted::bare(input),
        None => {
            return Err(Failure::input(
                "there is no such case or mesh",
                input.display().to_string(),
                "there is nothing to check",
                "give a case file, a folder with case.toml, or a mesh file",
            ));
        }
    };
    let mut surface = Surface::read(&wanted)?;
    let mut findings = Findings::of(&surface);
    // What comes after is only looked at on a surface that can be computed.
    let later = look_further(session, case.as_ref(), &mut surface, &mut findings);
    findings.faults = surface.faults.iter().map(Finding::of).collect();
    let errors: Vec<&Fault> = surface
        .faults
        .iter()
        .filter(|fault| fault.severity == Severity::Error)
        .collect();
    findings.ok = errors.is_empty() && later.is_ok();
    if let Some(json) = json {
        session.write_json(json, &findings)?;
    }
    if errors.is_empty() {
        later.map(|()| session.console.say("no errors found"))
    } else {
        Err(refusal(&surface.file, &errors))
    }
}

/// Modes, wake and cost; prints as it goes.
fn look_further(
    session: &Session,
    case: Option<&CaseFile>,
    surface: &mut Surface,
    findings: &mut Findings,
) -> Result<(), Failure> {
    let console = &session.console;
    report::surface(console, surface);
    if surface
        .faults
        .iter()
        .any(|fault| fault.severity == Severity::Error)
    {
        return Ok(());
    }
    let plan = match case {
        Some(file) => {
            let aircraft = Aircraft::on(file, surface.clone())?;
            report::structure(console, &aircraft.structure);
            report::transfer(console, aircraft.transfer.as_ref());
            findings.modes = aircraft.mode_names();
            let problem = own_forces::problem(file, &aircraft);
            fladder_bem::plan(&problem).map_err(|error| own_forces::unsolved(file, &error))?
        }
        None => bare_plan(surface)?,
    };
    findings.wake.elements = plan.sizes.wake_elements;
    findings.estimate = Estimate {
        memory_bytes: plan.memory_bytes,
        seconds: plan.core_seconds / rayon::current_num_threads() as f64,
    };
    findings.notes.clone_from(&plan.notes);
    console.notes(&plan.notes);
    console.say(format!(
        "wake: {} elements; forces would take about {} and {:.0} s on {} threads",
        plan.sizes.wake_elements,
        bytes_in_words(plan.memory_bytes),
        findings.estimate.seconds.max(1.0),
        rayon::current_num_threads()
    ));
    surface.faults.extend(too_large(&plan));
    Ok(())
}

fn bare_plan(surface: &Surface) -> Result<Plan, Failure> {
    let (low, high) = surface.mesh.bounds().unwrap_or_default();
    let problem = Problem {
        body_lines: &surface.body_lines,
        symmetry: surface.symmetry,
        // A mesh by itself has no reference length; the wake's extent is
        // reckoned from half of the surface's length.
        ..Problem::new(
            &surface.mesh,
            &surface.trailing_edges,
            &[],
            0.5 * (high.x - low.x),
        )
    };
    fladder_bem::plan(&problem).map_err(|error| {
        Failure::input(
            error.to_string(),
            surface.file.display().to_string(),
            "the wake could not be laid out",
            "look at the trailing edges listed above",
        )
    })
}

fn too_large(plan: &Plan) -> Option<Fault> {
    let usable = usable_bytes()?;
    (plan.memory_bytes > usable).then(|| {
        Fault::new(
            Code::TooLarge,
            format!(
                "the forces need {}, {} can be used",
                bytes_in_words(plan.memory_bytes),
                bytes_in_words(usable)
            ),
            "the system would kill the program half-way",
            "take a coarser mesh, or a machine with more memory",
        )
        .against(plan.memory_bytes as f64, usable as f64)
    })
}

/// A case whose forces come from a file has no surface to look at.
fn check_given_forces(session: &Session, file: &CaseFile) -> Result<(), Failure> {
    use crate::chain::forces::Forces;
    use crate::chain::structure::StructureData;
    let structure = StructureData::read(file)?;
    report::structure(&session.console, &structure);
    let forces = Forces::given(file, &structure)?;
    session.console.notes(&forces.notes);
    session.console.say(format!(
        "forces of {} modes at {} × {} points; no errors found",
        forces.table.order(),
        forces.table.g().len(),
        forces.table.k().len()
    ));
    Ok(())
}

impl Findings {
    fn of(surface: &Surface) -> Self {
        let edge = |edge: &fladder_mesh::TrailingEdge| Edge {
            edges: edge.upper.len(),
            length: edge.length(&surface.mesh),
        };
        Self {
            schema: SCHEMA,
            ok: false,
            symmetry: surface.symmetry,
            vertices: surface.mesh.vertices.len(),
            triangles: surface.mesh.triangles.len(),
            bodies: surface.bodies,
            area: surface.area,
            volume: surface.volume,
            trailing_edges: surface.trailing_edges.iter().map(edge).collect(),
            wake: WakeSize::default(),
            faults: Vec::new(),
            estimate: Estimate::default(),
            modes: Vec::new(),
            notes: surface.notes.clone(),
        }
    }
}

impl Finding {
    fn of(fault: &Fault) -> Self {
        Self {
            code: fault.code.name(),
            severity: fault.severity,
            message: fault.message(),
            elements: fault.elements.len(),
        }
    }
}
