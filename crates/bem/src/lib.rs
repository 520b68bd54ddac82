//! Generalised aerodynamic forces in the Laplace plane, incompressible flow.
//!
//! $$ Q_{ij}(p) = -\oint_S c_{p,j}(p)\,\mathbf n\cdot\boldsymbol\varphi_i\,\mathrm dS,
//!    \qquad p = g + \mathrm ik = s b/U $$
//!
//! Forces act on the structure; n points into the fluid; b is the reference semichord
//! (Eller, IFASD-2009-119, eq. (2)). A boundary-element method with a continuous, linear
//! potential on flat triangles, tested by Galerkin rows, with a wake that is found by
//! itself; linearised about the steady flow at incidence with unknowns carried by the
//! surface. One real factorisation gives a [`TransferModel`] that evaluates Q at any p.
//!
//! | module | idea |
//! |---|---|
//! | `panels` | influence of flat triangles |
//! | `adjacency`, `cut` | surface cut open along trailing edges |
//! | `body_path`, `body_trace`, `body_node`, `carry` | lines that carry a jump down a body |
//! | `stations`, `wake`, `wake_builder`, `wake_jumps`, `sheet_lines`, `wake_sheet` | the sheet and what jump it carries |
//! | `strike` | sheets that run into bodies |
//! | `contour`, `far_wake`, `far_tiles` | its semi-infinite part on a path in the complex plane |
//! | `lanes`, `panel_block`, `ordering`, `tiles` | eight points at once, blocks of close panels, test triangles |
//! | `source_columns` | products with source strengths |
//! | `skeleton`, `receiver`, `regions`, `received` | few points at which far influences are known |
//! | `galerkin`, `near_field`, `influence`, `assembly` | the equations |
//! | `dense`, `blocked_lu` | their factorisation |
//! | `hierarchical`, `krylov` | the same for more unknowns than a matrix can hold |
//! | `image` | half models |
//! | `guards`, `nose` | what the mesh resolves |
//! | `onset`, `boundary`, `pressure`, `steady` | modes in, forces out, steady flow |
//! | `shape_change` | elastic columns with the influences of the deformed surface |
//! | `prepare`, `surface_flow` | factorised body and steady flow; pressures for pictures |
//! | `trefftz` | induced drag from the wake far downstream |
//! | `wake_influence`, `reduce`, `blocks`, `transfer`, `solve` | the reduced model |
//!
//! Nothing here knows about files, clocks or terminals.

mod adjacency;
mod assembly;
mod blocked_lu;
mod blocks;
mod body_node;
mod body_path;
mod body_trace;
mod boundary;
mod carry;
mod contour;
mod cut;
mod dense;
#[cfg(test)]
mod direct;
mod divided_edges;
mod edge_cells;
mod error;
mod far_tiles;
mod far_wake;
mod galerkin;
mod guards;
mod hierarchical;
mod image;
mod influence;
mod krylov;
mod lanes;
mod near_field;
mod nose;
mod onset;
mod ordering;
mod panel_block;
pub mod panels;
#[doc(hidden)]
pub mod pieces;
mod prepare;
mod pressure;
mod progress;
mod received;
mod receiver;
mod reduce;
mod regions;
mod shape_change;
mod sheet_lines;
mod skeleton;
mod solve;
mod source_columns;
mod stations;
mod steady;
mod strike;
mod surface_flow;
mod tiles;
mod transfer;
mod trefftz;
mod wake;
mod wake_builder;
mod wake_influence;
mod wake_jumps;
mod wake_sheet;

pub use dense::Solver;
pub use error::{BemError, LaplaceError};
pub use fladder_mesh::Symmetry;
pub use guards::guards;
pub use progress::{Progress, Silent};
pub use shape_change::ShapeChange;
pub use solve::{Flow, Plan, Problem, Sizes, Solution, WakeDirection, plan, solve};
pub use steady::{Loads, OnsetForm, SpanwiseJump, SteadyState};
pub use surface_flow::{SurfaceFlow, UnsteadyPressure, surface_flow};
pub use transfer::TransferModel;
pub use wake_sheet::{JunctionLine, WakeSheet};
