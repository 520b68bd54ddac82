//! Nodes and elements of second order, made on starboard and mirrored to port.

use std::collections::{BTreeMap, HashMap};

use fladder_mesh::Vec3;

/// Nodes closer than this are one, m.
const MERGE: f64 = 8e-6;
/// Edge of the boxes in which a near node is looked for, m.
const BOX: f64 = 1e-5;
/// Points closer to the plane of symmetry than this lie on it, m.
const PLANE: f64 = 1e-9;

/// Ending of the sets on the port side.
pub(super) const PORT: &str = "_P";

/// A shell element: corners, then the middles of its edges; eight nodes or six.
pub(super) type Cell = Vec<usize>;

/// Nodes and shell elements; numbers count from 1.
#[derive(Clone, Debug, Default)]
pub(super) struct ShellMesh {
    pub(super) nodes: Vec<Vec3>,
    pub(super) cells: Vec<Cell>,
    /// Elements by the name of their set.
    pub(super) sets: BTreeMap<String, Vec<usize>>,
    boxes: HashMap<[i64; 3], usize>,
    /// Every interval is cut into so many.
    refine: usize,
}

impl ShellMesh {
    pub(super) fn new(refine: usize) -> Self {
        Self {
            refine: refine.max(1),
            ..Self::default()
        }
    }

    /// The node at a point, if there is one.
    pub(super) fn find(&self, point: &Vec3) -> Option<usize> {
        let key = cell_of(point);
        let near = |d: i64| [d - 1, d, d + 1];
        near(key[0])
            .into_iter()
            .flat_map(|i| near(key[1]).map(|j| (i, j)))
            .flat_map(|(i, j)| near(key[2]).map(|k| [i, j, k]))
            .filter_map(|key| self.boxes.get(&key).copied())
            .find(|number| (self.nodes[number - 1] - point).norm() < MERGE)
    }

    fn node(&mut self, point: Vec3) -> usize {
        if let Some(number) = self.find(&point) {
            return number;
        }
        self.nodes.push(point);
        self.boxes.insert(cell_of(&point), self.nodes.len());
        self.nodes.len()
    }

    fn add(&mut self, set: &str, port: bool, cell: Cell) {
        self.cells.push(cell);
        let name = if port {
            format!("{set}{PORT}")
        } else {
            set.to_owned()
        };
        self.sets.entry(name).or_default().push(self.cells.len());
    }

    /// Elements of eight nodes between the lines `u` and `v` of a surface; `flip` turns
    /// their normals.
    pub(super) fn patch(
        &mut self,
        set: &str,
        (u, v): (&[f64], &[f64]),
        flip: bool,
        surface: impl Fn(f64, f64) -> Vec3,
    ) {
        let (u, v) = (self.lines(u), self.lines(v));
        for port in [false, true] {
            let numbers: Vec<Vec<Option<usize>>> = (0..u.len())
                .map(|i| {
                    let used = |j: &usize| i.is_multiple_of(2) || j.is_multiple_of(2);
                    (0..v.len())
                        .map(|j| used(&j).then(|| self.node(side(port, surface(u[i], v[j])))))
                        .collect()
                })
                .collect();
            let at = |i: usize, j: usize| numbers[i][j].unwrap_or_default();
            for i in (0..u.len() - 1).step_by(2) {
                for j in (0..v.len() - 1).step_by(2) {
                    let mut ring = vec![
                        at(i, j),
                        at(i + 1, j),
                        at(i + 2, j),
                        at(i + 2, j + 1),
                        at(i + 2, j + 2),
                        at(i + 1, j + 2),
                        at(i, j + 2),
                        at(i, j + 1),
                    ];
                    turn(&mut ring, port != flip);
                    self.add(set, port, corners_first(&ring));
                }
            }
        }
    }

    /// Elements of six nodes round a point: `surface(0, v)` is the point, `surface(1, v)`
    /// the ring.
    pub(super) fn fan(&mut self, set: &str, v: &[f64], surface: impl Fn(f64, f64) -> Vec3) {
        let v = self.lines(v);
        for port in [false, true] {
            let tip = self.node(side(port, surface(0.0, v[0])));
            for j in (0..v.len() - 1).step_by(2) {
                let mut put = |u: f64, v: f64| self.node(side(port, surface(u, v)));
                let mut ring = vec![
                    tip,
                    put(0.5, v[j]),
                    put(1.0, v[j]),
                    put(1.0, v[j + 1]),
                    put(1.0, v[j + 2]),
                    put(0.5, v[j + 2]),
                ];
                turn(&mut ring, port);
                self.add(set, port, corners_first(&ring));
            }
        }
    }

    /// Lines of elements and their middles.
    fn lines(&self, places: &[f64]) -> Vec<f64> {
        let parts = 2 * self.refine;
        let mut lines = vec![places[0]];
        for pair in places.windows(2) {
            let inner = (1..parts).map(|i| i as f64 / parts as f64);
            lines.extend(inner.map(|part| pair[0] + part * (pair[1] - pair[0])));
            lines.push(pair[1]);
        }
        lines
    }

    /// Nodes of the sets that pass, ascending.
    pub(super) fn nodes_of(&self, keep: impl Fn(&str) -> bool) -> Vec<usize> {
        let sets = self.sets.iter().filter(|(name, _)| keep(name));
        let mut nodes: Vec<usize> = sets
            .flat_map(|(_, cells)| cells.iter().flat_map(|cell| &self.cells[cell - 1]))
            .copied()
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

/// A set's name without the ending of the port side.
pub(super) fn starboard(set: &str) -> &str {
    set.strip_suffix(PORT).unwrap_or(set)
}

fn cell_of(point: &Vec3) -> [i64; 3] {
    [point.x, point.y, point.z].map(|value| (value / BOX).round() as i64)
}

/// The point or its mirror image.
fn side(port: bool, mut point: Vec3) -> Vec3 {
    if point.y.abs() < PLANE {
        point.y = 0.0;
    } else if port {
        point.y = -point.y;
    }
    point
}

/// Other sense of rotation, first node kept.
fn turn(ring: &mut [usize], other: bool) {
    if other {
        ring[1..].reverse();
    }
}

/// From the order round the element to corners, then middles.
fn corners_first(ring: &[usize]) -> Cell {
    let every = |first: usize| ring.iter().skip(first).step_by(2).copied();
    every(0).chain(every(1)).collect()
}
