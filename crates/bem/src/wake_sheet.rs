//! The wake as it is looked at: near sheet, lines on bodies, length of rows.

/// The near part of the wake, which the far part continues straight on.
///
/// Sheets that lie on each other, where one carries jumps of several trailing edges, are
/// there once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WakeSheet {
    /// Positions in mesh axes, m.
    pub vertices: Vec<[f64; 3]>,
    /// Three vertex numbers a triangle, counter-clockwise seen from the trailing edge's
    /// upper side.
    pub triangles: Vec<[u32; 3]>,
    /// Number of the trailing edge of each triangle, as in
    /// [`Problem::trailing_edges`](crate::Problem::trailing_edges). A strip across a blunt
    /// base is counted to one of the edges it joins.
    pub edge: Vec<u32>,
    /// Row of each triangle, from 0 at the trailing edge.
    pub row: Vec<u32>,
    /// Lines on bodies along which the jump at a trailing edge's end is carried.
    pub junction_lines: Vec<JunctionLine>,
    /// Unit vector along the wake.
    pub direction: [f64; 3],
    /// Length of the longest row, m; 0 without a wake.
    pub longest_row: f64,
}

/// A line of mesh edges from a trailing edge's end down a body.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JunctionLine {
    /// Number of the trailing edge.
    pub edge: u32,
    /// Vertices of the mesh, from the trailing edge on.
    pub vertices: Vec<u32>,
}

impl WakeSheet {
    /// Phase of the convected wave along the longest row, |Im p| h/b in rad, at reduced
    /// frequency k = ω b/U.
    ///
    /// The jump is linear along a row. Relative error of Q against rows without length,
    /// measured on a wing of aspect ratio 8: 4e-4 at 0.04 rad, 3e-3 at 0.1, 1e-2 at 0.2,
    /// 3e-2 at 0.4, 8e-2 at 0.8.
    pub fn phase_per_row(&self, k: f64, semichord: f64) -> f64 {
        k.abs() * self.longest_row / semichord
    }
}
