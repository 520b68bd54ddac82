//! Typical sections with exact Theodorsen aerodynamics: flutter and divergence
//! from 21 samples on the imaginary axis, against the exact solution.

#![allow(
    clippy::unwrap_used,
    reason = "a fault in the reference data must stop the test"
)]

mod common;

use common::{Section, data_path, number, range, section, speeds};
use fladder_stability::{
    DEFAULT_DAMPING_LIMIT, GafPoint, GafTable, MethodResult, PiecewiseQuadratic, PkForm,
    RationalFit, Sweep, SweepResult,
};

fn sweep(section: &Section, from: f64, to: f64, count: usize) -> SweepResult {
    let fit = PiecewiseQuadratic::centred(&section.table, DEFAULT_DAMPING_LIMIT).unwrap();
    let schedule = speeds(range(from, to, count), section.density);
    Sweep::new(&section.system, &schedule, &section.table, &fit)
        .run(&())
        .unwrap()
}

fn check_flutter(name: &str, result: &MethodResult, section: &Section, tolerance: f64) {
    let reference = &section.file["flutter"][0];
    let (speed, k) = (number(&reference["U"]), number(&reference["k"]));
    assert_eq!(result.flutter.len(), 1, "{name}: {:?}", result.flutter);
    let found = &result.flutter[0];
    println!(
        "{name}: U* = {:.8}, exact {speed:.8}, error {:.1e}; k = {:.8}, exact {k:.8}",
        found.speed,
        found.speed / speed - 1.0,
        found.k
    );
    assert!((found.speed / speed - 1.0).abs() < tolerance);
    assert!((found.k / k - 1.0).abs() < 10.0 * tolerance);
}

/// Flutter of the section of Hodges & Pierce's proportions, U* = 2.1839 with
/// the exact C(k), by both methods.
#[test]
fn two_degree_section_flutters_at_the_exact_speed() {
    let section = section("stability_section2_theodorsen.json", |g| g == 0.0);
    let result = sweep(&section, 1.5, 2.6, 12);
    check_flutter("p2", result.methods.p2.as_ref().unwrap(), &section, 1e-4);
    check_flutter("p-k", result.methods.pk.as_ref().unwrap(), &section, 1e-5);
}

/// The same for three degrees of freedom with a flap.
#[test]
fn three_degree_section_flutters_at_the_exact_speed() {
    let section = section("stability_section3_theodorsen.json", |g| g == 0.0);
    let result = sweep(&section, 2.0, 4.0, 21);
    check_flutter("p2", result.methods.p2.as_ref().unwrap(), &section, 1e-4);
    check_flutter("p-k", result.methods.pk.as_ref().unwrap(), &section, 1e-5);
}

/// Static divergence needs Q(0) alone and is exact.
#[test]
fn sections_diverge_at_the_exact_speed() {
    for (name, from, to) in [
        ("stability_section2_theodorsen.json", 2.0, 4.0),
        ("stability_section3_theodorsen.json", 5.0, 8.0),
    ] {
        let section = section(name, |g| g == 0.0);
        let result = sweep(&section, from, to, 21);
        let divergence = &result.methods.pk.unwrap().divergence;
        let exact = number(&section.file["divergence_U"][0]);
        println!("{name}: {divergence:?}, exact {exact}");
        assert_eq!(divergence.len(), 1);
        assert!((divergence[0].speed / exact - 1.0).abs() < 1e-12);
        let p2 = &result.methods.p2.unwrap().divergence;
        assert_eq!(p2.len(), 1);
        assert!((p2[0].speed / exact - 1.0).abs() < 1e-9);
    }
}

/// p-k roots of the section at 13 speeds, against the file; the samples are
/// 21, so the interpolation limits the agreement.
#[test]
fn pk_roots_agree_with_the_reference() {
    let section = section("stability_section2_theodorsen.json", |g| g == 0.0);
    let text = std::fs::read_to_string(data_path("typical_section_pk_open.csv")).unwrap();
    let rows: Vec<Vec<&str>> = text
        .lines()
        .filter(|line| line.starts_with("TS1_classic"))
        .map(|line| line.split(',').collect())
        .collect();
    let value = |row: &[&str], column: usize| row[column].parse::<f64>().unwrap();
    let (mut checked, mut worst): (usize, f64) = (0, 0.0);
    for row in &rows {
        let (speed, g, k) = (value(row, 1), value(row, 2), value(row, 3));
        // Heavily damped roots amplify the interpolation error of Q.
        if k > 1.5 || g < -0.2 {
            continue;
        }
        let result = sweep(&section, speed, speed, 2).methods.pk.unwrap();
        let nearest = result
            .branches
            .iter()
            .map(|branch| (branch.g[0] - g).hypot(branch.k[0] - k))
            .fold(f64::INFINITY, f64::min);
        worst = worst.max(nearest);
        checked += 1;
        assert!(
            nearest < 1e-4,
            "V = {speed}, g = {g}, k = {k}: off by {nearest}"
        );
    }
    println!("{checked} p-k roots, largest difference {worst:.1e}");
    assert!(checked >= 20);
}

/// Refined on the rational fit of samples off the axis too, the sections
/// flutter within 1e-5 of the exact speed, and the roots of the file with
/// $g > -0.1$ are found within 1e-5, those down to $-0.2$ within 5e-4: the
/// exact function has a cut where the model has poles.
#[test]
fn rational_fit_refines_the_sections() {
    for name in [
        "stability_section2_theodorsen.json",
        "stability_section3_theodorsen.json",
    ] {
        let section = section(name, |_| true);
        let fit = PiecewiseQuadratic::of(&section.table).unwrap();
        let smooth = RationalFit::new(&section.table).unwrap();
        println!(
            "{name}: residual {:.1e}, poles {:?}",
            smooth.residual(),
            smooth.poles()
        );
        let truth = section.file["truth"].as_array().unwrap();
        let values = truth.iter().map(|t| number(&t["U"]));
        let schedule = speeds(values, section.density);
        let result = Sweep {
            smooth: Some(&smooth),
            method: fladder_stability::Method::P2,
            ..Sweep::new(&section.system, &schedule, &section.table, &fit)
        }
        .run(&())
        .unwrap()
        .methods
        .polished
        .unwrap();
        println!("complete {:?}", result.complete);
        let mut worst: f64 = 0.0;
        for (number, truth) in truth.iter().enumerate() {
            let exact = common::roots(&truth["roots"]);
            for root in exact
                .iter()
                .filter(|p| p.re > -0.2 && p.im < 1.5 && p.im > 0.0)
            {
                let miss = result
                    .branches
                    .iter()
                    .filter(|b| b.first <= number && number < b.first + b.g.len())
                    .map(|b| (b.g[number - b.first], b.k[number - b.first]))
                    .map(|(g, k)| (root.re - g).hypot(root.im - k))
                    .fold(f64::INFINITY, f64::min);
                println!("speed {number}: {root} missed by {miss:.1e}");
                assert!(miss < 5e-4, "{root} missed by {miss}");
                if root.re > -0.1 {
                    worst = worst.max(miss);
                }
            }
        }
        assert!(worst < 1e-5, "a root is missed by {worst}");
        check_flutter("rational", &result, &section, 1e-5);
    }
}

/// Two, three or four samples, with or without k = 0, make a table on which
/// every method runs: less accurate, without a fault.
#[test]
fn few_samples_are_enough_to_run() {
    for (start, count) in [(0, 2), (0, 3), (2, 2), (2, 3), (2, 4), (0, 7)] {
        let full = section("stability_section2_theodorsen.json", |g| g == 0.0);
        let points = full
            .table
            .k()
            .iter()
            .zip(full.table.axis())
            .skip(start)
            .step_by(3)
            .take(count)
            .map(|(&k, q)| GafPoint {
                g: 0.0,
                k,
                q: q.clone(),
            })
            .collect();
        let modes = full.table.modes().to_vec();
        let table = GafTable::new(1.0, 0.0, modes, points, vec![]).unwrap();
        let fit = PiecewiseQuadratic::of(&table).unwrap();
        let smooth = RationalFit::new(&table).unwrap();
        assert_eq!(fit.notes().is_empty(), start == 0, "{:?}", fit.notes());
        let schedule = speeds(range(1.5, 2.5, 5), full.density);
        let result = Sweep {
            smooth: Some(&smooth),
            pk_form: PkForm::RealMatrices,
            ..Sweep::new(&full.system, &schedule, &table, &fit)
        }
        .run(&())
        .unwrap();
        let branches = result.methods.p2.unwrap().branches.len();
        println!("{count} samples from number {start}: {branches} branches");
        if count == 7 {
            assert!(branches >= 2);
        }
    }
}
