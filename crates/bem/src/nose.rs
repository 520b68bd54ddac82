//! Whether the nose of lifting parts is resolved.
//!
//! Round a nose of radius ρ the steady velocity falls from U to nothing within ρ, where the
//! perturbation is largest. On triangles longer than that the product of their mean values
//! misses it: the lift by pressure, and with it Q, comes out high, the more the closer the
//! two facets at the edge are to a wedge. Measured on wings of 2 to 12 % thickness, angle
//! between the normals at the nose against excess over the wake's lift: 40° 0.1 %, 80° 0.4 %,
//! 120° 1.2 %.

use crate::adjacency::Adjacency;
use crate::solve::Problem;
use fladder_mesh::Vec3;

/// Angle between the normals at an edge from which the nose is a wedge, degrees.
const WEDGE_DEG: f64 = 100.0;

/// The mean normal of a nose points upstream, by its component.
const UPSTREAM: f64 = 0.8;

/// Length of such edges, in lengths of the trailing edges, from which it is said.
const SHARE: f64 = 0.25;

/// A warning where the foremost edges of the surface are wedges.
pub(crate) fn unresolved(problem: &Problem<'_>) -> Option<String> {
    let mesh = problem.mesh;
    let length =
        |[a, b]: [u32; 2]| (mesh.vertices[a as usize] - mesh.vertices[b as usize]).norm();
    let trailing: f64 = problem
        .trailing_edges
        .iter()
        .flat_map(fladder_mesh::TrailingEdge::edges)
        .map(length)
        .sum();
    let adjacency = Adjacency::new(mesh.vertices.len(), &mesh.triangles);
    let normal = |t: u32| mesh.area_vector(t as usize).normalize();
    let stream = problem.flow.stream();
    let mut wedges = 0.0;
    let mut worst: Option<(f64, Vec3)> = None;
    for (t, corners) in mesh.triangles.iter().enumerate() {
        for i in 0..3 {
            let [a, b] = [corners[i], corners[(i + 1) % 3]];
            let Some(other) = adjacency.left_of(b, a).filter(|_| a < b) else {
                continue;
            };
            let (n, m) = (normal(t as u32), normal(other));
            let angle = n.dot(&m).clamp(-1.0, 1.0).acos().to_degrees();
            if angle < WEDGE_DEG || -(n + m).normalize().dot(&stream) < UPSTREAM {
                continue;
            }
            wedges += length([a, b]);
            if worst.is_none_or(|(largest, _)| angle > largest) {
                let middle = 0.5 * (mesh.vertices[a as usize] + mesh.vertices[b as usize]);
                worst = Some((angle, middle));
            }
        }
    }
    let (angle, at) = worst.filter(|_| wedges > SHARE * trailing)?;
    Some(format!(
        "the leading edge is a wedge over {wedges:.3} m, with up to {angle:.0} degrees between the normals of the triangles that meet there (at {:.4}, {:.4}, {:.4} m): a rounded nose meshed like that has about one per cent too much lift in its pressures; make the first cells about as long as the nose's radius (below 60 degrees), or ignore this if the edge is sharp",
        at.x, at.y, at.z
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fladder_mesh::shapes::NacaWing;
    use fladder_mesh::{Topology, trailing_edge};

    #[test]
    fn a_nose_shorter_than_its_cells_is_told() {
        for (thickness, nose_clustering, is_told) in
            [(0.12, 0.0, false), (0.03, 0.0, true), (0.03, 1.0, false)]
        {
            let wing = NacaWing {
                thickness,
                nose_clustering,
                n_chord: 24,
                n_half_span: 4,
                ..NacaWing::default()
            };
            let mesh = wing.structured().expect("wing");
            let settings = trailing_edge::Settings::default();
            let edges = trailing_edge::find_by_shape(&mesh, &Topology::new(&mesh), settings);
            let told = unresolved(&Problem::new(&mesh, &edges, &[], 0.5));
            assert_eq!(
                told.is_some(),
                is_told,
                "{thickness} {nose_clustering}: {told:?}"
            );
        }
    }
}
