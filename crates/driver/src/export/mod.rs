//! Results for other programs: NumPy archives, OUTPUT4, a flutter summary, ParaView.

mod npz;
mod op4;
mod paraview;
mod summary;

pub(crate) use npz::{forces, states};
pub(crate) use op4::op4;
pub(crate) use paraview::{FRAMES, collection, frame};
pub(crate) use summary::summary;
