//! Every root of the free wing, proved: the count of the argument principle,
//! and the sweep by continuation against the one from every cell.

#![allow(
    clippy::unwrap_used,
    reason = "a fault in the reference data must stop the test"
)]

mod common;

use std::time::Instant;

use common::{Wing, number, range, roots, speeds};
use faer::{Mat, c64};
use fladder_stability::{
    Aerodynamics, FromFunction, Method, MethodResult, PiecewiseQuadratic, RationalFit,
    Schedule, Search, Structure, Sweep,
};

fn found_at(result: &MethodResult, number: usize) -> Vec<c64> {
    result
        .branches
        .iter()
        .filter(|branch| branch.first <= number && number < branch.first + branch.g.len())
        .map(|branch| {
            let at = number - branch.first;
            c64::new(branch.g[at], branch.k[at])
        })
        .collect()
}

fn nearest(to: c64, among: &[c64]) -> f64 {
    among
        .iter()
        .map(|root| (root - to).norm())
        .fold(f64::INFINITY, f64::min)
}

fn polished(
    structure: &dyn Structure,
    wing: &Wing,
    points: &dyn Schedule,
    smooth: &dyn Aerodynamics,
    search: Search,
) -> MethodResult {
    let table = wing.table(&[0.0]);
    let fit = PiecewiseQuadratic::of(&table).unwrap();
    let sweep = Sweep {
        smooth: Some(smooth),
        method: Method::Refined,
        search,
        ..Sweep::new(structure, points, &table, &fit)
    };
    sweep.run(&()).unwrap().methods.polished.unwrap()
}

fn truth_speeds(wing: &Wing) -> Vec<f64> {
    wing.truth()
        .iter()
        .map(|truth| number(&truth["U"]))
        .collect()
}

/// The closed form with its first pole, that of the slowest lag.
struct ClosedForm<'a>(&'a Wing);

impl Aerodynamics for ClosedForm<'_> {
    fn order(&self) -> usize {
        26
    }

    fn q(&self, p: c64) -> Mat<c64> {
        self.0.q(p)
    }

    fn rightmost_pole(&self) -> Option<f64> {
        let lag = common::numbers(&self.0.file["bl"])[0];
        let scales = common::numbers(&self.0.file["bs"]);
        Some(-lag / scales.iter().fold(0.0, |a: f64, b| a.max(*b)))
    }
}

/// With Q in closed form the roots with $|g|\le0.2$, $0\le k\le1.5$, the real
/// ones among them, are those of the file at every speed: none missed, none
/// invented, and four of them are zero.
#[test]
fn no_root_of_the_wing_is_missed_or_invented() {
    let wing = Wing::read();
    let smooth = ClosedForm(&wing);
    let rational = RationalFit::new(&wing.table(&[0.0])).unwrap();
    let points = speeds(truth_speeds(&wing), wing.density());
    let is_inside = |p: &c64| p.re.abs() <= 0.2 && p.im <= 1.5 && p.norm() > 1e-9;
    for (name, smooth, tolerance) in [
        ("closed form", &smooth as &dyn Aerodynamics, 1e-7),
        ("rational fit", &rational, 1e-7),
    ] {
        for search in [Search::Continuation, Search::EverySpeed] {
            let result = polished(&wing, &wing, &points, smooth, search);
            assert!(result.zero_roots.iter().all(|zeros| *zeros == 4));
            let (mut worst, mut total): (f64, usize) = (0.0, 0);
            for (number, truth) in wing.truth().iter().enumerate() {
                let found: Vec<c64> = found_at(&result, number)
                    .into_iter()
                    .filter(is_inside)
                    .collect();
                let exact: Vec<c64> = roots(&truth["roots"])
                    .into_iter()
                    .filter(is_inside)
                    .collect();
                assert_eq!(
                    found.len(),
                    exact.len(),
                    "{name}, speed {number}: {found:?}, exact {exact:?}"
                );
                for root in &exact {
                    worst = worst.max(nearest(*root, &found));
                }
                total += exact.len();
            }
            println!("{name}, {search:?}: {total} roots, largest difference {worst:.1e}");
            assert!(worst < tolerance);
            for count in result.count.unwrap() {
                let count = count.unwrap();
                assert_eq!(count.counted, count.found);
            }
        }
    }
}

/// Where gravity does not act there are six zero roots.
#[test]
fn six_roots_are_zero_without_gravity() {
    let wing = Wing::read().without_gravity();
    let smooth = FromFunction::new(26, |p| wing.q(p));
    let points = speeds(range(20.0, 75.0, 12), wing.density());
    let result = polished(&wing, &wing, &points, &smooth, Search::Continuation);
    println!("zero roots {:?}", result.zero_roots);
    assert!(result.zero_roots.iter().all(|zeros| *zeros == 6));
    assert!(result.complete.unwrap().iter().all(|met| *met));
}

/// At every speed a root taken out of the list and a false one put in are
/// reported; the number of roots does not change with the list.
#[test]
fn a_missing_and_a_false_root_are_reported_at_every_speed() {
    let wing = Wing::read();
    let smooth = RationalFit::new(&wing.table(&[0.0])).unwrap();
    let points = speeds(range(20.0, 75.0, 45), wing.density());
    let table = wing.table(&[0.0]);
    let fit = PiecewiseQuadratic::of(&table).unwrap();
    let sweep = Sweep {
        smooth: Some(&smooth),
        method: Method::Refined,
        ..Sweep::new(&wing, &points, &table, &fit)
    };
    let result = sweep.run(&()).unwrap().methods.polished.unwrap();
    for speed in 0..points.len() {
        let list = found_at(&result, speed);
        let zeros = result.zero_roots[speed];
        let count = |list: &[c64]| sweep.count(speed as f64, list, zeros).unwrap();
        let right = count(&list);
        assert_eq!(right.counted, right.found, "speed {speed}");
        let inside: Vec<usize> = (0..list.len()).filter(|&i| list[i].im > 0.01).collect();
        let gone = inside[speed % inside.len()];
        let mut fewer = list.clone();
        let root = fewer.remove(gone);
        let judged = count(&fewer);
        assert_eq!(
            judged.counted - judged.found,
            1,
            "speed {speed} without {root}"
        );
        assert_eq!(judged.counted, right.counted);
        let mut more = list.clone();
        more.push(root + c64::new(0.01, 0.01));
        let judged = count(&more);
        assert_eq!(
            judged.counted - judged.found,
            -1,
            "speed {speed} with a false root"
        );
        assert_eq!(judged.counted, right.counted);
    }
    println!(
        "{} speeds, roots inside {:?}",
        points.len(),
        result.count.unwrap()
    );
}

/// 200 speeds by continuation and from every cell: the same roots to 1e-9, all
/// counted.
#[test]
fn continuation_finds_the_roots_of_every_cell() {
    let wing = Wing::read();
    let smooth = RationalFit::new(&wing.table(&[0.0])).unwrap();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .build()
        .unwrap();
    for (from, to, count) in [(20.0, 75.0, 200), (18.0, 74.0, 8), (30.0, 31.0, 3)] {
        let points = speeds(range(from, to, count), wing.density());
        let run = |search| {
            let start = Instant::now();
            let result = pool.install(|| polished(&wing, &wing, &points, &smooth, search));
            println!(
                "{count} speeds, {search:?}: {:.3} s",
                start.elapsed().as_secs_f64()
            );
            result
        };
        let (fast, full) = (run(Search::Continuation), run(Search::EverySpeed));
        let (mut worst, mut differences): (f64, usize) = (0.0, 0);
        for speed in 0..count {
            let (one, other) = (found_at(&fast, speed), found_at(&full, speed));
            let lonely = |list: &[c64], among: &[c64]| -> Vec<c64> {
                let far = |root: &&c64| nearest(**root, among) > 1e-9;
                list.iter().filter(far).copied().collect()
            };
            let (extra, lost) = (lonely(&one, &other), lonely(&other, &one));
            if extra.len() + lost.len() > 0 {
                println!(
                    "speed {speed}: only by continuation {extra:?}, only by cells {lost:?}"
                );
            }
            differences += extra.len() + lost.len();
            for root in &one {
                worst = worst.max(nearest(*root, &other));
            }
        }
        println!("largest difference {worst:.1e}");
        assert!(worst < 1e-9 && differences == 0);
        assert_eq!(fast.zero_roots, full.zero_roots);
        assert!(fast.complete.unwrap().iter().all(|met| *met));
        for count in fast.count.unwrap().into_iter().chain(full.count.unwrap()) {
            let count = count.unwrap();
            assert_eq!(count.counted, count.found);
        }
        assert_eq!(fast.branches.len(), full.branches.len());
    }
}
