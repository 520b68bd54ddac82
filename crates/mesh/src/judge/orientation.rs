//! One orientation for every connected part, by flood fill.

use super::fault::counted;
use super::{Code, Element, Fault, Severity, Surface};
use crate::Topology;
use crate::topology::runs_along;

/// Turns triangles that run against most of their part; returns the parts.
///
/// Triangles are connected across edges that have exactly two. Raises
/// `flipped`, as an error where a part has no consistent orientation.
pub(super) fn orient(
    surface: &mut Surface,
    topology: &Topology,
    faults: &mut Vec<Fault>,
) -> Vec<Vec<u32>> {
    let n = surface.mesh.triangles.len();
    // Whether each triangle runs against the first of its part.
    let mut against: Vec<Option<bool>> = vec![None; n];
    let (mut parts, mut turned, mut twisted) = (Vec::new(), Vec::new(), Vec::new());
    for start in 0..n {
        if against[start].is_some() {
            continue;
        }
        against[start] = Some(false);
        let mut part = vec![start as u32];
        let mut next = 0;
        while let Some(&t) = part.get(next) {
            next += 1;
            let own = against[t as usize].unwrap_or(false);
            for (other, runs_against) in neighbours(surface, topology, t) {
                let expected = own != runs_against;
                match against[other as usize] {
                    None => {
                        against[other as usize] = Some(expected);
                        part.push(other);
                    }
                    Some(known) if known != expected => twisted.push(t.min(other)),
                    Some(_) => {}
                }
            }
        }
        part.sort_unstable();
        let n_against = part
            .iter()
            .filter(|&&t| against[t as usize] == Some(true))
            .count();
        let minority = 2 * n_against <= part.len();
        turned.extend(
            part.iter()
                .filter(|&&t| against[t as usize] == Some(minority)),
        );
        parts.push(part);
    }
    for &t in &turned {
        surface.mesh.triangles[t as usize].swap(1, 2);
    }
    if !turned.is_empty() {
        faults.push(flipped(surface, turned, &mut twisted));
    }
    parts
}

fn flipped(surface: &Surface, turned: Vec<u32>, twisted: &mut Vec<u32>) -> Fault {
    let mut fault = Fault::new(
        Code::Flipped,
        format!(
            "{} against the run of the neighbours, turned round",
            counted(turned.len(), "triangle", "triangles")
        ),
        "their normals pointed to the other side",
        "nothing, if the surface is closed",
    );
    let mut shown = turned;
    if !twisted.is_empty() {
        twisted.sort_unstable();
        twisted.dedup();
        fault = Fault::new(
            Code::Flipped,
            format!(
                "{} without an orientation that fits the neighbours",
                counted(twisted.len(), "triangle", "triangles")
            ),
            "a twisted band has no outside",
            "remesh there",
        );
        fault.severity = Severity::Error;
        shown = std::mem::take(twisted);
    }
    shown.sort_unstable();
    let elements = shown
        .iter()
        .map(|&t| Element::Triangle(surface.triangle[t as usize]))
        .collect();
    fault.at(elements, |k| Some(surface.centroid(shown[k] as usize)))
}

/// Triangles across edges of two, and whether they run the same way along it,
/// that is, against this triangle's orientation.
fn neighbours(surface: &Surface, topology: &Topology, t: u32) -> Vec<(u32, bool)> {
    let triangles = &surface.mesh.triangles;
    let mut found = Vec::with_capacity(3);
    for (k, &edge) in topology.triangle_edges[t as usize].iter().enumerate() {
        let &[s, u] = topology.edge_triangles(edge as usize) else {
            continue;
        };
        let other = if s == t { u } else { s };
        let corners = triangles[t as usize];
        found.push((
            other,
            runs_along(triangles[other as usize], corners[k], corners[(k + 1) % 3]),
        ));
    }
    found
}
