//! Stability of an elastic aircraft: matrices in, roots out.
//!
//! $$ \bigl[M s^2 + C s + K - q_\infty Q(p)\bigr]\xi = 0,\qquad
//!    p = \frac{sb}{U} = g + \mathrm ik,\quad q_\infty = \tfrac12\rho U^2 $$
//!
//! Given a structure ([`System`] or any [`Structure`]), samples of $Q$
//! ([`GafTable`]) and a range of flight conditions ([`Schedule`]), a [`Sweep`]
//! finds the roots by the p2 method (a quadratic $Q$ on each rectangle of the
//! plane, Eller, IFASD-2009-119), by the p-k method, and refined on a smooth
//! $Q(p)$; follows them over speed and finds where they cross into growth.
//!
//! Axes: x aft, y starboard, z up. Motion $e^{st}$, so positive $g$ grows.
//! Nothing here knows about files, clocks or terminals.

mod aerodynamics;
mod assignment;
mod complete;
mod continuation;
mod count;
mod crossing;
mod divergence;
mod eigenpair;
mod events;
mod flight;
mod flight_modes;
mod flutter_point;
mod frame;
mod gaf;
mod hump;
mod lane_lu;
mod linalg;
mod margin;
mod mixture;
mod p2;
mod pencil;
mod pk;
mod polish;
mod quasi_steady;
mod rational;
mod real_axis;
mod refined;
mod report;
mod resolvers;
mod results;
mod rigid;
mod sensitivity;
mod spline;
mod state_space;
mod static_sweep;
mod structure;
mod sweep;
mod system;
mod track;
mod vector_fit;
mod winding;

pub use aerodynamics::{Aerodynamics, Expansion, FromFunction};
pub use eigenpair::Eigenpair;
pub use flight::{Flight, Thrust, TrimLoads};
pub use flight_modes::{FlightMode, FlyingBody, Ratio};
pub use frame::{Frame, FrameError, to_body_frame};
pub use gaf::{GafError, GafPoint, GafTable, REACH};
pub use linalg::NoConvergence;
pub use margin::Margin;
pub use mixture::{Incidences, MachNumbers, Mixture};
pub use p2::{
    Candidate, Cell, DEFAULT_DAMPING_LIMIT, FitError, FitReport, PiecewiseQuadratic, Region,
};
pub use pk::PkForm;
pub use rational::RationalFit;
pub use results::{
    Branch, Count, Crossing, Divergence, Hump, Kind, MethodResult, Methods, SCHEMA,
    SweepResult, TurnOfPair, UnstableStart,
};
pub use rigid::{Matrix6, RIGID_NAMES, RigidBody, RigidBodyError, RigidModes};
pub use sensitivity::{Parameter, Sensitivity};
pub use spline::AxisSpline;
pub use state_space::StateMatrix;
pub use structure::{FlightPath, OperatingPoint, Schedule, StructuralMatrices, Structure};
pub use sweep::{Method, Progress, Search, Sweep, SweepError};
pub use system::{DampingModel, PartLoads, System, SystemError};
