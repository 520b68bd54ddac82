//! Areas and their moments, integrated over curved elements.
//!
//! $$ A = \int \left|\partial_r x \times \partial_s x\right| \mathrm dr\,\mathrm ds $$
//!
//! by the elements' own quadratic shape functions: three by three points of Gauss on eight
//! nodes, seven points on six.

use std::ops::{AddAssign, Mul};

use fladder_mesh::Vec3;
use nalgebra::Matrix3;

use super::mesh::ShellMesh;

/// An amount with its first and second moments about the origin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Weight {
    pub(super) amount: f64,
    pub(super) moment: Vec3,
    pub(super) second: Matrix3<f64>,
}

impl Weight {
    /// A unit at a point.
    pub(super) fn point(place: &Vec3) -> Self {
        Self {
            amount: 1.0,
            moment: *place,
            second: place * place.transpose(),
        }
    }
}

impl AddAssign for Weight {
    fn add_assign(&mut self, other: Self) {
        self.amount += other.amount;
        self.moment += other.moment;
        self.second += other.second;
    }
}

impl Mul<f64> for Weight {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self {
            amount: self.amount * factor,
            moment: self.moment * factor,
            second: self.second * factor,
        }
    }
}

/// Area of elements that are so thick, in m: thickness t spreads the area along the normal n
/// and adds $t^2/12\,n n^T$ to its second moment.
pub(super) fn weight(mesh: &ShellMesh, cells: &[usize], thickness: f64) -> Weight {
    let mut sum = Weight::default();
    for cell in cells {
        let nodes: Vec<Vec3> = mesh.cells[cell - 1]
            .iter()
            .map(|node| mesh.nodes[node - 1])
            .collect();
        let eight_nodes = nodes.len() == 8;
        let points = if eight_nodes { square() } else { triangle() };
        let shape: Shape = if eight_nodes { eight } else { six };
        for [r, s, factor] in points {
            let mut sums = [Vec3::zeros(); 3];
            for (node, values) in nodes.iter().zip(shape(r, s)) {
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += node * value;
                }
            }
            let [place, along, across] = sums;
            let normal = along.cross(&across);
            let mut part = Weight::point(&place);
            part.second += normal
                * normal.transpose()
                * (thickness * thickness / 12.0 / normal.norm_squared());
            sum += part * (factor * normal.norm());
        }
    }
    sum
}

/// Shape functions and derivatives of every node at a point.
type Shape = fn(f64, f64) -> Vec<[f64; 3]>;

/// Points of Gauss on the square −1 … 1 with their weights.
fn square() -> Vec<[f64; 3]> {
    let line = [
        (-0.6_f64.sqrt(), 5.0 / 9.0),
        (0.0, 8.0 / 9.0),
        (0.6_f64.sqrt(), 5.0 / 9.0),
    ];
    line.iter()
        .flat_map(|(r, a)| line.map(|(s, b)| [*r, s, a * b]))
        .collect()
}

/// Points of degree five on the triangle 0 … 1.
fn triangle() -> Vec<[f64; 3]> {
    let root = 15.0_f64.sqrt();
    let mut points = vec![[1.0 / 3.0, 1.0 / 3.0, 9.0 / 80.0]];
    for sign in [1.0, -1.0] {
        let a = (6.0 + sign * root) / 21.0;
        let factor = (155.0 + sign * root) / 2400.0;
        for [r, s] in [[a, a], [a, 1.0 - 2.0 * a], [1.0 - 2.0 * a, a]] {
            points.push([r, s, factor]);
        }
    }
    points
}

/// Shape functions of eight nodes and their derivatives.
fn eight(r: f64, s: f64) -> Vec<[f64; 3]> {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let middles = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]];
    let corner = |[a, b]: [f64; 2]| {
        let (u, v) = (1.0 + a * r, 1.0 + b * s);
        let w = a * r + b * s - 1.0;
        [
            0.25 * u * v * w,
            0.25 * a * v * (w + u),
            0.25 * b * u * (w + v),
        ]
    };
    let middle = |[a, b]: [f64; 2]| {
        if a == 0.0 {
            let (u, v) = (1.0 - r * r, 1.0 + b * s);
            [0.5 * u * v, -r * v, 0.5 * b * u]
        } else {
            let (u, v) = (1.0 + a * r, 1.0 - s * s);
            [0.5 * u * v, 0.5 * a * v, -s * u]
        }
    };
    corners
        .map(corner)
        .into_iter()
        .chain(middles.map(middle))
        .collect()
}

/// Of six nodes.
fn six(r: f64, s: f64) -> Vec<[f64; 3]> {
    let t = 1.0 - r - s;
    vec![
        [t * (2.0 * t - 1.0), 1.0 - 4.0 * t, 1.0 - 4.0 * t],
        [r * (2.0 * r - 1.0), 4.0 * r - 1.0, 0.0],
        [s * (2.0 * s - 1.0), 0.0, 4.0 * s - 1.0],
        [4.0 * t * r, 4.0 * (t - r), -4.0 * r],
        [4.0 * r * s, 4.0 * s, 4.0 * r],
        [4.0 * s * t, -4.0 * s, 4.0 * (t - s)],
    ]
}
