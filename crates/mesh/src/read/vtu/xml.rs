//! The little of XML that VTK's files use: tags with attributes, and what stands behind them.

use super::super::cursor::Malformed;
use super::wrong;

/// An opening tag.
pub(super) struct Tag<'a> {
    /// With a leading `?` for the prolog.
    pub(super) name: String,
    attributes: Vec<(String, String)>,
    /// What follows up to the next tag; for appended data up to the end of the file.
    pub(super) content: &'a [u8],
}

impl Tag<'_> {
    pub(super) fn attribute(&self, name: &str) -> Option<&str> {
        let found = self.attributes.iter().find(|(key, _)| key == name);
        found.map(|(_, value)| value.as_str())
    }
}

/// The opening tags of a file in order.
pub(super) struct Tags<'a> {
    bytes: &'a [u8],
}

impl<'a> Tags<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    /// The next opening tag; closing tags and comments are stepped over.
    pub(super) fn next(&mut self) -> Result<Option<Tag<'a>>, Malformed> {
        loop {
            let Some(start) = self.bytes.iter().position(|&byte| byte == b'<') else {
                return Ok(None);
            };
            self.bytes = &self.bytes[start..];
            if self.bytes.starts_with(b"<!--") {
                let end = self.bytes.windows(3).position(|w| w == b"-->");
                let end = end.ok_or_else(|| wrong("the file ends inside a comment"))?;
                self.bytes = &self.bytes[end + 3..];
                continue;
            }
            let end =
                end_of_tag(self.bytes).ok_or_else(|| wrong("the file ends inside a tag"))?;
            let text = String::from_utf8_lossy(&self.bytes[1..end]).into_owned();
            let rest = &self.bytes[end + 1..];
            self.bytes = rest;
            if text.starts_with(['/', '!']) {
                continue;
            }
            let (name, attributes) = parts(&text)?;
            let is_appended = name == "AppendedData";
            let next = rest
                .iter()
                .position(|&byte| byte == b'<')
                .unwrap_or(rest.len());
            let content = if is_appended { rest } else { &rest[..next] };
            return Ok(Some(Tag {
                name,
                attributes,
                content,
            }));
        }
    }
}

/// Place of the `>` that is not inside quotes.
fn end_of_tag(bytes: &[u8]) -> Option<usize> {
    let mut quote = None;
    for (i, &byte) in bytes.iter().enumerate() {
        match (quote, byte) {
            (None, b'>') => return Some(i),
            (None, b'"' | b'\'') => quote = Some(byte),
            (Some(open), byte) if byte == open => quote = None,
            _ => {}
        }
    }
    None
}

fn parts(text: &str) -> Result<(String, Vec<(String, String)>), Malformed> {
    let text = text.trim_end_matches(['/', '?']).trim();
    let (name, mut rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    let mut attributes = Vec::new();
    loop {
        rest = rest.trim_start();
        if rest.is_empty() {
            return Ok((name.to_owned(), attributes));
        }
        let shown: String = rest.chars().take(40).collect();
        let fault = || wrong(format!("`{shown}` is no attribute"));
        let (key, value) = rest.split_once('=').ok_or_else(fault)?;
        let value = value.trim_start();
        let quote = value.chars().next().filter(|c| ['"', '\''].contains(c));
        let quote = quote.ok_or_else(fault)?;
        let (value, after) = value[1..].split_once(quote).ok_or_else(fault)?;
        attributes.push((key.trim().to_owned(), plain(value)));
        rest = after;
    }
}

/// Text of an attribute.
fn plain(value: &str) -> String {
    let value = value
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&quot;", "\"");
    value.replace("&apos;", "'").replace("&amp;", "&")
}
