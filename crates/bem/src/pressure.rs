//! Pressure functionals: generalised forces of a potential.
//!
//! With unknowns carried with the body, ρ = U = 1,
//! $$ -p = s\varphi + \mathbf V_0\cdot(\nabla_s\varphi - \mathbf q) + \mathbf U\cdot\mathbf q $$
//! and Q_ij = 2 ∮ (−p_j) n·u_i dS. In powers of s, with q = s u + ∂u,
//!
//! Q = 2 { [P0 + s P1]ᵀ φ + s C1 + C0 },
//!
//! | functional | integral |
//! |---|---|
//! | P0 | ∮ (V₀·∇N) (u_i·n) dS, u_i·n by its mean on the triangle |
//! | P1 | ∮ N (u_i·n) dS |
//! | C1 | ∮ ((U − V₀)·u_k)(u_i·n) dS |
//! | C0 | ∮ ((U − V₀)·∂u_k)(u_i·n) dS |
//!
//! V₀, not U, multiplies the gradient: with U the moment of a body in a stream (Munk) is
//! 7–46 % off and does not converge.

use crate::boundary::ModeFields;
use crate::galerkin::Galerkin;
use crate::steady::UnitOnsets;
use crate::wake::Wake;
use faer::Mat;
use fladder_mesh::Vec3;

/// ∫ N_c N_d dS / A on a triangle: (1 + δ_cd)/12.
fn overlap(c: usize, d: usize) -> f64 {
    if c == d { 1.0 / 6.0 } else { 1.0 / 12.0 }
}

/// The functionals, row a vertex and column a mode (P) or modes × modes (C).
#[derive(Clone, Debug)]
pub(crate) struct Functionals {
    pub(crate) p0: Mat<f64>,
    pub(crate) p1: Mat<f64>,
    pub(crate) c0: Mat<f64>,
    pub(crate) c1: Mat<f64>,
    /// Parts of P0 and P1 of the jump carried on bodies: (slot, P0 row, P1 row).
    pub(crate) carried: Vec<(usize, Vec<f64>, Vec<f64>)>,
    /// −∮ c_p0 n·u_i dS.
    pub(crate) steady: Vec<f64>,
}

impl Functionals {
    pub(crate) fn new(
        galerkin: &Galerkin,
        fields: &ModeFields,
        onsets: &UnitOnsets,
        wake: &Wake,
        stream: Vec3,
    ) -> Self {
        let m = fields.count;
        let mut functionals = Self {
            p0: Mat::zeros(galerkin.n_vertices, m),
            p1: Mat::zeros(galerkin.n_vertices, m),
            c0: Mat::zeros(m, m),
            c1: Mat::zeros(m, m),
            carried: Vec::new(),
            steady: vec![0.0; m],
        };
        for t in 0..galerkin.n_triangles() {
            functionals.add_triangle(galerkin, fields, onsets, stream, t);
        }
        for (triangle, corner, slot) in wake.body_corners() {
            let velocity = onsets.velocity(triangle as usize, stream);
            let corner = CornerOf {
                galerkin,
                fields,
                velocity,
                t: triangle as usize,
                corner,
            };
            let rows = (0..m).map(|i| (corner.p0(i), corner.p1(i))).unzip();
            functionals.carried.push((slot, rows.0, rows.1));
        }
        functionals
    }

    fn add_triangle(
        &mut self,
        galerkin: &Galerkin,
        fields: &ModeFields,
        onsets: &UnitOnsets,
        stream: Vec3,
        t: usize,
    ) {
        let velocity = onsets.velocity(t, stream);
        let area = galerkin.areas[t];
        let pressure = 1.0 - velocity.norm_squared();
        let slip = stream - velocity;
        for i in 0..fields.count {
            let mean = fields.mean_normal(i, t);
            self.steady[i] -= pressure * mean * area;
            for (c, &v) in galerkin.triangles[t].iter().enumerate() {
                let corner = CornerOf {
                    galerkin,
                    fields,
                    velocity,
                    t,
                    corner: c,
                };
                self.p0[(v as usize, i)] += corner.p0(i);
                self.p1[(v as usize, i)] += corner.p1(i);
            }
        }
        for k in 0..fields.count {
            let along = fields.corners(galerkin, k, t).map(|u| slip.dot(&u));
            let convected = slip.dot(&fields.convected(k, t));
            for i in 0..fields.count {
                let mut sum = 0.0;
                for c in 0..3 {
                    let normal = fields.normal[(3 * t + c, i)];
                    for (d, value) in along.iter().enumerate() {
                        sum += normal * overlap(c, d) * value;
                    }
                }
                self.c1[(i, k)] += area * sum;
                self.c0[(i, k)] += area * fields.mean_normal(i, t) * convected;
            }
        }
    }
}

/// One corner's share of P0 and P1.
struct CornerOf<'a> {
    galerkin: &'a Galerkin,
    fields: &'a ModeFields,
    velocity: Vec3,
    t: usize,
    corner: usize,
}

impl CornerOf<'_> {
    fn p0(&self, mode: usize) -> f64 {
        let slope = self.galerkin.gradients[self.t][self.corner].dot(&self.velocity);
        self.galerkin.areas[self.t] * slope * self.fields.mean_normal(mode, self.t)
    }

    fn p1(&self, mode: usize) -> f64 {
        let sum: f64 = (0..3)
            .map(|d| overlap(self.corner, d) * self.fields.normal[(3 * self.t + d, mode)])
            .sum();
        self.galerkin.areas[self.t] * sum
    }
}
