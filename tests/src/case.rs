//! One way to pose a problem, and what can go wrong.

use fladder_bem::{BemError, Flow, LaplaceError, Problem, Silent, Solution, Solver, solve};
use fladder_mesh::shapes::ShapeError;
use fladder_mesh::{
    CurveGroup, Frame, SurfaceMode, Topology, TrailingEdge, TriMesh, Vec3, trailing_edge,
};

/// Why a figure could not be had.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// A reference file without what is asked of it.
    #[error("reference file {file}: {what}")]
    Reference {
        /// Its name.
        file: String,
        /// What is wrong.
        what: String,
    },
    /// A shape that cannot be built.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// A mesh that cannot be read.
    #[error(transparent)]
    Mesh(#[from] fladder_mesh::read::ReadError),
    /// A surface the solver refuses.
    #[error(transparent)]
    Solver(#[from] BemError),
    /// A point of the Laplace plane the transfer model refuses.
    #[error(transparent)]
    Laplace(#[from] LaplaceError),
    /// Modes that cannot be read.
    #[error(transparent)]
    Structure(#[from] fladder_modal::StructureError),
    /// Modes that do not fit the surface.
    #[error(transparent)]
    Transfer(#[from] fladder_modal::TransferError),
    /// Matrices or samples that make no eigenproblem.
    #[error("stability: {0}")]
    Stability(String),
    /// A surface that is not what the case needs.
    #[error("{0}")]
    Surface(String),
    /// A file of figures that cannot be read or written.
    #[error("{path}: {what}")]
    Figures {
        /// The file.
        path: String,
        /// What is wrong.
        what: String,
    },
}

/// A surface with its modes and stream.
#[derive(Clone, Debug)]
pub struct Setup<'a> {
    /// Closed surface.
    pub mesh: &'a TriMesh,
    /// Rows and columns of Q.
    pub modes: &'a [SurfaceMode],
    /// Incidence.
    pub flow: Flow,
    /// Reference semichord, m.
    pub semichord: f64,
    /// Where wakes leave; sought by shape where not given.
    pub trailing_edges: Option<&'a [TrailingEdge]>,
    /// Curve groups along which the wake's inner edge lies on a body; they begin with this.
    pub body_lines: Option<&'a str>,
    /// Moments are taken about this point, m.
    pub moment_point: Vec3,
}

impl<'a> Setup<'a> {
    /// No incidence, b = 1, a wake from every edge that looks like a trailing edge.
    pub fn new(mesh: &'a TriMesh, modes: &'a [SurfaceMode]) -> Self {
        Self {
            mesh,
            modes,
            flow: Flow::default(),
            semichord: 1.0,
            trailing_edges: None,
            body_lines: None,
            moment_point: Vec3::zeros(),
        }
    }

    /// The solution.
    ///
    /// # Errors
    /// What the solver refuses.
    pub fn solve(&self) -> Result<Solution, Fault> {
        let found = match self.trailing_edges {
            Some(given) => given.to_vec(),
            None => edges(self.mesh),
        };
        let is_line = |curve: &&CurveGroup| {
            self.body_lines
                .is_some_and(|prefix| curve.name.starts_with(prefix))
        };
        let body_lines: Vec<[u32; 2]> = self
            .mesh
            .curves
            .iter()
            .filter(is_line)
            .flat_map(|curve| curve.edges.iter().copied())
            .collect();
        let problem = Problem {
            flow: self.flow,
            body_lines: &body_lines,
            moment_point: self.moment_point,
            solver: Solver::automatic(self.mesh.vertices.len()),
            ..Problem::new(self.mesh, &found, self.modes, self.semichord)
        };
        Ok(solve(&problem, &Silent)?)
    }
}

/// Trailing edges by shape with the default settings.
pub fn edges(mesh: &TriMesh) -> Vec<TrailingEdge> {
    trailing_edge::find_by_shape(
        mesh,
        &Topology::new(mesh),
        trailing_edge::Settings::default(),
    )
}

/// A mode given by a field.
pub fn mode(
    mesh: &TriMesh,
    name: &str,
    frame: Frame,
    field: impl Fn(&Vec3) -> Vec3,
) -> SurfaceMode {
    SurfaceMode {
        name: name.into(),
        frame,
        displacement: mesh.vertices.iter().map(field).collect(),
    }
}

/// Unit translations and right-handed unit rotations about `centre`.
pub fn rigid_modes(mesh: &TriMesh, frame: Frame, centre: Vec3) -> Vec<SurfaceMode> {
    fladder_stability::RIGID_NAMES
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let mut axis = Vec3::zeros();
            axis[i % 3] = 1.0;
            mode(mesh, name, frame, move |x| {
                if i < 3 {
                    axis
                } else {
                    axis.cross(&(x - centre))
                }
            })
        })
        .collect()
}
