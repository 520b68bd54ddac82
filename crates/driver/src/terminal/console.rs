//! Text to standard output, warnings to standard error.
//!
//! A reader that went away (`fladder … | head`) is no error: the program goes
//! on without it, because its files are wanted all the same.

use crate::failure::Failure;
use std::cell::RefCell;
use std::io::{self, Write};
use std::path::Path;

/// Standard output and error.
#[derive(Debug, Default)]
pub(crate) struct Console {
    is_quiet: bool,
    failure: RefCell<Option<io::Error>>,
}

impl Console {
    pub(crate) fn new(is_quiet: bool) -> Self {
        Self {
            is_quiet,
            failure: RefCell::default(),
        }
    }

    pub(crate) fn is_quiet(&self) -> bool {
        self.is_quiet
    }

    /// A line that `--quiet` suppresses.
    pub(crate) fn say(&self, text: impl AsRef<str>) {
        if !self.is_quiet {
            self.answer(text);
        }
    }

    /// A line that was asked for.
    pub(crate) fn answer(&self, text: impl AsRef<str>) {
        if self.failure.borrow().is_some() {
            return;
        }
        let mut output = io::stdout().lock();
        let text = text.as_ref().trim_end_matches('\n');
        if let Err(error) = writeln!(output, "{text}").and_then(|()| output.flush()) {
            *self.failure.borrow_mut() = Some(error);
        }
    }

    /// Remarks, one line each.
    pub(crate) fn notes<'a>(&self, notes: impl IntoIterator<Item = &'a String>) {
        notes
            .into_iter()
            .for_each(|note| self.say(format!("  note: {note}")));
    }

    /// Whether everything could be written.
    pub(crate) fn finish(&self) -> Result<(), Failure> {
        match self.failure.borrow_mut().take() {
            Some(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::io(
                "write to standard output",
                Path::new("standard output"),
                &error,
            )),
            _ => Ok(()),
        }
    }
}

/// Something the user should know though the run goes on.
pub(crate) fn warn(text: impl AsRef<str>) {
    // Where standard error is closed there is nobody to tell.
    let _ = writeln!(io::stderr().lock(), "warning: {}", text.as_ref());
}
