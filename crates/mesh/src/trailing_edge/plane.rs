//! Trailing edges of central fins, in the plane that cuts a half model.
//!
//! In the symmetry plane y = 0 of a half model the other side of an edge is the
//! mirror image of the one that is there, n₂ = (n₁ₓ, −n₁ᵧ, n₁_z). Such an edge,
//! that of a central fin, is in no chain: symmetric motion makes no jump across
//! the plane.

use super::Settings;
use crate::{Topology, TriMesh};

/// The trailing edges in the symmetry plane y = 0 of a half model, by shape.
pub fn in_plane_by_shape(
    mesh: &TriMesh,
    topology: &Topology,
    settings: Settings,
) -> Vec<[u32; 2]> {
    let is_trailing = |edge: &usize| {
        wedge_in_plane(mesh, topology, *edge).is_some_and(|(wedge, downstream)| {
            wedge < settings.max_wedge_deg && downstream >= settings.min_downstream
        })
    };
    (0..topology.edges.len())
        .filter(is_trailing)
        .map(|edge| topology.edges[edge])
        .collect()
}

/// The edges of the named curve groups that lie in the symmetry plane y = 0 of
/// a half model.
pub fn in_plane_from_groups<S: AsRef<str>>(
    mesh: &TriMesh,
    topology: &Topology,
    names: &[S],
) -> Vec<[u32; 2]> {
    let groups = names.iter().filter_map(|name| mesh.curve(name.as_ref()));
    groups
        .flat_map(|group| &group.edges)
        .copied()
        .filter(|[a, b]| {
            topology
                .edge_between(*a, *b)
                .is_some_and(|edge| is_rim(mesh, topology, edge))
        })
        .collect()
}

/// Whether a half model ends at the edge, in the plane y = 0.
pub(super) fn is_rim(mesh: &TriMesh, topology: &Topology, edge: usize) -> bool {
    topology.edge_triangles(edge).len() == 1
        && topology.edges[edge]
            .iter()
            .all(|&v| mesh.vertices[v as usize].y == 0.0)
}

/// Wedge angle in degrees between a half model and its mirror image, and the
/// downstream component e·x.
fn wedge_in_plane(mesh: &TriMesh, topology: &Topology, edge: usize) -> Option<(f64, f64)> {
    if !is_rim(mesh, topology, edge) {
        return None;
    }
    let triangle = topology.edge_triangles(edge)[0];
    let normal = mesh.area_vector(triangle as usize).try_normalize(0.0)?;
    let direction = (normal + crate::mirrored(normal)).try_normalize(f64::EPSILON)?;
    // The normal of a convex side points away from its image.
    let half_wedge = normal.x.hypot(normal.z).atan2(normal.y).to_degrees();
    Some((2.0 * half_wedge, direction.x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;
    use crate::shapes::{Extent, NacaWing};
    use crate::trailing_edge::{find_by_shape, find_from_groups_of_half, wedge_and_downstream};

    /// Cut at its middle plane, an upright wing is a central fin: its trailing
    /// edge lies in the plane, and its leading edge points forward.
    #[test]
    fn the_trailing_edge_of_a_central_fin_lies_in_the_plane() {
        let wing = NacaWing {
            extent: Extent::Half,
            ..NacaWing::default()
        };
        let whole = wing.structured().unwrap();
        let mut mesh = TriMesh {
            vertices: whole.vertices.clone(),
            curves: whole.curves.clone(),
            ..TriMesh::default()
        };
        for p in &mut mesh.vertices {
            *p = Vec3::new(p.x, p.z, -p.y);
        }
        // The flat tip crosses the plane: it is left out, open or not.
        let is_starboard = |t: &&[u32; 3]| {
            let y = |v: &u32| mesh.vertices[*v as usize].y;
            t.iter().all(|v| y(v) >= 0.0)
        };
        mesh.triangles = whole
            .triangles
            .iter()
            .filter(is_starboard)
            .copied()
            .collect();
        let topology = Topology::new(&mesh);
        let settings = Settings::default();
        let found = in_plane_by_shape(&mesh, &topology, settings);
        assert_eq!(found.len(), wing.n_half_span);
        let at_end = |v: u32| (mesh.vertices[v as usize].x - wing.chord).abs() < 1e-12;
        assert!(found.iter().flatten().all(|&v| at_end(v)));
        let edge = topology.edge_between(found[0][0], found[0][1]).unwrap();
        let (wedge, downstream) = wedge_in_plane(&mesh, &topology, edge).unwrap();
        // Both triangles of the whole wing's edge: the same wedge.
        let both = Topology::new(&whole);
        let edge = both.edge_between(found[0][0], found[0][1]).unwrap();
        let expected = wedge_and_downstream(&whole, &both, edge).unwrap();
        assert!((wedge - expected.0).abs() < 1e-9 && (downstream - expected.1).abs() < 1e-12);
        assert_eq!(find_by_shape(&mesh, &topology, settings), []);
        assert_eq!(
            find_from_groups_of_half(&mesh, &topology, &["te"]),
            Ok(vec![])
        );
        let named = in_plane_from_groups(&mesh, &topology, &["te"]);
        assert_eq!(named.len(), wing.n_half_span);
    }
}
