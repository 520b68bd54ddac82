//! A complex pair that turns into two real roots, and back.
//!
//! Between two speeds a pair may meet the real axis and part along it: its
//! branch ends and two real ones begin. They are the same motion. The real
//! branches nearest to the last root of the pair, by the cost that joins roots
//! of neighbouring speeds, are taken for it. The way back is the same with the
//! speeds exchanged.

use crate::eigenpair::Eigenpair;
use crate::track::{Station, Track, cost_of_kinds};

/// A cost above this is another motion.
const DEAREST: f64 = 0.7;

/// Which way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Turn {
    /// From a pair to real roots.
    Split,
    /// From real roots to a pair.
    Join,
}

/// A pair and the real roots it comes from or turns into, by the numbers of
/// their tracks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Event {
    pub(crate) turn: Turn,
    pub(crate) pair: usize,
    /// One where the other lies outside the region.
    pub(crate) real: Vec<usize>,
    /// Number of the speed before it.
    pub(crate) after: usize,
}

/// All events, in order of speed.
pub(crate) fn events(tracks: &[Track], stations: &[Station<'_>]) -> Vec<Event> {
    let mut found = Vec::new();
    for after in 0..stations.len().saturating_sub(1) {
        for turn in [Turn::Split, Turn::Join] {
            found.extend(at_step(tracks, stations, after, turn));
        }
    }
    found
}

/// Tracks that begin as what a growing motion turns into: nothing begins to grow there.
pub(crate) fn from_growth(tracks: &[Track], events: &[Event]) -> Vec<usize> {
    let grows = |number: usize| {
        let last = tracks[number].roots.last();
        last.is_some_and(|root| root.p.re > 0.0)
    };
    events
        .iter()
        .flat_map(|event| match event.turn {
            Turn::Split if grows(event.pair) => event.real.clone(),
            Turn::Join if event.real.iter().all(|&real| grows(real)) => vec![event.pair],
            _ => Vec::new(),
        })
        .collect()
}

/// Ends of tracks at one speed that have no partner at the other.
fn loose(tracks: &[Track], at: usize, is_end: bool, is_real: bool) -> Vec<(usize, &Eigenpair)> {
    tracks
        .iter()
        .enumerate()
        .filter_map(|(number, track)| {
            let place = if is_end { track.last() } else { track.first };
            let root = if is_end {
                track.roots.last()
            } else {
                track.roots.first()
            };
            root.filter(|root| place == at && (root.p.im == 0.0) == is_real)
                .map(|root| (number, root))
        })
        .collect()
}

fn at_step(tracks: &[Track], stations: &[Station<'_>], after: usize, turn: Turn) -> Vec<Event> {
    let (pair_at, real_at) = match turn {
        Turn::Split => (after, after + 1),
        Turn::Join => (after + 1, after),
    };
    let is_split = turn == Turn::Split;
    let pairs = loose(tracks, pair_at, is_split, false);
    let real = loose(tracks, real_at, !is_split, true);
    let mut costs: Vec<(f64, usize, usize)> = Vec::new();
    for (pair_place, (_, pair)) in pairs.iter().enumerate() {
        for (real_place, (_, root)) in real.iter().enumerate() {
            let cost = cost_of_kinds(pair, &stations[pair_at], root, &stations[real_at]);
            if cost < DEAREST {
                costs.push((cost, pair_place, real_place));
            }
        }
    }
    costs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut taken = vec![false; real.len()];
    let mut partners: Vec<Vec<usize>> = vec![Vec::new(); pairs.len()];
    for (_, pair_place, real_place) in costs {
        if !taken[real_place] && partners[pair_place].len() < 2 {
            taken[real_place] = true;
            partners[pair_place].push(real[real_place].0);
        }
    }
    pairs
        .iter()
        .zip(partners)
        .filter(|(_, real)| !real.is_empty())
        .map(|((number, _), mut real)| {
            real.sort_unstable();
            Event {
                turn,
                pair: *number,
                real,
                after,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::c64;

    fn track(first: usize, roots: &[(f64, f64)]) -> Track {
        let root = |&(g, k): &(f64, f64)| Eigenpair {
            p: c64::new(g, k),
            right: Vec::new(),
            left: Vec::new(),
        };
        Track {
            first,
            roots: roots.iter().map(root).collect(),
        }
    }

    /// A pair that decays where it parts may still diverge within the step; what grew
    /// already does not begin to.
    #[test]
    fn only_what_comes_from_growth_begins_without_a_crossing() {
        for (damping, expected) in [(0.01, vec![1, 2]), (-0.01, Vec::new())] {
            let tracks = [
                track(0, &[(-0.02, 0.1), (damping, 0.05)]),
                track(2, &[(0.03, 0.0)]),
                track(2, &[(0.01, 0.0)]),
            ];
            let split = Event {
                turn: Turn::Split,
                pair: 0,
                real: vec![1, 2],
                after: 1,
            };
            assert_eq!(from_growth(&tracks, &[split]), expected);
        }
        for (damping, expected) in [(0.01, vec![2]), (-0.01, Vec::new())] {
            let tracks = [
                track(0, &[(0.02, 0.0)]),
                track(0, &[(damping, 0.0)]),
                track(1, &[(0.01, 0.02)]),
            ];
            let join = Event {
                turn: Turn::Join,
                pair: 2,
                real: vec![0, 1],
                after: 0,
            };
            assert_eq!(from_growth(&tracks, &[join]), expected);
        }
    }
}
