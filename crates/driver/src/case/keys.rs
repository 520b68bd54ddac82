//! Every key a case file may have, as a dotted path.
//!
//! `*` stands for a name the user chooses, `[]` for each element of an array.

/// Known keys.
pub(crate) const KEYS: &[&str] = &[
    "title",
    "reference.semichord",
    "reference.area",
    "reference.span",
    "reference.chord",
    "reference.moment_point",
    "flow.mach",
    "flow.alpha_deg",
    "flow.beta_deg",
    "flow.density",
    "flow.altitude",
    "mesh.file",
    "mesh.scale",
    "mesh.symmetry",
    "mesh.trailing_edge.max_wedge_deg",
    "mesh.trailing_edge.min_downstream",
    "mesh.trailing_edge.groups",
    "wake.mode",
    "wake.direction",
    "wake.body_lines",
    "structure.file",
    "structure.format",
    "structure.geometry",
    "structure.units",
    "structure.axes",
    "structure.origin",
    "structure.half",
    "structure.pressure_turning",
    "structure.shape_change",
    "structure.other_symmetry",
    "structure.modes",
    "structure.damping",
    "structure.damping_model",
    "structure.components.*",
    "structure.transfer",
    "structure.transfer.*",
    "structure.transfer_limit",
    "structure.added_mass[].name",
    "structure.added_mass[].mass",
    "structure.added_mass[].position",
    "structure.added_mass[].node",
    "structure.added_mass[].inertia.xx",
    "structure.added_mass[].inertia.yy",
    "structure.added_mass[].inertia.zz",
    "structure.added_mass[].inertia.xz",
    "structure.hinge[].name",
    "structure.hinge[].stiffness_change",
    "structure.hinge[].node",
    "structure.hinge[].direction",
    "structure.hinge[].control",
    "structure.hinge[].base",
    "structure.hinge[].axis",
    "structure.override[].mode",
    "structure.override[].frequency_hz",
    "structure.override[].damping",
    "structure.rigid_body.mass",
    "structure.rigid_body.cg",
    "structure.rigid_body.inertia.xx",
    "structure.rigid_body.inertia.yy",
    "structure.rigid_body.inertia.zz",
    "structure.rigid_body.inertia.xz",
    "structure.matrices.mass",
    "structure.matrices.damping",
    "structure.matrices.stiffness",
    "modes.analytic[].name",
    "modes.analytic[].translation",
    "modes.analytic[].rotation.axis",
    "modes.analytic[].rotation.point",
    "modes.analytic[].polynomial[].component",
    "modes.analytic[].polynomial[].coefficient",
    "modes.analytic[].polynomial[].powers",
    "modes.analytic[].polynomial[].odd_y",
    "modes.analytic[].group",
    "modes.control[].name",
    "modes.control[].group",
    "modes.control[].hinge.axis",
    "modes.control[].hinge.point",
    "flight.gravity",
    "flight.climb_deg",
    "flight.trim",
    "flight.trim_control",
    "flight.thrust",
    "flight.parasite_drag_area",
    "flight.induced_drag_factor",
    "flight.speed_derivative",
    "gaf.k",
    "gaf.g",
    "gaf.file",
    "gaf.exact",
    "gaf.solver",
    "gaf.tolerance",
    "stability.speed.from",
    "stability.speed.to",
    "stability.speed.count",
    "stability.altitude.from",
    "stability.altitude.to",
    "stability.altitude.count",
    "stability.matched",
    "stability.fit",
    "stability.pk",
    "stability.margin_speed",
    "stability.refine",
];

/// Whether a concrete path (array indices already as `[]`) is a known key or
/// a table that holds known keys.
pub(crate) fn is_known(path: &str) -> bool {
    KEYS.iter().any(|key| matches_prefix(path, key))
}

/// Whether `path` is `key` or one of the tables on the way to it.
fn matches_prefix(path: &str, key: &str) -> bool {
    let mut words = key.split('.');
    for word in path.split('.') {
        let Some(expected) = words.next() else {
            return false;
        };
        let open = expected == "*" || expected == word;
        if !open && expected.strip_suffix("[]") != Some(word) {
            return false;
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_on_the_way_and_free_names_are_known() {
        for path in [
            "flow",
            "flow.mach",
            "structure.components.wing_r",
            "modes.analytic",
        ] {
            assert!(is_known(path), "{path}");
        }
        for path in [
            "flow.mach.x",
            "flows",
            "structure.components.a.b",
            "modes.analytic[].nam",
        ] {
            assert!(!is_known(path), "{path}");
        }
    }
}
