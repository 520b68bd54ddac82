//! `cargo xtask paper`: section 5 of D. Eller, IFASD-2009-119, with the ScanEagle-like
//! aircraft.
//!
//! Figures, tables and a page into a folder; with `--docs` into the manual as well.

mod compare;
mod cost;
mod crossings;
mod fit;
mod incidence;
mod output;
mod published;
mod roots;
mod stills;
mod tables;
mod variants;
mod words;
mod work;

use std::path::{Path, PathBuf};

use clap::Args;
use fladder::failure::Failure;

use compare::Row;
use cost::Cost;
use output::Chapter;
use published::Published;
use work::{FAST, Work, at, dutch_roll, nearest};

/// The case and the chapter of the manual.
const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../cases/scaneagle");
const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs");

/// The paper's surface has about so many.
const PAPER_TRIANGLES: usize = 34_000;

/// What is reproduced.
#[derive(Args)]
pub(crate) struct Paper {
    /// 3k or 10k (in meshes/), 34k (made where it is not there), or a mesh file
    #[arg(long, default_value = "10k")]
    mesh: String,
    /// Folder of the results
    #[arg(long, default_value = "target/paper")]
    out: PathBuf,
    /// Folder of the cache [default: cache in the folder of the results]
    #[arg(long)]
    cache: Option<PathBuf>,
    /// The case
    #[arg(long, default_value = CASE)]
    case: PathBuf,
    /// Number of threads [default: all cores]
    #[arg(long)]
    threads: Option<usize>,
    /// Measure the times anew, also those of an earlier run with the same forces
    #[arg(long)]
    again: bool,
    /// Write tables and some figures into docs/paper.md and docs/images
    #[arg(long)]
    docs: bool,
}

/// Why nothing was reproduced.
#[derive(Debug, thiserror::Error)]
pub(crate) enum PaperError {
    #[error(transparent)]
    Failure(#[from] Failure),
    #[error(transparent)]
    Mesh(#[from] crate::scaneagle::ScanEagleError),
    #[error("no value of Q: {0}")]
    Value(#[from] fladder_bem::LaplaceError),
    #[error("the samples of figure 1 make no table: {0}")]
    Table(#[from] fladder_stability::GafError),
    #[error("the samples of figure 1 cannot be fitted: {0}")]
    Fit(#[from] fladder_stability::FitError),
    #[error("the paper's numbers cannot be read: {0}")]
    Numbers(#[from] toml::de::Error),
    #[error("the paper's numbers have no `{0}`")]
    Unknown(&'static str),
    #[error("the times cannot be kept: {0}")]
    Times(#[from] serde_json::Error),
    #[error("the threads could not be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    #[error("{}: {source}", path.display())]
    File {
        path: PathBuf,
        source: std::io::Error,
    },
}

impl Paper {
    /// Computes, writes, prints the comparison.
    pub(crate) fn run(&self) -> Result<(), PaperError> {
        // As the program itself: work is divided outside of matrix operations.
        faer::set_global_parallelism(faer::Par::Seq);
        if let Some(threads) = self.threads {
            rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build_global()?;
        }
        let published = Published::read()?;
        output::make(&self.out)?;
        let cache = self.cache.clone().unwrap_or_else(|| self.out.join("cache"));
        let mesh = work::mesh_file(&self.mesh, &self.out)?;
        eprintln!("forces on {}", mesh.display());
        let study = work::open(&self.case, &mesh, &cache, &[])?;
        let times = self.out.join("cost.json");
        let cost = match Cost::kept(&times, &study) {
            Some(cost) if !self.again => cost,
            _ => Cost::measure(&study, &self.case, &mesh)?,
        };
        output::write(&times, serde_json::to_string_pretty(&cost)? + "\n")?;
        let work = Work::new(study)?;
        eprintln!("figures");
        let mut chapter = chapter(&work, &published, &cost)?;
        chapter.variants = variants::table(&self.case, &self.out, &cache, &published)?;
        chapter.write(&self.out)?;
        if self.docs {
            chapter.document(Path::new(DOCS))?;
        }
        println!("{}", chapter.comparison().text());
        println!("{}", self.out.join("paper.html").display());
        Ok(())
    }
}

fn chapter(work: &Work, published: &Published, cost: &Cost) -> Result<Chapter, PaperError> {
    let mut chapter = Chapter::new(&work.study);
    let (picture, entry, error) = fit::figure(work)?;
    chapter.figure("figure_01", picture);
    chapter.fit = (entry, error);
    for (name, picture) in [
        ("figure_02_mesh", stills::mesh(work)),
        ("figure_03_structure", stills::structure(work)),
    ] {
        if let Some(picture) = picture {
            chapter.figure(name, picture);
        }
    }
    chapter.rows = modes(work, published, &mut chapter)?;
    let [locus, diagram] = roots::figure_8(work, &chapter.conditions);
    chapter.figure("figure_08", locus);
    chapter.figure("figure_08_vg", diagram);
    chapter.figure("figure_09", roots::figure_9(work));
    let (picture, claims) = incidence::figure(work)?;
    chapter.figure("figure_10", picture);
    chapter.claims = claims;
    chapter.rows.extend(motions(work, published)?);
    // A time on a smaller surface is none for the paper's.
    let is_as_large = work.study.mesh().triangles.len() >= PAPER_TRIANGLES;
    if is_as_large {
        let value = published.get("cost_forces")?;
        chapter.rows.push(Row::new(value, Some(cost.forces)));
    }
    let value = published.get("cost_sweep")?;
    chapter.rows.push(Row::new(value, Some(cost.sweep)));
    chapter.crossings = crossings::table(work);
    chapter.dutch = tables::dutch(work, published)?;
    chapter.longitudinal = tables::longitudinal(work, published)?;
    chapter.cost = cost.table();
    Ok(chapter)
}

/// Figures 4 to 7 and the frequencies in them.
fn modes(
    work: &Work,
    published: &Published,
    chapter: &mut Chapter,
) -> Result<Vec<Row>, PaperError> {
    let values = ["mode_1", "mode_2", "mode_3", "mode_4"]
        .into_iter()
        .map(|id| published.get(id))
        .collect::<Result<Vec<_>, _>>()?;
    let wanted: Vec<f64> = values.iter().map(|value| value.value).collect();
    let mut rows = Vec::new();
    for (number, (value, mode)) in
        (4..).zip(values.iter().zip(stills::nearest_modes(work, &wanted)))
    {
        rows.push(Row::new(value, mode.map(|mode| mode.frequency_hz)));
        let paper = format!("{}, {} Hz", value.quantity, value.value);
        let picture = mode.and_then(|mode| stills::mode(work, number, mode, &paper));
        let name = format!("figure_{number:02}_mode");
        if let Some(picture) = picture {
            chapter.figure(&name, picture);
        }
    }
    Ok(rows)
}

/// Flutter, Dutch roll, longitudinal motion, roll with bending.
fn motions(work: &Work, published: &Published) -> Result<Vec<Row>, PaperError> {
    let mut rows = Vec::new();
    let mut add = |id, here| -> Result<(), PaperError> {
        rows.push(Row::new(published.get(id)?, here));
        Ok(())
    };
    let flutter = crossings::of_the_kind(work, published)?;
    add("flutter_speed", flutter.map(|crossing| crossing.speed))?;
    add(
        "flutter_frequency",
        flutter.map(|crossing| crossing.frequency_hz),
    )?;
    add("flutter_k", flutter.map(|crossing| crossing.k))?;
    let first = crossings::elastic(work).next();
    add("flutter_first", first.map(|crossing| crossing.speed))?;
    let methods = &work.main.methods;
    let (p2, pk) = (methods.p2.as_ref(), methods.pk.as_ref());
    let period = published.get("dutch_period_p2")?.value;
    let by_p2 = p2.and_then(|p2| dutch_roll(&p2.flight_modes, period));
    add("dutch_period_p2", by_p2.and_then(|motion| motion.period))?;
    let period = published.get("dutch_period_pk")?.value;
    let by_pk = pk.and_then(|pk| dutch_roll(&pk.flight_modes, period));
    add("dutch_period_pk", by_pk.and_then(|motion| motion.period))?;
    let time = |sigma: f64| std::f64::consts::LN_2 / sigma;
    add("dutch_growth", by_p2.map(|motion| time(motion.sigma)))?;
    let period = published.get("longitudinal_period")?.value;
    for (id, swept) in [
        ("longitudinal_period", &work.without_speed),
        ("longitudinal_period_with", &work.with_speed),
    ] {
        let p2 = swept.methods.p2.as_ref();
        let found = p2.and_then(|p2| work::longitudinal(&p2.flight_modes, period));
        add(id, found.and_then(|motion| motion.period))?;
    }
    let frequency = published.get("roll_bending")?.value;
    let found = p2.and_then(|p2| {
        let those = at(&p2.flight_modes, FAST);
        let those =
            those.filter(|motion| ["roll", "coupled, lateral"].contains(&motion.motion));
        nearest(those, 1.0 / frequency)
    });
    add(
        "roll_bending",
        found.and_then(|motion| motion.period.map(|period| 1.0 / period)),
    )?;
    Ok(rows)
}

#[cfg(test)]
mod tests;
