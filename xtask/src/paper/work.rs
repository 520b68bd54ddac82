//! What the figures and tables are made of: one set of forces, four sweeps.

use std::path::{Path, PathBuf};

use fladder::study::Study;
use fladder_stability::{FlightMode, Method, MethodResult, Methods, SweepResult};

use super::PaperError;
use crate::scaneagle::{Mesh, ScanEagle, TABLE};

/// Speeds of the paper's figures, m/s.
const SPEEDS: &str = "stability.speed={ from = 20.0, to = 75.0, count = 56 }";
/// Lines of samples off the axis, for the fit on Laplace data.
pub(super) const LAPLACE: [f64; 7] = [-0.2, -0.1, -0.04, 0.0, 0.04, 0.1, 0.2];
/// Speed of table 1, m/s.
pub(super) const LATERAL: f64 = 30.0;
/// Speed of table 2, m/s.
pub(super) const LONGITUDINAL: f64 = 45.0;
/// Speed at which the paper tells of roll with bending, m/s.
pub(super) const FAST: f64 = 75.0;

/// Forces and sweeps.
pub(super) struct Work {
    pub(super) study: Study,
    /// Refined, p2 and p-k over all speeds.
    pub(super) main: SweepResult,
    /// p2 on samples off the axis.
    pub(super) laplace: SweepResult,
    /// At the speed of table 2, with the speed terms of the case.
    pub(super) with_speed: SweepResult,
    /// Without them, as in the paper.
    pub(super) without_speed: SweepResult,
}

/// The case on a mesh, with the paper's conditions and further overrides.
pub(super) fn open(
    case: &Path,
    mesh: &Path,
    cache: &Path,
    more: &[String],
) -> Result<Study, PaperError> {
    let mesh = std::path::absolute(mesh).map_err(|source| PaperError::File {
        path: mesh.to_owned(),
        source,
    })?;
    let mut set = vec![
        format!("mesh.file={:?}", mesh.display().to_string()),
        SPEEDS.to_owned(),
        "stability.fit=centred".to_owned(),
    ];
    set.extend_from_slice(more);
    Ok(Study::open(case, &set, Some(cache))?)
}

impl Work {
    /// Sweeps.
    pub(super) fn new(study: Study) -> Result<Self, PaperError> {
        eprintln!("p2, p-k and refined roots, 20 to 75 m/s");
        let main = study.sweep(&[], Method::Both)?.result;
        eprintln!("p2 on samples off the axis");
        let laplace = [
            "stability.fit=laplace".to_owned(),
            format!("gaf.g={LAPLACE:?}"),
        ];
        let laplace = study.sweep(&laplace, Method::Unrefined)?.result;
        let at = |terms: bool| {
            let set = [
                format!("stability.speed=[{LONGITUDINAL:?}]"),
                format!("flight.speed_derivative={terms}"),
            ];
            study.sweep(&set, Method::P2)
        };
        eprintln!("table 2");
        let (with_speed, without_speed) = (at(true)?.result, at(false)?.result);
        Ok(Self {
            study,
            main,
            laplace,
            with_speed,
            without_speed,
        })
    }

    /// The refined outcome.
    pub(super) fn refined(&self) -> Option<&MethodResult> {
        self.main.methods.polished.as_ref()
    }

    /// Methods with rigid motions by name: heading, outcome.
    pub(super) fn flying(&self) -> Vec<(&'static str, &MethodResult)> {
        let methods = &self.main.methods;
        let all = [
            ("p2 on axis data", &methods.p2),
            ("p2 on Laplace data", &self.laplace.methods.p2),
            ("p2, refined", &methods.polished),
            ("p-k", &methods.pk),
        ];
        all.into_iter()
            .filter_map(|(name, result)| Some((name, result.as_ref()?)))
            .collect()
    }
}

/// Motions at a speed.
pub(super) fn at(motions: &[FlightMode], speed: f64) -> impl Iterator<Item = &FlightMode> {
    motions
        .iter()
        .filter(move |motion| (motion.speed - speed).abs() < 1e-6 * speed)
}

/// The Dutch roll at the speed of table 1: by its name, the nearest in period where there
/// are several.
pub(super) fn dutch_roll(motions: &[FlightMode], period: f64) -> Option<&FlightMode> {
    nearest(
        at(motions, LATERAL).filter(|motion| motion.motion == "Dutch roll"),
        period,
    )
}

/// The oscillation in the plane of symmetry at the speed of table 2 with the nearest period.
pub(super) fn longitudinal(motions: &[FlightMode], period: f64) -> Option<&FlightMode> {
    let those = at(motions, LONGITUDINAL);
    nearest(those.filter(|motion| is_longitudinal(motion)), period)
}

/// The motion whose period is nearest, by ratio.
pub(super) fn nearest<'a>(
    motions: impl Iterator<Item = &'a FlightMode>,
    period: f64,
) -> Option<&'a FlightMode> {
    let distance = |motion: &FlightMode| {
        let own = motion.period.unwrap_or(f64::INFINITY);
        (own / period).ln().abs()
    };
    motions
        .filter(|motion| motion.period.is_some())
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// Whether a motion is one of the plane of symmetry.
pub(super) fn is_longitudinal(motion: &FlightMode) -> bool {
    ["short period", "phugoid", "coupled, symmetric"].contains(&motion.motion)
}

/// Outcomes of p2 and p-k alone, for a picture with p2 as lines.
pub(super) fn as_in_the_paper(methods: &Methods) -> Methods {
    Methods {
        p2: methods.p2.clone(),
        pk: methods.pk.clone(),
        ..Methods::default()
    }
}

/// File of a mesh given by size or path; `34k` is made where it is not there.
pub(super) fn mesh_file(mesh: &str, folder: &Path) -> Result<PathBuf, PaperError> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let kept = root.join(format!("meshes/scaneagle_{mesh}.msh"));
    let given = PathBuf::from(mesh);
    if given.is_file() {
        return Ok(given);
    }
    if kept.is_file() {
        return Ok(kept);
    }
    let made = folder.join(format!("scaneagle_{mesh}.msh"));
    if made.is_file() {
        return Ok(made);
    }
    let wanted = Mesh {
        size: mesh.to_owned(),
        params: TABLE.into(),
        out: Some(made.clone()),
    };
    ScanEagle::Mesh(wanted).run()?;
    Ok(made)
}
