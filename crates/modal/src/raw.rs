//! What a reader hands over before files are put together: everything by the
//! numbers of the file.

use crate::element::ElementKind;
use crate::rigid::RigidBody;
use fladder_mesh::Vec3;
use std::collections::{BTreeMap, HashMap};

/// Nodes, elements and sets of one file.
#[derive(Debug, Default)]
pub(crate) struct Geometry {
    /// Positions by node number.
    pub(crate) nodes: BTreeMap<u64, Vec3>,
    /// Elements in the order of the file.
    pub(crate) elements: Vec<RawElement>,
    /// Element numbers by set name.
    pub(crate) element_sets: BTreeMap<String, Vec<u64>>,
    /// Node numbers by set name.
    pub(crate) node_sets: BTreeMap<String, Vec<u64>>,
    /// What was ignored or assumed.
    pub(crate) notes: Vec<String>,
}

/// One element by node numbers.
#[derive(Debug)]
pub(crate) struct RawElement {
    pub(crate) id: u64,
    pub(crate) kind: ElementKind,
    pub(crate) nodes: Vec<u64>,
}

/// One mode; values in the order of [`ModeTable::order`].
#[derive(Debug)]
pub(crate) struct RawMode {
    pub(crate) index: u32,
    pub(crate) frequency_hz: f64,
    /// `None` where the file has frequencies only.
    pub(crate) eigenvalue: Option<f64>,
    /// `None` where the file does not say.
    pub(crate) generalised_mass: Option<f64>,
    pub(crate) displacement: Vec<Vec3>,
    pub(crate) rotation: Option<Vec<Vec3>>,
    pub(crate) participation: Option<Vec3>,
}

/// Modes over one list of nodes, which every mode must cover.
#[derive(Debug, Default)]
pub(crate) struct ModeTable {
    /// Node numbers in the order of the first mode.
    pub(crate) order: Vec<u64>,
    position: HashMap<u64, usize>,
    pub(crate) modes: Vec<RawMode>,
    pub(crate) stated_mass: Option<RigidBody>,
}

/// A mode's values while its block is read.
#[derive(Debug, Default)]
pub(crate) struct ShapeBuilder {
    values: Vec<Option<Vec3>>,
    next: usize,
}

impl ModeTable {
    /// Adds the displacement of a node; says what is wrong with it otherwise.
    pub(crate) fn add(
        &mut self,
        shape: &mut ShapeBuilder,
        node: u64,
        value: Vec3,
    ) -> Result<(), String> {
        let place = self.place(shape.next, node)?;
        if shape.values.len() <= place {
            shape.values.resize(place + 1, None);
        }
        if shape.values[place].replace(value).is_some() {
            return Err(format!("node {node} has two displacements in one mode"));
        }
        shape.next = place + 1;
        Ok(())
    }

    /// The values of a finished block, one a node.
    pub(crate) fn finish(&self, shape: ShapeBuilder) -> Result<Vec<Vec3>, String> {
        let mut values = shape.values;
        values.resize(self.order.len(), None);
        if let Some(missing) = values.iter().position(Option::is_none) {
            let node = self.order[missing];
            return Err(format!(
                "node {node} has no displacement, as it has in the first mode"
            ));
        }
        Ok(values.into_iter().flatten().collect())
    }

    fn place(&mut self, expected: usize, node: u64) -> Result<usize, String> {
        if self.order.get(expected) == Some(&node) {
            return Ok(expected);
        }
        if let Some(place) = self.position.get(&node) {
            return Ok(*place);
        }
        if !self.modes.is_empty() {
            return Err(format!(
                "node {node} has a displacement, but none in the first mode"
            ));
        }
        self.position.insert(node, self.order.len());
        self.order.push(node);
        Ok(self.order.len() - 1)
    }
}
