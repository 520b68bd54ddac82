//! The whole surface: starboard half in structured blocks, then its mirror image.
//!
//! A ring of points goes round every section, from the trailing edge below to the leading
//! edge and back above; the first ring lies on the fuselage. The fuselage has one block above
//! and one below the line nose – root section – tail. Quadrilaterals are cut along the
//! diagonal with the larger least angle. Points of the plane of symmetry are shared.

use fladder_mesh::{CurveGroup, SurfaceGroup, TriMesh, Vec3};
use libm::{atan2, sqrt};

use super::body::{Body, root};
use super::params::{Parameters, Size};
use super::plane::Plane;
use super::spacing::{Ring, sections};
use super::wing::Wing;

/// Groups of the starboard half by number; port ones end in `l`.
const GROUPS: [&str; 5] = ["wing", "elevon", "winglet", "rudder", "fuselage"];
const FUSELAGE: usize = 4;

/// Points nearer to the plane of symmetry lie in it, m.
const IN_PLANE: f64 = 1e-9;

/// What cannot be made of the dimensions.
#[derive(Debug, thiserror::Error)]
pub(crate) enum SurfaceError {
    #[error(
        "the wing does not pierce the fuselage at {0} of the chord: lower fuselage.radius or move the wing"
    )]
    Apart(f64),
    #[error("the mesh would have {0} vertices, more than can be numbered")]
    TooLarge(usize),
}

/// Corners in order round a face of one half; a triangle has no fourth.
type Face = ([usize; 3], Option<usize>, usize);

struct Half {
    points: Vec<Vec3>,
    faces: Vec<Face>,
    trailing_edge: Vec<usize>,
    body_wake: Vec<usize>,
}

/// The surface of the aircraft.
pub(crate) fn surface(parameters: &Parameters, size: Size) -> Result<TriMesh, SurfaceError> {
    let half = half(parameters, size)?;
    let count = 2 * half.points.len();
    if u32::try_from(count).is_err() {
        return Err(SurfaceError::TooLarge(count));
    }
    Ok(mirrored(&half))
}

fn half(parameters: &Parameters, size: Size) -> Result<Half, SurfaceError> {
    let (wing, body) = (Wing::new(parameters), Body::new(&parameters.fuselage));
    let ring = Ring::new(size.chord, parameters.controls.hinge);
    let rings = rings(parameters, &wing, &body, &ring, size)?;
    let round = ring.len();
    let mut half = Half {
        points: Vec::new(),
        faces: Vec::new(),
        trailing_edge: (0..rings.len()).map(|j| j * round).collect(),
        body_wake: Vec::new(),
    };
    for stations in &rings {
        for (k, s) in stations.iter().enumerate() {
            half.points
                .push(wing.point(ring.place[k], ring.side[k], *s));
        }
    }
    for j in 0..rings.len() - 1 {
        for k in 0..round {
            let next = (k + 1) % round;
            let group = group_of(parameters, &wing, &ring, [k, next], &rings[j..=j + 1]);
            let corner = |ring: usize, place: usize| ring * round + place;
            half.quad(
                [
                    corner(j, k),
                    corner(j + 1, k),
                    corner(j + 1, next),
                    corner(j, next),
                ],
                group,
            );
        }
    }
    half.close_tip((rings.len() - 1) * round, size.chord);
    half.add_fuselage(&body, size);
    Ok(half)
}

/// Arc length of every point of every ring.
fn rings(
    parameters: &Parameters,
    wing: &Wing<'_>,
    body: &Body,
    ring: &Ring,
    size: Size,
) -> Result<Vec<Vec<f64>>, SurfaceError> {
    let blend_to = parameters.junction.blend_to;
    let outside = |place: f64, side: f64, s: f64| {
        let point = wing.point(place, side, s);
        libm::hypot(point.y, point.z) - body.radius(point.x)
    };
    let mut first = Vec::new();
    for (place, side) in ring.place.iter().zip(&ring.side) {
        let (near, far) = (1e-4, blend_to.min(0.2));
        if outside(*place, *side, near) >= 0.0 || outside(*place, *side, far) <= 0.0 {
            return Err(SurfaceError::Apart(*place));
        }
        first.push(root(near, far, |s| outside(*place, *side, s)));
    }
    let mut rings: Vec<Vec<f64>> = (0..=size.root)
        .map(|i| {
            let t = i as f64 / size.root as f64;
            let part = 0.75 * t + 0.25 * t * t;
            first.iter().map(|s| s + (blend_to - s) * part).collect()
        })
        .collect();
    let outer = sections(parameters, wing, size.step);
    rings.extend(outer[1..].iter().map(|s| vec![*s; ring.len()]));
    Ok(rings)
}

/// Group of a cell of the wing: strips at the ends of a control belong to it.
fn group_of(
    parameters: &Parameters,
    wing: &Wing<'_>,
    ring: &Ring,
    places: [usize; 2],
    rings: &[Vec<f64>],
) -> usize {
    let place = 0.5 * (ring.place[places[0]] + ring.place[places[1]]);
    let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
    let s = 0.5 * (mean(&rings[0]) + mean(&rings[1]));
    // Halfway between the edge of the strip and its middle: whatever is beside it is outside.
    let reach = 0.25 * parameters.controls.gap;
    let within = |[low, high]: [f64; 2]| low - reach < s && s < high + reach;
    if place > parameters.controls.hinge {
        if within(parameters.controls.elevon) {
            return 1;
        }
        if within(wing.rudder()) {
            return 3;
        }
    }
    if s < wing.marks[0] { 0 } else { 2 }
}

impl Half {
    fn quad(&mut self, [a, b, c, d]: [usize; 4], group: usize) {
        self.faces.push(([a, b, c], Some(d), group));
    }

    fn triangle(&mut self, corners: [usize; 3], group: usize) {
        self.faces.push((corners, None, group));
    }

    /// The last section is closed between its lower and its upper side.
    fn close_tip(&mut self, first: usize, cells: usize) {
        let round = 2 * cells;
        let at = |k: usize| first + k % round;
        for k in 0..cells {
            let [a, b, c, d] = [at(k), at(k + 1), at(round - k - 1), at(round - k)];
            if a == d {
                self.triangle([a, c, b], 2);
            } else if b == c {
                self.triangle([a, d, b], 2);
            } else {
                self.quad([a, d, c, b], 2);
            }
        }
    }

    fn add_fuselage(&mut self, body: &Body, size: Size) {
        let round = 2 * size.chord;
        let root: Vec<[f64; 2]> = self.points[..round]
            .iter()
            .map(|point| [body.conformal(point.x), atan2(point.z, point.y)])
            .collect();
        let (leading, trailing) = (root[size.chord], root[0]);
        let [nose, tail] = body.caps().map(|x| body.conformal(x));
        let first = 0.05 * 12.0 / size.around as f64;
        let fore: Vec<[f64; 2]> = progression(leading[0] - nose, size.nose, 0.8 * first)
            .iter()
            .rev()
            .map(|distance| [leading[0] - distance, leading[1]])
            .collect();
        let aft: Vec<[f64; 2]> = progression(tail - trailing[0], size.tail, first)
            .iter()
            .map(|distance| [trailing[0] + distance, trailing[1]])
            .collect();
        let mut line: Vec<usize> = Vec::new();
        let mut blocks = Vec::new();
        for side in [1.0, -1.0] {
            let places: Vec<usize> = if side > 0.0 {
                (size.chord..=round).map(|k| k % round).collect()
            } else {
                (0..=size.chord).rev().collect()
            };
            let inner = places[1..size.chord].iter().map(|k| root[*k]);
            let lower: Vec<[f64; 2]> = fore
                .iter()
                .copied()
                .chain(inner)
                .chain(aft.iter().copied())
                .collect();
            let plane = block(&lower, side, size.around);
            let mut numbers = vec![vec![0; plane.columns]; plane.rows];
            if line.is_empty() {
                line = self.body_line(body, &lower, &places, size);
            }
            for (row, numbers) in numbers.iter_mut().enumerate() {
                let on_wing = row.checked_sub(size.nose).and_then(|at| places.get(at));
                numbers[0] = on_wing.copied().unwrap_or(line[row]);
            }
            for (row, numbers) in numbers.iter_mut().enumerate() {
                for (column, number) in numbers.iter_mut().enumerate().skip(1) {
                    let [m, angle] = plane.at(row, column);
                    *number = self.points.len();
                    self.points.push(body.point(body.station(m), angle));
                }
            }
            for i in 0..plane.rows - 1 {
                for j in 0..plane.columns - 1 {
                    let mut corners = [
                        numbers[i][j],
                        numbers[i + 1][j],
                        numbers[i + 1][j + 1],
                        numbers[i][j + 1],
                    ];
                    if side < 0.0 {
                        corners.reverse();
                    }
                    self.quad(corners, FUSELAGE);
                }
            }
            blocks.push((side, numbers));
        }
        let [nose, tail] = [0.0, body.length()].map(|x| {
            self.points.push(Vec3::new(x, 0.0, 0.0));
            self.points.len() - 1
        });
        for (side, numbers) in &blocks {
            for (tip, row, turn) in [(nose, 0, *side), (tail, numbers.len() - 1, -side)] {
                for pair in numbers[row].windows(2) {
                    let [a, b] = if turn > 0.0 {
                        [pair[0], pair[1]]
                    } else {
                        [pair[1], pair[0]]
                    };
                    self.triangle([tip, a, b], FUSELAGE);
                }
            }
        }
        let behind = size.nose + size.chord;
        self.body_wake = vec![0];
        self.body_wake.extend(&line[behind + 1..]);
        self.body_wake.push(tail);
    }

    /// Points of the line before and behind the wing; on the wing there are some already.
    fn body_line(
        &mut self,
        body: &Body,
        lower: &[[f64; 2]],
        places: &[usize],
        size: Size,
    ) -> Vec<usize> {
        (0..lower.len())
            .map(|row| {
                let on_wing = row.checked_sub(size.nose).and_then(|at| places.get(at));
                on_wing.copied().unwrap_or_else(|| {
                    let [m, angle] = lower[row];
                    self.points.push(body.point(body.station(m), angle));
                    self.points.len() - 1
                })
            })
            .collect()
    }
}

/// The grid of one side of the fuselage, from the line to the plane of symmetry.
fn block(lower: &[[f64; 2]], side: f64, around: usize) -> Plane {
    let mut upper: Vec<f64> = lower.iter().map(|point| point[0]).collect();
    for _ in 0..400 {
        let before = upper.clone();
        for (i, window) in before.windows(3).enumerate() {
            upper[i + 1] = 0.25 * window[0] + 0.5 * window[1] + 0.25 * window[2];
        }
    }
    let edge = side * std::f64::consts::FRAC_PI_2;
    let upper: Vec<[f64; 2]> = upper.into_iter().map(|m| [m, edge]).collect();
    let parts: Vec<f64> = (0..=around)
        .map(|j| j as f64 / around as f64)
        .map(|part| 0.85 * part + 0.15 * part * part)
        .collect();
    let mut plane = Plane::between(lower, &upper, &parts);
    plane.smooth();
    plane
}

/// Distances of cells in geometric progression, the first of about the given length.
fn progression(length: f64, cells: usize, first: f64) -> Vec<f64> {
    let sums = |ratio: f64| -> Vec<f64> {
        let mut out = vec![0.0];
        let mut cell = first;
        for _ in 0..cells {
            out.push(out[out.len() - 1] + cell);
            cell *= ratio;
        }
        out
    };
    let ratio = root(0.3, 3.0, |ratio| sums(ratio)[cells] - length);
    let out = sums(ratio);
    out.iter()
        .map(|distance| distance * length / out[cells])
        .collect()
}

/// Both halves; the second has its corners in the other order.
fn mirrored(half: &Half) -> TriMesh {
    let mut vertices = half.points.clone();
    let mut image = Vec::with_capacity(vertices.len());
    for (number, point) in half.points.iter().enumerate() {
        if point.y.abs() < IN_PLANE {
            vertices[number].y = 0.0;
            image.push(number);
        } else {
            image.push(vertices.len());
            vertices.push(Vec3::new(point.x, -point.y, point.z));
        }
    }
    let (mut own, mut groups) = (Vec::new(), Vec::new());
    for (corners, fourth, group) in &half.faces {
        for triangle in cut(&vertices, *corners, *fourth) {
            own.push(triangle);
            groups.push(*group);
        }
    }
    let number = |corners: [usize; 3]| corners.map(|corner| corner as u32);
    let outward = own.iter().map(|[a, b, c]| number([*c, *b, *a]));
    let other = own
        .iter()
        .map(|corners| number(corners.map(|corner| image[corner])));
    let triangles: Vec<[u32; 3]> = outward.chain(other).collect();
    let surfaces = ["r", "l"]
        .into_iter()
        .enumerate()
        .flat_map(|(side, letter)| {
            let offset = side * own.len();
            let groups = &groups;
            GROUPS
                .iter()
                .enumerate()
                .map(move |(group, name)| SurfaceGroup {
                    name: format!("{name}_{letter}"),
                    triangles: (0..groups.len())
                        .filter(|triangle| groups[*triangle] == group)
                        .map(|triangle| (triangle + offset) as u32)
                        .collect(),
                })
        })
        .collect();
    let chain = |name: &str, line: &[usize], is_port: bool| CurveGroup {
        name: name.to_owned(),
        edges: line
            .windows(2)
            .map(|pair| {
                [pair[0], pair[1]].map(|end| if is_port { image[end] } else { end } as u32)
            })
            .collect(),
    };
    TriMesh {
        curves: vec![
            chain("te_r", &half.trailing_edge, false),
            chain("te_l", &half.trailing_edge, true),
            chain("bodywake_r", &half.body_wake, false),
            chain("bodywake_l", &half.body_wake, true),
        ],
        vertices,
        triangles,
        surfaces,
    }
}

/// A quadrilateral along the diagonal with the larger least angle.
fn cut(points: &[Vec3], [a, b, c]: [usize; 3], fourth: Option<usize>) -> Vec<[usize; 3]> {
    let Some(d) = fourth else {
        return vec![[a, b, c]];
    };
    let least = |pair: [[usize; 3]; 2]| {
        pair.iter()
            .map(|corners| least_angle(corners.map(|corner| points[corner])))
            .fold(f64::INFINITY, f64::min)
    };
    let (one, other) = ([[a, b, c], [a, c, d]], [[a, b, d], [b, c, d]]);
    if least(one) >= least(other) {
        one
    } else {
        other
    }
    .to_vec()
}

fn least_angle([a, b, c]: [Vec3; 3]) -> f64 {
    let angle = |at: Vec3, one: Vec3, other: Vec3| {
        let (u, v) = (one - at, other - at);
        atan2(sqrt(u.cross(&v).norm_squared()), u.dot(&v))
    };
    angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b))
}
