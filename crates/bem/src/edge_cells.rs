//! Hat functions in the cells along trailing edges: the law of [`crate::divided_edges`] in
//! potential and influence.
//!
//! Triangles with divided edges are taken in parts, linear in each. Influence and potential of
//! a hat function go to the columns of the vertices that make its height and, by s, to those
//! of jumps; no unknowns come with it, and test functions stay as they are. Edges are divided
//! in halves because test triangles near a panel are divided there
//! ([`crate::near_field`]): kinks inside a part would be missed.

use crate::adjacency::undirected;
use crate::cut::CutSurface;
use crate::divided_edges::{DividedEdge, HEIGHT};
use crate::near_field::point_values;
use crate::ordering::spatial_order;
use crate::panel_block::{BLOCK, PanelBlock};
use fladder_mesh::Vec3;
use std::collections::HashMap;

/// Barycentric coordinate of a point that rounding has put outside.
const ON_EDGE: f64 = 1e-12;

/// A hat function and its values at the three points of a triangle.
type HatValues = (u32, [f64; 3]);

/// Divided edges of a cut surface and what belongs to them.
#[derive(Clone, Debug)]
pub(crate) struct EdgeCells {
    /// Vertices of the surface and columns of jumps. The slope of a jump has the number
    /// that follows the vertices by its column, the hat function of a divided edge the one
    /// that follows those by its place.
    n_vertices: u32,
    n_columns: u32,
    divided: Vec<DividedEdge>,
    /// Values of the hat functions in each triangle in parts.
    inside: HashMap<u32, Vec<HatValues>>,
}

fn sides_of([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

impl EdgeCells {
    /// Of the surface's divided edges; adds blocks of the parts of triangles, whose corners'
    /// columns are hat functions.
    pub(crate) fn new(surface: &CutSurface, blocks: &mut Vec<PanelBlock>) -> Self {
        let divided = surface.divided.clone();
        let (n_vertices, n_columns) = (surface.vertices.len(), surface.columns.len());
        let mut middles = Middles::new(&divided, n_vertices);
        let mut cells = Self {
            n_vertices: n_vertices as u32,
            n_columns: n_columns as u32,
            divided,
            inside: HashMap::new(),
        };
        let mut all = Vec::new();
        for (t, &corners) in surface.triangles.iter().enumerate() {
            let parts = middles.parts(corners);
            if parts.len() > 1 {
                let values = cells.hats_inside(corners, &parts, &middles);
                cells.inside.insert(t as u32, values);
                all.extend(parts);
            }
        }
        let mut vertices = surface.vertices.clone();
        for ends in &middles.ends {
            let [p, q] = ends.map(|v| vertices[v as usize]);
            vertices.push(0.5 * (p + q));
        }
        let centres: Vec<Vec3> = all
            .iter()
            .map(|part| part.iter().map(|&v| vertices[v as usize]).sum::<Vec3>() / 3.0)
            .collect();
        let order = spatial_order(&centres, [BLOCK]);
        blocks.extend(order.chunks(BLOCK).map(|which| {
            let hat = |t: u32, c: usize| cells.hat(all[t as usize][c]);
            let mut block = PanelBlock::new(&vertices, &all, which, hat);
            // They have no sources of their own.
            block.triangles.clear();
            block
        }));
        cells
    }

    /// Column of a hat function, by the vertex it is one at.
    fn hat(&self, vertex: u32) -> Option<u32> {
        let hats = self.n_vertices..self.n_vertices + self.divided.len() as u32;
        hats.contains(&vertex).then_some(vertex + self.n_columns)
    }

    /// A column with factors: a vertex itself, or vertices and slopes of jumps that make the
    /// height of a hat function.
    pub(crate) fn made_of(&self, column: u32) -> impl Iterator<Item = (u32, f64)> {
        let vertex = (column < self.n_vertices).then_some((column, 1.0));
        let hat = column.checked_sub(self.n_vertices + self.n_columns);
        let edge = hat.map(|hat| &self.divided[hat as usize]);
        let height = edge.into_iter().flat_map(|edge| {
            let slope = edge.slope.iter();
            let slopes = slope.map(|&(column, w)| (self.n_vertices + column as u32, w));
            edge.height
                .iter()
                .copied()
                .chain(slopes)
                .map(|(v, weight)| (v, HEIGHT * weight))
        });
        vertex.into_iter().chain(height)
    }

    /// Columns of jumps.
    pub(crate) fn n_columns(&self) -> usize {
        self.n_columns as usize
    }

    /// Vertices of the surface: their columns come first.
    pub(crate) fn n_vertices(&self) -> u32 {
        self.n_vertices
    }

    /// Hat functions that reach into a triangle, by their columns.
    pub(crate) fn inside(&self, triangle: u32) -> &[HatValues] {
        self.inside.get(&triangle).map_or(&[], Vec::as_slice)
    }

    /// Values of the hat functions at the three points of a triangle, taken as the influences
    /// of near panels are: on thin sections the two all but cancel.
    fn hats_inside(
        &self,
        corners: [u32; 3],
        parts: &[[u32; 3]],
        middles: &Middles,
    ) -> Vec<HatValues> {
        let unit = |v: u32| corners.map(|c| if c == v { 1.0 } else { 0.0 });
        let coordinates = |v: u32| -> [f64; 3] {
            let [a, b] = middles.ends_of(v).unwrap_or([v, v]).map(unit);
            std::array::from_fn(|i| 0.5 * (a[i] + b[i]))
        };
        let placed: Vec<_> = parts.iter().map(|p| (p, p.map(coordinates))).collect();
        let mut hats: Vec<u32> = parts.iter().flatten().copied().collect();
        hats.retain(|v| self.hat(*v).is_some());
        hats.sort_unstable();
        hats.dedup();
        let value = |hat: u32, point: &[f64; 3]| {
            let inside = placed.iter().find_map(|(part, at)| {
                let shape = shape_in(at, point);
                shape.iter().all(|x| *x > -ON_EDGE).then_some((part, shape))
            });
            inside.map_or(0.0, |(part, shape)| {
                let own = part.iter().zip(shape).find(|(v, _)| **v == hat);
                own.map_or(0.0, |(_, x)| x)
            })
        };
        hats.iter()
            .filter_map(|&v| Some((self.hat(v)?, point_values(|x| value(v, x)))))
            .collect()
    }
}

/// Barycentric coordinates of a point in a part, both given in those of the whole triangle.
fn shape_in(part: &[[f64; 3]; 3], point: &[f64; 3]) -> [f64; 3] {
    let det = |a: &[f64; 3], b: &[f64; 3], c: &[f64; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    let [a, b, c] = part;
    let whole = det(a, b, c);
    [det(point, b, c), det(a, point, c), det(a, b, point)].map(|x| x / whole)
}

/// Middles of edges as vertices behind those of the surface, those with a hat function first.
struct Middles {
    n_vertices: u32,
    ends: Vec<[u32; 2]>,
    of_edge: HashMap<(u32, u32), u32>,
}

impl Middles {
    fn new(divided: &[DividedEdge], n_vertices: usize) -> Self {
        let n_vertices = n_vertices as u32;
        let ends: Vec<[u32; 2]> = divided.iter().map(|edge| edge.ends).collect();
        let number =
            |(k, [a, b]): (usize, &[u32; 2])| (undirected(*a, *b), n_vertices + k as u32);
        Self {
            n_vertices,
            of_edge: ends.iter().enumerate().map(number).collect(),
            ends,
        }
    }

    /// Ends of the edge whose middle a vertex is.
    fn ends_of(&self, vertex: u32) -> Option<[u32; 2]> {
        let middle = vertex.checked_sub(self.n_vertices)?;
        Some(self.ends[middle as usize])
    }

    /// A triangle divided at the middles of its edges, in quarters where two are divided:
    /// the middle of the third is added.
    fn parts(&mut self, corners: [u32; 3]) -> Vec<[u32; 3]> {
        let at = |[a, b]: [u32; 2]| self.of_edge.get(&undirected(a, b)).copied();
        // Turned so that an undivided edge comes first.
        let sides = sides_of(corners);
        let Some(whole) = (0..3).find(|&e| at(sides[e]).is_none()) else {
            return vec![corners];
        };
        let [a, b, c] = std::array::from_fn(|i| corners[(whole + i) % 3]);
        match (at([b, c]), at([c, a])) {
            (None, None) => vec![corners],
            (Some(m), None) => vec![[a, b, m], [a, m, c]],
            (None, Some(m)) => vec![[a, b, m], [m, b, c]],
            (Some(m), Some(n)) => {
                let own = self.n_vertices + self.ends.len() as u32;
                self.ends.push([a, b]);
                vec![[a, own, n], [own, b, m], [n, m, c], [own, m, n]]
            }
        }
    }
}
