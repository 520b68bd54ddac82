//! What every computation starts with: wake, factorised body, steady flow.

use crate::boundary::{ModeFields, onset_sources};
use crate::cut::CutSurface;
use crate::dense::{BodyOperator, DenseOperator, Operator, Solver};
use crate::error::BemError;
use crate::galerkin::Galerkin;
use crate::hierarchical::HierarchicalOperator;
use crate::image::Image;
use crate::onset::OnsetBasis;
use crate::progress::Progress;
use crate::shape_change::{ShapeChange, check_symmetry, correct_potentials};
use crate::solve::{Problem, check, lay_out};
use crate::steady::UnitOnsets;
use crate::transfer::solve_complex;
use crate::wake::Wake;
use crate::wake_influence::WakeInfluence;
use faer::{Mat, c64};

/// A problem as far as it does not depend on s; `O` is the factorised operator, or
/// nothing once it is not needed any more.
pub(crate) struct Prepared<O> {
    pub(crate) surface: CutSurface,
    pub(crate) wake: Wake,
    /// The steady flow's, where its symmetry is another than the motion's.
    flow_wake: Option<Wake>,
    /// K: +1 at upper, −1 at lower vertices.
    pub(crate) selector: Mat<f64>,
    pub(crate) fields: ModeFields,
    pub(crate) body: Body<O>,
    pub(crate) onsets: UnitOnsets,
}

/// The body's equations with the symmetry of the motion.
pub(crate) struct Body<O> {
    pub(crate) galerkin: Galerkin,
    pub(crate) operator: O,
    pub(crate) free_terms: Vec<f64>,
    /// What the slopes of jumps add, [`crate::influence::Totals::slopes`].
    pub(crate) slopes: Mat<f64>,
    /// Potentials of the sources, without wake.
    pub(crate) potentials: Mat<f64>,
    /// A⁻ᵀ K: what a tested influence makes of each jump at the trailing edge.
    pub(crate) jump_adjoint: Mat<f64>,
}

impl Prepared<Operator> {
    /// Lays out, factorises and solves the steady flow.
    pub(crate) fn new(
        problem: &Problem<'_>,
        progress: &dyn Progress,
    ) -> Result<Self, BemError> {
        check(problem)?;
        check_symmetry(problem)?;
        let symmetry = problem.symmetry;
        let (flow, motion) = (Image::of_flow(symmetry), Image::of_motion(symmetry));
        let (surface, wake) = lay_out(problem, motion)?;
        let selector = selector(&surface);
        let tolerance = problem.solver.far_tolerance();
        let galerkin = Galerkin::with_tolerance(&surface, motion, tolerance);
        let fields = ModeFields::new(
            &galerkin,
            &surface.source,
            problem.modes,
            problem.turning,
            OnsetBasis::of(problem),
        );
        let sources = fields.sources(&galerkin);
        let mut flow_wake = None;
        let (body, onsets) = if flow == motion {
            let all = concatenate(&[&sources, &onset_sources(&galerkin)]);
            let body = Body::factorise(galerkin, &all, &selector, problem.solver, progress)?;
            let onsets = body.steady_onsets(&wake, &selector, sources.ncols(), progress)?;
            (body, onsets)
        } else {
            let even = Galerkin::with_tolerance(&surface, flow, tolerance);
            let onset = onset_sources(&even);
            let (_, even_wake) = lay_out(problem, flow)?;
            let steady = Body::factorise(even, &onset, &selector, problem.solver, progress)?;
            let onsets = steady.steady_onsets(&even_wake, &selector, 0, progress)?;
            flow_wake = Some(even_wake);
            drop(steady);
            (
                Body::factorise(galerkin, &sources, &selector, problem.solver, progress)?,
                onsets,
            )
        };
        let mut prepared = Self {
            surface,
            wake,
            flow_wake,
            selector,
            fields,
            body,
            onsets,
        };
        if problem.shape_change == ShapeChange::Exact {
            correct_potentials(&mut prepared, problem, progress)?;
        }
        Ok(prepared)
    }

    /// Frees the operator's memory.
    pub(crate) fn without_operator(self) -> Prepared<()> {
        Prepared {
            surface: self.surface,
            wake: self.wake,
            flow_wake: self.flow_wake,
            selector: self.selector,
            fields: self.fields,
            body: Body {
                galerkin: self.body.galerkin,
                operator: (),
                free_terms: self.body.free_terms,
                slopes: self.body.slopes,
                potentials: self.body.potentials,
                jump_adjoint: self.body.jump_adjoint,
            },
            onsets: self.onsets,
        }
    }
}

impl<O> Prepared<O> {
    /// The wake of the steady flow.
    pub(crate) fn flow_wake(&self) -> &Wake {
        self.flow_wake.as_ref().unwrap_or(&self.wake)
    }

    pub(crate) fn influence(&self) -> WakeInfluence<'_> {
        self.body.influence(&self.wake)
    }
}

impl<O> Body<O> {
    fn influence<'a>(&'a self, wake: &'a Wake) -> WakeInfluence<'a> {
        WakeInfluence {
            galerkin: &self.galerkin,
            wake,
            free_terms: &self.free_terms,
            slopes: &self.slopes,
        }
    }
}

impl Body<Operator> {
    fn factorise(
        galerkin: Galerkin,
        sources: &Mat<f64>,
        selector: &Mat<f64>,
        solver: Solver,
        progress: &dyn Progress,
    ) -> Result<Self, BemError> {
        let (operator, mut potentials, slopes, free_terms) = match solver {
            Solver::Hierarchical { tolerance } => {
                let assembled = HierarchicalOperator::assemble(
                    &galerkin,
                    sources.as_ref(),
                    tolerance,
                    progress,
                )?;
                (
                    Operator::Hierarchical(assembled.operator),
                    assembled.right_hand_sides,
                    assembled.slopes,
                    assembled.free_terms,
                )
            }
            Solver::Refined | Solver::Double => {
                let assembly = galerkin.assemble(sources.as_ref(), progress)?;
                let (size, is_double) = (galerkin.n_vertices, solver == Solver::Double);
                let operator = DenseOperator::new(assembly.rows, size, is_double, progress)?;
                (
                    Operator::Dense(operator),
                    assembly.right_hand_sides,
                    assembly.slopes,
                    assembly.free_terms,
                )
            }
        };
        operator.solve(&mut potentials, progress)?;
        let mut jump_adjoint = selector.clone();
        operator.solve_transpose(&mut jump_adjoint, progress)?;
        Ok(Self {
            galerkin,
            operator,
            free_terms,
            slopes,
            potentials,
            jump_adjoint,
        })
    }

    /// Steady potentials and jumps for the three unit onsets, whose potentials without
    /// wake are the three from `first` on.
    fn steady_onsets(
        &self,
        wake: &Wake,
        selector: &Mat<f64>,
        first: usize,
        progress: &dyn Progress,
    ) -> Result<UnitOnsets, BemError> {
        let n = selector.ncols();
        let mut phi = self.potentials.subcols(first, 3).to_owned();
        if self.galerkin.image.sign().is_some() {
            // A stream along y is antisymmetric.
            phi.col_mut(1).fill(0.0);
        }
        let mut jumps = Mat::zeros(n, 3);
        if n > 0 {
            let tested = self.influence(wake).steady(n, progress)?;
            let h = self.jump_adjoint.transpose() * &tested;
            let system = Mat::from_fn(n, n, |i, j| {
                let unit = if i == j { 1.0 } else { 0.0 };
                c64::new(unit - h[(i, j)], 0.0)
            });
            let right = selector.transpose() * &phi;
            let right = Mat::from_fn(n, 3, |i, j| c64::new(right[(i, j)], 0.0));
            let solved = solve_complex(system, right).ok_or(BemError::Singular {
                pivot: 0,
                size: n,
                value: 0.0,
            })?;
            jumps = Mat::from_fn(n, 3, |i, j| solved[(i, j)].re);
            let mut response = tested * &jumps;
            self.operator.solve(&mut response, progress)?;
            phi += response;
        }
        Ok(UnitOnsets::new(&self.galerkin, wake, phi, jumps))
    }
}

fn selector(surface: &CutSurface) -> Mat<f64> {
    let mut k = Mat::zeros(surface.vertices.len(), surface.columns.len());
    for (j, column) in surface.columns.iter().enumerate() {
        k[(column.upper as usize, j)] = 1.0;
        k[(column.lower as usize, j)] = -1.0;
    }
    k
}

/// Matrices side by side.
pub(crate) fn concatenate(parts: &[&Mat<f64>]) -> Mat<f64> {
    let rows = parts[0].nrows();
    let columns = parts.iter().map(|p| p.ncols()).sum();
    let mut all = Mat::zeros(rows, columns);
    let mut from = 0;
    for part in parts {
        all.subcols_mut(from, part.ncols()).copy_from(part);
        from += part.ncols();
    }
    all
}
