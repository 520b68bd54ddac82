//! Faults in words: what, where, why it matters, what to do.

use std::fmt;

use serde::Serialize;

use crate::trailing_edge::{self, wedge_and_downstream};
use crate::{Topology, TriMesh, Vec3};

/// Elements named in a message; the fault itself holds all.
const SHOWN: usize = 5;

/// Kinds of faults.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Code {
    /// A vertex coordinate that is NaN or infinite.
    NotFinite,
    /// A triangle that names a vertex that is not there, or one vertex twice.
    BadIndex,
    /// A triangle without area, or one that welding collapses.
    ZeroArea,
    /// A triangle far longer than high.
    Needle,
    /// Vertices in one place.
    DuplicateVertices,
    /// A half model that is none: whole, on the wrong side, or off the plane.
    NotAHalf,
    /// Vertices of a half model beside the plane y = 0.
    OffPlane,
    /// An edge with one triangle.
    OpenEdge,
    /// An edge with more than two triangles.
    NonManifoldEdge,
    /// A vertex in which the surface touches itself.
    BowTie,
    /// Triangles against the orientation of their neighbours.
    Flipped,
    /// A body whose normals point inward.
    InsideOut,
    /// Triangles that cross others.
    SelfCrossing,
    /// A body inside another.
    NestedBodies,
    /// No edge from which a wake would leave.
    NoTrailingEdge,
    /// A trailing edge in the symmetry plane of a half model.
    PlaneTrailingEdge,
    /// Mesh and structure of different size.
    Units,
    /// More elements than memory or time allow.
    TooLarge,
}

impl Code {
    /// The name in files and messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::NotFinite => "not_finite",
            Self::BadIndex => "bad_index",
            Self::ZeroArea => "zero_area",
            Self::Needle => "needle",
            Self::DuplicateVertices => "duplicate_vertices",
            Self::NotAHalf => "not_a_half",
            Self::OffPlane => "off_plane",
            Self::OpenEdge => "open_edge",
            Self::NonManifoldEdge => "non_manifold_edge",
            Self::BowTie => "bow_tie",
            Self::Flipped => "flipped",
            Self::InsideOut => "inside_out",
            Self::SelfCrossing => "self_crossing",
            Self::NestedBodies => "nested_bodies",
            Self::NoTrailingEdge => "no_trailing_edge",
            Self::PlaneTrailingEdge => "plane_trailing_edge",
            Self::Units => "units",
            Self::TooLarge => "too_large",
        }
    }

    /// How bad this kind is, unless the case says otherwise.
    pub fn severity(self) -> Severity {
        match self {
            Self::NotFinite
            | Self::BadIndex
            | Self::ZeroArea
            | Self::NotAHalf
            | Self::OpenEdge
            | Self::NonManifoldEdge
            | Self::BowTie
            | Self::SelfCrossing
            | Self::PlaneTrailingEdge
            | Self::TooLarge => Severity::Error,
            Self::DuplicateVertices | Self::OffPlane | Self::Flipped | Self::InsideOut => {
                Severity::Repaired
            }
            Self::Needle | Self::NestedBodies | Self::NoTrailingEdge | Self::Units => {
                Severity::Warning
            }
        }
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What a fault means for the computation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The computation would be meaningless.
    Error,
    /// Put right in the mesh that the judge returns.
    Repaired,
    /// The computation makes sense, but the user should know.
    Warning,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Error => "error",
            Self::Repaired => "repaired",
            Self::Warning => "warning",
        })
    }
}

/// A place in the mesh as it came in, all numbers from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// A vertex.
    Vertex(u32),
    /// An edge by its vertices.
    Edge([u32; 2]),
    /// A triangle.
    Triangle(u32),
    /// Two triangles.
    TrianglePair([u32; 2]),
    /// A body, in the order of first triangles.
    Body(u32),
    /// Two bodies, the outer one first.
    BodyPair([u32; 2]),
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vertex(v) => write!(f, "vertex {v}"),
            Self::Edge([a, b]) => write!(f, "edge {a}-{b}"),
            Self::Triangle(t) => write!(f, "triangle {t}"),
            Self::TrianglePair([s, t]) => write!(f, "triangles {s} and {t}"),
            Self::Body(b) => write!(f, "body {b}"),
            Self::BodyPair([outer, inner]) => write!(f, "body {inner} in body {outer}"),
        }
    }
}

/// All faults of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// The kind.
    pub code: Code,
    /// What it means.
    pub severity: Severity,
    /// What is wrong, with how many.
    pub what: String,
    /// Why that matters.
    pub why: &'static str,
    /// What to do.
    pub remedy: &'static str,
    /// Where, in ascending order of elements.
    pub elements: Vec<Element>,
    /// The first few elements in words, with their place in space.
    pub places: Vec<String>,
    /// The worst value measured, where there is a limit.
    pub measured: Option<f64>,
    /// The limit it is held against.
    pub limit: Option<f64>,
}

impl Fault {
    /// A fault of the usual severity without elements.
    pub fn new(
        code: Code,
        what: impl Into<String>,
        why: &'static str,
        remedy: &'static str,
    ) -> Self {
        Self {
            code,
            severity: code.severity(),
            what: what.into(),
            why,
            remedy,
            elements: Vec::new(),
            places: Vec::new(),
            measured: None,
            limit: None,
        }
    }

    /// Adds elements, and for the first few where they are.
    #[must_use]
    pub fn at(mut self, elements: Vec<Element>, place: impl Fn(usize) -> Option<Vec3>) -> Self {
        for (k, element) in elements.iter().enumerate().take(SHOWN) {
            self.places.push(match place(k) {
                Some(p) => {
                    format!(
                        "{element} near ({}, {}, {})",
                        short(p.x),
                        short(p.y),
                        short(p.z)
                    )
                }
                None => element.to_string(),
            });
        }
        self.elements = elements;
        self
    }

    /// Adds the worst value and its limit.
    #[must_use]
    pub fn against(mut self, measured: f64, limit: f64) -> Self {
        (self.measured, self.limit) = (Some(measured), Some(limit));
        self
    }

    /// What, where, why it matters, what to do.
    pub fn message(&self) -> String {
        let mut place = self.places.join(", ");
        if self.elements.len() > self.places.len() {
            place = format!(
                "{place} and {} more",
                self.elements.len() - self.places.len()
            );
        }
        let colon = if place.is_empty() { "" } else { ": " };
        format!("{}{colon}{place}; {}; {}", self.what, self.why, self.remedy)
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message())
    }
}

/// A count with its noun.
pub(super) fn counted(n: usize, one: &str, many: &str) -> String {
    if n == 1 {
        format!("1 {one}")
    } else {
        format!("{n} {many}")
    }
}

/// A number with five significant digits.
pub(super) fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.4e}").parse().unwrap_or(x);
    let is_plain = rounded == 0.0 || (1e-4..1e6).contains(&rounded.abs());
    if is_plain {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// That a trailing edge lies in the symmetry plane of an antisymmetric half
/// model, where the edge of a central fin has a wake that a half cannot carry.
pub fn plane_trailing_edge(mesh: &TriMesh, edges: &[[u32; 2]]) -> Fault {
    let place = |k: usize| {
        let [a, b] = edges[k].map(|v| mesh.vertices[v as usize]);
        Some(0.5 * (a + b))
    };
    Fault::new(
        Code::PlaneTrailingEdge,
        format!(
            "a trailing edge of {} lies in the symmetry plane, that of a central fin",
            counted(edges.len(), "edge", "edges")
        ),
        "in antisymmetric motion a fin lifts and sheds a wake in the plane itself, of which a half \
         model holds one side only",
        "mesh the whole aircraft and set mesh.symmetry = \"none\"",
    )
    .at(edges.iter().copied().map(Element::Edge).collect(), place)
}

/// That a surface has no trailing edge, with the sharpest edge that points
/// downstream; an error when a wake is required.
///
/// To be raised by who knows whether a wake is wanted.
pub fn no_trailing_edge(
    mesh: &TriMesh,
    topology: &Topology,
    settings: trailing_edge::Settings,
    severity: Severity,
) -> Fault {
    let sharpest = (0..topology.edges.len())
        .filter_map(|edge| {
            let (wedge, downstream) = wedge_and_downstream(mesh, topology, edge)?;
            (downstream >= settings.min_downstream).then_some((edge, wedge))
        })
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let mut fault = Fault::new(
        Code::NoTrailingEdge,
        format!(
            "no edge sharper than {}° points downstream",
            short(settings.max_wedge_deg)
        ),
        "without a trailing edge there is no wake and no lift",
        "sharpen a blunt trailing edge, raise mesh.trailing_edge.max_wedge_deg, or name the edges in \
         mesh.trailing_edge.groups",
    );
    fault.severity = severity;
    if let Some((edge, wedge)) = sharpest {
        let [a, b] = topology.edges[edge];
        let middle = 0.5 * (mesh.vertices[a as usize] + mesh.vertices[b as usize]);
        fault.what = format!("{}, the sharpest has {}°", fault.what, short(wedge));
        fault = fault
            .at(vec![Element::Edge([a, b])], |_| Some(middle))
            .against(wedge, settings.max_wedge_deg);
    }
    fault
}
