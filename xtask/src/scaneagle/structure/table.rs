//! The table of the structure: `cases/scaneagle/structure.toml`.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

use crate::scaneagle::params::{ParameterError, read_table};

/// Material and thickness in m, from outside to inside.
pub(super) type Layers = Vec<(String, f64)>;

/// The whole file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Table {
    pub(super) material: BTreeMap<String, Material>,
    pub(super) places: Places,
    pub(super) wing: Plates,
    pub(super) winglet: Plates,
    pub(super) hinges: Hinges,
    pub(super) elevon: Control,
    pub(super) rudder: Control,
    pub(super) fuselage: Shell,
    pub(super) zone: Vec<Zone>,
    pub(super) modes: Modes,
}

/// Moduli in N/m², density in kg/m³.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Material {
    pub(super) along: f64,
    pub(super) across: f64,
    pub(super) shear: f64,
    pub(super) poisson: f64,
    pub(super) density: f64,
    #[serde(default)]
    pub(super) core: bool,
}

/// Lines of elements: parts of the chord, and stations by arc length.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Places {
    pub(super) front_spar: f64,
    pub(super) cap_end: f64,
    pub(super) rear_spar: f64,
    pub(super) control_spar: f64,
    pub(super) control_middle: f64,
    pub(super) side_of_body: f64,
    pub(super) slot: f64,
    pub(super) stations: Vec<f64>,
    pub(super) ribs: Vec<f64>,
}

/// What wing or winglet are made of.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Plates {
    pub(super) leading: Layers,
    pub(super) cap: Layers,
    pub(super) r#box: Layers,
    pub(super) trailing: Layers,
    pub(super) web: Layers,
    pub(super) control: Layers,
    pub(super) control_web: Layers,
    pub(super) rib: Layers,
    pub(super) control_rib: Layers,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Hinges {
    pub(super) stations: Vec<f64>,
    pub(super) driven: usize,
}

/// Stiffness of a control about its hinge, N m/rad, and its balance.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Control {
    pub(super) stiffness: f64,
    pub(super) balance: Vec<Balance>,
}

/// A mass in kg that turns with the control, at a part of the chord.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Balance {
    pub(super) hinge: usize,
    pub(super) mass: f64,
    pub(super) place: f64,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Shell {
    #[serde(rename = "shell")]
    pub(super) skin: Layers,
    pub(super) bulkhead: Layers,
    pub(super) bulkheads: Vec<f64>,
    pub(super) nose: f64,
    pub(super) tail: f64,
    pub(super) step: f64,
}

/// Mass in kg that a length of the fuselage carries besides itself.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Zone {
    #[allow(dead_code, reason = "for the reader of the table")]
    pub(super) name: String,
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) mass: f64,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Modes {
    pub(super) count: usize,
}

impl Plates {
    /// Every laminate by the key in the table and the ending of its element set.
    pub(super) fn all(&self) -> [(&'static str, &'static str, &Layers); 9] {
        [
            ("leading", "LE", &self.leading),
            ("cap", "CAP", &self.cap),
            ("box", "BOX", &self.r#box),
            ("trailing", "TE", &self.trailing),
            ("web", "WEB", &self.web),
            ("control", "CS", &self.control),
            ("control_web", "CSW", &self.control_web),
            ("rib", "RIB", &self.rib),
            ("control_rib", "RIBCS", &self.control_rib),
        ]
    }
}

impl Table {
    /// Reads and checks it.
    ///
    /// # Errors
    /// A file that cannot be read, keys not known, values no structure can have.
    pub(super) fn read(path: &Path) -> Result<Self, ParameterError> {
        let read: Self = read_table(path)?;
        read.check().map_err(ParameterError::Value)?;
        Ok(read)
    }

    fn check(&self) -> Result<(), String> {
        self.check_plates()?;
        let places = &self.places;
        let chord = [
            0.0,
            places.front_spar,
            places.cap_end,
            places.rear_spar,
            places.control_spar,
            places.control_middle,
            1.0,
        ];
        ascending("[places], parts of the chord", &chord)?;
        ascending("places.stations", &places.stations)?;
        for (key, values) in [
            (
                "places.side_of_body",
                std::slice::from_ref(&places.side_of_body),
            ),
            ("places.ribs", &places.ribs),
        ] {
            if let Some(value) = values.iter().find(|s| !places.stations.contains(s)) {
                return Err(format!("{key}: {value} is not among places.stations"));
            }
        }
        let ends = [&[0.0], &*self.hinges.stations, &[1.0]].concat();
        ascending("hinges.stations between 0 and 1", &ends)?;
        let hinges = self.hinges.stations.len();
        if hinges < 2 || self.hinges.driven >= hinges {
            return Err(format!(
                "[hinges]: {hinges} stations, driven at number {}: there must be two or more, \
                 counted from 0",
                self.hinges.driven
            ));
        }
        for (name, control) in [("elevon", &self.elevon), ("rudder", &self.rudder)] {
            positive(&format!("{name}.stiffness"), control.stiffness)?;
            for balance in &control.balance {
                positive(&format!("{name}.balance, mass"), balance.mass)?;
                if balance.hinge >= hinges || !(0.0..1.0).contains(&balance.place) {
                    return Err(format!(
                        "{name}.balance: hinge {} of {hinges}, counted from 0, place {} of the chord",
                        balance.hinge, balance.place
                    ));
                }
            }
        }
        let body = &self.fuselage;
        ascending("fuselage.nose, tail", &[0.0, body.nose, body.tail])?;
        ascending("fuselage.bulkheads", &body.bulkheads)?;
        positive("fuselage.step", body.step)?;
        let mut bounds = vec![body.nose];
        for zone in &self.zone {
            bounds.extend([zone.from, zone.to]);
            positive(&format!("mass of the zone from {}", zone.from), zone.mass)?;
        }
        if bounds.windows(2).any(|pair| pair[0] > pair[1]) || bounds.last() > Some(&body.tail) {
            return Err(format!(
                "[[zone]]: {bounds:?} must ascend from fuselage.nose to fuselage.tail"
            ));
        }
        if !(7..=200).contains(&self.modes.count) {
            return Err(format!(
                "modes.count is {}: six are rigid, and more than 200 are not kept",
                self.modes.count
            ));
        }
        Ok(())
    }

    fn check_plates(&self) -> Result<(), String> {
        for (name, material) in &self.material {
            for (key, value) in [
                ("along", material.along),
                ("across", material.across),
                ("shear", material.shear),
                ("density", material.density),
            ] {
                positive(&format!("material.{name}.{key}"), value)?;
            }
            if !(0.0..0.5).contains(&material.poisson) {
                return Err(format!("material.{name}.poisson is {}", material.poisson));
            }
        }
        let body = &self.fuselage;
        let plates = [("wing", &self.wing), ("winglet", &self.winglet)]
            .into_iter()
            .flat_map(|(part, plates)| {
                let named = move |(key, _, layers)| (format!("{part}.{key}"), layers);
                plates.all().map(named)
            })
            .chain([
                ("fuselage.shell".to_owned(), &body.skin),
                ("fuselage.bulkhead".to_owned(), &body.bulkhead),
            ]);
        for (name, layers) in plates {
            if layers.is_empty() {
                return Err(format!("{name} has no layers"));
            }
            for (material, thickness) in layers {
                positive(&format!("{name}: thickness of {material}"), *thickness)?;
                if !self.material.contains_key(material) {
                    return Err(format!("{name}: there is no [material.{material}]"));
                }
            }
        }
        Ok(())
    }
}

fn positive(name: &str, value: f64) -> Result<(), String> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(format!("`{name}` is {value}: it must be positive"))
}

fn ascending(name: &str, values: &[f64]) -> Result<(), String> {
    if values.windows(2).all(|pair| pair[0] < pair[1]) {
        return Ok(());
    }
    Err(format!("{name}: {values:?} must ascend"))
}
