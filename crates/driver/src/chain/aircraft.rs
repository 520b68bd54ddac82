//! Everything the aerodynamics need: the surface and all modes on it.

use super::control;
use super::derivatives::Scales;
use super::structure::StructureData;
use super::structure_edits;
use super::surface::{Surface, Wanted};
use crate::case::{self, CaseFile, Term};
use crate::failure::Failure;
use fladder_mesh::{SurfaceMode, Symmetry, Vec3};
use fladder_modal::{
    self as modal, Component, Motion, PolynomialTerm, RigidBody, TransferReport,
};

/// Surface, structure, and the modes in order: rigid, elastic, analytic.
#[derive(Clone, Debug)]
pub(crate) struct Aircraft {
    pub(crate) surface: Surface,
    pub(crate) structure: StructureData,
    pub(crate) modes: Vec<SurfaceMode>,
    /// Modes in whose columns the steady pressure turns with the surface: the elastic ones.
    pub(crate) turning: Vec<bool>,
    /// How many of them the case asks for; behind them stand six unit rigid
    /// modes where derivatives are wanted and there is no rigid body.
    pub(crate) asked: usize,
    /// How the elastic modes came to the surface.
    pub(crate) transfer: Option<TransferReport>,
}

impl Aircraft {
    /// Reads and assembles; a surface with errors is refused.
    ///
    /// # Errors
    /// All that can be wrong with files, meshes, modes and names.
    pub(crate) fn read(file: &CaseFile) -> Result<Self, Failure> {
        let surface = Surface::read(&Wanted::by(file)?)?.without_errors()?;
        Self::on(file, surface)
    }

    /// The modes on a surface that has been judged.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub(crate) fn on(file: &CaseFile, surface: Surface) -> Result<Self, Failure> {
        let structure = StructureData::read(file)?;
        let vertices = &surface.mesh.vertices;
        let mut modes: Vec<SurfaceMode> = Vec::new();
        let symmetry = surface.symmetry;
        if let Some(body) = &structure.body {
            centred(file, body, &surface)?;
            modes.extend(rigid_modes(body, &surface));
        }
        let mut report = None;
        let rigid = modes.len();
        let turns = file
            .case
            .structure
            .as_ref()
            .is_none_or(|given| given.pressure_turning);
        if let Some(model) = &structure.model {
            let settings = structure_edits::transfer_settings(file.case.structure.as_ref());
            let (elastic, transferred) = modal::transfer(model, &surface.mesh, &settings)
                .map_err(|error| not_transferred(file, &error))?;
            structure_edits::within_limit(file, model, &transferred)?;
            modes.extend(elastic);
            report = Some(transferred);
        }
        let elastic = rigid..modes.len();
        for (place, mode) in &file.case.modes.formulae() {
            let formula = analytic(mode);
            if mode.group.is_none() {
                of_kind(file, &formula, symmetry, place)?;
            }
            let mut shape = formula.on(vertices).map_err(|error| {
                Failure::input(
                    error.to_string(),
                    file.places.of(place),
                    "its row and column of Q would be undefined",
                    "correct the shape of the mode",
                )
            })?;
            if let Some(groups) = &mode.group {
                control::restrict(&mut shape, &surface.mesh, groups.as_slice()).map_err(
                    |what| {
                        Failure::input(
                            what,
                            file.places.of(&format!("{place}.group")),
                            "the mode would move another part of the surface, or none",
                            "`fladder check` lists the groups of the mesh",
                        )
                    },
                )?;
            }
            within_plane(file, &shape, &surface, place)?;
            modes.push(shape);
        }
        if modes.is_empty() {
            return Err(Failure::input(
                "the case has no modes",
                file.places.of("modes"),
                "generalised forces are those of modes",
                "add [structure] with a result file or mass properties, or [[modes.analytic]]",
            ));
        }
        let turning = (0..modes.len())
            .map(|mode| turns && elastic.contains(&mode))
            .collect();
        let asked = modes.len();
        if structure.body.is_none() && Scales::of(&file.case.reference).is_some() {
            let about = Vec3::from(file.case.reference.moment_point);
            modes.extend(rigid_modes(&RigidBody::unit(about), &surface));
        }
        Ok(Self {
            surface,
            structure,
            modes,
            turning,
            asked,
            transfer: report,
        })
    }

    /// The modes the case asks for, in order.
    pub(crate) fn asked_modes(&self) -> &[SurfaceMode] {
        &self.modes[..self.asked]
    }

    /// Names of the modes the case asks for, in order.
    pub(crate) fn mode_names(&self) -> Vec<String> {
        let modes = self.asked_modes().iter();
        modes.map(|mode| mode.name.clone()).collect()
    }

    /// Number of modes that take part in sweeps: analytic modes do so only
    /// where their mass and stiffness are given.
    pub(crate) fn swept_modes(&self, file: &CaseFile) -> usize {
        let has_matrices = file
            .case
            .structure
            .as_ref()
            .is_some_and(|given| given.matrices.is_some());
        let analytic = if has_matrices {
            0
        } else {
            file.case.modes.analytic.len() + file.case.modes.control.len()
        };
        self.asked - analytic
    }
}

/// The rigid modes that the surface carries: all six, or three of a half.
fn rigid_modes(body: &RigidBody, surface: &Surface) -> impl Iterator<Item = SurfaceMode> {
    let symmetry = surface.symmetry;
    modal::rigid_modes(body, &surface.mesh.vertices)
        .into_iter()
        .zip(modal::RIGID_KINDS)
        .filter(move |(_, kind)| symmetry.carries(*kind))
        .map(|(mode, _)| mode)
}

/// Rigid modes of a half model turn about a point of its plane.
fn centred(file: &CaseFile, body: &modal::RigidBody, surface: &Surface) -> Result<(), Failure> {
    let (low, high) = surface.mesh.bounds().unwrap_or_default();
    let limit = CENTRE_TOLERANCE * (high - low).norm();
    if !surface.symmetry.is_half() || body.cg.y.abs() <= limit {
        return Ok(());
    }
    Err(Failure::input(
        format!(
            "the centre of mass is at y = {} m with a half model, which may be {limit:.1e} m off \
             the plane y = 0",
            body.cg.y
        ),
        file.places.of("structure.rigid_body"),
        "mass properties are those of the whole aircraft, symmetric about its plane",
        "give cg with y = 0, and mass and inertia of both halves together",
    ))
}

/// Distance of a centre of mass from the plane, relative to the size of the
/// half, that is taken for rounding.
const CENTRE_TOLERANCE: f64 = 1e-6;

/// Refuses a mode that a half model cannot carry.
fn of_kind(
    file: &CaseFile,
    mode: &modal::AnalyticMode,
    symmetry: Symmetry,
    place: &str,
) -> Result<(), Failure> {
    let kind = mode.symmetry();
    if symmetry.carries(kind) {
        return Ok(());
    }
    Err(Failure::input(
        format!(
            "mode `{}` is {}, the half model carries {} motion",
            mode.name,
            kind.word(),
            symmetry.word()
        ),
        file.places.of(place),
        "the mirror image of the half would move in another way than the mode says",
        "remove the mode, or compute it on the half of its own symmetry or on the whole aircraft \
         (mesh.symmetry)",
    ))
}

/// Refuses a control of a half model that leaves the plane where its image meets
/// it; elsewhere the image moves as the kind of motion says.
fn within_plane(
    file: &CaseFile,
    mode: &SurfaceMode,
    surface: &Surface,
    place: &str,
) -> Result<(), Failure> {
    let largest = mode.displacement.iter().map(Vec3::norm).fold(0.0, f64::max);
    let leaves = |(u, vertex): (&Vec3, &Vec3)| {
        let kept = surface.symmetry.in_plane(*u);
        vertex.y == 0.0 && (u - kept).norm() > CENTRE_TOLERANCE * largest
    };
    let mut moved = mode.displacement.iter().zip(&surface.mesh.vertices);
    if !moved.any(leaves) {
        return Ok(());
    }
    Err(Failure::input(
        format!(
            "mode `{}` moves the symmetry plane as {} motion cannot",
            mode.name,
            surface.symmetry.word()
        ),
        file.places.of(place),
        "the half and its mirror image would part there",
        "name groups that do not reach the plane, or compute the mode on the other half model",
    ))
}

fn not_transferred(file: &CaseFile, error: &modal::TransferError) -> Failure {
    Failure::input(
        error.to_string(),
        file.places.of("structure"),
        "the surface would not move as the structure does",
        "check units, axes, origin and components of [structure], and mesh.scale",
    )
}

fn analytic(mode: &case::AnalyticMode) -> modal::AnalyticMode {
    let motion = match (&mode.translation, &mode.rotation) {
        (Some(translation), _) => Motion::Translation(Vec3::from(*translation)),
        (None, Some(rotation)) => Motion::Rotation {
            axis: Vec3::from(rotation.axis),
            point: Vec3::from(rotation.point),
        },
        (None, None) => Motion::Polynomial(
            mode.polynomial
                .iter()
                .flatten()
                .map(polynomial_term)
                .collect(),
        ),
    };
    modal::AnalyticMode {
        name: mode.name.clone(),
        motion,
    }
}

fn polynomial_term(term: &Term) -> PolynomialTerm {
    PolynomialTerm {
        component: match term.component {
            case::Axis::X => Component::X,
            case::Axis::Y => Component::Y,
            case::Axis::Z => Component::Z,
        },
        coefficient: term.coefficient,
        powers: term.powers,
        odd_y: term.odd_y,
    }
}
