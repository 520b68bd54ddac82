//! Single vertices and triangles: numbers, duplicates, shapes.

use super::fault::{counted, short};
use super::{Code, Element, Fault, Settings, Surface};
use crate::weld::{Weld, weld};
use crate::{CurveGroup, TriMesh, Vec3};

/// A triangle lower than this fraction of the bounding box's diagonal has no
/// area: a tenth of the weld tolerance, a thousandth of the finest cells in use.
pub const ZERO_HEIGHT: f64 = 1e-7;

/// Height over √area of a triangle below which it is a needle; an equilateral
/// one has 1.3, one 800 times as long as high 0.05. The influence integrals
/// hold there, but the potential is resolved in one direction only.
pub const MIN_SHAPE: f64 = 0.05;

fn is_finite(p: &Vec3) -> bool {
    p.iter().all(|x| x.is_finite())
}

/// Raises `not_finite` and `bad_index`.
pub(super) fn check_numbers(mesh: &TriMesh, faults: &mut Vec<Fault>) {
    let bad: Vec<Element> = (0..)
        .zip(&mesh.vertices)
        .filter(|(_, p)| !is_finite(p))
        .map(|(v, _)| Element::Vertex(v))
        .collect();
    if !bad.is_empty() {
        let what = format!(
            "{} with coordinates that are no finite numbers",
            counted(bad.len(), "vertex", "vertices")
        );
        let why = "no distance to them exists";
        faults.push(
            Fault::new(Code::NotFinite, what, why, "correct the mesh file").at(bad, |_| None),
        );
    }
    let triangles: Vec<u32> = (0..)
        .zip(&mesh.triangles)
        .filter(|(_, t)| !is_usable(mesh, t))
        .map(|(t, _)| t)
        .collect();
    if !triangles.is_empty() {
        let first = mesh.triangles[triangles[0] as usize];
        let what = format!(
            "{} with a corner that is not among the {} vertices, or with one corner twice, the first {}",
            counted(triangles.len(), "triangle", "triangles"),
            mesh.vertices.len(),
            corner_list(first)
        );
        let why = "they have no place in the surface";
        let bad = triangles.into_iter().map(Element::Triangle).collect();
        faults.push(
            Fault::new(
                Code::BadIndex,
                what,
                why,
                "correct or remove them in the mesh file",
            )
            .at(bad, |_| None),
        );
    }
}

fn corner_list(t: [u32; 3]) -> String {
    let corner = |v: u32| {
        if v == crate::read::MISSING_VERTEX {
            "?".into()
        } else {
            v.to_string()
        }
    };
    format!("({}, {}, {})", corner(t[0]), corner(t[1]), corner(t[2]))
}

fn are_distinct([a, b, c]: [u32; 3]) -> bool {
    a != b && b != c && c != a
}

fn is_usable(mesh: &TriMesh, t: &[u32; 3]) -> bool {
    t.iter().all(|&v| (v as usize) < mesh.vertices.len()) && are_distinct(*t)
}

/// New number of every old vertex, from the old number of every new one; only
/// the kept ones are known.
pub(super) fn inverse(kept: &[u32], n_old: usize) -> Vec<u32> {
    let mut image = vec![crate::read::MISSING_VERTEX; n_old];
    for (new, &old) in (0..).zip(kept) {
        image[old as usize] = new;
    }
    image
}

/// Welds, leaves out what has no connectivity, and raises `duplicate_vertices`.
pub(super) fn welded_surface(
    mesh: &TriMesh,
    settings: Settings,
    faults: &mut Vec<Fault>,
) -> Surface {
    let welded = weld(&mesh.vertices, settings.weld_tolerance);
    if welded.kept.len() < mesh.vertices.len() {
        faults.push(duplicates(mesh, &welded));
    }
    let vertices: Vec<Vec3> = welded
        .kept
        .iter()
        .map(|&v| mesh.vertices[v as usize])
        .collect();
    let mut is_beside_gap = vec![false; vertices.len()];
    let (mut triangles, mut numbers) = (Vec::new(), Vec::new());
    for (number, t) in (0..).zip(&mesh.triangles) {
        let image = |v: u32| welded.image.get(v as usize).copied();
        if is_usable(mesh, t) {
            let joined = t.map(|v| welded.image[v as usize]);
            // The neighbours of a collapsed triangle close up without it.
            if are_distinct(joined) {
                triangles.push(joined);
                numbers.push(number);
            }
        } else {
            for v in t.iter().filter_map(|&v| image(v)) {
                is_beside_gap[v as usize] = true;
            }
        }
    }
    let finite: Vec<bool> = vertices.iter().map(is_finite).collect();
    Surface {
        is_finite: triangles
            .iter()
            .map(|t| t.iter().all(|&v| finite[v as usize]))
            .collect(),
        mesh: TriMesh {
            vertices,
            triangles,
            surfaces: Vec::new(),
            curves: welded_curves(mesh, &welded),
        },
        triangle: numbers,
        vertex: welded.kept,
        is_beside_gap,
        tolerance: welded.tolerance,
    }
}

/// Curve groups in new numbers; lines that welding collapses are gone.
fn welded_curves(mesh: &TriMesh, welded: &Weld) -> Vec<CurveGroup> {
    let image = |v: u32| welded.image.get(v as usize).copied().unwrap_or(v);
    let curve = |group: &CurveGroup| CurveGroup {
        name: group.name.clone(),
        edges: group
            .edges
            .iter()
            .map(|edge| edge.map(image))
            .filter(|[a, b]| a != b)
            .collect(),
    };
    mesh.curves.iter().map(curve).collect()
}

fn duplicates(mesh: &TriMesh, welded: &Weld) -> Fault {
    let joined: Vec<u32> = (0..)
        .zip(&welded.image)
        .filter(|&(old, &new)| welded.kept[new as usize] != old)
        .map(|(old, _)| old)
        .collect();
    let what = format!(
        "vertices closer than {} m were welded, {} to {}",
        short(welded.tolerance),
        mesh.vertices.len(),
        welded.kept.len()
    );
    let places: Vec<Vec3> = joined.iter().map(|&v| mesh.vertices[v as usize]).collect();
    let elements = joined.into_iter().map(Element::Vertex).collect();
    Fault::new(
        Code::DuplicateVertices,
        what,
        "a surface whose triangles do not share vertices has no neighbours",
        "nothing, if that was meant",
    )
    .at(elements, |k| Some(places[k]))
}

/// Raises `zero_area` and `needle`.
pub(super) fn check_shapes(mesh: &TriMesh, surface: &Surface, faults: &mut Vec<Fault>) {
    let finite: Vec<Vec3> = mesh.vertices.iter().copied().filter(is_finite).collect();
    let box_of_finite = TriMesh {
        vertices: finite,
        ..TriMesh::default()
    };
    let diagonal = box_of_finite
        .bounds()
        .map_or(0.0, |(low, high)| (high - low).norm());
    let limit = ZERO_HEIGHT * diagonal;
    // Original numbers of the triangles that welding left out.
    let mut collapsed: Vec<bool> = mesh.triangles.iter().map(|t| is_usable(mesh, t)).collect();
    for &t in &surface.triangle {
        collapsed[t as usize] = false;
    }
    let (mut flat, mut needles) = (Vec::new(), Vec::new());
    for (t, corners) in mesh.triangles.iter().enumerate() {
        if !is_usable(mesh, corners)
            || !corners
                .iter()
                .all(|&v| is_finite(&mesh.vertices[v as usize]))
        {
            continue;
        }
        let (height, shape) = height_and_shape(mesh.corners(t));
        if collapsed[t] || height <= limit {
            flat.push((t as u32, height));
        } else if shape < MIN_SHAPE {
            needles.push((t as u32, shape));
        }
    }
    raise(mesh, faults, &flat, |n, worst| {
        let what = format!(
            "{} without area, the lowest {} m high, limit {}",
            counted(n, "triangle", "triangles"),
            short(worst),
            short(limit)
        );
        let why = "they have no normal";
        Fault::new(
            Code::ZeroArea,
            what,
            why,
            "remove them in the mesh generator, closing the gap",
        )
        .against(worst, limit)
    });
    raise(mesh, faults, &needles, |n, worst| {
        let what = format!(
            "{} far longer than high, the worst with height over √area of {}, limit {MIN_SHAPE}",
            counted(n, "triangle", "triangles"),
            short(worst)
        );
        let why = "the solution there is resolved in one direction only";
        Fault::new(Code::Needle, what, why, "refine along their length")
            .against(worst, MIN_SHAPE)
    });
}

/// Height over the longest side, and height over √area.
fn height_and_shape([a, b, c]: [Vec3; 3]) -> (f64, f64) {
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    let area = 0.5 * (b - a).cross(&(c - a)).norm();
    if !(longest > 0.0 && area > 0.0) {
        return (0.0, 0.0);
    }
    let height = 2.0 * area / longest;
    (height, height / area.sqrt())
}

/// Raises one fault of triangles with a measured value each, lowest is worst.
fn raise(
    mesh: &TriMesh,
    faults: &mut Vec<Fault>,
    found: &[(u32, f64)],
    fault: impl Fn(usize, f64) -> Fault,
) {
    if found.is_empty() {
        return;
    }
    let worst = found
        .iter()
        .map(|&(_, value)| value)
        .fold(f64::INFINITY, f64::min);
    let elements = found.iter().map(|&(t, _)| Element::Triangle(t)).collect();
    let place = |k: usize| Some(mesh.corners(found[k].0 as usize)[0]);
    faults.push(fault(found.len(), worst).at(elements, place));
}
