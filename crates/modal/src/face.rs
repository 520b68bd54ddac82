//! Faces of shells and solids as curved patches `x(r, s) = Σ N_i(r, s) x_i`.
//!
//! Triangles over r, s ≥ 0, r + s ≤ 1; quadrilaterals over [−1, 1]². The
//! eight-node face uses the serendipity functions of the element itself, so
//! that a point of the element is found where the element has it. Zienkiewicz
//! & Taylor, The Finite Element Method, vol. 1, on shape functions.

use crate::element::ElementKind;
use fladder_mesh::Vec3;

/// Largest number of nodes of a face.
pub(crate) const MAX_NODES: usize = 8;

/// Shape functions and their derivatives by r and s; unused entries are zero.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Interpolation {
    pub(crate) value: [f64; MAX_NODES],
    pub(crate) by_r: [f64; MAX_NODES],
    pub(crate) by_s: [f64; MAX_NODES],
}

/// Point and tangents of a patch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchPoint {
    pub(crate) position: Vec3,
    pub(crate) tangent_r: Vec3,
    pub(crate) tangent_s: Vec3,
}

/// A face of the structure: three, four, six or eight nodes, corners first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Face {
    /// Indices of structural nodes.
    pub(crate) nodes: Vec<u32>,
    /// Index of its element.
    pub(crate) element: u32,
}

/// Facets by which a patch is searched: parameter points, and triangles between
/// them.
type Facets = (&'static [[f64; 2]], &'static [[u32; 3]]);

const TRIANGLE: Facets = (&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], &[[0, 1, 2]]);

const CURVED_TRIANGLE: Facets = (
    &[
        [0.0, 0.0],
        [1.0, 0.0],
        [0.0, 1.0],
        [0.5, 0.0],
        [0.5, 0.5],
        [0.0, 0.5],
    ],
    &[[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
);

const QUADRILATERAL: Facets = (
    &[
        [-1.0, -1.0],
        [1.0, -1.0],
        [1.0, 1.0],
        [-1.0, 1.0],
        [0.0, 0.0],
    ],
    &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
);

const CURVED_QUADRILATERAL: Facets = (
    &[
        [-1.0, -1.0],
        [1.0, -1.0],
        [1.0, 1.0],
        [-1.0, 1.0],
        [0.0, -1.0],
        [1.0, 0.0],
        [0.0, 1.0],
        [-1.0, 0.0],
        [0.0, 0.0],
    ],
    &[
        [0, 4, 8],
        [4, 1, 8],
        [1, 5, 8],
        [5, 2, 8],
        [2, 6, 8],
        [6, 3, 8],
        [3, 7, 8],
        [7, 0, 8],
    ],
);

/// Sides of the parameter triangle as `a·(r, s) ≤ b`.
const TRIANGLE_SIDES: [([f64; 2], f64); 3] =
    [([-1.0, 0.0], 0.0), ([0.0, -1.0], 0.0), ([1.0, 1.0], 1.0)];

/// Sides of the parameter square.
const SQUARE_SIDES: [([f64; 2], f64); 4] = [
    ([-1.0, 0.0], 1.0),
    ([1.0, 0.0], 1.0),
    ([0.0, -1.0], 1.0),
    ([0.0, 1.0], 1.0),
];

impl Face {
    pub(crate) fn is_triangle(&self) -> bool {
        matches!(self.nodes.len(), 3 | 6)
    }

    /// Parameters of the middle of the face.
    pub(crate) fn middle(&self) -> [f64; 2] {
        if self.is_triangle() {
            [1.0 / 3.0; 2]
        } else {
            [0.0; 2]
        }
    }

    pub(crate) fn facets(&self) -> Facets {
        match self.nodes.len() {
            3 => TRIANGLE,
            6 => CURVED_TRIANGLE,
            4 => QUADRILATERAL,
            _ => CURVED_QUADRILATERAL,
        }
    }

    pub(crate) fn sides(&self) -> &'static [([f64; 2], f64)] {
        if self.is_triangle() {
            &TRIANGLE_SIDES
        } else {
            &SQUARE_SIDES
        }
    }

    pub(crate) fn interpolation(&self, at: [f64; 2]) -> Interpolation {
        match self.nodes.len() {
            3 => linear_triangle(at),
            6 => quadratic_triangle(at),
            4 => bilinear(at),
            _ => serendipity(at),
        }
    }

    pub(crate) fn point(&self, at: [f64; 2], positions: &[Vec3]) -> PatchPoint {
        let shape = self.interpolation(at);
        let mut point = PatchPoint {
            position: Vec3::zeros(),
            tangent_r: Vec3::zeros(),
            tangent_s: Vec3::zeros(),
        };
        for (k, node) in self.nodes.iter().enumerate() {
            let x = positions[*node as usize];
            point.position += shape.value[k] * x;
            point.tangent_r += shape.by_r[k] * x;
            point.tangent_s += shape.by_s[k] * x;
        }
        point
    }

    /// Area by the facets.
    pub(crate) fn area(&self, positions: &[Vec3]) -> f64 {
        let (points, triangles) = self.facets();
        let corners: Vec<Vec3> = points
            .iter()
            .map(|at| self.point(*at, positions).position)
            .collect();
        triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|k| corners[k as usize]);
                0.5 * (b - a).cross(&(c - a)).norm()
            })
            .sum()
    }
}

fn linear_triangle([r, s]: [f64; 2]) -> Interpolation {
    let mut shape = Interpolation::default();
    shape.value[..3].copy_from_slice(&[1.0 - r - s, r, s]);
    shape.by_r[..3].copy_from_slice(&[-1.0, 1.0, 0.0]);
    shape.by_s[..3].copy_from_slice(&[-1.0, 0.0, 1.0]);
    shape
}

fn quadratic_triangle([r, s]: [f64; 2]) -> Interpolation {
    let t = 1.0 - r - s;
    let mut shape = Interpolation::default();
    let value = [
        t * (2.0 * t - 1.0),
        r * (2.0 * r - 1.0),
        s * (2.0 * s - 1.0),
        4.0 * t * r,
        4.0 * r * s,
        4.0 * s * t,
    ];
    let by_r = [
        1.0 - 4.0 * t,
        4.0 * r - 1.0,
        0.0,
        4.0 * (t - r),
        4.0 * s,
        -4.0 * s,
    ];
    let by_s = [
        1.0 - 4.0 * t,
        0.0,
        4.0 * s - 1.0,
        -4.0 * r,
        4.0 * r,
        4.0 * (t - s),
    ];
    shape.value[..6].copy_from_slice(&value);
    shape.by_r[..6].copy_from_slice(&by_r);
    shape.by_s[..6].copy_from_slice(&by_s);
    shape
}

/// Corner parameters of quadrilaterals.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

fn bilinear([r, s]: [f64; 2]) -> Interpolation {
    let mut shape = Interpolation::default();
    for (k, [a, b]) in CORNERS.into_iter().enumerate() {
        shape.value[k] = 0.25 * (1.0 + a * r) * (1.0 + b * s);
        shape.by_r[k] = 0.25 * a * (1.0 + b * s);
        shape.by_s[k] = 0.25 * b * (1.0 + a * r);
    }
    shape
}

fn serendipity([r, s]: [f64; 2]) -> Interpolation {
    let mut shape = Interpolation::default();
    for (k, [a, b]) in CORNERS.into_iter().enumerate() {
        shape.value[k] = 0.25 * (1.0 + a * r) * (1.0 + b * s) * (a * r + b * s - 1.0);
        shape.by_r[k] = 0.25 * a * (1.0 + b * s) * (2.0 * a * r + b * s);
        shape.by_s[k] = 0.25 * b * (1.0 + a * r) * (a * r + 2.0 * b * s);
    }
    for (k, b) in [(4, -1.0), (6, 1.0)] {
        shape.value[k] = 0.5 * (1.0 - r * r) * (1.0 + b * s);
        shape.by_r[k] = -r * (1.0 + b * s);
        shape.by_s[k] = 0.5 * b * (1.0 - r * r);
    }
    for (k, a) in [(5, 1.0), (7, -1.0)] {
        shape.value[k] = 0.5 * (1.0 + a * r) * (1.0 - s * s);
        shape.by_r[k] = 0.5 * a * (1.0 - s * s);
        shape.by_s[k] = -s * (1.0 + a * r);
    }
    shape
}

/// Local node numbers of the faces of a solid: corners, then midside nodes.
/// Abaqus order of nodes; which way a face looks does not matter here.
pub(crate) fn solid_faces(kind: ElementKind) -> &'static [&'static [usize]] {
    match kind {
        ElementKind::Tet4 => &[&[0, 1, 2], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]],
        ElementKind::Tet10 => &[
            &[0, 1, 2, 4, 5, 6],
            &[0, 1, 3, 4, 8, 7],
            &[1, 2, 3, 5, 9, 8],
            &[2, 0, 3, 6, 7, 9],
        ],
        ElementKind::Wedge6 => &[
            &[0, 1, 2],
            &[3, 4, 5],
            &[0, 1, 4, 3],
            &[1, 2, 5, 4],
            &[2, 0, 3, 5],
        ],
        ElementKind::Wedge15 => &[
            &[0, 1, 2, 6, 7, 8],
            &[3, 4, 5, 9, 10, 11],
            &[0, 1, 4, 3, 6, 13, 9, 12],
            &[1, 2, 5, 4, 7, 14, 10, 13],
            &[2, 0, 3, 5, 8, 12, 11, 14],
        ],
        ElementKind::Hex8 => &[
            &[0, 1, 2, 3],
            &[4, 5, 6, 7],
            &[0, 1, 5, 4],
            &[1, 2, 6, 5],
            &[2, 3, 7, 6],
            &[3, 0, 4, 7],
        ],
        ElementKind::Hex20 => &[
            &[0, 1, 2, 3, 8, 9, 10, 11],
            &[4, 5, 6, 7, 12, 13, 14, 15],
            &[0, 1, 5, 4, 8, 17, 12, 16],
            &[1, 2, 6, 5, 9, 18, 13, 17],
            &[2, 3, 7, 6, 10, 19, 14, 18],
            &[3, 0, 4, 7, 11, 16, 15, 19],
        ],
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn face(n: usize) -> Face {
        Face {
            nodes: (0..n as u32).collect(),
            element: 0,
        }
    }

    #[test]
    fn shape_functions_are_one_at_their_node_and_sum_to_one() {
        for n in [3, 4, 6, 8] {
            let face = face(n);
            for (node, at) in face.facets().0.iter().enumerate().take(n) {
                let shape = face.interpolation(*at);
                for k in 0..n {
                    let expected = f64::from(u8::from(k == node));
                    assert!(
                        (shape.value[k] - expected).abs() < 1e-15,
                        "{n} nodes, {k} at {node}"
                    );
                }
            }
            let shape = face.interpolation([0.2, 0.3]);
            let sum = |values: &[f64]| values.iter().sum::<f64>();
            assert!((sum(&shape.value) - 1.0).abs() < 1e-15);
            assert!(sum(&shape.by_r).abs() < 1e-15 && sum(&shape.by_s).abs() < 1e-15);
        }
    }

    #[test]
    fn derivatives_are_those_of_the_values() {
        let step = 1e-6;
        for n in [3, 4, 6, 8] {
            let face = face(n);
            let [r, s] = [0.21, 0.34];
            let shape = face.interpolation([r, s]);
            let difference = |dr: f64, ds: f64, k: usize| {
                let plus = face.interpolation([r + dr, s + ds]).value[k];
                let minus = face.interpolation([r - dr, s - ds]).value[k];
                (plus - minus) / (2.0 * step)
            };
            for k in 0..n {
                assert!(
                    (difference(step, 0.0, k) - shape.by_r[k]).abs() < 1e-9,
                    "{n}, {k} by r"
                );
                assert!(
                    (difference(0.0, step, k) - shape.by_s[k]).abs() < 1e-9,
                    "{n}, {k} by s"
                );
            }
        }
    }

    #[test]
    fn faces_of_solids_close_over_their_nodes() {
        use ElementKind::{Hex8, Hex20, Tet4, Tet10, Wedge6, Wedge15};
        for kind in [Tet4, Tet10, Wedge6, Wedge15, Hex8, Hex20] {
            let mut corner_edges = std::collections::BTreeMap::new();
            for face in solid_faces(kind) {
                let corners = if face.len() % 3 == 0 { 3 } else { 4 };
                for k in 0..corners {
                    let (a, b) = (face[k], face[(k + 1) % corners]);
                    let middle = face.get(corners + k).copied();
                    let entry = corner_edges.entry((a.min(b), a.max(b)));
                    entry.or_insert_with(Vec::new).push(middle);
                }
            }
            for (edge, middles) in corner_edges {
                assert_eq!(middles.len(), 2, "{kind:?} edge {edge:?}");
                assert_eq!(middles[0], middles[1], "{kind:?} edge {edge:?}");
            }
        }
    }
}
