//! Triangles round a vertex, and the groups into which cuts divide them.

use std::collections::{BTreeMap, HashMap, HashSet};

/// An edge without direction.
pub(crate) fn undirected(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

/// Which way round a vertex, seen from outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Turn {
    /// Counter-clockwise.
    Left,
    /// Clockwise.
    Right,
}

/// Who touches whom in a closed triangle surface.
#[derive(Clone, Debug)]
pub(crate) struct Adjacency<'a> {
    triangles: &'a [[u32; 3]],
    around: Vec<Vec<u32>>,
    directed: HashMap<(u32, u32), u32>,
}

impl<'a> Adjacency<'a> {
    pub(crate) fn new(n_vertices: usize, triangles: &'a [[u32; 3]]) -> Self {
        let mut around = vec![Vec::new(); n_vertices];
        let mut directed = HashMap::with_capacity(3 * triangles.len());
        for (t, corners) in triangles.iter().enumerate() {
            for i in 0..3 {
                around[corners[i] as usize].push(t as u32);
                directed.insert((corners[i], corners[(i + 1) % 3]), t as u32);
            }
        }
        Self {
            triangles,
            around,
            directed,
        }
    }

    /// Triangles that have the vertex, ascending.
    pub(crate) fn triangles_of(&self, vertex: u32) -> &[u32] {
        &self.around[vertex as usize]
    }

    /// The triangle whose boundary runs from `a` to `b`.
    pub(crate) fn left_of(&self, a: u32, b: u32) -> Option<u32> {
        self.directed.get(&(a, b)).copied()
    }

    /// Vertices joined to `vertex` by an edge, ascending.
    pub(crate) fn neighbours(&self, vertex: u32) -> Vec<u32> {
        let mut all: Vec<u32> = self
            .triangles_of(vertex)
            .iter()
            .flat_map(|&t| self.triangles[t as usize])
            .filter(|&v| v != vertex)
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Corners of a triangle.
    pub(crate) fn corners(&self, triangle: u32) -> [u32; 3] {
        self.triangles[triangle as usize]
    }

    /// The corner number of `vertex` in `triangle`.
    pub(crate) fn corner(&self, triangle: u32, vertex: u32) -> Option<usize> {
        self.triangles[triangle as usize]
            .iter()
            .position(|&v| v == vertex)
    }

    /// The corner of a triangle that is neither `a` nor `b`.
    pub(crate) fn third(&self, triangle: u32, a: u32, b: u32) -> Option<u32> {
        self.corners(triangle)
            .into_iter()
            .find(|&v| v != a && v != b)
    }

    /// Triangles round `vertex` seen from outside: counter-clockwise from the edge to
    /// `from` or clockwise, up to the first further edge that `stop` takes; and that
    /// edge's other vertex. None at an open rim, or where no edge stops.
    pub(crate) fn sector(
        &self,
        vertex: u32,
        from: u32,
        turn: Turn,
        stop: impl Fn(u32) -> bool,
    ) -> Option<(Vec<u32>, u32)> {
        let mut triangles = Vec::new();
        let mut edge = from;
        loop {
            let next = match turn {
                Turn::Left => self.left_of(vertex, edge)?,
                Turn::Right => self.left_of(edge, vertex)?,
            };
            triangles.push(next);
            edge = self.third(next, vertex, edge)?;
            if stop(edge) {
                return Some((triangles, edge));
            }
            if edge == from || triangles.len() > self.triangles_of(vertex).len() {
                return None;
            }
        }
    }

    /// At a vertex on an open rim, the neighbour along the rim from which its triangles lie
    /// counter-clockwise; none inside the surface.
    pub(crate) fn rim(&self, vertex: u32) -> Option<u32> {
        self.neighbours(vertex)
            .into_iter()
            .find(|&v| self.left_of(vertex, v).is_some() && self.left_of(v, vertex).is_none())
    }

    /// Groups into which the edges of `cuts` divide the triangles round `vertex`.
    ///
    /// Union–find over the edges that meet at the vertex; geometry has no say, since
    /// at a body's tail it gives nonsense.
    pub(crate) fn fan_groups(&self, vertex: u32, cuts: &HashSet<(u32, u32)>) -> Vec<Vec<u32>> {
        let fan = self.triangles_of(vertex);
        let mut parent: Vec<usize> = (0..fan.len()).collect();
        let mut first_with: HashMap<u32, usize> = HashMap::new();
        for (i, &t) in fan.iter().enumerate() {
            for other in self.triangles[t as usize] {
                if other == vertex || cuts.contains(&undirected(vertex, other)) {
                    continue;
                }
                match first_with.get(&other) {
                    Some(&j) => {
                        let (a, b) = (root(&mut parent, i), root(&mut parent, j));
                        parent[a.max(b)] = a.min(b);
                    }
                    None => {
                        first_with.insert(other, i);
                    }
                }
            }
        }
        let mut groups: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
        for (i, &t) in fan.iter().enumerate() {
            groups.entry(root(&mut parent, i)).or_default().push(t);
        }
        groups.into_values().collect()
    }
}

fn root(parent: &mut [usize], mut i: usize) -> usize {
    while parent[i] != i {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    i
}
