//! Unit sphere and ellipsoid from the icosahedron.
//!
//! Each of the 20 faces is cut into n² triangles and its points are pushed to
//! the unit sphere along their radius: 20 n² triangles, 10 n² + 2 vertices.

use std::collections::BTreeMap;

use crate::{SurfaceGroup, TriMesh, Vec3};

/// Corners of the icosahedron: the cyclic permutations of (0, ±1, ±φ).
fn icosahedron_corners() -> [Vec3; 12] {
    let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mut corners = [Vec3::zeros(); 12];
    for (k, corner) in corners.iter_mut().enumerate() {
        let axis = k / 4;
        let short = if k % 2 == 0 { 1.0 } else { -1.0 };
        let long = if k % 4 < 2 { golden } else { -golden };
        corner[(axis + 1) % 3] = short;
        corner[(axis + 2) % 3] = long;
    }
    corners
}

/// The 20 triples of mutually adjacent corners, outward.
fn icosahedron_faces(corners: &[Vec3; 12]) -> Vec<[usize; 3]> {
    // Edges have length 2, all other distances are at least 2 φ.
    let adjacent = |a: usize, b: usize| (corners[a] - corners[b]).norm() < 2.5;
    let mut faces = Vec::with_capacity(20);
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if adjacent(a, b) && adjacent(b, c) && adjacent(a, c) {
                    let outward = corners[a].dot(&corners[b].cross(&corners[c])) > 0.0;
                    faces.push(if outward { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    faces
}

/// Unit sphere with every face of the icosahedron cut into n² triangles.
///
/// All vertices have radius 1, so the volume is low by O(1/n²). The surface
/// group is `body`. `n = 0` counts as 1.
pub fn icosphere(n: usize) -> TriMesh {
    let n = n.max(1);
    let corners = icosahedron_corners();
    let mut mesh = TriMesh::default();
    let mut known = BTreeMap::new();
    for face in icosahedron_faces(&corners) {
        let mut point = |along_b: usize, along_c: usize| {
            let weights = [n - along_b - along_c, along_b, along_c];
            let mut key: Vec<(usize, usize)> = face.into_iter().zip(weights).collect();
            key.retain(|&(_, weight)| weight > 0);
            key.sort_unstable();
            let sum: Vec3 = key
                .iter()
                .map(|&(c, weight)| corners[c] * weight as f64)
                .sum();
            *known.entry(key).or_insert_with(|| {
                mesh.vertices.push(sum.normalize());
                mesh.vertices.len() as u32 - 1
            })
        };
        for i in 0..n {
            for j in 0..n - i {
                let (a, b, c) = (point(i, j), point(i + 1, j), point(i, j + 1));
                mesh.triangles.push([a, b, c]);
                if i + j + 1 < n {
                    mesh.triangles.push([b, point(i + 1, j + 1), c]);
                }
            }
        }
    }
    let all = (0..mesh.triangles.len() as u32).collect();
    mesh.surfaces = vec![SurfaceGroup {
        name: "body".into(),
        triangles: all,
    }];
    mesh
}

/// Ellipsoid with the given semi-axes along x, y, z: a stretched [`icosphere`].
///
/// All vertices lie on `(x/a)² + (y/b)² + (z/c)² = 1`; semi-axes positive.
pub fn ellipsoid(semi_axes: [f64; 3], n: usize) -> TriMesh {
    let mut mesh = icosphere(n);
    for vertex in &mut mesh.vertices {
        vertex.component_mul_assign(&Vec3::from(semi_axes));
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn an_icosphere_has_20_n2_triangles_and_10_n2_plus_2_vertices() {
        for n in [1, 2, 3, 7] {
            let mesh = icosphere(n);
            assert_eq!(mesh.triangles.len(), 20 * n * n);
            assert_eq!(mesh.vertices.len(), 10 * n * n + 2);
        }
    }

    /// Volume 4π abc/3, approached from inside with error O(1/n²).
    #[test]
    fn the_volume_of_an_ellipsoid_converges_at_second_order() {
        let semi_axes = [2.0, 1.0, 0.5];
        let exact = 4.0 / 3.0 * PI * semi_axes.iter().product::<f64>();
        let errors = [4, 8, 16].map(|n| exact - ellipsoid(semi_axes, n).volume());
        let orders = [0, 1].map(|i| (errors[i] / errors[i + 1]).log2());
        println!("errors {errors:?}, orders {orders:?}");
        assert!(errors.iter().all(|&e| e > 0.0));
        assert!(orders.iter().all(|&o| (1.9..2.1).contains(&o)));
    }
}
