//! Newton's iteration on the nonlinear eigenproblem, for many roots at once.
//!
//! Unknowns $x$ and $p$, equations $T(p)x = 0$ and $y^Hx = 1$. Eliminated, a
//! step is one solution with $T$:
//! $$ v = T^{-1}T'x,\qquad p \leftarrow p - \frac1{y^Hv},\qquad
//!    x \leftarrow \frac v{y^Hv} $$
//! It wants a $Q(p)$ that is smooth, not the piecewise one: there it never
//! settles across an edge.

use faer::{Mat, c64};

use crate::aerodynamics::Aerodynamics;
use crate::eigenpair::{Eigenpair, inverse_iteration, left_vector, turned_to_unit};
use crate::linalg::{Lu, apply, inner};
use crate::p2::{REAL_ROOT, ZERO_ROOT};
use crate::pencil::Pencil;
use crate::structure::{Hysteresis, Reduced};

/// Steps of $p$ are cut to this length.
const LONGEST_STEP: f64 = 0.3;

/// A root found further than this from its seed belongs to another seed.
const LONGEST_WAY: f64 = 0.1;

/// Step at which the iteration has converged, relative to $1 + |p|$.
const CONVERGED: f64 = 1e-13;

/// Step that is good enough when rounding keeps the iteration from the limit
/// above.
const ACCEPTABLE: f64 = 1e-10;

/// Steps must shrink by this before the next is foretold.
const LEAST_GAIN: f64 = 0.1;

const MAX_STEPS: usize = 20;

/// Roots closer than this, relative to $1+|p|$, are one.
const SAME_ROOT: f64 = 1e-8;

/// Where an iteration starts.
#[derive(Clone, Debug)]
pub(crate) struct Seed {
    pub(crate) p: c64,
    /// Right vector; without it inverse iteration finds one.
    pub(crate) vector: Option<Vec<c64>>,
    /// Number of the root at another speed that it continues.
    pub(crate) parent: Option<usize>,
}

impl Seed {
    pub(crate) fn new(p: c64) -> Self {
        Self {
            p,
            vector: None,
            parent: None,
        }
    }
}

/// A root and its right vector, of unit length.
#[derive(Clone, Debug)]
pub(crate) struct Root {
    pub(crate) p: c64,
    pub(crate) vector: Vec<c64>,
    /// That of its seed.
    pub(crate) parent: Option<usize>,
}

/// One iteration under way.
struct Way {
    seed: c64,
    parent: Option<usize>,
    p: c64,
    x: Vec<c64>,
    anchor: Vec<c64>,
    last_step: f64,
    state: State,
    rules: Rules,
}

/// What the problem says of an iteration.
#[derive(Clone, Copy)]
struct Rules {
    /// $T'$ is exact and steps shrink quadratically.
    is_quadratic: bool,
    /// With hysteretic damping $T$ holds above the real axis alone.
    is_hysteretic: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Running,
    Found,
    Lost,
}

/// Refines every seed; `None` where the iteration fails or leaves the
/// neighbourhood.
pub(crate) fn newton(pencil: &Pencil<'_>, seeds: Vec<Seed>) -> Vec<Option<Root>> {
    let mut ways: Vec<Way> = seeds
        .into_iter()
        .map(|seed| Way::new(pencil, seed))
        .collect();
    for _ in 0..MAX_STEPS {
        let running: Vec<usize> = (0..ways.len())
            .filter(|&way| ways[way].state == State::Running)
            .collect();
        if running.is_empty() {
            break;
        }
        let points: Vec<c64> = running.iter().map(|&way| ways[way].p).collect();
        pencil.each_operator_and_slope(&points, |number, operator, slope| {
            ways[running[number]].step(operator, &slope);
        });
    }
    ways.into_iter().map(Way::finish).collect()
}

impl Way {
    fn new(pencil: &Pencil<'_>, seed: Seed) -> Self {
        let start = seed.vector.unwrap_or_else(|| {
            let operator = pencil.operator(seed.p, Reduced::hysteresis_at(seed.p));
            inverse_iteration(seed.p, operator).right
        });
        let scale = turned_to_unit(&start);
        let anchor: Vec<c64> = start.into_iter().map(|value| value * scale).collect();
        Self {
            rules: Rules {
                is_quadratic: pencil.aerodynamics.expansion().is_some(),
                is_hysteretic: pencil.reduced.is_hysteretic(),
            },
            parent: seed.parent,
            seed: seed.p,
            p: seed.p,
            x: anchor.clone(),
            anchor,
            last_step: f64::INFINITY,
            state: State::Running,
        }
    }

    fn step(&mut self, operator: Mat<c64>, slope: &Mat<c64>) {
        let mut lu = Lu::new(operator);
        lu.guard_pivots();
        let image = apply(slope.as_ref(), &self.x);
        let mut solution = Mat::from_fn(image.len(), 1, |i, _| image[i]);
        lu.solve(solution.as_mut());
        let v = solution.col_as_slice(0);
        let gain = inner(&self.anchor, v);
        let mut change = -1.0 / gain;
        if self.seed.im == 0.0 {
            change.im = 0.0;
        }
        let length = change.norm();
        if !length.is_finite() {
            self.state = State::Lost;
            return;
        }
        let is_cut = length > LONGEST_STEP;
        self.p += if is_cut {
            change * (LONGEST_STEP / length)
        } else {
            change
        };
        self.x = v.iter().map(|value| value / gain).collect();
        let limit = CONVERGED * (1.0 + self.p.norm());
        let has_stalled = length >= 0.5 * self.last_step && length < ACCEPTABLE;
        if length < limit || has_stalled || self.next_step(length) < limit {
            self.state = State::Found;
        } else if (self.p - self.seed).norm() > 3.0 * LONGEST_WAY {
            self.state = State::Lost;
        }
        self.last_step = length;
    }

    /// Length that the next step will have, from this one and the last.
    fn next_step(&self, length: f64) -> f64 {
        let ratio = length / self.last_step;
        if ratio > LEAST_GAIN || self.last_step.is_infinite() {
            return f64::INFINITY;
        }
        let gain = if self.rules.is_quadratic {
            ratio * ratio
        } else {
            ratio
        };
        length * gain
    }

    fn finish(self) -> Option<Root> {
        // On the branch cut the slope is one side's and steps shrink by a constant only.
        let is_close = self.state == State::Running && self.last_step < ACCEPTABLE;
        let has_arrived = self.state == State::Found || is_close;
        if !has_arrived || (self.p - self.seed).norm() > LONGEST_WAY {
            return None;
        }
        let has_left = self.seed.im > 0.0 && self.p.im < REAL_ROOT;
        if self.rules.is_hysteretic && has_left {
            return None;
        }
        let (mut p, mut x) = (self.p, self.x);
        if p.im.abs() < REAL_ROOT {
            p = c64::new(p.re, 0.0);
        }
        if p.im < 0.0 {
            p = p.conj();
            for value in &mut x {
                *value = value.conj();
            }
        }
        let scale = turned_to_unit(&x);
        for value in &mut x {
            *value *= scale;
        }
        Some(Root {
            p,
            vector: x,
            parent: self.parent,
        })
    }
}

/// Improves one root; `None` where the iteration fails or leaves the
/// neighbourhood.
pub(crate) fn polish(
    reduced: &Reduced,
    aerodynamics: &dyn Aerodynamics,
    seed: c64,
    start: Option<&[c64]>,
) -> Option<Eigenpair> {
    let pencil = Pencil::new(reduced, aerodynamics);
    let seed = Seed {
        p: seed,
        vector: start.map(<[c64]>::to_vec),
        parent: None,
    };
    let root = newton(&pencil, vec![seed]).pop()??;
    Some(pencil.pair(root.p))
}

impl Pencil<'_> {
    /// A root with both its vectors.
    pub(crate) fn pair(&self, p: c64) -> Eigenpair {
        inverse_iteration(p, self.operator(p, Reduced::hysteresis_at(p)))
    }

    /// Several roots with both their vectors.
    pub(crate) fn pairs(&self, roots: &[&Root]) -> Vec<Eigenpair> {
        let mut pairs = Vec::with_capacity(roots.len());
        for hysteresis in [Hysteresis::Included, Hysteresis::LeftOut] {
            let group: Vec<&Root> = roots
                .iter()
                .copied()
                .filter(|root| Reduced::hysteresis_at(root.p) == hysteresis)
                .collect();
            let points: Vec<c64> = group.iter().map(|root| root.p).collect();
            self.each_operator(&points, hysteresis, |number, operator| {
                let right = group[number].vector.clone();
                pairs.push(left_vector(points[number], operator, right));
            });
        }
        sort(&mut pairs);
        pairs
    }
}

/// Adds a root unless it is zero or in the list already.
pub(crate) fn add_new(roots: &mut Vec<Root>, root: Root) {
    if root.p.norm() >= ZERO_ROOT && roots.iter().all(|other| !is_same(other.p, root.p)) {
        roots.push(root);
    }
}

/// Whether two values are one root.
pub(crate) fn is_same(first: c64, second: c64) -> bool {
    (first - second).norm() < SAME_ROOT * (1.0 + second.norm())
}

/// By $k$, then by $g$.
pub(crate) fn sort(roots: &mut [Eigenpair]) {
    roots.sort_by(|a, b| a.p.im.total_cmp(&b.p.im).then(a.p.re.total_cmp(&b.p.re)));
}
