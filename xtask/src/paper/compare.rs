//! A number of the paper beside ours, and what is to be said of the two.

use super::published::Quoted;
use super::words::{amplitude, number};

/// What is said of a pair of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    Agrees,
    /// With a cause.
    Differs,
    /// Without one.
    Open,
    /// Costs.
    Faster,
    Slower,
}

impl Verdict {
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Differs => "differs",
            Self::Open => "open",
            Self::Faster => "faster",
            Self::Slower => "slower",
        }
    }
}

/// A line of the comparison.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) quantity: String,
    pub(super) source: String,
    pub(super) paper: String,
    pub(super) here: String,
    pub(super) ratio: Option<f64>,
    pub(super) verdict: Verdict,
    pub(super) why: String,
}

impl Row {
    /// `here` in the unit of the paper's value; none where there is no such thing.
    pub(super) fn new(value: &Quoted, here: Option<f64>) -> Self {
        let here = here.filter(|here| here.is_finite());
        // Growth and decay are compared as rates.
        let ratio = here.map(|here| {
            if value.is_time_of_amplitude {
                value.value / here
            } else {
                here / value.value
            }
        });
        let is_close = ratio.is_some_and(|ratio| (ratio - 1.0).abs() <= value.tolerance);
        let verdict = match (value.is_cost, is_close, &value.why) {
            (true, ..) if ratio.is_some_and(|ratio| ratio <= 1.0) => Verdict::Faster,
            (true, ..) => Verdict::Slower,
            (_, true, _) => Verdict::Agrees,
            (_, _, Some(_)) => Verdict::Differs,
            (_, _, None) => Verdict::Open,
        };
        let why = match verdict {
            Verdict::Differs => value.why.clone().unwrap_or_default(),
            _ => String::new(),
        };
        let text = |quantity: f64| {
            if value.is_time_of_amplitude {
                amplitude(std::f64::consts::LN_2 / quantity)
            } else {
                format!("{} {}", number(quantity), value.unit)
                    .trim_end()
                    .to_owned()
            }
        };
        Self {
            quantity: value.quantity.clone(),
            source: value.source.clone(),
            paper: text(value.value),
            here: here.map_or_else(|| "none".to_owned(), text),
            ratio,
            verdict,
            why,
        }
    }

    /// Quantity, paper, here, ratio, verdict.
    pub(super) fn cells(&self) -> [String; 5] {
        [
            self.quantity.clone(),
            self.paper.clone(),
            self.here.clone(),
            self.ratio.map_or_else(
                || "–".to_owned(),
                |ratio| format!("{ratio:.3}").replace('-', "−"),
            ),
            self.verdict.word().to_owned(),
        ]
    }
}
