//! Mesh files out: Gmsh `.msh` 4.1 binary with named groups, STL.
//!
//! Gmsh reference manual, "MSH file format". Triangles that share the same set
//! of surface groups belong to one discrete surface, and every curve group is
//! one discrete curve; vertex and element tags are indices plus one, so that
//! the numbering survives.

use std::collections::BTreeMap;
use std::io::{self, Write};

use crate::TriMesh;

/// Writes a Gmsh 4.1 binary file; reading it gives the same mesh bit for bit,
/// apart from groups without elements.
///
/// # Errors
/// Those of the writer.
pub fn msh41(mut out: impl Write, mesh: &TriMesh) -> io::Result<()> {
    let surfaces = DiscreteSurfaces::new(mesh);
    out.write_all(b"$MeshFormat\n4.1 1 8\n")?;
    int(&mut out, 1)?;
    out.write_all(b"\n$EndMeshFormat\n")?;
    physical_names(&mut out, mesh)?;
    entities(&mut out, mesh, &surfaces)?;
    nodes(&mut out, mesh)?;
    elements(&mut out, mesh, &surfaces)?;
    out.flush()
}

/// Writes a file of triangles without vertices, names or full precision.
///
/// # Errors
/// Those of the writer.
pub fn stl(mut out: impl Write, mesh: &TriMesh) -> io::Result<()> {
    let triangles = (0..mesh.triangles.len()).map(|t| {
        let normal = mesh.area_vector(t).try_normalize(0.0).unwrap_or_default();
        let corners = mesh
            .corners(t)
            .map(|p| stl_io::Vertex::new(p.map(|x| x as f32).into()));
        stl_io::Triangle {
            normal: stl_io::Normal::new(normal.map(|x| x as f32).into()),
            vertices: corners,
        }
    });
    let triangles: Vec<stl_io::Triangle> = triangles.collect();
    stl_io::write_stl(&mut out, triangles.iter())?;
    out.flush()
}

/// The sets of surface groups that occur, and which one each triangle has.
struct DiscreteSurfaces {
    groups: Vec<Vec<i32>>,
    of_triangle: Vec<usize>,
}

impl DiscreteSurfaces {
    fn new(mesh: &TriMesh) -> Self {
        let mut sets = vec![Vec::new(); mesh.triangles.len()];
        for (tag, group) in (1..).zip(&mesh.surfaces) {
            for &t in &group.triangles {
                sets[t as usize].push(tag);
            }
        }
        let mut index = BTreeMap::new();
        let mut groups = Vec::new();
        let of_triangle = sets
            .into_iter()
            .map(|set| {
                *index.entry(set.clone()).or_insert_with(|| {
                    groups.push(set);
                    groups.len() - 1
                })
            })
            .collect();
        Self {
            groups,
            of_triangle,
        }
    }

    /// Runs of consecutive triangles of one discrete surface.
    fn runs(&self) -> impl Iterator<Item = (usize, std::ops::Range<usize>)> + Clone + '_ {
        let mut start = 0;
        self.of_triangle.chunk_by(|a, b| a == b).map(move |run| {
            let range = start..start + run.len();
            start = range.end;
            (run[0], range)
        })
    }
}

fn int(out: &mut impl Write, value: i32) -> io::Result<()> {
    out.write_all(&value.to_le_bytes())
}

fn size(out: &mut impl Write, value: usize) -> io::Result<()> {
    out.write_all(&(value as u64).to_le_bytes())
}

fn physical_names(out: &mut impl Write, mesh: &TriMesh) -> io::Result<()> {
    let n_names = mesh.surfaces.len() + mesh.curves.len();
    if n_names == 0 {
        return Ok(());
    }
    writeln!(out, "$PhysicalNames\n{n_names}")?;
    for (tag, group) in (1..).zip(&mesh.curves) {
        writeln!(out, "1 {tag} \"{}\"", group.name)?;
    }
    for (tag, group) in (1..).zip(&mesh.surfaces) {
        writeln!(out, "2 {tag} \"{}\"", group.name)?;
    }
    writeln!(out, "$EndPhysicalNames")
}

fn entities(
    out: &mut impl Write,
    mesh: &TriMesh,
    surfaces: &DiscreteSurfaces,
) -> io::Result<()> {
    let (low, high) = mesh.bounds().unwrap_or_default();
    out.write_all(b"$Entities\n")?;
    for count in [0, mesh.curves.len(), surfaces.groups.len(), 0] {
        size(out, count)?;
    }
    let curves = (1..).take(mesh.curves.len()).map(|tag| vec![tag]);
    for groups in [curves.collect(), surfaces.groups.clone()] {
        for (tag, groups) in (1..).zip(groups) {
            int(out, tag)?;
            for x in low.iter().chain(high.iter()) {
                out.write_all(&x.to_le_bytes())?;
            }
            size(out, groups.len())?;
            for group in groups {
                int(out, group)?;
            }
            size(out, 0)?;
        }
    }
    out.write_all(b"\n$EndEntities\n")
}

fn nodes(out: &mut impl Write, mesh: &TriMesh) -> io::Result<()> {
    let count = mesh.vertices.len();
    out.write_all(b"$Nodes\n")?;
    for value in [1, count, 1, count] {
        size(out, value)?;
    }
    for value in [2, 1, 0] {
        int(out, value)?;
    }
    size(out, count)?;
    for vertex in 0..count {
        size(out, vertex + 1)?;
    }
    for x in mesh.vertices.iter().flat_map(|p| p.iter()) {
        out.write_all(&x.to_le_bytes())?;
    }
    out.write_all(b"\n$EndNodes\n")
}

fn elements(
    out: &mut impl Write,
    mesh: &TriMesh,
    surfaces: &DiscreteSurfaces,
) -> io::Result<()> {
    let n_lines: usize = mesh.curves.iter().map(|curve| curve.edges.len()).sum();
    let count = n_lines + mesh.triangles.len();
    out.write_all(b"$Elements\n")?;
    for value in [mesh.curves.len() + surfaces.runs().count(), count, 1, count] {
        size(out, value)?;
    }
    // Triangles come first so that their tags are their indices plus one.
    for (surface, range) in surfaces.runs() {
        for value in [2, surface as i32 + 1, 2] {
            int(out, value)?;
        }
        size(out, range.len())?;
        for t in range {
            size(out, t + 1)?;
            for v in mesh.triangles[t] {
                size(out, v as usize + 1)?;
            }
        }
    }
    let mut tag = mesh.triangles.len();
    for (curve, group) in (1..).zip(&mesh.curves) {
        for value in [1, curve, 1] {
            int(out, value)?;
        }
        size(out, group.edges.len())?;
        for edge in &group.edges {
            tag += 1;
            size(out, tag)?;
            for v in edge {
                size(out, *v as usize + 1)?;
            }
        }
    }
    out.write_all(b"\n$EndElements\n")
}
