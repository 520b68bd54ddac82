//! Half models: the part on y ≥ 0 of what is symmetric in the plane y = 0.
//!
//! With the reflection S = diag(1, −1, 1), a displacement field is
//!
//! $$ \text{symmetric: } \mathbf u(S\mathbf r) = S\,\mathbf u(\mathbf r), \qquad
//!    \text{antisymmetric: } \mathbf u(S\mathbf r) = -S\,\mathbf u(\mathbf r), $$
//!
//! so that in the plane itself u_y = 0, and u_x = u_z = 0. Every field is the
//! sum of one of each, and on a symmetric body in a symmetric stream the two
//! exert no generalised force on each other.

use crate::Vec3;
use serde::{Deserialize, Serialize};

/// Whether a model is whole, or a half that carries one kind of motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Symmetry {
    /// Whole model.
    #[default]
    #[serde(rename = "none")]
    None,
    /// Half model on y ≥ 0, symmetric motion.
    #[serde(rename = "y")]
    Symmetric,
    /// Half model on y ≥ 0, antisymmetric motion.
    #[serde(rename = "-y")]
    Antisymmetric,
}

impl Symmetry {
    /// Whether the model is a half.
    pub fn is_half(self) -> bool {
        self != Self::None
    }

    /// Whether fields of the given kind are among the motions of the model.
    pub fn carries(self, field: Self) -> bool {
        !self.is_half() || self == field
    }

    /// The kind of motion in words.
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "neither symmetric nor antisymmetric",
            Self::Symmetric => "symmetric",
            Self::Antisymmetric => "antisymmetric",
        }
    }

    /// The part of a displacement that a point of the plane may have.
    pub fn in_plane(self, mut u: Vec3) -> Vec3 {
        match self {
            Self::None => {}
            Self::Symmetric => u.y = 0.0,
            Self::Antisymmetric => (u.x, u.z) = (0.0, 0.0),
        }
        u
    }
}

/// Image in the plane y = 0 of a place or of a displacement.
pub fn mirrored(v: Vec3) -> Vec3 {
    Vec3::new(v.x, -v.y, v.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A field and its image agree in the plane: what is left there is what
    /// the definition leaves.
    #[test]
    fn the_plane_keeps_what_its_own_image_allows() {
        let u = Vec3::new(1.0, 2.0, 3.0);
        let even = 0.5 * (u + mirrored(u));
        let odd = 0.5 * (u - mirrored(u));
        assert_eq!(Symmetry::Symmetric.in_plane(u), even);
        assert_eq!(Symmetry::Antisymmetric.in_plane(u), odd);
        assert_eq!(Symmetry::None.in_plane(u), even + odd);
    }
}
