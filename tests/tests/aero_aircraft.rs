//! The ScanEagle-like surface on its small mesh.

use fladder_tests::aircraft::{Aircraft, workspace};
use fladder_tests::row::report;

#[test]
fn q_of_the_aircraft_is_symmetric_and_smooth_and_its_wake_whole() {
    let mesh = workspace().join("meshes/scaneagle_3k.msh");
    let aircraft = Aircraft::read(&mesh, 6).expect("the committed mesh and modes");
    let solution = aircraft.solve().expect("a sound aircraft");
    let mut rows = aircraft.symmetry(&solution).expect("Q");
    rows.extend(aircraft.junction(&solution, 0.04));
    rows.extend(aircraft.smoothness(&solution).expect("Q"));
    assert!(report(&rows));
}
