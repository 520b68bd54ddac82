//! Modes on a half model: of which kind each is, and what that leaves of it.
//!
//! On a whole structure the even and the odd part of a shape are compared at
//! nodes that are mirror images, `u_e = (u(r) + S u(Sr))/2` and
//! `u_o = (u(r) − S u(Sr))/2`; on a half structure the displacement in the plane
//! y = 0 tells, where symmetric motion has no u_y and antisymmetric motion
//! neither u_x nor u_z.

use crate::model::ElasticMode;
use crate::read::diagonal;
use crate::result::{Element, ModalResult, NamedSet};
use crate::rigid_fit::fit_nodes;
use fladder_mesh::weld::weld;
use fladder_mesh::{Symmetry, Vec3, mirrored};

/// Share of the other kind up to which a mode is of one kind: solvers leave
/// 1e-6, meshes that are not quite symmetric 1e-2.
pub const SYMMETRY_LIMIT: f64 = 2e-2;

/// Distance, relative to the size of the structure, up to which a node lies in
/// the plane or on the mirror image of another.
const NODE_TOLERANCE: f64 = 1e-4;

/// Share of the nodes that must have an image for the kinds to be told.
const LEAST_PAIRED: f64 = 0.5;

/// A structure on which the kind of a mode cannot be told.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HalfError {
    /// A half structure that is on the wrong side, or whole.
    #[error(
        "structure.half = true, but {port} of the {nodes} nodes lie on y < 0 in mesh axes; half \
         models are taken on y ≥ 0"
    )]
    Side {
        /// Nodes on y < 0.
        port: usize,
        /// All nodes.
        nodes: usize,
    },
    /// A whole structure whose nodes have no images.
    #[error(
        "only {paired} of the {nodes} nodes of the structure have a mirror image in y = 0, so \
         that symmetric and antisymmetric modes cannot be told apart"
    )]
    NoImages {
        /// Nodes with an image.
        paired: usize,
        /// All nodes.
        nodes: usize,
    },
    /// Modes of the other kind, or of none.
    #[error(
        "{} not {wanted}, as mesh.symmetry has it: {}", are(.modes.len()), .modes.join(", ")
    )]
    OtherKind {
        /// The kind wanted.
        wanted: &'static str,
        /// Names with what was measured.
        modes: Vec<String>,
    },
}

fn are(count: usize) -> String {
    if count == 1 {
        "1 mode is".to_owned()
    } else {
        format!("{count} modes are")
    }
}

/// How the kinds of modes are told on one structure.
pub(crate) struct Probe {
    /// Nodes of shells where there are any: springs and scalar points have
    /// degrees of freedom that are no displacements.
    used: Vec<usize>,
    points: Points,
}

enum Points {
    /// Those of a half structure in the plane, among the used ones.
    InPlane(Vec<usize>),
    /// Those of a whole structure and their images.
    Pairs(Vec<[usize; 2]>),
}

impl Probe {
    pub(crate) fn new(result: &ModalResult, is_half: bool) -> Result<Self, HalfError> {
        let used = fit_nodes(result);
        let positions: Vec<Vec3> = used.iter().map(|n| result.nodes[*n].position).collect();
        let nodes = positions.len();
        let near = NODE_TOLERANCE * diagonal(positions.iter());
        let points = if is_half {
            let port = positions.iter().filter(|p| p.y < -near).count();
            if port > 0 {
                return Err(HalfError::Side { port, nodes });
            }
            let in_plane = |n: &usize| positions[*n].y <= near;
            Points::InPlane((0..nodes).filter(in_plane).collect())
        } else {
            let pairs = pairs(&positions);
            let paired = pairs.len();
            if (paired as f64) < LEAST_PAIRED * nodes as f64 {
                return Err(HalfError::NoImages { paired, nodes });
            }
            Points::Pairs(pairs)
        };
        Ok(Self { used, points })
    }

    /// Share of a shape that is not symmetric, and that is not antisymmetric.
    fn rests(&self, shape: &[Vec3]) -> [f64; 2] {
        let shape: Vec<Vec3> = self.used.iter().map(|n| shape[*n]).collect();
        match &self.points {
            Points::InPlane(nodes) => {
                let largest = shape.iter().map(Vec3::norm).fold(0.0, f64::max);
                let most = |part: &dyn Fn(&Vec3) -> f64| {
                    nodes.iter().map(|n| part(&shape[*n])).fold(0.0, f64::max) / largest
                };
                [most(&|u| u.y.abs()), most(&|u| u.x.hypot(u.z))]
            }
            Points::Pairs(pairs) => {
                let sum = |sign: f64| -> f64 {
                    let part = |[i, j]: &[usize; 2]| shape[*i] + mirrored(shape[*j]) * sign;
                    pairs.iter().map(|pair| part(pair).norm_squared()).sum()
                };
                let (even, odd) = (sum(1.0), sum(-1.0));
                [odd, even].map(|part| (part / (even + odd)).sqrt())
            }
        }
    }

    /// Takes the modes of one kind; the others are refused by name, or left out.
    pub(crate) fn select(
        &self,
        modes: Vec<ElasticMode>,
        wanted: Symmetry,
        leave_out: bool,
        notes: &mut Vec<String>,
    ) -> Result<Vec<ElasticMode>, HalfError> {
        let (mut kept, mut others, mut largest) = (Vec::new(), Vec::new(), 0.0_f64);
        for mode in modes {
            let [not_even, not_odd] = self.rests(&mode.shape);
            let (rest, other) = match wanted {
                Symmetry::Antisymmetric => (not_odd, not_even),
                _ => (not_even, not_odd),
            };
            if rest <= SYMMETRY_LIMIT {
                largest = largest.max(rest);
                kept.push(mode);
            } else {
                let is_other = other <= SYMMETRY_LIMIT;
                others.push(described(&mode, wanted, is_other, rest));
            }
        }
        let wanted = wanted.word();
        if !others.is_empty() {
            if !leave_out {
                return Err(HalfError::OtherKind {
                    wanted,
                    modes: others,
                });
            }
            notes.push(format!("left out, not {wanted}: {}", others.join(", ")));
        }
        if matches!(&self.points, Points::InPlane(nodes) if nodes.is_empty()) {
            notes.push(format!(
                "no node of the half structure lies in y = 0: its modes are taken to be {wanted}"
            ));
        } else if largest > 0.0 && !kept.is_empty() {
            notes.push(format!(
                "modes are {wanted} but for {largest:.1e} of their size (limit {SYMMETRY_LIMIT})"
            ));
        }
        Ok(kept)
    }
}

fn described(mode: &ElasticMode, wanted: Symmetry, is_other: bool, rest: f64) -> String {
    let other = match wanted {
        Symmetry::Antisymmetric => Symmetry::Symmetric,
        _ => Symmetry::Antisymmetric,
    };
    let (name, frequency) = (&mode.name, mode.frequency_hz);
    if is_other {
        return format!("{name} ({frequency:.3} Hz, {})", other.word());
    }
    format!(
        "{name} ({frequency:.3} Hz, {}: {rest:.1e} of it is not {})",
        Symmetry::None.word(),
        wanted.word()
    )
}

/// Nodes with their images, each node once; nodes in one place are left out,
/// because their images cannot be told apart.
fn pairs(positions: &[Vec3]) -> Vec<[usize; 2]> {
    let count = positions.len();
    let mut points = positions.to_vec();
    points.extend(positions.iter().map(|p| mirrored(*p)));
    let welded = weld(&points, NODE_TOLERANCE);
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); welded.kept.len()];
    for (node, place) in welded.image[..count].iter().enumerate() {
        members[*place as usize].push(node);
    }
    let alone = |place: u32| match members[place as usize][..] {
        [node] => Some(node),
        _ => None,
    };
    (0..count)
        .filter_map(|node| {
            let own = alone(welded.image[node])?;
            Some([own, alone(welded.image[count + node])?])
        })
        .collect()
}

impl ModalResult {
    /// Leaves out the elements that lie on y < 0 altogether: a half surface is
    /// carried by its own side of a whole structure.
    pub(crate) fn starboard_elements(mut self) -> Self {
        let near = NODE_TOLERANCE * diagonal(self.nodes.iter().map(|node| &node.position));
        let y = |node: &u32| self.nodes[*node as usize].position.y;
        let is_kept: Vec<bool> = self
            .elements
            .iter()
            .map(|element: &Element| element.nodes.iter().any(|node| y(node) > near))
            .collect();
        // New number of every kept element.
        let number: Vec<u32> = is_kept
            .iter()
            .scan(0, |next, kept| {
                let own = *next;
                *next += u32::from(*kept);
                Some(own)
            })
            .collect();
        let mut kept = is_kept.iter();
        self.elements.retain(|_| kept.next() == Some(&true));
        for NamedSet { members, .. } in &mut self.element_sets {
            *members = members
                .iter()
                .filter(|element| is_kept[**element as usize])
                .map(|element| number[*element as usize])
                .collect();
        }
        self
    }
}
