//! What is printed and written about inputs and results.

mod csv;
mod curves;
mod date;
mod derivatives;
mod flight;
mod forces;
mod inputs;
mod mode_pictures;
mod page;
mod pictures;
mod roots;
mod structure;
mod surface;
mod wake;

pub(crate) use csv::{counts_csv, crossings_csv, roots_csv};
pub(crate) use curves::{fit_picture, jump_picture};
pub(crate) use date::utc;
pub(crate) use derivatives::{derivatives, derivatives_csv, document as derivatives_document};
pub(crate) use flight::flight_csv;
pub(crate) use forces::{facts, own_forces, sample, steady_forces, wake_jumps};
pub(crate) use inputs::inputs;
pub(crate) use mode_pictures::{
    Motion, Named, Shown, flutter_motions, mode_motions, mode_pictures, picture_file, stills,
    structure_picture, surface_picture,
};
pub(crate) use page::{Page, Wetted, page};
pub(crate) use pictures::{EdgeEnd, ends, flow_pictures, pictures};
pub(crate) use roots::{best, conditions, roots};
pub(crate) use structure::{modes_of_case, modes_summary, structure, transfer};
pub(crate) use surface::surface;
pub(crate) use wake::wake;
