//! One line of a table of measured accuracy.

/// An error beside its goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What was computed.
    pub case: String,
    /// The mesh it was computed on.
    pub mesh: String,
    /// What the error is, in words, with the measured figure where there is one.
    pub figure: String,
    /// The error.
    pub error: f64,
    /// What it may be at most; infinite for a figure given for information.
    pub goal: f64,
}

impl Row {
    /// Whether the goal is met; an error that is no number is not.
    pub fn holds(&self) -> bool {
        self.error <= self.goal
    }

    /// Cells of a Markdown table: case, mesh, figure, error, goal, verdict.
    pub fn markdown(&self) -> String {
        let verdict = match self.holds() {
            true if self.goal.is_infinite() => "",
            true => "met",
            false => "**not met**",
        };
        format!(
            "| {} | {} | {} | {} | {} | {verdict} |",
            self.case,
            self.mesh,
            self.figure,
            size(self.error, self.goal),
            size(self.goal, self.goal)
        )
    }
}

/// Prints rows and says whether all goals are met.
pub fn report(rows: &[Row]) -> bool {
    for row in rows {
        println!("{}", row.markdown());
    }
    !rows.is_empty() && rows.iter().all(Row::holds)
}

/// In per cent where the goal is a matter of per cent.
fn size(value: f64, goal: f64) -> String {
    if value.is_infinite() {
        "–".to_owned()
    } else if goal >= 1e-3 {
        format!("{:.2} %", 100.0 * value)
    } else {
        format!("{value:.1e}")
    }
}

/// How large a mesh is, for the tables.
pub fn mesh_size(mesh: &fladder_mesh::TriMesh) -> String {
    format!("{} vertices", mesh.vertices.len())
}
