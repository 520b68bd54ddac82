//! Sections of Gmsh format 4.1.
//!
//! Elements belong to blocks of one geometric entity; the physical groups hang
//! on the entities.

use std::collections::BTreeMap;

use super::cursor::{Cursor, Malformed, WRITE_AGAIN};
use super::msh_elements::{Gathered, kind};

/// Physical groups of every geometric entity, by dimension and tag.
#[derive(Debug, Default)]
pub(super) struct Entities(BTreeMap<(i32, i32), Vec<i32>>);

/// Fewest bytes of one number with its separator in text.
const TEXT: usize = 2;

pub(super) fn entities(cursor: &mut Cursor) -> Result<Entities, Malformed> {
    let mut entities = Entities::default();
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = cursor.size()?;
    }
    for (dimension, announced) in (0..).zip(counts) {
        let n_numbers = if dimension == 0 { 5 } else { 8 };
        for _ in 0..cursor.count(announced, n_numbers * TEXT, n_numbers * 4)? {
            let tag = cursor.int()?;
            // A point has coordinates, all others a bounding box.
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                cursor.double()?;
            }
            let groups = integers(cursor)?;
            if dimension > 0 {
                integers(cursor)?;
            }
            // The sign is the orientation of the group, not part of its tag.
            let groups = groups.into_iter().map(i32::saturating_abs).collect();
            entities.0.insert((dimension, tag), groups);
        }
    }
    Ok(entities)
}

/// A count and as many integers.
fn integers(cursor: &mut Cursor) -> Result<Vec<i32>, Malformed> {
    let announced = cursor.size()?;
    (0..cursor.count(announced, TEXT, 4)?)
        .map(|_| cursor.int())
        .collect()
}

pub(super) fn nodes(cursor: &mut Cursor, gathered: &mut Gathered) -> Result<(), Malformed> {
    let (n_blocks, n_nodes) = (cursor.size()?, cursor.size()?);
    cursor.size()?;
    cursor.size()?;
    cursor.count(n_nodes, 4 * TEXT, 32)?;
    for _ in 0..cursor.count(n_blocks, 4 * TEXT, 20)? {
        let dimension = cursor.int()?;
        cursor.int()?;
        let is_parametric = cursor.int()? != 0;
        let announced = cursor.size()?;
        let count = cursor.count(announced, 4 * TEXT, 32)?;
        let tags = (0..count)
            .map(|_| cursor.size())
            .collect::<Result<Vec<u64>, _>>()?;
        for tag in tags {
            let at = cursor.position()?;
            for _ in 0..if is_parametric {
                dimension.clamp(0, 3)
            } else {
                0
            } {
                cursor.double()?;
            }
            gathered.add_node(cursor, tag, at)?;
        }
    }
    agree(cursor, "nodes", n_nodes, gathered.positions.len() as u64)
}

pub(super) fn elements(
    cursor: &mut Cursor,
    gathered: &mut Gathered,
    entities: &Entities,
) -> Result<(), Malformed> {
    let (n_blocks, n_elements) = (cursor.size()?, cursor.size()?);
    cursor.size()?;
    cursor.size()?;
    let mut found = 0;
    for _ in 0..cursor.count(n_blocks, 4 * TEXT, 20)? {
        let entity = (cursor.int()?, cursor.int()?);
        let element_type = cursor.int()?;
        let (kind, n_nodes) = kind(cursor, element_type)?;
        let announced = cursor.size()?;
        let count = cursor.count(announced, (1 + n_nodes) * TEXT, (1 + n_nodes) * 8)?;
        let groups = entities.0.get(&entity).map_or(&[][..], Vec::as_slice);
        let mut nodes = [0; 8];
        for _ in 0..count {
            let tag = cursor.size()?;
            for node in &mut nodes[..n_nodes] {
                *node = cursor.size()?;
            }
            gathered.add_element(kind, tag, &nodes[..n_nodes], groups);
        }
        found += count as u64;
    }
    agree(cursor, "elements", n_elements, found)
}

fn agree(cursor: &Cursor, what: &str, announced: u64, found: u64) -> Result<(), Malformed> {
    if announced == found {
        return Ok(());
    }
    Err(cursor.fault(
        format!("{announced} {what} are announced, {found} are there"),
        WRITE_AGAIN,
    ))
}
