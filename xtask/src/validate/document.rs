//! `docs/validation.md`: one marked part a validation, so that one can be renewed alone.

use super::parts::Part;
use crate::marked::replaced;
use fladder_tests::convergence::Refinement;
use fladder_tests::row::Row;
use std::fmt::Write as _;
use std::path::Path;

const HEAD: &str = "# Validation\n\n\
    Measured by `cargo xtask validate`, which writes this page and fails where a goal is not \
    met. Reference values come from the files in `tests/data`, whose heads say what they are. \
    The same cases run on smaller meshes in `cargo test`.\n";

/// Text of a part made of rows.
pub(crate) fn table(title: &str, about: &str, rows: &[Row]) -> String {
    let mut text = format!(
        "## {title}\n\n{about}\n\n| case | mesh | figure | error | goal | |\n|---|---|---|---|---|---|\n"
    );
    for row in rows {
        text.push_str(&row.markdown());
        text.push('\n');
    }
    text
}

/// Text of the part on refinement.
pub(crate) fn refinement(found: &Refinement, goals: &[f64]) -> String {
    let mut text = String::from(
        "## Refinement of the ScanEagle-like surface\n\n\
         Derivatives per rad (moments about the centre of mass; areas and chord of the case, \
         span = area / chord) and the 20 largest entries of Q at k = 0.2. Extrapolated with \
         h ~ 1/√N and the order observed on the three finest meshes, in brackets, or 1 where \
         they show none. Beside each value its distance from the extrapolated one; for \
         complex entries \\|Q\\| and the size of the complex distance. The meshes are of one \
         generator; `scaneagle_3k.msh` and `scaneagle_10k.msh` are in `meshes/`, a finer one \
         is too large to be kept there.\n\n",
    );
    let names: Vec<String> = found
        .meshes
        .iter()
        .map(|(name, triangles)| format!("{name}, {triangles} triangles"))
        .collect();
    let _ = writeln!(text, "| | {} | extrapolated |", names.join(" | "));
    let _ = writeln!(text, "|---|{}---|", "---|".repeat(names.len()));
    for quantity in &found.quantities {
        let cells: Vec<String> = quantity
            .values
            .iter()
            .zip(&quantity.errors)
            .map(|(value, error)| format!("{value:.5} ({:.2} %)", 100.0 * error))
            .collect();
        let _ = writeln!(
            text,
            "| {} | {} | {:.5} (order {:.1}) |",
            quantity.name,
            cells.join(" | "),
            quantity.limit,
            quantity.order
        );
    }
    let worst: Vec<String> = (0..goals.len())
        .map(|mesh| {
            let (worst, goal) = (found.worst(mesh), goals[mesh]);
            let verdict = match goal {
                g if g.is_infinite() => String::new(),
                g if worst <= g => format!(", goal {:.0} %: met", 100.0 * g),
                g => format!(", goal {:.0} %: **not met**", 100.0 * g),
            };
            format!("{:.2} %{verdict}", 100.0 * worst)
        })
        .collect();
    let _ = writeln!(text, "| largest distance | {} | |", worst.join(" | "));
    text
}

/// Mark of the part on refinement.
pub(crate) const REFINEMENT: &str = "refinement";

/// Puts a part into the document, in the place of the one with the same mark; where there is
/// no document, one with places for all parts is begun.
pub(crate) fn put(path: &Path, mark: &str, text: &str) -> std::io::Result<()> {
    let old = if path.exists() {
        std::fs::read_to_string(path)?
    } else {
        empty()
    };
    std::fs::write(path, replaced(&old, mark, text))
}

/// The head and an empty place for each part, in order.
fn empty() -> String {
    let marks = Part::all().iter().map(|part| part.mark());
    marks
        .chain([REFINEMENT.to_owned()])
        .fold(HEAD.to_owned(), |text, mark| replaced(&text, &mark, ""))
}
