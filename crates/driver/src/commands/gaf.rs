//! `fladder gaf`: forces into the cache, and on request into a file.

use super::Session;
use crate::case::CaseFile;
use crate::chain::aircraft::Aircraft;
use crate::chain::{forces, own_forces};
use crate::failure::Failure;
use crate::report;
use crate::terminal::Bar;
use faer::c64;
use std::path::Path;

pub(crate) fn gaf(
    session: &Session,
    path: &Path,
    json: Option<&Path>,
    at: &[[f64; 2]],
    vtu: Option<&Path>,
) -> Result<(), Failure> {
    let file = session.case(path)?;
    let console = &session.console;
    if forces::are_given(&file) {
        return Err(Failure::input(
            "the forces of this case come from `gaf.file`, there is nothing to compute",
            file.places.of("gaf.file"),
            "`gaf` computes forces on the mesh of the case",
            "use `fladder sweep`, or remove gaf.file and give [mesh]",
        ));
    }
    let aircraft = Aircraft::read(&file)?;
    report::surface(console, &aircraft.surface);
    report::structure(console, &aircraft.structure, aircraft.transfer.as_ref());
    report::transfer(console, aircraft.transfer.as_ref());
    let own = own_forces::obtain(&file, &aircraft, &session.open_cache(&file), console)?;
    report::own_forces(console, &file, &aircraft, &own);
    report::wake_jumps(console, &own.stored.solution.steady);
    report::steady_forces(console, &aircraft, &own.stored.solution.steady);
    session.derivatives(&file, &aircraft, &own, session.common.out.as_deref())?;
    if let Some(folder) = vtu {
        pictures(session, &file, &aircraft, at, folder)?;
    }
    if json.is_none() && at.is_empty() {
        return Ok(());
    }
    let points = if at.is_empty() {
        own_forces::grid(&file)
    } else {
        at.to_vec()
    };
    let samples = own_forces::samples(&aircraft, &own.stored, &points)?;
    if !at.is_empty() {
        for sample in &samples {
            report::sample(console, &aircraft.mode_names(), sample);
        }
    }
    match json {
        Some(json) => {
            let document = own_forces::document(&aircraft, &own.stored, samples);
            session.write_json(json, &document)
        }
        None => Ok(()),
    }
}

/// The flow on the surface for ParaView.
fn pictures(
    session: &Session,
    file: &CaseFile,
    aircraft: &Aircraft,
    at: &[[f64; 2]],
    folder: &Path,
) -> Result<(), Failure> {
    let problem = own_forces::problem(file, aircraft);
    let plan = fladder_bem::plan(&problem).map_err(|e| own_forces::unsolved(file, &e))?;
    let points: Vec<c64> = at.iter().map(|&[g, k]| c64::new(g, k)).collect();
    let bar = Bar::new(session.console.is_quiet());
    let flow = fladder_bem::surface_flow(&problem, &points, &bar)
        .map_err(|error| own_forces::unsolved(file, &error))?;
    bar.clear();
    let names = aircraft.mode_names();
    let files = report::flow_pictures(&aircraft.surface, &plan.wake, &flow, &names)
        .map_err(|error| Failure::io("draw the flow", folder, &error))?;
    for (name, content) in files {
        session.write(&folder.join(name), content)?;
    }
    Ok(())
}
