//! Analytic modes against closed form.

use fladder_mesh::{Frame, Vec3};
use fladder_modal::{AnalyticError, AnalyticMode, Component, Motion, PolynomialTerm};

fn mode(motion: Motion) -> AnalyticMode {
    AnalyticMode {
        name: "test".to_owned(),
        motion,
    }
}

fn points() -> Vec<Vec3> {
    vec![
        Vec3::new(0.5, 2.0, -0.25),
        Vec3::new(-1.0, -3.0, 4.0),
        Vec3::new(2.0, 0.0, 1.0),
    ]
}

#[test]
fn a_translation_is_the_same_everywhere() {
    let shift = Vec3::new(0.0, 0.5, 1.0);
    let found = mode(Motion::Translation(shift)).on(&points()).unwrap();
    assert_eq!(found.frame, Frame::Inertial);
    assert_eq!(found.displacement, vec![shift; 3]);
}

/// About +y through (0.5, 0, 0): u = (z, 0, −(x − 0.5)); nose up.
#[test]
fn a_rotation_is_by_one_radian_about_a_normalised_axis() {
    let axis = Vec3::new(0.0, 7.0, 0.0);
    let found = mode(Motion::Rotation {
        axis,
        point: Vec3::new(0.5, 1.0, 0.0),
    })
    .on(&points())
    .unwrap();
    for (u, p) in found.displacement.iter().zip(points()) {
        assert!((u - Vec3::new(p.z, 0.0, -(p.x - 0.5))).norm() < 1e-15);
    }
    let failed = mode(Motion::Rotation {
        axis: Vec3::zeros(),
        point: Vec3::zeros(),
    });
    assert!(matches!(
        failed.on(&points()),
        Err(AnalyticError::NoAxis { .. })
    ));
}

#[test]
fn a_polynomial_is_its_sum_of_terms() {
    let term = |component, coefficient, powers, odd_y| PolynomialTerm {
        component,
        coefficient,
        powers,
        odd_y,
    };
    let found = mode(Motion::Polynomial(vec![
        term(Component::Z, 2.0, [0, 2, 0], false),
        term(Component::Z, -1.0, [1, 1, 0], true),
        term(Component::X, 3.0, [0, 0, 3], false),
        term(Component::Y, 1.0, [0, 0, 0], true),
    ]))
    .on(&points())
    .unwrap();
    for (u, p) in found.displacement.iter().zip(points()) {
        // |y| sign(y) = y.
        let exact = Vec3::new(
            3.0 * p.z * p.z * p.z,
            if p.y == 0.0 { 0.0 } else { p.y / p.y.abs() },
            2.0 * p.y * p.y - p.x * p.y,
        );
        assert!((u - exact).norm() < 1e-13, "{u} {exact}");
    }
}

#[test]
fn fields_that_move_nothing_or_overflow_are_refused() {
    let size = |coefficient, powers| {
        let component = Component::Z;
        let term = PolynomialTerm {
            component,
            coefficient,
            powers,
            odd_y: false,
        };
        mode(Motion::Polynomial(vec![term])).on(&points())
    };
    assert!(
        matches!(size(0.0, [0, 0, 0]), Err(AnalyticError::Size { largest, .. }) if largest == 0.0)
    );
    assert!(matches!(
        size(1.0, [5000, 0, 0]),
        Err(AnalyticError::Size { .. })
    ));
    assert!(
        mode(Motion::Translation(Vec3::zeros()))
            .on(&points())
            .is_err()
    );
}
