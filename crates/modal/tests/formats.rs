//! Random contents in every format are read as written; cut or damaged files
//! give an error or a whole result, never a panic.

#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(
    clippy::format_push_string,
    reason = "the files written here are small"
)]

mod common;
mod writers;

use common::{file, mode};
use fladder_mesh::Vec3;
use fladder_modal::{ModalResult, Node, read_structure};
use flate2::Compression;
use flate2::write::GzEncoder;
use proptest::prelude::*;
use proptest::sample::Index;
use std::io::Write;
use writers::{Fields, WAYS, Way, bdf, rotation};

fn vector() -> impl Strategy<Value = Vec3> {
    let number = prop_oneof![-1e3..1e3_f64, -1e-9..1e-9_f64, Just(0.0)];
    [number.clone(), number.clone(), number].prop_map(Vec3::from)
}

/// Nodes at gaps in the numbering, a few modes.
fn contents() -> impl Strategy<Value = ModalResult> {
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
            for (k, (mut shape, mass)) in (1..).zip(shapes.into_iter().zip(masses)) {
                shape[0].x += 2e3;
                result.modes.push(mode(k, 3.5 * f64::from(k), mass, shape));
            }
            result
        })
    })
}

fn way() -> impl Strategy<Value = Way> {
    prop::sample::select(WAYS.to_vec())
}

/// The geometry a way needs, written beside.
fn geometry(way: Way, contents: &ModalResult, folder: &str) -> Option<std::path::PathBuf> {
    let text = bdf(contents, Fields::Free);
    way.needs_geometry()
        .then(|| file(folder, "nodes.bdf", text))
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn close(a: &Vec3, b: &Vec3, rounding: f64) -> bool {
    // Single precision and printed digits end somewhere below.
    let tiny = 1e-37;
    a.iter().zip(b).all(|(a, b)| {
        (a - b).abs() <= rounding * b.abs() + if rounding > 1e-9 { tiny } else { 0.0 }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn random_contents_are_read_as_written(
        way in way(),
        written in contents(),
        zipped in any::<bool>(),
    ) {
        let bytes = way.write(&written);
        let bytes = if zipped { gzip(&bytes) } else { bytes };
        let path = file("random_formats", "contents", bytes);
        let geometry = geometry(way, &written, "random_formats");
        let read = read_structure(&path, geometry.as_deref(), None).unwrap();
        prop_assert_eq!(read.nodes.len(), written.nodes.len());
        prop_assert_eq!(read.modes.len(), written.modes.len());
        let rounding = way.rounding();
        let exact = matches!(way, Way::FrdBinary | Way::Universal { .. });
        for (a, b) in read.nodes.iter().zip(&written.nodes) {
            prop_assert_eq!(a.id, b.id);
            let rounding = if exact || way.needs_geometry() { 0.0 } else { rounding };
            prop_assert!(close(&a.position, &b.position, rounding), "{way:?}");
        }
        for (a, b) in read.modes.iter().zip(&written.modes) {
            prop_assert_eq!(a.index, b.index);
            prop_assert!((a.frequency_hz / b.frequency_hz - 1.0).abs() < 6e-6);
            let mass = if way.has_masses() { b.generalised_mass } else { 1.0 };
            prop_assert!((a.generalised_mass / mass - 1.0).abs() <= 6e-6);
            prop_assert_eq!(a.rotation.is_some(), way.has_rotations());
            for (k, (u, v)) in a.displacement.iter().zip(&b.displacement).enumerate() {
                prop_assert!(close(u, v, rounding), "{way:?} {u} {v}");
                if let Some(turns) = &a.rotation {
                    prop_assert!(close(&turns[k], &rotation(v), rounding), "{way:?}");
                }
            }
        }
    }

    #[test]
    fn random_bulk_data_are_read_as_written(written in contents(), free in any::<bool>()) {
        let fields = if free { Fields::Free } else { Fields::Large };
        let geometry = file("random_bulk", "nodes.bdf", bdf(&written, fields));
        let path = file("random_bulk", "modes.pch", Way::Punch.write(&written));
        let read = read_structure(&path, Some(&geometry), None).unwrap();
        for (a, b) in read.nodes.iter().zip(&written.nodes) {
            prop_assert_eq!(a.id, b.id);
            let rounding = if free { 0.0 } else { 5.1e-9 };
            prop_assert!(close(&a.position, &b.position, rounding));
        }
    }

    /// Either an error or a whole result.
    #[test]
    fn damaged_files_never_panic(
        way in way(),
        written in contents(),
        flips in prop::collection::vec((any::<Index>(), any::<u8>()), 1..6),
        cut in prop::option::of(any::<Index>()),
    ) {
        let mut bytes = way.write(&written);
        for (place, byte) in flips {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        let path = file("damaged_formats", "contents", bytes);
        let geometry = geometry(way, &written, "damaged_formats");
        if let Ok(read) = read_structure(&path, geometry.as_deref(), None) {
            prop_assert!(read.modes.iter().all(|mode| mode.displacement.len() == read.nodes.len()));
        }
    }

    #[test]
    fn damaged_bulk_data_never_panic(
        written in contents(),
        flips in prop::collection::vec((any::<Index>(), any::<u8>()), 1..6),
        free in any::<bool>(),
    ) {
        let fields = if free { Fields::Free } else { Fields::Large };
        let mut bytes = bdf(&written, fields).into_bytes();
        for (place, byte) in flips {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        let geometry = file("damaged_bulk", "nodes.bdf", bytes);
        let path = file("damaged_bulk", "modes.pch", Way::Punch.write(&written));
        let read = read_structure(&path, Some(&geometry), None);
        prop_assert!(read.is_err() || read.is_ok_and(|read| read.nodes.len() == written.nodes.len()));
    }

    /// Files that say where they end are refused wherever they are cut; others
    /// where a mode or a node is cut through, so that all modes left are whole.
    #[test]
    fn files_cut_short_are_refused(way in way(), written in contents(), cut in any::<Index>()) {
        let bytes = way.write(&written);
        let kept = cut.index(bytes.len());
        let path = file("cut_formats", "contents", &bytes[..kept]);
        let geometry = geometry(way, &written, "cut_formats");
        let read = read_structure(&path, geometry.as_deref(), None);
        let has_end = way.has_end();
        let blank_end = bytes[kept..].iter().all(u8::is_ascii_whitespace);
        if let Ok(read) = read {
            prop_assert!(!has_end || blank_end, "{way:?} cut at {kept} of {}", bytes.len());
            for (a, b) in read.modes.iter().zip(&written.modes) {
                for (u, v) in a.displacement.iter().zip(&b.displacement) {
                    prop_assert!(close(u, v, way.rounding()), "{way:?} {u} {v}");
                }
            }
        }
    }
}
