//! What is odd about a set of modes: written twice, left out, not normalised.
//!
//! Two shapes are compared by the modal assurance criterion,
//!
//! $$ \mathrm{MAC} = \frac{(\varphi_i^T\varphi_j)^2}
//!    {(\varphi_i^T\varphi_i)(\varphi_j^T\varphi_j)} $$
//!
//! (Allemang & Brown 1982), over all nodes alike: it is one for two writings of
//! one shape, whatever their scale.

use crate::read::ranges;
use crate::result::{ModalResult, Mode};
use crate::rigid_fit::RigidSurvey;

/// Frequencies closer than this, relative, are those of a double root.
const SAME_FREQUENCY: f64 = 1e-4;

/// Shapes above this are one shape.
const SAME_SHAPE: f64 = 0.999;

/// Generalised masses farther from one than this, relative, ask for scaling:
/// printed digits leave less.
const NORMALISED: f64 = 1e-5;

/// Rigid modes above this share of the lowest elastic frequency stand on springs
/// that are worth a word; free ones are at the round-off of the eigensolver.
const FREE: f64 = 0.02;

/// One sentence for each oddity.
pub(crate) fn remarks(result: &ModalResult, survey: &RigidSurvey) -> Vec<String> {
    let elastic: Vec<&Mode> = result
        .modes
        .iter()
        .zip(&survey.fits)
        .filter(|(_, fit)| !fit.rigid)
        .map(|(mode, _)| mode)
        .collect();
    let mut remarks = Vec::new();
    remarks.extend(missing(result));
    remarks.extend(unnormalised(&elastic));
    remarks.extend(repeated(&elastic));
    remarks.extend(supported(result, survey, &elastic));
    let measured = elastic
        .iter()
        .filter(|mode| mode.participation.is_some())
        .count();
    if measured < elastic.len() {
        remarks.push(format!(
            "orthogonality to rigid motion is not known of {} elastic modes: the file gives no \
             participation factors",
            elastic.len() - measured
        ));
    }
    remarks
}

/// Numbers left out between the first and the last mode.
fn missing(result: &ModalResult) -> Option<String> {
    let mut there: Vec<u32> = result.modes.iter().map(|mode| mode.index).collect();
    there.sort_unstable();
    let between = |pair: &[u32]| (u64::from(pair[0]) + 1)..u64::from(pair[1]);
    // A number far off is a slip of the pen, not a million modes.
    let gaps: Vec<u64> = there.windows(2).flat_map(between).take(1000).collect();
    (!gaps.is_empty()).then(|| {
        format!(
            "modes are missing between the first and the last number: {}",
            ranges(&gaps)
        )
    })
}

/// Rigid motions at frequencies of their own, as of an aircraft on bungees.
fn supported(result: &ModalResult, survey: &RigidSurvey, elastic: &[&Mode]) -> Option<String> {
    let lowest = elastic.iter().map(|mode| mode.frequency_hz);
    let lowest = lowest.fold(f64::INFINITY, f64::min);
    let modes = result.modes.iter().zip(&survey.fits);
    let on_springs: Vec<String> = modes
        .filter(|(mode, fit)| fit.rigid && mode.frequency_hz > FREE * lowest)
        .map(|(mode, _)| format!("{} ({:.3} Hz)", mode.index, mode.frequency_hz))
        .collect();
    (!on_springs.is_empty()).then(|| {
        format!(
            "rigid motions that stand on springs: modes {}; they are left out, and rigid modes of \
             the free structure are made from the mass properties",
            on_springs.join(", ")
        )
    })
}

fn unnormalised(elastic: &[&Mode]) -> Option<String> {
    let masses = elastic.iter().map(|mode| mode.generalised_mass);
    let (low, high) = masses.fold((f64::INFINITY, 0.0_f64), |(low, high), mass| {
        (low.min(mass), high.max(mass))
    });
    let is_unit = (low - 1.0).abs() < NORMALISED && (high - 1.0).abs() < NORMALISED;
    (!elastic.is_empty() && !is_unit).then(|| {
        format!(
            "generalised masses of elastic modes are {low:.4e} to {high:.4e}: the shapes are \
             scaled to one"
        )
    })
}

fn repeated(elastic: &[&Mode]) -> Vec<String> {
    let mut order = elastic.to_vec();
    order.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    let mut remarks = Vec::new();
    for pair in order.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let apart = b.frequency_hz - a.frequency_hz;
        if apart > SAME_FREQUENCY * b.frequency_hz {
            continue;
        }
        let (first, second, f) = (a.index, b.index, b.frequency_hz);
        if assurance(a, b) > SAME_SHAPE {
            remarks.push(format!(
                "modes {first} and {second} at {f} Hz have one shape: leave one of them out with \
                 structure.modes, or write the file again"
            ));
        } else {
            remarks.push(format!(
                "modes {first} and {second} are a double root at {f} Hz: any mix of their shapes \
                 is a mode"
            ));
        }
    }
    remarks
}

fn assurance(a: &Mode, b: &Mode) -> f64 {
    let product = |a: &Mode, b: &Mode| -> f64 {
        a.displacement
            .iter()
            .zip(&b.displacement)
            .map(|(u, v)| u.dot(v))
            .sum()
    };
    let norms = product(a, a) * product(b, b);
    if norms > 0.0 {
        product(a, b).powi(2) / norms
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid_fit::survey;
    use fladder_mesh::Vec3;

    fn mode(index: u32, frequency_hz: f64, mass: f64, shape: [f64; 4]) -> Mode {
        Mode {
            index,
            frequency_hz,
            eigenvalue: 1.0,
            generalised_mass: mass,
            generalised_stiffness: mass,
            displacement: shape.map(|z| Vec3::new(0.0, 0.0, z)).to_vec(),
            rotation: None,
            participation: None,
        }
    }

    #[test]
    fn modes_written_twice_left_out_or_not_scaled_are_named() {
        let places = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        let result = ModalResult {
            format: crate::format::Format::Neutral,
            nodes: places
                .iter()
                .zip(1..)
                .map(|([x, y], id)| crate::result::Node {
                    id,
                    position: Vec3::new(*x, *y, 0.0),
                })
                .collect(),
            elements: Vec::new(),
            element_sets: Vec::new(),
            node_sets: Vec::new(),
            modes: vec![
                mode(1, 3.0, 1.0, [1.0, -1.0, -1.0, 1.0]),
                mode(2, 3.0, 4.0, [-2.0, 2.0, 2.0, -2.0]),
                mode(5, 7.0, 1.0, [1.0, 2.0, -1.0, 1.0]),
                mode(6, 7.0, 1.0, [1.0, -1.0, -1.0, 3.0]),
                mode(7, 0.5, 1.0, [1.0; 4]),
                mode(8, 0.01, 1.0, [1.0, 2.0, 1.0, 2.0]),
            ],
            stated_mass: None,
            notes: Vec::new(),
        };
        let found = remarks(&result, &survey(&result)).join("\n");
        for words in [
            "missing between the first and the last number: 3-4",
            "1.0000e0 to 4.0000e0",
            "modes 1 and 2 at 3 Hz have one shape",
            "modes 5 and 6 are a double root at 7 Hz",
            "not known of 4 elastic modes",
            "stand on springs: modes 7 (0.500 Hz);",
        ] {
            assert!(found.contains(words), "{words} in\n{found}");
        }
    }
}
