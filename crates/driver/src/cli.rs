//! The command line.

use crate::commands;
use crate::failure::{Failure, exit};
use crate::terminal::{Console, watch_for_interrupts};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

/// Flutter and flight-dynamic stability from a surface mesh and vibration
/// modes.
#[derive(Debug, Parser)]
#[command(
    name = "fladder",
    version,
    subcommand_required = true,
    arg_required_else_help = true
)]
struct Cli {
    #[command(flatten)]
    common: Common,
    #[command(subcommand)]
    command: Command,
}

/// Options of all commands.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct Common {
    /// Override a key of the case file, for example flow.alpha_deg=2
    #[arg(long, global = true, value_name = "KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Folder of the cache [default: .fladder/gaf beside the case file]
    #[arg(long, global = true, value_name = "DIR")]
    pub(crate) cache: Option<PathBuf>,
    /// Folder of the results [default: results/<case>]
    #[arg(long, global = true, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Number of threads [default: all cores]
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) threads: Option<u16>,
    /// Factorise in double precision instead of single precision refined twice; the same
    /// as --set gaf.exact=true
    #[arg(long, global = true)]
    pub(crate) exact: bool,
    /// Print neither progress nor tables
    #[arg(long, short, global = true)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Whole chain: mesh, aerodynamic forces, sweeps, report folder
    Run {
        /// TOML file, or folder with case.toml
        case: PathBuf,
        /// Which eigenvalue methods run
        #[arg(long, value_enum, default_value_t)]
        method: Method,
    },
    /// Report folder again, from forces in the cache or from gaf.file
    Report {
        /// TOML file, or folder with case.toml
        case: PathBuf,
        /// Which eigenvalue methods run
        #[arg(long, value_enum, default_value_t)]
        method: Method,
    },
    /// Write a folder with a commented case and a small mesh to start from
    New {
        /// Folder to make; its name is that of the case
        name: PathBuf,
    },
    /// Compute the generalised aerodynamic forces into the cache
    Gaf {
        /// TOML file, or folder with case.toml
        case: PathBuf,
        /// Write the forces to this file
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
        /// Evaluate Q exactly at this point instead of on the grid; repeatable
        #[arg(long, value_name = "G,K", allow_hyphen_values = true, value_parser = laplace_point)]
        at: Vec<[f64; 2]>,
        /// Write steady velocity and pressure, the unsteady pressure of every mode at the
        /// points of --at, and the wake for ParaView into this folder; solves again
        #[arg(long, value_name = "DIR")]
        vtu: Option<PathBuf>,
    },
    /// Eigenvalue sweeps only, from cached forces or from gaf.file
    Sweep {
        /// TOML file, or folder with case.toml
        case: PathBuf,
        /// Write the roots to this file
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
        /// Which eigenvalue methods run
        #[arg(long, value_enum, default_value_t)]
        method: Method,
    },
    /// Say all that can be said before computing
    Check {
        /// TOML file, folder with case.toml, or mesh file
        input: PathBuf,
        /// Write the findings to this file
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
        /// Write surface, trailing edges and wake for ParaView into this folder
        #[arg(long, value_name = "DIR")]
        vtu: Option<PathBuf>,
    },
    /// Show what a finite-element result file holds, or what a case makes of it: masses,
    /// modes, and their errors on the surface
    Modes {
        /// Result file; or TOML file, or folder with case.toml
        file: PathBuf,
        /// File with nodes, elements and sets that the result lacks
        #[arg(long, value_name = "FILE")]
        geometry: Option<PathBuf>,
        /// Write the findings to this file
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
        /// Write the modes on the structure, and of a case those on the surface, for
        /// ParaView and as pictures into this folder
        #[arg(long, value_name = "DIR")]
        vtu: Option<PathBuf>,
    },
    /// Look after the cache of aerodynamic forces
    Cache {
        #[command(subcommand)]
        action: CacheAction,
    },
}

#[derive(Debug, Subcommand)]
pub(crate) enum CacheAction {
    /// Show the entries
    List {
        /// Case whose cache is meant [default: --cache, or .fladder/gaf here]
        case: Option<PathBuf>,
    },
    /// Check every entry; exit code 4 when one is bad
    Verify {
        /// Case whose cache is meant [default: --cache, or .fladder/gaf here]
        case: Option<PathBuf>,
    },
    /// Remove bad entries, and good ones not changed for some days
    Prune {
        /// Case whose cache is meant [default: --cache, or .fladder/gaf here]
        case: Option<PathBuf>,
        /// Remove good entries too when they are at least this old
        #[arg(long, value_name = "DAYS")]
        older_than: Option<u32>,
    },
}

/// Which eigenvalue methods run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Method {
    /// p2, and its roots refined
    P2,
    /// p-k
    Pk,
    /// The g-method, and refined roots
    G,
    /// All
    #[default]
    Both,
}

fn laplace_point(text: &str) -> Result<[f64; 2], String> {
    let parts: Vec<&str> = text.split(',').collect();
    let [g, k] = parts[..] else {
        return Err(
            "write two numbers with a comma between them, for example -0.1,0.2".to_owned(),
        );
    };
    let number = |part: &str| {
        let value: Result<f64, _> = part.trim().parse();
        value
            .ok()
            .filter(|value| value.is_finite())
            .ok_or_else(|| format!("`{}` is no finite number", part.trim()))
    };
    let (g, k) = (number(g)?, number(k)?);
    if k == 0.0 && g < 0.0 {
        return Err(format!(
            "g = {g} with k = 0 lies on the branch cut, where Q has no single value; take k \
             above 0 or g of at least 0"
        ));
    }
    Ok([g, k])
}

/// Runs the program.
pub fn main() -> ExitCode {
    report_panics();
    let outcome = std::panic::catch_unwind(|| {
        let cli = match Cli::try_parse() {
            Ok(cli) => cli,
            Err(error) => return usage(&error),
        };
        match run(cli) {
            Ok(()) => exit::DONE,
            Err(failure) => {
                complain(&failure.to_string());
                failure.exit_code()
            }
        }
    });
    // The hook has told of the panic.
    ExitCode::from(outcome.unwrap_or(exit::NUMERICAL))
}

fn usage(error: &clap::Error) -> u8 {
    // Where the stream is closed there is nobody to tell.
    let _ = error.print();
    if error.use_stderr() {
        exit::INPUT
    } else {
        exit::DONE
    }
}

fn complain(text: &str) {
    // Where standard error is closed there is nobody to tell.
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}

fn run(cli: Cli) -> Result<(), Failure> {
    watch_for_interrupts();
    // Work is divided over threads outside of matrix operations; inside, another division
    // would change the last bits of a decomposition with the number of threads.
    faer::set_global_parallelism(faer::Par::Seq);
    let mut common = cli.common;
    if common.exact {
        common.set.push("gaf.exact=true".to_owned());
    }
    if let Some(threads) = common.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(usize::from(threads))
            .build_global()
            .map_err(|error| threads_failed(&error))?;
    }
    let console = Console::new(common.quiet);
    let session = commands::Session { common, console };
    match cli.command {
        Command::Run { case, method } => commands::run(&session, &case, method)?,
        Command::Report { case, method } => commands::report(&session, &case, method)?,
        Command::New { name } => commands::new(&session, &name)?,
        Command::Gaf {
            case,
            json,
            at,
            vtu,
        } => {
            commands::gaf(&session, &case, json.as_deref(), &at, vtu.as_deref())?;
        }
        Command::Sweep { case, json, method } => {
            commands::sweep(&session, &case, json.as_deref(), method)?;
        }
        Command::Check { input, json, vtu } => {
            commands::check(&session, &input, json.as_deref(), vtu.as_deref())?;
        }
        Command::Modes {
            file,
            geometry,
            json,
            vtu,
        } => {
            let wanted = commands::WantedModes {
                geometry: geometry.as_deref(),
                json: json.as_deref(),
                vtu: vtu.as_deref(),
            };
            commands::modes(&session, &file, &wanted)?;
        }
        Command::Cache { action } => commands::cache(&session, &action)?,
    }
    session.console.finish()
}

fn threads_failed(error: &rayon::ThreadPoolBuildError) -> Failure {
    Failure::numerical(
        format!("the threads could not be started: {error}"),
        "--threads",
        "nothing can be computed without them",
        "ask for fewer threads",
    )
}

/// A panic is a fault of the program; it is told like any other failure, with
/// what a report needs.
fn report_panics() {
    // Parallel work fails in many places at once: the first says enough.
    let first = std::sync::Once::new();
    std::panic::set_hook(Box::new(move |panic| {
        let place = panic.location().map_or_else(
            || "unknown".to_owned(),
            |at| format!("{}:{}", at.file(), at.line()),
        );
        let failure = Failure::numerical(
            format!("this should not have happened: {}", message(panic)),
            format!("fladder {}, {place}", env!("CARGO_PKG_VERSION")),
            "the computation stopped; files and cache entries written before are whole",
            "please report this with the case file and the command",
        );
        first.call_once(|| complain(&failure.to_string()));
    }));
}

fn message(panic: &std::panic::PanicHookInfo<'_>) -> String {
    let payload = panic.payload();
    let text = payload.downcast_ref::<&str>().map(ToString::to_string);
    text.or_else(|| payload.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "a panic without a message".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn points_may_begin_with_a_minus_sign_and_the_cut_is_refused() {
        let cli =
            Cli::try_parse_from(["fladder", "gaf", "c", "--at", "-0.1,0.2", "--at", "0,0"]);
        let Command::Gaf { at, .. } = cli.unwrap().command else {
            panic!("another command")
        };
        assert_eq!(at, [[-0.1, 0.2], [0.0, 0.0]]);
        let refused = Cli::try_parse_from(["fladder", "gaf", "c", "--at", "-0.1,0"]);
        assert!(refused.unwrap_err().to_string().contains("branch cut"));
    }

    #[test]
    fn overrides_are_taken_before_and_after_the_command() {
        let cli = Cli::try_parse_from(["fladder", "run", "c", "--set", "a=1", "--set", "b=-2"]);
        assert_eq!(cli.unwrap().common.set, ["a=1", "b=-2"]);
    }
}
