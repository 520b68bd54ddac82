//! `cargo xtask bench`: speed and memory, into `benches/RESULTS.md`.
//!
//! Ratios are of one run: the kernel against its scalar twin, the factorisation against the
//! matrix product. Growth is measured on the meshes that are given, coarse ones first,
//! because a process's largest memory never falls.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use clap::Args;
use faer::c64;
use fladder_bem::Solution;
use fladder_bem::pieces::{Factorisation, Instructions, PanelPairs};
use fladder_mesh::shapes::NacaWing;
use fladder_tests::aircraft::Aircraft;
use fladder_tests::case::Fault;

/// Order of the matrix that is factorised.
const ORDER: usize = 8192;
/// Largest number of elastic modes of the case.
const ELASTIC: usize = 20;
/// Values of p between the grid's, for the time of one more.
const VALUES: usize = 200;

/// What is measured.
#[derive(Args)]
pub(crate) struct Bench {
    /// Meshes of the ScanEagle-like surface, coarse to fine
    #[arg(default_values_t = default_meshes().map(|m| m.display().to_string()))]
    meshes: Vec<String>,
    /// The document
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../benches/RESULTS.md"))]
    out: PathBuf,
}

fn default_meshes() -> [PathBuf; 2] {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../meshes");
    ["scaneagle_3k.msh", "scaneagle_10k.msh"].map(|name| folder.join(name))
}

/// Why nothing was measured.
#[derive(Debug, thiserror::Error)]
pub(crate) enum BenchError {
    #[error(transparent)]
    Fault(#[from] Fault),
    #[error("no value of Q: {0}")]
    Value(#[from] fladder_bem::LaplaceError),
    #[error("no wing to measure the kernel on: {0}")]
    Wing(#[from] fladder_mesh::shapes::ShapeError),
    #[error("cannot write {}: {source}", path.display())]
    Write {
        path: PathBuf,
        source: std::io::Error,
    },
}

impl Bench {
    /// Measures, prints and writes.
    pub(crate) fn run(&self) -> Result<(), BenchError> {
        let mut text = heading();
        kernel(&mut text)?;
        factorisation(&mut text);
        self.growth(&mut text)?;
        print!("{text}");
        std::fs::write(&self.out, text).map_err(|source| BenchError::Write {
            path: self.out.clone(),
            source,
        })
    }

    fn growth(&self, text: &mut String) -> Result<(), BenchError> {
        text.push_str(
            "\n## From mesh and modes to Q\n\n\
             26 modes, incidence of the case, whole model; the solver is dense up to 20 000 \
             vertices and hierarchical beyond. The paper (Eller, IFASD-2009-119, section \
             5.4): 34 000 triangles, 134 000 wake elements, 17 minutes for 21 frequencies on \
             four cores.\n\n\
             | mesh | triangles | unknowns | wake elements | model | 21 values | 200 more | one \
             value | memory |\n|---|---|---|---|---|---|---|---|---|\n",
        );
        for mesh in &self.meshes {
            let mut aircraft = Aircraft::read(Path::new(mesh), ELASTIC)?;
            aircraft.modes.retain(|mode| {
                mode.name.starts_with("rigid") || mode.name.starts_with("elastic")
            });
            let start = Instant::now();
            let solution = aircraft.solve()?;
            let model = start.elapsed();
            let grid = values(&solution, 21, 1.5)?;
            let more = values(&solution, VALUES, 1.47)?;
            let name = Path::new(mesh).file_name().unwrap_or_default();
            let _ = writeln!(
                text,
                "| {} | {} | {} | {} | {:.1} s | {:.2} s | {:.2} s | {:.1} ms | {} |",
                name.to_string_lossy(),
                solution.sizes.triangles,
                solution.sizes.unknowns,
                solution.sizes.wake_elements,
                model.as_secs_f64(),
                grid.as_secs_f64(),
                more.as_secs_f64(),
                1e3 * more.as_secs_f64() / VALUES as f64,
                peak().map_or_else(
                    || "unknown".to_owned(),
                    |bytes| { format!("{:.2} GB", bytes / 1e9) }
                ),
            );
        }
        Ok(())
    }
}

/// Time of so many values of Q up to a reduced frequency, some of them damped; one after the
/// other.
fn values(solution: &Solution, count: usize, largest: f64) -> Result<Duration, BenchError> {
    let start = Instant::now();
    for i in 0..count {
        let k = largest * i as f64 / (count - 1) as f64;
        let g = if i % 3 == 2 { -0.02 } else { 0.0 };
        solution
            .transfer
            .q(c64::new(if k > 0.0 { g } else { 0.0 }, k))?;
    }
    Ok(start.elapsed())
}

fn heading() -> String {
    format!(
        "# Speed and memory\n\n\
         Written by `cargo xtask bench`. {}, {}, commit {}, release \
         profile without `target-cpu=native`. Times are of one run and those of a machine that \
         may have had other work; ratios are of the same run.\n",
        machine(),
        output("rustc", &["--version"]),
        output("git", &["rev-parse", "--short", "HEAD"]),
    )
}

fn output(program: &str, arguments: &[&str]) -> String {
    Command::new(program)
        .args(arguments)
        .output()
        .ok()
        .filter(|output| output.status.success())
        .map_or_else(
            || "unknown".to_owned(),
            |output| String::from_utf8_lossy(&output.stdout).trim().to_owned(),
        )
}

/// Threads and processor.
pub(crate) fn machine() -> String {
    let processor = std::fs::read_to_string("/proc/cpuinfo")
        .ok()
        .and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("model name"))?;
            Some(line.split_once(':')?.1.trim().to_owned())
        })
        .unwrap_or_else(|| "unknown processor".to_owned());
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{threads} threads of {processor}")
}

/// Shortest of several runs, by one evaluation.
fn shortest(mut run: impl FnMut()) -> Duration {
    const INNER: u32 = 200;
    (0..15)
        .map(|_| {
            let start = Instant::now();
            for _ in 0..INNER {
                run();
            }
            start.elapsed() / INNER
        })
        .min()
        .unwrap_or_default()
}

fn kernel(text: &mut String) -> Result<(), BenchError> {
    text.push_str(
        "\n## Panel integrals\n\n\
         D and S at the three corners of a triangle, seen from one point; one core.\n\n\
         | block | scalar | AVX2 | AVX-512 |\n|---|---|---|---|\n",
    );
    let mesh = NacaWing {
        n_chord: 16,
        n_half_span: 16,
        ..NacaWing::default()
    }
    .structured()?;
    for (name, distance) in [("far", 12.0), ("near", 1.0)] {
        let mut pairs = PanelPairs::new(&mesh, distance);
        let nanoseconds =
            |time: Duration, pairs: usize| 1e9 * time.as_secs_f64() / pairs as f64;
        let count = pairs.len();
        let scalar = nanoseconds(
            shortest(|| {
                std::hint::black_box(pairs.scalar());
            }),
            count,
        );
        let mut line = format!("| {name} | {scalar:.1} ns |");
        for instructions in [Instructions::Avx2, Instructions::Avx512] {
            if Instructions::available().contains(&instructions) {
                let time = nanoseconds(
                    shortest(|| {
                        std::hint::black_box(pairs.in_lanes(instructions));
                    }),
                    count,
                );
                let _ = write!(line, " {time:.1} ns, {:.1} times |", scalar / time);
            } else {
                line.push_str(" not here |");
            }
        }
        text.push_str(&line);
        text.push('\n');
    }
    Ok(())
}

fn factorisation(text: &mut String) {
    let matrix = Factorisation::new(ORDER);
    let best = |run: &dyn Fn()| {
        (0..3)
            .map(|_| {
                let start = Instant::now();
                run();
                start.elapsed().as_secs_f64()
            })
            .fold(f64::INFINITY, f64::min)
    };
    let product = matrix.product_flops() / best(&|| matrix.product());
    let factorised = matrix.flops() / best(&|| matrix.factorise());
    let _ = write!(
        text,
        "\n## Factorisation\n\n\
         Single precision, n = {ORDER}, all threads: {:.0} Gflop/s, {:.2} of the matrix product's \
         {:.0} Gflop/s.\n",
        factorised / 1e9,
        factorised / product,
        product / 1e9
    );
}

/// The most memory that the process has held, bytes.
fn peak() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024.0 * kibibytes)
}
