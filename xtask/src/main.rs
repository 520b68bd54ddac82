//! Chores: `cargo xtask mesh wing --chord 0.25 --span 2 wing.msh`, `cargo xtask validate`,
//! `cargo xtask paper`, `cargo xtask samples FOLDER`.

mod bench;
mod browser;
mod exports;
mod marked;
mod mesh;
mod paper;
mod samples;
mod scaneagle;
mod validate;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

#[derive(Parser)]
#[command(about = "Chores of the fladder workspace")]
struct Arguments {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Subcommand)]
enum Chore {
    /// Write the mesh of an analytic shape as Gmsh 4.1
    #[command(subcommand)]
    Mesh(mesh::Shape),
    /// Measure speed and memory and write benches/RESULTS.md
    Bench(bench::Bench),
    /// Measure the accuracy of the aerodynamics on fine meshes and write docs/validation.md
    Validate(validate::Validate),
    /// Drive a report page in a headless Chromium and print it
    Browser(browser::Browser),
    /// Read the files of a run with NumPy and pyNastran and compare them with its JSON
    Exports(exports::Exports),
    /// Make surface and modes of the ScanEagle-like aircraft from its tables
    #[command(subcommand)]
    Scaneagle(scaneagle::ScanEagle),
    /// Reproduce figures and tables of the paper (IFASD-2009-119, section 5) with the
    /// ScanEagle-like aircraft
    Paper(paper::Paper),
    /// Compare genuine result files below a folder with independent readers, node by node
    Samples(samples::Samples),
}

fn main() -> ExitCode {
    match Arguments::parse().chore {
        Chore::Mesh(shape) => match shape.write() {
            Ok(said) => {
                println!("{said}");
                ExitCode::SUCCESS
            }
            Err(error) => refused(&error),
        },
        Chore::Bench(bench) => match bench.run() {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => refused(&error),
        },
        Chore::Paper(paper) => match paper.run() {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => refused(&error),
        },
        Chore::Browser(browser) => match browser.run() {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => refused(&error),
        },
        Chore::Exports(exports) => match exports.run() {
            Ok(true) => ExitCode::SUCCESS,
            Ok(false) => {
                eprintln!("not all files say the same");
                ExitCode::FAILURE
            }
            Err(error) => refused(&error),
        },
        Chore::Scaneagle(chore) => match chore.run() {
            Ok(said) => {
                println!("{said}");
                ExitCode::SUCCESS
            }
            Err(error) => refused(&error),
        },
        Chore::Validate(validate) => match validate.run() {
            Ok(true) => ExitCode::SUCCESS,
            Ok(false) => {
                eprintln!("not all goals are met");
                ExitCode::FAILURE
            }
            Err(error) => refused(&error),
        },
        Chore::Samples(samples) => match samples.run() {
            Ok(true) => ExitCode::SUCCESS,
            Ok(false) => {
                eprintln!("not all files are read alike");
                ExitCode::FAILURE
            }
            Err(error) => refused(&error),
        },
    }
}

fn refused(error: &dyn std::error::Error) -> ExitCode {
    eprintln!("{error}");
    ExitCode::from(2)
}
