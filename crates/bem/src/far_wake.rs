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

use faer::c64;
use fladder_mesh::Vec3;

const INVERSE_FOUR_PI: f64 = 0.25 * std::f64::consts::FRAC_1_PI;

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

impl FarWake {
    /// Influence of each streamline's jump at each node: `out[line * nodes + node]`,
    /// times the node's weight; without e^{−sξ}.
    ///
    /// `distances` is working space of the same size.
    pub(crate) fn influence(
        &self,
        point: Vec3,
        nodes: &[c64],
        weights: &[c64],
        distances: &mut Vec<c64>,
        out: &mut [c64],
    ) {
        out.fill(c64::new(0.0, 0.0));
        self.inverse_distances(point, nodes, distances);
        let n = nodes.len();
        for &[a, b] in &self.strips {
            let (a, b) = (a as usize, b as usize);
            let strip = Strip::new(self.anchors[a], self.anchors[b], self.direction, point);
            if strip.height == 0.0 {
                continue;
            }
            for m in 0..n {
                let inverse = [distances[a * n + m], distances[b * n + m]];
                let [first, second] = strip.density(nodes[m], inverse);
                out[a * n + m] += first * weights[m];
                out[b * n + m] += second * weights[m];
            }
        }
    }

    fn inverse_distances(&self, point: Vec3, nodes: &[c64], distances: &mut Vec<c64>) {
        distances.clear();
        for anchor in &self.anchors {
            let offset = point - anchor;
            let along = offset.dot(&self.direction);
            let across = (offset - along * self.direction).norm();
            distances.extend(nodes.iter().map(|xi| {
                let zeta = xi - along;
                let below = root(zeta - c64::new(0.0, across));
                let above = root(zeta + c64::new(0.0, across));
                c64::new(1.0, 0.0) / (below * above)
            }));
        }
    }
}

/// Principal square root without angles: |z| from the squares, which cannot overflow for
/// lengths, and the smaller part from the larger by Im z = 2 Re √z Im √z. Half of a whole
/// computation went into the polar form.
fn root(z: c64) -> c64 {
    let size = (z.re * z.re + z.im * z.im).sqrt();
    let larger = (0.5 * (size + z.re.abs())).sqrt();
    if larger == 0.0 {
        return c64::new(0.0, 0.0);
    }
    let smaller = 0.5 * z.im.abs() / larger;
    let (re, im) = if z.re >= 0.0 {
        (larger, smaller)
    } else {
        (smaller, larger)
    };
    c64::new(re, im.copysign(z.im))
}

/// One strip seen from one point.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_is_the_principal_one() {
        for degrees in (-179..=179).step_by(7) {
            for size in [1e-6, 1.0, 3e4] {
                let z = c64::from_polar(size, f64::from(degrees).to_radians());
                let (found, wanted) = (root(z), z.sqrt());
                assert!((found - wanted).norm() < 4e-16 * wanted.norm(), "{z}");
            }
        }
        assert_eq!(root(c64::new(0.0, 0.0)), c64::new(0.0, 0.0));
    }
}
