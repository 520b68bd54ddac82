//! Ctrl-C: the first ends the program cleanly, the second at once.

use crate::failure::exit;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Time a stage has to end by itself after the first Ctrl-C. Files appear by
/// renaming, so leaving later harms none.
const PATIENCE: Duration = Duration::from_millis(1500);

/// Whether the user asked to stop.
pub(crate) fn is_interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// Begins to listen for Ctrl-C and termination.
pub(crate) fn watch() {
    // Without a handler the system's own way of ending stays in force.
    let _ = ctrlc::set_handler(|| {
        if INTERRUPTED.swap(true, Ordering::SeqCst) {
            leave();
        }
        eprintln!("\nstopping; press Ctrl-C again to leave at once");
        std::thread::spawn(|| {
            std::thread::sleep(PATIENCE);
            eprintln!(
                "error: interrupted\n  where: the running computation\n  why:   what was not \
                 finished is lost; finished entries of the cache stay\n  do:    repeat the same \
                 command to go on"
            );
            leave();
        });
    });
}

fn leave() -> ! {
    std::process::exit(i32::from(exit::INTERRUPTED))
}
