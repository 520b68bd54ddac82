//! Trailing edges: sharp edges that point downstream, or named by the user.
//!
//! With outward unit normals n₁, n₂ on the two sides of an edge,
//!
//! $$ \text{wedge} = 180^\circ - \angle(\mathbf n_1, \mathbf n_2), \qquad
//!    \mathbf e = \frac{\mathbf n_1 + \mathbf n_2}{\lvert\mathbf n_1 + \mathbf n_2\rvert} . $$
//!
//! A convex edge is sharp when its wedge is below a limit, and trailing when it
//! is sharp and e·x reaches another, x being the mesh axis. The leading edge of
//! a thin section is sharp too, but there e points forward; at a sharp tip it
//! points sideways.

use serde::{Deserialize, Serialize};

mod plane;

pub use plane::{in_plane_by_shape, in_plane_from_groups};

use crate::topology::runs_along;
use crate::{Topology, TriMesh, Vec3};
use plane::is_rim;

/// When an edge counts as trailing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Sharp: wedge angle below this, degrees.
    pub max_wedge_deg: f64,
    /// Trailing: sharp, and e·x at least this.
    pub min_downstream: f64,
}

impl Default for Settings {
    /// 60° and 0.3: sections end at 10 to 30°, square tips at 90°; a trailing
    /// edge swept by 72° still counts.
    fn default() -> Self {
        Self {
            max_wedge_deg: 60.0,
            min_downstream: 0.3,
        }
    }
}

/// Why named groups give no trailing edge.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrailingEdgeError {
    /// No curve group of that name.
    #[error("the mesh has no curve group `{name}`; it has {}", listed(.there))]
    UnknownGroup {
        /// Name asked for.
        name: String,
        /// Names there are.
        there: Vec<String>,
    },
    /// A line element that joins two vertices no triangle joins.
    #[error("line {position} of curve group `{name}` joins vertices {} and {}, which no triangle joins", edge[0], edge[1])]
    NotAnEdge {
        /// Name of the group.
        name: String,
        /// Place in the group, from 0.
        position: usize,
        /// The two vertices.
        edge: [u32; 2],
    },
    /// An edge that does not separate two sides.
    #[error("line {position} of curve group `{name}`, vertices {} and {}, has {triangles} triangles; a trailing edge needs 2 of the same orientation", edge[0], edge[1])]
    NotTwoSided {
        /// Name of the group.
        name: String,
        /// Place in the group, from 0.
        position: usize,
        /// The two vertices.
        edge: [u32; 2],
        /// Triangles at the edge.
        triangles: usize,
    },
}

fn listed(names: &[String]) -> String {
    if names.is_empty() {
        return "none".into();
    }
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    quoted.join(", ")
}

/// A chain of trailing edges.
///
/// Edge `i` runs from `vertices[i]` to `vertices[i + 1]`, from the last vertex
/// back to the first when the chain is closed. The upper side has the larger
/// mean normal component along z, or along y when the chain is that of an
/// upright fin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrailingEdge {
    /// Vertices in order, each once.
    pub vertices: Vec<u32>,
    /// The triangle of each edge that runs from `vertices[i]` to `vertices[i + 1]`.
    pub upper: Vec<u32>,
    /// The triangle of each edge that runs the other way.
    pub lower: Vec<u32>,
    /// Whether the last vertex is joined to the first.
    pub closed: bool,
}

impl TrailingEdge {
    /// Vertex pairs of the edges, in order.
    pub fn edges(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        (0..self.upper.len()).map(|i| {
            [
                self.vertices[i],
                self.vertices[(i + 1) % self.vertices.len()],
            ]
        })
    }

    /// Length of the chain, m.
    pub fn length(&self, mesh: &TriMesh) -> f64 {
        let at = |v: u32| mesh.vertices[v as usize];
        self.edges().map(|[a, b]| (at(b) - at(a)).norm()).sum()
    }
}

/// All trailing edges the geometry shows, in the order of the mesh's numbering.
///
/// Edges with other than two triangles of the same orientation are passed
/// over, and so are the rims of a surface folded onto itself, where e has no
/// direction.
pub fn find_by_shape(
    mesh: &TriMesh,
    topology: &Topology,
    settings: Settings,
) -> Vec<TrailingEdge> {
    let trailing: Vec<usize> = (0..topology.edges.len())
        .filter(|&edge| is_trailing(mesh, topology, edge, settings))
        .collect();
    chains(mesh, topology, &trailing)
}

/// The trailing edges in the named curve groups, whatever their angle.
///
/// # Errors
/// An unknown name, a line that is not an edge of the mesh, an edge without
/// two sides.
pub fn find_from_groups<S: AsRef<str>>(
    mesh: &TriMesh,
    topology: &Topology,
    names: &[S],
) -> Result<Vec<TrailingEdge>, TrailingEdgeError> {
    from_groups(mesh, topology, names, false)
}

/// As [`find_from_groups`], on a half model: edges in its symmetry plane, which
/// have one side there, are passed over.
///
/// # Errors
/// As [`find_from_groups`].
pub fn find_from_groups_of_half<S: AsRef<str>>(
    mesh: &TriMesh,
    topology: &Topology,
    names: &[S],
) -> Result<Vec<TrailingEdge>, TrailingEdgeError> {
    from_groups(mesh, topology, names, true)
}

fn from_groups<S: AsRef<str>>(
    mesh: &TriMesh,
    topology: &Topology,
    names: &[S],
    is_half: bool,
) -> Result<Vec<TrailingEdge>, TrailingEdgeError> {
    let mut trailing = Vec::new();
    for name in names {
        let name = name.as_ref();
        let group = mesh
            .curve(name)
            .ok_or_else(|| TrailingEdgeError::UnknownGroup {
                name: name.into(),
                there: mesh.curves.iter().map(|curve| curve.name.clone()).collect(),
            })?;
        for (position, &edge) in group.edges.iter().enumerate() {
            let name = || name.to_owned();
            let index = topology.edge_between(edge[0], edge[1]).ok_or_else(|| {
                TrailingEdgeError::NotAnEdge {
                    name: name(),
                    position,
                    edge,
                }
            })?;
            if is_half && is_rim(mesh, topology, index) {
                continue;
            }
            if sides(mesh, topology, index).is_none() {
                let triangles = topology.edge_triangles(index).len();
                return Err(TrailingEdgeError::NotTwoSided {
                    name: name(),
                    position,
                    edge,
                    triangles,
                });
            }
            trailing.push(index);
        }
    }
    trailing.sort_unstable();
    trailing.dedup();
    Ok(chains(mesh, topology, &trailing))
}

/// Wedge angle of an edge in degrees, and the downstream component e·x.
///
/// The wedge exceeds 180° where the surface is concave. `None` where the edge
/// has not two triangles of the same orientation and non-zero area, or where
/// the normals cancel.
pub fn wedge_and_downstream(
    mesh: &TriMesh,
    topology: &Topology,
    edge: usize,
) -> Option<(f64, f64)> {
    let [left, right] = sides(mesh, topology, edge)?;
    let n1 = mesh.area_vector(left as usize).try_normalize(0.0)?;
    let n2 = mesh.area_vector(right as usize).try_normalize(0.0)?;
    let direction = (n1 + n2).try_normalize(f64::EPSILON)?;
    let angle = n1.cross(&n2).norm().atan2(n1.dot(&n2)).to_degrees();
    let [from, to] = topology.edges[edge].map(|v| mesh.vertices[v as usize]);
    // Seen along the edge, the left triangle's normal turns towards the right
    // one's across a convex edge.
    let is_convex = n1.cross(&n2).dot(&(to - from)) >= 0.0;
    Some((
        if is_convex {
            180.0 - angle
        } else {
            180.0 + angle
        },
        direction.x,
    ))
}

fn is_trailing(mesh: &TriMesh, topology: &Topology, edge: usize, settings: Settings) -> bool {
    wedge_and_downstream(mesh, topology, edge).is_some_and(|(wedge, downstream)| {
        wedge < settings.max_wedge_deg && downstream >= settings.min_downstream
    })
}

/// The triangles left and right of an edge, lower vertex to higher.
fn sides(mesh: &TriMesh, topology: &Topology, edge: usize) -> Option<[u32; 2]> {
    let [from, to] = topology.edges[edge];
    let &[first, second] = topology.edge_triangles(edge) else {
        return None;
    };
    let left = |t: u32| runs_along(mesh.triangles[t as usize], from, to);
    match (left(first), left(second)) {
        (true, false) => Some([first, second]),
        (false, true) => Some([second, first]),
        _ => None,
    }
}

/// Joins edges into chains, cut where other than two of them meet.
fn chains(mesh: &TriMesh, topology: &Topology, trailing: &[usize]) -> Vec<TrailingEdge> {
    let mut at_vertex: std::collections::BTreeMap<u32, Vec<usize>> =
        std::collections::BTreeMap::new();
    for (k, &edge) in trailing.iter().enumerate() {
        for vertex in topology.edges[edge] {
            at_vertex.entry(vertex).or_default().push(k);
        }
    }
    let is_end = |vertex: u32| at_vertex[&vertex].len() != 2;
    let mut used = vec![false; trailing.len()];
    let mut walk = |start: u32, first: usize| {
        let (mut path, mut k) = (vec![start], first);
        while !used[k] {
            used[k] = true;
            let [a, b] = topology.edges[trailing[k]];
            let here = path[path.len() - 1];
            let next = if a == here { b } else { a };
            path.push(next);
            if is_end(next) {
                break;
            }
            let at = &at_vertex[&next];
            k = if at[0] == k { at[1] } else { at[0] };
        }
        path
    };
    let mut paths = Vec::new();
    for ends_first in [true, false] {
        for (&vertex, edges) in &at_vertex {
            if is_end(vertex) == ends_first {
                paths.extend(
                    edges
                        .iter()
                        .map(|&k| walk(vertex, k))
                        .filter(|path| path.len() > 1),
                );
            }
        }
    }
    paths.sort_by_key(|path| path.iter().copied().min());
    paths
        .into_iter()
        .map(|path| oriented(mesh, topology, path))
        .collect()
}

/// Gives a path its sides and its direction.
fn oriented(mesh: &TriMesh, topology: &Topology, mut path: Vec<u32>) -> TrailingEdge {
    let first = side_triangles(mesh, topology, &path);
    let difference = |[left, right]: &[u32; 2], edge: &[u32]| {
        let normal = |t: u32| {
            mesh.area_vector(t as usize)
                .try_normalize(0.0)
                .unwrap_or_default()
        };
        let [a, b] = [edge[0], edge[1]].map(|v| mesh.vertices[v as usize]);
        (normal(*left) - normal(*right)) * (b - a).norm()
    };
    let upward: Vec3 = first
        .iter()
        .zip(path.windows(2))
        .map(|(t, edge)| difference(t, edge))
        .sum();
    // Within 6° of upright the sign of z may be round-off.
    let is_fin = upward.z.abs() < 0.1 * upward.y.abs();
    let is_upper_left = if is_fin { upward.y } else { upward.z } >= 0.0;
    if !is_upper_left {
        path.reverse();
    }
    let sides = if is_upper_left {
        first
    } else {
        side_triangles(mesh, topology, &path)
    };
    let closed = path.len() > 2 && path.first() == path.last();
    if closed {
        path.pop();
    }
    TrailingEdge {
        vertices: path,
        upper: sides.iter().map(|side| side[0]).collect(),
        lower: sides.iter().map(|side| side[1]).collect(),
        closed,
    }
}

/// For every step of the path, the triangle along it and the one against it.
fn side_triangles(mesh: &TriMesh, topology: &Topology, path: &[u32]) -> Vec<[u32; 2]> {
    path.windows(2)
        .map(|step| {
            let edge = topology
                .edge_between(step[0], step[1])
                .expect("paths follow edges");
            let [left, right] =
                sides(mesh, topology, edge).expect("chosen edges have two sides");
            if step[0] < step[1] {
                [left, right]
            } else {
                [right, left]
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{Extent, NacaWing, icosphere};

    #[test]
    fn the_trailing_edge_of_a_wing_is_one_chain_from_port_to_starboard() {
        let wing = NacaWing::default();
        let mesh = wing.structured().unwrap();
        let topology = Topology::new(&mesh);
        let found = find_by_shape(&mesh, &topology, Settings::default());
        assert_eq!(found.len(), 1);
        let chain = &found[0];
        assert!(!chain.closed);
        assert!((chain.length(&mesh) - wing.span).abs() < 1e-12 * wing.span);
        for ([from, to], (&up, &low)) in chain.edges().zip(chain.upper.iter().zip(&chain.lower))
        {
            let y = |v: u32| mesh.vertices[v as usize].y;
            assert!(y(from) < y(to));
            assert!(runs_along(mesh.triangles[up as usize], from, to));
            assert!(runs_along(mesh.triangles[low as usize], to, from));
            assert!(mesh.area_vector(up as usize).z > 0.0);
            assert!(mesh.area_vector(low as usize).z < 0.0);
        }
        assert_eq!(find_from_groups(&mesh, &topology, &["te"]), Ok(found));
    }

    /// Rolled to stand upright, the wing is a fin: the side with +y is upper.
    #[test]
    fn the_upper_side_of_a_fin_faces_starboard() {
        let mut mesh = NacaWing {
            extent: Extent::Half,
            ..NacaWing::default()
        }
        .structured()
        .unwrap();
        for p in &mut mesh.vertices {
            *p = Vec3::new(p.x, p.z, -p.y);
        }
        let topology = Topology::new(&mesh);
        let found = find_by_shape(&mesh, &topology, Settings::default());
        assert_eq!(found.len(), 1);
        assert!(
            found[0]
                .upper
                .iter()
                .all(|&t| mesh.area_vector(t as usize).y > 0.0)
        );
    }

    #[test]
    fn a_sphere_has_no_trailing_edge() {
        let mesh = icosphere(6);
        let topology = Topology::new(&mesh);
        assert_eq!(find_by_shape(&mesh, &topology, Settings::default()), []);
    }

    /// A lens: two cones base to base have one sharp rim. With x along its
    /// axis, e is radial and nothing trails; without the downstream limit
    /// the whole rim is one closed chain.
    #[test]
    fn a_rim_is_a_closed_chain() {
        let n = 12_u32;
        let mut mesh = TriMesh::default();
        for k in 0..n {
            let angle = f64::from(k) / f64::from(n) * std::f64::consts::TAU;
            mesh.vertices.push(Vec3::new(angle.cos(), angle.sin(), 0.0));
        }
        mesh.vertices
            .extend([Vec3::new(0.0, 0.0, 0.1), Vec3::new(0.0, 0.0, -0.1)]);
        for k in 0..n {
            let next = (k + 1) % n;
            mesh.triangles.extend([[k, next, n], [next, k, n + 1]]);
        }
        let topology = Topology::new(&mesh);
        let all = Settings {
            min_downstream: -1.0,
            ..Settings::default()
        };
        let found = find_by_shape(&mesh, &topology, all);
        assert_eq!(found.len(), 1);
        assert!(found[0].closed);
        assert_eq!((found[0].vertices.len(), found[0].upper.len()), (12, 12));
        let aft = find_by_shape(&mesh, &topology, Settings::default());
        assert_eq!(aft.len(), 1);
        assert!(!aft[0].closed && aft[0].upper.len() < 12);
    }

    #[test]
    fn chains_are_cut_where_three_trailing_edges_meet() {
        // Groups may name any edges: the three around one triangle corner.
        let mut mesh = icosphere(2);
        let topology = Topology::new(&mesh);
        let hub = 0_u32;
        let spokes: Vec<[u32; 2]> = topology
            .edges
            .iter()
            .filter(|e| e.contains(&hub))
            .take(3)
            .copied()
            .collect();
        mesh.curves.push(crate::CurveGroup {
            name: "spokes".into(),
            edges: spokes,
        });
        let found = find_from_groups(&mesh, &topology, &["spokes"]).unwrap();
        assert_eq!(
            found
                .iter()
                .map(|chain| chain.upper.len())
                .collect::<Vec<_>>(),
            [1, 1, 1]
        );
    }

    #[test]
    fn an_unknown_group_is_refused_with_the_names_there_are() {
        let mesh = NacaWing::default().structured().unwrap();
        let error = find_from_groups(&mesh, &Topology::new(&mesh), &["tee"]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the mesh has no curve group `tee`; it has `te`"
        );
    }

    #[test]
    fn a_line_off_the_mesh_and_a_rim_are_refused() {
        let mut mesh = NacaWing {
            extent: Extent::Half,
            ..NacaWing::default()
        }
        .structured()
        .unwrap();
        let topology = Topology::new(&mesh);
        let far = mesh.vertices.len() as u32 - 1;
        mesh.curves.push(crate::CurveGroup {
            name: "off".into(),
            edges: vec![[0, far]],
        });
        mesh.curves.push(crate::CurveGroup {
            name: "rim".into(),
            edges: vec![[0, 1]],
        });
        let off = find_from_groups(&mesh, &topology, &["off"]).unwrap_err();
        assert!(
            matches!(off, TrailingEdgeError::NotAnEdge { position: 0, .. }),
            "{off}"
        );
        let rim = find_from_groups(&mesh, &topology, &["rim"]).unwrap_err();
        assert!(
            matches!(rim, TrailingEdgeError::NotTwoSided { triangles: 1, .. }),
            "{rim}"
        );
    }
}
