//! What ties the shells together: hinges, balance masses, wing and fuselage.
//!
//! A hinge has one rigid body of four nodes on the fixed side, one of four on the control, both
//! with their reference node on the hinge line, where translations are tied: three at the first
//! hinge, at the others those across the span. At the driven hinge the rotation of control
//! against wing about the line is the displacement of a scalar node, which a spring holds.
//! The front spar and a ring of the fuselage are one rigid body; the rear spar hangs in two
//! vertical pins, which leaves the wing soft in its plane.

use fladder_mesh::Vec3;
use libm::hypot;

use super::frame::{ControlFrame, Frame};
use super::mesh::ShellMesh;
use super::shells::box_middle;
use super::table::{Balance, Control, Table};

/// Sum of (node, degree of freedom, factor) is zero.
pub(super) type Equation = Vec<(usize, usize, f64)>;

/// Distance between the ends of a spring, m.
const SPRING: f64 = 0.05;
/// Nodes this close to a ring lie on it, m.
const RING: f64 = 1e-7;

/// Nodes that move as one, with the nodes of its translation and rotation.
#[derive(Clone, Debug)]
pub(super) struct Rigid {
    pub(super) nodes: Vec<usize>,
    pub(super) reference: usize,
    pub(super) rotation: usize,
}

/// A hinge's spring between a scalar node and a fixed one.
#[derive(Clone, Debug)]
pub(super) struct Spring {
    /// `elevon_r` and so on.
    pub(super) name: String,
    pub(super) scalar: usize,
    pub(super) fixed: usize,
    /// N m/rad
    pub(super) stiffness: f64,
}

/// A mass that turns with a control.
#[derive(Clone, Copy, Debug)]
pub(super) struct BalanceMass {
    pub(super) control: &'static str,
    pub(super) port: bool,
    pub(super) node: usize,
    /// kg
    pub(super) mass: f64,
}

/// Joints and the nodes made for them.
#[derive(Clone, Debug, Default)]
pub(super) struct Joints {
    /// Numbers go on after those of the shells.
    pub(super) nodes: Vec<Vec3>,
    pub(super) rigid: Vec<Rigid>,
    pub(super) equations: Vec<Equation>,
    pub(super) springs: Vec<Spring>,
    pub(super) masses: Vec<BalanceMass>,
    shells: usize,
}

impl Joints {
    /// # Errors
    /// A place where the shells have no node.
    pub(super) fn new(
        frame: &Frame<'_>,
        table: &Table,
        mesh: &ShellMesh,
    ) -> Result<Self, String> {
        let mut joints = Self {
            shells: mesh.nodes.len(),
            ..Self::default()
        };
        for port in [false, true] {
            let inputs = [&table.elevon, &table.rudder];
            for (control, input) in frame.controls.iter().zip(inputs) {
                joints.control((frame, table, mesh), (control, input), port)?;
            }
        }
        joints.root(frame, table, mesh)?;
        Ok(joints)
    }

    fn put(&mut self, point: Vec3) -> usize {
        self.nodes.push(point);
        self.shells + self.nodes.len()
    }

    fn control(
        &mut self,
        (frame, table, mesh): (&Frame<'_>, &Table, &ShellMesh),
        (control, input): (&ControlFrame, &Control),
        port: bool,
    ) -> Result<(), String> {
        let places = &table.places;
        let at =
            |place: f64, face: f64, s: f64| mirrored(port, frame.wing.point(place, face, s));
        let four = |chord: [f64; 2], s: f64| -> Result<Vec<usize>, String> {
            chord
                .into_iter()
                .flat_map(|place| [1.0, -1.0].map(|face| at(place, face, s)))
                .map(|point| node_at(mesh, &point))
                .collect()
        };
        let line = |s: f64| at(frame.hinge, 0.0, s);
        let (first, last) = (control.hinges[0], control.hinges[control.hinges.len() - 1]);
        let axis = (line(last) - line(first)).normalize();
        // The direction most along the span is left free at all hinges but the first.
        let free = axis.iamax();
        for (number, s) in control.hinges.iter().enumerate() {
            let place = line(*s);
            let [base, base_turn, own, own_turn] = [place; 4].map(|point| self.put(point));
            let fixed = four([places.rear_spar, box_middle(places)], *s)?;
            let mut moving = four([places.control_spar, places.control_middle], *s)?;
            for Balance { mass, place, .. } in input
                .balance
                .iter()
                .filter(|balance| balance.hinge == number)
            {
                let node = self.put(at(*place, 0.0, *s));
                self.masses.push(BalanceMass {
                    control: control.name,
                    port,
                    node,
                    mass: *mass,
                });
                moving.push(node);
            }
            self.rigid.push(Rigid {
                nodes: fixed,
                reference: base,
                rotation: base_turn,
            });
            self.rigid.push(Rigid {
                nodes: moving,
                reference: own,
                rotation: own_turn,
            });
            for direction in (0..3).filter(|direction| number == 0 || *direction != free) {
                self.equations
                    .push(vec![(own, direction + 1, 1.0), (base, direction + 1, -1.0)]);
            }
            if number == table.hinges.driven {
                let scalar = self.put(place);
                let ground = self.put(place + Vec3::new(SPRING, 0.0, 0.0));
                // The first term is eliminated: the largest.
                let mut equation = vec![(own_turn, free + 1, axis[free])];
                let others = (0..3).filter(|direction| *direction != free);
                equation.extend(others.map(|i| (own_turn, i + 1, axis[i])));
                equation.extend((0..3).map(|i| (base_turn, i + 1, -axis[i])));
                equation.push((scalar, 1, -1.0));
                self.equations.push(equation);
                self.springs.push(Spring {
                    name: format!("{}_{}", control.name, if port { 'l' } else { 'r' }),
                    scalar,
                    fixed: ground,
                    stiffness: input.stiffness,
                });
            }
        }
        Ok(())
    }

    /// Wing and fuselage.
    fn root(
        &mut self,
        frame: &Frame<'_>,
        table: &Table,
        mesh: &ShellMesh,
    ) -> Result<(), String> {
        let places = &table.places;
        let chord = [places.front_spar, places.rear_spar];
        for (number, (x, place)) in frame.spars.into_iter().zip(chord).enumerate() {
            let radius = frame.body.radius(x);
            let on_ring = |node: &Vec3| {
                (node.x - x).abs() < RING && (hypot(node.y, node.z) - radius).abs() < RING
            };
            let mut nodes: Vec<usize> = (1..)
                .zip(&mesh.nodes)
                .filter(|(_, node)| on_ring(node))
                .map(|(number, _)| number)
                .collect();
            let center = self.put(Vec3::new(x, 0.0, 0.0));
            let turn = self.put(Vec3::new(x, 0.0, 0.0));
            let spar = |face: f64, port: bool| {
                let point = frame.wing.point(place, face, places.side_of_body);
                node_at(mesh, &mirrored(port, point))
            };
            if number == 0 {
                for (face, port) in [(1.0, false), (1.0, true), (-1.0, false), (-1.0, true)] {
                    nodes.push(spar(face, port)?);
                }
                nodes.sort_unstable();
                nodes.dedup();
            } else {
                for port in [false, true] {
                    let pin = spar(1.0, port)?;
                    let arm = mesh.nodes[pin - 1] - Vec3::new(x, 0.0, 0.0);
                    self.equations.push(vec![
                        (pin, 3, 1.0),
                        (center, 3, -1.0),
                        (turn, 1, -arm.y),
                        (turn, 2, arm.x),
                    ]);
                }
            }
            self.rigid.push(Rigid {
                nodes,
                reference: center,
                rotation: turn,
            });
        }
        Ok(())
    }
}

fn node_at(mesh: &ShellMesh, point: &Vec3) -> Result<usize, String> {
    mesh.find(point).ok_or_else(|| {
        format!(
            "no node at x {:.4}, y {:.4}, z {:.4}, where a hinge or spar is to be fixed: \
             [places] and controls.hinge do not go together",
            point.x, point.y, point.z
        )
    })
}

fn mirrored(port: bool, mut point: Vec3) -> Vec3 {
    if port {
        point.y = -point.y;
    }
    point
}
