//! Nodes, frames and elements of a Nastran model, from cards or from records.

use crate::element::{self, ElementKind};
use crate::frames::{Coordinates, Frames, Grid, Points};
use crate::raw::{Geometry, RawElement};
use fladder_mesh::Vec3;
use std::collections::BTreeMap;

/// Displacement frame of a node that is a pressure in a fluid.
const FLUID: i64 = -1;

/// What an element card gives to the geometry.
pub(crate) struct Shape {
    /// Set of its property: this word and the property's number.
    property: &'static str,
    corners: ElementKind,
    full: ElementKind,
    /// Place of the first node among the data fields.
    pub(crate) first: usize,
}

impl Shape {
    /// The shape of that card; `None` where it has none, or none known here.
    pub(crate) fn of(card: &str) -> Option<Self> {
        use ElementKind::{
            Hex8, Hex20, Line2, Quad4, Quad8, Tet4, Tet10, Tri3, Tri6, Wedge6, Wedge15,
        };
        let (property, corners, full) = match card {
            "CTRIA3" | "CTRIAR" => ("pshell", Tri3, Tri3),
            "CTRIA6" => ("pshell", Tri3, Tri6),
            "CQUAD4" | "CQUADR" => ("pshell", Quad4, Quad4),
            "CQUAD8" => ("pshell", Quad4, Quad8),
            "CSHEAR" => ("pshear", Quad4, Quad4),
            "CTETRA" => ("psolid", Tet4, Tet10),
            "CPENTA" => ("psolid", Wedge6, Wedge15),
            "CHEXA" => ("psolid", Hex8, Hex20),
            "CBAR" | "CBEAM" => ("pbar", Line2, Line2),
            "CROD" | "CTUBE" | "CONROD" => ("prod", Line2, Line2),
            "RBAR" => ("rbar", Line2, Line2),
            _ => return None,
        };
        let first = if matches!(card, "CONROD" | "RBAR") {
            1
        } else {
            2
        };
        Some(Self {
            property,
            corners,
            full,
            first,
        })
    }

    /// Nodes with all midside nodes.
    pub(crate) fn most_nodes(&self) -> usize {
        self.full.node_count()
    }

    /// Nodes without midside nodes.
    pub(crate) fn least_nodes(&self) -> usize {
        self.corners.node_count()
    }

    /// Whether the second field is a property.
    pub(crate) fn has_property(&self) -> bool {
        self.first == 2
    }
}

/// What is gathered of a model.
#[derive(Debug, Default)]
pub(crate) struct Model {
    frames: Frames,
    elements: Vec<RawElement>,
    element_sets: BTreeMap<String, Vec<u64>>,
    pub(crate) node_sets: BTreeMap<String, Vec<u64>>,
    /// Elements that carry no face or are not known, by card.
    pub(crate) passed_over: BTreeMap<String, usize>,
    without_midsides: usize,
    fluid: usize,
}

impl Model {
    pub(crate) fn has_nodes(&self) -> bool {
        !self.frames.grids.is_empty()
    }

    pub(crate) fn has_node(&self, id: u64) -> bool {
        self.frames.grids.contains_key(&id)
    }

    /// Adds a node: numbers of its frames and three coordinates.
    pub(crate) fn grid(
        &mut self,
        id: u64,
        (placed_in, moves_in): (i64, i64),
        coordinates: Vec3,
    ) -> Result<(), String> {
        if moves_in == FLUID {
            self.fluid += 1;
            return Ok(());
        }
        let frame = |number: i64| {
            u64::try_from(number)
                .map_err(|_| format!("node {id} is in the coordinate system {number}"))
        };
        if !coordinates.iter().all(|x| x.is_finite()) {
            return Err(format!(
                "node {id} has a coordinate that is no finite number"
            ));
        }
        let grid = Grid {
            placed_in: frame(placed_in)?,
            coordinates,
            moves_in: frame(moves_in)?,
        };
        match self.frames.grids.insert(id, grid) {
            Some(old) if old != grid => Err(format!("node {id} is given in two ways")),
            _ => Ok(()),
        }
    }

    /// Adds a frame.
    pub(crate) fn frame(
        &mut self,
        id: u64,
        coordinates: Coordinates,
        points: Points,
    ) -> Result<(), String> {
        self.frames.define(id, coordinates, points)
    }

    /// Adds an element; 0 stands for a node that is left out.
    pub(crate) fn element(
        &mut self,
        shape: &Shape,
        (id, property): (u64, u64),
        nodes: &[u64],
    ) -> Result<(), String> {
        let least = shape.least_nodes();
        let there = |nodes: &[u64]| nodes.iter().all(|node| *node != 0);
        if nodes.len() < least || !there(&nodes[..least]) {
            return Err(format!("element {id} lacks one of its {least} corners"));
        }
        let midsides = nodes.get(least..shape.most_nodes());
        let kind = match midsides {
            Some(midsides) if there(midsides) => shape.full,
            midsides => {
                let any = midsides.is_some_and(|nodes| nodes.iter().any(|node| *node != 0));
                self.without_midsides += usize::from(any);
                shape.corners
            }
        };
        let mut nodes = nodes[..kind.node_count()].to_vec();
        // Bricks and wedges list midside nodes as .frd files do.
        element::frd_to_input_order(kind, &mut nodes);
        if property != 0 {
            let set = format!("{}_{property}", shape.property);
            self.element_sets.entry(set).or_default().push(id);
        }
        self.elements.push(RawElement { id, kind, nodes });
        Ok(())
    }

    /// Places all nodes in basic axes.
    pub(crate) fn finish(mut self) -> Result<Geometry, String> {
        let (nodes, local_axes) = self.frames.resolve()?;
        let mut notes = Vec::new();
        if self.without_midsides > 0 {
            notes.push(format!(
                "{} elements lack some of their midside nodes and are taken by their corners",
                self.without_midsides
            ));
        }
        if self.fluid > 0 {
            notes.push(format!(
                "{} nodes are pressures in a fluid and are left out",
                self.fluid
            ));
        }
        if !self.passed_over.is_empty() {
            let cards = self.passed_over.iter();
            let list: Vec<String> = cards.map(|(name, n)| format!("{n} {name}")).collect();
            notes.push(format!(
                "cards that give no face are left out: {}",
                list.join(", ")
            ));
        }
        Ok(Geometry {
            nodes,
            elements: self.elements,
            element_sets: self.element_sets,
            node_sets: self.node_sets,
            local_axes,
            notes,
        })
    }
}
