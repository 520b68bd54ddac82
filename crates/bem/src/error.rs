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
    /// The iteration does not come to an end.
    #[error(
        "the iteration left {residual:.1e} of a right-hand side after {steps} steps: the surface is hardly closed or has parts thinner than its triangles; look at it with `fladder check`, or set gaf.solver = \"dense\""
    )]
    NotConverged {
        /// Residual, of the right-hand side.
        residual: f64,
        /// Steps done.
        steps: usize,
    },
    /// Exact change of shape with the hierarchical solver.
    #[error(
        "exact elastic columns assemble the equations of every deformed surface in full; set gaf.solver = \"dense\", or keep structure.shape_change = \"attached\""
    )]
    ShapeChangeHierarchical,
    /// Exact change of shape with antisymmetric motion of a half model.
    #[error(
        "exact elastic columns deform the surface, and an antisymmetrically deformed half is no half of a symmetric surface; mesh the whole aircraft or keep structure.shape_change = \"attached\""
    )]
    ShapeChangeOnHalf,
    /// Sides that do not match, closer than the mesh resolves.
    #[error(
        "{percent:.0} % of the surface has an opposite side that does not match closer than {ratio} of the triangles' own size (triangle {triangle}: {distance:.2e} m): the lift would be wrong by half of itself and more; refine the mesh, make the part thicker, or mesh both sides alike"
    )]
    TooThin {
        /// Part of the surface, %.
        percent: f64,
        /// Ratio of thickness to the triangle's size.
        ratio: f64,
        /// The thinnest triangle.
        triangle: usize,
        /// Its distance from the other side, m.
        distance: f64,
    },
    /// Triangles longer than half a wave.
    #[error(
        "at |p| = {largest} triangle {triangle}, {length:.4} m long in the stream, sees {phase:.2} rad of the wave that motion leaves, more than half a wave: the forces would be meaningless; refine the mesh or lower the largest k"
    )]
    PhasePerPanel {
        /// Largest |p| asked for.
        largest: f64,
        /// Mesh triangle.
        triangle: usize,
        /// Its extent along the stream, m.
        length: f64,
        /// Phase across it, rad.
        phase: f64,
    },
    /// Sideslip on a half model.
    #[error(
        "a half model has its stream in the plane of symmetry, but β = {beta_deg}°; mesh the whole aircraft for sideslip"
    )]
    SideslipOnHalf {
        /// Sideslip, °.
        beta_deg: f64,
    },
    /// The trailing edges at a vertex do not divide its triangles into as many sides.
    #[error(
        "the {edges} edges along which the potential jumps at trailing-edge vertex {vertex} (at {x:.4}, {y:.4}, {z:.4} m) divide its triangles into {groups} parts, so the wake jump has no meaning there; two surfaces that touch in one vertex must be separated, or the edges named by curve groups"
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
        /// Edges that meet there.
        edges: usize,
        /// Parts found.
        groups: usize,
    },
    /// The body line could not be followed downstream.
    #[error(
        "no line of mesh edges runs downstream along the body from the junction at vertex {junction} (at {x:.4}, {y:.4}, {z:.4} m); name one by wake.body_lines, or refine the mesh there"
    )]
    PathNotFound {
        /// Vertex where the trailing edge ends on the body.
        junction: u32,
        /// Position.
        x: f64,
        /// Position.
        y: f64,
        /// Position.
        z: f64,
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
        "the triangles at vertex {vertex} (at {x:.4}, {y:.4}, {z:.4} m) of the wake's line along the body have no upper and lower side: the surface is open or touches itself there; name another line by wake.body_lines"
    )]
    PathFan {
        /// Mesh vertex.
        vertex: u32,
        /// Position.
        x: f64,
        /// Position.
        y: f64,
        /// Position.
        z: f64,
    },
    /// A sheet of the wake enters a body.
    #[error(
        "the wake of trailing edge {edge} strikes the body: the sheet that starts at vertex {start} ({:.4}, {:.4}, {:.4} m) enters triangle {triangle} at ({:.4}, {:.4}, {:.4}) m; lead it past by wake.direction or another incidence, or move the surfaces apart", from[0], from[1], from[2], at[0], at[1], at[2]
    )]
    WakeStrikes {
        /// Number of the trailing edge.
        edge: usize,
        /// Mesh vertex where a streamline at the cut starts.
        start: u32,
        /// Its position, m.
        from: [f64; 3],
        /// Triangle of the mesh.
        triangle: u32,
        /// Where it is struck, m.
        at: [f64; 3],
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
