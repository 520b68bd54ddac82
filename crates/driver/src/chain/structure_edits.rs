//! Changes of the structure and the choice of carriers, as the importer takes
//! them.

use crate::case::{self, Carrier, CaseFile, TransferChoice};
use crate::failure::Failure;
use fladder_mesh::Vec3;
use fladder_modal::{
    Edits, HingeChange, HingeRotation, Inertia, Kernel, Method, PointMass, StructuralModel,
    TransferReport, TransferSettings,
};

/// Masses, hinges and frequencies.
pub(super) fn edits(given: &case::Structure) -> Edits {
    Edits {
        masses: given.added_mass.iter().map(mass).collect(),
        hinges: given.hinge.iter().map(hinge).collect(),
        frequencies: given
            .overrides
            .iter()
            .filter_map(|mode| Some((mode.mode, mode.frequency_hz?)))
            .collect(),
    }
}

fn mass(given: &case::AddedMass) -> PointMass {
    PointMass {
        name: given.name.clone(),
        mass: given.mass,
        position: Vec3::from(given.position),
        node: given.node,
        inertia: given.inertia.as_ref().map(|moments| Inertia {
            xx: moments.xx,
            yy: moments.yy,
            zz: moments.zz,
            xz: moments.xz,
        }),
    }
}

fn hinge(given: &case::HingeChange) -> HingeChange {
    let component = match given.direction {
        None | Some(case::Axis::X) => 0,
        Some(case::Axis::Y) => 1,
        Some(case::Axis::Z) => 2,
    };
    let rotation = match (given.node, given.axis) {
        (Some(node), _) => HingeRotation::Scalar { node, component },
        (None, axis) => HingeRotation::Between {
            control: given.control.clone().unwrap_or_default(),
            base: given.base.clone().unwrap_or_default(),
            axis: Vec3::from(axis.unwrap_or_default()),
        },
    };
    HingeChange {
        name: given.name.clone(),
        stiffness_change: given.stiffness_change,
        rotation,
    }
}

/// What carries which group.
pub(super) fn transfer_settings(given: Option<&case::Structure>) -> TransferSettings {
    let components = given.and_then(|given| given.components.clone());
    let mut settings = TransferSettings::from(&components.unwrap_or_default());
    match given.and_then(|given| given.transfer.as_ref()) {
        None => {}
        Some(TransferChoice::One(carrier)) => settings.default_method = method(*carrier),
        Some(TransferChoice::Each(groups)) => {
            let chosen = groups
                .iter()
                .map(|(group, carrier)| (group.clone(), method(*carrier)));
            settings.methods = chosen.collect();
        }
    }
    settings
}

fn method(carrier: Carrier) -> Method {
    match carrier {
        Carrier::Faces => Method::Faces,
        Carrier::Polyharmonic => Method::Spline(Kernel::Polyharmonic),
        Carrier::ThinPlate => Method::Spline(Kernel::ThinPlate),
    }
}

/// Refuses modes that the surface does not follow.
///
/// # Errors
/// The worst mode, with the place of its largest error.
pub(super) fn within_limit(
    file: &CaseFile,
    model: &StructuralModel,
    report: &TransferReport,
) -> Result<(), Failure> {
    let limit = file
        .case
        .structure
        .as_ref()
        .map_or(f64::INFINITY, |given| given.transfer_limit);
    let judged = model.elastic.iter().zip(&report.errors);
    let above: Vec<String> = judged
        .clone()
        .filter_map(|(mode, error)| Some((mode, (*error)?.relative)))
        .filter(|(_, relative)| *relative > limit)
        .map(|(mode, relative)| format!("{} ({:.1} %)", mode.name, 100.0 * relative))
        .collect();
    let worst = judged
        .filter_map(|(mode, error)| Some((mode, (*error)?)))
        .max_by(|a, b| a.1.relative.total_cmp(&b.1.relative));
    let Some((mode, error)) = worst.filter(|(_, error)| error.relative > limit) else {
        return Ok(());
    };
    let node = &model.result.nodes[error.node as usize];
    let [x, y, z] = [node.position.x, node.position.y, node.position.z];
    Err(Failure::input(
        format!(
            "{} on the surface differs from the structure's skin by {:.1} % of its largest \
             displacement, {:.1} % are allowed; above that: {}",
            mode.name,
            100.0 * error.relative,
            100.0 * limit,
            above.join(", ")
        ),
        format!(
            "{}, node {} at ({x:.4}, {y:.4}, {z:.4}) m",
            file.places.of("structure"),
            node.id
        ),
        "forces would be those of another motion than the structure's",
        "name the sets that carry each group in [structure.components], leave out local modes with \
         structure.modes, or allow more with structure.transfer_limit",
    ))
}
