//! A small wing with a flap, as finite elements and as a wetted surface, and a
//! writer of the files CalculiX would leave.

#![allow(dead_code, reason = "every test file uses another part of it")]

use fladder_mesh::{SurfaceGroup, TriMesh, Vec3};
use fladder_modal::{Element, ElementKind, Format, ModalResult, Mode, NamedSet, Node};
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::PI;
use std::fmt::Write;

pub(crate) const SPAN: f64 = 4.0;
/// The fixed part ends here and the flap begins at `FLAP`.
pub(crate) const REAR: f64 = 0.7;
pub(crate) const HINGE: f64 = 0.75;
pub(crate) const FLAP: f64 = 0.77;
const THICKNESS: f64 = 0.12;

/// Half thickness of the section, chord 1; no polynomial, so that elements do
/// not follow it exactly.
pub(crate) fn half_thickness(x: f64) -> f64 {
    0.5 * THICKNESS * (PI * x).sin()
}

/// Finite elements under construction; nodes of one body are merged.
#[derive(Default)]
pub(crate) struct Shells {
    pub(crate) nodes: Vec<Vec3>,
    pub(crate) elements: Vec<(ElementKind, Vec<u32>, &'static str)>,
    known: HashMap<(u32, [i64; 3]), u32>,
}

impl Shells {
    pub(crate) fn node(&mut self, body: u32, position: Vec3) -> u32 {
        let key = [position.x, position.y, position.z].map(|v| (v * 1e7).round() as i64);
        *self.known.entry((body, key)).or_insert_with(|| {
            self.nodes.push(position);
            self.nodes.len() as u32 - 1
        })
    }

    /// Eight-node shells on the grid `u` × `v`.
    pub(crate) fn patch(
        &mut self,
        (body, set): (u32, &'static str),
        u: &[f64],
        v: &[f64],
        place: impl Fn(f64, f64) -> Vec3,
    ) {
        for u in u.windows(2) {
            for v in v.windows(2) {
                let (a, b) = (0.5 * (u[0] + u[1]), 0.5 * (v[0] + v[1]));
                let points = [
                    [u[0], v[0]],
                    [u[1], v[0]],
                    [u[1], v[1]],
                    [u[0], v[1]],
                    [a, v[0]],
                    [u[1], b],
                    [a, v[1]],
                    [u[0], b],
                ];
                let nodes = points.map(|[u, v]| self.node(body, place(u, v)));
                self.elements
                    .push((ElementKind::Quad8, nodes.to_vec(), set));
            }
        }
    }

    /// A result without modes.
    pub(crate) fn result(&self) -> ModalResult {
        let mut sets: BTreeMap<&str, Vec<u32>> = BTreeMap::new();
        for (index, element) in self.elements.iter().enumerate() {
            sets.entry(element.2).or_default().push(index as u32);
        }
        ModalResult {
            format: Format::CalculixFrd,
            nodes: self
                .nodes
                .iter()
                .enumerate()
                .map(|(k, position)| Node {
                    id: k as u64 + 1,
                    position: *position,
                })
                .collect(),
            elements: self
                .elements
                .iter()
                .enumerate()
                .map(|(k, (kind, nodes, _))| Element {
                    id: k as u64 + 1,
                    kind: *kind,
                    nodes: nodes.clone(),
                })
                .collect(),
            element_sets: sets
                .into_iter()
                .map(|(name, members)| NamedSet {
                    name: name.to_owned(),
                    members,
                })
                .collect(),
            node_sets: Vec::new(),
            modes: Vec::new(),
            stated_mass: None,
            notes: Vec::new(),
        }
    }
}

pub(crate) fn stations(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..=count)
        .map(|k| from + (to - from) * k as f64 / count as f64)
        .collect()
}

/// Skins `TOP`, `BOTTOM`, a web and ribs in the fixed part; `FLAP` skins apart
/// from it.
pub(crate) fn wing() -> Shells {
    let mut shells = Shells::default();
    let span = stations(0.0, SPAN, 8);
    let skin = |side: f64| move |x: f64, y: f64| Vec3::new(x, y, side * half_thickness(x));
    let fixed = stations(0.0, REAR, 5);
    shells.patch((0, "TOP"), &fixed, &span, skin(1.0));
    shells.patch((0, "BOTTOM"), &fixed, &span, skin(-1.0));
    let web = fixed[2];
    let across = |x: f64, t: f64| t * half_thickness(x);
    shells.patch((0, "WEB"), &[-1.0, 1.0], &span, |t, y| {
        Vec3::new(web, y, across(web, t))
    });
    for y in &span {
        shells.patch((0, "RIB"), &fixed[1..], &[-1.0, 1.0], |x, t| {
            Vec3::new(x, *y, across(x, t))
        });
    }
    let flap = stations(FLAP, 1.0, 2);
    shells.patch((1, "FLAP"), &flap, &span, skin(1.0));
    shells.patch((1, "FLAP"), &flap, &span, skin(-1.0));
    shells
}

/// The lens wing as a closed surface with the groups `wing` and `elevon`, the
/// border on the hinge line, tips flat.
pub(crate) fn surface() -> TriMesh {
    let mut mesh = TriMesh::default();
    let (mut x, y) = (stations(0.0, HINGE, 12), stations(0.0, SPAN, 33));
    let hinge = x.len() - 1;
    x.extend(&stations(HINGE, 1.0, 6)[1..]);
    let last = x.len() - 1;
    let mut index = HashMap::new();
    for side in 0..2_usize {
        for (j, y) in y.iter().enumerate() {
            for (i, x) in x.iter().enumerate() {
                let shared = i == 0 || i == last;
                let key = (if shared { 0 } else { side }, i, j);
                index.entry(key).or_insert_with(|| {
                    let z = if side == 0 { 1.0 } else { -1.0 } * half_thickness(*x);
                    mesh.vertices.push(Vec3::new(*x, *y, z));
                    mesh.vertices.len() as u32 - 1
                });
            }
        }
    }
    let at = |side: usize, i: usize, j: usize| {
        index[&(if i == 0 || i == last { 0 } else { side }, i, j)]
    };
    let (mut wing, mut flap) = (Vec::new(), Vec::new());
    for side in 0..2 {
        for j in 0..y.len() - 1 {
            for i in 0..last {
                let quad = [
                    at(side, i, j),
                    at(side, i + 1, j),
                    at(side, i + 1, j + 1),
                    at(side, i, j + 1),
                ];
                for corners in [[0, 1, 2], [0, 2, 3]] {
                    let mut triangle = corners.map(|k: usize| quad[k]);
                    if side == 1 {
                        triangle.swap(1, 2);
                    }
                    let group = if i < hinge { &mut wing } else { &mut flap };
                    group.push(mesh.triangles.len() as u32);
                    mesh.triangles.push(triangle);
                }
            }
        }
    }
    for (j, outward) in [(0, false), (y.len() - 1, true)] {
        for i in 0..last {
            let (a, b, c, d) = (at(0, i, j), at(0, i + 1, j), at(1, i, j), at(1, i + 1, j));
            for mut triangle in [[a, c, b], [b, c, d]] {
                if triangle[0] == triangle[1] || triangle[1] == triangle[2] {
                    continue;
                }
                if outward {
                    triangle.swap(1, 2);
                }
                let group = if i < hinge { &mut wing } else { &mut flap };
                group.push(mesh.triangles.len() as u32);
                mesh.triangles.push(triangle);
            }
        }
    }
    mesh.surfaces = vec![
        SurfaceGroup {
            name: "wing".to_owned(),
            triangles: wing,
        },
        SurfaceGroup {
            name: "elevon".to_owned(),
            triangles: flap,
        },
    ];
    mesh
}

pub(crate) fn mapping() -> BTreeMap<String, Vec<String>> {
    let sets = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    BTreeMap::from([
        ("wing".to_owned(), sets(&["TOP", "BOTTOM"])),
        ("elevon".to_owned(), sets(&["FLAP"])),
    ])
}

/// Largest difference relative to the largest of the second field.
pub(crate) fn largest_error(found: &[Vec3], exact: &[Vec3]) -> f64 {
    assert_eq!(found.len(), exact.len());
    let scale = exact.iter().map(Vec3::norm).fold(0.0, f64::max);
    let error = found
        .iter()
        .zip(exact)
        .map(|(a, b)| (a - b).norm())
        .fold(0.0, f64::max);
    error / scale
}

pub(crate) fn sample(points: &[Vec3], field: impl Fn(&Vec3) -> Vec3) -> Vec<Vec3> {
    points.iter().map(field).collect()
}

pub(crate) fn mode(index: u32, frequency_hz: f64, mass: f64, displacement: Vec<Vec3>) -> Mode {
    let eigenvalue = (std::f64::consts::TAU * frequency_hz).powi(2);
    Mode {
        index,
        frequency_hz,
        eigenvalue,
        generalised_mass: mass,
        generalised_stiffness: eigenvalue * mass,
        displacement,
        rotation: None,
        participation: None,
    }
}

/// Number of an element kind in `.frd` files.
pub(crate) fn frd_type(kind: ElementKind) -> u32 {
    match kind {
        ElementKind::Hex8 => 1,
        ElementKind::Tet4 => 3,
        ElementKind::Tri3 => 7,
        ElementKind::Tri6 => 8,
        ElementKind::Quad4 => 9,
        ElementKind::Quad8 => 10,
        ElementKind::Line2 => 11,
        other => panic!("{other:?} is not written here"),
    }
}

/// A `.frd` file as CalculiX 2.20 lays it out.
pub(crate) fn frd(result: &ModalResult) -> String {
    let mut text = String::from("    1C\n    1UPGM               CalculiX\n");
    let count = result.nodes.len();
    writeln!(text, "    2C                  {count:12}{:37}1", "").unwrap();
    for node in &result.nodes {
        let p = node.position;
        writeln!(
            text,
            " -1{:10}{}{}{}",
            node.id,
            e12(p.x),
            e12(p.y),
            e12(p.z)
        )
        .unwrap();
    }
    writeln!(
        text,
        " -3\n    3C                  {:12}{:37}1",
        result.elements.len(),
        ""
    )
    .unwrap();
    for element in &result.elements {
        writeln!(
            text,
            " -1{:10}{:5}    0    1",
            element.id,
            frd_type(element.kind)
        )
        .unwrap();
        for chunk in element.nodes.chunks(10) {
            text.push_str(" -2");
            for node in chunk {
                write!(text, "{:10}", result.nodes[*node as usize].id).unwrap();
            }
            text.push('\n');
        }
    }
    text.push_str(" -3\n");
    for mode in &result.modes {
        writeln!(text, "    1PSTEP{:26}{:12}{:12}", mode.index, 1, 1).unwrap();
        writeln!(
            text,
            "    1PGM                {}",
            exponent(mode.generalised_mass, 6)
        )
        .unwrap();
        let stiffness = mode.generalised_stiffness.max(0.0);
        writeln!(text, "    1PGK                {}", exponent(stiffness, 6)).unwrap();
        writeln!(text, "    1PMODE{:26}", mode.index).unwrap();
        let (number, frequency) = (100 + mode.index, e12(mode.frequency_hz));
        writeln!(
            text,
            "  100CL{number:5}{frequency}{count:12}{:20} 2{:5}MODAL      1",
            "", mode.index
        )
        .unwrap();
        text.push_str(" -4  DISP        4    1\n");
        for component in 1..=3 {
            writeln!(
                text,
                " -5  D{component}          1    2    {component}    0"
            )
            .unwrap();
        }
        text.push_str(" -5  ALL         1    2    0    0    1ALL\n");
        for (node, u) in result.nodes.iter().zip(&mode.displacement) {
            writeln!(
                text,
                " -1{:10}{}{}{}",
                node.id,
                e12(u.x),
                e12(u.y),
                e12(u.z)
            )
            .unwrap();
        }
        text.push_str(" -3\n");
    }
    text.push_str(" 9999\n");
    text
}

/// `%12.5E` of C: a sign, six digits, an exponent of at least two digits.
pub(crate) fn e12(value: f64) -> String {
    exponent(value, 5)
}

fn exponent(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{:>12}", format!("{mantissa}E{sign}{:02}", exponent.abs()))
}

/// A folder of its own under the build's temporary folder.
pub(crate) fn folder(name: &str) -> std::path::PathBuf {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Writes a file into a folder of its own.
pub(crate) fn file(
    folder_name: &str,
    name: &str,
    content: impl AsRef<[u8]>,
) -> std::path::PathBuf {
    let path = folder(folder_name).join(name);
    std::fs::write(&path, content).unwrap();
    path
}
