//! Wavefront OBJ: `v`, `f` and `l` lines in groups named by `g` or `o`.
//!
//! Polygons are cut into triangles, quadrilaterals along the better diagonal.
//! Faces make surface groups, lines curve groups. Indices count from 1, or
//! back from the last vertex when negative; texture and normal indices,
//! materials and free-form geometry are passed over.

use super::MISSING_VERTEX;
use super::cursor::{Cursor, Malformed};
use super::draft::Draft;
use crate::Vec3;

pub(super) fn parse(bytes: &[u8]) -> Result<Draft, Malformed> {
    let mut cursor = Cursor::new(bytes);
    let mut draft = Draft::default();
    // Indices may run ahead of the vertices, so that faces are cut at the end.
    let mut polygons: Vec<Polygon> = Vec::new();
    let mut group = String::new();
    let mut not_finite = Vec::new();
    let mut number = 0;
    while let Some(line) = cursor.line() {
        number += 1;
        let line = std::str::from_utf8(line).map_err(|_| at(number, "the line is not text"))?;
        let mut words = line
            .split('#')
            .next()
            .unwrap_or_default()
            .split_whitespace();
        match words.next() {
            Some("v") => {
                let position = vertex(words, number)?;
                if !position.iter().all(|x| x.is_finite()) {
                    not_finite.push(format!("line {number}"));
                }
                draft.vertices.push(position);
            }
            Some("g" | "o") => group = words.collect::<Vec<_>>().join(" "),
            Some(word @ ("f" | "l")) => {
                let n_vertices = draft.vertices.len();
                let corners = words
                    .map(|word| corner(word, n_vertices, number))
                    .collect::<Result<Vec<i64>, _>>()?;
                let is_line = word == "l";
                let fewest = if is_line { 2 } else { 3 };
                if corners.len() < fewest {
                    return Err(at(
                        number,
                        format!(
                            "`{word}` needs {fewest} vertices, {} are there",
                            corners.len()
                        ),
                    ));
                }
                polygons.push(Polygon {
                    is_line,
                    corners,
                    group: group.clone(),
                    line: number,
                });
            }
            Some(_) | None => {}
        }
    }
    draft.note_places("coordinates that are no finite numbers", &not_finite);
    cut(&mut draft, polygons);
    Ok(draft)
}

/// A face or polyline, its corners counted from 0.
struct Polygon {
    is_line: bool,
    corners: Vec<i64>,
    group: String,
    line: usize,
}

fn at(line: usize, what: impl Into<String>) -> Malformed {
    Malformed {
        place: super::Place::Line(line),
        what: what.into(),
        remedy: "correct the line".into(),
    }
}

fn vertex<'a>(words: impl Iterator<Item = &'a str>, line: usize) -> Result<Vec3, Malformed> {
    let mut coordinates = [0.0; 3];
    let mut count = 0;
    for (slot, word) in coordinates.iter_mut().zip(words) {
        *slot = word.parse().map_err(|_| {
            let shown: String = word.chars().take(40).collect();
            at(line, format!("`{shown}` is not a number"))
        })?;
        count += 1;
    }
    if count < 3 {
        return Err(at(
            line,
            format!("a vertex has 3 coordinates, {count} are there"),
        ));
    }
    Ok(Vec3::from(coordinates))
}

/// Vertex index of `v`, `v/vt`, `v//vn` or `v/vt/vn`, from 0; negative where
/// the file has no such vertex.
fn corner(word: &str, n_vertices: usize, line: usize) -> Result<i64, Malformed> {
    let digits = word.split('/').next().unwrap_or_default();
    let index: i64 = digits.parse().map_err(|_| {
        let shown: String = word.chars().take(40).collect();
        at(line, format!("`{shown}` is not a vertex number"))
    })?;
    Ok(if index < 0 {
        index.saturating_add(n_vertices as i64)
    } else {
        index - 1
    })
}

/// Cuts polygons into triangles and sorts all into their groups.
fn cut(draft: &mut Draft, polygons: Vec<Polygon>) {
    let n_vertices = draft.vertices.len();
    let mut missing = Vec::new();
    for polygon in polygons {
        let known = |corner: &i64| usize::try_from(*corner).is_ok_and(|v| v < n_vertices);
        if let Some(bad) = polygon.corners.iter().find(|corner| !known(corner)) {
            missing.push(format!(
                "line {} names vertex {}",
                polygon.line,
                bad.saturating_add(1)
            ));
        }
        let corners: Vec<u32> = polygon
            .corners
            .iter()
            .map(|corner| {
                if known(corner) {
                    *corner as u32
                } else {
                    MISSING_VERTEX
                }
            })
            .collect();
        if polygon.is_line {
            let name = if polygon.group.is_empty() {
                "lines"
            } else {
                &polygon.group
            };
            draft.add_to_curve(name, corners.windows(2).map(|pair| [pair[0], pair[1]]));
            continue;
        }
        let first = draft.triangles.len() as u32;
        draft.add_polygon(&corners);
        if !polygon.group.is_empty() {
            draft.add_to_surface(&polygon.group, first..draft.triangles.len() as u32);
        }
    }
    draft.note_places("vertices that are not in the file", &missing);
}
