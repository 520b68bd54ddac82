//! What went wrong, in the four parts every message of the program has.

use std::fmt;

/// Exit codes of the program.
pub mod exit {
    /// Done; an unstable aircraft is a result, not an error.
    pub const DONE: u8 = 0;
    /// Bad input or usage.
    pub const INPUT: u8 = 2;
    /// Numerical failure, or a panic that was caught.
    pub const NUMERICAL: u8 = 3;
    /// Input or output failed.
    pub const IO: u8 = 4;
    /// Stopped by the user.
    pub const INTERRUPTED: u8 = 130;
}

/// Who has to act.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// The user's input.
    Input,
    /// The numbers.
    Numerical,
    /// The file system.
    Io,
    /// The user stopped the program.
    Interrupted,
}

/// A failure: what, where, why it matters, what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// Decides the exit code.
    pub kind: Kind,
    /// One sentence that names the fault.
    pub what: String,
    /// File and line, element or option.
    pub place: String,
    /// What would go wrong if it were ignored.
    pub why: String,
    /// The next step.
    pub remedy: String,
}

impl Failure {
    /// A fault in what the user gave.
    pub fn input(
        what: impl Into<String>,
        place: impl Into<String>,
        why: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self::of(Kind::Input, what, place, why, remedy)
    }

    /// A computation that did not succeed.
    pub fn numerical(
        what: impl Into<String>,
        place: impl Into<String>,
        why: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self::of(Kind::Numerical, what, place, why, remedy)
    }

    /// A file that could not be read or written.
    pub fn io(operation: &str, path: &std::path::Path, error: &std::io::Error) -> Self {
        Self::of(
            Kind::Io,
            format!("could not {operation}: {error}"),
            path.display().to_string(),
            "the result would be incomplete",
            "check the folder, its permissions and the free space, then repeat the command",
        )
    }

    /// The user stopped the program.
    pub fn interrupted(stage: &str) -> Self {
        Self::of(
            Kind::Interrupted,
            format!("interrupted while {stage}"),
            "the running computation",
            "what was not finished is lost; finished entries of the cache stay",
            "repeat the same command to go on",
        )
    }

    fn of(
        kind: Kind,
        what: impl Into<String>,
        place: impl Into<String>,
        why: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            kind,
            what: what.into(),
            place: place.into(),
            why: why.into(),
            remedy: remedy.into(),
        }
    }

    /// Exit code of the program that ends with this failure.
    pub fn exit_code(&self) -> u8 {
        match self.kind {
            Kind::Input => exit::INPUT,
            Kind::Numerical => exit::NUMERICAL,
            Kind::Io => exit::IO,
            Kind::Interrupted => exit::INTERRUPTED,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [
            ("error:", &self.what),
            ("  where:", &self.place),
            ("  why:  ", &self.why),
            ("  do:   ", &self.remedy),
        ];
        for (label, text) in parts {
            let mut lines = text.lines();
            writeln!(f, "{label} {}", lines.next().unwrap_or_default())?;
            for line in lines {
                writeln!(f, "         {line}")?;
            }
        }
        Ok(())
    }
}

impl std::error::Error for Failure {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_has_four_parts_and_keeps_further_lines_aligned() {
        let failure = Failure::input("two\nlines", "case.toml:3", "because", "write it");
        assert_eq!(
            failure.to_string(),
            "error: two\n         lines\n  where: case.toml:3\n  why:   because\n  do:    write it\n"
        );
        assert_eq!(failure.exit_code(), 2);
    }
}
