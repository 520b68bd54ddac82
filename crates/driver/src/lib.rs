//! The program `fladder`: case files, the store of aerodynamic results,
//! progress, reports, and the command line.
//!
//! | module | idea |
//! |---|---|
//! | [`case`] | the case file, its overrides and its checks |
//! | [`cache`] | content-addressed store, hashed before it is decoded |
//! | [`gaf_json`], [`json`] | exchange files |
//! | [`plot`] | root locus, V-g-f diagram and mode shapes as SVG |
//! | [`study`] | forces of a case once, then Q, fits and sweeps for another program |
//! | [`failure`] | what every message says: what, where, why, what to do |
//! | [`cli`] | commands and exit codes |

pub mod atmosphere;
pub mod cache;
pub mod case;
mod chain;
pub mod cli;
mod commands;
mod export;
pub mod failure;
mod figures;
pub mod files;
pub mod gaf_json;
pub mod json;
mod memory;
pub mod plot;
mod report;
pub mod study;
mod terminal;
