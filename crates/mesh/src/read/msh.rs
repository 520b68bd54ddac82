//! Gmsh `.msh` files: sections, format line and physical names.
//!
//! Gmsh reference manual, "MSH file format". Every section starts with
//! `$Name` and ends with `$EndName`; sections not needed are skipped.

use super::cursor::{Cursor, Malformed, WRITE_AGAIN};
use super::draft::Draft;
use super::msh_elements::Gathered;
use super::{msh2, msh4};

/// Layout of the `$Nodes` and `$Elements` sections.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    Two,
    Four,
}

/// What to do about a version that is not read.
const SAVE_AS: &str = "save as version 4.1 or 2.2 (Mesh.MshFileVersion)";

pub(super) fn parse(bytes: &[u8]) -> Result<Draft, Malformed> {
    let mut cursor = Cursor::new(bytes);
    let mut file = File::default();
    while let Some(name) = section(&mut cursor)? {
        file.read_section(&mut cursor, &name)?;
        cursor.is_binary = false;
    }
    if !file.has_elements {
        return Err(cursor.fault("the file ends before the $Elements section", WRITE_AGAIN));
    }
    let mut draft = file.gathered.into_draft();
    draft.notes.extend(cursor.note_of_not_finite());
    Ok(draft)
}

/// What has been read of a file.
#[derive(Default)]
struct File {
    /// Version, and whether data sections are binary; known after $MeshFormat.
    format: Option<(Version, bool)>,
    entities: msh4::Entities,
    gathered: Gathered,
    has_elements: bool,
}

impl File {
    /// Reads a section to its end mark, its first line having been taken.
    fn read_section(&mut self, cursor: &mut Cursor, name: &str) -> Result<(), Malformed> {
        match name {
            "MeshFormat" => self.format = Some(format(cursor)?),
            "PhysicalNames" => physical_names(cursor, &mut self.gathered)?,
            "Entities" | "Nodes" | "Elements" => {
                let Some((version, is_binary)) = self.format else {
                    return Err(
                        cursor.fault(format!("${name} comes before $MeshFormat"), WRITE_AGAIN)
                    );
                };
                cursor.is_binary = is_binary;
                self.read_data(cursor, name, version)?;
            }
            "PartitionedEntities" => {
                return Err(
                    cursor.fault("the mesh is partitioned", "save it without partitions")
                );
            }
            _ if cursor.skip_past(&format!("$End{name}")) => return Ok(()),
            _ => return Err(cursor.fault(format!("$End{name} is missing"), WRITE_AGAIN)),
        }
        cursor.is_binary = false;
        end_of_section(cursor, name)
    }

    fn read_data(
        &mut self,
        cursor: &mut Cursor,
        name: &str,
        version: Version,
    ) -> Result<(), Malformed> {
        let gathered = &mut self.gathered;
        match (name, version) {
            ("Entities", _) => self.entities = msh4::entities(cursor)?,
            ("Nodes", Version::Four) => msh4::nodes(cursor, gathered)?,
            ("Nodes", Version::Two) => msh2::nodes(cursor, gathered)?,
            (_, Version::Four) => msh4::elements(cursor, gathered, &self.entities)?,
            (_, Version::Two) => {
                msh2::elements(cursor, gathered)?;
                gathered.join_repeated();
            }
        }
        self.has_elements |= name == "Elements";
        Ok(())
    }
}

/// Name of the next section; `None` at the end of the file.
fn section(cursor: &mut Cursor) -> Result<Option<String>, Malformed> {
    cursor.skip_space();
    if cursor.remaining() == 0 {
        return Ok(None);
    }
    let word = cursor.word()?;
    match word.strip_prefix('$') {
        Some("NOD" | "NOE" | "ELM") => Err(cursor.fault("this is format version 1", SAVE_AS)),
        Some(name) if !name.is_empty() && !name.starts_with("End") => {
            let name = name.to_owned();
            cursor.line();
            Ok(Some(name))
        }
        _ => {
            let shown: String = word.chars().take(40).collect();
            Err(cursor.fault(
                format!("`{shown}` stands where a section should start"),
                WRITE_AGAIN,
            ))
        }
    }
}

fn end_of_section(cursor: &mut Cursor, name: &str) -> Result<(), Malformed> {
    let word = cursor.word().unwrap_or("the end of the file");
    if word.strip_prefix("$End") == Some(name) {
        return Ok(());
    }
    let shown: String = word.chars().take(40).collect();
    Err(cursor.fault(
        format!("$End{name} should stand here, not `{shown}`"),
        WRITE_AGAIN,
    ))
}

/// `version file-type data-size`, in a binary file followed by the integer 1.
fn format(cursor: &mut Cursor) -> Result<(Version, bool), Malformed> {
    let number = cursor.word()?;
    let version = match number {
        "4.1" => Version::Four,
        "2" | "2.0" | "2.1" | "2.2" => Version::Two,
        _ => {
            let shown: String = number.chars().take(40).collect();
            return Err(cursor.fault(format!("format version `{shown}` is not read"), SAVE_AS));
        }
    };
    let is_binary = cursor.int()? != 0;
    let data_size = cursor.int()?;
    if data_size != 8 {
        return Err(cursor.fault(
            format!("numbers of {data_size} bytes are not read, only of 8"),
            "save the mesh on a 64-bit machine",
        ));
    }
    if is_binary {
        cursor.line();
        cursor.is_binary = true;
        let one = cursor.int()?;
        if one != 1 {
            return Err(cursor.fault(
                format!("the byte-order mark is {one}, not 1: the file was written in the other byte order"),
                "save the mesh as ASCII, or on a little-endian machine",
            ));
        }
    }
    Ok((version, is_binary))
}

fn physical_names(cursor: &mut Cursor, gathered: &mut Gathered) -> Result<(), Malformed> {
    let announced = cursor.size()?;
    for _ in 0..cursor.count(announced, 6, 6)? {
        let key = (cursor.int()?, cursor.int()?);
        let name = cursor.quoted()?;
        gathered.names.insert(key, name);
    }
    Ok(())
}
