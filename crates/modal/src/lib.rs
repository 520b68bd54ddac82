//! Finite-element modal results and their transfer to the wetted surface.

mod analytic;
mod axes_hint;
mod block_matrix;
mod closest;
mod components;
mod dat;
mod element;
mod error;
mod face;
mod format;
mod frd;
mod inp;
mod model;
mod neutral;
mod offset;
mod raw;
mod read;
mod result;
mod rigid;
mod rigid_fit;
mod skin;
mod summary;
mod text;
mod transfer;
mod units;

pub use analytic::{AnalyticError, AnalyticMode, Component, Motion, PolynomialTerm};
pub use block_matrix::BlockMatrix;
pub use components::Mapping;
pub use element::ElementKind;
pub use error::{ReadError, TransferError};
pub use format::Format;
pub use model::{
    ElasticMode, PARTICIPATION_LIMIT, RigidBodySettings, StructuralModel, StructureError,
    StructureSettings, load,
};
pub use neutral::{SCHEMA, write as write_neutral};
pub use read::read_structure;
pub use result::{Element, ModalResult, Mode, NamedSet, Node};
pub use rigid::{Inertia, RigidBody, RigidBodyError, rigid_modes};
pub use rigid_fit::{RecoveredBody, RigidFit, RigidSurvey, survey};
pub use summary::{ModeSummary, ModesSummary, SetSummary, modes_summary};
pub use transfer::{
    ComponentReport, Transfer, TransferReport, build as build_transfer, transfer,
};
pub use units::{Axes, AxesError, Units};
