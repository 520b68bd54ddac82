//! Mass properties of the whole from the three rigid modes of a half model.
//!
//! With `r₀` the middle of the nodes, symmetric motion is `(t_x, t_z, ω_y)` about
//! `r₀`, antisymmetric motion `(t_y, ω_x, ω_z)` about its image in y = 0. As with
//! six modes, `M_rr = (B diag(m_k)⁻¹ Bᵀ)⁻¹`, now
//!
//! $$ \begin{bmatrix} m & 0 & m c_z\\ & m & -m c_x\\ & & I_{yy}\end{bmatrix}, \qquad
//!    \begin{bmatrix} m & -m c_z & m c_x\\ & I_{xx} & -I_{xz}\\ & & I_{zz}\end{bmatrix} $$
//!
//! about `r₀`, c the centre of mass from there and `I_xz = ∫ x z dm`. The moments
//! that are not in them belong to the other kind of motion.

use crate::rigid::{Inertia, RigidBody};
use crate::rigid_fit::{Basis, RIGID_RESIDUAL, RecoveredBody};
use fladder_mesh::{Symmetry, Vec3};
use nalgebra::{Matrix3, Vector3, Vector6};

/// The three parameters of a rigid motion of one kind; `None` where it is of
/// another.
fn parameters(
    motion: &Vector6<f64>,
    basis: &Basis,
    symmetry: Symmetry,
) -> Option<Vector3<f64>> {
    let [tx, ty, tz, wx, wy, wz]: [f64; 6] = (*motion).into();
    let arm = basis.centre.y / basis.size;
    let (kept, others) = match symmetry {
        Symmetry::None => return None,
        Symmetry::Symmetric => (Vector3::new(tx, tz, wy), Vector3::new(ty, wx, wz)),
        Symmetry::Antisymmetric => (
            Vector3::new(ty, wx, wz),
            Vector3::new(tx + wz * arm, tz - wx * arm, wy),
        ),
    };
    (others.norm() <= RIGID_RESIDUAL * motion.norm()).then_some(kept)
}

/// Recovers what three rigid modes of one kind hold; generalised masses are
/// those of the whole.
pub(crate) fn recover(
    modes: &[(Vector6<f64>, f64)],
    basis: &Basis,
    symmetry: Symmetry,
    notes: &mut Vec<String>,
) -> Option<RecoveredBody> {
    let mut inverse_mass = Matrix3::zeros();
    for (motion, generalised_mass) in modes {
        let Some(b) = parameters(motion, basis, symmetry) else {
            notes.push(format!(
                "a rigid mode of the half model is not {}: no mass properties from the file",
                symmetry.word()
            ));
            return None;
        };
        inverse_mass += b * b.transpose() / *generalised_mass;
    }
    let matrix = inverse_mass.try_inverse()?;
    let recovered = match symmetry {
        Symmetry::None => return None,
        Symmetry::Symmetric => symmetric(&matrix, basis),
        Symmetry::Antisymmetric => antisymmetric(&matrix, basis),
    };
    let held = if symmetry == Symmetry::Symmetric {
        "Iyy; the other moments of inertia"
    } else {
        "Ixx, Izz and ∫ x z dm; Iyy"
    };
    notes.push(format!(
        "mass properties from three rigid modes of the half model: of the moments of inertia \
         they hold {held} shown have no meaning and take no part in {} motion",
        symmetry.word()
    ));
    Some(recovered)
}

fn symmetric(matrix: &Matrix3<f64>, basis: &Basis) -> RecoveredBody {
    let mass = 0.5 * (matrix[(0, 0)] + matrix[(1, 1)]);
    let arm = Vec3::new(-matrix[(1, 2)], 0.0, matrix[(0, 2)]) * (basis.size / mass);
    let yy = matrix[(2, 2)] * basis.size.powi(2) - mass * arm.norm_squared();
    RecoveredBody {
        body: RigidBody {
            mass,
            cg: centre(basis, arm),
            inertia: Inertia {
                xx: yy,
                yy,
                zz: yy,
                xz: 0.0,
            },
        },
        mass_spread: (matrix[(0, 0)] / mass - 1.0).abs(),
        asymmetry: [0.0; 2],
    }
}

fn antisymmetric(matrix: &Matrix3<f64>, basis: &Basis) -> RecoveredBody {
    let mass = matrix[(0, 0)];
    let arm = Vec3::new(matrix[(0, 2)], 0.0, -matrix[(0, 1)]) * (basis.size / mass);
    let square = basis.size.powi(2);
    let xx = matrix[(1, 1)] * square - mass * arm.z * arm.z;
    let zz = matrix[(2, 2)] * square - mass * arm.x * arm.x;
    RecoveredBody {
        body: RigidBody {
            mass,
            cg: centre(basis, arm),
            inertia: Inertia {
                xx,
                yy: xx.max(zz),
                zz,
                xz: -matrix[(1, 2)] * square - mass * arm.x * arm.z,
            },
        },
        mass_spread: 0.0,
        asymmetry: [0.0; 2],
    }
}

fn centre(basis: &Basis, arm: Vec3) -> Vec3 {
    let mut centre = basis.centre + arm;
    centre.y = 0.0;
    centre
}
