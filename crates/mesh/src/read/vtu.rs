//! VTK's `.vtu`: unstructured grids in XML, as text, base64 or appended raw, with or without
//! zlib.
//!
//! VTK file formats, "XML file formats". Triangles, quadrilaterals, pixels and polygons
//! become triangles, lines and polylines the curve group `lines`. Whole numbers of a cell
//! array named `group` make surface groups `group_N` for N above 0. Points and cells of
//! several pieces follow each other.

use std::io::Read;

use super::MAX_UNPACKED;
use super::cursor::{Malformed, WRITE_AGAIN};
use super::draft::Draft;

mod cells;
mod numbers;
mod xml;

use cells::Reading;
use numbers::{Stream, value, width};
use xml::{Tag, Tags};

pub(super) fn parse(bytes: &[u8]) -> Result<Draft, Malformed> {
    let file = File::read(bytes)?;
    let mut draft = Draft::default();
    let mut reading = Reading {
        file: &file,
        draft: &mut draft,
        missing: Vec::new(),
        points_only: 0,
    };
    for piece in &file.pieces {
        reading.piece(piece)?;
    }
    let (missing, points_only) = (reading.missing, reading.points_only);
    draft.note_places("points that are not in the file", &missing);
    if points_only > 0 {
        draft.notes.push(format!(
            "cells that are points were passed over: {points_only}"
        ));
    }
    Ok(draft)
}

/// Width of the lengths before binary data.
#[derive(Clone, Copy, PartialEq)]
enum Header {
    Four,
    Eight,
}

/// An array as its tag tells.
struct DataArray<'a> {
    name: String,
    kind: String,
    format: String,
    offset: usize,
    content: &'a [u8],
}

/// The arrays of a piece that matter.
#[derive(Default)]
struct Piece<'a> {
    points: Option<DataArray<'a>>,
    connectivity: Option<DataArray<'a>>,
    offsets: Option<DataArray<'a>>,
    types: Option<DataArray<'a>>,
    group: Option<DataArray<'a>>,
}

struct File<'a> {
    header: Header,
    is_big: bool,
    is_compressed: bool,
    /// What follows the underscore, and whether it is base64.
    appended: Option<(&'a [u8], bool)>,
    pieces: Vec<Piece<'a>>,
}

fn wrong(what: impl Into<String>) -> Malformed {
    Malformed::whole(what, WRITE_AGAIN)
}

impl<'a> File<'a> {
    fn read(bytes: &'a [u8]) -> Result<Self, Malformed> {
        if !bytes.trim_ascii_end().ends_with(b"</VTKFile>") {
            return Err(wrong("the file does not end with `</VTKFile>`"));
        }
        let mut tags = Tags::new(bytes);
        let first = loop {
            match tags.next()? {
                Some(tag) if tag.name == "VTKFile" => break tag,
                Some(tag) if tag.name.starts_with('?') => {}
                _ => return Err(wrong("the file has no element `VTKFile`")),
            }
        };
        let mut file = Self::described(&first)?;
        let mut section = String::new();
        while let Some(tag) = tags.next()? {
            match tag.name.as_str() {
                "Piece" => file.pieces.push(Piece::default()),
                "PointData" | "CellData" | "Points" | "Cells" => section.clone_from(&tag.name),
                "DataArray" => {
                    let array = DataArray::new(&tag)?;
                    if let Some(piece) = file.pieces.last_mut() {
                        piece.put(&section, array);
                    }
                }
                "AppendedData" => {
                    let is_base64 = tag.attribute("encoding") == Some("base64");
                    let start = tag.content.iter().position(|&byte| byte == b'_');
                    let start =
                        start.ok_or_else(|| wrong("the appended data lack their `_`"))?;
                    file.appended = Some((&tag.content[start + 1..], is_base64));
                    break;
                }
                _ => {}
            }
        }
        Ok(file)
    }

    fn described(tag: &Tag<'_>) -> Result<Self, Malformed> {
        let kind = tag.attribute("type").unwrap_or_default();
        if kind != "UnstructuredGrid" {
            return Err(Malformed::whole(
                format!("this is a VTK file of type `{kind}`, which is not read"),
                "save the mesh as an unstructured grid (.vtu)",
            ));
        }
        let is_compressed = match tag.attribute("compressor") {
            None | Some("") => false,
            Some("vtkZLibDataCompressor") => true,
            Some(other) => {
                return Err(Malformed::whole(
                    format!("the data are compressed by `{other}`, which is not read"),
                    "save without compression, or with zlib",
                ));
            }
        };
        let header = match tag.attribute("header_type") {
            None | Some("UInt32") => Header::Four,
            Some("UInt64") => Header::Eight,
            Some(other) => return Err(wrong(format!("header type `{other}` is not known"))),
        };
        Ok(Self {
            header,
            is_big: tag.attribute("byte_order") == Some("BigEndian"),
            is_compressed,
            appended: None,
            pieces: Vec::new(),
        })
    }

    /// All numbers of an array.
    fn numbers(&self, array: &DataArray<'_>) -> Result<Vec<f64>, Malformed> {
        if array.format == "ascii" {
            return array.text_numbers();
        }
        let width = width(&array.kind).ok_or_else(|| {
            wrong(format!(
                "array `{}` is of type `{}`",
                array.name, array.kind
            ))
        })?;
        let stream = if array.format == "appended" {
            let (bytes, is_base64) = self
                .appended
                .ok_or_else(|| wrong(format!("array `{}` is not in the file", array.name)))?;
            let bytes = bytes.get(array.offset..).unwrap_or_default();
            Stream {
                bytes,
                is_base64,
                buffer: Vec::new(),
            }
        } else {
            Stream {
                bytes: array.content,
                is_base64: true,
                buffer: Vec::new(),
            }
        };
        let bytes = self
            .block(stream)
            .map_err(|what| wrong(format!("array `{}`: {what}", array.name)))?;
        if bytes.len() % width != 0 {
            return Err(wrong(format!(
                "array `{}` ends inside a number",
                array.name
            )));
        }
        let mut number = [0; 8];
        Ok(bytes
            .chunks_exact(width)
            .map(|chunk| {
                number[..width].copy_from_slice(chunk);
                if self.is_big {
                    number[..width].reverse();
                }
                value(&array.kind, number)
            })
            .collect())
    }

    /// The bytes of an array behind its lengths.
    fn block(&self, mut stream: Stream<'_>) -> Result<Vec<u8>, String> {
        if !self.is_compressed {
            let length = self.length(&mut stream)?;
            return stream.take(length);
        }
        let (count, full, last) = (
            self.length(&mut stream)?,
            self.length(&mut stream)?,
            self.length(&mut stream)?,
        );
        let sizes = (0..count.min(stream.bytes.len()))
            .map(|_| self.length(&mut stream))
            .collect::<Result<Vec<usize>, _>>()?;
        // In base64 the blocks begin a group of their own.
        stream.buffer.clear();
        let mut bytes = Vec::new();
        for (i, size) in sizes.iter().enumerate() {
            let packed = stream.take(*size)?;
            let expected = if i + 1 == sizes.len() && last > 0 {
                last
            } else {
                full
            };
            let room = MAX_UNPACKED
                .saturating_sub(bytes.len() as u64)
                .min((expected as u64).saturating_add(1));
            let before = bytes.len();
            flate2::read::ZlibDecoder::new(&packed[..])
                .take(room)
                .read_to_end(&mut bytes)
                .map_err(|error| format!("block {i} does not unpack: {error}"))?;
            if bytes.len() - before != expected {
                return Err(format!("block {i} does not unpack to {expected} bytes"));
            }
        }
        Ok(bytes)
    }

    fn length(&self, stream: &mut Stream<'_>) -> Result<usize, String> {
        let width = if self.header == Header::Four { 4 } else { 8 };
        let mut bytes = [0; 8];
        bytes[..width].copy_from_slice(&stream.take(width)?);
        if self.is_big {
            bytes[..width].reverse();
        }
        usize::try_from(u64::from_le_bytes(bytes)).map_err(|error| error.to_string())
    }
}

impl<'a> DataArray<'a> {
    fn new(tag: &Tag<'a>) -> Result<Self, Malformed> {
        let text = |name: &str| tag.attribute(name).unwrap_or_default().to_owned();
        let offset = text("offset");
        let format = text("format");
        if !["ascii", "binary", "appended"].contains(&format.as_str()) {
            return Err(wrong(format!("data format `{format}` is not known")));
        }
        Ok(Self {
            name: text("Name"),
            kind: text("type"),
            offset: match offset.as_str() {
                "" => 0,
                digits => digits
                    .parse()
                    .map_err(|_| wrong(format!("`{digits}` is no offset of an array")))?,
            },
            format,
            content: tag.content,
        })
    }

    fn text_numbers(&self) -> Result<Vec<f64>, Malformed> {
        let text = std::str::from_utf8(self.content)
            .map_err(|_| wrong(format!("array `{}` is not text", self.name)))?;
        text.split_ascii_whitespace()
            .map(|word| {
                let shown: String = word.chars().take(40).collect();
                word.parse().map_err(|_| {
                    wrong(format!(
                        "`{shown}` in array `{}` is not a number",
                        self.name
                    ))
                })
            })
            .collect()
    }
}

impl<'a> Piece<'a> {
    fn put(&mut self, section: &str, array: DataArray<'a>) {
        let place = match (section, array.name.as_str()) {
            ("Points", _) => &mut self.points,
            ("Cells", "connectivity") => &mut self.connectivity,
            ("Cells", "offsets") => &mut self.offsets,
            ("Cells", "types") => &mut self.types,
            ("CellData", "group") => &mut self.group,
            _ => return,
        };
        *place = Some(array);
    }
}
