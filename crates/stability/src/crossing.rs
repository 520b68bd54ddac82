//! Where a branch passes from decay to growth, solved between the speeds.
//!
//! Where $Q(p)$ is smooth Newton's iteration in vector, frequency and speed
//! ([`flutter_point`](crate::flutter_point)) places a crossing. Else, and for
//! real roots, the damping $g$ of the branch as a function of the sweep's
//! parameter is brought to zero by the false position of Illinois, with
//! bisection where it gains too little; each step solves the eigenproblem
//! anew. On a fit that jumps across an edge it ends at the jump.

use faer::c64;

use crate::eigenpair::Eigenpair;
use crate::sensitivity::Sensitivity;
use crate::track::Track;

/// Finds the root of a branch at a place between two speeds.
pub(crate) trait Resolver: Sync {
    /// Root nearest to `guess` at `parameter`.
    fn near(&self, parameter: f64, guess: &Eigenpair) -> Option<Eigenpair>;

    /// Place within `bounds` where the root of `guess` has no damping, and the
    /// root there; none where the method has no iteration for it.
    fn crossing(
        &self,
        _parameter: f64,
        _guess: &Eigenpair,
        _bounds: [f64; 2],
    ) -> Option<(f64, Eigenpair)> {
        None
    }

    /// Change of $g$ a step of the sweep, at every speed of every track where
    /// the method has it at little cost.
    fn tangents(&self, tracks: &[Track]) -> Vec<Vec<Option<f64>>> {
        vec![Vec::new(); tracks.len()]
    }

    /// Whether the method's forces off the samples are continued from them.
    fn continues_samples(&self) -> bool {
        true
    }

    /// Derivatives of a crossing with respect to the sweep's parameters.
    fn sensitivities(&self, _parameter: f64, _pair: &Eigenpair) -> Vec<Sensitivity> {
        Vec::new()
    }
}

/// Width of the bracket, in steps of the sweep, at which the search ends.
const WIDTH: f64 = 1e-11;

/// |g| that counts as zero.
const DAMPING: f64 = 1e-14;

const MAX_STEPS: usize = 100;

/// Jump of $g$, as a part of $|p|$, that a piecewise fit may make near the
/// axis.
const LARGEST_JUMP: f64 = 0.05;

/// Change of $g$, as a part of $|p|$, that is believed where the root was lost
/// between the speeds.
const LARGEST_STEP: f64 = 0.3;

/// Steps back from the first speed of a branch that begins unstable.
const BACK_STEPS: usize = 8;

/// A sign change of $g$ on a track.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    /// Number of the track.
    pub(crate) track: usize,
    /// Place in the sweep.
    pub(crate) parameter: f64,
    /// Root there.
    pub(crate) pair: Eigenpair,
    /// From decay to growth.
    pub(crate) is_rising: bool,
}

/// Two places of one branch with $g$ of different sign.
#[derive(Clone)]
pub(crate) struct Bracketed {
    track: usize,
    ends: [(f64, Eigenpair); 2],
}

impl Bracketed {
    pub(crate) fn new(track: usize, low: (f64, Eigenpair), high: (f64, Eigenpair)) -> Self {
        Self {
            track,
            ends: [low, high],
        }
    }
}

/// Sign changes between consecutive speeds of a track.
pub(crate) fn sign_changes(number: usize, track: &Track) -> Vec<Bracketed> {
    track
        .roots
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| (pair[0].p.re > 0.0) != (pair[1].p.re > 0.0))
        .map(|(step, pair)| {
            let start = (track.first + step) as f64;
            Bracketed::new(
                number,
                (start, pair[0].clone()),
                (start + 1.0, pair[1].clone()),
            )
        })
        .collect()
}

/// A branch that begins unstable after the first speed is followed back
/// towards the speed before; where it was stable on the way, that is a
/// crossing.
pub(crate) fn before_the_start(
    number: usize,
    track: &Track,
    resolver: &dyn Resolver,
) -> Option<Bracketed> {
    let mut head = track.roots.first()?.clone();
    if head.p.re <= 0.0 || track.first == 0 {
        return None;
    }
    let mut place = track.first as f64;
    for step in 1..=BACK_STEPS {
        let next = track.first as f64 - step as f64 / BACK_STEPS as f64;
        let pair = resolver.near(next, &head)?;
        if (pair.p.im == 0.0) != (head.p.im == 0.0) {
            return None;
        }
        if pair.p.re <= 0.0 {
            return Some(Bracketed::new(number, (next, pair), (place, head)));
        }
        (place, head) = (next, pair);
    }
    None
}

/// Solves for the crossing inside a bracket; `None` where the damping jumps
/// over zero, because two roots were joined that are not one.
pub(crate) fn locate(bracket: &Bracketed, resolver: &dyn Resolver) -> Option<Found> {
    let [mut low, mut high] = bracket.ends.clone();
    let is_rising = high.1.p.re > 0.0;
    if let Some((parameter, pair)) = at_once(&low, &high, resolver) {
        return Some(Found {
            track: bracket.track,
            parameter,
            pair,
            is_rising,
        });
    }
    let mut weights = [low.1.p.re, high.1.p.re];
    let mut last_side = None;
    for step in 0..MAX_STEPS {
        let width = high.0 - low.0;
        if width < WIDTH {
            break;
        }
        let fraction = if step % 4 == 3 {
            0.5
        } else {
            weights[0] / (weights[0] - weights[1])
        };
        let parameter = low.0 + fraction.clamp(1e-6, 1.0 - 1e-6) * width;
        let guess = between(&low, &high, parameter);
        let Some(pair) = resolver.near(parameter, &guess) else {
            break;
        };
        let damping = pair.p.re;
        if damping.abs() < DAMPING {
            return Some(Found {
                track: bracket.track,
                parameter,
                pair,
                is_rising,
            });
        }
        let is_high = (damping > 0.0) == is_rising;
        let side = usize::from(is_high);
        weights[side] = damping;
        if last_side == Some(side) {
            weights[1 - side] *= 0.5;
        }
        last_side = Some(side);
        if is_high {
            high = (parameter, pair);
        } else {
            low = (parameter, pair);
        }
    }
    let jump = (high.1.p.re - low.1.p.re).abs() / high.1.p.norm();
    let limit = if high.0 - low.0 < WIDTH {
        LARGEST_JUMP
    } else {
        LARGEST_STEP
    };
    if high.1.p.im > 0.0 && jump > limit {
        return None;
    }
    let fraction = low.1.p.re / (low.1.p.re - high.1.p.re);
    let parameter = low.0 + fraction * (high.0 - low.0);
    let mut pair = between(&low, &high, parameter);
    pair.p.re = 0.0;
    Some(Found {
        track: bracket.track,
        parameter,
        pair,
        is_rising,
    })
}

/// The crossing of a complex root from a linear start.
fn at_once(
    low: &(f64, Eigenpair),
    high: &(f64, Eigenpair),
    resolver: &dyn Resolver,
) -> Option<(f64, Eigenpair)> {
    if low.1.p.im == 0.0 || high.1.p.im == 0.0 {
        return None;
    }
    let fraction = low.1.p.re / (low.1.p.re - high.1.p.re);
    let parameter = low.0 + fraction * (high.0 - low.0);
    let guess = between(low, high, parameter);
    resolver.crossing(parameter, &guess, [low.0, high.0])
}

/// Linear in $p$, with the vectors of the nearer end.
pub(crate) fn between(
    low: &(f64, Eigenpair),
    high: &(f64, Eigenpair),
    parameter: f64,
) -> Eigenpair {
    let fraction = (parameter - low.0) / (high.0 - low.0);
    let p: c64 = low.1.p + (high.1.p - low.1.p) * fraction;
    let nearer = if fraction < 0.5 { &low.1 } else { &high.1 };
    Eigenpair {
        p,
        ..nearer.clone()
    }
}
