//! Changes of a structure, and how its modes come to the surface.

use super::aerodynamics::Axis;
use super::check::{At, Checked};
use super::structure::{Inertia, Structure};
use serde::Deserialize;
use std::collections::BTreeMap;

/// What carries the surface: one choice, or one a group of the mesh.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(
    untagged,
    expecting = "\"faces\", \"polyharmonic\" or \"thin-plate\", or one of them for each group \
                 of the mesh"
)]
pub enum TransferChoice {
    /// The same for all.
    One(Carrier),
    /// For the groups named; the others are carried by faces.
    Each(BTreeMap<String, Carrier>),
}

/// What carries a part of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Carrier {
    /// The nearest face.
    Faces,
    /// A spline of r³ through the nodes.
    Polyharmonic,
    /// A spline of r² ln r through the nodes.
    ThinPlate,
}

/// A mass added through the modes.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AddedMass {
    /// Name in messages.
    pub name: String,
    /// kg; negative to take away.
    pub mass: f64,
    /// Its centre in mesh axes, m.
    pub position: [f64; 3],
    /// Node it is fixed to; left out: the nearest.
    pub node: Option<u64>,
    /// About its own centre, kg m².
    pub inertia: Option<Inertia>,
}

/// A hinge stiffness changed through the modes.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HingeChange {
    /// Name in messages.
    pub name: String,
    /// N m/rad, added to that of the model.
    pub stiffness_change: f64,
    /// Node one of whose displacements stands for the rotation.
    pub node: Option<u64>,
    /// Which displacement, in the structure's axes.
    pub direction: Option<Axis>,
    /// Set of the control surface.
    pub control: Option<String>,
    /// Set of what it is hinged to.
    pub base: Option<String>,
    /// Hinge axis in mesh axes.
    pub axis: Option<[f64; 3]>,
}

/// What is known better of one elastic mode.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModeOverride {
    /// Number of the elastic mode, from 1.
    pub mode: usize,
    /// Hz.
    pub frequency_hz: Option<f64>,
    /// Structural damping coefficient.
    pub damping: Option<f64>,
}

pub(super) fn check(given: &Structure, at: &At<'_>) -> Checked {
    at.positive("structure.transfer_limit", given.transfer_limit)?;
    let edited = [
        ("structure.added_mass", given.added_mass.is_empty()),
        ("structure.hinge", given.hinge.is_empty()),
        ("structure.override", given.overrides.is_empty()),
    ];
    for (key, is_empty) in edited {
        if !is_empty && given.file.is_none() {
            return Err(at.refuse(
                key,
                format!("[[{key}]] is given without `structure.file`"),
                "the change acts on elastic modes, and there are none",
                "name the result file; matrices given outright are changed in the matrices",
            ));
        }
    }
    for (number, mass) in given.added_mass.iter().enumerate() {
        added_mass(mass, &format!("structure.added_mass.{number}"), at)?;
    }
    for (number, hinge) in given.hinge.iter().enumerate() {
        hinge_change(hinge, &format!("structure.hinge.{number}"), at)?;
    }
    for (number, mode) in given.overrides.iter().enumerate() {
        let key = format!("structure.override.{number}");
        let earlier = &given.overrides[..number];
        mode_override(mode, earlier, &key, at)?;
    }
    Ok(())
}

fn added_mass(mass: &AddedMass, key: &str, at: &At<'_>) -> Checked {
    at.finite(&format!("{key}.mass"), mass.mass)?;
    at.all_finite(&format!("{key}.position"), &mass.position)?;
    let Some(inertia) = &mass.inertia else {
        return Ok(());
    };
    let moments = [inertia.xx, inertia.yy, inertia.zz, inertia.xz];
    at.all_finite(&format!("{key}.inertia"), &moments)
}

fn hinge_change(hinge: &HingeChange, key: &str, at: &At<'_>) -> Checked {
    at.finite(&format!("{key}.stiffness_change"), hinge.stiffness_change)?;
    let scalar = [hinge.node.is_some(), hinge.direction.is_some()];
    let between = [
        hinge.control.is_some(),
        hinge.base.is_some(),
        hinge.axis.is_some(),
    ];
    let one_way = (scalar == [true; 2] && between == [false; 3])
        || (scalar == [false; 2] && between == [true; 3]);
    if !one_way {
        return Err(at.refuse(
            key,
            format!("the hinge `{}` does not say how the modes turn it", hinge.name),
            "the change of stiffness acts on the rotation of the hinge in every mode",
            "give node and direction (a displacement that stands for the rotation), or control, \
             base (sets of the structure) and axis",
        ));
    }
    if let Some(axis) = &hinge.axis {
        at.all_finite(&format!("{key}.axis"), axis)?;
        if *axis == [0.0; 3] {
            return Err(at.refuse(
                &format!("{key}.axis"),
                format!("the axis of the hinge `{}` has no length", hinge.name),
                "there is no direction to turn about",
                "give for example axis = [0.0, 1.0, 0.0]",
            ));
        }
    }
    Ok(())
}

fn mode_override(
    mode: &ModeOverride,
    earlier: &[ModeOverride],
    key: &str,
    at: &At<'_>,
) -> Checked {
    if mode.mode == 0 || earlier.iter().any(|other| other.mode == mode.mode) {
        return Err(at.refuse(
            &format!("{key}.mode"),
            format!("`mode` is {}, which is zero or given twice", mode.mode),
            "elastic modes are counted from 1, and each has one frequency and one damping",
            "give every elastic mode once",
        ));
    }
    if mode.frequency_hz.is_none() && mode.damping.is_none() {
        return Err(at.refuse(
            key,
            format!(
                "elastic mode {} is named and nothing given for it",
                mode.mode
            ),
            "the entry would have no effect",
            "add frequency_hz or damping, or remove the entry",
        ));
    }
    if let Some(frequency) = mode.frequency_hz {
        at.positive(&format!("{key}.frequency_hz"), frequency)?;
    }
    mode.damping.map_or(Ok(()), |damping| {
        at.not_negative(&format!("{key}.damping"), damping)
    })
}
