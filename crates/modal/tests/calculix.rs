//! Reading what CalculiX leaves: `.frd`, `.dat` and `.inp`.

#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(
    clippy::format_push_string,
    reason = "the files written here are small"
)]

mod common;

use common::{file, frd, mode};
use fladder_mesh::Vec3;
use fladder_modal::{ElementKind, Format, ModalResult, ReadError, read_structure};
use std::io::Write;

/// A small wing with two modes.
fn small() -> ModalResult {
    let mut result = common::wing().result();
    let positions = result.positions();
    let shape = |k: f64| {
        positions
            .iter()
            .map(|p| p * k - Vec3::new(0.1, 0.0, k * k))
            .collect()
    };
    result.modes = vec![
        mode(1, 0.0, 1.0, shape(1.0)),
        mode(2, 7.5, 2.5, shape(-0.3)),
    ];
    result
}

fn read(folder: &str, content: impl AsRef<[u8]>) -> Result<ModalResult, ReadError> {
    read_structure(&file(folder, "model.frd", content), None, None)
}

fn refused(folder: &str, content: impl AsRef<[u8]>, words: &[&str]) {
    let message = read(folder, content)
        .map(|read| read.modes.len())
        .unwrap_err()
        .to_string();
    println!("{message}");
    for word in words {
        assert!(message.contains(word), "{word:?} is not in: {message}");
    }
}

/// The five decimals of the format.
fn nearly(a: f64, b: f64) -> bool {
    (a - b).abs() <= 5.1e-6 * b.abs()
}

#[test]
fn what_is_written_is_read() {
    let (written, read) = (small(), read("written", frd(&small())).unwrap());
    assert_eq!(read.format, Format::CalculixFrd);
    assert_eq!(read.elements, written.elements);
    assert_eq!(read.nodes.len(), written.nodes.len());
    for (a, b) in read.nodes.iter().zip(&written.nodes) {
        assert_eq!(a.id, b.id);
        assert!(
            a.position
                .iter()
                .zip(&b.position)
                .all(|(a, b)| nearly(*a, *b))
        );
    }
    for (a, b) in read.modes.iter().zip(&written.modes) {
        assert_eq!((a.index, a.frequency_hz), (b.index, b.frequency_hz));
        assert_eq!(a.generalised_mass, b.generalised_mass);
        assert!(nearly(a.generalised_stiffness, b.generalised_stiffness));
        for (a, b) in a.displacement.iter().zip(&b.displacement) {
            assert!(a.iter().zip(b).all(|(a, b)| nearly(*a, *b)), "{a} {b}");
        }
    }
}

/// `5.54093E-02-1.12684E-02` is two numbers: columns count, not blanks.
#[test]
fn numbers_without_separators_are_parted_by_columns() {
    let text = "    1C\n    2C                             2                                     1\n \
        -1         1 5.54093E-02-1.12684E-02-1.00000E-01\n \
        -1    200000-1.00000E+00-2.00000D+00-3.00000-101\n -3\n  100CL  101 0.00000E+00           \
        2                     2    1MODAL      1\n -4  DISP        4    1\n -5  D1          1    2    \
        1    0\n -5  D2          1    2    2    0\n -5  D3          1    2    3    0\n -1         \
        1-1.11111E-01-2.22222E-02-3.33333E-03\n -1    200000-4.00000E+00-5.00000E+00-6.00000E+00\n \
        -3\n 9999\n";
    let read = read("separators", text).unwrap();
    assert_eq!(
        read.nodes[0].position,
        Vec3::new(5.54093e-2, -1.12684e-2, -0.1)
    );
    assert_eq!(read.nodes[1].position, Vec3::new(-1.0, -2.0, -3.0e-101));
    assert_eq!(read.nodes[1].id, 200_000);
    assert_eq!(
        read.modes[0].displacement[0],
        Vec3::new(-0.111_111, -0.022_222_2, -0.003_333_33)
    );
    let notes = read.notes.join("\n");
    assert!(notes.contains("without a generalised mass"), "{notes}");
}

#[test]
fn line_ends_byte_order_marks_and_compression_change_nothing() {
    let text = frd(&small());
    let plain = read("ends", &text).unwrap();
    assert_eq!(
        plain,
        read("ends_crlf", text.replace('\n', "\r\n")).unwrap()
    );
    assert_eq!(plain, read("ends_bom", format!("\u{feff}{text}")).unwrap());
    assert_eq!(plain, read("ends_gz", zipped(text.as_bytes())).unwrap());
}

fn zipped(content: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(content).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn a_file_cut_short_anywhere_is_refused() {
    let mut result = small();
    result.elements.truncate(3);
    result.nodes.truncate(40);
    result
        .elements
        .retain(|element| element.nodes.iter().all(|node| *node < 40));
    result
        .modes
        .iter_mut()
        .for_each(|mode| mode.displacement.truncate(40));
    let text = frd(&result);
    let whole = text.trim_end().len();
    assert!(read("cut", &text).is_ok());
    for length in 0..whole {
        let failed = read("cut", &text.as_bytes()[..length]).unwrap_err();
        let told = matches!(
            failed,
            ReadError::Truncated { .. }
                | ReadError::Count { .. }
                | ReadError::UnknownFormat { .. }
        );
        assert!(told, "{length} of {whole} bytes: {failed}");
    }
    let zipped = zipped(text.as_bytes());
    for length in (0..zipped.len()).step_by(7) {
        assert!(read("cut_gz", &zipped[..length]).is_err(), "{length} bytes");
    }
}

#[test]
fn faults_are_refused_with_line_and_reason() {
    let text = frd(&small());
    let lines: Vec<&str> = text.lines().collect();
    let without = |n: usize| {
        let kept: Vec<&str> = lines
            .iter()
            .enumerate()
            .filter(|line| line.0 != n)
            .map(|line| *line.1)
            .collect();
        kept.join("\n") + "\n"
    };
    let first_shape = lines
        .iter()
        .position(|line| line.starts_with(" -5  ALL"))
        .unwrap()
        + 1;
    refused("fault_node", without(5), &["nodes where the header states"]);
    refused(
        "fault_shape",
        without(first_shape + 3),
        &["displacements where the header states"],
    );
    let twice = text.replacen(lines[4], lines[3], 1);
    refused("fault_twice", twice, &["line 5", "node 1 appears twice"]);
    let number = text.replacen(&lines[first_shape][13..25], "         NaN", 1);
    refused("fault_nan", number, &["\"NaN\" is no finite number"]);
    let letters = text.replacen(" -1         1   10", " -1         1   77", 1);
    refused(
        "fault_type",
        letters,
        &["element 1 is of unknown type \"77\""],
    );
    let binary = text.replacen(&format!("{:37}1", ""), &format!("{:37}2", ""), 1);
    refused("fault_binary", binary, &["line"]);
    let zero_mass = text.replacen("2.500000E+00", "0.000000E+00", 1);
    refused("fault_mass", zero_mass, &["mode 2", "generalised mass"]);
    let two_steps = text.replacen(&format!("1PMODE{:26}", 2), &format!("1PMODE{:26}", 1), 1);
    refused("fault_steps", two_steps, &["mode 1 comes twice"]);
    let complex = text.replacen(" -4  DISP ", " -4  PDISP", 1);
    refused("fault_complex", complex, &["complex modes"]);
    refused(
        "fault_other",
        "solid cube\n",
        &["solid cube", "no modal result known here"],
    );
    refused("fault_empty", "", &["any content"]);
    let missing = read_structure("there/is/no.frd".as_ref(), None, None).unwrap_err();
    assert!(matches!(missing, ReadError::Io { .. }), "{missing}");
}

#[test]
fn a_mode_that_lacks_a_node_of_the_first_is_refused() {
    let mut result = small();
    let text = frd(&result);
    let last = result.nodes.len();
    result.modes.truncate(1);
    let both = frd(&result);
    let second = &text[both.trim_end().trim_end_matches("9999").trim_end().len()..];
    let node = format!(" -1{last:10}");
    let renamed = second.replacen(&node, &format!(" -1{:10}", last + 1), 1);
    let whole = both
        .trim_end()
        .trim_end_matches("9999")
        .trim_end()
        .to_owned()
        + &renamed;
    refused(
        "lacks",
        whole,
        &["has a displacement, but none in the first mode"],
    );
}

#[test]
fn other_result_blocks_are_named_and_skipped() {
    let text = frd(&small());
    let block = "  100CL  101 1.00000E+00           1                     0    1           1\n -4  \
        STRESS      6    1\n -5  SXX         1    4    1    1\n -1         1 1.00000E+00\n -3\n";
    let with = text.replace(" 9999\n", &format!("{block} 9999\n"));
    let read = read("skipped", with).unwrap();
    assert_eq!(read.modes.len(), 2);
    assert!(
        read.notes
            .iter()
            .any(|note| note == "static results STRESS are not used")
    );
}

const DAT: &str = "
     E I G E N V A L U E   O U T P U T

 MODE NO    EIGENVALUE                       FREQUENCY
                                     REAL PART            IMAGINARY PART
                           (RAD/TIME)      (CYCLES/TIME     (RAD/TIME)

      1  -0.4018860E-04   0.0000000E+00   0.0000000E+00   0.6339448E-02
      2   0.2220662E+04   0.4712390E+02   0.7500003E+01   0.0000000E+00

     P A R T I C I P A T I O N   F A C T O R S

MODE NO.   X-COMPONENT     Y-COMPONENT     Z-COMPONENT     X-ROTATION      Y-ROTATION      Z-ROTATION

      1   0.2122819E+01  -0.1057348E-01   0.2022589E+01  -0.6706862E+00  -0.1044963E+01  -0.1080056E-01
      2   0.3296636D-07  -0.6513646E-03  -0.8713048E-08   0.1649775E-05   0.6513993E-03  -0.4979463E-03
";

#[test]
fn eigenvalues_come_from_the_dat_file_with_their_sign() {
    let path = file("dat", "model.frd", frd(&small()));
    file("dat", "model.dat", DAT);
    let read = read_structure(&path, None, None).unwrap();
    assert_eq!(read.modes[0].eigenvalue, -0.401_886e-4);
    assert_eq!(read.modes[0].frequency_hz, 0.0);
    assert_eq!(read.modes[1].frequency_hz, 7.500_003);
    assert_eq!(read.modes[1].generalised_stiffness, 2.5 * 2220.662);
    assert_eq!(
        read.modes[1].participation,
        Some(Vec3::new(3.296_636e-8, -6.513_646e-4, -8.713_048e-9))
    );
}

#[test]
fn a_dat_file_of_another_run_is_refused() {
    let path = file("dat_other", "model.frd", frd(&small()));
    file(
        "dat_other",
        "model.dat",
        DAT.replace("0.7500003E+01", "0.7501003E+01"),
    );
    let message = read_structure(&path, None, None).unwrap_err().to_string();
    assert!(
        message.contains("7.501003") && message.contains("different runs"),
        "{message}"
    );
    let row = "      2   0.2220662E+04   0.4712390E+02   0.7500003E+01   0.0000000E+00\n";
    file("dat_other", "model.dat", DAT.replace(row, ""));
    let message = read_structure(&path, None, None).unwrap_err().to_string();
    assert!(
        message.contains("1 eigenvalues, but the result file has 2 modes"),
        "{message}"
    );
    file("dat_other", "model.dat", "nothing of the kind\n");
    let message = read_structure(&path, None, None).unwrap_err().to_string();
    assert!(
        message.contains("the table of eigenvalues is missing"),
        "{message}"
    );
}

/// Nodes and elements of the small wing with sets of every spelling.
fn input(result: &ModalResult) -> String {
    let mut text = String::from("** a comment\n*Heading\nsome words\n*NODE, NSET=Nall\n");
    for node in &result.nodes {
        let p = node.position;
        text += &format!("{}, {}, {},{}\n", node.id, p.x, p.y, p.z);
    }
    text += "*NODE\n9001, 5.\n";
    text += "*ELEMENT, TYPE=S8R, ELSET=Skin\n";
    for element in &result.elements {
        let nodes: Vec<String> = element
            .nodes
            .iter()
            .map(|n| result.nodes[*n as usize].id.to_string())
            .collect();
        text += &format!(
            "{},{},\n  {}\n",
            element.id,
            nodes[..5].join(","),
            nodes[5..].join(",")
        );
    }
    text +=
        "*ELEMENT, TYPE=SPRINGA, ELSET=SPRING\n9000, 1, 9001\n*SPRING, ELSET=SPRING\n\n4.\n";
    text += "*ELEMENT, TYPE=U77\n9002, 1, 2, 3, 4\n";
    text += "*ELSET, ELSET=ODD, GENERATE\n1, 8000000000, 2\n*elset, elset=FEW\n1, 2,\n3\n";
    text += "*ELSET, ELSET=BOTH\nodd, Few, 4\n*NSET, NSET=TIP\n1,2,3,\n4\n";
    text + "*STEP\n*FREQUENCY\n2\n*END STEP\n"
}

#[test]
fn sets_elements_and_positions_come_from_the_input_file() {
    let written = small();
    let path = file("inp", "model.frd", frd(&written));
    for ends in ["\n", "\r\n"] {
        let geometry = file("inp", "model.inp", input(&written).replace('\n', ends));
        let read = read_structure(&path, Some(&geometry), None).unwrap();
        assert_eq!(read.elements, written.elements);
        assert_eq!(read.positions(), written.positions());
        let set = |name: &str| {
            let set = read
                .element_sets
                .iter()
                .find(|set| set.name == name)
                .unwrap();
            set.members
                .iter()
                .map(|m| read.elements[*m as usize].id)
                .collect::<Vec<_>>()
        };
        let count = written.elements.len() as u64;
        assert_eq!(set("Skin"), (1..=count).collect::<Vec<_>>());
        assert_eq!(set("ODD"), (1..=count).step_by(2).collect::<Vec<_>>());
        assert_eq!(set("FEW"), [1, 2, 3]);
        let both: Vec<u64> = (1..=count)
            .filter(|id| id % 2 == 1 || *id == 2 || *id == 4)
            .collect();
        assert_eq!(set("BOTH"), both);
        assert_eq!(
            read.node_sets
                .iter()
                .find(|set| set.name == "TIP")
                .unwrap()
                .members,
            [0, 1, 2, 3]
        );
        let notes = read.notes.join("\n");
        println!("{notes}");
        assert!(notes.contains("type U77 are not known here"));
        assert!(notes.contains("1 nodes carry no displacements and are left out: 9001"));
        assert!(
            notes.contains(
                "1 elements with nodes that carry no displacements are left out: 9000"
            )
        );
    }
}

#[test]
fn included_files_are_read_and_loops_refused() {
    let written = small();
    let path = file("include", "model.frd", frd(&written));
    file("include", "part.inc", input(&written));
    let geometry = file("include", "model.inp", "*INCLUDE, INPUT=part.inc\n");
    let read = read_structure(&path, Some(&geometry), None).unwrap();
    assert_eq!(read.elements.len(), written.elements.len());
    let own = file("include", "own.inp", "*INCLUDE, INPUT=own.inp\n");
    let message = read_structure(&path, Some(&own), None)
        .unwrap_err()
        .to_string();
    assert!(message.contains("nested too deep"), "{message}");
}

#[test]
fn geometry_that_does_not_fit_the_result_is_refused() {
    let written = small();
    let path = file("unfit", "model.frd", frd(&written));
    let mut moved = written.clone();
    moved.nodes[6].position.y += 0.01;
    let try_with = |text: String| {
        let geometry = file("unfit", "model.inp", text);
        read_structure(&path, Some(&geometry), None)
            .unwrap_err()
            .to_string()
    };
    let message = try_with(input(&moved));
    assert!(
        message.contains("node 7 lies") && message.contains("away"),
        "{message}"
    );
    let mut fewer = written.clone();
    fewer.nodes.pop();
    fewer.elements.truncate(4);
    let message = try_with(input(&fewer));
    assert!(message.contains("OUTPUT=2D"), "{message}");
    let message = try_with(input(&written).replace("*NODE, NSET=Nall", "*NODE, SYSTEM=C"));
    assert!(message.contains("cylindrical"), "{message}");
    let message = try_with(input(&written).replace("TYPE=S8R", "TYPE=S6"));
    assert!(
        message.contains("element 1 has 8 nodes and needs 6"),
        "{message}"
    );
    let message =
        try_with(input(&written).replace("*ELSET, ELSET=BOTH\nodd", "*ELSET, ELSET=BOTH\nodt"));
    assert!(message.contains("BOTH refers to odt"), "{message}");
    let message = try_with("HELLO, 1\n".to_owned());
    assert!(message.contains("HELLO, 1"), "{message}");
}

/// The file lists the upright edges before the top ones; input the other way.
#[test]
fn bricks_of_twenty_nodes_come_in_input_order() {
    let mut text = String::from(
        "    1C\n    2C                            20                                     1\n",
    );
    let line = |id: u32| {
        format!(
            " -1{id:10}{}{}{}\n",
            common::e12(f64::from(id)),
            common::e12(0.5),
            common::e12(0.0)
        )
    };
    (1..=20).for_each(|id| text += &line(id));
    text += " -3\n    3C                             1                                     1\n -1         1    4    0    1\n";
    for row in [1, 11] {
        text += " -2";
        (row..row + 10).for_each(|id| text += &format!("{id:10}"));
        text += "\n";
    }
    text += " -3\n  100CL  101 1.00000E+00          20                     2    1MODAL      1\n -4  DISP        4    1\n";
    (1..=3).for_each(|k| text += &format!(" -5  D{k}          1    2    {k}    0\n"));
    (1..=20).for_each(|id| text += &line(id));
    text += " -3\n 9999\n";
    let read = read("hex20", text).unwrap();
    assert_eq!(read.elements[0].kind, ElementKind::Hex20);
    let expected: Vec<u32> = (0..12).chain(16..20).chain(12..16).collect();
    assert_eq!(read.elements[0].nodes, expected);
}

/// CalculiX's own file, decompressed and cut.
#[test]
fn the_result_of_a_real_run_cut_at_many_lengths_is_refused() {
    use std::io::Read;
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../cases/scaneagle/modes.frd.gz");
    let mut text = Vec::new();
    flate2::read::GzDecoder::new(std::fs::File::open(path).unwrap())
        .read_to_end(&mut text)
        .unwrap();
    assert_eq!(read("real", &text).unwrap().modes.len(), 26);
    let whole = text.len() - "\n".len();
    // Spread over the file, and every byte of its last two lines.
    let lengths = (0..40).map(|k| k * whole / 40).chain(whole - 60..whole);
    for length in lengths {
        let failed = read("real_cut", &text[..length]).map(|read| read.modes.len());
        assert!(failed.is_err(), "{length} of {whole} bytes");
    }
}
