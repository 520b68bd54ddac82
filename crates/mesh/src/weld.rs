//! Vertices that lie in one place made one vertex.

use std::collections::HashMap;

use crate::Vec3;

/// Vertices closer than this fraction of the bounding box's diagonal are one.
///
/// Single-precision files place a point within 6e-8 of the size, six-digit
/// text within 1e-6; the finest cells in use are 1e-4 of it.
pub const WELD_TOLERANCE: f64 = 1e-6;

/// The result of welding.
#[derive(Clone, Debug, PartialEq)]
pub struct Weld {
    /// New number of every old vertex.
    pub image: Vec<u32>,
    /// Old number of every new vertex: the first of those that became one.
    pub kept: Vec<u32>,
    /// The distance used.
    pub tolerance: f64,
}

/// Welds points closer than `relative` times the diagonal of their box.
///
/// The first of a cluster in the given order is kept, and a point joins the
/// first kept one in reach. Points that are not finite stay as they are.
pub fn weld(points: &[Vec3], relative: f64) -> Weld {
    let is_finite = |p: &Vec3| p.iter().all(|x| x.is_finite());
    let mut finite = points.iter().filter(|p| is_finite(p));
    let first = finite.next().copied().unwrap_or_default();
    let (low, high) = finite.fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
    let tolerance = relative * (high - low).norm();
    // Kept points are a tolerance apart, so that few fit into a cell, and most
    // points reach into one cell only.
    let width = 8.0 * tolerance;
    let cell = |x: f64| {
        if width > 0.0 {
            (x / width).floor() as i64
        } else {
            0
        }
    };
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut weld = Weld {
        image: Vec::with_capacity(points.len()),
        kept: Vec::new(),
        tolerance,
    };
    for (old, p) in points.iter().enumerate() {
        if !is_finite(p) {
            weld.image.push(weld.kept.len() as u32);
            weld.kept.push(old as u32);
            continue;
        }
        let from = (p - low).map(|x| cell(x - tolerance));
        let to = (p - low).map(|x| cell(x + tolerance));
        let mut nearest: Option<u32> = None;
        for key in keys(from.into(), to.into()) {
            for &new in cells.get(&key).map_or(&[][..], Vec::as_slice) {
                let is_near =
                    (points[weld.kept[new as usize] as usize] - p).norm() <= tolerance;
                if is_near && nearest.is_none_or(|other| new < other) {
                    nearest = Some(new);
                }
            }
        }
        let new = nearest.unwrap_or_else(|| {
            let new = weld.kept.len() as u32;
            weld.kept.push(old as u32);
            cells
                .entry((p - low).map(cell).into())
                .or_default()
                .push(new);
            new
        });
        weld.image.push(new);
    }
    weld
}

/// The cells of a box, at most two along each axis.
fn keys(from: [i64; 3], to: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    (0..8).filter_map(move |corner: usize| {
        let upper = [corner & 1 != 0, corner & 2 != 0, corner & 4 != 0];
        let repeats = (0..3).any(|axis| upper[axis] && from[axis] == to[axis]);
        let pick = |axis: usize| if upper[axis] { to[axis] } else { from[axis] };
        (!repeats).then(|| [pick(0), pick(1), pick(2)])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::icosphere;

    /// Every vertex of an icosphere soup of F triangles comes up six or five
    /// times; Euler's formula leaves F/2 + 2 of them.
    #[test]
    fn a_soup_welds_to_the_number_of_euler() {
        let mesh = icosphere(7);
        let shake =
            |k: usize| Vec3::new(1.0, -1.0, 1.0) * 1e-7 * ((k * 7919) % 13) as f64 / 13.0;
        let soup: Vec<Vec3> = mesh
            .triangles
            .iter()
            .flatten()
            .enumerate()
            .map(|(k, &v)| mesh.vertices[v as usize] + shake(k))
            .collect();
        let welded = weld(&soup, WELD_TOLERANCE);
        assert_eq!(welded.kept.len(), mesh.triangles.len() / 2 + 2);
    }

    #[test]
    fn points_further_apart_than_the_tolerance_stay_apart() {
        let points = [0.0, 1.0, 1.0 + 2e-6, 1.0 + 0.5e-6].map(|x| Vec3::new(x, 0.0, 0.0));
        let welded = weld(&points, WELD_TOLERANCE);
        assert_eq!(welded.kept, [0, 1, 2]);
        assert_eq!(welded.image, [0, 1, 2, 1]);
    }
}
