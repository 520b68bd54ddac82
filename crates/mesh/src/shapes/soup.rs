//! Triangles by their corners, made a mesh.

use std::collections::HashMap;

use crate::weld::weld;
use crate::{SurfaceGroup, TriMesh, Vec3};

/// Triangles by their corners.
#[derive(Default)]
pub(super) struct Soup {
    triangles: Vec<[Vec3; 3]>,
}

impl Soup {
    pub(super) fn add(&mut self, triangle: [Vec3; 3]) {
        self.triangles.push(triangle);
    }

    /// Cut from the first corner to the third.
    pub(super) fn quadrilateral(&mut self, [a, b, c, d]: [Vec3; 4]) {
        self.add([a, b, c]);
        self.add([a, c, d]);
    }

    /// Corners in one place made one; triangles without area, and pairs that lie on each
    /// other back to back at a sharp corner, left out.
    pub(super) fn closed(self) -> TriMesh {
        let points: Vec<Vec3> = self.triangles.iter().flatten().copied().collect();
        let weld = weld(&points, 1e-9);
        let mut triangles: Vec<[u32; 3]> = weld
            .image
            .chunks_exact(3)
            .map(|t| [t[0], t[1], t[2]])
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        let corners = |t: &[u32; 3]| {
            let mut sorted = *t;
            sorted.sort_unstable();
            sorted
        };
        let mut count: HashMap<[u32; 3], usize> = HashMap::new();
        for t in &triangles {
            *count.entry(corners(t)).or_insert(0) += 1;
        }
        triangles.retain(|t| count[&corners(t)] == 1);
        let mut vertices = Vec::new();
        let mut number = HashMap::new();
        for v in triangles.iter_mut().flatten() {
            *v = *number.entry(*v).or_insert_with(|| {
                vertices.push(points[weld.kept[*v as usize] as usize]);
                vertices.len() as u32 - 1
            });
        }
        let all = (0..triangles.len() as u32).collect();
        TriMesh {
            vertices,
            triangles,
            surfaces: vec![SurfaceGroup {
                name: "aircraft".into(),
                triangles: all,
            }],
            curves: Vec::new(),
        }
    }
}
