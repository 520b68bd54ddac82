//! From the names in an edit to nodes, rotations and places of a structure.

use crate::attach::{Attachment, mean_rotation};
use crate::edit::{Change, EditError, Fixed, HingeChange, HingeRotation, PointMass};
use crate::model::{ElasticMode, StructureSettings};
use crate::result::{ModalResult, NamedSet};
use crate::rigid::RigidBody;
use crate::rigid_fit::{RigidSurvey, fit_nodes};
use fladder_mesh::Vec3;
use std::f64::consts::TAU;

/// A structure in SI units and mesh axes, and what is asked of it.
pub(crate) struct Structure<'a> {
    pub(crate) result: &'a ModalResult,
    pub(crate) survey: &'a RigidSurvey,
    pub(crate) settings: &'a StructureSettings,
}

/// Distance of a mass from its node, relative to the size of the structure, that
/// is named.
const FAR: f64 = 0.05;

impl Structure<'_> {
    /// The elastic modes and mass properties after the edits.
    pub(crate) fn edited(
        &self,
        elastic: &[ElasticMode],
        body: Option<RigidBody>,
        notes: &mut Vec<String>,
    ) -> Result<(Vec<ElasticMode>, Option<RigidBody>), EditError> {
        let edits = &self.settings.edits;
        if self.settings.half {
            return Err(EditError::Half);
        }
        let rigid = self.survey.rigid_count();
        if body.is_none() && rigid > 0 && !edits.masses.is_empty() {
            return Err(EditError::UnknownBody { rigid });
        }
        let positions = self.result.positions();
        let masses = edits
            .masses
            .iter()
            .map(|mass| self.fixed(mass, &positions, notes))
            .collect::<Result<Vec<_>, _>>()?;
        let hinges = edits
            .hinges
            .iter()
            .map(|hinge| {
                let rotation = elastic
                    .iter()
                    .map(|mode| self.rotation(hinge, mode, &positions));
                Ok((hinge.stiffness_change, rotation.collect::<Result<_, _>>()?))
            })
            .collect::<Result<Vec<_>, EditError>>()?;
        let change = Change {
            masses: &masses,
            hinges: &hinges,
            positions: &positions,
        };
        let (renewed, body) = change.apply(elastic, body.as_ref(), notes)?;
        for hinge in &edits.hinges {
            let (name, change) = (&hinge.name, hinge.stiffness_change);
            notes.push(format!(
                "{name}: {change:+} N m/rad added through the modes"
            ));
        }
        if renewed.len() == elastic.len() {
            notes.push(format!(
                "elastic modes are made anew from the {} of the file",
                elastic.len()
            ));
        }
        Ok((renewed, body))
    }

    fn fixed<'a>(
        &self,
        mass: &'a PointMass,
        positions: &[Vec3],
        notes: &mut Vec<String>,
    ) -> Result<Fixed<'a>, EditError> {
        let name = &mass.name;
        let node = mass.node.map(|id| self.node(name, id)).transpose()?;
        let candidates = fit_nodes(self.result);
        let unknown = || EditError::Unknown {
            name: name.clone(),
            what: "node".to_owned(),
        };
        let attachment = Attachment::new(&mass.position, node, &candidates, positions)
            .ok_or_else(unknown)?;
        let (on, away) = attachment.place();
        let size = crate::read::diagonal(positions.iter());
        let id = self.result.nodes[on].id;
        notes.push(format!("{name}: {} kg added on node {id}", mass.mass));
        if away > FAR * size {
            notes.push(format!(
                "{name} is {away:.3} m away from the node it follows, {id}: name the node it is \
                 fixed to, or correct its position"
            ));
        }
        let has_rotations = self.result.modes.iter().all(|mode| mode.rotation.is_some());
        if attachment.is_open && !has_rotations {
            notes.push(format!(
                "{name}: the nodes around it lie on one line and have no rotations; the rotation \
                 about the line counts as zero"
            ));
        }
        Ok(Fixed { mass, attachment })
    }

    fn node(&self, name: &str, id: u64) -> Result<usize, EditError> {
        let found = self.result.nodes.binary_search_by_key(&id, |node| node.id);
        found.map_err(|_| EditError::Unknown {
            name: name.to_owned(),
            what: format!("node {id} that carries displacements"),
        })
    }

    fn rotation(
        &self,
        hinge: &HingeChange,
        mode: &ElasticMode,
        positions: &[Vec3],
    ) -> Result<f64, EditError> {
        match &hinge.rotation {
            HingeRotation::Scalar { node, component } => {
                let node = self.node(&hinge.name, *node)?;
                let direction = self.settings.axes.turn(&Vec3::ith(*component, 1.0));
                // A displacement of the file is one of the mode in metres; a
                // rotation in its place is turned into the mode's scale.
                Ok(direction.dot(&mode.shape[node]) / self.settings.units.length())
            }
            HingeRotation::Between {
                control,
                base,
                axis,
            } => {
                let turn = |set: &String| {
                    let nodes = self.nodes(&hinge.name, set)?;
                    mean_rotation(&nodes, &mode.shape, positions).ok_or_else(|| {
                        EditError::NoRotation {
                            name: hinge.name.clone(),
                            set: set.clone(),
                        }
                    })
                };
                Ok((turn(control)? - turn(base)?).dot(&axis.normalize()))
            }
        }
    }

    /// Nodes of a node set, or of the elements of an element set.
    fn nodes(&self, name: &str, set: &str) -> Result<Vec<usize>, EditError> {
        let find = |sets: &'_ [NamedSet]| {
            let mut found = sets
                .iter()
                .filter(|known| known.name.eq_ignore_ascii_case(set));
            found.next().map(|known| known.members.clone())
        };
        let of_elements = || {
            let members = find(&self.result.element_sets)?;
            let elements = members
                .iter()
                .map(|e| &self.result.elements[*e as usize].nodes);
            Some(elements.flatten().copied().collect())
        };
        let nodes: Option<Vec<u32>> = find(&self.result.node_sets).or_else(of_elements);
        let mut nodes: Vec<usize> = nodes
            .ok_or_else(|| EditError::Unknown {
                name: name.to_owned(),
                what: format!("set {set:?}"),
            })?
            .into_iter()
            .map(|node| node as usize)
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        Ok(nodes)
    }
}

/// Frequencies known better than by the model; shapes and their order stay.
pub(crate) fn override_frequencies(
    elastic: &mut [ElasticMode],
    frequencies: &[(usize, f64)],
    notes: &mut Vec<String>,
) -> Result<(), EditError> {
    let count = elastic.len();
    for (number, frequency) in frequencies {
        let mode = number
            .checked_sub(1)
            .and_then(|place| elastic.get_mut(place));
        let mode = mode.ok_or(EditError::NoMode {
            number: *number,
            count,
        })?;
        notes.push(format!(
            "{}: {frequency} Hz as given, in place of {:.4} Hz",
            mode.name, mode.frequency_hz
        ));
        mode.frequency_hz = *frequency;
        mode.omega = TAU * frequency;
    }
    Ok(())
}
