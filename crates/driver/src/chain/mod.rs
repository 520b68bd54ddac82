//! From a case to roots: surface, modes, forces, sweep.

pub(crate) mod aircraft;
pub(crate) mod conditions;
pub(crate) mod control;
pub(crate) mod derivatives;
pub(crate) mod exact;
pub(crate) mod forces;
mod given;
mod level;
pub(crate) mod own_forces;
pub(crate) mod smooth;
pub(crate) mod structure;
mod structure_edits;
pub(crate) mod surface;
pub(crate) mod surrogate;
pub(crate) mod sweep;
mod trim;
