//! Random `.inp` and `.dat` files beside a `.frd` file are read as written;
//! damaged ones never panic.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use common::{file, frd, mode};
use fladder_mesh::Vec3;
use fladder_modal::{ModalResult, Node, read_contents, read_structure};
use proptest::prelude::*;
use proptest::sample::Index;
use std::f64::consts::TAU;
use std::fmt::Write;

const NODES: u64 = 12;

fn base(frequencies: &[f64]) -> ModalResult {
    let mut result = common::Shells::default().result();
    for id in 1..=NODES {
        let x = id as f64;
        let position = Vec3::new(x, x * x, 0.0);
        result.nodes.push(Node { id, position });
    }
    for (index, f) in (1..).zip(frequencies) {
        let shape = (0..NODES).map(|k| Vec3::new(0.0, 1.0, k as f64)).collect();
        result.modes.push(mode(index, *f, 1.0, shape));
    }
    result
}

/// Corners of a shell; sets it is in.
type Shell = (Vec<u64>, bool);

fn shells() -> impl Strategy<Value = Vec<Shell>> {
    let ids: Vec<u64> = (1..=NODES).collect();
    let corners = prop::sample::subsequence(ids, 3..=4).prop_shuffle();
    prop::collection::vec((corners, any::<bool>()), 1..9)
}

/// Elements in two sets, one of them given by element lines and one by a list.
fn inp(result: &ModalResult, shells: &[Shell]) -> String {
    let mut text = String::from("** made by a test\n*Node, nset=All\n");
    for node in &result.nodes {
        let p = node.position;
        writeln!(text, "{}, {:?}, {:?}, {:?}", node.id, p.x, p.y, p.z).unwrap();
    }
    for (id, (corners, _)) in (1..).zip(shells) {
        let kind = if corners.len() == 3 { "S3" } else { "S4" };
        let nodes: Vec<String> = corners.iter().map(u64::to_string).collect();
        writeln!(
            text,
            "*Element, type={kind}, elset=Skin\n{id}, {}",
            nodes.join(",")
        )
        .unwrap();
    }
    let chosen = (1..).zip(shells).filter(|(_, shell)| shell.1);
    let chosen: Vec<String> = chosen.map(|(id, _): (u64, _)| id.to_string()).collect();
    if !chosen.is_empty() {
        writeln!(text, "*Elset, elset=Chosen\n{}", chosen.join(",\n")).unwrap();
    }
    text
}

/// The table as CalculiX 2.20 lays it out.
fn dat(frequencies: &[f64]) -> String {
    let mut text = String::from("\n     E I G E N V A L U E   O U T P U T\n\n");
    text.push_str(" MODE NO    EIGENVALUE                       FREQUENCY\n");
    text.push_str("                                     REAL PART            IMAGINARY PART\n");
    text.push_str("                           (RAD/TIME)      (CYCLES/TIME     (RAD/TIME)\n\n");
    for (number, f) in (1..).zip(frequencies) {
        let omega = TAU * f;
        let lambda = omega * omega;
        let columns = [lambda, omega, *f, 0.0].map(|x| format!("  {x:14.7E}"));
        let number: u32 = number;
        writeln!(text, "{number:7}{}", columns.concat()).unwrap();
    }
    text
}

fn damage(bytes: &mut [u8], flips: &[(Index, u8)]) {
    for (place, byte) in flips {
        let place = place.index(bytes.len());
        bytes[place] = *byte;
    }
}

fn flips() -> impl Strategy<Value = Vec<(Index, u8)>> {
    prop::collection::vec((any::<Index>(), any::<u8>()), 1..6)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn random_input_is_read_as_written(shells in shells(), crlf in any::<bool>()) {
        let result = base(&[3.0]);
        let text = inp(&result, &shells);
        let text = if crlf { text.replace('\n', "\r\n") } else { text };
        let path = file("random_inp", "model.inp", text);
        let read = read_contents(&path).unwrap();
        prop_assert_eq!(read.nodes.len(), result.nodes.len());
        for ((id, place), node) in read.nodes.iter().zip(&result.nodes) {
            prop_assert_eq!(*id, node.id);
            prop_assert_eq!(place, &node.position);
        }
        let found: Vec<&Vec<u64>> = read.elements.iter().map(|element| &element.2).collect();
        let written: Vec<&Vec<u64>> = shells.iter().map(|shell| &shell.0).collect();
        prop_assert_eq!(found, written);
        let modes = file("random_inp", "other.frd", frd(&result));
        let joined = read_structure(&modes, Some(&path), None).unwrap();
        let members = |name: &str| joined.element_sets.iter()
            .find(|set| set.name.eq_ignore_ascii_case(name)).map_or(0, |set| set.members.len());
        prop_assert_eq!(members("Skin"), shells.len());
        prop_assert_eq!(members("Chosen"), shells.iter().filter(|shell| shell.1).count());
    }

    #[test]
    fn random_eigenvalues_are_read_as_written(
        mut frequencies in prop::collection::vec(1e-2..1e3_f64, 1..8),
    ) {
        frequencies.sort_by(f64::total_cmp);
        file("random_dat", "model.dat", dat(&frequencies));
        let path = file("random_dat", "model.frd", frd(&base(&frequencies)));
        let read = read_structure(&path, None, None).unwrap();
        for (mode, f) in read.modes.iter().zip(&frequencies) {
            prop_assert!((mode.frequency_hz / f - 1.0).abs() < 5.1e-8);
            let omega = TAU * f;
            prop_assert!((mode.eigenvalue / (omega * omega) - 1.0).abs() < 5.1e-8);
        }
    }

    #[test]
    fn damaged_input_and_eigenvalues_never_panic(
        shells in shells(),
        of_input in flips(),
        of_table in flips(),
        cut in prop::option::of(any::<Index>()),
    ) {
        let frequencies = [3.0, 4.5];
        let result = base(&frequencies);
        let mut input = inp(&result, &shells).into_bytes();
        damage(&mut input, &of_input);
        let mut table = dat(&frequencies).into_bytes();
        damage(&mut table, &of_table);
        if let Some(cut) = cut {
            input.truncate(cut.index(input.len()));
            table.truncate(cut.index(table.len()));
        }
        let geometry = file("damaged_inp", "geometry.inp", input);
        let path = file("damaged_inp", "plain.frd", frd(&result));
        if let Ok(read) = read_structure(&path, Some(&geometry), None) {
            prop_assert_eq!(read.nodes.len(), result.nodes.len());
        }
        file("damaged_dat", "model.dat", table);
        let path = file("damaged_dat", "model.frd", frd(&result));
        if let Ok(read) = read_structure(&path, None, None) {
            prop_assert_eq!(read.modes.len(), frequencies.len());
        }
    }
}
