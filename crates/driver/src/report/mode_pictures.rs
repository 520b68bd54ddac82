//! Modes to look at: a picture of each, and files for ParaView.

use crate::chain::aircraft::Aircraft;
use crate::plot::{ModePicture, mode_shape};
use faer::c64;
use fladder_mesh::vtu::{Field, Grid, vtu};
use fladder_mesh::{SurfaceMode, Vec3};
use fladder_modal::{ModalResult, StructuralModel};
use fladder_stability::Crossing;

/// A picture and what it is called.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Named {
    pub(crate) name: String,
    pub(crate) picture: String,
}

impl Named {
    pub(crate) fn new(name: impl Into<String>, picture: String) -> Self {
        Self {
            name: name.into(),
            picture,
        }
    }
}

/// Every mode on the surface that the case asks for, but for rigid ones.
pub(crate) fn mode_pictures(aircraft: &Aircraft) -> Vec<Named> {
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
            Some(Named {
                name: mode.name.clone(),
                picture,
            })
        })
        .collect()
}

/// Crossings shown a quarter of a period later too: pictures make up most of a page.
const TWICE: usize = 2;

/// What moves at every crossing of the axis: the surface when the largest displacement is
/// reached, and for the first ones a quarter of a period later.
///
/// u(t) = Re [Σ_j x_j u_j e^{iωt}], x the eigenvector with its phase such that the largest
/// displacement is real.
pub(crate) fn flutter_pictures(aircraft: &Aircraft, crossings: &[Crossing]) -> Vec<Named> {
    let modes = aircraft.asked_modes();
    let mesh = &aircraft.surface.mesh;
    let mut pictures = Vec::new();
    let complete = crossings.iter().filter(|c| c.shape.len() <= modes.len());
    for (number, crossing) in complete.enumerate() {
        let part = |turn: c64| -> Vec<Vec3> {
            (0..mesh.vertices.len())
                .map(|v| {
                    let of_mode =
                        |(x, mode): (&c64, &SurfaceMode)| mode.displacement[v] * (x * turn).re;
                    crossing.shape.iter().zip(modes).map(of_mode).sum()
                })
                .collect()
        };
        let one = c64::new(1.0, 0.0);
        let quarter = c64::new(0.0, 1.0);
        let (real, imaginary) = (part(one), part(-quarter));
        let phase = real
            .iter()
            .zip(&imaginary)
            .max_by(|a, b| size(a).total_cmp(&size(b)))
            .map_or(0.0, |(re, im)| turned(re, im));
        let aligned = c64::from_polar(1.0, -phase);
        let phases = [
            ("", aligned),
            (", a quarter of a period later", aligned * quarter),
        ];
        let count = if number < TWICE { 2 } else { 1 };
        for (when, turn) in phases.into_iter().take(count) {
            let name = format!(
                "{} at {:.2} m/s, {:.2} Hz{when}",
                crossing.branch, crossing.speed, crossing.frequency_hz
            );
            let picture = mode_shape(&ModePicture {
                title: &name,
                mesh,
                displacement: &part(turn),
            });
            pictures.extend(picture.map(|picture| Named { name, picture }));
        }
    }
    pictures
}

fn size((re, im): &(&Vec3, &Vec3)) -> f64 {
    re.norm_squared() + im.norm_squared()
}

/// Phase at which Re[(a + ib) e^{−iφ}] is longest: tan 2φ = 2 a·b/(a² − b²).
fn turned(re: &Vec3, im: &Vec3) -> f64 {
    0.5 * (2.0 * re.dot(im)).atan2(re.norm_squared() - im.norm_squared())
}

/// Name of the file of a mode's picture.
pub(crate) fn picture_file(name: &str) -> String {
    format!("{}.svg", file_name(name))
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
