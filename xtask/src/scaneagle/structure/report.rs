//! What the command prints.

use std::fmt::Write;

use fladder_modal::{RigidBody, StructuralModel};

use super::judge::{Judged, PARTS};
use super::model::Model;

/// Counts and integrated mass.
pub(super) fn model(model: &Model) -> String {
    let mut text = format!(
        "{} shell elements, {} nodes, {} joints\n",
        model.mesh.cells.len(),
        model.mesh.nodes.len() + model.joints.nodes.len(),
        model.joints.rigid.len() + model.joints.equations.len()
    );
    for (set, mass) in &model.masses {
        let _ = writeln!(text, "  {set:8} {mass:8.4} kg");
    }
    for control in &model.controls {
        let _ = writeln!(
            text,
            "{}: {:.1} g, static moment {:.3e} kg m, {:.0} % balanced; {:.3e} kg m² with balance",
            control.name,
            1e3 * control.mass,
            control.static_moment,
            100.0 * control.balanced,
            control.inertia
        );
    }
    text.push_str("integrated:  ");
    text.push_str(&body(&model.body));
    text
}

fn body(body: &RigidBody) -> String {
    let inertia = &body.inertia;
    format!(
        "{:.4} kg at x {:.4} m, z {:.5} m; xx {:.4}, yy {:.4}, zz {:.4}, xz {:.4} kg m²\n",
        body.mass, body.cg.x, body.cg.z, inertia.xx, inertia.yy, inertia.zz, inertia.xz
    )
}

/// Every elastic mode with its kind, where it moves, and the paper's name if it has one.
pub(super) fn modes(judged: &[Judged], found: &StructuralModel) -> String {
    let mut text = String::new();
    if let Some(recovered) = &found.rigid_body_from_file {
        text.push_str("rigid modes: ");
        text.push_str(&body(&recovered.body));
    }
    let _ = write!(text, "elastic       Hz    ");
    for part in PARTS {
        let _ = write!(text, "{part:>10}");
    }
    text.push('\n');
    let names = names(judged);
    for (number, (mode, name)) in judged.iter().zip(names).enumerate() {
        let kind = if mode.parity > 0.0 { 'S' } else { 'A' };
        let _ = write!(text, "{:7} {:8.3} {kind}  ", number + 1, mode.hertz);
        for part in mode.moves {
            let _ = write!(text, "{:8.0} %", 100.0 * part);
        }
        let _ = writeln!(text, "  {name}");
    }
    text
}

/// The paper's modes: first of the kind that moves most in the direction.
fn names(judged: &[Judged]) -> Vec<&'static str> {
    let mut names = vec![""; judged.len()];
    let in_plane = |mode: &Judged| mode.moves[1] > mode.moves[0];
    let wanted: [(&str, f64, bool, usize); 4] = [
        ("first bending (paper: 7.7 Hz)", 1.0, false, 0),
        ("in-plane bending (19 Hz)", 1.0, true, 0),
        ("antisymmetric in-plane (22 Hz)", -1.0, true, 0),
        ("second bending (32 Hz)", 1.0, false, 1),
    ];
    for (name, parity, plane, skip) in wanted {
        let fits = |mode: &Judged| mode.parity * parity > 0.0 && in_plane(mode) == plane;
        let found = (0..judged.len()).filter(|i| fits(&judged[*i])).nth(skip);
        if let Some(place) = found {
            names[place] = name;
        }
    }
    names
}
