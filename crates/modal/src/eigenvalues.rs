//! A table of eigenvalues apart from the shapes, and how it joins them.

use crate::error::ReadError;
use crate::raw::ModeTable;
use serde::Serialize;
use std::f64::consts::TAU;
use std::path::Path;

/// Relative difference between two prints of one eigenvalue: seven digits, and
/// single precision in between.
const TOLERANCE: f64 = 2e-6;

/// One real eigenvalue.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Eigenvalue {
    /// Number of the mode.
    pub mode: u32,
    /// λ = ω² in (rad/s)².
    pub lambda: f64,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Generalised mass.
    pub generalised_mass: f64,
    /// Generalised stiffness.
    pub generalised_stiffness: f64,
}

/// Frequency in Hz of an eigenvalue; zero where rounding made it negative.
pub(crate) fn frequency_of(lambda: f64) -> f64 {
    lambda.max(0.0).sqrt() / TAU
}

/// Gives modes the masses and frequencies of a table of the same run.
///
/// Tables come once a subcase or an analysis: of several rows with the number
/// of a mode the one with its eigenvalue counts.
///
/// # Errors
/// [`ReadError::Mismatch`] for a mode whose eigenvalue no row has.
pub(crate) fn join(
    table: &mut ModeTable,
    rows: &[Eigenvalue],
    file: &Path,
) -> Result<(), ReadError> {
    if rows.is_empty() {
        return Ok(());
    }
    // Rigid modes differ by rounding alone: the largest one sets the scale.
    let largest = rows.iter().map(|row| row.lambda.abs()).fold(0.0, f64::max);
    for mode in &mut table.modes {
        let lambda = mode.eigenvalue.unwrap_or((TAU * mode.frequency_hz).powi(2));
        let near = |row: &&Eigenvalue| {
            row.mode == mode.index
                && (row.lambda - lambda).abs() <= TOLERANCE * lambda.abs() + 1e-9 * largest
        };
        let Some(row) = rows.iter().rfind(near) else {
            return Err(ReadError::Mismatch {
                file: file.display().to_string(),
                message: format!(
                    "no row of the table of eigenvalues is mode {} with λ = {lambda:e}: shapes \
                     and eigenvalues are of different runs",
                    mode.index
                ),
            });
        };
        mode.eigenvalue = Some(row.lambda);
        mode.frequency_hz = row.frequency_hz;
        mode.generalised_mass = Some(row.generalised_mass);
    }
    Ok(())
}
