//! CalculiX as a program beside this one.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Name of the job in its folder.
pub(super) const JOB: &str = "modes";

/// Why CalculiX gave no modes.
#[derive(Debug, thiserror::Error)]
pub(crate) enum SolverError {
    #[error(
        "{program}: CalculiX is not there. Install it (Debian: apt install calculix-ccx) or name \
         the program with --ccx PATH. The case itself needs no CalculiX: its modes are in its folder"
    )]
    Missing { program: String },
    #[error("{}: {source}", path.display())]
    File {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("CalculiX found no modes ({status}); it said last:\n{last}")]
    Failed { status: String, last: String },
}

/// Lines of the log that are shown when it failed.
const LAST: usize = 12;

/// Solves the input in the folder; the result is `modes.frd` and `modes.dat` there.
///
/// # Errors
/// A program that is not there, or one that leaves no result.
pub(super) fn solve(program: &Path, folder: &Path, input: &str) -> Result<(), SolverError> {
    let file = |path: PathBuf| move |source| SolverError::File { path, source };
    let path = folder.join(format!("{JOB}.inp"));
    std::fs::write(&path, input).map_err(file(path.clone()))?;
    let log = folder.join(format!("{JOB}.log"));
    let out = std::fs::File::create(&log).map_err(file(log.clone()))?;
    let errors = out.try_clone().map_err(file(log.clone()))?;
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let ended = Command::new(program)
        .arg(JOB)
        .current_dir(folder)
        .env("OMP_NUM_THREADS", threads.to_string())
        .stdin(Stdio::null())
        .stdout(out)
        .stderr(errors)
        .status();
    let status = ended.map_err(|source| {
        if source.kind() == std::io::ErrorKind::NotFound {
            let program = program.display().to_string();
            SolverError::Missing { program }
        } else {
            let path = program.to_owned();
            SolverError::File { path, source }
        }
    })?;
    let there = ["frd", "dat"].iter().all(|ending| {
        let result = folder.join(format!("{JOB}.{ending}"));
        result.metadata().is_ok_and(|data| data.len() > 0)
    });
    let said = std::fs::read_to_string(&log).unwrap_or_default();
    if status.success() && there && !said.contains("*ERROR") {
        return Ok(());
    }
    let lines: Vec<&str> = said
        .lines()
        .filter(|line| !line.trim().is_empty())
        .collect();
    Err(SolverError::Failed {
        status: status.to_string(),
        last: lines[lines.len().saturating_sub(LAST)..].join("\n"),
    })
}
