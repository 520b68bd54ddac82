//! `cargo xtask browser`: drives a report page in a real browser.
//!
//! A copy of the page gets a script that does what a reader would and leaves its findings in
//! the page; a headless Chromium runs it and hands the page back. The page is also printed.

use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;
use serde::Deserialize;

/// What drives the page.
const DRIVER: &str = include_str!("browser.js");
/// Collects errors from the first line of the page on.
const LISTENER: &str = "<script>window.failures=[];\
    addEventListener('error',(e)=>window.failures.push(e.message));</script>";
/// Widths of the window, pixels.
const WIDTHS: [u32; 2] = [1400, 800];
/// Names under which browsers are looked for.
const BROWSERS: [&str; 4] = [
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
];
/// Largest page, bytes.
const LARGEST: usize = 6_000_000;

/// The page and the browser.
#[derive(Args)]
pub(crate) struct Browser {
    /// report.html of a case with a mesh
    page: PathBuf,
    /// Program to use instead of the first Chromium found
    #[arg(long)]
    browser: Option<String>,
}

/// Why the page was not driven, or what it does not do.
#[derive(Debug, thiserror::Error)]
pub(crate) enum BrowserError {
    #[error("{}: {source}", path.display())]
    File {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("no browser found among {}; install Chromium or name one with --browser", BROWSERS.join(", "))]
    None,
    #[error("the browser {program} failed: {what}")]
    Failed { program: String, what: String },
    #[error("the browser gave back no findings at {width} pixels")]
    Silent { width: u32 },
    #[error("{0} of the checks are not met")]
    NotMet(usize),
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Finding {
    name: String,
    is_met: bool,
    figure: String,
}

impl Browser {
    /// Drives and prints the page.
    pub(crate) fn run(&self) -> Result<(), BrowserError> {
        let at = |path: &Path| {
            let path = path.to_owned();
            move |source| BrowserError::File { path, source }
        };
        let text = std::fs::read_to_string(&self.page).map_err(at(&self.page))?;
        let program = self.program()?;
        let folder = tempfile::tempdir().map_err(at(&self.page))?;
        let copy = folder.path().join("page.html");
        let driven = text
            .replacen("<style>", &format!("{LISTENER}<style>"), 1)
            .replace("</body>", &format!("<script>{DRIVER}</script></body>"));
        std::fs::write(&copy, driven).map_err(at(&copy))?;
        let mut missed = 0;
        for width in WIDTHS {
            let size = format!("--window-size={width},2000");
            let budget = "--virtual-time-budget=10000";
            let page = call(&program, &[&size, budget, "--dump-dom"], &copy)?;
            let findings = findings(&page).ok_or(BrowserError::Silent { width })?;
            println!("{width} pixels");
            for finding in findings {
                let word = if finding.is_met { "yes" } else { "NO " };
                println!("  {word} {} {}", finding.name, finding.figure);
                missed += usize::from(!finding.is_met);
            }
        }
        let paper = folder.path().join("page.pdf");
        let option = format!("--print-to-pdf={}", paper.display());
        call(&program, &[&option, "--no-pdf-header-footer"], &self.page)?;
        let printed = std::fs::metadata(&paper).map_err(at(&paper))?.len();
        println!("printed: {printed} bytes; page: {} bytes", text.len());
        missed += usize::from(printed < 10_000 || text.len() > LARGEST);
        if missed > 0 {
            return Err(BrowserError::NotMet(missed));
        }
        Ok(())
    }

    fn program(&self) -> Result<String, BrowserError> {
        let named = self.browser.iter().map(String::as_str);
        let mut candidates = named.chain(BROWSERS);
        let runs = |program: &&str| {
            let asked = Command::new(program).arg("--version").output();
            asked.is_ok_and(|output| output.status.success())
        };
        candidates
            .find(runs)
            .map(str::to_owned)
            .ok_or(BrowserError::None)
    }
}

fn call(program: &str, options: &[&str], page: &Path) -> Result<String, BrowserError> {
    let failed = |what: String| BrowserError::Failed {
        program: program.to_owned(),
        what,
    };
    let page = std::fs::canonicalize(page).map_err(|error| failed(error.to_string()))?;
    let output = Command::new(program)
        .args(["--headless", "--no-sandbox", "--disable-gpu"])
        .args(options)
        .arg(format!("file://{}", page.display()))
        .output()
        .map_err(|error| failed(error.to_string()))?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        Err(failed(output.status.to_string()))
    }
}

fn findings(page: &str) -> Option<Vec<Finding>> {
    use base64::Engine;
    let (_, rest) = page.split_once("<pre id=\"outcome\">")?;
    let (packed, _) = rest.split_once("</pre>")?;
    let bytes = base64::engine::general_purpose::STANDARD
        .decode(packed)
        .ok()?;
    serde_json::from_slice(&bytes).ok()
}
