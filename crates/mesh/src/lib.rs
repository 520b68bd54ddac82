//! Triangle meshes of wetted surfaces: read, judge, and find the edges a wake leaves from.

pub mod bulk;
pub mod judge;
pub mod read;
pub mod shapes;
mod surface;
mod symmetry;
mod topology;
pub mod trailing_edge;
pub mod vtu;
pub mod weld;
pub mod write;

pub use surface::{CurveGroup, Frame, SurfaceGroup, SurfaceMode, TriMesh, Vec3};
pub use symmetry::{Symmetry, mirrored};
pub use topology::Topology;
pub use trailing_edge::TrailingEdge;
