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

/// Reduced frequency up to which the goal of plates is the stricter one.
pub const LOW_FREQUENCY: f64 = 0.4;

/// Incidence of the comparison of lift by pressure and by wake.
const ALPHA_DEG: f64 = 4.0;

/// Cells of a wing of unit chord.
#[derive(Clone, Copy, Debug)]
pub struct Cells {
    /// From leading to trailing edge, a side.
    pub chord: usize,
    /// From root to tip at aspect ratio 8; up to a quarter less or more for other spans.
    pub half_span: usize,
    /// Shortening of the cells at the nose, [`NacaWing::nose_clustering`].
    pub nose: f64,
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

    /// Largest error of Q of a plate by max |Q| at reduced frequency k.
    pub fn lattice_goal(self, k: f64) -> f64 {
        match self {
            Self::Structured if k <= LOW_FREQUENCY => 0.015,
            Self::Structured => 0.025,
            Self::Unstructured => 0.03,
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
    let share = (aspect_ratio / 8.0).sqrt().clamp(0.75, 1.25);
    NacaWing {
        thickness,
        span: aspect_ratio,
        n_chord: cells.chord,
        n_half_span: (cells.half_span as f64 * share).round() as usize,
        nose_clustering: cells.nose,
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

/// Lift slope per rad on the area, by pressure.
///
/// A difference about no incidence: an unstructured mesh, not symmetric about its chord
/// plane, has a little lift there.
fn slope_by_pressure(solution: &Solution, area: f64) -> f64 {
    let force = |alpha: f64| {
        let loads = solution.steady.loads_at([alpha.cos(), 0.0, alpha.sin()]);
        loads.force[2]
    };
    let step = 1e-3;
    (force(step) - force(-step)) / (2.0 * step * area)
}

/// Lift slope by the wake's jump, of which that of a symmetric section is sin α times.
fn slope_by_jump(solution: &Solution, area: f64) -> f64 {
    solution.steady.lift_by_wake_jump / (ALPHA_DEG.to_radians().sin() * area)
}

/// Lift by pressure over lift by the wake's jump, distance from 1.
fn kutta_joukowski(solution: &Solution) -> f64 {
    let steady = &solution.steady;
    (steady.lift_by_pressure / steady.lift_by_wake_jump - 1.0).abs()
}

/// What may be wrong by how much.
#[derive(Clone, Copy, Debug)]
pub struct Goals {
    /// Lift slope, by pressure and by the wake's jump, on structured meshes.
    pub structured: f64,
    /// The same on unstructured ones, whose nose is uneven.
    pub unstructured: f64,
    /// Lift by pressure against lift by jump: of first order in the chordwise cells, since
    /// the nose of a 2 % section has a radius of 4e-4 c.
    pub kutta: f64,
}

impl Goals {
    /// Of slopes and of the two lifts.
    fn of(self, kind: Kind) -> [f64; 2] {
        let slope = match kind {
            Kind::Structured => self.structured,
            Kind::Unstructured => self.unstructured,
        };
        [slope, self.kutta]
    }
}

/// Slopes by pressure and jump, and the two lifts against each other.
fn rows_of(
    case: &str,
    mesh: &TriMesh,
    found: [f64; 2],
    exact: f64,
    kutta: f64,
    goals: [f64; 2],
) -> Vec<Row> {
    let row = |case: String, figure: String, error: f64, goal: f64| Row {
        case,
        mesh: mesh_size(mesh),
        figure,
        error,
        goal,
    };
    let mut rows: Vec<Row> = ["pressure", "wake jump"]
        .iter()
        .zip(found)
        .map(|(by, found)| {
            let figure = format!("C_Lα by {by} {found:.4}, reference {exact}");
            row(
                case.to_owned(),
                figure,
                (found / exact - 1.0).abs(),
                goals[0],
            )
        })
        .collect();
    rows.push(row(
        format!("{case}: Kutta and Joukowski"),
        "lift by pressure against wake jump, 4°".into(),
        kutta,
        goals[1],
    ));
    rows
}

/// Lift slopes of plates of the aspect ratios `wanted`, thickness extrapolated.
///
/// # Errors
/// Reference file, shape or solver.
pub fn plates(
    cells: Cells,
    wanted: impl Fn(f64) -> bool,
    goals: Goals,
) -> Result<Vec<Row>, Fault> {
    let mut rows = Vec::new();
    for line in reference::lines("steady_rect_lift_slope_open.csv")? {
        let [aspect_ratio, exact] = line.numbers(["AR", "CL_alpha"])?;
        if !wanted(aspect_ratio) {
            continue;
        }
        for kind in Kind::ALL {
            let solved = |thickness: f64| -> Result<(TriMesh, Solution), Fault> {
                let mesh = kind.mesh(&rectangular(aspect_ratio, thickness, cells))?;
                let solution = at_incidence(&mesh)?;
                Ok((mesh, solution))
            };
            let ((_, thick), (mesh, thin)) = (solved(THICK)?, solved(THIN)?);
            let found = [slope_by_pressure, slope_by_jump]
                .map(|by| plate_limit(by(&thick, aspect_ratio), by(&thin, aspect_ratio)));
            let kutta = kutta_joukowski(&thick).max(kutta_joukowski(&thin));
            let case = format!("plate, aspect ratio {aspect_ratio}, {}", kind.name());
            rows.extend(rows_of(&case, &mesh, found, exact, kutta, goals.of(kind)));
        }
    }
    Ok(rows)
}

/// Wings of aspect ratio 8 with thickness against limits of refinement.
///
/// # Errors
/// As [`plates`].
pub fn thick(cells: Cells, goals: Goals) -> Result<Vec<Row>, Fault> {
    let mut rows = Vec::new();
    for line in reference::lines("wing_ar8_thick_lift_slope.csv")? {
        let [thickness, exact] = line.numbers(["thickness", "CL_alpha"])?;
        for kind in Kind::ALL {
            let mesh = kind.mesh(&rectangular(8.0, thickness, cells))?;
            let solution = at_incidence(&mesh)?;
            let found = [slope_by_pressure, slope_by_jump].map(|by| by(&solution, 8.0));
            let case = format!(
                "wing, aspect ratio 8, {:.0} % thick, {}",
                100.0 * thickness,
                kind.name()
            );
            let kutta = kutta_joukowski(&solution);
            rows.extend(rows_of(&case, &mesh, found, exact, kutta, goals.of(kind)));
        }
    }
    Ok(rows)
}
