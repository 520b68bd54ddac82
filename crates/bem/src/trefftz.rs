//! Induced drag from the trace of the wake far downstream.
//!
//! Far behind the aircraft the flow across the stream is two-dimensional, and the energy
//! left in it is paid for by drag. With φ the potential there, κ = φ_u − φ_l its jump
//! across the trace C of the wake, n the normal of C from the lower to the upper side,
//! and a unit speed,
//!
//! $$ \frac{D_i}{q_\infty} = \iint |\nabla\varphi|^2\,\mathrm dA
//!    = -\int_C \kappa\,\frac{\partial\varphi}{\partial n}\,\mathrm dl
//!    = -\frac1{2\pi}\iint_{C\times C} \gamma\,\gamma'\ln|\mathbf r-\mathbf r'|\,
//!      \mathrm dl\,\mathrm dl',\qquad \gamma=\frac{\mathrm d\kappa}{\mathrm dl} . $$
//!
//! The second form is Green's theorem, the third the same in vortices: it holds where the
//! jump is continuous along the sheet and zero at its free edges, so that the vortices add
//! up to nothing. κ is linear between streamlines, γ constant on a straight piece, and the
//! double integral over two pieces has a closed form (see `log_integral`). The sum is
//! therefore exact for the jump there is, never negative, and as accurate as the jump is.
//!
//! Source: the wake-trace integral of Trefftz (1921) and Munk (NACA TR 121, 1921).

use crate::far_wake::FarWake;
use fladder_mesh::Vec3;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// A free edge whose jump is above this part of the largest one has a vortex of its own,
/// and a concentrated vortex has no finite energy.
const FREE_EDGE_JUMP: f64 = 1e-6;

/// Streamlines closer than this part of the trace's distance from the origin are one.
const SAME_PLACE: f64 = 1e-10;

/// D_i/q∞ in m² from the jump of each streamline at unit speed; none where the sheet has a
/// free edge with a jump, zero without a wake.
pub(crate) fn induced_drag(far: &FarWake, jump: impl Fn(u32) -> f64) -> Option<f64> {
    let jumps: Vec<f64> = (0..far.anchors.len() as u32).map(jump).collect();
    let largest = jumps
        .iter()
        .fold(0.0_f64, |largest, k| largest.max(k.abs()));
    let (points, point_of) = points(far);
    let mut edges = vec![0.0; points.len()];
    let mut changes: BTreeMap<[usize; 2], f64> = BTreeMap::new();
    for &[a, b] in &far.strips {
        let (a, b) = (a as usize, b as usize);
        let (from, to) = (point_of[a], point_of[b]);
        edges[from] += jumps[a];
        edges[to] -= jumps[b];
        // Turned round, a strip has the other side up: its vortices stay what they are.
        *changes.entry([from.min(to), from.max(to)]).or_insert(0.0) += jumps[b] - jumps[a];
    }
    if edges
        .iter()
        .any(|edge| edge.abs() > FREE_EDGE_JUMP * largest)
    {
        return None;
    }
    let pieces: Vec<Piece> = changes
        .into_iter()
        .filter_map(|([a, b], change)| Piece::new(points[a], points[b], change))
        .collect();
    let mut energy = 0.0;
    for (i, one) in pieces.iter().enumerate() {
        energy += one.strength * one.strength * one.own_integral();
        for other in &pieces[i + 1..] {
            energy += 2.0 * one.strength * other.strength * log_integral(one, other);
        }
    }
    Some(-energy / TAU)
}

/// Positions in the plane across the stream, and which of them each streamline has.
///
/// Sheets that meet, and copies of one sheet for jumps of different origin, have
/// streamlines of their own in the same place.
fn points(far: &FarWake) -> (Vec<[f64; 2]>, Vec<usize>) {
    let all = plane(far);
    let size = all.iter().flatten().fold(0.0_f64, |l, x| l.max(x.abs()));
    let is_same =
        |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) <= SAME_PLACE * size;
    let mut points: Vec<[f64; 2]> = Vec::new();
    let point_of = all
        .iter()
        .map(|p| {
            let known = points.iter().position(|q| is_same(p, q));
            known.unwrap_or_else(|| {
                points.push(*p);
                points.len() - 1
            })
        })
        .collect();
    (points, point_of)
}

/// Positions of the streamlines in the plane across the stream.
fn plane(far: &FarWake) -> Vec<[f64; 2]> {
    let side = Vec3::y() - far.direction * far.direction.y;
    let side = side.normalize();
    let up = far.direction.cross(&side);
    let project = |p: &Vec3| [p.dot(&side), p.dot(&up)];
    far.anchors.iter().map(project).collect()
}

/// A straight piece of the trace with its vortices.
struct Piece {
    from: faer::c64,
    to: faer::c64,
    length: f64,
    /// γ, the jump's change per length.
    strength: f64,
}

impl Piece {
    /// None for a piece seen end on, or without vortices.
    fn new(a: [f64; 2], b: [f64; 2], change: f64) -> Option<Self> {
        let [from, to] = [a, b].map(|[x, y]| faer::c64::new(x, y));
        let length = (to - from).norm();
        (length > 0.0 && change != 0.0).then(|| Self {
            from,
            to,
            length,
            strength: change / length,
        })
    }

    /// ∬ ln |r − r'| of a piece with itself: L² (ln L − 3/2).
    fn own_integral(&self) -> f64 {
        self.length.powi(2) * (self.length.ln() - 1.5)
    }

    fn direction(&self) -> faer::c64 {
        (self.to - self.from) / self.length
    }
}

/// ∬ ln |r − r'| dl dl' over two pieces that do not cross.
///
/// With z along the one and z' along the other, ln (z − z') is −∂²G/∂z∂z' of
/// G(ζ) = ζ² (ln ζ / 2 − 3/4), so that the integral is the real part of four values of G at
/// the ends. The differences ζ fill a parallelogram beside the origin; the logarithm is cut
/// on the side away from its middle.
fn log_integral(one: &Piece, other: &Piece) -> f64 {
    let turn = one.direction() * other.direction();
    let middle = 0.5 * (one.from + one.to - other.from - other.to);
    let antiderivative = |zeta: faer::c64| {
        if zeta.norm() == 0.0 {
            return zeta;
        }
        let logarithm = (zeta / middle).ln() + middle.ln();
        zeta * zeta * (0.5 * logarithm - 0.75)
    };
    let sum = antiderivative(one.to - other.from) + antiderivative(one.from - other.to)
        - antiderivative(one.to - other.to)
        - antiderivative(one.from - other.from);
    (sum / turn).re
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// A sheet through the given points of the plane across the stream along x.
    fn sheet(points: &[[f64; 2]]) -> FarWake {
        let n = points.len() as u32;
        FarWake {
            direction: Vec3::x(),
            anchors: points
                .iter()
                .map(|[y, z]| Vec3::new(0.3 * y, *y, *z))
                .collect(),
            strips: (1..n).map(|i| [i - 1, i]).collect(),
        }
    }

    fn cosine_stations(n: usize) -> Vec<f64> {
        (0..=n).map(|i| -(PI * i as f64 / n as f64).cos()).collect()
    }

    /// κ = √(1 − y²) leaves a downwash of 1/2: D_i/q = π/4; the error of the linear jump
    /// falls with the square of the spacing.
    #[test]
    fn an_elliptic_jump_has_the_least_drag_of_its_lift() {
        let error = |n: usize| {
            let y = cosine_stations(n);
            let points: Vec<[f64; 2]> = y.iter().map(|y| [*y, 0.0]).collect();
            let jump = |i: u32| (1.0 - y[i as usize].powi(2)).max(0.0).sqrt();
            induced_drag(&sheet(&points), jump).unwrap() / (0.25 * PI) - 1.0
        };
        let errors = [20, 40, 80].map(error);
        println!("elliptic jump on 20, 40, 80 strips: {errors:?}");
        assert!(errors[2].abs() < 1e-3);
        assert!((errors[0] / errors[1] - 4.0).abs() < 0.3);
        assert!((errors[1] / errors[2] - 4.0).abs() < 0.3);
    }

    /// Two pieces of any position against sums of midpoints.
    #[test]
    fn the_closed_form_is_the_integral() {
        let cases = [
            ([0.0, 0.0], [1.0, 0.2], [1.0, 0.2], [1.5, 1.0]),
            ([0.0, 0.0], [1.0, 0.0], [0.3, 0.1], [0.6, 0.1]),
            ([0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 0.0]),
            ([0.0, 0.0], [-1.0, -0.5], [3.0, 0.1], [3.0, -2.0]),
        ];
        for (a, b, c, d) in cases {
            let (one, other) = (
                Piece::new(a, b, 1.0).unwrap(),
                Piece::new(c, d, 1.0).unwrap(),
            );
            let n = 400;
            let at = |piece: &Piece, i: usize| {
                piece.from + (piece.to - piece.from) * ((i as f64 + 0.5) / f64::from(n))
            };
            let mut sum = 0.0;
            for i in 0..n as usize {
                for j in 0..n as usize {
                    sum += (at(&one, i) - at(&other, j)).norm().ln();
                }
            }
            sum *= one.length * other.length / f64::from(n).powi(2);
            let exact = log_integral(&one, &other);
            assert!((exact - sum).abs() < 2e-5, "{exact} against {sum}");
            assert!((log_integral(&other, &one) - exact).abs() < 1e-13);
        }
    }

    /// Munk's stagger theorem and the biplane: two equal elliptic wings far apart have twice
    /// the drag of one, on one another four times; turned about the stream it is the same.
    #[test]
    fn sheets_add_as_the_energy_does() {
        let y = cosine_stations(30);
        let jump_at = |y: f64| (1.0 - y * y).max(0.0).sqrt();
        let pair = |gap: f64, angle: f64| {
            let (sin, cos) = angle.sin_cos();
            let place = |y: f64, z: f64| [y * cos - z * sin, y * sin + z * cos];
            let mut points: Vec<[f64; 2]> = y.iter().map(|y| place(*y, 0.0)).collect();
            points.extend(y.iter().map(|y| place(*y, gap)));
            let mut far = sheet(&points);
            far.strips.remove(30);
            let jump = |i: u32| jump_at(y[i as usize % 31]);
            induced_drag(&far, jump).unwrap()
        };
        let single = {
            let points: Vec<[f64; 2]> = y.iter().map(|y| [*y, 0.0]).collect();
            induced_drag(&sheet(&points), |i| jump_at(y[i as usize])).unwrap()
        };
        assert!((pair(1e3, 0.0) / single - 2.0).abs() < 1e-5);
        assert!((pair(1e-6, 0.0) / single - 4.0).abs() < 1e-4);
        assert!((pair(0.5, 0.0) / pair(0.5, 1.1) - 1.0).abs() < 1e-11);
    }

    /// A sheet in two halves with a streamline each where they meet, and its jump divided
    /// over two copies, is the sheet.
    #[test]
    fn sheets_in_one_place_are_one() {
        let y = cosine_stations(10);
        let points: Vec<[f64; 2]> = y.iter().map(|y| [*y, 0.0]).collect();
        let jump = |y: f64| (1.0 - y * y).max(0.0).sqrt();
        let whole = induced_drag(&sheet(&points), |i| jump(y[i as usize])).unwrap();
        let split: Vec<[f64; 2]> = [&points[..6], &points[5..], &points[5..]].concat();
        let mut far = sheet(&split);
        far.strips.retain(|s| !matches!(s, [5, 6] | [11, 12]));
        // The third part, turned round.
        for s in far.strips.iter_mut().filter(|s| s[0] > 11) {
            s.reverse();
        }
        let share = |i: u32| match i {
            0..6 => jump(y[i as usize]),
            6..12 => 0.25 * jump(y[i as usize - 1]),
            _ => -0.75 * jump(y[i as usize - 7]),
        };
        let drag = induced_drag(&far, share).unwrap();
        assert!((drag / whole - 1.0).abs() < 1e-12, "{drag} {whole}");
    }

    #[test]
    fn a_free_edge_with_a_jump_has_no_finite_drag() {
        let far = sheet(&[[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0]]);
        assert_eq!(induced_drag(&far, |i| f64::from(i == 2)), None);
        assert!(induced_drag(&far, |i| f64::from(i == 1)).is_some());
        assert_eq!(induced_drag(&sheet(&[]), |_| 1.0), Some(0.0));
    }
}
