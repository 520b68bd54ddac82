//! Humps between two speeds, and pairs that turn into real roots, on
//! structures whose roots are known at every speed.

#![allow(clippy::unwrap_used, reason = "a refused input must stop the test")]

use faer::{Mat, c64};
use fladder_stability::{
    FromFunction, GafPoint, GafTable, Method, Methods, OperatingPoint, PiecewiseQuadratic,
    StructuralMatrices, Structure, Sweep,
};

/// Matrices as functions of the airspeed, no aerodynamics; $b = 1$.
struct Given<F> {
    modes: Vec<String>,
    matrices: F,
}

impl<F: Fn(f64) -> [Mat<f64>; 3] + Sync> Structure for Given<F> {
    fn modes(&self) -> &[String] {
        &self.modes
    }

    fn rigid_modes(&self) -> Vec<usize> {
        Vec::new()
    }

    fn at(&self, point: &OperatingPoint) -> StructuralMatrices {
        let [mass, damping, stiffness] = (self.matrices)(point.airspeed);
        StructuralMatrices {
            mass,
            damping,
            stiffness,
            hysteretic: None,
            flight_path: None,
        }
    }
}

fn sweep<F: Fn(f64) -> [Mat<f64>; 3] + Sync>(
    order: usize,
    speeds: &[f64],
    matrices: F,
) -> Methods {
    let modes: Vec<String> = (1..=order).map(|i| format!("mode:{i}")).collect();
    let points = [0.0, 0.05, 0.1, 0.3, 0.6, 1.0]
        .map(|k| GafPoint {
            g: 0.0,
            k,
            q: Mat::zeros(order, order),
        })
        .into();
    let table = GafTable::new(1.0, 0.0, modes.clone(), points, vec![]).unwrap();
    let fit = PiecewiseQuadratic::of(&table).unwrap();
    let still = FromFunction::new(order, |_: c64| Mat::zeros(order, order));
    let structure = Given { modes, matrices };
    let schedule: Vec<OperatingPoint> = speeds
        .iter()
        .map(|speed| OperatingPoint::new(*speed, 1.0))
        .collect();
    Sweep {
        smooth: Some(&still),
        method: Method::P2,
        ..Sweep::new(&structure, &schedule, &table, &fit)
    }
    .run(&())
    .unwrap()
    .methods
}

fn one(value: f64) -> Mat<f64> {
    Mat::from_fn(1, 1, |_, _| value)
}

/// Damping $0.02 - 0.03\,e^{-((U-10.23)/0.3)^2}$ is negative within 0.191 m/s
/// of 10.23 m/s, between two speeds of a sweep in steps of half a metre a
/// second. Both crossings are found, and told as a hump.
#[test]
fn a_hump_between_two_speeds_is_found() {
    let speeds: Vec<f64> = (0..21).map(|i| 5.0 + 0.5 * f64::from(i)).collect();
    let damping = |u: f64| 0.02 - 0.03 * (-((u - 10.23) / 0.3).powi(2)).exp();
    let methods = sweep(1, &speeds, |u| [one(1.0), one(damping(u)), one(9.0)]);
    let result = methods.polished.unwrap();
    let half = 0.3 * 1.5_f64.ln().sqrt();
    assert!(result.branches[0].g.iter().all(|g| *g < 0.0));
    assert_eq!((result.flutter.len(), result.restabilised.len()), (1, 1));
    let errors = [
        result.flutter[0].speed - (10.23 - half),
        result.restabilised[0].speed - (10.23 + half),
    ];
    println!(
        "hump from {:.6} to {:.6} m/s, errors {errors:?}",
        result.flutter[0].speed, result.restabilised[0].speed
    );
    assert!(errors.iter().all(|error| error.abs() < 1e-9));
    assert_eq!(result.humps.len(), 1);
    assert_eq!(result.humps[0].branch, "mode:1");
    assert!(result.unstable_at_start.is_empty());
}

/// $K = \begin{bmatrix}\alpha & \beta_1\\ \beta_2 & \alpha\end{bmatrix}$ with
/// $\alpha = 0.02(2.5-U)$, $\beta_1\beta_2 = 10^{-4}(U-3)$ and damping 0.1: a
/// pair flutters and at 3 m/s turns into two growing real roots. The
/// instability is told once, the branches are named as one motion, and with
/// the speeds exchanged the same holds for the way back.
#[test]
fn a_growing_pair_that_turns_real_is_told_once() {
    let matrices = |u: f64| {
        let alpha = 0.02 * (2.5 - u);
        [
            Mat::from_fn(2, 2, |i, j| f64::from(u8::from(i == j))),
            Mat::from_fn(2, 2, |i, j| if i == j { 0.1 } else { 0.0 }),
            Mat::from_fn(2, 2, |i, j| match (i, j) {
                (0, 1) => 0.01,
                (1, 0) => 0.01 * (u - 3.0),
                _ => alpha,
            }),
        ]
    };
    let speeds: Vec<f64> = (0..32).map(|i| 1.02 + 0.1 * f64::from(i)).collect();
    let there = sweep(2, &speeds, matrices);
    let back = sweep(2, &speeds, |u| matrices(5.15 - u));
    for (name, result) in [("p2", there.p2), ("polished", there.polished)] {
        let result = result.unwrap();
        println!(
            "{name}: flutter {:?}, divergence {:?}, at start {:?}, turns {:?}",
            result.flutter.iter().map(|f| f.speed).collect::<Vec<_>>(),
            result
                .divergence
                .iter()
                .map(|f| f.speed)
                .collect::<Vec<_>>(),
            result.unstable_at_start,
            result.turns
        );
        assert_eq!(result.flutter.len(), 1, "{name}");
        assert!(
            result.divergence.is_empty() && result.unstable_at_start.is_empty(),
            "{name}"
        );
        let turn = result
            .turns
            .iter()
            .find(|turn| turn.pair == result.flutter[0].branch)
            .unwrap();
        assert_eq!((turn.kind, turn.real.len()), ("split", 2));
        assert!(turn.between[0] < 3.0 && turn.between[1] > 3.0);
    }
    for (name, result) in [("p2", back.p2), ("polished", back.polished)] {
        let result = result.unwrap();
        println!(
            "{name} back: at start {:?}, turns {:?}",
            result.unstable_at_start, result.turns
        );
        assert_eq!(
            result.unstable_at_start.len(),
            2,
            "{name}: the two real roots"
        );
        assert_eq!(result.restabilised.len(), 1, "{name}");
        let turn = result
            .turns
            .iter()
            .find(|turn| turn.pair == result.restabilised[0].branch)
            .unwrap();
        assert_eq!((turn.kind, turn.real.len()), ("join", 2));
    }
}
