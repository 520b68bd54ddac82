//! Wings against lattices, thin-aerofoil theory and limits of refinement, on small meshes.

use fladder_tests::laplace;
use fladder_tests::plate::{LOW, Planform, Plate};
use fladder_tests::row::report;
use fladder_tests::section::{LongWing, theodorsen};
use fladder_tests::wings::{Cells, Kind, plates, thick};

const CELLS: Cells = Cells {
    chord: 20,
    half_span: 12,
};

#[test]
fn lift_slopes_of_plates() {
    let rows = plates(
        CELLS,
        |aspect_ratio| [2.0, 12.0].contains(&aspect_ratio),
        0.015,
    );
    assert!(report(&rows.expect("solved")));
}

#[test]
fn lift_slopes_of_thick_wings() {
    assert!(report(&thick(CELLS, 0.015).expect("solved")));
}

#[test]
fn a_section_obeys_theodorsen_anywhere_in_the_laplace_plane() {
    let wing = LongWing {
        aspect_ratio: 60.0,
        n_chord: 24,
        n_half_span: 6,
    };
    assert!(report(&theodorsen(&wing, 0.03).expect("solved")));
}

#[test]
fn q_of_a_plate_anywhere_in_the_laplace_plane() {
    for kind in Kind::ALL {
        let plate = Plate::new(Planform::Rectangular, kind, CELLS).expect("solved");
        let goal = |k: f64| if k <= LOW { 0.025 } else { 0.03 };
        let file = "laplace_gaf_rect_ar8.csv";
        let rows = plate.compare(file, kind.name(), goal, |_, _| true);
        assert!(report(&rows.expect("Q")));
        if kind == Kind::Structured {
            let rows = laplace::analytic("rectangular", plate.mesh(), plate.thick());
            assert!(report(&rows.expect("Q")));
        }
    }
}

#[test]
fn q_of_a_swept_tapered_plate() {
    let plate = Plate::new(Planform::Swept, Kind::Structured, CELLS).expect("solved");
    let goal = |k: f64| if k <= LOW { 0.025 } else { 0.03 };
    let rows = plate.compare("dlm_gaf_agard_planform.csv", "swept", goal, |_, _| true);
    assert!(report(&rows.expect("Q")));
}
