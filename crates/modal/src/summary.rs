//! What a result file holds, for people and for scripts.

use crate::error::ReadError;
use crate::format::Format;
use crate::quality;
use crate::read::read_structure;
use crate::result::{ModalResult, Mode};
use crate::rigid::{Inertia, RigidBody};
use crate::rigid_fit::survey;
use fladder_mesh::Vec3;
use serde::Serialize;
use std::path::Path;

/// Contents of a result file in its own units and axes; serialises to schema
/// `fladder.modes/1`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModesSummary {
    /// `fladder.modes/1`.
    pub schema: &'static str,
    /// Name of the format.
    pub format: &'static str,
    /// Nodes that carry displacements.
    pub nodes: usize,
    /// Elements between them.
    pub elements: usize,
    /// Names of element sets and their sizes.
    pub element_sets: Vec<SetSummary>,
    /// The modes have rotations.
    pub rotations: bool,
    /// Modes in the order of the file.
    pub modes: Vec<ModeSummary>,
    /// Mass stated in the file or recovered from its rigid modes.
    pub mass: Option<f64>,
    /// Centre of mass.
    pub cg: Option<Vec3>,
    /// Inertia about the centre of mass.
    pub inertia: Option<Inertia>,
    /// Mass properties that the file states.
    pub stated: Option<RigidBody>,
    /// Mass properties recovered from its rigid modes.
    pub recovered: Option<RigidBody>,
    /// What was repaired, ignored or looks odd.
    pub notes: Vec<String>,
}

/// One named set.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SetSummary {
    /// Name in the file.
    pub name: String,
    /// Number of members.
    pub members: usize,
}

/// One mode.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModeSummary {
    /// Number in the file.
    pub index: u32,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Generalised mass as in the file.
    pub generalised_mass: f64,
    /// Generalised stiffness as in the file, or from the eigenvalue.
    pub generalised_stiffness: f64,
    /// The shape is a rigid motion.
    pub rigid: bool,
    /// Share of the shape that no rigid motion explains.
    pub rigid_residual: f64,
    /// Largest participation of a rigid translation over √(mass · generalised
    /// mass): zero for an elastic mode orthogonal to rigid motion. `None` where
    /// participation factors or the mass are not known.
    pub rigid_participation: Option<f64>,
}

/// Reads a file and sums up what it holds.
///
/// # Errors
/// Those of [`read_structure`].
pub fn modes_summary(
    file: &Path,
    geometry: Option<&Path>,
    format: Option<Format>,
) -> Result<ModesSummary, ReadError> {
    Ok(summary_of(&read_structure(file, geometry, format)?))
}

/// Sums up what a result holds.
pub fn summary_of(result: &ModalResult) -> ModesSummary {
    let survey = survey(result);
    let recovered = survey.recovered.map(|recovered| recovered.body);
    let body = result.stated_mass.or(recovered);
    let remarks = quality::remarks(result, &survey);
    let participation = |mode: &Mode| {
        let scale = (body?.mass * mode.generalised_mass).sqrt();
        Some(mode.participation?.amax() / scale)
    };
    let modes = result
        .modes
        .iter()
        .zip(&survey.fits)
        .map(|(mode, fit)| ModeSummary {
            index: mode.index,
            frequency_hz: mode.frequency_hz,
            generalised_mass: mode.generalised_mass,
            generalised_stiffness: mode.generalised_stiffness,
            rigid: fit.rigid,
            rigid_residual: fit.residual,
            rigid_participation: participation(mode),
        })
        .collect();
    let element_sets = result
        .element_sets
        .iter()
        .map(|set| SetSummary {
            name: set.name.clone(),
            members: set.members.len(),
        })
        .collect();
    ModesSummary {
        schema: "fladder.modes/1",
        format: result.format.name(),
        nodes: result.nodes.len(),
        elements: result.elements.len(),
        element_sets,
        rotations: result.modes.iter().all(|mode| mode.rotation.is_some()),
        modes,
        mass: body.map(|body| body.mass),
        cg: body.map(|body| body.cg),
        inertia: body.map(|body| body.inertia),
        stated: result.stated_mass,
        recovered,
        notes: [result.notes.clone(), survey.notes, remarks].concat(),
    }
}
