//! Chosen points of a cluster of test triangles in lanes, and what their values give its
//! rows.
//!
//! Of influences that are far from a cluster ([`crate::skeleton`]) its rows need the values
//! at few points only: T D = (T W) D(P_k), T W of the size rows × chosen points. With a
//! plane of symmetry the points' images are taken along; the sum over both halves is
//! harmonic where both are far.
//!
//! Several receivers together have a receiver of their own among their chosen points: for
//! what is far from all of them it stands for them all.

use crate::galerkin::Galerkin;
use crate::image::{Image, mirrored};
use crate::lanes::WIDTH;
use crate::near_field::NEAR;
use crate::panel_block::{PanelBlock, Points};
use crate::skeleton::{REACH, Skeleton};
use faer::Mat;
use fladder_mesh::Vec3;

/// Where a cluster receives what is far.
#[derive(Clone, Debug)]
pub(crate) struct Receiver {
    /// The chosen points and, for half models, their images.
    pub(crate) seen: Vec<ChosenPoints>,
    chosen: Vec<Vec3>,
    radius: f64,
    /// Largest radius of a test triangle.
    largest: f64,
    /// T W: rows of the cluster × [`Self::width`].
    pub(crate) tested: Mat<f64>,
}

/// Eight chosen points at a time, the last one repeated.
#[derive(Clone, Debug)]
pub(crate) struct ChosenPoints {
    pub(crate) points: Vec<Points>,
    pub(crate) centre: Vec3,
    pub(crate) sign: f64,
}

impl Receiver {
    /// Of test triangles whose corners are among the sorted `rows`; none where a cluster
    /// has too few points to gain anything.
    pub(crate) fn new(galerkin: &Galerkin, triangles: &[u32], rows: &[u32]) -> Option<Self> {
        let tests = triangles.iter().map(|&t| &galerkin.tests[t as usize]);
        let points: Vec<Vec3> = tests.clone().flat_map(|test| test.points).collect();
        let skeleton = Skeleton::new(&points, galerkin.tolerance)?;
        let mut tested = Mat::zeros(rows.len(), width(&skeleton));
        for (place, &t) in triangles.iter().enumerate() {
            for (i, v) in galerkin.triangles[t as usize].iter().enumerate() {
                let row = rows.partition_point(|x| x < v);
                for q in 0..3 {
                    let weight = galerkin.test_weight(t as usize, q, i);
                    for k in 0..skeleton.chosen.len() {
                        tested[(row, k)] += weight * skeleton.weights[(3 * place + q, k)];
                    }
                }
            }
        }
        let largest = tests.map(|test| test.radius).fold(0.0, f64::max);
        Some(Self::with(
            &skeleton,
            &points,
            galerkin.image,
            largest,
            tested,
        ))
    }

    /// Of several receivers, each with its rows; `rows` are those of all.
    pub(crate) fn of_all(
        parts: &[(&Self, &[u32])],
        image: Image,
        rows: &[u32],
        tolerance: f64,
    ) -> Option<Self> {
        let points: Vec<Vec3> = parts.iter().flat_map(|(p, _)| &p.chosen).copied().collect();
        let skeleton = Skeleton::new(&points, tolerance)?;
        let mut tested = Mat::zeros(rows.len(), width(&skeleton));
        let mut first = 0;
        for (part, part_rows) in parts {
            let count = part.chosen.len();
            let weights = skeleton.weights.subrows(first, count);
            first += count;
            let values = part.tested.subcols(0, count) * weights;
            let places: Vec<usize> = part_rows
                .iter()
                .map(|v| rows.partition_point(|x| x < v))
                .collect();
            for k in 0..values.ncols() {
                for (r, &place) in places.iter().enumerate() {
                    tested[(place, k)] += values[(r, k)];
                }
            }
        }
        let largest = parts.iter().map(|(p, _)| p.largest).fold(0.0, f64::max);
        Some(Self::with(&skeleton, &points, image, largest, tested))
    }

    fn with(
        skeleton: &Skeleton,
        points: &[Vec3],
        image: Image,
        largest: f64,
        tested: Mat<f64>,
    ) -> Self {
        let chosen: Vec<Vec3> = skeleton
            .chosen
            .iter()
            .map(|&i| points[i as usize])
            .collect();
        let mut seen = vec![ChosenPoints::new(&chosen, skeleton.centre, 1.0)];
        if let Some(sign) = image.sign() {
            let images: Vec<Vec3> = chosen.iter().map(mirrored).collect();
            seen.push(ChosenPoints::new(&images, mirrored(&skeleton.centre), sign));
        }
        Self {
            seen,
            chosen,
            radius: skeleton.radius,
            largest,
            tested,
        }
    }

    /// Places of chosen points, a multiple of [`WIDTH`].
    pub(crate) fn width(&self) -> usize {
        self.tested.ncols()
    }

    /// Whether all panels of a block are far, and none near a test triangle.
    pub(crate) fn is_far_from(&self, block: &PanelBlock) -> bool {
        let near = self.radius + NEAR * (block.largest + self.largest);
        let reach = near.max(REACH * self.radius) + block.radius;
        self.seen
            .iter()
            .all(|seen| (seen.centre - block.centre).norm() > reach)
    }

    /// Whether the distance of the far wake's singularities from a point is large enough.
    pub(crate) fn is_beyond(&self, distance: impl Fn(Vec3) -> f64) -> bool {
        self.seen
            .iter()
            .all(|seen| distance(seen.centre) > REACH * self.radius)
    }

    /// Radius of the cluster.
    pub(crate) fn radius(&self) -> f64 {
        self.radius
    }
}

/// Places of the chosen points.
fn width(skeleton: &Skeleton) -> usize {
    skeleton.chosen.len().next_multiple_of(WIDTH)
}

impl ChosenPoints {
    fn new(points: &[Vec3], centre: Vec3, sign: f64) -> Self {
        let eight = |part: &[Vec3]| {
            std::array::from_fn(|axis| {
                std::array::from_fn(|lane| part[lane.min(part.len() - 1)][axis])
            })
        };
        Self {
            points: points.chunks(WIDTH).map(eight).collect(),
            centre,
            sign,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::galerkin::Galerkin;
    use crate::hierarchical::HierarchicalOperator;
    use crate::image::Image;
    use crate::progress::Silent;
    use crate::regions::{Part, Regions};
    use crate::solve::{Problem, lay_out};
    use crate::wake_influence::WakeInfluence;
    use faer::{Mat, MatRef, c64};
    use fladder_mesh::shapes::{Extent, NacaWing};
    use fladder_mesh::{Symmetry, Topology, trailing_edge};

    fn difference(found: MatRef<'_, f64>, expected: MatRef<'_, f64>) -> f64 {
        (found - expected).norm_max() / expected.norm_max()
    }

    /// Everything that is received at chosen points, against the same at all test points:
    /// matrix, right-hand sides, wake; a whole wing and half of one.
    #[test]
    fn chosen_points_stand_for_all_test_points() {
        let shape = NacaWing {
            span: 12.0,
            n_chord: 24,
            n_half_span: 48,
            sweep_deg: 20.0,
            ..NacaWing::default()
        };
        for (extent, symmetry, image) in [
            (Extent::Full, Symmetry::None, Image::None),
            (Extent::Half, Symmetry::Antisymmetric, Image::Odd),
        ] {
            let mesh = NacaWing { extent, ..shape }.structured().expect("wing");
            let edges = trailing_edge::find_by_shape(
                &mesh,
                &Topology::new(&mesh),
                trailing_edge::Settings::default(),
            );
            let problem = Problem {
                symmetry,
                ..Problem::new(&mesh, &edges, &[], 0.5)
            };
            let (surface, wake) = lay_out(&problem, image).expect("wake");
            let galerkin = Galerkin::new(&surface, image);
            let mut plain = galerkin.clone();
            for cluster in &mut plain.clusters {
                cluster.receiver = None;
            }
            plain.regions = Regions::new(&plain.clusters, image, plain.tolerance);
            let far: Vec<Part> = galerkin
                .blocks
                .iter()
                .flat_map(|b| galerkin.regions.receiving(|r| r.is_far_from(b)))
                .collect();
            let received = |is_region: bool| {
                far.iter()
                    .filter(|p| matches!(p, Part::Region(_)) == is_region)
                    .count()
            };
            // Columns that vary on a triangle and columns that do not.
            let sources = Mat::from_fn(3 * mesh.triangles.len(), 2, |i, j| {
                (((i / if j == 0 { 1 } else { 3 }) * 37 % 19) as f64 - 9.0) / 9.0
            });
            let [with, without] = [&galerkin, &plain]
                .map(|g| g.assemble(sources.as_ref(), &Silent).expect("assembled"));
            let n = galerkin.n_vertices;
            let matrix = difference(
                MatRef::from_row_major_slice(&with.rows, n, n),
                MatRef::from_row_major_slice(&without.rows, n, n),
            );
            let right = difference(
                with.right_hand_sides.as_ref(),
                without.right_hand_sides.as_ref(),
            );
            let hierarchical =
                HierarchicalOperator::assemble(&galerkin, sources.as_ref(), 1e-6, &Silent)
                    .expect("assembled");
            let free = without.free_terms;
            assert_eq!(hierarchical.free_terms, free);
            let alone = difference(
                hierarchical.right_hand_sides.as_ref(),
                without.right_hand_sides.as_ref(),
            );
            let left = Mat::from_fn(n, 5, |i, j| (((i * (j + 3)) % 17) as f64 - 8.0) / 8.0);
            let columns = surface.columns.len();
            let [with, without] = [&galerkin, &plain].map(|galerkin| {
                let influence = WakeInfluence {
                    galerkin,
                    wake: &wake,
                    free_terms: &free,
                    slopes: &without.slopes,
                };
                let blocks = influence.blocks(left.as_ref(), &Silent).expect("blocks");
                let steady = influence.steady(columns, &Silent).expect("steady");
                let at_one = influence
                    .tested(c64::new(-0.1, 0.4), columns, &Silent)
                    .expect("tested");
                let real = Mat::from_fn(n, columns, |i, j| at_one[(i, j)].re);
                (vec![blocks.near, steady, real], blocks.far)
            });
            let worst = |with: &[Mat<f64>], without: &[Mat<f64>]| {
                let pairs = with.iter().zip(without);
                pairs
                    .map(|(a, b)| difference(a.as_ref(), b.as_ref()))
                    .fold(0.0, f64::max)
            };
            let sheet = worst(&with.0, &without.0);
            // Single nodes have cancellation where P is beside the line through a strip's
            // ends; it is the same with and without, and gone in their sum over the path.
            let nodes = worst(&with.1, &without.1);
            println!(
                "{image:?}: {} blocks to regions, {} to clusters; matrix {matrix:.1e}, \
                 right-hand sides {right:.1e} and {alone:.1e}, wake {sheet:.1e}, \
                 single nodes {nodes:.1e}",
                received(true),
                received(false)
            );
            assert!(received(true) > 10);
            // Interpolation to 1e-10 of a charge's potential; influences have its slope.
            assert!(matrix.max(right).max(alone).max(sheet) < 1e-9 && nodes < 1e-6);
        }
    }
}
