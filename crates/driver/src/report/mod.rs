//! What is printed and written about inputs and results.

mod csv;
mod date;
mod forces;
mod roots;
mod structure;
mod surface;

pub(crate) use csv::roots_csv;
pub(crate) use date::utc;
pub(crate) use forces::{own_forces, sample, wake_jumps};
pub(crate) use roots::{conditions, roots};
pub(crate) use structure::{modes_summary, structure, transfer};
pub(crate) use surface::surface;
