//! Whether what is given as a half model is the half on y ≥ 0, open in y = 0.

use super::fault::{counted, short};
use super::{Code, Element, Fault, Settings, Severity, Surface};

/// Share of the area on y < 0 from which a surface lies on both sides: what
/// is less was cut in the wrong place and crosses its image.
const BOTH_SIDES: f64 = 0.1;

/// Where a surface lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// On y ≥ 0, or nearly.
    Starboard,
    /// On y ≤ 0, or nearly.
    Port,
    /// On both sides.
    Both,
}

/// Where the surface lies; raises `not_a_half` for a half model elsewhere than
/// on y ≥ 0.
pub(super) fn side(surface: &Surface, settings: Settings, faults: &mut Vec<Fault>) -> Side {
    let (mut port, mut total) = (0.0, 0.0);
    for t in (0..surface.mesh.triangles.len()).filter(|&t| surface.is_finite[t]) {
        let area = surface.mesh.area_vector(t).norm();
        total += area;
        if surface.centroid(t).y < 0.0 {
            port += area;
        }
    }
    let share = if total > 0.0 { port / total } else { 0.0 };
    let side = if share < BOTH_SIDES {
        Side::Starboard
    } else if share > 1.0 - BOTH_SIDES {
        Side::Port
    } else {
        Side::Both
    };
    if settings.symmetry_plane && side != Side::Starboard {
        faults.push(elsewhere(side, share));
    }
    side
}

fn elsewhere(side: Side, share: f64) -> Fault {
    let (what, why, remedy) = if side == Side::Both {
        (
            "the surface lies on both sides of y = 0, it is whole",
            "a half model stands for itself and its mirror image, so that a whole one would be \
             there twice",
            "set mesh.symmetry = \"none\", or cut the surface at y = 0 and keep the half on y ≥ 0",
        )
    } else {
        (
            "the half model lies on y ≤ 0",
            "half models are taken on y ≥ 0, with their normals and modes",
            "export the half on y ≥ 0, or mirror the file: change the sign of every y and swap two \
             corners of every triangle",
        )
    };
    let what = format!(
        "{what}: {} % of its area are on y < 0",
        short(100.0 * share)
    );
    Fault::new(Code::NotAHalf, what, why, remedy).against(share, BOTH_SIDES)
}

/// Moves vertices nearer to the plane than the distance of welding into it,
/// raising `off_plane`.
pub(super) fn move_into_plane(
    surface: &mut Surface,
    settings: Settings,
    faults: &mut Vec<Fault>,
) {
    if !settings.symmetry_plane {
        return;
    }
    let (mut moved, mut farthest) = (Vec::new(), 0.0_f64);
    for v in 0..surface.mesh.vertices.len() as u32 {
        if !surface.is_in_symmetry_plane(v) {
            continue;
        }
        let y = std::mem::replace(&mut surface.mesh.vertices[v as usize].y, 0.0);
        if y != 0.0 {
            moved.push(v);
            farthest = farthest.max(y.abs());
        }
    }
    if moved.is_empty() {
        return;
    }
    let what = format!(
        "{} moved into the symmetry plane y = 0, by up to {} m, limit {} m",
        counted(moved.len(), "vertex", "vertices"),
        short(farthest),
        short(surface.tolerance)
    );
    let elements = moved
        .iter()
        .map(|&v| Element::Vertex(surface.vertex[v as usize]))
        .collect();
    let why = "the half and its mirror image must meet there";
    let fault = Fault::new(Code::OffPlane, what, why, "nothing, if that was meant")
        .at(elements, |k| Some(surface.mesh.vertices[moved[k] as usize]))
        .against(farthest, surface.tolerance);
    faults.push(fault);
}

/// Warns of a half model that the plane does not cut.
pub(super) fn check_rim(
    surface: &Surface,
    is_rim: &[bool],
    settings: Settings,
    faults: &mut Vec<Fault>,
) {
    let is_explained = faults
        .iter()
        .any(|fault| matches!(fault.code, Code::OpenEdge | Code::SelfCrossing));
    let is_cut = is_rim.iter().any(|is_rim| *is_rim);
    if !settings.symmetry_plane || is_cut || is_explained || surface.mesh.triangles.is_empty() {
        return;
    }
    let mut fault = Fault::new(
        Code::NotAHalf,
        "no edge of the half model lies in the plane y = 0",
        "the aircraft would be this body and its mirror image, apart from each other",
        "nothing, if that was meant; else cut the surface at y = 0",
    );
    fault.severity = Severity::Warning;
    faults.push(fault);
}
