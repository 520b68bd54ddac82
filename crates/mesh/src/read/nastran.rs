//! Nastran bulk data: `GRID`, `CTRIA3`, `CQUAD4` and `PLOTEL` in small, large or free fields.
//!
//! Small fields are 8 columns wide, large ones 16 (the card's name ends in `*`), free ones
//! stand between commas; a card goes on in lines whose first field is empty or begins with
//! `+` or `*`. Elements of one property make the surface group `pshell_PID`; `PLOTEL` lines
//! make the curve group `plotel`. Quadrilaterals are cut along the better diagonal.

use std::collections::{BTreeMap, HashMap};

use super::MISSING_VERTEX;
use super::Place;
use super::cursor::{Malformed, WRITE_AGAIN};
use super::draft::Draft;
use crate::Vec3;

/// Width of a small field and of a tab stop.
const SMALL: usize = 8;
const LARGE: usize = 16;

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
    let mut card: Option<Card> = None;
    // Lines before BEGIN BULK are about the solution, not about the mesh.
    let begin = text.lines().position(|line| {
        line.get(..10)
            .is_some_and(|word| word.eq_ignore_ascii_case("begin bulk"))
    });
    let first = begin.map_or(0, |begin| begin + 1);
    let mut is_ended = false;
    for (number, line) in text.lines().enumerate().skip(first) {
        let line = line.split('$').next().unwrap_or_default().trim_end();
        if line.trim().is_empty() {
            continue;
        }
        if line.trim().eq_ignore_ascii_case("enddata") {
            is_ended = true;
            break;
        }
        let (name, fields) = fields(line);
        if name.is_empty() || name.starts_with(['+', '*']) {
            if let Some(card) = &mut card {
                card.fields.extend(fields);
            }
            continue;
        }
        let next = Card {
            name,
            fields,
            line: number + 1,
        };
        if let Some(whole) = card.replace(next) {
            reader.take(&whole)?;
        }
    }
    if let Some(whole) = card {
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

/// A card with its continuations.
struct Card {
    /// Without `*`, in capitals.
    name: String,
    fields: Vec<String>,
    line: usize,
}

/// Name and data fields of a line; those left out are empty.
fn fields(line: &str) -> (String, Vec<String>) {
    let name_of = |text: &str| {
        let name = text.trim().to_ascii_uppercase();
        if name.starts_with('*') {
            name
        } else {
            name.trim_end_matches('*').to_owned()
        }
    };
    let is_large = line
        .split([',', '\t', ' '])
        .next()
        .is_some_and(|word| word.contains('*'));
    let (width, count) = if is_large { (LARGE, 4) } else { (SMALL, 8) };
    // A decimal comma in a fixed field does not make the card a free one.
    let is_free = line
        .split_once(',')
        .is_some_and(|(name, _)| !name.trim().contains(' '));
    let (name, mut data): (String, Vec<String>) = if is_free {
        let mut words = line.split(',').map(|word| word.trim().to_owned());
        let name = words.next().unwrap_or_default();
        (name_of(&name), words.take(count).collect())
    } else {
        let columns: Vec<char> = without_tabs(line).chars().collect();
        let piece = |from: usize, to: usize| -> String {
            let to = to.min(columns.len());
            columns.get(from..to).unwrap_or_default().iter().collect()
        };
        let field = |i: usize| {
            let from = SMALL + i * width;
            piece(from, from + width).trim().to_owned()
        };
        (name_of(&piece(0, SMALL)), (0..count).map(field).collect())
    };
    data.resize(count, String::new());
    (name, data)
}

/// Tabs reach to the next column that 8 divides.
fn without_tabs(line: &str) -> String {
    let mut text = String::with_capacity(line.len());
    let mut column = 0;
    for c in line.chars() {
        let count = if c == '\t' { SMALL - column % SMALL } else { 1 };
        text.extend(std::iter::repeat_n(if c == '\t' { ' ' } else { c }, count));
        column += count;
    }
    text
}

/// A number as Nastran writes it: the exponent may lack its letter, or have a D.
fn real(text: &str) -> Option<f64> {
    let plain = text.replace(['d', 'D'], "e");
    if let Ok(value) = plain.parse() {
        return Some(value);
    }
    let sign = plain
        .char_indices()
        .skip(1)
        .find(|(_, c)| matches!(c, '+' | '-'))?
        .0;
    format!("{}e{}", &plain[..sign], &plain[sign..])
        .parse()
        .ok()
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

impl Card {
    fn field(&self, i: usize) -> &str {
        self.fields.get(i).map_or("", String::as_str)
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_without_an_exponent_letter_are_read() {
        let read = ["1.5-3", "-2.+1", "7.D0", "4.25", "-.5E2"].map(real);
        assert_eq!(read, [1.5e-3, -20.0, 7.0, 4.25, -50.0].map(Some));
        assert_eq!(real("1..5"), None);
        assert_eq!(real(""), None);
    }
}
