//! Files of the chapter: pictures, CSV, page, and its parts in the manual.

use std::fmt::Write as _;
use std::path::Path;

use fladder::study::Study;

use super::PaperError;
use super::compare::Row;
use super::incidence::Claims;
use super::words::{Table, escape, number};
use crate::marked::replaced;

/// All that was computed.
pub(super) struct Chapter {
    pub(super) conditions: String,
    figures: Vec<(String, String)>,
    pub(super) rows: Vec<Row>,
    /// Entry of figure 1 and the largest error of its fit.
    pub(super) fit: (String, f64),
    pub(super) claims: Claims,
    pub(super) crossings: Table,
    pub(super) dutch: Table,
    pub(super) variants: Table,
    pub(super) longitudinal: Table,
    pub(super) cost: Table,
}

/// Figures that the manual shows.
const SHOWN: [&str; 4] = ["figure_01", "figure_08", "figure_09", "figure_10"];

impl Chapter {
    pub(super) fn new(study: &Study) -> Self {
        let case = &study.file().case;
        Self {
            conditions: format!(
                "{} triangles, density {} kg/m³, semichord {} m, level flight at every speed",
                study.mesh().triangles.len(),
                case.flow.density.unwrap_or(f64::NAN),
                case.reference.semichord
            ),
            figures: Vec::new(),
            rows: Vec::new(),
            fit: (String::new(), f64::NAN),
            claims: Claims::default(),
            crossings: Table::default(),
            dutch: Table::default(),
            variants: Table::default(),
            longitudinal: Table::default(),
            cost: Table::default(),
        }
    }

    pub(super) fn figure(&mut self, name: &str, picture: String) {
        self.figures.push((name.to_owned(), picture));
    }

    /// Quantity, paper, here, ratio, verdict.
    pub(super) fn comparison(&self) -> Table {
        let mut table = Table::new(&["quantity", "paper", "here", "ratio", "verdict"]);
        for row in &self.rows {
            table.push(row.cells());
        }
        table
    }

    /// The same with source and cause.
    fn comparison_with_causes(&self) -> Table {
        let mut table = Table::new(&[
            "quantity", "paper", "here", "ratio", "verdict", "cause", "source",
        ]);
        for row in &self.rows {
            let more = [row.why.clone(), row.source.clone()];
            table.push(row.cells().into_iter().chain(more));
        }
        table
    }

    /// What the paper says of figures 1 and 10, measured.
    fn claims(&self) -> Table {
        let mut table = Table::new(&["claim", "measured"]);
        let percent = |part: f64| format!("{} %", number(100.0 * part));
        let claims = &self.claims;
        for [claim, measured] in [
            [
                format!(
                    "figure 1: the fit between samples, part of the largest value of Q({0}, {0})",
                    self.fit.0
                ),
                format!("differs by up to {}", percent(self.fit.1)),
            ],
            [
                "figure 10: the shift of rigid columns y and z is in phase with β and α"
                    .to_owned(),
                format!(
                    "out of phase: up to {} of the shift",
                    percent(claims.out_of_phase)
                ),
            ],
            [
                "figure 10: it is constant over k".to_owned(),
                format!("changes by up to {} of the shift", percent(claims.drift)),
            ],
            [
                "figure 10: it is in rigid columns only".to_owned(),
                format!(
                    "no: column {} changes by up to {}",
                    claims.elastic.1,
                    percent(claims.elastic.0)
                ),
            ],
        ] {
            table.push([claim, measured]);
        }
        table
    }

    /// Pictures, tables and the page.
    pub(super) fn write(&self, folder: &Path) -> Result<(), PaperError> {
        for (name, picture) in &self.figures {
            write(&folder.join(format!("{name}.svg")), picture)?;
        }
        for (name, table) in [
            ("table_1.csv", &self.dutch),
            ("table_2.csv", &self.longitudinal),
            ("cost.csv", &self.cost),
            ("crossings.csv", &self.crossings),
            ("variants.csv", &self.variants),
            ("claims.csv", &self.claims()),
            ("comparison.csv", &self.comparison_with_causes()),
        ] {
            write(&folder.join(name), table.csv())?;
        }
        write(&folder.join("paper.html"), self.page())
    }

    fn page(&self) -> String {
        let mut text = format!(
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width\">\n\
             <title>IFASD-2009-119, section 5</title>\n<style>{STYLE}</style></head><body>\n\
             <h1>IFASD-2009-119, section 5, with the ScanEagle-like aircraft</h1>\n<p>{}</p>\n",
            escape(&self.conditions)
        );
        let mut part = |title: &str, content: &str| {
            // Writing to a string cannot fail.
            let _ = write!(text, "<h2>{}</h2>\n{content}", escape(title));
        };
        part(
            "The paper beside ours",
            &self.comparison_with_causes().html(),
        );
        part("Claims", &self.claims().html());
        part("Crossings into growth", &self.crossings.html());
        part("Table 1", &self.dutch.html());
        part("Changed aircraft", &self.variants.html());
        part("Table 2", &self.longitudinal.html());
        part("Cost, section 5.4", &self.cost.html());
        for (name, _) in &self.figures {
            let title = name.replace('_', " ");
            let picture = format!("<img src=\"{name}.svg\" alt=\"{title}\">\n");
            part(&title, &picture);
        }
        text + "</body></html>\n"
    }

    /// Marked parts of the chapter, and the pictures it shows.
    pub(super) fn document(&self, docs: &Path) -> Result<(), PaperError> {
        let path = docs.join("paper.md");
        let mut text = std::fs::read_to_string(&path).map_err(|source| PaperError::File {
            path: path.clone(),
            source,
        })?;
        let causes = {
            let mut table =
                Table::new(&["quantity", "paper", "here", "ratio", "verdict", "cause"]);
            for row in &self.rows {
                table.push(row.cells().into_iter().chain([row.why.clone()]));
            }
            table
        };
        for (mark, table) in [
            ("comparison", &causes),
            ("claims", &self.claims()),
            ("crossings", &self.crossings),
            ("table 1", &self.dutch),
            ("variants", &self.variants),
            ("table 2", &self.longitudinal),
            ("cost", &self.cost),
        ] {
            text = replaced(&text, mark, &table.markdown());
        }
        text = replaced(&text, "conditions", &format!("{}.\n", self.conditions));
        write(&path, text)?;
        for (name, picture) in &self.figures {
            if SHOWN.contains(&name.as_str()) {
                write(&docs.join(format!("images/paper_{name}.svg")), picture)?;
            }
        }
        Ok(())
    }
}

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:1000px;margin:auto;padding:1em}\
    img{max-width:100%}table{border-collapse:collapse;display:block;overflow-x:auto}\
    td,th{border-bottom:1px solid #ccc;padding:.2em .7em;text-align:left;vertical-align:top}";

/// A folder with all above it.
pub(super) fn make(folder: &Path) -> Result<(), PaperError> {
    std::fs::create_dir_all(folder).map_err(|source| PaperError::File {
        path: folder.to_owned(),
        source,
    })
}

pub(super) fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<(), PaperError> {
    std::fs::write(path, content).map_err(|source| PaperError::File {
        path: path.to_owned(),
        source,
    })
}
