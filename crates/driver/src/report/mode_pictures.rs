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

/// Name and frequency of a mode.
fn titled(aircraft: &Aircraft, name: &str) -> String {
    let models = aircraft.structure.model.iter();
    let mut elastic = models.flat_map(|model| &model.elastic);
    match elastic.find(|mode| mode.name == name) {
        Some(mode) => format!("{name}, {:.2} Hz", mode.frequency_hz),
        None => name.to_owned(),
    }
}

/// Every mode on the surface that the case asks for, but for rigid ones.
pub(crate) fn mode_pictures(aircraft: &Aircraft) -> Vec<Named> {
    let modes = aircraft.asked_modes().iter();
    modes
        .filter(|mode| !mode.name.starts_with("rigid:"))
        .filter_map(|mode| {
            let picture = mode_shape(&ModePicture {
                title: &titled(aircraft, &mode.name),
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

/// A motion of the surface: $\operatorname{Re}[(a + \mathrm ib)e^{\mathrm i\omega t}]$.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    pub(crate) name: String,
    /// $a$ of every vertex.
    pub(crate) real: Vec<Vec3>,
    /// $b$; empty where all moves in phase.
    pub(crate) imaginary: Vec<Vec3>,
}

/// The modes that the case asks for, but for rigid ones.
pub(crate) fn mode_motions(aircraft: &Aircraft) -> Vec<Motion> {
    let modes = aircraft.asked_modes().iter();
    modes
        .filter(|mode| !mode.name.starts_with("rigid:"))
        .map(|mode| Motion {
            name: titled(aircraft, &mode.name),
            real: mode.displacement.clone(),
            imaginary: Vec::new(),
        })
        .collect()
}

/// What moves at every crossing of the axis, with its phase such that the largest
/// displacement is real: $u(t) = \operatorname{Re}[\sum_jx_ju_je^{\mathrm i\omega t}]$, $x$ the
/// eigenvector.
pub(crate) fn flutter_motions(aircraft: &Aircraft, crossings: &[Crossing]) -> Vec<Motion> {
    let modes = aircraft.asked_modes();
    let vertices = aircraft.surface.mesh.vertices.len();
    let complete = crossings.iter().filter(|c| c.shape.len() <= modes.len());
    complete
        .map(|crossing| {
            let part = |turn: c64| -> Vec<Vec3> {
                (0..vertices)
                    .map(|v| {
                        let of_mode = |(x, mode): (&c64, &SurfaceMode)| {
                            mode.displacement[v] * (x * turn).re
                        };
                        crossing.shape.iter().zip(modes).map(of_mode).sum()
                    })
                    .collect()
            };
            let quarter = c64::new(0.0, 1.0);
            let (real, imaginary) = (part(c64::new(1.0, 0.0)), part(-quarter));
            let phase = real
                .iter()
                .zip(&imaginary)
                .max_by(|a, b| size(a).total_cmp(&size(b)))
                .map_or(0.0, |(re, im)| turned(re, im));
            let aligned = c64::from_polar(1.0, -phase);
            Motion {
                name: format!(
                    "{} at {:.2} m/s, {:.2} Hz",
                    crossing.branch, crossing.speed, crossing.frequency_hz
                ),
                real: part(aligned),
                imaginary: part(-quarter * aligned),
            }
        })
        .collect()
}

/// A motion when its largest displacement is reached, and a quarter of a period later.
pub(crate) fn stills(aircraft: &Aircraft, motion: &Motion) -> Vec<Named> {
    // Re[(a + ib) i] = −b.
    let later: Vec<Vec3> = motion.imaginary.iter().map(|b| -b).collect();
    [
        ("", &motion.real),
        (", a quarter of a period later", &later),
    ]
    .into_iter()
    .filter_map(|(when, displacement)| {
        let name = format!("{}{when}", motion.name);
        let picture = mode_shape(&ModePicture {
            title: &name,
            mesh: &aircraft.surface.mesh,
            displacement,
        });
        picture.map(|picture| Named { name, picture })
    })
    .collect()
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
