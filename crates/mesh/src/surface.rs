//! The surface itself, and displacement fields on it.

use serde::{Deserialize, Serialize};

/// A point or vector in mesh axes: x aft, y to starboard, z up; metres.
pub type Vec3 = nalgebra::Vector3<f64>;

/// A closed triangle surface with named parts.
///
/// Triangles are counter-clockwise seen from the fluid, so that the normal
/// `(v1 − v0) × (v2 − v0)` points out of the body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriMesh {
    /// Vertex positions, metres.
    pub vertices: Vec<Vec3>,
    /// Three vertex indices a triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Named sets of triangles.
    pub surfaces: Vec<SurfaceGroup>,
    /// Named sets of edges.
    pub curves: Vec<CurveGroup>,
}

/// A named set of triangles, for example one control surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceGroup {
    /// Name in the mesh file.
    pub name: String,
    /// Triangle indices, ascending.
    pub triangles: Vec<u32>,
}

/// A named set of edges, for example a trailing edge.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurveGroup {
    /// Name in the mesh file.
    pub name: String,
    /// Vertex pairs in the order of the file.
    pub edges: Vec<[u32; 2]>,
}

impl TriMesh {
    /// Corner positions of one triangle.
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|v| self.vertices[v as usize])
    }

    /// Area vector of one triangle: outward normal times area, m².
    pub fn area_vector(&self, triangle: usize) -> Vec3 {
        let [a, b, c] = self.corners(triangle);
        0.5 * (b - a).cross(&(c - a))
    }

    /// Total area, m².
    pub fn area(&self) -> f64 {
        (0..self.triangles.len())
            .map(|t| self.area_vector(t).norm())
            .sum()
    }

    /// Enclosed volume, m³: positive when the normals point outward.
    ///
    /// $$ V = \tfrac16 \sum (\mathbf a \times \mathbf b)\cdot\mathbf c $$
    ///
    /// with the corners taken from the middle of the bounding box, so that a
    /// body far from the origin loses no digits. Meaningless when the surface
    /// is open.
    pub fn volume(&self) -> f64 {
        let Some((low, high)) = self.bounds() else {
            return 0.0;
        };
        let middle = 0.5 * (low + high);
        let tetrahedron = |t| {
            let [a, b, c] = self.corners(t).map(|p| p - middle);
            a.cross(&b).dot(&c) / 6.0
        };
        (0..self.triangles.len()).map(tetrahedron).sum()
    }

    /// Lowest and highest corner of the bounding box; `None` without vertices.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let first = *self.vertices.first()?;
        let fold = |(low, high): (Vec3, Vec3), p: &Vec3| (low.inf(p), high.sup(p));
        Some(self.vertices.iter().fold((first, first), fold))
    }

    /// The surface group of that name.
    pub fn surface(&self, name: &str) -> Option<&SurfaceGroup> {
        self.surfaces.iter().find(|group| group.name == name)
    }

    /// The curve group of that name.
    pub fn curve(&self, name: &str) -> Option<&CurveGroup> {
        self.curves.iter().find(|group| group.name == name)
    }
}

/// The axes in which a mode's displacement is counted, which decides its
/// boundary condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Frame {
    /// Axes that travel with the free stream's mean and do not turn: the normal
    /// velocity follows from `(s + U·∇) u`.
    Inertial,
    /// Rigid quasi-coordinates of the body: the normal velocity is `s u` alone.
    Body,
}

/// A displacement field on the vertices of a surface mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceMode {
    /// `rigid:x`, `elastic:1`, or the name given in the case file.
    pub name: String,
    /// How the boundary condition is formed.
    pub frame: Frame,
    /// One displacement a mesh vertex, metres per unit generalised coordinate.
    pub displacement: Vec<Vec3>,
}
