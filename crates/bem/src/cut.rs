//! The surface with its trailing-edge vertices doubled.
//!
//! The potential jumps across a trailing edge, so that each vertex on it has an upper
//! and a lower value; their difference is the wake's jump κ. A free tip keeps one value:
//! the jump is zero there. A junction with a body is doubled too, by the first edge of
//! the body line; along the rest of the line the vertices stay single and the jump is
//! added on the corners of their upper triangles (`carry`).
//!
//! Where n trailing edges meet in one vertex they divide its triangles into n sectors with
//! a value each. One is the reference, the others' differences from it are n − 1 columns,
//! and the jump of each edge is the difference of its two sectors: counted one way round,
//! the jumps of the n sheets sum to zero, as they must where sheets meet in a line.

use crate::adjacency::{Adjacency, undirected};
use crate::body_path::BodyPaths;
use crate::carry::{CarriedCorner, Carrier, Join};
use crate::divided_edges::DividedEdge;
use crate::error::BemError;
use crate::image::on_plane;
use fladder_mesh::{TrailingEdge, TriMesh, Vec3};
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

/// Two values of one vertex: κ = φ(upper) − φ(lower).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Column {
    pub(crate) upper: u32,
    pub(crate) lower: u32,
}

/// A jump as weights of the columns' κ; empty where it is zero.
pub(crate) type Jump = Vec<(usize, f64)>;

/// Surface cut open along its trailing edges.
#[derive(Clone, Debug)]
pub(crate) struct CutSurface {
    pub(crate) vertices: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Mesh vertex of each vertex.
    pub(crate) source: Vec<u32>,
    pub(crate) columns: Vec<Column>,
    /// Jump at each vertex of each chain; empty at free tips.
    pub(crate) chain_jumps: Vec<Vec<Jump>>,
    /// Whether the first and the last vertex of each chain lie on a body.
    pub(crate) on_body: Vec<[bool; 2]>,
    /// Shares of body lines' jumps on corners of triangles.
    pub(crate) carried: Vec<CarriedCorner>,
    /// Body lines that end on other trailing edges.
    pub(crate) joins: Vec<Join>,
    /// Edges that leave trailing edges, divided in [`crate::edge_cells`].
    pub(crate) divided: Vec<DividedEdge>,
}

/// The sectors of one vertex.
struct Sectors {
    /// Sector of each triangle.
    of_triangle: HashMap<u32, usize>,
    /// Column of each sector, none of the reference.
    columns: Vec<Option<usize>>,
}

impl CutSurface {
    /// `half`: the mesh is open at y = 0, where trailing edges go on.
    pub(crate) fn new(
        mesh: &TriMesh,
        adjacency: &Adjacency<'_>,
        chains: &[TrailingEdge],
        paths: &BodyPaths,
        half: bool,
    ) -> Result<Self, BemError> {
        let carrier = Carrier {
            vertices: &mesh.vertices,
            adjacency,
            chains,
            paths,
        };
        let (carried, joins) = carrier.carry()?;
        let mut surface = Self {
            vertices: mesh.vertices.clone(),
            triangles: mesh.triangles.clone(),
            source: (0..mesh.vertices.len() as u32).collect(),
            columns: Vec::new(),
            chain_jumps: Vec::new(),
            on_body: (0..chains.len())
                .map(|c| [false, true].map(|last| paths.of_end(c, last).is_some()))
                .collect(),
            carried,
            joins,
            divided: Vec::new(),
        };
        let cuts = Cuts::new(chains, paths);
        let mut sectors: HashMap<u32, Option<Sectors>> = HashMap::new();
        for chain in chains {
            let mut jumps = Vec::with_capacity(chain.vertices.len());
            for (i, &vertex) in chain.vertices.iter().enumerate() {
                let edge = if i < chain.upper.len() { i } else { i - 1 };
                let [upper, lower] = [chain.upper[edge], chain.lower[edge]];
                let own = match sectors.entry(vertex) {
                    Entry::Occupied(known) => known.into_mut(),
                    Entry::Vacant(new) => {
                        new.insert(surface.divide(vertex, lower, adjacency, &cuts, half)?)
                    }
                };
                jumps.push(
                    own.as_ref()
                        .map_or_else(Jump::new, |s| s.jump(upper, lower)),
                );
            }
            surface.chain_jumps.push(jumps);
        }
        Ok(surface)
    }

    /// Gives each sector of a vertex its own number, the one with the triangle `reference`
    /// the old one. None at a free tip; on the plane of symmetry of a half model the edge
    /// goes on.
    fn divide(
        &mut self,
        vertex: u32,
        reference: u32,
        adjacency: &Adjacency<'_>,
        cuts: &Cuts,
        half: bool,
    ) -> Result<Option<Sectors>, BemError> {
        let cuts = &cuts.at[&vertex];
        let arriving = cuts.len();
        let p = self.vertices[vertex as usize];
        let on_plane = half && on_plane(&p);
        if arriving == 1 && !on_plane {
            return Ok(None);
        }
        let groups = adjacency.fan_groups(vertex, cuts);
        let expected = if on_plane { arriving + 1 } else { arriving };
        if groups.len() != expected {
            return Err(BemError::TrailingFan {
                vertex,
                x: p.x,
                y: p.y,
                z: p.z,
                edges: arriving,
                groups: groups.len(),
            });
        }
        let mut sectors = Sectors {
            of_triangle: HashMap::new(),
            columns: Vec::new(),
        };
        for (g, group) in groups.iter().enumerate() {
            sectors.of_triangle.extend(group.iter().map(|&t| (t, g)));
            if group.contains(&reference) {
                sectors.columns.push(None);
                continue;
            }
            let own = self.vertices.len() as u32;
            self.vertices.push(p);
            self.source.push(vertex);
            for &t in group {
                for v in &mut self.triangles[t as usize] {
                    if *v == vertex {
                        *v = own;
                    }
                }
            }
            self.columns.push(Column {
                upper: own,
                lower: vertex,
            });
            sectors.columns.push(Some(self.columns.len() - 1));
        }
        Ok(Some(sectors))
    }
}

impl Sectors {
    /// φ on the sector of one triangle less φ on that of another.
    fn jump(&self, upper: u32, lower: u32) -> Jump {
        let column = |t: u32| {
            let sector = self.of_triangle.get(&t)?;
            self.columns[*sector]
        };
        let plus = column(upper).map(|c| (c, 1.0));
        let minus = column(lower).map(|c| (c, -1.0));
        if plus.map(|p| p.0) == minus.map(|m| m.0) {
            return Jump::new();
        }
        plus.into_iter().chain(minus).collect()
    }
}

/// The edges that divide the triangles round each trailing-edge vertex: trailing edges,
/// and at a junction the first edge of the body line.
struct Cuts {
    at: HashMap<u32, HashSet<(u32, u32)>>,
}

impl Cuts {
    fn new(chains: &[TrailingEdge], paths: &BodyPaths) -> Self {
        let mut at: HashMap<u32, HashSet<(u32, u32)>> = HashMap::new();
        for [a, b] in chains.iter().flat_map(TrailingEdge::edges) {
            for v in [a, b] {
                at.entry(v).or_default().insert(undirected(a, b));
            }
        }
        for path in &paths.paths {
            let [junction, next] = [path.vertices[0], path.vertices[1]];
            at.entry(junction)
                .or_default()
                .insert(undirected(junction, next));
        }
        Self { at }
    }
}
