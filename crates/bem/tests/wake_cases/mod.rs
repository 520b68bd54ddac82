//! Surfaces and what is said about their wakes.

use fladder_bem::{Flow, Plan, Problem, Silent, Solution, WakeDirection, plan, solve};
use fladder_mesh::shapes::{Arm, NacaWing, Star, Tail, WingBody};
use fladder_mesh::trailing_edge::{Settings, find_by_shape};
use fladder_mesh::{Frame, SurfaceMode, Topology, TrailingEdge, TriMesh, Vec3};

/// A surface, its trailing edges and rigid modes.
pub(crate) struct Case {
    pub(crate) mesh: TriMesh,
    pub(crate) edges: Vec<TrailingEdge>,
    pub(crate) modes: Vec<SurfaceMode>,
    pub(crate) flow: Flow,
    pub(crate) direction: WakeDirection,
    semichord: f64,
}

impl Case {
    pub(crate) fn new(mesh: TriMesh, semichord: f64, alpha_deg: f64) -> Self {
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
        ];
        Self {
            edges,
            modes,
            flow: Flow {
                alpha: alpha_deg.to_radians(),
                beta: 0.0,
            },
            direction: WakeDirection::X,
            semichord,
            mesh,
        }
    }

    pub(crate) fn problem(&self) -> Problem<'_> {
        Problem {
            flow: self.flow,
            wake_direction: self.direction,
            ..Problem::new(&self.mesh, &self.edges, &self.modes, self.semichord)
        }
    }

    pub(crate) fn plan(&self) -> Plan {
        plan(&self.problem()).expect("a wake")
    }

    pub(crate) fn solve(&self) -> Solution {
        solve(&self.problem(), &Silent).expect("a solution")
    }

    /// Position of a trailing-edge vertex.
    pub(crate) fn at(&self, edge: usize, i: usize) -> Vec3 {
        self.mesh.vertices[self.edges[edge].vertices[i] as usize]
    }

    /// Where the lines along bodies end.
    pub(crate) fn line_ends(&self) -> Vec<Vec3> {
        let lines = self.plan().wake.junction_lines;
        lines
            .iter()
            .filter_map(|line| line.vertices.last())
            .map(|&v| self.mesh.vertices[v as usize])
            .collect()
    }

    pub(crate) fn report(&self, name: &str, solution: &Solution) {
        let steady = &solution.steady;
        println!(
            "{name}: {} unknowns, {} wake elements, lift by pressure / wake {:.4}, lowest c_p {:.2}, notes {:?}",
            solution.sizes.unknowns,
            solution.sizes.wake_elements,
            steady.lift_by_pressure / steady.lift_by_wake_jump,
            steady.lowest_pressure.0,
            solution.notes
        );
        for (edge, jump) in steady.wake_jumps.iter().enumerate() {
            let [from, to] = [0, jump.jumps.len() - 1].map(|i| self.at(edge, i));
            println!(
                "  edge {edge} from {:.3?} to {:.3?}: {:.4?}",
                from.as_slice(),
                to.as_slice(),
                jump.jumps
            );
        }
    }
}

/// Jump met at each end of a trailing edge that lies on the x axis, going round it
/// counter-clockwise seen from behind. Left of a trailing edge's run is its upper side, and
/// seen from behind, one that runs outward has it clockwise.
pub(crate) fn jump_into(case: &Case, solution: &Solution, edge: usize) -> Vec<f64> {
    let jumps = &solution.steady.wake_jumps[edge].jumps;
    let last = jumps.len() - 1;
    [(0, 1.0), (last, -1.0)]
        .into_iter()
        .filter(|&(i, _)| case.at(edge, i).yz().norm() < 1e-9)
        .map(|(i, sign)| sign * jumps[i])
        .collect()
}

/// Surfaces that meet in the x axis.
pub(crate) fn star(arms: &[(f64, f64)]) -> TriMesh {
    Star {
        arms: arms.to_vec(),
        chord: 1.0,
        thickness: 0.1,
        n_chord: 8,
        n_span: 6,
    }
    .structured()
    .expect("a star")
}

/// A body 4 m long, with a dozen cells around it and more where there are more than three
/// arms.
pub(crate) fn wing_body(tail: Tail, arms: Vec<Arm>) -> TriMesh {
    finer_wing_body(tail, arms, 1)
}

/// As [`wing_body`] with cells divided.
pub(crate) fn finer_wing_body(tail: Tail, mut arms: Vec<Arm>, fine: usize) -> TriMesh {
    for arm in &mut arms {
        arm.n_span *= fine;
    }
    let n_around = fine * (12 / arms.len()).max(4);
    WingBody {
        stations: WingBody::even_stations(4.0, 0.16 / fine as f64, &arms),
        half_width: 0.25,
        half_height: 0.3,
        tail,
        arms,
        n_around,
    }
    .structured()
    .expect("a body")
}

pub(crate) fn arm(angle_deg: f64, start: f64, chord: f64, reach: f64) -> Arm {
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

pub(crate) fn wings() -> Vec<Arm> {
    vec![arm(0.0, 1.2, 0.8, 2.2), arm(180.0, 1.2, 0.8, 2.2)]
}

/// A rectangular wing with its leading edge at x and z.
pub(crate) fn wing(chord: f64, span: f64, x: f64, z: f64) -> TriMesh {
    let mut mesh = NacaWing {
        chord,
        span,
        n_chord: 8,
        n_half_span: 8,
        ..NacaWing::default()
    }
    .structured()
    .expect("a wing");
    for p in &mut mesh.vertices {
        *p += Vec3::new(x, 0.0, z);
    }
    mesh
}

/// Congruential generator with Knuth's MMIX constants.
struct Dice(u64);

impl Dice {
    /// Uniform in 0 to 1.
    fn roll(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The same body with edges flipped and vertices moved by chance, wings left as they are:
/// no row of edges is left along it.
pub(crate) fn scrambled(mesh: &TriMesh, seed: u64, shift: f64) -> TriMesh {
    let mut mesh = mesh.clone();
    let mut dice = Dice(seed);
    // On the body's ellipse; wings reach beyond it.
    let on_skin = |p: &Vec3| (p.y / 0.2501).powi(2) + (p.z / 0.3001).powi(2) <= 1.0;
    let skin: Vec<bool> = mesh.vertices.iter().map(on_skin).collect();
    let is_skin = |t: &[u32; 3]| t.iter().all(|&v| skin[v as usize]);
    let (low, high) = mesh.bounds().expect("vertices");
    let fixed: Vec<bool> = (0..mesh.vertices.len())
        .map(|v| {
            let p = mesh.vertices[v];
            p.x == low.x
                || p.x == high.x
                || mesh
                    .triangles
                    .iter()
                    .any(|t| t.contains(&(v as u32)) && !is_skin(t))
        })
        .collect();
    for _ in 0..3 {
        for t in 0..mesh.triangles.len() {
            for i in 0..3 {
                if dice.roll() < 0.4 {
                    flip(&mut mesh, t, i, &is_skin);
                }
            }
        }
    }
    for (v, _) in fixed.iter().enumerate().filter(|(_, is_fixed)| !**is_fixed) {
        let around: Vec<u32> = mesh
            .triangles
            .iter()
            .filter(|t| t.contains(&(v as u32)))
            .flatten()
            .copied()
            .filter(|&w| w != v as u32)
            .collect();
        let other = around[(dice.roll() * around.len() as f64) as usize % around.len()];
        let step = mesh.vertices[other as usize] - mesh.vertices[v];
        mesh.vertices[v] += shift * dice.roll() * step;
    }
    mesh
}

/// Turns the edge opposite corner `i` of a triangle where the surface is flat enough.
fn flip(mesh: &mut TriMesh, t: usize, i: usize, is_skin: &impl Fn(&[u32; 3]) -> bool) {
    let [c, a, b] = [0, 1, 2].map(|k| mesh.triangles[t][(i + k) % 3]);
    let across = mesh
        .triangles
        .iter()
        .position(|s| (0..3).any(|k| s[k] == b && s[(k + 1) % 3] == a));
    let Some(across) = across else { return };
    let Some(&d) = mesh.triangles[across].iter().find(|&&v| v != a && v != b) else {
        return;
    };
    let (first, second) = ([c, a, d], [c, d, b]);
    let is_edge = |v: u32, w: u32| {
        mesh.triangles
            .iter()
            .any(|s| s.contains(&v) && s.contains(&w))
    };
    if !is_skin(&mesh.triangles[t]) || !is_skin(&mesh.triangles[across]) || is_edge(c, d) {
        return;
    }
    let normal = |t: [u32; 3]| {
        let [p, q, r] = t.map(|v| mesh.vertices[v as usize]);
        (q - p).cross(&(r - p))
    };
    let old = normal(mesh.triangles[t]) + normal(mesh.triangles[across]);
    let flat = [first, second].iter().all(|&s| {
        let n = normal(s);
        n.dot(&old) > 0.9 * n.norm() * old.norm() && n.norm() > 0.2 * old.norm()
    });
    if flat {
        mesh.triangles[t] = first;
        mesh.triangles[across] = second;
    }
}
