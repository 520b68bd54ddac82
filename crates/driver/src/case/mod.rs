//! The case file: what is computed, at which conditions, and what is swept.

mod aerodynamics;
mod check;
mod check_structure;
mod check_sweep;
mod flight;
mod keys;
mod one_or_many;
mod source;
mod structure;
mod structure_edits;
mod suggest;

pub use aerodynamics::{
    AnalyticMode, Axis, ControlMode, Flow, Gaf, Mesh, Modes, Reference, Rotation, SolverChoice,
    Term, TrailingEdges, Wake, WakeDirection, WakeMode,
};
pub use flight::{Fit, Flight, PkDamping, Range, Refine, Speeds, Stability, Thrust, Trim};
pub use one_or_many::OneOrMany;
pub use source::Places;
pub use structure::{
    DampingModel, Inertia, Matrices, OtherSymmetry, RigidBody, ShapeChange, Structure, Units,
};
pub use structure_edits::{AddedMass, Carrier, HingeChange, ModeOverride, TransferChoice};

use crate::failure::Failure;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// A case as written, before anything is read that it names.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Heading of reports.
    #[serde(default)]
    pub title: String,
    /// Reference lengths.
    pub reference: Reference,
    /// Free stream.
    #[serde(default)]
    pub flow: Flow,
    /// Wetted surface; not needed with `gaf.file`.
    pub mesh: Option<Mesh>,
    /// Wake.
    #[serde(default)]
    pub wake: Wake,
    /// Structure.
    pub structure: Option<Structure>,
    /// Modes given by formulae.
    #[serde(default)]
    pub modes: Modes,
    /// Gravity, drag, thrust.
    pub flight: Option<Flight>,
    /// Grid of the generalised aerodynamic forces, or their file.
    pub gaf: Gaf,
    /// What is swept.
    pub stability: Option<Stability>,
}

/// A case with the places its keys came from.
#[derive(Clone, Debug)]
pub struct CaseFile {
    /// The values.
    pub case: Case,
    /// Where each key stands.
    pub places: Places,
    /// The file's stem, or its folder's name for `case.toml`.
    pub name: String,
    folder: PathBuf,
    path: PathBuf,
}

impl CaseFile {
    /// Reads, overrides and checks a case.
    ///
    /// `path` is a TOML file or a folder that holds `case.toml`; `overrides`
    /// are `key=value`.
    ///
    /// # Errors
    /// Missing file, invalid TOML, unknown keys, wrong kinds of values, values
    /// that make a computation meaningless: each with file and line.
    pub fn read(path: &Path, overrides: &[String]) -> Result<Self, Failure> {
        let file = case_path(path)?;
        let text = std::fs::read_to_string(&file).map_err(|error| unreadable(&file, &error))?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let (root, places) = source::parse(&file, text, overrides)?;
        let case = Case::deserialize(toml::de::Deserializer::from(root))
            .map_err(|error| source::wrong_value(&error, &places))?;
        let folder = file.parent().unwrap_or(Path::new("")).to_owned();
        let read = Self {
            case,
            places,
            name: case_name(&file),
            folder,
            path: file,
        };
        check::check(&read)?;
        Ok(read)
    }

    /// The case file itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// A path of the case file, which counts from the case file's folder.
    pub fn resolve(&self, path: &Path) -> PathBuf {
        self.folder.join(path)
    }

    /// The same, refused with the key's place when there is no such file.
    ///
    /// # Errors
    /// [`Failure`] of kind input when the file is missing.
    pub fn existing(&self, key: &str, path: &Path) -> Result<PathBuf, Failure> {
        let full = self.resolve(path);
        if full.is_file() {
            return Ok(full);
        }
        Err(Failure::input(
            format!("the file `{}` of `{key}` is not there", path.display()),
            format!("{}: looked for {}", self.places.of(key), full.display()),
            "the computation cannot start without it",
            "correct the path; it counts from the folder of the case file",
        ))
    }

    /// Folder of the cache when none is given.
    pub fn default_cache(&self) -> PathBuf {
        self.folder.join(".fladder").join("gaf")
    }
}

fn case_path(path: &Path) -> Result<PathBuf, Failure> {
    if path.is_dir() {
        let file = path.join("case.toml");
        if file.is_file() {
            return Ok(file);
        }
        return Err(missing(path, "this folder holds no case.toml"));
    }
    if path.is_file() {
        return Ok(path.to_owned());
    }
    Err(missing(path, "there is no such case file or folder"))
}

fn missing(path: &Path, what: &str) -> Failure {
    Failure::input(
        what,
        path.display().to_string(),
        "the case says what is to be computed",
        "give a TOML file or a folder with case.toml, for example cases/wing",
    )
}

fn unreadable(file: &Path, error: &std::io::Error) -> Failure {
    Failure::input(
        format!("the case file cannot be read: {error}"),
        file.display().to_string(),
        "the case says what is to be computed",
        "check that it is a UTF-8 text file you may read",
    )
}

fn case_name(file: &Path) -> String {
    let absolute = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    let is_default = absolute.file_name().is_some_and(|name| name == "case.toml");
    let named = if is_default {
        absolute.parent()
    } else {
        Some(absolute.as_path())
    };
    let stem = named.and_then(|path| {
        if is_default {
            path.file_name()
        } else {
            path.file_stem()
        }
    });
    stem.map_or_else(
        || "case".to_owned(),
        |stem| stem.to_string_lossy().into_owned(),
    )
}
