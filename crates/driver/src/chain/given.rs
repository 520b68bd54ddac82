//! Forces from files of other programs.

use super::conditions::Conditions;
use super::forces::{Forces, in_body_frame, side_by_side};
use super::level;
use super::structure::StructureData;
use crate::case::CaseFile;
use crate::failure::Failure;
use crate::gaf_json::{self, Given};
use fladder_stability::{MachNumbers, Mixture};
use std::path::PathBuf;
use std::sync::Arc;

/// Forces at M = 0 serve up to this Mach number, with a warning.
const INCOMPRESSIBLE: f64 = 0.3;

/// A file that was read.
struct Source {
    path: PathBuf,
    given: Given,
}

/// The forces of the case's files: one of them, or all mixed by Mach number.
///
/// # Errors
/// Unreadable files, and forces that do not fit the case or each other.
pub(super) fn read(file: &CaseFile, structure: &StructureData) -> Result<Forces, Failure> {
    let conditions = Conditions::of(file)?;
    let mut sources = Vec::new();
    let listed = file.case.gaf.file.as_ref();
    for path in listed.map_or(&[][..], |files| files.as_slice()) {
        let full = file.existing("gaf.file", path)?;
        let given = gaf_json::read(&full)?;
        sources.push(Source { path: full, given });
    }
    sources.sort_by(|a, b| a.given.table.mach().total_cmp(&b.given.table.mach()));
    if let Some(pair) = sources
        .windows(2)
        .find(|pair| pair[0].given.table.mach() == pair[1].given.table.mach())
    {
        return Err(Failure::input(
            format!(
                "two files of forces have Mach number {}: {} and {}",
                pair[0].given.table.mach(),
                pair[0].path.display(),
                pair[1].path.display()
            ),
            file.places.of("gaf.file"),
            "it would be left open which of them holds",
            "name one file for each Mach number",
        ));
    }
    let (used, mut notes) = chosen(file, sources, &conditions)?;
    let alpha_deg = used[0].given.alpha_deg;
    let beta_deg = used[0].given.beta_deg;
    for source in &used {
        let place = source.path.display().to_string();
        fits(file, &source.given, &place)?;
        same_modes(file, structure, &source.given, &place)?;
        if [source.given.alpha_deg, source.given.beta_deg] != [alpha_deg, beta_deg] {
            return Err(Failure::input(
                format!(
                    "the forces of {} and {} are of different incidence",
                    used[0].path.display(),
                    source.path.display()
                ),
                file.places.of("gaf.file"),
                "Mach number and incidence would change together",
                "give files of one incidence",
            ));
        }
        notes.push(format!("forces from {place}"));
    }
    let alpha =
        angle(file, "flow.alpha_deg", file.case.flow.alpha_deg, alpha_deg)?.to_radians();
    let beta = angle(file, "flow.beta_deg", file.case.flow.beta_deg, beta_deg)?.to_radians();
    let steady = used
        .iter()
        .map(|source| source.given.table.steady().to_vec())
        .collect();
    let machs: Vec<f64> = used
        .iter()
        .map(|source| source.given.table.mach())
        .collect();
    let tables = used
        .into_iter()
        .map(|Source { given, .. }| {
            in_body_frame(file, structure, given.table, &given.frames, alpha)
        })
        .collect::<Result<Vec<_>, _>>()?;
    let trim = level::given(file, structure, &tables, alpha)?;
    let conditions = conditions.at_incidence(alpha, beta).trimmed(trim);
    notes.extend(level::notes(file, &conditions)?);
    let table = side_by_side(file, &tables)?;
    notes.extend_from_slice(table.notes());
    Ok(Forces {
        table,
        mixture: MachNumbers::new(machs).map(|machs| Arc::new(machs) as Arc<dyn Mixture>),
        steady,
        transfer: None,
        flows: Vec::new(),
        conditions,
        notes,
    })
}

/// The files that a sweep needs, and what is to be said of it.
fn chosen(
    file: &CaseFile,
    sources: Vec<Source>,
    conditions: &Conditions,
) -> Result<(Vec<Source>, Vec<String>), Failure> {
    let machs: Vec<f64> = sources
        .iter()
        .map(|source| source.given.table.mach())
        .collect();
    let there: Vec<String> = machs.iter().map(f64::to_string).collect();
    if machs.is_empty() {
        return Err(Failure::input(
            "`gaf.file` names no file",
            file.places.of("gaf.file"),
            "there are no forces",
            "give the path of a file, or leave the key out to compute forces from [mesh]",
        ));
    }
    let is_stated = file.places.has("flow.mach") || conditions.is_matched();
    if machs.len() == 1 && !is_stated {
        return Ok((sources, Vec::new()));
    }
    let wanted: Vec<f64> = conditions
        .points()
        .iter()
        .filter_map(|point| point.mach)
        .collect();
    let low = wanted.iter().copied().fold(f64::INFINITY, f64::min);
    let high = wanted.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if low == high
        && let Some(exact) = machs.iter().position(|mach| *mach == low)
    {
        let source = sources.into_iter().nth(exact);
        return Ok((source.into_iter().collect(), Vec::new()));
    }
    let (first, last) = (machs[0], machs[machs.len() - 1]);
    if machs.len() > 1 && first <= low && high <= last {
        let note = format!(
            "forces between Mach numbers {} are interpolated linearly",
            there.join(", ")
        );
        return Ok((sources, vec![note]));
    }
    let is_slow = last == 0.0 && high < INCOMPRESSIBLE && conditions.is_matched();
    if is_slow {
        let note = format!(
            "warning: Mach numbers up to {high:.3} with forces of M = 0: compressibility, about \
             {:.1} % of the lift there, is left out",
            100.0 * (1.0 / (1.0 - high * high).sqrt() - 1.0)
        );
        return Ok((sources, vec![note]));
    }
    let range = if low == high {
        format!("Mach number {low}")
    } else {
        format!("Mach numbers {low:.4} to {high:.4}")
    };
    Err(Failure::input(
        format!(
            "the sweep has {range}; the files of forces have {}",
            there.join(", ")
        ),
        file.places.of("gaf.file"),
        "forces of another Mach number give other roots, and they are not extrapolated",
        "give files whose Mach numbers enclose those of the sweep, or set flow.mach to one of these",
    ))
}

/// Refuses forces of other modes than the structure's.
fn same_modes(
    file: &CaseFile,
    structure: &StructureData,
    given: &Given,
    place: &str,
) -> Result<(), Failure> {
    let names = structure
        .clone()
        .with_rigid_modes_of(given.table.modes())
        .mode_names();
    let has_matrices = file
        .case
        .structure
        .as_ref()
        .is_some_and(|given| given.matrices.is_some());
    let modes = given.table.modes();
    let agree = if has_matrices {
        modes.starts_with(&names)
    } else {
        modes == names
    };
    if file.case.structure.is_none() || agree {
        return Ok(());
    }
    Err(Failure::input(
        format!(
            "the forces are of the modes {}, the structure has {}",
            modes.join(", "),
            names.join(", ")
        ),
        place.to_owned(),
        "rows and columns of Q would meet other modes",
        "order and name the modes of the file as the case does: rigid, elastic, analytic",
    ))
}

fn fits(file: &CaseFile, given: &Given, place: &str) -> Result<(), Failure> {
    let (theirs, ours) = (given.table.semichord(), file.case.reference.semichord);
    if (theirs - ours).abs() <= 1e-9 * ours {
        return Ok(());
    }
    Err(Failure::input(
        format!("the forces have semichord {theirs} m, the case has {ours} m"),
        format!("{place}; {}", file.places.of("reference.semichord")),
        "k and g are reduced by the semichord, so the forces would be read at wrong points",
        "give both the same semichord",
    ))
}

/// The file's angle, unless the case states another.
fn angle(file: &CaseFile, key: &str, stated: f64, theirs: f64) -> Result<f64, Failure> {
    if !file.places.has(key) || (stated - theirs).abs() <= 1e-9 {
        return Ok(theirs);
    }
    Err(Failure::input(
        format!("the forces are of {theirs} degrees, `{key}` is {stated}"),
        file.places.of(key),
        "the forces depend on the incidence they are linearised about",
        "leave the key out, or give forces of that incidence",
    ))
}
