//! Aerodynamics: panel kernel, whole computation, Q at one point.
//!
//! `cargo bench -p fladder-benches --bench aerodynamics`

use divan::{Bencher, black_box};
use fladder_bem::pieces::{Equations, Factorisation, Instructions, PanelPairs};
use fladder_bem::{Problem, Silent, Solution, solve};
use fladder_mesh::shapes::NacaWing;
use fladder_mesh::{Frame, SurfaceMode, Topology, TrailingEdge, TriMesh, Vec3, trailing_edge};

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

/// D and S of a far and of a near block at eight points, one pair an item; first by the
/// scalar functions that are the oracle.
#[divan::bench(args = [12.0, 1.0])]
fn panel_pairs_scalar(bencher: Bencher, distance: f64) {
    let pairs = PanelPairs::new(&wing(16, 16), distance);
    bencher
        .counter(divan::counter::ItemsCount::new(pairs.len()))
        .bench_local(|| black_box(&pairs).scalar());
}

#[divan::bench(args = [12.0, 1.0])]
fn panel_pairs_avx2(bencher: Bencher, distance: f64) {
    panel_pairs(bencher, distance, Instructions::Avx2);
}

#[divan::bench(args = [12.0, 1.0])]
fn panel_pairs_avx512(bencher: Bencher, distance: f64) {
    panel_pairs(bencher, distance, Instructions::Avx512);
}

fn panel_pairs(bencher: Bencher, distance: f64, instructions: Instructions) {
    let mut pairs = PanelPairs::new(&wing(16, 16), distance);
    bencher
        .counter(divan::counter::ItemsCount::new(pairs.len()))
        .bench_local(|| black_box(&mut pairs).in_lanes(instructions));
}

/// Doublets and sources of a whole surface, tested on one cluster; one pair an item.
#[divan::bench]
fn tested_pairs(bencher: Bencher) {
    let mesh = wing(32, 32);
    let equations = Equations::new(&mesh, &edges(&mesh), 0.5).expect("equations");
    bencher
        .counter(divan::counter::ItemsCount::new(
            equations.pairs_of_a_cluster(),
        ))
        .bench_local(|| black_box(&equations).one_cluster());
}

/// Blocked factorisation in single precision.
#[divan::bench(args = [4096, 8192], sample_count = 3)]
fn factorisation(bencher: Bencher, size: usize) {
    let matrix = Factorisation::new(size);
    bencher
        .counter(divan::counter::ItemsCount::new(matrix.flops() as usize))
        .bench_local(|| black_box(&matrix).factorise());
}

/// The matrix product that bounds it, on all threads.
#[divan::bench(args = [4096, 8192], sample_count = 3)]
fn product(bencher: Bencher, size: usize) {
    let matrix = Factorisation::new(size);
    bencher
        .counter(divan::counter::ItemsCount::new(
            matrix.product_flops() as usize
        ))
        .bench_local(|| black_box(&matrix).product());
}

fn edges(mesh: &TriMesh) -> Vec<TrailingEdge> {
    trailing_edge::find_by_shape(
        mesh,
        &Topology::new(mesh),
        trailing_edge::Settings::default(),
    )
}

fn solution(n_chord: usize) -> Solution {
    let mesh = wing(n_chord, n_chord);
    let edges = edges(&mesh);
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
