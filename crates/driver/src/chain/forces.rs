//! Forces as a sweep needs them: of the swept modes, rigid ones in body axes.

use super::aircraft::Aircraft;
use super::conditions::Conditions;
use super::given;
use super::level;
use super::own_forces::{self, OwnForces};
use super::structure::{StructureData, stability_body};
use crate::case::CaseFile;
use crate::failure::Failure;
use crate::gaf_json::{Document, Frame};
use faer::{Mat, c64};
use fladder_bem::{Flow, TransferModel};
use fladder_stability::{self as stability, GafPoint, GafTable, Incidences, Mixture};
use rayon::prelude::*;
use std::sync::Arc;

/// Samples of $Q$ with all that belongs to them.
#[derive(Debug)]
pub(crate) struct Forces {
    /// Samples of the swept modes, parts side by side.
    pub(crate) table: GafTable,
    /// How the parts make the forces of a flight condition, where there are
    /// several.
    pub(crate) mixture: Option<Arc<dyn Mixture>>,
    /// Steady forces of the modes, for each part.
    pub(crate) steady: Vec<Vec<Option<f64>>>,
    /// Where $Q$ can be evaluated anywhere, if it can.
    pub(crate) transfer: Option<TransferModel>,
    /// Incidence of each part, where it can.
    pub(crate) flows: Vec<Flow>,
    /// Flight conditions of the sweep.
    pub(crate) conditions: Conditions,
    /// Sentences for the user.
    pub(crate) notes: Vec<String>,
}

impl Forces {
    /// From what was computed here, on the grid of the case.
    ///
    /// # Errors
    /// A grid that is none; a speed at which no incidence carries the weight.
    pub(crate) fn own(
        file: &CaseFile,
        aircraft: &Aircraft,
        forces: &OwnForces,
        document: &Document,
    ) -> Result<Self, Failure> {
        let stored = &forces.stored;
        let flow = Flow {
            alpha: document.alpha_deg.to_radians(),
            beta: document.beta_deg.to_radians(),
        };
        let trim = level::own(file, aircraft, stored)?;
        let conditions = Conditions::of(file)?
            .at_incidence(flow.alpha, flow.beta)
            .trimmed(trim);
        let mut notes = level::notes(file, &conditions)?;
        let incidences = conditions.is_trimmed().then(|| {
            let alphas: Vec<f64> = conditions
                .points()
                .iter()
                .map(|point| point.alpha)
                .collect();
            let low = alphas.iter().copied().fold(f64::INFINITY, f64::min);
            let high = alphas.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            Incidences::over(low, high)
        });
        let flows = match &incidences {
            Some(nodes) => nodes.values().map(|alpha| Flow { alpha, ..flow }).to_vec(),
            None => vec![flow],
        };
        let order = aircraft.swept_modes(file);
        let sheets = samples(file, &stored.solution.transfer, &flows, order)?;
        let steady: Vec<Vec<Option<f64>>> = flows
            .iter()
            .map(|flow| {
                let all = stored
                    .solution
                    .steady
                    .generalised_forces_at(flow.stream().into());
                all.into_iter().take(order).map(Some).collect()
            })
            .collect();
        let mut tables = Vec::new();
        for (points, (flow, steady)) in sheets.into_iter().zip(flows.iter().zip(&steady)) {
            let table = GafTable::new(
                document.semichord,
                document.mach,
                document.modes[..order].to_vec(),
                points,
                steady.clone(),
            )
            .map_err(|error| {
                Failure::input(
                    error.to_string(),
                    file.places.of("gaf"),
                    "roots are found from forces on a grid that contains the imaginary axis",
                    "correct k and g of [gaf]",
                )
            })?;
            let frames = &document.frames[..order];
            tables.push(in_body_frame(
                file,
                &aircraft.structure,
                table,
                frames,
                flow.alpha,
            )?);
        }
        let table = side_by_side(file, &tables)?;
        notes.extend_from_slice(table.notes());
        Ok(Self {
            table,
            mixture: incidences.map(|nodes| Arc::new(nodes) as Arc<dyn Mixture>),
            steady,
            transfer: Some(stored.solution.transfer.clone()),
            flows,
            conditions,
            notes,
        })
    }

    /// From the files that the case names.
    ///
    /// # Errors
    /// Unreadable files, and forces that do not fit the case.
    pub(crate) fn given(file: &CaseFile, structure: &StructureData) -> Result<Self, Failure> {
        given::read(file, structure)
    }
}

/// $Q$ of the swept modes on the grid of the case, one list for each incidence.
fn samples(
    file: &CaseFile,
    transfer: &TransferModel,
    flows: &[Flow],
    order: usize,
) -> Result<Vec<Vec<GafPoint>>, Failure> {
    let grid = own_forces::grid(file);
    let each: Vec<Vec<GafPoint>> = grid
        .par_iter()
        .map(|&[g, k]| {
            let parts = transfer
                .q_at_each(c64::new(g, k), flows)
                .map_err(|error| own_forces::not_evaluated(&error))?;
            let sample = |q: Mat<c64>| GafPoint {
                g,
                k,
                q: q.submatrix(0, 0, order, order).to_owned(),
            };
            Ok(parts.into_iter().map(sample).collect())
        })
        .collect::<Result<_, Failure>>()?;
    let of_part = |part: usize| each.iter().map(|points| points[part].clone()).collect();
    Ok((0..flows.len()).map(of_part).collect())
}

/// Rigid columns in body axes, exactly zero at rest.
pub(super) fn in_body_frame(
    file: &CaseFile,
    structure: &StructureData,
    table: GafTable,
    frames: &[Frame],
    alpha: f64,
) -> Result<GafTable, Failure> {
    let Some(body) = &structure.body else {
        return Ok(table);
    };
    let frames: Vec<stability::Frame> = frames.iter().map(|frame| (*frame).into()).collect();
    stability::to_body_frame(table, &frames, &stability_body(body), alpha).map_err(|error| {
        Failure::input(
            error.to_string(),
            file.places.of("gaf.file"),
            "rigid modes are swept in body axes",
            "give all six rigid modes in the file (three of a half model), or those in frame body",
        )
    })
}

/// One table of all parts.
pub(super) fn side_by_side(file: &CaseFile, tables: &[GafTable]) -> Result<GafTable, Failure> {
    GafTable::side_by_side(tables).map_err(|error| {
        Failure::input(
            error.to_string(),
            file.places.of("gaf.file"),
            "between Mach numbers forces are interpolated entry by entry",
            "give files with the same modes, semichord, k and g",
        )
    })
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
