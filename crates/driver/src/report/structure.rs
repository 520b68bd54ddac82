//! Masses and modes in words.
//!
//! Of every elastic mode stands in one row what the file says of it and how far
//! the surface is from the structure's skin in it.

use crate::chain::structure::StructureData;
use crate::figures::fixed;
use crate::terminal::{Align, Console, Table};
use fladder_modal::{ModeSummary, ModesSummary, RigidBody, StructuralModel, TransferReport};

/// Columns of what a mode loses on the surface.
const ON_SURFACE: [(&str, Align); 2] = [
    ("largest error on the skin [%]", Align::Right),
    ("at node", Align::Right),
];

/// Mass properties and the elastic modes, with their errors on the surface
/// where they are there.
pub(crate) fn structure(
    console: &Console,
    data: &StructureData,
    report: Option<&TransferReport>,
) {
    body(console, data);
    let Some(model) = &data.model else { return };
    console.notes(&model.notes);
    let mut columns = vec![
        ("mode", Align::Left),
        ("f [Hz]", Align::Right),
        ("generalised mass before scaling", Align::Right),
        ("and stiffness", Align::Right),
        ("rigid part", Align::Right),
    ];
    columns.extend(report.iter().flat_map(|_| ON_SURFACE));
    let mut table = Table::new(&columns);
    for (number, mode) in model.elastic.iter().enumerate() {
        let mut cells = vec![
            mode.name.clone(),
            format!("{:.3}", mode.frequency_hz),
            format!("{:.4}", mode.generalised_mass),
            format!("{:.4e}", mode.generalised_stiffness),
            small(mode.participation),
        ];
        cells.extend(
            report
                .iter()
                .flat_map(|report| on_surface(model, report, number)),
        );
        table.row(cells);
    }
    if !table.is_empty() {
        console.say(table.text());
    }
}

/// The largest error of an elastic mode and its node.
fn on_surface(model: &StructuralModel, report: &TransferReport, number: usize) -> [String; 2] {
    match report.errors.get(number).copied().flatten() {
        Some(error) => [
            format!("{:.2}", 100.0 * error.relative),
            model.result.nodes[error.node as usize].id.to_string(),
        ],
        None => ["–".to_owned(), "–".to_owned()],
    }
}

/// Mass properties in use, and those of the file where they differ.
fn body(console: &Console, data: &StructureData) {
    if let Some(body) = &data.body {
        console.say(format!("rigid body: {}", body_in_words(body)));
    }
    let Some(model) = &data.model else { return };
    let recovered = model.rigid_body_from_file.as_ref();
    if let Some(recovered) = recovered.filter(|found| data.body != Some(found.body)) {
        console.say(format!(
            "  the file's own rigid modes give {}",
            body_in_words(&recovered.body)
        ));
    }
    console.say(format!("structure: {} elastic modes", model.elastic.len()));
}

/// A share that may not be known.
fn small(share: Option<f64>) -> String {
    share.map_or_else(|| "–".to_owned(), |share| format!("{share:.1e}"))
}

fn body_in_words(body: &RigidBody) -> String {
    let (cg, inertia) = (body.cg, body.inertia);
    format!(
        "{:.4} kg, centre of mass ({}, {}, {}) m, Ixx {:.5}, Iyy {:.5}, Izz {:.5}, ∫xz dm {:.5} \
         kg m²",
        body.mass,
        fixed(cg.x, 4),
        fixed(cg.y, 4),
        fixed(cg.z, 4),
        inertia.xx,
        inertia.yy,
        inertia.zz,
        inertia.xz
    )
}

/// How the elastic modes came to the surface.
pub(crate) fn transfer(console: &Console, report: Option<&TransferReport>) {
    let Some(report) = report else { return };
    console.say(format!(
        "modes on the surface: {:.1} % of it lies on the structure, farthest vertex {:.1} mm away",
        100.0 * report.overlap,
        1000.0 * report.largest_distance
    ));
    let mut table = Table::new(&[
        ("part of the surface", Align::Left),
        ("carried by", Align::Left),
        ("how", Align::Left),
        ("by", Align::Left),
        ("farthest [mm]", Align::Right),
    ]);
    for part in &report.components {
        table.row([
            part.name.clone(),
            part.sets.join(", "),
            part.mapping.words().to_owned(),
            part.method.words().to_owned(),
            format!("{:.1}", 1000.0 * part.largest_distance),
        ]);
    }
    if !table.is_empty() {
        console.say(table.text());
    }
    console.notes(&report.notes);
    if !report.left_out.is_empty() {
        console.say(format!(
            "  not on the surface: {}",
            report.left_out.join(", ")
        ));
    }
}

/// Contents of a result file, in the units of the file.
pub(crate) fn modes_summary(console: &Console, summary: &ModesSummary) {
    heading(console, summary);
    let mut table = Table::new(&FILE_COLUMNS);
    for mode in &summary.modes {
        let is = if mode.rigid { "rigid" } else { "" };
        table.row(in_file(mode, is));
    }
    console.answer(table.text());
    masses(console, summary);
    console.notes(&summary.notes);
}

/// The same with what an unchanged case makes of it: names of the modes in use
/// and their errors on the surface.
pub(crate) fn modes_of_case(
    console: &Console,
    summary: &ModesSummary,
    data: &StructureData,
    report: Option<&TransferReport>,
) {
    let Some(model) = &data.model else {
        return modes_summary(console, summary);
    };
    heading(console, summary);
    let mut columns = FILE_COLUMNS.to_vec();
    columns.extend(report.iter().flat_map(|_| ON_SURFACE));
    let mut table = Table::new(&columns);
    for mode in &summary.modes {
        let number = model
            .elastic
            .iter()
            .position(|elastic| elastic.index == mode.index);
        let is = match number {
            Some(number) => &model.elastic[number].name,
            None if mode.rigid => "rigid",
            None => "not in use",
        };
        let mut cells = in_file(mode, is);
        if let Some(report) = report {
            cells.extend(number.map_or_else(
                || [String::new(), String::new()],
                |number| on_surface(model, report, number),
            ));
        }
        table.row(cells);
    }
    console.answer(table.text());
    masses(console, summary);
    body(console, data);
    let more = model
        .notes
        .iter()
        .filter(|note| !summary.notes.contains(note));
    console.notes(summary.notes.iter().chain(more));
}

const FILE_COLUMNS: [(&str, Align); 7] = [
    ("mode", Align::Right),
    ("f [Hz]", Align::Right),
    ("generalised mass", Align::Right),
    ("and stiffness", Align::Right),
    ("not rigid", Align::Right),
    ("rigid part", Align::Right),
    ("", Align::Left),
];

fn in_file(mode: &ModeSummary, is: &str) -> Vec<String> {
    vec![
        mode.index.to_string(),
        format!("{:.4}", mode.frequency_hz),
        format!("{:.5}", mode.generalised_mass),
        format!("{:.4e}", mode.generalised_stiffness),
        format!("{:.1e}", mode.rigid_residual),
        small(mode.rigid_participation.filter(|_| !mode.rigid)),
        is.to_owned(),
    ]
}

fn heading(console: &Console, summary: &ModesSummary) {
    console.answer(format!(
        "{}: {} nodes, {} elements, {} modes{}",
        summary.format,
        summary.nodes,
        summary.elements,
        summary.modes.len(),
        if summary.rotations {
            " with rotations"
        } else {
            ""
        }
    ));
}

/// Mass properties in the file.
fn masses(console: &Console, summary: &ModesSummary) {
    let bodies = [
        ("stated in the file", &summary.stated),
        ("from its rigid modes", &summary.recovered),
    ];
    for (source, body) in bodies {
        if let Some(body) = body {
            console.answer(format!("  {source}: {}", masses_in_words(body)));
        }
    }
}

/// In the units of a file.
fn masses_in_words(body: &RigidBody) -> String {
    let [x, y, z] = [body.cg.x, body.cg.y, body.cg.z].map(|c| fixed(c, 5));
    let inertia = body.inertia;
    format!(
        "mass {:.5}, centre ({x}, {y}, {z}), xx {:.5}, yy {:.5}, zz {:.5}, ∫xz dm {:.5}",
        body.mass, inertia.xx, inertia.yy, inertia.zz, inertia.xz
    )
}
