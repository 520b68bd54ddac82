//! A body with wings, fins and tail planes of NACA section, in one closed surface.
//!
//! Cross-sections are ellipses whose half-axes vary along x; arms leave them at given
//! angles. Where an arm is attached the skin of the body is left out between its upper and
//! lower root, so that arm and body share their edges there; fore and aft of it one row of
//! edges runs along the body at the arm's angle.

use std::f64::consts::TAU;

use super::soup::Soup;
use super::wing::{ShapeError, naca_half_thickness};
use crate::{TriMesh, Vec3};

/// How the body ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tail {
    /// In one point.
    Pointed,
    /// Cut off square where it is thickest.
    Blunt,
    /// In an upright edge, thin across y.
    Knife,
}

/// A wing, fin or half of a tail plane on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arm {
    /// Angle about x: 0 starboard, 90 up, 180 port; degrees.
    pub angle_deg: f64,
    /// x of the root's leading edge, m.
    pub start: f64,
    /// Chord, m.
    pub chord: f64,
    /// Distance of the tip from the body's axis, m.
    pub reach: f64,
    /// Thickness over chord at the root; it falls to zero at the tip like an ellipse.
    pub thickness: f64,
    /// Chordwise sweep of the tip, m.
    pub sweep: f64,
    /// Cells along the span.
    pub n_span: usize,
}

/// The body and what is on it.
#[derive(Clone, Debug, PartialEq)]
pub struct WingBody {
    /// x of the cross-sections, ascending from nose to tail, m; roots begin and end on them.
    pub stations: Vec<f64>,
    /// Half-axis along y where the body is thickest, m.
    pub half_width: f64,
    /// Half-axis along z where the body is thickest, m.
    pub half_height: f64,
    /// How it ends.
    pub tail: Tail,
    /// Surfaces on it.
    pub arms: Vec<Arm>,
    /// Cells between neighbouring arms.
    pub n_around: usize,
}

impl WingBody {
    /// Equal steps of about `step` from nose to tail, with the arms' roots among them.
    pub fn even_stations(length: f64, step: f64, arms: &[Arm]) -> Vec<f64> {
        let mut knots = vec![0.0, length];
        knots.extend(arms.iter().flat_map(|a| [a.start, a.start + a.chord]));
        knots.sort_by(f64::total_cmp);
        knots.dedup_by(|b, a| *b - *a < 1e-9 * length);
        let mut all = vec![0.0];
        for pair in knots.windows(2) {
            let n = ((pair[1] - pair[0]) / step).round().max(1.0) as usize;
            all.extend((1..n).map(|i| pair[0] + (pair[1] - pair[0]) * i as f64 / n as f64));
            all.push(pair[1]);
        }
        all
    }

    /// Structured mesh, closed, outward; symmetric in y = 0 where arms and cells are.
    ///
    /// # Errors
    /// Fewer than four stations or no arm, and arms that are thicker than the body.
    pub fn structured(&self) -> Result<TriMesh, ShapeError> {
        if self.arms.is_empty() || self.stations.len() < 4 {
            return Err(ShapeError::Unsupported(
                "a body without arms or with fewer than four stations",
            ));
        }
        let mut soup = Soup::default();
        let rings: Vec<Vec<Corner>> = self
            .stations
            .iter()
            .map(|&x| self.ring(x))
            .collect::<Result<_, _>>()?;
        for pair in rings.windows(2) {
            self.skin(&pair[0], &pair[1], &mut soup);
        }
        if self.tail == Tail::Blunt {
            let last = &rings[rings.len() - 1];
            let x = self.stations[self.stations.len() - 1];
            for i in 0..last.len() {
                let next = last[(i + 1) % last.len()];
                soup.add([last[i].at, next.at, Vec3::new(x, 0.0, 0.0)]);
            }
        }
        for arm in &self.arms {
            self.arm(arm, &mut soup);
        }
        Ok(soup.closed())
    }

    /// Half-axes of the cross-section at x: an ellipsoid of 4:1 ahead, the body's own
    /// behind its thickest place.
    fn axes(&self, x: f64) -> [f64; 2] {
        let (first, last) = (self.stations[0], self.stations[self.stations.len() - 1]);
        let t = (x - first) / (last - first);
        let nose = |t: f64| (1.0 - (1.0 - t / 0.3).max(0.0).powi(2)).max(0.0).sqrt();
        let taper = if t < 0.6 {
            1.0
        } else {
            (1.0 - ((t - 0.6) / 0.4).powi(2)).max(0.0)
        };
        match self.tail {
            Tail::Pointed => [
                self.half_width * nose(t) * taper,
                self.half_height * nose(t) * taper,
            ],
            Tail::Blunt => [self.half_width * nose(t), self.half_height * nose(t)],
            Tail::Knife => [
                self.half_width * nose(t) * taper,
                self.half_height * nose(t),
            ],
        }
    }

    /// Point of the ellipse at an angle.
    fn on_ring(&self, x: f64, angle: f64) -> Vec3 {
        let [a, b] = self.axes(x);
        let (sin, cos) = angle.sin_cos();
        let exact = |v: f64| if v.abs() < 1e-15 { 0.0 } else { v };
        Vec3::new(x, exact(a * cos), exact(b * sin))
    }

    /// Half thickness of an arm's root at x.
    fn half_thickness(arm: &Arm, x: f64) -> f64 {
        let xi = (x - arm.start) / arm.chord;
        if !(1e-9..=1.0 - 1e-9).contains(&xi) {
            return 0.0;
        }
        arm.chord * naca_half_thickness(arm.thickness, xi)
    }

    /// Angle by which an arm's root surface lies off its middle at x.
    fn half_angle(&self, arm: &Arm, x: f64) -> Result<f64, ShapeError> {
        let [a, b] = self.axes(x);
        let across = arm.angle_deg.to_radians();
        let size = (a * across.sin()).hypot(b * across.cos());
        let sine = Self::half_thickness(arm, x) / size.max(f64::MIN_POSITIVE);
        if sine > 0.9 {
            return Err(ShapeError::Dimension {
                name: "thickness",
                value: arm.thickness,
                rule: "arms must be thinner than the body",
            });
        }
        Ok(sine.min(0.9).asin())
    }

    /// Corners of a cross-section counter-clockwise seen from behind, arm by arm: its lower
    /// root, its upper root, and the points up to the next arm.
    fn ring(&self, x: f64) -> Result<Vec<Corner>, ShapeError> {
        let mut groups = self.angles();
        groups.push(groups[0] + TAU);
        let mut ring = Vec::new();
        let half = |angle: f64| -> Result<(f64, bool), ShapeError> {
            for arm in self.at_angle(angle) {
                let half = self.half_angle(arm, x)?;
                if half > 0.0 {
                    return Ok((half, true));
                }
            }
            Ok((0.0, false))
        };
        for pair in groups.windows(2) {
            let (here, inside) = half(pair[0])?;
            let (there, _) = half(pair[1])?;
            ring.push(Corner {
                at: self.on_ring(x, pair[0] - here),
                root: inside,
            });
            let [from, to] = [pair[0] + here, pair[1] - there];
            for i in 0..self.n_around {
                let angle = from + (to - from) * i as f64 / self.n_around as f64;
                ring.push(Corner {
                    at: self.on_ring(x, angle),
                    root: false,
                });
            }
        }
        Ok(ring)
    }

    /// Different angles of arms, ascending, radians.
    fn angles(&self) -> Vec<f64> {
        let mut all: Vec<f64> = self
            .arms
            .iter()
            .map(|a| a.angle_deg.to_radians().rem_euclid(TAU))
            .collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    fn at_angle(&self, angle: f64) -> impl Iterator<Item = &Arm> {
        let wanted = angle.rem_euclid(TAU);
        self.arms.iter().filter(move |a| {
            let own = a.angle_deg.to_radians().rem_euclid(TAU);
            (own - wanted).abs() < 1e-9
        })
    }

    /// Skin between two cross-sections.
    fn skin(&self, fore: &[Corner], aft: &[Corner], soup: &mut Soup) {
        let n = fore.len();
        for i in 0..n {
            let next = (i + 1) % n;
            // From the lower to the upper root there is the arm.
            if i % (self.n_around + 1) == 0 && (fore[i].root || aft[i].root) {
                continue;
            }
            let [a, b, c, d] = [fore[i].at, fore[next].at, aft[next].at, aft[i].at];
            // Port mirrors starboard.
            if a.y + b.y + c.y + d.y > 0.0 {
                soup.quadrilateral([a, b, c, d]);
            } else {
                soup.quadrilateral([b, c, d, a]);
            }
        }
    }

    /// Both sides of an arm: from the root points at each station to a sharp tip.
    fn arm(&self, arm: &Arm, soup: &mut Soup) {
        let angle = arm.angle_deg.to_radians();
        let (sin, cos) = angle.sin_cos();
        let exact = |v: f64| if v.abs() < 1e-15 { 0.0 } else { v };
        let out = Vec3::new(0.0, exact(cos), exact(sin));
        let up = Vec3::new(0.0, -out.z, out.y);
        let rows: Vec<f64> = self
            .stations
            .iter()
            .copied()
            .filter(|x| (arm.start - 1e-9..=arm.start + arm.chord + 1e-9).contains(x))
            .collect();
        let point = |x: f64, k: usize, side: f64| -> Vec3 {
            let half = self.half_angle(arm, x).unwrap_or(0.0);
            let root = self.on_ring(x, angle + side * half);
            let eta = k as f64 / arm.n_span as f64;
            let tip = Vec3::new(x, 0.0, 0.0) + arm.reach * out;
            let span = out * ((tip - root).dot(&out) * eta);
            let thin = (1.0 - eta * eta).max(0.0).sqrt();
            let off = (root - Vec3::new(x, 0.0, 0.0)).dot(&up);
            root + span + up * (off * (thin - 1.0)) + Vec3::x() * (arm.sweep * eta)
        };
        for pair in rows.windows(2) {
            for k in 0..arm.n_span {
                for side in [1.0, -1.0] {
                    let corners = [
                        point(pair[0], k, side),
                        point(pair[1], k, side),
                        point(pair[1], k + 1, side),
                        point(pair[0], k + 1, side),
                    ];
                    if side > 0.0 {
                        soup.quadrilateral(corners);
                    } else {
                        let [a, b, c, d] = corners;
                        soup.quadrilateral([a, d, c, b]);
                    }
                }
            }
        }
    }
}

/// A corner of a cross-section.
#[derive(Clone, Copy)]
struct Corner {
    at: Vec3,
    /// Whether an arm stands between this corner and the next.
    root: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Topology;
    use crate::judge::{self, judge};
    use crate::trailing_edge::{self, find_by_shape};

    fn arm(angle_deg: f64, start: f64) -> Arm {
        Arm {
            angle_deg,
            start,
            chord: 0.8,
            reach: 2.0,
            thickness: 0.1,
            sweep: 0.2,
            n_span: 6,
        }
    }

    fn body(tail: Tail, arms: Vec<Arm>) -> TriMesh {
        WingBody {
            stations: WingBody::even_stations(4.0, 0.1, &arms),
            half_width: 0.25,
            half_height: 0.3,
            tail,
            arms,
            n_around: 5,
        }
        .structured()
        .expect("a body")
    }

    /// Whatever the tail and the arms, the surface is closed, outward, and has one
    /// trailing edge an arm, or one down the knife.
    #[test]
    fn bodies_with_arms_are_sound() {
        let wings = || vec![arm(0.0, 1.0), arm(180.0, 1.0)];
        let mut tailed = wings();
        tailed.extend([arm(0.0, 2.8), arm(180.0, 2.8), arm(90.0, 2.6)]);
        for (tail, arms, edges) in [
            (Tail::Pointed, wings(), 2),
            (Tail::Pointed, tailed.clone(), 5),
            (Tail::Blunt, tailed, 5),
            (Tail::Knife, wings(), 3),
        ] {
            let mesh = body(tail, arms);
            let topology = Topology::new(&mesh);
            assert!(
                (0..topology.edges.len()).all(|e| topology.edge_triangles(e).len() == 2),
                "{tail:?}"
            );
            assert!(mesh.volume() > 0.0);
            let verdict = judge(mesh.clone(), judge::Settings::default());
            assert!(verdict.faults.is_empty(), "{tail:?} {:?}", verdict.faults);
            let found = find_by_shape(&mesh, &topology, trailing_edge::Settings::default());
            assert_eq!(found.len(), edges, "{tail:?}");
        }
    }
}
