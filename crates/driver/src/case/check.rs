//! Values that would make a computation meaningless are refused here, before
//! anything is read or computed.

use super::aerodynamics::{AnalyticMode, Gaf, Mesh};
use super::check_structure::structure;
use super::check_sweep::{flight, stability};
use super::{Case, CaseFile, Places, SolverChoice, Structure};
use crate::atmosphere;
use crate::failure::Failure;

pub(super) type Checked = Result<(), Failure>;

/// Refuses what has no meaning, the first fault found.
pub(super) fn check(file: &CaseFile) -> Checked {
    let case = &file.case;
    let at = At(&file.places);
    reference(case, &at)?;
    flow(case, &at)?;
    source_of_forces(case, &at)?;
    if let Some(mesh) = &case.mesh {
        surface(mesh, case.flow.beta_deg, &at)?;
        let across = case.reference.moment_point[1];
        if mesh.symmetry.is_half() && across != 0.0 {
            return Err(at.refuse(
                "reference.moment_point",
                format!("`reference.moment_point` is at y = {across} with a half model"),
                "moments about a point beside the plane mix symmetric and antisymmetric motion",
                "give a point with y = 0",
            ));
        }
    }
    if let Some(given) = &case.structure {
        structure(given, &at)?;
        half_structure(case, given, &at)?;
    }
    let formulae = case.modes.formulae();
    for (number, (key, mode)) in formulae.iter().enumerate() {
        analytic(mode, &formulae[..number], key, &at)?;
    }
    flight(case, &at)?;
    case.stability
        .as_ref()
        .map_or(Ok(()), |swept| stability(case, swept, &at))
}

/// Makes failures that carry the place of a key.
pub(super) struct At<'a>(&'a Places);

impl At<'_> {
    pub(super) fn refuse(
        &self,
        key: &str,
        what: impl Into<String>,
        why: &str,
        remedy: &str,
    ) -> Failure {
        Failure::input(what, self.0.of(key), why, remedy)
    }

    pub(super) fn finite(&self, key: &str, value: f64) -> Checked {
        if value.is_finite() {
            return Ok(());
        }
        Err(self.refuse(
            key,
            format!("`{key}` is {value}"),
            "every result would be undefined",
            "give a finite number",
        ))
    }

    pub(super) fn all_finite(&self, key: &str, values: &[f64]) -> Checked {
        values.iter().try_for_each(|value| self.finite(key, *value))
    }

    pub(super) fn positive(&self, key: &str, value: f64) -> Checked {
        if value.is_finite() && value > 0.0 {
            return Ok(());
        }
        Err(self.refuse(
            key,
            format!("`{key}` is {value}, it must be positive"),
            "it is divided by, or scales everything",
            "give a positive number in SI units",
        ))
    }

    pub(super) fn not_negative(&self, key: &str, value: f64) -> Checked {
        if value.is_finite() && value >= 0.0 {
            return Ok(());
        }
        Err(self.refuse(
            key,
            format!("`{key}` is {value}, it must not be negative"),
            "the quantity has no meaning below zero",
            "give zero or a positive number in SI units",
        ))
    }
}

fn reference(case: &Case, at: &At<'_>) -> Checked {
    let given = &case.reference;
    at.positive("reference.semichord", given.semichord)?;
    let optional = [
        ("reference.area", given.area),
        ("reference.span", given.span),
        ("reference.chord", given.chord),
    ];
    for (key, value) in optional {
        value.map_or(Ok(()), |value| at.positive(key, value))?;
    }
    at.all_finite("reference.moment_point", &given.moment_point)
}

fn flow(case: &Case, at: &At<'_>) -> Checked {
    let flow = &case.flow;
    at.not_negative("flow.mach", flow.mach)?;
    at.finite("flow.alpha_deg", flow.alpha_deg)?;
    at.finite("flow.beta_deg", flow.beta_deg)?;
    if flow.mach > 0.0 && case.gaf.file.is_none() {
        return Err(at.refuse(
            "flow.mach",
            format!(
                "`flow.mach` is {}; only incompressible flow can be computed",
                flow.mach
            ),
            "the forces would be those of Mach 0 under another name",
            "set flow.mach = 0, or give forces of that Mach number with gaf.file",
        ));
    }
    for (key, angle) in [
        ("flow.alpha_deg", flow.alpha_deg),
        ("flow.beta_deg", flow.beta_deg),
    ] {
        if angle.abs() >= 90.0 {
            return Err(at.refuse(
                key,
                format!("`{key}` is {angle} degrees"),
                "the stream would come from behind or from the side alone",
                "give the angle in degrees, well below 90",
            ));
        }
    }
    density(case, at)
}

fn density(case: &Case, at: &At<'_>) -> Checked {
    match (case.flow.density, case.flow.altitude) {
        (Some(_), Some(_)) => Err(at.refuse(
            "flow.altitude",
            "both `flow.density` and `flow.altitude` are given",
            "each of them sets the air density, and they need not agree",
            "remove one of the two",
        )),
        (Some(density), None) => at.positive("flow.density", density),
        (None, Some(altitude)) => {
            at.finite("flow.altitude", altitude)?;
            if atmosphere::RANGE.contains(&altitude) {
                return Ok(());
            }
            Err(at.refuse(
                "flow.altitude",
                format!("`flow.altitude` is {altitude} m"),
                "the standard atmosphere is known here from -2000 m to 20000 m",
                "give an altitude in that range, or flow.density instead",
            ))
        }
        (None, None)
            if case
                .stability
                .as_ref()
                .is_some_and(|swept| swept.altitude.is_none()) =>
        {
            Err(at.refuse(
                "flow.density",
                "neither `flow.density` nor `flow.altitude` is given",
                "the dynamic pressure of a speed needs the density",
                "add density = 1.225 (kg/m³) or altitude = 0.0 (m) to [flow]",
            ))
        }
        (None, None) => Ok(()),
    }
}

fn source_of_forces(case: &Case, at: &At<'_>) -> Checked {
    if let Some(files) = &case.gaf.file {
        if files.as_slice().is_empty() {
            return Err(at.refuse(
                "gaf.file",
                "`gaf.file` is an empty list",
                "there are no aerodynamic forces",
                "name one file, or remove the key and give [mesh]",
            ));
        }
        return Ok(());
    }
    if case.mesh.is_none() {
        return Err(at.refuse(
            "mesh",
            "there is neither [mesh] nor `gaf.file`",
            "the aerodynamic forces have no source",
            "add [mesh] with file = \"…\", or gaf.file with forces from elsewhere",
        ));
    }
    grid(case, &case.gaf, at)
}

fn grid(case: &Case, gaf: &Gaf, at: &At<'_>) -> Checked {
    if !(1e-7..=1e-2).contains(&gaf.tolerance) {
        return Err(at.refuse(
            "gaf.tolerance",
            format!("`gaf.tolerance` is {}, outside 1e-7 to 1e-2", gaf.tolerance),
            "blocks are kept in single precision, and beyond a hundredth forces mean nothing",
            "leave the key out: 1e-6 keeps Q to some 1e-5 of its largest entry",
        ));
    }
    if gaf.exact && gaf.solver == SolverChoice::Hierarchical {
        return Err(at.refuse(
            "gaf.exact",
            "`gaf.exact` asks for factors in double precision, `gaf.solver` for an iteration",
            "a hierarchical matrix has no factors",
            "leave out one of the two",
        ));
    }
    at.all_finite("gaf.k", &gaf.k)?;
    at.all_finite("gaf.g", &gaf.g)?;
    let Some(first) = gaf.k.first() else {
        return Err(at.refuse(
            "gaf.k",
            "`gaf.k` is missing or empty",
            "the forces are computed at these reduced frequencies",
            "add for example k = [0.0, 0.05, 0.1, 0.2, 0.4, 0.8, 1.5] to [gaf]",
        ));
    };
    let ascending = gaf.k.windows(2).position(|pair| pair[0] >= pair[1]);
    if *first < 0.0 || ascending.is_some() {
        let place = ascending.map_or(0, |before| before + 1);
        return Err(at.refuse(
            &format!("gaf.k.{place}"),
            format!(
                "`gaf.k` must be non-negative and ascend, but its value number {} is {}",
                place + 1,
                gaf.k[place]
            ),
            "the approximation of the forces joins neighbours in k",
            "sort the list and remove what is there twice",
        ));
    }
    let is_rigid = case
        .structure
        .as_ref()
        .is_some_and(|s| s.rigid_body.is_some());
    if is_rigid && *first != 0.0 {
        return Err(at.refuse(
            "gaf.k.0",
            format!("`gaf.k` begins with {first} though there are rigid modes"),
            "rigid modes live at and near k = 0, where Q is known to vanish",
            "let the list begin with 0.0",
        ));
    }
    if !gaf.g.contains(&0.0) {
        return Err(at.refuse(
            "gaf.g",
            "`gaf.g` does not contain 0",
            "flutter is where the damping is zero",
            "add 0.0 to the list, or leave the key out",
        ));
    }
    let twice = (1..gaf.g.len()).find(|&i| gaf.g[..i].contains(&gaf.g[i]));
    twice.map_or(Ok(()), |i| {
        Err(at.refuse(
            &format!("gaf.g.{i}"),
            format!("`gaf.g` holds {} twice", gaf.g[i]),
            "each line of the grid is one value",
            "remove one of the two",
        ))
    })
}

/// Half a structure moves half a surface.
fn half_structure(case: &Case, given: &Structure, at: &At<'_>) -> Checked {
    let is_whole_mesh = case.gaf.file.is_none()
        && case
            .mesh
            .as_ref()
            .is_some_and(|mesh| !mesh.symmetry.is_half());
    if given.half && is_whole_mesh {
        return Err(at.refuse(
            "structure.half",
            "`structure.half` is true with a mesh of the whole aircraft",
            "the port side of the surface would have no structure to move it",
            "give the half mesh on y ≥ 0 with mesh.symmetry = \"y\" or \"-y\", or a whole structure",
        ));
    }
    Ok(())
}

fn surface(mesh: &Mesh, beta_deg: f64, at: &At<'_>) -> Checked {
    at.positive("mesh.scale", mesh.scale)?;
    if mesh.symmetry.is_half() && beta_deg != 0.0 {
        return Err(at.refuse(
            "flow.beta_deg",
            format!("`flow.beta_deg` is {beta_deg} with a half model"),
            "sideslip is not symmetric, a half model cannot carry it",
            "set beta_deg = 0, or mesh the whole aircraft with symmetry = \"none\"",
        ));
    }
    let edges = &mesh.trailing_edge;
    if !(edges.max_wedge_deg > 0.0 && edges.max_wedge_deg < 180.0) {
        return Err(at.refuse(
            "mesh.trailing_edge.max_wedge_deg",
            format!("`max_wedge_deg` is {}", edges.max_wedge_deg),
            "a wedge angle lies between 0 and 180 degrees",
            "60 finds the trailing edges of usual wings",
        ));
    }
    if edges.min_downstream.abs() > 1.0 || edges.min_downstream.is_nan() {
        return Err(at.refuse(
            "mesh.trailing_edge.min_downstream",
            format!("`min_downstream` is {}", edges.min_downstream),
            "it is compared with the component of a unit vector",
            "0.3 tells trailing from leading edges of usual wings",
        ));
    }
    Ok(())
}

fn analytic(
    mode: &AnalyticMode,
    earlier: &[(String, AnalyticMode)],
    key: &str,
    at: &At<'_>,
) -> Checked {
    let name = &mode.name;
    if name.is_empty() || name.starts_with("rigid:") || name.starts_with("elastic:") {
        return Err(at.refuse(
            &format!("{key}.name"),
            format!("an analytic mode is named `{name}`"),
            "rows and columns of Q are told apart by their names; rigid: and elastic: are taken",
            "give another name",
        ));
    }
    if earlier.iter().any(|(_, other)| other.name == *name) {
        return Err(at.refuse(
            &format!("{key}.name"),
            format!("two analytic modes are named `{name}`"),
            "rows and columns of Q are told apart by their names",
            "rename one of the two",
        ));
    }
    let kinds = [
        mode.translation.is_some(),
        mode.rotation.is_some(),
        mode.polynomial.is_some(),
    ];
    if kinds.iter().filter(|given| **given).count() != 1 {
        return Err(at.refuse(
            key,
            format!("the analytic mode `{name}` needs exactly one shape"),
            "its displacement would be undefined or given twice",
            "give one of translation, rotation, polynomial",
        ));
    }
    if mode
        .group
        .as_ref()
        .is_some_and(|groups| groups.as_slice().is_empty())
    {
        return Err(at.refuse(
            &format!("{key}.group"),
            format!("`group` of `{name}` is an empty list"),
            "the mode would move nothing",
            "name a surface group of the mesh, or leave the key out",
        ));
    }
    if let Some(translation) = &mode.translation {
        at.all_finite(&format!("{key}.translation"), translation)?;
    }
    if let Some(rotation) = &mode.rotation {
        let is_control = key.starts_with("modes.control");
        let axis_key = format!("{key}.{}", if is_control { "hinge" } else { "rotation" });
        at.all_finite(&format!("{axis_key}.point"), &rotation.point)?;
        at.all_finite(&format!("{axis_key}.axis"), &rotation.axis)?;
        if rotation.axis == [0.0; 3] {
            return Err(at.refuse(
                &format!("{axis_key}.axis"),
                format!("the axis of `{name}` has no length"),
                "there is no direction to turn about",
                "give for example axis = [0.0, 1.0, 0.0]",
            ));
        }
    }
    for (number, term) in mode.polynomial.iter().flatten().enumerate() {
        at.finite(
            &format!("{key}.polynomial.{number}.coefficient"),
            term.coefficient,
        )?;
    }
    Ok(())
}
