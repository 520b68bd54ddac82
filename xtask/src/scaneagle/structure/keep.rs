//! The files of the case: compressed, without times and names of the run.

use std::io::Write;
use std::path::{Path, PathBuf};

use flate2::{Compression, GzBuilder};

use super::solver::{JOB, SolverError};

/// Lines of the head of a result that differ from run to run.
const RUN: [&str; 5] = [
    "    1UUSER",
    "    1UDATE",
    "    1UTIME",
    "    1UHOST",
    "    1UDIR",
];

/// Writes input, result and tables of the job into a folder; their sizes in bytes.
///
/// # Errors
/// Files that cannot be read or written.
pub(super) fn keep(
    job: &Path,
    input: &str,
    folder: &Path,
) -> Result<Vec<(PathBuf, usize)>, SolverError> {
    let read = |ending: &str| {
        let path = job.join(format!("{JOB}.{ending}"));
        std::fs::read_to_string(&path).map_err(|source| SolverError::File { path, source })
    };
    let frd = read("frd")?;
    let kept = frd
        .split_inclusive('\n')
        .filter(|line| !RUN.iter().any(|start| line.starts_with(start)));
    let frd: String = kept.collect();
    let files = [
        (format!("{JOB}.inp.gz"), packed(input.as_bytes())),
        (format!("{JOB}.frd.gz"), packed(frd.as_bytes())),
        (format!("{JOB}.dat"), Ok(read("dat")?.into_bytes())),
    ];
    let mut sizes = Vec::new();
    for (name, bytes) in files {
        let path = folder.join(name);
        let written = bytes.and_then(|bytes| {
            std::fs::write(&path, &bytes)?;
            Ok(bytes.len())
        });
        let size = written.map_err(|source| SolverError::File {
            path: path.clone(),
            source,
        })?;
        sizes.push((path, size));
    }
    Ok(sizes)
}

/// Gzip without a name or a time.
fn packed(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut packer = GzBuilder::new().write(Vec::new(), Compression::best());
    packer.write_all(bytes)?;
    packer.finish()
}
