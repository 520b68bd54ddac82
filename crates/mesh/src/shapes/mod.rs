//! Analytic bodies as meshes: spheres, ellipsoids and wings of NACA section.

mod parts;
mod sphere;
mod unstructured;
mod wing;

pub use sphere::{ellipsoid, icosphere};
pub use wing::{Extent, NacaWing, ShapeError, Tip, naca_half_thickness};
