//! What a reader hands over before files are put together: everything by the
//! numbers of the file.

use crate::element::ElementKind;
use crate::rigid::RigidBody;
use fladder_mesh::Vec3;
use nalgebra::Matrix3;
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
    /// Directions of displacement components, as columns in the axes of the
    /// positions, of nodes that have their own.
    pub(crate) local_axes: BTreeMap<u64, Matrix3<f64>>,
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
    /// Vectors are in each node's own axes, [`Geometry::local_axes`].
    pub(crate) in_local_axes: bool,
}

/// A mode with displacements and, where the file has them, rotations, while its
/// block is read.
#[derive(Debug)]
pub(crate) struct ModeBuilder {
    mode: RawMode,
    displacement: ShapeBuilder,
    rotation: ShapeBuilder,
    has_rotations: bool,
    /// Unknowns that belong to no place.
    pub(crate) scalar_points: usize,
}

impl ModeBuilder {
    pub(crate) fn new(index: u32, frequency_hz: f64, eigenvalue: Option<f64>) -> Self {
        Self {
            mode: RawMode {
                index,
                frequency_hz,
                eigenvalue,
                generalised_mass: None,
                displacement: Vec::new(),
                rotation: None,
                participation: None,
            },
            displacement: ShapeBuilder::default(),
            rotation: ShapeBuilder::default(),
            has_rotations: false,
            scalar_points: 0,
        }
    }

    pub(crate) fn with_mass(mut self, mass: Option<f64>) -> Self {
        self.mode.generalised_mass = mass;
        self
    }

    pub(crate) fn index(&self) -> u32 {
        self.mode.index
    }

    /// Adds a node; says what is wrong with it otherwise.
    pub(crate) fn add(
        &mut self,
        table: &mut ModeTable,
        node: u64,
        displacement: Vec3,
        rotation: Option<Vec3>,
    ) -> Result<(), String> {
        table.add(&mut self.displacement, node, displacement)?;
        if let Some(rotation) = rotation {
            self.has_rotations = true;
            table.add(&mut self.rotation, node, rotation)?;
        }
        Ok(())
    }

    /// Puts the finished mode into the table.
    pub(crate) fn finish(
        self,
        table: &mut ModeTable,
        notes: &mut Vec<String>,
    ) -> Result<(), String> {
        let mut mode = self.mode;
        if table.modes.iter().any(|other| other.index == mode.index) {
            return Err(format!(
                "mode {} comes twice, as after two subcases or steps; keep one",
                mode.index
            ));
        }
        mode.displacement = table.finish(self.displacement)?;
        if self.has_rotations {
            mode.rotation = Some(table.finish(self.rotation)?);
        }
        if self.scalar_points > 0 && table.modes.is_empty() {
            notes.push(format!(
                "{} scalar points have no place and are left out",
                self.scalar_points
            ));
        }
        table.modes.push(mode);
        Ok(())
    }
}

/// A mode's values while its block is read.
#[derive(Debug, Default)]
pub(crate) struct ShapeBuilder {
    values: Vec<Option<Vec3>>,
    next: usize,
}

impl ModeTable {
    /// An empty table of vectors in each node's own axes.
    pub(crate) fn in_local_axes() -> Self {
        Self {
            in_local_axes: true,
            ..Self::default()
        }
    }

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
