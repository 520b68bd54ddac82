//! Files of Nastran and of programs that write like it.
//!
//! Geometry comes from bulk data ([`bulk`]) or from the tables of an `.op2`
//! file; modes from a punch file ([`pch`]), the printed file ([`f06`]), an
//! `.op2` file or matrices in an `.op4` file. Displacements are in each node's
//! own frame (field CD of `GRID`), which only the geometry knows.

pub(crate) mod bulk;
pub(crate) mod f06;
mod model;
pub(crate) mod op2;
mod op2_geometry;
mod op2_tables;
pub(crate) mod op4;
mod op4_ascii;
mod op4_binary;
pub(crate) mod op4_modes;
pub(crate) mod pch;
