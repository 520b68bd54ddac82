//! Meshes of analytic shapes.

use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};
use fladder_mesh::shapes::{Extent, NacaWing, ShapeError, Tip, ellipsoid};
use fladder_mesh::{TriMesh, write};

/// A shape and its dimensions.
#[derive(Subcommand)]
pub(crate) enum Shape {
    /// Wing of symmetric NACA four-digit section; groups `wing` and `te`
    Wing(Wing),
    /// Sphere from the icosahedron; group `body`
    Sphere {
        /// Radius, m
        #[arg(long, default_value_t = 1.0)]
        radius: f64,
        #[command(flatten)]
        cut: Cut,
    },
    /// Ellipsoid, a stretched sphere; group `body`
    Ellipsoid {
        /// Semi-axes along x, y, z, m
        #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], required = true)]
        semi_axes: Vec<f64>,
        #[command(flatten)]
        cut: Cut,
    },
}

/// How finely a sphere is cut, and where it goes.
#[derive(Args)]
pub(crate) struct Cut {
    /// Triangles along an edge of the icosahedron: 20 N² in all
    #[arg(short, default_value_t = 8)]
    n: usize,
    /// File to write
    out: PathBuf,
}

/// Dimensions and cells of a wing.
#[derive(Args)]
pub(crate) struct Wing {
    /// Thickness over chord
    #[arg(long, default_value_t = 0.12)]
    thickness: f64,
    /// Root chord, m
    #[arg(long, default_value_t = 1.0)]
    chord: f64,
    /// Span of the whole wing, m
    #[arg(long, default_value_t = 8.0)]
    span: f64,
    /// Sweep of the leading edge, degrees
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    sweep_deg: f64,
    /// Tip chord over root chord
    #[arg(long, default_value_t = 1.0)]
    taper: f64,
    /// Cells from leading to trailing edge on each side
    #[arg(long, default_value_t = 12)]
    n_chord: usize,
    /// Cells from root to tip
    #[arg(long, default_value_t = 16)]
    n_half_span: usize,
    /// How the wing ends
    #[arg(long, value_enum, default_value_t = TipShape::Flat)]
    tip: TipShape,
    /// Only the half on y >= 0, open at y = 0
    #[arg(long)]
    half: bool,
    /// Irregular points from this seed, upper and lower side not matched
    #[arg(long, value_name = "SEED")]
    unstructured: Option<u64>,
    /// File to write
    out: PathBuf,
}

#[derive(Clone, Copy, ValueEnum)]
enum TipShape {
    /// Cut off square
    Flat,
    /// Upper and lower side meet
    Sharp,
}

/// Why no mesh was written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum MeshError {
    #[error(transparent)]
    Shape(#[from] ShapeError),
    #[error("cannot write {}: {source}", path.display())]
    Write {
        path: PathBuf,
        source: std::io::Error,
    },
}

impl Shape {
    /// Writes the file and says what is in it.
    pub(crate) fn write(self) -> Result<String, MeshError> {
        let (mesh, path) = match self {
            Self::Wing(wing) => (wing.mesh()?, wing.out),
            Self::Sphere { radius, cut } => (ellipsoid([radius; 3], cut.n), cut.out),
            Self::Ellipsoid { semi_axes, cut } => (
                ellipsoid([semi_axes[0], semi_axes[1], semi_axes[2]], cut.n),
                cut.out,
            ),
        };
        File::create(&path)
            .and_then(|file| write::msh41(BufWriter::new(file), &mesh))
            .map_err(|source| MeshError::Write {
                path: path.clone(),
                source,
            })?;
        Ok(format!(
            "{}: {} vertices, {} triangles, area {:.6} m², volume {:.6} m³",
            path.display(),
            mesh.vertices.len(),
            mesh.triangles.len(),
            mesh.area(),
            mesh.volume()
        ))
    }
}

impl Wing {
    fn mesh(&self) -> Result<TriMesh, ShapeError> {
        let wing = NacaWing {
            thickness: self.thickness,
            chord: self.chord,
            span: self.span,
            sweep_deg: self.sweep_deg,
            taper: self.taper,
            n_chord: self.n_chord,
            n_half_span: self.n_half_span,
            tip: match self.tip {
                TipShape::Flat => Tip::Flat,
                TipShape::Sharp => Tip::Sharp,
            },
            extent: if self.half {
                Extent::Half
            } else {
                Extent::Full
            },
            ..NacaWing::default()
        };
        match self.unstructured {
            Some(seed) => wing.unstructured(seed),
            None => wing.structured(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use clap::Parser;
    use fladder_mesh::read::read_mesh;

    use super::*;

    #[derive(Parser)]
    struct OneWing {
        #[command(flatten)]
        wing: Wing,
    }

    fn wing(arguments: &[&str]) -> Wing {
        OneWing::parse_from([&["wing"], arguments].concat()).wing
    }

    /// The mesh of the first case is the one the command in its case file makes.
    #[test]
    fn the_wing_of_the_first_case_is_what_the_command_makes() {
        let arguments = [
            "--chord",
            "0.25",
            "--span",
            "2",
            "--n-chord",
            "12",
            "--n-half-span",
            "16",
            "wing.msh",
        ];
        let made = wing(&arguments).mesh().unwrap();
        let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/wing/wing.msh");
        let kept = read_mesh(kept, 1.0).unwrap();
        assert_eq!(
            (&made.triangles, &made.surfaces, &made.curves),
            (&kept.triangles, &kept.surfaces, &kept.curves)
        );
        // Sines and cosines differ in the last bit between machines.
        let furthest = made
            .vertices
            .iter()
            .zip(&kept.vertices)
            .map(|(p, q)| (p - q).norm());
        assert!(
            made.vertices.len() == kept.vertices.len() && furthest.fold(0.0, f64::max) < 1e-14
        );
    }

    #[test]
    fn options_reach_the_shape() {
        let half = wing(&["--half", "--sweep-deg", "-10", "--tip", "sharp", "out.msh"])
            .mesh()
            .unwrap();
        assert!(half.vertices.iter().all(|p| p.y >= 0.0));
        assert!(half.vertices.iter().any(|p| p.x < 0.0));
        let irregular = wing(&["--unstructured", "7", "out.msh"]).mesh().unwrap();
        assert_ne!(irregular, wing(&["out.msh"]).mesh().unwrap());
        assert!(wing(&["--thickness", "0", "out.msh"]).mesh().is_err());
    }

    #[test]
    fn a_written_sphere_is_read_back() {
        let out =
            std::env::temp_dir().join(format!("fladder-sphere-{}.msh", std::process::id()));
        let said = Shape::Sphere {
            radius: 2.0,
            cut: Cut {
                n: 3,
                out: out.clone(),
            },
        }
        .write()
        .unwrap();
        assert!(said.contains("92 vertices, 180 triangles"), "{said}");
        let back = read_mesh(&out, 1.0).unwrap();
        std::fs::remove_file(&out).unwrap();
        assert_eq!(back, ellipsoid([2.0; 3], 3));
    }
}
