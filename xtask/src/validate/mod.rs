//! `cargo xtask validate`: measured accuracy against its goals, into `docs/validation.md`.
//!
//! `cargo xtask validate --scaneagle coarse.msh middle.json fine.msh` adds the table of
//! refinement; figures of a mesh kept by `--keep` can stand for the mesh.

mod document;
mod parts;

use std::path::{Path, PathBuf};

use clap::Args;
use fladder_tests::case::Fault;
use fladder_tests::convergence::{MeshFigures, Refinement};
use parts::Part;

/// Goals of refinement by triangles: 10k within 3 %, 34k within 1 %.
const REFINEMENT_GOALS: [(usize, f64); 2] = [(10_000, 0.03), (30_000, 0.01)];

/// What is validated.
#[derive(Args)]
pub(crate) struct Validate {
    /// Only these parts, separated by commas
    #[arg(long, value_enum, value_delimiter = ',', conflicts_with = "scaneagle")]
    only: Vec<Part>,
    /// Meshes of the ScanEagle-like surface, or JSON files kept from them: the table of
    /// refinement alone
    #[arg(long, num_args = 1.., value_name = "FILE")]
    scaneagle: Vec<PathBuf>,
    /// Folder in which the figures of each mesh of --scaneagle are kept
    #[arg(long, value_name = "FOLDER", requires = "scaneagle")]
    keep: Option<PathBuf>,
    /// The document
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/validation.md"))]
    out: PathBuf,
}

/// Why nothing was validated.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ValidateError {
    #[error(transparent)]
    Fault(#[from] Fault),
    #[error("cannot write {}: {source}", path.display())]
    Write {
        path: PathBuf,
        source: std::io::Error,
    },
}

impl Validate {
    /// Runs, prints and writes; whether all goals are met.
    pub(crate) fn run(&self) -> Result<bool, ValidateError> {
        if !self.scaneagle.is_empty() {
            return self.refinement();
        }
        let parts = if self.only.is_empty() {
            Part::all()
        } else {
            &self.only
        };
        let mut all_met = true;
        for &part in parts {
            let rows = part.rows()?;
            let (title, about) = part.head();
            let text = document::table(title, about, &rows);
            println!("{text}");
            all_met &= rows.iter().all(fladder_tests::row::Row::holds);
            self.put(&part.mark(), &text)?;
        }
        Ok(all_met)
    }

    fn refinement(&self) -> Result<bool, ValidateError> {
        if let Some(folder) = &self.keep {
            // Before hours of work, not after.
            std::fs::create_dir_all(folder).map_err(|source| ValidateError::Write {
                path: folder.clone(),
                source,
            })?;
        }
        let mut figures = Vec::new();
        for file in &self.scaneagle {
            figures.push(self.figures(file)?);
        }
        if figures.len() < 2 {
            return Ok(true);
        }
        let found = Refinement::new(figures)?;
        let goal = |triangles: usize| {
            let passed = REFINEMENT_GOALS.iter().rev().find(|g| triangles >= g.0);
            passed.map_or(f64::INFINITY, |g| g.1)
        };
        let goals: Vec<f64> = found.meshes.iter().map(|(_, n)| goal(*n)).collect();
        let text = document::refinement(&found, &goals);
        println!("{text}");
        self.put(document::REFINEMENT, &text)?;
        let met = |(mesh, goal): (usize, &f64)| found.worst(mesh) <= *goal;
        Ok(goals.iter().enumerate().all(met))
    }

    fn figures(&self, file: &Path) -> Result<MeshFigures, ValidateError> {
        if file
            .extension()
            .is_some_and(|extension| extension == "json")
        {
            return Ok(MeshFigures::read(file)?);
        }
        let figures = MeshFigures::compute(file)?;
        if let Some(folder) = &self.keep {
            let stem = file.file_stem().unwrap_or_default();
            let mut name = PathBuf::from(stem);
            name.set_extension("json");
            figures.write(&folder.join(name))?;
        }
        Ok(figures)
    }

    fn put(&self, mark: &str, text: &str) -> Result<(), ValidateError> {
        document::put(&self.out, mark, text).map_err(|source| ValidateError::Write {
            path: self.out.clone(),
            source,
        })
    }
}
