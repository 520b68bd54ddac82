//! Unit onsets of which streams are combinations.
//!
//! The steady velocity and the convected displacement are linear in the stream U. While
//! the wake stays where it is, Q is a polynomial in the components of U,
//!
//! Q(s; U) = 2 { s² P1ᵀb₁ … + Σ_a U_a (…) + Σ_ab U_a U_b (…) },
//!
//! so that one factorisation serves every incidence: a wake that stays, or none, is given
//! the onsets e_x and e_z (and e_y where there is sideslip). A wake along the free stream
//! has one onset, the stream.

use crate::solve::{Problem, WakeDirection};
use fladder_mesh::Vec3;
use serde::{Deserialize, Serialize};

/// How far a stream may lie outside the span of the onsets.
const OUTSIDE: f64 = 1e-12;

/// Orthonormal onsets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct OnsetBasis(Vec<[f64; 3]>);

impl OnsetBasis {
    /// The onsets of a problem.
    pub(crate) fn of(problem: &Problem<'_>) -> Self {
        let follows = problem.wake_direction == WakeDirection::Freestream;
        if follows && !problem.trailing_edges.is_empty() {
            return Self::single(problem.flow.stream());
        }
        let mut axes = vec![[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        if problem.flow.beta != 0.0 {
            axes.push([0.0, 1.0, 0.0]);
        }
        Self(axes)
    }

    /// One stream only.
    pub(crate) fn single(stream: Vec3) -> Self {
        Self(vec![stream.into()])
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    pub(crate) fn axes(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.0.iter().map(|&axis| Vec3::from(axis))
    }

    /// Components of a stream, or none where it is no combination of the onsets.
    pub(crate) fn components(&self, stream: Vec3) -> Option<Vec<f64>> {
        let components: Vec<f64> = self.axes().map(|axis| axis.dot(&stream)).collect();
        let sum: Vec3 = self
            .axes()
            .zip(&components)
            .map(|(axis, c)| axis * *c)
            .sum();
        ((sum - stream).norm() <= OUTSIDE).then_some(components)
    }

    /// Whether the values are those of orthonormal vectors.
    pub(crate) fn is_sound(&self) -> bool {
        !self.0.is_empty()
            && self.axes().enumerate().all(|(i, a)| {
                self.axes().enumerate().all(|(j, b)| {
                    let unit = if i == j { 1.0 } else { 0.0 };
                    (a.dot(&b) - unit).abs() <= OUTSIDE
                })
            })
    }
}
