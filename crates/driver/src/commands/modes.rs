//! `fladder modes`: what a finite-element result file holds, or what a case makes
//! of one.

use super::Session;
use crate::case::CaseFile;
use crate::chain::aircraft::Aircraft;
use crate::chain::forces;
use crate::chain::structure::StructureData;
use crate::failure::Failure;
use crate::report::{self, Shown};
use crate::terminal::Console;
use fladder_modal::{ModesSummary, ReadError, TransferReport, read_structure, summary_of};
use std::path::Path;

/// What is asked for besides the table.
pub(crate) struct Wanted<'a> {
    pub(crate) geometry: Option<&'a Path>,
    pub(crate) json: Option<&'a Path>,
    pub(crate) vtu: Option<&'a Path>,
}

pub(crate) fn modes(
    session: &Session,
    input: &Path,
    wanted: &Wanted<'_>,
) -> Result<(), Failure> {
    let is_case = input
        .extension()
        .is_some_and(|extension| extension == "toml");
    if is_case || input.is_dir() {
        return of_case(session, input, wanted);
    }
    for path in [Some(input), wanted.geometry].into_iter().flatten() {
        if !path.is_file() {
            return Err(Failure::input(
                "there is no such file",
                path.display().to_string(),
                "its modes cannot be shown",
                "correct the path",
            ));
        }
    }
    let result =
        read_structure(input, wanted.geometry, None).map_err(|error| unread(&error, input))?;
    let summary = summary_of(&result);
    report::modes_summary(&session.console, &summary);
    if let Some(folder) = wanted.vtu {
        write_structure(session, folder, &Shown::File(&result))?;
    }
    write_json(session, wanted, &summary)
}

fn of_case(session: &Session, path: &Path, wanted: &Wanted<'_>) -> Result<(), Failure> {
    if let Some(geometry) = wanted.geometry {
        return Err(Failure::input(
            "--geometry is given beside a case",
            geometry.display().to_string(),
            "the case names its own files",
            "leave the option out, or set structure.geometry",
        ));
    }
    let file = session.case(path)?;
    let console = &session.console;
    let summary = contents(&file)?;
    if forces::are_given(&file) || file.case.mesh.is_none() {
        let structure = StructureData::read(&file)?;
        table(console, &file, (&summary, &structure), None);
        if let (Some(folder), Some(model)) = (wanted.vtu, &structure.model) {
            write_structure(session, folder, &Shown::Model(model))?;
        }
        return write_json(session, wanted, &summary);
    }
    let aircraft = match Aircraft::read(&file) {
        Ok(aircraft) => aircraft,
        Err(failure) => {
            // What is in the file may explain why it does not fit.
            report::modes_summary(console, &summary);
            return Err(failure);
        }
    };
    let carried = aircraft.transfer.as_ref();
    table(console, &file, (&summary, &aircraft.structure), carried);
    report::transfer(console, carried);
    if let Some(folder) = wanted.vtu {
        if let Some(model) = &aircraft.structure.model {
            write_structure(session, folder, &Shown::Model(model))?;
        }
        let picture =
            report::surface_picture(&aircraft).map_err(|error| not_drawn(folder, &error))?;
        session.write(&folder.join("surface_modes.vtu"), picture)?;
        for report::Named { name, picture } in report::mode_pictures(&aircraft) {
            session.write(&folder.join(report::picture_file(&name)), picture)?;
        }
    }
    write_json(session, wanted, &summary)
}

/// All modes in one table; changed ones, which are no longer those of the file,
/// in one of their own.
fn table(
    console: &Console,
    file: &CaseFile,
    (summary, data): (&ModesSummary, &StructureData),
    carried: Option<&TransferReport>,
) {
    let given = file.case.structure.as_ref();
    if given.is_some_and(crate::case::Structure::is_changed) {
        report::modes_summary(console, summary);
        report::structure(console, data, carried);
    } else {
        report::modes_of_case(console, summary, data, carried);
    }
}

/// Contents of the result file that a case names.
fn contents(file: &CaseFile) -> Result<ModesSummary, Failure> {
    let given = file.case.structure.as_ref();
    let Some((given, path)) = given.and_then(|given| Some((given, given.file.as_ref()?)))
    else {
        return Err(Failure::input(
            "the case names no result file",
            file.places.of("structure"),
            "there are no modes to be shown",
            "set structure.file",
        ));
    };
    let path = file.existing("structure.file", path)?;
    let geometry = given.geometry.as_deref();
    let geometry = geometry
        .map(|geometry| file.existing("structure.geometry", geometry))
        .transpose()?;
    let format = given
        .format
        .as_deref()
        .and_then(fladder_modal::Format::from_name);
    let result = read_structure(&path, geometry.as_deref(), format);
    result
        .map(|result| summary_of(&result))
        .map_err(|error| unread(&error, &path))
}

fn write_json(
    session: &Session,
    wanted: &Wanted<'_>,
    summary: &ModesSummary,
) -> Result<(), Failure> {
    wanted
        .json
        .map_or(Ok(()), |json| session.write_json(json, summary))
}

fn write_structure(session: &Session, folder: &Path, shown: &Shown<'_>) -> Result<(), Failure> {
    let picture =
        report::structure_picture(shown).map_err(|error| not_drawn(folder, &error))?;
    session.write(&folder.join("structure_modes.vtu"), picture)
}

fn not_drawn(folder: &Path, error: &std::io::Error) -> Failure {
    Failure::io("draw the modes", folder, error)
}

fn unread(error: &ReadError, file: &Path) -> Failure {
    let remedy = match error {
        ReadError::Io { .. } => "correct the path, or make the file readable",
        ReadError::UnknownFormat { .. } => {
            "give a file of these formats; results of other programs go into the neutral JSON of \
             docs/modal-json.md"
        }
        ReadError::UnknownGeometry { .. } => {
            "give the input of the finite-element program as the geometry"
        }
        ReadError::Truncated { .. } | ReadError::Damaged { .. } | ReadError::Count { .. } => {
            "write the file again with the finite-element program, and copy it whole"
        }
        ReadError::Syntax { .. } => {
            "correct this line, or write the file again with the finite-element program"
        }
        _ => "give files of one and the same run, with real modes and the nodes they are of",
    };
    Failure::input(
        error.to_string(),
        file.display().to_string(),
        "modes that are wrong or incomplete give wrong roots without any sign of it",
        remedy,
    )
}
