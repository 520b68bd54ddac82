//! Numbers for people.

/// Three significant digits, at least one decimal: `46.4`, `2.18`, `0.103`.
pub(crate) fn three_digits(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-4..1e6).contains(&size) {
        return format!("{value:.2e}");
    }
    let magnitude = if size > 0.0 {
        size.log10().floor()
    } else {
        0.0
    };
    let decimals = (2.0 - magnitude).clamp(1.0, 6.0) as usize;
    format!("{value:.decimals$}")
}

/// So many decimals, and no minus sign before a zero.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(size) if size.chars().all(|c| c == '0' || c == '.') => size.to_owned(),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rounded_zero_has_no_sign() {
        let shown = [-1e-9, -0.5, 0.25].map(|value| fixed(value, 2));
        assert_eq!(shown, ["0.00", "-0.50", "0.25"]);
    }

    #[test]
    fn three_digits_are_kept_at_any_size() {
        let shown = [46.41, 2.1839, 0.10329, 0.0, -123.4, 1e-9].map(three_digits);
        assert_eq!(
            shown,
            ["46.4", "2.18", "0.103", "0.00", "-123.4", "1.00e-9"]
        );
    }
}
