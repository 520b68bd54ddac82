//! What can be wrong with a boundary-element problem.

/// Why no generalised forces could be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BemError {
    /// A mode has another number of displacements than the mesh has vertices.
    #[error("mode `{mode}` has {found} displacements for {expected} mesh vertices")]
    ModeLength {
        /// Name of the mode.
        mode: String,
        /// Displacements found.
        found: usize,
        /// Vertices of the mesh.
        expected: usize,
    },
    /// A displacement is not finite.
    #[error("mode `{mode}` has no finite displacement at vertex {vertex}")]
    ModeNotFinite {
        /// Name of the mode.
        mode: String,
        /// Mesh vertex.
        vertex: usize,
    },
    /// Sideslip on a half model.
    #[error(
        "a half model has its stream in the plane of symmetry, but β = {beta_deg}°; mesh the whole aircraft for sideslip"
    )]
    SideslipOnHalf {
        /// Sideslip, °.
        beta_deg: f64,
    },
    /// The triangles at a trailing-edge vertex do not fall into two sides.
    #[error(
        "the triangles at trailing-edge vertex {vertex} (at {x:.4}, {y:.4}, {z:.4} m) fall into {groups} groups instead of an upper and a lower one, so the wake jump has no meaning there; trailing edges that join or branch in one vertex are not handled: separate them or name the edges by curve groups"
    )]
    TrailingFan {
        /// Mesh vertex.
        vertex: u32,
        /// Position.
        x: f64,
        /// Position.
        y: f64,
        /// Position.
        z: f64,
        /// Groups found.
        groups: usize,
    },
    /// The line along which a wake lies on a body runs into another trailing edge.
    #[error(
        "the wake's inner edge, followed along the body from the junction at vertex {junction}, meets another trailing edge at vertex {vertex}; give the line by wake.body_lines"
    )]
    PathMeetsTrailingEdge {
        /// Vertex where the trailing edge ends on the body.
        junction: u32,
        /// Vertex where the lines meet.
        vertex: u32,
    },
    /// The body line could not be followed downstream.
    #[error(
        "no line along the body could be followed downstream from the junction at vertex {junction}; name it by wake.body_lines"
    )]
    PathNotFound {
        /// Vertex where the trailing edge ends on the body.
        junction: u32,
    },
    /// A named body line does not run downstream.
    #[error(
        "the body line from the junction at vertex {junction} runs upstream at vertex {vertex}"
    )]
    PathNotDownstream {
        /// Vertex where the trailing edge ends on the body.
        junction: u32,
        /// First vertex that lies upstream of the one before.
        vertex: u32,
    },
    /// The wake's upper and lower sides cannot be told apart along the body line.
    #[error(
        "the triangles at vertex {vertex} of the wake's line along the body fall into {groups} groups instead of two"
    )]
    PathFan {
        /// Mesh vertex.
        vertex: u32,
        /// Groups found.
        groups: usize,
    },
    /// The influence matrix has no usable factorisation.
    #[error(
        "the influence matrix is singular to working precision (pivot {pivot} of {size} is {value:.2e}); look for surfaces that touch or are thinner than the mesh resolves"
    )]
    Singular {
        /// Number of the pivot.
        pivot: usize,
        /// Number of unknowns.
        size: usize,
        /// Its size.
        value: f64,
    },
    /// A point of the Laplace plane at which no pressure can be given.
    #[error(
        "g = {g}, k = {k} is no point with k > 0, or k = 0 and g ≥ 0; pressures are given there only"
    )]
    Point {
        /// Reduced damping.
        g: f64,
        /// Reduced frequency.
        k: f64,
    },
    /// The result holds a value that is no number.
    #[error("the generalised forces of mode `{mode}` are not finite")]
    NotFinite {
        /// Name of the mode.
        mode: String,
    },
    /// The computation was interrupted.
    #[error("interrupted while {stage}")]
    Interrupted {
        /// What was being done.
        stage: &'static str,
    },
}

/// Why Q could not be evaluated at a point of the Laplace plane.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LaplaceError {
    /// The point lies on the branch cut.
    #[error("g = {g} with k = 0 lies on the branch cut of Q; take k > 0 or g ≥ 0")]
    BranchCut {
        /// Reduced damping.
        g: f64,
    },
    /// The point is not finite.
    #[error("g = {g}, k = {k} is not a point of the Laplace plane")]
    NotFinite {
        /// Reduced damping.
        g: f64,
        /// Reduced frequency.
        k: f64,
    },
    /// The motion decays so fast that the far wake's integral loses its digits.
    #[error(
        "at g = {g}, k = {k} the motion decays too fast for the far wake to be integrated; take g nearer to 0"
    )]
    TooDamped {
        /// Reduced damping.
        g: f64,
        /// Reduced frequency.
        k: f64,
    },
    /// The model was made for one incidence, its wake following the stream.
    #[error(
        "the forces were computed with a wake along the stream of their own incidence and do not hold at α = {alpha_deg}°, β = {beta_deg}°; set wake.direction = \"x\" (and some sideslip where it is to vary)"
    )]
    OtherIncidence {
        /// Angle of attack, °.
        alpha_deg: f64,
        /// Sideslip, °.
        beta_deg: f64,
    },
    /// The jump equations are singular: a pole of Q.
    #[error("the wake equations are singular at g = {g}, k = {k}")]
    Singular {
        /// Reduced damping.
        g: f64,
        /// Reduced frequency.
        k: f64,
    },
}
