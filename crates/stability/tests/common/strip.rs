//! A uniform cantilever wing in assumed modes, with strip theory.
//!
//! Bending $w$ up and twist $\theta$ nose up about the elastic axis:
//! $m\ddot w + EIw'''' - mx\ddot\theta = L$,
//! $I\ddot\theta - mx\ddot w - GJ\theta'' = M$. Modes: those of a uniform
//! clamped beam and shaft. Forces of the section at $(h/b, \alpha)$, h down,
//! are carried over by $w = -h$.

use faer::{Mat, c64};
use fladder_stability::System;
use serde_json::Value;

use super::theodorsen::theodorsen;

/// Roots of $\cosh z\cos z = -1$.
const CLAMPED: [f64; 4] = [
    1.875_104_068_711_961,
    4.694_091_132_974_174,
    7.854_757_438_237_613,
    10.995_540_734_875_467,
];

/// Gauss–Legendre panels along the span, ten points each.
const PANELS: usize = 24;

const NODES: [(f64, f64); 5] = [
    (0.148_874_338_981_631_2, 0.295_524_224_714_752_9),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_4),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

pub struct StripWing {
    length: f64,
    pub semichord: f64,
    pub density: f64,
    axis: f64,
    mass: f64,
    inertia: f64,
    offset: f64,
    bending: f64,
    torsion: f64,
    modes: usize,
    /// ∫φφ, ∫φψ, ∫ψψ.
    products: [Mat<f64>; 3],
}

impl StripWing {
    /// `modes` of bending and as many of twist, of the parameters in a file.
    pub fn new(file: &Value, modes: usize) -> Self {
        let value =
            |name: &str| -> f64 { file["parameters"][name].as_str().unwrap().parse().unwrap() };
        let length = value("L");
        let product = |one: &dyn Fn(usize, f64) -> f64, other: &dyn Fn(usize, f64) -> f64| {
            Mat::from_fn(modes, modes, |i, j| {
                length * integral(&|t| one(i, t) * other(j, t))
            })
        };
        let products = [
            product(&bending_shape, &bending_shape),
            product(&bending_shape, &twist_shape),
            product(&twist_shape, &twist_shape),
        ];
        Self {
            length,
            semichord: value("b"),
            density: value("rho"),
            axis: value("a"),
            mass: value("m"),
            inertia: value("I"),
            offset: value("x"),
            bending: value("EI"),
            torsion: value("GJ"),
            modes,
            products,
        }
    }

    pub fn names(&self) -> Vec<String> {
        let numbered =
            |word: &'static str| (1..=self.modes).map(move |i| format!("{word}:{i}"));
        numbered("bending").chain(numbered("twist")).collect()
    }

    /// Blocks of a matrix: bending, coupling, twist.
    fn assemble<T: Copy>(&self, block: impl Fn(usize, usize, usize, usize) -> T) -> Mat<T> {
        let n = self.modes;
        Mat::from_fn(2 * n, 2 * n, |i, j| block(i / n, j / n, i % n, j % n))
    }

    fn product(&self, row: usize, column: usize, i: usize, j: usize) -> f64 {
        match (row, column) {
            (0, 0) => self.products[0][(i, j)],
            (0, _) => self.products[1][(i, j)],
            (_, 0) => self.products[1][(j, i)],
            _ => self.products[2][(i, j)],
        }
    }

    pub fn system(&self) -> System {
        let mass = self.assemble(|row, column, i, j| {
            let factor = match (row, column) {
                (0, 0) => self.mass,
                (1, 1) => self.inertia,
                _ => -self.mass * self.offset,
            };
            factor * self.product(row, column, i, j)
        });
        let stiffness = self.assemble(|row, column, i, j| {
            if row != column || i != j {
                return 0.0;
            }
            if row == 0 {
                let z = CLAMPED[i] / self.length;
                self.bending * z.powi(4) * self.products[0][(i, i)]
            } else {
                let z = twist_rate(i) / self.length;
                self.torsion * z * z * self.products[2][(i, i)]
            }
        });
        let still = Mat::zeros(2 * self.modes, 2 * self.modes);
        System::from_matrices(self.names(), mass, still, stiffness).unwrap()
    }

    pub fn q(&self, p: c64) -> Mat<c64> {
        let section = section_forces(self.axis, p);
        let b = self.semichord;
        self.assemble(|row, column, i, j| {
            let factor = match (row, column) {
                (0, 0) => section[0][0],
                (0, _) => section[0][1] * -b,
                (_, 0) => section[1][0] * -b,
                _ => section[1][1] * (b * b),
            };
            factor * self.product(row, column, i, j)
        })
    }
}

/// Theodorsen's forces of a section at $(h/b, \alpha)$ over $\rho U^2b/2$ and
/// $\rho U^2b^2/2$, elastic axis `a` semichords aft of mid-chord. NACA Report
/// 496.
fn section_forces(a: f64, p: c64) -> [[c64; 2]; 2] {
    let tau = std::f64::consts::TAU;
    let lift = theodorsen(p) * (2.0 * tau);
    let wash = [p, p * (0.5 - a) + 1.0];
    let square = p * p;
    [
        [
            square * -tau - lift * wash[0],
            p * -tau + square * (tau * a) - lift * wash[1],
        ],
        [
            square * (tau * a) + lift * wash[0] * (a + 0.5),
            p * (-tau * (0.5 - a)) - square * (tau * (0.125 + a * a))
                + lift * wash[1] * (a + 0.5),
        ],
    ]
}

fn bending_shape(mode: usize, t: f64) -> f64 {
    let z = CLAMPED[mode];
    let ratio = (z.cosh() + z.cos()) / (z.sinh() + z.sin());
    let x = z * t;
    x.cosh() - x.cos() - ratio * (x.sinh() - x.sin())
}

fn twist_rate(mode: usize) -> f64 {
    (mode as f64 + 0.5) * std::f64::consts::PI
}

fn twist_shape(mode: usize, t: f64) -> f64 {
    (twist_rate(mode) * t).sin()
}

/// Integral over 0 … 1.
fn integral(function: &dyn Fn(f64) -> f64) -> f64 {
    let half = 0.5 / PANELS as f64;
    let mut sum = 0.0;
    for panel in 0..PANELS {
        let middle = half * (2 * panel + 1) as f64;
        for (node, weight) in NODES {
            sum += weight
                * half
                * (function(middle - half * node) + function(middle + half * node));
        }
    }
    sum
}
