//! Random valid files are read as written; damaged ones never panic.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use common::{file, frd, mode};
use fladder_mesh::Vec3;
use fladder_modal::{ModalResult, Node, read_structure, write_neutral};
use proptest::prelude::*;

fn vector() -> impl Strategy<Value = Vec3> {
    let number = prop_oneof![-1e3..1e3_f64, -1e-9..1e-9_f64, Just(0.0)];
    [number.clone(), number.clone(), number].prop_map(Vec3::from)
}

/// Nodes at gaps in the numbering, no elements, a few modes.
fn result() -> impl Strategy<Value = ModalResult> {
    (1..30_usize, 1..4_usize).prop_flat_map(|(nodes, modes)| {
        let positions = prop::collection::vec(vector(), nodes);
        let gaps = prop::collection::vec(1..1000_u64, nodes);
        let shapes = prop::collection::vec(prop::collection::vec(vector(), nodes), modes);
        let masses = prop::collection::vec(1e-3..1e3_f64, modes);
        (positions, gaps, shapes, masses).prop_map(|(positions, gaps, shapes, masses)| {
            let mut result = common::Shells::default().result();
            let mut id = 0;
            for (position, gap) in positions.into_iter().zip(gaps) {
                id += gap;
                result.nodes.push(Node { id, position });
            }
            for (k, (mut shape, mass)) in shapes.into_iter().zip(masses).enumerate() {
                shape[0].x += 2e3;
                result
                    .modes
                    .push(mode(k as u32 + 1, 3.5 * k as f64, mass, shape));
            }
            result
        })
    })
}

fn close(a: &Vec3, b: &Vec3) -> bool {
    a.iter()
        .zip(b)
        .all(|(a, b)| (a - b).abs() <= 5.1e-6 * b.abs())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn a_random_frd_file_is_read_as_written(written in result()) {
        let path = file("random_frd", "model.frd", frd(&written));
        let read = read_structure(&path, None, None).unwrap();
        prop_assert_eq!(read.modes.len(), written.modes.len());
        for (a, b) in read.nodes.iter().zip(&written.nodes) {
            prop_assert_eq!(a.id, b.id);
            prop_assert!(close(&a.position, &b.position));
        }
        for (a, b) in read.modes.iter().zip(&written.modes) {
            for (a, b) in a.displacement.iter().zip(&b.displacement) {
                prop_assert!(close(a, b), "{} {}", a, b);
            }
        }
    }

    #[test]
    fn a_random_neutral_file_is_read_as_written(written in result()) {
        let mut bytes = Vec::new();
        write_neutral(&written, &mut bytes).unwrap();
        let path = file("random_json", "model.json", bytes);
        let read = read_structure(&path, None, None).unwrap();
        prop_assert_eq!(read.nodes, written.nodes);
        prop_assert_eq!(read.modes, written.modes);
    }

    /// Either an error or a whole result: as many modes as were written.
    #[test]
    fn flipped_bytes_never_panic(
        written in result(),
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        json in any::<bool>(),
    ) {
        let mut bytes = Vec::new();
        if json {
            write_neutral(&written, &mut bytes).unwrap();
        } else {
            bytes = frd(&written).into_bytes();
        }
        for (place, byte) in flips {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        let path = file("flipped", "model", bytes);
        if let Ok(read) = read_structure(&path, None, None) {
            prop_assert!(read.modes.iter().all(|mode| mode.displacement.len() == read.nodes.len()));
        }
    }

    #[test]
    fn any_bytes_as_geometry_never_panic(lines in prop::collection::vec(line(), 0..20)) {
        let mut result = common::Shells::default().result();
        result.nodes.push(Node { id: 1, position: Vec3::zeros() });
        result.modes.push(mode(1, 1.0, 1.0, vec![Vec3::x()]));
        let path = file("any_inp", "model.frd", frd(&result));
        let geometry = file("any_inp", "model.inp", lines.join("\n"));
        if let Ok(read) = read_structure(&path, Some(&geometry), None) {
            prop_assert_eq!(read.nodes.len(), 1);
        }
    }
}

fn line() -> impl Strategy<Value = String> {
    let word = prop_oneof![
        Just("*NODE, NSET=A".to_owned()),
        Just("*ELEMENT, TYPE=S3, ELSET=B".to_owned()),
        Just("*ELSET, ELSET=C, GENERATE".to_owned()),
        Just("*NSET, NSET=A".to_owned()),
        Just("1, 0, 0, 0".to_owned()),
        Just("1, 18446744073709551615, 1".to_owned()),
        Just("2, 1, 1, 1".to_owned()),
        Just("A,,B, -3".to_owned()),
        "[ -~]{0,12}",
        "[0-9,. ]{0,12}",
    ];
    word
}

/// Squares of such numbers overflow; nothing may hang or panic.
#[test]
fn enormous_numbers_end_in_an_answer() {
    let mut result = common::wing().result();
    let positions = result.positions();
    for k in 0..7 {
        let shape = positions
            .iter()
            .map(|p| p * 1e200 + Vec3::ith(k % 3, 1e300))
            .collect();
        result.modes.push(mode(k as u32 + 1, 0.0, 1e-300, shape));
    }
    for scale in [1.0, 1e200, 1e-200] {
        let mut scaled = result.clone();
        scaled
            .nodes
            .iter_mut()
            .for_each(|node| node.position *= scale);
        let survey = fladder_modal::survey(&scaled);
        assert!(survey.recovered.is_none());
        let mesh = common::surface();
        let carried = fladder_modal::build_transfer(&scaled, &mesh, &common::mapping());
        assert_eq!(carried.is_ok(), scale == 1.0);
    }
}

/// Elements whose nodes coincide, cross over or lie on a line carry nothing.
#[test]
fn degenerate_elements_give_no_undefined_displacement() {
    let mut result = common::wing().result();
    let count = result.nodes.len() as u32;
    for (k, element) in result.elements.iter_mut().enumerate() {
        match k % 9 {
            0 => element.nodes.fill(k as u32 % count),
            1 => element.nodes.swap(0, 1),
            2 => element.nodes.swap(5, 7),
            3 => {
                let first = element.nodes[0];
                element.nodes[3] = first;
                element.nodes[7] = first;
            }
            _ => {}
        }
    }
    let mesh = common::surface();
    let carried = fladder_modal::build_transfer(&result, &mesh, &common::mapping()).unwrap();
    let rigid = |p: &Vec3| Vec3::new(1.0, 2.0, 3.0) + Vec3::new(0.3, 0.1, -0.2).cross(p);
    let found = carried
        .matrix
        .displacement(&common::sample(&result.positions(), rigid));
    let error = common::largest_error(&found, &common::sample(&mesh.vertices, rigid));
    println!("rigid motion over degenerate elements: {error:.1e}");
    assert!(error < 1e-11);
}
