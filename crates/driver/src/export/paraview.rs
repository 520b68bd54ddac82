//! A motion over its cycle for ParaView: one VTU a frame and a collection that names them.

use crate::report::Motion;
use fladder_mesh::vtu::{Field, Grid, vtu};
use fladder_mesh::{TriMesh, Vec3};
use std::f64::consts::TAU;
use std::fmt::Write;

/// Frames of a cycle.
pub(crate) const FRAMES: usize = 16;

/// The surface at one frame with its displacement, the largest of the cycle one.
pub(crate) fn frame(
    mesh: &TriMesh,
    motion: &Motion,
    number: usize,
) -> std::io::Result<Vec<u8>> {
    let (sine, cosine) = (TAU * number as f64 / FRAMES as f64).sin_cos();
    let imaginary = |v: usize| motion.imaginary.get(v).copied().unwrap_or_default();
    let largest = (0..motion.real.len())
        .map(|v| (motion.real[v].norm_squared() + imaginary(v).norm_squared()).sqrt())
        .fold(f64::MIN_POSITIVE, f64::max);
    let displacement: Vec<Vec3> = (0..motion.real.len())
        .map(|v| (motion.real[v] * cosine - imaginary(v) * sine) / largest)
        .collect();
    let mut bytes = Vec::new();
    vtu(
        &mut bytes,
        &Grid {
            points: &mesh.vertices,
            triangles: &mesh.triangles,
            point_data: vec![Field::vectors("displacement", displacement)],
            ..Grid::default()
        },
    )?;
    Ok(bytes)
}

/// The collection of all frames, time in seconds.
pub(crate) fn collection(frames: &[String], frequency_hz: f64) -> String {
    let mut text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" \
                    byte_order=\"LittleEndian\">\n<Collection>\n"
        .to_owned();
    let period = if frequency_hz > 0.0 {
        1.0 / frequency_hz
    } else {
        1.0
    };
    for (number, name) in frames.iter().enumerate() {
        let time = period * number as f64 / frames.len() as f64;
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "<DataSet timestep=\"{time}\" part=\"0\" file=\"{name}\"/>"
        );
    }
    text.push_str("</Collection>\n</VTKFile>\n");
    text
}
