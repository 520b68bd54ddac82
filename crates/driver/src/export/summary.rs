//! A flutter summary in the columns of Nastran's solution 145, method PK, or PKNL where
//! density and Mach number change from line to line.
//!
//! One point a branch, every speed of the sweep a line: reduced frequency with the
//! semichord, its inverse, with PKNL density in kg/m³ and Mach number, velocity, damping
//! $2\sigma/\omega$, frequency, and the eigenvalue in 1/s. A speed at which the branch is not
//! there, and the damping of a real root, is NaN.

use fladder_stability::{Branch, MethodResult};
use std::fmt::Write;

/// What Nastran prints for 1/0.
const INFINITE: f64 = 9.999_999_6e24;

/// Density of which a density ratio of PK is a part: ISO 2533 at sea level, kg/m³.
const REFERENCE_DENSITY: f64 = 1.225;

/// The whole file; `density` is that of the whole sweep, none where it changes.
pub(crate) fn summary(
    result: &MethodResult,
    speeds: &[f64],
    mach: f64,
    density: Option<f64>,
) -> String {
    let conditions: Vec<Option<[f64; 2]>> = speeds
        .iter()
        .map(|speed| condition(result, *speed))
        .collect();
    let varies = conditions.iter().any(Option::is_some);
    let method = if varies {
        "METHOD = PKNL\n".to_owned()
    } else {
        let ratio = density.unwrap_or(f64::NAN) / REFERENCE_DENSITY;
        format!("MACH NUMBER = {mach:7.4}     DENSITY RATIO = {ratio:.4E}     METHOD = PK\n")
    };
    let columns = if varies {
        "    KFREQ          1./KFREQ          DENSITY           MACH NO.         VELOCITY"
    } else {
        "    KFREQ          1./KFREQ         VELOCITY"
    };
    let mut text = String::new();
    for (number, branch) in result.branches.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "0{:108}SUBCASE 1\n0{:55}FLUTTER  SUMMARY\n{:25}CONFIGURATION = AEROSG2D     \
             XY-SYMMETRY = ASYMMETRIC     XZ-SYMMETRY = ASYMMETRIC\n       POINT = {:5}     \
             {method}\n\n{columns}            DAMPING       FREQUENCY            COMPLEX   \
             EIGENVALUE\n",
            "",
            "",
            "",
            number + 1,
        );
        for (speed, condition) in speeds.iter().zip(&conditions) {
            let condition = varies.then(|| condition.unwrap_or([f64::NAN; 2]));
            line(&mut text, branch, *speed, condition);
        }
        let _ = writeln!(text, "1 {:60} PAGE {:5}", branch.name, number + 1);
    }
    text.push_str(" * * * END OF JOB * * *\n");
    text
}

/// Density and Mach number at a speed, where branches carry them.
fn condition(result: &MethodResult, speed: f64) -> Option<[f64; 2]> {
    result.branches.iter().find_map(|branch| {
        let at = branch.speed.iter().position(|own| *own == speed)?;
        let density = branch.density.as_ref()?.get(at)?;
        let mach = branch.mach.as_ref()?.get(at)?;
        Some([*density, *mach])
    })
}

fn line(text: &mut String, branch: &Branch, speed: f64, condition: Option<[f64; 2]>) {
    let at = branch.speed.iter().position(|own| *own == speed);
    let value = |list: &[f64]| at.map_or(f64::NAN, |at| list[at]);
    let k = value(&branch.k);
    let inverse = if k == 0.0 { INFINITE } else { 1.0 / k };
    let damping = at
        .and_then(|at| branch.structural_damping[at])
        .unwrap_or(f64::NAN);
    let _ = write!(text, "{:>11}{:>17}", fixed(k), exponential(inverse));
    let more = [
        speed,
        damping,
        value(&branch.frequency_hz),
        value(&branch.sigma),
        value(&branch.omega),
    ];
    for number in condition.into_iter().flatten().chain(more) {
        let _ = write!(text, "{:>17}", exponential(number));
    }
    text.push('\n');
}

fn fixed(value: f64) -> String {
    if value.is_nan() {
        "NaN".to_owned()
    } else {
        format!("{value:.4}")
    }
}

fn exponential(value: f64) -> String {
    if value.is_nan() {
        return "NaN".to_owned();
    }
    let text = format!("{value:.7E}");
    let (digits, exponent) = text.split_once('E').unwrap_or((&text, "0"));
    let (sign, size) = match exponent.strip_prefix('-') {
        Some(size) => ('-', size),
        None => ('+', exponent),
    };
    format!("{digits}E{sign}{size:0>2}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn branch(density: Option<Vec<f64>>) -> MethodResult {
        let branch = Branch {
            name: "elastic:1".to_owned(),
            speed: vec![20.0, 30.0],
            k: vec![0.5, 0.0],
            sigma: vec![-1.0; 2],
            omega: vec![10.0, 0.0],
            frequency_hz: vec![1.6, 0.0],
            structural_damping: vec![Some(-0.2), None],
            mach: density.as_ref().map(|_| vec![0.25, 0.5]),
            density,
            ..Branch::default()
        };
        MethodResult {
            branches: vec![branch],
            ..MethodResult::default()
        }
    }

    #[test]
    fn one_density_is_a_ratio_to_sea_level() {
        let text = summary(&branch(None), &[20.0, 30.0], 0.1, Some(0.6125));
        assert!(
            text.contains(
                "MACH NUMBER =  0.1000     DENSITY RATIO = 5.0000E-1     METHOD = PK\n"
            )
        );
        let line = text.lines().find(|line| line.contains("2.0000000E+01"));
        assert_eq!(line.map(|line| line.split_whitespace().count()), Some(7));
    }

    #[test]
    fn density_and_mach_number_that_change_stand_in_every_line() {
        let result = branch(Some(vec![1.0, 0.5]));
        let text = summary(&result, &[20.0, 30.0, 40.0], 0.0, None);
        assert!(text.contains("METHOD = PKNL\n") && !text.contains("DENSITY RATIO"));
        let columns = |speed: &str| -> Vec<String> {
            let line = text.lines().find(|line| line.contains(speed));
            let words = line.unwrap_or_default().split_whitespace();
            words.map(str::to_owned).collect()
        };
        assert_eq!(
            columns("2.0000000E+01")[2..5],
            ["1.0000000E+00", "2.5000000E-01", "2.0000000E+01"]
        );
        assert_eq!(
            columns("3.0000000E+01")[2..4],
            ["5.0000000E-01", "5.0000000E-01"]
        );
        // No branch is there.
        assert_eq!(columns("4.0000000E+01")[2..4], ["NaN", "NaN"]);
    }
}
