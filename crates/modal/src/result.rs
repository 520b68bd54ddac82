//! What a finite-element result file holds, in the units and axes of that file.

use crate::element::ElementKind;
use crate::format::Format;
use crate::rigid::RigidBody;
use fladder_mesh::Vec3;

/// A node that carries displacements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Number in the file.
    pub id: u64,
    /// Position.
    pub position: Vec3,
}

/// An element whose nodes all carry displacements.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// Number in the file.
    pub id: u64,
    /// Shape and node order.
    pub kind: ElementKind,
    /// Indices into [`ModalResult::nodes`].
    pub nodes: Vec<u32>,
}

/// A named set of nodes or elements, by index.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedSet {
    /// Name as written in the file.
    pub name: String,
    /// Indices, ascending, each once.
    pub members: Vec<u32>,
}

/// One natural mode as the file gives it, before normalisation.
///
/// The shape φ gives the displacement `φ ξ`, so that with the mass matrix `M`
/// of the structure `m = φᵀ M φ` and `k = φᵀ K φ = λ m`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Number in the file.
    pub index: u32,
    /// Frequency in Hz; zero where the eigenvalue is negative.
    pub frequency_hz: f64,
    /// Eigenvalue λ = ω² in (rad/s)²; rounding makes it negative for rigid modes.
    pub eigenvalue: f64,
    /// Generalised mass m.
    pub generalised_mass: f64,
    /// Generalised stiffness k.
    pub generalised_stiffness: f64,
    /// One displacement a node of [`ModalResult::nodes`].
    pub displacement: Vec<Vec3>,
    /// One rotation vector a node, where the file has them.
    pub rotation: Option<Vec<Vec3>>,
    /// Participation factors of the three translations, where the file has them.
    pub participation: Option<Vec3>,
}

/// Nodes, elements, sets and modes of one result file.
#[derive(Clone, Debug, PartialEq)]
pub struct ModalResult {
    /// Format the file was written in.
    pub format: Format,
    /// Nodes that carry displacements, by ascending number.
    pub nodes: Vec<Node>,
    /// Elements between them.
    pub elements: Vec<Element>,
    /// Named sets of elements.
    pub element_sets: Vec<NamedSet>,
    /// Named sets of nodes.
    pub node_sets: Vec<NamedSet>,
    /// Modes in the order of the file.
    pub modes: Vec<Mode>,
    /// Mass properties the file states outright.
    pub stated_mass: Option<RigidBody>,
    /// What was repaired, ignored or assumed, one sentence each.
    pub notes: Vec<String>,
}

impl ModalResult {
    /// Node positions in the order of [`ModalResult::nodes`].
    pub fn positions(&self) -> Vec<Vec3> {
        self.nodes.iter().map(|node| node.position).collect()
    }

    /// Doubles generalised masses and stiffnesses: the file holds half of a
    /// symmetric structure, the generalised coordinates are of the whole.
    #[must_use]
    pub fn doubled(mut self) -> Self {
        for mode in &mut self.modes {
            mode.generalised_mass *= 2.0;
            mode.generalised_stiffness *= 2.0;
        }
        self.notes
            .push("half model: generalised masses and stiffnesses are doubled".to_owned());
        self
    }
}
