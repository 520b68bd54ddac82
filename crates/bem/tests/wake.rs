//! The wake on surfaces whose trailing edges join, end on bodies, or lie behind each other.

use faer::c64;
use fladder_bem::{Flow, Plan, Problem, Silent, Solution, WakeDirection, plan, solve};
use fladder_mesh::shapes::{Arm, NacaWing, Star, Tail, WingBody};
use fladder_mesh::trailing_edge::{Settings, find_by_shape};
use fladder_mesh::{Frame, SurfaceMode, Topology, TrailingEdge, TriMesh, Vec3, read};
use std::path::Path;

/// A surface, its trailing edges and heave, sway and roll.
struct Case {
    mesh: TriMesh,
    edges: Vec<TrailingEdge>,
    modes: Vec<SurfaceMode>,
    flow: Flow,
    semichord: f64,
}

impl Case {
    fn new(mesh: TriMesh, semichord: f64, alpha_deg: f64) -> Self {
        let edges = find_by_shape(&mesh, &Topology::new(&mesh), Settings::default());
        let mode = |name: &str, frame, field: fn(&Vec3) -> Vec3| SurfaceMode {
            name: name.into(),
            frame,
            displacement: mesh.vertices.iter().map(field).collect(),
        };
        let modes = vec![
            mode("heave", Frame::Body, |_| Vec3::z()),
            mode("sway", Frame::Body, |_| Vec3::y()),
            mode("pitch", Frame::Inertial, |x| Vec3::new(x.z, 0.0, -x.x)),
            mode("roll", Frame::Inertial, |x| Vec3::new(0.0, -x.z, x.y)),
            mode("yaw", Frame::Inertial, |x| Vec3::new(-x.y, x.x, 0.0)),
        ];
        Self {
            edges,
            modes,
            flow: Flow {
                alpha: alpha_deg.to_radians(),
                beta: 0.0,
            },
            semichord,
            mesh,
        }
    }

    fn problem(&self) -> Problem<'_> {
        Problem {
            mesh: &self.mesh,
            trailing_edges: &self.edges,
            modes: &self.modes,
            flow: self.flow,
            wake_direction: WakeDirection::X,
            body_lines: &[],
            semichord: self.semichord,
            moment_point: Vec3::zeros(),
        }
    }

    fn plan(&self) -> Plan {
        plan(&self.problem()).expect("a wake")
    }

    fn solve(&self) -> Solution {
        solve(&self.problem(), &Silent).expect("a solution")
    }

    /// Position of a trailing-edge vertex.
    fn at(&self, edge: usize, i: usize) -> Vec3 {
        self.mesh.vertices[self.edges[edge].vertices[i] as usize]
    }
}

fn report(name: &str, case: &Case, solution: &Solution) {
    let steady = &solution.steady;
    println!(
        "{name}: {} unknowns, {} wake elements, lift by pressure / wake {:.4}, lowest c_p {:.2}; notes {:?}",
        solution.sizes.unknowns,
        solution.sizes.wake_elements,
        steady.lift_by_pressure / steady.lift_by_wake_jump,
        steady.lowest_pressure.0,
        solution.notes
    );
    for (edge, jump) in steady.wake_jumps.iter().enumerate() {
        let text: Vec<String> = jump.jumps.iter().map(|k| format!("{k:+.4}")).collect();
        println!(
            "  edge {edge} from {:?} to {:?}: {}",
            case.at(edge, 0).as_slice(),
            case.at(edge, jump.jumps.len() - 1).as_slice(),
            text.join(" ")
        );
    }
}

fn star(arms: &[(f64, f64)]) -> TriMesh {
    Star {
        arms: arms.to_vec(),
        chord: 1.0,
        thickness: 0.1,
        n_chord: 8,
        n_span: 8,
    }
    .structured()
    .expect("a star")
}

/// A T-tail without its fin is a wing; with it, symmetric flow does not see the fin's wake,
/// and the three jumps at the common vertex sum to zero in any flow.
#[test]
fn jumps_at_a_common_vertex_sum_to_zero() {
    for (name, arms) in [
        ("T", vec![(0.0, 2.0), (180.0, 2.0), (270.0, 2.0)]),
        ("winglet", vec![(0.0, 1.0), (70.0, 0.8), (180.0, 3.0)]),
        (
            "cross",
            vec![(0.0, 2.0), (90.0, 1.5), (180.0, 2.0), (270.0, 1.0)],
        ),
    ] {
        let mut case = Case::new(star(&arms), 0.5, 4.0);
        case.flow.beta = 0.05;
        let solution = case.solve();
        report(name, &case, &solution);
        let mut sum = 0.0;
        let mut largest = 0.0_f64;
        for (edge, jump) in solution.steady.wake_jumps.iter().enumerate() {
            for (i, out) in [(0, 1), (jump.jumps.len() - 1, jump.jumps.len() - 2)] {
                let here = case.at(edge, i);
                if here.y.hypot(here.z) < 1e-9 {
                    // Upper left of the chain's run: going round counter-clockwise seen from
                    // behind, an arm that runs outward is crossed from lower to upper.
                    sum += if i < out {
                        jump.jumps[i]
                    } else {
                        -jump.jumps[i]
                    };
                    largest = largest.max(jump.jumps[i].abs());
                }
            }
        }
        println!("{name}: sum of the jumps {sum:.1e}, largest {largest:.3}");
        assert!(sum.abs() < 1e-12 * largest);
        let ratio = solution.steady.lift_by_pressure / solution.steady.lift_by_wake_jump;
        assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    }
}

fn wing_body(tail: Tail, arms: Vec<Arm>) -> TriMesh {
    WingBody {
        stations: WingBody::even_stations(4.0, 0.16, &arms),
        half_width: 0.25,
        half_height: 0.3,
        tail,
        arms,
        n_around: 4,
    }
    .structured()
    .expect("a body")
}

fn arm(angle_deg: f64, start: f64, chord: f64, reach: f64) -> Arm {
    Arm {
        angle_deg,
        start,
        chord,
        reach,
        thickness: 0.12,
        sweep: 0.1,
        n_span: 6,
    }
}

fn wings() -> Vec<Arm> {
    vec![arm(0.0, 1.2, 0.8, 2.2), arm(180.0, 1.2, 0.8, 2.2)]
}

#[test]
fn bodies() {
    let with = |more: &[Arm]| [wings(), more.to_vec()].concat();
    let fin = arm(90.0, 2.9, 0.5, 1.2);
    let tailplane = [arm(0.0, 2.9, 0.5, 1.2), arm(180.0, 2.9, 0.5, 1.2)];
    for (name, tail, arms) in [
        ("pointed", Tail::Pointed, wings()),
        ("pointed and fin", Tail::Pointed, with(&[fin])),
        ("blunt and fin", Tail::Blunt, with(&[fin])),
        ("knife", Tail::Knife, wings()),
        ("knife and fin", Tail::Knife, with(&[fin])),
        (
            "tail",
            Tail::Pointed,
            with(&[tailplane[0], tailplane[1], fin]),
        ),
        ("fin alone", Tail::Pointed, vec![fin]),
    ] {
        let case = Case::new(wing_body(tail, arms), 0.4, 3.0);
        let plan = case.plan();
        for line in &plan.wake.junction_lines {
            let text: Vec<String> = line
                .vertices
                .iter()
                .map(|&v| {
                    let p = case.mesh.vertices[v as usize];
                    format!("({:.2} {:.2} {:.2})", p.x, p.y, p.z)
                })
                .collect();
            println!("  line of {}: {}", line.edge, text.join(" "));
        }
        let solution = case.solve();
        report(name, &case, &solution);
    }
}

#[test]
fn scaneagle() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes/scaneagle_3k.msh");
    let mesh = read::read_mesh(path, 1.0).expect("the committed mesh");
    let mut case = Case::new(mesh, 0.115, 3.0);
    let solution = case.solve();
    report("scaneagle", &case, &solution);
    let q = solution.transfer.q(c64::new(0.0, 0.1)).expect("Q");
    println!("{:?}", (q[(0, 0)], q[(2, 2)], q[(4, 4)]));
    case.flow.alpha = -2_f64.to_radians();
    println!("{:?}", case.plan().notes);
    let _ = NacaWing::default();
}
