//! Order in space: neighbours in the list are neighbours on the surface.

use fladder_mesh::Vec3;

/// Indices of `points` in an order in which every aligned run of `unit` of them, and every
/// aligned run of `small`, is a compact cluster: bisection across the longest side of the
/// box, cut at multiples of the run.
pub(crate) fn spatial_order(points: &[Vec3], unit: usize, small: usize) -> Vec<u32> {
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    bisect(points, &mut order, unit, small);
    order
}

fn bisect(points: &[Vec3], part: &mut [u32], unit: usize, small: usize) {
    let run = if part.len() > unit { unit } else { small };
    if part.len() <= run {
        return;
    }
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
    bisect(points, left, unit, small);
    bisect(points, right, unit, small);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_compact_and_nothing_is_lost() {
        let points: Vec<Vec3> = (0..1000)
            .map(|i| Vec3::new(f64::from(i * 37 % 1000), f64::from(i % 3), 0.0))
            .collect();
        let order = spatial_order(&points, 64, 8);
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
