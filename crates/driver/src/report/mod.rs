//! What is printed and written about inputs and results.

mod csv;
mod date;
mod derivatives;
mod forces;
mod mode_pictures;
mod pictures;
mod roots;
mod structure;
mod surface;
mod wake;

pub(crate) use csv::roots_csv;
pub(crate) use date::utc;
pub(crate) use derivatives::{derivatives, derivatives_csv, document as derivatives_document};
pub(crate) use forces::{own_forces, sample, steady_forces, wake_jumps};
pub(crate) use mode_pictures::{Shown, mode_pictures, structure_picture, surface_picture};
pub(crate) use pictures::{EdgeEnd, ends, flow_pictures, pictures};
pub(crate) use roots::{conditions, roots};
pub(crate) use structure::{modes_of_case, modes_summary, structure, transfer};
pub(crate) use surface::surface;
pub(crate) use wake::wake;
