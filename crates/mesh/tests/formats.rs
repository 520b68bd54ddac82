//! Every format that is read, from files of another program and from our own.
#![allow(clippy::unwrap_used, reason = "a failed read fails the test")]

use std::io::Write;
use std::path::{Path, PathBuf};

use fladder_mesh::judge::{Settings, judge};
use fladder_mesh::read::{Format, Loaded, ReadError, load, parse};
use fladder_mesh::shapes::{NacaWing, icosphere};
use fladder_mesh::{Topology, TriMesh, vtu, write};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

fn parse_bytes(bytes: &[u8]) -> Result<Loaded, ReadError> {
    parse(bytes, Path::new("memory"), 1.0)
}

fn area_of(mesh: &TriMesh, group: &str) -> f64 {
    let triangles = &mesh.surface(group).unwrap().triangles;
    triangles
        .iter()
        .map(|&t| mesh.area_vector(t as usize).norm())
        .sum()
}

fn sorted(mesh: &TriMesh, group: &str) -> Vec<[u32; 3]> {
    let triangles = &mesh.surface(group).unwrap().triangles;
    let mut triangles: Vec<[u32; 3]> = triangles
        .iter()
        .map(|&t| mesh.triangles[t as usize])
        .collect();
    triangles.sort_unstable();
    triangles
}

/// Closed, of area 7 m² and volume 1 m³, as a box of 2 × 1 × 0.5 m is.
fn assert_is_the_box(mesh: &TriMesh, tolerance: f64) {
    let topology = Topology::new(mesh);
    assert!((0..topology.edges.len()).all(|edge| topology.edge_triangles(edge).len() == 2));
    assert_eq!(
        mesh.vertices.len() + mesh.triangles.len() - topology.edges.len(),
        2
    );
    assert!(
        (mesh.area() - 7.0).abs() < tolerance,
        "area {}",
        mesh.area()
    );
    assert!(
        (mesh.volume() - 1.0).abs() < tolerance,
        "volume {}",
        mesh.volume()
    );
}

const MSH: [&str; 4] = [
    "box_22_ascii.msh",
    "box_22_binary.msh",
    "box_41_ascii.msh",
    "box_41_binary.msh",
];

#[test]
fn the_four_flavours_of_gmsh_give_the_same_box_and_groups() {
    let mut first: Option<TriMesh> = None;
    for name in MSH {
        let loaded = load(data(name), 1.0).unwrap();
        assert_eq!(loaded.format, Format::Msh);
        let mesh = loaded.mesh;
        // Gmsh places edge points within 3e-12.
        assert_is_the_box(&mesh, 1e-10);
        let names: Vec<&str> = mesh
            .surfaces
            .iter()
            .map(|group| group.name.as_str())
            .collect();
        assert_eq!(names, ["top", "rest of it", "9"], "{name}");
        for (group, area) in [("top", 2.0), ("rest of it", 5.0), ("9", 2.5)] {
            assert!(
                (area_of(&mesh, group) - area).abs() < 1e-10,
                "{group} of {name}"
            );
        }
        let curve = mesh.curve("upper back edge").unwrap();
        let at = |v: u32| mesh.vertices[v as usize];
        let length: f64 = curve
            .edges
            .iter()
            .map(|&[a, b]| (at(b) - at(a)).norm())
            .sum();
        assert!((length - 1.0).abs() < 1e-10);
        assert!(
            curve
                .edges
                .iter()
                .flatten()
                .all(|&v| at(v).x == 2.0 && at(v).z == 0.5)
        );
        // The versions order the faces differently, so sets are compared.
        let first = first.get_or_insert_with(|| mesh.clone());
        for group in ["top", "rest of it", "9"] {
            assert_eq!(
                sorted(&mesh, group),
                sorted(first, group),
                "{group} of {name}"
            );
        }
        assert_eq!(mesh.curves, first.curves);
    }
}

#[test]
fn stl_is_welded_and_says_how_many_vertices_became_one() {
    for (name, format) in [
        ("box_ascii.stl", Format::StlAscii),
        ("box_binary.stl", Format::StlBinary),
    ] {
        let loaded = load(data(name), 1.0).unwrap();
        assert_eq!(loaded.format, format);
        assert_is_the_box(&loaded.mesh, 1e-6);
        let (n_triangles, n_vertices) =
            (loaded.mesh.triangles.len(), loaded.mesh.vertices.len());
        let said = format!(
            "{} corners of {n_triangles} triangles welded to {n_vertices}",
            3 * n_triangles
        );
        assert!(loaded.notes[0].starts_with(&said), "{:?}", loaded.notes);
    }
}

#[test]
fn a_binary_stl_whose_header_says_solid_is_read() {
    let mut bytes = std::fs::read(data("box_binary.stl")).unwrap();
    bytes[..20].copy_from_slice(b"solid facet by name ");
    let loaded = parse_bytes(&bytes).unwrap();
    assert_eq!(loaded.format, Format::StlBinary);
    assert_is_the_box(&loaded.mesh, 1e-6);
}

#[test]
fn several_solids_of_a_text_stl_become_groups() {
    let facet = |z: f64| {
        format!(
            "facet normal 0 0 1\n outer loop\n vertex 0 0 {z}\n vertex 1 0 {z}\n vertex 0 1 {z}\n endloop\nendfacet\n"
        )
    };
    let text = format!(
        "solid left wing\n{}{}endsolid left wing\r\nsolid tail\n{}endsolid\n",
        facet(0.0),
        facet(1.0),
        facet(2.0)
    );
    let mesh = parse_bytes(text.as_bytes()).unwrap().mesh;
    assert_eq!(mesh.surface("left wing").unwrap().triangles, [0, 1]);
    assert_eq!(mesh.surface("tail").unwrap().triangles, [2]);
}

#[test]
fn an_stl_whose_count_is_too_small_is_refused_with_both_numbers() {
    let mut bytes = std::fs::read(data("box_binary.stl")).unwrap();
    bytes[80..84].copy_from_slice(&3_u32.to_le_bytes());
    let message = parse_bytes(&bytes).unwrap_err().to_string();
    assert!(
        message.contains("announces 3 triangles") && message.contains("hold 92"),
        "{message}"
    );
}

#[test]
fn obj_of_gmsh_gives_the_box() {
    let loaded = load(data("box.obj"), 1.0).unwrap();
    assert_eq!(loaded.format, Format::Obj);
    assert_is_the_box(&loaded.mesh, 1e-10);
}

/// Groups, negative indices, normals, polygons, comments, CRLF, lines.
#[test]
fn obj_cuts_polygons_and_counts_back_from_the_end() {
    let text = "# a pyramid\r\no hull\r\nv 0 0 0\r\nv 0 1 0\r\nv 1 1 0 # base\r\nv 1 0 0\r\n\
                v 0.5 0.5 1\r\nvn 0 0 1\r\nf 1/1/1 2//1 3 4\r\ng sides\r\nf -5 -2 -1\r\nf 4 3 5\r\n\
                f 3 2 5\r\nf 2 1 5\r\ng rim\r\nl 1 2 3\r\n";
    let mesh = parse_bytes(text.as_bytes()).unwrap().mesh;
    assert_eq!(mesh.triangles.len(), 6);
    assert_eq!(mesh.surface("hull").unwrap().triangles, [0, 1]);
    assert_eq!(mesh.surface("sides").unwrap().triangles, [2, 3, 4, 5]);
    assert_eq!(mesh.curve("rim").unwrap().edges, [[0, 1], [1, 2]]);
    // Base 1 m², height 1 m.
    assert!((mesh.volume() - 1.0 / 3.0).abs() < 1e-15);
    let pentagon = "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n";
    let mesh = parse_bytes(pentagon.as_bytes()).unwrap().mesh;
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
}

/// A rhombus has angles of 60° and 120°: the short diagonal leaves 60°
/// triangles, the long one 30°.
#[test]
fn quadrilaterals_are_cut_along_the_better_diagonal() {
    let text = "v 0 0 0\nv 1 0 0\nv 1.5 0.8660254 0\nv 0.5 0.8660254 0\nf 1 2 3 4\nf 2 3 4 1\n";
    let mesh = parse_bytes(text.as_bytes()).unwrap().mesh;
    assert!(
        mesh.triangles
            .iter()
            .all(|t| t.contains(&1) && t.contains(&3)),
        "{:?}",
        mesh.triangles
    );
}

#[test]
fn gzip_is_seen_through() {
    for name in MSH
        .iter()
        .chain(&["box_ascii.stl", "box_binary.stl", "box.obj"])
    {
        let plain = std::fs::read(data(name)).unwrap();
        let path =
            std::env::temp_dir().join(format!("fladder-{}-{name}.gz", std::process::id()));
        let mut encoder = flate2::write::GzEncoder::new(
            std::fs::File::create(&path).unwrap(),
            flate2::Compression::fast(),
        );
        encoder.write_all(&plain).unwrap();
        encoder.finish().unwrap();
        let packed = load(&path, 1.0).unwrap();
        std::fs::remove_file(&path).unwrap();
        assert_eq!(packed, load(data(name), 1.0).unwrap());
    }
}

#[test]
fn scale_turns_file_units_into_metres() {
    let metres = load(data("box_41_binary.msh"), 1.0).unwrap().mesh;
    let millimetres = load(data("box_41_binary.msh"), 1e-3).unwrap().mesh;
    assert!((millimetres.volume() / metres.volume() - 1e-9).abs() < 1e-20);
    for bad in [0.0, -1.0, f64::NAN] {
        assert!(matches!(
            load(data("box.obj"), bad),
            Err(ReadError::Scale(_))
        ));
    }
}

#[test]
fn what_is_written_is_read_back_bit_for_bit() {
    let wing = NacaWing {
        sweep_deg: 30.0,
        ..NacaWing::default()
    };
    let mut meshes = vec![
        icosphere(3),
        wing.structured().unwrap(),
        wing.unstructured(4).unwrap(),
    ];
    // Overlapping and interleaved groups, and triangles of no group.
    let mut mixed = icosphere(2);
    mixed.surfaces[0].triangles.retain(|t| t % 3 == 0);
    mixed.surfaces.push(fladder_mesh::SurfaceGroup {
        name: "every other".into(),
        triangles: (0..80).step_by(2).collect(),
    });
    meshes.push(mixed);
    meshes.push(load(data("box_41_ascii.msh"), 1.0).unwrap().mesh);
    for mesh in meshes {
        let mut bytes = Vec::new();
        write::msh41(&mut bytes, &mesh).unwrap();
        let back = parse_bytes(&bytes).unwrap();
        assert_eq!(back.mesh, mesh);
        assert_eq!(back.notes, Vec::<String>::new());
    }
}

#[test]
fn a_written_stl_has_the_same_volume_in_single_precision() {
    let mesh = icosphere(6);
    let mut bytes = Vec::new();
    write::stl(&mut bytes, &mesh).unwrap();
    let back = parse_bytes(&bytes).unwrap().mesh;
    assert_eq!(
        (back.vertices.len(), back.triangles.len()),
        (mesh.vertices.len(), mesh.triangles.len())
    );
    assert!((back.volume() - mesh.volume()).abs() < 1e-6);
}

/// Written by VTK from the box of Gmsh, with triangles and quadrilaterals: coordinates have
/// single precision in text and binary of either byte order.
#[test]
fn ply_of_vtk_gives_the_box() {
    for name in ["box_ascii.ply", "box_little.ply", "box_big.ply"] {
        let loaded = load(data(name), 1.0).unwrap();
        assert_eq!(loaded.format, Format::Ply);
        assert_is_the_box(&loaded.mesh, 1e-6);
        assert_eq!(loaded.mesh.triangles.len(), 70 + 2 * 11);
    }
}

/// Every way in which VTK writes numbers, of both byte orders and widths of lengths, with
/// and without zlib. In text it writes ten digits.
#[test]
fn vtu_of_vtk_gives_the_box_with_groups_and_lines() {
    let mut first: Option<TriMesh> = None;
    for name in [
        "box_inline.vtu",
        "box_inline_zlib.vtu",
        "box_raw.vtu",
        "box_raw_zlib.vtu",
        "box_base64.vtu",
        "box_base64_zlib.vtu",
        "box_ascii.vtu",
    ] {
        let loaded = load(data(name), 1.0).unwrap();
        assert_eq!(loaded.format, Format::Vtu);
        let mesh = loaded.mesh;
        assert_is_the_box(&mesh, if name.contains("ascii") { 1e-8 } else { 1e-10 });
        assert!(mesh.surface("group_7").is_some());
        assert_eq!(mesh.curve("lines").unwrap().edges.len(), 2);
        if !name.contains("ascii") {
            assert_eq!(*first.get_or_insert_with(|| mesh.clone()), mesh, "{name}");
        }
    }
}

#[test]
fn nastran_in_small_large_and_free_fields_gives_the_box() {
    for name in ["box_small.bdf", "box_large.bdf", "box_free.bdf"] {
        let loaded = load(data(name), 1.0).unwrap();
        assert_eq!(loaded.format, Format::Nastran);
        let mesh = loaded.mesh;
        // Eight columns hold six digits.
        let tolerance = if name.contains("small") { 1e-5 } else { 1e-9 };
        assert_is_the_box(&mesh, tolerance);
        assert_eq!(mesh.triangles.len(), 70 + 2 * 11);
        assert!(mesh.surface("pshell_7").is_some());
    }
    // All free, a card that goes on, comments, lines for a curve group, no frame.
    let loaded = parse_bytes(
        b"$ comment\nGRID,1,0,0.,0.\n,0.,,\ngrid,2,,1.+0,0.,0.\nGRID,3,,0.,10.-1,0.\n\
          CTRIA3,1,4,1,2,3 $ all\nPLOTEL,2,1,2\nCBAR,9,9,1,2,0.,0.,1.\nPSHELL,4,1,.1\n",
    )
    .unwrap();
    assert!((loaded.mesh.area() - 0.5).abs() < 1e-15);
    assert_eq!(loaded.mesh.surface("pshell_4").unwrap().triangles, [0]);
    assert_eq!(loaded.mesh.curve("plotel").unwrap().edges, [[0, 1]]);
    assert_eq!(loaded.notes, ["cards that are not read: 1 of CBAR"]);
}

/// The picture of a surface is a mesh again, bit for bit.
#[test]
fn a_written_vtu_is_read_back_bit_for_bit() {
    let mesh = NacaWing::default().structured().unwrap();
    let group: Vec<i32> = (0..mesh.triangles.len() as i32).map(|t| t % 3).collect();
    let grid = vtu::Grid {
        points: &mesh.vertices,
        triangles: &mesh.triangles,
        lines: &mesh.curves[0].edges,
        cell_data: vec![vtu::Field::integers(
            "group",
            group
                .iter()
                .copied()
                .chain(mesh.curves[0].edges.iter().map(|_| 0))
                .collect(),
        )],
        ..vtu::Grid::default()
    };
    let mut bytes = Vec::new();
    vtu::vtu(&mut bytes, &grid).unwrap();
    let back = parse_bytes(&bytes).unwrap().mesh;
    assert_eq!(
        (&back.vertices, &back.triangles),
        (&mesh.vertices, &mesh.triangles)
    );
    assert_eq!(back.curves[0].edges, mesh.curves[0].edges);
    let second = &back.surface("group_2").unwrap().triangles;
    assert!(second.iter().all(|t| t % 3 == 2) && second.len() == mesh.triangles.len() / 3);
}

#[test]
fn faults_of_ply_vtu_and_nastran_are_named() {
    let text = |name: &str| String::from_utf8(std::fs::read(data(name)).unwrap()).unwrap();
    let ply = text("box_ascii.ply");
    let vtu = text("box_ascii.vtu");
    let bdf = text("box_small.bdf");
    for (file, said) in [
        (
            ply.replace("vertex 48", "vertex 4000000000"),
            "3999999999 records are announced",
        ),
        (
            ply.replace("ascii 1.0", "utf 1.0"),
            "line 2: format `utf` is not known",
        ),
        (ply.replace("float z", "float w"), "no coordinate `z`"),
        (
            ply.replace("int vertex_indices", "int strips"),
            "no list `vertex_indices`",
        ),
        (
            ply.replace("end_header\n0 0 0", "end_header\n0 x 0"),
            "`x` is not a number",
        ),
        (
            vtu.replace("UnstructuredGrid\" v", "PolyData\" v"),
            "VTK file of type `PolyData`",
        ),
        (
            vtu.replace("</VTKFile>", ""),
            "does not end with `</VTKFile>`",
        ),
        (
            vtu.replace("Name=\"types\"", "Name=\"tips\""),
            "no array of types",
        ),
        (
            vtu.replace(
                "header_type",
                "compressor=\"vtkLZ4DataCompressor\" header_type",
            ),
            "compressed by `vtkLZ4DataCompressor`, which is not read",
        ),
        (
            bdf.replace("GRID    2       ", "GRID    2       7"),
            "coordinate system `7`",
        ),
        (
            bdf.replace("GRID    2 ", "GRID    1 "),
            "line 4: node 1 is there twice",
        ),
        (
            bdf.replace("CQUAD4 ", "CQUAD8 "),
            "`CQUAD8` has nodes on its edges",
        ),
        (bdf.replace("ENDDATA", ""), "`BEGIN BULK` has no `ENDDATA`"),
        (
            bdf.replacen("     0.5\n", "     0,5\n", 1),
            "line 4: field 6 of GRID is `0,5`, not a number",
        ),
        (
            bdf.replace("BEGIN BULK", "BEGIN BULK\nINCLUDE 'wing.bdf'"),
            "includes another one",
        ),
    ] {
        let message = refusal(file.as_bytes());
        assert!(message.contains(said), "{message} instead of {said}");
    }
    // A volume element by its number.
    let points = "<Points><DataArray type=\"Float64\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1\
                  </DataArray></Points>";
    let cells = |kind: u8| {
        let array = |name: &str, values: &str| {
            format!(
                "<DataArray type=\"Int32\" Name=\"{name}\" format=\"ascii\">{values}</DataArray>"
            )
        };
        let arrays = [
            array("connectivity", "0 1 2 3"),
            array("offsets", "4"),
            array("types", &kind.to_string()),
        ];
        format!(
            "<VTKFile type=\"UnstructuredGrid\"><Piece>{points}<Cells>{}</Cells></Piece></VTKFile>",
            arrays.concat()
        )
    };
    let message = refusal(cells(10).as_bytes());
    assert!(message.contains("cell 0 is of VTK type 10, which is no flat surface element"));
    assert_eq!(
        parse_bytes(cells(9).as_bytes())
            .unwrap()
            .mesh
            .triangles
            .len(),
        2
    );
    let pixel = parse_bytes(cells(8).as_bytes()).unwrap().mesh.triangles;
    assert_eq!(pixel, [[0, 1, 3], [0, 3, 2]]);
}

/// Message of a file that must be refused.
fn refusal(bytes: &[u8]) -> String {
    parse_bytes(bytes).unwrap_err().to_string()
}

#[test]
fn versions_and_elements_that_are_not_read_are_named() {
    let file = |name: &str| std::fs::read(data(name)).unwrap();
    for (name, said) in [
        (
            "box_40.msh",
            "line 2: format version `4` is not read; save as version 4.1 or 2.2",
        ),
        ("box_10.msh", "format version 1"),
        ("box_order2.msh", "3-node line"),
    ] {
        let message = refusal(&file(name));
        assert!(message.contains(said), "{message}");
    }
    let mut other_order = file("box_41_binary.msh");
    let at = other_order
        .windows(7)
        .position(|w| w == b"4.1 1 8")
        .unwrap()
        + 8;
    other_order[at..at + 4].reverse();
    assert!(refusal(&other_order).contains("other byte order"));
    assert!(refusal(b"# vtk DataFile Version 3.0\n").contains("a legacy VTK file"));
    assert!(refusal(b"").contains("empty"));
    assert!(refusal(b"hello world\n").contains("none of"));
}

#[test]
fn a_wrong_number_is_reported_with_its_line() {
    let text = String::from_utf8(std::fs::read(data("box_22_ascii.msh")).unwrap()).unwrap();
    let line = text.lines().position(|line| line == "2 0 0 0.5").unwrap() + 1;
    let message = refusal(text.replace("\n2 0 0 0.5\n", "\n2 0 0 0,5\n").as_bytes());
    assert!(
        message.starts_with(&format!("memory, line {line}: `0,5` is not a number")),
        "{message}"
    );
    let message = refusal(b"v 0 0 0\nv 1 0 0\nv 0 1 zero\nf 1 2 3\n");
    assert!(
        message.starts_with("memory, line 3: `zero` is not a number"),
        "{message}"
    );
}

#[test]
fn a_hostile_count_is_refused_against_the_file_size() {
    let text = String::from_utf8(std::fs::read(data("box_22_ascii.msh")).unwrap()).unwrap();
    let message = refusal(
        text.replace("$Nodes\n48\n", "$Nodes\n4000000000\n")
            .as_bytes(),
    );
    assert!(
        message.contains("4000000000 records are announced"),
        "{message}"
    );
}

#[test]
fn a_node_that_is_not_there_is_passed_on_and_noted() {
    let loaded = parse_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n").unwrap();
    assert_eq!(
        loaded.mesh.triangles[1],
        [0, 1, fladder_mesh::read::MISSING_VERTEX]
    );
    assert!(
        loaded.notes[0].contains("line 5 names vertex 9"),
        "{:?}",
        loaded.notes
    );
}

#[test]
fn a_coordinate_that_is_no_number_is_passed_on_and_its_line_noted() {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 nan 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let text = String::from_utf8(std::fs::read(data("box_22_ascii.msh")).unwrap()).unwrap();
    let line = text.lines().position(|line| line == "2 0 0 0.5").unwrap() + 1;
    let msh = text.replace("\n2 0 0 0.5\n", "\n2 0 inf 0.5\n");
    for (text, line, vertex) in [(obj, 3, 2), (&msh, line, 1)] {
        let loaded = parse_bytes(text.as_bytes()).unwrap();
        assert_eq!(
            loaded.notes,
            [format!(
                "coordinates that are no finite numbers: line {line}"
            )]
        );
        assert!(!loaded.mesh.vertices[vertex].y.is_finite());
        assert!(judge(loaded.mesh, Settings::default()).has_errors());
    }
}

#[test]
fn unused_vertices_are_dropped_and_said() {
    let loaded = parse_bytes(b"v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n").unwrap();
    assert_eq!(loaded.mesh.vertices.len(), 3);
    assert_eq!(
        loaded.notes,
        ["vertices that no triangle uses were dropped: 1"]
    );
}

/// What is read is judged too, to see that the judge survives it.
fn parse_and_judge(bytes: &[u8]) -> Result<TriMesh, ReadError> {
    let mesh = parse_bytes(bytes)?.mesh;
    Ok(judge(mesh, Settings::default()).mesh)
}

/// Truncated at every length and with bytes changed, no reader panics, and a
/// text or size that no longer fits is refused, not half read.
#[test]
fn damaged_files_never_panic() {
    let mut n_refused = 0;
    let mut n_tried = 0;
    let mut random = 1_u64;
    let mut next = move |below: usize| {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (random >> 33) as usize % below
    };
    for name in MSH.iter().chain(&[
        "box_ascii.stl",
        "box_binary.stl",
        "box.obj",
        "box_order2.msh",
        "box_ascii.ply",
        "box_big.ply",
        "box_ascii.vtu",
        "box_inline_zlib.vtu",
        "box_raw.vtu",
        "box_base64_zlib.vtu",
        "box_small.bdf",
        "box_large.bdf",
    ]) {
        let whole = std::fs::read(data(name)).unwrap();
        for length in 0..whole.len() {
            let outcome = parse_and_judge(&whole[..length]);
            n_tried += 1;
            n_refused += usize::from(outcome.is_err());
            let has_end_mark = *name != "box.obj";
            // The very last bytes are the newline after the end mark.
            assert!(
                outcome.is_err() || !has_end_mark || length + 40 > whole.len(),
                "{name} cut to {length}"
            );
        }
        for _ in 0..2000 {
            let mut bytes = whole.clone();
            for _ in 0..=next(3) {
                let at = next(bytes.len());
                bytes[at] = if next(2) == 0 {
                    bytes[at] ^ (1 << next(8))
                } else {
                    next(256) as u8
                };
            }
            n_tried += 1;
            n_refused += usize::from(parse_and_judge(&bytes).is_err());
        }
    }
    println!("{n_tried} damaged files, {n_refused} refused");
    assert!(n_refused > n_tried / 2);
}

/// Random triangles over few vertices, some not finite or far out, with bad
/// indices: hardly ever a surface, never a panic.
mod hostile {
    use fladder_mesh::Vec3;
    use proptest::prelude::*;

    use super::{Settings, TriMesh, judge};

    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![
            8 => -1.0..1.0,
            4 => (-2..3).prop_map(f64::from),
            1 => any::<f64>(),
            1 => Just(f64::NAN),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn any_triangles_are_judged_without_a_panic(
            points in prop::collection::vec([coordinate(), coordinate(), coordinate()], 0..12),
            triangles in prop::collection::vec([0..14_u32, 0..14, 0..14], 0..40),
            symmetry_plane in any::<bool>(),
        ) {
            let n_triangles = triangles.len();
            let mesh = TriMesh {
                vertices: points.into_iter().map(Vec3::from).collect(),
                triangles,
                ..TriMesh::default()
            };
            let judgement = judge(mesh, Settings { symmetry_plane, ..Settings::default() });
            prop_assert_eq!(judgement.mesh.triangles.len(), n_triangles);
            for fault in &judgement.faults {
                prop_assert!(!fault.message().is_empty());
            }
        }
    }
}
