//! Cards of Nastran bulk data, whatever they hold.
//!
//! Small fields are 8 columns wide, large ones 16 (the card's name ends in `*`), free ones
//! stand between commas; a card goes on in lines whose first field is empty or begins with
//! `+` or `*`. What stands behind column 72, or behind `$`, is no data.

/// Width of a small field and of a tab stop.
const SMALL: usize = 8;
const LARGE: usize = 16;

/// A card with its continuations.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Card {
    /// Without `*`, in capitals.
    pub name: String,
    /// Data fields, empty where left out: whole lines of eight (large fields: four).
    pub fields: Vec<String>,
    /// Line of its name.
    pub line: usize,
}

impl Card {
    /// A data field, counted from 0; empty behind the last.
    pub fn field(&self, i: usize) -> &str {
        self.fields.get(i).map_or("", String::as_str)
    }
}

/// Puts cards together from lines.
#[derive(Debug, Default)]
pub struct Cards {
    open: Option<Card>,
}

impl Cards {
    /// Takes a line; gives the card before, where this one begins another.
    pub fn push(&mut self, line: &str, number: usize) -> Option<Card> {
        let line = line.split('$').next().unwrap_or_default().trim_end();
        if line.trim().is_empty() {
            return None;
        }
        let (name, fields) = fields(line);
        if name.is_empty() || name.starts_with(['+', '*']) {
            if let Some(card) = &mut self.open {
                card.fields.extend(fields);
            }
            return None;
        }
        self.open.replace(Card {
            name,
            fields,
            line: number,
        })
    }

    /// The last card.
    pub fn finish(&mut self) -> Option<Card> {
        self.open.take()
    }
}

/// Whether bulk data begin behind this line.
pub fn is_begin_bulk(line: &str) -> bool {
    let mut words = line.split_ascii_whitespace();
    let mut is = |word: &str| {
        words
            .next()
            .is_some_and(|found| found.eq_ignore_ascii_case(word))
    };
    is("begin") && is("bulk")
}

/// Whether bulk data end with this line.
pub fn is_end_of_data(line: &str) -> bool {
    let line = line.split('$').next().unwrap_or_default();
    // Some programs write a checksum behind it.
    let word = line.split_ascii_whitespace().next();
    word.is_some_and(|word| word.eq_ignore_ascii_case("enddata"))
}

/// Name and data fields of a line; those left out are empty.
fn fields(line: &str) -> (String, Vec<String>) {
    let name_of = |text: &str| {
        let name = text.trim().to_ascii_uppercase();
        if name.starts_with('*') {
            name
        } else {
            name.trim_end_matches('*').trim_end().to_owned()
        }
    };
    let is_large = line
        .split([',', '\t', ' '])
        .next()
        .is_some_and(|word| word.contains('*'));
    let (width, count) = if is_large { (LARGE, 4) } else { (SMALL, 8) };
    // A decimal comma in a fixed field does not make the card a free one.
    let is_free = line
        .split_once(',')
        .is_some_and(|(name, _)| !name.trim().contains(' '));
    let (name, mut data): (String, Vec<String>) = if is_free {
        let mut words = line.split(',').map(|word| word.trim().to_owned());
        let name = words.next().unwrap_or_default();
        (name_of(&name), words.take(count).collect())
    } else {
        let columns: Vec<char> = without_tabs(line).chars().collect();
        let piece = |from: usize, to: usize| -> String {
            let to = to.min(columns.len());
            columns.get(from..to).unwrap_or_default().iter().collect()
        };
        let field = |i: usize| {
            let from = SMALL + i * width;
            piece(from, from + width).trim().to_owned()
        };
        (name_of(&piece(0, SMALL)), (0..count).map(field).collect())
    };
    data.resize(count, String::new());
    (name, data)
}

/// Tabs reach to the next column that 8 divides.
fn without_tabs(line: &str) -> String {
    let mut text = String::with_capacity(line.len());
    let mut column = 0;
    for c in line.chars() {
        let count = if c == '\t' { SMALL - column % SMALL } else { 1 };
        text.extend(std::iter::repeat_n(if c == '\t' { ' ' } else { c }, count));
        column += count;
    }
    text
}

/// A number as Nastran writes it: the exponent may lack its letter, or have a D.
pub fn real(text: &str) -> Option<f64> {
    let plain = text.replace(['d', 'D'], "e");
    if let Ok(value) = plain.parse() {
        return Some(value);
    }
    let sign = plain
        .char_indices()
        .skip(1)
        .find(|(_, c)| matches!(c, '+' | '-'))?
        .0;
    format!("{}e{}", &plain[..sign], &plain[sign..])
        .parse()
        .ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_without_an_exponent_letter_are_read() {
        let read = ["1.5-3", "-2.+1", "7.D0", "4.25", "-.5E2"].map(real);
        assert_eq!(read, [1.5e-3, -20.0, 7.0, 4.25, -50.0].map(Some));
        assert_eq!(real("1..5"), None);
        assert_eq!(real(""), None);
    }

    #[test]
    fn columns_behind_72_are_no_data() {
        let mut cards = Cards::default();
        let tail = format!(
            "{:<72}{:>8}",
            "GRID           7       0     1.0     2.0     3.0", 5
        );
        assert_eq!(cards.push(&tail, 1), None);
        let card = cards.finish().unwrap();
        assert_eq!((card.field(0), card.field(4)), ("7", "3.0"));
        assert_eq!(card.fields.len(), 8);
    }
}
