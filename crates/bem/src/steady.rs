//! Steady flow about the loaded surface.
//!
//! φ₀ = A₀⁻¹(−S[−n·U] + T W(0) κ₀) for a unit onset along each axis; the steady velocity
//! on a triangle is V₀ = U − n (n·U) + ∇_s φ₀ and c_p0 = 1 − |V₀|². Loads are quadratic in
//! the onset, so that any incidence follows from the three unit solutions.

use crate::boundary::ModeFields;
use crate::cut::CutSurface;
use crate::galerkin::Galerkin;
use crate::image::{mirrored, on_plane};
use crate::trefftz::induced_drag;
use crate::wake::Wake;
use faer::Mat;
use fladder_mesh::{Symmetry, Vec3};
use serde::{Deserialize, Serialize};

/// Velocity on every triangle for onsets along x, y and z, and the wake jumps.
#[derive(Clone, Debug)]
pub(crate) struct UnitOnsets {
    /// Three a triangle.
    pub(crate) velocities: Vec<[Vec3; 3]>,
    /// κ₀: columns × 3.
    pub(crate) jumps: Mat<f64>,
    /// φ₀ without the jumps carried on bodies: vertices × 3.
    pub(crate) potentials: Mat<f64>,
}

impl UnitOnsets {
    /// From the potentials (vertices × 3) and jumps (columns × 3).
    pub(crate) fn new(
        galerkin: &Galerkin,
        wake: &Wake,
        potentials: Mat<f64>,
        jumps: Mat<f64>,
    ) -> Self {
        let carried = carried_jumps(galerkin, wake, &jumps);
        let velocities = (0..galerkin.n_triangles())
            .map(|t| {
                let normal = galerkin.normals[t];
                std::array::from_fn(|axis| {
                    let mut onset = Vec3::zeros();
                    onset[axis] = 1.0;
                    let mut velocity = onset - normal * normal[axis];
                    for (corner, &v) in galerkin.triangles[t].iter().enumerate() {
                        let phi = potentials[(v as usize, axis)]
                            + carried.get(&(t as u32, corner)).map_or(0.0, |k| k[axis]);
                        velocity += galerkin.gradients[t][corner] * phi;
                    }
                    velocity
                })
            })
            .collect();
        Self {
            velocities,
            jumps,
            potentials,
        }
    }

    /// V₀ on a triangle for the onset `stream`.
    pub(crate) fn velocity(&self, triangle: usize, stream: Vec3) -> Vec3 {
        let [x, y, z] = &self.velocities[triangle];
        x * stream.x + y * stream.y + z * stream.z
    }
}

/// Steady jumps on the corners of triangles along body lines.
fn carried_jumps(
    galerkin: &Galerkin,
    wake: &Wake,
    jumps: &Mat<f64>,
) -> std::collections::HashMap<(u32, usize), [f64; 3]> {
    let mut carried = std::collections::HashMap::new();
    for (triangle, corner, slot) in wake.body_corners() {
        let value = carried.entry((triangle, corner)).or_insert([0.0; 3]);
        for &(column, weight) in &wake.threads[wake.slots[slot].thread] {
            for (axis, v) in value.iter_mut().enumerate() {
                *v += weight * jumps[(column, axis)];
            }
        }
    }
    debug_assert!(
        carried
            .keys()
            .all(|(t, _)| (*t as usize) < galerkin.n_triangles())
    );
    carried
}

/// The wake jump along one trailing edge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpanwiseJump {
    /// Positions of the trailing-edge vertices, m.
    pub positions: Vec<[f64; 3]>,
    /// φ_upper − φ_lower at unit speed, m; zero at free tips.
    pub jumps: Vec<f64>,
    /// Whether the first and the last vertex lie on a body.
    pub on_body: [bool; 2],
}

/// Steady loads, per q∞: forces in m², moments in m³ about the reference point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Loads {
    /// −∮ c_p n dS, mesh axes.
    pub force: [f64; 3],
    /// −∮ c_p (x − x₀) × n dS.
    pub moment: [f64; 3],
}

/// The steady flow at the given incidence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SteadyState {
    /// Unit vector of the stream.
    pub stream: [f64; 3],
    /// Wake jump along every trailing edge.
    pub wake_jumps: Vec<SpanwiseJump>,
    /// Forces and moments.
    pub loads: Loads,
    /// −∮ c_p0 n·φ_i dS of every mode, m² for unit-metre modes.
    pub generalised_forces: Vec<f64>,
    /// The same as quadratic forms of the onset's components: entry [mode][a][b].
    pub generalised_forms: Vec<[[f64; 3]; 3]>,
    /// Lift per q∞ from the jump far downstream, 2 ∫ κ₀ dy over the whole sheet (Kutta
    /// and Joukowski), m²: beside the pressure's it shows how well the mesh resolves
    /// the flow.
    pub lift_by_wake_jump: f64,
    /// Induced drag per q∞ from the energy the wake leaves far downstream, m²; none where
    /// the sheet has a free edge with a jump.
    pub induced_drag: Option<f64>,
    /// Lift per q∞ from the pressure, perpendicular to the stream, m².
    pub lift_by_pressure: f64,
    /// Lowest pressure coefficient and the triangle it is on.
    pub lowest_pressure: (f64, usize),
    /// Pressure coefficient of every triangle.
    pub pressures: Vec<f32>,
    /// Force (m²) and moment (m³) as quadratic forms of the onset's components:
    /// entry [axis][a][b].
    pub force_form: OnsetForm,
    /// As `force_form`.
    pub moment_form: OnsetForm,
}

impl SteadyState {
    /// Loads for another onset (unit vector), with the wake left where it is; for half
    /// models within the plane of symmetry.
    pub fn loads_at(&self, stream: [f64; 3]) -> Loads {
        let evaluate =
            |form: &OnsetForm| std::array::from_fn(|axis| quadratic(&form[axis], stream));
        Loads {
            force: evaluate(&self.force_form),
            moment: evaluate(&self.moment_form),
        }
    }

    /// Generalised forces for another onset, as [`Self::loads_at`].
    pub fn generalised_forces_at(&self, stream: [f64; 3]) -> Vec<f64> {
        self.generalised_forms
            .iter()
            .map(|form| quadratic(form, stream))
            .collect()
    }
}

/// Σ form_ab U_a U_b.
fn quadratic(form: &[[f64; 3]; 3], stream: [f64; 3]) -> f64 {
    form.iter()
        .zip(stream)
        .map(|(row, u)| u * row.iter().zip(stream).map(|(v, w)| v * w).sum::<f64>())
        .sum()
}

/// A load along each axis as a quadratic form of the onset: [axis][a][b].
pub type OnsetForm = [[[f64; 3]; 3]; 3];

/// Gathers everything the user may want to know of the steady flow.
pub(crate) struct SteadyReport<'a> {
    pub(crate) galerkin: &'a Galerkin,
    pub(crate) surface: &'a CutSurface,
    pub(crate) wake: &'a Wake,
    pub(crate) onsets: &'a UnitOnsets,
    pub(crate) fields: &'a ModeFields,
    pub(crate) stream: Vec3,
    pub(crate) moment_point: Vec3,
    /// What the motion does under reflection.
    pub(crate) symmetry: Symmetry,
}

impl SteadyReport<'_> {
    pub(crate) fn build(&self, chains: &[fladder_mesh::TrailingEdge]) -> SteadyState {
        let (force_form, moment_form) = self.forms();
        let generalised_forms = self.generalised_forms();
        let wake_jumps: Vec<SpanwiseJump> = (0..chains.len())
            .map(|c| self.spanwise(c, &chains[c]))
            .collect();
        let lift_direction = self.lift_direction();
        let mut state = SteadyState {
            stream: self.stream.into(),
            lift_by_wake_jump: self.wake_lift(),
            induced_drag: self.induced_drag(),
            wake_jumps,
            loads: Loads {
                force: [0.0; 3],
                moment: [0.0; 3],
            },
            generalised_forces: Vec::new(),
            generalised_forms,
            lift_by_pressure: 0.0,
            lowest_pressure: self.lowest_pressure(),
            pressures: (0..self.galerkin.n_triangles())
                .map(|t| self.pressure(t) as f32)
                .collect(),
            force_form,
            moment_form,
        };
        state.loads = state.loads_at(self.stream.into());
        state.generalised_forces = state.generalised_forces_at(self.stream.into());
        state.lift_by_pressure = Vec3::from(state.loads.force).dot(&lift_direction);
        state
    }

    fn lift_direction(&self) -> Vec3 {
        let up = Vec3::z() - self.stream * self.stream.z;
        up.normalize()
    }

    /// −∮ c_p n dS with c_p = |U|² − |V|², as forms of U.
    fn forms(&self) -> (OnsetForm, OnsetForm) {
        let mut force = [[[0.0; 3]; 3]; 3];
        let mut moment = [[[0.0; 3]; 3]; 3];
        for t in 0..self.galerkin.n_triangles() {
            let area_vector = self.galerkin.normals[t] * self.galerkin.areas[t];
            let centroid = self.galerkin.triangles[t]
                .iter()
                .map(|&v| self.surface.vertices[v as usize])
                .sum::<Vec3>()
                / 3.0;
            let arm = (centroid - self.moment_point).cross(&area_vector);
            let v = &self.onsets.velocities[t];
            for a in 0..3 {
                for b in 0..3 {
                    let pressure = if a == b { 1.0 } else { 0.0 } - v[a].dot(&v[b]);
                    for axis in 0..3 {
                        force[axis][a][b] -= pressure * area_vector[axis];
                        moment[axis][a][b] -= pressure * arm[axis];
                    }
                }
            }
        }
        if self.symmetry != Symmetry::None {
            // The other half doubles x, z and the moment about y and cancels the rest.
            for axis in 0..3 {
                let (f, m) = if axis == 1 { (0.0, 2.0) } else { (2.0, 0.0) };
                for (force, moment) in force[axis]
                    .as_flattened_mut()
                    .iter_mut()
                    .zip(moment[axis].as_flattened_mut())
                {
                    *force *= f;
                    *moment *= m;
                }
            }
        }
        (force, moment)
    }

    /// −∮ c_p0 n·φ_i dS as forms of U; the steady flow of a half model does no work on
    /// antisymmetric modes.
    fn generalised_forms(&self) -> Vec<[[f64; 3]; 3]> {
        let factor = match self.symmetry {
            Symmetry::None => 1.0,
            Symmetry::Symmetric => 2.0,
            Symmetry::Antisymmetric => 0.0,
        };
        let mut forms = vec![[[0.0; 3]; 3]; self.fields.count];
        for (i, form) in forms.iter_mut().enumerate() {
            for t in 0..self.galerkin.n_triangles() {
                let work = factor * self.fields.mean_normal(i, t) * self.galerkin.areas[t];
                let v = &self.onsets.velocities[t];
                for a in 0..3 {
                    for b in 0..3 {
                        let pressure = if a == b { 1.0 } else { 0.0 } - v[a].dot(&v[b]);
                        form[a][b] -= pressure * work;
                    }
                }
            }
        }
        forms
    }

    fn spanwise(&self, c: usize, chain: &fladder_mesh::TrailingEdge) -> SpanwiseJump {
        let jumps = self.surface.chain_jumps[c]
            .iter()
            .map(|jump| jump.iter().map(|&(j, w)| w * self.column_jump(j)).sum())
            .collect();
        let positions = chain
            .vertices
            .iter()
            .map(|&v| self.surface.vertices[v as usize].into())
            .collect();
        SpanwiseJump {
            positions,
            jumps,
            on_body: self.surface.on_body[c],
        }
    }

    /// Kutta–Joukowski: force per q∞ = 2 ∫ κ U × dl over the far sheet, along lift.
    fn wake_lift(&self) -> f64 {
        let lift = self.lift_direction();
        let far = &self.wake.far;
        let jump = |line: u32| self.far_jump(line);
        let sum: f64 = far
            .strips
            .iter()
            .map(|&[a, b]| {
                let step = far.anchors[b as usize] - far.anchors[a as usize];
                (jump(a) + jump(b)) * self.stream.cross(&step).dot(&lift)
            })
            .sum();
        if self.symmetry == Symmetry::None {
            sum
        } else {
            2.0 * sum
        }
    }

    /// Of the whole far sheet; a half model's image goes on from the lines on the plane.
    fn induced_drag(&self) -> Option<f64> {
        let mut far = self.wake.far.clone();
        let mut source: Vec<u32> = (0..far.anchors.len() as u32).collect();
        if self.symmetry != Symmetry::None {
            let image: Vec<u32> = source
                .clone()
                .into_iter()
                .map(|line| {
                    let anchor = far.anchors[line as usize];
                    if on_plane(&anchor) {
                        return line;
                    }
                    far.anchors.push(mirrored(&anchor));
                    source.push(line);
                    source.len() as u32 - 1
                })
                .collect();
            for [a, b] in self.wake.far.strips.iter().copied() {
                far.strips.push([image[b as usize], image[a as usize]]);
            }
        }
        induced_drag(&far, |line| self.far_jump(source[line as usize]))
    }

    /// κ₀ of a streamline of the far sheet.
    fn far_jump(&self, line: u32) -> f64 {
        self.wake.threads[self.wake.far_threads[line as usize]]
            .iter()
            .map(|&(column, weight)| weight * self.column_jump(column))
            .sum()
    }

    fn column_jump(&self, column: usize) -> f64 {
        (0..3)
            .map(|axis| self.onsets.jumps[(column, axis)] * self.stream[axis])
            .sum()
    }

    /// $c_p = 1 - |V|^2$ of a triangle.
    fn pressure(&self, triangle: usize) -> f64 {
        1.0 - self.onsets.velocity(triangle, self.stream).norm_squared()
    }

    fn lowest_pressure(&self) -> (f64, usize) {
        (0..self.galerkin.n_triangles())
            .map(|t| (self.pressure(t), t))
            .fold(
                (f64::INFINITY, 0),
                |low, here| if here.0 < low.0 { here } else { low },
            )
    }
}
