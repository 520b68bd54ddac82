//! Level flight: what is balanced at every point of a sweep.

use super::aircraft::Aircraft;
use super::conditions::Conditions;
use super::own_forces::{StoredForces, not_evaluated};
use super::structure::StructureData;
use super::trim::{self, Loads, PlaneLoads, Trim};
use crate::case::{self, CaseFile, OneOrMany};
use crate::failure::Failure;
use crate::figures::three_digits;
use faer::{Mat, c64};
use fladder_bem::Flow;
use fladder_modal::RigidBody;
use fladder_stability::{GafTable, PiecewiseQuadratic, RIGID_NAMES};

/// The part of the case that asks for a trim, with the body that flies.
fn wanted<'a>(
    file: &'a CaseFile,
    structure: &'a StructureData,
) -> Option<(&'a case::Flight, &'a RigidBody)> {
    let flight = file.case.flight.as_ref()?;
    let is_level = flight.trim == case::Trim::Level;
    structure
        .body
        .as_ref()
        .filter(|_| is_level)
        .map(|body| (flight, body))
}

fn weight(flight: &case::Flight, body: &RigidBody) -> f64 {
    body.mass * flight.gravity * flight.climb_deg.to_radians().cos()
}

/// From forces computed here: lift and moment at every incidence.
///
/// # Errors
/// No value of $Q(0)$; rigid modes or controls that are missing.
pub(super) fn own(
    file: &CaseFile,
    aircraft: &Aircraft,
    forces: &StoredForces,
) -> Result<Option<Trim>, Failure> {
    let Some((flight, body)) = wanted(file, &aircraft.structure) else {
        return Ok(None);
    };
    let place = |name: &str| aircraft.modes.iter().position(|mode| mode.name == name);
    let rows = Rows {
        x: place(RIGID_NAMES[0]),
        z: place(RIGID_NAMES[2]),
        theta: place(RIGID_NAMES[4]),
        mass: body.mass.sqrt(),
        inertia: body.inertia.yy.sqrt(),
    };
    let nodes = trim::nodes();
    let flows = nodes.values().map(|alpha| Flow {
        alpha,
        beta: forces.beta_deg.to_radians(),
    });
    let steady = flows.map(|flow| {
        let all = forces
            .solution
            .steady
            .generalised_forces_at(flow.stream().into());
        rows.loads(&|row| all[row])
    });
    let names = flight.trim_control.iter().flat_map(OneOrMany::as_slice);
    let controls: Vec<usize> = names.filter_map(|name| place(name)).collect();
    let control = if controls.is_empty() {
        None
    } else {
        let each: Vec<Mat<c64>> = forces
            .solution
            .transfer
            .q_at_each(c64::new(0.0, 0.0), &flows)
            .map_err(|error| not_evaluated(&error))?;
        let sum = |q: &Mat<c64>, row: usize| controls.iter().map(|&j| q[(row, j)].re).sum();
        let loads = each.iter().map(|q| rows.loads(&|row| sum(q, row)));
        Some(loads.collect())
    };
    Ok(Some(Trim {
        weight: weight(flight, body),
        loads: Loads::Everywhere {
            nodes,
            steady: steady.to_vec(),
            control,
        },
    }))
}

/// Rows of the mass-normalised rigid modes.
struct Rows {
    x: Option<usize>,
    z: Option<usize>,
    theta: Option<usize>,
    mass: f64,
    inertia: f64,
}

impl Rows {
    /// Loads in newton and metres per unit dynamic pressure.
    fn loads(&self, force: &dyn Fn(usize) -> f64) -> PlaneLoads {
        let scaled = |row: Option<usize>, scale: f64| row.map_or(0.0, |row| force(row) * scale);
        PlaneLoads {
            x: scaled(self.x, self.mass),
            z: scaled(self.z, self.mass),
            moment: scaled(self.theta, self.inertia),
        }
    }
}

/// From forces of a file: lift and its slope at the incidence of the file, by
/// its steady forces and the slope of $Q_{zz}$.
///
/// # Errors
/// The file does not say what lift there is; a control, whose effect is not
/// in the steady forces.
pub(super) fn given(
    file: &CaseFile,
    structure: &StructureData,
    tables: &[GafTable],
    alpha: f64,
) -> Result<Option<Trim>, Failure> {
    let Some((flight, body)) = wanted(file, structure) else {
        return Ok(None);
    };
    if flight.trim_control.is_some() {
        return Err(Failure::input(
            "`flight.trim_control` with forces from a file",
            file.places.of("flight.trim_control"),
            "a file holds forces at one incidence, from which lift is continued, not moments",
            "remove the key",
        ));
    }
    let table = &tables[0];
    let place = |name: &str| table.modes().iter().position(|mode| mode == name);
    let steady = |name: &str| place(name).and_then(|mode| table.steady()[mode]);
    let (Some(z), Some(force)) = (place(RIGID_NAMES[2]), steady(RIGID_NAMES[2])) else {
        return Err(Failure::input(
            "`flight.trim = \"level\"`, but the steady force of rigid:z is unknown",
            file.places.of("gaf.file"),
            "the incidence that carries the weight follows from the lift of the file",
            "give `steady` in the file, or trim = \"none\" with the incidence of one speed",
        ));
    };
    let fit = PiecewiseQuadratic::of(table).map_err(|error| {
        Failure::numerical(
            error.to_string(),
            file.places.of("gaf.file"),
            "the slope of the lift is unknown",
            "look at the samples near k = 0",
        )
    })?;
    let normal = steady(RIGID_NAMES[0]).unwrap_or(0.0);
    let (sine, cosine) = alpha.sin_cos();
    let lift = body.mass.sqrt() * (force * cosine - normal * sine);
    let slope = -body.mass * table.semichord() * fit.slope_at_origin(z, z);
    if slope <= 0.0 {
        return Err(Failure::input(
            format!("the lift of the file has the slope {slope} m² per radian"),
            file.places.of("gaf.file"),
            "no incidence carries the weight when lift does not grow with it",
            "check sign and frame of rigid:z in the file",
        ));
    }
    Ok(Some(Trim {
        weight: weight(flight, body),
        loads: Loads::Line { alpha, lift, slope },
    }))
}

/// The incidences found, in words.
///
/// # Errors
/// A point of the sweep at which no incidence carries the weight.
pub(super) fn notes(file: &CaseFile, conditions: &Conditions) -> Result<Vec<String>, Failure> {
    let Some(trim) = conditions.trim() else {
        return Ok(Vec::new());
    };
    let mut found = Vec::new();
    for point in conditions.points() {
        let balance = trim.at(point.dynamic_pressure()).ok_or_else(|| {
            Failure::input(
                format!(
                    "no incidence within 25 degrees carries the weight of {:.1} N at {} m/s",
                    trim.weight,
                    three_digits(point.airspeed)
                ),
                file.places.of("flight.trim"),
                "there is no level flight to linearise about",
                "begin the sweep at a higher speed, or check mass and mesh.scale",
            )
        })?;
        found.push((point.airspeed, balance));
    }
    let (Some(first), Some(last)) = (found.first(), found.last()) else {
        return Ok(Vec::new());
    };
    let words = |(speed, balance): &(f64, trim::Balance)| {
        let control = balance.deflection.map_or_else(String::new, |angle| {
            format!(", control {:+.2}°", angle.to_degrees())
        });
        format!(
            "α = {:.2}°{control} at {} m/s",
            balance.alpha.to_degrees(),
            three_digits(*speed)
        )
    };
    let mut notes = vec![format!("level flight: {}, {}", words(first), words(last))];
    let is_stalled = |(_, balance): &&(f64, trim::Balance)| balance.alpha.abs() > trim::STALL;
    if let Some(last) = found.iter().rfind(is_stalled) {
        notes.push(format!(
            "warning: up to {} m/s the incidence is above 12°, where the flow of a real wing \
             separates",
            three_digits(last.0)
        ));
    }
    match &trim.loads {
        Loads::Line { .. } => notes.push(
            "the forces stay those of the file's incidence; attitude and weight follow the trim"
                .to_owned(),
        ),
        Loads::Everywhere { control: None, .. } => notes.push(
            "the pitching moment is not balanced: flight.trim_control names no control".to_owned(),
        ),
        Loads::Everywhere { .. } => {}
    }
    Ok(notes)
}
