//! The structure as triangles and lines between its nodes, for pictures.

use crate::element::ElementKind;
use crate::result::ModalResult;
use crate::skin;

/// Triangles of shells, or of the free faces of solids, and lines of beams.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cells {
    /// Three nodes each.
    pub triangles: Vec<[u32; 3]>,
    /// Two nodes each; nodes by themselves where there is nothing else.
    pub lines: Vec<[u32; 2]>,
}

/// Cuts by the number of nodes of a face, through the midside nodes.
fn cut(nodes: usize) -> &'static [[usize; 3]] {
    match nodes {
        3 => &[[0, 1, 2]],
        4 => &[[0, 1, 2], [0, 2, 3]],
        6 => &[[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
        8 => &[
            [0, 4, 7],
            [4, 1, 5],
            [5, 2, 6],
            [6, 3, 7],
            [4, 5, 6],
            [4, 6, 7],
        ],
        _ => &[],
    }
}

impl ModalResult {
    /// The structure's cells.
    pub fn cells(&self) -> Cells {
        let mut cells = Cells::default();
        for face in skin::candidates(self, &self.positions()) {
            let nodes = &face.nodes;
            let corners = cut(nodes.len()).iter().map(|t| t.map(|k| nodes[k]));
            cells.triangles.extend(corners);
        }
        for element in &self.elements {
            match (element.kind, element.nodes.as_slice()) {
                (ElementKind::Line2, [a, b]) => cells.lines.push([*a, *b]),
                (ElementKind::Line3, [a, b, middle]) => {
                    cells.lines.extend([[*a, *middle], [*middle, *b]]);
                }
                _ => {}
            }
        }
        if cells.triangles.is_empty() && cells.lines.is_empty() {
            cells.lines = (0..self.nodes.len() as u32).map(|node| [node; 2]).collect();
        }
        cells
    }
}
