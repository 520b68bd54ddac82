//! Coordinate frames in which nodes are placed and displacements are given.
//!
//! A rectangular, cylindrical or spherical frame has an origin A, its z axis
//! through B, and C in its x–z half plane: `k = (B − A)/|B − A|`,
//! `j ∥ k × (C − A)`, `i = j × k`. Coordinates are (x, y, z), (r, θ, z) or
//! (ρ, θ from z, φ about z), angles in degrees; displacements are along the
//! tangents of the coordinate lines at the node. Points are given in another
//! frame or as nodes, which may lie in a third one.

use fladder_mesh::Vec3;
use nalgebra::Matrix3;
use std::collections::{BTreeMap, HashMap};

/// Frames and nodes may rest on one another this deep; a longer chain is not
/// written by any program.
const DEPTH: usize = 64;

/// Smallest |k × (C − A)| over |C − A|: below it the three points are on a
/// line as far as six digits can tell.
const COLLINEAR: f64 = 1e-7;

/// What the coordinates of a frame are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coordinates {
    Rectangular,
    Cylindrical,
    Spherical,
}

/// Where the three points of a frame are.
#[derive(Clone, Debug)]
pub(crate) enum Points {
    /// Coordinates in another frame; 0 is the basic one.
    In(u64, [Vec3; 3]),
    /// Nodes.
    Nodes([u64; 3]),
}

/// A frame in basic axes.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    coordinates: Coordinates,
    origin: Vec3,
    /// Columns i, j, k.
    axes: Matrix3<f64>,
}

impl Frame {
    /// The basic frame.
    fn basic() -> Self {
        Self {
            coordinates: Coordinates::Rectangular,
            origin: Vec3::zeros(),
            axes: Matrix3::identity(),
        }
    }

    /// A frame from its three points in basic axes.
    pub(crate) fn from_points(
        coordinates: Coordinates,
        [a, b, c]: [Vec3; 3],
    ) -> Result<Self, String> {
        let wrong = || "has three points on a line".to_owned();
        let k = (b - a).try_normalize(0.0).ok_or_else(wrong)?;
        let across = k.cross(&(c - a));
        let (height, limit) = (across.norm(), COLLINEAR * (c - a).norm());
        if height.is_nan() || limit.is_nan() || height <= limit {
            return Err(wrong());
        }
        let j = across.normalize();
        Ok(Self {
            coordinates,
            origin: a,
            axes: Matrix3::from_columns(&[j.cross(&k), j, k]),
        })
    }

    /// A place in basic axes.
    fn place(&self, x: &Vec3) -> Vec3 {
        let local = match self.coordinates {
            Coordinates::Rectangular => *x,
            Coordinates::Cylindrical => {
                let (sin, cos) = x.y.to_radians().sin_cos();
                Vec3::new(x.x * cos, x.x * sin, x.z)
            }
            Coordinates::Spherical => {
                let (sin_theta, cos_theta) = x.y.to_radians().sin_cos();
                let (sin_phi, cos_phi) = x.z.to_radians().sin_cos();
                Vec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta) * x.x
            }
        };
        self.origin + self.axes * local
    }

    /// Directions of displacement components at a place, as columns.
    fn directions(&self, place: &Vec3) -> Matrix3<f64> {
        let local = self.axes.transpose() * (place - self.origin);
        let phi = local.y.atan2(local.x);
        let (sin, cos) = phi.sin_cos();
        let turned = match self.coordinates {
            Coordinates::Rectangular => Matrix3::identity(),
            Coordinates::Cylindrical => {
                Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0)
            }
            Coordinates::Spherical => {
                let theta = local.x.hypot(local.y).atan2(local.z);
                let (st, ct) = theta.sin_cos();
                Matrix3::from_columns(&[
                    Vec3::new(st * cos, st * sin, ct),
                    Vec3::new(ct * cos, ct * sin, -st),
                    Vec3::new(-sin, cos, 0.0),
                ])
            }
        };
        self.axes * turned
    }
}

/// A node as its card gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grid {
    /// Frame of the coordinates.
    pub(crate) placed_in: u64,
    pub(crate) coordinates: Vec3,
    /// Frame of the displacements.
    pub(crate) moves_in: u64,
}

/// Frames and nodes as cards give them.
#[derive(Debug, Default)]
pub(crate) struct Frames {
    definitions: BTreeMap<u64, (Coordinates, Points)>,
    pub(crate) grids: BTreeMap<u64, Grid>,
    known: HashMap<u64, Frame>,
}

impl Frames {
    /// Adds a frame.
    pub(crate) fn define(
        &mut self,
        id: u64,
        coordinates: Coordinates,
        points: Points,
    ) -> Result<(), String> {
        let old = self.definitions.insert(id, (coordinates, points));
        if id == 0 || old.is_some() {
            return Err(format!("coordinate system {id} is defined twice"));
        }
        Ok(())
    }

    /// Places of all nodes in basic axes, and the directions of displacement
    /// of those that have their own.
    #[expect(clippy::type_complexity, reason = "two tables by node number")]
    pub(crate) fn resolve(
        &mut self,
    ) -> Result<(BTreeMap<u64, Vec3>, BTreeMap<u64, Matrix3<f64>>), String> {
        let (mut places, mut directions) = (BTreeMap::new(), BTreeMap::new());
        let ids: Vec<u64> = self.grids.keys().copied().collect();
        for id in ids {
            let place = self.place_of(id, 0)?;
            places.insert(id, place);
            let moves_in = self.grids[&id].moves_in;
            if moves_in != 0 {
                let frame = self.frame(moves_in, 0);
                let frame = frame.map_err(|message| format!("node {id}: {message}"))?;
                directions.insert(id, frame.directions(&place));
            }
        }
        Ok((places, directions))
    }

    fn place_of(&mut self, node: u64, depth: usize) -> Result<Vec3, String> {
        let Some(grid) = self.grids.get(&node).copied() else {
            return Err(format!("node {node} of a coordinate system is not there"));
        };
        let frame = self.frame(grid.placed_in, depth);
        let about = |message| match depth {
            0 => format!("node {node}: {message}"),
            _ => message,
        };
        Ok(frame.map_err(about)?.place(&grid.coordinates))
    }

    fn frame(&mut self, id: u64, depth: usize) -> Result<Frame, String> {
        if id == 0 {
            return Ok(Frame::basic());
        }
        if let Some(frame) = self.known.get(&id) {
            return Ok(frame.clone());
        }
        if depth > DEPTH {
            return Err(format!(
                "coordinate system {id} rests on itself, or on more than {DEPTH} others"
            ));
        }
        let Some((coordinates, points)) = self.definitions.get(&id).cloned() else {
            return Err(format!("coordinate system {id} is not defined"));
        };
        let points = match points {
            Points::In(other, points) => {
                let other = self.frame(other, depth + 1)?;
                points.map(|point| other.place(&point))
            }
            Points::Nodes([a, b, c]) => [
                self.place_of(a, depth + 1)?,
                self.place_of(b, depth + 1)?,
                self.place_of(c, depth + 1)?,
            ],
        };
        let frame = Frame::from_points(coordinates, points)
            .map_err(|message| format!("coordinate system {id} {message}"))?;
        self.known.insert(id, frame.clone());
        Ok(frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(placed_in: u64, coordinates: [f64; 3], moves_in: u64) -> Grid {
        Grid {
            placed_in,
            coordinates: Vec3::from(coordinates),
            moves_in,
        }
    }

    /// The displacement of a coordinate is the derivative of the place by it.
    #[test]
    fn directions_are_tangents_of_coordinate_lines() {
        let points = [[1.0, 2.0, 3.0], [1.5, 2.5, 4.0], [4.0, 2.0, 3.5]].map(Vec3::from);
        // What an angle turns at: r, and r sin θ at θ = 30 degrees; none: a length.
        for (coordinates, radii) in [
            (Coordinates::Rectangular, [None; 3]),
            (Coordinates::Cylindrical, [None, Some(2.0), None]),
            (Coordinates::Spherical, [None, Some(2.0), Some(1.0)]),
        ] {
            let frame = Frame::from_points(coordinates, points).unwrap();
            let at = Vec3::new(2.0, 30.0, 40.0);
            let directions = frame.directions(&frame.place(&at));
            for (axis, radius) in radii.into_iter().enumerate() {
                let step = 1e-5;
                let unit = radius.map_or(step, |_| f64::to_degrees(step));
                let forth = frame.place(&(at + Vec3::ith(axis, unit)));
                let back = frame.place(&(at - Vec3::ith(axis, unit)));
                let tangent = (forth - back) / (2.0 * step * radius.unwrap_or(1.0));
                let error = (tangent - directions.column(axis)).norm();
                assert!(error < 1e-9, "{coordinates:?} {axis}: {error:e}");
            }
        }
    }

    #[test]
    fn frames_on_nodes_in_frames_are_found_and_circles_are_refused() {
        let mut frames = Frames::default();
        let turned = [[1.0, 0.0, 0.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]].map(Vec3::from);
        frames
            .define(5, Coordinates::Rectangular, Points::In(0, turned))
            .unwrap();
        frames
            .define(6, Coordinates::Cylindrical, Points::Nodes([1, 2, 3]))
            .unwrap();
        frames.grids = BTreeMap::from([
            (1, grid(5, [0.0, 0.0, 0.0], 0)),
            (2, grid(5, [0.0, 0.0, 2.0], 0)),
            (3, grid(5, [1.0, 0.0, 0.0], 0)),
            (4, grid(6, [2.0, 90.0, 1.0], 6)),
        ]);
        let (places, directions) = frames.resolve().unwrap();
        // Frame 5 has its x along y: frame 6 too, its y along −x.
        assert!((places[&4] - Vec3::new(-1.0, 0.0, 1.0)).norm() < 1e-15);
        let radial = directions[&4].column(0).into_owned();
        assert!((radial - Vec3::new(-1.0, 0.0, 0.0)).norm() < 1e-15);
        frames.grids.insert(1, grid(6, [0.0; 3], 0));
        frames.known.clear();
        assert!(frames.resolve().unwrap_err().contains("rests on itself"));
    }
}
