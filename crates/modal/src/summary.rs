//! What a result file holds, for people and for scripts.

use crate::error::ReadError;
use crate::format::Format;
use crate::read::read_structure;
use crate::rigid::Inertia;
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
    /// Modes in the order of the file.
    pub modes: Vec<ModeSummary>,
    /// Mass stated in the file or recovered from its rigid modes.
    pub mass: Option<f64>,
    /// Centre of mass.
    pub cg: Option<Vec3>,
    /// Inertia about the centre of mass.
    pub inertia: Option<Inertia>,
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
    /// The shape is a rigid motion.
    pub rigid: bool,
    /// Share of the shape that no rigid motion explains.
    pub rigid_residual: f64,
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
    let result = read_structure(file, geometry, format)?;
    let survey = survey(&result);
    let body = result
        .stated_mass
        .or(survey.recovered.map(|recovered| recovered.body));
    let modes = result
        .modes
        .iter()
        .zip(&survey.fits)
        .map(|(mode, fit)| ModeSummary {
            index: mode.index,
            frequency_hz: mode.frequency_hz,
            generalised_mass: mode.generalised_mass,
            rigid: fit.rigid,
            rigid_residual: fit.residual,
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
    Ok(ModesSummary {
        schema: "fladder.modes/1",
        format: result.format.name(),
        nodes: result.nodes.len(),
        elements: result.elements.len(),
        element_sets,
        modes,
        mass: body.map(|body| body.mass),
        cg: body.map(|body| body.cg),
        inertia: body.map(|body| body.inertia),
        notes: result.notes.into_iter().chain(survey.notes).collect(),
    })
}
