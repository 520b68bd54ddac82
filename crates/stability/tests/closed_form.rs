//! Sections and a cantilever wing with $Q(p)$ in closed form: what is left is
//! the error of the solution, not that of the samples.

#![allow(
    clippy::unwrap_used,
    reason = "a fault in the reference data must stop the test"
)]

mod common;

use common::strip::StripWing;
use common::theodorsen::theodorsen;
use common::{Columns, Section, SectionForces, number, range, read_json, section, speeds};
use faer::{Mat, c64};
use fladder_stability::{
    Aerodynamics, FromFunction, GafPoint, GafTable, Method, MethodResult, PiecewiseQuadratic,
    Sweep, SweepResult,
};

/// Samples on the axis at $k = 1.5(i/20)^{1.5}$.
fn graded_table(semichord: f64, modes: Vec<String>, q: impl Fn(c64) -> Mat<c64>) -> GafTable {
    let points = (0..=20)
        .map(|i| 1.5 * (f64::from(i) / 20.0).powf(1.5))
        .map(|k| GafPoint {
            g: 0.0,
            k,
            q: q(c64::new(0.0, k)),
        })
        .collect();
    GafTable::new(semichord, 0.0, modes, points, vec![]).unwrap()
}

/// The test's own C(p) against 30-digit values.
#[test]
fn theodorsen_function_agrees_with_the_table() {
    let table = Columns::read("theodorsen_complex_open.csv");
    let (g, k) = (table.numbers("g"), table.numbers("k"));
    let (re, im) = (table.numbers("ReC"), table.numbers("ImC"));
    let mut worst: f64 = 0.0;
    for i in 0..g.len() {
        let p = c64::new(g[i], k[i]);
        if p.norm() < 3.0 {
            worst = worst.max((theodorsen(p) - c64::new(re[i], im[i])).norm());
        }
    }
    println!("C(p): largest difference {worst:.1e}");
    assert!(worst < 1e-12);
}

/// All methods on a section with its closed form.
fn sweep(section: &Section, speeds: &[fladder_stability::OperatingPoint]) -> SweepResult {
    let forces = SectionForces::of(&section.file);
    let exact = FromFunction::new(section.table.order(), |p| forces.q(p));
    let fit = PiecewiseQuadratic::centred(&section.table, 0.2).unwrap();
    let speeds = speeds.to_vec();
    Sweep {
        smooth: Some(&exact),
        pk_forces: Some(&exact),
        ..Sweep::new(&section.system, &speeds, &section.table, &fit)
    }
    .run(&())
    .unwrap()
}

/// Flutter within 1e-4 by p2 from 21 samples, 1e-8 polished and by p-k with
/// the closed form; divergence the same.
#[test]
fn sections_flutter_and_diverge_at_the_exact_speeds() {
    for (name, flutter, divergence) in [
        ("stability_section2_theodorsen.json", [1.5, 2.6], [2.6, 3.2]),
        ("stability_section2_jones.json", [1.5, 2.6], [2.6, 3.2]),
        ("stability_section3_theodorsen.json", [2.0, 4.0], [6.0, 6.6]),
    ] {
        let section = section(name, |g| g == 0.0);
        let at = |[from, to]: [f64; 2]| speeds(range(from, to, 13), section.density);
        let result = sweep(&section, &at(flutter)).methods;
        let exact = &section.file["flutter"][0];
        let exact = [number(&exact["U"]), number(&exact["k"])];
        for (method, outcome, tolerance) in [
            ("p2", &result.p2, 1e-4),
            ("polished", &result.polished, 1e-8),
            ("p-k", &result.pk, 1e-8),
        ] {
            let found = &outcome.as_ref().unwrap().flutter;
            assert_eq!(found.len(), 1, "{name} {method}: {found:?}");
            let errors = [found[0].speed / exact[0] - 1.0, found[0].k / exact[1] - 1.0];
            println!(
                "{name} {method}: flutter U* {:.10}, errors {:.1e} {:.1e}",
                found[0].speed, errors[0], errors[1]
            );
            assert!(errors[0].abs() < tolerance && errors[1].abs() < 10.0 * tolerance);
        }
        let result = sweep(&section, &at(divergence)).methods;
        let exact = number(&section.file["divergence_U"][0]);
        for (method, outcome, tolerance) in [
            ("p2", &result.p2, 1e-4),
            ("polished", &result.polished, 1e-8),
            ("p-k", &result.pk, 1e-8),
        ] {
            let found = &outcome.as_ref().unwrap().divergence;
            assert_eq!(found.len(), 1, "{name} {method}: {found:?}");
            let error = found[0].speed / exact - 1.0;
            println!(
                "{name} {method}: divergence {:.10}, error {error:.1e}",
                found[0].speed
            );
            assert!(error.abs() < tolerance);
        }
    }
}

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

/// At every speed of the file the polished roots with $|g|\le0.2$,
/// $10^{-3}<k\le1.5$ and those on the positive real axis are the file's: none
/// missed, none invented, all to 1e-9.
#[test]
fn no_root_of_a_section_is_missed_or_invented() {
    for (name, roots) in [
        (
            "stability_section2_theodorsen.json",
            "typical_section_TS1_classic.csv",
        ),
        (
            "stability_section3_theodorsen.json",
            "typical_section_TS3_flap_karpel.csv",
        ),
    ] {
        let section = section(name, |g| g == 0.0);
        let table = Columns::read(roots);
        let (v, g, k) = (table.numbers("V"), table.numbers("g"), table.numbers("k"));
        let mut airspeeds = v.clone();
        airspeeds.dedup();
        let points = speeds(airspeeds.iter().copied(), section.density);
        let result = sweep(&section, &points).methods.polished.unwrap();
        let is_judged =
            |p: &c64| p.re.abs() <= 0.2 && p.im <= 1.5 && (p.im > 1e-3 || p.re > 0.0);
        let (mut count, mut worst): (usize, f64) = (0, 0.0);
        for (number, airspeed) in airspeeds.iter().enumerate() {
            let exact: Vec<c64> = (0..v.len())
                .filter(|&row| v[row] == *airspeed)
                .map(|row| c64::new(g[row], k[row]))
                .filter(is_judged)
                .collect();
            let found: Vec<c64> = found_at(&result, number)
                .into_iter()
                .filter(is_judged)
                .collect();
            assert_eq!(
                found.len(),
                exact.len(),
                "V = {airspeed}: {found:?}, exact {exact:?}"
            );
            for root in &exact {
                let miss = found
                    .iter()
                    .map(|other| (other - root).norm())
                    .fold(f64::INFINITY, f64::min);
                worst = worst.max(miss);
                count += 1;
            }
        }
        println!("{name}: {count} roots, largest difference {worst:.1e}");
        println!("  counted {:?}", result.count.as_ref().unwrap());
        assert!(result.complete.unwrap().iter().all(|met| *met));
        assert!(count > 20 && worst < 1e-9);
    }
}

/// p-k roots with Q in closed form are the file's to 1e-6, from the 21 samples
/// to 1e-3 where $|g|\le0.2$. Of those with more damping two are worse, by
/// 2e-3: they lie below the second sample, where $C(\mathrm ik)$ goes as
/// $k\ln k$.
#[test]
fn pk_roots_of_the_sections_agree_with_the_file() {
    let table = Columns::read("typical_section_pk_open.csv");
    let (names, v) = (table.words("name"), table.numbers("V"));
    let (g, k) = (table.numbers("pk_g"), table.numbers("pk_k"));
    for (name, file) in [
        ("TS1_classic", "stability_section2_theodorsen.json"),
        ("TS3_flap_karpel", "stability_section3_theodorsen.json"),
    ] {
        let section = section(file, |g| g == 0.0);
        let forces = SectionForces::of(&section.file);
        let exact = FromFunction::new(section.table.order(), |p| forces.q(p));
        let fit = PiecewiseQuadratic::centred(&section.table, 0.2).unwrap();
        for (given, source, tolerance) in [
            (Some(&exact as &dyn Aerodynamics), "closed form", 1e-6),
            (None, "21 samples", 1e-3),
        ] {
            let (mut worst, mut outside, mut count): (f64, f64, usize) = (0.0, 0.0, 0);
            for row in (0..v.len()).filter(|&row| names[row] == name && k[row] < 1.5) {
                let points = speeds([v[row]], section.density);
                let result = Sweep {
                    method: Method::Pk,
                    pk_forces: given,
                    ..Sweep::new(&section.system, &points, &section.table, &fit)
                }
                .run(&())
                .unwrap();
                let result = result.methods.pk.unwrap();
                let miss = found_at(&result, 0)
                    .into_iter()
                    .map(|p| (p - c64::new(g[row], k[row])).norm())
                    .fold(f64::INFINITY, f64::min);
                if g[row].abs() <= 0.2 {
                    worst = worst.max(miss);
                } else {
                    outside = outside.max(miss);
                }
                count += 1;
            }
            println!(
                "{name}, {source}: {count} p-k roots, largest difference {worst:.1e}, with |g| > 0.2 \
                 {outside:.1e}"
            );
            assert!(count >= 20 && worst < tolerance);
        }
    }
}

/// The Goland wing in two to four modes of bending and of twist: flutter of
/// each to 1e-8 of the same discretisation, p2 to 1e-4 of the exact beam,
/// divergence of the exact beam as far as the modes go.
#[test]
fn goland_wing_flutters_at_the_exact_speed() {
    let file = read_json("goland_beam_strip.json");
    let parse = |value: &serde_json::Value| -> f64 { value.as_str().unwrap().parse().unwrap() };
    let exact = parse(&file["flutter"][0]["U"]);
    for modes in [2, 3, 4] {
        let listed = file["assumed_modes_convergence"].as_array().unwrap();
        let same = listed
            .iter()
            .find(|entry| entry["bending_and_torsion_modes_each"] == modes)
            .unwrap();
        let wing = StripWing::new(&file, modes);
        let table = graded_table(wing.semichord, wing.names(), |p| wing.q(p));
        let fit = PiecewiseQuadratic::of(&table).unwrap();
        let smooth = FromFunction::new(2 * modes, |p| wing.q(p));
        let system = wing.system();
        let points = speeds(range(110.0, 160.0, 11), wing.density);
        let result = Sweep {
            smooth: Some(&smooth),
            ..Sweep::new(&system, &points, &table, &fit)
        }
        .run(&())
        .unwrap()
        .methods;
        let speed = |outcome: &Option<MethodResult>| outcome.as_ref().unwrap().flutter[0].speed;
        let (p2, polished) = (speed(&result.p2), speed(&result.polished));
        let discrete = parse(&same["U"]);
        println!(
            "{modes} modes each: p2 {p2:.6} ({:.1e} of the exact beam), polished {polished:.8} \
             ({:.1e} of the same modes)",
            p2 / exact - 1.0,
            polished / discrete - 1.0
        );
        assert!((p2 / exact - 1.0).abs() < 1e-4);
        // The file gives eleven digits.
        assert!((polished / discrete - 1.0).abs() < 1e-8);
        let hertz = result.polished.as_ref().unwrap().flutter[0].frequency_hz;
        let omega = hertz * std::f64::consts::TAU;
        assert!((omega / parse(&same["omega"]) - 1.0).abs() < 1e-8);
        let points = speeds(range(230.0, 270.0, 5), wing.density);
        let result = Sweep::new(&system, &points, &table, &fit).run(&()).unwrap();
        let diverged = result.methods.pk.unwrap().divergence[0].speed;
        let exact = parse(&file["divergence_U"][0]);
        println!("  divergence {diverged:.6}, exact beam {exact:.6}");
        assert!(diverged > exact && diverged / exact - 1.0 < 2e-2 / modes as f64);
    }
}

/// The flat wing of aspect ratio 8, clamped and free, from the seven samples
/// on the imaginary axis: flutter within the file's three digits.
#[test]
fn flat_wing_flutters_where_the_file_says() {
    let file = read_json("wing3d_flutter_ar8.json");
    let samples = Columns::read("laplace_gaf_rect_ar8.csv");
    for case in ["A", "B"] {
        let case = &file["cases"][case];
        let modes: Vec<usize> = case["modes"]
            .as_array()
            .unwrap()
            .iter()
            .map(|mode| mode.as_u64().unwrap() as usize)
            .collect();
        let names: Vec<String> = modes.iter().map(|mode| format!("plate:{mode}")).collect();
        let table = plate_table(&samples, &modes, &names, |g, _| g == 0.0);
        // The samples with g < 0 begin at k = 0.2.
        let whole = plate_table(&samples, &modes, &names, |_, k| k >= 0.2);
        let system = plate_system(case, &modes, &names);
        let fit = PiecewiseQuadratic::of(&table).unwrap();
        let smooth = fladder_stability::RationalFit::new(&whole).unwrap();
        println!("residual of the rational fit {:.1e}", smooth.residual());
        let exact = &case["crossings"][0];
        let (speed, k) = (number(&exact["U"]), number(&exact["k"]));
        let points = speeds(range(0.8 * speed, 1.2 * speed, 9), 1.225);
        let result = Sweep {
            smooth: Some(&smooth),
            ..Sweep::new(&system, &points, &table, &fit)
        }
        .run(&())
        .unwrap()
        .methods;
        for (method, outcome) in [
            ("p2", &result.p2),
            ("polished", &result.polished),
            ("p-k", &result.pk),
        ] {
            let found = &outcome.as_ref().unwrap().flutter;
            let errors = [found[0].speed / speed - 1.0, found[0].k / k - 1.0];
            println!(
                "{method}: {:.4} m/s, errors {:.1e} {:.1e}",
                found[0].speed, errors[0], errors[1]
            );
            assert_eq!(found.len(), 1);
            assert!(errors.iter().all(|error| error.abs() < 1e-3));
        }
    }
}

fn plate_table(
    samples: &Columns,
    modes: &[usize],
    names: &[String],
    wanted: impl Fn(f64, f64) -> bool,
) -> GafTable {
    let (g, k) = (samples.numbers("g"), samples.numbers("k"));
    let (i, j) = (samples.numbers("i"), samples.numbers("j"));
    let (re, im) = (samples.numbers("ReQ"), samples.numbers("ImQ"));
    let mut points: Vec<GafPoint> = Vec::new();
    for row in (0..g.len()).filter(|&row| wanted(g[row], k[row])) {
        let place = |index: f64| modes.iter().position(|mode| *mode as f64 == index);
        let (Some(i), Some(j)) = (place(i[row]), place(j[row])) else {
            continue;
        };
        let known = points
            .iter()
            .position(|point| point.g == g[row] && point.k == k[row]);
        let at = known.unwrap_or_else(|| {
            points.push(GafPoint {
                g: g[row],
                k: k[row],
                q: Mat::zeros(modes.len(), modes.len()),
            });
            points.len() - 1
        });
        points[at].q[(i, j)] = c64::new(re[row], im[row]);
    }
    GafTable::new(0.5, 0.0, names.to_vec(), points, vec![]).unwrap()
}

/// Mass and stiffness as the head of the file gives them.
fn plate_system(
    case: &serde_json::Value,
    modes: &[usize],
    names: &[String],
) -> fladder_stability::System {
    let d = number(&case["x_cg"]) - 0.5;
    let j = 0.0625 + d * d;
    let (third, fifth) = (1.0 / 3.0, 0.2);
    let whole = [
        [1.0, -d, third, -d * third],
        [-d, j, -d * third, j * third],
        [third, -d * third, fifth, -d * fifth],
        [-d * third, j * third, -d * fifth, j * fifth],
    ];
    let scale = 2.0 * 4.0 * 9.621_127_501_2;
    let entry = |i: usize, j: usize| scale * whole[modes[i] - 1][modes[j] - 1];
    let rates = [0.0, 0.0, number(&case["wb"]), number(&case["wt"])];
    let order = modes.len();
    let mass = Mat::from_fn(order, order, entry);
    let stiffness = Mat::from_fn(order, order, |i, j| {
        if i == j {
            entry(i, i) * rates[modes[i] - 1].powi(2)
        } else {
            0.0
        }
    });
    let still = Mat::zeros(order, order);
    fladder_stability::System::from_matrices(names.to_vec(), mass, still, stiffness).unwrap()
}
