//! Rigid motion in mode shapes: recognition, and the mass properties it holds.
//!
//! A rigid motion has six parameters, `u(r) = t + ω × (r − r₀)`. A mode is rigid
//! when the least-squares fit leaves next to nothing of its shape; frequencies
//! alone cannot tell, because mechanisms are at 0 Hz too. With all six rigid
//! modes of generalised masses `m_k`, `U = R B` gives the rigid mass matrix
//!
//! $$ M_{rr} = \left( B \, \mathrm{diag}(m_k)^{-1} B^T \right)^{-1}, $$
//!
//! and with it mass, centre of mass and inertia: `M_rr` of a basis about `r₀`
//! is `[[m I, −m c̃], [m c̃, I₀]]`, c the centre of mass from `r₀`.

use crate::result::ModalResult;
use crate::rigid::{Inertia, RigidBody};
use crate::rigid_half;
use fladder_mesh::{Symmetry, Vec3};
use nalgebra::{Matrix3, Matrix6, SymmetricEigen, Vector6};

/// Share of a shape's norm that a rigid fit may leave in a rigid mode. Six
/// printed digits leave 2e-5; elastic modes, orthogonal to rigid motion with
/// the mass as weight, leave a large part of one.
pub(crate) const RIGID_RESIDUAL: f64 = 1e-3;

/// Fits leaving less than this are named: a body on soft supports, or a rigid
/// mode spoilt by writing.
const NEARLY_RIGID_RESIDUAL: f64 = 0.05;

/// Share of the nodes that may be left out of the fit because they do not
/// follow: springs and scalar points.
const STRAY_SHARE: f64 = 0.05;

/// Residual up to which a mode can be a rigid one with strays among its nodes:
/// the square root of their share, and a margin.
const STRAY_RESIDUAL: f64 = 0.3;

/// Directions of rigid motion that the nodes cannot tell apart (nodes on one
/// line) are those whose share of the normal matrix is under this.
const RANK_TOLERANCE: f64 = 1e-12;

/// A 6 × 6 symmetric matrix takes some twenty steps; positions so large that
/// their squares overflow take for ever.
const EIGEN_ITERATIONS: usize = 1000;

/// Spread of the three translational masses above which the modes do not fit
/// one body.
const MASS_SPREAD: f64 = 1e-2;

/// What the rigid fit says of one mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidFit {
    /// Norm of what remains over the norm of the shape.
    pub residual: f64,
    /// The shape is a rigid motion.
    pub rigid: bool,
    motion: Vector6<f64>,
}

/// Mass properties recovered from six rigid modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecoveredBody {
    /// Mass, centre of mass and inertia.
    pub body: RigidBody,
    /// Largest difference between the masses of the three translations,
    /// relative: what the printed digits leave.
    pub mass_spread: f64,
    /// ∫ x y dm and ∫ y z dm about the centre of mass; zero for a symmetric
    /// aircraft, and not part of the rigid modes.
    pub asymmetry: [f64; 2],
}

impl RecoveredBody {
    /// The whole of which the modes hold the half y ≥ 0 or y ≤ 0, once generalised
    /// masses are doubled: the centre of mass moves to y = 0, and the distance of
    /// each half from there adds to the moments about x and z.
    #[must_use]
    pub(crate) fn with_mirror_image(mut self) -> Self {
        self.body = self.body.parted();
        self.asymmetry = [0.0; 2];
        self
    }
}

/// The rigid part of a whole result.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidSurvey {
    /// One fit a mode, in the order of the result.
    pub fits: Vec<RigidFit>,
    /// Mass properties, where six independent rigid modes are there.
    pub recovered: Option<RecoveredBody>,
    /// What is odd, one sentence each.
    pub notes: Vec<String>,
}

impl RigidSurvey {
    /// Number of rigid modes.
    pub fn rigid_count(&self) -> usize {
        self.fits.iter().filter(|fit| fit.rigid).count()
    }
}

/// Basis of rigid motion about the middle of some nodes, rotations scaled to
/// the size of the structure so that the normal matrix is well conditioned.
pub(crate) struct Basis {
    pub(crate) centre: Vec3,
    pub(crate) size: f64,
    nodes: Vec<usize>,
}

impl Basis {
    fn new(positions: &[Vec3], nodes: Vec<usize>) -> Self {
        let count = nodes.len().max(1) as f64;
        let centre = nodes.iter().map(|n| positions[*n]).sum::<Vec3>() / count;
        let square: f64 = nodes
            .iter()
            .map(|n| (positions[*n] - centre).norm_squared())
            .sum();
        let size = (square / count).sqrt();
        Self {
            centre,
            size: if size > 0.0 { size } else { 1.0 },
            nodes,
        }
    }

    /// Displacement of a motion (translation; rotation times size).
    fn displacement(&self, motion: &Vector6<f64>, position: &Vec3) -> Vec3 {
        let (t, w) = (motion.fixed_rows::<3>(0), motion.fixed_rows::<3>(3));
        t + w.cross(&((position - self.centre) / self.size))
    }

    fn inverse_normal(&self, positions: &[Vec3]) -> Matrix6<f64> {
        let mut normal = Matrix6::zeros();
        for node in &self.nodes {
            let arm = ((positions[*node] - self.centre) / self.size).cross_matrix();
            let mut normal_block = |row, column, block: Matrix3<f64>| {
                let mut view = normal.fixed_view_mut::<3, 3>(row, column);
                view += block;
            };
            normal_block(0, 0, Matrix3::identity());
            normal_block(0, 3, -arm);
            normal_block(3, 0, arm);
            normal_block(3, 3, -arm * arm);
        }
        let Some(eigen) = SymmetricEigen::try_new(normal, f64::EPSILON, EIGEN_ITERATIONS)
        else {
            return Matrix6::zeros();
        };
        let floor = RANK_TOLERANCE * eigen.eigenvalues.max();
        let inverted = eigen
            .eigenvalues
            .map(|v| if v > floor { 1.0 / v } else { 0.0 });
        eigen.eigenvectors * Matrix6::from_diagonal(&inverted) * eigen.eigenvectors.transpose()
    }

    fn fit(&self, inverse: &Matrix6<f64>, positions: &[Vec3], shape: &[Vec3]) -> Vector6<f64> {
        let mut right = Vector6::zeros();
        for node in &self.nodes {
            let (arm, u) = ((positions[*node] - self.centre) / self.size, shape[*node]);
            let moment = arm.cross(&u);
            right += Vector6::new(u.x, u.y, u.z, moment.x, moment.y, moment.z);
        }
        inverse * right
    }

    /// Remaining norm over the norm of the shape, on the nodes of the basis.
    fn residual(&self, motion: &Vector6<f64>, positions: &[Vec3], shape: &[Vec3]) -> f64 {
        let (mut rest, mut whole) = (0.0, 0.0);
        for node in &self.nodes {
            rest +=
                (shape[*node] - self.displacement(motion, &positions[*node])).norm_squared();
            whole += shape[*node].norm_squared();
        }
        if whole > 0.0 {
            (rest / whole).sqrt()
        } else {
            1.0
        }
    }
}

/// Fits every mode and recovers the mass properties.
pub fn survey(result: &ModalResult) -> RigidSurvey {
    survey_of(result, Symmetry::None)
}

/// As [`survey`]; of a half model, whose generalised masses are doubled, three
/// rigid modes of one kind hold the mass properties that this kind needs.
pub(crate) fn survey_of(result: &ModalResult, symmetry: Symmetry) -> RigidSurvey {
    let positions = result.positions();
    let mut notes = Vec::new();
    let basis = Basis::new(&positions, fit_nodes(result));
    let (basis, strays) = without_strays(result, &positions, basis);
    if strays > 0 {
        notes.push(format!(
            "{strays} nodes do not follow rigid motion (springs, scalar points)"
        ));
    }
    let inverse = basis.inverse_normal(&positions);
    let fits: Vec<RigidFit> = result
        .modes
        .iter()
        .map(|mode| {
            let motion = basis.fit(&inverse, &positions, &mode.displacement);
            let residual = basis.residual(&motion, &positions, &mode.displacement);
            RigidFit {
                residual,
                rigid: residual < RIGID_RESIDUAL,
                motion,
            }
        })
        .collect();
    for (mode, fit) in result.modes.iter().zip(&fits) {
        if !fit.rigid && fit.residual < NEARLY_RIGID_RESIDUAL {
            notes.push(format!(
                "mode {} at {} Hz is rigid but for {:.1} % of its shape and counts as elastic",
                mode.index,
                mode.frequency_hz,
                100.0 * fit.residual
            ));
        }
    }
    let rigid: Vec<(Vector6<f64>, f64)> = result
        .modes
        .iter()
        .zip(&fits)
        .filter(|(_, fit)| fit.rigid)
        .map(|(mode, fit)| (fit.motion, mode.generalised_mass))
        .collect();
    let recovered = if symmetry.is_half() && rigid.len() == 3 {
        rigid_half::recover(&rigid, &basis, symmetry, &mut notes)
    } else {
        let whole = recover(&rigid, &basis, &mut notes);
        whole.map(|body| {
            if symmetry.is_half() {
                body.with_mirror_image()
            } else {
                body
            }
        })
    };
    RigidSurvey {
        fits,
        recovered,
        notes,
    }
}

/// Nodes of shells where there are any, else of solids, else all.
pub(crate) fn fit_nodes(result: &ModalResult) -> Vec<usize> {
    let of = |wanted: fn(&crate::element::ElementKind) -> bool| {
        let mut used = vec![false; result.nodes.len()];
        for element in result
            .elements
            .iter()
            .filter(|element| wanted(&element.kind))
        {
            element
                .nodes
                .iter()
                .for_each(|node| used[*node as usize] = true);
        }
        (0..used.len())
            .filter(|node| used[*node])
            .collect::<Vec<usize>>()
    };
    let shells = of(|kind| kind.is_shell());
    if shells.len() >= 3 {
        return shells;
    }
    let solids = of(|kind| kind.is_solid());
    if solids.len() >= 3 {
        solids
    } else {
        (0..result.nodes.len()).collect()
    }
}

/// Leaves out nodes that stay behind in modes which are otherwise rigid.
fn without_strays(result: &ModalResult, positions: &[Vec3], basis: Basis) -> (Basis, usize) {
    let inverse = basis.inverse_normal(positions);
    let mut stray = vec![false; positions.len()];
    for mode in &result.modes {
        let shape = &mode.displacement;
        let motion = basis.fit(&inverse, positions, shape);
        if basis.residual(&motion, positions, shape) > STRAY_RESIDUAL {
            continue;
        }
        let errors: Vec<f64> = basis
            .nodes
            .iter()
            .map(|n| (shape[*n] - basis.displacement(&motion, &positions[*n])).norm())
            .collect();
        let mut sorted = errors.clone();
        sorted.sort_by(f64::total_cmp);
        let typical = sorted[sorted.len() / 2];
        let scale = motion.norm() * RIGID_RESIDUAL;
        let limit = (10.0 * typical).max(scale);
        for (node, error) in basis.nodes.iter().zip(&errors) {
            stray[*node] |= *error > limit && typical < scale * 100.0;
        }
    }
    let count = basis.nodes.iter().filter(|node| stray[**node]).count();
    let allowed = (STRAY_SHARE * basis.nodes.len() as f64) as usize;
    if count == 0 || count > allowed {
        return (basis, 0);
    }
    let kept = basis
        .nodes
        .iter()
        .copied()
        .filter(|node| !stray[*node])
        .collect();
    (Basis::new(positions, kept), count)
}

fn recover(
    rigid: &[(Vector6<f64>, f64)],
    basis: &Basis,
    notes: &mut Vec<String>,
) -> Option<RecoveredBody> {
    let mut inverse_mass = Matrix6::zeros();
    for (motion, generalised_mass) in rigid {
        inverse_mass += motion * motion.transpose() / *generalised_mass;
    }
    let count = rigid.len();
    if count != 6 {
        if count > 0 {
            notes.push(format!("{count} rigid modes: mass properties need six"));
        }
        return None;
    }
    let eigen =
        SymmetricEigen::try_new(inverse_mass, f64::EPSILON, EIGEN_ITERATIONS)?.eigenvalues;
    if eigen.min() <= RANK_TOLERANCE * eigen.max() {
        notes.push("the six rigid modes are not independent: no mass properties".to_owned());
        return None;
    }
    let mass_matrix = inverse_mass.try_inverse()?;
    let recovered = body_of(&mass_matrix, basis);
    if recovered.mass_spread > MASS_SPREAD {
        notes.push(format!(
            "the masses of the three rigid translations differ by {:.1} %",
            100.0 * recovered.mass_spread
        ));
    }
    Some(recovered)
}

/// Mass, centre of mass and inertia from the 6 × 6 mass matrix of the basis.
fn body_of(matrix: &Matrix6<f64>, basis: &Basis) -> RecoveredBody {
    let translations = [matrix[(0, 0)], matrix[(1, 1)], matrix[(2, 2)]];
    let mass = translations.iter().sum::<f64>() / 3.0;
    let spread = translations
        .iter()
        .map(|m| (m / mass - 1.0).abs())
        .fold(0.0, f64::max);
    // The lower left block is m c̃ / size: c̃[(2,1)] = c_x and so on.
    let coupling: Matrix3<f64> = matrix.fixed_view::<3, 3>(3, 0).into_owned();
    let skew = (coupling - coupling.transpose()) * (0.5 * basis.size / mass);
    let arm = Vec3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)]);
    let about_centre: Matrix3<f64> = matrix.fixed_view::<3, 3>(3, 3) * basis.size.powi(2);
    let cross = arm.cross_matrix();
    let inertia = about_centre + cross * cross * mass;
    RecoveredBody {
        body: RigidBody {
            mass,
            cg: basis.centre + arm,
            inertia: Inertia {
                xx: inertia[(0, 0)],
                yy: inertia[(1, 1)],
                zz: inertia[(2, 2)],
                xz: -0.5 * (inertia[(0, 2)] + inertia[(2, 0)]),
            },
        },
        mass_spread: spread,
        asymmetry: [-inertia[(0, 1)], -inertia[(1, 2)]],
    }
}
