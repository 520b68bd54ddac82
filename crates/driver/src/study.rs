//! A case for a program that asks more than one question of it: forces once, then $Q$
//! anywhere and any number of sweeps.
//!
//! ```no_run
//! use fladder::study::Study;
//! use fladder_stability::Method;
//!
//! let study = Study::open("cases/scaneagle".as_ref(), &[], None)?;
//! let slow = study.sweep(&["stability.speed={ from = 20.0, to = 30.0, count = 11 }".into()], Method::Both)?;
//! println!("{:.1} s", slow.time.as_secs_f64());
//! # Ok::<(), fladder::failure::Failure>(())
//! ```

use crate::cache::Cache;
use crate::case::CaseFile;
use crate::chain::aircraft::Aircraft;
use crate::chain::forces::{self, Forces};
use crate::chain::own_forces::{self, Origin, OwnForces};
use crate::chain::sweep as sweeping;
use crate::failure::Failure;
use crate::terminal::{Console, warn};
use fladder_bem::{Solution, TransferModel};
use fladder_mesh::{SurfaceMode, TriMesh};
use fladder_modal::{RigidBody, StructuralModel};
use fladder_stability::{Method, SweepResult};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A case whose forces are computed here, with these forces.
pub struct Study {
    path: PathBuf,
    overrides: Vec<String>,
    file: CaseFile,
    aircraft: Aircraft,
    own: OwnForces,
}

/// Outcome of a sweep.
#[derive(Clone, Debug)]
pub struct Swept {
    /// Roots, crossings, rigid motions.
    pub result: SweepResult,
    /// What the eigenproblems, their tracking and the crossings took.
    pub time: Duration,
}

impl Study {
    /// Reads case and files; forces come from the cache, or are computed and stored.
    ///
    /// `overrides` are `key=value`; without `cache` it is that of the case.
    ///
    /// # Errors
    /// All that `fladder gaf` refuses.
    pub fn open(
        path: &Path,
        overrides: &[String],
        cache: Option<&Path>,
    ) -> Result<Self, Failure> {
        let file = CaseFile::read(path, overrides)?;
        if forces::are_given(&file) {
            return Err(Failure::input(
                "the forces of this case come from `gaf.file`",
                file.places.of("gaf.file"),
                "they cannot be evaluated between the samples of the file",
                "remove gaf.file and give [mesh]",
            ));
        }
        let aircraft = Aircraft::read(&file)?;
        let folder = cache.map_or_else(|| file.default_cache(), Path::to_owned);
        let (cache, warning) = Cache::open(&folder);
        if let Some(warning) = warning {
            warn(warning);
        }
        let own = own_forces::obtain(&file, &aircraft, &cache, &Console::new(true))?;
        Ok(Self {
            path: path.to_owned(),
            overrides: overrides.to_vec(),
            file,
            aircraft,
            own,
        })
    }

    /// Roots over the speeds of the case, under further overrides; they must leave the
    /// forces as they are.
    ///
    /// # Errors
    /// Overrides that the case or the sweep refuses, or under which the forces are others.
    pub fn sweep(&self, overrides: &[String], method: Method) -> Result<Swept, Failure> {
        let mut all = self.overrides.clone();
        all.extend_from_slice(overrides);
        let file = CaseFile::read(&self.path, &all)?;
        let key = own_forces::key(&file, &own_forces::problem(&file, &self.aircraft));
        if key != self.own.key {
            return Err(Failure::input(
                "the overrides of a sweep change the aerodynamic problem",
                overrides.join(", "),
                "the forces at hand are those of another problem",
                "open the study with these overrides",
            ));
        }
        let assembled = forces::assemble(&file, &self.aircraft, self.own.clone())?;
        let forces = Forces::own(&file, &self.aircraft, &assembled.own, &assembled.document)?;
        let console = Console::new(true);
        let swept = sweeping::run(&file, &self.aircraft.structure, &forces, method, &console)?;
        Ok(Swept {
            result: swept.result,
            time: swept.time,
        })
    }

    /// The case with its overrides.
    pub fn file(&self) -> &CaseFile {
        &self.file
    }

    /// Place of the forces in the cache: a hash of all that enters them.
    pub fn key(&self) -> String {
        self.own.key.to_hex()
    }

    /// What the forces took, and the most memory the process held, where it is told;
    /// none where they were in the cache.
    pub fn effort(&self) -> Option<(Duration, Option<u64>)> {
        match &self.own.origin {
            Origin::Computed(effort) => Some((effort.total(), effort.peak_bytes)),
            Origin::Cache => None,
        }
    }

    /// The wetted surface.
    pub fn mesh(&self) -> &TriMesh {
        &self.aircraft.surface.mesh
    }

    /// Modes of $Q$ in order: rigid, elastic, then those of formulae and controls.
    pub fn modes(&self) -> &[SurfaceMode] {
        self.aircraft.asked_modes()
    }

    /// How many of them, from the first on, are degrees of freedom of the sweeps.
    pub fn swept_modes(&self) -> usize {
        self.aircraft.swept_modes(&self.file)
    }

    /// The structure with its elastic modes, where there is a result file.
    pub fn structure(&self) -> Option<&StructuralModel> {
        self.aircraft.structure.model.as_ref()
    }

    /// Mass properties of the rigid modes, where there are such.
    pub fn body(&self) -> Option<&RigidBody> {
        self.aircraft.structure.body.as_ref()
    }

    /// Steady flow, sizes, and the transfer model.
    pub fn solution(&self) -> &Solution {
        &self.own.stored.solution
    }

    /// $Q$ anywhere in the Laplace plane.
    pub fn transfer(&self) -> &TransferModel {
        &self.solution().transfer
    }
}
