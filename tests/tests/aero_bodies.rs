//! Closed bodies without a wake, on small meshes.

use fladder_tests::row::report;
use fladder_tests::{bodies, stream, surface_velocity};

#[test]
fn row_sums_of_the_double_layer_are_minus_one_half() {
    let rows = bodies::row_sums(8, 1e-12).expect("shapes");
    assert!(report(&rows));
}

/// Four times the goal at 2500 vertices, because the order is two.
#[test]
fn added_masses_converge_at_second_order_and_hold_at_every_p() {
    for name in ["sphere", "triaxial_2_1_0.5"] {
        let rows = bodies::added_mass(name, &[4, 8], 0.02).expect("solved");
        assert!(report(&rows));
    }
}

#[test]
fn ellipsoids_in_a_stream_obey_kirchhoff() {
    let rows = stream::munk(&[4, 8], 2, 0.02).expect("solved");
    assert!(report(&rows));
}

#[test]
fn free_ellipsoids_have_their_roots() {
    let rows = stream::free_roots(8, 0.02).expect("solved");
    assert!(report(&rows));
}

#[test]
fn ellipsoids_have_their_surface_velocity() {
    for name in ["sphere", "triaxial_2_1_0.5"] {
        let rows = surface_velocity::rows(name, 8, 0.04).expect("solved");
        assert!(report(&rows));
    }
}
