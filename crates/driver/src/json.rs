//! JSON with objects over several lines and arrays of numbers on one.
//!
//! The same value gives the same bytes: fields in the order of their types,
//! numbers as the shortest text that reads back to the same bits.

use serde::Serialize;
use serde_json::ser::Formatter;
use std::io::{self, Write};

const INDENT: &[u8] = b"  ";

/// Text of a value, ending with a line break.
///
/// # Errors
/// Values that JSON cannot hold, which none of this crate's types has.
pub fn text<T: Serialize>(value: &T) -> Result<String, serde_json::Error> {
    let mut bytes = Vec::new();
    let mut serializer = serde_json::Serializer::with_formatter(&mut bytes, Layout::default());
    value.serialize(&mut serializer)?;
    bytes.push(b'\n');
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[derive(Default)]
struct Layout {
    depth: usize,
    is_empty: bool,
}

impl Layout {
    fn new_line<W: ?Sized + Write>(&self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b"\n")?;
        (0..self.depth).try_for_each(|_| writer.write_all(INDENT))
    }
}

impl Formatter for Layout {
    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.depth += 1;
        self.is_empty = true;
        writer.write_all(b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.depth -= 1;
        if !self.is_empty {
            self.new_line(writer)?;
        }
        self.is_empty = false;
        writer.write_all(b"}")
    }

    fn begin_object_key<W: ?Sized + Write>(
        &mut self,
        writer: &mut W,
        first: bool,
    ) -> io::Result<()> {
        self.is_empty = false;
        if !first {
            writer.write_all(b",")?;
        }
        self.new_line(writer)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b": ")
    }

    fn begin_array_value<W: ?Sized + Write>(
        &mut self,
        writer: &mut W,
        first: bool,
    ) -> io::Result<()> {
        if first {
            Ok(())
        } else {
            writer.write_all(b", ")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct Sample {
        list: Vec<f64>,
        nested: Vec<Inner>,
    }

    #[derive(Serialize)]
    struct Inner {
        a: Option<f64>,
    }

    #[test]
    fn numbers_stay_on_a_line_and_undefined_values_are_null() {
        let sample = Sample {
            list: vec![1.0, 0.1],
            nested: vec![Inner { a: None }, Inner { a: Some(f64::NAN) }],
        };
        assert_eq!(
            text(&sample).unwrap(),
            "{\n  \"list\": [1.0, 0.1],\n  \"nested\": [{\n    \"a\": null\n  }, {\n    \"a\": null\n  }]\n}\n"
        );
    }
}
