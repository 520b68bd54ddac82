//! Test triangles against a few strips of the far wake: the tested influence densities.
//!
//! The formulae are those of [`crate::far_wake`], whose scalar function is the oracle;
//! lanes are field points. One complex root serves a streamline and a node: with
//! r² = (ζ − iρ)(ζ + iρ) the product √(ζ − iρ) √(ζ + iρ) is the principal root of r², or
//! its negative where Re ζ < 0 and |Im ζ| > ρ, the angles of both factors adding up to
//! more than π there.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a dispatched function has its instructions"
)]

use crate::far_wake::{FarWake, INVERSE_FOUR_PI};
use crate::lanes::{Lanes, WIDTH};
use crate::panel_block::{Points, dot, points_of, splat3};
use crate::receiver::Receiver;
use crate::tiles::{TestCluster, add_lanes, test};
use faer::{MatRef, c64};
use fladder_mesh::Vec3;
use pulp::{Arch, Simd, WithSimd};

/// Strips of a block: their tile on a cluster stays in the second cache.
const STRIPS: usize = 8;

/// Neighbouring strips and the streamlines they lie between.
#[derive(Clone, Debug)]
pub(crate) struct FarBlock {
    /// Unit vector along the stream.
    direction: Vec3,
    anchors: Vec<Vec3>,
    strips: Vec<FarStrip>,
    /// Numbers of the streamlines.
    pub(crate) lines: Vec<u32>,
}

/// A strip between streamlines a and b, e = B − A.
#[derive(Clone, Debug)]
struct FarStrip {
    ends: [usize; 2],
    span: Vec3,
    /// u × e / 4π.
    normal: Vec3,
    span_squared: f64,
    /// e·u.
    skew: f64,
}

impl FarBlock {
    /// All strips of a wake, in their order.
    pub(crate) fn of(far: &FarWake) -> Vec<Self> {
        far.strips
            .chunks(STRIPS)
            .map(|strips| {
                let mut lines: Vec<u32> = strips.iter().flatten().copied().collect();
                lines.sort_unstable();
                lines.dedup();
                let anchors: Vec<Vec3> =
                    lines.iter().map(|&l| far.anchors[l as usize]).collect();
                let strips = strips
                    .iter()
                    .map(|strip| {
                        let ends = strip.map(|l| lines.partition_point(|&x| x < l));
                        let span = anchors[ends[1]] - anchors[ends[0]];
                        FarStrip {
                            ends,
                            span,
                            normal: INVERSE_FOUR_PI * far.direction.cross(&span),
                            span_squared: span.norm_squared(),
                            skew: span.dot(&far.direction),
                        }
                    })
                    .collect();
                Self {
                    direction: far.direction,
                    anchors,
                    strips,
                    lines,
                }
            })
            .collect()
    }

    /// Whether the singularities at all nodes are far from a receiver.
    pub(crate) fn is_far_from(&self, receiver: &Receiver, nodes: &[c64]) -> bool {
        receiver.is_beyond(|point| self.distance(point, nodes))
    }

    /// Distance of a point from the singularities at the nodes, from below.
    ///
    /// With X along and ρ across a streamline, 1/r at ξ is singular where X = Re ξ and
    /// ρ = |Im ξ|, and its branch is cut on ρ = |Im ξ| downstream of there. Streamlines
    /// between the ends of a strip are at most half its length from the nearer one.
    fn distance(&self, point: Vec3, nodes: &[c64]) -> f64 {
        let between = self
            .strips
            .iter()
            .map(|s| s.span_squared.sqrt())
            .fold(0.0, f64::max);
        let nearest = self
            .anchors
            .iter()
            .flat_map(|anchor| {
                let offset = point - anchor;
                let along = offset.dot(&self.direction);
                let across = (offset - along * self.direction).norm();
                nodes.iter().map(move |xi| {
                    let ahead = (xi.re - along).max(0.0);
                    ahead.hypot(across - xi.im.abs())
                })
            })
            .fold(f64::INFINITY, f64::min);
        nearest - 0.5 * between
    }

    /// Columns of a tile: (streamlines × nodes × 2), real and imaginary part beside each
    /// other.
    pub(crate) fn columns(&self, nodes: usize) -> usize {
        2 * self.lines.len() * nodes
    }
}

/// Working space of one thread.
#[derive(Debug)]
pub(crate) struct FarScratch {
    arch: Arch,
    inverse: Vec<[f64; 2 * WIDTH]>,
    values: [Vec<f64>; 3],
    at_points: Vec<f64>,
    tile: Vec<f64>,
}

impl Default for FarScratch {
    fn default() -> Self {
        Self {
            arch: Arch::new(),
            inverse: Vec::new(),
            values: Default::default(),
            at_points: Vec::new(),
            tile: Vec::new(),
        }
    }
}

impl FarScratch {
    /// Tested influence densities of a block at the nodes ξ, without weights and without
    /// e^{−sξ}: rows of the cluster × [`FarBlock::columns`]; with factors, one a node, their
    /// sums over the nodes: rows × (streamlines × 2).
    pub(crate) fn tile(
        &mut self,
        cluster: &TestCluster,
        block: &FarBlock,
        nodes: &[c64],
        factors: Option<&[c64]>,
    ) -> MatRef<'_, f64> {
        let (rows, columns) = self.clear(cluster.rows.len(), block, nodes, factors);
        for group in &cluster.groups {
            for q in 0..3 {
                for (image, seen) in group.seen.iter().enumerate() {
                    self.evaluate(&seen.points[q], block, nodes, factors);
                    if image == 0 {
                        self.values[q].clone_from(&self.at_points);
                    } else {
                        for (o, v) in self.values[q].iter_mut().zip(&self.at_points) {
                            *o += seen.sign * v;
                        }
                    }
                }
            }
            test(self.arch, group, &self.values, &mut self.tile);
        }
        MatRef::from_row_major_slice(&self.tile, rows, columns)
    }

    /// [`Self::tile`] at the chosen points of a receiver instead of at rows.
    pub(crate) fn far_tile(
        &mut self,
        receiver: &Receiver,
        block: &FarBlock,
        nodes: &[c64],
        factors: Option<&[c64]>,
    ) -> MatRef<'_, f64> {
        let (width, columns) = self.clear(receiver.width(), block, nodes, factors);
        for seen in &receiver.seen {
            for (eight, points) in seen.points.iter().enumerate() {
                self.evaluate(points, block, nodes, factors);
                add_lanes(seen.sign, eight, &self.at_points, width, &mut self.tile);
            }
        }
        MatRef::from_column_major_slice(&self.tile, width, columns)
    }

    /// Makes room for a tile; its size.
    fn clear(
        &mut self,
        rows: usize,
        block: &FarBlock,
        nodes: &[c64],
        factors: Option<&[c64]>,
    ) -> (usize, usize) {
        let places = if factors.is_some() { 1 } else { nodes.len() };
        let columns = block.columns(places);
        self.tile.clear();
        self.tile.resize(rows * columns, 0.0);
        self.at_points.resize(columns * WIDTH, 0.0);
        (rows, columns)
    }

    /// Densities at eight points.
    fn evaluate(
        &mut self,
        points: &Points,
        block: &FarBlock,
        nodes: &[c64],
        factors: Option<&[c64]>,
    ) {
        self.inverse
            .resize(block.lines.len() * nodes.len(), [0.0; 2 * WIDTH]);
        self.at_points.fill(0.0);
        self.arch.dispatch(Densities {
            block,
            nodes,
            factors,
            points,
            inverse: &mut self.inverse,
            out: &mut self.at_points,
        });
    }
}

/// Adds the densities of unit jumps on the streamlines, columns × [`WIDTH`], to `out`; with
/// factors, their sums over the nodes.
struct Densities<'a> {
    block: &'a FarBlock,
    nodes: &'a [c64],
    factors: Option<&'a [c64]>,
    points: &'a Points,
    inverse: &'a mut [[f64; 2 * WIDTH]],
    out: &'a mut [f64],
}

/// A complex number a lane.
#[derive(Clone, Copy)]
struct Complex<S: Simd> {
    re: Lanes<S>,
    im: Lanes<S>,
}

impl<S: Simd> Complex<S> {
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self {
            re: self.re.mul_add(other.re, -(self.im * other.im)),
            im: self.re.mul_add(other.im, self.im * other.re),
        }
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self {
            re: self.re + other.re,
            im: self.im + other.im,
        }
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self {
            re: self.re - other.re,
            im: self.im - other.im,
        }
    }

    #[inline(always)]
    fn scaled(self, factor: Lanes<S>) -> Self {
        Self {
            re: self.re * factor,
            im: self.im * factor,
        }
    }
}

/// 1/r of a streamline with the point `along` and `across` from its start.
#[inline(always)]
fn inverse_distance<S: Simd>(
    simd: S,
    xi: c64,
    along: Lanes<S>,
    across: Lanes<S>,
) -> Complex<S> {
    let c = |value| Lanes::splat(simd, value);
    let (x, y) = (c(xi.re) - along, c(xi.im));
    let re = x.mul_add(x, -((y - across) * (y + across)));
    let im = c(2.0 * xi.im) * x;
    let size = re.mul_add(re, im * im).sqrt();
    // The principal root has the parts `larger` and |Im r²|/(2 larger).
    let larger = (c(0.5) * (size + re.abs())).sqrt();
    let scale = c(1.0) / (size * larger);
    let (large, small) = (larger * larger * scale, c(0.5) * im.abs() * scale);
    let real = re.where_less(c(0.0), small, large);
    let imaginary = re.where_less(c(0.0), large, small);
    let imaginary = im.where_less(c(0.0), imaginary, -imaginary);
    let beyond = across.where_less(y.abs(), c(-1.0), c(1.0));
    let sign = x.where_less(c(0.0), beyond, c(1.0));
    Complex {
        re: sign * real,
        im: sign * imaginary,
    }
}

impl WithSimd for Densities<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            block,
            nodes,
            factors,
            points,
            inverse,
            out,
        } = self;
        let c = |value| Lanes::splat(simd, value);
        let lanes = |values: S::f64s| Lanes::new(simd, values);
        let chunks = WIDTH / S::F64_LANES;
        let n = nodes.len();
        let (out, _) = S::as_mut_simd_f64s(out);
        for chunk in 0..chunks {
            let point = points_of(simd, points, chunk);
            for (line, anchor) in block.anchors.iter().enumerate() {
                let d = offset(simd, point, anchor);
                let stream = splat3(simd, &block.direction);
                let along = dot(d, stream);
                let across = [
                    d[0] - along * stream[0],
                    d[1] - along * stream[1],
                    d[2] - along * stream[2],
                ];
                let across = dot(across, across).sqrt();
                for (xi, out) in nodes.iter().zip(&mut inverse[line * n..]) {
                    let value = inverse_distance(simd, *xi, along, across);
                    let (out, _) = S::as_mut_simd_f64s(out);
                    out[0] = value.re.values();
                    out[chunks] = value.im.values();
                }
            }
            for strip in &block.strips {
                let [a, b] = strip.ends;
                let d = offset(simd, point, &block.anchors[a]);
                let height = dot(d, splat3(simd, &strip.normal));
                let along = dot(d, splat3(simd, &block.direction));
                let distance = dot(d, d);
                let over_span = c(1.0 / strip.span_squared);
                let projection = dot(d, splat3(simd, &strip.span)) * over_span;
                let skew = strip.skew / strip.span_squared;
                for (node, xi) in nodes.iter().enumerate() {
                    let ends = [
                        kept(simd, &inverse[a * n + node]),
                        kept(simd, &inverse[b * n + node]),
                    ];
                    let foot = Complex {
                        re: projection - c(xi.re * skew),
                        im: c(-xi.im * skew),
                    };
                    let (first, second) = density(
                        simd,
                        *xi,
                        [along, distance, c(strip.span_squared), over_span],
                        foot,
                        ends,
                    );
                    // In the plane of the strip the density is zero, r and a too.
                    let away = height.abs();
                    for (line, value) in [(a, first), (b, second)] {
                        let mut part = Complex {
                            re: c(0.0).where_less(away, value.re * height, c(0.0)),
                            im: c(0.0).where_less(away, value.im * height, c(0.0)),
                        };
                        let mut place = line * n + node;
                        if let Some(factors) = factors {
                            let factor = factors[node];
                            part = part.times(Complex {
                                re: c(factor.re),
                                im: c(factor.im),
                            });
                            place = line;
                        }
                        let at = 2 * place * chunks + chunk;
                        out[at] = (lanes(out[at]) + part.re).values();
                        out[at + chunks] = (lanes(out[at + chunks]) + part.im).values();
                    }
                }
            }
        }
    }
}

/// P − A.
#[inline(always)]
fn offset<S: Simd>(simd: S, point: [Lanes<S>; 3], anchor: &Vec3) -> [Lanes<S>; 3] {
    let anchor = splat3(simd, anchor);
    [
        point[0] - anchor[0],
        point[1] - anchor[1],
        point[2] - anchor[2],
    ]
}

/// A number as it was kept.
#[inline(always)]
fn kept<S: Simd>(simd: S, values: &[f64; 2 * WIDTH]) -> Complex<S> {
    let (v, _) = S::as_simd_f64s(values);
    Complex {
        re: Lanes::new(simd, v[0]),
        im: Lanes::new(simd, v[WIDTH / S::F64_LANES]),
    }
}

/// Densities of unit jumps at both ends over the height of the point.
#[inline(always)]
fn density<S: Simd>(
    simd: S,
    xi: c64,
    [along, distance_squared, span_squared, over_span]: [Lanes<S>; 4],
    foot: Complex<S>,
    inverse: [Complex<S>; 2],
) -> (Complex<S>, Complex<S>) {
    let c = |value| Lanes::splat(simd, value);
    let r0_squared = Complex {
        re: (c(xi.re) - c(2.0) * along).mul_add(c(xi.re), distance_squared - c(xi.im * xi.im)),
        im: c(2.0 * xi.im) * (c(xi.re) - along),
    };
    let a_squared = r0_squared.minus(foot.times(foot).scaled(span_squared));
    let rest = Complex {
        re: c(1.0) - foot.re,
        im: -foot.im,
    };
    let sum = rest.times(inverse[1]).plus(foot.times(inverse[0]));
    let size = c(1.0)
        / a_squared
            .re
            .mul_add(a_squared.re, a_squared.im * a_squared.im);
    let over_a = Complex {
        re: a_squared.re * size,
        im: -(a_squared.im * size),
    };
    let whole = sum.times(over_a);
    let moment = inverse[0].minus(inverse[1]).scaled(over_span);
    let second = moment.plus(foot.times(whole));
    (whole.minus(second), second)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contour::Paths;

    /// A swept wing's strips, points on both sides, in front and in a strip's plane.
    #[test]
    fn lanes_give_what_the_scalar_function_gives() {
        let far = FarWake {
            direction: Vec3::new(0.05_f64.cos(), 0.0, 0.05_f64.sin()),
            anchors: (0..9)
                .map(|i| {
                    let y = f64::from(i) * 0.4 - 1.6;
                    Vec3::new(1.0 + 0.4 * y.abs(), y, 0.02 * y * y)
                })
                .collect(),
            strips: (0..8).map(|i| [i, i + 1]).collect(),
        };
        let paths = Paths::new(0.9, 0.2, 3.5);
        let mut worst = 0.0_f64;
        for group in 0..6 {
            let point = |l: usize| {
                let i = (group * WIDTH + l) as f64;
                if l == 3 {
                    // In the plane of the strip from anchor 2.
                    far.anchors[2] + 0.3 * (far.anchors[3] - far.anchors[2])
                        - 0.2 * far.direction
                } else {
                    Vec3::new(
                        0.8 * (0.7 * i).sin(),
                        1.7 * (1.1 * i).cos(),
                        0.1 * (2.3 * i).sin(),
                    )
                }
            };
            let points: Points = std::array::from_fn(|a| std::array::from_fn(|l| point(l)[a]));
            for path in [&paths.oscillating, &paths.decaying] {
                let n = path.nodes.len();
                let mut sums = vec![vec![c64::new(0.0, 0.0); far.anchors.len() * n]; WIDTH];
                for block in FarBlock::of(&far) {
                    let mut inverse = vec![[0.0; 2 * WIDTH]; block.lines.len() * n];
                    let mut out = vec![0.0; block.columns(n) * WIDTH];
                    Arch::new().dispatch(Densities {
                        block: &block,
                        nodes: &path.nodes,
                        factors: None,
                        points: &points,
                        inverse: &mut inverse,
                        out: &mut out,
                    });
                    for (i, &line) in block.lines.iter().enumerate() {
                        for node in 0..n {
                            for (l, sums) in sums.iter_mut().enumerate() {
                                let at = 2 * (i * n + node) * WIDTH + l;
                                sums[line as usize * n + node] +=
                                    c64::new(out[at], out[at + WIDTH]);
                            }
                        }
                    }
                }
                for (l, found) in sums.iter().enumerate() {
                    let expected = far.influence(point(l), &path.nodes);
                    let largest = expected.iter().map(|v| v.norm()).fold(0.0, f64::max);
                    for (f, e) in found.iter().zip(&expected) {
                        worst = worst.max((f - e).norm() / largest);
                    }
                }
            }
        }
        println!("far wake in lanes: off by {worst:.1e} of the largest");
        assert!(worst < 1e-12);
    }
}
