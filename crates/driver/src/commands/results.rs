//! The report folder: computed by `run`, made again by `report`.

use super::{Session, sweep};
use crate::case::CaseFile;
use crate::chain::aircraft::Aircraft;
use crate::chain::conditions::Conditions;
use crate::chain::forces::{self, Forces};
use crate::chain::own_forces::{self, OwnForces};
use crate::chain::structure::StructureData;
use crate::chain::sweep as sweeping;
use crate::cli::Method;
use crate::export;
use crate::failure::Failure;
use crate::files;
use crate::plot::{self, Subject};
use crate::report;
use std::path::Path;

/// Where forces of a surface may come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Forcing {
    /// Computed where the cache has none.
    Computed,
    /// The cache alone.
    Stored,
}

/// Crossings whose pictures are for paper: two each.
const STILLS: usize = 2;

/// The whole chain into a report folder.
pub(crate) fn results(
    session: &Session,
    path: &Path,
    method: Method,
    forcing: Forcing,
) -> Result<(), Failure> {
    let file = session.case(path)?;
    let console = &session.console;
    // Before hours of computing it is known whether there is a sweep at all.
    let speeds = Conditions::of(&file)?.speeds();
    let out = session.results_folder(&file);
    let mut own = None;
    let mut facts = report::inputs(&file, &session.common.set);
    let (structure, forces) = if forces::are_given(&file) {
        let structure = StructureData::read(&file)?;
        report::structure(console, &structure, None);
        let forces = Forces::given(&file, &structure)?;
        (structure, forces)
    } else {
        let (aircraft, stored) = surface_forces(session, path, &file, forcing)?;
        for mode in report::mode_pictures(&aircraft) {
            let name = report::picture_file(&mode.name);
            files::write(&out.join("modes").join(name), &mode.picture)?;
        }
        facts.extend(report::facts(&aircraft, &stored));
        session.derivatives(&file, &aircraft, &stored, Some(&out))?;
        let assembled = forces::assemble(&file, &aircraft, stored)?;
        session.write_json(&out.join("gaf.json"), &assembled.document)?;
        let archive = out.join("gaf.npz");
        session.write(&archive, export::forces(&archive, &assembled.document)?)?;
        session.write(&out.join("gaf.op4"), export::op4(&assembled.document))?;
        let forces = Forces::own(&file, &aircraft, &assembled.own, &assembled.document)?;
        let structure = aircraft.structure.clone();
        own = Some((aircraft, assembled.own));
        (structure, forces)
    };
    console.notes(&forces.notes);
    let swept = sweeping::run(&file, &structure, &forces, method, console)?;
    tables(session, &out, &file, &forces, &swept, &speeds)?;
    let result = &swept.result;
    let write = |name: &str, text: String| session.write(&out.join(name), text);
    let best = report::best(&result.methods);
    let conditions = report::conditions(&file, &forces.conditions);
    let title = if file.case.title.is_empty() {
        &file.name
    } else {
        &file.case.title
    };
    let subject = Subject {
        title,
        conditions: &conditions,
        methods: &result.methods,
    };
    let root_locus = plot::root_locus(&subject);
    let flutter_diagram = plot::flutter_diagram(&subject);
    write("root_locus.svg", root_locus.clone())?;
    write("vgf.svg", flutter_diagram.clone())?;
    let flutter = best.map_or(&[][..], |best| &best.flutter);
    let mut curves = Vec::new();
    let leading = flutter
        .first()
        .map(|crossing| crossing.branch.split('#').next().unwrap_or_default());
    let fit = sweeping::fit(&file, &forces)?;
    curves.extend(report::fit_picture(&forces.table, &fit, leading));
    let (mut motions, mut stills) = (Vec::new(), Vec::new());
    if let Some((aircraft, stored)) = &own {
        curves.extend(report::jump_picture(&stored.stored.solution.steady));
        motions = report::flutter_motions(aircraft, flutter);
        if let (Some(motion), Some(crossing)) = (motions.first(), flutter.first()) {
            flutter_frames(session, &out, aircraft, motion, crossing.frequency_hz)?;
        }
        for motion in motions.iter().take(STILLS) {
            stills.extend(report::stills(aircraft, motion));
        }
        motions.extend(report::mode_motions(aircraft));
    }
    let page = report::page(&report::Page {
        title,
        conditions: &conditions,
        result,
        speeds: &speeds,
        root_locus: &root_locus,
        flutter_diagram: &flutter_diagram,
        curves: &curves,
        surface: own.as_ref().map(|(aircraft, stored)| report::Wetted {
            mesh: &aircraft.surface.mesh,
            pressure: &stored.stored.solution.steady.pressures,
        }),
        motions: &motions,
        stills: &stills,
        facts: &facts,
    });
    write("report.html", page)?;
    report::roots(console, result, &speeds);
    Ok(())
}

/// Files that not every run writes: those of an earlier run must not stay beside the others.
fn clear(out: &Path) -> Result<(), Failure> {
    for name in [
        "flight_modes.csv",
        "counts.csv",
        "flutter_summary.f06",
        "flutter_mode.pvd",
    ] {
        files::remove(&out.join(name))?;
    }
    for number in 0..export::FRAMES {
        files::remove(&out.join(frame_name(number)))?;
    }
    Ok(())
}

/// File of a frame of the flutter mode.
fn frame_name(number: usize) -> String {
    format!("flutter_mode_{number:02}.vtu")
}

/// Roots and what follows from them as files.
fn tables(
    session: &Session,
    out: &Path,
    file: &CaseFile,
    forces: &Forces,
    swept: &sweeping::Swept,
    speeds: &[f64],
) -> Result<(), Failure> {
    let result = &swept.result;
    clear(out)?;
    session.write_json(&out.join("flutter.json"), result)?;
    let write = |name: &str, text: String| session.write(&out.join(name), text);
    write("roots.csv", report::roots_csv(&result.methods))?;
    write("crossings.csv", report::crossings_csv(&result.methods))?;
    if let Some(best) = report::best(&result.methods) {
        if !best.flight_modes.is_empty() {
            write("flight_modes.csv", report::flight_csv(best, result))?;
        }
        if let Some(text) = report::counts_csv(best, speeds) {
            write("counts.csv", text)?;
        }
        let text = export::summary(best, speeds, file.case.flow.mach, result.density);
        write("flutter_summary.f06", text)?;
    }
    let archive = out.join("state_space.npz");
    let models = export::states(&archive, forces.table.modes(), &swept.states)?;
    session.write(&archive, models)
}

/// The first crossing over its cycle, for ParaView.
fn flutter_frames(
    session: &Session,
    out: &Path,
    aircraft: &Aircraft,
    motion: &report::Motion,
    frequency_hz: f64,
) -> Result<(), Failure> {
    for number in 0..export::FRAMES {
        let path = out.join(frame_name(number));
        let bytes = export::frame(&aircraft.surface.mesh, motion, number)
            .map_err(|error| Failure::io("write the file", &path, &error))?;
        files::write(&path, bytes)?;
    }
    let frames: Vec<String> = (0..export::FRAMES).map(frame_name).collect();
    let text = export::collection(&frames, frequency_hz);
    session.write(&out.join("flutter_mode.pvd"), text)
}

/// The surface with its modes, said, and its forces.
fn surface_forces(
    session: &Session,
    path: &Path,
    file: &CaseFile,
    forcing: Forcing,
) -> Result<(Aircraft, OwnForces), Failure> {
    let console = &session.console;
    let aircraft = Aircraft::read(file)?;
    let own = match forcing {
        Forcing::Computed => {
            report::surface(console, &aircraft.surface);
            report::structure(console, &aircraft.structure, aircraft.transfer.as_ref());
            report::transfer(console, aircraft.transfer.as_ref());
            own_forces::obtain(file, &aircraft, &session.open_cache(file), console)?
        }
        Forcing::Stored => sweep::stored(session, path, file, &aircraft)?,
    };
    report::own_forces(console, file, &aircraft, &own);
    Ok((aircraft, own))
}
