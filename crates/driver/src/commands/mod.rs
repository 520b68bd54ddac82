//! One file a command.

mod cache;
mod check;
mod gaf;
mod modes;
mod new;
mod results;
mod run;
mod sweep;

pub(crate) use cache::cache;
pub(crate) use check::check;
pub(crate) use gaf::gaf;
pub(crate) use modes::{Wanted as WantedModes, modes};
pub(crate) use new::new;
pub(crate) use run::{report, run};
pub(crate) use sweep::sweep;

use crate::cache::Cache;
use crate::case::CaseFile;
use crate::chain::aircraft::Aircraft;
use crate::chain::derivatives::Derivatives;
use crate::chain::own_forces::{self, OwnForces};
use crate::cli::Common;
use crate::failure::Failure;
use crate::files;
use crate::json;
use crate::report as reports;
use crate::terminal::{Console, warn};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Options and output of one call of the program.
pub(crate) struct Session {
    pub(crate) common: Common,
    pub(crate) console: Console,
}

impl Session {
    fn case(&self, path: &Path) -> Result<CaseFile, Failure> {
        let file = CaseFile::read(path, &self.common.set)?;
        let title = &file.case.title;
        if !title.is_empty() {
            self.console.say(title);
        }
        Ok(file)
    }

    fn cache_folder(&self, file: &CaseFile) -> PathBuf {
        self.common
            .cache
            .clone()
            .unwrap_or_else(|| file.default_cache())
    }

    fn open_cache(&self, file: &CaseFile) -> Cache {
        let (cache, warning) = Cache::open(&self.cache_folder(file));
        if let Some(warning) = warning {
            warn(warning);
        }
        cache
    }

    fn results_folder(&self, file: &CaseFile) -> PathBuf {
        self.common
            .out
            .clone()
            .unwrap_or_else(|| Path::new("results").join(&file.name))
    }

    /// Prints derivatives, where the case gives the lengths for them, and writes them
    /// into the folder, where there is one.
    fn derivatives(
        &self,
        file: &CaseFile,
        aircraft: &Aircraft,
        own: &OwnForces,
        out: Option<&Path>,
    ) -> Result<(), Failure> {
        let found = Derivatives::of(file, aircraft, &own.stored)
            .map_err(|error| own_forces::not_evaluated(&error))?;
        let Some(found) = found else {
            self.console
                .say("no derivatives: they need area, span and chord in [reference]");
            return Ok(());
        };
        reports::derivatives(&self.console, file, &found);
        let Some(out) = out else { return Ok(()) };
        let document = reports::derivatives_document(file, &found);
        self.write_json(&out.join("derivatives.json"), &document)?;
        self.write(
            &out.join("derivatives.csv"),
            reports::derivatives_csv(&found),
        )
    }

    fn write(&self, path: &Path, content: impl AsRef<[u8]>) -> Result<(), Failure> {
        files::write(path, content)?;
        self.console.say(format!("wrote {}", path.display()));
        Ok(())
    }

    fn write_json<T: Serialize>(&self, path: &Path, value: &T) -> Result<(), Failure> {
        let text = json::text(value).map_err(|error| {
            Failure::numerical(
                format!("the result cannot be written as JSON: {error}"),
                path.display().to_string(),
                "the file would be incomplete",
                "please report this with the case file and the command",
            )
        })?;
        self.write(path, text)
    }
}
