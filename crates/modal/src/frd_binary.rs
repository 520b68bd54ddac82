//! Binary blocks of CalculiX `.frd` files.
//!
//! Headings are text as in the ASCII form; behind a heading of format 2 (single
//! precision) or 3 (double) come as many records as it states, little-endian
//! and without separators or an end mark: a node is its number and three
//! reals; an element its number, type, group and material and its nodes; a
//! result the node's number and its components.

use crate::binary::{Order, Words};
use crate::element;
use crate::error::ReadError;
use crate::raw::{Geometry, ModeTable, RawElement, ShapeBuilder};
use crate::text::Lines;
use fladder_mesh::Vec3;

/// Bytes of an integer and of a real in single precision.
const WORD: usize = 4;

/// Precision of the reals in a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Precision {
    Single,
    Double,
}

/// Number and reals of a node.
fn record(
    lines: &mut Lines,
    precision: Precision,
    missing: &str,
) -> Result<(u64, Vec3), ReadError> {
    let width = match precision {
        Precision::Single => 1,
        Precision::Double => 2,
    };
    let bytes = lines.bytes(WORD * (1 + 3 * width), missing)?;
    let words = Words::new(bytes, Order::Little, WORD);
    let id = number(lines, &words, 0)?;
    let mut vector = Vec3::zeros();
    for axis in 0..3 {
        let at = 1 + axis * width;
        let value = match precision {
            Precision::Single => words.real(at),
            Precision::Double => words.double(at),
        };
        vector[axis] = value
            .filter(|value| value.is_finite())
            .ok_or_else(|| lines.syntax(format!("node {id} has a value that is not finite")))?;
    }
    Ok((id, vector))
}

fn number(lines: &Lines, words: &Words, at: usize) -> Result<u64, ReadError> {
    let number = words.int(at).unwrap_or(0);
    u64::try_from(number)
        .ok()
        .filter(|id| *id > 0)
        .ok_or_else(|| lines.syntax(format!("{number} numbers no node or element")))
}

pub(crate) fn nodes(
    lines: &mut Lines,
    stated: usize,
    precision: Precision,
    geometry: &mut Geometry,
) -> Result<(), ReadError> {
    for _ in 0..stated {
        let (id, position) = record(lines, precision, "the node block")?;
        if geometry.nodes.insert(id, position).is_some() {
            return Err(lines.syntax(format!("node {id} appears twice")));
        }
    }
    Ok(())
}

pub(crate) fn elements(
    lines: &mut Lines,
    stated: usize,
    geometry: &mut Geometry,
) -> Result<(), ReadError> {
    for _ in 0..stated {
        let head = Words::new(
            lines.bytes(4 * WORD, "the element block")?,
            Order::Little,
            WORD,
        );
        let id = number(lines, &head, 0)?;
        let shape = head.int(1).unwrap_or(0);
        let kind = element::of_frd_type(shape)
            .ok_or_else(|| lines.syntax(format!("element {id} is of unknown type {shape}")))?;
        let count = kind.node_count();
        let bytes = lines.bytes(count * WORD, "the nodes of an element")?;
        let words = Words::new(bytes, Order::Little, WORD);
        let nodes: Result<Vec<u64>, ReadError> =
            (0..count).map(|k| number(lines, &words, k)).collect();
        let mut nodes = nodes?;
        element::frd_to_input_order(kind, &mut nodes);
        geometry.elements.push(RawElement { id, kind, nodes });
    }
    Ok(())
}

/// Displacements of a mode.
pub(crate) fn displacements(
    lines: &mut Lines,
    stated: usize,
    precision: Precision,
    table: &mut ModeTable,
) -> Result<Vec<Vec3>, ReadError> {
    let mut shape = ShapeBuilder::default();
    for _ in 0..stated {
        let (id, value) = record(lines, precision, "the end of a mode")?;
        let added = table.add(&mut shape, id, value);
        added.map_err(|message| lines.syntax(message))?;
    }
    let finished = table.finish(shape);
    finished.map_err(|message| lines.syntax(message))
}

/// Passes over a result of so many components.
pub(crate) fn skip(
    lines: &mut Lines,
    stated: usize,
    components: usize,
    precision: Precision,
) -> Result<(), ReadError> {
    let width = match precision {
        Precision::Single => 1,
        Precision::Double => 2,
    };
    for _ in 0..stated {
        lines.bytes(WORD * (1 + components * width), "the end of a result block")?;
    }
    Ok(())
}
