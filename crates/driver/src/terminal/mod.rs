//! What people see while the program runs.

mod console;
mod interrupt;
mod progress;
mod table;

pub(crate) use console::{Console, warn};
pub(crate) use interrupt::watch as watch_for_interrupts;
pub(crate) use progress::{Bar, Effort};
pub(crate) use table::{Align, Table};
