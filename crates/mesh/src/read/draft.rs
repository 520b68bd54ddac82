//! A surface while it is being read.

use std::collections::BTreeMap;

use super::MISSING_VERTEX;
use super::cursor::Malformed;
use crate::{CurveGroup, SurfaceGroup, TriMesh, Vec3};

/// At most this many single places are named in a note.
pub(super) const SHOWN: usize = 5;

/// A surface whose vertices may be unused and whose lines may lie off it.
#[derive(Clone, Debug, Default)]
pub(super) struct Draft {
    pub(super) vertices: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) notes: Vec<String>,
    surfaces: Groups<u32>,
    curves: Groups<[u32; 2]>,
}

/// Named lists in the order in which the names came up.
#[derive(Clone, Debug)]
struct Groups<T> {
    index: BTreeMap<String, usize>,
    lists: Vec<(String, Vec<T>)>,
}

impl<T> Default for Groups<T> {
    fn default() -> Self {
        Self {
            index: BTreeMap::new(),
            lists: Vec::new(),
        }
    }
}

impl<T> Groups<T> {
    fn list(&mut self, name: &str) -> &mut Vec<T> {
        if !self.index.contains_key(name) {
            self.index.insert(name.to_owned(), self.lists.len());
            self.lists.push((name.to_owned(), Vec::new()));
        }
        &mut self.lists[self.index[name]].1
    }
}

impl Draft {
    pub(super) fn add_to_surface(
        &mut self,
        name: &str,
        triangles: impl IntoIterator<Item = u32>,
    ) {
        self.surfaces.list(name).extend(triangles);
    }

    pub(super) fn add_to_curve(
        &mut self,
        name: &str,
        edges: impl IntoIterator<Item = [u32; 2]>,
    ) {
        self.curves.list(name).extend(edges);
    }

    /// Adds the two triangles of a quadrilateral, cut along the diagonal that
    /// leaves the larger smallest angle.
    pub(super) fn add_quad(&mut self, [a, b, c, d]: [u32; 4]) {
        let along_ac = [[a, b, c], [a, c, d]];
        let along_bd = [[a, b, d], [b, c, d]];
        let smallest = |cut: [[u32; 3]; 2]| {
            cut.iter()
                .map(|&t| self.smallest_angle(t))
                .fold(f64::INFINITY, f64::min)
        };
        // Equal within round-off counts as equal: the first diagonal stays.
        let cut = if smallest(along_bd) > smallest(along_ac) + 1e-9 {
            along_bd
        } else {
            along_ac
        };
        self.triangles.extend(cut);
    }

    /// Adds a polygon as triangles: a quadrilateral along the better diagonal, others as a
    /// fan round their first corner.
    pub(super) fn add_polygon(&mut self, corners: &[u32]) {
        match *corners {
            [a, b, c, d] => self.add_quad([a, b, c, d]),
            [first, ref rest @ ..] => {
                let fan = rest.windows(2).map(|pair| [first, pair[0], pair[1]]);
                self.triangles.extend(fan);
            }
            [] => {}
        }
    }

    /// Smallest angle in radians; zero when a vertex is missing.
    fn smallest_angle(&self, triangle: [u32; 3]) -> f64 {
        let mut corners = [Vec3::zeros(); 3];
        for (corner, v) in corners.iter_mut().zip(triangle) {
            let Some(p) = self.vertices.get(v as usize) else {
                return 0.0;
            };
            *corner = *p;
        }
        let angle = |k: usize| {
            let (u, v) = (
                corners[(k + 1) % 3] - corners[k],
                corners[(k + 2) % 3] - corners[k],
            );
            u.cross(&v).norm().atan2(u.dot(&v))
        };
        angle(0).min(angle(1)).min(angle(2))
    }

    /// Adds a note about single places, naming the first few.
    pub(super) fn note_places(&mut self, what: &str, places: &[String]) {
        if places.is_empty() {
            return;
        }
        let mut text = format!("{what}: {}", places[..places.len().min(SHOWN)].join(", "));
        if places.len() > SHOWN {
            text = format!("{text} and {} more", places.len() - SHOWN);
        }
        self.notes.push(text);
    }

    /// Drops what no triangle uses, scales, and gives the mesh and all notes.
    pub(super) fn finish(mut self, scale: f64) -> Result<(TriMesh, Vec<String>), Malformed> {
        if self.triangles.is_empty() {
            return Err(Malformed::whole(
                "the file holds no triangles or quadrilaterals",
                "export the surface mesh, not only points or lines",
            ));
        }
        let mut image = vec![MISSING_VERTEX; self.vertices.len()];
        for &v in self.triangles.iter().flatten() {
            if let Some(slot) = image.get_mut(v as usize) {
                *slot = 0;
            }
        }
        let mut vertices = Vec::with_capacity(self.vertices.len());
        for (slot, p) in image.iter_mut().zip(&self.vertices) {
            if *slot == 0 {
                *slot = vertices.len() as u32;
                vertices.push(p * scale);
            }
        }
        let dropped = self.vertices.len() - vertices.len();
        if dropped > 0 {
            self.notes.push(format!(
                "vertices that no triangle uses were dropped: {dropped}"
            ));
        }
        let at = |v: u32| image.get(v as usize).copied().unwrap_or(MISSING_VERTEX);
        let curves = self.mapped_curves(at);
        let triangles = self.triangles.iter().map(|t| t.map(at)).collect();
        let surfaces = self
            .surfaces
            .lists
            .into_iter()
            .map(|(name, mut triangles)| {
                triangles.sort_unstable();
                triangles.dedup();
                SurfaceGroup { name, triangles }
            });
        let surfaces = surfaces
            .filter(|group| !group.triangles.is_empty())
            .collect();
        Ok((
            TriMesh {
                vertices,
                triangles,
                surfaces,
                curves,
            },
            self.notes,
        ))
    }

    /// Curve groups in final vertex numbers, without the lines off the surface.
    fn mapped_curves(&mut self, at: impl Fn(u32) -> u32) -> Vec<CurveGroup> {
        let mut curves = Vec::new();
        for (name, edges) in std::mem::take(&mut self.curves.lists) {
            let n_lines = edges.len();
            let edges: Vec<[u32; 2]> = edges
                .into_iter()
                .map(|edge| edge.map(&at))
                .filter(|edge| !edge.contains(&MISSING_VERTEX))
                .collect();
            if edges.len() < n_lines {
                self.notes.push(format!(
                    "lines of curve group `{name}` that end off the surface were dropped: {} of {n_lines}",
                    n_lines - edges.len()
                ));
            }
            if !edges.is_empty() {
                curves.push(CurveGroup { name, edges });
            }
        }
        curves
    }
}
