//! `fladder check`: all that can be said before computing.

use super::Session;
use crate::case::CaseFile;
use crate::chain::aircraft::Aircraft;
use crate::chain::own_forces;
use crate::chain::surface::{Surface, Wanted, refusal};
use crate::failure::Failure;
use crate::memory::{bytes_in_words, usable_bytes};
use crate::report::{self, EdgeEnd};
use fladder_bem::{Plan, Problem, WakeSheet};
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
    /// What it begins and ends with; left out where no wake was laid out.
    #[serde(skip_serializing_if = "Option::is_none")]
    ends: Option<[EdgeEnd; 2]>,
}

#[derive(Debug, Default, Serialize)]
struct WakeSize {
    elements: usize,
    rows: usize,
    streamlines: usize,
    lines_on_bodies: usize,
    longest_row: f64,
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
    vtu: Option<&Path>,
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
    let plan = look_further(session, case.as_ref(), &mut surface, &mut findings);
    let sheet = plan
        .as_ref()
        .ok()
        .and_then(Option::as_ref)
        .map(|plan| &plan.wake);
    if let Some(folder) = vtu {
        write_pictures(session, folder, &surface, sheet)?;
    }
    let later = plan.map(drop);
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
) -> Result<Option<Plan>, Failure> {
    let console = &session.console;
    report::surface(console, surface);
    if surface
        .faults
        .iter()
        .any(|fault| fault.severity == Severity::Error)
    {
        return Ok(None);
    }
    let plan = match case {
        Some(file) => {
            let aircraft = Aircraft::on(file, surface.clone())?;
            report::structure(console, &aircraft.structure, aircraft.transfer.as_ref());
            report::transfer(console, aircraft.transfer.as_ref());
            findings.modes = aircraft.mode_names();
            let problem = own_forces::problem(file, &aircraft);
            let mut plan = fladder_bem::plan(&problem)
                .map_err(|error| own_forces::unsolved(file, &error))?;
            plan.notes
                .extend(own_forces::guarded(file, &problem, Some(&plan))?);
            plan
        }
        None => bare_plan(surface)?,
    };
    report::wake(console, surface, &plan);
    findings.add_wake(surface, &plan);
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
    Ok(Some(plan))
}

/// What there is to be seen, faults or not.
fn write_pictures(
    session: &Session,
    folder: &Path,
    surface: &Surface,
    sheet: Option<&WakeSheet>,
) -> Result<(), Failure> {
    let files = report::pictures(surface, sheet)
        .map_err(|error| Failure::io("draw the surface", folder, &error))?;
    for (name, content) in files {
        session.write(&folder.join(name), content)?;
    }
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
    report::structure(&session.console, &structure, None);
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
            ends: None,
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

    fn add_wake(&mut self, surface: &Surface, plan: &Plan) {
        self.wake = WakeSize {
            elements: plan.sizes.wake_elements,
            rows: plan.sizes.wake_rows.saturating_sub(1),
            streamlines: plan.sizes.wake_streamlines,
            lines_on_bodies: plan.wake.junction_lines.len(),
            longest_row: plan.wake.longest_row,
        };
        let ends = report::ends(&surface.trailing_edges, &plan.wake);
        for (edge, ends) in self.trailing_edges.iter_mut().zip(ends) {
            edge.ends = Some(ends);
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
