//! Bulk data, punch and printed files.

use super::{lambda, rotation};
use fladder_mesh::Vec3;
use fladder_modal::ModalResult;
use std::fmt::Write;

/// Layout of bulk data.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Fields {
    Large,
    Free,
}

/// Sixteen columns with the digits that fit, the exponent without its letter.
fn large(value: f64) -> String {
    let text = format!("{value:.8e}");
    let (mantissa, exponent) = text.split_once('e').unwrap();
    let sign = if exponent.starts_with('-') { "" } else { "+" };
    format!("{mantissa}{sign}{exponent}")
}

pub(crate) fn bdf(contents: &ModalResult, fields: Fields) -> String {
    let mut text = String::from("SOL 103\nCEND\nBEGIN BULK\n");
    for node in &contents.nodes {
        let p = node.position;
        match fields {
            Fields::Large => writeln!(
                text,
                "GRID*   {:16}{:16}{:>16}{:>16}*\n*       {:>16}",
                node.id,
                0,
                large(p.x),
                large(p.y),
                large(p.z)
            ),
            Fields::Free => writeln!(text, "GRID,{},,{:?},{:?},{:?}", node.id, p.x, p.y, p.z),
        }
        .unwrap();
    }
    text.push_str("ENDDATA\n");
    text
}

fn number(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$E}");
    let (mantissa, exponent) = text.split_once('E').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{mantissa}E{sign}{:02}", exponent.abs())
}

fn numbers(u: &Vec3, width: usize) -> String {
    let mut text = String::new();
    for x in u {
        write!(text, "{:>width$}", number(*x, 6)).unwrap();
    }
    text
}

pub(crate) fn pch(contents: &ModalResult) -> String {
    let mut lines: Vec<String> = Vec::new();
    for mode in &contents.modes {
        lines.extend(
            [
                "$TITLE   = RANDOM",
                "$SUBTITLE=",
                "$LABEL   =",
                "$EIGENVECTOR",
                "$REAL OUTPUT",
            ]
            .map(str::to_owned),
        );
        lines.push("$SUBCASE ID =           1".to_owned());
        let value = number(lambda(mode), 7);
        lines.push(format!("$EIGENVALUE =  {value}  MODE = {:5}", mode.index));
        for (node, u) in contents.nodes.iter().zip(&mode.displacement) {
            lines.push(format!("{:10}       G{}", node.id, numbers(u, 18)));
            lines.push(format!("-CONT-            {}", numbers(&rotation(u), 18)));
        }
    }
    let mut text = String::new();
    for (k, line) in (1..).zip(&lines) {
        writeln!(text, "{line:<72}{k:8}").unwrap();
    }
    text
}

pub(crate) fn f06(contents: &ModalResult) -> String {
    let page = "1    RANDOM                                    PAGE     1\n \n0\n \n";
    let mut text = String::from("1\n0        N A S T R A N    E X E C U T I V E\n");
    writeln!(text, "{page}{:46}R E A L   E I G E N V A L U E S", "").unwrap();
    text.push_str(
        "   MODE    EXTRACTION      EIGENVALUE            RADIANS\n    NO.       ORDER\n",
    );
    for mode in &contents.modes {
        write!(text, "{:9}{:10}", mode.index, mode.index).unwrap();
        let l = lambda(mode);
        let m = mode.generalised_mass;
        for value in [l, l.sqrt(), mode.frequency_hz, m, l * m] {
            write!(text, "{:>20}", number(value, 6)).unwrap();
        }
        text.push('\n');
    }
    for mode in &contents.modes {
        let table: Vec<_> = contents.nodes.iter().zip(&mode.displacement).collect();
        for rows in table.chunks(7) {
            let value = number(lambda(mode), 6);
            writeln!(text, "{page}      EIGENVALUE =  {value}").unwrap();
            writeln!(
                text,
                "          CYCLES =  {}         R E A L   E I G E N V E C T O R   N O .{:11}\n \n      \
                 POINT ID.   TYPE          T1             T2",
                number(mode.frequency_hz, 6),
                mode.index
            )
            .unwrap();
            for (node, u) in rows {
                let values = numbers(u, 15) + &numbers(&rotation(u), 15);
                writeln!(text, "{:14}      G{values}", node.id).unwrap();
            }
        }
    }
    text + page
}
