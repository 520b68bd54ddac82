//! Forces as a sweep needs them: of the swept modes, rigid ones in body axes.

use super::aircraft::Aircraft;
use super::own_forces::{self, OwnForces};
use super::structure::{StructureData, stability_body};
use crate::case::CaseFile;
use crate::failure::Failure;
use crate::gaf_json::{self, Document, Frame, Given};
use faer::{Mat, c64};
use fladder_bem::TransferModel;
use fladder_stability::{self as stability, GafPoint, GafTable};
use std::path::PathBuf;

/// Samples of $Q$ with all that belongs to them.
#[derive(Debug)]
pub(crate) struct Forces {
    /// Samples of the swept modes.
    pub(crate) table: GafTable,
    /// Incidence and sideslip they hold for, rad.
    pub(crate) alpha: f64,
    pub(crate) beta: f64,
    /// Where $Q$ can be evaluated anywhere, if it can.
    pub(crate) transfer: Option<TransferModel>,
    /// Sentences for the user.
    pub(crate) notes: Vec<String>,
}

impl Forces {
    /// From what was computed here, on the grid of the case.
    ///
    /// # Errors
    /// A grid that is none.
    pub(crate) fn own(
        file: &CaseFile,
        aircraft: &Aircraft,
        forces: &OwnForces,
        document: &Document,
    ) -> Result<Self, Failure> {
        let order = aircraft.swept_modes(file);
        let entry =
            |q: &Vec<Vec<[f64; 2]>>, i: usize, j: usize| c64::new(q[i][j][0], q[i][j][1]);
        let points = document
            .points
            .iter()
            .map(|sample| GafPoint {
                g: sample.g,
                k: sample.k,
                q: Mat::from_fn(order, order, |i, j| entry(&sample.q, i, j)),
            })
            .collect();
        let table = GafTable::new(
            document.semichord,
            document.mach,
            document.modes[..order].to_vec(),
            points,
            document.steady[..order].to_vec(),
        )
        .map_err(|error| {
            Failure::input(
                error.to_string(),
                file.places.of("gaf"),
                "roots are found from forces on a grid that contains the imaginary axis",
                "correct k and g of [gaf]",
            )
        })?;
        let made = Self {
            alpha: document.alpha_deg.to_radians(),
            beta: document.beta_deg.to_radians(),
            transfer: Some(forces.stored.solution.transfer.clone()),
            notes: Vec::new(),
            table,
        };
        let frames: Vec<Frame> = document.frames[..order].to_vec();
        made.in_body_frame(file, &aircraft.structure, &frames)
    }

    /// From the file that the case names.
    ///
    /// # Errors
    /// Unreadable files, and forces that do not fit the case.
    pub(crate) fn given(file: &CaseFile, structure: &StructureData) -> Result<Self, Failure> {
        let (path, given) = chosen(file)?;
        let place = path.display().to_string();
        fits(file, &given, &place)?;
        let names = structure
            .clone()
            .with_rigid_modes_of(given.table.modes())
            .mode_names();
        let has_matrices = file
            .case
            .structure
            .as_ref()
            .is_some_and(|given| given.matrices.is_some());
        let modes = given.table.modes();
        let agree = if has_matrices {
            modes.starts_with(&names)
        } else {
            modes == names
        };
        if file.case.structure.is_some() && !agree {
            return Err(Failure::input(
                format!(
                    "the forces are of the modes {}, the structure has {}",
                    modes.join(", "),
                    names.join(", ")
                ),
                place,
                "rows and columns of Q would meet other modes",
                "order and name the modes of the file as the case does: rigid, elastic, analytic",
            ));
        }
        let alpha_deg = angle(
            file,
            "flow.alpha_deg",
            file.case.flow.alpha_deg,
            given.alpha_deg,
        )?;
        let beta_deg = angle(
            file,
            "flow.beta_deg",
            file.case.flow.beta_deg,
            given.beta_deg,
        )?;
        let made = Self {
            table: given.table,
            alpha: alpha_deg.to_radians(),
            beta: beta_deg.to_radians(),
            transfer: None,
            notes: vec![format!("forces from {place}")],
        };
        made.in_body_frame(file, structure, &given.frames)
    }

    /// Rigid columns in body axes, exactly zero at rest.
    fn in_body_frame(
        mut self,
        file: &CaseFile,
        structure: &StructureData,
        frames: &[Frame],
    ) -> Result<Self, Failure> {
        let Some(body) = &structure.body else {
            self.notes.extend_from_slice(self.table.notes());
            return Ok(self);
        };
        let frames: Vec<stability::Frame> =
            frames.iter().map(|frame| (*frame).into()).collect();
        self.table =
            stability::to_body_frame(self.table, &frames, &stability_body(body), self.alpha)
                .map_err(|error| {
                    Failure::input(
                        error.to_string(),
                        file.places.of("gaf.file"),
                        "rigid modes are swept in body axes",
                        "give all six rigid modes in the file (three of a half model), or those in frame body",
                    )
                })?;
        self.notes.extend_from_slice(self.table.notes());
        Ok(self)
    }
}

/// The file of the case's Mach number, or the only one.
fn chosen(file: &CaseFile) -> Result<(PathBuf, Given), Failure> {
    let listed = file
        .case
        .gaf
        .file
        .as_ref()
        .map_or(&[][..], |files| files.as_slice());
    let mut read = Vec::new();
    for path in listed {
        let full = file.existing("gaf.file", path)?;
        let given = gaf_json::read(&full)?;
        read.push((full, given));
    }
    let is_single = read.len() == 1 && !file.places.has("flow.mach");
    let there: Vec<String> = read
        .iter()
        .map(|(_, given)| given.table.mach().to_string())
        .collect();
    let mach = file.case.flow.mach;
    read.into_iter()
        .find(|(_, given)| is_single || given.table.mach() == mach)
        .ok_or_else(|| {
            Failure::input(
                format!(
                    "no file of forces has Mach number {mach}; there are {}",
                    there.join(", ")
                ),
                file.places.of("gaf.file"),
                "forces of another Mach number give other roots",
                "set flow.mach to one of these, or give the file of that Mach number",
            )
        })
}

fn fits(file: &CaseFile, given: &Given, place: &str) -> Result<(), Failure> {
    let (theirs, ours) = (given.table.semichord(), file.case.reference.semichord);
    if (theirs - ours).abs() <= 1e-9 * ours {
        return Ok(());
    }
    Err(Failure::input(
        format!("the forces have semichord {theirs} m, the case has {ours} m"),
        format!("{place}; {}", file.places.of("reference.semichord")),
        "k and g are reduced by the semichord, so the forces would be read at wrong points",
        "give both the same semichord",
    ))
}

/// The file's angle, unless the case states another.
fn angle(file: &CaseFile, key: &str, stated: f64, theirs: f64) -> Result<f64, Failure> {
    if !file.places.has(key) || (stated - theirs).abs() <= 1e-9 {
        return Ok(theirs);
    }
    Err(Failure::input(
        format!("the forces are of {theirs} degrees, `{key}` is {stated}"),
        file.places.of(key),
        "the forces depend on the incidence they are linearised about",
        "leave the key out, or give forces of that incidence",
    ))
}

impl From<Frame> for stability::Frame {
    fn from(frame: Frame) -> Self {
        match frame {
            Frame::Inertial => Self::Inertial,
            Frame::Body => Self::Body,
        }
    }
}

impl From<fladder_mesh::Frame> for Frame {
    fn from(frame: fladder_mesh::Frame) -> Self {
        match frame {
            fladder_mesh::Frame::Inertial => Self::Inertial,
            fladder_mesh::Frame::Body => Self::Body,
        }
    }
}

/// Whether the forces come from a file.
pub(crate) fn are_given(file: &CaseFile) -> bool {
    file.case.gaf.file.is_some()
}

/// Forces and the whole table of a case, from the cache or computed.
pub(crate) struct Assembled {
    pub(crate) own: OwnForces,
    pub(crate) document: Document,
}

/// Evaluates the grid of the case.
///
/// # Errors
/// A point where $Q$ has no value.
pub(crate) fn assemble(
    file: &CaseFile,
    aircraft: &Aircraft,
    own: OwnForces,
) -> Result<Assembled, Failure> {
    let samples = own_forces::samples(aircraft, &own.stored, &own_forces::grid(file))?;
    let document = own_forces::document(aircraft, &own.stored, samples);
    Ok(Assembled { own, document })
}
