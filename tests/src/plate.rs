//! Q of plates against converged lattices: rectangular in the Laplace plane, swept and
//! tapered at g = 0. The limit of no thickness is taken from 4 % and 2 %.

use faer::{Mat, c64};
use fladder_bem::TransferModel;
use fladder_mesh::shapes::NacaWing;
use fladder_mesh::{Frame, SurfaceMode, TriMesh, Vec3};

use crate::case::{Fault, Setup, mode};
use crate::reference;
use crate::row::{Row, mesh_size};
use crate::wings::{Cells, Kind, LOW_FREQUENCY, THICK, THIN, plate_limit};

/// The planforms of the reference files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Planform {
    /// Aspect ratio 8, unit chord.
    Rectangular,
    /// AGARD 445.6: quarter chord swept by 45°, taper 0.66.
    Swept,
}

impl Planform {
    fn wing(self, thickness: f64, cells: Cells) -> NacaWing {
        let wing = NacaWing {
            thickness,
            n_chord: cells.chord,
            n_half_span: cells.half_span,
            nose_clustering: cells.nose,
            ..NacaWing::default()
        };
        match self {
            Self::Rectangular => wing,
            Self::Swept => NacaWing {
                chord: ROOT_CHORD,
                span: 2.0 * SEMISPAN,
                taper: TIP_CHORD / ROOT_CHORD,
                sweep_deg: (TIP_SETBACK / SEMISPAN).atan().to_degrees(),
                ..wing
            },
        }
    }

    /// Plunge, pitch about the root's mid-chord, bending and torsion about the local one.
    fn modes(self, thickness: f64, cells: Cells, mesh: &TriMesh) -> Vec<SurfaceMode> {
        let wing = self.wing(thickness, cells);
        let semispan = 0.5 * wing.span;
        let root = 0.5 * wing.chord;
        let slope = (wing.sweep_deg.to_radians().tan())
            + 0.5 * wing.chord * (wing.taper - 1.0) / semispan;
        let shape = move |x: &Vec3| (x.y / semispan).powi(2);
        let turn = move |x: &Vec3, axis: f64| Vec3::new(x.z, 0.0, axis - x.x);
        vec![
            mode(mesh, "plunge", Frame::Inertial, |_| Vec3::z()),
            mode(mesh, "pitch", Frame::Inertial, move |x| turn(x, root)),
            mode(mesh, "bending", Frame::Inertial, move |x| {
                shape(x) * Vec3::z()
            }),
            mode(mesh, "torsion", Frame::Inertial, move |x| {
                shape(x) * turn(x, root + slope * x.y.abs())
            }),
        ]
    }

    /// Semichord of p, half the root chord.
    fn semichord(self) -> f64 {
        0.5 * self
            .wing(
                THICK,
                Cells {
                    chord: 3,
                    half_span: 1,
                    nose: 0.0,
                },
            )
            .chord
    }
}

/// Dimensions in the head of `dlm_gaf_agard_planform.csv`, m.
const ROOT_CHORD: f64 = 0.5587;
const TIP_CHORD: f64 = 0.3683;
const SEMISPAN: f64 = 0.762;
/// Leading edge of the tip behind that of the root, m.
const TIP_SETBACK: f64 = 0.8096;

/// Transfer models of both thicknesses.
#[derive(Clone, Debug)]
pub struct Plate {
    thick: TransferModel,
    thin: TransferModel,
    mesh: String,
}

impl Plate {
    /// Computes both.
    ///
    /// # Errors
    /// Shape or solver.
    pub fn new(planform: Planform, kind: Kind, cells: Cells) -> Result<Self, Fault> {
        let transfer = |thickness: f64| -> Result<(TransferModel, String), Fault> {
            let mesh = kind.mesh(&planform.wing(thickness, cells))?;
            let modes = planform.modes(thickness, cells, &mesh);
            let setup = Setup {
                semichord: planform.semichord(),
                ..Setup::new(&mesh, &modes)
            };
            Ok((setup.solve()?.transfer, mesh_size(&mesh)))
        };
        let ((thick, _), (thin, mesh)) = (transfer(THICK)?, transfer(THIN)?);
        Ok(Self { thick, thin, mesh })
    }

    /// Q in the limit of no thickness.
    ///
    /// # Errors
    /// A point the transfer model refuses.
    pub fn q(&self, p: c64) -> Result<Mat<c64>, Fault> {
        let (thick, thin) = (self.thick.q(p)?, self.thin.q(p)?);
        Ok(Mat::from_fn(thick.nrows(), thick.ncols(), |i, j| {
            let limit =
                |part: fn(c64) -> f64| plate_limit(part(thick[(i, j)]), part(thin[(i, j)]));
            c64::new(limit(|z| z.re), limit(|z| z.im))
        }))
    }

    /// Size of the mesh, for tables.
    pub fn mesh(&self) -> &str {
        &self.mesh
    }

    /// The transfer model of the thicker wing.
    pub fn thick(&self) -> &TransferModel {
        &self.thick
    }

    /// Largest error by max |Q| at points of a reference file, in classes of k.
    ///
    /// # Errors
    /// Reference file.
    pub fn compare(
        &self,
        file: &str,
        case: &str,
        goal: impl Fn(f64) -> f64,
    ) -> Result<Vec<Row>, Fault> {
        let mut rows: Vec<Row> = Vec::new();
        for (p, exact) in samples(file)? {
            let error = (self.q(p)? - &exact).norm_max() / exact.norm_max();
            let (g, k) = (p.re, p.im);
            let place = format!("worst at g = {g:+.2}, k = {k:.2}");
            let class = if k <= LOW_FREQUENCY {
                format!("k ≤ {LOW_FREQUENCY}")
            } else {
                format!("k > {LOW_FREQUENCY}")
            };
            let case = format!("{case}, {class}");
            match rows.iter_mut().find(|row| row.case == case) {
                Some(row) if row.error >= error => {}
                Some(row) => (row.error, row.figure) = (error, figure(&place)),
                None => rows.push(Row {
                    case,
                    mesh: self.mesh.clone(),
                    figure: figure(&place),
                    error,
                    goal: goal(k),
                }),
            }
        }
        Ok(rows)
    }
}

fn figure(place: &str) -> String {
    format!("largest error of Q by max \\|Q\\|, {place}")
}

/// Reference matrices at M = 0 by point.
fn samples(file: &str) -> Result<Vec<(c64, Mat<c64>)>, Fault> {
    let mut points: Vec<(c64, Mat<c64>)> = Vec::new();
    for line in reference::lines(file)? {
        if line.has("Mach") && line.number("Mach")? != 0.0 {
            continue;
        }
        let g = if line.has("g") {
            line.number("g")?
        } else {
            0.0
        };
        let [k, i, j] = line.numbers(["k", "i", "j"])?;
        let [re, im] = line.numbers(["ReQ", "ImQ"])?;
        let p = c64::new(g, k);
        let at = points.iter().position(|(q, _)| *q == p).unwrap_or_else(|| {
            points.push((p, Mat::zeros(4, 4)));
            points.len() - 1
        });
        points[at].1[(i as usize - 1, j as usize - 1)] = c64::new(re, im);
    }
    Ok(points)
}
