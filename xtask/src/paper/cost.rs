//! What section 5.4 counts: forces, sweep, one more frequency.

use std::path::Path;
use std::time::{Duration, Instant};

use faer::c64;
use fladder::study::Study;
use fladder_stability::Method;
use serde::{Deserialize, Serialize};

use super::PaperError;
use super::words::{Table, number};
use super::work::open;

/// Frequencies that the paper's time is for.
const FREQUENCIES: usize = 21;
/// Values between them, for the time of one.
const MORE: usize = 100;
/// The paper's sweep.
const SWEEP: [&str; 2] = [
    "stability.speed={ from = 20.0, to = 75.0, count = 200 }",
    "stability.fit=literal",
];

/// Times in seconds.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Cost {
    /// Of the forces that were timed.
    key: String,
    machine: String,
    triangles: usize,
    wake_elements: usize,
    /// Model and values at the paper's number of frequencies.
    pub(super) forces: f64,
    /// Largest memory of the process, bytes.
    memory: Option<u64>,
    /// One more frequency, one thread.
    pub(super) one_more: f64,
    /// The paper's sweep by p2.
    pub(super) sweep: f64,
    /// The same speeds refined by continuation.
    pub(super) refined: f64,
    modes: usize,
}

impl Cost {
    /// Measured now; where the forces came from the cache, they are computed once more.
    pub(super) fn measure(study: &Study, case: &Path, mesh: &Path) -> Result<Self, PaperError> {
        let transfer = study.transfer();
        let largest = study.file().case.gaf.k.last().copied().unwrap_or(1.0);
        let values = |count: usize| -> Result<f64, PaperError> {
            let start = Instant::now();
            for i in 0..count {
                let k = largest * (i as f64 + 0.5) / count as f64;
                transfer.q(c64::new(0.0, k))?;
            }
            Ok(start.elapsed().as_secs_f64())
        };
        let one_more = values(MORE)? / MORE as f64;
        let grid = values(FREQUENCIES)?;
        let (model, memory) = match study.effort() {
            Some(effort) => effort,
            None => forces_again(case, mesh)?,
        };
        let model = model.as_secs_f64();
        let set = SWEEP.map(str::to_owned);
        eprintln!("200 speeds with 42 rectangles");
        let sweep = study.sweep(&set, Method::Unrefined)?.time.as_secs_f64();
        eprintln!("200 speeds by continuation");
        let refined = study.sweep(&set[..1], Method::Refined)?.time.as_secs_f64();
        let sizes = &study.solution().sizes;
        Ok(Self {
            key: study.key(),
            machine: crate::bench::machine(),
            triangles: sizes.triangles,
            wake_elements: sizes.wake_elements,
            forces: model + grid,
            memory,
            one_more,
            sweep,
            refined,
            modes: study.swept_modes(),
        })
    }

    /// Those of an earlier run with the same forces on the same machine.
    pub(super) fn kept(file: &Path, study: &Study) -> Option<Self> {
        let text = std::fs::read_to_string(file).ok()?;
        let kept: Self = serde_json::from_str(&text).ok()?;
        let is_same = kept.key == study.key() && kept.machine == crate::bench::machine();
        is_same.then_some(kept)
    }

    /// Beside the paper's.
    pub(super) fn table(&self) -> Table {
        let mut table = Table::new(&[
            "",
            "paper, four cores of 2006",
            &format!("here, {}", self.machine),
        ]);
        let memory = self.memory.map_or_else(String::new, |bytes| {
            format!(", {:.1} GB", bytes as f64 / 1e9)
        });
        let seconds = |time: f64| format!("{} s", number(time));
        for row in [
            [
                "surface; wake".to_owned(),
                "34 000 triangles; 134 000".to_owned(),
                format!("{} triangles; {}", self.triangles, self.wake_elements),
            ],
            [
                "Q at 21 frequencies".to_owned(),
                "17 min".to_owned(),
                format!("{}{memory}", seconds(self.forces)),
            ],
            [
                format!("p2 at 200 speeds, 42 rectangles, {} modes", self.modes),
                "20 s (26 modes)".to_owned(),
                seconds(self.sweep),
            ],
            [
                "the same speeds, refined by continuation and counted".to_owned(),
                "–".to_owned(),
                seconds(self.refined),
            ],
            [
                "one more frequency from what is stored".to_owned(),
                "as much as each before".to_owned(),
                format!("{} ms, one thread", number(1e3 * self.one_more)),
            ],
        ] {
            table.push(row);
        }
        table
    }
}

/// Time and memory of the forces, computed into a cache of their own.
fn forces_again(case: &Path, mesh: &Path) -> Result<(Duration, Option<u64>), PaperError> {
    eprintln!("forces once more, for their time");
    let fresh = tempfile::tempdir().map_err(|source| PaperError::File {
        path: std::env::temp_dir(),
        source,
    })?;
    let study = open(case, mesh, fresh.path(), &[])?;
    Ok(study.effort().unwrap_or_default())
}
