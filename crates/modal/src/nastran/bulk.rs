//! Geometry of Nastran bulk data: `GRID` with its frames, and elements.
//!
//! Cards as in [`fladder_mesh::bulk`], `INCLUDE` beside the file that has it.
//! Elements of one property make an element set such as `pshell_7`, the name
//! that surface meshes give it; `SET1` cards make node sets such as `set1_7`.

use super::model::{Model, Shape};
use crate::error::ReadError;
use crate::frames::{Coordinates, Points};
use crate::raw::Geometry;
use crate::text::{Lines, real};
use fladder_mesh::Vec3;
use fladder_mesh::bulk::{Card, Cards, is_begin_bulk, is_end_of_data};
use std::path::{Path, PathBuf};

/// `INCLUDE` may nest this deep; deeper is a file that includes itself.
const INCLUDE_DEPTH: usize = 16;

/// Data lines that the name of an included file may go on over.
const INCLUDE_LINES: usize = 16;

struct Reader {
    model: Model,
    /// Frames of nodes that name none, from `GRDSET`.
    default_frames: (i64, i64),
    /// Nodes before the default is known: number, frames, coordinates.
    grids: Vec<(u64, [Option<i64>; 2], Vec3)>,
    sets: Vec<(String, Vec<[u64; 2]>)>,
    is_ended: bool,
}

/// Reads the geometry of a bulk-data file and the files it includes.
pub(crate) fn read(path: &Path) -> Result<Geometry, ReadError> {
    let mut reader = Reader {
        model: Model::default(),
        default_frames: (0, 0),
        grids: Vec::new(),
        sets: Vec::new(),
        is_ended: false,
    };
    let begin = line_of_begin(path)?;
    let mut lines = Lines::open(path)?;
    while lines.number() < begin {
        lines.next_line()?;
    }
    reader.file(&mut lines, path, 0)?;
    if begin > 0 && !reader.is_ended {
        return Err(lines.truncated("ENDDATA, which ends what BEGIN BULK begins,"));
    }
    reader.finish().map_err(|message| ReadError::Mismatch {
        file: path.display().to_string(),
        message,
    })
}

/// Line of `BEGIN BULK`, 0 where a file has none and holds cards alone.
fn line_of_begin(path: &Path) -> Result<usize, ReadError> {
    let mut lines = Lines::open(path)?;
    while let Some(line) = lines.next_line()? {
        if is_begin_bulk(line) {
            return Ok(lines.number());
        }
    }
    Ok(0)
}

impl Reader {
    fn file(&mut self, lines: &mut Lines, path: &Path, depth: usize) -> Result<(), ReadError> {
        let mut cards = Cards::default();
        while let Some(line) = lines.next_line()? {
            if is_end_of_data(line) {
                self.is_ended = true;
                break;
            }
            let line = line.to_owned();
            let word = line.split_ascii_whitespace().next().unwrap_or("");
            if word.eq_ignore_ascii_case("BEGIN") {
                return Err(lines.unsupported(format!(
                    "line {}: {:?}: superelements and parts are not read; write one flat model",
                    lines.number(),
                    line.trim()
                )));
            }
            if line.trim_start().get(..7).is_some_and(is_include) {
                self.take_last(&mut cards, lines)?;
                self.include(&line, lines, path, depth)?;
                if self.is_ended {
                    break;
                }
                continue;
            }
            let number = lines.number();
            if let Some(card) = cards.push(&line, number) {
                self.card(&card)
                    .map_err(|m| at(lines, card.line, &card.name, &m))?;
            }
        }
        self.take_last(&mut cards, lines)?;
        while self.is_ended && lines.next_line()?.is_some() {}
        Ok(())
    }

    fn take_last(&mut self, cards: &mut Cards, lines: &Lines) -> Result<(), ReadError> {
        let Some(card) = cards.finish() else {
            return Ok(());
        };
        self.card(&card)
            .map_err(|m| at(lines, card.line, &card.name, &m))
    }

    fn include(
        &mut self,
        first: &str,
        lines: &mut Lines,
        path: &Path,
        depth: usize,
    ) -> Result<(), ReadError> {
        let mut name = first.trim_start()[7..].trim().to_owned();
        let quote = name.chars().next().filter(|c| ['\'', '"'].contains(c));
        if let Some(quote) = quote {
            for _ in 0..INCLUDE_LINES {
                if name[1..].contains(quote) {
                    break;
                }
                let Some(line) = lines.next_line()? else {
                    break;
                };
                name.push_str(line.trim());
            }
            name = name[1..].split(quote).next().unwrap_or("").to_owned();
        }
        if depth == INCLUDE_DEPTH || name.is_empty() {
            return Err(lines.syntax("INCLUDE without a file, or nested too deep"));
        }
        let file = beside(path, &name);
        let mut included = Lines::open(&file)?;
        self.file(&mut included, &file, depth + 1)
    }

    fn card(&mut self, card: &Card) -> Result<(), String> {
        match card.name.as_str() {
            "GRID" => self.grid(card),
            "GRDSET" => {
                let frame = |i| Ok::<_, String>(signed(card, i)?.unwrap_or(0));
                self.default_frames = (frame(1)?, frame(5)?);
                Ok(())
            }
            "CORD1R" => self.by_nodes(card, Coordinates::Rectangular),
            "CORD1C" => self.by_nodes(card, Coordinates::Cylindrical),
            "CORD1S" => self.by_nodes(card, Coordinates::Spherical),
            "CORD2R" => self.by_points(card, Coordinates::Rectangular),
            "CORD2C" => self.by_points(card, Coordinates::Cylindrical),
            "CORD2S" => self.by_points(card, Coordinates::Spherical),
            "SET1" => {
                self.set(card);
                Ok(())
            }
            name => self.element(name, card),
        }
    }

    fn grid(&mut self, card: &Card) -> Result<(), String> {
        let place = Vec3::new(
            coordinate(card, 2)?,
            coordinate(card, 3)?,
            coordinate(card, 4)?,
        );
        let frames = [signed(card, 1)?, signed(card, 5)?];
        self.grids.push((number(card, 0)?, frames, place));
        Ok(())
    }

    /// Two frames of three nodes each may stand on a card.
    fn by_nodes(&mut self, card: &Card, coordinates: Coordinates) -> Result<(), String> {
        for first in [0, 4] {
            if first > 0 && card.field(first).is_empty() {
                continue;
            }
            let nodes = [1, 2, 3].map(|k| number(card, first + k));
            let [a, b, c] = nodes;
            let points = Points::Nodes([a?, b?, c?]);
            self.model
                .frame(number(card, first)?, coordinates, points)?;
        }
        Ok(())
    }

    fn by_points(&mut self, card: &Card, coordinates: Coordinates) -> Result<(), String> {
        let other = signed(card, 1)?.unwrap_or(0);
        let other = u64::try_from(other).map_err(|_| format!("coordinate system {other}"))?;
        let mut points = [Vec3::zeros(); 3];
        for (k, point) in points.iter_mut().enumerate() {
            for axis in 0..3 {
                point[axis] = coordinate(card, 2 + 3 * k + axis)?;
            }
        }
        let points = Points::In(other, points);
        self.model.frame(number(card, 0)?, coordinates, points)
    }

    fn element(&mut self, name: &str, card: &Card) -> Result<(), String> {
        let Some(shape) = Shape::of(name) else {
            if name.starts_with("RBE") || is_unknown_element(name) {
                *self.model.passed_over.entry(name.to_owned()).or_default() += 1;
            }
            return Ok(());
        };
        let nodes: Result<Vec<u64>, String> = (0..shape.most_nodes())
            .map(|k| match card.field(shape.first + k) {
                "" => Ok(0),
                _ => number(card, shape.first + k),
            })
            .collect();
        let property = match card.field(1) {
            text if shape.has_property() && !text.is_empty() => number(card, 1)?,
            // The default property has the element's own number.
            _ if shape.has_property() => number(card, 0)?,
            _ => 0,
        };
        self.model
            .element(&shape, (number(card, 0)?, property), &nodes?)
    }

    /// Numbers and ranges; words such as the name of a splining option end it.
    fn set(&mut self, card: &Card) {
        let mut ranges: Vec<[u64; 2]> = Vec::new();
        let mut through = false;
        for text in &card.fields[1..] {
            if text.eq_ignore_ascii_case("THRU") {
                through = true;
            } else if let Ok(id) = text.parse() {
                match ranges.last_mut() {
                    Some(range) if through => range[1] = id,
                    _ => ranges.push([id, id]),
                }
                through = false;
            }
        }
        self.sets.push((format!("set1_{}", card.field(0)), ranges));
    }

    fn finish(mut self) -> Result<Geometry, String> {
        let (placed_in, moves_in) = self.default_frames;
        for (id, [own_placed, own_moves], place) in std::mem::take(&mut self.grids) {
            let frames = (
                own_placed.unwrap_or(placed_in),
                own_moves.unwrap_or(moves_in),
            );
            self.model.grid(id, frames, place)?;
        }
        if !self.model.has_nodes() {
            return Err("it has no GRID card".to_owned());
        }
        let sets = std::mem::take(&mut self.sets);
        let mut geometry = self.model.finish()?;
        for (name, ranges) in sets {
            let members = geometry.node_sets.entry(name).or_default();
            for [first, last] in ranges {
                if first <= last {
                    members.extend(geometry.nodes.range(first..=last).map(|node| *node.0));
                }
            }
        }
        Ok(geometry)
    }
}

/// Elements that could have a face or an edge and are not known.
fn is_unknown_element(name: &str) -> bool {
    const NO_ELEMENTS: [&str; 9] = [
        "CORD", "CONM", "CELAS", "CDAMP", "CMASS", "CAERO", "CONV", "CSET", "CBUSH",
    ];
    name.starts_with('C')
        && name.bytes().all(|byte| byte.is_ascii_alphanumeric())
        && !NO_ELEMENTS.iter().any(|other| name.starts_with(other))
}

fn is_include(word: &str) -> bool {
    word.eq_ignore_ascii_case("INCLUDE")
}

/// The included file: beside the including one, names of other systems too.
fn beside(path: &Path, name: &str) -> PathBuf {
    let name = Path::new(name);
    match path.parent() {
        Some(folder) if name.is_relative() => folder.join(name),
        _ => name.to_owned(),
    }
}

fn at(lines: &Lines, line: usize, card: &str, message: &str) -> ReadError {
    ReadError::Syntax {
        file: lines.name(),
        line,
        message: format!("{card}: {message}"),
    }
}

fn number(card: &Card, i: usize) -> Result<u64, String> {
    let text = card.field(i);
    match text.parse() {
        Ok(0) | Err(_) => Err(wrong(i, text, "a positive number of a node or element")),
        Ok(id) => Ok(id),
    }
}

/// A whole number that may be left out.
fn signed(card: &Card, i: usize) -> Result<Option<i64>, String> {
    match card.field(i) {
        "" => Ok(None),
        text => text
            .parse()
            .map(Some)
            .map_err(|_| wrong(i, text, "a number of a coordinate system")),
    }
}

/// An empty field is zero.
fn coordinate(card: &Card, i: usize) -> Result<f64, String> {
    match card.field(i) {
        "" => Ok(0.0),
        text => real(text).ok_or_else(|| wrong(i, text, "a finite number")),
    }
}

fn wrong(i: usize, text: &str, kind: &str) -> String {
    let shown: String = text.chars().take(40).collect();
    format!("field {} is {shown:?}, not {kind}", i + 2)
}
