//! On which side of a plane a point lies, with a bound on round-off.
//!
//! Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
//! geometric predicates" (1997), §4.3: the determinant in double precision has
//! the right sign when it exceeds (7 + 56 ε) ε times its permanent.

use crate::Vec3;

/// Sign of the volume of (a, b, c, d): 1 when d lies below the plane of a, b,
/// c seen counter-clockwise, −1 above, 0 when round-off could decide.
pub(super) fn side(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> i8 {
    let (u, v, w) = (a - d, b - d, c - d);
    let minors = [(v, w, u.z), (w, u, v.z), (u, v, w.z)];
    let determinant: f64 = minors
        .iter()
        .map(|(p, q, z)| z * (p.x * q.y - p.y * q.x))
        .sum();
    let permanent: f64 = minors
        .iter()
        .map(|(p, q, z)| z.abs() * ((p.x * q.y).abs() + (p.y * q.x).abs()))
        .sum();
    // Half of f64::EPSILON is the round-off of one operation.
    let bound = 8.0 * 0.5 * f64::EPSILON * permanent;
    if determinant > bound {
        1
    } else if -determinant > bound {
        -1
    } else {
        0
    }
}

/// Whether two triangles cross: an edge of one pierces the other, or both lie
/// in one plane and overlap. Touching does not count.
pub(super) fn triangles_cross(first: [Vec3; 3], second: [Vec3; 3]) -> bool {
    let below = |plane: [Vec3; 3], points: [Vec3; 3]| {
        points.map(|p| side(plane[0], plane[1], plane[2], p))
    };
    let (of_second, of_first) = (below(first, second), below(second, first));
    let is_one_sided =
        |signs: [i8; 3]| signs.iter().all(|&s| s > 0) || signs.iter().all(|&s| s < 0);
    if is_one_sided(of_second) || is_one_sided(of_first) {
        return false;
    }
    if of_second == [0; 3] && of_first == [0; 3] {
        return overlap_in_plane(first, second);
    }
    pierces(second, of_second, first) || pierces(first, of_first, second)
}

/// Whether an edge of `triangle`, whose corners lie on the given sides of the
/// plane of `other`, goes through `other`.
fn pierces(triangle: [Vec3; 3], sides: [i8; 3], other: [Vec3; 3]) -> bool {
    (0..3).any(|k| {
        let next = (k + 1) % 3;
        if sides[k] * sides[next] >= 0 {
            return false;
        }
        let (p, q) = (triangle[k], triangle[next]);
        let turns = [0, 1, 2].map(|m| side(p, q, other[m], other[(m + 1) % 3]));
        turns != [0; 3] && (turns.iter().all(|&s| s >= 0) || turns.iter().all(|&s| s <= 0))
    })
}

/// Whether two triangles in one plane share an area: no side of either has
/// the other wholly on its far side.
fn overlap_in_plane(first: [Vec3; 3], second: [Vec3; 3]) -> bool {
    let normal = (first[1] - first[0]).cross(&(first[2] - first[0]));
    let drop = normal.iamax();
    let flat = |t: [Vec3; 3]| t.map(|p| (p[(drop + 1) % 3], p[(drop + 2) % 3]));
    let (first, second) = (flat(first), flat(second));
    !has_separating_side(first, second) && !has_separating_side(second, first)
}

fn has_separating_side(triangle: [(f64, f64); 3], other: [(f64, f64); 3]) -> bool {
    let turn = |a: (f64, f64), b: (f64, f64), p: (f64, f64)| {
        let (left, right) = ((b.0 - a.0) * (p.1 - a.1), (b.1 - a.1) * (p.0 - a.0));
        // Points on the line count as outside.
        let is_sure = (left - right).abs() > 8.0 * f64::EPSILON * (left.abs() + right.abs());
        if is_sure { left - right } else { 0.0 }
    };
    let orientation = turn(triangle[0], triangle[1], triangle[2]).signum();
    (0..3).any(|k| {
        let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
        other.iter().all(|&p| orientation * turn(a, b, p) <= 0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(points: [[f64; 3]; 3]) -> [Vec3; 3] {
        points.map(Vec3::from)
    }

    const BASE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];

    #[test]
    fn a_triangle_through_another_crosses_it_and_one_beside_does_not() {
        let through = [[0.5, 0.5, -1.0], [0.5, 0.5, 1.0], [3.0, 3.0, 0.0]];
        let beside = [[1.5, 1.5, -1.0], [1.5, 1.5, 1.0], [3.0, 3.0, 0.0]];
        let above = [[0.5, 0.5, 0.1], [0.5, 0.5, 1.0], [3.0, 3.0, 0.5]];
        assert!(triangles_cross(triangle(BASE), triangle(through)));
        assert!(triangles_cross(triangle(through), triangle(BASE)));
        assert!(!triangles_cross(triangle(BASE), triangle(beside)));
        assert!(!triangles_cross(triangle(BASE), triangle(above)));
    }

    #[test]
    fn in_one_plane_overlap_counts_and_touching_does_not() {
        let overlapping = [[0.5, 0.5, 0.0], [3.0, 0.5, 0.0], [0.5, 3.0, 0.0]];
        let touching = [[2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
        let inside = [[0.1, 0.1, 0.0], [0.2, 0.1, 0.0], [0.1, 0.2, 0.0]];
        assert!(triangles_cross(triangle(BASE), triangle(overlapping)));
        assert!(triangles_cross(triangle(BASE), triangle(inside)));
        assert!(triangles_cross(triangle(inside), triangle(BASE)));
        assert!(!triangles_cross(triangle(BASE), triangle(touching)));
    }

    /// The sign does not flip within round-off of the plane.
    #[test]
    fn a_point_of_the_plane_is_on_neither_side() {
        let [a, b, c] = triangle([[0.1, 0.2, 0.3], [1.7, -0.4, 0.9], [0.3, 1.1, -0.7]]);
        for k in 0..100 {
            let (s, t) = (f64::from(k) / 37.0, f64::from(k % 7) / 7.0);
            let p = a + s * (b - a) + t * (c - a);
            assert_eq!(side(a, b, c, p), 0, "at {s}, {t}");
        }
    }
}
