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
    let recovered = model.rigid_body_from_file.as_ref();
    if let Some(recovered) = recovered.filter(|found| data.body != Some(found.body)) {
        console.say(format!(
            "  the file's own rigid modes give {}",
            body_in_words(&recovered.body)
        ));
    }
    console.say(format!("structure: {} elastic modes", model.elastic.len()));
    console.notes(&model.notes);
    let mut table = Table::new(&[
        ("mode", Align::Left),
        ("f [Hz]", Align::Right),
        ("generalised mass before scaling", Align::Right),
        ("and stiffness", Align::Right),
        ("rigid part", Align::Right),
    ]);
    for mode in &model.elastic {
        table.row([
            mode.name.clone(),
            format!("{:.3}", mode.frequency_hz),
            format!("{:.4}", mode.generalised_mass),
            format!("{:.4e}", mode.generalised_stiffness),
            small(mode.participation),
        ]);
    }
    if !table.is_empty() {
        console.say(table.text());
    }
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
pub(crate) fn transfer(
    console: &Console,
    data: &StructureData,
    report: Option<&TransferReport>,
) {
    let (Some(report), Some(model)) = (report, &data.model) else {
        return;
    };
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
    let mut table = Table::new(&[
        ("mode", Align::Left),
        ("largest error on the skin [%]", Align::Right),
        ("at node", Align::Right),
    ]);
    for (mode, error) in model.elastic.iter().zip(&report.errors) {
        let Some(error) = error else { continue };
        table.row([
            mode.name.clone(),
            format!("{:.2}", 100.0 * error.relative),
            model.result.nodes[error.node as usize].id.to_string(),
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
    let mut table = Table::new(&[
        ("mode", Align::Right),
        ("f [Hz]", Align::Right),
        ("generalised mass", Align::Right),
        ("and stiffness", Align::Right),
        ("not rigid", Align::Right),
        ("rigid part", Align::Right),
        ("", Align::Left),
    ]);
    for mode in &summary.modes {
        table.row([
            mode.index.to_string(),
            format!("{:.4}", mode.frequency_hz),
            format!("{:.5}", mode.generalised_mass),
            format!("{:.4e}", mode.generalised_stiffness),
            format!("{:.1e}", mode.rigid_residual),
            small(mode.rigid_participation.filter(|_| !mode.rigid)),
            if mode.rigid {
                "rigid".to_owned()
            } else {
                String::new()
            },
        ]);
    }
    console.answer(table.text());
    let bodies = [
        ("stated in the file", &summary.stated),
        ("from its rigid modes", &summary.recovered),
    ];
    for (source, body) in bodies {
        if let Some(body) = body {
            console.answer(format!("  {source}: {}", masses_in_words(body)));
        }
    }
    console.notes(&summary.notes);
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
