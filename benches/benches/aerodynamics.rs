//! Aerodynamics: panel kernel, whole computation, Q at one point.
//!
//! `cargo bench -p fladder-benches --bench aerodynamics`

use divan::{Bencher, black_box};
use fladder_bem::panels::PanelSet;
use fladder_bem::{Problem, Silent, Solution, solve};
use fladder_mesh::shapes::NacaWing;
use fladder_mesh::{Frame, SurfaceMode, Topology, TriMesh, Vec3, trailing_edge};

fn main() {
    divan::main();
}

fn wing(n_chord: usize, n_half_span: usize) -> TriMesh {
    NacaWing {
        n_chord,
        n_half_span,
        ..NacaWing::default()
    }
    .structured()
    .expect("a wing")
}

/// Doublet and source influences of all panels at one point; divide by the panels.
#[divan::bench(args = [8, 16, 32])]
fn panel_pairs(bencher: Bencher, n_chord: usize) {
    let mesh = wing(n_chord, 16);
    let panels = PanelSet::new(&mesh.vertices, &mesh.triangles);
    let mut scratch = panels.scratch();
    let mut doublets = vec![[0.0; 3]; panels.len()];
    let mut sources = doublets.clone();
    bencher
        .counter(divan::counter::ItemsCount::new(panels.len()))
        .bench_local(|| {
            let point = black_box(Vec3::new(0.4, 0.3, 0.05));
            panels.doublets_and_sources(point, &mut scratch, &mut doublets, &mut sources);
        });
}

fn solution(n_chord: usize) -> Solution {
    let mesh = wing(n_chord, n_chord);
    let edges = trailing_edge::find_by_shape(
        &mesh,
        &Topology::new(&mesh),
        trailing_edge::Settings::default(),
    );
    let modes: Vec<SurfaceMode> = (0..26)
        .map(|power| SurfaceMode {
            name: format!("mode {power}"),
            frame: Frame::Inertial,
            displacement: mesh
                .vertices
                .iter()
                .map(|x| Vec3::z() * (x.y / 4.0).powi(power))
                .collect(),
        })
        .collect();
    solve(&Problem::new(&mesh, &edges, &modes, 0.5), &Silent).expect("solved")
}

/// From mesh and 26 modes to the transfer model.
#[divan::bench(args = [8, 16], sample_count = 3)]
fn transfer_model(bencher: Bencher, n_chord: usize) {
    bencher.bench_local(|| solution(black_box(n_chord)));
}

/// Q at one complex p from the transfer model, 26 modes.
#[divan::bench(args = [8, 16])]
fn one_value_of_p(bencher: Bencher, n_chord: usize) {
    let transfer = solution(n_chord).transfer;
    bencher.bench_local(|| transfer.q(black_box(faer::c64::new(-0.02, 0.3))));
}
