//! A control about its hinge: what is to be balanced.

use std::collections::BTreeMap;

use fladder_mesh::Vec3;

use super::frame::{ControlFrame, Frame};
use super::joints::Joints;
use super::laminate::Laminate;
use super::mass::{Weight, weight};
use super::mesh::ShellMesh;

/// A control of the starboard side about its hinge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    pub(super) name: &'static str,
    /// Without balance, kg.
    pub(super) mass: f64,
    /// Without balance, positive with its centre aft, kg m.
    pub(super) static_moment: f64,
    /// Part of it that the balance takes away.
    pub(super) balanced: f64,
    /// With balance, kg m².
    pub(super) inertia: f64,
}

/// Of one control; its sets and balance masses are found by its letter and name.
pub(super) fn moments(
    control: &ControlFrame,
    frame: &Frame<'_>,
    mesh: &ShellMesh,
    (laminates, joints): (&BTreeMap<String, Laminate>, &Joints),
) -> Moments {
    let line = |s: f64| frame.wing.point(frame.hinge, 0.0, s);
    let start = line(control.ends[0]);
    let axis = (line(control.ends[1]) - start).normalize();
    // Aft in the plane of the control.
    let aft = (Vec3::x() - axis * axis.x).normalize();
    let mut own = Weight::default();
    for ending in ["CS", "CSW", "RIBCS"] {
        let set = format!("{}{ending}", control.letter);
        let laminate = &laminates[&set];
        own += weight(mesh, &mesh.sets[&set], laminate.thickness) * laminate.area_density;
    }
    let first = mesh.nodes.len() + 1;
    let mut balance = Weight::default();
    for mass in joints
        .masses
        .iter()
        .filter(|mass| mass.control == control.name && !mass.port)
    {
        balance += Weight::point(&joints.nodes[mass.node - first]) * mass.mass;
    }
    let lever = |weight: &Weight| (weight.moment - start * weight.amount).dot(&aft);
    let mut both = own;
    both += balance;
    // ∫ |r × axis|² dm about the start of the hinge line.
    let about = both.second - both.moment * start.transpose() - start * both.moment.transpose()
        + start * start.transpose() * both.amount;
    Moments {
        name: control.name,
        mass: own.amount,
        static_moment: lever(&own),
        balanced: -lever(&balance) / lever(&own),
        inertia: about.trace() - (axis.transpose() * about * axis).x,
    }
}
