//! The structure as the eigenproblem needs it: rigid-body properties, and
//! elastic modes of unit generalised mass in SI units and mesh axes.

use crate::edit::{EditError, Edits};
use crate::edit_setup;
use crate::error::ReadError;
use crate::format::Format;
use crate::half::{HalfError, Probe};
use crate::quality;
use crate::read::read_structure;
use crate::result::{ModalResult, Mode};
use crate::rigid::{Inertia, RigidBody, RigidBodyError};
use crate::rigid_fit::{RecoveredBody, RigidSurvey, survey_of};
use crate::units::{Axes, Units};
use fladder_mesh::{Symmetry, Vec3};
use std::f64::consts::TAU;
use std::path::PathBuf;

/// Translational participation over √mass above which an elastic mode is not
/// orthogonal to rigid motion: modes of one free body stay near 1e-3.
pub const PARTICIPATION_LIMIT: f64 = 1e-2;

/// Where a structure comes from and how it is to be taken.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StructureSettings {
    /// Result file.
    pub file: PathBuf,
    /// File with nodes, elements and sets.
    pub geometry: Option<PathBuf>,
    /// Overrides the format told from the content.
    pub format: Option<Format>,
    /// Units of the files.
    pub units: Units,
    /// Directions of the structure's axes in mesh axes.
    pub axes: Axes,
    /// The structure's origin in mesh axes, metres.
    pub origin: Vec3,
    /// The files hold half of a symmetric structure; mass properties that a
    /// file states are those of the whole all the same.
    pub half: bool,
    /// The kind of motion that is wanted of it, whole or half.
    pub symmetry: Symmetry,
    /// Whether modes of the other kind are left out; else they are refused.
    pub leave_out_other: bool,
    /// First and last elastic mode, counted from 1; all where left out.
    pub modes: Option<[usize; 2]>,
    /// Mass properties that override those of the file.
    pub rigid_body: RigidBodySettings,
    /// What is changed of it.
    pub edits: Edits,
}

/// Mass properties of the whole aircraft as far as the case gives them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidBodySettings {
    /// Mass, kg.
    pub mass: Option<f64>,
    /// Centre of mass in mesh axes, metres.
    pub cg: Option<Vec3>,
    /// Inertia about the centre of mass, kg m².
    pub inertia: Option<Inertia>,
}

/// An elastic mode of unit generalised mass.
#[derive(Clone, Debug, PartialEq)]
pub struct ElasticMode {
    /// `elastic:1` and so on, in order of frequency.
    pub name: String,
    /// Number in the file.
    pub index: u32,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Circular frequency, rad/s; its square is the generalised stiffness.
    pub omega: f64,
    /// Generalised mass before normalisation, kg: that in the file, twice that
    /// of a half model.
    pub generalised_mass: f64,
    /// Generalised stiffness before normalisation.
    pub generalised_stiffness: f64,
    /// Displacement a node, m per √kg m.
    pub shape: Vec<Vec3>,
    /// Rotation a node, rad per √kg m, where the file has them.
    pub rotation: Option<Vec<Vec3>>,
    /// Largest participation of a rigid translation, relative to √mass; zero
    /// for a mode orthogonal to rigid motion. `None` where the file is silent.
    pub participation: Option<f64>,
}

/// A structure ready for transfer and for the eigenproblem.
#[derive(Clone, Debug, PartialEq)]
pub struct StructuralModel {
    /// Mass properties used: given values, the rest from the file. `None`
    /// where neither has any.
    pub rigid_body: Option<RigidBody>,
    /// Mass properties recovered from the file's own six rigid modes.
    pub rigid_body_from_file: Option<RecoveredBody>,
    /// Elastic modes, by ascending frequency.
    pub elastic: Vec<ElasticMode>,
    /// The kind of motion they are.
    pub symmetry: Symmetry,
    /// The result in SI units and mesh axes; for a half surface without the
    /// elements on y < 0.
    pub result: ModalResult,
    /// Which of its modes are rigid.
    pub survey: RigidSurvey,
    /// What was repaired, ignored, assumed or looks odd.
    pub notes: Vec<String>,
}

/// A structure that cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StructureError {
    /// The files.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The mass properties.
    #[error(transparent)]
    RigidBody(#[from] RigidBodyError),
    /// A half model that is none, or modes of the other kind.
    #[error(transparent)]
    Half(#[from] HalfError),
    /// Changes that cannot be made.
    #[error(transparent)]
    Edit(#[from] EditError),
    /// A choice of modes the file does not hold.
    #[error(
        "structure.modes = [{first}, {last}] where the file holds the elastic modes 1 to {count}"
    )]
    ModeRange {
        /// First mode asked for.
        first: usize,
        /// Last mode asked for.
        last: usize,
        /// Elastic modes in the file.
        count: usize,
    },
}

/// Reads a structure and brings it into SI units, mesh axes and unit
/// generalised masses; the file's rigid modes are recognised and removed.
///
/// # Errors
/// [`StructureError`] for unreadable files, impossible mass properties and
/// modes that are not there.
pub fn load(settings: &StructureSettings) -> Result<StructuralModel, StructureError> {
    let read = read_structure(
        &settings.file,
        settings.geometry.as_deref(),
        settings.format,
    )?;
    let read = if settings.half { read.doubled() } else { read };
    let mut result = read.to_si_mesh_axes(settings.units, &settings.axes, &settings.origin);
    let is_half = settings.half || settings.symmetry.is_half();
    let probe = is_half
        .then(|| Probe::new(&result, settings.half))
        .transpose()?;
    let survey = if settings.half {
        survey_of(&result, half_kind(settings.symmetry))
    } else {
        survey_of(&result, Symmetry::None)
    };
    let mut notes = result.notes.clone();
    notes.extend(survey.notes.iter().cloned());
    notes.extend(survey.recovered.as_ref().and_then(asymmetry));
    notes.extend(quality::remarks(&result, &survey));
    let mut rigid_body = rigid_body(&settings.rigid_body, &result, &survey, &mut notes)?;
    participations(&mut result, settings);
    let mut elastic = elastic_modes(&result, &survey, rigid_body.as_ref());
    if !settings.edits.keeps_shapes() {
        let structure = edit_setup::Structure {
            result: &result,
            survey: &survey,
            settings,
        };
        (elastic, rigid_body) = structure.edited(&elastic, rigid_body, &mut notes)?;
    }
    edit_setup::override_frequencies(&mut elastic, &settings.edits.frequencies, &mut notes)?;
    let mut elastic = subset(elastic, settings.modes)?;
    if let Some(probe) = probe.filter(|_| settings.symmetry.is_half()) {
        let (wanted, leave_out) = (settings.symmetry, settings.leave_out_other);
        elastic = probe.select(elastic, wanted, leave_out, &mut notes)?;
    }
    notes.extend(elastic.iter().filter_map(oddity));
    if settings.symmetry.is_half() && !settings.half {
        result = result.starboard_elements();
    }
    let rigid_body_from_file = survey.recovered;
    Ok(StructuralModel {
        rigid_body,
        rigid_body_from_file,
        elastic,
        symmetry: settings.symmetry,
        result,
        survey,
        notes,
    })
}

/// Of a half structure by itself, without a surface, symmetric motion is
/// assumed where it matters: for what three rigid modes mean.
fn half_kind(symmetry: Symmetry) -> Symmetry {
    if symmetry.is_half() {
        symmetry
    } else {
        Symmetry::Symmetric
    }
}

/// Participation factors of the whole: those of the mirror image add to what
/// the half has along the plane in symmetric motion, across it in antisymmetric
/// motion, and cancel the rest.
fn participations(result: &mut ModalResult, settings: &StructureSettings) {
    if !settings.half {
        return;
    }
    for mode in &mut result.modes {
        let doubled = mode
            .participation
            .map(|p| 2.0 * settings.symmetry.in_plane(p));
        mode.participation = doubled.filter(|_| settings.symmetry.is_half());
    }
}

fn rigid_body(
    given: &RigidBodySettings,
    result: &ModalResult,
    survey: &RigidSurvey,
    notes: &mut Vec<String>,
) -> Result<Option<RigidBody>, RigidBodyError> {
    let recovered = survey.recovered.map(|recovered| recovered.body);
    if let (Some(_), Some(_)) = (result.stated_mass, recovered) {
        notes.push(
            "the file states mass properties: they are used, not those of its rigid modes"
                .to_owned(),
        );
    }
    let from_file = result.stated_mass.or(recovered);
    let nothing_given = given.mass.is_none() && given.cg.is_none() && given.inertia.is_none();
    if nothing_given && from_file.is_none() {
        return Ok(None);
    }
    let missing = |name| RigidBodyError::Missing {
        name,
        rigid: survey.rigid_count(),
    };
    let body = RigidBody {
        mass: given
            .mass
            .or(from_file.map(|b| b.mass))
            .ok_or_else(|| missing("mass"))?,
        cg: given
            .cg
            .or(from_file.map(|b| b.cg))
            .ok_or_else(|| missing("cg"))?,
        inertia: given
            .inertia
            .or(from_file.map(|b| b.inertia))
            .ok_or_else(|| missing("inertia"))?,
    };
    body.check()?;
    Ok(Some(body))
}

/// Products of inertia across y = 0 above this share of the moment about z are
/// named: the rigid modes have no place for them.
const ASYMMETRY_LIMIT: f64 = 1e-3;

fn asymmetry(recovered: &RecoveredBody) -> Option<String> {
    let [xy, yz] = recovered.asymmetry;
    let limit = ASYMMETRY_LIMIT * recovered.body.inertia.zz;
    (xy.abs().max(yz.abs()) > limit).then(|| {
        format!(
            "the mass is not symmetric about y = 0: ∫ x y dm = {xy:.3e} and ∫ y z dm = {yz:.3e} \
             kg m² are left out"
        )
    })
}

fn elastic_modes(
    result: &ModalResult,
    survey: &RigidSurvey,
    body: Option<&RigidBody>,
) -> Vec<ElasticMode> {
    let mut modes: Vec<&Mode> = result
        .modes
        .iter()
        .zip(&survey.fits)
        .filter(|(_, fit)| !fit.rigid)
        .map(|(mode, _)| mode)
        .collect();
    modes.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    modes
        .iter()
        .enumerate()
        .map(|(k, mode)| normalised(mode, k + 1, body.map(|body| body.mass)))
        .collect()
}

fn normalised(mode: &Mode, number: usize, mass: Option<f64>) -> ElasticMode {
    let scale = 1.0 / mode.generalised_mass.sqrt();
    let participation = mode.participation.zip(mass);
    let scaled = |values: &[Vec3]| values.iter().map(|u| u * scale).collect();
    ElasticMode {
        name: format!("elastic:{number}"),
        index: mode.index,
        frequency_hz: mode.frequency_hz,
        omega: TAU * mode.frequency_hz,
        generalised_mass: mode.generalised_mass,
        generalised_stiffness: mode.generalised_stiffness,
        shape: scaled(&mode.displacement),
        rotation: mode.rotation.as_deref().map(scaled),
        participation: participation
            .map(|(factors, mass)| factors.amax() * scale / mass.sqrt()),
    }
}

fn oddity(mode: &ElasticMode) -> Option<String> {
    let ElasticMode { name, index, .. } = mode;
    if mode.frequency_hz == 0.0 {
        return Some(format!(
            "{name} (mode {index}) has no stiffness and is no rigid motion: a mechanism"
        ));
    }
    let participation = mode
        .participation
        .filter(|value| *value > PARTICIPATION_LIMIT)?;
    Some(format!(
        "{name} (mode {index}) is not orthogonal to rigid motion: participation {participation:.1e} \
         of √mass (limit {PARTICIPATION_LIMIT:e})"
    ))
}

fn subset(
    elastic: Vec<ElasticMode>,
    modes: Option<[usize; 2]>,
) -> Result<Vec<ElasticMode>, StructureError> {
    let Some([first, last]) = modes else {
        return Ok(elastic);
    };
    let count = elastic.len();
    if first == 0 || last < first || last > count {
        return Err(StructureError::ModeRange { first, last, count });
    }
    Ok(elastic
        .into_iter()
        .skip(first - 1)
        .take(last + 1 - first)
        .collect())
}
