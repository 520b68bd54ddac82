//! What several whole-chain tests need.
#![allow(dead_code, reason = "each test file uses its part")]

use fladder_bem::{Flow, Problem, Silent, Solution, solve};
use fladder_mesh::{Frame, SurfaceMode, Topology, TrailingEdge, TriMesh, Vec3, trailing_edge};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A reference file of this test crate.
pub(crate) fn data(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("data")
        .join(name)
}

/// Rows of a comma-separated file with `#` comments and one header line.
pub(crate) fn csv(name: &str) -> Vec<std::collections::HashMap<String, String>> {
    let text = std::fs::read_to_string(data(name)).expect("reference file");
    let mut lines = text
        .lines()
        .filter(|l| !l.starts_with('#') && !l.trim().is_empty());
    let header: Vec<String> = lines
        .next()
        .expect("header")
        .split(',')
        .map(|s| s.trim().to_owned())
        .collect();
    lines
        .map(|line| {
            let cells = line.split(',').map(|s| s.trim().to_owned());
            header.iter().cloned().zip(cells).collect()
        })
        .collect()
}

/// Trailing edges by shape with the default settings.
pub(crate) fn edges(mesh: &TriMesh) -> Vec<TrailingEdge> {
    trailing_edge::find_by_shape(
        mesh,
        &Topology::new(mesh),
        trailing_edge::Settings::default(),
    )
}

/// A mode given by a field.
pub(crate) fn mode(
    mesh: &TriMesh,
    name: &str,
    frame: Frame,
    field: impl Fn(&Vec3) -> Vec3,
) -> SurfaceMode {
    SurfaceMode {
        name: name.into(),
        frame,
        displacement: mesh.vertices.iter().map(field).collect(),
    }
}

/// Solution with the given modes at an incidence.
pub(crate) fn solved(
    mesh: &TriMesh,
    edges: &[TrailingEdge],
    modes: &[SurfaceMode],
    flow: Flow,
    semichord: f64,
) -> Solution {
    let problem = Problem {
        flow,
        ..Problem::new(mesh, edges, modes, semichord)
    };
    solve(&problem, &Silent).expect("a sound problem")
}

/// Mesh groups of the ScanEagle-like surface and the sets of its structure: skins of each side, the fuselage as one; webs, ribs and springs left out.
pub(crate) fn scaneagle_components() -> BTreeMap<String, Vec<String>> {
    let mut map = BTreeMap::new();
    for (side, mark) in [("r", ""), ("l", "_P")] {
        let mut add = |group: &str, sets: &[&str]| {
            let sets = sets.iter().map(|set| format!("{set}{mark}")).collect();
            map.insert(format!("{group}_{side}"), sets);
        };
        add(
            "wing",
            &["WLE", "WCAP", "WBOX", "WTE", "LLE", "LCAP", "LBOX", "LTE"],
        );
        add(
            "winglet",
            &["WLE", "WCAP", "WBOX", "WTE", "LLE", "LCAP", "LBOX", "LTE"],
        );
        add("elevon", &["WCS"]);
        add("rudder", &["LCS"]);
    }
    let body = ["FUS", "FUSZ0", "FUSZ1", "FUSZ2", "FUSZ3"];
    let both: Vec<String> = body
        .iter()
        .flat_map(|s| [(*s).to_owned(), format!("{s}_P")])
        .collect();
    for group in ["fuselage_r", "fuselage_l"] {
        map.insert(group.to_owned(), both.clone());
    }
    map
}
