//! Roots over a range of flight conditions, by p2, p-k and refined.
//!
//! Speeds are independent and solved in parallel; tracking and naming are
//! sequential, so that the outcome has the same bits at any thread count.

use faer::{Mat, c64};
use rayon::prelude::*;

use crate::aerodynamics::Aerodynamics;
use crate::crossing::{Found, Resolver, before_the_start, locate, sign_changes};
use crate::eigenpair::Eigenpair;
use crate::gaf::GafTable;
use crate::linalg::NoConvergence;
use crate::p2::PiecewiseQuadratic;
use crate::pk::PkForm;
use crate::refined::refined_roots;
use crate::report::Reporter;
use crate::resolvers::{P2Resolver, PkResolver, PolishedResolver};
use crate::results::{MethodResult, Methods, SCHEMA, SweepResult};
use crate::spline::AxisSpline;
use crate::structure::{OperatingPoint, Reduced, Schedule, Structure};
use crate::track::{Station, Track, follow};

/// Which methods run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// p2 and the refined roots.
    P2,
    /// p-k.
    Pk,
    /// All.
    #[default]
    Both,
}

/// A sweep to be made.
pub struct Sweep<'a> {
    /// Structure.
    pub structure: &'a dyn Structure,
    /// Flight conditions.
    pub schedule: &'a dyn Schedule,
    /// Samples of $Q$, from which p-k interpolates.
    pub table: &'a GafTable,
    /// Piecewise quadratic of the same samples.
    pub fit: &'a PiecewiseQuadratic,
    /// Smooth $Q(p)$ on which roots are refined; without it there is no
    /// outcome `polished`.
    pub smooth: Option<&'a dyn Aerodynamics>,
    /// Which methods run.
    pub method: Method,
    /// Form of the p-k problem.
    pub pk_form: PkForm,
}

/// What a caller wants to know while a sweep runs.
pub trait Progress: Sync {
    /// One more flight condition was solved by one method.
    fn advance(&self) {}
    /// Whether to stop.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Nobody watches.
impl Progress for () {}

/// Why a sweep gave nothing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// The schedule has no point.
    #[error("the sweep has no flight condition")]
    Empty,
    /// A flight condition is impossible.
    #[error(
        "flight condition {number}: airspeed {airspeed} m/s and density {density} kg/m³ must be positive and finite"
    )]
    Condition {
        /// Number of the condition, from 1.
        number: usize,
        /// Airspeed.
        airspeed: f64,
        /// Density.
        density: f64,
    },
    /// Structure and aerodynamics have different modes.
    #[error("the structure has {structure} modes, the aerodynamic forces have {aerodynamics}")]
    Order {
        /// Modes of the structure.
        structure: usize,
        /// Modes of the aerodynamics.
        aerodynamics: usize,
    },
    /// An eigenvalue iteration failed.
    #[error("at {airspeed} m/s {source}")]
    Numerical {
        /// Airspeed.
        airspeed: f64,
        /// What failed.
        source: NoConvergence,
    },
    /// The spline of the p-k method failed.
    #[error("the interpolation of Q failed: {0}")]
    Spline(NoConvergence),
    /// The caller stopped the sweep.
    #[error("the sweep was stopped")]
    Cancelled,
}

impl Sweep<'_> {
    /// Number of calls of [`Progress::advance`] in a whole run.
    pub fn steps(&self) -> usize {
        let methods = match self.method {
            Method::P2 | Method::Pk => 1,
            Method::Both => 2,
        };
        let polished = usize::from(self.smooth.is_some() && self.method != Method::Pk);
        (methods + polished) * self.schedule.count()
    }

    /// Solves every flight condition, follows the roots and finds crossings.
    ///
    /// # Errors
    /// See [`SweepError`]. An unstable structure is a result, not an error.
    pub fn run(&self, progress: &dyn Progress) -> Result<SweepResult, SweepError> {
        let points = self.checked_points()?;
        let semichord = self.table.semichord();
        let reduced: Vec<Reduced> = points
            .par_iter()
            .map(|point| Reduced::new(self.structure, point, semichord))
            .collect();
        let run = Run {
            sweep: self,
            points: &points,
            reduced: &reduced,
            progress,
        };
        let mut methods = Methods::default();
        if self.method != Method::Pk {
            methods.p2 = Some(run.p2()?);
            if let Some(smooth) = self.smooth {
                methods.polished = Some(run.polished(smooth)?);
            }
        }
        if self.method != Method::P2 {
            methods.pk = Some(run.pk()?);
        }
        let density = points[0].density;
        let is_constant = points.iter().all(|point| point.density == density);
        Ok(SweepResult {
            schema: SCHEMA,
            density: is_constant.then_some(density),
            semichord,
            methods,
        })
    }

    fn checked_points(&self) -> Result<Vec<OperatingPoint>, SweepError> {
        let count = self.schedule.count();
        if count == 0 {
            return Err(SweepError::Empty);
        }
        let (structure, aerodynamics) = (self.structure.modes().len(), self.table.order());
        if structure != aerodynamics {
            return Err(SweepError::Order {
                structure,
                aerodynamics,
            });
        }
        let points: Vec<OperatingPoint> = (0..count)
            .map(|number| self.schedule.at(number as f64))
            .collect();
        let is_good = |value: f64| value.is_finite() && value > 0.0;
        for (number, point) in points.iter().enumerate() {
            if !(is_good(point.airspeed) && is_good(point.density)) {
                return Err(SweepError::Condition {
                    number: number + 1,
                    airspeed: point.airspeed,
                    density: point.density,
                });
            }
        }
        Ok(points)
    }
}

/// Roots at every speed and what was counted there.
struct Solved {
    roots: Vec<Vec<Eigenpair>>,
    zeros: Vec<usize>,
    complete: Option<Vec<bool>>,
}

struct Run<'a> {
    sweep: &'a Sweep<'a>,
    points: &'a [OperatingPoint],
    reduced: &'a [Reduced],
    progress: &'a dyn Progress,
}

impl Run<'_> {
    /// Solves all speeds in parallel, in order.
    fn at_every_speed<T: Send>(
        &self,
        solve: impl Fn(&Reduced) -> Result<T, NoConvergence> + Sync,
    ) -> Result<Vec<T>, SweepError> {
        self.points
            .par_iter()
            .zip(self.reduced)
            .map(|(point, reduced)| {
                if self.progress.is_cancelled() {
                    return Err(SweepError::Cancelled);
                }
                let solved = solve(reduced);
                self.progress.advance();
                solved.map_err(|source| SweepError::Numerical {
                    airspeed: point.airspeed,
                    source,
                })
            })
            .collect()
    }

    fn p2(&self) -> Result<MethodResult, SweepError> {
        let fit = self.sweep.fit;
        let solved = self.at_every_speed(|reduced| crate::p2::roots(fit, reduced))?;
        let (roots, zeros) = solved.into_iter().map(|s| (s.roots, s.zeros)).unzip();
        let resolver = P2Resolver { sweep: self.sweep };
        Ok(self.finish(
            &Solved {
                roots,
                zeros,
                complete: None,
            },
            &resolver,
        ))
    }

    fn polished(&self, smooth: &dyn Aerodynamics) -> Result<MethodResult, SweepError> {
        let sweep = self.sweep;
        let solved =
            self.at_every_speed(|reduced| refined_roots(reduced, sweep.fit, smooth))?;
        let complete = solved.iter().map(|speed| speed.is_complete).collect();
        let (roots, zeros) = solved.into_iter().map(|s| (s.roots, s.zeros)).unzip();
        let resolver = PolishedResolver { sweep, smooth };
        Ok(self.finish(
            &Solved {
                roots,
                zeros,
                complete: Some(complete),
            },
            &resolver,
        ))
    }

    fn pk(&self) -> Result<MethodResult, SweepError> {
        let sweep = self.sweep;
        let spline = AxisSpline::new(sweep.table).map_err(SweepError::Spline)?;
        let solved = self.at_every_speed(|reduced| {
            crate::pk::PkProblem {
                reduced,
                spline: &spline,
                form: sweep.pk_form,
            }
            .roots(sweep.table.k())
        })?;
        let (roots, zeros) = solved.into_iter().map(|s| (s.roots, s.zeros)).unzip();
        let resolver = PkResolver {
            sweep,
            spline: &spline,
        };
        let mut result = self.finish(
            &Solved {
                roots,
                zeros,
                complete: None,
            },
            &resolver,
        );
        result.divergence = crate::static_sweep::divergences(sweep, self.points, &spline)?;
        Ok(result)
    }

    fn finish(&self, solved: &Solved, resolver: &dyn Resolver) -> MethodResult {
        let stations: Vec<Station<'_>> = solved
            .roots
            .iter()
            .zip(self.reduced)
            .map(|(roots, reduced)| Station {
                roots,
                rate: reduced.rate,
                mass: &reduced.mass,
            })
            .collect();
        let tracks = follow(&stations);
        let found = crossings(&tracks, resolver);
        let reporter = Reporter::new(self.sweep, self.points, self.reduced, &tracks);
        let mut result = reporter.report(&found);
        result.zero_roots.clone_from(&solved.zeros);
        result.complete.clone_from(&solved.complete);
        result
    }
}

fn crossings(tracks: &[Track], resolver: &dyn Resolver) -> Vec<Found> {
    tracks
        .par_iter()
        .enumerate()
        .flat_map_iter(|(number, track)| {
            let mut brackets = sign_changes(number, track);
            brackets.extend(before_the_start(number, track, resolver));
            brackets
                .into_iter()
                .filter_map(|bracket| locate(&bracket, resolver))
        })
        .collect()
}

/// Mass matrix of a flight condition between the points.
pub(crate) fn reduced_at(sweep: &Sweep<'_>, parameter: f64) -> Reduced {
    let point = sweep.schedule.at(parameter);
    Reduced::new(sweep.structure, &point, sweep.table.semichord())
}

/// $Q(0)$ by interpolation, real.
pub(crate) fn q_at_rest(spline: &AxisSpline) -> Mat<c64> {
    let q = spline.q(0.0);
    Mat::from_fn(q.nrows(), q.ncols(), |i, j| c64::new(q[(i, j)].re, 0.0))
}
