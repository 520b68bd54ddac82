//! `cargo xtask exports`: results of a run read by NumPy and pyNastran.

use clap::Args;
use std::path::PathBuf;
use std::process::Command;

/// Reads and compares.
const SCRIPT: &str = include_str!("compare.py");

/// A results folder of a case with forces of its own.
#[derive(Args)]
pub(crate) struct Exports {
    /// Folder that `fladder run` wrote
    folder: PathBuf,
    /// Python with numpy and pyNastran
    #[arg(long, default_value = "python3")]
    python: String,
}

/// Why nothing was compared.
#[derive(Debug, thiserror::Error)]
#[error("{program} could not be run: {source}; it needs numpy and pyNastran")]
pub(crate) struct ExportsError {
    program: String,
    source: std::io::Error,
}

impl Exports {
    /// Whether all files say the same.
    pub(crate) fn run(&self) -> Result<bool, ExportsError> {
        let status = Command::new(&self.python)
            .args(["-c", SCRIPT])
            .arg(&self.folder)
            .status()
            .map_err(|source| ExportsError {
                program: self.python.clone(),
                source,
            })?;
        Ok(status.success())
    }
}
