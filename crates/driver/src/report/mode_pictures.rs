//! Modes to look at: a picture of each, and files for ParaView.

use crate::chain::aircraft::Aircraft;
use crate::plot::{ModePicture, mode_shape};
use fladder_mesh::vtu::{Field, Grid, vtu};
use fladder_modal::{ModalResult, StructuralModel};

/// Name and picture of every mode on the surface that the case asks for, but for
/// rigid ones.
pub(crate) fn mode_pictures(aircraft: &Aircraft) -> Vec<(String, String)> {
    let frequency = |name: &str| {
        let mut elastic = aircraft
            .structure
            .model
            .iter()
            .flat_map(|model| &model.elastic);
        elastic
            .find(|mode| mode.name == name)
            .map(|mode| mode.frequency_hz)
    };
    let modes = aircraft.asked_modes().iter();
    modes
        .filter(|mode| !mode.name.starts_with("rigid:"))
        .filter_map(|mode| {
            let title = match frequency(&mode.name) {
                Some(frequency) => format!("{}, {frequency:.2} Hz", mode.name),
                None => mode.name.clone(),
            };
            let picture = mode_shape(&ModePicture {
                title: &title,
                mesh: &aircraft.surface.mesh,
                displacement: &mode.displacement,
            })?;
            Some((format!("{}.svg", file_name(&mode.name)), picture))
        })
        .collect()
}

/// Letters, digits, points, hyphens and underscores of a name, all else as `_`.
fn file_name(name: &str) -> String {
    let kept = |letter: char| letter.is_alphanumeric() || "-_.".contains(letter);
    name.chars()
        .map(|letter| if kept(letter) { letter } else { '_' })
        .collect()
}

/// The surface with the displacement of every mode.
pub(crate) fn surface_picture(aircraft: &Aircraft) -> std::io::Result<Vec<u8>> {
    let mesh = &aircraft.surface.mesh;
    let modes = aircraft.asked_modes().iter();
    file(&Grid {
        points: &mesh.vertices,
        triangles: &mesh.triangles,
        point_data: modes
            .map(|mode| Field::vectors(mode.name.as_str(), mode.displacement.clone()))
            .collect(),
        ..Grid::default()
    })
}

/// What is drawn of a structure.
pub(crate) enum Shown<'a> {
    /// A file as it is, in its units and axes.
    File(&'a ModalResult),
    /// Elastic modes in use, in metres and mesh axes.
    Model(&'a StructuralModel),
}

/// The structure with the displacement of every mode.
pub(crate) fn structure_picture(shown: &Shown<'_>) -> std::io::Result<Vec<u8>> {
    let (result, point_data) = match shown {
        Shown::File(result) => {
            let modes = result.modes.iter();
            let field = |(number, mode): (usize, &fladder_modal::Mode)| {
                let name = format!(
                    "mode {} at {:.4} Hz ({number})",
                    mode.index, mode.frequency_hz
                );
                Field::vectors(name, mode.displacement.clone())
            };
            (*result, (1..).zip(modes).map(field).collect())
        }
        Shown::Model(model) => {
            let field = |mode: &fladder_modal::ElasticMode| {
                Field::vectors(mode.name.as_str(), mode.shape.clone())
            };
            (&model.result, model.elastic.iter().map(field).collect())
        }
    };
    let cells = result.cells();
    file(&Grid {
        points: &result.positions(),
        triangles: &cells.triangles,
        lines: &cells.lines,
        point_data,
        ..Grid::default()
    })
}

fn file(grid: &Grid<'_>) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    vtu(&mut bytes, grid)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_modes_become_names_of_files() {
        assert_eq!(file_name("elastic:12"), "elastic_12");
        assert_eq!(file_name("../flap /<1>"), ".._flap___1_");
    }
}
