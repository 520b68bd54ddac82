//! Element types of Gmsh files and the gathering of their elements.
//!
//! Numbers and names as in the Gmsh reference manual, file format section.

use std::collections::{BTreeMap, HashMap};

use super::MISSING_VERTEX;
use super::cursor::{Cursor, Malformed};
use super::draft::Draft;
use crate::Vec3;

/// What an element is to a surface mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Point,
    Line,
    Triangle,
    Quad,
    /// A volume element: passed over.
    Volume,
}

/// Kind and node count of a Gmsh element type.
pub(super) fn kind(cursor: &Cursor, element_type: i32) -> Result<(Kind, usize), Malformed> {
    let higher = |name: &str| {
        Err(cursor.fault(
            format!("the file holds {name} elements (type {element_type}); only straight ones are read"),
            "mesh with Mesh.ElementOrder = 1",
        ))
    };
    match element_type {
        15 => Ok((Kind::Point, 1)),
        1 => Ok((Kind::Line, 2)),
        2 => Ok((Kind::Triangle, 3)),
        3 => Ok((Kind::Quad, 4)),
        4 => Ok((Kind::Volume, 4)),
        5 => Ok((Kind::Volume, 8)),
        6 => Ok((Kind::Volume, 6)),
        7 => Ok((Kind::Volume, 5)),
        8 => higher("3-node line"),
        9 => higher("6-node triangle"),
        10 => higher("9-node quadrilateral"),
        11 => higher("10-node tetrahedron"),
        12 => higher("27-node hexahedron"),
        16 => higher("8-node quadrilateral"),
        20 => higher("incomplete 9-node triangle"),
        21 => higher("10-node triangle"),
        26 => higher("4-node line"),
        27 => higher("5-node line"),
        36 => higher("16-node quadrilateral"),
        _ if (1..=140).contains(&element_type) => higher("higher-order"),
        _ => Err(cursor.fault(
            format!("{element_type} is not an element type"),
            super::cursor::WRITE_AGAIN,
        )),
    }
}

/// Nodes and elements as they come, in the file's tags.
#[derive(Debug, Default)]
pub(super) struct Gathered {
    pub(super) positions: Vec<Vec3>,
    pub(super) index_of_tag: HashMap<u64, u32>,
    /// Names of the physical groups, by dimension and tag.
    pub(super) names: BTreeMap<(i32, i32), String>,
    elements: Vec<Element>,
    n_volume_elements: usize,
}

#[derive(Debug)]
struct Element {
    kind: Kind,
    tag: u64,
    nodes: [u64; 4],
    groups: Vec<i32>,
}

impl Gathered {
    /// Adds a node; a tag given twice is refused.
    pub(super) fn add_node(
        &mut self,
        cursor: &Cursor,
        tag: u64,
        at: Vec3,
    ) -> Result<(), Malformed> {
        let index = self.positions.len() as u32;
        if self.index_of_tag.insert(tag, index).is_some() {
            return Err(cursor.fault(
                format!("node {tag} is given twice"),
                "give every node its own number",
            ));
        }
        self.positions.push(at);
        Ok(())
    }

    pub(super) fn add_element(&mut self, kind: Kind, tag: u64, nodes: &[u64], groups: &[i32]) {
        match kind {
            Kind::Point => {}
            Kind::Volume => self.n_volume_elements += 1,
            Kind::Line | Kind::Triangle | Kind::Quad => {
                let mut padded = [0; 4];
                padded[..nodes.len()].copy_from_slice(nodes);
                self.elements.push(Element {
                    kind,
                    tag,
                    nodes: padded,
                    groups: groups.to_vec(),
                });
            }
        }
    }

    /// Joins an element that is written once for each of its physical groups,
    /// as format 2.2 does, into one element of several groups.
    pub(super) fn join_repeated(&mut self) {
        let mut first_of = HashMap::new();
        let mut joined: Vec<Element> = Vec::with_capacity(self.elements.len());
        for element in std::mem::take(&mut self.elements) {
            let is_face = matches!(element.kind, Kind::Triangle | Kind::Quad);
            if let Some(&first) = first_of.get(&element.nodes)
                && is_face
            {
                let first: &mut Element = &mut joined[first];
                if !element
                    .groups
                    .iter()
                    .any(|group| first.groups.contains(group))
                {
                    first.groups.extend(element.groups);
                    continue;
                }
            } else if is_face {
                first_of.insert(element.nodes, joined.len());
            }
            joined.push(element);
        }
        self.elements = joined;
    }

    fn name(&self, dimension: i32, group: i32) -> String {
        self.names
            .get(&(dimension, group))
            .cloned()
            .unwrap_or_else(|| group.to_string())
    }

    /// Turns tags into indices and groups into named lists.
    pub(super) fn into_draft(mut self) -> Draft {
        let mut draft = Draft::default();
        draft.vertices = std::mem::take(&mut self.positions);
        let mut missing = Vec::new();
        let mut surfaces: BTreeMap<i32, Vec<u32>> = BTreeMap::new();
        let mut curves: BTreeMap<i32, Vec<[u32; 2]>> = BTreeMap::new();
        for element in &self.elements {
            let index = element.nodes.map(|tag| {
                self.index_of_tag
                    .get(&tag)
                    .copied()
                    .unwrap_or(MISSING_VERTEX)
            });
            let [a, b, c, d] = index;
            let n_before = draft.triangles.len() as u32;
            let n_nodes = match element.kind {
                Kind::Line => {
                    for &group in &element.groups {
                        curves.entry(group).or_default().push([a, b]);
                    }
                    2
                }
                Kind::Quad => {
                    draft.add_quad([a, b, c, d]);
                    4
                }
                _ => {
                    draft.triangles.push([a, b, c]);
                    3
                }
            };
            for &group in &element.groups {
                let added = n_before..draft.triangles.len() as u32;
                surfaces.entry(group).or_default().extend(added);
            }
            if let Some(k) = (0..n_nodes).find(|&k| index[k] == MISSING_VERTEX) {
                missing.push(format!(
                    "element {} names node {}",
                    element.tag, element.nodes[k]
                ));
            }
        }
        for (group, triangles) in surfaces {
            draft.add_to_surface(&self.name(2, group), triangles);
        }
        for (group, edges) in curves {
            draft.add_to_curve(&self.name(1, group), edges);
        }
        draft.note_places("nodes that are not in the file", &missing);
        if self.n_volume_elements > 0 {
            draft.notes.push(format!(
                "volume elements were passed over: {}",
                self.n_volume_elements
            ));
        }
        draft
    }
}
