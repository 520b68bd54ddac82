//! The program `fladder`: case files, the store of aerodynamic results,
//! progress, reports, and the command line.

pub mod atmosphere;
pub mod cache;
pub mod case;
pub mod failure;
pub mod files;
pub mod gaf_json;
pub mod json;
pub mod plot;
