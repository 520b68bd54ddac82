//! Wings against lattices, thin-aerofoil theory and limits of refinement, on small meshes.

use fladder_tests::laplace;
use fladder_tests::plate::{Planform, Plate};
use fladder_tests::row::report;
use fladder_tests::section::{LongWing, theodorsen};
use fladder_tests::wings::{Cells, Goals, Kind, plates, thick};

const CELLS: Cells = Cells {
    chord: 20,
    half_span: 12,
    nose: 0.0,
};

/// Two and three times the goal on fine meshes: pressures converge at first order.
const GOALS: Goals = Goals {
    structured: 0.02,
    unstructured: 0.03,
    kutta: 0.02,
};

#[test]
fn lift_slopes_of_plates() {
    let cells = Cells {
        chord: 16,
        half_span: 10,
        nose: 0.0,
    };
    let rows = plates(
        cells,
        |aspect_ratio| [2.0, 6.0].contains(&aspect_ratio),
        GOALS,
    );
    assert!(report(&rows.expect("solved")));
}

#[test]
fn lift_slopes_of_thick_wings() {
    assert!(report(&thick(CELLS, GOALS).expect("solved")));
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

/// The goals of fine meshes are met on this one.
#[test]
fn q_of_a_plate_anywhere_in_the_laplace_plane() {
    for kind in Kind::ALL {
        let plate = Plate::new(Planform::Rectangular, kind, CELLS).expect("solved");
        let file = "laplace_gaf_rect_ar8.csv";
        let rows = plate.compare(file, kind.name(), |k| kind.lattice_goal(k));
        assert!(report(&rows.expect("Q")));
        if kind == Kind::Structured {
            let rows = laplace::analytic("rectangular", plate.mesh(), plate.thick());
            assert!(report(&rows.expect("Q")));
        }
    }
}

#[test]
fn q_of_a_swept_tapered_plate() {
    let cells = Cells {
        chord: 16,
        half_span: 10,
        nose: 0.0,
    };
    let plate = Plate::new(Planform::Swept, Kind::Structured, cells).expect("solved");
    let rows = plate.compare("dlm_gaf_agard_planform.csv", "swept", |_| 0.03);
    assert!(report(&rows.expect("Q")));
}
