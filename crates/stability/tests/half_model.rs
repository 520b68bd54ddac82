//! Three rigid modes of a half model: rows and columns of the six.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use faer::{Mat, c64};
use fladder_stability::{
    DampingModel, Flight, Frame, GafPoint, GafTable, OperatingPoint, RIGID_NAMES, RigidBody,
    Structure, System, Thrust, to_body_frame,
};

const BODY: RigidBody = RigidBody {
    mass: 9.0,
    ixx: 2.0,
    iyy: 4.0,
    izz: 5.0,
    ixz: 0.3,
};

/// Numbers of the rigid modes of each half model.
const KINDS: [[usize; 3]; 2] = [[0, 2, 4], [1, 3, 5]];

/// Names of some rigid modes and of one elastic one.
fn names(rigid: &[usize]) -> Vec<String> {
    let rigid = rigid.iter().map(|number| RIGID_NAMES[*number].to_owned());
    rigid.chain(["elastic:1".to_owned()]).collect()
}

fn system(rigid: &[usize], heave_slope: f64, steady: f64) -> System {
    let names = names(rigid);
    let mut frequencies = vec![0.0; rigid.len()];
    frequencies.push(30.0);
    let mut forces: Vec<Option<f64>> = vec![Some(0.0); rigid.len()];
    forces.push(Some(steady));
    let damping = DampingModel::Viscous(vec![0.01; names.len()]);
    let flight = Flight {
        gravity: 9.81,
        climb: 0.05,
        parasite_drag_area: 0.02,
        induced_drag_factor: 0.05,
        thrust: Thrust::ConstantPower,
        speed_derivative: true,
    };
    System::from_frequencies(names, &frequencies, damping)
        .unwrap()
        .with_rigid_body(BODY)
        .with_flight(flight, 0.3, heave_slope, &forces)
        .unwrap()
}

/// Entries of the six-mode system between modes of one kind are those of the
/// half model; between modes of the two kinds there is nothing.
#[test]
fn matrices_of_a_half_model_are_blocks_of_the_whole() {
    let mut point = OperatingPoint::new(31.0, 1.2);
    point.alpha = 0.07;
    // An elastic mode of antisymmetric motion feels no steady force.
    for (kind, steady) in [(0, 0.8), (1, 0.0)] {
        let slope = if kind == 0 { -3.0 } else { 0.0 };
        let whole = system(&[0, 1, 2, 3, 4, 5], -3.0, steady).at(&point);
        let half = system(&KINDS[kind], slope, steady).at(&point);
        let mut places = KINDS[kind].to_vec();
        places.push(6);
        let pairs = [
            (&whole.mass, &half.mass),
            (&whole.damping, &half.damping),
            (&whole.stiffness, &half.stiffness),
        ];
        for (whole, half) in pairs {
            for (i, &row) in places.iter().enumerate() {
                for (j, &column) in places.iter().enumerate() {
                    assert_eq!(half[(i, j)], whole[(row, column)], "({row}, {column})");
                }
                for other in KINDS[1 - kind] {
                    assert_eq!(whole[(row, other)], 0.0);
                    assert_eq!(whole[(other, row)], 0.0);
                }
            }
        }
        assert_eq!(half.flight_path.is_some(), kind == 0);
    }
}

/// Conversion to body axes needs modes of one kind only.
#[test]
fn columns_of_a_half_model_are_converted_as_those_of_the_whole() {
    let table = |rigid: &[usize]| {
        let numbers: Vec<usize> = rigid.iter().copied().chain([6]).collect();
        let order = numbers.len();
        let points = [0.0, 0.1, 0.2, 0.4, 0.8].map(|k| GafPoint {
            g: 0.0,
            k,
            q: Mat::from_fn(order, order, |i, j| {
                let (a, b) = (numbers[i] as f64, numbers[j] as f64);
                c64::new(a - 2.0 * b + k * k, k * (1.0 + a * b))
            }),
        });
        let table = GafTable::new(0.3, 0.0, names(rigid), points.into(), vec![]).unwrap();
        to_body_frame(table, &vec![Frame::Inertial; order], &BODY, 0.1).unwrap()
    };
    let whole = table(&[0, 1, 2, 3, 4, 5]);
    for kind in KINDS {
        let half = table(&kind);
        let places: Vec<usize> = kind.into_iter().chain([6]).collect();
        for (half, whole) in half.axis().zip(whole.axis()) {
            for (i, &row) in places.iter().enumerate() {
                for (j, &column) in places.iter().enumerate() {
                    assert_eq!(half[(i, j)], whole[(row, column)]);
                }
            }
        }
    }
}
