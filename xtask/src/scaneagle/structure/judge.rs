//! What the modes must fulfil, and what each of them does.

use std::collections::HashMap;

use fladder_mesh::Vec3;
use fladder_modal::{RigidBody, StructuralModel};

use super::mesh::starboard;
use super::model::Model;

/// Hz, below which a mode is rigid motion.
const RIGID_HZ: f64 = 0.05;
/// Largest relative difference between integrated mass and that of the rigid modes: six digits
/// of the file, summed over two squares.
const MASS: f64 = 1e-4;
/// The same of moments of inertia: CalculiX integrates its shells as solids, at two by two
/// points across.
const INERTIA: f64 = 5e-4;
/// Least purity of a symmetric or antisymmetric mode: a pair of equal frequencies mixes.
const PARITY: f64 = 0.99;

/// One elastic mode.
#[derive(Clone, Debug)]
pub(super) struct Judged {
    pub(super) hertz: f64,
    /// +1 symmetric, −1 antisymmetric.
    pub(super) parity: f64,
    /// Parts of the mean square motion.
    pub(super) moves: [f64; PARTS.len()],
}

/// Where a mode moves.
pub(super) const PARTS: [&str; 6] =
    ["wing up", "in plane", "winglet", "elevon", "rudder", "body"];

/// Refuses what is no free aircraft with a plane of symmetry.
///
/// # Errors
/// One sentence for what is wrong.
pub(super) fn judge(model: &Model, found: &StructuralModel) -> Result<Vec<Judged>, String> {
    let modes = &found.result.modes;
    if modes.len() != model.modes {
        return Err(format!(
            "{} modes where {} were asked for",
            modes.len(),
            model.modes
        ));
    }
    for (number, (mode, fit)) in modes.iter().zip(&found.survey.fits).enumerate() {
        let hertz = mode.eigenvalue.abs().sqrt() / std::f64::consts::TAU;
        if (number < 6) != (fit.rigid && hertz < RIGID_HZ) {
            return Err(format!(
                "mode {} at {hertz:.4} Hz {} rigid motion, where the first six must be, below \
                 {RIGID_HZ} Hz, and no others",
                number + 1,
                if fit.rigid { "is" } else { "is not" }
            ));
        }
    }
    compare(&model.body, found)?;
    let image = images(&found.result.positions())?;
    let groups = groups(found);
    let mut judged = Vec::new();
    for mode in &found.elastic {
        let parity = parity(&mode.shape, &image, &groups);
        if parity.abs() < PARITY {
            return Err(format!(
                "{} at {:.3} Hz is neither symmetric nor antisymmetric: {parity:.4}",
                mode.name, mode.frequency_hz
            ));
        }
        judged.push(Judged {
            hertz: mode.frequency_hz,
            parity,
            moves: moves(&mode.shape, &groups),
        });
    }
    Ok(judged)
}

fn compare(own: &RigidBody, found: &StructuralModel) -> Result<(), String> {
    let recovered = found.rigid_body_from_file.as_ref();
    let body = recovered
        .ok_or("the rigid modes give no mass properties")?
        .body;
    let pairs = [
        ("mass", own.mass, body.mass, MASS),
        ("xx", own.inertia.xx, body.inertia.xx, INERTIA),
        ("yy", own.inertia.yy, body.inertia.yy, INERTIA),
        ("zz", own.inertia.zz, body.inertia.zz, INERTIA),
    ];
    for (name, own, modal, limit) in pairs {
        if (modal / own - 1.0).abs() > limit {
            return Err(format!(
                "{name} is {own:.6} by integration and {modal:.6} by the rigid modes: more than \
                 {limit:.0e} apart"
            ));
        }
    }
    Ok(())
}

/// Every node's mirror image, among nodes of six digits.
fn images(places: &[Vec3]) -> Result<Vec<usize>, String> {
    let key = |p: &Vec3| [p.x, p.y + 0.0, p.z + 0.0].map(f64::to_bits);
    let numbers: HashMap<_, _> = places.iter().map(key).zip(0..).collect();
    let other = |p: &Vec3| {
        let image = Vec3::new(p.x, -p.y, p.z);
        let none = || format!("the node at {p:?} has no image on the other side");
        numbers.get(&key(&image)).copied().ok_or_else(none)
    };
    places.iter().map(other).collect()
}

/// Of the skins: the scalar nodes hold angles, whose sign is another matter.
fn parity(shape: &[Vec3], image: &[usize], groups: &[Option<usize>]) -> f64 {
    let mirrored = |u: &Vec3| Vec3::new(u.x, -u.y, u.z);
    let skins = shape
        .iter()
        .zip(image)
        .zip(groups)
        .filter(|(_, group)| group.is_some());
    let (mut both, mut all) = (0.0, 0.0);
    for ((u, other), _) in skins {
        both += u.dot(&mirrored(&shape[*other]));
        all += u.norm_squared();
    }
    both / all
}

/// Number in `PARTS` of every node, 0 for the whole wing; none for the scalar nodes.
fn groups(found: &StructuralModel) -> Vec<Option<usize>> {
    let mut groups = vec![None; found.result.nodes.len()];
    for set in &found.result.element_sets {
        let group = match starboard(&set.name) {
            "WLE" | "WCAP" | "WBOX" | "WTE" => 0,
            "LLE" | "LCAP" | "LBOX" | "LTE" => 2,
            "WCS" => 3,
            "LCS" => 4,
            name if name.starts_with("FUS") => 5,
            _ => continue,
        };
        for element in &set.members {
            for node in &found.result.elements[*element as usize].nodes {
                groups[*node as usize] = Some(group);
            }
        }
    }
    groups
}

/// Parts of the sum of squares over the skins.
fn moves(shape: &[Vec3], groups: &[Option<usize>]) -> [f64; PARTS.len()] {
    let mut sums = [0.0; PARTS.len()];
    for (u, group) in shape.iter().zip(groups) {
        match group {
            Some(0) => {
                sums[0] += u.y * u.y + u.z * u.z;
                sums[1] += u.x * u.x;
            }
            Some(group) => sums[*group] += u.norm_squared(),
            None => {}
        }
    }
    let total: f64 = sums.iter().sum();
    sums.map(|sum| sum / total)
}
