//! Masses added through the mode shapes against beams with closed solutions.
//!
//! A beam of unit length, bending stiffness and mass along y moves in z. With
//! ω = λ², a mass μ at its end asks for `w''' = −μ λ⁴ w` and a moment of inertia
//! J for `w'' = J λ⁴ w'` there.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use common::{stations, wing};
use fladder_mesh::Vec3;
use fladder_modal::{
    EditError, Edits, HingeChange, HingeRotation, Inertia, ModalResult, Mode, Node, PointMass,
    RigidBody, StructuralModel, StructureError, StructureSettings, load, write_neutral,
};
use std::f64::consts::{PI, TAU};

#[derive(Clone, Copy, PartialEq)]
enum Beam {
    Cantilever,
    Free,
}

/// Root between two bounds of a function that changes sign there.
fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let sign = f(low).signum();
    assert!(sign != f(high).signum(), "{low} to {high}");
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle).signum() == sign {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

impl Beam {
    /// −1 for the cantilever, whose sum is cosh − cos; +1 for the free beam.
    fn sign(self) -> f64 {
        if self == Self::Cantilever { -1.0 } else { 1.0 }
    }

    /// Wave number of elastic mode n ≥ 1.
    fn wave_number(self, n: usize) -> f64 {
        let middle = if self == Self::Cantilever {
            n as f64 - 0.5
        } else {
            n as f64 + 0.5
        } * PI;
        root(middle - 0.5, middle + 0.5, |l| {
            l.cos() - self.sign() / l.cosh()
        })
    }

    /// `cosh + s cos − σ (sinh + s sin)` at λy and its slope by λy, of unit mass;
    /// growing and falling exponentials apart, so that no digits are lost.
    fn shape(self, l: f64, y: f64) -> [f64; 2] {
        let s = self.sign();
        // σ = (cosh − s cos)/(sinh − s sin) for both; 1 − σ without cancellation.
        let below = 0.5 * (1.0 - (-2.0 * l).exp()) - s * l.sin() * (-l).exp();
        let rest = (s * (l.cos() - l.sin()) - (-l).exp()) / below;
        let sigma = 1.0 - rest * (-l).exp();
        let growing = 0.5 * rest * (l * (y - 1.0)).exp();
        let falling = 0.5 * (1.0 + sigma) * (-l * y).exp();
        let (sin, cos) = (l * y).sin_cos();
        [
            growing + falling + s * (cos - sigma * sin),
            l * (growing - falling - s * (sin + sigma * cos)),
        ]
    }

    /// Modes of the beam as a file would hold them.
    fn result(self, modes: usize) -> ModalResult {
        let mut result = wing().result();
        result.elements.clear();
        result.element_sets.clear();
        let places = stations(0.0, 1.0, 10);
        let node = |(k, y): (usize, &f64)| Node {
            id: k as u64 + 1,
            position: Vec3::new(0.0, *y, 0.0),
        };
        result.nodes = places.iter().enumerate().map(node).collect();
        for n in 1..=modes {
            let l = self.wave_number(n);
            let omega = l * l;
            let motion: Vec<[f64; 2]> = places.iter().map(|y| self.shape(l, *y)).collect();
            result.modes.push(Mode {
                index: n as u32,
                frequency_hz: omega / TAU,
                eigenvalue: omega * omega,
                generalised_mass: 1.0,
                generalised_stiffness: omega * omega,
                displacement: motion.iter().map(|m| Vec3::new(0.0, 0.0, m[0])).collect(),
                rotation: Some(motion.iter().map(|m| Vec3::new(m[1], 0.0, 0.0)).collect()),
                participation: None,
            });
        }
        if self == Self::Free {
            let (bending, twist) = (1.0 / 12.0, 1e-3);
            result.stated_mass = Some(RigidBody {
                mass: 1.0,
                cg: Vec3::new(0.0, 0.5, 0.0),
                inertia: Inertia {
                    xx: bending,
                    yy: twist,
                    zz: bending,
                    xz: 0.0,
                },
            });
        }
        result
    }

    /// Wave number of mode n with mass and moment of inertia at the end.
    fn loaded(self, n: usize, mass: f64, inertia: f64) -> f64 {
        let s = self.sign();
        // Scaled by 1/cosh; a and b are the shares of the two free solutions.
        let equation = |l: f64| {
            let (sin, cos) = l.sin_cos();
            let (sin, cos, tanh) = (sin / l.cosh(), cos / l.cosh(), l.tanh());
            let moment = |value: [f64; 3]| value[2] - inertia * l.powi(3) * value[1];
            let force = |value: [f64; 3], third: f64| third + mass * l * value[0];
            let first = [1.0 + s * cos, tanh - s * sin, 1.0 - s * cos];
            let second = [tanh + s * sin, 1.0 + s * cos, tanh - s * sin];
            let third = [tanh + s * sin, 1.0 - s * cos];
            moment(first) * force(second, third[1]) - moment(second) * force(first, third[0])
        };
        // A load lowers every root, but not below the unloaded one before.
        let highest = self.wave_number(n) - 1e-9;
        let lowest = if n == 1 {
            0.3
        } else {
            self.wave_number(n - 1) + 1e-9
        };
        let steps = stations(lowest, highest, 400);
        let mut brackets = steps
            .windows(2)
            .filter(|pair| equation(pair[0]).signum() != equation(pair[1]).signum());
        let bracket = brackets.next().unwrap();
        root(bracket[0], bracket[1], equation)
    }
}

fn loaded(result: &ModalResult, edits: Edits) -> Result<StructuralModel, StructureError> {
    let file = tempfile("beam.json");
    write_neutral(result, std::fs::File::create(&file).unwrap()).unwrap();
    let settings = StructureSettings {
        file: file.clone(),
        edits,
        ..StructureSettings::default()
    };
    let model = load(&settings);
    std::fs::remove_file(file).unwrap();
    model
}

fn tempfile(name: &str) -> std::path::PathBuf {
    use std::sync::atomic::{AtomicUsize, Ordering};
    static NUMBER: AtomicUsize = AtomicUsize::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    std::env::temp_dir().join(format!("fladder-{}-{number}-{name}", std::process::id()))
}

fn mass(mass: f64, moment: f64) -> Edits {
    Edits {
        masses: vec![PointMass {
            name: "store".to_owned(),
            mass,
            position: Vec3::new(0.0, 1.0, 0.0),
            node: None,
            inertia: (moment > 0.0).then_some(Inertia {
                xx: moment,
                yy: moment,
                zz: moment,
                xz: 0.0,
            }),
        }],
        ..Edits::default()
    }
}

/// Largest relative error of the first three frequencies.
fn error(beam: Beam, modes: usize, added: f64, moment: f64) -> f64 {
    let model = loaded(&beam.result(modes), mass(added, moment)).unwrap();
    (1..=3)
        .map(|n| {
            let exact = beam.loaded(n, added, moment).powi(2);
            (model.elastic[n - 1].omega / exact - 1.0).abs()
        })
        .fold(0.0, f64::max)
}

/// The shapes satisfy the end conditions and are of unit mass.
#[test]
fn the_shapes_are_those_of_the_beams() {
    for beam in [Beam::Cantilever, Beam::Free] {
        for n in [1, 2, 7, 60] {
            let l = beam.wave_number(n);
            let end = if beam == Beam::Cantilever {
                [0.0, 0.0]
            } else {
                [2.0, 0.0]
            };
            assert!((beam.shape(l, 0.0)[0] - end[0]).abs() < 1e-9);
            assert!((beam.shape(l, 1.0)[0].abs() - 2.0).abs() < 1e-9, "{n}");
            let count = 20_000;
            let square: f64 = (0..count)
                .map(|k| beam.shape(l, (f64::from(k) + 0.5) / f64::from(count))[0].powi(2))
                .sum();
            assert!((square / f64::from(count) - 1.0).abs() < 1e-5, "{n}");
        }
    }
}

#[test]
fn an_added_mass_gives_the_frequencies_of_an_exact_analysis() {
    for beam in [Beam::Cantilever, Beam::Free] {
        let name = if beam == Beam::Free {
            "free"
        } else {
            "cantilever"
        };
        let errors = [25, 50, 100, 200].map(|modes| (modes, error(beam, modes, 0.05, 0.0)));
        println!("{name} beam, a twentieth of its mass at the end: {errors:?}");
        for pair in errors.windows(2) {
            let order = (pair[0].1 / pair[1].1).log2();
            assert!(
                order > 2.7,
                "cubic convergence in the number of modes: {order}"
            );
        }
        assert!(errors[3].1 < 1e-6);
    }
}

/// Slopes grow with the mode number, so that a moment of inertia converges in
/// proportion to the number of modes alone.
#[test]
fn a_moment_of_inertia_converges_with_the_number_of_modes() {
    let errors = [25, 50, 100].map(|modes| error(Beam::Cantilever, modes, 0.05, 1e-3));
    println!("moment of inertia: {errors:?}");
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1] - 2.0).abs() < 0.1, "first order");
    }
    // What is left when the leading term is taken out: the frequencies go to
    // those of the exact analysis.
    assert!((2.0 * errors[2] - errors[1]).abs() < 2e-5);
}

/// Mass, centre and inertia follow; the new modes have unit mass and no part in
/// rigid motion, which shows in a second mass being the same as both at once.
#[test]
fn masses_added_one_after_the_other_are_those_added_at_once() {
    let result = Beam::Free.result(40);
    let both = {
        let mut edits = mass(0.05, 1e-3);
        edits.masses.extend(mass(0.1, 0.0).masses);
        loaded(&result, edits).unwrap()
    };
    let body = both.rigid_body.unwrap();
    assert!((body.mass - 1.15).abs() < 1e-14);
    assert!((body.cg.y - 0.65 / 1.15).abs() < 1e-14);
    let about = |y: f64| (y - body.cg.y).powi(2);
    let xx = 1.0 / 12.0 + about(0.5) + 1e-3 + 0.15 * about(1.0);
    assert!((body.inertia.xx - xx).abs() < 1e-14);
    let first = loaded(&result, mass(0.05, 1e-3)).unwrap();
    let mut middle = result.clone();
    middle.stated_mass = first.rigid_body;
    for (mode, new) in middle.modes.iter_mut().zip(&first.elastic) {
        mode.frequency_hz = new.frequency_hz;
        mode.eigenvalue = new.omega * new.omega;
        mode.displacement.clone_from(&new.shape);
        mode.rotation.clone_from(&new.rotation);
    }
    let second = loaded(&middle, mass(0.1, 0.0)).unwrap();
    for (a, b) in both.elastic.iter().zip(&second.elastic) {
        assert!((a.omega / b.omega - 1.0).abs() < 1e-10, "{}", a.name);
        assert!(
            (a.shape[10] - b.shape[10]).norm() < 1e-7 * a.shape[10].norm(),
            "{}",
            a.name
        );
    }
    let is_said = |note: &String| note.contains("not symmetric about y = 0");
    assert!(!both.notes.iter().any(is_said));
}

#[test]
fn what_cannot_be_changed_is_refused_by_name() {
    let result = Beam::Free.result(6);
    let refused = |result: &ModalResult, edits| match loaded(result, edits) {
        Err(StructureError::Edit(error)) => error,
        other => panic!("{other:?}"),
    };
    let mut on_node = mass(0.1, 0.0);
    on_node.masses[0].node = Some(99);
    assert!(matches!(
        refused(&result, on_node),
        EditError::Unknown { .. }
    ));
    assert!(matches!(
        refused(&result, mass(-5.0, 0.0)),
        EditError::Impossible { .. }
    ));
    let hinge = |rotation| Edits {
        hinges: vec![HingeChange {
            name: "elevon".to_owned(),
            stiffness_change: -1e9,
            rotation,
        }],
        ..Edits::default()
    };
    let scalar = hinge(HingeRotation::Scalar {
        node: 11,
        component: 2,
    });
    assert!(matches!(
        refused(&result, scalar),
        EditError::Impossible { .. }
    ));
    let sets = hinge(HingeRotation::Between {
        control: "FLAP".to_owned(),
        base: "WING".to_owned(),
        axis: Vec3::y(),
    });
    assert!(matches!(refused(&result, sets), EditError::Unknown { .. }));
    let frequency = Edits {
        frequencies: vec![(7, 3.0)],
        ..Edits::default()
    };
    assert!(matches!(
        refused(&result, frequency),
        EditError::NoMode {
            number: 7,
            count: 6
        }
    ));
}
