//! Edges and vertices at which the surface is not a surface.

use super::fault::{counted, short};
use super::{Code, Element, Fault, Settings, Surface};
use crate::Topology;

/// Edges with one triangle that lie in the symmetry plane of a half model.
pub(super) fn symmetry_rim(
    surface: &Surface,
    topology: &Topology,
    settings: Settings,
) -> Vec<bool> {
    let is_rim = |edge: usize| {
        settings.symmetry_plane
            && topology.edge_triangles(edge).len() == 1
            && topology.edges[edge]
                .iter()
                .all(|&v| surface.is_in_symmetry_plane(v))
    };
    (0..topology.edges.len()).map(is_rim).collect()
}

/// Raises `open_edge`, `non_manifold_edge` and `bow_tie`.
pub(super) fn check(
    surface: &Surface,
    topology: &Topology,
    is_rim: &[bool],
    settings: Settings,
    faults: &mut Vec<Fault>,
) {
    let beside_gap = |edge: usize| {
        topology.edges[edge]
            .iter()
            .any(|&v| surface.is_beside_gap[v as usize])
    };
    let (mut open, mut manifold) = (Vec::new(), Vec::new());
    let mut is_doubtful = surface.is_beside_gap.clone();
    for (edge, &in_plane) in is_rim.iter().enumerate() {
        let is_fault = match topology.edge_triangles(edge).len() {
            1 if in_plane || beside_gap(edge) => false,
            1 => {
                open.push(edge);
                true
            }
            2 => false,
            _ => {
                manifold.push(edge);
                true
            }
        };
        for &v in topology.edges[edge].iter().filter(|_| is_fault) {
            is_doubtful[v as usize] = true;
        }
    }
    if !open.is_empty() {
        let fault = if settings.symmetry_plane {
            open_beside_plane(surface, topology, &open)
        } else {
            open_edges(open.len())
        };
        faults.push(of_edges(surface, topology, &open, fault));
    }
    if !manifold.is_empty() {
        let most = manifold
            .iter()
            .map(|&edge| topology.edge_triangles(edge).len())
            .max()
            .unwrap_or(0);
        let fault = Fault::new(
            Code::NonManifoldEdge,
            format!(
                "{} with more than two triangles, up to {most}",
                counted(manifold.len(), "edge", "edges")
            ),
            "there is no one side to either side of them",
            "model fins and junctions as thick parts that share vertices with the skin, without inner walls",
        );
        faults.push(of_edges(surface, topology, &manifold, fault));
    }
    let is_closed_in_plane = closed_in_plane(surface, topology, is_rim, settings);
    check_fans(surface, topology, &is_doubtful, &is_closed_in_plane, faults);
}

/// Vertices in which a half model touches its mirror image without being open
/// there; those of walls in the plane cross it.
fn closed_in_plane(
    surface: &Surface,
    topology: &Topology,
    is_rim: &[bool],
    settings: Settings,
) -> Vec<bool> {
    let mut is_closed = vec![false; surface.mesh.vertices.len()];
    if !settings.symmetry_plane {
        return is_closed;
    }
    let mut mark = |vertices: &[u32], value: &dyn Fn(u32) -> bool| {
        for &v in vertices {
            is_closed[v as usize] = value(v);
        }
    };
    let triangles = &surface.mesh.triangles;
    for triangle in triangles {
        mark(triangle, &|v| surface.is_in_symmetry_plane(v));
    }
    let in_plane = |t: &&[u32; 3]| t.iter().all(|&v| surface.is_in_symmetry_plane(v));
    for wall in triangles.iter().filter(in_plane) {
        mark(wall, &|_| false);
    }
    for (edge, _) in is_rim.iter().enumerate().filter(|(_, is_rim)| **is_rim) {
        mark(&topology.edges[edge], &|_| false);
    }
    is_closed
}

fn open_edges(count: usize) -> Fault {
    Fault::new(
        Code::OpenEdge,
        format!(
            "the surface is open along {}",
            counted(count, "edge", "edges")
        ),
        "the potential inside an open body is undefined",
        "close the surface in the mesh generator, or set mesh.symmetry if it is a half model",
    )
}

/// Open edges of a half model: how far the nearest lies from the plane.
fn open_beside_plane(surface: &Surface, topology: &Topology, open: &[usize]) -> Fault {
    let distance = |&edge: &usize| {
        let [a, b] = topology.edges[edge].map(|v| surface.mesh.vertices[v as usize].y.abs());
        a.max(b)
    };
    let nearest = open.iter().map(distance).fold(f64::INFINITY, f64::min);
    let what = format!(
        "the surface is open along {} beside the plane y = 0, the nearest {} m away, limit {} m",
        counted(open.len(), "edge", "edges"),
        short(nearest),
        short(surface.tolerance)
    );
    Fault::new(
        Code::OpenEdge,
        what,
        "a half model is closed by its mirror image in the plane alone",
        "move the rim of the half to y = 0 exactly, and close the surface elsewhere",
    )
    .against(nearest, surface.tolerance)
}

fn of_edges(surface: &Surface, topology: &Topology, edges: &[usize], fault: Fault) -> Fault {
    let elements = edges
        .iter()
        .map(|&edge| surface.edge(topology.edges[edge]))
        .collect();
    fault.at(elements, |k| Some(surface.middle(topology.edges[edges[k]])))
}

/// Raises `bow_tie` at vertices whose triangles form more than one fan, that
/// of the mirror image counted.
fn check_fans(
    surface: &Surface,
    topology: &Topology,
    is_doubtful: &[bool],
    is_closed_in_plane: &[bool],
    faults: &mut Vec<Fault>,
) {
    let tied: Vec<u32> = (0..surface.mesh.vertices.len() as u32)
        .filter(|&v| {
            !is_doubtful[v as usize]
                && (is_closed_in_plane[v as usize] || n_fans(surface, topology, v) > 1)
        })
        .collect();
    if tied.is_empty() {
        return;
    }
    let elements = tied
        .iter()
        .map(|&v| Element::Vertex(surface.vertex[v as usize]))
        .collect();
    let fault = Fault::new(
        Code::BowTie,
        format!(
            "the surface touches itself in {}",
            counted(tied.len(), "single vertex", "single vertices")
        ),
        "both sides would share one potential there",
        "separate the parts, or join them along edges",
    );
    faults.push(fault.at(elements, |k| Some(surface.mesh.vertices[tied[k] as usize])));
}

/// Number of fans of triangles around a vertex, joined across edges of two.
fn n_fans(surface: &Surface, topology: &Topology, vertex: u32) -> usize {
    let around = topology.vertex_triangles(vertex as usize);
    let mut is_reached = vec![false; around.len()];
    let mut count = 0;
    for start in 0..around.len() {
        if is_reached[start] {
            continue;
        }
        count += 1;
        let mut open = vec![start];
        while let Some(at) = open.pop() {
            if std::mem::replace(&mut is_reached[at], true) {
                continue;
            }
            let t = around[at] as usize;
            for (k, &edge) in topology.triangle_edges[t].iter().enumerate() {
                let corners = surface.mesh.triangles[t];
                if corners[k] != vertex && corners[(k + 1) % 3] != vertex {
                    continue;
                }
                for other in topology.edge_triangles(edge as usize) {
                    open.extend(
                        around
                            .iter()
                            .position(|t| t == other)
                            .filter(|&o| !is_reached[o]),
                    );
                }
            }
        }
    }
    count
}
