//! The whole model: shells with their laminates, joints, and its mass.

use std::collections::BTreeMap;

use fladder_mesh::Vec3;
use fladder_modal::{Inertia, RigidBody};

use super::frame::Frame;
use super::joints::Joints;
use super::laminate::Laminate;
use super::mass::{Weight, weight};
use super::mesh::{PORT, ShellMesh, starboard};
use super::moments::{Moments, moments};
use super::shells::shells;
use super::table::Table;
use crate::scaneagle::params::Parameters;

/// Shells, what they are made of, and joints.
pub(super) struct Model {
    pub(super) mesh: ShellMesh,
    pub(super) joints: Joints,
    /// By the name of the set on starboard; mass that a zone carries is in its density.
    pub(super) laminates: BTreeMap<String, Laminate>,
    /// Direction of the layers on starboard: of wing, and of bend and winglet.
    pub(super) grain: [Vec3; 2],
    pub(super) modes: usize,
    /// Integrated mass properties.
    pub(super) body: RigidBody,
    /// Mass of every set, both sides, kg.
    pub(super) masses: BTreeMap<String, f64>,
    pub(super) controls: Vec<Moments>,
}

impl Model {
    /// Every interval between lines of elements is cut into `refine` parts.
    ///
    /// # Errors
    /// Tables that do not go together.
    pub(super) fn new(
        parameters: &Parameters,
        table: &Table,
        refine: usize,
    ) -> Result<Self, String> {
        let frame = Frame::new(parameters, table)?;
        let mesh = shells(&frame, table, refine);
        let joints = Joints::new(&frame, table, &mesh)?;
        let laminates = laminates(table, &mesh);
        let mut total = Weight::default();
        let mut masses = BTreeMap::new();
        for (set, cells) in &mesh.sets {
            let laminate = &laminates[starboard(set)];
            let part = weight(&mesh, cells, laminate.thickness) * laminate.area_density;
            *masses.entry(starboard(set).to_owned()).or_insert(0.0) += part.amount;
            total += part;
        }
        let first = mesh.nodes.len() + 1;
        for balance in &joints.masses {
            total += Weight::point(&joints.nodes[balance.node - first]) * balance.mass;
            *masses.entry("balance".to_owned()).or_insert(0.0) += balance.mass;
        }
        let controls = frame
            .controls
            .iter()
            .map(|control| moments(control, &frame, &mesh, (&laminates, &joints)))
            .collect();
        let [begin, end, tip] = frame.wing.marks;
        let line = |a: f64, b: f64| {
            (frame.wing.point(0.4, 0.0, b) - frame.wing.point(0.4, 0.0, a)).normalize()
        };
        Ok(Self {
            joints,
            laminates,
            grain: [line(0.0, begin), line(end, tip)],
            modes: table.modes.count,
            body: total.body(),
            masses,
            controls,
            mesh,
        })
    }
}

/// The plate of every set; what a zone carries is spread over its integrated area.
fn laminates(table: &Table, mesh: &ShellMesh) -> BTreeMap<String, Laminate> {
    let plate = |layers| Laminate::of(layers, &table.material);
    let mut laminates = BTreeMap::new();
    for (letter, plates) in [('W', &table.wing), ('L', &table.winglet)] {
        for (_, ending, layers) in plates.all() {
            laminates.insert(format!("{letter}{ending}"), plate(layers));
        }
    }
    let shell = plate(&table.fuselage.skin);
    for set in ["FUS", "FUSN", "FUST"] {
        laminates.insert(set.to_owned(), shell);
    }
    for (number, zone) in table.zone.iter().enumerate() {
        let set = format!("FUSZ{number}");
        let sides = [set.clone(), format!("{set}{PORT}")];
        let cells = sides.iter().filter_map(|side| mesh.sets.get(side));
        let area: f64 = cells.map(|cells| weight(mesh, cells, 0.0).amount).sum();
        let mut loaded = shell;
        loaded.area_density += zone.mass / area;
        laminates.insert(set, loaded);
    }
    laminates.insert("BULK".to_owned(), plate(&table.fuselage.bulkhead));
    laminates
}

impl Weight {
    /// Mass, centre and moments about it.
    fn body(&self) -> RigidBody {
        let (mass, cg) = (self.amount, self.moment / self.amount);
        let second = self.second - cg * cg.transpose() * mass;
        let [x, y, z] = [second[(0, 0)], second[(1, 1)], second[(2, 2)]];
        RigidBody {
            mass,
            cg,
            inertia: Inertia {
                xx: y + z,
                yy: x + z,
                zz: x + y,
                xz: second[(0, 2)],
            },
        }
    }
}
