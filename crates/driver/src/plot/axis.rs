//! Ranges and ticks at round numbers.

/// A linear axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    /// Lower end.
    pub(super) from: f64,
    /// Upper end.
    pub(super) to: f64,
    /// Distance of ticks: 1, 2 or 5 times a power of ten.
    step: f64,
}

impl Axis {
    /// An axis that covers the values, its ends on ticks.
    pub(super) fn covering(low: f64, high: f64, ticks: usize) -> Self {
        let (low, high) = widened(low, high);
        let step = round_step((high - low) / ticks as f64);
        Self {
            from: (low / step).floor() * step,
            to: (high / step).ceil() * step,
            step,
        }
    }

    /// An axis with exactly these ends.
    pub(super) fn exact(low: f64, high: f64, ticks: usize) -> Self {
        let (from, to) = widened(low, high);
        Self {
            from,
            to,
            step: round_step((to - from) / ticks as f64),
        }
    }

    /// Place of a value between 0 and 1.
    pub(super) fn fraction(&self, value: f64) -> f64 {
        (value - self.from) / (self.to - self.from)
    }

    pub(super) fn contains(&self, value: f64) -> bool {
        (self.from..=self.to).contains(&value)
    }

    /// Values of the ticks and their texts.
    pub(super) fn ticks(&self) -> Vec<(f64, String)> {
        let slack = 1e-9 * (self.to - self.from);
        let first = ((self.from - slack) / self.step).ceil() as i64;
        let last = ((self.to + slack) / self.step).floor() as i64;
        let decimals = (-self.step.log10().floor()).max(0.0) as usize;
        (first..=last)
            .map(|number| {
                let value = number as f64 * self.step;
                let text = format!("{value:.decimals$}");
                let text = text
                    .strip_prefix('-')
                    .map_or(text.clone(), |t| format!("\u{2212}{t}"));
                (value, text)
            })
            .collect()
    }
}

/// A range of some width, so that nothing is divided by zero.
fn widened(low: f64, high: f64) -> (f64, f64) {
    let size = low.abs().max(high.abs()).max(1e-3);
    if high - low > 1e-9 * size {
        (low, high)
    } else {
        (low - 0.1 * size, high + 0.1 * size)
    }
}

/// The nearest step above of 1, 2, 5 times a power of ten.
fn round_step(wanted: f64) -> f64 {
    let power = 10f64.powf(wanted.log10().floor());
    let factor = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|factor| factor * power >= wanted * 0.999);
    factor.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_cover_the_values() {
        let axis = Axis::covering(-0.213, 0.037, 6);
        let texts: Vec<String> = axis.ticks().into_iter().map(|tick| tick.1).collect();
        assert_eq!(
            texts,
            [
                "\u{2212}0.25",
                "\u{2212}0.20",
                "\u{2212}0.15",
                "\u{2212}0.10",
                "\u{2212}0.05",
                "0.00",
                "0.05"
            ]
        );
        let axis = Axis::covering(20.0, 75.0, 6);
        assert_eq!((axis.from, axis.to), (20.0, 80.0));
    }

    #[test]
    fn a_single_value_still_has_an_axis() {
        let axis = Axis::covering(0.0, 0.0, 5);
        assert!(axis.from < 0.0 && axis.to > 0.0 && axis.fraction(0.0) == 0.5);
    }
}
