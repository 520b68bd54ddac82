//! The smooth $Q(p)$ on which roots are refined.

use fladder_stability::{GafTable, RationalFit};

/// Misfit, as a part of the largest entry, above which a rational model of all
/// samples is held against one of the imaginary axis alone. Forces with a
/// strong branch cut, as those of a section, have samples beside the cut that
/// no few poles can follow; flutter is decided on the axis.
const WORTH_COMPARING: f64 = 1e-4;

/// How much smaller the misfit on the axis must be to be preferred.
const CLEARLY_BETTER: f64 = 0.1;

/// A rational model, and what the user should know of it.
///
/// # Errors
/// A sentence about a decomposition that failed.
pub(crate) fn smooth(table: &GafTable) -> Result<(RationalFit, Vec<String>), String> {
    let whole = RationalFit::new(table).map_err(|error| error.to_string())?;
    let mut notes = whole.notes().to_vec();
    if table.g().len() == 1 || whole.residual() <= WORTH_COMPARING {
        return Ok((whole, notes));
    }
    let axis = RationalFit::new(&table.axis_alone()).ok();
    match axis.filter(|axis| axis.residual() < CLEARLY_BETTER * whole.residual()) {
        Some(axis) => {
            notes = axis.notes().to_vec();
            notes.push(format!(
                "roots are refined on a rational model of the samples at g = 0 (misfit {:.1e}); one \
                 of all samples misfits by {:.1e}",
                axis.residual(),
                whole.residual()
            ));
            Ok((axis, notes))
        }
        None => Ok((whole, notes)),
    }
}
