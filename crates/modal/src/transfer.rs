//! Modes of the structure on the wetted surface.
//!
//! Every vertex is carried by the nearest face of its component and the rotation
//! of that face ([`crate::offset`]), or by a spline through its component's nodes
//! ([`crate::scatter`], [`crate::rod`]); all of it is one sparse matrix, whose transpose carries
//! forces back ([`BlockMatrix`]).

use crate::axes_hint::better_axes;
use crate::block_matrix::BlockMatrix;
use crate::closest::FaceSearch;
use crate::components::{Mapping, Plan, Planner, Target, target_faces};
use crate::error::TransferError;
use crate::model::{ElasticMode, StructuralModel};
use crate::offset;
use crate::read::{diagonal, ranges};
use crate::result::ModalResult;
use crate::rod::Rod;
use crate::scatter::{Scatter, Wanted, apart};
use crate::skin::{self, Skin, SurfaceSearch};
use crate::skin_error::{SkinError, WayBack};
use crate::transfer_settings::{Method, TransferSettings};
use fladder_mesh::{Frame, SurfaceMode, Symmetry, TriMesh, Vec3};
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

/// Mesh size over structure size, both box diagonals: outside, the two are in
/// different units (the smallest common factor is 3.3, feet to metres) or one
/// of them is not the aircraft.
const SIZE_RATIO: [f64; 2] = [0.5, 2.0];

/// Distance from the structure, relative to the mesh's diagonal, up to which a
/// vertex counts as covered: open noses and hinge gaps stay below.
const COVERED: f64 = 0.025;

/// The same for a vertex under a spline: beams and test points stand off the
/// surface by a chord, or by the distance between them.
const COVERED_BY_POINTS: f64 = 0.1;

/// Share of the surface that must be covered: less, and the two are in different
/// axes or belong to different aircraft.
const LEAST_OVERLAP: f64 = 0.3;

/// Share under which a note is made.
const EXPECTED_OVERLAP: f64 = 0.95;

/// The matrix and what is to be said about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    /// Nodes of the structure to vertices of the mesh.
    pub matrix: BlockMatrix,
    /// How well the two fit.
    pub report: TransferReport,
    /// Judges single modes.
    way_back: WayBack,
}

impl Transfer {
    /// Largest difference between a displacement of the surface and that of the
    /// structure's nodes at the surface; `None` where there are no such nodes.
    pub fn skin_error(&self, on_surface: &[Vec3], on_structure: &[Vec3]) -> Option<SkinError> {
        self.way_back.error(on_surface, on_structure)
    }
}

/// How structure and surface fit together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TransferReport {
    /// Diagonal of the mesh over that of the structure.
    pub size_ratio: f64,
    /// Largest distance of a vertex from the structure that carries it, m.
    pub largest_distance: f64,
    /// The vertex of that distance.
    pub farthest_vertex: u32,
    /// Share of the wetted area nearer to the structure than `covered_within`.
    pub overlap: f64,
    /// Distance up to which a vertex counts as covered, m; four times as much
    /// under a spline.
    pub covered_within: f64,
    /// One entry a part of the mesh.
    pub components: Vec<ComponentReport>,
    /// Elements that carry no surface, by set.
    pub left_out: Vec<String>,
    /// Largest error of each mode against the structure's skin, in their order;
    /// empty before modes are carried.
    pub errors: Vec<Option<SkinError>>,
    /// What looks odd.
    pub notes: Vec<String>,
}

/// How one part of the mesh is carried.
#[derive(Clone, Debug, PartialEq)]
pub struct ComponentReport {
    /// Group of the mesh.
    pub name: String,
    /// Element sets of the structure that carry it.
    pub sets: Vec<String>,
    /// How they were found.
    pub mapping: Mapping,
    /// By what it is carried.
    pub method: Method,
    /// Faces that carry it, or nodes under a spline.
    pub faces: usize,
    /// Vertices carried.
    pub vertices: usize,
    /// Largest distance of one of them from its face, m.
    pub largest_distance: f64,
    /// Vertices that count as uncovered.
    pub uncovered: usize,
}

/// Carries the elastic modes of a structure to a mesh; frame
/// [`Frame::Inertial`].
///
/// # Errors
/// See [`build`].
pub fn transfer(
    model: &StructuralModel,
    mesh: &TriMesh,
    settings: impl Into<TransferSettings>,
) -> Result<(Vec<SurfaceMode>, TransferReport), TransferError> {
    let transfer = build(&model.result, mesh, settings)?;
    let (modes, judged): (Vec<SurfaceMode>, Vec<(f64, _)>) = model
        .elastic
        .par_iter()
        .map(|shape| {
            let mut displacement = transfer
                .matrix
                .displacement(&nodal(shape, &transfer.matrix));
            let removed = hold_in_plane(&mut displacement, mesh, model.symmetry);
            let mode = SurfaceMode {
                name: shape.name.clone(),
                frame: Frame::Inertial,
                displacement,
            };
            let error = transfer.skin_error(&mode.displacement, &shape.shape);
            (mode, (removed, error))
        })
        .unzip();
    let (removed, errors): (Vec<f64>, Vec<_>) = judged.into_iter().unzip();
    let mut report = transfer.report;
    report.errors = errors;
    let worst = (0..modes.len()).max_by(|&a, &b| removed[a].total_cmp(&removed[b]));
    if let Some(worst) = worst.filter(|&worst| removed[worst] > SAID_IN_PLANE) {
        report.notes.push(format!(
            "in the symmetry plane the surface was kept from moving as {} motion cannot, by up to \
             {:.1e} of the largest displacement, in {}",
            model.symmetry.word(),
            removed[worst],
            modes[worst].name
        ));
    }
    Ok((modes, report))
}

/// Displacements, and rotations behind them where the matrix takes them.
fn nodal<'a>(mode: &'a ElasticMode, matrix: &BlockMatrix) -> Cow<'a, [Vec3]> {
    match &mode.rotation {
        Some(rotation) if matrix.columns() > mode.shape.len() => {
            Cow::Owned([mode.shape.as_slice(), rotation].concat())
        }
        _ => Cow::Borrowed(&mode.shape),
    }
}

/// Round-off of a displacement, relative to the largest.
const SAID_IN_PLANE: f64 = 1e-9;

/// Takes from the vertices in the plane of a half model what its kind of motion
/// does not allow there; the largest part taken, relative to the largest
/// displacement.
fn hold_in_plane(displacement: &mut [Vec3], mesh: &TriMesh, symmetry: Symmetry) -> f64 {
    if !symmetry.is_half() {
        return 0.0;
    }
    let largest = displacement.iter().map(Vec3::norm).fold(0.0, f64::max);
    let mut removed: f64 = 0.0;
    for (u, vertex) in displacement.iter_mut().zip(&mesh.vertices) {
        if vertex.y == 0.0 {
            let kept = symmetry.in_plane(*u);
            removed = removed.max((*u - kept).norm());
            *u = kept;
        }
    }
    if largest > 0.0 {
        removed / largest
    } else {
        0.0
    }
}

/// Builds the matrix that carries displacements from structure to mesh.
///
/// Its columns are the nodes and, where nodes on one line carry a part by their
/// rotations, behind them the rotations of all nodes.
///
/// Cost: a nearest-face query a vertex, O(vertices · log faces); under a spline
/// that of three patches of forty points a vertex.
///
/// # Errors
/// [`TransferError`] for structures without shells or solids, unknown names,
/// sizes that betray different units, and bodies that lie apart.
pub fn build(
    result: &ModalResult,
    mesh: &TriMesh,
    settings: impl Into<TransferSettings>,
) -> Result<Transfer, TransferError> {
    let settings = &settings.into();
    let positions = result.positions();
    let surface = SurfaceSearch::new(mesh).ok_or(TransferError::NoSurface)?;
    let faces = skin::candidates(result, &positions);
    let methods = settings.methods.values().chain([&settings.default_method]);
    let splines = methods.filter(|method| **method != Method::Faces).count();
    if faces.is_empty() && splines == 0 {
        return Err(TransferError::NoSkin {
            elements: result.elements.len(),
        });
    }
    let skin = Skin::judge(faces, &positions, &surface);
    let planner = Planner {
        result,
        positions: &positions,
        mesh,
        skin: &skin,
        settings,
    };
    // Under wrong axes few faces lie on the surface: all of them tell the size.
    let by_faces = || {
        let of_faces = skin.faces.iter().flat_map(|face| &face.nodes);
        size_ratio(of_faces, &positions, mesh)
    };
    let of_faces = (splines == 0).then(by_faces).transpose()?;
    let plan = match planner.plan() {
        Err(TransferError::NotOnSurface) => {
            return Err(TransferError::Apart {
                overlap: 0.0,
                hint: better_axes(&positions, &mesh.vertices),
            });
        }
        other => other?,
    };
    let nodes = carrying_nodes(&plan, &skin);
    let size_ratio = match of_faces {
        Some(ratio) => ratio,
        None => size_ratio(nodes.iter().flatten(), &positions, mesh)?,
    };
    let carriers = Carriers::new(&plan, &skin, &positions, result)?;
    let carried = carriers.carry(&plan, &positions, mesh);
    let mut report = report(&plan, &skin, &carried, mesh);
    report.size_ratio = size_ratio;
    report.left_out = left_out(&plan, &skin, result);
    if report.overlap < LEAST_OVERLAP {
        let hint = better_axes(&positions, &mesh.vertices);
        return Err(TransferError::Apart {
            overlap: report.overlap,
            hint,
        });
    }
    let rows = carried.into_iter().map(|carried| carried.blocks).collect();
    let columns = positions.len() * carriers.columns_a_node();
    Ok(Transfer {
        matrix: BlockMatrix::from_rows(columns, rows),
        report,
        way_back: WayBack::new(&plan, &nodes, &positions, mesh),
    })
}

/// Nodes of each target, ascending.
fn carrying_nodes(plan: &Plan, skin: &Skin) -> Vec<Vec<u32>> {
    let of_target = |target: &Target| {
        let mut nodes: Vec<u32> = match target {
            Target::Faces(faces) => {
                let of_face = |f: &u32| skin.faces[*f as usize].nodes.iter().copied();
                faces.iter().flat_map(of_face).collect()
            }
            Target::Nodes(nodes, _) => nodes.clone(),
        };
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    };
    plan.targets.iter().map(of_target).collect()
}

fn size_ratio<'a>(
    nodes: impl Iterator<Item = &'a u32>,
    positions: &[Vec3],
    mesh: &TriMesh,
) -> Result<f64, TransferError> {
    let used: BTreeSet<u32> = nodes.copied().collect();
    let structure = diagonal(used.iter().map(|node| &positions[*node as usize]));
    let mesh = diagonal(mesh.vertices.iter());
    let ratio = mesh / structure;
    if (SIZE_RATIO[0]..=SIZE_RATIO[1]).contains(&ratio) {
        return Ok(ratio);
    }
    Err(TransferError::Size {
        mesh,
        structure,
        ratio,
    })
}

/// One row of the matrix and its distance; no blocks for vertices of no
/// triangle.
struct Carried {
    blocks: Vec<(u32, Matrix3<f64>)>,
    distance: f64,
}

/// One of [`Plan::targets`], ready to be asked.
enum Carrier {
    Faces(Option<Box<FaceSearch>>),
    Points(Scatter),
    Beam(Rod),
}

struct Carriers(Vec<Carrier>);

impl Carriers {
    fn new(
        plan: &Plan,
        skin: &Skin,
        positions: &[Vec3],
        result: &ModalResult,
    ) -> Result<Self, TransferError> {
        let has_rotations =
            !result.modes.is_empty() && result.modes.iter().all(|mode| mode.rotation.is_some());
        let carrier = |(number, target): (usize, &Target)| match target {
            Target::Faces(faces) => {
                let search = FaceSearch::new(target_faces(skin, faces), positions);
                Ok(Carrier::Faces(search.map(Box::new)))
            }
            Target::Nodes(nodes, kernel) => {
                let mut names = plan.components.iter().filter(|c| c.target == number);
                let beam = if has_rotations {
                    Rod::new(&apart(nodes, positions), positions)
                } else {
                    None
                };
                if let Some(beam) = beam {
                    return Ok(Carrier::Beam(beam));
                }
                let wanted = Wanted {
                    group: names.next().map_or("", |component| &component.name),
                    nodes,
                    kernel: *kernel,
                };
                Scatter::new(&wanted, positions).map(Carrier::Points)
            }
        };
        let carriers = plan.targets.iter().enumerate().map(carrier);
        Ok(Self(carriers.collect::<Result<_, _>>()?))
    }

    /// Two where rotations stand behind the displacements.
    fn columns_a_node(&self) -> usize {
        let is_beam = |carrier: &Carrier| matches!(carrier, Carrier::Beam(_));
        1 + usize::from(self.0.iter().any(is_beam))
    }

    fn carry(&self, plan: &Plan, positions: &[Vec3], mesh: &TriMesh) -> Vec<Carried> {
        mesh.vertices
            .par_iter()
            .zip(&plan.of_vertex)
            .map(|(vertex, component)| {
                let target = component.map(|c| plan.components[c as usize].target);
                self.row(target, vertex, positions)
            })
            .collect()
    }

    fn row(&self, target: Option<usize>, vertex: &Vec3, positions: &[Vec3]) -> Carried {
        match target.map(|target| &self.0[target]) {
            Some(Carrier::Faces(Some(search))) => {
                let hit = search.nearest(vertex, positions);
                let face = &search.faces()[hit.face as usize];
                Carried {
                    blocks: offset::blocks(face, hit.at, vertex, positions),
                    distance: hit.distance,
                }
            }
            Some(Carrier::Points(points)) => Carried {
                blocks: points.blocks(vertex),
                distance: points.distance(vertex),
            },
            Some(Carrier::Beam(beam)) => Carried {
                blocks: beam.blocks(vertex),
                distance: beam.distance(vertex),
            },
            Some(Carrier::Faces(None)) | None => Carried {
                blocks: Vec::new(),
                distance: 0.0,
            },
        }
    }
}

fn report(plan: &Plan, skin: &Skin, carried: &[Carried], mesh: &TriMesh) -> TransferReport {
    let mesh_size = diagonal(mesh.vertices.iter());
    let covered_within = COVERED * mesh_size;
    let mut components: Vec<ComponentReport> = plan
        .components
        .iter()
        .map(|component| ComponentReport {
            name: component.name.clone(),
            sets: component.sets.clone(),
            mapping: component.mapping,
            method: match plan.targets[component.target] {
                Target::Faces(_) => Method::Faces,
                Target::Nodes(_, kernel) => Method::Spline(kernel),
            },
            faces: plan.targets[component.target].len(),
            vertices: 0,
            largest_distance: 0.0,
            uncovered: 0,
        })
        .collect();
    let mut report = TransferReport {
        covered_within,
        overlap: overlap(plan, carried, mesh),
        notes: plan.notes.clone(),
        ..TransferReport::default()
    };
    let mut unused = 0;
    for (vertex, (component, row)) in plan.of_vertex.iter().zip(carried).enumerate() {
        let Some(component) = component else {
            unused += 1;
            continue;
        };
        let component = &mut components[*component as usize];
        component.vertices += 1;
        component.largest_distance = component.largest_distance.max(row.distance);
        component.uncovered += usize::from(row.distance > component.method.reach(mesh_size));
        if row.distance > report.largest_distance {
            report.largest_distance = row.distance;
            report.farthest_vertex = vertex as u32;
        }
    }
    if unused > 0 {
        report
            .notes
            .push(format!("{unused} vertices of no triangle are not moved"));
    }
    if report.overlap < EXPECTED_OVERLAP {
        report.notes.push(format!(
            "{:.0} % of the surface lie more than {covered_within:.3} m from the structure and \
             move as its nearest part continued rigidly",
            100.0 * (1.0 - report.overlap)
        ));
    }
    let inside = skin.outer.iter().filter(|is_skin| !**is_skin).count();
    let by_faces = |target: &Target| matches!(target, Target::Faces(_));
    if inside == skin.faces.len() && plan.targets.iter().any(by_faces) {
        report
            .notes
            .push("no face of the structure lies on the surface".to_owned());
    }
    report.components = components;
    report
}

impl Method {
    /// Distance up to which a vertex counts as covered.
    fn reach(self, mesh_size: f64) -> f64 {
        match self {
            Self::Faces => COVERED * mesh_size,
            Self::Spline(_) => COVERED_BY_POINTS * mesh_size,
        }
    }
}

/// Share of the wetted area whose corners are covered, a third each.
fn overlap(plan: &Plan, carried: &[Carried], mesh: &TriMesh) -> f64 {
    let mesh_size = diagonal(mesh.vertices.iter());
    let is_covered = |vertex: u32| {
        let component = plan.of_vertex[vertex as usize];
        let target = component.map(|c| &plan.targets[plan.components[c as usize].target]);
        let method = match target {
            Some(Target::Nodes(_, kernel)) => Method::Spline(*kernel),
            _ => Method::Faces,
        };
        carried[vertex as usize].distance <= method.reach(mesh_size)
    };
    let (mut covered, mut total) = (0.0, 0.0);
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        let third = mesh.area_vector(index).norm() / 3.0;
        for vertex in triangle {
            total += third;
            if is_covered(*vertex) {
                covered += third;
            }
        }
    }
    if total > 0.0 { covered / total } else { 0.0 }
}

/// Elements that carry nothing, by reason and set.
fn left_out(plan: &Plan, skin: &Skin, result: &ModalResult) -> Vec<String> {
    let mut used = vec![false; result.elements.len()];
    for face in plan.targets.iter().flat_map(Target::faces) {
        used[skin.faces[*face as usize].element as usize] = true;
    }
    let judged: BTreeSet<u32> = skin.faces.iter().map(|face| face.element).collect();
    let mut by_reason: BTreeMap<&str, Vec<u32>> = BTreeMap::new();
    for (index, element) in result.elements.iter().enumerate().filter(|e| !used[e.0]) {
        let reason = skin::reason(element.kind, judged.contains(&(index as u32)));
        by_reason.entry(reason).or_default().push(index as u32);
    }
    by_reason
        .into_iter()
        .map(|(reason, elements)| format!("{reason}: {}", by_set(&elements, result)))
        .collect()
}

/// `WWEB (34), RIB (60), 3 elements of no set (17-19)`.
fn by_set(elements: &[u32], result: &ModalResult) -> String {
    let mut rest: BTreeSet<u32> = elements.iter().copied().collect();
    let mut words = Vec::new();
    for set in &result.element_sets {
        let members: Vec<u32> = set
            .members
            .iter()
            .filter(|member| rest.contains(member))
            .copied()
            .collect();
        if members.is_empty() {
            continue;
        }
        for member in &members {
            rest.remove(member);
        }
        let part = if members.len() == set.members.len() {
            format!("{} ({})", set.name, members.len())
        } else {
            format!("{} ({} of {})", set.name, members.len(), set.members.len())
        };
        words.push(part);
    }
    if !rest.is_empty() {
        let ids: Vec<u64> = rest
            .iter()
            .map(|e| result.elements[*e as usize].id)
            .collect();
        words.push(format!("{} of no set ({})", ids.len(), ranges(&ids)));
    }
    words.join(", ")
}
