//! Roots over the speeds of the case.

use super::exact::ExactForces;
use super::forces::Forces;
use super::smooth::smooth;
use super::structure::{StructureData, system};
use super::surrogate::Surrogate;
use crate::case::{self, CaseFile, Fit, Refine};
use crate::cli::Method;
use crate::failure::Failure;
use crate::report;
use crate::terminal::{Bar, Console};
use fladder_stability::{
    self as stability, Aerodynamics, DEFAULT_DAMPING_LIMIT, PartLoads, PiecewiseQuadratic,
    PkForm, REACH, Schedule, StateMatrix, Sweep, SweepError, SweepResult, System,
};
use std::time::{Duration, Instant};

/// Misfit of the rational model, as a part of the largest entry, above which p2, which
/// meets the samples, may be the better method.
const ROUGH: f64 = 1e-3;

/// Outcome of a sweep.
pub(crate) struct Swept {
    pub(crate) result: SweepResult,
    /// State-space models at the first, the middle and the last point.
    pub(crate) states: Vec<StateMatrix>,
    /// What the eigenproblems, their tracking and the crossings took.
    pub(crate) time: Duration,
}

/// Sweeps the case.
///
/// # Errors
/// A structure that does not fit the forces, an eigenvalue problem that does
/// not converge, an interruption.
pub(crate) fn run(
    file: &CaseFile,
    structure: &StructureData,
    forces: &Forces,
    method: impl Into<stability::Method>,
    console: &Console,
) -> Result<Swept, Failure> {
    let fit = fit(file, forces)?;
    console.say(fit_words(&fit));
    console.notes(fit.notes());
    let system = complete_system(file, structure, forces, &fit, console)?;
    let (rational, notes) = smooth(&forces.table).map_err(|error| unfit(file, &error))?;
    let exact = forces.transfer.as_ref().map(|transfer| ExactForces {
        transfer,
        flows: &forces.flows,
        slopes: &rational,
    });
    let surrogate = exact
        .as_ref()
        .and_then(|exact| Surrogate::new(exact, &forces.table));
    let smooth = match (refine(file, forces)?, &exact, &surrogate) {
        (Refine::Exact, Some(exact), _) => exact as &dyn Aerodynamics,
        (_, _, Some(surrogate)) => {
            console.say(format!(
                "  roots are refined on an interpolant of the forces, misfit {:.0e}",
                surrogate.misfit
            ));
            surrogate
        }
        _ => {
            console.notes(&notes);
            console.say(format!(
                "  roots are refined on a rational model of the samples, {} poles, misfit {:.0e}",
                rational.poles().len(),
                rational.residual()
            ));
            if rational.residual() > ROUGH {
                console.say(
                    "  warning: the samples are too few or too rough for the refined roots to be \
                     better than p2: compare the two, and give more values of k",
                );
            }
            &rational
        }
    };
    let parameters = system.modal_parameters();
    let sweep = Sweep {
        smooth: Some(smooth),
        method: method.into(),
        mixture: forces.mixture.as_deref(),
        pk_form: pk_form(file),
        parameters: &parameters,
        ..Sweep::new(&system, &forces.conditions, &forces.table, &fit)
    };
    let bar = Bar::new(console.is_quiet());
    bar.begin("sweeping speeds", sweep.steps() as u64);
    let start = Instant::now();
    let mut result = sweep.run(&bar).map_err(|error| not_swept(file, &error))?;
    let time = start.elapsed();
    bar.clear();
    let wanted = file
        .case
        .stability
        .as_ref()
        .and_then(|swept| swept.margin_speed);
    result.margin = wanted.and_then(|speed| Some(report::best(&result.methods)?.margin(speed)));
    let last = forces.conditions.count().saturating_sub(1);
    let mut chosen = vec![0, last / 2, last];
    chosen.dedup();
    let states = chosen
        .into_iter()
        .map(|number| sweep.state_matrix(&rational, number as f64))
        .collect();
    Ok(Swept {
        result,
        states,
        time,
    })
}

/// The piecewise quadratic of the samples.
///
/// # Errors
/// Samples that make none.
pub(crate) fn fit(file: &CaseFile, forces: &Forces) -> Result<PiecewiseQuadratic, Failure> {
    let swept = file.case.stability.as_ref();
    let table = &forces.table;
    let made = match swept.map(|swept| swept.fit).unwrap_or_default() {
        Fit::Centred => PiecewiseQuadratic::centred(table, DEFAULT_DAMPING_LIMIT),
        Fit::Literal => PiecewiseQuadratic::literal(table, DEFAULT_DAMPING_LIMIT),
        Fit::Laplace if table.g().len() > 1 => PiecewiseQuadratic::laplace(table),
        Fit::Laplace => {
            return Err(Failure::input(
                "`stability.fit = \"laplace\"` with forces at g = 0 alone",
                file.places.of("stability.fit"),
                "rectangles off the axis need samples off the axis",
                "give more values of gaf.g, for example [-0.2, -0.1, -0.04, 0.0, 0.04, 0.1, 0.2]",
            ));
        }
    };
    made.map_err(|error| unfit(file, &error.to_string()))
}

/// What the fit met, in words.
fn fit_words(fit: &PiecewiseQuadratic) -> String {
    let report = fit.report();
    format!(
        "  p2: {} cells, {} equations, rank {} of {}, misfit {:.0e}; largest jump between cells {:.0e} \
         of max |Q| at g = 0, {:.0e} at g = -0.05",
        fit.cells().len(),
        report.equations,
        report.rank,
        report.unknowns,
        report.residual,
        fit.jump_at(0.0),
        fit.jump_at(-REACH)
    )
}

fn pk_form(file: &CaseFile) -> PkForm {
    let swept = file.case.stability.as_ref();
    match swept.map(|swept| swept.pk).unwrap_or_default() {
        case::PkDamping::Complex => PkForm::Complex,
        case::PkDamping::Real => PkForm::RealMatrices,
    }
}

/// On which forces roots are to be refined.
fn refine(file: &CaseFile, forces: &Forces) -> Result<Refine, Failure> {
    let wanted = file
        .case
        .stability
        .as_ref()
        .map(|swept| swept.refine)
        .unwrap_or_default();
    if wanted == Refine::Exact && forces.transfer.is_none() {
        return Err(Failure::input(
            "`stability.refine = \"exact\"` with forces from a file",
            file.places.of("stability.refine"),
            "a file holds samples of Q, not Q itself",
            "leave the key out",
        ));
    }
    Ok(wanted)
}

fn complete_system(
    file: &CaseFile,
    structure: &StructureData,
    forces: &Forces,
    fit: &PiecewiseQuadratic,
    console: &Console,
) -> Result<System, Failure> {
    let names = forces.table.modes();
    let system = system(file, structure, names)?;
    let Some(flight) = &file.case.flight else {
        return Ok(system);
    };
    let heave = names
        .iter()
        .position(|name| name == stability::RIGID_NAMES[2]);
    let order = names.len();
    let loads: Vec<PartLoads> = (0..)
        .zip(&forces.steady)
        .map(|(part, steady)| PartLoads {
            heave_slope: heave.map_or(0.0, |z| fit.slope_at_origin(z, part * order + z)),
            steady: steady.clone(),
        })
        .collect();
    let is_elastic = |name: &String| !stability::RIGID_NAMES.contains(&name.as_str());
    let is_unknown = |mode: &usize| forces.steady.iter().any(|part| part[*mode].is_none());
    let unknown = (0..order)
        .filter(|mode| is_elastic(&names[*mode]))
        .filter(is_unknown)
        .count();
    if flight.speed_derivative && unknown > 0 {
        console.say(format!(
            "  note: the steady force of {unknown} elastic modes is unknown; their rows of the \
             speed derivative are left out"
        ));
    }
    system
        .with_flight_loads(
            stability_flight(flight),
            forces.table.semichord(),
            loads,
            forces.mixture.clone(),
        )
        .map_err(|error| unfit(file, &error.to_string()))
}

fn stability_flight(flight: &case::Flight) -> stability::Flight {
    stability::Flight {
        gravity: flight.gravity,
        climb: flight.climb_deg.to_radians(),
        parasite_drag_area: flight.parasite_drag_area,
        induced_drag_factor: flight.induced_drag_factor,
        thrust: match flight.thrust {
            case::Thrust::ConstantPower => stability::Thrust::ConstantPower,
            case::Thrust::ConstantThrust => stability::Thrust::ConstantThrust,
            case::Thrust::None => stability::Thrust::None,
        },
        speed_derivative: flight.speed_derivative,
    }
}

fn unfit(file: &CaseFile, what: &str) -> Failure {
    Failure::input(
        what,
        file.places.of("gaf"),
        "roots are found from forces on a grid that contains the imaginary axis",
        "give more reduced frequencies, evenly spread over those of interest",
    )
}

fn not_swept(file: &CaseFile, error: &SweepError) -> Failure {
    let place = file.places.of("stability");
    match error {
        SweepError::Cancelled => Failure::interrupted("sweeping speeds"),
        SweepError::Numerical { .. } | SweepError::Spline(_) => Failure::numerical(
            error.to_string(),
            place,
            "the roots at this speed are unknown",
            "look at mass and stiffness for entries of very different size",
        ),
        _ => Failure::input(
            error.to_string(),
            place,
            "there is no eigenvalue problem to solve",
            "correct [stability], [structure] or the forces",
        ),
    }
}

impl From<Method> for stability::Method {
    fn from(method: Method) -> Self {
        match method {
            Method::P2 => Self::P2,
            Method::Pk => Self::Pk,
            Method::G => Self::G,
            Method::Both => Self::Both,
        }
    }
}
