//! Parts that every wing has: tip caps, mirror image, named groups.

use crate::{CurveGroup, SurfaceGroup, TriMesh, Vec3};

/// Triangles with normal +y between two chains from leading to trailing edge.
///
/// Both chains share their end points; the chain whose next point is further
/// forward advances.
pub(super) fn cap_strip(vertices: &[Vec3], upper: &[u32], lower: &[u32]) -> Vec<[u32; 3]> {
    let (last_upper, last_lower) = (upper.len() - 2, lower.len() - 2);
    let x = |v: u32| vertices[v as usize].x;
    let (mut a, mut b) = (1, 1);
    let mut strip = vec![[upper[0], upper[1], lower[1]]];
    while a < last_upper || b < last_lower {
        let upper_first =
            b == last_lower || (a < last_upper && x(upper[a + 1]) <= x(lower[b + 1]));
        if upper_first {
            strip.push([lower[b], upper[a], upper[a + 1]]);
            a += 1;
        } else {
            strip.push([lower[b], upper[a], lower[b + 1]]);
            b += 1;
        }
    }
    strip.push([lower[b], upper[a], upper[a + 1]]);
    strip
}

/// Adds an edge to the curve group `te`.
pub(super) fn add_trailing_edge(mesh: &mut TriMesh, from: u32, to: u32) {
    if mesh.curves.is_empty() {
        mesh.curves.push(CurveGroup {
            name: "te".into(),
            edges: Vec::new(),
        });
    }
    mesh.curves[0].edges.push([from, to]);
}

/// Puts all triangles into the surface group `wing`.
pub(super) fn with_wing_group(mut mesh: TriMesh) -> TriMesh {
    let all = (0..mesh.triangles.len() as u32).collect();
    mesh.surfaces = vec![SurfaceGroup {
        name: "wing".into(),
        triangles: all,
    }];
    mesh
}

/// A starboard half and its mirror image, joined at the vertices with y = 0.
pub(super) fn mirrored(half: TriMesh) -> TriMesh {
    let mut mesh = half;
    let (n_triangles, n_edges) = (mesh.triangles.len(), mesh.curves[0].edges.len());
    let mut image = Vec::with_capacity(mesh.vertices.len());
    for v in 0..mesh.vertices.len() {
        let p = mesh.vertices[v];
        image.push(if p.y == 0.0 {
            v as u32
        } else {
            mesh.vertices.len() as u32
        });
        if p.y != 0.0 {
            mesh.vertices.push(Vec3::new(p.x, -p.y, p.z));
        }
    }
    for t in 0..n_triangles {
        let [a, b, c] = mesh.triangles[t].map(|v| image[v as usize]);
        mesh.triangles.push([a, c, b]);
    }
    for e in 0..n_edges {
        let [a, b] = mesh.curves[0].edges[e].map(|v| image[v as usize]);
        mesh.curves[0].edges.push([b, a]);
    }
    mesh
}
