//! A flutter summary in the columns of Nastran's solution 145, method PK.
//!
//! One point a branch, every speed of the sweep a line: reduced frequency with the
//! semichord, its inverse, velocity, damping $2\sigma/\omega$, frequency, and the eigenvalue in
//! 1/s. A speed at which the branch is not there, and the damping of a real root, is NaN.

use fladder_stability::{Branch, MethodResult};
use std::fmt::Write;

/// What Nastran prints for 1/0.
const INFINITE: f64 = 9.999_999_6e24;

/// The whole file.
pub(crate) fn summary(result: &MethodResult, speeds: &[f64], mach: f64) -> String {
    let mut text = String::new();
    for (number, branch) in result.branches.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "0{:108}SUBCASE 1\n0{:55}FLUTTER  SUMMARY\n{:25}CONFIGURATION = AEROSG2D     \
             XY-SYMMETRY = ASYMMETRIC     XZ-SYMMETRY = ASYMMETRIC\n       POINT = {:5}     MACH \
             NUMBER = {mach:7.4}     DENSITY RATIO = {:.4E}     METHOD = PK\n\n\n    \
             KFREQ          1./KFREQ         VELOCITY            DAMPING       FREQUENCY            \
             COMPLEX   EIGENVALUE\n",
            "",
            "",
            "",
            number + 1,
            1.0
        );
        for speed in speeds {
            line(&mut text, branch, *speed);
        }
        let _ = writeln!(text, "1 {:60} PAGE {:5}", branch.name, number + 1);
    }
    text.push_str(" * * * END OF JOB * * *\n");
    text
}

fn line(text: &mut String, branch: &Branch, speed: f64) {
    let at = branch.speed.iter().position(|own| *own == speed);
    let value = |list: &[f64]| at.map_or(f64::NAN, |at| list[at]);
    let k = value(&branch.k);
    let inverse = if k == 0.0 { INFINITE } else { 1.0 / k };
    let damping = at
        .and_then(|at| branch.structural_damping[at])
        .unwrap_or(f64::NAN);
    let _ = write!(text, "{:>11}", fixed(k));
    for number in [
        inverse,
        speed,
        damping,
        value(&branch.frequency_hz),
        value(&branch.sigma),
        value(&branch.omega),
    ] {
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
