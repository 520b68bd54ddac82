//! What a mesh can resolve: how fast a motion, how thin a part.
//!
//! The wave e^{−sξ} that motion leaves on surface and wake changes by |p| Δx / b rad over
//! the streamwise length Δx. The potential is linear on a triangle and along a wake row, so
//! that much more than a radian on either is not resolved, whatever the equations give.
//!
//! Where upper and lower side are much closer than their triangles are large, the two
//! sides' equations become the same and their difference, the lift, is lost, unless the
//! triangles of the sides match.
//!
//! A mode that moves the two sides against each other (breathing of thin skins) changes
//! the steady flow by the strain of the section, which the surface-attached form leaves
//! out.

use crate::error::BemError;
use crate::solve::{Plan, Problem};
use fladder_mesh::{TriMesh, Vec3};
use parry3d_f64::math::Vector;
use parry3d_f64::query::{Ray, RayCast};
use rayon::prelude::*;

/// Phase on a triangle, rad, above which is warned and above which is refused.
const PHASE_WARNED: f64 = 1.0;
const PHASE_REFUSED: f64 = std::f64::consts::PI;

/// Phase on a wake row, rad, above which is warned: the error of Q is then 1 %.
const ROW_PHASE_WARNED: f64 = 0.5;

/// Ratio of local thickness to the root of a triangle's area below which a part with sides
/// that do not match is thin, and below which it is too thin.
///
/// Measured on an irregular wing of 380 triangles: at a quarter of the surface below 0.02
/// (1 % thick) the lift slope is 3 % off, at half below 0.01 (0.3 % thick) 60 %, thinner yet
/// it has no meaning. Where the sides' triangles match, 0.01 % is as good as 3 %.
const THIN: f64 = 0.02;
const TOO_THIN: f64 = 0.01;

/// Parts of the surface from which thin triangles are warned of and refused: near a sharp
/// trailing edge every section is thin.
const THIN_SHARE: f64 = 0.25;
const TOO_THIN_SHARE: f64 = 0.5;

/// Distance of the centroid across from where the inward ray strikes, in sizes of the
/// triangle, from which the sides do not match.
const UNMATCHED: f64 = 0.05;

/// Thickness change of a mode, relative to its displacement, above which is warned.
const BREATHING: f64 = 0.3;

/// Looks at a mesh for motions up to |p| = `largest`; gives warnings with numbers. Without
/// a plan only the phase on triangles is looked at, which takes no time.
///
/// # Errors
/// [`BemError::PhasePerPanel`] where triangles are longer than half a wave,
/// [`BemError::TooThin`] where half of the surface is thinner than its triangles resolve.
pub fn guards(
    problem: &Problem<'_>,
    plan: Option<&Plan>,
    largest: f64,
) -> Result<Vec<String>, BemError> {
    let mut warnings = Vec::new();
    let wave_number = largest / problem.semichord;
    let (triangle, length) = longest_triangle(problem.mesh, problem.flow.stream());
    let phase = wave_number * length;
    if phase > PHASE_REFUSED {
        return Err(BemError::PhasePerPanel {
            largest,
            triangle,
            length,
            phase,
        });
    }
    if phase > PHASE_WARNED {
        warnings.push(format!(
            "at |p| = {largest} triangle {triangle}, {length:.4} m long in the stream, sees {phase:.2} rad of the wave, more than {PHASE_WARNED} rad: forces at high frequency are not resolved; refine the mesh or lower the largest k"
        ));
    }
    let Some(plan) = plan else {
        return Ok(warnings);
    };
    let row_phase = plan.wake.phase_per_row(largest, problem.semichord);
    if row_phase > ROW_PHASE_WARNED {
        warnings.push(format!(
            "at |p| = {largest} the longest wake row sees {row_phase:.2} rad of the wave, more than {ROW_PHASE_WARNED} rad; rows follow reference.semichord: give the semichord of the lifting surface or lower the largest k"
        ));
    }
    warnings.extend(crate::nose::unresolved(problem));
    if let Some(section) = Section::new(problem.mesh) {
        warnings.extend(section.thin_parts()?);
        warnings.extend(section.thickness_modes(problem));
    }
    Ok(warnings)
}

/// The triangle with the largest extent along the stream.
fn longest_triangle(mesh: &TriMesh, stream: Vec3) -> (usize, f64) {
    (0..mesh.triangles.len())
        .map(|t| {
            let along = mesh.corners(t).map(|v| v.dot(&stream));
            let low = along.iter().copied().fold(f64::INFINITY, f64::min);
            let high = along.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            (t, high - low)
        })
        .fold(
            (0, 0.0),
            |most, here| if here.1 > most.1 { here } else { most },
        )
}

/// The surface and what lies straight across from each triangle.
struct Section<'a> {
    mesh: &'a TriMesh,
    /// Triangle across and distance; none where the inward ray leaves through nothing.
    across: Vec<Option<(usize, f64)>>,
}

impl<'a> Section<'a> {
    fn new(mesh: &'a TriMesh) -> Option<Self> {
        let vertices = mesh
            .vertices
            .iter()
            .map(|v| Vector::new(v.x, v.y, v.z))
            .collect();
        let search = parry3d_f64::shape::TriMesh::new(vertices, mesh.triangles.clone()).ok()?;
        let across = (0..mesh.triangles.len())
            .into_par_iter()
            .map(|t| across(mesh, &search, t))
            .collect();
        Some(Self { mesh, across })
    }

    fn size(&self, t: usize) -> f64 {
        self.mesh.area_vector(t).norm().sqrt()
    }

    /// Whether the triangles of both sides lie straight across from each other.
    fn is_matched(&self, t: usize, (other, distance): (usize, f64)) -> bool {
        let centroid = |t: usize| self.mesh.corners(t).iter().sum::<Vec3>() / 3.0;
        let inward = -self.mesh.area_vector(t).normalize();
        let struck = centroid(t) + distance * inward;
        (struck - centroid(other)).norm() < UNMATCHED * self.size(t)
    }

    /// Triangles with the other side closer than `limit` of their size and not matching,
    /// and their part of the surface.
    fn thin_triangles(&self, limit: f64) -> (Vec<(usize, f64)>, f64) {
        let area = |t: usize| self.mesh.area_vector(t).norm();
        let total: f64 = (0..self.mesh.triangles.len()).map(area).sum();
        let thin: Vec<(usize, f64)> = (0..self.mesh.triangles.len())
            .filter_map(|t| self.across[t].map(|across| (t, across)))
            .filter(|&(t, across)| {
                across.1 < limit * self.size(t) && !self.is_matched(t, across)
            })
            .map(|(t, (_, distance))| (t, distance))
            .collect();
        let share = thin.iter().map(|&(t, _)| area(t)).sum::<f64>() / total;
        (thin, share)
    }

    /// A warning where much of the surface is thinner than its triangles resolve.
    fn thin_parts(&self) -> Result<Option<String>, BemError> {
        let (too_thin, share) = self.thin_triangles(TOO_THIN);
        if share >= TOO_THIN_SHARE {
            let (triangle, distance) = thinnest(&too_thin);
            return Err(BemError::TooThin {
                percent: 100.0 * share,
                ratio: TOO_THIN,
                triangle,
                distance,
            });
        }
        let (thin, share) = self.thin_triangles(THIN);
        if share < THIN_SHARE {
            return Ok(None);
        }
        let (triangle, distance) = thinnest(&thin);
        let place = self.mesh.corners(triangle).iter().sum::<Vec3>() / 3.0;
        Ok(Some(format!(
            "{} triangles, {:.0} % of the surface, have an opposite side that does not match closer than {THIN} of their own size (triangle {triangle} at {:.4}, {:.4}, {:.4} m: {distance:.2e} m): a few per cent of the lift are lost there; refine the part, make it thicker, or mesh both sides alike",
            thin.len(),
            100.0 * share,
            place.x,
            place.y,
            place.z
        )))
    }

    /// A warning for every elastic mode that mostly changes thickness.
    fn thickness_modes(&self, problem: &Problem<'_>) -> Vec<String> {
        problem
            .modes
            .iter()
            .enumerate()
            .filter(|(m, _)| problem.turning.get(*m).copied().unwrap_or(false))
            .filter_map(|(_, mode)| {
                let ratio = self.thickness_change(&mode.displacement);
                (ratio > BREATHING).then(|| {
                    format!(
                        "mode `{}` changes the thickness of the surface by {ratio:.2} of its own displacement (root mean square): forces of breathing are wrong in the surface-attached form; leave it out by structure.modes or set structure.shape_change = \"exact\"",
                        mode.name
                    )
                })
            })
            .collect()
    }

    /// Root mean square of the relative normal displacement of opposite sides over that of
    /// the normal displacement: 0 for sections that keep their form, 2 where they breathe.
    fn thickness_change(&self, displacement: &[Vec3]) -> f64 {
        let mean = |t: usize| {
            let [a, b, c] = self.mesh.triangles[t].map(|v| displacement[v as usize]);
            (a + b + c) / 3.0
        };
        let (mut change, mut whole) = (0.0, 0.0);
        for (t, other) in self.across.iter().enumerate() {
            let Some((other, _)) = *other else { continue };
            let area = self.mesh.area_vector(t);
            let (size, normal) = (area.norm(), area.normalize());
            let (here, there) = (mean(t), mean(other));
            change += size * (here - there).dot(&normal).powi(2);
            whole += size * here.norm_squared();
        }
        if whole > 0.0 {
            (change / whole).sqrt()
        } else {
            0.0
        }
    }
}

/// The thinnest of them.
fn thinnest(thin: &[(usize, f64)]) -> (usize, f64) {
    thin.iter()
        .copied()
        .fold((0, f64::INFINITY), |least, here| {
            if here.1 < least.1 { here } else { least }
        })
}

/// The triangle straight inward from a triangle's centroid and its distance.
fn across(
    mesh: &TriMesh,
    search: &parry3d_f64::shape::TriMesh,
    t: usize,
) -> Option<(usize, f64)> {
    let area = mesh.area_vector(t);
    let inward = -area / area.norm();
    let centroid = mesh.corners(t).iter().sum::<Vec3>() / 3.0;
    // Off the triangle itself by what cannot be another side.
    let off = 1e-9 * area.norm().sqrt();
    let origin = centroid + off * inward;
    let ray = Ray::new(
        Vector::new(origin.x, origin.y, origin.z),
        Vector::new(inward.x, inward.y, inward.z),
    );
    let hit = search.cast_local_ray_and_get_normal(&ray, f64::MAX, false)?;
    Some((hit.subshape as usize, hit.time_of_impact + off))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BemError, plan};
    use fladder_mesh::shapes::NacaWing;
    use fladder_mesh::{Frame, SurfaceMode, Topology, trailing_edge};

    fn wing(thickness: f64) -> TriMesh {
        NacaWing {
            thickness,
            n_chord: 8,
            n_half_span: 4,
            nose_clustering: 1.0,
            ..NacaWing::default()
        }
        .structured()
        .expect("wing")
    }

    fn warnings(
        mesh: &TriMesh,
        modes: &[SurfaceMode],
        largest: f64,
    ) -> Result<Vec<String>, BemError> {
        let edges = trailing_edge::find_by_shape(
            mesh,
            &Topology::new(mesh),
            trailing_edge::Settings::default(),
        );
        let turning = vec![true; modes.len()];
        let problem = Problem {
            turning: &turning,
            ..Problem::new(mesh, &edges, modes, 0.5)
        };
        guards(&problem, Some(&plan(&problem).expect("a wake")), largest)
    }

    /// Cells of c/8, clustered, are at most 0.2 chords long: 0.4 rad at k = 1.
    #[test]
    fn fast_motion_is_warned_of_and_refused() {
        let mesh = wing(0.12);
        assert_eq!(
            warnings(&mesh, &[], 1.0).expect("resolved"),
            Vec::<String>::new()
        );
        let warned = warnings(&mesh, &[], 5.0).expect("half resolved");
        assert!(warned[0].contains("rad of the wave"), "{warned:?}");
        let refused = warnings(&mesh, &[], 40.0);
        assert!(matches!(refused, Err(BemError::PhasePerPanel { .. })));
    }

    /// Sides that match bear any thickness, others as much as their triangles resolve.
    #[test]
    fn a_part_thinner_than_its_mesh_is_warned_of_and_refused() {
        // Noses of so few cells are wedges, which is another warning.
        let thickness_warnings = |mesh: &TriMesh| {
            let mut all = warnings(mesh, &[], 1.0)?;
            all.retain(|warning| !warning.contains("wedge"));
            Ok::<_, BemError>(all)
        };
        for thickness in [0.12, 0.001] {
            let warned = thickness_warnings(&wing(thickness)).expect("resolved");
            assert!(warned.is_empty(), "{thickness}: {warned:?}");
        }
        let irregular = |thickness: f64| {
            let shape = NacaWing {
                thickness,
                n_chord: 8,
                n_half_span: 5,
                ..NacaWing::default()
            };
            thickness_warnings(&shape.unstructured(1).expect("wing"))
        };
        assert_eq!(irregular(0.03).expect("resolved"), Vec::<String>::new());
        assert!(irregular(0.01).expect("half resolved")[0].contains("does not match"));
        assert!(matches!(irregular(0.003), Err(BemError::TooThin { .. })));
    }

    #[test]
    fn breathing_is_told_from_bending() {
        let mesh = wing(0.12);
        let mode = |name: &str, field: fn(&Vec3) -> Vec3| SurfaceMode {
            name: name.into(),
            frame: Frame::Inertial,
            displacement: mesh.vertices.iter().map(field).collect(),
        };
        let modes = [
            mode("bending", |x| {
                Vec3::new(0.0, -x.z * x.y / 8.0, x.y * x.y / 16.0)
            }),
            mode("breathing", |x| Vec3::new(0.0, 0.0, x.z)),
        ];
        let warned = warnings(&mesh, &modes, 1.0).expect("resolved");
        assert_eq!(warned.len(), 1, "{warned:?}");
        assert!(warned[0].contains("`breathing`"));
    }
}
