//! The wetted surface: read, judged, with the edges its wake leaves from.

use crate::case::{CaseFile, TrailingEdges, Wake, WakeMode};
use crate::failure::Failure;
use fladder_mesh::judge::{self, Code, Fault, Severity};
use fladder_mesh::read::{self, ReadError};
use fladder_mesh::{Symmetry, Topology, TrailingEdge, TriMesh, trailing_edge};
use std::path::{Path, PathBuf};

/// What is asked of a surface.
#[derive(Clone, Debug)]
pub(crate) struct Wanted {
    pub(crate) file: PathBuf,
    pub(crate) scale: f64,
    pub(crate) symmetry: Symmetry,
    pub(crate) trailing_edges: TrailingEdges,
    pub(crate) wake: Wake,
    /// Where groups are named, for messages.
    pub(crate) groups_place: String,
    /// Where body lines are named, for messages.
    pub(crate) lines_place: String,
}

impl Wanted {
    /// As the case says.
    ///
    /// # Errors
    /// No mesh, or no such file.
    pub(crate) fn by(file: &CaseFile) -> Result<Self, Failure> {
        let Some(mesh) = &file.case.mesh else {
            return Err(Failure::input(
                "the case has no [mesh]",
                file.places.of("mesh"),
                "aerodynamic forces are computed on a wetted surface",
                "add [mesh] with file = \"…\"; with gaf.file only `sweep` and `run` make sense",
            ));
        };
        Ok(Self {
            file: file.existing("mesh.file", &mesh.file)?,
            scale: mesh.scale,
            symmetry: mesh.symmetry,
            trailing_edges: mesh.trailing_edge.clone(),
            wake: file.case.wake.clone(),
            groups_place: file.places.of("mesh.trailing_edge.groups"),
            lines_place: file.places.of("wake.body_lines"),
        })
    }

    /// A mesh file by itself, with the defaults of a case.
    pub(crate) fn bare(file: &Path) -> Self {
        let place = file.display().to_string();
        Self {
            file: file.to_owned(),
            scale: 1.0,
            symmetry: Symmetry::None,
            trailing_edges: TrailingEdges::default(),
            wake: Wake::default(),
            groups_place: place.clone(),
            lines_place: place,
        }
    }
}

/// A judged surface.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    pub(crate) file: PathBuf,
    pub(crate) mesh: TriMesh,
    /// Whether the mesh is a half, and of which motion.
    pub(crate) symmetry: Symmetry,
    pub(crate) faults: Vec<Fault>,
    /// Bodies, area in m² and volume in m³ of the whole aircraft.
    pub(crate) bodies: usize,
    /// Number of each triangle's body, from 1.
    pub(crate) body_of_triangle: Vec<i32>,
    pub(crate) area: f64,
    pub(crate) volume: f64,
    /// Where the wake leaves; empty without one.
    pub(crate) trailing_edges: Vec<TrailingEdge>,
    pub(crate) body_lines: Vec<[u32; 2]>,
    pub(crate) notes: Vec<String>,
}

impl Surface {
    /// Reads and judges; faults are collected, not raised.
    ///
    /// # Errors
    /// A file that cannot be read, groups that are not there.
    pub(crate) fn read(wanted: &Wanted) -> Result<Self, Failure> {
        let loaded = read::load(&wanted.file, wanted.scale)
            .map_err(|error| unreadable(&wanted.file, &error))?;
        let settings = judge::Settings {
            symmetry_plane: wanted.symmetry.is_half(),
            ..judge::Settings::default()
        };
        let judgement = judge::judge(loaded.mesh, settings);
        let mut notes = loaded.notes;
        let mut faults = judgement.faults;
        let mesh = judgement.mesh;
        let count = mesh.triangles.len();
        let has_errors = faults.iter().any(|fault| fault.severity == Severity::Error);
        let (mut trailing_edges, mut body_lines) = (Vec::new(), Vec::new());
        if !has_errors && wanted.wake.mode != WakeMode::None {
            trailing_edges = find_trailing_edges(&mesh, wanted, &mut faults, &mut notes)?;
            body_lines = named_lines(&mesh, wanted)?;
        }
        Ok(Self {
            file: wanted.file.clone(),
            mesh,
            symmetry: wanted.symmetry,
            faults,
            bodies: judgement.whole_bodies,
            body_of_triangle: numbered(count, &judgement.bodies),
            area: judgement.area,
            volume: judgement.volume,
            trailing_edges,
            body_lines,
            notes,
        })
    }

    /// Refuses a surface with a fault that makes a computation meaningless.
    ///
    /// # Errors
    /// All such faults in one message.
    pub(crate) fn without_errors(self) -> Result<Self, Failure> {
        let errors: Vec<&Fault> = self
            .faults
            .iter()
            .filter(|fault| fault.severity == Severity::Error)
            .collect();
        if errors.is_empty() {
            return Ok(self);
        }
        Err(refusal(&self.file, &errors))
    }
}

/// Number of the body of each of `count` triangles, from 1.
fn numbered(count: usize, bodies: &[judge::Body]) -> Vec<i32> {
    let mut numbers = vec![0; count];
    for (number, body) in (1..).zip(bodies) {
        for &t in &body.triangles {
            // A surface with errors may lack triangles of the file.
            if let Some(place) = numbers.get_mut(t as usize) {
                *place = number;
            }
        }
    }
    numbers
}

/// The faults as one message.
pub(crate) fn refusal(file: &Path, errors: &[&Fault]) -> Failure {
    let join = |part: &dyn Fn(&Fault) -> String| {
        let mut lines: Vec<String> = errors.iter().map(|fault| part(fault)).collect();
        lines.dedup();
        lines.join("\n")
    };
    let places = |fault: &Fault| {
        let more = fault.elements.len().saturating_sub(fault.places.len());
        let more = if more > 0 {
            format!(" and {more} more")
        } else {
            String::new()
        };
        format!("{}{more}", fault.places.join(", "))
    };
    let place = join(&|fault| format!("{}: {}", file.display(), places(fault)));
    Failure::input(
        join(&|fault| fault.what.clone()),
        place.replace(": \n", "\n").trim_end_matches(": "),
        join(&|fault| fault.why.to_owned()),
        join(&|fault| fault.remedy.to_owned()),
    )
}

fn unreadable(file: &Path, error: &ReadError) -> Failure {
    let (place, what, remedy) = match error {
        ReadError::Malformed {
            path,
            place,
            what,
            remedy,
        } => (
            format!("{}, {place}", path.display()),
            what.clone(),
            remedy.clone(),
        ),
        other => (
            file.display().to_string(),
            other.to_string(),
            "check the file and your right to read it".to_owned(),
        ),
    };
    Failure::input(
        what,
        place,
        "without a whole surface nothing can be computed",
        remedy,
    )
}

fn find_trailing_edges(
    mesh: &TriMesh,
    wanted: &Wanted,
    faults: &mut Vec<Fault>,
    notes: &mut Vec<String>,
) -> Result<Vec<TrailingEdge>, Failure> {
    let topology = Topology::new(mesh);
    let settings = trailing_edge::Settings {
        max_wedge_deg: wanted.trailing_edges.max_wedge_deg,
        min_downstream: wanted.trailing_edges.min_downstream,
    };
    let wrong = |error: trailing_edge::TrailingEdgeError| {
        unknown_groups(&error.to_string(), &wanted.groups_place)
    };
    let found = match &wanted.trailing_edges.groups {
        Some(groups) if wanted.symmetry.is_half() => {
            trailing_edge::find_from_groups_of_half(mesh, &topology, groups).map_err(wrong)?
        }
        Some(groups) => {
            trailing_edge::find_from_groups(mesh, &topology, groups).map_err(wrong)?
        }
        None => trailing_edge::find_by_shape(mesh, &topology, settings),
    };
    let in_plane = match &wanted.trailing_edges.groups {
        _ if !wanted.symmetry.is_half() => Vec::new(),
        Some(groups) => trailing_edge::in_plane_from_groups(mesh, &topology, groups),
        None => trailing_edge::in_plane_by_shape(mesh, &topology, settings),
    };
    if !in_plane.is_empty() && wanted.symmetry == Symmetry::Antisymmetric {
        faults.push(judge::plane_trailing_edge(mesh, &in_plane));
    } else if !in_plane.is_empty() {
        notes.push(format!(
            "{} trailing edges in the symmetry plane carry no wake: symmetric motion makes no jump \
             there",
            in_plane.len()
        ));
    }
    if found.is_empty() {
        let severity = match wanted.wake.mode {
            WakeMode::Required => Severity::Error,
            _ => Code::NoTrailingEdge.severity(),
        };
        faults.push(judge::no_trailing_edge(mesh, &topology, settings, severity));
    }
    Ok(found)
}

fn unknown_groups(what: &str, place: &str) -> Failure {
    Failure::input(
        what,
        place,
        "the wake would leave from another place, or from none",
        "correct the name, or leave the key out to have the edges found from the shape",
    )
}

fn named_lines(mesh: &TriMesh, wanted: &Wanted) -> Result<Vec<[u32; 2]>, Failure> {
    let mut edges = Vec::new();
    for name in &wanted.wake.body_lines {
        let Some(group) = mesh.curve(name) else {
            let there: Vec<&str> = mesh
                .curves
                .iter()
                .map(|group| group.name.as_str())
                .collect();
            let what = format!("the mesh has no curve group `{name}`; it has {there:?}");
            return Err(unknown_groups(&what, &wanted.lines_place));
        };
        edges.extend_from_slice(&group.edges);
    }
    Ok(edges)
}
