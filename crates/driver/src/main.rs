//! The program `fladder`.

fn main() -> std::process::ExitCode {
    fladder::cli::main()
}
