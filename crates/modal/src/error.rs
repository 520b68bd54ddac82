//! What can be wrong with a result file.

use std::io;

/// A result or geometry file that cannot be taken.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The operating system refused.
    #[error("{file} cannot be read: {source}")]
    Io {
        /// File as given.
        file: String,
        /// Reason of the operating system.
        source: io::Error,
    },
    /// The first line belongs to no format known here.
    #[error(
        "{file} begins with {start:?}, which is no modal result known here \
         (calculix-frd, fladder-json)"
    )]
    UnknownFormat {
        /// File as given.
        file: String,
        /// Start of its first line.
        start: String,
    },
    /// The file ends before it is complete.
    #[error("{file} is cut short after line {line}: {missing} is missing")]
    Truncated {
        /// File as given.
        file: String,
        /// Last line read.
        line: usize,
        /// What should have come.
        missing: String,
    },
    /// A line that cannot be understood.
    #[error("{file}, line {line}: {message}")]
    Syntax {
        /// File as given.
        file: String,
        /// Line, counted from 1.
        line: usize,
        /// What is wrong with it.
        message: String,
    },
    /// A header announces another number of records than follow.
    #[error("{file}, line {line}: {found} {what} where the header states {stated}")]
    Count {
        /// File as given.
        file: String,
        /// Last line of the block.
        line: usize,
        /// Kind of record.
        what: &'static str,
        /// Records found.
        found: usize,
        /// Records announced.
        stated: usize,
    },
    /// Something that is understood and not handled.
    #[error("{file}: {what}")]
    Unsupported {
        /// File as given.
        file: String,
        /// What it is, and what to do.
        what: String,
    },
    /// Parts that do not belong together.
    #[error("{file}: {message}")]
    Mismatch {
        /// File as given.
        file: String,
        /// What contradicts what, with the measured size.
        message: String,
    },
}
