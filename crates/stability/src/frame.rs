//! Rigid columns of $Q$ from the inertial to the body frame.
//!
//! A rigid rotation in axes that travel with $U$ and do not turn carries an
//! incidence that the body quasi-coordinates count elsewhere
//! ($z_b = z_I - (U/s)\theta$, $y_b = y_I + (U/s)\psi$ at $\alpha = 0$):
//!
//! $$ Q_{\theta,b} = Q_{\theta,I} - \frac bp(\sin\alpha\,Q_x - \cos\alpha\,Q_z),\quad
//!    Q_{\psi,b} = Q_{\psi,I} - \frac bp\cos\alpha\,Q_y,\quad
//!    Q_{\varphi,b} = Q_{\varphi,I} + \frac bp\sin\alpha\,Q_y $$
//!
//! in metres and radians; with mass-normalised columns the second terms carry
//! $\sqrt{m/I}$. In the body frame the loads of a displacement at rest vanish:
//! $Q_b(0) = 0$ exactly. Whether the given columns fit together is seen from
//! $Q_{\theta,I}(0) = -b\,\mathrm dQ_z/\mathrm dp(0)$ and its like.

use faer::c64;

use crate::gaf::GafTable;
use crate::linalg::largest;
use crate::p2::{DEFAULT_DAMPING_LIMIT, FitError, PiecewiseQuadratic};
use crate::rigid::{RIGID_NAMES, RigidBody, RigidModes};

/// Axes in which a mode is a displacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// Axes that travel with $U$ and do not turn.
    Inertial,
    /// Body quasi-coordinates.
    Body,
}

/// Why columns could not be converted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameError {
    /// The list of frames has another length than the modes.
    #[error("{frames} frames are given for {modes} modes")]
    Count {
        /// Frames given.
        frames: usize,
        /// Number of modes.
        modes: usize,
    },
    /// A translation that the conversion needs is not among the modes.
    #[error(
        "{mode} is given in the inertial frame; its conversion needs {needs}, which is missing"
    )]
    Missing {
        /// The rotation.
        mode: &'static str,
        /// The translation.
        needs: &'static str,
    },
    /// The slopes at the origin could not be found.
    #[error(transparent)]
    Fit(#[from] FitError),
}

/// A mismatch at rest above this fraction of the column is said.
const MISMATCH: f64 = 1e-3;

/// One rotation to convert and what is added to its column.
struct Conversion {
    column: usize,
    name: &'static str,
    /// Translation columns with their factors on $b/p$.
    terms: Vec<(usize, f64)>,
}

/// Converts the rigid columns given in the inertial frame, and makes all rigid
/// columns exactly zero at $p = 0$.
///
/// `alpha` is the incidence in radians. The columns are mass-normalised.
///
/// # Errors
/// See [`FrameError`].
pub fn to_body_frame(
    mut table: GafTable,
    frames: &[Frame],
    body: &RigidBody,
    alpha: f64,
) -> Result<GafTable, FrameError> {
    let modes = table.order();
    if frames.len() != modes {
        return Err(FrameError::Count {
            frames: frames.len(),
            modes,
        });
    }
    let rigid = RigidModes::among(table.modes());
    let conversions = conversions(&rigid, frames, body, alpha)?;
    let semichord = table.semichord();
    let has_rest = table.k()[0] == 0.0;
    if has_rest && !conversions.is_empty() {
        say_mismatch(&mut table, &conversions)?;
    }
    let columns = rigid.numbers();
    table.change(|p, q| {
        if p.norm() == 0.0 {
            for &column in &columns {
                (0..modes).for_each(|row| q[(row, column)] = c64::new(0.0, 0.0));
            }
            return;
        }
        for conversion in &conversions {
            for &(from, factor) in &conversion.terms {
                for row in 0..modes {
                    let added = q[(row, from)] * factor * semichord / p;
                    q[(row, conversion.column)] += added;
                }
            }
        }
    });
    Ok(table)
}

fn conversions(
    rigid: &RigidModes,
    frames: &[Frame],
    body: &RigidBody,
    alpha: f64,
) -> Result<Vec<Conversion>, FrameError> {
    let (sin, cos) = alpha.sin_cos();
    let scales = body.scales();
    let wanted: [(usize, [(usize, f64); 2]); 3] = [
        (3, [(1, sin), (1, 0.0)]),
        (4, [(0, -sin), (2, cos)]),
        (5, [(1, -cos), (1, 0.0)]),
    ];
    let mut found = Vec::new();
    for (rotation, terms) in wanted {
        let Some(column) = rigid.0[rotation] else {
            continue;
        };
        if frames[column] == Frame::Body {
            continue;
        }
        let mut listed = Vec::new();
        for (translation, factor) in terms.into_iter().filter(|(_, factor)| *factor != 0.0) {
            let from = rigid.0[translation].ok_or(FrameError::Missing {
                mode: RIGID_NAMES[rotation],
                needs: RIGID_NAMES[translation],
            })?;
            listed.push((from, factor * scales[rotation] / scales[translation]));
        }
        found.push(Conversion {
            column,
            name: RIGID_NAMES[rotation],
            terms: listed,
        });
    }
    Ok(found)
}

/// Compares the column at rest with the slopes of the translations.
fn say_mismatch(table: &mut GafTable, conversions: &[Conversion]) -> Result<(), FrameError> {
    let fit = PiecewiseQuadratic::centred(table, DEFAULT_DAMPING_LIMIT)?;
    for conversion in conversions {
        let mut worst: f64 = 0.0;
        let mut scale = f64::MIN_POSITIVE;
        if let Some(at_rest) = table.axis().next() {
            scale = scale.max(largest(at_rest.subcols(conversion.column, 1)));
            for row in 0..table.order() {
                let expected: f64 = conversion
                    .terms
                    .iter()
                    .map(|&(from, factor)| {
                        -factor * table.semichord() * fit.slope_at_origin(row, from)
                    })
                    .sum();
                worst = worst.max((at_rest[(row, conversion.column)].re - expected).abs());
            }
        }
        if worst > MISMATCH * scale {
            table.note(format!(
                "{} at rest differs from the slope of the translations by {:.1e} of its \
                 largest entry: its frame or its normalisation may not be as stated",
                conversion.name,
                worst / scale
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gaf::GafPoint;
    use faer::Mat;

    const BODY: RigidBody = RigidBody {
        mass: 9.0,
        ixx: 2.0,
        iyy: 4.0,
        izz: 5.0,
        ixz: 0.1,
    };

    /// Columns built in the body frame, moved to the inertial frame by the
    /// formulae of the head at incidence 0.1, come back; with the factors
    /// written out once more by hand.
    #[test]
    fn conversion_inverts_the_formulae() {
        let (semichord, alpha) = (0.3, 0.1_f64);
        let modes: Vec<String> = RIGID_NAMES.iter().map(ToString::to_string).collect();
        let body_q = |p: c64| {
            Mat::from_fn(6, 6, |i, j| {
                let (a, b) = ((i + 2 * j) as f64 - 3.0, (i * j) as f64 - 4.0);
                p * a + p * p * b
            })
        };
        let (m, ixx, iyy, izz) = (BODY.mass, BODY.ixx, BODY.iyy, BODY.izz);
        let inertial = |k: f64| {
            let p = c64::new(0.0, k);
            let slope = |q: &Mat<c64>, i: usize, j: usize| {
                if k == 0.0 {
                    c64::new((i + 2 * j) as f64 - 3.0, 0.0)
                } else {
                    q[(i, j)] / p
                }
            };
            let body = body_q(p);
            Mat::from_fn(6, 6, |i, j| {
                let along = |column| slope(&body, i, column) * semichord;
                body[(i, j)]
                    + match j {
                        3 => along(1) * -alpha.sin() * (m / ixx).sqrt(),
                        4 => {
                            (along(0) * alpha.sin() - along(2) * alpha.cos()) * (m / iyy).sqrt()
                        }
                        5 => along(1) * alpha.cos() * (m / izz).sqrt(),
                        _ => c64::new(0.0, 0.0),
                    }
            })
        };
        let points: Vec<GafPoint> = [0.0, 0.1, 0.2, 0.4, 0.8]
            .map(|k| GafPoint {
                g: 0.0,
                k,
                q: inertial(k),
            })
            .into();
        let table = GafTable::new(semichord, 0.0, modes, points, vec![]).unwrap();
        let table = to_body_frame(table, &[Frame::Inertial; 6], &BODY, alpha).unwrap();
        assert!(table.notes().is_empty(), "{:?}", table.notes());
        for (q, &k) in table.axis().zip(table.k()) {
            let error = largest((q - body_q(c64::new(0.0, k))).as_ref());
            assert!(error < 1e-13, "k = {k}: {error}");
        }
    }
}
