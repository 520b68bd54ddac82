//! Induced drag in the Trefftz plane against a vortex lattice.

mod common;

use common::{edges, mode, solved};
use faer::Mat;
use faer::prelude::Solve;
use fladder_bem::Flow;
use fladder_mesh::shapes::NacaWing;
use fladder_mesh::{Frame, Vec3};
use std::f64::consts::PI;

/// Span efficiency CL²/(π A CDi) of a flat rectangular wing of unit chord by horseshoe
/// vortices at quarter-points, cosine spaced over the span: the induced drag of discrete
/// vortices at their own mid-points far downstream. With 4 × 40 vortices CL_α is 4.584 at
/// aspect ratio 8, whose limit is 4.586.
fn lattice_efficiency(ratio: f64, n_chord: usize, n_span: usize) -> f64 {
    let edge = |j: usize| -0.5 * ratio * (PI * j as f64 / n_span as f64).cos();
    let middle = |j: usize| -0.5 * ratio * (PI * (j as f64 + 0.5) / n_span as f64).cos();
    let n = n_chord * n_span;
    let place = |i: usize, at: f64| ((i / n_span) as f64 + at) / n_chord as f64;
    let influence = Mat::from_fn(n, n, |i, j| {
        let x = place(i, 0.75) - place(j, 0.25);
        let wash = |edge: f64| {
            let y = middle(i % n_span) - edge;
            (1.0 + x.hypot(y) / x) / y
        };
        (wash(edge(j % n_span)) - wash(edge(j % n_span + 1))) / (4.0 * PI)
    });
    let normalwash = Mat::from_fn(n, 1, |_, _| 1.0);
    let strengths = influence.partial_piv_lu().solve(&normalwash);
    let jump: Vec<f64> = (0..n_span)
        .map(|j| (0..n_chord).map(|i| strengths[(i * n_span + j, 0)]).sum())
        .collect();
    let width = |j: usize| edge(j + 1) - edge(j);
    let lift: f64 = (0..n_span).map(|j| 2.0 * jump[j] * width(j)).sum();
    let wash = |i: usize| -> f64 {
        let of = |j: usize| 1.0 / (middle(i) - edge(j)) - 1.0 / (middle(i) - edge(j + 1));
        (0..n_span).map(|j| jump[j] * of(j) / (2.0 * PI)).sum()
    };
    let drag: f64 = (0..n_span).map(|i| jump[i] * wash(i) * width(i)).sum();
    (lift / ratio).powi(2) / (PI * ratio * (drag.abs() / ratio))
}

/// A thin wing at a small angle: lift by the jump and drag by the energy of the same wake.
#[test]
fn span_efficiency_is_that_of_the_vortex_lattice() {
    for (span, thickness) in [(8.0, 0.04), (8.0, 0.12), (4.0, 0.04)] {
        let reference = lattice_efficiency(span, 4, 40);
        let wing = NacaWing {
            thickness,
            span,
            n_chord: 12,
            n_half_span: 14,
            span_clustering: 1.0,
            ..NacaWing::default()
        };
        let mesh = wing.structured().expect("a wing");
        let plunge = mode(&mesh, "plunge", Frame::Inertial, |_| Vec3::z());
        let flow = Flow {
            alpha: 4_f64.to_radians(),
            beta: 0.0,
        };
        let steady = solved(&mesh, &edges(&mesh), &[plunge], flow, 0.5).steady;
        let drag = steady.induced_drag.expect("a sheet without free edges");
        let by_pressure: f64 = steady
            .loads
            .force
            .iter()
            .zip(steady.stream)
            .map(|(force, stream)| force * stream)
            .sum();
        let efficiency = steady.lift_by_wake_jump.powi(2) / (PI * span * span * drag);
        println!(
            "A {span}, {:.0} %: efficiency {efficiency:.4}, lattice {reference:.4}, {:+.2} %; \
             CDi {:.5}, CD by pressure {:.5}",
            100.0 * thickness,
            100.0 * (efficiency / reference - 1.0),
            drag / span,
            by_pressure / span
        );
        assert!((efficiency / reference - 1.0).abs() < 0.01);
        assert!(efficiency < 1.0);
    }
}
