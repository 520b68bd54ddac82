//! The nearest known word to a misspelt one.

/// Number of insertions, deletions, replacements and swaps of neighbours that
/// turn one word into the other (optimal string alignment distance).
fn edit_distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut rows = vec![vec![0; b.len() + 1]; a.len() + 1];
    for (i, row) in rows.iter_mut().enumerate() {
        row[0] = i;
    }
    for (j, start) in rows[0].iter_mut().enumerate() {
        *start = j;
    }
    for i in 1..=a.len() {
        for j in 1..=b.len() {
            let replaced = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = replaced.min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(rows[i - 2][j - 2] + 1);
            }
            rows[i][j] = best;
        }
    }
    rows[a.len()][b.len()]
}

/// The known dotted key nearest to an unknown one.
///
/// The last word counts most and the table it is in least, because keys put
/// into the wrong table are as common as misspelt ones; a word that was cut
/// short counts as one edit.
pub(crate) fn nearest<'k>(unknown: &str, known: &[&'k str]) -> Option<&'k str> {
    let cost = |key: &str| {
        let ((unknown_table, unknown_word), (table, word)) = (split(unknown), split(key));
        let is_start = unknown_word.len() > 2 && word.starts_with(unknown_word);
        let words = if is_start {
            1
        } else {
            edit_distance(unknown_word, word)
        };
        let elsewhere = usize::from(unknown_table != table);
        (2 * words + elsewhere).min(2 * edit_distance(unknown, key))
    };
    known
        .iter()
        .copied()
        .min_by_key(|key| (cost(key), edit_distance(unknown, key)))
}

fn split(key: &str) -> (&str, &str) {
    key.rsplit_once('.').unwrap_or(("", key))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_counts_edits() {
        assert_eq!(edit_distance("kitten", "sitting"), 3);
        assert_eq!(edit_distance("semichrod", "semichord"), 1);
        assert_eq!(edit_distance("", "abc"), 3);
    }

    #[test]
    fn a_typo_and_a_key_in_the_wrong_table_are_both_found() {
        let known = ["flow.alpha_deg", "flow.mach", "gaf.k", "stability.speed"];
        assert_eq!(nearest("flow.alfa_deg", &known), Some("flow.alpha_deg"));
        assert_eq!(nearest("alpha_deg", &known), Some("flow.alpha_deg"));
        assert_eq!(nearest("reference.mach", &known), Some("flow.mach"));
    }
}
