//! Changes of a structure without a new finite-element run.
//!
//! Added masses and changed hinge stiffnesses act through the mode shapes. With
//! the elastic modes Φ of the structure as it was (`ΦᵀMΦ = 1`, `ΦᵀKΦ = Λ`) and
//! its rigid motions R, which carry no stiffness and are orthogonal to Φ,
//!
//! $$ M_{ee} = 1 + \sum_k \left(m_k U_k^T U_k + W_k^T J_k W_k\right), \quad
//!    M_{re} = \sum_k \left(m_k R_k^T U_k + R_{\omega}^T J_k W_k\right), \quad
//!    K_{ee} = \Lambda + \sum_h \Delta k_h\,\theta_h\theta_h^T, $$
//!
//! `U_k`, `W_k` the displacements and rotations of the modes at mass k and
//! `θ_h` their hinge rotations. Taking `R G`, `G = M_rr⁻¹ M_re`, from the shapes
//! makes them orthogonal to rigid motion again; the modes of what is left are the
//! new elastic modes. It is the Rayleigh-Ritz method on the modes in the file:
//! frequencies approach those of a new analysis from above as more of them are
//! there.

use crate::attach::Attachment;
use crate::model::ElasticMode;
use crate::rigid::{Inertia, RigidBody};
use fladder_mesh::Vec3;
use nalgebra::{
    Cholesky, DMatrix, DVector, Matrix3, Matrix3x6, Matrix6, SymmetricEigen, Vector6,
};
use std::f64::consts::TAU;

/// What is changed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Edits {
    /// Masses added.
    pub masses: Vec<PointMass>,
    /// Hinges made stiffer or softer.
    pub hinges: Vec<HingeChange>,
    /// Frequencies that tests have shown, by the number of the elastic mode.
    pub frequencies: Vec<(usize, f64)>,
}

impl Edits {
    /// Nothing that asks for new modes.
    pub(crate) fn keeps_shapes(&self) -> bool {
        self.masses.is_empty() && self.hinges.is_empty()
    }
}

/// A mass fixed to the structure.
#[derive(Clone, Debug, PartialEq)]
pub struct PointMass {
    /// Name in messages.
    pub name: String,
    /// Mass, kg; negative to take away.
    pub mass: f64,
    /// Its centre in mesh axes, m.
    pub position: Vec3,
    /// Number of the node it is fixed to; left out: the nearest.
    pub node: Option<u64>,
    /// Moments about its own centre, kg m².
    pub inertia: Option<Inertia>,
}

/// A hinge stiffness that differs from that of the finite-element model.
#[derive(Clone, Debug, PartialEq)]
pub struct HingeChange {
    /// Name in messages.
    pub name: String,
    /// Stiffness to be added, N m/rad.
    pub stiffness_change: f64,
    /// Where the rotation is found.
    pub rotation: HingeRotation,
}

/// How the modes turn a hinge.
#[derive(Clone, Debug, PartialEq)]
pub enum HingeRotation {
    /// A displacement component (0 to 2, in the structure's axes) of a node
    /// stands for the rotation, as that of a scalar point does.
    Scalar {
        /// Number of the node.
        node: u64,
        /// Component.
        component: usize,
    },
    /// The nodes of one set turn against those of another about an axis.
    Between {
        /// Set on the control surface.
        control: String,
        /// Set on what it is hinged to.
        base: String,
        /// Hinge axis in mesh axes.
        axis: Vec3,
    },
}

/// An edit that cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EditError {
    /// A node or set that the structure lacks.
    #[error("{name}: the structure has no {what}")]
    Unknown {
        /// Mass or hinge.
        name: String,
        /// What it names.
        what: String,
    },
    /// Nodes on one line, or a single one.
    #[error(
        "{name}: the nodes of {set:?} do not tell a rotation: they are less than three, or on one line"
    )]
    NoRotation {
        /// Hinge.
        name: String,
        /// Set.
        set: String,
    },
    /// A free structure of unknown mass.
    #[error(
        "added masses move the free structure as a whole, and its own mass is not known: the file \
         holds {rigid} rigid modes and no mass properties"
    )]
    UnknownBody {
        /// Rigid modes in the file.
        rigid: usize,
    },
    /// Halves.
    #[error(
        "structure.half = true with added masses or hinges: they change the whole, which the file does not hold"
    )]
    Half,
    /// A mass or stiffness taken away that was not there.
    #[error("with these changes the structure has {what}")]
    Impossible {
        /// `no stiffness left` and so on.
        what: &'static str,
    },
    /// An override of a mode that is not there.
    #[error("elastic mode {number} is not there: there are {count}")]
    NoMode {
        /// Number given.
        number: usize,
        /// Elastic modes.
        count: usize,
    },
}

/// A mass with the place it is fixed to.
pub(crate) struct Fixed<'a> {
    pub(crate) mass: &'a PointMass,
    pub(crate) attachment: Attachment,
}

/// The new modes of a structure.
pub(crate) struct Change<'a> {
    pub(crate) masses: &'a [Fixed<'a>],
    /// Stiffness added, and the rotation of every mode.
    pub(crate) hinges: &'a [(f64, Vec<f64>)],
    pub(crate) positions: &'a [Vec3],
}

/// Rigid body with its full inertia tensor.
struct Whole {
    mass: f64,
    centre: Vec3,
    inertia: Matrix3<f64>,
}

impl Whole {
    fn of(body: &RigidBody) -> Self {
        Self {
            mass: body.mass,
            centre: body.cg,
            inertia: tensor(&body.inertia),
        }
    }

    fn with(&self, masses: &[Fixed<'_>]) -> Self {
        let added = masses.iter().map(|fixed| fixed.mass);
        let mass = self.mass + added.clone().map(|added| added.mass).sum::<f64>();
        let moment = self.centre * self.mass
            + added
                .clone()
                .map(|added| added.position * added.mass)
                .sum::<Vec3>();
        let centre = moment / mass;
        let mut inertia = self.inertia + steiner(self.mass, &(self.centre - centre));
        for added in added {
            inertia += added.inertia.as_ref().map_or_else(Matrix3::zeros, tensor);
            inertia += steiner(added.mass, &(added.position - centre));
        }
        Self {
            mass,
            centre,
            inertia,
        }
    }

    fn body(&self) -> RigidBody {
        RigidBody {
            mass: self.mass,
            cg: self.centre,
            inertia: Inertia {
                xx: self.inertia[(0, 0)],
                yy: self.inertia[(1, 1)],
                zz: self.inertia[(2, 2)],
                xz: -self.inertia[(0, 2)],
            },
        }
    }

    /// About its own centre.
    fn matrix(&self) -> Matrix6<f64> {
        let mut matrix = Matrix6::zeros();
        let diagonal = Matrix3::identity() * self.mass;
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&diagonal);
        matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.inertia);
        matrix
    }
}

fn tensor(inertia: &Inertia) -> Matrix3<f64> {
    let Inertia { xx, yy, zz, xz } = *inertia;
    Matrix3::new(xx, 0.0, -xz, 0.0, yy, 0.0, -xz, 0.0, zz)
}

fn steiner(mass: f64, arm: &Vec3) -> Matrix3<f64> {
    let cross = arm.cross_matrix();
    -cross * cross * mass
}

/// Displacement from a motion of the whole about a centre.
fn rigid_at(arm: &Vec3) -> Matrix3x6<f64> {
    let mut matrix = Matrix3x6::zeros();
    matrix
        .fixed_view_mut::<3, 3>(0, 0)
        .copy_from(&Matrix3::identity());
    matrix
        .fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&-arm.cross_matrix());
    matrix
}

/// Products of inertia across y = 0 and distance of the centre from there above
/// this share are named.
const ASYMMETRY: f64 = 1e-3;

impl Change<'_> {
    /// The modes and the mass properties after the change.
    pub(crate) fn apply(
        &self,
        modes: &[ElasticMode],
        body: Option<&RigidBody>,
        notes: &mut Vec<String>,
    ) -> Result<(Vec<ElasticMode>, Option<RigidBody>), EditError> {
        let n = modes.len();
        let mut mass = DMatrix::<f64>::identity(n, n);
        let squares = modes.iter().map(|mode| mode.omega * mode.omega);
        let mut stiffness = DMatrix::from_diagonal(&DVector::from_iterator(n, squares));
        for (change, rotation) in self.hinges {
            let rotation = DVector::from_column_slice(rotation);
            stiffness += &rotation * rotation.transpose() * *change;
        }
        let whole = body.map(|body| Whole::of(body).with(self.masses));
        let centre = whole
            .as_ref()
            .map_or_else(Vec3::zeros, |whole| whole.centre);
        let mut coupling = vec![Vector6::zeros(); n];
        for fixed in self.masses {
            let motions: Vec<[Vec3; 2]> = modes
                .iter()
                .map(|mode| fixed.attachment.motion(mode, self.positions))
                .collect();
            let added = fixed.mass;
            let inertia = added.inertia.as_ref().map_or_else(Matrix3::zeros, tensor);
            let rigid = rigid_at(&(added.position - centre));
            for i in 0..n {
                let [u, w] = motions[i];
                let turn = inertia * w;
                coupling[i] += rigid.transpose() * u * added.mass
                    + Vector6::new(0.0, 0.0, 0.0, turn.x, turn.y, turn.z);
                for j in 0..n {
                    let [v, x] = motions[j];
                    mass[(i, j)] += added.mass * u.dot(&v) + turn.dot(&x);
                }
            }
        }
        let mut rigid_parts = vec![Vector6::zeros(); n];
        if let Some(whole) = &whole {
            let inverse = whole.matrix().cholesky().ok_or(EditError::Impossible {
                what: "a mass or moment of inertia that is not positive",
            })?;
            rigid_parts = coupling.iter().map(|c| inverse.solve(c)).collect();
            for i in 0..n {
                for j in 0..n {
                    mass[(i, j)] -= coupling[i].dot(&rigid_parts[j]);
                }
            }
            notes.extend(asymmetry(whole));
        }
        let (squares, vectors) = eigen(&mass, &stiffness)?;
        let renewed = (0..n)
            .map(|k| self.combined(modes, &rigid_parts, &centre, (k, squares[k], &vectors)))
            .collect();
        Ok((renewed, whole.map(|whole| whole.body())))
    }

    fn combined(
        &self,
        modes: &[ElasticMode],
        rigid_parts: &[Vector6<f64>],
        centre: &Vec3,
        (number, square, vectors): (usize, f64, &DMatrix<f64>),
    ) -> ElasticMode {
        let shares = vectors.column(number);
        let main = &modes[shares.iamax()];
        let sign = shares[shares.iamax()].signum();
        let rigid: Vector6<f64> = rigid_parts
            .iter()
            .zip(shares.iter())
            .map(|(part, c)| part * (sign * c))
            .sum();
        let turn = rigid.fixed_rows::<3>(3).into_owned();
        let mut shape: Vec<Vec3> = self
            .positions
            .iter()
            .map(|position| -(rigid_at(&(position - centre)) * rigid))
            .collect();
        let mut rotation = main
            .rotation
            .as_ref()
            .map(|rotations| vec![-turn; rotations.len()]);
        for (mode, share) in modes.iter().zip(shares.iter()) {
            let share = sign * share;
            shape
                .iter_mut()
                .zip(&mode.shape)
                .for_each(|(u, v)| *u += v * share);
            if let (Some(rotation), Some(others)) = (&mut rotation, &mode.rotation) {
                rotation
                    .iter_mut()
                    .zip(others)
                    .for_each(|(w, v)| *w += v * share);
            }
        }
        let omega = square.max(0.0).sqrt();
        ElasticMode {
            name: format!("elastic:{}", number + 1),
            omega,
            frequency_hz: omega / TAU,
            shape,
            rotation,
            participation: None,
            ..main.clone()
        }
    }
}

fn asymmetry(whole: &Whole) -> Option<String> {
    let [xy, yz] = [-whole.inertia[(0, 1)], -whole.inertia[(1, 2)]];
    let limit = ASYMMETRY * whole.inertia[(2, 2)];
    (xy.abs().max(yz.abs()) > limit).then(|| {
        format!(
            "the added masses are not symmetric about y = 0: ∫ x y dm = {xy:.3e} and ∫ y z dm = \
             {yz:.3e} kg m² are left out of the rigid modes"
        )
    })
}

/// Squares of circular frequencies, ascending, and their vectors of unit mass.
///
/// The inverse problem `M y = μ (K + σ M) y`, `μ = 1/(ω² + σ)`, keeps the digits
/// of the lowest modes; σ is zero unless there are mechanisms.
fn eigen(
    mass: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
) -> Result<(Vec<f64>, DMatrix<f64>), EditError> {
    let impossible = |what| EditError::Impossible { what };
    if Cholesky::new(mass.clone()).is_none() {
        return Err(impossible(
            "a mass that is not positive in one of its modes",
        ));
    }
    let (low, high) = (stiffness.diagonal().min(), stiffness.diagonal().max());
    let shift = if low > high * f64::EPSILON {
        0.0
    } else {
        high.max(1.0) * 1e-6
    };
    let factor = Cholesky::new(stiffness + mass * shift)
        .ok_or_else(|| impossible("no stiffness left in one of its modes"))?
        .l();
    let n = mass.nrows();
    let half = factor
        .solve_lower_triangular(mass)
        .unwrap_or_else(|| DMatrix::zeros(n, n));
    let inner = factor
        .solve_lower_triangular(&half.transpose())
        .unwrap_or_else(|| DMatrix::zeros(n, n));
    let inner = (&inner + inner.transpose()) * 0.5;
    let eigen = SymmetricEigen::new(inner);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let mut vectors = DMatrix::zeros(n, n);
    let mut squares = Vec::with_capacity(n);
    for (place, k) in order.into_iter().enumerate() {
        let value = eigen.eigenvalues[k];
        let square = 1.0 / value - shift;
        if value.is_nan() || value <= 0.0 || square < -1e-3 * shift {
            return Err(impossible("no stiffness left in one of its modes"));
        }
        squares.push(square);
        let vector = factor
            .tr_solve_lower_triangular(&eigen.eigenvectors.column(k))
            .unwrap_or_else(|| DVector::zeros(n));
        vectors.set_column(place, &(vector / value.sqrt()));
    }
    Ok((squares, vectors))
}
