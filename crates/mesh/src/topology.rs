//! Which triangles meet at which edges and vertices.
//!
//! Edges are stored once, with the lower vertex first, in ascending order, so
//! that their numbering depends on the mesh alone. Nothing is assumed about
//! the surface: an edge may have one, two or more triangles.

use crate::TriMesh;

/// Adjacency of the edges, triangles and vertices of one mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Topology {
    /// Vertex pairs, lower index first, ascending.
    pub edges: Vec<[u32; 2]>,
    /// Edges of every triangle: edge `k` joins corner `k` to corner `k + 1`.
    pub triangle_edges: Vec<[u32; 3]>,
    edge_triangles: Rows,
    vertex_triangles: Rows,
}

/// Lists of unequal length, one after the other.
#[derive(Clone, Debug, Default, PartialEq)]
struct Rows {
    starts: Vec<usize>,
    entries: Vec<u32>,
}

impl Rows {
    /// Gathers `(row, entry)` pairs, keeping their order within a row.
    fn new(n_rows: usize, pairs: impl Iterator<Item = (usize, u32)> + Clone) -> Self {
        let mut starts = vec![0; n_rows + 1];
        for (row, _) in pairs.clone() {
            starts[row + 1] += 1;
        }
        for row in 0..n_rows {
            starts[row + 1] += starts[row];
        }
        let mut entries = vec![0; starts[n_rows]];
        let mut next = starts.clone();
        for (row, entry) in pairs {
            entries[next[row]] = entry;
            next[row] += 1;
        }
        Self { starts, entries }
    }

    fn row(&self, row: usize) -> &[u32] {
        &self.entries[self.starts[row]..self.starts[row + 1]]
    }
}

impl Topology {
    /// Adjacency of `mesh`, in O(n log n).
    ///
    /// # Panics
    /// When a triangle names a vertex that is not there; the judge finds
    /// such triangles first.
    pub fn new(mesh: &TriMesh) -> Self {
        let mut edges: Vec<[u32; 2]> = mesh.triangles.iter().flat_map(sides).collect();
        edges.sort_unstable();
        edges.dedup();
        let triangle_edges: Vec<[u32; 3]> = mesh
            .triangles
            .iter()
            .map(|t| {
                sides(t).map(|side| {
                    edges
                        .binary_search(&side)
                        .expect("every side was collected above") as u32
                })
            })
            .collect();
        let edge_triangles = Rows::new(edges.len(), incidences(&triangle_edges));
        let vertex_triangles = Rows::new(mesh.vertices.len(), incidences(&mesh.triangles));
        Self {
            edges,
            triangle_edges,
            edge_triangles,
            vertex_triangles,
        }
    }

    /// Triangles that share an edge, ascending.
    pub fn edge_triangles(&self, edge: usize) -> &[u32] {
        self.edge_triangles.row(edge)
    }

    /// Triangles that share a vertex, ascending.
    pub fn vertex_triangles(&self, vertex: usize) -> &[u32] {
        self.vertex_triangles.row(vertex)
    }

    /// The edge between two vertices, in either order.
    pub fn edge_between(&self, from: u32, to: u32) -> Option<usize> {
        self.edges.binary_search(&[from.min(to), from.max(to)]).ok()
    }
}

/// The three sides of a triangle, lower vertex first.
fn sides(t: &[u32; 3]) -> [[u32; 2]; 3] {
    [0, 1, 2].map(|k| {
        let (a, b) = (t[k], t[(k + 1) % 3]);
        [a.min(b), a.max(b)]
    })
}

/// Pairs (entity, triangle) of a triangle-to-entity table.
fn incidences(table: &[[u32; 3]]) -> impl Iterator<Item = (usize, u32)> + Clone + '_ {
    table
        .iter()
        .enumerate()
        .flat_map(|(triangle, row)| row.map(|entity| (entity as usize, triangle as u32)))
}

/// Whether the triangle runs through the edge from `from` to `to`.
pub(crate) fn runs_along(triangle: [u32; 3], from: u32, to: u32) -> bool {
    (0..3).any(|k| triangle[k] == from && triangle[(k + 1) % 3] == to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    /// V − E + F = 2 on a sphere, two triangles on every edge.
    #[test]
    fn a_sphere_has_euler_characteristic_two() {
        let mesh = shapes::icosphere(5);
        let topology = Topology::new(&mesh);
        let euler = mesh.vertices.len() + mesh.triangles.len() - topology.edges.len();
        assert_eq!(euler, 2);
        assert!((0..topology.edges.len()).all(|e| topology.edge_triangles(e).len() == 2));
    }

    /// Every listed incidence holds in the triangle table, both ways.
    #[test]
    fn incidences_agree_with_the_triangle_table() {
        let mesh = shapes::icosphere(3);
        let topology = Topology::new(&mesh);
        let mut seen = 0;
        for vertex in 0..mesh.vertices.len() {
            for &t in topology.vertex_triangles(vertex) {
                assert!(mesh.triangles[t as usize].contains(&(vertex as u32)));
                seen += 1;
            }
        }
        assert_eq!(seen, 3 * mesh.triangles.len());
        for (t, edges) in topology.triangle_edges.iter().enumerate() {
            for (k, &e) in edges.iter().enumerate() {
                let [a, b] = [mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]];
                assert_eq!(topology.edge_between(a, b), Some(e as usize));
                assert!(topology.edge_triangles(e as usize).contains(&(t as u32)));
            }
        }
    }
}
