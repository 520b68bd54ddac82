//! Analytic bodies as meshes: spheres, ellipsoids, wings of NACA section, bodies with wings.

mod parts;
mod soup;
mod sphere;
mod star;
mod unstructured;
mod wing;
mod wing_body;

pub use sphere::{ellipsoid, icosphere};
pub use star::Star;
pub use wing::{Extent, NacaWing, ShapeError, Tip, naca_half_thickness};
pub use wing_body::{Arm, Tail, WingBody};
