//! The paper's numbers, `paper.toml`.

use serde::Deserialize;

use super::PaperError;

/// A number of the paper.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Quoted {
    /// By which the command asks for it.
    pub(super) id: String,
    pub(super) quantity: String,
    pub(super) value: f64,
    pub(super) unit: String,
    /// Document, and table or figure.
    pub(super) source: String,
    /// Largest relative difference that is called agreement.
    #[serde(default)]
    pub(super) tolerance: f64,
    /// Cause of a difference; none: it is open.
    #[serde(default)]
    pub(super) why: Option<String>,
    /// Whether it is a time to double (positive) or to halve (negative).
    #[serde(default)]
    pub(super) is_time_of_amplitude: bool,
    /// Whether it is a time of computing.
    #[serde(default)]
    pub(super) is_cost: bool,
}

/// All of them.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Published {
    pub(super) value: Vec<Quoted>,
}

impl Published {
    /// From the file that comes with the program.
    pub(super) fn read() -> Result<Self, PaperError> {
        Ok(toml::from_str(include_str!("paper.toml"))?)
    }

    pub(super) fn get(&self, id: &'static str) -> Result<&Quoted, PaperError> {
        let found = self.value.iter().find(|value| value.id == id);
        found.ok_or(PaperError::Unknown(id))
    }
}
