//! Roots over a range of flight conditions, by p2, p-k and refined.
//!
//! Speeds are independent and solved in parallel; tracking and naming are
//! sequential, so that the outcome has the same bits at any thread count.

use faer::{Mat, c64};
use rayon::prelude::*;

use crate::aerodynamics::Aerodynamics;
use crate::complete;
use crate::continuation::Continuation;
use crate::count::{Census, Claim};
use crate::crossing::{Found, Resolver, before_the_start, locate, sign_changes};
use crate::eigenpair::Eigenpair;
use crate::events::{events, from_growth};
use crate::flight_modes::FlightMode;
use crate::gaf::GafTable;
use crate::hump::hidden_crossings;
use crate::linalg::NoConvergence;
use crate::mixture::Mixture;
use crate::p2::PiecewiseQuadratic;
use crate::pencil::Pencil;
use crate::pk::PkForm;
use crate::quasi_steady::rigid_aircraft;
use crate::rational::RationalFit;
use crate::refined::RefinedRoots;
use crate::report::Reporter;
use crate::resolvers::{P2Resolver, PkResolver, PolishedResolver};
use crate::results::{Count, MethodResult, Methods, SCHEMA, SweepResult};
use crate::sensitivity::{Parameter, root_sensitivity};
use crate::spline::{AxisForces, AxisSpline, OnAxis};
use crate::state_space::{StateMatrix, state_matrix};
use crate::structure::{OperatingPoint, Reduced, Schedule, Structure};
use crate::track::{Station, Track, follow};

/// Which methods run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// p2 and the refined roots.
    P2,
    /// p-k.
    Pk,
    /// p2 alone.
    Unrefined,
    /// The refined roots alone.
    Refined,
    /// The g-method, with the refined roots.
    G,
    /// All.
    #[default]
    Both,
}

impl Method {
    fn has_p2(self) -> bool {
        matches!(self, Self::P2 | Self::Unrefined | Self::Both | Self::G)
    }

    fn has_refined(self) -> bool {
        matches!(self, Self::P2 | Self::Refined | Self::Both | Self::G)
    }

    fn has_pk(self) -> bool {
        matches!(self, Self::Pk | Self::Both)
    }
}

/// How the refined roots are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Search {
    /// Followed from speed to speed, counted at each, searched anew where the
    /// count is not met.
    #[default]
    Continuation,
    /// From the quadratic problems of every cell at every speed: twenty times
    /// the cost, an oracle for the other.
    EverySpeed,
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
    /// How $Q$ changes with the flight condition, where the samples have
    /// several parts.
    pub mixture: Option<&'a dyn Mixture>,
    /// How the refined roots are found.
    pub search: Search,
    /// Which methods run.
    pub method: Method,
    /// Form of the p-k problem.
    pub pk_form: PkForm,
    /// $Q(\mathrm ik)$ of the p-k problem; without it the samples are
    /// interpolated.
    pub pk_forces: Option<&'a dyn Aerodynamics>,
    /// Properties with respect to which crossings of the refined roots are
    /// differentiated.
    pub parameters: &'a [Parameter],
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
    /// The mixture has another number of parts than the samples.
    #[error("the mixture has {weights} parts, the aerodynamic forces have {parts}")]
    Parts {
        /// Parts of the mixture.
        weights: usize,
        /// Parts of the samples.
        parts: usize,
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

impl<'a> Sweep<'a> {
    /// All methods on samples alone: no smooth $Q(p)$, p-k by interpolation.
    pub fn new(
        structure: &'a dyn Structure,
        schedule: &'a dyn Schedule,
        table: &'a GafTable,
        fit: &'a PiecewiseQuadratic,
    ) -> Self {
        Self {
            structure,
            schedule,
            table,
            fit,
            smooth: None,
            mixture: None,
            search: Search::default(),
            method: Method::default(),
            pk_form: PkForm::default(),
            pk_forces: None,
            parameters: &[],
        }
    }
}

impl Sweep<'_> {
    /// Number of calls of [`Progress::advance`] in a whole run.
    pub fn steps(&self) -> usize {
        let runs = [
            self.method.has_p2(),
            self.method.has_pk(),
            self.method.has_refined() && self.smooth.is_some(),
            self.method == Method::G,
        ];
        runs.iter().filter(|runs| **runs).count() * self.schedule.count()
    }

    /// Solves every flight condition, follows the roots and finds crossings.
    ///
    /// # Errors
    /// See [`SweepError`]. An unstable structure is a result, not an error.
    pub fn run(&self, progress: &dyn Progress) -> Result<SweepResult, SweepError> {
        let points = self.checked_points()?;
        let semichord = self.table.semichord();
        let reduced: Vec<Reduced> =
            points.par_iter().map(|point| self.reduced(point)).collect();
        let run = Run {
            sweep: self,
            points: &points,
            reduced: &reduced,
            progress,
        };
        let mut methods = Methods::default();
        if self.method.has_p2() {
            methods.p2 = Some(run.p2()?);
        }
        if let (true, Some(smooth)) = (self.method.has_refined(), self.smooth) {
            methods.polished = Some(run.polished(smooth)?);
        }
        if self.method.has_pk() {
            methods.pk = Some(run.pk(self.pk_form)?);
        }
        if self.method == Method::G {
            methods.g = Some(run.pk(PkForm::GMethod)?);
        }
        let density = points[0].density;
        let is_constant = points
            .iter()
            .all(|point| point.density == density && point.altitude.is_none());
        Ok(SweepResult {
            schema: SCHEMA,
            density: is_constant.then_some(density),
            semichord,
            methods,
            margin: None,
            rigid_aircraft: run.rigid_aircraft()?,
        })
    }

    /// Counts the roots at a place of the sweep and holds a list against the
    /// number: the roots of the list inside the curves are `found`, a missing
    /// one raises `counted` above it, a false one lowers it.
    ///
    /// The number comes from values of $\det T$ along the curves alone; the
    /// list only makes its phase smooth. `None` without a smooth $Q(p)$ and
    /// where a curve runs through a root.
    pub fn count(&self, parameter: f64, roots: &[c64], zeros: usize) -> Option<Count> {
        let smooth = self.smooth?;
        let reduced = reduced_at(self, parameter);
        let census = Census {
            pencil: &Pencil::new(&reduced, smooth),
            claim: &Claim::new(smooth, self.fit.region()),
            roots,
            zeros,
        };
        census.tally().map(Count::from)
    }

    /// The state-space model at a place of the sweep, of a rational model of the
    /// forces; hysteretic damping is not in it.
    pub fn state_matrix(&self, fit: &RationalFit, parameter: f64) -> StateMatrix {
        let point = self.schedule.at(parameter);
        let reduced = self.reduced(&point);
        let in_p = state_matrix(&reduced, fit);
        let scaled = |matrix: &Mat<f64>, factor: f64| {
            Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
                matrix[(i, j)] * factor
            })
        };
        StateMatrix {
            airspeed: point.airspeed,
            density: point.density,
            matrix: scaled(&in_p, reduced.rate),
            mass: scaled(&reduced.mass, 1.0 / (reduced.rate * reduced.rate)),
            damping: scaled(&reduced.damping, 1.0 / reduced.rate),
            stiffness: reduced.stiffness.clone(),
            poles: fit.poles(),
        }
    }

    /// $\partial p/\partial\theta$ of a root at a place of the sweep and fixed
    /// speed, with respect to each of the sweep's parameters. The root is
    /// refined first; `None` without a smooth $Q(p)$ or a root nearby.
    pub fn root_sensitivities(&self, parameter: f64, root: c64) -> Option<Vec<c64>> {
        let smooth = self.smooth?;
        let reduced = reduced_at(self, parameter);
        let pair = crate::polish::polish(&reduced, smooth, root, None)?;
        let slope = reduced.operator_slope(pair.p, &smooth.q_and_slope(pair.p).1);
        let each = |parameter| root_sensitivity(&reduced, &slope, &pair, parameter);
        Some(self.parameters.iter().map(each).collect())
    }

    fn reduced(&self, point: &OperatingPoint) -> Reduced {
        let reduced = Reduced::new(self.structure, point, self.table.semichord());
        match self.mixture {
            Some(mixture) => reduced.mixed(mixture.weights(point)),
            None => reduced,
        }
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
        let (weights, parts) = (self.mixture.map_or(1, Mixture::parts), self.table.parts());
        if weights != parts {
            return Err(SweepError::Parts { weights, parts });
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
    count: Option<Vec<Option<Count>>>,
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

    fn rigid_aircraft(&self) -> Result<Vec<FlightMode>, SweepError> {
        let Some(flying) = self.sweep.structure.flying_body() else {
            return Ok(Vec::new());
        };
        let (fit, semichord) = (self.sweep.fit, self.sweep.table.semichord());
        let mut listed = Vec::new();
        for (point, reduced) in self.points.iter().zip(self.reduced) {
            let motions = rigid_aircraft(&flying, fit, reduced, point, semichord);
            listed.extend(motions.map_err(|source| SweepError::Numerical {
                airspeed: point.airspeed,
                source,
            })?);
        }
        Ok(listed)
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
                count: None,
            },
            &resolver,
        ))
    }

    fn polished(&self, smooth: &dyn Aerodynamics) -> Result<MethodResult, SweepError> {
        let sweep = self.sweep;
        let solved = match sweep.search {
            Search::Continuation => self.continued(smooth)?,
            Search::EverySpeed => self.search_all_cells(smooth)?,
        };
        let complete = solved.iter().map(|speed| speed.is_complete).collect();
        let count = solved.iter().map(|speed| speed.count).collect();
        let (roots, zeros) = solved.into_iter().map(|s| (s.roots, s.zeros)).unzip();
        let resolver = PolishedResolver { sweep, smooth };
        Ok(self.finish(
            &Solved {
                roots,
                zeros,
                complete: Some(complete),
                count: Some(count),
            },
            &resolver,
        ))
    }

    fn continued(&self, smooth: &dyn Aerodynamics) -> Result<Vec<RefinedRoots>, SweepError> {
        let tick = || {
            self.progress.advance();
            !self.progress.is_cancelled()
        };
        let continuation = Continuation {
            fit: self.sweep.fit,
            smooth,
            reduced: self.reduced,
        };
        continuation
            .run(&tick)
            .map_err(|(number, source)| SweepError::Numerical {
                airspeed: self.points[number].airspeed,
                source,
            })?
            .ok_or(SweepError::Cancelled)
    }

    fn search_all_cells(
        &self,
        smooth: &dyn Aerodynamics,
    ) -> Result<Vec<RefinedRoots>, SweepError> {
        let fit = self.sweep.fit;
        let claim = Claim::new(smooth, fit.region());
        self.at_every_speed(|reduced| {
            let pencil = Pencil::new(reduced, smooth);
            let search = complete::Search {
                pencil: &pencil,
                fit,
                claim: &claim,
            };
            let (list, found) = search.search_all_cells()?;
            Ok(search.finish(&list, &found))
        })
    }

    fn pk(&self, form: PkForm) -> Result<MethodResult, SweepError> {
        let sweep = self.sweep;
        let spline = AxisSpline::new(sweep.table).map_err(SweepError::Spline)?;
        let given = sweep.pk_forces.map(OnAxis);
        let forces: &dyn AxisForces = match &given {
            Some(given) => given,
            None => &spline,
        };
        let solved = self.at_every_speed(|reduced| {
            crate::pk::PkProblem {
                reduced,
                forces,
                form,
            }
            .roots(sweep.table.k())
        })?;
        let (roots, zeros) = solved.into_iter().map(|s| (s.roots, s.zeros)).unzip();
        let resolver = PkResolver {
            sweep,
            forces,
            form,
        };
        let mut result = self.finish(
            &Solved {
                roots,
                zeros,
                complete: None,
                count: None,
            },
            &resolver,
        );
        result.divergence = crate::static_sweep::divergences(sweep, self.points, forces)?;
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
        let events = events(&tracks, &stations);
        let grown = from_growth(&tracks, &events);
        let found = crossings(&tracks, &grown, resolver);
        let reporter = Reporter::new(self.sweep, self.points, self.reduced, &tracks);
        let mut result = reporter.report(&found, &events, resolver);
        result.zero_roots.clone_from(&solved.zeros);
        result.complete.clone_from(&solved.complete);
        result.count.clone_from(&solved.count);
        result
    }
}

fn crossings(tracks: &[Track], grown: &[usize], resolver: &dyn Resolver) -> Vec<Found> {
    let tangents = resolver.tangents(tracks);
    tracks
        .par_iter()
        .zip(&tangents)
        .enumerate()
        .flat_map_iter(|(number, (track, tangents))| {
            let mut brackets = sign_changes(number, track);
            if !grown.contains(&number) {
                brackets.extend(before_the_start(number, track, resolver));
            }
            brackets.extend(hidden_crossings(number, track, tangents, resolver));
            brackets
                .into_iter()
                .filter_map(|bracket| locate(&bracket, resolver))
        })
        .collect()
}

/// Mass matrix of a flight condition between the points.
pub(crate) fn reduced_at(sweep: &Sweep<'_>, parameter: f64) -> Reduced {
    let point = sweep.schedule.at(parameter);
    sweep.reduced(&point)
}

/// $Q(0)$, real.
pub(crate) fn q_at_rest(forces: &dyn AxisForces) -> Mat<c64> {
    let q = forces.q(0.0);
    Mat::from_fn(q.nrows(), q.ncols(), |i, j| c64::new(q[(i, j)].re, 0.0))
}
