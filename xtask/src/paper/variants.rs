//! What moves the Dutch roll and the longitudinal motion: other mass distributions and
//! other winglets, on the smallest mesh.

use std::path::{Path, PathBuf};

use fladder::study::Study;
use fladder_modal::RigidBody;
use fladder_stability::{FlightMode, Method};

use super::PaperError;
use super::output;
use super::published::Published;
use super::words::{Table, amplitude, number};
use super::work::{LATERAL, LONGITUDINAL, dutch_roll, longitudinal, mesh_file, open};
use crate::scaneagle::{Mesh, ScanEagle, TABLE};

/// Size of the mesh.
const SIZE: &str = "3k";
/// Distance by which the centre of mass is moved, m.
const SHIFT: f64 = 0.04;
/// By which the product of inertia is changed, kg m².
const PRODUCT: f64 = 0.15;
/// Factors of the winglets' length.
const WINGLETS: [f64; 2] = [0.5, 1.4];

/// A changed aircraft.
struct Variant {
    name: String,
    mesh: PathBuf,
    set: Vec<String>,
}

/// The table; a variant that cannot be computed says why.
pub(super) fn table(
    case: &Path,
    folder: &Path,
    cache: &Path,
    published: &Published,
) -> Result<Table, PaperError> {
    let periods = [
        published.get("dutch_period_p2")?.value,
        published.get("longitudinal_period")?.value,
    ];
    let mesh = mesh_file(SIZE, folder)?;
    let base = open(case, &mesh, cache, &[])?;
    let mut table = Table::new(&[
        "aircraft",
        "Dutch roll at 30 m/s, period",
        "amplitude",
        "σ",
        "longitudinal motion at 45 m/s without speed terms, period",
    ]);
    let mut all = vec![Variant {
        name: format!("as it is, {} triangles", base.mesh().triangles.len()),
        mesh: mesh.clone(),
        set: Vec::new(),
    }];
    all.extend(base.body().into_iter().flat_map(|body| masses(body, &mesh)));
    for factor in WINGLETS {
        all.push(Variant {
            name: format!("winglets {factor} times as long"),
            mesh: other_winglets(factor, folder)?,
            // The structure keeps its own winglets.
            set: vec!["structure.transfer_limit=1000.0".to_owned()],
        });
    }
    for variant in all {
        eprintln!("Dutch roll, {}", variant.name);
        let cells = match study(case, cache, &variant) {
            Ok(study) => cells(&study, periods)?,
            Err(error) => {
                eprintln!("{error}");
                ["not computed", "–", "–", "–"].map(str::to_owned)
            }
        };
        table.push([variant.name].into_iter().chain(cells));
    }
    Ok(table)
}

fn study(case: &Path, cache: &Path, variant: &Variant) -> Result<Study, PaperError> {
    open(case, &variant.mesh, cache, &variant.set)
}

fn cells(study: &Study, periods: [f64; 2]) -> Result<[String; 4], PaperError> {
    let set = [
        format!("stability.speed=[{LATERAL:?}, {LONGITUDINAL:?}]"),
        "flight.speed_derivative=false".to_owned(),
    ];
    let result = study.sweep(&set, Method::P2)?.result;
    let motions = result
        .methods
        .polished
        .map_or_else(Vec::new, |refined| refined.flight_modes);
    let none = || "–".to_owned();
    let period =
        |motion: &FlightMode| format!("{} s", number(motion.period.unwrap_or(f64::NAN)));
    let lateral = dutch_roll(&motions, periods[0]).map_or_else(
        || ["none".to_owned(), none(), none()],
        |motion| {
            let sigma = format!("{} 1/s", number(motion.sigma));
            [period(motion), amplitude(motion.sigma), sigma]
        },
    );
    let along =
        longitudinal(&motions, periods[1]).map_or_else(|| "aperiodic".to_owned(), period);
    let [first, second, third] = lateral;
    Ok([first, second, third, along])
}

fn masses(body: &RigidBody, mesh: &Path) -> Vec<Variant> {
    let variant = |name: String, set: String| Variant {
        name,
        mesh: mesh.to_owned(),
        set: vec![set],
    };
    let centre = |x: f64| {
        let set = format!(
            "structure.rigid_body.cg=[{:?}, {:?}, {:?}]",
            body.cg.x + x,
            0.0,
            body.cg.z
        );
        let side = if x > 0.0 { "aft" } else { "forward" };
        let name = format!("centre of mass {:.0} mm {side}", 1e3 * x.abs());
        variant(name, set)
    };
    let inertia = |name: String, xx: f64, xz: f64| {
        let own = &body.inertia;
        let set = format!(
            "structure.rigid_body.inertia={{ xx = {:?}, yy = {:?}, zz = {:?}, xz = {:?} }}",
            xx * own.xx,
            own.yy,
            own.zz,
            own.xz + xz
        );
        variant(name, set)
    };
    let product = |xz: f64| {
        let name = format!(
            "∫xz dm {} by {} kg m²",
            if xz > 0.0 { "more" } else { "less" },
            xz.abs()
        );
        inertia(name, 1.0, xz)
    };
    vec![
        centre(SHIFT),
        centre(-SHIFT),
        inertia("roll inertia doubled".to_owned(), 2.0, 0.0),
        product(PRODUCT),
        product(-PRODUCT),
    ]
}

/// The mesh with other winglets.
fn other_winglets(factor: f64, folder: &Path) -> Result<PathBuf, PaperError> {
    let path = PathBuf::from(TABLE);
    let text = std::fs::read_to_string(&path).map_err(|source| PaperError::File {
        path: path.clone(),
        source,
    })?;
    let mut dimensions: toml::Table = toml::from_str(&text)?;
    let winglet = dimensions
        .get_mut("winglet")
        .and_then(toml::Value::as_table_mut);
    let length = winglet.and_then(|winglet| winglet.get_mut("length"));
    let length = length.ok_or(PaperError::Unknown("winglet.length"))?;
    let own = length
        .as_float()
        .ok_or(PaperError::Unknown("winglet.length"))?;
    *length = toml::Value::Float(factor * own);
    let params = folder.join(format!("winglets_{factor}.toml"));
    output::write(&params, dimensions.to_string())?;
    let out = folder.join(format!("winglets_{factor}.msh"));
    let mesh = Mesh {
        size: SIZE.to_owned(),
        params,
        out: Some(out.clone()),
    };
    ScanEagle::Mesh(mesh).run()?;
    Ok(out)
}
