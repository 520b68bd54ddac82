//! How modes are to be carried to the surface.

use crate::spline::Kernel;
use std::collections::BTreeMap;

/// What carries a part of the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The nearest face of its component, and the rotation of that face.
    #[default]
    Faces,
    /// A spline through the nodes of its component: for beams, and for the few
    /// points of a test.
    Spline(Kernel),
}

impl Method {
    /// Words for reports.
    pub fn words(self) -> &'static str {
        match self {
            Self::Faces => "nearest face",
            Self::Spline(Kernel::ThinPlate) => "thin-plate spline",
            Self::Spline(Kernel::Polyharmonic) => "polyharmonic spline",
        }
    }
}

/// Sets and methods of a transfer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TransferSettings {
    /// Sets of the structure for groups of the mesh; the others are matched by
    /// equal names, else by connectivity.
    pub components: BTreeMap<String, Vec<String>>,
    /// Method of groups that [`methods`](Self::methods) does not name.
    pub default_method: Method,
    /// Methods of single groups.
    pub methods: BTreeMap<String, Method>,
}

impl TransferSettings {
    pub(crate) fn method(&self, group: &str) -> Method {
        self.methods
            .get(group)
            .copied()
            .unwrap_or(self.default_method)
    }
}

/// By faces, with the sets given.
impl From<&BTreeMap<String, Vec<String>>> for TransferSettings {
    fn from(components: &BTreeMap<String, Vec<String>>) -> Self {
        Self {
            components: components.clone(),
            ..Self::default()
        }
    }
}

impl From<&TransferSettings> for TransferSettings {
    fn from(settings: &TransferSettings) -> Self {
        settings.clone()
    }
}
