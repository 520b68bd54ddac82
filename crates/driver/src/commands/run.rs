//! `fladder run`: the whole chain into a report folder.

use super::Session;
use crate::chain::aircraft::Aircraft;
use crate::chain::conditions::Conditions;
use crate::chain::forces::{self, Forces};
use crate::chain::own_forces;
use crate::chain::structure::StructureData;
use crate::chain::sweep as sweeping;
use crate::cli::Method;
use crate::failure::Failure;
use crate::plot::{self, Subject};
use crate::report;
use std::path::Path;

pub(crate) fn run(session: &Session, path: &Path, method: Method) -> Result<(), Failure> {
    let file = session.case(path)?;
    let console = &session.console;
    // Before hours of computing it is known whether there is a sweep at all.
    let conditions = Conditions::of(&file)?;
    let speeds = conditions.speeds();
    let out = session.results_folder(&file);
    let mut aircraft = None;
    let mut modes = Vec::new();
    let mut facts = vec![("case".to_owned(), path.display().to_string())];
    let (structure, forces) = if forces::are_given(&file) {
        let structure = StructureData::read(&file)?;
        report::structure(console, &structure, None);
        let forces = Forces::given(&file, &structure)?;
        (structure, forces)
    } else {
        let read = aircraft.insert(Aircraft::read(&file)?);
        report::surface(console, &read.surface);
        report::structure(console, &read.structure, read.transfer.as_ref());
        report::transfer(console, read.transfer.as_ref());
        modes = report::mode_pictures(read);
        for mode in &modes {
            let name = report::picture_file(&mode.name);
            session.write(&out.join("modes").join(name), &mode.picture)?;
        }
        let own = own_forces::obtain(&file, read, &session.open_cache(&file), console)?;
        report::own_forces(console, &file, read, &own);
        facts.extend(report::facts(read, &own));
        session.derivatives(&file, read, &own, Some(&out))?;
        let assembled = forces::assemble(&file, read, own)?;
        session.write_json(&out.join("gaf.json"), &assembled.document)?;
        let forces = Forces::own(&file, read, &assembled.own, &assembled.document)?;
        (read.structure.clone(), forces)
    };
    console.notes(&forces.notes);
    let result = sweeping::run(&file, &structure, &forces, method, console)?;
    session.write_json(&out.join("flutter.json"), &result)?;
    let write = |name: &str, text: String| session.write(&out.join(name), text);
    write("roots.csv", report::roots_csv(&result.methods))?;
    if let Some(best) =
        report::best(&result.methods).filter(|best| !best.flight_modes.is_empty())
    {
        write("flight_modes.csv", report::flight_csv(best, &result))?;
    }
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
    let diagrams = [
        ("Root locus", "root_locus.svg", plot::root_locus(&subject)),
        ("V-g-f diagram", "vgf.svg", plot::flutter_diagram(&subject)),
    ]
    .map(|(name, file, picture)| (file, report::Named::new(name, picture)));
    for (file, diagram) in &diagrams {
        write(file, diagram.picture.clone())?;
    }
    let flutter = report::best(&result.methods).map_or(&[][..], |best| &best.flutter);
    let flutter_modes = aircraft.as_ref().map_or_else(Vec::new, |aircraft| {
        report::flutter_pictures(aircraft, flutter)
    });
    let page = report::page(&report::Page {
        title,
        conditions: &conditions,
        methods: &result.methods,
        speeds: &speeds,
        diagrams: &diagrams.map(|(_, diagram)| diagram),
        flutter_modes: &flutter_modes,
        modes: &modes,
        facts: &facts,
    });
    write("report.html", page)?;
    report::roots(console, &result, &speeds);
    Ok(())
}
