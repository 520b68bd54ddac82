//! Cells of a grid as triangles and lines of a surface.

use super::super::MISSING_VERTEX;
use super::super::cursor::Malformed;
use super::super::draft::Draft;
use super::{DataArray, File, Piece, wrong};
use crate::Vec3;

/// Numbers of cell types.
const VERTEX: i64 = 1;
const POLY_VERTEX: i64 = 2;
const LINE: i64 = 3;
const POLYLINE: i64 = 4;
const TRIANGLE: i64 = 5;
const POLYGON: i64 = 7;
const PIXEL: i64 = 8;
const QUAD: i64 = 9;

/// Pieces becoming a surface.
pub(super) struct Reading<'a> {
    pub(super) file: &'a File<'a>,
    pub(super) draft: &'a mut Draft,
    pub(super) missing: Vec<String>,
    pub(super) points_only: usize,
}

impl Reading<'_> {
    pub(super) fn piece(&mut self, piece: &Piece<'_>) -> Result<(), Malformed> {
        let numbers = |array: &Option<DataArray<'_>>, name: &str| {
            let array = array.as_ref();
            let array =
                array.ok_or_else(|| wrong(format!("a piece has no array of {name}")))?;
            self.file.numbers(array)
        };
        let points = numbers(&piece.points, "points")?;
        let corners = numbers(&piece.connectivity, "connectivity")?;
        let ends = numbers(&piece.offsets, "offsets")?;
        let types = numbers(&piece.types, "types")?;
        let groups = piece
            .group
            .as_ref()
            .map(|array| self.file.numbers(array))
            .transpose()?;
        if points.len() % 3 != 0 {
            return Err(wrong("the points have not three coordinates each"));
        }
        if types.len() != ends.len() || groups.as_ref().is_some_and(|g| g.len() != ends.len()) {
            return Err(wrong(format!(
                "{} cells have {} types",
                ends.len(),
                types.len()
            )));
        }
        let base = self.draft.vertices.len() as u32;
        let count = points.len() / 3;
        self.draft
            .vertices
            .extend(points.chunks_exact(3).map(|p| Vec3::new(p[0], p[1], p[2])));
        self.note_not_finite(base as usize);
        let mut start = 0;
        for (number, (&end, &kind)) in ends.iter().zip(&types).enumerate() {
            let slice = (end.fract() == 0.0 && end >= start as f64)
                .then(|| corners.get(start..end as usize))
                .flatten()
                .ok_or_else(|| {
                    wrong(format!("cell {number} ends at {end}, which is no place"))
                })?;
            start = end as usize;
            let known = |v: f64| v.fract() == 0.0 && (0.0..count as f64).contains(&v);
            if let Some(bad) = slice.iter().find(|v| !known(**v)) {
                self.missing
                    .push(format!("cell {number} names point {bad}"));
            }
            let corner = |v: &f64| {
                if known(*v) {
                    base + *v as u32
                } else {
                    MISSING_VERTEX
                }
            };
            let cell: Vec<u32> = slice.iter().map(corner).collect();
            let group = groups.as_ref().map_or(0.0, |groups| groups[number]);
            self.cell(number, kind as i64, &cell, group)?;
        }
        Ok(())
    }

    fn note_not_finite(&mut self, base: usize) {
        let bad = self.draft.vertices[base..].iter().enumerate();
        let bad = bad.filter(|(_, p)| !p.iter().all(|x| x.is_finite()));
        let places: Vec<String> = bad.map(|(i, _)| format!("point {i}")).collect();
        self.draft
            .note_places("coordinates that are no finite numbers", &places);
    }

    fn cell(
        &mut self,
        number: usize,
        kind: i64,
        corners: &[u32],
        group: f64,
    ) -> Result<(), Malformed> {
        let expected = match kind {
            VERTEX | POLY_VERTEX => {
                self.points_only += 1;
                return Ok(());
            }
            LINE | POLYLINE => {
                let edges = corners.windows(2).map(|pair| [pair[0], pair[1]]);
                self.draft.add_to_curve("lines", edges);
                return Ok(());
            }
            TRIANGLE => 3..=3,
            PIXEL | QUAD => 4..=4,
            POLYGON => 3..=usize::MAX,
            _ => {
                return Err(Malformed::whole(
                    format!(
                        "cell {number} is of VTK type {kind}, which is no flat surface element"
                    ),
                    "extract the surface and save triangles or quadrilaterals",
                ));
            }
        };
        if !expected.contains(&corners.len()) {
            return Err(wrong(format!(
                "cell {number} of VTK type {kind} has {} corners",
                corners.len()
            )));
        }
        let first = self.draft.triangles.len() as u32;
        match *corners {
            [a, b, d, c] if kind == PIXEL => self.draft.add_quad([a, b, c, d]),
            _ => self.draft.add_polygon(corners),
        }
        if group >= 1.0 {
            let last = self.draft.triangles.len() as u32;
            self.draft
                .add_to_surface(&format!("group_{group}"), first..last);
        }
        Ok(())
    }
}
