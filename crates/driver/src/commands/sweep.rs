//! `fladder sweep`: roots from forces that are there.

use super::Session;
use crate::cache::Cache;
use crate::case::CaseFile;
use crate::chain::aircraft::Aircraft;
use crate::chain::conditions::Conditions;
use crate::chain::forces::{self, Forces};
use crate::chain::own_forces::{self, OwnForces};
use crate::chain::structure::StructureData;
use crate::chain::sweep as sweeping;
use crate::cli::Method;
use crate::failure::Failure;
use crate::report;
use std::path::Path;

pub(crate) fn sweep(
    session: &Session,
    path: &Path,
    json: Option<&Path>,
    method: Method,
) -> Result<(), Failure> {
    let file = session.case(path)?;
    let console = &session.console;
    let speeds = Conditions::of(&file)?.speeds();
    let (structure, forces) = if forces::are_given(&file) {
        let structure = StructureData::read(&file)?;
        let forces = Forces::given(&file, &structure)?;
        (structure, forces)
    } else {
        let aircraft = Aircraft::read(&file)?;
        let own = stored(session, path, &file, &aircraft)?;
        let assembled = forces::assemble(&file, &aircraft, own)?;
        console.say(format!(
            "forces at {} points from the cache, key {}",
            assembled.document.points.len(),
            assembled.own.key.to_hex()
        ));
        let forces = Forces::own(&file, &aircraft, &assembled.own, &assembled.document)?;
        (aircraft.structure, forces)
    };
    console.notes(&forces.notes);
    let result = sweeping::run(&file, &structure, &forces, method, console)?.result;
    if let Some(json) = json {
        session.write_json(json, &result)?;
    }
    report::roots(console, &result, &speeds);
    Ok(())
}

/// The options that enter the key or name the cache, as they were given.
fn options(session: &Session) -> String {
    let cache = session
        .common
        .cache
        .iter()
        .map(|folder| format!(" --cache {}", folder.display()));
    let set = session
        .common
        .set
        .iter()
        .map(|given| format!(" --set '{given}'"));
    cache.chain(set).collect()
}

/// The forces of the case from the cache; refused where they are not there.
pub(super) fn stored(
    session: &Session,
    path: &Path,
    file: &CaseFile,
    aircraft: &Aircraft,
) -> Result<OwnForces, Failure> {
    let folder = session.cache_folder(file);
    let key = own_forces::key(file, &own_forces::problem(file, aircraft));
    own_forces::cached(&Cache::existing(&folder), key).ok_or_else(|| {
        Failure::input(
            format!(
                "the forces of this case are not in the cache (key {})",
                key.to_hex()
            ),
            folder.display().to_string(),
            "`sweep` never computes forces: it would take minutes where seconds are expected",
            format!(
                "make them with `fladder gaf {}{}`",
                path.display(),
                options(session)
            ),
        )
    })
}
