//! A structured grid in a plane, smoothed by Winslow's equations.
//!
//! $\alpha\,\mathbf x_{\xi\xi}-2\beta\,\mathbf x_{\xi\eta}+\gamma\,\mathbf x_{\eta\eta}=0$ with
//! $\alpha=|\mathbf x_\eta|^2$, $\beta=\mathbf x_\xi\cdot\mathbf x_\eta$,
//! $\gamma=|\mathbf x_\xi|^2$ (A. Winslow, J. Comp. Phys. 1, 1966), by Jacobi's iteration.

const SWEEPS: usize = 4000;
const TOLERANCE: f64 = 1e-7;

/// Points of a grid: rows along ξ, columns along η.
pub(super) struct Plane {
    pub(super) rows: usize,
    pub(super) columns: usize,
    points: Vec<[f64; 2]>,
}

impl Plane {
    /// Straight lines between a lower and an upper row of points.
    pub(super) fn between(lower: &[[f64; 2]], upper: &[[f64; 2]], parts: &[f64]) -> Self {
        let blend = |(low, high): (&[f64; 2], &[f64; 2]), part: f64| {
            [0, 1].map(|axis| (1.0 - part) * low[axis] + part * high[axis])
        };
        let points = lower
            .iter()
            .zip(upper)
            .flat_map(|ends| parts.iter().map(move |part| blend(ends, *part)))
            .collect();
        Self {
            rows: lower.len(),
            columns: parts.len(),
            points,
        }
    }

    pub(super) fn at(&self, row: usize, column: usize) -> [f64; 2] {
        self.points[row * self.columns + column]
    }

    /// Moves inner points until they are at rest.
    pub(super) fn smooth(&mut self) {
        for _ in 0..SWEEPS {
            let mut next = self.points.clone();
            let mut largest: f64 = 0.0;
            for i in 1..self.rows - 1 {
                for j in 1..self.columns - 1 {
                    let moved = self.relaxed(i, j);
                    let here = self.at(i, j);
                    for axis in 0..2 {
                        largest = largest.max((moved[axis] - here[axis]).abs());
                    }
                    next[i * self.columns + j] = moved;
                }
            }
            self.points = next;
            if largest < TOLERANCE {
                return;
            }
        }
    }

    fn relaxed(&self, i: usize, j: usize) -> [f64; 2] {
        let half = |a: [f64; 2], b: [f64; 2]| [0, 1].map(|axis| 0.5 * (a[axis] - b[axis]));
        let (east, west) = (self.at(i + 1, j), self.at(i - 1, j));
        let (north, south) = (self.at(i, j + 1), self.at(i, j - 1));
        let (xi, eta) = (half(east, west), half(north, south));
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let (alpha, beta, gamma) = (dot(eta, eta), dot(xi, eta), dot(xi, xi));
        [0, 1].map(|axis| {
            let mixed = 0.25
                * (self.at(i + 1, j + 1)[axis]
                    - self.at(i - 1, j + 1)[axis]
                    - self.at(i + 1, j - 1)[axis]
                    + self.at(i - 1, j - 1)[axis]);
            let sum = alpha * (east[axis] + west[axis]) + gamma * (north[axis] + south[axis])
                - 2.0 * beta * mixed;
            sum / (2.0 * (alpha + gamma)).max(f64::MIN_POSITIVE)
        })
    }
}
