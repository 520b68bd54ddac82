//! Nastran bulk data: `GRID`, `CTRIA3`, `CQUAD4` and `PLOTEL` in small, large or free fields.
//!
//! Cards are those of [`crate::bulk`]. Elements of one property make the surface group `pshell_PID`; `PLOTEL` lines
//! make the curve group `plotel`. Quadrilaterals are cut along the better diagonal.

use std::collections::{BTreeMap, HashMap};

use super::MISSING_VERTEX;
use super::Place;
use super::cursor::{Malformed, WRITE_AGAIN};
use super::draft::Draft;
use crate::Vec3;
use crate::bulk::{Card, Cards, is_begin_bulk, is_end_of_data, real};

/// Whether the text has lines of bulk data.
pub(super) fn is_bulk_data(text: &[u8]) -> bool {
    let starts = |line: &[u8], word: &[u8]| {
        line.len() >= word.len() && line[..word.len()].eq_ignore_ascii_case(word)
    };
    let is_card = |line: &[u8]| {
        let named = [&b"GRID"[..], b"CTRIA3", b"CQUAD4"].iter().any(|word| {
            starts(line, word)
                && matches!(line.get(word.len()), Some(b' ' | b',' | b'*' | b'\t'))
        });
        named || starts(line, b"BEGIN BULK")
    };
    !text.contains(&0) && text.split(|&byte| byte == b'\n').any(is_card)
}

pub(super) fn parse(bytes: &[u8]) -> Result<Draft, Malformed> {
    let text = String::from_utf8_lossy(bytes);
    let mut reader = Reader::default();
    let mut cards = Cards::default();
    // Lines before BEGIN BULK are about the solution, not about the mesh.
    let begin = text.lines().position(is_begin_bulk);
    let first = begin.map_or(0, |begin| begin + 1);
    let mut is_ended = false;
    for (number, line) in text.lines().enumerate().skip(first) {
        if is_end_of_data(line) {
            is_ended = true;
            break;
        }
        if let Some(whole) = cards.push(line, number + 1) {
            reader.take(&whole)?;
        }
    }
    if let Some(whole) = cards.finish() {
        reader.take(&whole)?;
    }
    if begin.is_some() && !is_ended {
        return Err(Malformed::whole(
            "`BEGIN BULK` has no `ENDDATA`",
            WRITE_AGAIN,
        ));
    }
    Ok(reader.finish())
}

#[derive(Default)]
struct Reader {
    draft: Draft,
    index: HashMap<u64, u32>,
    /// Corners (three or four), property and line of every element.
    elements: Vec<(Vec<u64>, Option<u64>, usize)>,
    lines: Vec<[u64; 2]>,
    passed_over: BTreeMap<String, usize>,
    not_finite: Vec<String>,
}

impl Reader {
    fn take(&mut self, card: &Card) -> Result<(), Malformed> {
        match card.name.as_str() {
            "GRID" => self.grid(card),
            "CTRIA3" | "CTRIAR" => self.element(card, 3),
            "CQUAD4" | "CQUADR" => self.element(card, 4),
            "PLOTEL" => {
                self.lines.push([card.number(1)?, card.number(2)?]);
                Ok(())
            }
            "GRDSET" if !["", "0"].contains(&card.field(1)) => Err(card.local_axes(1)),
            "INCLUDE" => Err(card.fault(
                "the file includes another one, which is not read",
                "put all bulk data into one file",
            )),
            "CTRIA6" | "CQUAD8" => Err(card.fault(
                format!("`{}` has nodes on its edges, which is not read", card.name),
                "export three-node triangles or four-node quadrilaterals",
            )),
            name => {
                *self.passed_over.entry(name.to_owned()).or_default() += 1;
                Ok(())
            }
        }
    }

    fn grid(&mut self, card: &Card) -> Result<(), Malformed> {
        let id = card.number(0)?;
        if !["", "0"].contains(&card.field(1)) {
            return Err(card.local_axes(1));
        }
        let position = Vec3::new(card.real(2)?, card.real(3)?, card.real(4)?);
        if !position.iter().all(|x| x.is_finite()) {
            self.not_finite.push(format!("line {}", card.line));
        }
        if self
            .index
            .insert(id, self.draft.vertices.len() as u32)
            .is_some()
        {
            return Err(card.fault(
                format!("node {id} is there twice"),
                "number the nodes uniquely",
            ));
        }
        self.draft.vertices.push(position);
        Ok(())
    }

    fn element(&mut self, card: &Card, count: usize) -> Result<(), Malformed> {
        let property = match card.field(1) {
            "" => None,
            _ => Some(card.number(1)?),
        };
        let corners = (0..count)
            .map(|i| card.number(2 + i))
            .collect::<Result<_, _>>()?;
        self.elements.push((corners, property, card.line));
        Ok(())
    }

    fn finish(mut self) -> Draft {
        let mut missing = Vec::new();
        for (corners, property, line) in std::mem::take(&mut self.elements) {
            let found: Vec<u32> = corners.iter().map(|id| self.vertex(*id)).collect();
            if let Some(i) = found.iter().position(|v| *v == MISSING_VERTEX) {
                missing.push(format!("line {line} names node {}", corners[i]));
            }
            let first = self.draft.triangles.len() as u32;
            self.draft.add_polygon(&found);
            if let Some(property) = property {
                let last = self.draft.triangles.len() as u32;
                self.draft
                    .add_to_surface(&format!("pshell_{property}"), first..last);
            }
        }
        let lines: Vec<[u32; 2]> = self
            .lines
            .iter()
            .map(|line| line.map(|id| self.vertex(id)))
            .collect();
        if !lines.is_empty() {
            self.draft.add_to_curve("plotel", lines);
        }
        self.draft
            .note_places("nodes that are not in the file", &missing);
        self.draft
            .note_places("coordinates that are no finite numbers", &self.not_finite);
        let elements: Vec<String> = self
            .passed_over
            .iter()
            .filter(|(name, _)| name.starts_with('C'))
            .map(|(name, count)| format!("{count} of {name}"))
            .collect();
        self.draft.note_places("cards that are not read", &elements);
        self.draft
    }

    fn vertex(&self, id: u64) -> u32 {
        self.index.get(&id).copied().unwrap_or(MISSING_VERTEX)
    }
}

/// What is taken from a card, and what is said of one that cannot be.
trait Take {
    fn fault(&self, what: impl Into<String>, remedy: &str) -> Malformed;
    fn local_axes(&self, i: usize) -> Malformed;
    fn number(&self, i: usize) -> Result<u64, Malformed>;
    fn real(&self, i: usize) -> Result<f64, Malformed>;
    fn wrong(&self, i: usize, kind: &str) -> Malformed;
}

impl Take for Card {
    fn fault(&self, what: impl Into<String>, remedy: &str) -> Malformed {
        Malformed {
            place: Place::Line(self.line),
            what: what.into(),
            remedy: remedy.into(),
        }
    }

    fn local_axes(&self, i: usize) -> Malformed {
        self.fault(
            format!(
                "nodes are given in coordinate system `{}`, which is not read",
                self.field(i)
            ),
            "export the nodes in the basic coordinate system",
        )
    }

    fn number(&self, i: usize) -> Result<u64, Malformed> {
        self.field(i)
            .parse()
            .map_err(|_| self.wrong(i, "a number of a node or element"))
    }

    /// An empty field is zero.
    fn real(&self, i: usize) -> Result<f64, Malformed> {
        let text = self.field(i);
        if text.is_empty() {
            return Ok(0.0);
        }
        real(text).ok_or_else(|| self.wrong(i, "a number"))
    }

    fn wrong(&self, i: usize, kind: &str) -> Malformed {
        let shown: String = self.field(i).chars().take(40).collect();
        self.fault(
            format!("field {} of {} is `{shown}`, not {kind}", i + 2, self.name),
            "correct the card",
        )
    }
}
