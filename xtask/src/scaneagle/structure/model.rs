//! The whole model: shells with their laminates, joints, and its mass.

use std::collections::BTreeMap;

use fladder_mesh::Vec3;
use fladder_modal::{Inertia, RigidBody};

use super::frame::{ControlFrame, Frame};
use super::joints::Joints;
use super::laminate::Laminate;
use super::mass::{Weight, weight};
use super::mesh::{ShellMesh, starboard};
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

/// A control of the starboard side about its hinge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    pub(super) name: &'static str,
    /// Without balance, kg.
    pub(super) mass: f64,
    /// Without balance, positive with its centre aft, kg m.
    pub(super) static_moment: f64,
    /// Part of it that the balance takes away.
    pub(super) balanced: f64,
    /// With balance, kg m².
    pub(super) inertia: f64,
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
        let mut areas: BTreeMap<&str, Weight> = BTreeMap::new();
        for (set, cells) in &mesh.sets {
            *areas.entry(starboard(set)).or_default() += weight(&mesh, cells);
        }
        let mut laminates = BTreeMap::new();
        for (letter, plates) in [('W', &table.wing), ('L', &table.winglet)] {
            for (_, ending, layers) in plates.all() {
                laminates.insert(
                    format!("{letter}{ending}"),
                    Laminate::of(layers, &table.material),
                );
            }
        }
        let shell = Laminate::of(&table.fuselage.shell, &table.material);
        for set in ["FUS", "FUSN", "FUST"] {
            laminates.insert(set.to_owned(), shell);
        }
        for (number, zone) in table.zone.iter().enumerate() {
            let set = format!("FUSZ{number}");
            let mut loaded = shell;
            loaded.area_density += zone.mass / areas.get(&*set).map_or(1.0, |zone| zone.amount);
            laminates.insert(set, loaded);
        }
        let bulkhead = Laminate::of(&table.fuselage.bulkhead, &table.material);
        laminates.insert("BULK".to_owned(), bulkhead);
        let mut total = Weight::default();
        let mut masses = BTreeMap::new();
        for (set, area) in areas {
            let part = area * laminates[set].area_density;
            masses.insert(set.to_owned(), part.amount);
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

fn moments(
    control: &ControlFrame,
    frame: &Frame<'_>,
    mesh: &ShellMesh,
    (laminates, joints): (&BTreeMap<String, Laminate>, &Joints),
) -> Moments {
    let line = |s: f64| frame.wing.point(frame.hinge, 0.0, s);
    let start = line(control.ends[0]);
    let axis = (line(control.ends[1]) - start).normalize();
    // Aft in the plane of the control.
    let aft = (Vec3::x() - axis * axis.x).normalize();
    let mut own = Weight::default();
    for ending in ["CS", "CSW", "RIBCS"] {
        let set = format!("{}{ending}", control.letter);
        own += weight(mesh, &mesh.sets[&set]) * laminates[&set].area_density;
    }
    let first = mesh.nodes.len() + 1;
    let mut balance = Weight::default();
    for mass in joints.masses.iter().filter(|mass| mass.control == control.name && !mass.port) {
        balance += Weight::point(&joints.nodes[mass.node - first]) * mass.mass;
    }
    let lever = |weight: &Weight| (weight.moment - start * weight.amount).dot(&aft);
    let mut both = own;
    both += balance;
    // ∫ |r × axis|² dm about the start of the hinge line.
    let about = both.second - both.moment * start.transpose() - start * both.moment.transpose()
        + start * start.transpose() * both.amount;
    Moments {
        name: control.name,
        mass: own.amount,
        static_moment: lever(&own),
        balanced: -lever(&balance) / lever(&own),
        inertia: about.trace() - (axis.transpose() * about * axis).x,
    }
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
