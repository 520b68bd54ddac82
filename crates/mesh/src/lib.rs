//! Triangle meshes of wetted surfaces: read, judge, and find the edges a wake leaves from.

mod surface;

pub use surface::{CurveGroup, Frame, SurfaceGroup, SurfaceMode, TriMesh, Vec3};
