//! The structure: finite-element modes, mass properties, and the matrices of
//! the eigenproblem.

use super::structure_edits;
use crate::case::{self, CaseFile, DampingModel, OneOrMany};
use crate::failure::Failure;
use faer::Mat;
use fladder_mesh::{Symmetry, Vec3};
use fladder_modal as modal;
use fladder_stability::{self as stability, System, SystemError};

/// What is known of the structure before any force.
#[derive(Clone, Debug, Default)]
pub(crate) struct StructureData {
    /// The finite-element result, if there is one.
    pub(crate) model: Option<modal::StructuralModel>,
    /// Mass properties of the rigid modes, if there are such.
    pub(crate) body: Option<modal::RigidBody>,
    /// Circular frequencies of the elastic modes, rad/s.
    pub(crate) frequencies: Vec<f64>,
    /// The kind of motion, where the surface is a half.
    pub(crate) symmetry: Symmetry,
}

impl StructureData {
    /// Reads what the case names.
    ///
    /// # Errors
    /// Missing or unreadable files, impossible or missing mass properties.
    pub(crate) fn read(file: &CaseFile) -> Result<Self, Failure> {
        let Some(given) = &file.case.structure else {
            return Ok(Self::default());
        };
        let Some(path) = &given.file else {
            let body = given
                .rigid_body
                .as_ref()
                .map(|body| stated_body(file, body))
                .transpose()?;
            return Ok(Self {
                body,
                symmetry: symmetry(file),
                ..Self::default()
            });
        };
        let settings = settings(file, given, path)?;
        let place = || format!("{}: {}", file.places.of("structure.file"), path.display());
        let model = modal::load(&settings).map_err(|error| not_loaded(&error, place()))?;
        let body = match (&given.rigid_body, model.rigid_body) {
            (Some(_), Some(body)) => Some(body),
            (Some(_), None) => {
                return Err(Failure::input(
                    "[structure.rigid_body] lacks mass, cg or inertia, and the result file has none",
                    file.places.of("structure.rigid_body"),
                    "six rigid modes need all of them",
                    "add mass (kg), cg (m) and inertia = { xx, yy, zz, xz } (kg m²)",
                ));
            }
            (None, _) => None,
        };
        let frequencies = model.elastic.iter().map(|mode| mode.omega).collect();
        Ok(Self {
            model: Some(model),
            body,
            frequencies,
            symmetry: symmetry(file),
        })
    }

    /// Names of rigid and elastic modes, in order.
    pub(crate) fn mode_names(&self) -> Vec<String> {
        let rigid = self.body.iter().flat_map(|_| self.rigid_names());
        let elastic = self.model.iter().flat_map(|model| &model.elastic);
        rigid
            .map(str::to_owned)
            .chain(elastic.map(|mode| mode.name.clone()))
            .collect()
    }

    /// Names of the rigid modes of this kind of motion: six, or three of a
    /// half model.
    fn rigid_names(&self) -> impl Iterator<Item = &'static str> {
        let symmetry = self.symmetry;
        stability::RIGID_NAMES
            .into_iter()
            .zip(modal::RIGID_KINDS)
            .filter(move |(_, kind)| symmetry.carries(*kind))
            .map(|(name, _)| name)
    }

    /// Takes the kind of motion that forces from a file have by the rigid modes
    /// among them, where the case has no mesh that says it.
    pub(crate) fn with_rigid_modes_of(mut self, modes: &[String]) -> Self {
        let there: Vec<&str> = modes
            .iter()
            .map(String::as_str)
            .filter(|mode| stability::RIGID_NAMES.contains(mode))
            .collect();
        for symmetry in [Symmetry::Symmetric, Symmetry::Antisymmetric] {
            let candidate = Self {
                symmetry,
                ..Self::default()
            };
            if there == candidate.rigid_names().collect::<Vec<_>>() {
                self.symmetry = symmetry;
            }
        }
        self
    }
}

/// The kind of motion of the case's mesh.
fn symmetry(file: &CaseFile) -> Symmetry {
    let mesh = file.case.mesh.as_ref();
    mesh.map(|mesh| mesh.symmetry).unwrap_or_default()
}

fn not_loaded(error: &modal::StructureError, place: String) -> Failure {
    use modal::{HalfError, StructureError};
    let (why, remedy) = match error {
        StructureError::Half(HalfError::OtherKind { .. }) => (
            "the mirror image of the half surface would move in another way than these modes say",
            "choose others with structure.modes, leave these out with structure.other_symmetry = \
             \"leave-out\", or mesh the whole aircraft",
        ),
        StructureError::Half(HalfError::Side { .. }) => (
            "the half surface on y ≥ 0 would have no structure to move it",
            "set structure.half = false for a whole structure; mirror one that lies on y < 0, or turn \
             it by structure.axes",
        ),
        StructureError::Half(_) => (
            "a half model carries modes of one kind only",
            "give a structure that is symmetric about y = 0 in mesh axes (structure.axes, \
             structure.origin), a half structure, or mesh the whole aircraft",
        ),
        StructureError::Edit(_) => (
            "the modes would not be those of the changed structure",
            "correct [[structure.added_mass]], [[structure.hinge]] or [[structure.override]]",
        ),
        _ => (
            "modes that are wrong or incomplete give wrong roots without any sign of it",
            "correct the file or the keys of [structure]; `fladder modes FILE` shows what a file \
             holds",
        ),
    };
    Failure::input(error.to_string(), place, why, remedy)
}

fn settings(
    file: &CaseFile,
    given: &case::Structure,
    path: &std::path::Path,
) -> Result<modal::StructureSettings, Failure> {
    let geometry = given.geometry.as_deref();
    let body = given.rigid_body.as_ref();
    Ok(modal::StructureSettings {
        file: file.existing("structure.file", path)?,
        geometry: geometry
            .map(|path| file.existing("structure.geometry", path))
            .transpose()?,
        format: given
            .format
            .as_deref()
            .map(|name| format_named(file, name))
            .transpose()?,
        units: match given.units {
            case::Units::MetreKilogram => modal::Units::MetreKilogram,
            case::Units::MillimetreTonne => modal::Units::MillimetreTonne,
            case::Units::InchPound => modal::Units::InchPoundForce,
            case::Units::FootSlug => modal::Units::FootSlug,
        },
        axes: axes(file, given)?,
        origin: Vec3::from(given.origin),
        half: given.half,
        symmetry: symmetry(file),
        leave_out_other: given.other_symmetry == case::OtherSymmetry::LeaveOut,
        modes: given.modes,
        rigid_body: modal::RigidBodySettings {
            mass: body.and_then(|body| body.mass),
            cg: body.and_then(|body| body.cg).map(Vec3::from),
            inertia: body.and_then(|body| body.inertia.as_ref()).map(inertia),
        },
        edits: structure_edits::edits(given),
    })
}

fn format_named(file: &CaseFile, name: &str) -> Result<modal::Format, Failure> {
    modal::Format::from_name(name).ok_or_else(|| {
        Failure::input(
            format!("the format `{name}` is not known"),
            file.places.of("structure.format"),
            "the file cannot be read",
            format!(
                "leave the key out to have the format told from the content; known are {}",
                modal::Format::names().collect::<Vec<_>>().join(", ")
            ),
        )
    })
}

fn axes(file: &CaseFile, given: &case::Structure) -> Result<modal::Axes, Failure> {
    let Some([x, y, z]) = &given.axes else {
        return Ok(modal::Axes::default());
    };
    modal::Axes::from_names([x, y, z]).map_err(|error| {
        Failure::input(
            error.to_string(),
            file.places.of("structure.axes"),
            "the modes would point in another direction",
            "write for example axes = [\"-x\", \"y\", \"-z\"]",
        )
    })
}

fn inertia(given: &case::Inertia) -> modal::Inertia {
    modal::Inertia {
        xx: given.xx,
        yy: given.yy,
        zz: given.zz,
        xz: given.xz,
    }
}

/// Mass properties given in full, which the case has been checked for.
fn stated_body(file: &CaseFile, given: &case::RigidBody) -> Result<modal::RigidBody, Failure> {
    match (given.mass, given.cg, &given.inertia) {
        (Some(mass), Some(cg), Some(moments)) => Ok(modal::RigidBody {
            mass,
            cg: Vec3::from(cg),
            inertia: inertia(moments),
        }),
        _ => Err(Failure::input(
            "[structure.rigid_body] lacks mass, cg or inertia",
            file.places.of("structure.rigid_body"),
            "six rigid modes need all of them",
            "add mass (kg), cg (m) and inertia = { xx, yy, zz, xz } (kg m²)",
        )),
    }
}

/// The same mass properties for the eigenproblem.
pub(crate) fn stability_body(body: &modal::RigidBody) -> stability::RigidBody {
    stability::RigidBody {
        mass: body.mass,
        ixx: body.inertia.xx,
        iyy: body.inertia.yy,
        izz: body.inertia.zz,
        ixz: body.inertia.xz,
    }
}

/// The eigenproblem's structure for the named modes, without flight terms.
///
/// # Errors
/// Matrices or damping of another size than the modes, masses that do not
/// agree with the rigid body.
pub(crate) fn system(
    file: &CaseFile,
    structure: &StructureData,
    names: &[String],
) -> Result<System, Failure> {
    let Some(given) = &file.case.structure else {
        return Err(Failure::input(
            "the case has no [structure]",
            file.places.of("structure"),
            "roots need mass and stiffness besides the aerodynamic forces",
            "add [structure] with file, rigid_body or matrices; `fladder gaf` needs none",
        ));
    };
    let refused = |key: &str| {
        let place = file.places.of(key);
        move |error: SystemError| {
            Failure::input(
                error.to_string(),
                place,
                "mass, stiffness and forces must be of the same modes in the same order",
                format!("the modes are, in order: {}", names.join(", ")),
            )
        }
    };
    if let Some(matrices) = &given.matrices {
        let key = "structure.matrices";
        let zero = vec![vec![0.0; matrices.mass.len()]; matrices.mass.len()];
        let system = System::from_matrices(
            names.to_vec(),
            matrix(&matrices.mass),
            matrix(matrices.damping.as_ref().unwrap_or(&zero)),
            matrix(&matrices.stiffness),
        )
        .map_err(refused(key))?;
        return match &structure.body {
            Some(body) => system
                .with_rigid_body_checked(stability_body(body))
                .map_err(refused(key)),
            None => Ok(system),
        };
    }
    let rigid = names.len() - structure.frequencies.len();
    let mut frequencies = vec![0.0; rigid];
    frequencies.extend(&structure.frequencies);
    let damping = damping(file, given, rigid, structure.frequencies.len())?;
    let system = System::from_frequencies(names.to_vec(), &frequencies, damping)
        .map_err(refused("structure"))?;
    Ok(match &structure.body {
        Some(body) => system.with_rigid_body(stability_body(body)),
        None => system,
    })
}

fn matrix(rows: &[Vec<f64>]) -> Mat<f64> {
    Mat::from_fn(rows.len(), rows.first().map_or(0, Vec::len), |i, j| {
        rows[i][j]
    })
}

/// One coefficient a mode, zero for the rigid ones.
fn damping(
    file: &CaseFile,
    given: &case::Structure,
    rigid: usize,
    elastic: usize,
) -> Result<stability::DampingModel, Failure> {
    let mut values = vec![0.0; rigid];
    match &given.damping {
        None => values.extend(vec![0.0; elastic]),
        Some(OneOrMany::One(value)) => values.extend(vec![*value; elastic]),
        Some(OneOrMany::Many(list)) if list.len() == elastic => values.extend(list),
        Some(OneOrMany::Many(list)) => {
            return Err(Failure::input(
                format!(
                    "`structure.damping` has {} values for {elastic} elastic modes",
                    list.len()
                ),
                file.places.of("structure.damping"),
                "each elastic mode needs its own coefficient",
                "give one number for all modes, or one for each",
            ));
        }
    }
    for over in &given.overrides {
        let Some(coefficient) = over.damping else {
            continue;
        };
        let first = given.modes.map_or(1, |[first, _]| first);
        let place = over
            .mode
            .checked_sub(first)
            .filter(|place| *place < elastic);
        let Some(place) = place else {
            return Err(Failure::input(
                format!(
                    "damping is given for elastic mode {}, which is not used",
                    over.mode
                ),
                file.places.of("structure.override"),
                "it would have no effect",
                format!(
                    "the elastic modes in use are {first} to {}",
                    first + elastic - 1
                ),
            ));
        };
        values[rigid + place] = coefficient;
    }
    Ok(match given.damping_model {
        DampingModel::Viscous => stability::DampingModel::Viscous(values),
        DampingModel::Hysteretic => stability::DampingModel::Hysteretic(values),
    })
}
