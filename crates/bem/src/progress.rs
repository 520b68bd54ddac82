//! How far a computation is, told to whoever asked for it.

/// Receives progress; a stage is announced, then advanced from any thread.
pub trait Progress: Sync {
    /// A new stage of `total` steps begins.
    fn stage(&self, name: &'static str, total: u64);
    /// `steps` more are done.
    fn advance(&self, steps: u64);
    /// Whether the computation should stop.
    fn cancelled(&self) -> bool {
        false
    }
}

/// Ignores progress.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn stage(&self, _name: &'static str, _total: u64) {}
    fn advance(&self, _steps: u64) {}
}
