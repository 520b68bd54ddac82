//! Triangles by their corners, made a mesh.

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

    /// Corners in one place made one, triangles without area left out.
    pub(super) fn closed(self) -> TriMesh {
        let points: Vec<Vec3> = self.triangles.iter().flatten().copied().collect();
        let weld = weld(&points, 1e-9);
        let triangles: Vec<[u32; 3]> = weld
            .image
            .chunks_exact(3)
            .map(|t| [t[0], t[1], t[2]])
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        let all = (0..triangles.len() as u32).collect();
        TriMesh {
            vertices: weld.kept.iter().map(|&old| points[old as usize]).collect(),
            triangles,
            surfaces: vec![SurfaceGroup {
                name: "aircraft".into(),
                triangles: all,
            }],
            curves: Vec::new(),
        }
    }
}
