//! Mesh files: Gmsh `.msh` 4.1 and 2.2, STL, OBJ, PLY, VTK `.vtu` and Nastran bulk data,
//! each plain or gzipped.
//!
//! The format is told from the content, never from the name. Readers do not
//! judge the surface: a vertex that is not a number, or a triangle that names
//! a vertex the file lacks, is passed on (the latter as [`MISSING_VERTEX`]) so
//! that the judge can list it beside all other faults. What a reader changes
//! on its own account (vertices welded or dropped, elements passed over) it
//! says in its notes.

mod cursor;
mod draft;
mod msh;
mod msh2;
mod msh4;
mod msh_elements;
mod nastran;
mod obj;
mod ply;
mod stl;
mod vtu;

use std::fmt;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::TriMesh;
use cursor::Malformed;
use draft::Draft;

/// Stands in a triangle for a vertex that the file does not hold.
pub const MISSING_VERTEX: u32 = u32::MAX;

/// Most bytes a gzipped file may unpack to: a surface mesh of this size could
/// not be computed, and a few kilobytes of gzip can ask for any amount.
const MAX_UNPACKED: u64 = 1 << 30;

/// Bytes among which an XML file says that it is VTK's.
const XML_HEAD: usize = 4096;

/// Why a mesh file cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file cannot be opened, read or unpacked.
    #[error("{}: cannot {doing}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What was tried.
        doing: &'static str,
        /// What the system said.
        source: std::io::Error,
    },
    /// The content is not what its format asks for.
    #[error("{}, {place}: {what}; {remedy}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Where in the (unpacked) file.
        place: Place,
        /// What is wrong there.
        what: String,
        /// What to do.
        remedy: String,
    },
    /// A scale that makes no lengths.
    #[error("mesh scale is {0}, but file units to metres must be a positive number")]
    Scale(f64),
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// Line, from 1.
    Line(usize),
    /// Byte, from 0.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => write!(f, "whole file"),
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// The formats that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Gmsh 4.1 or 2.2, ASCII or binary.
    Msh,
    /// STL of text.
    StlAscii,
    /// STL of 50-byte records.
    StlBinary,
    /// Wavefront OBJ.
    Obj,
    /// PLY of text or binary numbers.
    Ply,
    /// VTK's unstructured grid in XML.
    Vtu,
    /// Nastran bulk data.
    Nastran,
}

/// A mesh as read, with what the reader did to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The mesh, in metres.
    pub mesh: TriMesh,
    /// The format found.
    pub format: Format,
    /// Sentences about what was welded, dropped or passed over.
    pub notes: Vec<String>,
}

/// Reads a mesh file and multiplies its lengths by `scale`; see [`load`].
///
/// # Errors
/// See [`ReadError`].
pub fn read_mesh(path: impl AsRef<Path>, scale: f64) -> Result<TriMesh, ReadError> {
    load(path, scale).map(|loaded| loaded.mesh)
}

/// Reads a mesh file, multiplies its lengths by `scale`, and says what was done.
///
/// # Errors
/// A file that cannot be read, a format that is not known, content that
/// contradicts its format, a surface without triangles.
pub fn load(path: impl AsRef<Path>, scale: f64) -> Result<Loaded, ReadError> {
    let path = path.as_ref();
    let io = |doing| {
        move |source| ReadError::Io {
            path: path.into(),
            doing,
            source,
        }
    };
    let bytes = std::fs::read(path).map_err(io("read"))?;
    let bytes = unpacked(bytes).map_err(io("unpack"))?;
    parse(&bytes, path, scale)
}

/// Reads a mesh from the bytes of an unpacked file; `path` is for messages.
///
/// # Errors
/// As [`load`].
pub fn parse(bytes: &[u8], path: &Path, scale: f64) -> Result<Loaded, ReadError> {
    if !(scale.is_finite() && scale > 0.0) {
        return Err(ReadError::Scale(scale));
    }
    parse_draft(bytes)
        .and_then(|(format, draft)| {
            let (mesh, notes) = draft.finish(scale)?;
            Ok(Loaded {
                mesh,
                format,
                notes,
            })
        })
        .map_err(
            |Malformed {
                 place,
                 what,
                 remedy,
             }| ReadError::Malformed {
                path: path.into(),
                place,
                what,
                remedy,
            },
        )
}

fn parse_draft(bytes: &[u8]) -> Result<(Format, Draft), Malformed> {
    let format = detect(bytes)?;
    let draft = match format {
        Format::Msh => msh::parse(bytes),
        Format::StlAscii => stl::parse_ascii(bytes),
        Format::StlBinary => stl::parse_binary(bytes),
        Format::Obj => obj::parse(bytes),
        Format::Ply => ply::parse(bytes),
        Format::Vtu => vtu::parse(bytes),
        Format::Nastran => nastran::parse(bytes),
    }?;
    Ok((format, draft))
}

fn unpacked(bytes: Vec<u8>) -> std::io::Result<Vec<u8>> {
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(bytes);
    }
    let mut content = Vec::new();
    flate2::read::MultiGzDecoder::new(&bytes[..])
        .take(MAX_UNPACKED + 1)
        .read_to_end(&mut content)?;
    if content.len() as u64 > MAX_UNPACKED {
        return Err(std::io::Error::other(format!(
            "it unpacks to more than {MAX_UNPACKED} bytes"
        )));
    }
    Ok(content)
}

/// Tells the format from the content.
fn detect(bytes: &[u8]) -> Result<Format, Malformed> {
    let text = bytes
        .strip_prefix(b"\xef\xbb\xbf")
        .unwrap_or(bytes)
        .trim_ascii_start();
    if text.is_empty() {
        return Err(Malformed::whole("the file is empty", "give a mesh file"));
    }
    // Gmsh's sections begin with `$`, and so do Nastran's comments.
    let is_bulk_data = nastran::is_bulk_data(text);
    if text.starts_with(b"$") && (!is_bulk_data || text.starts_with(b"$MeshFormat")) {
        return Ok(Format::Msh);
    }
    if stl::is_whole_binary(bytes) {
        return Ok(Format::StlBinary);
    }
    let starts =
        |word: &[u8]| text.len() >= word.len() && text[..word.len()].eq_ignore_ascii_case(word);
    if starts(b"solid")
        && text
            .windows(5)
            .any(|word| word.eq_ignore_ascii_case(b"facet"))
    {
        return Ok(Format::StlAscii);
    }
    if starts(b"ply\n") || starts(b"ply\r") {
        return Ok(Format::Ply);
    }
    let is_vtk = |word: &[u8]| word.eq_ignore_ascii_case(b"<vtkfile");
    if starts(b"<") && text[..text.len().min(XML_HEAD)].windows(8).any(is_vtk) {
        return Ok(Format::Vtu);
    }
    if is_bulk_data {
        return Ok(Format::Nastran);
    }
    let other = [
        (&b"<?xml"[..], "an XML file that is not VTK's"),
        (b"# vtk", "a legacy VTK file"),
        (b"off", "an OFF file"),
        (b"iso-10303-21", "a STEP file"),
    ];
    if let Some((_, name)) = other.iter().find(|(word, _)| starts(word)) {
        return Err(Malformed::whole(
            format!("this is {name}, which is not read"),
            "save the mesh as Gmsh .msh, STL, OBJ, PLY, .vtu or Nastran bulk data",
        ));
    }
    let is_vertex_line =
        |line: &[u8]| matches!(line.trim_ascii_start(), [b'v', b' ' | b'\t', ..]);
    if !bytes.contains(&0) && text.split(|&byte| byte == b'\n').any(is_vertex_line) {
        return Ok(Format::Obj);
    }
    if bytes.len() >= stl::HEADER && bytes.contains(&0) {
        // Its reader says how size and count disagree.
        return Ok(Format::StlBinary);
    }
    Err(Malformed::whole(
        "the content is none of Gmsh .msh, STL, OBJ, PLY, .vtu and Nastran bulk data",
        "save the mesh in one of these formats",
    ))
}
