//! `cargo xtask samples FOLDER`: every genuine result file below a folder, read here and by
//! independent readers, compared node by node.
//!
//! The other readers are the Python packages pyNastran and pyuff, put into a virtual
//! environment of their own below the target folder on the first run. The figures read here
//! go to the script `compare.py` as JSON lines.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;
use fladder_modal::{FileContents, read_contents};
use serde::Serialize;

/// The script that reads the same files with other readers.
const SCRIPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/src/samples/compare.py");

/// Packages of the other readers; versions with which the comparison is known to work.
const PACKAGES: [&str; 3] = ["pyNastran==1.4.1", "pyuff==2.5.8", "numpy<2"];

/// Endings of files that others include and that mean nothing alone.
const INCLUDED: [&str; 3] = ["inc", "blk", "md"];

/// Compares readers.
#[derive(Args)]
pub(crate) struct Samples {
    /// Folder with files of finite-element programs and test systems
    folder: PathBuf,
    /// Folder for the virtual environment and the figures
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../target/samples"))]
    work: PathBuf,
}

/// Why nothing was compared.
#[derive(Debug, thiserror::Error)]
pub(crate) enum SamplesError {
    #[error("{}: {source}", path.display())]
    Io {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("{what} cannot be run: {source}; Python 3 with venv is needed")]
    Run {
        what: String,
        source: std::io::Error,
    },
    #[error("{0} failed; without the packages there is nothing to compare with")]
    Failed(String),
    #[error("{} holds no files", .0.display())]
    Empty(PathBuf),
}

/// One file as it goes to the script.
#[derive(Serialize)]
struct Line<'a> {
    path: &'a Path,
    error: Option<String>,
    contents: Option<FileContents>,
}

impl Samples {
    /// Runs the comparison; whether all files are read and agree.
    pub(crate) fn run(&self) -> Result<bool, SamplesError> {
        let mut files = Vec::new();
        gather(&self.folder, &mut files)?;
        files.sort();
        if files.is_empty() {
            return Err(SamplesError::Empty(self.folder.clone()));
        }
        let python = self.environment()?;
        let figures = self.work.join("figures.jsonl");
        write(&figures, &files)?;
        let mut command = Command::new(python);
        command.arg(SCRIPT).arg(&figures);
        let status = run(&mut command)?;
        Ok(status.success())
    }

    /// The interpreter of an environment with the packages.
    fn environment(&self) -> Result<PathBuf, SamplesError> {
        let folder = self.work.join("venv");
        let python = folder.join("bin").join("python");
        let done = self.work.join("packages.txt");
        let wanted = PACKAGES.join("\n");
        if fs::read_to_string(&done).is_ok_and(|text| text == wanted) && python.is_file() {
            return Ok(python);
        }
        fs::create_dir_all(&self.work).map_err(|source| io(&self.work, source))?;
        let mut make = Command::new("python3");
        make.arg("-m").arg("venv").arg(&folder);
        let mut install = Command::new(&python);
        install
            .args(["-m", "pip", "install", "--quiet"])
            .args(PACKAGES);
        for command in [&mut make, &mut install] {
            if !run(command)?.success() {
                return Err(SamplesError::Failed(format!("{command:?}")));
            }
        }
        fs::write(&done, wanted).map_err(|source| io(&done, source))?;
        Ok(python)
    }
}

fn io(path: &Path, source: std::io::Error) -> SamplesError {
    SamplesError::Io {
        path: path.to_owned(),
        source,
    }
}

fn run(command: &mut Command) -> Result<std::process::ExitStatus, SamplesError> {
    command.status().map_err(|source| SamplesError::Run {
        what: command.get_program().to_string_lossy().into_owned(),
        source,
    })
}

fn gather(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), SamplesError> {
    for entry in fs::read_dir(folder).map_err(|source| io(folder, source))? {
        let path = entry.map_err(|source| io(folder, source))?.path();
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        if path.is_dir() {
            gather(&path, files)?;
        } else if !INCLUDED.contains(&ending.as_ref()) {
            files.push(path);
        }
    }
    Ok(())
}

fn write(figures: &Path, files: &[PathBuf]) -> Result<(), SamplesError> {
    let wrong = |source| io(figures, source);
    let mut out = BufWriter::new(File::create(figures).map_err(wrong)?);
    for path in files {
        let (contents, error) = match read_contents(path) {
            Ok(contents) => (Some(contents), None),
            Err(error) => (None, Some(error.to_string())),
        };
        let line = Line {
            path,
            error,
            contents,
        };
        serde_json::to_writer(&mut out, &line).map_err(|error| wrong(error.into()))?;
        out.write_all(b"\n").map_err(wrong)?;
    }
    out.flush().map_err(wrong)
}
