//! Doublet strips on streamlines, at complex distance ξ behind the trailing edge.
//!
//! A strip between the streamlines through A and B carries the jump
//! κ_A (1 − η) + κ_B η times e^{−sξ}. With e = B − A, d = P − A, stream direction u
//! and N = u × e, its influence density along ξ is, in closed form over η,
//!
//! $$ \frac{\mathbf d\cdot\mathbf N}{4\pi}\int_0^1\frac{(1-\eta,\ \eta)}{r^3}\mathrm d\eta,
//! \qquad
//! \int_0^1\frac{\mathrm d\eta}{r^3}=\frac1{a^2}\Big[\frac{1-h_0}{r_1}+\frac{h_0}{r_0}\Big],
//! \qquad
//! \int_0^1\frac{\eta-h_0}{r^3}\mathrm d\eta=\frac1{e^2}\Big[\frac1{r_0}-\frac1{r_1}\Big], $$
//!
//! h₀ = (e·d − ξ e·u)/e², a² = r₀² − e²h₀². For complex ξ the distance to the end on a
//! streamline is the product r = √(ζ − iρ) √(ζ + iρ), ζ = ξ − d·u: the principal root of
//! r² itself has the wrong sign past arg ξ = −90°.

#[cfg(test)]
use faer::c64;
use fladder_mesh::Vec3;

pub(crate) const INVERSE_FOUR_PI: f64 = 0.25 * std::f64::consts::FRAC_1_PI;

/// Streamlines and the strips between them.
#[derive(Clone, Debug)]
pub(crate) struct FarWake {
    /// Unit vector along the stream.
    pub(crate) direction: Vec3,
    /// Where each streamline has ξ = 0.
    pub(crate) anchors: Vec<Vec3>,
    /// Pairs of streamlines, along the trailing edge's direction.
    pub(crate) strips: Vec<[u32; 2]>,
}

#[cfg(test)]
impl FarWake {
    /// Influence density of each streamline's unit jump at each node, without e^{−sξ}:
    /// streamlines × nodes. What [`crate::far_tiles`] must give.
    pub(crate) fn influence(&self, point: Vec3, nodes: &[c64]) -> Vec<c64> {
        let n = nodes.len();
        let mut out = vec![c64::new(0.0, 0.0); self.anchors.len() * n];
        for &[a, b] in &self.strips {
            let (a, b) = (a as usize, b as usize);
            let ends = [self.anchors[a], self.anchors[b]];
            let strip = Strip::new(ends[0], ends[1], self.direction, point);
            if strip.height == 0.0 {
                continue;
            }
            let lines = ends.map(|end| Line::new(&end, self.direction, point));
            for (m, xi) in nodes.iter().enumerate() {
                let inverse = [&lines[0], &lines[1]].map(|line| line.inverse_distance(*xi));
                let [first, second] = strip.density(*xi, inverse);
                out[a * n + m] += first;
                out[b * n + m] += second;
            }
        }
        out
    }
}

/// One streamline seen from one point.
#[cfg(test)]
struct Line {
    along: f64,
    across: f64,
}

#[cfg(test)]
impl Line {
    fn new(anchor: &Vec3, direction: Vec3, point: Vec3) -> Self {
        let offset = point - anchor;
        let along = offset.dot(&direction);
        Self {
            along,
            across: (offset - along * direction).norm(),
        }
    }

    /// 1/r at distance ξ.
    fn inverse_distance(&self, xi: c64) -> c64 {
        let zeta = xi - self.along;
        let below = (zeta - c64::new(0.0, self.across)).sqrt();
        let above = (zeta + c64::new(0.0, self.across)).sqrt();
        c64::new(1.0, 0.0) / (below * above)
    }
}

/// One strip seen from one point.
#[cfg(test)]
struct Strip {
    /// d·N / 4π.
    height: f64,
    span_squared: f64,
    /// e·d.
    projection: f64,
    /// e·u.
    skew: f64,
    /// d·u and d·d.
    along: f64,
    distance_squared: f64,
}

#[cfg(test)]
impl Strip {
    fn new(a: Vec3, b: Vec3, direction: Vec3, point: Vec3) -> Self {
        let e = b - a;
        let d = point - a;
        Self {
            height: INVERSE_FOUR_PI * d.dot(&direction.cross(&e)),
            span_squared: e.norm_squared(),
            projection: e.dot(&d),
            skew: e.dot(&direction),
            along: d.dot(&direction),
            distance_squared: d.norm_squared(),
        }
    }

    /// Influence density of unit jumps at both ends, `inverse` = 1/r₀, 1/r₁.
    fn density(&self, xi: c64, inverse: [c64; 2]) -> [c64; 2] {
        let foot = (self.projection - xi * self.skew) / self.span_squared;
        let r0_squared = (xi - 2.0 * self.along) * xi + self.distance_squared;
        let a_squared = r0_squared - foot * foot * self.span_squared;
        let whole = ((1.0 - foot) * inverse[1] + foot * inverse[0]) / a_squared;
        let moment = (inverse[0] - inverse[1]) / self.span_squared;
        let second = moment + foot * whole;
        [(whole - second) * self.height, second * self.height]
    }
}
