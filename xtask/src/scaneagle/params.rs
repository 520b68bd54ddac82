//! Dimensions of the aircraft and sizes of its meshes, from a TOML file.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::DeserializeOwned;

/// The whole file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Parameters {
    pub(crate) wing: Wing,
    pub(crate) bend: Bend,
    pub(crate) winglet: Winglet,
    pub(crate) fuselage: Fuselage,
    pub(crate) controls: Controls,
    pub(crate) junction: Junction,
    pub(crate) size: BTreeMap<String, Size>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Wing {
    pub(crate) span: f64,
    pub(crate) leading_edge: f64,
    pub(crate) root_chord: f64,
    pub(crate) tip_chord: f64,
    pub(crate) sweep_quarter_deg: f64,
    pub(crate) twist_tip_deg: f64,
    pub(crate) thickness_root: f64,
    pub(crate) thickness_tip: f64,
    pub(crate) camber: f64,
    pub(crate) camber_place: f64,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Bend {
    pub(crate) radius: f64,
    pub(crate) cant_deg: f64,
    pub(crate) chord_ratio: f64,
    pub(crate) twist_ratio: f64,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Winglet {
    pub(crate) length: f64,
    pub(crate) tip_chord: f64,
    pub(crate) sweep_leading_deg: f64,
    pub(crate) thickness: f64,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Fuselage {
    pub(crate) length: f64,
    pub(crate) radius: f64,
    pub(crate) nose: f64,
    pub(crate) tail_begin: f64,
    pub(crate) tail_radius: f64,
    pub(crate) spinner: f64,
    pub(crate) nose_cap: f64,
    pub(crate) tail_cap: f64,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Controls {
    pub(crate) hinge: f64,
    pub(crate) elevon: [f64; 2],
    pub(crate) rudder: [f64; 2],
    pub(crate) gap: f64,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Junction {
    pub(crate) blend_to: f64,
}

/// Numbers of cells.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Size {
    pub(crate) chord: usize,
    pub(crate) step: f64,
    pub(crate) around: usize,
    pub(crate) nose: usize,
    pub(crate) tail: usize,
    pub(crate) root: usize,
}

/// Why there are no dimensions.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ParameterError {
    #[error("{}: {source}", path.display())]
    File {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("{}: {source}", path.display())]
    Text {
        path: PathBuf,
        source: Box<toml::de::Error>,
    },
    #[error("{0}")]
    Value(String),
}

/// Fewest and most cells in any direction.
const CELLS: std::ops::RangeInclusive<usize> = 2..=400;

/// A table as it stands in its file.
///
/// # Errors
/// A file that cannot be read, keys not known or missing.
pub(crate) fn read_table<T: DeserializeOwned>(path: &Path) -> Result<T, ParameterError> {
    let text = std::fs::read_to_string(path).map_err(|source| ParameterError::File {
        path: path.to_owned(),
        source,
    })?;
    toml::from_str(&text).map_err(|source| ParameterError::Text {
        path: path.to_owned(),
        source: Box::new(source),
    })
}

impl Parameters {
    pub(crate) fn read(path: &Path) -> Result<Self, ParameterError> {
        read_table::<Self>(path)?.checked()
    }

    /// Dimensions of which no surface can be made are refused by name.
    fn checked(self) -> Result<Self, ParameterError> {
        let (wing, body) = (&self.wing, &self.fuselage);
        let positive = [
            ("wing.span", wing.span),
            ("wing.root_chord", wing.root_chord),
            ("wing.tip_chord", wing.tip_chord),
            ("wing.thickness_root", wing.thickness_root),
            ("wing.thickness_tip", wing.thickness_tip),
            ("wing.camber_place", wing.camber_place),
            ("bend.radius", self.bend.radius),
            ("bend.chord_ratio", self.bend.chord_ratio),
            ("winglet.length", self.winglet.length),
            ("winglet.tip_chord", self.winglet.tip_chord),
            ("winglet.thickness", self.winglet.thickness),
            ("fuselage.length", body.length),
            ("fuselage.radius", body.radius),
            ("fuselage.nose", body.nose),
            ("fuselage.tail_radius", body.tail_radius),
            ("fuselage.spinner", body.spinner),
            ("fuselage.nose_cap", body.nose_cap),
            ("fuselage.tail_cap", body.tail_cap),
            ("controls.gap", self.controls.gap),
        ];
        for (name, value) in positive {
            if !(value.is_finite() && value > 0.0) {
                return Err(ParameterError::Value(format!(
                    "`{name}` is {value}: it must be positive"
                )));
            }
        }
        let ordered = [
            (
                "fuselage.nose, tail_begin, length",
                vec![body.nose, body.tail_begin, body.length - body.spinner],
            ),
            (
                "fuselage.nose_cap, radius",
                vec![body.nose_cap, body.radius],
            ),
            (
                "fuselage.tail_cap, tail_radius",
                vec![body.tail_cap, body.tail_radius],
            ),
            ("controls.elevon", self.controls.elevon.to_vec()),
            (
                "junction.blend_to before controls.elevon",
                vec![
                    body.radius,
                    self.junction.blend_to,
                    self.controls.elevon[0] - self.controls.gap,
                ],
            ),
            (
                "controls.rudder between 0 and 1",
                vec![0.0, self.controls.rudder[0], self.controls.rudder[1], 1.0],
            ),
            (
                "controls.hinge between 0 and 1",
                vec![0.0, self.controls.hinge, 1.0],
            ),
            (
                "bend.cant_deg between 0 and 90",
                vec![0.0, self.bend.cant_deg, 90.001],
            ),
        ];
        for (name, values) in ordered {
            let ascends = values.windows(2).all(|pair| pair[0] < pair[1]);
            if !ascends {
                return Err(ParameterError::Value(format!(
                    "{name}: {values:?} must ascend"
                )));
            }
        }
        for (name, size) in &self.size {
            let cells = [size.chord, size.around, size.nose, size.tail, size.root];
            if cells.iter().any(|cells| !CELLS.contains(cells))
                || size.chord < 6
                || !(1e-3..1.0).contains(&size.step)
            {
                return Err(ParameterError::Value(format!(
                    "[size.{name}]: cells must lie between {} and {} (chord from 6), step between \
                     0.001 and 1 m",
                    CELLS.start(),
                    CELLS.end()
                )));
            }
        }
        Ok(self)
    }
}
