//! Result files appear whole or not at all.

use crate::failure::Failure;
use std::fs;
use std::io::Write;
use std::path::Path;

/// Writes a file by way of a temporary one in the same folder.
///
/// # Errors
/// [`Failure`] of kind input or output.
pub fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<(), Failure> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let failed = |error: std::io::Error| Failure::io("write the file", path, &error);
    fs::create_dir_all(folder).map_err(failed)?;
    let mut file = tempfile::Builder::new()
        .prefix(".tmp-")
        .tempfile_in(folder)
        .map_err(failed)?;
    file.write_all(content.as_ref()).map_err(failed)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Temporary files are private; results are for everyone, as the
        // folder allows.
        let mode = fs::Permissions::from_mode(0o644);
        file.as_file().set_permissions(mode).map_err(failed)?;
    }
    file.persist(path)
        .map_err(|error| failed(error.error))
        .map(drop)
}

/// Removes a file of an earlier run that this one does not write; one that is not there is
/// no failure.
///
/// # Errors
/// [`Failure`] of kind input or output.
pub fn remove(path: &Path) -> Result<(), Failure> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(Failure::io(
            "remove the file of an earlier run",
            path,
            &error,
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_and_folders_are_made() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a").join("b.txt");
        write(&path, "one").unwrap();
        write(&path, "two").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "two");
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_in_the_way_is_an_output_failure() {
        let folder = tempfile::tempdir().unwrap();
        let failure = write(folder.path(), "x").expect_err("it is a folder");
        assert_eq!(failure.exit_code(), crate::failure::exit::IO);
    }
}
