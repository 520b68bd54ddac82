//! The store of aerodynamic results.
//!
//! *An entry is either exactly what some run computed from exactly these
//! inputs, or it is not there.* Content addressed by BLAKE3; every entry is
//! hashed whole before any of it is decoded; entries appear by renaming a file
//! that was synchronised before, never by writing in place.

mod codec;
mod entry;
mod key;
mod store;

pub use entry::Fault;
pub use key::{Key, KeyBuilder};
pub use store::{Cache, Listed, Loaded, Stored};
