//! Tables with aligned columns.

/// Side on which a column is flush.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Align {
    Left,
    Right,
}

/// Rows of text under headings.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    columns: Vec<(String, Align)>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// Headings with the side of each column.
    pub(crate) fn new(columns: &[(&str, Align)]) -> Self {
        let columns = columns
            .iter()
            .map(|(name, align)| ((*name).to_owned(), *align))
            .collect();
        Self {
            columns,
            rows: Vec::new(),
        }
    }

    /// Adds a row; missing cells stay empty.
    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The text, two spaces before each column.
    pub(crate) fn text(&self) -> String {
        let width = |column: usize| {
            let cells = self.rows.iter().filter_map(|row| row.get(column));
            let longest = cells.map(|cell| cell.chars().count()).max().unwrap_or(0);
            longest.max(self.columns[column].0.chars().count())
        };
        let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
        let line = |cells: &[String]| {
            let mut text = String::new();
            for ((cell, width), (_, align)) in cells.iter().zip(&widths).zip(&self.columns) {
                let padding = " ".repeat(width.saturating_sub(cell.chars().count()));
                text.push_str("  ");
                match align {
                    Align::Left => text.extend([cell.as_str(), padding.as_str()]),
                    Align::Right => text.extend([padding.as_str(), cell.as_str()]),
                }
            }
            text.truncate(text.trim_end().len());
            text.push('\n');
            text
        };
        let heading: Vec<String> = self.columns.iter().map(|column| column.0.clone()).collect();
        let mut text = line(&heading);
        self.rows.iter().for_each(|row| text.push_str(&line(row)));
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned() {
        let mut table = Table::new(&[("mode", Align::Left), ("f [Hz]", Align::Right)]);
        table.row(["elastic:1".to_owned(), "7.73".to_owned()]);
        table.row(["a".to_owned(), "110.00".to_owned()]);
        assert_eq!(
            table.text(),
            "  mode       f [Hz]\n  elastic:1    7.73\n  a          110.00\n"
        );
    }
}
