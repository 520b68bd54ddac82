//! `cargo xtask scaneagle mesh` and `modes`: wetted surface and structure of the ScanEagle-like
//! aircraft, or of another flying wing, from tables.

mod body;
mod params;
mod plane;
mod spacing;
mod structure;
mod surface;
mod wing;

use std::path::PathBuf;

use clap::{Args, Subcommand};
use fladder_mesh::write::msh41;

use params::{ParameterError, Parameters};
use surface::{SurfaceError, surface};

/// The dimensions of the case.
pub(crate) const TABLE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../cases/scaneagle/geometry.toml"
);

/// What is made.
#[derive(Subcommand)]
pub(crate) enum ScanEagle {
    /// Write the surface as Gmsh 4.1, with groups for wing, controls, edges
    Mesh(Mesh),
    /// Make the structure, have CalculiX find its modes, and write them into the case
    Modes(structure::Modes),
}

/// Which surface, and where it goes.
#[derive(Args)]
pub(crate) struct Mesh {
    /// A [size.NAME] of the table: 3k, 10k, 34k
    #[arg(long, default_value = "10k")]
    pub(crate) size: String,
    /// Table of dimensions
    #[arg(long, default_value = TABLE)]
    pub(crate) params: PathBuf,
    /// File to write [default: scaneagle_SIZE.msh here]
    #[arg(long)]
    pub(crate) out: Option<PathBuf>,
}

/// Why no mesh was made.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ScanEagleError {
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    #[error(transparent)]
    Modes(#[from] structure::ModesError),
    #[error("there is no [size.{wanted}]; there are {there}")]
    Size { wanted: String, there: String },
    #[error("{}: {source}", path.display())]
    Write {
        path: PathBuf,
        source: std::io::Error,
    },
}

impl ScanEagle {
    /// Makes it; a sentence about it.
    pub(crate) fn run(&self) -> Result<String, ScanEagleError> {
        match self {
            Self::Mesh(mesh) => mesh.run(),
            Self::Modes(modes) => Ok(modes.run()?),
        }
    }
}

impl Mesh {
    fn run(&self) -> Result<String, ScanEagleError> {
        let mesh = self;
        let parameters = Parameters::read(&mesh.params)?;
        let size = parameters.size.get(&mesh.size).copied();
        let size = size.ok_or_else(|| ScanEagleError::Size {
            wanted: mesh.size.clone(),
            there: parameters
                .size
                .keys()
                .cloned()
                .collect::<Vec<_>>()
                .join(", "),
        })?;
        let made = surface(&parameters, size)?;
        let named = || PathBuf::from(format!("scaneagle_{}.msh", mesh.size));
        let path = mesh.out.clone().unwrap_or_else(named);
        let mut bytes = Vec::new();
        let written = msh41(&mut bytes, &made).and_then(|()| std::fs::write(&path, bytes));
        written.map_err(|source| ScanEagleError::Write {
            path: path.clone(),
            source,
        })?;
        Ok(format!(
            "{}: {} triangles, {} vertices, {:.4} m², {:.6} m³",
            path.display(),
            made.triangles.len(),
            made.vertices.len(),
            made.area(),
            made.volume()
        ))
    }
}

#[cfg(test)]
mod tests;
