//! Pictures of a sweep as SVG: the root locus and the V-g-f diagram.

mod axis;
mod flutter_diagram;
mod label;
mod layout;
mod panel;
mod root_locus;
mod style;
mod svg;

pub use flutter_diagram::flutter_diagram;
pub use root_locus::root_locus;

use fladder_stability::{MethodResult, Methods};

/// What both pictures show.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// Heading.
    pub title: &'a str,
    /// Conditions, one line under the heading.
    pub conditions: &'a str,
    /// Outcome of the sweep.
    pub methods: &'a Methods,
}

impl<'a> Subject<'a> {
    /// The outcome drawn as lines, and the method's name.
    fn lines(&self) -> Option<(&'a MethodResult, &'static str)> {
        let methods = self.methods;
        methods
            .polished
            .as_ref()
            .map(|result| (result, "p2, refined"))
            .or_else(|| methods.p2.as_ref().map(|result| (result, "p2")))
            .or_else(|| methods.pk.as_ref().map(|result| (result, "p-k")))
    }

    /// The outcome drawn as crosses beside the lines.
    fn crosses(&self) -> Option<&'a MethodResult> {
        let beside = self.methods.polished.is_some() || self.methods.p2.is_some();
        self.methods.pk.as_ref().filter(|_| beside)
    }
}
