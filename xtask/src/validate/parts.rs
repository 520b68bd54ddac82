//! What is validated, on which meshes, with which goals.

use clap::ValueEnum;
use fladder_tests::aircraft::{Aircraft, workspace};
use fladder_tests::case::Fault;
use fladder_tests::plate::{Planform, Plate};
use fladder_tests::row::Row;
use fladder_tests::section::LongWing;
use fladder_tests::wings::{Cells, Goals, Kind};
use fladder_tests::{bodies, laplace, section, stream, surface_velocity, wings};

/// A part of the validation that can be run by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Part {
    /// Row sums, added masses
    Bodies,
    /// Ellipsoids in a stream, free ellipsoids
    Stream,
    /// Steady wings
    Wings,
    /// Generalised Theodorsen
    Section,
    /// Rectangular plate in the Laplace plane
    Plate,
    /// Swept and tapered plate
    Swept,
    /// Cauchy and Riemann, symmetry
    Laplace,
    /// The ScanEagle-like surface
    Aircraft,
}

/// Goals of steady wings.
const STEADY: Goals = Goals {
    structured: 0.01,
    unstructured: 0.01,
    kutta: 0.01,
};

/// Cells of the fine wings: the first about as long as the nose radius of a 3 % section.
const WING: Cells = Cells {
    chord: 48,
    half_span: 24,
    nose: 0.4,
};

/// Cells of the fine wings with thickness.
const THICK_WING: Cells = Cells {
    chord: 56,
    half_span: 28,
    nose: 0.3,
};

impl Part {
    /// All, in the order of the document.
    pub(crate) fn all() -> &'static [Self] {
        Self::value_variants()
    }

    /// Mark in the document.
    pub(crate) fn mark(self) -> String {
        self.to_possible_value()
            .map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// Heading and what the figures are.
    pub(crate) fn head(self) -> (&'static str, &'static str) {
        match self {
            Self::Bodies => (
                "Closed bodies",
                "Row sums of the double layer at interior points of the triangles; added \
                 masses and moments (`ellipsoid_added_mass_open.csv`) from Q at p = 0.3i, \
                 0.3 + 2i, −0.2 + i and 0.5.",
            ),
            Self::Stream => (
                "Ellipsoids in a stream",
                "All 6 × 6 entries in both frames at p = 0, 0.5i, 0.3 + i and −0.2 + 0.1i, \
                 against Kirchhoff's equations with the masses of \
                 `ellipsoid_added_mass_open.csv`; roots of free ellipsoids \
                 (`free_ellipsoid_eigenvalues_open.csv`) from mesh, Q and eigenproblem.",
            ),
            Self::Wings => (
                "Steady wings",
                "Lift slopes of plates, extrapolated linearly in thickness from sections of \
                 4 % and 2 % (`steady_rect_lift_slope_open.csv`); wings with thickness \
                 (`wing_ar8_thick_lift_slope.csv`); lift by pressure against lift by the \
                 wake's jump at 4°.",
            ),
            Self::Section => (
                "Oscillating section",
                "Middle of a wing of aspect ratio 100 against Theodorsen's function at complex \
                 p (`theodorsen_complex_open.csv`), plunge and pitch about 0.4 c, moments about \
                 quarter chord by lift × c/4. Judged in the limit of thin sections, from 3 % and \
                 1.5 %. Beside it the 3 % section divided by its steady factor 1 + 0.77 t: at \
                 k = 1 thickness delays the lift by 0.7° and makes it 0.7 % smaller instead of \
                 2.3 % larger, so that this leaves 3 %.",
            ),
            Self::Plate => (
                "Rectangular plate in the Laplace plane",
                "Four modes, aspect ratio 8, all g and k of `laplace_gaf_rect_ar8.csv`, \
                 extrapolated in thickness from 4 % and 2 %.",
            ),
            Self::Swept => (
                "Swept tapered plate",
                "Planform of AGARD 445.6, four modes, M = 0, `dlm_gaf_agard_planform.csv`, \
                 extrapolated in thickness from 4 % and 2 %.",
            ),
            Self::Laplace => (
                "Analyticity",
                "Derivatives of Q along g and along k on arcs |p| = 0.05, 0.2, 0.5, by \
                 differences; Q at conjugate points. The reduced model against the solve of \
                 the whole complex system is a test of `crates/bem` (1e-14).",
            ),
            Self::Aircraft => (
                "ScanEagle-like surface",
                "`meshes/scaneagle_10k.msh` with the modes of `cases/scaneagle` at its \
                 incidence, Q at k = 0.2 and over the grid of the case.",
            ),
        }
    }

    /// Computes the rows.
    pub(crate) fn rows(self) -> Result<Vec<Row>, Fault> {
        let mut rows = Vec::new();
        match self {
            Self::Bodies => {
                rows.extend(bodies::row_sums(16, 1e-12)?);
                for name in ["sphere", "triaxial_2_1_0.5"] {
                    rows.extend(bodies::added_mass(name, &[4, 8, 16], 5e-3)?);
                }
            }
            Self::Stream => {
                rows.extend(stream::munk(&[8, 16], 3, 0.02)?);
                rows.extend(stream::free_roots(16, 0.02)?);
                for name in ["sphere", "spheroid_4to1", "triaxial_2_1_0.5"] {
                    rows.extend(surface_velocity::rows(name, 16, 0.01)?);
                }
            }
            Self::Wings => {
                rows.extend(wings::plates(WING, |_| true, STEADY)?);
                rows.extend(wings::thick(THICK_WING, STEADY)?);
            }
            Self::Section => {
                let wing = LongWing {
                    aspect_ratio: 100.0,
                    n_chord: 40,
                    n_half_span: 12,
                };
                rows.extend(section::theodorsen(&wing, 0.02)?);
            }
            Self::Plate => {
                for kind in Kind::ALL {
                    let plate = Plate::new(Planform::Rectangular, kind, WING)?;
                    let goal = |k: f64| kind.lattice_goal(k);
                    let case = format!("plate, {}", kind.name());
                    let file = "laplace_gaf_rect_ar8.csv";
                    rows.extend(plate.compare(file, &case, goal)?);
                }
            }
            Self::Swept => {
                for kind in Kind::ALL {
                    let plate = Plate::new(Planform::Swept, kind, WING)?;
                    let goal = |k: f64| kind.lattice_goal(k);
                    let case = format!("swept plate, {}", kind.name());
                    let file = "dlm_gaf_agard_planform.csv";
                    rows.extend(plate.compare(file, &case, goal)?);
                }
            }
            Self::Laplace => {
                for (name, planform) in [
                    ("rectangular wing", Planform::Rectangular),
                    ("swept wing", Planform::Swept),
                ] {
                    let cells = Cells {
                        chord: 16,
                        half_span: 12,
                        nose: 0.0,
                    };
                    let plate = Plate::new(planform, Kind::Structured, cells)?;
                    rows.extend(laplace::analytic(name, plate.mesh(), plate.thick())?);
                }
            }
            Self::Aircraft => {
                let mesh = workspace().join("meshes/scaneagle_10k.msh");
                let aircraft = Aircraft::read(&mesh, 20)?;
                let solution = aircraft.solve()?;
                rows.extend(aircraft.symmetry(&solution)?);
                rows.extend(aircraft.junction(&solution, 0.02));
                rows.extend(aircraft.smoothness(&solution)?);
            }
        }
        Ok(rows)
    }
}
