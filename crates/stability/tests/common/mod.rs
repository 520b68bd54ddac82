//! Reference cases read from the files of `tests/data`.
#![allow(dead_code, reason = "each test file uses its own part")]
#![allow(unreachable_pub, reason = "the module is compiled into each test")]

pub mod strip;
pub mod theodorsen;

use std::path::{Path, PathBuf};

use faer::{Mat, c64};
use fladder_stability::{
    GafPoint, GafTable, OperatingPoint, StructuralMatrices, Structure, System,
};
use serde_json::Value;

/// A file of `tests/data`, from whichever package the module is compiled in.
pub fn data_path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .map(|folder| folder.join("tests/data").join(name))
        .find(|path| path.exists())
        .unwrap()
}

pub fn read_json(name: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(data_path(name)).unwrap()).unwrap()
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

pub fn matrix(value: &Value) -> Mat<f64> {
    let rows: Vec<Vec<f64>> = value.as_array().unwrap().iter().map(numbers).collect();
    Mat::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
}

pub fn roots(value: &Value) -> Vec<c64> {
    let pairs = value.as_array().unwrap().iter().map(numbers);
    pairs.map(|pair| c64::new(pair[0], pair[1])).collect()
}

/// A typical section: samples, structure and what is known of it.
pub struct Section {
    pub file: Value,
    pub table: GafTable,
    pub system: System,
    pub density: f64,
}

/// Reads a section; `g` picks the samples by their damping.
pub fn section(name: &str, g: impl Fn(f64) -> bool) -> Section {
    let file = read_json(name);
    let samples = file["Q_samples"].as_array().unwrap();
    let points: Vec<GafPoint> = samples
        .iter()
        .map(|sample| {
            let (re, im) = (matrix(&sample["re"]), matrix(&sample["im"]));
            let q = Mat::from_fn(re.nrows(), re.ncols(), |i, j| {
                c64::new(re[(i, j)], im[(i, j)])
            });
            GafPoint {
                g: number(&sample["g"]),
                k: number(&sample["k"]),
                q,
            }
        })
        .filter(|point| g(point.g))
        .collect();
    let mass = matrix(&file["M"]);
    let order = mass.nrows();
    let modes: Vec<String> = (1..=order).map(|i| format!("section:{i}")).collect();
    let table = GafTable::new(1.0, 0.0, modes.clone(), points, vec![]).unwrap();
    let system =
        System::from_matrices(modes, mass, Mat::zeros(order, order), matrix(&file["K"]))
            .unwrap();
    let density = 1.0 / (std::f64::consts::PI * number(&file["mu"]));
    Section {
        file,
        table,
        system,
        density,
    }
}

/// $Q(p)$ of a section in closed form, $B_0 + B_1p + B_2p^2 + l(w_0 + w_1p)^TC(p)$.
pub struct SectionForces {
    b: [Mat<f64>; 3],
    l: Vec<f64>,
    w: [Vec<f64>; 2],
    /// Lag terms of a rational $C$; the exact function without them.
    lags: Vec<(f64, f64)>,
}

impl SectionForces {
    pub fn of(file: &Value) -> Self {
        let rational = &file["C"];
        let lags = if rational.is_object() {
            let (a, b) = (numbers(&rational["a"]), numbers(&rational["b"]));
            a.into_iter().zip(b).collect()
        } else {
            Vec::new()
        };
        Self {
            b: ["B0", "B1", "B2"].map(|name| matrix(&file[name])),
            l: numbers(&file["l"]),
            w: ["w0", "w1"].map(|name| numbers(&file[name])),
            lags,
        }
    }

    pub fn q(&self, p: c64) -> Mat<c64> {
        let lift = if self.lags.is_empty() {
            theodorsen::theodorsen(p)
        } else {
            let lost: c64 = self.lags.iter().map(|(a, b)| p * *a / (p + *b)).sum();
            c64::new(1.0, 0.0) - lost
        };
        let [b0, b1, b2] = &self.b;
        Mat::from_fn(b0.nrows(), b0.ncols(), |i, j| {
            let wash = p * self.w[1][j] + self.w[0][j];
            p * (p * b2[(i, j)] + b1[(i, j)]) + b0[(i, j)] + lift * wash * self.l[i]
        })
    }
}

/// A file of comma-separated values: the columns of its head and the rows.
pub struct Columns {
    head: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Columns {
    pub fn read(name: &str) -> Self {
        let text = std::fs::read_to_string(data_path(name)).unwrap();
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let split = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        let head = split(lines.next().unwrap());
        Self {
            head,
            rows: lines.map(split).collect(),
        }
    }

    fn column(&self, name: &str) -> usize {
        self.head.iter().position(|head| head == name).unwrap()
    }

    /// A column as words.
    pub fn words(&self, name: &str) -> Vec<&str> {
        let column = self.column(name);
        self.rows.iter().map(|row| row[column].as_str()).collect()
    }

    /// A column as numbers.
    pub fn numbers(&self, name: &str) -> Vec<f64> {
        self.words(name)
            .into_iter()
            .map(|word| word.parse().unwrap())
            .collect()
    }
}

/// The 26-mode free-flying wing with aerodynamics in closed form.
pub struct Wing {
    pub file: Value,
    pub modes: Vec<String>,
    mass: Mat<f64>,
    stiffness: Mat<f64>,
    /// $C = C_1U + C_{-1}/U + C_{-3}/U^3$.
    damping: [Mat<f64>; 3],
    closed_form: ClosedForm,
}

struct ClosedForm {
    b0: Mat<f64>,
    b1: Mat<f64>,
    b2: Mat<f64>,
    l: Mat<f64>,
    w0: Mat<f64>,
    w1: Mat<f64>,
    scales: Vec<f64>,
    a: Vec<f64>,
    poles: Vec<f64>,
}

impl Wing {
    pub fn read() -> Self {
        let file = read_json("stability_wing26.json");
        let rigid = ["x", "y", "z", "phi", "theta", "psi"];
        let modes = rigid
            .iter()
            .map(|name| format!("rigid:{name}"))
            .chain((1..=20).map(|i| format!("elastic:{i}")))
            .collect();
        let omega = numbers(&file["omega_elastic"]);
        let rigid_stiffness = matrix(&file["truth"][0]["K_rigid"]);
        let stiffness = Mat::from_fn(26, 26, |i, j| {
            if i < 6 && j < 6 {
                rigid_stiffness[(i, j)]
            } else if i == j {
                omega[i - 6] * omega[i - 6]
            } else {
                0.0
            }
        });
        let damping = damping_powers(&file);
        let part = |name: &str| matrix(&file[name]);
        let closed_form = ClosedForm {
            b0: part("B0"),
            b1: part("B1"),
            b2: part("B2"),
            l: part("L"),
            w0: part("W0"),
            w1: part("W1"),
            scales: numbers(&file["bs"]),
            a: numbers(&file["a"]),
            poles: numbers(&file["bl"]),
        };
        let mass = matrix(&file["M"]);
        Self {
            file,
            modes,
            mass,
            stiffness,
            damping,
            closed_form,
        }
    }

    /// The same wing where gravity does not act.
    pub fn without_gravity(mut self) -> Self {
        for i in 0..6 {
            (0..6).for_each(|j| self.stiffness[(i, j)] = 0.0);
        }
        self
    }

    pub fn semichord(&self) -> f64 {
        number(&self.file["b"])
    }

    pub fn density(&self) -> f64 {
        number(&self.file["rho"])
    }

    /// Samples on `k = 1.5 (i/20)^1.5` at each `g`.
    pub fn table(&self, dampings: &[f64]) -> GafTable {
        let mut points = Vec::new();
        for &g in dampings {
            for i in 0..=20 {
                let k = 1.5 * (f64::from(i) / 20.0).powf(1.5);
                if k > 0.0 || g >= 0.0 {
                    points.push(GafPoint {
                        g,
                        k,
                        q: self.q(c64::new(g, k)),
                    });
                }
            }
        }
        GafTable::new(self.semichord(), 0.0, self.modes.clone(), points, vec![]).unwrap()
    }

    /// $Q(p)$ in closed form.
    pub fn q(&self, p: c64) -> Mat<c64> {
        let form = &self.closed_form;
        let lag: Vec<c64> = form
            .scales
            .iter()
            .map(|scale| {
                let z = p * scale;
                let lost: c64 = form
                    .a
                    .iter()
                    .zip(&form.poles)
                    .map(|(a, b)| z * *a / (z + *b))
                    .sum();
                c64::new(1.0, 0.0) - lost
            })
            .collect();
        Mat::from_fn(26, 26, |i, j| {
            let circulatory: c64 = lag
                .iter()
                .enumerate()
                .map(|(s, c)| c * form.l[(i, s)] * (p * form.w1[(j, s)] + form.w0[(j, s)]))
                .sum();
            p * (p * form.b2[(i, j)] + form.b1[(i, j)]) + form.b0[(i, j)] + circulatory
        })
    }

    /// Coefficients of $U/50$, $50/U$, $(50/U)^3$ in $C(U)$.
    pub fn damping_powers(&self) -> &[Mat<f64>; 3] {
        &self.damping
    }

    pub fn truth(&self) -> &[Value] {
        self.file["truth"].as_array().unwrap()
    }
}

/// Least squares of the damping matrices at all speeds.
fn damping_powers(file: &Value) -> [Mat<f64>; 3] {
    let truth = file["truth"].as_array().unwrap();
    let speeds: Vec<f64> = truth.iter().map(|t| number(&t["U"])).collect();
    let given: Vec<Mat<f64>> = truth.iter().map(|t| matrix(&t["C"])).collect();
    let basis = |u: f64| [u / 50.0, 50.0 / u, (50.0 / u).powi(3)];
    let normal = Mat::from_fn(3, 3, |i, j| {
        speeds
            .iter()
            .map(|&u| basis(u)[i] * basis(u)[j])
            .sum::<f64>()
    });
    let lu = normal.partial_piv_lu();
    let mut powers = [0; 3].map(|_| Mat::zeros(26, 26));
    for i in 0..26 {
        for j in 0..26 {
            let rhs = Mat::from_fn(3, 1, |row, _| {
                let pairs = speeds.iter().zip(&given);
                pairs.map(|(&u, c)| basis(u)[row] * c[(i, j)]).sum::<f64>()
            });
            let solved = faer::linalg::solvers::Solve::solve(&lu, rhs);
            for (power, matrix) in powers.iter_mut().enumerate() {
                matrix[(i, j)] = solved[(power, 0)];
            }
        }
    }
    powers
}

impl Structure for Wing {
    fn modes(&self) -> &[String] {
        &self.modes
    }

    fn rigid_modes(&self) -> Vec<usize> {
        (0..6).collect()
    }

    fn at(&self, point: &OperatingPoint) -> StructuralMatrices {
        let u = point.airspeed;
        let weights = [u / 50.0, 50.0 / u, (50.0 / u).powi(3)];
        StructuralMatrices {
            mass: self.mass.clone(),
            damping: Mat::from_fn(26, 26, |i, j| {
                (0..3)
                    .map(|power| self.damping[power][(i, j)] * weights[power])
                    .sum()
            }),
            stiffness: self.stiffness.clone(),
            hysteretic: None,
            flight_path: None,
        }
    }
}

/// Points at constant density.
pub fn speeds(values: impl IntoIterator<Item = f64>, density: f64) -> Vec<OperatingPoint> {
    values
        .into_iter()
        .map(|speed| OperatingPoint::new(speed, density))
        .collect()
}

/// Evenly spaced values, both ends included.
pub fn range(from: f64, to: f64, count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |i| from + (to - from) * i as f64 / (count - 1) as f64)
}
