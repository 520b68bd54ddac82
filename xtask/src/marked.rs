//! Documents with marked parts, each of which can be renewed alone.

/// The document with a text in the place of the part with the same mark; where there is
/// none, it is added at the end.
pub(crate) fn replaced(old: &str, mark: &str, text: &str) -> String {
    let (open, close) = (
        format!("<!-- {mark} -->\n"),
        format!("<!-- end of {mark} -->\n"),
    );
    let block = format!("{open}{text}{close}");
    let (Some(from), Some(to)) = (old.find(&open), old.find(&close)) else {
        return format!("{}\n{block}", old.trim_end().to_owned() + "\n");
    };
    format!("{}{block}{}", &old[..from], &old[to + close.len()..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_added_once_and_then_renewed_in_its_place() {
        let first = replaced("# Head\n", "a", "one\n");
        let both = replaced(&first, "b", "two\n");
        let renewed = replaced(&both, "a", "three\n");
        assert_eq!(
            renewed,
            "# Head\n\n<!-- a -->\nthree\n<!-- end of a -->\n\n<!-- b -->\ntwo\n<!-- end of b -->\n"
        );
    }
}
