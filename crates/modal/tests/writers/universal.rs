//! Universal files.

use super::{lambda, rotation};
use fladder_modal::ModalResult;
use std::fmt::Write;

fn real(value: f64) -> String {
    let text = format!("{value:.5e}");
    let (mantissa, exponent) = text.split_once('e').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{:>13}", format!("{mantissa}e{sign}{:02}", exponent.abs()))
}

/// Nodes in dataset 2411, modes in 55 or 2414.
pub(crate) fn unv(contents: &ModalResult, results: bool) -> String {
    let mut text = String::from("    -1\n  2411\n");
    for node in &contents.nodes {
        writeln!(text, "{:10}{:10}{:10}{:10}", node.id, 1, 1, 11).unwrap();
        for x in &node.position {
            write!(text, "{:>25}", format!("{x:.16e}")).unwrap();
        }
        text.push('\n');
    }
    text.push_str("    -1\n");
    for mode in &contents.modes {
        let (f, l, m) = (mode.frequency_hz, lambda(mode), mode.generalised_mass);
        let zero = real(0.0);
        if results {
            writeln!(text, "    -1\n  2414\n{:10}\nmodes\n{:10}", mode.index, 1).unwrap();
            text.push_str(&"NONE\n".repeat(5));
            text.push_str("         1         2         3         8         2         6\n");
            let index = mode.index;
            writeln!(
                text,
                "{:10}{:10}{:10}{:10}{:10}{index:10}{:10}{:10}",
                0, 1, 1, 0, 1, 0, 0
            )
            .unwrap();
            text.push_str("         0         0\n");
            writeln!(text, "{zero}{}{}{}{zero}{zero}", real(f), real(l), real(m)).unwrap();
            writeln!(text, "{}", zero.repeat(6)).unwrap();
        } else {
            text.push_str("    -1\n    55\n");
            text.push_str(&"NONE\n".repeat(5));
            text.push_str("         1         2         3         8         2         6\n");
            writeln!(text, "{:10}{:10}{:10}{:10}", 2, 4, 0, mode.index).unwrap();
            writeln!(text, "{}{}{zero}{zero}", real(f), real(m)).unwrap();
        }
        for (node, u) in contents.nodes.iter().zip(&mode.displacement) {
            writeln!(text, "{:10}", node.id).unwrap();
            let rotation = rotation(u);
            let values: String = u.iter().chain(&rotation).map(|x| real(*x)).collect();
            text.push_str(&values);
            text.push('\n');
        }
        text.push_str("    -1\n");
    }
    text
}
