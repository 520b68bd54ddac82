//! Nodes, frames and elements from the tables `GEOM1` and `GEOM2`.
//!
//! A block is one kind of card: three words that name it, then its fields.
//! Word counts of a card differ between programs and versions; the count is
//! taken by which all numbers in the block make sense.

use super::model::{Model, Shape};
use crate::binary::Words;
use crate::frames::{Coordinates, Points};
use fladder_mesh::Vec3;

/// Largest number of a node, element or frame.
const LARGEST: i64 = 1 << 40;

/// Cards of elements: the first of the three words, name, words an element.
const ELEMENTS: [(i64, &str, &[usize]); 15] = [
    (2408, "CBAR", &[16]),
    (5408, "CBEAM", &[18]),
    (1601, "CONROD", &[8]),
    (3001, "CROD", &[4]),
    (3701, "CTUBE", &[4]),
    (3101, "CSHEAR", &[6]),
    (5959, "CTRIA3", &[13, 14]),
    (9200, "CTRIAR", &[13, 14]),
    (4801, "CTRIA6", &[13, 14, 15]),
    (2958, "CQUAD4", &[14, 15]),
    (8009, "CQUADR", &[14, 15]),
    (4701, "CQUAD8", &[17, 18, 16]),
    (5508, "CTETRA", &[12]),
    (4108, "CPENTA", &[17]),
    (7308, "CHEXA", &[22]),
];

/// Blocks of `GEOM2` until the nodes are known, which may come later.
#[derive(Default)]
pub(crate) struct Elements {
    blocks: Vec<Words>,
}

/// Takes a block of `GEOM1`.
pub(crate) fn geom1(words: &Words, is_wide: bool, model: &mut Model) -> Result<(), String> {
    match words.int(0) {
        Some(4501) => grids(words, is_wide, model),
        Some(1801) => by_nodes(words, Coordinates::Rectangular, model),
        Some(1701) => by_nodes(words, Coordinates::Cylindrical, model),
        Some(1901) => by_nodes(words, Coordinates::Spherical, model),
        Some(2101) => by_points(words, is_wide, Coordinates::Rectangular, model),
        Some(2001) => by_points(words, is_wide, Coordinates::Cylindrical, model),
        Some(2201) => by_points(words, is_wide, Coordinates::Spherical, model),
        Some(14301) => Err("coordinate systems CORD3G are not read".to_owned()),
        _ => Ok(()),
    }
}

/// Starts of entries of so many words behind the three that name the card.
fn entries(words: &Words, size: usize) -> Option<impl Iterator<Item = usize>> {
    let count = words.len().checked_sub(3)?;
    (count.is_multiple_of(size)).then(|| (0..count / size).map(move |k| 3 + k * size))
}

fn whole(words: &Words, at: usize, least: i64) -> Option<i64> {
    words
        .int(at)
        .filter(|number| (least..LARGEST).contains(number))
}

/// Number, frame, three coordinates (of one word or of eight bytes), frame of
/// displacements, constraints, superelement.
fn grids(words: &Words, is_wide: bool, model: &mut Model) -> Result<(), String> {
    type Entry = (u64, (i64, i64), Vec3);
    let read = |at: usize, doubled: bool| -> Option<Entry> {
        let behind = if doubled { 8 } else { 5 };
        let coordinate = |k: usize| {
            let value = if doubled {
                words.double(at + 2 + 2 * k)
            } else {
                words.real(at + 2 + k)
            };
            value.filter(|value| value.is_finite())
        };
        let place = Vec3::new(coordinate(0)?, coordinate(1)?, coordinate(2)?);
        whole(words, at + behind + 1, 0).filter(|constraints| *constraints <= 123_456)?;
        whole(words, at + behind + 2, 0)?;
        let frames = (whole(words, at + 1, 0)?, whole(words, at + behind, -1)?);
        Some((whole(words, at, 1)? as u64, frames, place))
    };
    let layouts: &[bool] = if is_wide { &[false] } else { &[false, true] };
    for doubled in layouts.iter().copied() {
        let size = if doubled { 11 } else { 8 };
        let list: Option<Vec<Entry>> = entries(words, size)
            .and_then(|starts| starts.map(|at| read(at, doubled)).collect());
        for (id, frames, place) in list.iter().flatten().copied() {
            model.grid(id, frames, place)?;
        }
        if list.is_some() {
            return Ok(());
        }
    }
    Err(unknown("GRID", words))
}

fn by_nodes(words: &Words, kind: Coordinates, model: &mut Model) -> Result<(), String> {
    let starts = entries(words, 6).ok_or_else(|| unknown("CORD1", words))?;
    for at in starts {
        let number = |k: usize| {
            let number = whole(words, at + k, 1);
            number
                .map(|n| n as u64)
                .ok_or_else(|| unknown("CORD1", words))
        };
        let points = Points::Nodes([number(3)?, number(4)?, number(5)?]);
        model.frame(number(0)?, kind, points)?;
    }
    Ok(())
}

/// Number, two words, frame, nine coordinates of one word or of eight bytes.
fn by_points(
    words: &Words,
    is_wide: bool,
    kind: Coordinates,
    model: &mut Model,
) -> Result<(), String> {
    let doubled = !is_wide && entries(words, 13).is_none();
    let size = if doubled { 22 } else { 13 };
    let wrong = || unknown("CORD2", words);
    for at in entries(words, size).ok_or_else(wrong)? {
        let mut points = [Vec3::zeros(); 3];
        for k in 0..9 {
            let value = if doubled {
                words.double(at + 4 + 2 * k)
            } else {
                words.real(at + 4 + k)
            };
            let value = value.filter(|value| value.is_finite()).ok_or_else(wrong)?;
            points[k / 3][k % 3] = value;
        }
        let id = whole(words, at, 1).ok_or_else(wrong)? as u64;
        let other = whole(words, at + 3, 0).ok_or_else(wrong)? as u64;
        model.frame(id, kind, Points::In(other, points))?;
    }
    Ok(())
}

impl Elements {
    pub(crate) fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Keeps a block of `GEOM2`.
    pub(crate) fn push(&mut self, words: Words) {
        self.blocks.push(words);
    }

    /// Adds the elements to the model, which has all nodes now.
    pub(crate) fn finish(self, model: &mut Model) -> Result<(), String> {
        for words in &self.blocks {
            let key = words.int(0).unwrap_or(0);
            let Some((_, card, sizes)) = ELEMENTS.iter().find(|entry| entry.0 == key) else {
                continue;
            };
            let Some(shape) = Shape::of(card) else {
                continue;
            };
            let list = sizes
                .iter()
                .find_map(|size| elements(words, *size, &shape, model))
                .ok_or_else(|| unknown(card, words))?;
            for (id, property, nodes) in list {
                model.element(&shape, (id, property), &nodes)?;
            }
        }
        Ok(())
    }
}

type Element = (u64, u64, Vec<u64>);

/// The elements of a block if it has entries of that size: all numbers
/// positive, all nodes there.
fn elements(words: &Words, size: usize, shape: &Shape, model: &Model) -> Option<Vec<Element>> {
    entries(words, size)?
        .map(|at| {
            let id = whole(words, at, 1)? as u64;
            let property = if shape.has_property() {
                whole(words, at + 1, 0)? as u64
            } else {
                0
            };
            let nodes: Option<Vec<u64>> = (0..shape.most_nodes())
                .map(|k| {
                    let least = i64::from(k < shape.least_nodes());
                    let node = whole(words, at + shape.first + k, least)? as u64;
                    (node == 0 || model.has_node(node)).then_some(node)
                })
                .collect();
            Some((id, property, nodes?))
        })
        .collect()
}

fn unknown(card: &str, words: &Words) -> String {
    format!(
        "the block {card} of {} words has a layout that is not known, or names nodes that are \
         not there",
        words.len()
    )
}
