//! Steady lift of rectangular wings; lift by pressure against lift by the wake's jump.

use fladder_bem::{Flow, Solution};
use fladder_mesh::shapes::NacaWing;
use fladder_mesh::{Frame, TriMesh, Vec3};

use crate::case::{Fault, Setup, mode};
use crate::reference;
use crate::row::{Row, mesh_size};

/// Thickness ratios from which the limit of the plate is taken.
pub const THICK: f64 = 0.04;
/// The thinner one.
pub const THIN: f64 = 0.02;

/// Incidence of the comparison of lift by pressure and by wake.
const ALPHA_DEG: f64 = 4.0;

/// Cells of a wing of unit chord.
#[derive(Clone, Copy, Debug)]
pub struct Cells {
    /// From leading to trailing edge, a side.
    pub chord: usize,
    /// From root to tip at aspect ratio 8; other spans in proportion to the root of it.
    pub half_span: usize,
}

/// How the points of a mesh lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Rows and columns, upper and lower side alike.
    Structured,
    /// Irregular, upper and lower side not matched.
    Unstructured,
}

impl Kind {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Structured, Self::Unstructured];

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Structured => "structured",
            Self::Unstructured => "unstructured",
        }
    }

    /// The wing in that kind of mesh.
    ///
    /// # Errors
    /// A wing that cannot be built.
    pub fn mesh(self, wing: &NacaWing) -> Result<TriMesh, Fault> {
        Ok(match self {
            Self::Structured => wing.structured()?,
            Self::Unstructured => wing.unstructured(1)?,
        })
    }
}

/// Value in the limit of no thickness, linear in thickness from [`THICK`] and [`THIN`].
pub fn plate_limit<T>(thick: T, thin: T) -> T
where
    T: std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T>,
{
    thin * (THICK / (THICK - THIN)) - thick * (THIN / (THICK - THIN))
}

fn rectangular(aspect_ratio: f64, thickness: f64, cells: Cells) -> NacaWing {
    let share = (aspect_ratio / 8.0).sqrt();
    NacaWing {
        thickness,
        span: aspect_ratio,
        n_chord: cells.chord,
        n_half_span: (cells.half_span as f64 * share).round().max(6.0) as usize,
        ..NacaWing::default()
    }
}

fn at_incidence(mesh: &TriMesh) -> Result<Solution, Fault> {
    let plunge = [mode(mesh, "plunge", Frame::Inertial, |_| Vec3::z())];
    let setup = Setup {
        flow: Flow {
            alpha: ALPHA_DEG.to_radians(),
            beta: 0.0,
        },
        semichord: 0.5,
        ..Setup::new(mesh, &plunge)
    };
    setup.solve()
}

/// Lift slope per rad on the area.
///
/// A difference about no incidence: an unstructured mesh, not symmetric about its chord
/// plane, has a little lift there.
fn lift_slope(solution: &Solution, area: f64) -> f64 {
    let force = |alpha: f64| {
        let loads = solution.steady.loads_at([alpha.cos(), 0.0, alpha.sin()]);
        loads.force[2]
    };
    let step = 1e-3;
    (force(step) - force(-step)) / (2.0 * step * area)
}

/// Lift by pressure over lift by the wake's jump, distance from 1.
fn kutta_joukowski(solution: &Solution) -> f64 {
    let steady = &solution.steady;
    (steady.lift_by_pressure / steady.lift_by_wake_jump - 1.0).abs()
}

/// Lift slopes of plates of the aspect ratios `wanted`, thickness extrapolated.
///
/// # Errors
/// Reference file, shape or solver.
pub fn plates(
    cells: Cells,
    wanted: impl Fn(f64) -> bool,
    goal: f64,
) -> Result<Vec<Row>, Fault> {
    let mut rows = Vec::new();
    for line in reference::lines("steady_rect_lift_slope_open.csv")? {
        let [aspect_ratio, exact] = line.numbers(["AR", "CL_alpha"])?;
        if !wanted(aspect_ratio) {
            continue;
        }
        for kind in Kind::ALL {
            let mut slopes = [0.0; 2];
            let mut last = TriMesh::default();
            let mut kutta = 0.0_f64;
            for (slope, thickness) in slopes.iter_mut().zip([THICK, THIN]) {
                last = kind.mesh(&rectangular(aspect_ratio, thickness, cells))?;
                let solution = at_incidence(&last)?;
                *slope = lift_slope(&solution, aspect_ratio);
                kutta = kutta.max(kutta_joukowski(&solution));
            }
            let found = plate_limit(slopes[0], slopes[1]);
            let case = format!("plate, aspect ratio {aspect_ratio}, {}", kind.name());
            rows.push(Row {
                case: case.clone(),
                mesh: mesh_size(&last),
                figure: format!("C_Lα {found:.4}, reference {exact:.4}"),
                error: (found / exact - 1.0).abs(),
                goal,
            });
            rows.push(Row {
                case: format!("{case}: Kutta and Joukowski"),
                mesh: mesh_size(&last),
                figure: "lift by pressure against wake jump, worse of 4 % and 2 %".into(),
                error: kutta,
                goal: 0.01,
            });
        }
    }
    Ok(rows)
}

/// Wings of aspect ratio 8 with thickness against limits of refinement.
///
/// # Errors
/// As [`plates`].
pub fn thick(cells: Cells, goal: f64) -> Result<Vec<Row>, Fault> {
    let mut rows = Vec::new();
    for line in reference::lines("wing_ar8_thick_lift_slope.csv")? {
        let [thickness, exact] = line.numbers(["thickness", "CL_alpha"])?;
        for kind in Kind::ALL {
            let mesh = kind.mesh(&rectangular(8.0, thickness, cells))?;
            let solution = at_incidence(&mesh)?;
            let found = lift_slope(&solution, 8.0);
            let case = format!(
                "wing, aspect ratio 8, {:.0} % thick, {}",
                100.0 * thickness,
                kind.name()
            );
            rows.push(Row {
                case: case.clone(),
                mesh: mesh_size(&mesh),
                figure: format!("C_Lα {found:.3}, reference {exact:.2}"),
                error: (found / exact - 1.0).abs(),
                goal,
            });
            rows.push(Row {
                case: format!("{case}: Kutta and Joukowski"),
                mesh: mesh_size(&mesh),
                figure: "lift by pressure against wake jump".into(),
                error: kutta_joukowski(&solution),
                goal: 0.01,
            });
        }
    }
    Ok(rows)
}
