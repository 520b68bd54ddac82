//! Lays the wake out: lines of the sheet, strips between them, corners on the body.
//!
//! Every trailing-edge vertex has a line along the stream; the line of a junction follows
//! the body to the tail, and lines start where body lines meet. Neighbouring lines span
//! strips: triangles up to the last station, then a strip of the far part.

use crate::body_path::BodyPaths;
use crate::contour::Paths;
use crate::cut::CutSurface;
use crate::far_wake::FarWake;
use crate::image::mirrored;
use crate::panels::PanelSet;
use crate::stations::{RowLaw, stations};
use crate::wake::{JumpSheet, NO_SLOT, Slot, Wake};
use fladder_mesh::{TrailingEdge, TriMesh, Vec3};
use std::collections::HashMap;

/// Diagonals that differ less than this are as long as each other.
const SAME_LENGTH: f64 = 1e-9;

/// Distance of the far part behind the last body point, in semichords.
const FAR_MARGIN: f64 = 0.6;

/// A line of the sheet: its vertices from the first station on.
struct SheetLine {
    first_station: usize,
    vertices: Vec<u32>,
    far: u32,
}

/// Everything of a wake while it is being laid out.
pub(crate) struct Builder<'a> {
    mesh: &'a TriMesh,
    chains: &'a [TrailingEdge],
    surface: &'a CutSurface,
    paths: &'a BodyPaths,
    direction: Vec3,
    stations: Vec<f64>,
    margin: f64,
    /// Whether the other half is an image.
    half: bool,
    threads: Vec<Vec<(usize, f64)>>,
    slots: Vec<Slot>,
    slot_of: HashMap<(usize, u64), u32>,
    far: FarWake,
    far_threads: Vec<usize>,
    sheet_vertices: Vec<Vec3>,
    sheet_triangles: Vec<[u32; 3]>,
    sheet_slots: Vec<u32>,
    body_corners: HashMap<u32, [u32; 3]>,
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
            stations: Vec::new(),
            margin: FAR_MARGIN * semichord,
            half,
            threads: Vec::new(),
            slots: Vec::new(),
            slot_of: HashMap::new(),
            far: FarWake {
                direction,
                anchors: Vec::new(),
                strips: Vec::new(),
            },
            far_threads: Vec::new(),
            sheet_vertices: Vec::new(),
            sheet_triangles: Vec::new(),
            sheet_slots: Vec::new(),
            body_corners: HashMap::new(),
            notes: Vec::new(),
        };
        builder.stations = builder.row_stations(semichord);
        builder
    }

    fn position(&self, vertex: u32) -> Vec3 {
        self.mesh.vertices[vertex as usize]
    }

    fn row_stations(&self, semichord: f64) -> Vec<f64> {
        let last_cell = self
            .chains
            .iter()
            .map(|c| self.last_cell(c))
            .fold(f64::INFINITY, f64::min);
        if !last_cell.is_finite() {
            return Vec::new();
        }
        let wanted: Vec<f64> = (0..self.paths.paths.len())
            .flat_map(|p| self.path_distances(p))
            .collect();
        let tails: Vec<f64> = (0..self.paths.cuts.len())
            .map(|c| self.tail_distance(c))
            .collect();
        let farthest = self
            .chains
            .iter()
            .flat_map(|c| &c.vertices)
            .map(|&v| self.position(v).dot(&self.direction))
            .fold(f64::INFINITY, f64::min);
        let rear = self
            .mesh
            .vertices
            .iter()
            .map(|v| v.dot(&self.direction))
            .fold(f64::NEG_INFINITY, f64::max);
        let end = rear - farthest + self.margin;
        stations(RowLaw::new(last_cell, semichord), &wanted, &tails, end)
    }

    /// Mean height of the triangles on a trailing edge: the last chordwise cell.
    fn last_cell(&self, chain: &TrailingEdge) -> f64 {
        let n = chain.vertices.len();
        let mut sum = 0.0;
        for i in 0..chain.upper.len() {
            let edge =
                self.position(chain.vertices[(i + 1) % n]) - self.position(chain.vertices[i]);
            for t in [chain.upper[i], chain.lower[i]] {
                sum += 2.0 * self.mesh.area_vector(t as usize).norm() / edge.norm();
            }
        }
        sum / (2 * chain.upper.len()) as f64
    }

    fn path_distances(&self, path: usize) -> Vec<f64> {
        let line = &self.paths.paths[path].vertices;
        let origin = self.position(line[0]);
        line.iter()
            .map(|&v| (self.position(v) - origin).dot(&self.direction))
            .collect()
    }

    /// ξ where the wake leaves the body behind a cut.
    fn tail_distance(&self, cut: usize) -> f64 {
        let cut = &self.paths.cuts[cut];
        [cut.before, cut.after]
            .into_iter()
            .flatten()
            .filter_map(|p| self.path_distances(p).last().copied())
            .fold(0.0, f64::max)
    }

    pub(crate) fn build(mut self) -> Wake {
        let chain_threads = self.chain_threads();
        let bridges: Vec<Vec<usize>> = (0..self.paths.cuts.len())
            .map(|c| self.bridge_lines(c, &chain_threads))
            .collect();
        let mut lines: Vec<SheetLine> = Vec::new();
        let mut bridge_index: Vec<Vec<usize>> = Vec::new();
        for (cut, threads) in bridges.iter().enumerate() {
            let from = lines.len();
            for (i, &thread) in threads.iter().enumerate() {
                let line = self.bridge_line(cut, i, thread);
                lines.push(line);
            }
            bridge_index.push((from..lines.len()).collect());
        }
        for ids in &bridge_index {
            for pair in ids.windows(2) {
                self.strip(&lines[pair[0]], &lines[pair[1]]);
            }
        }
        for (c, threads) in chain_threads.iter().enumerate() {
            self.chain_sheet(c, threads, &bridges, &lines, &bridge_index);
        }
        for (cut, threads) in bridges.iter().enumerate() {
            self.body_jump(cut, &chain_threads, threads);
        }
        self.finish()
    }

    fn chain_threads(&mut self) -> Vec<Vec<usize>> {
        let columns = &self.surface.chain_columns;
        columns
            .iter()
            .map(|chain| {
                chain
                    .iter()
                    .map(|column| {
                        self.threads
                            .push(column.iter().map(|&c| (c, 1.0)).collect());
                        self.threads.len() - 1
                    })
                    .collect()
            })
            .collect()
    }

    fn junction_column(&self, path: usize) -> usize {
        let end = self.paths.paths[path].end;
        let columns = &self.surface.chain_columns[end.chain];
        let index = if end.last { columns.len() - 1 } else { 0 };
        columns[index].expect("a junction vertex is doubled")
    }

    fn junction_thread(&self, path: usize, chain_threads: &[Vec<usize>]) -> usize {
        let end = self.paths.paths[path].end;
        let threads = &chain_threads[end.chain];
        if end.last {
            threads[threads.len() - 1]
        } else {
            threads[0]
        }
    }

    /// Threads of the vertices where two body lines meet; none for a line alone.
    fn bridge_lines(&mut self, cut: usize, chain_threads: &[Vec<usize>]) -> Vec<usize> {
        let body_cut = &self.paths.cuts[cut];
        let (Some(before), Some(after)) = (body_cut.before, body_cut.after) else {
            return Vec::new();
        };
        let last = body_cut.bridge.len() - 1;
        (0..=last)
            .map(|i| {
                if last > 0 && i == 0 {
                    return self.junction_thread(before, chain_threads);
                }
                if last > 0 && i == last {
                    return self.junction_thread(after, chain_threads);
                }
                let share = if last == 0 {
                    0.5
                } else {
                    i as f64 / last as f64
                };
                let (a, b) = (self.junction_column(before), self.junction_column(after));
                self.threads.push(vec![(a, 1.0 - share), (b, share)]);
                self.threads.len() - 1
            })
            .collect()
    }

    fn bridge_line(&mut self, cut: usize, i: usize, thread: usize) -> SheetLine {
        let vertex = self.paths.cuts[cut].bridge[i];
        let tail = self.tail_distance(cut);
        let anchor = self.position(vertex) - tail * self.direction;
        let first_station = self.station_at(tail);
        let points = self.along(anchor, first_station);
        let far = self.far_line(anchor, thread);
        self.line(first_station, points, |_| thread, far)
    }

    /// Index of the station at ξ, which is one of them.
    fn station_at(&self, xi: f64) -> usize {
        self.stations
            .partition_point(|x| *x < xi - 1e-9 * self.margin)
    }

    fn far_line(&mut self, anchor: Vec3, thread: usize) -> u32 {
        self.far.anchors.push(anchor);
        self.far_threads.push(thread);
        self.far.anchors.len() as u32 - 1
    }

    fn chain_sheet(
        &mut self,
        c: usize,
        threads: &[usize],
        bridges: &[Vec<usize>],
        bridge_lines: &[SheetLine],
        bridge_index: &[Vec<usize>],
    ) {
        let chain = &self.chains[c];
        let n = chain.vertices.len();
        let mut lines = Vec::with_capacity(n);
        for (i, &thread) in threads.iter().enumerate() {
            let path = self
                .paths
                .paths
                .iter()
                .position(|p| p.end.chain == c && i == if p.end.last { n - 1 } else { 0 });
            let line = match path {
                Some(path) => {
                    self.junction_line(path, thread, bridges, bridge_lines, bridge_index)
                }
                None => self.straight_line(chain.vertices[i], thread),
            };
            lines.push(line);
        }
        for i in 0..chain.upper.len() {
            let (a, b) = (&lines[i], &lines[(i + 1) % n]);
            self.strip(a, b);
        }
    }

    fn straight_line(&mut self, vertex: u32, thread: usize) -> SheetLine {
        let anchor = self.position(vertex);
        let points = self.along(anchor, 0);
        let far = self.far_line(anchor, thread);
        self.line(0, points, |_| thread, far)
    }

    /// Points on a streamline at the stations from `first` on.
    fn along(&self, anchor: Vec3, first: usize) -> Vec<Vec3> {
        self.stations[first..]
            .iter()
            .map(|xi| anchor + *xi * self.direction)
            .collect()
    }

    fn line(
        &mut self,
        first_station: usize,
        points: Vec<Vec3>,
        thread_at: impl Fn(usize) -> usize,
        far: u32,
    ) -> SheetLine {
        let from = self.sheet_vertices.len() as u32;
        for r in first_station..self.stations.len() {
            let slot = self.slot(thread_at(r), self.stations[r]);
            self.sheet_slots.push(slot);
        }
        self.sheet_vertices.extend(points);
        let vertices = (from..self.sheet_vertices.len() as u32).collect();
        SheetLine {
            first_station,
            vertices,
            far,
        }
    }

    /// The sheet's inner edge: along the body to the tail, then straight on.
    fn junction_line(
        &mut self,
        path: usize,
        thread: usize,
        bridges: &[Vec<usize>],
        bridge_lines: &[SheetLine],
        bridge_index: &[Vec<usize>],
    ) -> SheetLine {
        let (cut, is_before) = self
            .paths
            .cuts
            .iter()
            .enumerate()
            .find_map(|(c, cut)| {
                (cut.before == Some(path))
                    .then_some((c, true))
                    .or((cut.after == Some(path)).then_some((c, false)))
            })
            .expect("every path belongs to a cut");
        let tail = self.tail_distance(cut);
        let vertices = self.paths.paths[path].vertices.clone();
        let mut knots = self.path_distances(path);
        if let Some(last) = knots.last_mut() {
            *last = tail;
        }
        let end = self.position(vertices[vertices.len() - 1]) - tail * self.direction;
        let (far_thread, far) = if bridges[cut].is_empty() {
            self.notes.push(format!(
                "the wake's inner edge from the junction at vertex {} ends alone on the body, at vertex {}: behind it the sheet has a free edge with the junction's jump",
                vertices[0],
                vertices[vertices.len() - 1]
            ));
            (thread, self.far_line(end, thread))
        } else {
            let i = if is_before { 0 } else { bridges[cut].len() - 1 };
            (bridges[cut][i], bridge_lines[bridge_index[cut][i]].far)
        };
        let tail_station = self.station_at(tail);
        let points = self
            .stations
            .iter()
            .enumerate()
            .map(|(r, xi)| {
                if r < tail_station {
                    self.on_path(&vertices, &knots, *xi)
                } else {
                    end + *xi * self.direction
                }
            })
            .collect();
        self.line(
            0,
            points,
            |r| if r < tail_station { thread } else { far_thread },
            far,
        )
    }

    fn on_path(&self, vertices: &[u32], knots: &[f64], xi: f64) -> Vec3 {
        let i = knots
            .partition_point(|k| *k <= xi)
            .clamp(1, knots.len() - 1);
        let share = (xi - knots[i - 1]) / (knots[i] - knots[i - 1]);
        let (a, b) = (self.position(vertices[i - 1]), self.position(vertices[i]));
        a + share * (b - a)
    }

    /// Triangles between two lines, and their far strip.
    fn strip(&mut self, a: &SheetLine, b: &SheetLine) {
        let from = a.first_station.max(b.first_station);
        for r in from..self.stations.len().saturating_sub(1) {
            let ids = [(a, r), (a, r + 1), (b, r + 1), (b, r)]
                .map(|(line, r)| line.vertices[r - line.first_station]);
            let p = ids.map(|i| self.sheet_vertices[i as usize]);
            let [i, j, k, l] = ids;
            if first_diagonal(&p) {
                self.sheet_triangles.extend([[i, j, k], [i, k, l]]);
            } else {
                self.sheet_triangles.extend([[i, j, l], [j, k, l]]);
            }
        }
        self.far.strips.push([a.far, b.far]);
    }

    fn slot(&mut self, thread: usize, xi: f64) -> u32 {
        if self.threads[thread].is_empty() {
            return NO_SLOT;
        }
        let slots = &mut self.slots;
        *self
            .slot_of
            .entry((thread, xi.to_bits()))
            .or_insert_with(|| {
                slots.push(Slot { thread, xi });
                slots.len() as u32 - 1
            })
    }

    /// Slots on the upper corners of the body's triangles along a cut.
    fn body_jump(&mut self, cut: usize, chain_threads: &[Vec<usize>], bridge: &[usize]) {
        let body_cut = self.paths.cuts[cut].clone();
        let tail = self.tail_distance(cut);
        let mut slot_of_vertex: HashMap<u32, u32> = HashMap::new();
        for path in [body_cut.before, body_cut.after].into_iter().flatten() {
            let thread = self.junction_thread(path, chain_threads);
            let vertices = &self.paths.paths[path].vertices;
            let xi = self.path_distances(path);
            for (v, xi) in vertices.iter().zip(xi).skip(1) {
                let slot = self.slot(thread, xi);
                slot_of_vertex.insert(*v, slot);
            }
        }
        for (v, &thread) in body_cut.bridge.iter().zip(bridge) {
            let slot = self.slot(thread, tail);
            slot_of_vertex.insert(*v, slot);
        }
        for upper in &self.surface.cut_corners[cut] {
            let Some(&slot) = slot_of_vertex.get(&upper.vertex) else {
                continue;
            };
            for &(triangle, corner) in &upper.corners {
                self.body_corners.entry(triangle).or_insert([NO_SLOT; 3])[corner] = slot;
            }
        }
    }

    fn finish(self) -> Wake {
        let start = self.stations.last().copied().unwrap_or(0.0);
        let reach = self.reach();
        let mut body: Vec<(u32, [u32; 3])> = self.body_corners.into_iter().collect();
        body.sort_unstable();
        let body_triangles: Vec<u32> = body.iter().map(|(t, _)| *t).collect();
        let body_panels: Vec<[u32; 3]> = body_triangles
            .iter()
            .map(|&t| self.mesh.triangles[t as usize])
            .collect();
        let corner_slots = self
            .sheet_triangles
            .iter()
            .map(|t| t.map(|v| self.sheet_slots[v as usize]))
            .collect();
        Wake {
            threads: self.threads,
            slots: self.slots,
            near: JumpSheet {
                panels: PanelSet::new(&self.sheet_vertices, &self.sheet_triangles),
                corner_slots,
                body_triangles: Vec::new(),
            },
            body: JumpSheet {
                panels: PanelSet::compact(&self.mesh.vertices, &body_panels),
                corner_slots: body.into_iter().map(|(_, slots)| slots).collect(),
                body_triangles,
            },
            far: self.far,
            far_threads: self.far_threads,
            paths: Paths::new(start, self.margin, reach),
            notes: self.notes,
            stations: self.stations.len(),
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

/// Whether the quadrangle is divided from its first to its third corner: along the shorter
/// diagonal, and where both are as long from the upstream corner nearer to the plane
/// y = 0, so that the sheet of a symmetric surface is symmetric.
fn first_diagonal(p: &[Vec3; 4]) -> bool {
    let (first, second) = ((p[0] - p[2]).norm(), (p[1] - p[3]).norm());
    if (first - second).abs() > SAME_LENGTH * (first + second) {
        return first < second;
    }
    p[0].y.abs() <= p[3].y.abs()
}
