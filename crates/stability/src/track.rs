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

/// For every root of the station the head it continues.
fn join(heads: &[&Eigenpair], rate: f64, station: &Station<'_>) -> Vec<Option<usize>> {
    let (old, new) = (heads.len(), station.roots.len());
    let size = old + new;
    let costs: Vec<Vec<f64>> = (0..size)
        .map(|row| {
            (0..size)
                .map(|column| match (row < old, column < new) {
                    (true, true) => {
                        pair_cost((heads[row], rate), &station.roots[column], station)
                    }
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

fn pair_cost((head, rate): (&Eigenpair, f64), root: &Eigenpair, station: &Station<'_>) -> f64 {
    if (head.p.im == 0.0) != (root.p.im == 0.0) {
        return FORBIDDEN;
    }
    let (before, after) = (head.p * rate, root.p * station.rate);
    let distance = (after - before).norm();
    let scale = f64::midpoint(before.norm(), after.norm()) + SMALL_RATE;
    1.0 - alikeness(&head.right, &root.right, station.mass) + distance / scale
}

/// Modal assurance criterion weighted by the mass.
pub(crate) fn alikeness(first: &[c64], second: &[c64], mass: &Mat<f64>) -> f64 {
    let weigh = |left: &[c64], right: &[c64]| -> c64 {
        let mut sum = c64::new(0.0, 0.0);
        for (j, value) in right.iter().enumerate() {
            for (i, other) in left.iter().enumerate() {
                sum += other.conj() * value * mass[(i, j)];
            }
        }
        sum
    };
    let product = weigh(first, second).norm_sqr();
    product / (weigh(first, first).re * weigh(second, second).re)
}
