//! Masses and modes in words.

use crate::chain::structure::StructureData;
use crate::figures::fixed;
use crate::terminal::{Align, Console, Table};
use fladder_modal::{ModesSummary, RigidBody, TransferReport};

/// Mass properties and the elastic modes.
pub(crate) fn structure(console: &Console, data: &StructureData) {
    if let Some(body) = &data.body {
        console.say(format!("rigid body: {}", body_in_words(body)));
    }
    let Some(model) = &data.model else { return };
    console.say(format!("structure: {} elastic modes", model.elastic.len()));
    console.notes(&model.notes);
    let mut table = Table::new(&[
        ("mode", Align::Left),
        ("f [Hz]", Align::Right),
        ("generalised mass before scaling", Align::Right),
    ]);
    for mode in &model.elastic {
        table.row([
            mode.name.clone(),
            format!("{:.3}", mode.frequency_hz),
            format!("{:.4}", mode.generalised_mass),
        ]);
    }
    if !table.is_empty() {
        console.say(table.text());
    }
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
        ("farthest [mm]", Align::Right),
    ]);
    for part in &report.components {
        table.row([
            part.name.clone(),
            part.sets.join(", "),
            part.mapping.words().to_owned(),
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
    console.answer(format!(
        "{}: {} nodes, {} elements, {} modes",
        summary.format,
        summary.nodes,
        summary.elements,
        summary.modes.len()
    ));
    let mut table = Table::new(&[
        ("mode", Align::Right),
        ("f [Hz]", Align::Right),
        ("generalised mass", Align::Right),
        ("", Align::Left),
    ]);
    for mode in &summary.modes {
        table.row([
            mode.index.to_string(),
            format!("{:.4}", mode.frequency_hz),
            format!("{:.5}", mode.generalised_mass),
            if mode.rigid {
                "rigid".to_owned()
            } else {
                String::new()
            },
        ]);
    }
    console.answer(table.text());
    if let Some(mass) = summary.mass {
        console.answer(format!("  mass {mass:.5} (units of the file)"));
    }
    if let Some(cg) = summary.cg {
        let [x, y, z] = [cg.x, cg.y, cg.z].map(|c| fixed(c, 5));
        console.answer(format!("  centre of mass ({x}, {y}, {z})"));
    }
    if let Some(inertia) = summary.inertia {
        console.answer(format!(
            "  inertia about it: xx {:.5}, yy {:.5}, zz {:.5}, xz {:.5}",
            inertia.xx, inertia.yy, inertia.zz, inertia.xz
        ));
    }
    console.notes(&summary.notes);
}
