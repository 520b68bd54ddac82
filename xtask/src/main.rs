//! Chores: `cargo xtask mesh wing --chord 0.25 --span 2 wing.msh`.

mod mesh;

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
}

fn main() -> std::process::ExitCode {
    let Chore::Mesh(shape) = Arguments::parse().chore;
    match shape.write() {
        Ok(said) => {
            println!("{said}");
            std::process::ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            std::process::ExitCode::from(2)
        }
    }
}
