//! Forces that change with the flight condition, on the free wing.

#![allow(
    clippy::unwrap_used,
    reason = "a fault in the reference data must stop the test"
)]

mod common;

use common::{Wing, range, speeds};
use faer::Mat;
use fladder_stability::{
    GafPoint, GafTable, MachNumbers, Method, MethodResult, OperatingPoint, PiecewiseQuadratic,
    RationalFit, Schedule, Sweep,
};

/// Speed of sound of the tests, m/s.
const SOUND: f64 = 200.0;

/// The table with every sample times a factor.
fn scaled(table: &GafTable, factor: f64, mach: f64) -> GafTable {
    let points = table
        .k()
        .iter()
        .zip(table.axis())
        .map(|(k, q)| GafPoint {
            g: 0.0,
            k: *k,
            q: Mat::from_fn(q.nrows(), q.ncols(), |i, j| q[(i, j)] * factor),
        })
        .collect();
    let modes = table.modes().to_vec();
    GafTable::new(
        table.semichord(),
        mach,
        modes,
        points,
        table.steady().to_vec(),
    )
    .unwrap()
}

fn sweep(
    wing: &Wing,
    points: &dyn Schedule,
    table: &GafTable,
    mixture: Option<&MachNumbers>,
) -> [MethodResult; 3] {
    let fit = PiecewiseQuadratic::of(table).unwrap();
    let smooth = RationalFit::new(table).unwrap();
    let sweep = Sweep {
        smooth: Some(&smooth),
        mixture: mixture.map(|mixture| mixture as _),
        method: Method::Both,
        ..Sweep::new(wing, points, table, &fit)
    };
    let methods = sweep.run(&()).unwrap().methods;
    [methods.p2, methods.polished, methods.pk].map(Option::unwrap)
}

/// Largest difference of two lists of branches.
fn difference(one: &MethodResult, other: &MethodResult) -> f64 {
    assert_eq!(one.branches.len(), other.branches.len());
    let mut worst: f64 = 0.0;
    for (a, b) in one.branches.iter().zip(&other.branches) {
        assert_eq!((&a.name, a.g.len()), (&b.name, b.g.len()));
        let pairs = a.g.iter().chain(&a.k).zip(b.g.iter().chain(&b.k));
        worst = pairs.map(|(x, y)| (x - y).abs()).fold(worst, f64::max);
    }
    worst
}

/// At a constant Mach number the mixture is one table.
#[test]
fn a_mixture_at_one_condition_is_the_mixed_table() {
    let wing = Wing::read();
    let table = wing.table(&[0.0]);
    let machs = MachNumbers::new(vec![0.0, 0.5]).unwrap();
    let parts = [scaled(&table, 1.0, 0.0), scaled(&table, 1.2, 0.5)];
    let wide = GafTable::side_by_side(&parts).unwrap();
    let points: Vec<OperatingPoint> = speeds(range(30.0, 60.0, 7), wing.density())
        .into_iter()
        .map(|point| OperatingPoint {
            mach: Some(0.25),
            ..point
        })
        .collect();
    let mixed = sweep(&wing, &points, &wide, Some(&machs));
    let single = sweep(&wing, &points, &scaled(&table, 1.1, 0.25), None);
    for (name, (one, other)) in ["p2", "polished", "p-k"]
        .iter()
        .zip(mixed.iter().zip(&single))
    {
        let roots = difference(one, other);
        let speed = |result: &MethodResult| -> Vec<f64> {
            result
                .flutter
                .iter()
                .map(|crossing| crossing.speed)
                .collect()
        };
        println!(
            "{name}: roots differ by {roots:.1e}, flutter at {:?}",
            speed(one)
        );
        assert!(roots < 1e-7, "{name}");
        assert_eq!(speed(one).len(), speed(other).len());
        for (a, b) in speed(one).iter().zip(speed(other)) {
            assert!((a - b).abs() < 1e-6 * b);
        }
    }
    let complete = mixed[1].complete.as_ref().unwrap();
    assert!(complete.iter().all(|met| *met));
}

/// A matched sweep: at each crossing a sweep at the Mach number of that
/// crossing crosses at the same speed.
#[test]
fn matched_crossings_are_crossings_at_their_mach_number() {
    let wing = Wing::read();
    let table = wing.table(&[0.0]);
    let machs = MachNumbers::new(vec![0.0, 0.4]).unwrap();
    let parts = [scaled(&table, 1.0, 0.0), scaled(&table, 1.15, 0.4)];
    let wide = GafTable::side_by_side(&parts).unwrap();
    let points: Vec<OperatingPoint> = speeds(range(25.0, 60.0, 15), wing.density())
        .into_iter()
        .map(|point| OperatingPoint {
            mach: Some(point.airspeed / SOUND),
            ..point
        })
        .collect();
    let [_, matched, _] = sweep(&wing, &points, &wide, Some(&machs));
    assert!(!matched.flutter.is_empty());
    for crossing in &matched.flutter {
        let mach = crossing.speed / SOUND;
        let factor = 1.0 + 0.15 * mach / 0.4;
        let points = speeds(
            range(crossing.speed - 1.0, crossing.speed + 1.0, 3),
            wing.density(),
        );
        let [_, there, _] = sweep(&wing, &points, &scaled(&table, factor, mach), None);
        let nearest = there
            .flutter
            .iter()
            .map(|other| (other.speed - crossing.speed).abs())
            .fold(f64::INFINITY, f64::min);
        println!(
            "{:.6} m/s at M {mach:.4}: {nearest:.1e} m/s apart",
            crossing.speed
        );
        assert!(nearest < 1e-6);
    }
}

/// Tables of other grids or modes are refused.
#[test]
fn tables_side_by_side_must_agree() {
    let wing = Wing::read();
    let table = wing.table(&[0.0]);
    let other = GafTable::new(
        2.0 * table.semichord(),
        0.3,
        table.modes().to_vec(),
        table
            .k()
            .iter()
            .zip(table.axis())
            .map(|(k, q)| GafPoint {
                g: 0.0,
                k: *k,
                q: q.clone(),
            })
            .collect(),
        vec![],
    )
    .unwrap();
    let error = GafTable::side_by_side(&[table.clone(), other]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "table 2 has other semichord than the first"
    );
    let wide = GafTable::side_by_side(&[table.clone(), table.clone()]).unwrap();
    let fit = PiecewiseQuadratic::of(&wide).unwrap();
    let points = speeds([30.0], wing.density());
    assert!(Sweep::new(&wing, &points, &wide, &fit).run(&()).is_err());
}
