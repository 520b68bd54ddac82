//! The files a result was made from, each with its hash.

use crate::case::CaseFile;
use std::path::{Path, PathBuf};

/// Name of the key and what it names: case, mesh, structure and forces, with the BLAKE3 hash of
/// each file; then what the command line overrides.
///
/// A file that cannot be read any more has no hash.
pub(crate) fn inputs(file: &CaseFile, overrides: &[String]) -> Vec<(String, String)> {
    let case = &file.case;
    let mut named: Vec<(&str, PathBuf)> = vec![("case", file.path().to_owned())];
    if let (Some(mesh), None) = (&case.mesh, &case.gaf.file) {
        named.push(("mesh.file", file.resolve(&mesh.file)));
    }
    if let Some(structure) = &case.structure {
        let files = [
            ("structure.file", &structure.file),
            ("structure.geometry", &structure.geometry),
        ];
        for (key, path) in files {
            named.extend(path.iter().map(|path| (key, file.resolve(path))));
        }
    }
    let forces = case
        .gaf
        .file
        .iter()
        .flat_map(crate::case::OneOrMany::as_slice);
    named.extend(forces.map(|path| ("gaf.file", file.resolve(path))));
    let hashed = named
        .into_iter()
        .map(|(key, path)| (key.to_owned(), hashed(&path)));
    let set = overrides
        .iter()
        .map(|given| ("--set".to_owned(), given.clone()));
    hashed.chain(set).collect()
}

/// Name of a file and the hash of its bytes.
fn hashed(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    let hash = std::fs::read(path).map_or_else(
        |_| "not readable".to_owned(),
        |bytes| blake3::hash(&bytes).to_hex().to_string(),
    );
    format!("{}: {hash}", name.to_string_lossy())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_the_hash_of_its_bytes() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.msh");
        assert_eq!(hashed(&path), "a.msh: not readable");
        std::fs::write(&path, b"one").expect("written");
        let first = hashed(&path);
        std::fs::write(&path, b"two").expect("written");
        assert!(first.starts_with("a.msh: ") && first != hashed(&path));
    }
}
