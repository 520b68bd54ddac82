//! Accuracy of the aerodynamics, each case written once with the size of its mesh as a
//! parameter: the tests run it on a small mesh, `cargo xtask validate` on a fine one.
//!
//! | module | compared with |
//! |---|---|
//! | [`bodies`] | row sums, added masses of sphere and ellipsoids |
//! | [`stream`] | Kirchhoff's equations: ellipsoids in a stream, free ellipsoids |
//! | [`surface_velocity`] | steady velocity on ellipsoids |
//! | [`wings`] | lift slopes of plates, thick wings, Kutta and Joukowski |
//! | [`section`] | Theodorsen's function at complex p |
//! | [`plate`] | lattices: rectangular plate in the Laplace plane, swept tapered plate |
//! | [`laplace`] | Cauchy and Riemann, conjugate symmetry |
//! | [`aircraft`] | the ScanEagle-like surface: symmetry, junction |
//! | [`smooth`] | rational prediction of a left-out sample |
//! | [`convergence`] | refinement of the ScanEagle-like surface |
//! | [`reference`], [`case`], [`row`] | files, one way to pose a problem, one line of a table |

pub mod aircraft;
pub mod bodies;
pub mod case;
pub mod convergence;
pub mod laplace;
pub mod plate;
pub mod reference;
pub mod row;
pub mod section;
pub mod smooth;
pub mod stream;
pub mod surface_velocity;
pub mod wings;
