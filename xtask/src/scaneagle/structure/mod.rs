//! `cargo xtask scaneagle modes`: the structure of the aircraft from its table, and its modes
//! by CalculiX.

mod deck;
mod frame;
mod joints;
mod judge;
mod keep;
mod laminate;
mod mass;
mod mesh;
mod model;
mod moments;
mod report;
mod shells;
mod solver;
mod table;

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use fladder_modal::{StructureSettings, load};

use super::params::{ParameterError, Parameters};
use model::Model;
use solver::{JOB, SolverError};
use table::Table;

/// The structure of the case.
const TABLE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../cases/scaneagle/structure.toml"
);
/// Where its modes are.
const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../cases/scaneagle");

/// Which structure, and where its modes go.
#[derive(Args)]
pub(crate) struct Modes {
    /// Table of dimensions
    #[arg(long, default_value = super::TABLE)]
    params: PathBuf,
    /// Table of the structure
    #[arg(long, default_value = TABLE)]
    structure: PathBuf,
    /// Folder for modes.frd.gz, modes.inp.gz and modes.dat
    #[arg(long, default_value = CASE)]
    out: PathBuf,
    /// CalculiX
    #[arg(long, default_value = "ccx")]
    ccx: PathBuf,
    /// Write modes.inp there and do not solve
    #[arg(long)]
    inp_only: bool,
    /// Cut every interval between lines of elements into so many parts
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=4))]
    refine: u8,
}

/// Why there are no modes.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ModesError {
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    #[error(transparent)]
    Solver(#[from] SolverError),
    #[error(transparent)]
    Read(#[from] fladder_modal::StructureError),
    #[error("{0}; nothing is written")]
    Judged(String),
}

impl Modes {
    /// Makes the model, solves it, judges the modes and writes them; what was found.
    ///
    /// # Errors
    /// Tables that make no structure, CalculiX missing or at a loss, modes that are not those
    /// of a free symmetric aircraft.
    pub(crate) fn run(&self) -> Result<String, ModesError> {
        let parameters = Parameters::read(&self.params)?;
        let table = Table::read(&self.structure)?;
        let model = Model::new(&parameters, &table, usize::from(self.refine))
            .map_err(ParameterError::Value)?;
        let input = deck::deck(&model);
        let mut said = report::model(&model);
        let file = |path: PathBuf| move |source| SolverError::File { path, source };
        std::fs::create_dir_all(&self.out).map_err(file(self.out.clone()))?;
        if self.inp_only {
            let path = self.out.join(format!("{JOB}.inp"));
            std::fs::write(&path, &input).map_err(file(path.clone()))?;
            return Ok(format!("{said}wrote {}", path.display()));
        }
        let job = tempfile::tempdir().map_err(file(std::env::temp_dir()))?;
        solver::solve(&self.ccx, job.path(), &input)?;
        let found = load(&StructureSettings {
            file: job.path().join(format!("{JOB}.frd")),
            geometry: Some(job.path().join(format!("{JOB}.inp"))),
            ..StructureSettings::default()
        })?;
        let judged = judge::judge(&model, &found).map_err(ModesError::Judged)?;
        said.push_str(&report::modes(&judged, &found));
        for (path, bytes) in keep::keep(job.path(), &input, &self.out)? {
            let _ = writeln!(said, "wrote {}, {bytes} bytes", path.display());
        }
        Ok(said.trim_end().to_owned())
    }
}

#[cfg(test)]
mod tests;
