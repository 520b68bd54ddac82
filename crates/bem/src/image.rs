//! Half models: the other half of the surface as an image in the plane y = 0.
//!
//! A reflection keeps the kernels: a panel's image seen from P is the panel seen from P's
//! image P′. With φ(P′) = ±φ(P) the equation on the given half is
//!
//! c φ − (D ± D′)[φ] − (W ± W′)[κ] = −(S ± S′)[σ], c = 1 + D[1] + D′[1],
//!
//! D′ evaluated at P′. It is the whole surface's equation restricted to symmetric or
//! antisymmetric potentials, hence gives the same forces. The test functions on the plane
//! have both halves equal (symmetric) or a potential that is zero (antisymmetric).

use fladder_mesh::{Symmetry, Vec3};

/// Vertices closer to the plane than this, in metres, are on it; meshes put them there.
const PLANE: f64 = 1e-12;

/// What the potential does under reflection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Image {
    /// The surface is whole.
    None,
    /// φ(P′) = φ(P).
    Even,
    /// φ(P′) = −φ(P).
    Odd,
}

impl Image {
    /// What the steady flow does, which is symmetric whatever the motion.
    pub(crate) fn of_flow(symmetry: Symmetry) -> Self {
        match symmetry {
            Symmetry::None => Self::None,
            Symmetry::Symmetric | Symmetry::Antisymmetric => Self::Even,
        }
    }

    /// What the motion does.
    pub(crate) fn of_motion(symmetry: Symmetry) -> Self {
        match symmetry {
            Symmetry::None => Self::None,
            Symmetry::Symmetric => Self::Even,
            Symmetry::Antisymmetric => Self::Odd,
        }
    }

    /// Sign of the image's potential; none for whole surfaces.
    pub(crate) fn sign(self) -> Option<f64> {
        match self {
            Self::None => None,
            Self::Even => Some(1.0),
            Self::Odd => Some(-1.0),
        }
    }
}

/// Reflection in the plane y = 0.
pub(crate) fn mirrored(point: &Vec3) -> Vec3 {
    Vec3::new(point.x, -point.y, point.z)
}

/// Whether a vertex lies on the plane.
pub(crate) fn on_plane(point: &Vec3) -> bool {
    point.y.abs() <= PLANE
}
