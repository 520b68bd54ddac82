//! `fladder run`: the whole chain into a report folder.

use super::Session;
use crate::chain::aircraft::Aircraft;
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
    let speeds = sweeping::speeds(&file)?;
    let density = sweeping::density(&file)?;
    let out = session.results_folder(&file);
    let (structure, forces) = if forces::are_given(&file) {
        let structure = StructureData::read(&file)?;
        report::structure(console, &structure, None);
        let forces = Forces::given(&file, &structure)?;
        (structure, forces)
    } else {
        let aircraft = Aircraft::read(&file)?;
        report::surface(console, &aircraft.surface);
        report::structure(console, &aircraft.structure, aircraft.transfer.as_ref());
        report::transfer(console, aircraft.transfer.as_ref());
        for (name, picture) in report::mode_pictures(&aircraft) {
            session.write(&out.join("modes").join(name), picture)?;
        }
        let own = own_forces::obtain(&file, &aircraft, &session.open_cache(&file), console)?;
        report::own_forces(console, &file, &aircraft, &own);
        session.derivatives(&file, &aircraft, &own, Some(&out))?;
        let assembled = forces::assemble(&file, &aircraft, own)?;
        session.write_json(&out.join("gaf.json"), &assembled.document)?;
        let forces = Forces::own(&file, &aircraft, &assembled.own, &assembled.document)?;
        (aircraft.structure, forces)
    };
    console.notes(&forces.notes);
    let result = sweeping::run(&file, &structure, &forces, method, console)?;
    session.write_json(&out.join("flutter.json"), &result)?;
    let write = |name: &str, text: String| session.write(&out.join(name), text);
    write("roots.csv", report::roots_csv(&result.methods))?;
    let conditions = report::conditions(&file, &speeds, density);
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
    write("root_locus.svg", plot::root_locus(&subject))?;
    write("vgf.svg", plot::flutter_diagram(&subject))?;
    report::roots(console, &result.methods, &speeds);
    Ok(())
}
