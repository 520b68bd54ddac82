//! The binary starts and says what it can do.

use assert_cmd::Command;

#[test]
fn help_names_every_command_and_usage_errors_suggest() {
    let program = || Command::new(env!("CARGO_BIN_EXE_fladder"));
    let help = program().arg("--help").assert().code(0);
    let text = String::from_utf8_lossy(&help.get_output().stdout).into_owned();
    for command in ["run", "gaf", "sweep", "check", "modes", "cache"] {
        assert!(
            text.contains(&format!("  {command} ")),
            "{command} is missing:\n{text}"
        );
    }
    let typo = program().arg("swep").assert().code(2);
    let text = String::from_utf8_lossy(&typo.get_output().stderr).into_owned();
    assert!(text.contains("sweep"), "{text}");
}
