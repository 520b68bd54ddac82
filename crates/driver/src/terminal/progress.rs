//! Progress bars on standard error, only on a terminal.

use super::interrupt::is_interrupted;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;

/// Stage, how much is done, how much is left, and when it will end; narrower
/// than 80 columns, so that it stays on one line.
const TEMPLATE: &str = "{msg:27} {bar:14} {percent:>3} %  {pos}/{len}, {eta} left";

/// One bar that goes through the stages of a computation.
#[derive(Debug)]
pub(crate) struct Bar(ProgressBar);

impl Bar {
    /// A bar, or a silent one under `--quiet` and where standard error is no
    /// terminal.
    pub(crate) fn new(is_quiet: bool) -> Self {
        if is_quiet || !std::io::stderr().is_terminal() {
            return Self(ProgressBar::hidden());
        }
        let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr());
        let style =
            ProgressStyle::with_template(TEMPLATE).map(|style| style.progress_chars("=> "));
        if let Ok(style) = style {
            bar.set_style(style);
        }
        bar.enable_steady_tick(std::time::Duration::from_millis(200));
        Self(bar)
    }

    /// A new stage of so many steps.
    pub(crate) fn begin(&self, stage: &'static str, steps: u64) {
        self.0.reset();
        self.0.set_length(steps);
        self.0.set_message(stage);
    }

    /// Removes the bar.
    pub(crate) fn clear(&self) {
        self.0.finish_and_clear();
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.clear();
    }
}

impl fladder_bem::Progress for Bar {
    fn stage(&self, name: &'static str, total: u64) {
        self.begin(name, total);
    }

    fn advance(&self, steps: u64) {
        self.0.inc(steps);
    }

    fn cancelled(&self) -> bool {
        is_interrupted()
    }
}

impl fladder_stability::Progress for Bar {
    fn advance(&self) {
        self.0.inc(1);
    }

    fn is_cancelled(&self) -> bool {
        is_interrupted()
    }
}
