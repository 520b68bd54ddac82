//! Boundary condition of each mode.
//!
//! Unknowns are carried with the body. With u the displacement, the velocity of the
//! surface against the stream is q = s u + ∂u, where
//!
//! * frame `inertial`: ∂u = (U·∇) u, in surface gradients and with the normal derivative
//!   that keeps normals normal: (U·∇)u = Σ_c (∇N_c·U) u_c + (n·U) δn,
//!   δn = −(∇_s u)ᵀ n = −Σ_c ∇N_c (u_c·n);
//! * frame `body`: ∂u = 0.
//!
//! The source strength is ∂φ/∂n = q·n = s (u·n) + ∂u·n. U has size one here; ∂u is kept
//! for each unit onset, being linear in U.

use crate::galerkin::Galerkin;
use crate::onset::OnsetBasis;
use faer::Mat;
use fladder_mesh::{Frame, SurfaceMode, Vec3};

/// Modes on the corners of the triangles.
#[derive(Clone, Debug)]
pub(crate) struct ModeFields {
    pub(crate) count: usize,
    /// u·n at corners: row 3 t + c, column mode.
    pub(crate) normal: Mat<f64>,
    /// ∂u of each triangle for each unit onset: index (onset × modes + mode) × triangles + t.
    convected: Vec<Vec3>,
    /// Displacements: index mode × vertices of the mesh.
    displacement: Vec<Vec3>,
    n_mesh: usize,
    source: Vec<u32>,
    n_triangles: usize,
    /// Columns of modes whose ∂u is not zero.
    pub(crate) inertial: Vec<usize>,
    /// Columns on which the steady pressure turns with the surface.
    pub(crate) turning: Vec<bool>,
    /// Unit onsets.
    pub(crate) basis: OnsetBasis,
}

impl ModeFields {
    /// `source` maps cut to mesh vertices; `turning` may be empty for none.
    pub(crate) fn new(
        galerkin: &Galerkin,
        source: &[u32],
        modes: &[SurfaceMode],
        turning: &[bool],
        basis: OnsetBasis,
    ) -> Self {
        let n_triangles = galerkin.n_triangles();
        let n_mesh = modes.first().map_or(0, |m| m.displacement.len());
        let mut fields = Self {
            count: modes.len(),
            normal: Mat::zeros(3 * n_triangles, modes.len()),
            convected: vec![Vec3::zeros(); basis.len() * modes.len() * n_triangles],
            displacement: modes
                .iter()
                .flat_map(|m| m.displacement.iter().copied())
                .collect(),
            n_mesh,
            source: source.to_vec(),
            n_triangles,
            inertial: Vec::new(),
            turning: (0..modes.len())
                .map(|m| turning.get(m).copied().unwrap_or(false))
                .collect(),
            basis,
        };
        let axes: Vec<Vec3> = fields.basis.axes().collect();
        for (m, mode) in modes.iter().enumerate() {
            if mode.frame == Frame::Inertial {
                fields.inertial.push(m);
            }
            for t in 0..n_triangles {
                let normal = galerkin.normals[t];
                let corners = fields.corners(galerkin, m, t);
                for (c, u) in corners.iter().enumerate() {
                    fields.normal[(3 * t + c, m)] = u.dot(&normal);
                }
                if mode.frame == Frame::Inertial {
                    for (a, axis) in axes.iter().enumerate() {
                        fields.convected[(a * modes.len() + m) * n_triangles + t] =
                            convected(&corners, &galerkin.gradients[t], normal, *axis);
                    }
                }
            }
        }
        fields
    }

    /// Displacement of mode `m` at the corners of triangle `t`.
    pub(crate) fn corners(&self, galerkin: &Galerkin, m: usize, t: usize) -> [Vec3; 3] {
        galerkin.triangles[t]
            .map(|v| self.displacement[m * self.n_mesh + self.source[v as usize] as usize])
    }

    /// ∂u of mode `m` on triangle `t` in unit onset `a`.
    pub(crate) fn convected(&self, a: usize, m: usize, t: usize) -> Vec3 {
        self.convected[(a * self.count + m) * self.n_triangles + t]
    }

    /// Change of the area vector n A of triangle `t` with mode `m`:
    /// A Σ_c [n (∇N_c·u_c) − ∇N_c (u_c·n)], exact to first order.
    pub(crate) fn turned_area(&self, galerkin: &Galerkin, m: usize, t: usize) -> Vec3 {
        let normal = galerkin.normals[t];
        let corners = self.corners(galerkin, m, t);
        let sum: Vec3 = corners
            .iter()
            .zip(&galerkin.gradients[t])
            .map(|(u, g)| normal * g.dot(u) - g * u.dot(&normal))
            .sum();
        galerkin.areas[t] * sum
    }

    /// Mean of u·n over a triangle.
    pub(crate) fn mean_normal(&self, m: usize, t: usize) -> f64 {
        (0..3).map(|c| self.normal[(3 * t + c, m)]).sum::<f64>() / 3.0
    }

    /// Source strengths of the motion at corners: [u·n of all modes, then for each unit
    /// onset ∂u·n of the inertial modes].
    pub(crate) fn sources(&self, galerkin: &Galerkin) -> Mat<f64> {
        let (m, e) = (self.count, self.inertial.len());
        Mat::from_fn(
            3 * self.n_triangles,
            m + self.basis.len() * e,
            |row, column| {
                let t = row / 3;
                if column < m {
                    return self.normal[(row, column)];
                }
                let (a, k) = ((column - m) / e, (column - m) % e);
                self.convected(a, self.inertial[k], t)
                    .dot(&galerkin.normals[t])
            },
        )
    }
}

/// Source strengths −n·e_x, −n·e_y, −n·e_z of the steady onsets at corners.
pub(crate) fn onset_sources(galerkin: &Galerkin) -> Mat<f64> {
    Mat::from_fn(3 * galerkin.n_triangles(), 3, |row, axis| {
        -galerkin.normals[row / 3][axis]
    })
}

/// (U·∇) u on one triangle.
fn convected(corners: &[Vec3; 3], gradients: &[Vec3; 3], normal: Vec3, stream: Vec3) -> Vec3 {
    let mut along = Vec3::zeros();
    let mut turned = Vec3::zeros();
    for (u, g) in corners.iter().zip(gradients) {
        along += g.dot(&stream) * u;
        turned -= g * u.dot(&normal);
    }
    along + normal.dot(&stream) * turned
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rotation field has (U·∇)u = θ × U exactly, whatever the triangle.
    #[test]
    fn a_rotation_convects_to_its_cross_product() {
        let p = [
            Vec3::new(0.1, 0.2, -0.3),
            Vec3::new(1.3, 0.1, 0.4),
            Vec3::new(0.5, 0.9, 0.2),
        ];
        let area = (p[1] - p[0]).cross(&(p[2] - p[0]));
        let normal = area.normalize();
        let gradients = std::array::from_fn(|i| {
            normal.cross(&(p[(i + 2) % 3] - p[(i + 1) % 3])) / area.norm()
        });
        let rotation = Vec3::new(0.3, -0.7, 0.2);
        let stream = Vec3::new(0.9, -0.1, 0.3).normalize();
        let corners = p.map(|x| rotation.cross(&x));
        let difference =
            convected(&corners, &gradients, normal, stream) - rotation.cross(&stream);
        assert!(difference.norm() < 1e-15, "{difference}");
    }
}
