//! What several whole-chain tests need.
#![allow(dead_code, reason = "each test file uses its part")]
#![allow(unused_imports, reason = "each test file uses its part")]

use fladder_bem::{Flow, Solution};
use fladder_mesh::{SurfaceMode, TrailingEdge, TriMesh};
use fladder_tests::case::Setup;
use std::collections::BTreeMap;

pub(crate) use fladder_tests::case::{edges, mode};

/// Solution with the given modes at an incidence.
pub(crate) fn solved(
    mesh: &TriMesh,
    edges: &[TrailingEdge],
    modes: &[SurfaceMode],
    flow: Flow,
    semichord: f64,
) -> Solution {
    let setup = Setup {
        flow,
        semichord,
        trailing_edges: Some(edges),
        ..Setup::new(mesh, modes)
    };
    setup.solve().expect("a sound problem")
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
    let body = ["FUS", "FUSZ0", "FUSZ1", "FUSZ2", "FUSZ3", "FUSN", "FUST"];
    let both: Vec<String> = body
        .iter()
        .flat_map(|s| [(*s).to_owned(), format!("{s}_P")])
        .collect();
    for group in ["fuselage_r", "fuselage_l"] {
        map.insert(group.to_owned(), both.clone());
    }
    map
}
