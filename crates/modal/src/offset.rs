//! Displacement of a point that stands off a face.
//!
//! The point is carried by the nearest point x of the face and by the rotation
//! ω of the face there,
//!
//! $$ \mathbf u(\mathbf p) = \sum_i N_i \mathbf u_i
//! \;{+}\; \boldsymbol\omega \times (\mathbf p - \mathbf x), \qquad
//!    \boldsymbol\omega = \sum_i \left[ -(\mathbf n \times \mathbf g_i)\,\mathbf n^T
//!    + \tfrac12\,\mathbf n\,(\mathbf n \times \mathbf g_i)^T \right] \mathbf u_i, $$
//!
//! `g_i = ∂N_i/∂r g¹ + ∂N_i/∂s g²` the surface gradient of N_i with the
//! reciprocal tangents, n the normal. The first part of ω turns the normal with
//! the surface, `δn = −g_i (n·u_i)`, the second is half the surface curl about
//! the normal. For `u = t + ω₀ × r` it gives ω = ω₀, so that rigid motion is
//! exact for any face, parameters and offset.

use crate::face::Face;
use fladder_mesh::Vec3;
use nalgebra::Matrix3;

/// The blocks that give the displacement of `point` from the face's nodes.
pub(crate) fn blocks(
    face: &Face,
    at: [f64; 2],
    point: &Vec3,
    positions: &[Vec3],
) -> Vec<(u32, Matrix3<f64>)> {
    let shape = face.interpolation(at);
    let patch = face.point(at, positions);
    let (t, u) = (patch.tangent_r, patch.tangent_s);
    let across = t.cross(&u);
    let jacobian = across.norm();
    let normal = across / jacobian;
    let (dual_r, dual_s) = (u.cross(&normal) / jacobian, normal.cross(&t) / jacobian);
    let offset = (point - patch.position).cross_matrix();
    face.nodes
        .iter()
        .enumerate()
        .map(|(k, node)| {
            let gradient = shape.by_r[k] * dual_r + shape.by_s[k] * dual_s;
            (
                *node,
                Matrix3::identity() * shape.value[k] - offset * turning(&normal, &gradient),
            )
        })
        .collect()
}

/// The part of ω that the displacement of one node makes.
pub(crate) fn turning(normal: &Vec3, gradient: &Vec3) -> Matrix3<f64> {
    let turned = normal.cross(gradient);
    0.5 * normal * turned.transpose() - turned * normal.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A warped eight-node face, a point far off it, parameters outside it.
    #[test]
    fn rigid_motion_is_exact_for_any_face_parameters_and_offset() {
        let positions: Vec<Vec3> = [
            [0.0, 0.0, 0.0],
            [1.0, 0.1, 0.2],
            [1.2, 0.9, -0.1],
            [-0.1, 1.0, 0.1],
            [0.5, -0.05, 0.2],
            [1.15, 0.5, 0.0],
            [0.5, 1.0, 0.1],
            [0.0, 0.5, 0.15],
        ]
        .into_iter()
        .map(Vec3::from)
        .collect();
        let (turn, shift) = (Vec3::new(0.3, -0.7, 1.1), Vec3::new(5.0, -2.0, 0.4));
        let rigid = |p: &Vec3| shift + turn.cross(p);
        for count in [3, 4, 6, 8] {
            let face = Face {
                nodes: (0..count).collect(),
                element: 0,
            };
            for at in [[0.2, 0.3], [-0.4, 0.9], [1.3, -0.2]] {
                let point = Vec3::new(0.4, 0.7, 1.5);
                let mut got = Vec3::zeros();
                for (node, block) in blocks(&face, at, &point, &positions) {
                    got += block * rigid(&positions[node as usize]);
                }
                assert!((got - rigid(&point)).norm() < 1e-13, "{count} nodes: {got}");
            }
        }
    }
}
