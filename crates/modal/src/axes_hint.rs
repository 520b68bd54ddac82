//! A guess at the axes a structure was written in, from bounding boxes.

use fladder_mesh::Vec3;

/// Share of the joint box that two boxes must have in common before the guess
/// is worth a word.
const GOOD_MATCH: f64 = 0.5;

const NAMES: [[&str; 2]; 3] = [["x", "-x"], ["y", "-y"], ["z", "-z"]];

/// The right-handed axes, other than those in use, under which the box of the
/// structure matches that of the mesh best, as a hint for the user.
pub(crate) fn better_axes(structure: &[Vec3], mesh: &[Vec3]) -> String {
    let target = bounds(mesh.iter().copied());
    let mut best = (GOOD_MATCH, String::new());
    for columns in [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ] {
        for signs in 0..8_usize {
            let sign = |k: usize| if signs >> k & 1 == 1 { -1.0 } else { 1.0 };
            let axis = |k: usize| Vec3::ith(columns[k], sign(k));
            let (a, b, c) = (axis(0), axis(1), axis(2));
            if a.cross(&b).dot(&c) < 0.0 {
                continue;
            }
            let turned = structure.iter().map(|p| a * p.x + b * p.y + c * p.z);
            let matched = common_share(&bounds(turned), &target);
            if matched > best.0 {
                let name = |k: usize| NAMES[columns[k]][signs >> k & 1];
                let names = format!("[\"{}\", \"{}\", \"{}\"]", name(0), name(1), name(2));
                best = (matched, names);
            }
        }
    }
    match best.1.as_str() {
        "" => "check structure.axes, structure.origin and mesh.scale".to_owned(),
        "[\"x\", \"y\", \"z\"]" => {
            "the boxes match, so check structure.origin and whether both are one aircraft"
                .to_owned()
        }
        names => format!("on top of the present axes, {names} would match better"),
    }
}

fn bounds(points: impl Iterator<Item = Vec3>) -> [Vec3; 2] {
    points.fold(
        [Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)],
        |[low, high], p| [low.inf(&p), high.sup(&p)],
    )
}

/// Product over the axes of common length over joint length.
fn common_share(a: &[Vec3; 2], b: &[Vec3; 2]) -> f64 {
    (0..3)
        .map(|k| {
            let common = a[1][k].min(b[1][k]) - a[0][k].max(b[0][k]);
            let joint = a[1][k].max(b[1][k]) - a[0][k].min(b[0][k]);
            if joint > 0.0 {
                (common / joint).max(0.0)
            } else {
                1.0
            }
        })
        .product()
}
