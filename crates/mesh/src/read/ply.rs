//! PLY, the polygon file format: vertices and polygons, text or binary of either byte order.
//!
//! The header names elements and the type of each of their properties. Taken are `x`, `y`,
//! `z` of `vertex` and the list `vertex_indices` (or `vertex_index`) of `face`; all else is
//! stepped over. Polygons are cut into triangles. The format has no groups.

use super::cursor::{Cursor, Malformed, WRITE_AGAIN};
use super::draft::Draft;
use super::{MISSING_VERTEX, Place};
use crate::Vec3;

/// Corners of a polygon: more come from a damaged count.
const MOST_CORNERS: usize = 1000;

#[derive(Clone, Copy, PartialEq)]
enum Order {
    Text,
    Little,
    Big,
}

/// Type of a number.
#[derive(Clone, Copy)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

struct Property {
    name: String,
    /// Type of the count, of a list.
    count: Option<Kind>,
    kind: Kind,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

pub(super) fn parse(bytes: &[u8]) -> Result<Draft, Malformed> {
    let mut cursor = Cursor::new(bytes);
    let (order, elements) = header(&mut cursor)?;
    cursor.is_binary = order != Order::Text;
    let mut values = Values { cursor, order };
    let mut draft = Draft::default();
    let mut polygons = Vec::new();
    let mut other = Vec::new();
    for element in &elements {
        values.check_room(element)?;
        match element.name.as_str() {
            "vertex" => vertices(&mut values, element, &mut draft)?,
            "face" => polygons.extend(faces(&mut values, element)?),
            name => {
                for _ in 0..element.count {
                    values.record(element, |_, _| ())?;
                }
                other.push(format!("{} of `{name}`", element.count));
            }
        }
    }
    draft.note_places("elements that are not read", &other);
    cut(&mut draft, polygons);
    Ok(draft)
}

fn header(cursor: &mut Cursor) -> Result<(Order, Vec<Element>), Malformed> {
    let mut order = None;
    let mut elements: Vec<Element> = Vec::new();
    // The word `ply`.
    cursor.line();
    let mut number = 1;
    loop {
        number += 1;
        let Some(line) = cursor.line() else {
            return Err(cursor.fault("the header has no `end_header`", WRITE_AGAIN));
        };
        let line = String::from_utf8_lossy(line);
        let words: Vec<&str> = line.split_whitespace().collect();
        let wrong = |what: String| Malformed {
            place: Place::Line(number),
            what,
            remedy: "correct the header".into(),
        };
        match words[..] {
            ["end_header"] => break,
            ["format", name, "1.0"] => {
                order = Some(match name {
                    "ascii" => Order::Text,
                    "binary_little_endian" => Order::Little,
                    "binary_big_endian" => Order::Big,
                    _ => return Err(wrong(format!("format `{name}` is not known"))),
                });
            }
            ["element", name, count] => elements.push(Element {
                name: name.to_owned(),
                count: count
                    .parse()
                    .map_err(|_| wrong(format!("`{count}` is not a count of elements")))?,
                properties: Vec::new(),
            }),
            ["property", ..] => {
                let property = property(&words[1..])
                    .ok_or_else(|| wrong(format!("`{}` is not a property", words.join(" "))))?;
                let element = elements.last_mut();
                element
                    .ok_or_else(|| wrong("a property stands before any element".to_owned()))?
                    .properties
                    .push(property);
            }
            [] | ["comment" | "obj_info", ..] => {}
            _ => return Err(wrong(format!("`{}` is not known here", words.join(" ")))),
        }
    }
    let order = order.ok_or_else(|| cursor.fault("the header names no format", WRITE_AGAIN))?;
    Ok((order, elements))
}

fn property(words: &[&str]) -> Option<Property> {
    match *words {
        ["list", count, kind, name] => Some(Property {
            name: name.to_owned(),
            count: Some(Kind::named(count)?),
            kind: Kind::named(kind)?,
        }),
        [kind, name] => Some(Property {
            name: name.to_owned(),
            count: None,
            kind: Kind::named(kind)?,
        }),
        _ => None,
    }
}

/// Numbers behind the header.
struct Values<'a> {
    cursor: Cursor<'a>,
    order: Order,
}

impl Values<'_> {
    /// Refuses a count of records that the file has no room for.
    fn check_room(&self, element: &Element) -> Result<(), Malformed> {
        let kinds = element.properties.iter().map(|p| p.count.unwrap_or(p.kind));
        let binary: usize = kinds.map(Kind::size).sum();
        if binary == 0 {
            let what = format!("the element `{}` has no properties", element.name);
            return Err(self.cursor.fault(what, "correct the header"));
        }
        // In text every value has a digit and a space.
        let text = 2 * element.properties.len();
        // The last value of a text file needs no space.
        let count = element
            .count
            .saturating_sub(usize::from(self.order == Order::Text));
        self.cursor.count(count as u64, text, binary).map(drop)
    }

    fn number(&mut self, kind: Kind) -> Result<f64, Malformed> {
        if self.order == Order::Text {
            return self.cursor.double();
        }
        Ok(match kind {
            Kind::I8 => f64::from(i8::from_le_bytes(self.bytes()?)),
            Kind::U8 => f64::from(u8::from_le_bytes(self.bytes()?)),
            Kind::I16 => f64::from(i16::from_le_bytes(self.bytes()?)),
            Kind::U16 => f64::from(u16::from_le_bytes(self.bytes()?)),
            Kind::I32 => f64::from(i32::from_le_bytes(self.bytes()?)),
            Kind::U32 => f64::from(u32::from_le_bytes(self.bytes()?)),
            Kind::F32 => f64::from(f32::from_le_bytes(self.bytes()?)),
            Kind::F64 => f64::from_le_bytes(self.bytes()?),
        })
    }

    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Malformed> {
        let mut bytes = self.cursor.take()?;
        if self.order == Order::Big {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// Reads one record, showing each property's name and numbers.
    fn record(
        &mut self,
        element: &Element,
        mut show: impl FnMut(&str, &[f64]),
    ) -> Result<(), Malformed> {
        let mut list = Vec::new();
        for property in &element.properties {
            let count = match property.count {
                None => 1,
                Some(kind) => self.length(kind)?,
            };
            list.clear();
            for _ in 0..count {
                list.push(self.number(property.kind)?);
            }
            show(&property.name, &list);
        }
        Ok(())
    }

    fn length(&mut self, kind: Kind) -> Result<usize, Malformed> {
        let count = self.number(kind)?;
        if count.fract() == 0.0 && (0.0..=MOST_CORNERS as f64).contains(&count) {
            return Ok(count as usize);
        }
        Err(self
            .cursor
            .fault(format!("a list has {count} entries"), WRITE_AGAIN))
    }
}

fn vertices(
    values: &mut Values,
    element: &Element,
    draft: &mut Draft,
) -> Result<(), Malformed> {
    for axis in ["x", "y", "z"] {
        if !element
            .properties
            .iter()
            .any(|p| p.name == axis && p.count.is_none())
        {
            let what = format!("the vertices have no coordinate `{axis}`");
            return Err(Malformed::whole(what, "export vertices with x, y and z"));
        }
    }
    let mut not_finite = Vec::new();
    for number in 0..element.count {
        let mut position = Vec3::zeros();
        values.record(element, |name, list| {
            let axis = ["x", "y", "z"].iter().position(|axis| *axis == name);
            if let (Some(axis), [value]) = (axis, list) {
                position[axis] = *value;
            }
        })?;
        if !position.iter().all(|x| x.is_finite()) {
            not_finite.push(format!("vertex {number}"));
        }
        draft.vertices.push(position);
    }
    draft.note_places("coordinates that are no finite numbers", &not_finite);
    Ok(())
}

fn faces(values: &mut Values, element: &Element) -> Result<Vec<Vec<f64>>, Malformed> {
    let is_list = |name: &str| ["vertex_indices", "vertex_index"].contains(&name);
    if !element
        .properties
        .iter()
        .any(|p| is_list(&p.name) && p.count.is_some())
    {
        return Err(Malformed::whole(
            "the faces have no list `vertex_indices`",
            "export polygons, not triangle strips or points",
        ));
    }
    let mut polygons = Vec::new();
    for number in 0..element.count {
        let mut corners = Vec::new();
        values.record(element, |name, list| {
            if is_list(name) {
                corners = list.to_vec();
            }
        })?;
        if corners.len() < 3 {
            let what = format!("face {number} has {} corners", corners.len());
            return Err(values
                .cursor
                .fault(what, "a face has three corners or more"));
        }
        polygons.push(corners);
    }
    Ok(polygons)
}

fn cut(draft: &mut Draft, polygons: Vec<Vec<f64>>) {
    let count = draft.vertices.len() as f64;
    let mut missing = Vec::new();
    for (number, polygon) in polygons.into_iter().enumerate() {
        let known = |v: f64| v.fract() == 0.0 && (0.0..count).contains(&v);
        if let Some(bad) = polygon.iter().find(|v| !known(**v)) {
            missing.push(format!("face {number} names vertex {bad}"));
        }
        let corner = |v: f64| if known(v) { v as u32 } else { MISSING_VERTEX };
        let corners: Vec<u32> = polygon.into_iter().map(corner).collect();
        draft.add_polygon(&corners);
    }
    draft.note_places("vertices that are not in the file", &missing);
}
