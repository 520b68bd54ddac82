//! Surface and trailing edges in words.

use crate::chain::surface::Surface;
use crate::figures::fixed;
use crate::terminal::{Align, Console, Table};
use fladder_mesh::judge::Severity;

/// Sizes, what was repaired or looks odd, and the trailing edges.
pub(crate) fn surface(console: &Console, surface: &Surface) {
    let mesh = &surface.mesh;
    let bodies = if surface.bodies == 1 {
        "body"
    } else {
        "bodies"
    };
    console.say(format!(
        "surface {}: {} triangles, {} vertices, {} {bodies}, {:.4} m², {:.4} m³",
        surface.file.display(),
        mesh.triangles.len(),
        mesh.vertices.len(),
        surface.bodies,
        surface.area,
        surface.volume
    ));
    if surface.symmetry.is_half() {
        console.say(format!(
            "  half model on y ≥ 0, {} motion: the whole aircraft has {} triangles; bodies, area and \
             volume are those of the whole",
            surface.symmetry.word(),
            2 * mesh.triangles.len()
        ));
    }
    if let Some((low, high)) = mesh.bounds() {
        let size = high - low;
        console.say(format!(
            "  extends {:.3} m × {:.3} m × {:.3} m",
            size.x, size.y, size.z
        ));
    }
    let groups: Vec<&str> = mesh
        .surfaces
        .iter()
        .map(|group| group.name.as_str())
        .collect();
    let lines: Vec<&str> = mesh
        .curves
        .iter()
        .map(|group| group.name.as_str())
        .collect();
    if !groups.is_empty() {
        console.say(format!("  groups: {}", groups.join(", ")));
    }
    if !lines.is_empty() {
        console.say(format!("  curve groups: {}", lines.join(", ")));
    }
    console.notes(&surface.notes);
    for fault in &surface.faults {
        let word = match fault.severity {
            Severity::Error => "error",
            Severity::Repaired => "repaired",
            Severity::Warning => "warning",
        };
        console.say(format!("  {word}: {fault}"));
    }
    let mut table = Table::new(&[
        ("trailing edge", Align::Left),
        ("edges", Align::Right),
        ("length [m]", Align::Right),
        ("from (x, y, z) [m]", Align::Right),
        ("to (x, y, z) [m]", Align::Right),
    ]);
    let place = |vertex: Option<&u32>| {
        let place = vertex.and_then(|v| mesh.vertices.get(*v as usize));
        place.map_or_else(String::new, |p| {
            [p.x, p.y, p.z].map(|c| fixed(c, 3)).join(", ")
        })
    };
    for (number, edge) in surface.trailing_edges.iter().enumerate() {
        let last = if edge.closed {
            edge.vertices.first()
        } else {
            edge.vertices.last()
        };
        table.row([
            (number + 1).to_string(),
            edge.upper.len().to_string(),
            format!("{:.4}", edge.length(mesh)),
            place(edge.vertices.first()),
            place(last),
        ]);
    }
    if table.is_empty() {
        console.say("  no wake");
    } else {
        console.say(table.text());
    }
}
