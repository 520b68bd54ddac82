//! Roots of one speed joined to those of the next.
//!
//! The cost of a pair is
//! $$ 1 - \mathrm{MAC} + \frac{|s_2 - s_1|}{\tfrac12(|s_1|+|s_2|) + \pi},
//!    \qquad \mathrm{MAC} = \frac{|x_1^HMx_2|^2}{(x_1^HMx_1)(x_2^HMx_2)} $$
//! with $s$ in rad/s; the cheapest assignment of all pairs is taken. A root
//! whose pair would cost more than 0.7 stays alone, and its branch ends or
//! begins. A complex root is never joined to a real one: where a pair turns
//! into two real roots its branch ends and two begin.

use faer::{Mat, c64};

use crate::assignment::assign;
use crate::eigenpair::Eigenpair;
use crate::linalg::inner;

/// Dearer pairs are not joined; half of it for each side left alone.
const UNMATCHED: f64 = 0.7;

/// Cost of a pair that must not be.
const FORBIDDEN: f64 = 1e3;

/// Scale of $|s|$ below which differences count absolutely: half a hertz.
pub(crate) const SMALL_RATE: f64 = std::f64::consts::PI;

/// A root followed over consecutive speeds.
#[derive(Clone, Debug)]
pub(crate) struct Track {
    /// Number of the first speed.
    pub(crate) first: usize,
    /// One root a speed.
    pub(crate) roots: Vec<Eigenpair>,
}

impl Track {
    /// Number of the last speed.
    pub(crate) fn last(&self) -> usize {
        self.first + self.roots.len() - 1
    }
}

/// Roots of one speed, with what turns $p$ into $s$ and weighs the vectors.
pub(crate) struct Station<'a> {
    pub(crate) roots: &'a [Eigenpair],
    /// $U/b$.
    pub(crate) rate: f64,
    pub(crate) mass: &'a Mat<f64>,
}

/// Follows all roots over all speeds, in order of their first speed.
pub(crate) fn follow(stations: &[Station<'_>]) -> Vec<Track> {
    let mut tracks: Vec<Track> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    for (number, station) in stations.iter().enumerate() {
        let heads: Vec<&Eigenpair> = open
            .iter()
            .filter_map(|&track| tracks[track].roots.last())
            .collect();
        let partners = match number.checked_sub(1) {
            Some(previous) => join(&heads, stations[previous].rate, station),
            None => vec![None; station.roots.len()],
        };
        let mut next = Vec::with_capacity(station.roots.len());
        for (root, partner) in station.roots.iter().zip(partners) {
            if let Some(head) = partner {
                tracks[open[head]].roots.push(root.clone());
                next.push(open[head]);
            } else {
                next.push(tracks.len());
                tracks.push(Track {
                    first: number,
                    roots: vec![root.clone()],
                });
            }
        }
        open = next;
    }
    tracks
}

/// A root with what its comparisons need.
struct Weighed<'a> {
    root: &'a Eigenpair,
    /// $s$ in rad/s.
    rate: c64,
    /// $Mx$.
    momentum: Vec<c64>,
    /// $x^HMx$.
    energy: f64,
}

impl<'a> Weighed<'a> {
    fn new(root: &'a Eigenpair, rate: f64, mass: &Mat<f64>) -> Self {
        let momentum = weigh(&root.right, mass);
        let energy = inner(&root.right, &momentum).re;
        Self {
            root,
            rate: root.p * rate,
            momentum,
            energy,
        }
    }
}

/// For every root of the station the head it continues.
fn join(heads: &[&Eigenpair], rate: f64, station: &Station<'_>) -> Vec<Option<usize>> {
    let before: Vec<Weighed<'_>> = heads
        .iter()
        .map(|root| Weighed::new(root, rate, station.mass))
        .collect();
    let after: Vec<Weighed<'_>> = station
        .roots
        .iter()
        .map(|root| Weighed::new(root, station.rate, station.mass))
        .collect();
    let (old, new) = (before.len(), after.len());
    let size = old + new;
    let costs: Vec<Vec<f64>> = (0..size)
        .map(|row| {
            (0..size)
                .map(|column| match (row < old, column < new) {
                    (true, true) => pair_cost(&before[row], &after[column]),
                    (false, false) => 0.0,
                    _ => 0.5 * UNMATCHED,
                })
                .collect()
        })
        .collect();
    let mut partners = vec![None; new];
    for (row, column) in assign(&costs).into_iter().enumerate() {
        if row < old && column < new {
            partners[column] = Some(row);
        }
    }
    partners
}

/// Cost of joining roots of two speeds, be they real or complex.
pub(crate) fn cost_of_kinds(
    first: &Eigenpair,
    at_first: &Station<'_>,
    second: &Eigenpair,
    at_second: &Station<'_>,
) -> f64 {
    cost(
        &Weighed::new(first, at_first.rate, at_second.mass),
        &Weighed::new(second, at_second.rate, at_second.mass),
    )
}

fn pair_cost(before: &Weighed<'_>, after: &Weighed<'_>) -> f64 {
    if (before.root.p.im == 0.0) == (after.root.p.im == 0.0) {
        cost(before, after)
    } else {
        FORBIDDEN
    }
}

fn cost(before: &Weighed<'_>, after: &Weighed<'_>) -> f64 {
    let distance = (after.rate - before.rate).norm();
    let scale = f64::midpoint(before.rate.norm(), after.rate.norm()) + SMALL_RATE;
    let likeness =
        inner(&before.root.right, &after.momentum).norm_sqr() / (before.energy * after.energy);
    1.0 - likeness + distance / scale
}

/// Modal assurance criterion weighted by the mass.
pub(crate) fn alikeness(first: &[c64], second: &[c64], mass: &Mat<f64>) -> f64 {
    let (one, other) = (weigh(first, mass), weigh(second, mass));
    let product = inner(first, &other).norm_sqr();
    product / (inner(first, &one).re * inner(second, &other).re)
}

/// $Mx$.
fn weigh(vector: &[c64], mass: &Mat<f64>) -> Vec<c64> {
    let mut out = vec![c64::new(0.0, 0.0); vector.len()];
    for (column, value) in vector.iter().enumerate() {
        for (row, sum) in out.iter_mut().enumerate() {
            *sum += value * mass[(row, column)];
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const ORDER: usize = 8;

    /// Eight roots that cross and veer, in the order of a shuffle.
    fn station(speed: usize, shuffle: usize) -> Vec<Eigenpair> {
        let t = speed as f64 / 40.0;
        let pair = |mode: usize| {
            let own = mode as f64;
            // Neighbours exchange their frequencies, and their vectors turn
            // into each other on the way.
            let partner = mode ^ 1;
            let turn = (20.0 * (t - 0.5)).tanh().mul_add(0.5, 0.5) * 0.9;
            let vector = |i: usize| match i {
                i if i == mode => c64::new((1.0 - turn * turn).sqrt(), 0.0),
                i if i == partner => c64::new(0.3 * turn, 0.1 * turn),
                _ => c64::new(0.0, 0.0),
            };
            let drift = if mode.is_multiple_of(2) { t } else { -t };
            Eigenpair {
                p: c64::new(-0.01 - 0.002 * own, 0.2 + 0.15 * own + 0.16 * drift),
                right: (0..ORDER).map(vector).collect(),
                left: Vec::new(),
            }
        };
        (0..ORDER)
            .map(|place| pair((place * shuffle + speed * (shuffle - 1)) % ORDER))
            .collect()
    }

    /// The order in which the roots of a speed are listed does not matter.
    #[test]
    fn shuffled_roots_give_the_same_tracks() {
        let mass = Mat::from_fn(ORDER, ORDER, |i, j| f64::from(u8::from(i == j)));
        let tracks = |shuffle: usize| {
            let roots: Vec<Vec<Eigenpair>> =
                (0..=40).map(|speed| station(speed, shuffle)).collect();
            let stations: Vec<Station<'_>> = roots
                .iter()
                .map(|roots| Station {
                    roots,
                    rate: 100.0,
                    mass: &mass,
                })
                .collect();
            let mut tracks: Vec<Vec<(f64, f64)>> = follow(&stations)
                .into_iter()
                .map(|track| {
                    track
                        .roots
                        .iter()
                        .map(|root| (root.p.re, root.p.im))
                        .collect()
                })
                .collect();
            tracks.sort_by(|a: &Vec<(f64, f64)>, b| a[0].1.total_cmp(&b[0].1));
            tracks
        };
        let straight = tracks(1);
        assert_eq!(straight.len(), ORDER);
        for track in &straight {
            assert!(track.iter().all(|root| root.0 == track[0].0), "{track:?}");
        }
        for shuffle in [3, 5, 7] {
            assert_eq!(tracks(shuffle), straight);
        }
    }
}
