//! `fladder cache`: list, verify, prune.

use super::Session;
use crate::cache::{Cache, Listed};
use crate::case::CaseFile;
use crate::chain::own_forces::StoredForces;
use crate::cli::CacheAction;
use crate::failure::{Failure, Kind};
use crate::memory::bytes_in_words;
use crate::report;
use crate::terminal::{Align, Table};
use std::path::{Path, PathBuf};
use std::time::Duration;

const SECONDS_PER_DAY: u64 = 86_400;

pub(crate) fn cache(session: &Session, action: &CacheAction) -> Result<(), Failure> {
    let (CacheAction::List { case }
    | CacheAction::Verify { case }
    | CacheAction::Prune { case, .. }) = action;
    let folder = folder(session, case.as_deref())?;
    let cache = Cache::existing(&folder);
    session
        .console
        .answer(format!("cache {}", folder.display()));
    match action {
        CacheAction::List { .. } => list(session, &cache.list()?),
        CacheAction::Verify { .. } => return verify(session, &folder, &cache.list()?),
        CacheAction::Prune { older_than, .. } => {
            let age =
                older_than.map(|days| Duration::from_secs(u64::from(days) * SECONDS_PER_DAY));
            let (files, bytes) = cache.prune::<StoredForces>(age)?;
            session.console.answer(format!(
                "  removed {files} files, {}",
                bytes_in_words(bytes)
            ));
        }
    }
    Ok(())
}

/// Folder of `--cache`, of the case, or the default below the current folder.
fn folder(session: &Session, case: Option<&Path>) -> Result<PathBuf, Failure> {
    if let Some(folder) = &session.common.cache {
        return Ok(folder.clone());
    }
    match case {
        Some(case) => Ok(CaseFile::read(case, &session.common.set)?.default_cache()),
        None => Ok(Path::new(".fladder").join("gaf")),
    }
}

fn list(session: &Session, entries: &[Listed<StoredForces>]) {
    if entries.is_empty() {
        session.console.answer("  no entries");
        return;
    }
    let mut table = Table::new(&[
        ("key", Align::Left),
        ("size", Align::Right),
        ("date (UTC)", Align::Left),
        ("modes", Align::Right),
        ("triangles", Align::Right),
        ("Mach", Align::Right),
        ("alpha", Align::Right),
        ("beta", Align::Right),
    ]);
    for entry in entries {
        let name = || {
            entry
                .path
                .file_name()
                .map_or_else(String::new, |n| n.to_string_lossy().into_owned())
        };
        let key = entry.key.map_or_else(name, |key| key.short());
        let mut row = vec![key, bytes_in_words(entry.size), report::utc(entry.modified)];
        match &entry.content {
            Ok(stored) => row.extend([
                stored.solution.transfer.n_modes().to_string(),
                stored.solution.sizes.triangles.to_string(),
                stored.mach.to_string(),
                format!("{}°", stored.alpha_deg),
                format!("{}°", stored.beta_deg),
            ]),
            Err(_) => row.push("bad".to_owned()),
        }
        table.row(row);
    }
    session.console.answer(table.text());
}

fn verify(
    session: &Session,
    folder: &Path,
    entries: &[Listed<StoredForces>],
) -> Result<(), Failure> {
    let mut bad = Vec::new();
    for entry in entries {
        let name = entry.path.display();
        match &entry.content {
            Ok(_) => session.console.say(format!("  good  {name}")),
            Err(fault) => {
                session.console.answer(format!("  BAD   {name}: {fault}"));
                bad.push(entry.path.display().to_string());
            }
        }
    }
    if bad.is_empty() {
        session
            .console
            .answer(format!("  {} entries, all good", entries.len()));
        return Ok(());
    }
    let mut failure = Failure::input(
        format!("{} of {} entries are bad", bad.len(), entries.len()),
        folder.display().to_string(),
        "they are never used: their forces will be computed again",
        "remove them with `fladder cache prune`; if it happens again, look at the disk",
    );
    failure.kind = Kind::Io;
    Err(failure)
}
