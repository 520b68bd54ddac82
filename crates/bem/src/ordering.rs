//! Order in space: neighbours in the list are neighbours on the surface.

use fladder_mesh::Vec3;

/// Indices of `points` in an order in which every aligned run of `runs[0]` of them, of
/// `runs[1]` and so on, each a divisor of the one before, is a compact cluster: bisection
/// across the longest side of the box, cut at multiples of the longest run below the length.
pub(crate) fn spatial_order<const N: usize>(points: &[Vec3], runs: [usize; N]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    bisect(points, &mut order, &runs);
    order
}

fn bisect(points: &[Vec3], part: &mut [u32], runs: &[usize]) {
    let Some(&run) = runs.iter().find(|run| part.len() > **run) else {
        return;
    };
    let (mut low, mut high) = (points[part[0] as usize], points[part[0] as usize]);
    for &i in part.iter() {
        low = low.inf(&points[i as usize]);
        high = high.sup(&points[i as usize]);
    }
    let axis = (high - low).imax();
    let cut = (part.len() / 2).div_ceil(run) * run;
    part.select_nth_unstable_by(cut, |&a, &b| {
        points[a as usize][axis]
            .total_cmp(&points[b as usize][axis])
            .then(a.cmp(&b))
    });
    let (left, right) = part.split_at_mut(cut);
    bisect(points, left, runs);
    bisect(points, right, runs);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_compact_and_nothing_is_lost() {
        let points: Vec<Vec3> = (0..1000)
            .map(|i| Vec3::new(f64::from(i * 37 % 1000), f64::from(i % 3), 0.0))
            .collect();
        let order = spatial_order(&points, [64, 8]);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(i, &v)| i == v as usize));
        for run in order.chunks(64) {
            let xs = run.iter().map(|&i| points[i as usize].x);
            let (low, high) = xs.fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
            assert!(high - low < 140.0, "{low} {high}");
        }
    }
}
