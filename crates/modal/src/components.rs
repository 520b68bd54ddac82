//! Which part of the structure carries which part of the surface.
//!
//! Parts that move against each other, such as a control surface and its wing,
//! must not share structure: the nearest face across a hinge gap belongs to the
//! wrong one. Each named group of the mesh is therefore carried by its own sets
//! of the structure: those of the case file, those of the same name, or, failing
//! both, the connected pieces of skin that lie nearest to it.
//!
//! A vertex on the border of two groups goes to the one with more area. So the
//! vertices of a hinge line belong to the wing, and a vertex belongs to a control
//! surface only if all its triangles do.

use crate::closest::FaceSearch;
use crate::error::TransferError;
use crate::face::Face;
use crate::result::{ModalResult, NamedSet};
use crate::skin::Skin;
use crate::spline::Kernel;
use crate::transfer_settings::{Method, TransferSettings};
use fladder_mesh::{TriMesh, Vec3};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// Share of a group's area that must lie nearest to a piece of the structure for
/// the piece to carry the group: the strip before a hinge is nearer to the
/// control surface and must not count.
const PIECE_SHARE: f64 = 0.1;

/// How a group of the mesh found its structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mapping {
    /// Sets named in the case file.
    Given,
    /// A set of the same name.
    EqualName,
    /// Connected pieces of skin nearest to it.
    Connectivity,
    /// All nodes of the structure, by a spline.
    AllNodes,
}

impl Mapping {
    /// Words for reports.
    pub fn words(self) -> &'static str {
        match self {
            Self::Given => "as given",
            Self::EqualName => "by equal names",
            Self::Connectivity => "by connectivity",
            Self::AllNodes => "by all nodes",
        }
    }
}

/// A part of the surface and the structure that carries it.
pub(crate) struct Component {
    pub(crate) name: String,
    pub(crate) sets: Vec<String>,
    pub(crate) mapping: Mapping,
    /// Index into [`Plan::targets`].
    pub(crate) target: usize,
    pub(crate) area: f64,
}

/// Structure that carries parts of the surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// Faces, as indices into the skin's faces.
    Faces(Vec<u32>),
    /// Nodes under a spline.
    Nodes(Vec<u32>, Kernel),
}

impl Target {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Faces(list) | Self::Nodes(list, _) => list.len(),
        }
    }

    /// Its faces; none under a spline.
    pub(crate) fn faces(&self) -> &[u32] {
        match self {
            Self::Faces(faces) => faces,
            Self::Nodes(..) => &[],
        }
    }
}

/// The whole assignment.
pub(crate) struct Plan {
    pub(crate) components: Vec<Component>,
    /// Component of each vertex; `None` for vertices of no triangle.
    pub(crate) of_vertex: Vec<Option<u32>>,
    /// What carries the components.
    pub(crate) targets: Vec<Target>,
    pub(crate) notes: Vec<String>,
}

/// Given names, all checked.
pub(crate) struct Planner<'a> {
    pub(crate) result: &'a ModalResult,
    pub(crate) positions: &'a [Vec3],
    pub(crate) mesh: &'a TriMesh,
    pub(crate) skin: &'a Skin,
    pub(crate) settings: &'a TransferSettings,
}

/// Triangles of a group that no smaller group holds.
struct Part {
    name: String,
    triangles: Vec<u32>,
}

impl Planner<'_> {
    pub(crate) fn plan(&self) -> Result<Plan, TransferError> {
        self.check_names()?;
        let mut notes = Vec::new();
        let all: Vec<u32> = (0..self.skin.faces.len() as u32)
            .filter(|f| self.skin.outer[*f as usize])
            .collect();
        let nearest_piece = if self.needs_faces() {
            self.nearest_pieces(&all)?
        } else {
            vec![0; self.mesh.triangles.len()]
        };
        let mut components = Vec::new();
        let mut targets: Vec<Target> = Vec::new();
        let mut of_triangle = vec![0; self.mesh.triangles.len()];
        for part in self.parts(&nearest_piece, &mut notes) {
            let (mapping, carriers) = match self.settings.method(&part.name) {
                Method::Faces => {
                    let (mapping, faces) = self.carriers(&part, &nearest_piece, &mut notes)?;
                    (mapping, Target::Faces(faces))
                }
                Method::Spline(kernel) => {
                    let (mapping, nodes) = self.nodes(&part);
                    (mapping, Target::Nodes(nodes, kernel))
                }
            };
            let target = targets
                .iter()
                .position(|known| *known == carriers)
                .unwrap_or_else(|| {
                    targets.push(carriers);
                    targets.len() - 1
                });
            for triangle in &part.triangles {
                of_triangle[*triangle as usize] = components.len() as u32;
            }
            components.push(Component {
                sets: self.set_names(&part.name, mapping, &targets[target]),
                name: part.name,
                mapping,
                target,
                area: part.triangles.iter().map(|t| self.area(*t)).sum(),
            });
        }
        let of_vertex = self.vertices(&components, &of_triangle);
        Ok(Plan {
            components,
            of_vertex,
            targets,
            notes,
        })
    }

    fn area(&self, triangle: u32) -> f64 {
        self.mesh.area_vector(triangle as usize).norm()
    }

    /// Whether a part of the mesh may be carried by faces.
    fn needs_faces(&self) -> bool {
        let groups = &self.mesh.surfaces;
        let grouped: usize = groups.iter().map(|group| group.triangles.len()).sum();
        let by_faces = |name: &str| self.settings.method(name) == Method::Faces;
        (grouped < self.mesh.triangles.len() && self.settings.default_method == Method::Faces)
            || groups.iter().any(|group| by_faces(&group.name))
    }

    fn check_names(&self) -> Result<(), TransferError> {
        let groups = || {
            let surfaces = self.mesh.surfaces.iter();
            surfaces.map(|surface| surface.name.clone())
        };
        let methods = self.settings.methods.keys();
        if let Some(name) = methods
            .clone()
            .find(|name| groups().all(|known| known != **name))
        {
            return Err(TransferError::NoSuchGroup {
                name: name.clone(),
                known: groups().collect(),
            });
        }
        for (group, sets) in &self.settings.components {
            if !groups().any(|name| name == *group) {
                return Err(TransferError::NoGroup {
                    name: group.clone(),
                    known: groups().collect(),
                });
            }
            for set in sets {
                let splined = self.settings.method(group) != Method::Faces;
                if self.set(set).is_none() && !(splined && self.node_set(set).is_some()) {
                    let of_nodes = self.result.node_sets.iter().filter(|_| splined);
                    let sets = self.result.element_sets.iter().chain(of_nodes);
                    let known = sets.map(|set| set.name.clone()).collect();
                    let group = group.clone();
                    return Err(TransferError::NoSet {
                        name: set.clone(),
                        group,
                        known,
                    });
                }
            }
        }
        Ok(())
    }

    fn set(&self, name: &str) -> Option<&[u32]> {
        named(&self.result.element_sets, name)
    }

    fn node_set(&self, name: &str) -> Option<&[u32]> {
        named(&self.result.node_sets, name)
    }

    /// The nodes that carry a part by a spline, and how they were found: those of
    /// the sets given, of a set of its name, or all.
    fn nodes(&self, part: &Part) -> (Mapping, Vec<u32>) {
        if let Some(sets) = self.settings.components.get(&part.name) {
            return (Mapping::Given, self.nodes_of(sets));
        }
        let own = self.nodes_of(std::slice::from_ref(&part.name));
        if own.is_empty() {
            let all = (0..self.positions.len() as u32).collect();
            return (Mapping::AllNodes, all);
        }
        (Mapping::EqualName, own)
    }

    fn nodes_of(&self, sets: &[String]) -> Vec<u32> {
        let mut nodes = BTreeSet::new();
        for set in sets {
            for element in self.set(set).unwrap_or_default() {
                nodes.extend(&self.result.elements[*element as usize].nodes);
            }
            nodes.extend(self.node_set(set).unwrap_or_default());
        }
        nodes.into_iter().collect()
    }

    /// Piece of the skin nearest to the middle of each triangle.
    fn nearest_pieces(&self, skin: &[u32]) -> Result<Vec<u32>, TransferError> {
        let faces = skin
            .iter()
            .map(|f| self.skin.faces[*f as usize].clone())
            .collect();
        let search =
            FaceSearch::new(faces, self.positions).ok_or(TransferError::NotOnSurface)?;
        Ok((0..self.mesh.triangles.len())
            .into_par_iter()
            .map(|triangle| {
                let [a, b, c] = self.mesh.corners(triangle);
                let hit = search.nearest(&((a + b + c) / 3.0), self.positions);
                self.skin.piece[skin[hit.face as usize] as usize]
            })
            .collect())
    }

    /// The groups of the mesh without overlap; triangles of no group form parts
    /// by the piece of structure nearest to them.
    fn parts(&self, nearest_piece: &[u32], notes: &mut Vec<String>) -> Vec<Part> {
        let groups = &self.mesh.surfaces;
        let mut owner: Vec<Option<usize>> = vec![None; self.mesh.triangles.len()];
        let mut overlap = 0;
        // Groups named in the case first, then the smaller before the larger.
        let mut order: Vec<usize> = (0..groups.len()).collect();
        order.sort_by_key(|g| {
            (
                !self.settings.components.contains_key(&groups[*g].name),
                groups[*g].triangles.len(),
                *g,
            )
        });
        for group in order {
            for triangle in &groups[group].triangles {
                match owner[*triangle as usize] {
                    Some(_) => overlap += 1,
                    None => owner[*triangle as usize] = Some(group),
                }
            }
        }
        if overlap > 0 {
            notes.push(format!(
                "{overlap} triangles are in several groups of the mesh: the smallest one counts"
            ));
        }
        let mut parts: Vec<Part> = groups
            .iter()
            .map(|group| Part {
                name: group.name.clone(),
                triangles: Vec::new(),
            })
            .collect();
        let mut loose: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (triangle, owner) in owner.iter().enumerate() {
            match owner {
                Some(group) => parts[*group].triangles.push(triangle as u32),
                None => loose
                    .entry(nearest_piece[triangle])
                    .or_default()
                    .push(triangle as u32),
            }
        }
        for (number, triangles) in loose.into_values().enumerate() {
            parts.push(Part {
                name: format!("no group {}", number + 1),
                triangles,
            });
        }
        parts.retain(|part| !part.triangles.is_empty());
        parts
    }

    /// The faces that carry a part, and how they were found.
    fn carriers(
        &self,
        part: &Part,
        nearest_piece: &[u32],
        notes: &mut Vec<String>,
    ) -> Result<(Mapping, Vec<u32>), TransferError> {
        if let Some(sets) = self.settings.components.get(&part.name) {
            return Ok((Mapping::Given, self.faces_of(&part.name, sets, notes)?));
        }
        if self
            .set(&part.name)
            .is_some_and(|members| !members.is_empty())
        {
            let sets = [part.name.clone()];
            return Ok((Mapping::EqualName, self.faces_of(&part.name, &sets, notes)?));
        }
        let mut share: BTreeMap<u32, f64> = BTreeMap::new();
        for triangle in &part.triangles {
            *share.entry(nearest_piece[*triangle as usize]).or_default() +=
                self.area(*triangle);
        }
        let total: f64 = share.values().sum();
        let chosen: BTreeSet<u32> = share
            .iter()
            .filter(|(_, area)| **area >= PIECE_SHARE * total)
            .map(|(piece, _)| *piece)
            .collect();
        let is_carrier =
            |f: &usize| self.skin.outer[*f] && chosen.contains(&self.skin.piece[*f]);
        let faces = (0..self.skin.faces.len())
            .filter(is_carrier)
            .map(|f| f as u32)
            .collect();
        Ok((Mapping::Connectivity, faces))
    }

    /// Skin faces of the elements in some sets; all their faces where nearly
    /// none of them counts as skin, because the sets were chosen by hand.
    fn faces_of(
        &self,
        group: &str,
        sets: &[String],
        notes: &mut Vec<String>,
    ) -> Result<Vec<u32>, TransferError> {
        let elements: BTreeSet<u32> = sets
            .iter()
            .filter_map(|set| self.set(set))
            .flatten()
            .copied()
            .collect();
        let of_sets: Vec<u32> = (0..self.skin.faces.len() as u32)
            .filter(|f| elements.contains(&self.skin.faces[*f as usize].element))
            .collect();
        if of_sets.is_empty() {
            return Err(TransferError::NoFaces {
                group: group.to_owned(),
                sets: sets.to_vec(),
            });
        }
        let skin: Vec<u32> = of_sets
            .iter()
            .filter(|f| self.skin.outer[**f as usize])
            .copied()
            .collect();
        if 2 * skin.len() < of_sets.len() {
            notes.push(format!(
                "{group}: {} of {} faces of its sets are away from the surface or across it; all \
                 are kept, as the sets were named",
                of_sets.len() - skin.len(),
                of_sets.len()
            ));
            return Ok(of_sets);
        }
        Ok(skin)
    }

    fn set_names(&self, part: &str, mapping: Mapping, target: &Target) -> Vec<String> {
        match mapping {
            Mapping::Given => self
                .settings
                .components
                .get(part)
                .cloned()
                .unwrap_or_default(),
            Mapping::EqualName => vec![part.to_owned()],
            Mapping::AllNodes => Vec::new(),
            Mapping::Connectivity => {
                let elements: BTreeSet<u32> = target
                    .faces()
                    .iter()
                    .map(|f| self.skin.faces[*f as usize].element)
                    .collect();
                let sets = self.result.element_sets.iter();
                sets.filter(|set| set.members.iter().any(|member| elements.contains(member)))
                    .map(|set| set.name.clone())
                    .collect()
            }
        }
    }

    fn vertices(&self, components: &[Component], of_triangle: &[u32]) -> Vec<Option<u32>> {
        // Components with one carrier count as one part of the surface.
        let mut target_area: BTreeMap<usize, f64> = BTreeMap::new();
        for component in components {
            *target_area.entry(component.target).or_default() += component.area;
        }
        let area = |component: u32| target_area[&components[component as usize].target];
        let mut of_vertex: Vec<Option<u32>> = vec![None; self.mesh.vertices.len()];
        for (triangle, component) in self.mesh.triangles.iter().zip(of_triangle) {
            for vertex in triangle {
                let slot = &mut of_vertex[*vertex as usize];
                let better = match *slot {
                    None => true,
                    Some(known) => (area(*component), known) > (area(known), *component),
                };
                if better {
                    *slot = Some(*component);
                }
            }
        }
        of_vertex
    }
}

fn named<'a>(sets: &'a [NamedSet], name: &str) -> Option<&'a [u32]> {
    let exact = sets.iter().find(|set| set.name == name);
    let found = exact.or_else(|| sets.iter().find(|set| set.name.eq_ignore_ascii_case(name)));
    found.map(|set| set.members.as_slice())
}

/// The faces of one target.
pub(crate) fn target_faces(skin: &Skin, target: &[u32]) -> Vec<Face> {
    target
        .iter()
        .map(|f| skin.faces[*f as usize].clone())
        .collect()
}
