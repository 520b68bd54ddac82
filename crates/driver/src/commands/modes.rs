//! `fladder modes`: what a finite-element result file holds.

use super::Session;
use crate::failure::Failure;
use crate::report;
use fladder_modal::modes_summary;
use std::path::Path;

pub(crate) fn modes(
    session: &Session,
    file: &Path,
    geometry: Option<&Path>,
    json: Option<&Path>,
) -> Result<(), Failure> {
    for path in [Some(file), geometry].into_iter().flatten() {
        if !path.is_file() {
            return Err(Failure::input(
                "there is no such file",
                path.display().to_string(),
                "its modes cannot be shown",
                "correct the path",
            ));
        }
    }
    let summary = modes_summary(file, geometry, None).map_err(|error| {
        Failure::input(
            error.to_string(),
            file.display().to_string(),
            "modes that are wrong or incomplete give wrong roots without any sign of it",
            "write the file again with the finite-element program, and copy it whole",
        )
    })?;
    report::modes_summary(&session.console, &summary);
    match json {
        Some(json) => session.write_json(json, &summary),
        None => Ok(()),
    }
}
