//! The ScanEagle-like surface: symmetry, junction, smoothness of Q.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use faer::{Mat, c64};
use fladder::case::{Case, CaseFile};
use fladder_bem::{Flow, Solution};
use fladder_mesh::{Frame, SurfaceMode, TriMesh, Vec3, read};
use fladder_modal::{StructureSettings, load, transfer};

use crate::case::{Fault, Setup, mode};
use crate::row::{Row, mesh_size};
use crate::smooth::worst_prediction;

/// A point of the oscillation axis at which matrices are compared.
const POINT: c64 = c64::new(0.0, 0.2);

/// Entries of Q below this part of the largest are rounding.
const ROUNDING: f64 = 1e-9;

/// Part of a mode's kind in its name.
const PROJECTED: &str = "projected ";

/// A mesh of the surface with modes on it.
#[derive(Clone, Debug)]
pub struct Aircraft {
    /// The case in `cases/scaneagle`.
    pub case: Case,
    /// Its surface, on any mesh.
    pub mesh: TriMesh,
    /// Rigid, analytic, elastic, and elastic modes made exactly symmetric.
    pub modes: Vec<SurfaceMode>,
    /// Image of every vertex in the plane of symmetry.
    image: Vec<usize>,
    /// Largest distance of a vertex from the image of its partner, m.
    mirror_error: f64,
}

/// Root of the workspace.
pub fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

impl Aircraft {
    /// The surface in a mesh file, with the first elastic modes of the case.
    ///
    /// # Errors
    /// Mesh, case or modes that cannot be read; a surface without a plane of symmetry.
    pub fn read(mesh: &Path, elastic: usize) -> Result<Self, Fault> {
        let folder = workspace().join("cases/scaneagle");
        let file = CaseFile::read(&folder, &[])
            .map_err(|failure| Fault::Surface(failure.to_string()))?;
        let structure = file
            .case
            .structure
            .clone()
            .ok_or_else(|| Fault::Surface("the case has no structure".into()))?;
        let mesh = read::read_mesh(mesh, 1.0)?;
        let model = load(&StructureSettings {
            file: file.resolve(structure.file.as_deref().unwrap_or(Path::new(""))),
            geometry: structure.geometry.as_deref().map(|path| file.resolve(path)),
            modes: Some([1, elastic]),
            ..StructureSettings::default()
        })?;
        let mut body = model
            .rigid_body
            .ok_or_else(|| Fault::Surface("the modes hold no rigid body".into()))?;
        // The finite-element model's centre of mass lies 1e-8 m beside the plane.
        body.cg.y = 0.0;
        let mut modes = fladder_modal::rigid_modes(&body, &mesh.vertices);
        modes.extend(analytic_modes(&mesh));
        let components = structure.components.unwrap_or_default();
        let (shapes, _) = transfer(&model, &mesh, &components)?;
        let (image, mirror_error) = images(&mesh)?;
        modes.extend(shapes.iter().cloned());
        for shape in &shapes {
            modes.push(projected(shape, &image));
        }
        Ok(Self {
            case: file.case,
            mesh,
            modes,
            image,
            mirror_error,
        })
    }

    /// The solution at the incidence of the case.
    ///
    /// # Errors
    /// What the solver refuses.
    pub fn solve(&self) -> Result<Solution, Fault> {
        let flow = &self.case.flow;
        let setup = Setup {
            flow: Flow {
                alpha: flow.alpha_deg.to_radians(),
                beta: flow.beta_deg.to_radians(),
            },
            semichord: self.case.reference.semichord,
            body_lines: Some("bodywake"),
            moment_point: Vec3::from(self.case.reference.moment_point),
            ..Setup::new(&self.mesh, &self.modes)
        };
        setup.solve()
    }

    /// Whether a mode is symmetric, and what part of it is not of its kind: of its
    /// displacements, or of what it turns the triangles by, which Q sees as well. Turning
    /// is a difference of near displacements, so that the digits of a file show more there.
    fn parity(&self, mode: &SurfaceMode) -> (bool, f64) {
        let parts = [1.0, -1.0].map(|sign| split(mode, &self.image, sign));
        let [even, odd] = parts.each_ref().map(|part| squares(part));
        let [even_turn, odd_turn] = parts.each_ref().map(|part| turning(&self.mesh, part));
        let other = |even: f64, odd: f64| (even.min(odd) / (even + odd)).sqrt();
        (
            even >= odd,
            other(even, odd).max(other(even_turn, odd_turn)),
        )
    }

    /// Numbers of the modes whose name passes.
    fn those(&self, keep: impl Fn(&str) -> bool) -> Vec<usize> {
        let names = self.modes.iter().map(|mode| mode.name.as_str());
        (0..)
            .zip(names)
            .filter(|(_, name)| keep(name))
            .map(|(i, _)| i)
            .collect()
    }

    /// Largest entry of Q between symmetric and antisymmetric modes of a set, by the
    /// largest of the set; and the largest asymmetry of a shape.
    fn coupling(&self, q: &Mat<c64>, modes: &[usize]) -> (f64, f64) {
        let parities: Vec<(bool, f64)> =
            modes.iter().map(|&m| self.parity(&self.modes[m])).collect();
        let (mut across, mut largest) = (0.0_f64, 0.0_f64);
        for (a, &i) in parities.iter().zip(modes) {
            for (b, &j) in parities.iter().zip(modes) {
                let size = q[(i, j)].norm();
                largest = largest.max(size);
                if a.0 != b.0 {
                    across = across.max(size);
                }
            }
        }
        let asymmetry = parities.iter().map(|p| p.1).fold(0.0, f64::max);
        (across / largest, asymmetry)
    }

    /// Symmetric and antisymmetric modes do not see each other.
    ///
    /// # Errors
    /// A point the transfer model refuses.
    pub fn symmetry(&self, solution: &Solution) -> Result<Vec<Row>, Fault> {
        let q = solution.transfer.q(POINT)?;
        let row = |case: &str, figure: String, error: f64, goal: f64| Row {
            case: format!("ScanEagle-like: {case}"),
            mesh: mesh_size(&self.mesh),
            figure,
            error,
            goal,
        };
        let exact =
            self.those(|name| !name.starts_with("elastic") && !name.starts_with(PROJECTED));
        let shapes = self.those(|name| name.starts_with("elastic"));
        let projected = self.those(|name| name.starts_with(PROJECTED));
        let (rigid, _) = self.coupling(&q, &exact);
        let (elastic, asymmetry) = self.coupling(&q, &shapes);
        let (even, _) = self.coupling(&q, &projected);
        let by = "largest \\|Q_ij\\| across by max \\|Q\\|";
        Ok(vec![
            row(
                "mesh its own mirror image",
                "largest distance, m".into(),
                self.mirror_error,
                1e-12,
            ),
            row("rigid and analytic modes decouple", by.into(), rigid, 1e-9),
            row(
                "finite-element modes decouple",
                format!("{by}; goal twice the asymmetry of the shapes, {asymmetry:.1e}"),
                elastic,
                2.0 * asymmetry,
            ),
            row("the same shapes made symmetric", by.into(), even, 1e-9),
        ])
    }

    /// Every entry of Q over the grid of the case against the other samples.
    ///
    /// # Errors
    /// A point the transfer model refuses.
    pub fn smoothness(&self, solution: &Solution) -> Result<Vec<Row>, Fault> {
        let k = self.grid();
        let keep = self.those(|name| !name.starts_with(PROJECTED));
        let mut samples = Vec::new();
        for &k in &k {
            let q = solution.transfer.q(c64::new(0.0, k))?;
            samples.push(Mat::from_fn(keep.len(), keep.len(), |i, j| {
                q[(keep[i], keep[j])]
            }));
        }
        let (error, [i, j], at) = worst_prediction(&k, &samples, ROUNDING);
        let name = |m: usize| &self.modes[keep[m]].name;
        Ok(vec![Row {
            case: format!("ScanEagle-like: every entry of Q smooth over {} k", k.len()),
            mesh: mesh_size(&self.mesh),
            figure: format!(
                "left-out sample against the others by max \\|Q_ij\\|, worst {}, {} at k = {at:.3}",
                name(i),
                name(j)
            ),
            error,
            goal: 1e-3,
        }])
    }

    /// Reduced frequencies of the case.
    fn grid(&self) -> Vec<f64> {
        self.case.gaf.k.clone()
    }

    /// The wake's jump goes on through the junction, its step there below `goal` of it (one
    /// cell of the mesh); lift by pressure and by the wake.
    pub fn junction(&self, solution: &Solution, goal: f64) -> Vec<Row> {
        let steady = &solution.steady;
        let mut rows = Vec::new();
        for jump in &steady.wake_jumps {
            for (end, is_on_body) in jump.on_body.into_iter().enumerate() {
                if !is_on_body {
                    continue;
                }
                let mut jumps = jump.jumps.clone();
                if end == 1 {
                    jumps.reverse();
                }
                let side = if jump.positions.iter().map(|p| p[1]).sum::<f64>() > 0.0 {
                    "starboard"
                } else {
                    "port"
                };
                rows.push(Row {
                    case: format!("ScanEagle-like: wake jump through the {side} junction"),
                    mesh: mesh_size(&self.mesh),
                    figure: format!(
                        "step of κ from body to wing by κ; κ = {:.4}, {:.4}, {:.4} m",
                        jumps[0], jumps[1], jumps[2]
                    ),
                    // The load is nearly flat at the root, so that the next steps are no
                    // measure.
                    error: ((jumps[1] - jumps[0]) / jumps[1]).abs(),
                    goal,
                });
            }
        }
        rows.push(Row {
            case: "ScanEagle-like: Kutta and Joukowski".into(),
            mesh: mesh_size(&self.mesh),
            figure: "lift by pressure against wake jump".into(),
            error: (steady.lift_by_pressure / steady.lift_by_wake_jump - 1.0).abs(),
            goal: 0.01,
        });
        rows
    }
}

/// Wing bending and torsion by formula, symmetric and antisymmetric.
fn analytic_modes(mesh: &TriMesh) -> Vec<SurfaceMode> {
    let side = |y: f64| if y == 0.0 { 0.0 } else { y.signum() };
    let bend = |x: &Vec3| x.y * x.y * Vec3::z();
    let twist = |x: &Vec3| x.y.abs() * Vec3::new(x.z, 0.0, -x.x);
    vec![
        mode(mesh, "bending, symmetric", Frame::Inertial, bend),
        mode(mesh, "bending, antisymmetric", Frame::Inertial, move |x| {
            side(x.y) * bend(x)
        }),
        mode(mesh, "torsion, symmetric", Frame::Inertial, twist),
        mode(mesh, "torsion, antisymmetric", Frame::Inertial, move |x| {
            side(x.y) * twist(x)
        }),
    ]
}

/// Vertex at the mirror image of each, and how far it is from there at most.
fn images(mesh: &TriMesh) -> Result<(Vec<usize>, f64), Fault> {
    let length = mesh.bounds().map_or(1.0, |(low, high)| (high - low).norm());
    let cell = 1e-7 * length;
    let key = |x: &Vec3| [x.x, x.y, x.z].map(|v| (v / cell).round() as i64);
    let mut places: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    for (v, x) in mesh.vertices.iter().enumerate() {
        places.entry(key(x)).or_default().push(v);
    }
    let mut image = Vec::with_capacity(mesh.vertices.len());
    let mut worst = 0.0_f64;
    for x in &mesh.vertices {
        let target = Vec3::new(x.x, -x.y, x.z);
        let [i, j, k] = key(&target);
        let mut best = (f64::INFINITY, 0);
        for near in (0..27).map(|n| [i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1]) {
            for &v in places.get(&near).into_iter().flatten() {
                let distance = (mesh.vertices[v] - target).norm();
                if distance < best.0 {
                    best = (distance, v);
                }
            }
        }
        if !best.0.is_finite() {
            return Err(Fault::Surface(format!(
                "no vertex at the mirror image of ({:.5}, {:.5}, {:.5})",
                x.x, x.y, x.z
            )));
        }
        image.push(best.1);
        worst = worst.max(best.0);
    }
    Ok((image, worst))
}

fn squares(field: &[Vec3]) -> f64 {
    field.iter().map(Vec3::norm_squared).sum()
}

/// Sum over triangles of area times the square of the angle by which displacements turn the
/// normal, from `δ(n A) = (δe × f + e × δf)/2` without its part along n.
fn turning(mesh: &TriMesh, field: &[Vec3]) -> f64 {
    let mut sum = 0.0;
    for [a, b, c] in mesh.triangles.iter().map(|t| t.map(|v| v as usize)) {
        let edges = |x: &[Vec3]| [x[b] - x[a], x[c] - x[a]];
        let ([e, f], [de, df]) = (edges(&mesh.vertices), edges(field));
        let double = e.cross(&f);
        let change = de.cross(&f) + e.cross(&df);
        let area = 0.5 * double.norm();
        let normal = double / (2.0 * area);
        let turn = (change - normal * normal.dot(&change)) / (2.0 * area);
        sum += area * turn.norm_squared();
    }
    sum
}

/// The part of a mode with the given parity.
fn split(mode: &SurfaceMode, image: &[usize], sign: f64) -> Vec<Vec3> {
    mode.displacement
        .iter()
        .zip(image)
        .map(|(u, &other)| {
            let mirrored = mode.displacement[other].component_mul(&Vec3::new(1.0, -1.0, 1.0));
            0.5 * (u + sign * mirrored)
        })
        .collect()
}

/// The larger of a mode's symmetric and antisymmetric parts.
fn projected(mode: &SurfaceMode, image: &[usize]) -> SurfaceMode {
    let [even, odd] = [1.0, -1.0].map(|sign| split(mode, image, sign));
    let size = |field: &[Vec3]| field.iter().map(Vec3::norm_squared).sum::<f64>();
    SurfaceMode {
        name: format!("{PROJECTED}{}", mode.name),
        frame: mode.frame,
        displacement: if size(&even) >= size(&odd) { even } else { odd },
    }
}
