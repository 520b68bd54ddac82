//! What can be wrong with a result file.

use std::io;

/// A result or geometry file that cannot be taken.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The operating system refused.
    #[error("{file} cannot be read: {source}")]
    Io {
        /// File as given.
        file: String,
        /// Reason of the operating system.
        source: io::Error,
    },
    /// The first line belongs to no format known here.
    #[error(
        "{file} begins with {start:?}, which is no modal result known here \
         (calculix-frd, fladder-json, gmsh-msh, nastran-f06, nastran-op2, nastran-op4, \
         nastran-punch, unv)"
    )]
    UnknownFormat {
        /// File as given.
        file: String,
        /// Start of its first line.
        start: String,
    },
    /// A geometry file of no format known here.
    #[error(
        "{file} begins with {start:?}, which is no geometry known here (Nastran bulk data, \
         CalculiX .inp, or a result file with nodes)"
    )]
    UnknownGeometry {
        /// File as given.
        file: String,
        /// Start of its first line.
        start: String,
    },
    /// The file ends before it is complete.
    #[error("{file} is cut short after line {line}: {missing} is missing")]
    Truncated {
        /// File as given.
        file: String,
        /// Last line read.
        line: usize,
        /// What should have come.
        missing: String,
    },
    /// A line that cannot be understood.
    #[error("{file}, line {line}: {message}")]
    Syntax {
        /// File as given.
        file: String,
        /// Line, counted from 1.
        line: usize,
        /// What is wrong with it.
        message: String,
    },
    /// A binary file whose records do not fit together.
    #[error("{file}, near byte {byte}: {message}; copy the file again, whole and as binary")]
    Damaged {
        /// File as given.
        file: String,
        /// Bytes read so far, of the unpacked file.
        byte: u64,
        /// What is wrong there.
        message: String,
    },
    /// A header announces another number of records than follow.
    #[error("{file}, line {line}: {found} {what} where the header states {stated}")]
    Count {
        /// File as given.
        file: String,
        /// Last line of the block.
        line: usize,
        /// Kind of record.
        what: &'static str,
        /// Records found.
        found: usize,
        /// Records announced.
        stated: usize,
    },
    /// Something that is understood and not handled.
    #[error("{file}: {what}")]
    Unsupported {
        /// File as given.
        file: String,
        /// What it is, and what to do.
        what: String,
    },
    /// Parts that do not belong together.
    #[error("{file}: {message}")]
    Mismatch {
        /// File as given.
        file: String,
        /// What contradicts what, with the measured size.
        message: String,
    },
}

/// A structure that cannot carry a surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TransferError {
    /// A mesh without any triangle of finite area.
    #[error("the mesh has no triangle of any area")]
    NoSurface,
    /// Nothing that has faces.
    #[error(
        "the structure has no shells and no solids among its {elements} elements: nothing there \
         can carry a surface; name a geometry file if the result holds nodes alone, or choose a \
         spline through the nodes with structure.transfer = \"polyharmonic\""
    )]
    NoSkin {
        /// Elements in the structure.
        elements: usize,
    },
    /// No face of the structure lies on the wetted surface.
    #[error("no face of the structure lies on the wetted surface")]
    NotOnSurface,
    /// Different units.
    #[error(
        "the mesh measures {mesh:.4e} m across and the structure {structure:.4e} m, a ratio of \
         {ratio:.4e} outside 0.5 to 2; check mesh.scale and structure.units"
    )]
    Size {
        /// Diagonal of the mesh's box, m.
        mesh: f64,
        /// Diagonal of the structure's box, m.
        structure: f64,
        /// Their ratio.
        ratio: f64,
    },
    /// Different axes, places or aircraft.
    #[error(
        "{:.0} % of the wetted surface lie on the structure, and 30 % are needed; {hint}",
        100.0 * overlap
    )]
    Apart {
        /// Share of the wetted area near the structure.
        overlap: f64,
        /// What to try.
        hint: String,
    },
    /// A group of `structure.components` that the mesh lacks.
    #[error("structure.components names {name:?}, but the mesh has the groups {known:?}")]
    NoGroup {
        /// Name given.
        name: String,
        /// Groups of the mesh.
        known: Vec<String>,
    },
    /// A set of `structure.components` that the structure lacks.
    #[error(
        "structure.components.{group} names {name:?}, but the structure has the sets \
         {known:?}"
    )]
    NoSet {
        /// Name given.
        name: String,
        /// Group it is given for.
        group: String,
        /// Element sets of the structure.
        known: Vec<String>,
    },
    /// Points that leave a rotation open.
    #[error(
        "{group}: its {points} points of the structure lie on one line and have no rotations, so \
         that nothing says how the surface turns about the line; name sets with points beside it, \
         or write rotations with the modes"
    )]
    OnOneLine {
        /// Group of the mesh.
        group: String,
        /// Points found for it.
        points: usize,
    },
    /// A method for a group that the mesh lacks.
    #[error("structure.transfer names {name:?}, but the mesh has the groups {known:?}")]
    NoSuchGroup {
        /// Name given.
        name: String,
        /// Groups of the mesh.
        known: Vec<String>,
    },
    /// Sets without shells or solids.
    #[error("{group}: the sets {sets:?} hold no shell and no free face of a solid")]
    NoFaces {
        /// Group of the mesh.
        group: String,
        /// Sets given for it.
        sets: Vec<String>,
    },
}
