//! Structural matrices put together from modes, mass properties and flight.

use std::sync::Arc;

use faer::{Mat, c64};

use crate::flight::{Flight, TrimAerodynamics};
use crate::flight_modes::FlyingBody;
use crate::mixture::Mixture;
use crate::rigid::{RigidBody, RigidModes};
use crate::sensitivity::Parameter;
use crate::structure::{FlightPath, OperatingPoint, StructuralMatrices, Structure};

/// Given mass matrices may differ from the rigid body by this fraction.
const RIGID_MASS_TOLERANCE: f64 = 1e-3;

/// Structural damping of the elastic modes.
#[derive(Clone, Debug, PartialEq)]
pub enum DampingModel {
    /// $C_{ii} = g_{s,i}\,\omega_i$: holds for every root.
    Viscous(Vec<f64>),
    /// $K_{ii}(1 + \mathrm ig_{s,i})$ for oscillations, nothing for real roots.
    Hysteretic(Vec<f64>),
}

/// Why matrices make no structure.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SystemError {
    /// A matrix is not square of the order of the modes.
    #[error("{name} has {rows} rows and {columns} columns, there are {modes} modes")]
    Shape {
        /// Which matrix.
        name: &'static str,
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
        /// Number of modes.
        modes: usize,
    },
    /// An entry is not finite.
    #[error("{name} is not finite in row {row}, column {column}")]
    NotFinite {
        /// Which matrix.
        name: &'static str,
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
    },
    /// A generalised mass is not positive.
    #[error("the generalised mass of mode {mode} is {mass}, it must be positive")]
    Mass {
        /// Name of the mode.
        mode: String,
        /// Diagonal entry.
        mass: f64,
    },
    /// A list has another length than the modes it belongs to.
    #[error("{name}: {found} values where {wanted} are wanted")]
    Count {
        /// Which list.
        name: &'static str,
        /// Values found.
        found: usize,
        /// Values wanted.
        wanted: usize,
    },
    /// The given mass matrix disagrees with the rigid body.
    #[error(
        "mass of ({row}, {column}) is {given}, the rigid body says {wanted}; they may differ by {limit}"
    )]
    RigidMass {
        /// Name of the row's mode.
        row: String,
        /// Name of the column's mode.
        column: String,
        /// Entry of the given matrix.
        given: f64,
        /// Entry of the rigid body.
        wanted: f64,
        /// Largest difference.
        limit: f64,
    },
    /// Flight terms without a rigid body.
    #[error("flight terms need the mass properties of the rigid body")]
    FlightWithoutBody,
}

/// A structure with constant $M$, $C$, $K$, to which rigid-body and flight
/// terms are added at each flight condition.
#[derive(Clone, Debug)]
pub struct System {
    modes: Vec<String>,
    mass: Mat<f64>,
    damping: Mat<f64>,
    stiffness: Mat<f64>,
    hysteretic: Option<Vec<f64>>,
    /// Coefficients of the viscous model, which are in `damping`.
    viscous: Vec<f64>,
    rigid_modes: RigidModes,
    body: Option<RigidBody>,
    flight: Option<FlightSetting>,
}

#[derive(Clone, Debug)]
struct FlightSetting {
    flight: Flight,
    semichord: f64,
    /// One for each part of $Q$.
    loads: Vec<PartLoads>,
    mixture: Option<Arc<dyn Mixture>>,
}

/// What the aerodynamics of one part of $Q$ tell of the trimmed state.
#[derive(Clone, Debug, PartialEq)]
pub struct PartLoads {
    /// $\mathrm dQ_{zz}/\mathrm dp$ at $p = 0$ of the mass-normalised mode
    /// `rigid:z`; 0 where there is none.
    pub heave_slope: f64,
    /// Steady force of every mode per unit dynamic pressure, where known.
    pub steady: Vec<Option<f64>>,
}

impl FlightSetting {
    /// Slope and elastic forces at a flight condition; a force that one part
    /// lacks is left out.
    fn loads_at(&self, point: &OperatingPoint, rigid: &[usize]) -> (f64, Vec<(usize, f64)>) {
        let weights = self
            .mixture
            .as_ref()
            .map_or_else(|| vec![1.0], |mixture| mixture.weights(point));
        let parts = || self.loads.iter().zip(&weights);
        let slope = parts()
            .map(|(part, weight)| part.heave_slope * weight)
            .sum();
        let force = |mode: usize| -> Option<f64> {
            parts()
                .map(|(part, weight)| Some(part.steady[mode]? * weight))
                .sum()
        };
        let modes = self.loads.first().map_or(0, |part| part.steady.len());
        let elastic = (0..modes)
            .filter(|mode| !rigid.contains(mode))
            .filter_map(|mode| Some((mode, force(mode)?)))
            .collect();
        (slope, elastic)
    }
}

impl System {
    /// A structure given by its generalised matrices.
    ///
    /// # Errors
    /// Wrong shapes, entries that are not finite, masses that are not
    /// positive.
    pub fn from_matrices(
        modes: Vec<String>,
        mass: Mat<f64>,
        damping: Mat<f64>,
        stiffness: Mat<f64>,
    ) -> Result<Self, SystemError> {
        for (name, matrix) in [
            ("mass", &mass),
            ("damping", &damping),
            ("stiffness", &stiffness),
        ] {
            check_matrix(name, matrix, modes.len())?;
        }
        if let Some(mode) = (0..modes.len()).find(|&mode| mass[(mode, mode)] <= 0.0) {
            let mass = mass[(mode, mode)];
            return Err(SystemError::Mass {
                mode: modes[mode].clone(),
                mass,
            });
        }
        let rigid_modes = RigidModes::among(&modes);
        Ok(Self {
            viscous: vec![0.0; modes.len()],
            modes,
            mass,
            damping,
            stiffness,
            hysteretic: None,
            rigid_modes,
            body: None,
            flight: None,
        })
    }

    /// Mass-normalised modes: the rigid ones named `rigid:…` (frequency 0),
    /// the others with their circular frequencies in rad/s.
    ///
    /// # Errors
    /// Lists of the wrong length and values that are not finite.
    pub fn from_frequencies(
        modes: Vec<String>,
        frequencies: &[f64],
        damping: DampingModel,
    ) -> Result<Self, SystemError> {
        let order = modes.len();
        if frequencies.len() != order {
            let found = frequencies.len();
            return Err(SystemError::Count {
                name: "frequencies",
                found,
                wanted: order,
            });
        }
        let diagonal = |values: &dyn Fn(usize) -> f64| {
            Mat::from_fn(order, order, |i, j| if i == j { values(i) } else { 0.0 })
        };
        Self::from_matrices(
            modes,
            diagonal(&|_| 1.0),
            diagonal(&|_| 0.0),
            diagonal(&|mode| frequencies[mode] * frequencies[mode]),
        )?
        .with_structural_damping(damping)
    }

    /// Adds structural damping, one coefficient a mode (0 for rigid ones).
    ///
    /// The frequency of the viscous model is $\omega_i = \sqrt{K_{ii}/M_{ii}}$
    /// and its entry $g_{s,i}\,\omega_iM_{ii}$.
    ///
    /// # Errors
    /// A list of the wrong length.
    pub fn with_structural_damping(
        mut self,
        damping: DampingModel,
    ) -> Result<Self, SystemError> {
        let (DampingModel::Viscous(values) | DampingModel::Hysteretic(values)) = &damping;
        if values.len() != self.modes.len() {
            return Err(SystemError::Count {
                name: "structural damping",
                found: values.len(),
                wanted: self.modes.len(),
            });
        }
        match damping {
            DampingModel::Viscous(values) => {
                self.viscous.clone_from(&values);
                for (mode, value) in values.into_iter().enumerate() {
                    let product = self.stiffness[(mode, mode)] * self.mass[(mode, mode)];
                    self.damping[(mode, mode)] += value * product.max(0.0).sqrt();
                }
            }
            DampingModel::Hysteretic(values) => {
                let any = values.iter().any(|&value| value != 0.0);
                self.hysteretic = any.then_some(values);
            }
        }
        Ok(self)
    }

    /// Makes the rigid modes those of a body: writes its mass matrix and adds
    /// the rotation-rate terms at every flight condition.
    #[must_use]
    pub fn with_rigid_body(mut self, body: RigidBody) -> Self {
        let block = body.mass_matrix();
        for (i, row) in block.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                if let (Some(row), Some(column)) =
                    (self.rigid_modes.0[i], self.rigid_modes.0[j])
                {
                    self.mass[(row, column)] = *value;
                }
            }
        }
        self.body = Some(body);
        self
    }

    /// As [`with_rigid_body`](Self::with_rigid_body), but keeps the given mass
    /// matrix and compares its diagonal and its φψ term with the body.
    ///
    /// # Errors
    /// [`SystemError::RigidMass`] where they differ by more than 1e-3.
    pub fn with_rigid_body_checked(mut self, body: RigidBody) -> Result<Self, SystemError> {
        let block = body.mass_matrix();
        let places = (0..6).map(|i| (i, i)).chain([(3, 5), (5, 3)]);
        for (i, j) in places {
            let (Some(row), Some(column)) = (self.rigid_modes.0[i], self.rigid_modes.0[j])
            else {
                continue;
            };
            let (given, wanted) = (self.mass[(row, column)], block[i][j]);
            if (given - wanted).abs() > RIGID_MASS_TOLERANCE {
                return Err(SystemError::RigidMass {
                    row: self.modes[row].clone(),
                    column: self.modes[column].clone(),
                    given,
                    wanted,
                    limit: RIGID_MASS_TOLERANCE,
                });
            }
        }
        self.body = Some(body);
        Ok(self)
    }

    /// Adds gravity, drag, thrust and speed derivatives.
    ///
    /// `heave_slope` is $\mathrm dQ_{zz}/\mathrm dp$ at $p = 0$ of the
    /// mass-normalised mode `rigid:z` (0 where there is none), `steady` the
    /// steady force of every mode per unit dynamic pressure; unknown ones are
    /// left out of the speed derivative.
    ///
    /// # Errors
    /// No rigid body, or a list of the wrong length.
    pub fn with_flight(
        self,
        flight: Flight,
        semichord: f64,
        heave_slope: f64,
        steady: &[Option<f64>],
    ) -> Result<Self, SystemError> {
        let loads = vec![PartLoads {
            heave_slope,
            steady: steady.to_vec(),
        }];
        self.with_flight_loads(flight, semichord, loads, None)
    }

    /// As [`with_flight`](Self::with_flight), with loads that change with the
    /// flight condition as $Q$ does.
    ///
    /// # Errors
    /// No rigid body, or a list of the wrong length.
    pub fn with_flight_loads(
        mut self,
        flight: Flight,
        semichord: f64,
        loads: Vec<PartLoads>,
        mixture: Option<Arc<dyn Mixture>>,
    ) -> Result<Self, SystemError> {
        if self.body.is_none() {
            return Err(SystemError::FlightWithoutBody);
        }
        let counts = loads
            .iter()
            .map(|part| ("steady forces", part.steady.len(), self.modes.len()))
            .chain([(
                "parts of the aerodynamic forces",
                loads.len(),
                mixture.as_ref().map_or(1, |mixture| mixture.parts()),
            )]);
        for (name, found, wanted) in counts {
            if found != wanted {
                return Err(SystemError::Count {
                    name,
                    found,
                    wanted,
                });
            }
        }
        self.flight = Some(FlightSetting {
            flight,
            semichord,
            loads,
            mixture,
        });
        Ok(self)
    }

    /// Number of modes.
    pub fn order(&self) -> usize {
        self.modes.len()
    }

    /// Frequency (Hz, at constant mass), structural damping and generalised
    /// mass (at constant stiffness) of every mode that has a stiffness and is
    /// not rigid, as properties for sensitivities.
    pub fn modal_parameters(&self) -> Vec<Parameter> {
        let rigid = self.rigid_modes.numbers();
        let is_elastic =
            |mode: &usize| !rigid.contains(mode) && self.stiffness[(*mode, *mode)] > 0.0;
        (0..self.order())
            .filter(is_elastic)
            .flat_map(|mode| self.parameters_of(mode))
            .collect()
    }

    fn parameters_of(&self, mode: usize) -> [Parameter; 3] {
        let (mass, stiffness) = (self.mass[(mode, mode)], self.stiffness[(mode, mode)]);
        let rate = (stiffness / mass).sqrt();
        let named = |what: &str, unit| {
            Parameter::new(
                format!("{what} of {}", self.modes[mode]),
                unit,
                self.order(),
            )
        };
        let factor = self.hysteretic.as_ref().map_or(0.0, |list| list[mode]);
        let place = (mode, mode);
        let mut frequency = named("frequency", "Hz");
        frequency.value = Some(rate / std::f64::consts::TAU);
        let per_hertz = std::f64::consts::TAU;
        frequency.stiffness[place] = c64::new(1.0, factor) * (2.0 * rate * mass * per_hertz);
        frequency.damping[place] = self.viscous[mode] * mass * per_hertz;
        let mut damping = named("damping", "1");
        damping.value = Some(self.viscous[mode] + factor);
        if self.hysteretic.is_some() {
            damping.stiffness[place] = c64::new(0.0, stiffness);
        } else {
            damping.damping[place] = rate * mass;
        }
        let mut inertia = named("mass", "1");
        inertia.value = Some(mass);
        inertia.mass[place] = 1.0;
        // C_ii = g sqrt(K M).
        inertia.damping[place] = 0.5 * self.viscous[mode] * rate;
        [frequency, damping, inertia]
    }
}

impl Structure for System {
    fn modes(&self) -> &[String] {
        &self.modes
    }

    fn rigid_modes(&self) -> Vec<usize> {
        self.rigid_modes.numbers()
    }

    fn flying_body(&self) -> Option<FlyingBody> {
        self.body.map(|body| FlyingBody {
            modes: self.rigid_modes,
            body,
            climb: self
                .flight
                .as_ref()
                .map_or(0.0, |setting| setting.flight.climb),
        })
    }

    fn at(&self, point: &OperatingPoint) -> StructuralMatrices {
        let (mut damping, mut stiffness) = (self.damping.clone(), self.stiffness.clone());
        let mut flight_path = None;
        if let Some(body) = &self.body {
            self.rigid_modes
                .add(&body.rotation_rate(point), &mut damping);
            if let Some(setting) = &self.flight {
                let flight = &setting.flight;
                let attitude = point.alpha + flight.climb;
                self.rigid_modes
                    .add(&body.gravity(flight.gravity, attitude), &mut stiffness);
                let rigid = self.rigid_modes.numbers();
                let (heave_slope, elastic) = setting.loads_at(point, &rigid);
                let loads = TrimAerodynamics {
                    semichord: setting.semichord,
                    heave_slope,
                    elastic: &elastic,
                };
                flight.add_damping(body, &self.rigid_modes, &loads, point, &mut damping);
                flight_path = self.rigid_modes.0[0].map(|x| FlightPath {
                    x,
                    z: self.rigid_modes.0[2],
                    tan_alpha: point.alpha.tan(),
                });
            }
        }
        StructuralMatrices {
            mass: self.mass.clone(),
            damping,
            stiffness,
            hysteretic: self.hysteretic.clone(),
            flight_path,
        }
    }
}

fn check_matrix(
    name: &'static str,
    matrix: &Mat<f64>,
    modes: usize,
) -> Result<(), SystemError> {
    let (rows, columns) = (matrix.nrows(), matrix.ncols());
    if rows != modes || columns != modes {
        return Err(SystemError::Shape {
            name,
            rows,
            columns,
            modes,
        });
    }
    for column in 0..columns {
        for row in 0..rows {
            if !matrix[(row, column)].is_finite() {
                return Err(SystemError::NotFinite {
                    name,
                    row: row + 1,
                    column: column + 1,
                });
            }
        }
    }
    Ok(())
}
