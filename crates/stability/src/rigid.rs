//! Rigid-body motion in body quasi-coordinates.
//!
//! With $q_6 = (x, y, z, \varphi, \theta, \psi)$, the integrals of the
//! body-axis velocities and rates, structural axes x aft, y starboard, z up:
//!
//! $$ M_6 = \begin{bmatrix} mI & 0\\ 0 & J\end{bmatrix},\quad
//!    C_6 = \begin{bmatrix} 0 & -m[V_0]_\times\\ 0 & 0\end{bmatrix},\quad
//!    K_6 = \begin{bmatrix} 0 & -m[g_b]_\times\\ 0 & 0\end{bmatrix} $$
//!
//! $V_0 = -U(\cos\alpha\cos\beta, -\sin\beta, \sin\alpha\cos\beta)$,
//! $g_b = g(\sin\vartheta, 0, -\cos\vartheta)$ with
//! $\vartheta = \alpha + \gamma$, $J_{xz} = -I_{xz}$. All three are normalised
//! by $T = \operatorname{diag}(m,m,m,I_{xx},I_{yy},I_{zz})^{-1/2}$. Eller,
//! IFASD-2009-119, eqs. (3)–(22), with the missing terms at incidence.
//!
//! In these coordinates the loads of a rigid displacement vanish, $Q(0) = 0$
//! in the rigid columns, and the zero roots are semisimple: four with gravity,
//! six without.

use crate::structure::OperatingPoint;

/// Names of the rigid modes, in order.
pub const RIGID_NAMES: [&str; 6] = [
    "rigid:x",
    "rigid:y",
    "rigid:z",
    "rigid:phi",
    "rigid:theta",
    "rigid:psi",
];

/// A 6 × 6 matrix over the rigid modes.
pub type Matrix6 = [[f64; 6]; 6];

/// Mass and inertia about the centre of mass, structural axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidBody {
    /// Mass in kg.
    pub mass: f64,
    /// $I_{xx}$ in kg m².
    pub ixx: f64,
    /// $I_{yy}$ in kg m².
    pub iyy: f64,
    /// $I_{zz}$ in kg m².
    pub izz: f64,
    /// $I_{xz} = \int xz\,\mathrm dm$ in kg m²; the tensor entry is its
    /// negative.
    pub ixz: f64,
}

/// Mass properties that no body can have.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RigidBodyError {
    /// Mass or a moment of inertia is not positive.
    #[error("{name} is {value}, it must be positive and finite")]
    NotPositive {
        /// Which property.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The product of inertia is too large.
    #[error("the product of inertia {ixz} is not below sqrt(Ixx Izz) = {limit}")]
    Product {
        /// $I_{xz}$.
        ixz: f64,
        /// $\sqrt{I_{xx}I_{zz}}$.
        limit: f64,
    },
}

impl RigidBody {
    /// Checks that the inertia matrix is positive.
    ///
    /// # Errors
    /// See [`RigidBodyError`].
    pub fn validated(self) -> Result<Self, RigidBodyError> {
        let named = [
            ("mass", self.mass),
            ("Ixx", self.ixx),
            ("Iyy", self.iyy),
            ("Izz", self.izz),
        ];
        for (name, value) in named {
            if !(value.is_finite() && value > 0.0) {
                return Err(RigidBodyError::NotPositive { name, value });
            }
        }
        let limit = (self.ixx * self.izz).sqrt();
        if self.ixz.is_nan() || self.ixz.abs() >= limit {
            return Err(RigidBodyError::Product {
                ixz: self.ixz,
                limit,
            });
        }
        Ok(self)
    }

    /// Diagonal of $T$: one over the square roots of masses and inertias.
    pub fn scales(&self) -> [f64; 6] {
        [
            self.mass, self.mass, self.mass, self.ixx, self.iyy, self.izz,
        ]
        .map(|v| 1.0 / v.sqrt())
    }

    /// $TM_6T$: the unit matrix but for
    /// $M_{\varphi\psi} = -I_{xz}/\sqrt{I_{xx}I_{zz}}$.
    pub fn mass_matrix(&self) -> Matrix6 {
        let mut matrix = [[0.0; 6]; 6];
        for (mode, row) in matrix.iter_mut().enumerate() {
            row[mode] = 1.0;
        }
        let coupling = -self.ixz / (self.ixx * self.izz).sqrt();
        matrix[3][5] = coupling;
        matrix[5][3] = coupling;
        matrix
    }

    /// $TC_6T$: rotation rates carry the velocity vector along.
    pub fn rotation_rate(&self, point: &OperatingPoint) -> Matrix6 {
        let (sin_a, cos_a) = point.alpha.sin_cos();
        let (sin_b, cos_b) = point.beta.sin_cos();
        let u = -point.airspeed;
        self.upper_right([u * cos_a * cos_b, -u * sin_b, u * sin_a * cos_b])
    }

    /// $TK_6T$: gravity turns in body axes when the body turns.
    pub fn gravity(&self, gravity: f64, pitch_attitude: f64) -> Matrix6 {
        let (sin, cos) = pitch_attitude.sin_cos();
        self.upper_right([gravity * sin, 0.0, -gravity * cos])
    }

    /// $T\,[0, -m[v]_\times; 0, 0]\,T$.
    fn upper_right(&self, v: [f64; 3]) -> Matrix6 {
        let cross = [[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]];
        let scales = self.scales();
        let mut matrix = [[0.0; 6]; 6];
        for (i, row) in cross.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                matrix[i][3 + j] = -self.mass * value * scales[i] * scales[3 + j];
            }
        }
        matrix
    }
}

/// Where the six rigid modes stand among all modes; a half model has three.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RigidModes(pub [Option<usize>; 6]);

impl RigidModes {
    /// Finds the rigid modes by their names.
    pub fn among(modes: &[String]) -> Self {
        Self(RIGID_NAMES.map(|name| modes.iter().position(|mode| mode == name)))
    }

    /// Their numbers, ascending.
    pub fn numbers(&self) -> Vec<usize> {
        let mut numbers: Vec<usize> = self.0.iter().copied().flatten().collect();
        numbers.sort_unstable();
        numbers
    }

    /// Adds a 6 × 6 matrix to the rows and columns of the rigid modes.
    pub(crate) fn add(&self, block: &Matrix6, matrix: &mut faer::Mat<f64>) {
        for (i, row) in block.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                if let (Some(row), Some(column)) = (self.0[i], self.0[j]) {
                    matrix[(row, column)] += value;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BODY: RigidBody = RigidBody {
        mass: 4.0,
        ixx: 1.0,
        iyy: 2.25,
        izz: 3.0,
        ixz: 0.3,
    };

    /// $C(y,\psi) = -U\sqrt{m/I_{zz}}$, $C(z,\theta) = U\sqrt{m/I_{yy}}$ and
    /// nothing else at zero incidence.
    #[test]
    fn rotation_rates_at_zero_incidence_are_the_two_known_terms() {
        let c = BODY.rotation_rate(&OperatingPoint::new(30.0, 1.0));
        assert!((c[1][5] + 30.0 * (4.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert!((c[2][4] - 30.0 * (4.0_f64 / 2.25).sqrt()).abs() < 1e-12);
        let others: f64 = c.iter().flatten().map(|v| v.abs()).sum();
        assert!((others - c[1][5].abs() - c[2][4].abs()).abs() < 1e-12);
    }

    /// In level flight nose-up pitch gives a forward component of weight
    /// against x aft, bank a side component: $K(x,\theta) = -g\sqrt{m/I_{yy}}$,
    /// $K(y,\varphi) = g\sqrt{m/I_{xx}}$.
    #[test]
    fn gravity_in_level_flight_is_the_two_known_terms() {
        let k = BODY.gravity(9.81, 0.0);
        assert!((k[0][4] + 9.81 * (4.0_f64 / 2.25).sqrt()).abs() < 1e-12);
        assert!((k[1][3] - 9.81 * 2.0).abs() < 1e-12);
    }

    /// A product of inertia beyond the geometric mean belongs to no body.
    #[test]
    fn impossible_inertia_is_refused() {
        let body = RigidBody { ixz: 2.0, ..BODY };
        assert!(matches!(
            body.validated(),
            Err(RigidBodyError::Product { .. })
        ));
        let body = RigidBody {
            mass: f64::NAN,
            ..BODY
        };
        assert!(matches!(
            body.validated(),
            Err(RigidBodyError::NotPositive { .. })
        ));
    }
}
