//! Whether a surface can be computed, and what is wrong with it.
//!
//! The order is that of dependence: indices, finite numbers, welding,
//! degenerate triangles, the side of a half model, edges, orientation, bodies and their volume, vertex
//! fans, crossings, nesting. Nothing stops at the first fault: what one fault
//! makes meaningless is left out, everything else is still looked at. Each
//! kind of fault is listed once, with all its elements.
//!
//! Four kinds are repaired and said: duplicate vertices are welded, vertices
//! beside the plane of a half model moved into it, triangles against the run of
//! their neighbours turned, bodies inside out turned.

mod bodies;
mod crossing;
mod edges;
mod elements;
mod fault;
mod half;
mod nesting;
mod orientation;
mod predicates;

pub use bodies::Body;
pub use elements::{MIN_SHAPE, ZERO_HEIGHT};
pub use fault::{Code, Element, Fault, Severity, no_trailing_edge, plane_trailing_edge};

use crate::weld::WELD_TOLERANCE;
use crate::{Topology, TriMesh, Vec3};

/// What is expected of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Half model: the part on y ≥ 0 of a body symmetric in y = 0. Edges that
    /// lie in that plane are then not open; what reaches across it, or lies in
    /// it, would cross its mirror image. Vertices within the distance of
    /// welding from the plane lie in it.
    pub symmetry_plane: bool,
    /// Vertices closer than this fraction of the bounding box's diagonal are welded.
    pub weld_tolerance: f64,
}

impl Default for Settings {
    /// A whole aircraft, welded at [`WELD_TOLERANCE`].
    fn default() -> Self {
        Self {
            symmetry_plane: false,
            weld_tolerance: WELD_TOLERANCE,
        }
    }
}

/// What the judge found.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// The repaired mesh; fit for use when there [are no errors](Self::has_errors).
    pub mesh: TriMesh,
    /// One fault a kind, in the order in which they were looked for.
    pub faults: Vec<Fault>,
    /// Connected parts, in the order of their first triangle.
    pub bodies: Vec<Body>,
    /// Area of the triangles that can be measured, m²; of the whole aircraft
    /// also where half of it is given.
    pub area: f64,
    /// Sum of the volumes of the closed bodies, m³; of the whole aircraft also
    /// where half of it is given.
    pub volume: f64,
    /// Connected parts of the whole aircraft: one beside the plane of a half
    /// model and its image are two.
    pub whole_bodies: usize,
}

impl Judgement {
    /// Whether a fault makes the computation meaningless.
    pub fn has_errors(&self) -> bool {
        self.faults
            .iter()
            .any(|fault| fault.severity == Severity::Error)
    }

    /// The fault of one kind, if it is there.
    pub fn fault(&self, code: Code) -> Option<&Fault> {
        self.faults.iter().find(|fault| fault.code == code)
    }
}

/// The triangles whose connectivity can be used, with their original numbers.
///
/// Element numbers in faults are those of the mesh as it came in.
struct Surface {
    /// Welded vertices, all of them, and the usable triangles.
    mesh: TriMesh,
    /// Original number of each triangle.
    triangle: Vec<u32>,
    /// Original number of each vertex.
    vertex: Vec<u32>,
    /// Whether the triangle's corners are finite, so that it has a normal.
    is_finite: Vec<bool>,
    /// Vertices of triangles that are not here: edges there may look open.
    is_beside_gap: Vec<bool>,
    /// Length below which two places are one, m.
    tolerance: f64,
}

impl Surface {
    fn edge(&self, edge: [u32; 2]) -> Element {
        Element::Edge(edge.map(|v| self.vertex[v as usize]))
    }

    fn middle(&self, edge: [u32; 2]) -> Vec3 {
        let [a, b] = edge.map(|v| self.mesh.vertices[v as usize]);
        0.5 * (a + b)
    }

    fn centroid(&self, triangle: usize) -> Vec3 {
        let [a, b, c] = self.mesh.corners(triangle);
        (a + b + c) / 3.0
    }

    /// Whether a point lies in the plane y = 0.
    fn is_in_symmetry_plane(&self, v: u32) -> bool {
        self.mesh.vertices[v as usize].y.abs() <= self.tolerance
    }
}

/// Judges and repairs a surface, in O(n log n) for n triangles unless very many cross.
pub fn judge(mesh: TriMesh, settings: Settings) -> Judgement {
    let mut faults = Vec::new();
    elements::check_numbers(&mesh, &mut faults);
    let mut surface = elements::welded_surface(&mesh, settings, &mut faults);
    let side = half::side(&surface, settings, &mut faults);
    // What is whole is judged as a whole.
    let settings = Settings {
        symmetry_plane: settings.symmetry_plane && side != half::Side::Both,
        ..settings
    };
    half::move_into_plane(&mut surface, settings, &mut faults);
    elements::check_shapes(&mesh, &surface, &mut faults);
    let topology = Topology::new(&surface.mesh);
    let is_rim = edges::symmetry_rim(&surface, &topology, settings);
    edges::check(&surface, &topology, &is_rim, settings, &mut faults);
    let parts = orientation::orient(&mut surface, &topology, &mut faults);
    let bodies = bodies::measure(
        &mut surface,
        &topology,
        &is_rim,
        parts,
        settings,
        &mut faults,
    );
    let is_starboard_half = settings.symmetry_plane && side == half::Side::Starboard;
    crossing::check(&surface, is_starboard_half, &mut faults);
    half::check_rim(&surface, &is_rim, settings, &mut faults);
    nesting::check(&surface, &bodies, settings, &mut faults);
    let area: f64 = (0..surface.mesh.triangles.len())
        .filter(|&t| surface.is_finite[t])
        .map(|t| surface.mesh.area_vector(t).norm())
        .sum();
    let volume: f64 = bodies.iter().filter_map(|body| body.volume).sum();
    let copies = if settings.symmetry_plane { 2.0 } else { 1.0 };
    let is_doubled = |body: &&Body| settings.symmetry_plane && !body.is_cut;
    Judgement {
        mesh: repaired(mesh, surface),
        faults,
        area: copies * area,
        volume: copies * volume,
        whole_bodies: bodies.len() + bodies.iter().filter(is_doubled).count(),
        bodies,
    }
}

/// The original mesh with welded vertices and turned triangles.
fn repaired(original: TriMesh, surface: Surface) -> TriMesh {
    let mut triangles = vec![[crate::read::MISSING_VERTEX; 3]; original.triangles.len()];
    let mut is_usable = vec![false; original.triangles.len()];
    for (t, &number) in surface.mesh.triangles.iter().zip(&surface.triangle) {
        triangles[number as usize] = *t;
        is_usable[number as usize] = true;
    }
    let image = elements::inverse(&surface.vertex, original.vertices.len());
    for (t, old) in original
        .triangles
        .iter()
        .enumerate()
        .filter(|&(t, _)| !is_usable[t])
    {
        triangles[t] = old.map(|v| image.get(v as usize).copied().unwrap_or(v));
    }
    let surfaces = original.surfaces;
    TriMesh {
        triangles,
        surfaces,
        ..surface.mesh
    }
}
