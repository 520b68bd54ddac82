//! Figures 2 to 7: mesh, structure, modes.

use fladder::plot::{ModePicture, Wireframe, mode_shape, wireframe};
use fladder_modal::ElasticMode;

use super::work::Work;

/// Figure 2.
pub(super) fn mesh(work: &Work) -> Option<String> {
    let mesh = work.study.mesh();
    let sizes = &work.study.solution().sizes;
    wireframe(&Wireframe {
        title: "Figure 2: wetted surface",
        caption: &format!(
            "{} triangles, {} vertices; wake: {} elements",
            mesh.triangles.len(),
            mesh.vertices.len(),
            sizes.wake_elements
        ),
        points: &mesh.vertices,
        triangles: &mesh.triangles,
        lines: &[],
        is_closed: true,
    })
}

/// Figure 3.
pub(super) fn structure(work: &Work) -> Option<String> {
    let model = work.study.structure()?;
    let cells = model.result.cells();
    wireframe(&Wireframe {
        title: "Figure 3: structure",
        caption: &format!(
            "{} elements, {} nodes; cells are cut into triangles",
            model.result.elements.len(),
            model.result.nodes.len()
        ),
        points: &model.result.positions(),
        triangles: &cells.triangles,
        lines: &cells.lines,
        is_closed: false,
    })
}

/// Figures 4 to 7: the modes whose frequencies are nearest to the paper's, each once.
pub(super) fn nearest_modes<'a>(
    work: &'a Work,
    wanted: &[f64],
) -> Vec<Option<&'a ElasticMode>> {
    let mut left: Vec<&ElasticMode> = work
        .study
        .structure()
        .iter()
        .flat_map(|model| &model.elastic)
        .collect();
    wanted
        .iter()
        .map(|frequency| {
            let distance = |mode: &ElasticMode| (mode.frequency_hz / frequency).ln().abs();
            let nearest = (0..left.len())
                .min_by(|a, b| distance(left[*a]).total_cmp(&distance(left[*b])))?;
            Some(left.remove(nearest))
        })
        .collect()
}

/// A mode on the surface.
pub(super) fn mode(
    work: &Work,
    figure: usize,
    mode: &ElasticMode,
    paper: &str,
) -> Option<String> {
    let shape = work
        .study
        .modes()
        .iter()
        .find(|shape| shape.name == mode.name)?;
    mode_shape(&ModePicture {
        title: &format!(
            "Figure {figure}: {}, {:.2} Hz (paper: {paper})",
            mode.name, mode.frequency_hz
        ),
        mesh: work.study.mesh(),
        displacement: &shape.displacement,
    })
}
