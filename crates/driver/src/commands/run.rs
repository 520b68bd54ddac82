//! `fladder run` and `fladder report`: into a report folder.

use super::Session;
use super::results::{Forcing, results};
use crate::cli::Method;
use crate::failure::Failure;
use std::path::Path;

/// The whole chain; forces are computed where the cache has none.
pub(crate) fn run(session: &Session, path: &Path, method: Method) -> Result<(), Failure> {
    results(session, path, method, Forcing::Computed)
}

/// The report folder again, from stored forces: nothing long is computed.
pub(crate) fn report(session: &Session, path: &Path, method: Method) -> Result<(), Failure> {
    results(session, path, method, Forcing::Stored)
}
