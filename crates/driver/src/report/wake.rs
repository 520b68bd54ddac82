//! The wake that will be computed, in words.

use super::pictures::ends;
use crate::chain::surface::Surface;
use crate::figures::{fixed, three_digits};
use crate::terminal::{Align, Console, Table};
use fladder_bem::{Plan, WakeSheet};

/// Extent of the sheet, its lines on bodies, and what its trailing edges end in.
pub(crate) fn wake(console: &Console, surface: &Surface, plan: &Plan) {
    let sheet = &plan.wake;
    if sheet.triangles.is_empty() {
        return;
    }
    let sizes = &plan.sizes;
    let [x, y, z] = sheet.direction.map(|c| fixed(c, 4));
    console.say(format!(
        "wake along ({x}, {y}, {z}): {} rows of {} elements in all, {} streamlines, {} m long, \
         longest row {} m; straight on behind it",
        sizes.wake_rows.saturating_sub(1),
        sizes.wake_elements,
        sizes.wake_streamlines,
        fixed(length(sheet), 3),
        three_digits(sheet.longest_row)
    ));
    let mut table = Table::new(&[
        ("trailing edge", Align::Left),
        ("elements", Align::Right),
        ("begins", Align::Left),
        ("ends", Align::Left),
    ]);
    let ends = ends(&surface.trailing_edges, sheet);
    for (number, [first, last]) in ends.into_iter().enumerate() {
        let elements = sheet.edge.iter().filter(|e| **e as usize == number);
        table.row([
            (number + 1).to_string(),
            elements.count().to_string(),
            first.words().to_owned(),
            last.words().to_owned(),
        ]);
    }
    console.say(table.text());
    for line in &sheet.junction_lines {
        let place = |vertex: Option<&u32>| {
            let position = vertex.and_then(|v| surface.mesh.vertices.get(*v as usize));
            position.map_or_else(String::new, |p| {
                format!("({}, {}, {})", fixed(p.x, 3), fixed(p.y, 3), fixed(p.z, 3))
            })
        };
        console.say(format!(
            "  on a body: from trailing edge {} at {} m along {} mesh edges to {} m",
            line.edge + 1,
            place(line.vertices.first()),
            line.vertices.len().saturating_sub(1),
            place(line.vertices.last())
        ));
    }
}

/// Extent of the sheet along the wake.
fn length(sheet: &WakeSheet) -> f64 {
    let along = |p: &[f64; 3]| -> f64 {
        let products = p.iter().zip(sheet.direction);
        products.map(|(p, d)| p * d).sum()
    };
    let range = sheet
        .vertices
        .iter()
        .map(along)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
    range.1 - range.0
}
