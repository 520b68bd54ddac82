//! 200 speeds of the 26-mode wing: full p2 on 42 rectangles, refined roots
//! from every cell, and by continuation with the count at every speed. One run
//! prints times and their ratios, and holds the roots against each other.
//! With words behind `--` only the ways whose names hold one of them run, for
//! a profile.

#![allow(
    clippy::unwrap_used,
    reason = "a fault in the reference data must stop the run"
)]

#[path = "../../crates/stability/tests/common/mod.rs"]
mod common;

use std::time::Instant;

use common::{Wing, range, speeds};
use fladder_stability::{
    Method, MethodResult, OperatingPoint, PiecewiseQuadratic, PkForm, RationalFit, Search,
    Sweep,
};

/// Speeds of the sweep.
const COUNT: usize = 200;

/// Threads of all runs.
const THREADS: usize = 2;

/// Each is timed so often, and the shortest time taken.
const TRIES: usize = 3;

/// Roots of the two ways may differ by this.
const SAME: f64 = 1e-9;

fn main() {
    let wing = Wing::read();
    let table = wing.table(&[0.0]);
    let points = speeds(range(20.0, 75.0, COUNT), wing.density());
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(THREADS)
        .build()
        .unwrap();
    let literal = PiecewiseQuadratic::literal(&table, 0.2).unwrap();
    let centred = PiecewiseQuadratic::of(&table).unwrap();
    let start = Instant::now();
    let smooth = RationalFit::new(&table).unwrap();
    println!(
        "rational fit of {} poles: {:.3} s",
        smooth.poles().len(),
        start.elapsed().as_secs_f64()
    );
    let run = |fit, method, search| {
        let sweep = Sweep {
            smooth: Some(&smooth),
            method,
            search,
            pk_form: PkForm::Complex,
            ..Sweep::new(&wing, &points, &table, fit)
        };
        let mut best: Option<(f64, MethodResult)> = None;
        for _ in 0..TRIES {
            let start = Instant::now();
            let methods = pool.install(|| sweep.run(&())).unwrap().methods;
            let seconds = start.elapsed().as_secs_f64();
            let result = methods.polished.or(methods.p2).or(methods.pk).unwrap();
            if best.as_ref().is_none_or(|(least, _)| seconds < *least) {
                best = Some((seconds, result));
            }
        }
        best.unwrap()
    };
    let ways = [
        (
            "p2, 42 rectangles",
            &literal,
            Method::Unrefined,
            Search::default(),
        ),
        (
            "p2, centred, 20 cells",
            &centred,
            Method::Unrefined,
            Search::default(),
        ),
        (
            "refined from every cell",
            &centred,
            Method::Refined,
            Search::EverySpeed,
        ),
        (
            "refined by continuation",
            &centred,
            Method::Refined,
            Search::Continuation,
        ),
        ("p-k", &centred, Method::Pk, Search::default()),
    ];
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| !word.starts_with("--"))
        .collect();
    let is_wanted =
        |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word.as_str()));
    println!("{COUNT} speeds, 26 modes, {THREADS} threads, crossings and tracking included:");
    let mut times = Vec::new();
    let mut refined = Vec::new();
    for (name, fit, method, search) in ways {
        if !is_wanted(name) {
            continue;
        }
        let (seconds, result) = run(fit, method, search);
        println!("  {name:24} {seconds:7.3} s");
        times.push((name, seconds));
        if method == Method::Refined {
            refined.push(result);
        }
    }
    if let [full, followed] = refined.as_slice() {
        compare(&points, &times, full, followed);
    }
}

/// Ratios to the continuation, and its roots held against those of the search in every cell.
fn compare(
    points: &[OperatingPoint],
    times: &[(&str, f64)],
    full: &MethodResult,
    followed: &MethodResult,
) {
    let fast = times
        .iter()
        .find(|(name, _)| name.contains("continuation"))
        .unwrap()
        .1;
    for (name, seconds) in times {
        println!("  {name:24} {:5.1} times the continuation", seconds / fast);
    }
    let complete = followed.complete.as_ref().unwrap();
    let difference = largest_difference(points, followed, full);
    println!(
        "  count met at {} speeds; largest difference of roots {difference:.1e}",
        complete.iter().filter(|met| **met).count(),
    );
    assert!(difference < SAME && complete.iter().all(|met| *met));
}

/// Largest distance of a root of either list from the nearest of the other.
fn largest_difference(
    points: &[OperatingPoint],
    one: &MethodResult,
    other: &MethodResult,
) -> f64 {
    let at = |result: &MethodResult, speed: usize| -> Vec<[f64; 2]> {
        let there = result
            .branches
            .iter()
            .filter(|branch| branch.first <= speed && speed < branch.first + branch.g.len());
        there
            .map(|branch| {
                [
                    branch.g[speed - branch.first],
                    branch.k[speed - branch.first],
                ]
            })
            .collect()
    };
    let far = |from: &[[f64; 2]], to: &[[f64; 2]]| {
        let nearest = |root: &[f64; 2]| {
            to.iter()
                .map(|other| (other[0] - root[0]).hypot(other[1] - root[1]))
                .fold(f64::INFINITY, f64::min)
        };
        from.iter().map(nearest).fold(0.0, f64::max)
    };
    (0..points.len())
        .map(|speed| {
            let (one, other) = (at(one, speed), at(other, speed));
            far(&one, &other).max(far(&other, &one))
        })
        .fold(0.0, f64::max)
}
