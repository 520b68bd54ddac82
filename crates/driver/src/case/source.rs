//! The text of a case file with the overrides of the command line in it, and
//! the place every key came from.

use super::keys::{KEYS, is_known};
use super::suggest::nearest;
use crate::failure::Failure;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Where each key stands.
#[derive(Clone, Debug, Default)]
pub struct Places {
    file: PathBuf,
    line_starts: Vec<usize>,
    length: usize,
    overrides: Vec<String>,
    keys: BTreeMap<String, usize>,
}

impl Places {
    fn new(file: &Path, text: &str, overrides: &[String]) -> Self {
        let starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1));
        Self {
            file: file.to_owned(),
            line_starts: starts.collect(),
            length: text.len(),
            overrides: overrides.to_vec(),
            keys: BTreeMap::new(),
        }
    }

    /// `file:line` of a key, of the table it should be in, or the file.
    pub fn of(&self, key: &str) -> String {
        let mut path = key;
        loop {
            if let Some(position) = self.keys.get(path) {
                return self.of_position(*position);
            }
            match path.rsplit_once('.') {
                Some((table, _)) => path = table,
                None => return self.file.display().to_string(),
            }
        }
    }

    /// Whether the key was given.
    pub fn has(&self, key: &str) -> bool {
        self.keys.contains_key(key)
    }

    /// Positions past the end of the text stand for the overrides in order.
    fn of_position(&self, position: usize) -> String {
        if let Some(number) = position.checked_sub(self.override_position(0)) {
            let given = self.overrides.get(number).map_or("", String::as_str);
            return format!("--set {given}");
        }
        let line = self.line_starts.partition_point(|start| *start <= position);
        format!("{}:{line}", self.file.display())
    }

    fn override_position(&self, number: usize) -> usize {
        self.length + 1 + number
    }

    /// The case file.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// What was given by `--set`, in order.
    pub fn overrides(&self) -> &[String] {
        &self.overrides
    }
}

/// Parses a case file, puts the overrides in and refuses unknown keys.
///
/// Values from overrides carry positions past the end of the text, so that a
/// later fault in one of them is told from a fault in the file.
pub(crate) fn parse<'t>(
    file: &Path,
    text: &'t str,
    overrides: &'t [String],
) -> Result<(Spanned<DeTable<'t>>, Places), Failure> {
    let mut places = Places::new(file, text, overrides);
    let mut root = DeTable::parse(text).map_err(|error| syntax(&error, &places))?;
    for (number, given) in overrides.iter().enumerate() {
        let at = places.override_position(number);
        let (key, value) = split_override(given)?;
        insert(root.get_mut(), &key, at_position(value, at), at)
            .map_err(|table| not_a_table(table, given))?;
    }
    let mut unknown = Vec::new();
    walk(root.get_ref(), "", "", &mut places.keys, &mut unknown);
    if unknown.is_empty() {
        Ok((root, places))
    } else {
        Err(unknown_keys(&unknown, &places))
    }
}

fn syntax(error: &toml::de::Error, places: &Places) -> Failure {
    let position = error.span().map_or(0, |span| span.start);
    Failure::input(
        format!("this is no valid TOML: {}", error.message()),
        places.of_position(position),
        "the case cannot be read past this place",
        "correct the line; strings need quotes, lists need brackets and commas",
    )
}

/// Turns a fault found while the values were read into a message.
pub(crate) fn wrong_value(error: &toml::de::Error, places: &Places) -> Failure {
    let position = error.span().map_or(0, |span| span.start);
    let message = in_words(error.message().trim_end());
    let (why, remedy) = if message.starts_with("missing field") {
        (
            "this key has no default that could be right",
            "add the key to this table",
        )
    } else {
        (
            "the value would have no meaning",
            "give a value of the kind that is named",
        )
    };
    Failure::input(message, places.of_position(position), why, remedy)
}

/// Names of types in the words of the case file.
fn in_words(message: &str) -> String {
    const WORDS: [(&str, &str); 5] = [
        ("expected f64", "expected a number"),
        ("expected usize", "expected a whole number of at least 0"),
        ("expected u32", "expected a whole number of at least 0"),
        ("expected a sequence", "expected a list"),
        ("expected a map", "expected a table"),
    ];
    let replace = |text: String, (code, word): &(&str, &str)| text.replace(code, word);
    WORDS.iter().fold(message.to_owned(), replace)
}

/// `key=value` with the value as TOML, or as a bare string.
fn split_override(given: &str) -> Result<(Vec<&str>, DeValue<'_>), Failure> {
    let no_key = || {
        Failure::input(
            format!("`{given}` is no `key=value`"),
            format!("--set {given}"),
            "nothing can be overridden without a key and a value",
            "write for example --set flow.alpha_deg=2",
        )
    };
    let (key, text) = given.split_once('=').ok_or_else(no_key)?;
    let path: Vec<&str> = key.split('.').map(str::trim).collect();
    if path.iter().any(|word| word.is_empty()) {
        return Err(no_key());
    }
    let text = text.trim();
    let bare = |_| DeValue::String(Cow::Borrowed(text));
    Ok((
        path,
        DeValue::parse(text).map_or_else(bare, Spanned::into_inner),
    ))
}

/// The value with all positions inside moved to one place.
fn at_position(value: DeValue<'_>, at: usize) -> Spanned<DeValue<'_>> {
    let moved = match value {
        DeValue::Array(array) => DeValue::Array(
            array
                .into_iter()
                .map(|element| at_position(element.into_inner(), at))
                .collect(),
        ),
        DeValue::Table(table) => DeValue::Table(
            table
                .into_iter()
                .map(|(key, element)| {
                    let key = Spanned::new(at..at, key.into_inner());
                    (key, at_position(element.into_inner(), at))
                })
                .collect(),
        ),
        plain => plain,
    };
    Spanned::new(at..at, moved)
}

/// Puts a value at a dotted path, making the tables on the way.
///
/// A number as a word picks an element of an array. The error is the word
/// that is neither a table nor an array.
fn insert<'t>(
    table: &mut DeTable<'t>,
    path: &[&'t str],
    value: Spanned<DeValue<'t>>,
    at: usize,
) -> Result<(), &'t str> {
    let [word, rest @ ..] = path else {
        return Ok(());
    };
    if rest.is_empty() {
        table.remove(*word);
        table.insert(Spanned::new(at..at, Cow::Borrowed(*word)), value);
        return Ok(());
    }
    let next = table
        .entry(Spanned::new(at..at, Cow::Borrowed(*word)))
        .or_insert_with(|| Spanned::new(at..at, DeValue::Table(DeTable::new())));
    match (next.get_mut(), rest) {
        (DeValue::Table(inner), _) => insert(inner, rest, value, at),
        (DeValue::Array(array), [index, rest @ ..]) => {
            let element = index
                .parse()
                .ok()
                .and_then(|index: usize| array.get_mut(index));
            match element.map(Spanned::get_mut) {
                Some(DeValue::Table(inner)) if !rest.is_empty() => {
                    insert(inner, rest, value, at)
                }
                Some(element) if rest.is_empty() => {
                    *element = value.into_inner();
                    Ok(())
                }
                _ => Err(index),
            }
        }
        _ => Err(word),
    }
}

fn not_a_table(word: &str, given: &str) -> Failure {
    Failure::input(
        format!("`{word}` holds no further keys here"),
        format!("--set {given}"),
        "the override has no place to go to",
        "give the key as in the case file: tables and keys with dots between them, \
         elements of a list by their number from 0",
    )
}

/// Collects the position of every key, and the unknown ones.
///
/// `path` is the concrete path, `pattern` the same with `[]` for the numbers
/// of array elements.
fn walk(
    table: &DeTable<'_>,
    path: &str,
    pattern: &str,
    positions: &mut BTreeMap<String, usize>,
    unknown: &mut Vec<String>,
) {
    for (key, value) in table {
        let path = join(path, key.get_ref());
        let pattern = join(pattern, key.get_ref());
        positions.insert(path.clone(), key.span().start);
        if !is_known(&pattern) {
            unknown.push(path);
            continue;
        }
        match value.get_ref() {
            DeValue::Table(inner) => walk(inner, &path, &pattern, positions, unknown),
            DeValue::Array(array) => {
                for (number, element) in array.iter().enumerate() {
                    let path = format!("{path}.{number}");
                    positions.insert(path.clone(), element.span().start);
                    if let DeValue::Table(inner) = element.get_ref() {
                        walk(inner, &path, &format!("{pattern}[]"), positions, unknown);
                    }
                }
            }
            _ => {}
        }
    }
}

fn join(table: &str, key: &str) -> String {
    if table.is_empty() {
        key.to_owned()
    } else {
        format!("{table}.{key}")
    }
}

fn unknown_keys(unknown: &[String], places: &Places) -> Failure {
    let shown = unknown
        .iter()
        .map(|key| format!("`{key}`"))
        .collect::<Vec<_>>()
        .join(", ");
    let (keys, are) = if unknown.len() == 1 {
        ("key", "is")
    } else {
        ("keys", "are")
    };
    let where_each: Vec<String> = unknown.iter().map(|key| places.of(key)).collect();
    let remedies: Vec<String> = unknown
        .iter()
        .map(|key| {
            let near = nearest(key, KEYS).unwrap_or("title");
            format!("for `{key}`, did you mean `{near}`?")
        })
        .collect();
    Failure::input(
        format!("the {keys} {shown} {are} unknown"),
        where_each.join("\n"),
        "a key that is not understood would silently leave the default in force",
        remedies.join("\n"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn failure(text: &str, overrides: &[&str]) -> Failure {
        let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
        parse(Path::new("case.toml"), text, &overrides).expect_err("there is a fault")
    }

    #[test]
    fn a_misspelt_key_is_named_with_its_line_and_the_nearest_key() {
        let failure = failure("title = \"x\"\n[flow]\nalfa_deg = 2.0\n", &[]);
        assert_eq!(failure.place, "case.toml:3");
        assert!(failure.remedy.contains("`flow.alpha_deg`"), "{failure}");
    }

    #[test]
    fn every_unknown_key_is_named_at_once() {
        let failure = failure("[flow]\nmach_number = 0\n[wakes]\nmode = \"auto\"\n", &[]);
        assert_eq!(failure.place, "case.toml:2\ncase.toml:3");
        assert!(failure.remedy.contains("`flow.mach`"), "{failure}");
    }

    #[test]
    fn an_unknown_override_is_named_as_given() {
        let failure = failure("[flow]\n", &["flow.alpha=2"]);
        assert_eq!(failure.place, "--set flow.alpha=2");
        assert!(failure.remedy.contains("`flow.alpha_deg`"), "{failure}");
    }

    #[test]
    fn overrides_take_toml_values_and_bare_strings_and_reach_into_arrays() {
        let text = "[[modes.analytic]]\nname = \"a\"\n";
        let overrides: Vec<String> = [
            "gaf.g=[0.0, 0.1]",
            "wake.mode=none",
            "modes.analytic.0.name=b",
        ]
        .map(String::from)
        .to_vec();
        let (root, places) = parse(Path::new("case.toml"), text, &overrides).unwrap();
        let read: toml::Table =
            serde::Deserialize::deserialize(toml::de::Deserializer::from(root)).unwrap();
        assert_eq!(read["wake"]["mode"].as_str(), Some("none"));
        assert_eq!(read["modes"]["analytic"][0]["name"].as_str(), Some("b"));
        assert_eq!(read["gaf"]["g"].as_array().unwrap().len(), 2);
        assert_eq!(places.of("wake.mode"), "--set wake.mode=none");
        assert_eq!(places.of("modes.analytic.0.translation"), "case.toml:1");
    }

    #[test]
    fn broken_syntax_is_placed() {
        assert_eq!(failure("title = \"a\"\n[flow\n", &[]).place, "case.toml:2");
    }
}
