//! Runs the built program in a folder of its own.
#![allow(dead_code, reason = "each test file uses its part")]

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use fladder_mesh::TriMesh;
use fladder_mesh::shapes::NacaWing;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::SystemTime;

/// The program; built if it is not there or older than its sources, as when
/// the tests of this package alone are run.
fn program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let test = std::env::current_exe().expect("a running test has a path");
        let folder = test
            .parent()
            .and_then(Path::parent)
            .expect("target/<profile>/deps/<test>");
        let path = folder.join(format!("fladder{}", std::env::consts::EXE_SUFFIX));
        let built = path.metadata().and_then(|m| m.modified()).ok();
        if built.is_none_or(|built| built < newest_source()) {
            build(folder);
        }
        path
    })
}

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("tests/ is in the workspace")
        .into()
}

fn newest_source() -> SystemTime {
    let mut folders = vec![workspace().join("crates")];
    let mut newest = SystemTime::UNIX_EPOCH;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder)
            .expect("a source folder")
            .flatten()
        {
            let (path, kind) = (entry.path(), entry.file_type().expect("a source file"));
            let is_test = path.file_name().is_some_and(|name| name == "tests");
            if kind.is_dir() && !is_test {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs" || e == "toml") {
                let modified = entry.metadata().and_then(|m| m.modified());
                newest = newest.max(modified.expect("sources have dates"));
            }
        }
    }
    newest
}

fn build(folder: &Path) {
    let mut cargo = std::process::Command::new(env!("CARGO"));
    cargo
        .current_dir(workspace())
        .args(["build", "--quiet", "--package", "fladder"]);
    cargo.args([
        "--target-dir".as_ref(),
        folder.parent().expect("target").as_os_str(),
    ]);
    if folder.ends_with("release") {
        cargo.arg("--release");
    }
    assert!(
        cargo.status().expect("cargo runs").success(),
        "the program does not build"
    );
}

/// A folder with a case in it.
pub(crate) struct Place(tempfile::TempDir);

impl Place {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> &Self {
        std::fs::write(self.path(name), content).expect("a writable folder");
        self
    }

    pub(crate) fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name))
            .unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(program());
        command.current_dir(self.0.path()).args(arguments);
        command
    }

    /// Runs the program in this folder.
    pub(crate) fn run(&self, arguments: &[&str]) -> Assert {
        self.command(arguments).assert()
    }

    /// Runs what must be refused with exit code 2, and gives back the message,
    /// which must have its four parts and come from no panic.
    pub(crate) fn refused(&self, arguments: &[&str]) -> String {
        let text = errors(&self.run(arguments).code(2));
        for part in ["error:", "where:", "why:", "do:"] {
            assert!(text.contains(part), "`{part}` is missing in:\n{text}");
        }
        assert!(
            !text.contains("panicked") && !text.contains("report this"),
            "{text}"
        );
        text
    }
}

pub(crate) fn errors(assert: &Assert) -> String {
    String::from_utf8_lossy(&assert.get_output().stderr).into_owned()
}

pub(crate) fn output(assert: &Assert) -> String {
    String::from_utf8_lossy(&assert.get_output().stdout).into_owned()
}

/// A surface as Wavefront OBJ.
pub(crate) fn obj(mesh: &TriMesh) -> String {
    let mut text = String::new();
    for v in &mesh.vertices {
        writeln!(text, "v {} {} {}", v.x, v.y, v.z).expect("strings take all");
    }
    for [a, b, c] in &mesh.triangles {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).expect("strings take all");
    }
    text
}

/// A coarse wing that is computed in a second.
pub(crate) fn small_wing() -> TriMesh {
    let wing = NacaWing {
        thickness: 0.12,
        chord: 1.0,
        span: 4.0,
        n_chord: 8,
        n_half_span: 5,
        ..NacaWing::default()
    };
    wing.structured().expect("a wing")
}

/// A rigid wing that plunges and pitches on springs.
pub(crate) const WING_CASE: &str = r#"title = "small wing"
[reference]
semichord = 0.5
[flow]
density = 1.225
[mesh]
file = "wing.obj"
[wake]
mode = "required"
[structure.matrices]
mass = [[40.0, -4.0], [-4.0, 4.0]]
stiffness = [[40000.0, 0.0], [0.0, 16000.0]]
[[modes.analytic]]
name = "plunge"
translation = [0.0, 0.0, 1.0]
[[modes.analytic]]
name = "pitch"
rotation = { axis = [0.0, 1.0, 0.0], point = [0.4, 0.0, 0.0] }
[gaf]
k = [0.0, 0.05, 0.1, 0.2, 0.4, 0.8, 1.5]
[stability]
speed = { from = 20.0, to = 80.0, count = 13 }
"#;

/// The small wing and its case in a folder.
pub(crate) fn wing_place() -> Place {
    let place = Place::new();
    place
        .write("wing.obj", obj(&small_wing()))
        .write("wing.toml", WING_CASE);
    place
}
