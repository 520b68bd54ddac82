//! The eigenvalue table of a CalculiX `.dat` file.
//!
//! Columns: mode, eigenvalue λ, ω, f, and the imaginary part √−λ, which alone
//! is non-zero where λ is negative. Seven digits, against six in the `.frd`
//! file. The participation factors of the translations are kept; those of the
//! rotations are not, because they include the rotations of reference nodes and
//! are off by about one part in a hundred.

use crate::error::ReadError;
use crate::raw::ModeTable;
use crate::text::{Lines, real};
use fladder_mesh::Vec3;
use std::path::Path;

/// Relative difference between the frequencies of `.frd` (six digits) and
/// `.dat` above which the files belong to different runs, and the absolute one,
/// in Hz, that rigid modes near zero are allowed.
const FREQUENCY_TOLERANCE: (f64, f64) = (2e-5, 1e-4);

/// One row of the eigenvalue table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Eigenvalue {
    pub(crate) mode: u32,
    pub(crate) lambda: f64,
    pub(crate) frequency_hz: f64,
}

/// Both tables of a `.dat` file.
#[derive(Debug, Default)]
pub(crate) struct Tables {
    pub(crate) eigenvalues: Vec<Eigenvalue>,
    pub(crate) participation: Vec<(u32, Vec3)>,
}

/// Reads the tables; the last ones where a file has several.
pub(crate) fn read(path: &Path) -> Result<Tables, ReadError> {
    let mut lines = Lines::open(path)?;
    let mut tables = Tables::default();
    while let Some(line) = lines.next_line()? {
        match line.trim() {
            "E I G E N V A L U E   O U T P U T" => {
                tables.eigenvalues.clear();
                for (mode, row) in rows::<4>(&mut lines)? {
                    let [lambda, _, frequency_hz, _] = row;
                    tables.eigenvalues.push(Eigenvalue {
                        mode,
                        lambda,
                        frequency_hz,
                    });
                }
            }
            "P A R T I C I P A T I O N   F A C T O R S" => {
                let table = rows::<6>(&mut lines)?;
                tables.participation = table
                    .into_iter()
                    .map(|(mode, row)| (mode, Vec3::new(row[0], row[1], row[2])))
                    .collect();
            }
            _ => {}
        }
    }
    if tables.eigenvalues.is_empty() {
        return Err(lines.truncated("the table of eigenvalues"));
    }
    Ok(tables)
}

/// Rows of a mode number and `N` reals; the heading before them is skipped.
fn rows<const N: usize>(lines: &mut Lines) -> Result<Vec<(u32, [f64; N])>, ReadError> {
    let mut rows = Vec::new();
    while let Some(line) = lines.next_line()? {
        let mut words = line.split_whitespace();
        let Some(mode) = words.next().and_then(|word| word.parse().ok()) else {
            if rows.is_empty() && !line.contains("O U T P U T") {
                continue;
            }
            lines.step_back();
            return Ok(rows);
        };
        let values: Vec<Option<f64>> = words.map(real).collect();
        let values: Option<Vec<f64>> = values.into_iter().collect();
        match values.and_then(|values| <[f64; N]>::try_from(values).ok()) {
            Some(values) => rows.push((mode, values)),
            None => {
                return Err(lines.syntax(format!("a mode number and {N} numbers are needed")));
            }
        }
    }
    Ok(rows)
}

/// Replaces the six-digit frequencies of the `.frd` file.
///
/// # Errors
/// [`ReadError::Mismatch`] when the two files are not of the same run.
pub(crate) fn refine(
    table: &mut ModeTable,
    tables: &Tables,
    file: &Path,
) -> Result<(), ReadError> {
    let mismatch = |message| ReadError::Mismatch {
        file: file.display().to_string(),
        message,
    };
    let (found, wanted) = (tables.eigenvalues.len(), table.modes.len());
    if found != wanted {
        return Err(mismatch(format!(
            "{found} eigenvalues, but the result file has {wanted} modes: they are of \
             different runs"
        )));
    }
    for (mode, row) in table.modes.iter_mut().zip(&tables.eigenvalues) {
        let (relative, absolute) = FREQUENCY_TOLERANCE;
        let difference = (mode.frequency_hz - row.frequency_hz).abs();
        if mode.index != row.mode || difference > relative * row.frequency_hz + absolute {
            return Err(mismatch(format!(
                "mode {} has {} Hz, but mode {} of the result file has {} Hz: they are of \
                 different runs",
                row.mode, row.frequency_hz, mode.index, mode.frequency_hz
            )));
        }
        mode.frequency_hz = row.frequency_hz;
        mode.eigenvalue = Some(row.lambda);
        let participation = tables
            .participation
            .iter()
            .find(|entry| entry.0 == row.mode);
        mode.participation = participation.map(|entry| entry.1);
    }
    Ok(())
}
