//! Connected parts: Euler characteristic, area, volume, and which way is out.

use super::fault::{counted, short};
use super::{Code, Element, Fault, Settings, Surface};
use crate::{Topology, Vec3};

/// A connected part of the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its triangles, in the numbers of the mesh as it came in, ascending.
    pub triangles: Vec<u32>,
    /// V − E + F, of the half that is given in a half model.
    pub euler: i64,
    /// Number of handles, from χ = 2 − 2 genus; in a half model that of the
    /// whole body, whose χ is twice the half's. `None` when open or pinched.
    pub genus: Option<u32>,
    /// Whether the symmetry plane of a half model cuts it.
    pub is_cut: bool,
    /// Area of what is given, m².
    pub area: f64,
    /// Volume of what is given, m³, positive; `None` when open.
    pub volume: Option<f64>,
}

/// Measures the parts and turns those inside out, raising `inside_out`.
pub(super) fn measure(
    surface: &mut Surface,
    topology: &Topology,
    is_rim: &[bool],
    parts: Vec<Vec<u32>>,
    settings: Settings,
    faults: &mut Vec<Fault>,
) -> Vec<Body> {
    let (mut bodies, mut inverted) = (Vec::with_capacity(parts.len()), Vec::new());
    for (number, part) in (0..).zip(parts) {
        let mut body = measured(surface, topology, is_rim, &part, settings);
        if let Some(volume) = body.volume.filter(|&volume| volume < 0.0) {
            for &t in &part {
                surface.mesh.triangles[t as usize].swap(1, 2);
            }
            inverted.push((number, volume, surface.centroid(part[0] as usize)));
            body.volume = Some(-volume);
        }
        bodies.push(body);
    }
    if !inverted.is_empty() {
        let elements = inverted
            .iter()
            .map(|&(number, ..)| Element::Body(number))
            .collect();
        let lowest = inverted
            .iter()
            .map(|&(_, volume, _)| volume)
            .fold(0.0, f64::min);
        let what = format!(
            "{} inside out, with a volume of {} m³, turned round",
            counted(inverted.len(), "body", "bodies"),
            short(lowest)
        );
        let why = "normals must point into the fluid";
        let fault = Fault::new(
            Code::InsideOut,
            what,
            why,
            "nothing, if the fluid is outside",
        );
        faults.push(
            fault
                .at(elements, |k| Some(inverted[k].2))
                .against(lowest, 0.0),
        );
    }
    bodies
}

fn measured(
    surface: &Surface,
    topology: &Topology,
    is_rim: &[bool],
    part: &[u32],
    settings: Settings,
) -> Body {
    let mesh = &surface.mesh;
    let mut edges: Vec<u32> = part
        .iter()
        .flat_map(|&t| topology.triangle_edges[t as usize])
        .collect();
    let mut vertices: Vec<u32> = part
        .iter()
        .flat_map(|&t| mesh.triangles[t as usize])
        .collect();
    for list in [&mut edges, &mut vertices] {
        list.sort_unstable();
        list.dedup();
    }
    let euler = vertices.len() as i64 - edges.len() as i64 + part.len() as i64;
    let has_rim = edges.iter().any(|&edge| is_rim[edge as usize]);
    let is_closed = edges.iter().all(|&edge| {
        is_rim[edge as usize] || topology.edge_triangles(edge as usize).len() == 2
    });
    let is_finite = part.iter().all(|&t| surface.is_finite[t as usize]);
    let of_whole = if has_rim { 2 * euler } else { euler };
    let genus =
        (is_closed && of_whole <= 2 && of_whole % 2 == 0).then(|| ((2 - of_whole) / 2) as u32);
    let finite = part.iter().filter(|&&t| surface.is_finite[t as usize]);
    Body {
        triangles: part.iter().map(|&t| surface.triangle[t as usize]).collect(),
        euler,
        genus,
        is_cut: has_rim,
        area: finite.map(|&t| mesh.area_vector(t as usize).norm()).sum(),
        volume: (is_closed && is_finite).then(|| volume(surface, part, settings)),
    }
}

/// Sum of the tetrahedra to a point near the part, in the symmetry plane of a
/// half model, so that the missing wall there adds nothing.
fn volume(surface: &Surface, part: &[u32], settings: Settings) -> f64 {
    let mut apex: Vec3 = surface.centroid(part[0] as usize);
    if settings.symmetry_plane {
        apex.y = 0.0;
    }
    let tetrahedron = |&t: &u32| {
        let [a, b, c] = surface.mesh.corners(t as usize).map(|p| p - apex);
        a.cross(&b).dot(&c) / 6.0
    };
    part.iter().map(tetrahedron).sum()
}
