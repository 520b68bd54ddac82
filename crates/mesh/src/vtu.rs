//! Pictures of grids and fields for ParaView: `.vtu` files and `.pvd` lists of them.
//!
//! VTK file formats, "XML file formats": an `UnstructuredGrid` with its arrays
//! appended raw, little-endian, each behind its length as `UInt64`. Cells are
//! triangles first, lines after them.

use std::fmt::Write as _;
use std::io::{self, Write};

use crate::Vec3;

/// VTK's number for a straight line of two points.
const LINE: u8 = 3;
/// VTK's number for a triangle of three points.
const TRIANGLE: u8 = 5;

/// One value a point or a cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Whole numbers, for example of groups.
    Integers(Vec<i32>),
    /// Scalars.
    Scalars(Vec<f64>),
    /// Vectors in mesh axes.
    Vectors(Vec<Vec3>),
}

/// A named field.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Name in the list of the viewer; one of its kind in a grid.
    pub name: String,
    /// The values, in the order of points or cells.
    pub values: Values,
}

impl Field {
    /// A field of whole numbers.
    pub fn integers(name: impl Into<String>, values: Vec<i32>) -> Self {
        Self {
            name: name.into(),
            values: Values::Integers(values),
        }
    }

    /// A field of scalars.
    pub fn scalars(name: impl Into<String>, values: Vec<f64>) -> Self {
        Self {
            name: name.into(),
            values: Values::Scalars(values),
        }
    }

    /// A field of vectors.
    pub fn vectors(name: impl Into<String>, values: Vec<Vec3>) -> Self {
        Self {
            name: name.into(),
            values: Values::Vectors(values),
        }
    }

    fn len(&self) -> usize {
        match &self.values {
            Values::Integers(values) => values.len(),
            Values::Scalars(values) => values.len(),
            Values::Vectors(values) => values.len(),
        }
    }

    fn array(&self) -> Array<'_> {
        match &self.values {
            Values::Integers(values) => Array::integers(&self.name, values),
            Values::Scalars(values) => {
                Array::floats(&self.name, 1, values.len(), values.iter().copied())
            }
            Values::Vectors(values) => Array::vectors(&self.name, values),
        }
    }
}

/// Points, triangles and lines with fields on them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grid<'a> {
    /// Positions, metres.
    pub points: &'a [Vec3],
    /// Cells of three points.
    pub triangles: &'a [[u32; 3]],
    /// Cells of two points, after the triangles.
    pub lines: &'a [[u32; 2]],
    /// One value a point.
    pub point_data: Vec<Field>,
    /// One value a cell: those of the triangles, then those of the lines.
    pub cell_data: Vec<Field>,
}

impl Grid<'_> {
    fn n_cells(&self) -> usize {
        self.triangles.len() + self.lines.len()
    }

    /// Fields must fit, names differ, cells have points: viewers crash on less.
    fn check(&self) -> io::Result<()> {
        for (fields, count, what) in [
            (&self.point_data, self.points.len(), "points"),
            (&self.cell_data, self.n_cells(), "cells"),
        ] {
            for (i, field) in fields.iter().enumerate() {
                if field.len() != count {
                    return Err(invalid(format!(
                        "field `{}` has {} values for {count} {what}",
                        field.name,
                        field.len()
                    )));
                }
                if fields[..i].iter().any(|other| other.name == field.name) {
                    return Err(invalid(format!("two fields are named `{}`", field.name)));
                }
            }
        }
        let corners = self.triangles.as_flattened().iter();
        let mut corners = corners.chain(self.lines.as_flattened());
        match corners.find(|&&v| v as usize >= self.points.len()) {
            Some(v) => Err(invalid(format!(
                "a cell names point {v}, which is not there"
            ))),
            None => Ok(()),
        }
    }
}

fn invalid(what: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, what)
}

/// Writes a grid; every number is written with all of its bits.
///
/// # Errors
/// Those of the writer; [`io::ErrorKind::InvalidInput`] for fields that do not
/// fit the grid, names that occur twice, and cells of points that are not there.
pub fn vtu(mut out: impl Write, grid: &Grid<'_>) -> io::Result<()> {
    grid.check()?;
    let cells = cell_arrays(grid);
    let points = Array::vectors("points", grid.points);
    let mut appended = Appended::default();
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<UnstructuredGrid>\n",
    );
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">",
        grid.points.len(),
        grid.n_cells()
    );
    text.push_str(&appended.section("PointData", grid.point_data.iter().map(Field::array)));
    text.push_str(&appended.section("CellData", grid.cell_data.iter().map(Field::array)));
    text.push_str(&appended.section("Points", [points].into_iter()));
    text.push_str(&appended.section("Cells", cells.into_iter()));
    text.push_str("</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    out.write_all(text.as_bytes())?;
    out.write_all(&appended.bytes)?;
    out.write_all(b"\n</AppendedData>\n</VTKFile>\n")?;
    out.flush()
}

/// Writes a list of files, each with the number a viewer shows it at: a time, a
/// mode, a reduced frequency. File names count from the folder of the list.
///
/// # Errors
/// Those of the writer.
pub fn pvd<N: AsRef<str>>(mut out: impl Write, files: &[(f64, N)]) -> io::Result<()> {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n",
    );
    for (time, name) in files {
        let _ = writeln!(
            text,
            "<DataSet timestep=\"{time}\" group=\"\" part=\"0\" file=\"{}\"/>",
            escaped(name.as_ref())
        );
    }
    text.push_str("</Collection>\n</VTKFile>\n");
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// Connectivity, ends of the cells in it, and their types.
fn cell_arrays(grid: &Grid<'_>) -> [Array<'static>; 3] {
    let triangles = grid.triangles.as_flattened();
    let corners: Vec<i64> = triangles
        .iter()
        .chain(grid.lines.as_flattened())
        .map(|&v| i64::from(v))
        .collect();
    let mut ends: Vec<i64> = (1..=grid.triangles.len() as i64).map(|t| 3 * t).collect();
    ends.extend((1..=grid.lines.len() as i64).map(|l| triangles.len() as i64 + 2 * l));
    let mut types = vec![TRIANGLE; grid.triangles.len()];
    types.resize(grid.n_cells(), LINE);
    [
        Array::longs("connectivity", &corners),
        Array::longs("offsets", &ends),
        Array::new("types", "UInt8", 1, types),
    ]
}

/// An array as it is written.
struct Array<'a> {
    name: &'a str,
    kind: &'static str,
    components: usize,
    bytes: Vec<u8>,
}

impl<'a> Array<'a> {
    fn new(name: &'a str, kind: &'static str, components: usize, bytes: Vec<u8>) -> Self {
        Self {
            name,
            kind,
            components,
            bytes,
        }
    }

    fn floats(
        name: &'a str,
        components: usize,
        count: usize,
        values: impl Iterator<Item = f64>,
    ) -> Self {
        let mut bytes = Vec::with_capacity(8 * components * count);
        for value in values {
            bytes.extend_from_slice(&value.to_le_bytes());
        }
        Self::new(name, "Float64", components, bytes)
    }

    fn vectors(name: &'a str, values: &[Vec3]) -> Self {
        let components = values.iter().flat_map(|v| [v.x, v.y, v.z]);
        Self::floats(name, 3, values.len(), components)
    }

    fn integers(name: &'a str, values: &[i32]) -> Self {
        let bytes = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        Self::new(name, "Int32", 1, bytes)
    }

    fn longs(name: &'a str, values: &[i64]) -> Self {
        let bytes = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        Self::new(name, "Int64", 1, bytes)
    }
}

/// What stands behind the text.
#[derive(Default)]
struct Appended {
    bytes: Vec<u8>,
}

impl Appended {
    /// The text of a section, whose arrays are appended.
    fn section<'a>(&mut self, tag: &str, arrays: impl Iterator<Item = Array<'a>>) -> String {
        let mut text = format!("<{tag}>\n");
        for array in arrays {
            let _ = writeln!(
                text,
                "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" \
                 format=\"appended\" offset=\"{}\"/>",
                array.kind,
                escaped(array.name),
                array.components,
                self.bytes.len()
            );
            let length = array.bytes.len() as u64;
            self.bytes.extend_from_slice(&length.to_le_bytes());
            self.bytes.extend(array.bytes);
        }
        let _ = writeln!(text, "</{tag}>");
        text
    }
}

/// A name inside the quotes of an XML attribute.
fn escaped(name: &str) -> String {
    let mut text = String::with_capacity(name.len());
    for c in name.chars() {
        match c {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '>' => text.push_str("&gt;"),
            '"' => text.push_str("&quot;"),
            c if c.is_control() => text.push(' '),
            c => text.push(c),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> [Vec3; 4] {
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.1]].map(|[x, y]| Vec3::new(x, y, 0.5))
    }

    /// Array of the given name, by the rules of the format.
    fn array<'a>(file: &'a [u8], name: &str) -> &'a [u8] {
        let start = file.windows(2).position(|w| w == b"\n_");
        let start = start.unwrap() + 2;
        let text = String::from_utf8_lossy(&file[..start]);
        let line = text
            .lines()
            .find(|line| line.contains(&format!("Name=\"{name}\"")))
            .unwrap();
        let offset = line.split("offset=\"").nth(1).unwrap();
        let offset: usize = offset.split('"').next().unwrap().parse().unwrap();
        let at = start + offset;
        let length = u64::from_le_bytes(*file[at..].first_chunk().unwrap()) as usize;
        &file[at + 8..at + 8 + length]
    }

    #[test]
    fn arrays_stand_where_the_text_says() {
        let points = square();
        let grid = Grid {
            points: &points,
            triangles: &[[0, 1, 2], [0, 2, 3]],
            lines: &[[2, 3]],
            point_data: vec![Field::vectors("<v>", points.to_vec())],
            cell_data: vec![
                Field::scalars("cp", vec![0.1, f64::NAN, -3.0]),
                Field::integers("body", vec![1, 2, 3]),
            ],
        };
        let mut file = Vec::new();
        vtu(&mut file, &grid).unwrap();
        let doubles = |bytes: &[u8]| -> Vec<u64> {
            let chunks = bytes.chunks_exact(8);
            chunks
                .map(|c| u64::from_le_bytes(*c.first_chunk().unwrap()))
                .collect()
        };
        let expected: Vec<u64> = points
            .iter()
            .flat_map(|p| [p.x, p.y, p.z])
            .map(f64::to_bits)
            .collect();
        assert_eq!(doubles(array(&file, "points")), expected);
        assert_eq!(doubles(array(&file, "&lt;v&gt;")), expected);
        let scalars = [0.1, f64::NAN, -3.0].map(f64::to_bits);
        assert_eq!(doubles(array(&file, "cp")), scalars);
        assert_eq!(
            doubles(array(&file, "connectivity")),
            [0, 1, 2, 0, 2, 3, 2, 3]
        );
        assert_eq!(doubles(array(&file, "offsets")), [3, 6, 8]);
        assert_eq!(array(&file, "types"), [5, 5, 3]);
        assert_eq!(array(&file, "body").len(), 12);
        assert!(file.ends_with(b"</VTKFile>\n"));
    }

    #[test]
    fn fields_that_do_not_fit_are_refused() {
        let points = square();
        let grid = |triangles, cell_data| Grid {
            points: &points,
            triangles,
            cell_data,
            ..Grid::default()
        };
        let wrong = |grid: &Grid<'_>| vtu(Vec::new(), grid).unwrap_err().to_string();
        let short = grid(&[[0, 1, 2]], vec![Field::scalars("cp", vec![])]);
        assert_eq!(wrong(&short), "field `cp` has 0 values for 1 cells");
        let twice = vec![
            Field::scalars("a", vec![0.0]),
            Field::integers("a", vec![0]),
        ];
        assert_eq!(
            wrong(&grid(&[[0, 1, 2]], twice)),
            "two fields are named `a`"
        );
        let missing = wrong(&grid(&[[0, 1, 4]], vec![]));
        assert_eq!(missing, "a cell names point 4, which is not there");
    }

    #[test]
    fn a_collection_names_its_files() {
        let mut file = Vec::new();
        pvd(&mut file, &[(0.5, "a&b.vtu")]).unwrap();
        let text = String::from_utf8(file).unwrap();
        assert!(text.contains("timestep=\"0.5\" group=\"\" part=\"0\" file=\"a&amp;b.vtu\""));
    }
}
