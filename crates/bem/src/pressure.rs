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
//! Columns of elastic modes have in C0 also the turning of the steady pressure with the
//! surface, −½ ∮ c_p0 δ(n dS)·u_i: the force on a material element changes with its area
//! vector. Rigid motion has no such term, force components being along axes that turn with
//! the body. V₀ and ∂u are linear in the stream, so that P0 and C1 are kept for every unit
//! onset and C0 for every pair.
//!
//! V₀, not U, multiplies the gradient: with U the moment of a body in a stream (Munk) is
//! 7–46 % off and does not converge.

use crate::boundary::ModeFields;
use crate::galerkin::Galerkin;
use crate::shape_change::{ShapeChange, metric_change};
use crate::steady::UnitOnsets;
use crate::wake::Wake;
use faer::Mat;
use fladder_mesh::Vec3;

/// ∫ N_c N_d dS / A on a triangle: (1 + δ_cd)/12.
fn overlap(c: usize, d: usize) -> f64 {
    if c == d { 1.0 / 6.0 } else { 1.0 / 12.0 }
}

/// The functionals, row a vertex and column a mode (P) or modes × modes (C); what depends
/// on the stream is there for each unit onset a, or for each pair at a · onsets + b.
#[derive(Clone, Debug)]
pub(crate) struct Functionals {
    pub(crate) p0: Vec<Mat<f64>>,
    pub(crate) p1: Mat<f64>,
    pub(crate) c0: Vec<Mat<f64>>,
    pub(crate) c1: Vec<Mat<f64>>,
    /// Parts of P0 (onset by onset) and P1 of the jump carried on bodies.
    pub(crate) carried: Vec<Carried>,
}

/// What one corner with a carried jump adds.
#[derive(Clone, Debug)]
pub(crate) struct Carried {
    pub(crate) slot: usize,
    /// Index onset × modes + mode.
    pub(crate) p0: Vec<f64>,
    pub(crate) p1: Vec<f64>,
}

impl Functionals {
    pub(crate) fn new(
        galerkin: &Galerkin,
        fields: &ModeFields,
        onsets: &UnitOnsets,
        wake: &Wake,
        shape: ShapeChange,
    ) -> Self {
        let (m, onset_count) = (fields.count, fields.basis.len());
        let square = |count: usize| vec![Mat::zeros(m, m); count];
        let mut functionals = Self {
            p0: vec![Mat::zeros(galerkin.n_vertices, m); onset_count],
            p1: Mat::zeros(galerkin.n_vertices, m),
            c0: square(onset_count * onset_count),
            c1: square(onset_count),
            carried: Vec::new(),
        };
        let axes: Vec<Vec3> = fields.basis.axes().collect();
        for t in 0..galerkin.n_triangles() {
            let here = Triangle {
                galerkin,
                fields,
                axes: &axes,
                velocities: axes.iter().map(|axis| onsets.velocity(t, *axis)).collect(),
                t,
                shape,
            };
            here.add_potential(&mut functionals);
            here.add_motion(&mut functionals);
            here.add_turning(&mut functionals);
        }
        for (triangle, corner, slot) in wake.body_corners() {
            let t = triangle as usize;
            let p0 = axes
                .iter()
                .flat_map(|axis| {
                    let velocity = onsets.velocity(t, *axis);
                    (0..m).map(move |i| slope(galerkin, fields, velocity, t, corner, i))
                })
                .collect();
            let p1 = (0..m)
                .map(|i| level(galerkin, fields, t, corner, i))
                .collect();
            functionals.carried.push(Carried { slot, p0, p1 });
        }
        functionals
    }
}

/// One triangle's share.
struct Triangle<'a> {
    galerkin: &'a Galerkin,
    fields: &'a ModeFields,
    axes: &'a [Vec3],
    /// V₀ of each unit onset.
    velocities: Vec<Vec3>,
    t: usize,
    shape: ShapeChange,
}

impl Triangle<'_> {
    /// P0 and P1.
    fn add_potential(&self, out: &mut Functionals) {
        for i in 0..self.fields.count {
            for (c, &v) in self.galerkin.triangles[self.t].iter().enumerate() {
                for (p0, velocity) in out.p0.iter_mut().zip(&self.velocities) {
                    p0[(v as usize, i)] +=
                        slope(self.galerkin, self.fields, *velocity, self.t, c, i);
                }
                out.p1[(v as usize, i)] += level(self.galerkin, self.fields, self.t, c, i);
            }
        }
    }

    /// C1 and C0.
    fn add_motion(&self, out: &mut Functionals) {
        let (fields, t, onset_count) = (self.fields, self.t, self.axes.len());
        let area = self.galerkin.areas[t];
        for k in 0..fields.count {
            let corners = fields.corners(self.galerkin, k, t);
            for (a, (axis, velocity)) in self.axes.iter().zip(&self.velocities).enumerate() {
                let slip = axis - velocity;
                let along = corners.map(|u| slip.dot(&u));
                for i in 0..fields.count {
                    let mut sum = 0.0;
                    for c in 0..3 {
                        let normal = fields.normal[(3 * t + c, i)];
                        for (d, value) in along.iter().enumerate() {
                            sum += normal * overlap(c, d) * value;
                        }
                    }
                    out.c1[a][(i, k)] += area * sum;
                }
                for b in 0..onset_count {
                    let convected = self.convection(k, a, b);
                    for i in 0..fields.count {
                        out.c0[a * onset_count + b][(i, k)] +=
                            area * fields.mean_normal(i, t) * convected;
                    }
                }
            }
        }
    }

    /// (U − V₀)·∂u for the onsets a of V₀ and b of U, or its exact form.
    fn convection(&self, mode: usize, a: usize, b: usize) -> f64 {
        let (fields, t) = (self.fields, self.t);
        if self.shape == ShapeChange::Exact && fields.turning[mode] {
            let velocities = (self.velocities[a], self.velocities[b]);
            let onset = self.axes[b];
            return metric_change(self.galerkin, fields, mode, t, velocities, onset);
        }
        let slip = self.axes[a] - self.velocities[a];
        slip.dot(&fields.convected(b, mode, t))
    }

    /// The steady pressure on the turned and stretched surface, −½ c_p0 δ(n dS)·u_i.
    fn add_turning(&self, out: &mut Functionals) {
        let (fields, t) = (self.fields, self.t);
        for k in (0..fields.count).filter(|&k| fields.turning[k]) {
            let change = fields.turned_area(self.galerkin, k, t);
            for i in 0..fields.count {
                let mean = fields.corners(self.galerkin, i, t).iter().sum::<Vec3>() / 3.0;
                let work = -0.5 * change.dot(&mean);
                for (pair, c0) in out.c0.iter_mut().enumerate() {
                    let (a, b) = (pair / self.axes.len(), pair % self.axes.len());
                    let pressure = self.axes[a].dot(&self.axes[b])
                        - self.velocities[a].dot(&self.velocities[b]);
                    c0[(i, k)] += pressure * work;
                }
            }
        }
    }
}

/// A corner's share of P0: A (V₀·∇N) mean(u_i·n).
fn slope(
    galerkin: &Galerkin,
    fields: &ModeFields,
    velocity: Vec3,
    t: usize,
    corner: usize,
    mode: usize,
) -> f64 {
    let slope = galerkin.gradients[t][corner].dot(&velocity);
    galerkin.areas[t] * slope * fields.mean_normal(mode, t)
}

/// A corner's share of P1: ∫ N (u_i·n).
fn level(
    galerkin: &Galerkin,
    fields: &ModeFields,
    t: usize,
    corner: usize,
    mode: usize,
) -> f64 {
    let sum: f64 = (0..3)
        .map(|d| overlap(corner, d) * fields.normal[(3 * t + d, mode)])
        .sum();
    galerkin.areas[t] * sum
}
