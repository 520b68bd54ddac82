//! `fladder new`: a case to start from.

use super::Session;
use crate::failure::Failure;
use crate::files;
use fladder_mesh::shapes::NacaWing;
use fladder_mesh::write::msh41;
use std::path::Path;

/// The case, with every key explained.
const CASE: &str = include_str!("new.toml");

/// Makes a folder with a case and its mesh; what is there already stays.
pub(crate) fn new(session: &Session, folder: &Path) -> Result<(), Failure> {
    let place = folder.display().to_string();
    let name = folder.file_name().and_then(|name| name.to_str());
    let Some(name) = name.filter(|name| !name.contains(['"', '\\']) && !name.trim().is_empty())
    else {
        return Err(Failure::input(
            format!("`{place}` is no name for a case"),
            "the argument NAME",
            "the folder's name becomes the title of the case and of its results",
            "give a plain name, for example `fladder new wing`",
        ));
    };
    if folder.symlink_metadata().is_ok() {
        return Err(Failure::input(
            format!("`{place}` is there already"),
            place,
            "nothing that exists is written over",
            "give another name, or remove it first",
        ));
    }
    let wing = NacaWing {
        chord: 0.25,
        span: 2.0,
        ..NacaWing::default()
    };
    let mesh = wing.structured().map_err(|error| {
        Failure::numerical(
            format!("the example mesh could not be made: {error}"),
            place.clone(),
            "the case would have no surface",
            "please report this",
        )
    })?;
    let mut bytes = Vec::new();
    msh41(&mut bytes, &mesh).map_err(|error| Failure::io("write the mesh", folder, &error))?;
    // The mesh first: a folder with a case file is a whole case.
    files::write(&folder.join("wing.msh"), bytes)?;
    files::write(&folder.join("case.toml"), CASE.replace("NAME", name))?;
    session.console.say(format!(
        "made {place} with case.toml and wing.msh\n\n  fladder check {place}   what is in it\n  \
         fladder run {place}     forces, roots, report in results/{name}\n\nThen exchange mesh and \
         structure for your own: every key is explained in case.toml."
    ));
    Ok(())
}
