//! Tracks and crossings put into words and numbers.

use std::collections::HashMap;

use crate::crossing::{Found, Resolver};
use crate::eigenpair::Eigenpair;
use crate::events::{Event, Turn};
use crate::flight_modes::{FlightMode, Motion, Named, names};
use crate::results::{
    Branch, Crossing, Divergence, Hump, Kind, MethodResult, TurnOfPair, UnstableStart,
};
use crate::structure::{OperatingPoint, Reduced};
use crate::sweep::{Sweep, reduced_at};
use crate::track::Track;

/// Writes the outcome of one method.
pub(crate) struct Reporter<'a> {
    sweep: &'a Sweep<'a>,
    points: &'a [OperatingPoint],
    reduced: &'a [Reduced],
    tracks: &'a [Track],
    rigid: Vec<usize>,
    names: Vec<String>,
    kinds: Vec<Kind>,
}

impl<'a> Reporter<'a> {
    pub(crate) fn new(
        sweep: &'a Sweep<'a>,
        points: &'a [OperatingPoint],
        reduced: &'a [Reduced],
        tracks: &'a [Track],
    ) -> Self {
        let rigid = sweep.structure.rigid_modes();
        let shares: Vec<Vec<f64>> = tracks
            .iter()
            .map(|track| reduced[track.first].energy_shares(&track.roots[0].right))
            .collect();
        let leading = shares
            .iter()
            .map(|shares| leading_mode(sweep.structure.modes(), shares));
        let names = unique_names(leading);
        let kinds = shares
            .iter()
            .map(|shares| kind_of(shares, &rigid))
            .collect();
        Self {
            sweep,
            points,
            reduced,
            tracks,
            rigid,
            names,
            kinds,
        }
    }

    pub(crate) fn report(
        &self,
        found: &[Found],
        events: &[Event],
        resolver: &dyn Resolver,
    ) -> MethodResult {
        let mut result = MethodResult::default();
        for number in 0..self.tracks.len() {
            result.branches.push(self.branch(number, resolver));
            if !self.continues_growth(number, events) {
                result
                    .unstable_at_start
                    .extend(self.unstable_start(number, found));
            }
        }
        result.turns = events.iter().map(|event| self.turn(event)).collect();
        result.humps = self.humps(found);
        result.flight_modes = self.flight_modes();
        for crossing in found {
            let entry = self.crossing(crossing);
            if !crossing.is_rising {
                result.restabilised.push(entry);
            } else if crossing.pair.p.im > 0.0 {
                let derivatives = resolver.sensitivities(crossing.parameter, &crossing.pair);
                result.flutter.push(Crossing {
                    sensitivities: (!derivatives.is_empty()).then_some(derivatives),
                    ..entry
                });
            } else {
                result.divergence.push(Divergence {
                    speed: entry.speed,
                    dynamic_pressure: entry.dynamic_pressure,
                    branch: entry.branch,
                    kind: entry.kind,
                    altitude: entry.altitude,
                });
            }
        }
        result.flutter.sort_by(|a, b| a.speed.total_cmp(&b.speed));
        result
            .restabilised
            .sort_by(|a, b| a.speed.total_cmp(&b.speed));
        result
            .divergence
            .sort_by(|a, b| a.speed.total_cmp(&b.speed));
        result
    }

    /// Rigid motions of every speed, fastest first.
    fn flight_modes(&self) -> Vec<FlightMode> {
        let Some(flying) = self.sweep.structure.flying_body() else {
            return Vec::new();
        };
        let semichord = self.sweep.table.semichord();
        let modes = self.sweep.structure.modes();
        let mut listed = Vec::new();
        for (station, (point, reduced)) in self.points.iter().zip(self.reduced).enumerate() {
            let mut there: Vec<(usize, Vec<f64>, Motion)> = Vec::new();
            for (number, track) in self.tracks.iter().enumerate() {
                if !(track.first..=track.last()).contains(&station) {
                    continue;
                }
                let root = &track.roots[station - track.first];
                let shares = reduced.energy_shares(&root.right);
                if kind_of(&shares, &self.rigid) == Kind::Rigid {
                    let held: f64 = self.rigid.iter().map(|mode| shares[*mode]).sum();
                    let motion =
                        Motion::new(&flying, point, semichord, root.p, &root.right, 1.0 - held);
                    there.push((number, shares, motion));
                }
            }
            there.sort_by(|a, b| b.2.p.norm().total_cmp(&a.2.p.norm()));
            let (keys, motions): (Vec<(usize, Vec<f64>)>, Vec<Motion>) = there
                .into_iter()
                .map(|(number, shares, motion)| ((number, shares), motion))
                .unzip();
            let found = names(&motions);
            for (((number, shares), motion), name) in keys.iter().zip(&motions).zip(found) {
                let elastic = (0..shares.len()).filter(|mode| !self.rigid.contains(mode));
                let leading = elastic
                    .clone()
                    .max_by(|a, b| shares[*a].total_cmp(&shares[*b]));
                let named = Named {
                    motion,
                    name,
                    branch: self.names[*number].clone(),
                    elastic_share: elastic.map(|mode| shares[mode]).sum(),
                    elastic_mode: leading.map(|mode| modes[mode].clone()),
                };
                listed.push(named.at(point, semichord));
            }
        }
        listed
    }

    fn branch(&self, number: usize, resolver: &dyn Resolver) -> Branch {
        let track = &self.tracks[number];
        let points = &self.points[track.first..=track.last()];
        let mut branch = Branch {
            name: self.names[number].clone(),
            kind: self.kinds[number],
            first: track.first,
            ..Branch::default()
        };
        for (point, root) in points.iter().zip(&track.roots) {
            let rate = point.airspeed / self.sweep.table.semichord();
            branch.push(point.airspeed, rate, root);
        }
        if resolver.continues_samples() {
            let outside: Vec<bool> = track
                .roots
                .iter()
                .map(|root| self.sweep.table.is_outside(root.p))
                .collect();
            branch.extrapolated = outside.contains(&true).then_some(outside);
        }
        let is_over_altitude = self.points.iter().any(|point| point.altitude.is_some());
        if is_over_altitude {
            branch.density = Some(points.iter().map(|point| point.density).collect());
            branch.altitude = points.iter().map(|point| point.altitude).collect();
            branch.mach = points.iter().map(|point| point.mach).collect();
        }
        branch
    }

    fn crossing(&self, found: &Found) -> Crossing {
        let point = self.sweep.schedule.at(found.parameter);
        let reduced = reduced_at(self.sweep, found.parameter);
        let shares = reduced.energy_shares(&found.pair.right);
        Crossing {
            speed: point.airspeed,
            dynamic_pressure: point.dynamic_pressure(),
            frequency_hz: found.pair.p.im * reduced.rate / std::f64::consts::TAU,
            k: found.pair.p.im,
            branch: self.names[found.track].clone(),
            kind: kind_of(&shares, &self.rigid),
            altitude: point.altitude,
            sensitivities: None,
            shape: found.pair.right.clone(),
        }
    }

    /// Whether the branch begins in a pair or in real roots that grow already:
    /// the same instability, told once.
    fn continues_growth(&self, number: usize, events: &[Event]) -> bool {
        let grows = |track: &usize| {
            let last = self.tracks[*track].roots.last();
            last.is_some_and(|root| root.p.re > 0.0)
        };
        events.iter().any(|event| match event.turn {
            Turn::Split => event.real.contains(&number) && grows(&event.pair),
            Turn::Join => event.pair == number && event.real.iter().any(grows),
        })
    }

    fn turn(&self, event: &Event) -> TurnOfPair {
        let name = |track: &usize| self.names[*track].clone();
        TurnOfPair {
            kind: match event.turn {
                Turn::Split => "split",
                Turn::Join => "join",
            },
            pair: name(&event.pair),
            real: event.real.iter().map(name).collect(),
            between: [event.after, event.after + 1].map(|speed| self.points[speed].airspeed),
        }
    }

    /// Ways into growth that the same branch leaves again.
    fn humps(&self, found: &[Found]) -> Vec<Hump> {
        let mut ordered: Vec<&Found> = found.iter().collect();
        ordered.sort_by(|a, b| {
            let by_track = a.track.cmp(&b.track);
            by_track.then(a.parameter.total_cmp(&b.parameter))
        });
        let is_hump = |pair: &&[&Found]| {
            pair[0].track == pair[1].track && pair[0].is_rising && !pair[1].is_rising
        };
        let speed = |found: &Found| self.sweep.schedule.at(found.parameter).airspeed;
        let mut humps: Vec<Hump> = ordered
            .windows(2)
            .filter(is_hump)
            .map(|pair| Hump {
                branch: self.names[pair[0].track].clone(),
                from: speed(pair[0]),
                to: speed(pair[1]),
            })
            .collect();
        humps.sort_by(|a, b| a.from.total_cmp(&b.from));
        humps
    }

    fn unstable_start(&self, number: usize, found: &[Found]) -> Option<UnstableStart> {
        let track = &self.tracks[number];
        let start = track.first as f64;
        let has_crossed = found
            .iter()
            .any(|crossing| crossing.track == number && crossing.parameter < start);
        let root = &track.roots[0];
        (root.p.re > 0.0 && !has_crossed).then(|| UnstableStart {
            branch: self.names[number].clone(),
            g: root.p.re,
            k: root.p.im,
            speed: self.points[track.first].airspeed,
            kind: self.kinds[number],
        })
    }
}

impl Branch {
    fn push(&mut self, airspeed: f64, rate: f64, root: &Eigenpair) {
        let (g, k) = (root.p.re, root.p.im);
        let size = root.p.norm();
        self.speed.push(airspeed);
        self.g.push(g);
        self.k.push(k);
        self.sigma.push(g * rate);
        self.omega.push(k * rate);
        self.frequency_hz.push(k * rate / std::f64::consts::TAU);
        self.damping_ratio.push((size > 0.0).then(|| -g / size));
        self.structural_damping.push((k > 0.0).then(|| 2.0 * g / k));
        self.shapes.push(root.right.clone());
    }
}

/// Name of the mode with the largest share.
pub(crate) fn leading_mode<'a>(modes: &'a [String], shares: &[f64]) -> &'a str {
    let best = (0..shares.len()).max_by(|&a, &b| shares[a].total_cmp(&shares[b]));
    best.map_or("", |mode| modes[mode].as_str())
}

/// Rigid when the rigid modes hold more than half of the kinetic energy.
pub(crate) fn kind_of(shares: &[f64], rigid: &[usize]) -> Kind {
    let held: f64 = rigid.iter().map(|&mode| shares[mode]).sum();
    if held > 0.5 {
        Kind::Rigid
    } else {
        Kind::Elastic
    }
}

/// Adds `#2`, `#3` … to names that are taken.
fn unique_names<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut uses: HashMap<&str, usize> = HashMap::new();
    names
        .map(|name| {
            let count = uses.entry(name).or_insert(0);
            *count += 1;
            if *count == 1 {
                name.to_owned()
            } else {
                format!("{name}#{count}")
            }
        })
        .collect()
}
