//! Progress bars on standard error, only on a terminal; and the time of every stage.

use super::interrupt::is_interrupted;
use crate::memory::{bytes_in_words, held_bytes};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Stage, how much is done, how much is left, when it will end, and the memory
/// held; narrower than 80 columns, so that it stays on one line.
const TEMPLATE: &str = "{msg:26} {bar:10} {percent:>3} %  {pos}/{len}, {eta} left, {memory}";

/// One bar that goes through the stages of a computation.
#[derive(Debug)]
pub(crate) struct Bar {
    bar: ProgressBar,
    stages: Mutex<Vec<(&'static str, Instant)>>,
}

/// What a computation took.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Effort {
    /// Stages of the same name add up.
    pub(crate) stages: Vec<(&'static str, Duration)>,
    /// The most memory that the process has held, where the system tells.
    pub(crate) peak_bytes: Option<u64>,
}

impl Effort {
    pub(crate) fn total(&self) -> Duration {
        self.stages.iter().map(|(_, time)| *time).sum()
    }
}

impl Bar {
    /// A bar, or a silent one under `--quiet` and where standard error is no
    /// terminal.
    pub(crate) fn new(is_quiet: bool) -> Self {
        if is_quiet || !std::io::stderr().is_terminal() {
            return Self::of(ProgressBar::hidden());
        }
        let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template(TEMPLATE).map(|style| {
            style
                .with_key("memory", |_: &ProgressState, out: &mut dyn Write| {
                    if let Some((held, _)) = held_bytes() {
                        // A bar that cannot be drawn is no fault of the computation.
                        let _ = out.write_str(&bytes_in_words(held));
                    }
                })
                .progress_chars("=> ")
        });
        if let Ok(style) = style {
            bar.set_style(style);
        }
        bar.enable_steady_tick(std::time::Duration::from_millis(200));
        Self::of(bar)
    }

    fn of(bar: ProgressBar) -> Self {
        let stages = Mutex::new(vec![("preparing", Instant::now())]);
        Self { bar, stages }
    }

    /// A new stage of so many steps.
    pub(crate) fn begin(&self, stage: &'static str, steps: u64) {
        if let Ok(mut stages) = self.stages.lock() {
            stages.push((stage, Instant::now()));
        }
        self.bar.reset();
        self.bar.set_length(steps);
        self.bar.set_message(stage);
    }

    /// Removes the bar.
    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
    }

    /// Ends it; time by stage and memory.
    pub(crate) fn effort(self) -> Effort {
        let begun = self
            .stages
            .lock()
            .map_or_else(|_| Vec::new(), |s| s.clone());
        let end = Instant::now();
        let mut stages: Vec<(&'static str, Duration)> = Vec::new();
        for (i, (name, start)) in begun.iter().enumerate() {
            let time = begun.get(i + 1).map_or(end, |next| next.1) - *start;
            match stages.iter_mut().find(|(known, _)| known == name) {
                Some((_, sum)) => *sum += time,
                None => stages.push((name, time)),
            }
        }
        Effort {
            stages,
            peak_bytes: held_bytes().map(|(_, peak)| peak),
        }
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
        self.bar.inc(steps);
    }

    fn cancelled(&self) -> bool {
        is_interrupted()
    }
}

impl fladder_stability::Progress for Bar {
    fn advance(&self) {
        self.bar.inc(1);
    }

    fn is_cancelled(&self) -> bool {
        is_interrupted()
    }
}
