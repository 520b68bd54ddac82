//! What is computed on, as files for ParaView.

use crate::chain::surface::Surface;
use fladder_bem::{SurfaceFlow, WakeSheet};
use fladder_mesh::vtu::{Field, Grid, vtu};
use fladder_mesh::{Topology, TrailingEdge, Vec3, trailing_edge};

/// Name and content of each file: the surface, its trailing edges, and the wake once it
/// is laid out.
///
/// `surface.vtu` has cell data `body` and `group` (numbers in the order of `check`, 0: in
/// no group), `trailing_edge` (number of the edge: positive on its upper side, negative on
/// its lower one, 0 elsewhere) and `normal`. `trailing_edges.vtu` has lines with `edge`,
/// `wedge_deg` and `downstream`. `wake.vtu` has triangles with `edge` and `row`, and the
/// lines along which it lies on bodies as cells of row −1.
pub(crate) fn pictures(
    surface: &Surface,
    sheet: Option<&WakeSheet>,
) -> std::io::Result<Vec<(&'static str, Vec<u8>)>> {
    let mut files = vec![
        ("surface.vtu", surface_picture(surface)?),
        ("trailing_edges.vtu", trailing_edges(surface)?),
    ];
    if let Some(sheet) = sheet {
        files.push(("wake.vtu", wake(surface, sheet)?));
    }
    Ok(files)
}

/// The flow on the surface: `flow.vtu` with cell data `velocity` (V₀/U) and `cp`,
/// `pressure_gG_kK.vtu` for each point p with `MODE_re` and `MODE_im` of every mode (c_p
/// per unit of the mode), and the wake.
pub(crate) fn flow_pictures(
    surface: &Surface,
    sheet: &WakeSheet,
    flow: &SurfaceFlow,
    modes: &[String],
) -> std::io::Result<Vec<(String, Vec<u8>)>> {
    let velocities = flow.velocity.iter().map(|&v| Vec3::from(v)).collect();
    let on_surface = |fields: Vec<Field>| {
        file(&Grid {
            points: &surface.mesh.vertices,
            triangles: &surface.mesh.triangles,
            cell_data: fields,
            ..Grid::default()
        })
    };
    let steady = vec![
        Field::vectors("velocity", velocities),
        Field::scalars("cp", flow.pressure.clone()),
    ];
    let mut files = vec![
        ("flow.vtu".to_owned(), on_surface(steady)?),
        ("wake.vtu".to_owned(), wake(surface, sheet)?),
    ];
    for unsteady in &flow.unsteady {
        let fields = modes
            .iter()
            .zip(&unsteady.pressure)
            .flat_map(|(name, values)| {
                let part = |f: fn(&faer::c64) -> f64| values.iter().map(f).collect();
                [
                    Field::scalars(format!("{name}_re"), part(|c| c.re)),
                    Field::scalars(format!("{name}_im"), part(|c| c.im)),
                ]
            })
            .collect();
        let name = format!("pressure_g{}_k{}.vtu", unsteady.p.re, unsteady.p.im);
        files.push((name, on_surface(fields)?));
    }
    Ok(files)
}

fn file(grid: &Grid<'_>) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    vtu(&mut bytes, grid)?;
    Ok(bytes)
}

fn surface_picture(surface: &Surface) -> std::io::Result<Vec<u8>> {
    let mesh = &surface.mesh;
    let count = mesh.triangles.len();
    let mut group = vec![0; count];
    for (number, named) in (1..).zip(&mesh.surfaces) {
        for &t in &named.triangles {
            if let Some(group) = group.get_mut(t as usize).filter(|group| **group == 0) {
                *group = number;
            }
        }
    }
    let mut wedge = vec![0; count];
    for (number, edge) in (1..).zip(&surface.trailing_edges) {
        for (sides, sign) in [(&edge.upper, 1), (&edge.lower, -1)] {
            for &t in sides {
                wedge[t as usize] = sign * number;
            }
        }
    }
    let normal = |t| mesh.area_vector(t).try_normalize(0.0).unwrap_or_default();
    let normals = (0..count).map(normal).collect();
    file(&Grid {
        points: &mesh.vertices,
        triangles: &mesh.triangles,
        cell_data: vec![
            Field::integers("body", surface.body_of_triangle.clone()),
            Field::integers("group", group),
            Field::integers("trailing_edge", wedge),
            Field::vectors("normal", normals),
        ],
        ..Grid::default()
    })
}

fn trailing_edges(surface: &Surface) -> std::io::Result<Vec<u8>> {
    let mesh = &surface.mesh;
    let topology = Topology::new(mesh);
    let (mut lines, mut numbers) = (Vec::new(), Vec::new());
    let (mut wedges, mut downstream) = (Vec::new(), Vec::new());
    for (number, chain) in (1..).zip(&surface.trailing_edges) {
        for edge in chain.edges() {
            let angles = topology
                .edge_between(edge[0], edge[1])
                .and_then(|index| trailing_edge::wedge_and_downstream(mesh, &topology, index));
            let (wedge, along) = angles.unwrap_or((f64::NAN, f64::NAN));
            lines.push(edge);
            numbers.push(number);
            wedges.push(wedge);
            downstream.push(along);
        }
    }
    let (points, lines) = own_points(&mesh.vertices, &lines);
    file(&Grid {
        points: &points,
        lines: &lines,
        cell_data: vec![
            Field::integers("edge", numbers),
            Field::scalars("wedge_deg", wedges),
            Field::scalars("downstream", downstream),
        ],
        ..Grid::default()
    })
}

fn wake(surface: &Surface, sheet: &WakeSheet) -> std::io::Result<Vec<u8>> {
    let mut points: Vec<Vec3> = sheet.vertices.iter().map(|p| Vec3::from(*p)).collect();
    let (mut edges, mut rows): (Vec<i32>, Vec<i32>) = sheet
        .edge
        .iter()
        .zip(&sheet.row)
        .map(|(&edge, &row)| (edge as i32 + 1, row as i32))
        .unzip();
    let mut lines = Vec::new();
    for line in &sheet.junction_lines {
        let from = points.len() as u32;
        points.extend(
            line.vertices
                .iter()
                .map(|&v| surface.mesh.vertices[v as usize]),
        );
        for i in 1..line.vertices.len() as u32 {
            lines.push([from + i - 1, from + i]);
            edges.push(line.edge as i32 + 1);
            rows.push(-1);
        }
    }
    file(&Grid {
        points: &points,
        triangles: &sheet.triangles,
        lines: &lines,
        cell_data: vec![Field::integers("edge", edges), Field::integers("row", rows)],
        ..Grid::default()
    })
}

/// The points that lines use, and the lines in their numbers.
fn own_points(all: &[Vec3], lines: &[[u32; 2]]) -> (Vec<Vec3>, Vec<[u32; 2]>) {
    let mut used: Vec<u32> = lines.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    let place = |v: u32| used.binary_search(&v).unwrap_or_default() as u32;
    (
        used.iter().map(|&v| all[v as usize]).collect(),
        lines.iter().map(|line| line.map(place)).collect(),
    )
}

/// What a trailing edge meets at its first and its last vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum EdgeEnd {
    /// Nothing: a tip, where the jump is zero.
    Free,
    /// A body, along which the jump is carried on.
    OnBody,
    /// Another trailing edge.
    Joined,
    /// The other end of the same edge.
    Closed,
}

impl EdgeEnd {
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::OnBody => "on body",
            Self::Joined => "joined",
            Self::Closed => "closed",
        }
    }
}

/// The ends of every trailing edge, as the wake takes them.
pub(crate) fn ends(edges: &[TrailingEdge], sheet: &WakeSheet) -> Vec<[EdgeEnd; 2]> {
    let end = |number: usize, vertex: Option<&u32>| {
        let on_body = sheet
            .junction_lines
            .iter()
            .any(|line| line.edge as usize == number && line.vertices.first() == vertex);
        let joined = edges.iter().enumerate().any(|(other, edge)| {
            other != number && vertex.is_some_and(|v| edge.vertices.contains(v))
        });
        match (on_body, joined) {
            (true, _) => EdgeEnd::OnBody,
            (_, true) => EdgeEnd::Joined,
            _ => EdgeEnd::Free,
        }
    };
    edges
        .iter()
        .enumerate()
        .map(|(number, edge)| {
            if edge.closed {
                return [EdgeEnd::Closed; 2];
            }
            [edge.vertices.first(), edge.vertices.last()].map(|v| end(number, v))
        })
        .collect()
}
