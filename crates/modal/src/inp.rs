//! Geometry of CalculiX and Abaqus input: nodes, elements and sets.
//!
//! Keyword lines begin with `*`, comments with `**`, data are separated by
//! commas. An element continues on further lines until its type's node count
//! is reached. Element sets exist in this file alone, not in the results.

use crate::element::{self, ElementKind};
use crate::error::ReadError;
use crate::raw::{Geometry, RawElement};
use crate::text::{Lines, real};
use fladder_mesh::Vec3;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// `*INCLUDE` may nest this deep; deeper is a file that includes itself.
const INCLUDE_DEPTH: usize = 8;

/// A keyword line: name and parameters, both upper case, values as written.
struct Keyword {
    name: String,
    parameters: Vec<(String, String)>,
}

impl Keyword {
    fn parse(line: &str) -> Self {
        let mut parts = line.trim_start_matches('*').split(',');
        let name = parts.next().unwrap_or("").trim().to_ascii_uppercase();
        let parameters = parts
            .map(|part| {
                let (key, value) = part.split_once('=').unwrap_or((part, ""));
                (
                    key.trim().to_ascii_uppercase(),
                    value.trim().trim_matches('"').to_owned(),
                )
            })
            .collect();
        Self { name, parameters }
    }

    fn get(&self, key: &str) -> Option<&str> {
        self.parameters
            .iter()
            .find(|entry| entry.0 == key)
            .map(|entry| entry.1.as_str())
    }
}

/// What a set is of.
#[derive(Clone, Copy)]
enum Of {
    Nodes,
    Elements,
}

/// Members of a set as one entry of its data lines gives them.
enum Members {
    One(u64),
    Range { first: u64, last: u64, step: u64 },
    Set(String),
}

/// What is gathered over a file and its includes.
#[derive(Default)]
struct Reading {
    geometry: Geometry,
    members: Vec<(Of, String, Members)>,
    unknown_types: BTreeSet<String>,
}

/// Reads the geometry of an input file and the files it includes.
pub(crate) fn read(path: &Path) -> Result<Geometry, ReadError> {
    let mut reading = Reading::default();
    read_file(path, &mut reading, 0)?;
    resolve(&mut reading, path)?;
    let Reading {
        mut geometry,
        unknown_types,
        ..
    } = reading;
    for name in unknown_types {
        geometry.notes.push(format!(
            "elements of type {name} are not known here and left out"
        ));
    }
    Ok(geometry)
}

fn read_file(path: &Path, reading: &mut Reading, depth: usize) -> Result<(), ReadError> {
    let mut lines = Lines::open(path)?;
    while let Some(line) = next_data_or_keyword(&mut lines)? {
        if !line.starts_with('*') {
            continue;
        }
        let keyword = Keyword::parse(&line);
        match keyword.name.as_str() {
            "NODE" => nodes(&mut lines, &keyword, reading)?,
            "ELEMENT" => elements(&mut lines, &keyword, reading)?,
            "NSET" => set(&mut lines, &keyword, Of::Nodes, reading)?,
            "ELSET" => set(&mut lines, &keyword, Of::Elements, reading)?,
            "INSTANCE" | "SYSTEM" => {
                return Err(lines.unsupported(format!(
                    "line {}: *{} moves nodes, which is not handled; write a flat input file",
                    lines.number(),
                    keyword.name
                )));
            }
            "INCLUDE" => {
                let file = keyword.get("INPUT").unwrap_or("");
                if depth == INCLUDE_DEPTH || file.is_empty() {
                    return Err(lines.syntax("*INCLUDE without a file, or nested too deep"));
                }
                let folder = path.parent().unwrap_or(Path::new("."));
                read_file(&folder.join(file), reading, depth + 1)?;
            }
            _ => {}
        }
    }
    Ok(())
}

/// The next line that is neither blank nor a comment.
fn next_data_or_keyword(lines: &mut Lines) -> Result<Option<String>, ReadError> {
    while let Some(line) = lines.next_line()? {
        let line = line.trim();
        if !line.is_empty() && !line.starts_with("**") {
            return Ok(Some(line.to_owned()));
        }
    }
    Ok(None)
}

/// The next data line; `None`, and the keyword left to the caller, otherwise.
fn next_data(lines: &mut Lines) -> Result<Option<String>, ReadError> {
    let line = next_data_or_keyword(lines)?;
    match line {
        Some(line) if line.starts_with('*') => {
            lines.step_back();
            Ok(None)
        }
        other => Ok(other),
    }
}

fn nodes(lines: &mut Lines, keyword: &Keyword, reading: &mut Reading) -> Result<(), ReadError> {
    if keyword
        .get("SYSTEM")
        .is_some_and(|system| !system.eq_ignore_ascii_case("R"))
    {
        return Err(lines.unsupported("*NODE in cylindrical or spherical axes is not handled"));
    }
    let set = keyword.get("NSET").map(str::to_owned);
    while let Some(line) = next_data(lines)? {
        let mut words = line.split(',');
        let id = number(lines, words.next().unwrap_or(""))?;
        let mut position = Vec3::zeros();
        for (axis, word) in words
            .take(3)
            .enumerate()
            .filter(|part| !part.1.trim().is_empty())
        {
            let bad = || lines.syntax(format!("{:?} is no finite coordinate", word.trim()));
            position[axis] = real(word).ok_or_else(bad)?;
        }
        if reading
            .geometry
            .nodes
            .insert(id, position)
            .is_some_and(|old| old != position)
        {
            return Err(lines.syntax(format!("node {id} is given at two positions")));
        }
        if let Some(set) = &set {
            reading
                .members
                .push((Of::Nodes, set.clone(), Members::One(id)));
        }
    }
    Ok(())
}

fn elements(
    lines: &mut Lines,
    keyword: &Keyword,
    reading: &mut Reading,
) -> Result<(), ReadError> {
    let type_name = keyword.get("TYPE").unwrap_or("").to_owned();
    let kind = element::of_input_type(&type_name);
    if kind.is_none() {
        reading.unknown_types.insert(type_name);
    }
    let set = keyword.get("ELSET").map(str::to_owned);
    while let Some(line) = next_data(lines)? {
        let Some(kind) = kind else { continue };
        let element = one_element(lines, &line, kind)?;
        if let Some(set) = &set {
            reading
                .members
                .push((Of::Elements, set.clone(), Members::One(element.id)));
        }
        reading.geometry.elements.push(element);
    }
    Ok(())
}

fn one_element(
    lines: &mut Lines,
    first: &str,
    kind: ElementKind,
) -> Result<RawElement, ReadError> {
    let mut numbers = numbers(lines, first)?;
    let wanted = kind.node_count() + 1;
    while numbers.len() < wanted {
        let missing = numbers.first().map_or(0, |id| *id);
        let Some(line) = next_data(lines)? else {
            return Err(lines.syntax(format!(
                "element {missing} has {} nodes and needs {}",
                numbers.len().saturating_sub(1),
                wanted - 1
            )));
        };
        numbers.extend(self::numbers(lines, &line)?);
    }
    if numbers.len() > wanted {
        return Err(lines.syntax(format!(
            "element {} has {} nodes and needs {}",
            numbers[0],
            numbers.len() - 1,
            wanted - 1
        )));
    }
    let nodes = numbers.split_off(1);
    Ok(RawElement {
        id: numbers[0],
        kind,
        nodes,
    })
}

fn set(
    lines: &mut Lines,
    keyword: &Keyword,
    of: Of,
    reading: &mut Reading,
) -> Result<(), ReadError> {
    let name = keyword.get(&keyword.name).filter(|name| !name.is_empty());
    let Some(name) = name.map(str::to_owned) else {
        return Err(lines.syntax(format!("*{} without a name", keyword.name)));
    };
    let generate = keyword.get("GENERATE").is_some();
    while let Some(line) = next_data(lines)? {
        if generate {
            let [first, last, step] = range(lines, &line)?;
            reading
                .members
                .push((of, name.clone(), Members::Range { first, last, step }));
            continue;
        }
        for word in line
            .split(',')
            .map(str::trim)
            .filter(|word| !word.is_empty())
        {
            let member = match word.parse() {
                Ok(id) => Members::One(id),
                Err(_) => Members::Set(word.to_owned()),
            };
            reading.members.push((of, name.clone(), member));
        }
    }
    Ok(())
}

fn range(lines: &Lines, line: &str) -> Result<[u64; 3], ReadError> {
    match numbers(lines, line)?[..] {
        [first, last] => Ok([first, last, 1]),
        [first, last, step] if step > 0 => Ok([first, last, step]),
        _ => Err(lines.syntax("GENERATE needs a first number, a last one and a step")),
    }
}

/// Sets by name; names do not depend on case in these files.
#[derive(Default)]
struct SetTable {
    /// Name as first written, and members, by upper-case name.
    sets: BTreeMap<String, (String, BTreeSet<u64>)>,
}

impl SetTable {
    fn add(&mut self, name: &str, ids: impl IntoIterator<Item = u64>) {
        let entry = self.sets.entry(name.to_ascii_uppercase());
        entry
            .or_insert_with(|| (name.to_owned(), BTreeSet::new()))
            .1
            .extend(ids);
    }

    fn members(&self, name: &str) -> Option<Vec<u64>> {
        let entry = self.sets.get(&name.to_ascii_uppercase());
        entry.map(|entry| entry.1.iter().copied().collect())
    }

    fn named(self) -> BTreeMap<String, Vec<u64>> {
        self.sets
            .into_values()
            .map(|(name, ids)| (name, ids.into_iter().collect()))
            .collect()
    }
}

/// Fills the sets once all nodes and elements are known: a `GENERATE` range
/// holds those of its numbers that exist, whatever its length.
fn resolve(reading: &mut Reading, file: &Path) -> Result<(), ReadError> {
    let elements: BTreeSet<u64> = reading.geometry.elements.iter().map(|e| e.id).collect();
    let (mut node_sets, mut element_sets) = (SetTable::default(), SetTable::default());
    for (of, name, members) in std::mem::take(&mut reading.members) {
        let sets = match of {
            Of::Nodes => &mut node_sets,
            Of::Elements => &mut element_sets,
        };
        match members {
            Members::One(id) => sets.add(&name, [id]),
            Members::Range { first, last, step } if first <= last => {
                let inside = |id: &u64| (id - first).is_multiple_of(step);
                match of {
                    Of::Nodes => {
                        let nodes = reading.geometry.nodes.range(first..=last);
                        sets.add(&name, nodes.map(|node| *node.0).filter(inside));
                    }
                    Of::Elements => {
                        sets.add(&name, elements.range(first..=last).copied().filter(inside));
                    }
                }
            }
            Members::Range { .. } => sets.add(&name, []),
            Members::Set(other) => {
                let ids = sets.members(&other).ok_or_else(|| ReadError::Mismatch {
                    file: file.display().to_string(),
                    message: format!(
                        "set {name} refers to {other}, which is not defined before"
                    ),
                })?;
                sets.add(&name, ids);
            }
        }
    }
    reading.geometry.node_sets = node_sets.named();
    reading.geometry.element_sets = element_sets.named();
    Ok(())
}

fn number(lines: &Lines, text: &str) -> Result<u64, ReadError> {
    let text = text.trim();
    text.parse()
        .map_err(|_| lines.syntax(format!("{text:?} is no node or element number")))
}

fn numbers(lines: &Lines, line: &str) -> Result<Vec<u64>, ReadError> {
    line.split(',')
        .map(str::trim)
        .filter(|word| !word.is_empty())
        .map(|word| number(lines, word))
        .collect()
}
