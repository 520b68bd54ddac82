//! Finite-element modal results and their transfer to the wetted surface.

mod analytic;
mod dat;
mod element;
mod error;
mod format;
mod frd;
mod inp;
mod model;
mod neutral;
mod raw;
mod read;
mod result;
mod rigid;
mod rigid_fit;
mod summary;
mod text;
mod units;

pub use analytic::{AnalyticError, AnalyticMode, Component, Motion, PolynomialTerm};
pub use element::ElementKind;
pub use error::ReadError;
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
pub use units::{Axes, AxesError, Units};
