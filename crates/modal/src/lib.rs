//! Finite-element modal results and their transfer to the wetted surface.
//!
//! From a result file to modes on a mesh: [`load`] reads it, brings it into SI
//! units and mesh axes (x aft, y to starboard, z up), parts rigid from elastic
//! modes by shape and normalises the elastic ones,
//!
//! $$ \varphi_i^T M \varphi_i = 1, \qquad \varphi_i^T K \varphi_i = \omega_i^2; $$
//!
//! [`transfer`] carries them to the wetted surface by one sparse matrix,
//! `u = H q`, whose transpose carries forces back. [`rigid_modes`] makes the six
//! rigid modes from mass properties, [`AnalyticMode::on`] modes from formulae.
//! Nothing here knows of the flow, of case files or of terminals.

mod analytic;
mod attach;
mod axes_hint;
mod binary;
mod block_matrix;
mod cells;
mod closest;
mod components;
mod contents;
mod dat;
mod edit;
mod edit_setup;
mod eigenvalues;
mod element;
mod error;
mod face;
mod format;
mod frames;
mod frd;
mod frd_binary;
mod half;
mod inp;
mod model;
mod msh;
mod msh_scanner;
mod nastran;
mod neutral;
mod offset;
mod quality;
mod raw;
mod read;
mod result;
mod rigid;
mod rigid_fit;
mod rigid_half;
mod rod;
mod scatter;
mod skin;
mod skin_error;
mod spline;
mod summary;
mod text;
mod transfer;
mod transfer_settings;
mod units;
mod unv;
mod unv_binary;
mod unv_modes;

pub use analytic::{AnalyticError, AnalyticMode, Component, Motion, PolynomialTerm};
pub use block_matrix::BlockMatrix;
pub use cells::Cells;
pub use components::Mapping;
pub use contents::{FileContents, FileMatrix, FileMode, read_contents};
pub use edit::{EditError, Edits, HingeChange, HingeRotation, PointMass};
pub use eigenvalues::Eigenvalue;
pub use element::ElementKind;
pub use error::{ReadError, TransferError};
pub use format::Format;
pub use half::{HalfError, SYMMETRY_LIMIT};
pub use model::{
    ElasticMode, PARTICIPATION_LIMIT, RigidBodySettings, StructuralModel, StructureError,
    StructureSettings, load,
};
pub use nastran::op4::{Op4Matrix, read_op4};
pub use neutral::{SCHEMA, write as write_neutral};
pub use read::read_structure;
pub use result::{Element, ModalResult, Mode, NamedSet, Node};
pub use rigid::{Inertia, RIGID_KINDS, RigidBody, RigidBodyError, rigid_modes};
pub use rigid_fit::{RecoveredBody, RigidFit, RigidSurvey, survey};
pub use skin_error::SkinError;
pub use spline::Kernel;
pub use summary::{ModeSummary, ModesSummary, SetSummary, modes_summary, summary_of};
pub use transfer::{
    ComponentReport, Transfer, TransferReport, build as build_transfer, transfer,
};
pub use transfer_settings::{Method, TransferSettings};
pub use units::{Axes, AxesError, Units};
