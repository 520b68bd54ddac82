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
    let Some(name) = name.filter(|name| is_plain(name)) else {
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
    // Made beside and moved there: a folder of that name is a whole case.
    let parent = match folder.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let failed = |error: std::io::Error| Failure::io("make the folder", folder, &error);
    std::fs::create_dir_all(parent).map_err(failed)?;
    let made = tempfile::Builder::new()
        .prefix(".tmp-")
        .tempdir_in(parent)
        .map_err(failed)?;
    files::write(&made.path().join("wing.msh"), bytes)?;
    files::write(&made.path().join("case.toml"), CASE.replace("NAME", name))?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Temporary folders are private.
        let mode = std::fs::Permissions::from_mode(0o755);
        std::fs::set_permissions(made.path(), mode).map_err(failed)?;
    }
    std::fs::rename(made.path(), folder).map_err(failed)?;
    // It is no temporary folder any more.
    let _ = made.keep();
    session.console.say(format!(
        "made {place} with case.toml and wing.msh\n\n  fladder check {place}   what is in it\n  \
         fladder run {place}     forces, roots, report in results/{name}\n\nThen exchange mesh and \
         structure for your own: every key is explained in case.toml."
    ));
    Ok(())
}

/// Whether a name can stand in the case file as it is.
fn is_plain(name: &str) -> bool {
    let is_strange = |letter: char| letter.is_control() || "\"\\".contains(letter);
    !name.trim().is_empty() && !name.contains(is_strange)
}
