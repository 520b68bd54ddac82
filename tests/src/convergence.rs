//! Refinement of the ScanEagle-like surface: derivatives and the largest entries of Q on
//! meshes of one generator, with the extrapolated value.
//!
//! With h ~ N^{−1/2} for N vertices and three meshes, f = f₀ + C h^p is solved for p and f₀
//! (Richardson) where the two differences have one sign and p lies in a sensible range;
//! otherwise, and with two meshes, p = 1 is taken.

use std::path::Path;

use faer::c64;
use fladder_bem::Solution;
use serde::{Deserialize, Serialize};

use crate::aircraft::Aircraft;
use crate::case::Fault;

/// Reduced frequency at which entries of Q are compared.
const REDUCED_FREQUENCY: f64 = 0.2;

/// How many of the largest entries.
const ENTRIES: usize = 20;

/// Elastic modes of the case.
const ELASTIC: usize = 20;

/// Orders that are taken from three meshes.
const ORDERS: std::ops::RangeInclusive<f64> = 0.5..=3.0;

/// What one mesh gives; small enough to be kept and joined with others later.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeshFigures {
    /// Name of the mesh.
    pub name: String,
    /// Vertices.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// C_Lα, C_mα, C_lβ, C_nβ, per rad.
    pub derivatives: [f64; 4],
    /// Names of the modes.
    pub modes: Vec<String>,
    /// Q at the reduced frequency by rows, real and imaginary parts.
    pub q: Vec<Vec<[f64; 2]>>,
}

/// Names of the derivatives, in order.
const DERIVATIVES: [&str; 4] = ["C_Lα", "C_mα", "C_lβ", "C_nβ"];

impl MeshFigures {
    /// Computes them on a mesh file.
    ///
    /// # Errors
    /// Files that cannot be read, what the solver refuses.
    pub fn compute(mesh: &Path) -> Result<Self, Fault> {
        let mut aircraft = Aircraft::read(mesh, ELASTIC)?;
        aircraft
            .modes
            .retain(|mode| mode.name.starts_with("rigid") || mode.name.starts_with("elastic"));
        let solution = aircraft.solve()?;
        let q = solution.transfer.q(c64::new(0.0, REDUCED_FREQUENCY))?;
        let rows = (0..q.nrows())
            .map(|i| {
                (0..q.ncols())
                    .map(|j| [q[(i, j)].re, q[(i, j)].im])
                    .collect()
            })
            .collect();
        Ok(Self {
            name: mesh
                .file_name()
                .map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
            vertices: aircraft.mesh.vertices.len(),
            triangles: aircraft.mesh.triangles.len(),
            derivatives: derivatives(&aircraft, &solution),
            modes: aircraft
                .modes
                .iter()
                .map(|mode| mode.name.clone())
                .collect(),
            q: rows,
        })
    }

    /// Reads figures that were kept.
    ///
    /// # Errors
    /// [`Fault::Figures`].
    pub fn read(path: &Path) -> Result<Self, Fault> {
        let text = std::fs::read_to_string(path).map_err(|e| unreadable(path, &e))?;
        serde_json::from_str(&text).map_err(|e| unreadable(path, &e))
    }

    /// Keeps the figures.
    ///
    /// # Errors
    /// [`Fault::Figures`].
    pub fn write(&self, path: &Path) -> Result<(), Fault> {
        let text = serde_json::to_string(self).map_err(|e| unreadable(path, &e))?;
        std::fs::write(path, text + "\n").map_err(|e| unreadable(path, &e))
    }

    fn entry(&self, i: usize, j: usize) -> c64 {
        c64::new(self.q[i][j][0], self.q[i][j][1])
    }
}

fn unreadable(path: &Path, error: &dyn std::fmt::Display) -> Fault {
    Fault::Figures {
        path: path.display().to_string(),
        what: error.to_string(),
    }
}

/// C_Lα, C_mα, C_lβ, C_nβ at the incidence of the case; roll and yaw about axes forward and
/// down, reference span = area / mean chord.
fn derivatives(aircraft: &Aircraft, solution: &Solution) -> [f64; 4] {
    let reference = &aircraft.case.reference;
    let chord = 2.0 * reference.semichord;
    let area = reference.area.unwrap_or(1.0);
    let span = area / chord;
    let alpha = aircraft.case.flow.alpha_deg.to_radians();
    let step = 1e-4;
    let at = |alpha: f64, beta: f64| {
        let flow = fladder_bem::Flow { alpha, beta };
        let loads = solution.steady.loads_at(flow.stream().into());
        let [x, _, z] = loads.force;
        let lift = z * alpha.cos() - x * alpha.sin();
        let [roll, pitch, yaw] = loads.moment;
        [
            lift / area,
            pitch / (area * chord),
            -roll / (area * span),
            -yaw / (area * span),
        ]
    };
    let slope =
        |ahead: [f64; 4], behind: [f64; 4], i: usize| (ahead[i] - behind[i]) / (2.0 * step);
    let by_alpha = (at(alpha + step, 0.0), at(alpha - step, 0.0));
    let by_beta = (at(alpha, step), at(alpha, -step));
    [
        slope(by_alpha.0, by_alpha.1, 0),
        slope(by_alpha.0, by_alpha.1, 1),
        slope(by_beta.0, by_beta.1, 2),
        slope(by_beta.0, by_beta.1, 3),
    ]
}

/// One quantity over the meshes, coarsest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Its name.
    pub name: String,
    /// Its size on each mesh: the value of a derivative, |Q_ij| of an entry.
    pub values: Vec<f64>,
    /// Extrapolated size.
    pub limit: f64,
    /// Order it was extrapolated with.
    pub order: f64,
    /// Distance of each mesh's value from the extrapolated one, by its size.
    pub errors: Vec<f64>,
}

/// A table over meshes.
#[derive(Clone, Debug, PartialEq)]
pub struct Refinement {
    /// The meshes, coarsest first.
    pub meshes: Vec<(String, usize)>,
    /// Derivatives, then the largest entries of Q.
    pub quantities: Vec<Quantity>,
}

impl Refinement {
    /// From figures of two meshes at least.
    ///
    /// # Errors
    /// Fewer than two meshes, or meshes with other modes.
    pub fn new(mut figures: Vec<MeshFigures>) -> Result<Self, Fault> {
        figures.sort_by_key(|f| f.vertices);
        let Some(finest) = figures.last().filter(|_| figures.len() > 1) else {
            return Err(Fault::Surface("refinement needs two meshes or more".into()));
        };
        if let Some(other) = figures.iter().find(|f| f.modes != finest.modes) {
            return Err(Fault::Surface(format!(
                "{} and {} have other modes",
                other.name, finest.name
            )));
        }
        let sizes: Vec<f64> = figures
            .iter()
            .map(|f| (f.vertices as f64).powf(-0.5))
            .collect();
        let mut quantities: Vec<Quantity> = DERIVATIVES
            .iter()
            .enumerate()
            .map(|(i, name)| {
                let values = figures.iter().map(|f| c64::new(f.derivatives[i], 0.0));
                quantity(name, &sizes, &values.collect::<Vec<_>>(), true)
            })
            .collect();
        for (i, j) in largest(finest) {
            let name = format!("Q, {} by {}", finest.modes[i], finest.modes[j]);
            let values: Vec<c64> = figures.iter().map(|f| f.entry(i, j)).collect();
            quantities.push(quantity(&name, &sizes, &values, false));
        }
        Ok(Self {
            meshes: figures
                .iter()
                .map(|f| (f.name.clone(), f.triangles))
                .collect(),
            quantities,
        })
    }

    /// Largest error of any quantity on a mesh.
    pub fn worst(&self, mesh: usize) -> f64 {
        self.quantities
            .iter()
            .map(|q| q.errors[mesh])
            .fold(0.0, f64::max)
    }
}

/// Places of the largest entries.
fn largest(figures: &MeshFigures) -> Vec<(usize, usize)> {
    let n = figures.q.len();
    let mut places: Vec<(usize, usize)> = (0..n * n).map(|e| (e / n, e % n)).collect();
    let size = |&(i, j): &(usize, usize)| figures.entry(i, j).norm();
    places.sort_by(|a, b| size(b).total_cmp(&size(a)));
    places.truncate(ENTRIES);
    places
}

/// Extrapolates a complex value along the line through its values.
fn quantity(name: &str, sizes: &[f64], values: &[c64], is_real: bool) -> Quantity {
    let n = values.len();
    let order = if n > 2 {
        observed_order(&sizes[n - 3..], &values[n - 3..])
    } else {
        1.0
    };
    let ratio = (sizes[n - 2] / sizes[n - 1]).powf(order);
    let limit = values[n - 1] + (values[n - 1] - values[n - 2]) / (ratio - 1.0);
    let shown = |z: &c64| if is_real { z.re } else { z.norm() };
    Quantity {
        name: name.to_owned(),
        values: values.iter().map(shown).collect(),
        limit: shown(&limit),
        order,
        errors: values
            .iter()
            .map(|z| (z - limit).norm() / limit.norm())
            .collect(),
    }
}

/// p with (f₁ − f₂)/(f₂ − f₃) = (h₁^p − h₂^p)/(h₂^p − h₃^p), or 1 where there is none.
fn observed_order(sizes: &[f64], values: &[c64]) -> f64 {
    let (first, second) = (values[0] - values[1], values[1] - values[2]);
    // The part of the first step along the second, so that complex values do as real ones.
    let ratio = (first * second.conj()).re / second.norm_sqr();
    let steps = |p: f64| {
        let [a, b, c] = [sizes[0], sizes[1], sizes[2]].map(|h| h.powf(p));
        (a - b) / (b - c)
    };
    let (mut low, mut high) = (*ORDERS.start(), *ORDERS.end());
    if !(steps(low)..=steps(high)).contains(&ratio) {
        return 1.0;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if steps(middle) < ratio {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values with a known limit and order give both back.
    #[test]
    fn richardson_finds_limit_and_order() {
        let sizes = [0.1, 0.06, 0.03];
        let limit = c64::new(2.0, -1.0);
        let values = sizes.map(|h: f64| limit + c64::new(0.4, 0.3) * h.powf(1.4));
        let found = quantity("f", &sizes, &values, false);
        assert!((found.order - 1.4).abs() < 1e-9);
        assert!((found.limit - limit.norm()).abs() < 1e-12);
        let opposite = [1.0, 2.0, 1.5].map(|x| c64::new(x, 0.0));
        assert_eq!(quantity("f", &sizes, &opposite, true).order, 1.0);
    }
}
