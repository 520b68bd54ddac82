//! Generalised aerodynamic forces as JSON, schema `fladder.gaf/1`.
//!
//! `q[i][j] = [re, im]` of $Q_{ij}$, row force, column motion;
//! `steady[i]` $= -\oint c_{p0}\,\mathbf n\cdot\boldsymbol\varphi_i\,\mathrm dS$.

use crate::failure::Failure;
use faer::{Mat, c64};
use fladder_stability::{GafError, GafPoint, GafTable};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Version of the layout.
pub const SCHEMA: &str = "fladder.gaf/1";

/// A whole file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Document {
    /// Version of the layout.
    pub schema: String,
    /// Mach number.
    pub mach: f64,
    /// $b$ in m.
    pub semichord: f64,
    /// Angle of attack in degrees.
    #[serde(default)]
    pub alpha_deg: f64,
    /// Sideslip in degrees.
    #[serde(default)]
    pub beta_deg: f64,
    /// Names of the modes.
    pub modes: Vec<String>,
    /// Frame of each mode.
    pub frames: Vec<Frame>,
    /// Steady forces, m² for unit-metre modes; null where unknown.
    #[serde(default)]
    pub steady: Vec<Option<f64>>,
    /// Samples.
    pub points: Vec<Sample>,
}

/// Axes in which a mode is a displacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Frame {
    /// Axes that travel with the stream and do not turn.
    Inertial,
    /// Rigid quasi-coordinates of the body.
    Body,
}

impl Frame {
    /// The word of the file.
    pub fn word(self) -> &'static str {
        match self {
            Self::Inertial => "inertial",
            Self::Body => "body",
        }
    }
}

/// $Q$ at one point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Reduced damping.
    pub g: f64,
    /// Reduced frequency.
    pub k: f64,
    /// Rows of real and imaginary parts.
    pub q: Vec<Vec<[f64; 2]>>,
}

impl Sample {
    /// From a matrix.
    pub fn new(g: f64, k: f64, q: &Mat<c64>) -> Self {
        let row = |i| {
            (0..q.ncols())
                .map(|j| [q[(i, j)].re, q[(i, j)].im])
                .collect()
        };
        Self {
            g,
            k,
            q: (0..q.nrows()).map(row).collect(),
        }
    }
}

/// Forces from elsewhere, checked.
#[derive(Clone, Debug)]
pub struct Given {
    /// Samples on a grid.
    pub table: GafTable,
    /// Frame of each mode.
    pub frames: Vec<Frame>,
    /// Incidence they hold for, degrees.
    pub alpha_deg: f64,
    /// Sideslip they hold for, degrees.
    pub beta_deg: f64,
}

/// Reads a file and checks it.
///
/// # Errors
/// Not JSON, another schema, missing fields, wrong shapes, values that are not
/// finite, contradicting doubles, a hole in the grid: each with file and place.
pub fn read(path: &Path) -> Result<Given, Failure> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| refuse(path, format!("the file cannot be read: {error}"), None))?;
    parse(path, &text)
}

fn parse(path: &Path, text: &str) -> Result<Given, Failure> {
    #[derive(Deserialize)]
    struct Head {
        schema: Option<String>,
    }
    let broken = |error: serde_json::Error| {
        let place = Some(format!("line {}, column {}", error.line(), error.column()));
        refuse(path, format!("the file is not readable: {error}"), place)
    };
    let head: Head = serde_json::from_str(text).map_err(broken)?;
    if head.schema.as_deref() != Some(SCHEMA) {
        let found = head.schema.unwrap_or_else(|| "none".to_owned());
        return Err(refuse(
            path,
            format!("its schema is {found} instead of {SCHEMA}"),
            None,
        ));
    }
    let document: Document = serde_json::from_str(text).map_err(broken)?;
    check(path, document)
}

fn check(path: &Path, document: Document) -> Result<Given, Failure> {
    let modes = document.modes.len();
    if document.frames.len() != modes {
        let what = format!("it has {} frames for {modes} modes", document.frames.len());
        return Err(refuse(path, what, Some("frames".to_owned())));
    }
    let twice = (1..modes).find(|&i| document.modes[..i].contains(&document.modes[i]));
    if let Some(twice) = twice {
        let what = format!("two modes are named `{}`", document.modes[twice]);
        return Err(refuse(path, what, Some("modes".to_owned())));
    }
    if !(document.mach.is_finite() && document.mach >= 0.0) {
        let what = format!("its Mach number is {}", document.mach);
        return Err(refuse(path, what, Some("mach".to_owned())));
    }
    let mut points = Vec::with_capacity(document.points.len());
    for (number, sample) in document.points.iter().enumerate() {
        points.push(point(path, number, sample, modes)?);
    }
    let table = GafTable::new(
        document.semichord,
        document.mach,
        document.modes,
        points,
        document.steady,
    )
    .map_err(|error| refuse(path, error.to_string(), Some(place_of(&error))))?;
    Ok(Given {
        table,
        frames: document.frames,
        alpha_deg: document.alpha_deg,
        beta_deg: document.beta_deg,
    })
}

fn point(
    path: &Path,
    number: usize,
    sample: &Sample,
    modes: usize,
) -> Result<GafPoint, Failure> {
    let wrong = sample.q.iter().find(|row| row.len() != modes);
    if sample.q.len() != modes || wrong.is_some() {
        let columns = wrong.map_or(modes, Vec::len);
        let what = format!(
            "q is {} × {columns} at g = {}, k = {}, there are {modes} modes",
            sample.q.len(),
            sample.g,
            sample.k
        );
        return Err(refuse(path, what, Some(format!("points[{number}]"))));
    }
    let entry = |i: usize, j: usize| c64::new(sample.q[i][j][0], sample.q[i][j][1]);
    let q = Mat::from_fn(modes, modes, entry);
    Ok(GafPoint {
        g: sample.g,
        k: sample.k,
        q,
    })
}

fn place_of(error: &GafError) -> String {
    match error {
        GafError::Semichord(_) => "semichord".to_owned(),
        GafError::NoModes => "modes".to_owned(),
        GafError::Steady { .. } => "steady".to_owned(),
        GafError::Place { index, .. } => format!("points[{}]", index - 1),
        _ => "points".to_owned(),
    }
}

fn refuse(path: &Path, what: String, place: Option<String>) -> Failure {
    let file = path.display();
    Failure::input(
        what,
        place.map_or_else(|| file.to_string(), |place| format!("{file}: {place}")),
        "a wrong or incomplete table of forces gives wrong roots without any sign of it",
        "correct the file; its layout is in crates/driver/README.md",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document() -> Document {
        let sample = |k: f64| Sample {
            g: 0.0,
            k,
            q: vec![vec![[k, 2.0 * k]]],
        };
        Document {
            schema: SCHEMA.to_owned(),
            mach: 0.0,
            semichord: 0.5,
            alpha_deg: 0.0,
            beta_deg: 0.0,
            modes: vec!["plunge".to_owned()],
            frames: vec![Frame::Inertial],
            steady: vec![None],
            points: [0.0, 0.1, 0.2].map(sample).to_vec(),
        }
    }

    fn refusal(change: impl FnOnce(&mut Document)) -> Failure {
        let mut changed = document();
        change(&mut changed);
        check(Path::new("q.json"), changed).expect_err("it is refused")
    }

    #[test]
    fn a_file_survives_writing_and_reading() {
        let text = crate::json::text(&document()).unwrap();
        let read: Document = serde_json::from_str(&text).unwrap();
        assert_eq!(read, document());
        let given = parse(Path::new("q.json"), &text).unwrap();
        assert_eq!(given.table.k(), [0.0, 0.1, 0.2]);
    }

    #[test]
    fn shapes_doubles_holes_and_names_are_refused_with_their_place() {
        let failure = refusal(|d| d.points[1].q[0].push([0.0; 2]));
        assert!(failure.place.contains("points[1]"), "{failure}");
        let failure = refusal(|d| d.points[1].k = 0.2);
        assert!(
            failure.what.contains("twice with different values"),
            "{failure}"
        );
        let failure = refusal(|d| {
            d.points.push(Sample {
                g: 0.1,
                ..d.points[0].clone()
            });
        });
        assert!(failure.what.contains("hole"), "{failure}");
        let failure = refusal(|d| d.frames.clear());
        assert!(failure.what.contains("0 frames for 1 modes"), "{failure}");
        let failure = refusal(|d| d.points[2].g = f64::INFINITY);
        assert!(failure.place.contains("points[2]"), "{failure}");
    }

    #[test]
    fn nan_and_missing_fields_are_refused_with_line_and_column() {
        let text = crate::json::text(&document()).unwrap();
        let nan = text.replacen("0.1", "NaN", 1);
        assert!(
            parse(Path::new("q.json"), &nan)
                .unwrap_err()
                .place
                .contains("line")
        );
        let no_frames = text.replace("\"frames\"", "\"farmes\"");
        let failure = parse(Path::new("q.json"), &no_frames).unwrap_err();
        assert!(failure.what.contains("missing field `frames`"), "{failure}");
        let other = text.replace(SCHEMA, "fladder.gaf/9");
        assert!(
            parse(Path::new("q.json"), &other)
                .unwrap_err()
                .what
                .contains("gaf/9")
        );
    }
}
