//! Finite elements by shape, with the node order of Abaqus and CalculiX input.

/// Shape and order of an element; corner nodes first, then midside nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ElementKind {
    /// One node: a mass or a spring to ground.
    Point,
    /// Two-node bar, beam or spring.
    Line2,
    /// Three-node beam.
    Line3,
    /// Three-node shell.
    Tri3,
    /// Six-node shell.
    Tri6,
    /// Four-node shell.
    Quad4,
    /// Eight-node shell.
    Quad8,
    /// Four-node tetrahedron.
    Tet4,
    /// Ten-node tetrahedron.
    Tet10,
    /// Six-node wedge.
    Wedge6,
    /// Fifteen-node wedge.
    Wedge15,
    /// Eight-node brick.
    Hex8,
    /// Twenty-node brick.
    Hex20,
}

/// The kinds with their names in the neutral file and their node counts.
const KINDS: [(ElementKind, &str, usize); 13] = [
    (ElementKind::Point, "point", 1),
    (ElementKind::Line2, "line2", 2),
    (ElementKind::Line3, "line3", 3),
    (ElementKind::Tri3, "tri3", 3),
    (ElementKind::Tri6, "tri6", 6),
    (ElementKind::Quad4, "quad4", 4),
    (ElementKind::Quad8, "quad8", 8),
    (ElementKind::Tet4, "tet4", 4),
    (ElementKind::Tet10, "tet10", 10),
    (ElementKind::Wedge6, "wedge6", 6),
    (ElementKind::Wedge15, "wedge15", 15),
    (ElementKind::Hex8, "hex8", 8),
    (ElementKind::Hex20, "hex20", 20),
];

impl ElementKind {
    /// Number of nodes.
    pub fn node_count(self) -> usize {
        self.entry().2
    }

    /// Name in the neutral file, for example `quad8`.
    pub fn name(self) -> &'static str {
        self.entry().1
    }

    /// The kind of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        KINDS.iter().find(|kind| kind.1 == name).map(|kind| kind.0)
    }

    /// Shells: the elements that can be outer skin.
    pub fn is_shell(self) -> bool {
        matches!(self, Self::Tri3 | Self::Tri6 | Self::Quad4 | Self::Quad8)
    }

    /// Volume elements.
    pub fn is_solid(self) -> bool {
        self >= Self::Tet4
    }

    fn entry(self) -> (Self, &'static str, usize) {
        *KINDS
            .iter()
            .find(|kind| kind.0 == self)
            .expect("every kind is in the table")
    }
}

/// Kind of a CalculiX or Abaqus element type such as `S8R`; `None` where the
/// type is not known here.
pub(crate) fn of_input_type(name: &str) -> Option<ElementKind> {
    use ElementKind::{
        Hex8, Hex20, Line2, Line3, Point, Quad4, Quad8, Tet4, Tet10, Tri3, Tri6, Wedge6,
        Wedge15,
    };
    Some(match name.to_ascii_uppercase().as_str() {
        "S3" | "S3R" | "M3D3" | "STRI3" => Tri3,
        "S6" | "M3D6" | "STRI65" => Tri6,
        "S4" | "S4R" | "S4R5" | "M3D4" | "M3D4R" => Quad4,
        "S8" | "S8R" | "S8R5" | "M3D8" | "M3D8R" => Quad8,
        "C3D4" => Tet4,
        "C3D10" | "C3D10M" | "C3D10T" => Tet10,
        "C3D6" => Wedge6,
        "C3D15" => Wedge15,
        "C3D8" | "C3D8R" | "C3D8I" => Hex8,
        "C3D20" | "C3D20R" => Hex20,
        "B31" | "B31R" | "T3D2" | "SPRINGA" | "SPRING2" | "DASHPOTA" | "GAPUNI" | "B33" => {
            Line2
        }
        "B32" | "B32R" | "T3D3" => Line3,
        "MASS" | "SPRING1" | "DCOUP3D" | "ROTARYI" => Point,
        _ => return None,
    })
}

/// Kind of a numbered `.frd` element type.
///
/// Numbers from the CalculiX GraphiX manual, "Element Definition Block".
pub(crate) fn of_frd_type(number: i64) -> Option<ElementKind> {
    use ElementKind::{
        Hex8, Hex20, Line2, Line3, Quad4, Quad8, Tet4, Tet10, Tri3, Tri6, Wedge6, Wedge15,
    };
    Some(match number {
        1 => Hex8,
        2 => Wedge6,
        3 => Tet4,
        4 => Hex20,
        5 => Wedge15,
        6 => Tet10,
        7 => Tri3,
        8 => Tri6,
        9 => Quad4,
        10 => Quad8,
        11 => Line2,
        12 => Line3,
        _ => return None,
    })
}

/// Brings `.frd` nodes into input order: the file lists the upright midside
/// nodes of bricks and wedges before those of the top face.
pub(crate) fn frd_to_input_order(kind: ElementKind, nodes: &mut [u64]) {
    match kind {
        ElementKind::Hex20 if nodes.len() == 20 => nodes[12..20].rotate_left(4),
        ElementKind::Wedge15 if nodes.len() == 15 => nodes[9..15].rotate_left(3),
        _ => {}
    }
}
