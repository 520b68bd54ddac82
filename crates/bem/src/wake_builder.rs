//! Lays the wake out: lines of the sheet, strips between them, corners on the body.
//!
//! Every trailing-edge vertex has a line along the stream; the line of a junction follows
//! the body to its end, and lines start where body lines are led over a base. Neighbouring
//! lines span strips: triangles up to the last station, then a strip of the far part.
//!
//! Distances ξ count from the vertex where a jump starts. Where a sheet carries jumps that
//! started elsewhere too, it lies there several times, once for each origin (*copies*):
//! influences are linear in the jump.

use crate::body_path::{BodyPaths, Finish};
use crate::contour::Paths;
use crate::cut::{CutSurface, Jump};
use crate::error::BemError;
use crate::far_wake::FarWake;
use crate::image::mirrored;
use crate::sheet_lines::{Layer, SheetLine, Source};
use crate::stations::{RowLaw, stations};
use crate::strike::Strikes;
use crate::wake::{JumpSheet, Slot, Wake};
use crate::wake_jumps::SAME_ORIGIN;
use crate::wake_sheet::{JunctionLine, WakeSheet};
use fladder_mesh::{TrailingEdge, TriMesh, Vec3};
use std::collections::HashMap;

/// Distance of the far part behind the last body point, in semichords.
const FAR_MARGIN: f64 = 0.6;

/// Everything of a wake while it is being laid out.
pub(crate) struct Builder<'a> {
    pub(crate) mesh: &'a TriMesh,
    pub(crate) chains: &'a [TrailingEdge],
    pub(crate) surface: &'a CutSurface,
    pub(crate) paths: &'a BodyPaths,
    pub(crate) direction: Vec3,
    pub(crate) law: RowLaw,
    pub(crate) stations: Vec<f64>,
    pub(crate) margin: f64,
    /// Whether the other half is an image.
    half: bool,
    pub(crate) threads: Vec<Jump>,
    pub(crate) thread_of: HashMap<Vec<(usize, u64)>, usize>,
    pub(crate) slots: Vec<Slot>,
    pub(crate) slot_of: HashMap<(usize, u64), u32>,
    pub(crate) far: FarWake,
    pub(crate) far_threads: Vec<usize>,
    pub(crate) sheet: Layer,
    notes: Vec<String>,
}

impl<'a> Builder<'a> {
    pub(crate) fn new(
        mesh: &'a TriMesh,
        chains: &'a [TrailingEdge],
        surface: &'a CutSurface,
        paths: &'a BodyPaths,
        direction: Vec3,
        semichord: f64,
        half: bool,
    ) -> Self {
        let mut builder = Self {
            mesh,
            chains,
            surface,
            paths,
            direction,
            law: RowLaw::new(f64::INFINITY, semichord),
            stations: Vec::new(),
            margin: FAR_MARGIN * semichord,
            half,
            threads: Vec::new(),
            thread_of: HashMap::new(),
            slots: Vec::new(),
            slot_of: HashMap::new(),
            far: FarWake {
                direction,
                anchors: Vec::new(),
                strips: Vec::new(),
            },
            far_threads: Vec::new(),
            sheet: Layer::default(),
            notes: Vec::new(),
        };
        builder.set_stations(semichord);
        builder
    }

    pub(crate) fn position(&self, vertex: u32) -> Vec3 {
        self.mesh.vertices[vertex as usize]
    }

    fn set_stations(&mut self, semichord: f64) {
        let last_cell = self
            .chains
            .iter()
            .map(|c| self.last_cell(c))
            .fold(f64::INFINITY, f64::min);
        if !last_cell.is_finite() {
            return;
        }
        let along = |v: &Vec3| v.dot(&self.direction);
        let foremost = self
            .chains
            .iter()
            .flat_map(|c| &c.vertices)
            .map(|&v| along(&self.position(v)))
            .fold(f64::INFINITY, f64::min);
        let rear = self
            .mesh
            .vertices
            .iter()
            .map(along)
            .fold(f64::NEG_INFINITY, f64::max);
        self.law = RowLaw::new(last_cell, semichord);
        self.stations = stations(self.law, rear - foremost + self.margin);
    }

    /// Mean height of the triangles on a trailing edge: the last chordwise cell.
    fn last_cell(&self, chain: &TrailingEdge) -> f64 {
        let mut sum = 0.0;
        for ([a, b], (&upper, &lower)) in
            chain.edges().zip(chain.upper.iter().zip(&chain.lower))
        {
            let edge = self.position(b) - self.position(a);
            for t in [upper, lower] {
                sum += 2.0 * self.mesh.area_vector(t as usize).norm() / edge.norm();
            }
        }
        sum / (2 * chain.upper.len()) as f64
    }

    pub(crate) fn build(mut self, strikes: &Strikes<'_>) -> Result<Wake, BemError> {
        for chain in 0..self.chains.len() {
            self.chain_sheet(chain);
        }
        for path in 0..self.paths.paths.len() {
            self.base_sheet(path);
        }
        let close = strikes.check(&self.sheet)?;
        self.notes.extend(close);
        let body = self.body_jumps();
        Ok(self.finish(body))
    }

    /// The sheet of one trailing edge, with what others add to it.
    fn chain_sheet(&mut self, c: usize) {
        let chain = &self.chains[c];
        let n = chain.vertices.len();
        let mut lines = Vec::with_capacity(n);
        for i in 0..n {
            let path = match (i == 0, i == n - 1) {
                (true, _) => self.paths.of_end(c, false),
                (_, true) => self.paths.of_end(c, true),
                _ => None,
            };
            let line = if let Some(path) = path {
                self.junction_line(path)
            } else {
                let thread = self.thread(&self.surface.chain_jumps[c][i]);
                self.free_line(self.position(chain.vertices[i]), 0.0, thread)
            };
            lines.push(line);
        }
        for i in 0..chain.upper.len() {
            let source = Source {
                edge: c,
                start: chain.vertices[i],
            };
            self.strip([&lines[i], &lines[(i + 1) % n]], Some(source));
        }
        for last in [false, true] {
            if let Some(path) = self.paths.of_end(c, last) {
                let inner = if last { [n - 1, n - 2] } else { [0, 1] };
                self.node_copies(path, inner.map(|i| &lines[i]));
            }
        }
        for join in &self.surface.joins {
            if join.chain == c {
                let pair = [&lines[join.edge], &lines[(join.edge + 1) % n]];
                let vertex = self.paths.paths[join.path].last();
                let is_first = chain.vertices[join.edge] == vertex;
                let sign = if join.on_upper { 1.0 } else { -1.0 };
                let thread = self.shared_thread(&[(join.path, sign)]);
                let shift = self.distance(join.path, self.position(vertex));
                let none = self.thread(&[]);
                let threads = if is_first {
                    [thread, none]
                } else {
                    [none, thread]
                };
                let copies = [0, 1]
                    .map(|k| self.copy(pair[k], shift, f64::NEG_INFINITY, 0.0, threads[k]));
                self.strip([&copies[0], &copies[1]], None);
            }
        }
    }

    /// The sheet's inner edge: along the body to the line's end, then straight on.
    fn junction_line(&mut self, path: usize) -> SheetLine {
        let line = &self.paths.paths[path];
        // An edge across may lead back by the stream's incidence: it counts as level.
        let knots: Vec<f64> = line.vertices[..=line.whole]
            .iter()
            .scan(0.0, |level: &mut f64, &v| {
                *level = level.max(self.distance(path, self.position(v)));
                Some(*level)
            })
            .collect();
        let corners: Vec<Vec3> = line.vertices[..=line.whole]
            .iter()
            .map(|&v| self.position(v))
            .collect();
        let end = corners[line.whole];
        if line.finish == Finish::Alone {
            self.notes.push(format!(
                "the wake's inner edge from the junction at vertex {} ends alone on the body, at vertex {} ({:.4}, {:.4}, {:.4} m): behind it the sheet has a free edge with the junction's jump, a vortex",
                line.vertices[0],
                line.last(),
                end.x,
                end.y,
                end.z
            ));
        }
        let whole = self.shared_thread(&[(path, 1.0)]);
        let shares = self.paths.jump_at(path, line.whole, &self.mesh.vertices);
        let own = self
            .origins(end, &shares)
            .into_iter()
            .find(|o| o.shares.iter().any(|(p, _)| *p == path))
            .map_or_else(Vec::new, |o| o.shares);
        let behind = self.shared_thread(&own);
        self.bent_line(&corners, &knots, [whole, behind])
    }

    /// Copies of the strip beside a line that ends in a node, one for each further origin.
    fn node_copies(&mut self, path: usize, [inner, next]: [&SheetLine; 2]) {
        let line = &self.paths.paths[path];
        if !matches!(line.finish, Finish::Node(_)) || line.whole + 1 < line.vertices.len() {
            return;
        }
        let end = self.position(line.last());
        let own = self.distance(path, end);
        let shares = self.paths.jump_at(path, line.whole, &self.mesh.vertices);
        // The jump comes in over the row before the node.
        let from = inner
            .xi
            .iter()
            .copied()
            .rfind(|&x| x < own - SAME_ORIGIN * self.margin)
            .unwrap_or(own);
        let none = self.thread(&[]);
        for origin in self.origins(end, &shares) {
            if origin.shares.iter().any(|(p, _)| *p == path) {
                continue;
            }
            let thread = self.shared_thread(&origin.shares);
            let shift = origin.xi - own;
            let edge = self.copy(inner, shift, from, own, thread);
            let beside = self.copy(next, shift, from, own, none);
            let pair = if line.end.last {
                [&beside, &edge]
            } else {
                [&edge, &beside]
            };
            self.strip(pair, None);
        }
    }

    /// The sheet behind a line that is led over a base to a node.
    fn base_sheet(&mut self, path: usize) {
        let line = &self.paths.paths[path];
        let Finish::Node(node) = line.finish else {
            return;
        };
        if line.whole + 1 == line.vertices.len() {
            return;
        }
        let members: Vec<(usize, f64)> = self.paths.nodes[node]
            .paths
            .iter()
            .map(|&p| (p, 1.0))
            .collect();
        let end = self.position(line.vertices[line.whole]);
        for origin in self.origins(end, &members) {
            let reference = origin.shares[0].0;
            let is_own = origin.shares.iter().any(|(p, _)| *p == path);
            let mut lines = Vec::new();
            for index in line.whole..line.vertices.len() {
                let point = self.position(line.vertices[index]);
                let jump: Vec<(usize, f64)> = self
                    .paths
                    .jump_at(path, index, &self.mesh.vertices)
                    .into_iter()
                    .filter(|(p, _)| origin.shares.iter().any(|(q, _)| p == q))
                    .collect();
                let thread = self.shared_thread(&jump);
                let xi = self.distance(reference, point);
                lines.push(self.free_line(point, xi, thread));
            }
            if !line.end.last {
                lines.reverse();
            }
            let seen = is_own.then_some(Source {
                edge: line.end.chain,
                start: line.vertices[0],
            });
            for pair in lines.windows(2) {
                self.strip([&pair[0], &pair[1]], seen);
            }
        }
    }

    fn visible(&self) -> WakeSheet {
        let lines = self.paths.paths.iter().map(|path| JunctionLine {
            edge: path.end.chain as u32,
            vertices: path.vertices.clone(),
        });
        self.sheet
            .visible(&self.stations, lines.collect(), self.direction)
    }

    fn finish(self, body: Vec<(u32, [u32; 3])>) -> Wake {
        let visible = self.visible();
        let start = self.stations.last().copied().unwrap_or(0.0);
        let reach = self.reach();
        let body_triangles: Vec<u32> = body.iter().map(|(t, _)| *t).collect();
        let body_panels: Vec<[u32; 3]> = body_triangles
            .iter()
            .map(|&t| self.mesh.triangles[t as usize])
            .collect();
        Wake {
            threads: self.threads,
            slots: self.slots,
            near: JumpSheet::new(
                &self.sheet.vertices,
                &self.sheet.triangles,
                self.sheet.corner_slots(),
                Vec::new(),
            ),
            body: JumpSheet::new(
                &self.mesh.vertices,
                &body_panels,
                body.into_iter().map(|(_, slots)| slots).collect(),
                body_triangles,
            ),
            far: self.far,
            far_threads: self.far_threads,
            paths: Paths::new(start, self.margin, reach),
            notes: self.notes,
            stations: self.stations.len(),
            sheet: visible,
        }
    }

    /// Largest distance of a body point from a wake streamline.
    fn reach(&self) -> f64 {
        let flat = |v: &Vec3| v - self.direction * v.dot(&self.direction);
        let anchors: Vec<Vec3> = self.far.anchors.iter().map(flat).collect();
        let images = self
            .mesh
            .vertices
            .iter()
            .filter(|_| self.half)
            .map(mirrored);
        self.mesh
            .vertices
            .iter()
            .copied()
            .chain(images)
            .map(|v| flat(&v))
            .flat_map(|v| anchors.iter().map(move |a| (v - a).norm()))
            .fold(self.margin, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use crate::{Problem, WakeDirection, plan};
    use fladder_mesh::shapes::NacaWing;
    use fladder_mesh::{Topology, Vec3, trailing_edge};

    /// The sheet of a straight wing lies behind it, row by row, its upper side up.
    #[test]
    fn the_visible_wake_of_a_wing() {
        let mesh = NacaWing::default().structured().expect("wing");
        let edges = trailing_edge::find_by_shape(
            &mesh,
            &Topology::new(&mesh),
            trailing_edge::Settings::default(),
        );
        let problem = Problem {
            wake_direction: WakeDirection::X,
            ..Problem::new(&mesh, &edges, &[], 0.5)
        };
        let wake = plan(&problem).expect("a wake").wake;
        let rows = wake.row.iter().max().map_or(0, |r| r + 1);
        assert_eq!(wake.triangles.len(), 2 * 24 * rows as usize);
        assert_eq!(wake.edge.len(), wake.triangles.len());
        assert!(wake.edge.iter().all(|&e| e == 0));
        for t in &wake.triangles {
            let [a, b, c] = t.map(|v| Vec3::from(wake.vertices[v as usize]));
            assert!((b - a).cross(&(c - a)).z > 0.0);
            for p in [a, b, c] {
                assert!(p.x >= 1.0 - 1e-12 && p.x <= 1.3 + 1e-12 && p.z.abs() < 1e-12);
            }
        }
        // Rows are at most 0.2 b long.
        let phase = wake.phase_per_row(1.0, 0.5);
        assert!(phase > 0.05 && phase <= 0.2 + 1e-9, "{phase}");
    }
}
