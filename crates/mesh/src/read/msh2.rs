//! Sections of Gmsh format 2.2.
//!
//! Every element carries its tags; the first is its physical group, 0 for none.

use super::cursor::{Cursor, Malformed, WRITE_AGAIN};
use super::msh_elements::{Gathered, kind};

pub(super) fn nodes(cursor: &mut Cursor, gathered: &mut Gathered) -> Result<(), Malformed> {
    let announced = text_count(cursor)?;
    for _ in 0..cursor.count(announced, 8, 28)? {
        let tag = cursor.int()?;
        let at = cursor.position()?;
        gathered.add_node(cursor, node_tag(cursor, tag)?, at)?;
    }
    Ok(())
}

pub(super) fn elements(cursor: &mut Cursor, gathered: &mut Gathered) -> Result<(), Malformed> {
    let announced = text_count(cursor)?;
    let mut left = cursor.count(announced, 8, 8)?;
    while left > 0 {
        let block = if cursor.is_binary {
            binary_block(cursor)?
        } else {
            Block {
                number: Some(cursor.int()?),
                element_type: cursor.int()?,
                count: 1,
                n_tags: cursor.int()?,
            }
        };
        let (kind, n_nodes) = kind(cursor, block.element_type)?;
        let n_tags = usize::try_from(block.n_tags)
            .ok()
            .filter(|&n| n <= cursor.remaining())
            .ok_or_else(|| {
                cursor.fault(format!("an element has {} tags", block.n_tags), WRITE_AGAIN)
            })?;
        if block.count == 0 || block.count > left {
            return Err(cursor.fault(
                format!("a block of {} elements where {left} are left", block.count),
                WRITE_AGAIN,
            ));
        }
        for _ in 0..block.count {
            let number = match block.number {
                Some(number) => number,
                None => cursor.int()?,
            };
            let mut group = 0;
            for k in 0..n_tags {
                let tag = cursor.int()?;
                if k == 0 {
                    group = tag.saturating_abs();
                }
            }
            let mut nodes = [0; 8];
            for node in &mut nodes[..n_nodes] {
                let tag = cursor.int()?;
                *node = node_tag(cursor, tag)?;
            }
            let groups: &[i32] = if group == 0 { &[] } else { &[group] };
            gathered.add_element(
                kind,
                u64::from(number.unsigned_abs()),
                &nodes[..n_nodes],
                groups,
            );
        }
        left -= block.count;
    }
    Ok(())
}

/// Elements that share type and number of tags; in text always one.
struct Block {
    /// Number of the element where it comes first.
    number: Option<i32>,
    element_type: i32,
    count: usize,
    n_tags: i32,
}

fn binary_block(cursor: &mut Cursor) -> Result<Block, Malformed> {
    let (element_type, count, n_tags) = (cursor.int()?, cursor.int()?, cursor.int()?);
    // A negative count fails the check against what is left.
    let count = usize::try_from(count).unwrap_or(0);
    Ok(Block {
        number: None,
        element_type,
        count,
        n_tags,
    })
}

/// The count at the head of a section, text even in a binary file.
fn text_count(cursor: &mut Cursor) -> Result<u64, Malformed> {
    let is_binary = std::mem::replace(&mut cursor.is_binary, false);
    let count = cursor.size()?;
    cursor.line();
    cursor.is_binary = is_binary;
    Ok(count)
}

fn node_tag(cursor: &Cursor, tag: i32) -> Result<u64, Malformed> {
    u64::try_from(tag)
        .map_err(|_| cursor.fault(format!("node number {tag} is negative"), WRITE_AGAIN))
}
