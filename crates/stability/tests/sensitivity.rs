//! Derivatives of roots and flutter speeds against differences.

#![allow(
    clippy::unwrap_used,
    reason = "a fault in the reference data must stop the test"
)]

mod common;

use common::{SectionForces, Wing, range, section, speeds};
use faer::{Mat, c64};
use fladder_stability::{
    DampingModel, FromFunction, Method, MethodResult, OperatingPoint, Parameter,
    PiecewiseQuadratic, RationalFit, Schedule, StructuralMatrices, Structure, Sweep, System,
};

/// A wing with $M + \theta M_\theta$ and its like.
struct Changed<'a> {
    wing: &'a Wing,
    parameter: &'a Parameter,
    amount: f64,
}

impl Structure for Changed<'_> {
    fn modes(&self) -> &[String] {
        self.wing.modes()
    }

    fn rigid_modes(&self) -> Vec<usize> {
        self.wing.rigid_modes()
    }

    fn at(&self, point: &OperatingPoint) -> StructuralMatrices {
        let mut matrices = self.wing.at(point);
        for i in 0..26 {
            for j in 0..26 {
                matrices.mass[(i, j)] += self.amount * self.parameter.mass[(i, j)];
                matrices.damping[(i, j)] += self.amount * self.parameter.damping[(i, j)];
                matrices.stiffness[(i, j)] += self.amount * self.parameter.stiffness[(i, j)].re;
            }
        }
        matrices
    }
}

/// Frequency, damping and mass of a mode, a point mass and a hinge.
fn wing_parameters(wing: &Wing) -> Vec<(Parameter, f64)> {
    let omega = common::numbers(&wing.file["omega_elastic"]);
    let mut found = Vec::new();
    for mode in [0, 1, 4] {
        let place = (6 + mode, 6 + mode);
        let mut frequency = Parameter::new(format!("frequency of {mode}"), "Hz", 26);
        frequency.value = Some(omega[mode] / std::f64::consts::TAU);
        frequency.stiffness[place] = c64::new(2.0 * omega[mode] * std::f64::consts::TAU, 0.0);
        found.push((frequency, 1e-3));
        let mut damping = Parameter::new("damping", "1", 26);
        damping.damping[place] = omega[mode];
        found.push((damping, 1e-4));
        let mut mass = Parameter::new("mass", "1", 26);
        mass.mass[place] = 1.0;
        found.push((mass, 1e-4));
    }
    // Any displacement and rotation of a point will do.
    let displacement: Vec<[f64; 3]> = (0..26)
        .map(|i| {
            let t = f64::from(i);
            [
                0.05 * (1.3 * t).cos(),
                0.02 * (0.7 * t).sin(),
                0.2 * (2.1 * t).cos(),
            ]
        })
        .collect();
    found.push((Parameter::point_mass("tip mass", &displacement), 1e-4));
    let rotation: Vec<f64> = (0..26)
        .map(|i| {
            if i < 6 {
                0.0
            } else {
                (1.7 * f64::from(i)).sin()
            }
        })
        .collect();
    found.push((Parameter::hinge("hinge", &rotation), 1e-2));
    found
}

fn polished(
    structure: &dyn Structure,
    points: &dyn Schedule,
    wing: &Wing,
    smooth: &RationalFit,
    parameters: &[Parameter],
) -> MethodResult {
    let table = wing.table(&[0.0]);
    let fit = PiecewiseQuadratic::of(&table).unwrap();
    Sweep {
        smooth: Some(smooth),
        method: Method::P2,
        parameters,
        ..Sweep::new(structure, points, &table, &fit)
    }
    .run(&())
    .unwrap()
    .methods
    .polished
    .unwrap()
}

/// Four flutter points of the free wing, eleven properties: speed and
/// frequency against central differences.
#[test]
fn flutter_sensitivities_agree_with_differences() {
    let wing = Wing::read();
    let smooth = RationalFit::new(&wing.table(&[0.0])).unwrap();
    let points = speeds(range(30.0, 58.0, 15), wing.density());
    let with_steps = wing_parameters(&wing);
    let parameters: Vec<Parameter> = with_steps
        .iter()
        .map(|(parameter, _)| parameter.clone())
        .collect();
    let base = polished(&wing, &points, &wing, &smooth, &parameters);
    assert_eq!(base.flutter.len(), 4);
    let mut worst: f64 = 0.0;
    let mut n_frequencies = 0;
    for (index, (parameter, step)) in with_steps.iter().enumerate() {
        let moved = |amount: f64| {
            let changed = Changed {
                wing: &wing,
                parameter,
                amount,
            };
            polished(&changed, &points, &wing, &smooth, &[]).flutter
        };
        let (ahead, behind) = (moved(*step), moved(-*step));
        for (number, crossing) in base.flutter.iter().enumerate() {
            let ours = &crossing.sensitivities.as_ref().unwrap()[index];
            let difference = |value: &dyn Fn(usize) -> [f64; 2]| {
                let [high, low] = value(number);
                (high - low) / (2.0 * step)
            };
            let speed = difference(&|n| [ahead[n].speed, behind[n].speed]);
            let hertz = difference(&|n| [ahead[n].frequency_hz, behind[n].frequency_hz]);
            // Differences carry their own error of the step squared.
            let scale = |value: f64| 1e-3 + value.abs();
            let miss = ((ours.speed - speed).abs() / scale(speed))
                .max((ours.frequency_hz - hertz).abs() / scale(hertz));
            worst = worst.max(miss);
            println!(
                "{:14} flutter {number}: {:+.5} m/s per {}, difference {speed:+.5}; {:+.5} Hz, difference {hertz:+.5}",
                parameter.name, ours.speed, parameter.unit, ours.frequency_hz
            );
            assert!(miss < 1e-4, "{miss:.1e}");
            // What the tables say of a frequency is the same derivative, per cent of it.
            let Some(mode) = parameter.name.strip_prefix("frequency of ") else {
                continue;
            };
            let owed = crossing.owed_to_frequencies();
            let (_, shown) = owed.iter().find(|(name, _)| *name == mode).unwrap();
            assert!((shown - 0.01 * ours.value.unwrap() * speed).abs() < 1e-4 * scale(*shown));
            assert!(owed.is_sorted_by(|a, b| a.1.abs() >= b.1.abs()));
            n_frequencies += 1;
        }
    }
    assert!(n_frequencies > 0);
    println!("largest relative difference {worst:.1e}");
}

/// Every root of the region at one speed, eleven properties, against central
/// differences.
#[test]
fn root_sensitivities_agree_with_differences() {
    let wing = Wing::read();
    let smooth = RationalFit::new(&wing.table(&[0.0])).unwrap();
    let table = wing.table(&[0.0]);
    let fit = PiecewiseQuadratic::of(&table).unwrap();
    let points = speeds([40.0], wing.density());
    let with_steps = wing_parameters(&wing);
    let parameters: Vec<Parameter> = with_steps
        .iter()
        .map(|(parameter, _)| parameter.clone())
        .collect();
    let base = polished(&wing, &points, &wing, &smooth, &parameters);
    let sweep = Sweep {
        smooth: Some(&smooth),
        parameters: &parameters,
        ..Sweep::new(&wing, &points, &table, &fit)
    };
    let roots: Vec<c64> = base
        .branches
        .iter()
        .map(|branch| c64::new(branch.g[0], branch.k[0]))
        .filter(|p| p.re > -0.15)
        .collect();
    let mut worst: f64 = 0.0;
    for (index, (parameter, step)) in with_steps.iter().enumerate() {
        let moved = |amount: f64| {
            let changed = Changed {
                wing: &wing,
                parameter,
                amount,
            };
            let result = polished(&changed, &points, &wing, &smooth, &[]);
            let values = result.branches.iter();
            values.map(|b| c64::new(b.g[0], b.k[0])).collect::<Vec<_>>()
        };
        let (ahead, behind) = (moved(*step), moved(-*step));
        for root in &roots {
            let ours = sweep.root_sensitivities(0.0, *root).unwrap()[index];
            let follow = |list: &[c64], amount: f64| -> c64 {
                let expected = root + ours * amount;
                *list
                    .iter()
                    .min_by(|a, b| (*a - expected).norm().total_cmp(&(*b - expected).norm()))
                    .unwrap()
            };
            let difference = (follow(&ahead, *step) - follow(&behind, -*step)) / (2.0 * step);
            let miss = (ours - difference).norm() / (1e-6 + difference.norm());
            // The difference loses what the roots have of rounding.
            let rounding = 1e-11 / (step * (1e-6 + difference.norm()));
            worst = worst.max(miss - rounding);
            assert!(
                miss < 1e-4 + rounding,
                "{} of {root}: {ours}, {difference}",
                parameter.name
            );
        }
    }
    println!(
        "{} roots, largest relative difference {worst:.1e}",
        roots.len()
    );
}

/// The properties that a system lists for itself: flutter of a section with
/// viscous and with hysteretic damping.
#[test]
fn modal_parameters_of_a_system_agree_with_differences() {
    let section = section("stability_section2_theodorsen.json", |g| g == 0.0);
    let forces = SectionForces::of(&section.file);
    let smooth = FromFunction::new(2, |p| forces.q(p));
    let fit = PiecewiseQuadratic::centred(&section.table, 0.2).unwrap();
    let mass = common::matrix(&section.file["M"]);
    let stiffness = common::matrix(&section.file["K"]);
    let points = speeds(range(1.9, 2.6, 8), section.density);
    // Amounts of frequency (Hz), damping and mass of both modes.
    let system = |amounts: [f64; 6], is_hysteretic: bool| {
        let mut changed = [mass.clone(), stiffness.clone()];
        let mut damping = vec![0.01, 0.02];
        for mode in 0..2 {
            let place = (mode, mode);
            let hertz = (stiffness[place] / mass[place]).sqrt() / std::f64::consts::TAU;
            changed[1][place] =
                mass[place] * (std::f64::consts::TAU * (hertz + amounts[3 * mode])).powi(2);
            damping[mode] += amounts[3 * mode + 1];
            changed[0][place] += amounts[3 * mode + 2];
        }
        let [mass, stiffness] = changed;
        let names = section.table.modes().to_vec();
        let model = if is_hysteretic {
            DampingModel::Hysteretic(damping)
        } else {
            DampingModel::Viscous(damping)
        };
        System::from_matrices(names, mass, Mat::zeros(2, 2), stiffness)
            .unwrap()
            .with_structural_damping(model)
            .unwrap()
    };
    let flutter = |system: &System, parameters: &[Parameter]| {
        let sweep = Sweep {
            smooth: Some(&smooth),
            method: Method::P2,
            parameters,
            ..Sweep::new(system, &points, &section.table, &fit)
        };
        let result = sweep.run(&()).unwrap().methods.polished.unwrap();
        assert_eq!(result.flutter.len(), 1);
        result.flutter[0].clone()
    };
    for is_hysteretic in [false, true] {
        let base = system([0.0; 6], is_hysteretic);
        let parameters = base.modal_parameters();
        let crossing = flutter(&base, &parameters);
        println!("flutter at {:.6}", crossing.speed);
        for (index, ours) in crossing.sensitivities.unwrap().iter().enumerate() {
            let step = 1e-5;
            let moved = |amount: f64| {
                let mut amounts = [0.0; 6];
                amounts[index] = amount;
                flutter(&system(amounts, is_hysteretic), &[]).speed
            };
            let difference = (moved(step) - moved(-step)) / (2.0 * step);
            println!(
                "{}: {:+.6}, difference {difference:+.6}",
                ours.parameter, ours.speed
            );
            assert!((ours.speed - difference).abs() < 1e-5 * (1.0 + difference.abs()));
        }
    }
}
