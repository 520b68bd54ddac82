//! Lines of the sheet and the triangles between them.

use crate::stations::between;
use crate::wake::NO_SLOT;
use crate::wake_builder::Builder;
use crate::wake_sheet::{JunctionLine, WakeSheet};
use fladder_mesh::Vec3;

/// A line of the sheet: its points downstream, then a streamline of the far part.
pub(crate) struct SheetLine {
    /// Distance of each point from where the jump starts, ascending; the last is the same
    /// for all lines.
    pub(crate) xi: Vec<f64>,
    vertices: Vec<u32>,
    far: u32,
}

/// To what a strip of the sheet is counted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source {
    /// Trailing edge.
    pub(crate) edge: usize,
    /// Mesh vertex where one of its lines starts.
    pub(crate) start: u32,
}

/// Where a triangle of the sheet comes from.
#[derive(Clone, Copy, Debug)]
struct Seen {
    source: Source,
    xi: f64,
}

/// All triangles of the near sheet.
#[derive(Clone, Debug, Default)]
pub(crate) struct Layer {
    pub(crate) vertices: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    slots: Vec<u32>,
    /// What each triangle is counted to; none of a copy.
    seen: Vec<Option<Seen>>,
    longest: f64,
}

impl Layer {
    pub(crate) fn corner_slots(&self) -> Vec<[u32; 3]> {
        self.triangles
            .iter()
            .map(|t| t.map(|v| self.slots[v as usize]))
            .collect()
    }

    /// Corners, trailing edge and start of every triangle, copies left out.
    pub(crate) fn seen(&self) -> impl Iterator<Item = ([Vec3; 3], usize, u32)> + '_ {
        self.triangles
            .iter()
            .zip(&self.seen)
            .filter_map(|(triangle, seen)| {
                let source = (*seen)?.source;
                let corners = triangle.map(|v| self.vertices[v as usize]);
                Some((corners, source.edge, source.start))
            })
    }

    /// Every point of the sheet with a trailing edge it belongs to, copies left out.
    pub(crate) fn seen_points(&self) -> impl Iterator<Item = (Vec3, usize)> + '_ {
        let mut edge_of = vec![None; self.vertices.len()];
        for (triangle, seen) in self.triangles.iter().zip(&self.seen) {
            for &v in triangle {
                edge_of[v as usize] = seen.map(|s| s.source.edge).or(edge_of[v as usize]);
            }
        }
        self.vertices
            .iter()
            .zip(edge_of)
            .filter_map(|(point, edge)| Some((*point, edge?)))
    }

    /// What there is to be seen, copies left out.
    pub(crate) fn visible(
        &self,
        stations: &[f64],
        junction_lines: Vec<JunctionLine>,
        direction: Vec3,
    ) -> WakeSheet {
        let mut sheet = WakeSheet {
            vertices: self.vertices.iter().map(|&p| p.into()).collect(),
            junction_lines,
            direction: direction.into(),
            longest_row: self.longest,
            ..WakeSheet::default()
        };
        for (triangle, seen) in self.triangles.iter().zip(&self.seen) {
            if let &Some(Seen { source, xi }) = seen {
                sheet.triangles.push(*triangle);
                sheet.edge.push(source.edge as u32);
                let row = stations.partition_point(|s| *s <= xi).saturating_sub(1);
                sheet.row.push(row as u32);
            }
        }
        sheet
    }
}

impl Builder<'_> {
    /// A straight line from `start`, which lies at ξ = `xi`, with one thread.
    pub(crate) fn free_line(&mut self, start: Vec3, xi: f64, thread: usize) -> SheetLine {
        self.bent_line(&[start], &[xi], [thread; 2])
    }

    /// A line through `corners` at the distances `knots`, then straight on; the first
    /// thread up to the last corner, the second from there.
    pub(crate) fn bent_line(
        &mut self,
        corners: &[Vec3],
        knots: &[f64],
        [before, behind]: [usize; 2],
    ) -> SheetLine {
        let last = knots.len() - 1;
        let own = knots.iter().copied().zip(corners.iter().copied());
        let between = between(self.law, knots, &self.stations)
            .into_iter()
            .map(|x| {
                let i = knots.partition_point(|k| *k <= x);
                let point = if i > last {
                    corners[last] + (x - knots[last]) * self.direction
                } else {
                    let share = (x - knots[i - 1]) / (knots[i] - knots[i - 1]);
                    corners[i - 1] + share * (corners[i] - corners[i - 1])
                };
                (x, point)
            });
        let mut all: Vec<(f64, Vec3)> = own.chain(between).collect();
        // Stable: corners at one distance keep their order.
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let xi: Vec<f64> = all.iter().map(|p| p.0).collect();
        let points: Vec<(Vec3, u32)> = all
            .into_iter()
            .map(|(x, point)| {
                let thread = if x < knots[last] { before } else { behind };
                (point, self.slot(thread, x))
            })
            .collect();
        let anchor = corners[last] - knots[last] * self.direction;
        self.add_line(xi, &points, anchor, behind)
    }

    fn add_line(
        &mut self,
        xi: Vec<f64>,
        points: &[(Vec3, u32)],
        anchor: Vec3,
        thread: usize,
    ) -> SheetLine {
        let from = self.sheet.vertices.len() as u32;
        for (point, slot) in points {
            self.sheet.vertices.push(*point);
            self.sheet.slots.push(*slot);
        }
        let row = xi.windows(2).map(|pair| pair[1] - pair[0]);
        self.sheet.longest = row.fold(self.sheet.longest, f64::max);
        self.far.anchors.push(anchor);
        self.far_threads.push(thread);
        SheetLine {
            xi,
            vertices: (from..self.sheet.vertices.len() as u32).collect(),
            far: self.far.anchors.len() as u32 - 1,
        }
    }

    /// The same line for a jump that has come `shift` farther: its points from ξ = `from`
    /// on, with the jump of `thread` from ξ = `slots_from` on, to the common last ξ.
    pub(crate) fn copy(
        &mut self,
        line: &SheetLine,
        shift: f64,
        from: f64,
        slots_from: f64,
        thread: usize,
    ) -> SheetLine {
        let end = line.xi[line.xi.len() - 1];
        let first = line.xi.partition_point(|x| *x <= from).saturating_sub(1);
        let at = |i: usize| self.sheet.vertices[line.vertices[i] as usize];
        let mut points: Vec<(f64, Vec3)> = (first..line.xi.len())
            .map(|i| (line.xi[i] + shift, at(i)))
            .filter(|(x, _)| *x < end - 1e-3 * self.law.length(*x))
            .collect();
        let anchor = self.far.anchors[line.far as usize] - shift * self.direction;
        points.push((end, anchor + end * self.direction));
        let slotted: Vec<(Vec3, u32)> = points
            .iter()
            .map(|&(x, point)| {
                let slot = if x >= slots_from + shift {
                    self.slot(thread, x)
                } else {
                    NO_SLOT
                };
                (point, slot)
            })
            .collect();
        let xi = points.into_iter().map(|(x, _)| x).collect();
        self.add_line(xi, &slotted, anchor, thread)
    }

    /// Triangles between two lines, and their far strip; a copy has no source.
    pub(crate) fn strip(&mut self, [a, b]: [&SheetLine; 2], source: Option<Source>) {
        let (mut i, mut j) = (0, 0);
        loop {
            let [next_a, next_b] =
                [(a, i), (b, j)].map(|(line, k)| line.xi.get(k + 1).copied());
            let xi = a.xi[i].max(b.xi[j]);
            let new: Vec<[u32; 3]> = match (next_a, next_b) {
                (Some(x), Some(y)) if x == y => {
                    let ids = [
                        a.vertices[i],
                        a.vertices[i + 1],
                        b.vertices[j + 1],
                        b.vertices[j],
                    ];
                    i += 1;
                    j += 1;
                    self.quadrilateral(ids).to_vec()
                }
                (Some(x), y) if y.is_none_or(|y| x < y) => {
                    i += 1;
                    vec![[a.vertices[i - 1], a.vertices[i], b.vertices[j]]]
                }
                (_, Some(_)) => {
                    j += 1;
                    vec![[a.vertices[i], b.vertices[j], b.vertices[j - 1]]]
                }
                _ => break,
            };
            for triangle in new {
                self.sheet.triangles.push(triangle);
                self.sheet
                    .seen
                    .push(source.map(|source| Seen { source, xi }));
            }
        }
        self.far.strips.push([a.far, b.far]);
    }

    /// Two triangles, cut along the shorter diagonal; where both are alike, along the one
    /// from the upstream corner nearer to the plane y = 0, so that port mirrors starboard.
    fn quadrilateral(&self, [i, j, k, l]: [u32; 4]) -> [[u32; 3]; 2] {
        let p = [i, j, k, l].map(|v| self.sheet.vertices[v as usize]);
        let (first, second) = ((p[0] - p[2]).norm(), (p[1] - p[3]).norm());
        let first_is_shorter = if (first - second).abs() > 1e-9 * first {
            first < second
        } else {
            p[0].y.abs() <= p[3].y.abs()
        };
        if first_is_shorter {
            [[i, j, k], [i, k, l]]
        } else {
            [[i, j, l], [j, k, l]]
        }
    }
}
