//! Colour and marker of each branch.
//!
//! Eight colours that people with colour blindness tell apart (Okabe and Ito,
//! the yellow replaced by wine, which shows on white), seven markers: the pair
//! repeats only after 56 branches.

use super::svg::Svg;
use std::collections::BTreeMap;

const COLOURS: [&str; 8] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000", "#882255",
];

/// Shape of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    Inverted,
    Ring,
    Frame,
}

const MARKERS: [Marker; 7] = [
    Marker::Circle,
    Marker::Square,
    Marker::Triangle,
    Marker::Diamond,
    Marker::Inverted,
    Marker::Ring,
    Marker::Frame,
];

/// Look of one branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Style {
    pub(super) colour: &'static str,
    pub(super) marker: Marker,
}

impl Style {
    pub(super) fn numbered(number: usize) -> Self {
        Self {
            colour: COLOURS[number % COLOURS.len()],
            marker: MARKERS[number % MARKERS.len()],
        }
    }

    /// Draws the marker.
    pub(super) fn mark(self, svg: &mut Svg, at: [f64; 2], size: f64) {
        let [x, y] = at;
        let colour = self.colour;
        let corners = |offsets: &[[f64; 2]]| -> Vec<[f64; 2]> {
            offsets
                .iter()
                .map(|[dx, dy]| [x + dx * size, y + dy * size])
                .collect()
        };
        let square = [[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]];
        match self.marker {
            Marker::Circle => svg.circle(at, size, colour, colour, 1.0),
            Marker::Ring => svg.circle(at, size, "#ffffff", colour, 1.4),
            Marker::Square => svg.polygon(&corners(&square), colour, colour),
            Marker::Frame => svg.polygon(&corners(&square), "#ffffff", colour),
            Marker::Triangle => {
                svg.polygon(
                    &corners(&[[0.0, -1.2], [1.1, 0.8], [-1.1, 0.8]]),
                    colour,
                    colour,
                );
            }
            Marker::Inverted => {
                svg.polygon(
                    &corners(&[[0.0, 1.2], [1.1, -0.8], [-1.1, -0.8]]),
                    colour,
                    colour,
                );
            }
            Marker::Diamond => {
                let diamond = [[0.0, -1.3], [1.1, 0.0], [0.0, 1.3], [-1.1, 0.0]];
                svg.polygon(&corners(&diamond), colour, colour);
            }
        }
    }
}

/// Draws crosses of the p-k method.
pub(super) fn crosses(svg: &mut Svg, places: &[[f64; 2]], colour: &str) {
    svg.crosses(places, 3.0, colour, 1.1);
}

/// Looks by name of the branch.
#[derive(Clone, Debug)]
pub(super) struct Styles(BTreeMap<String, Style>);

impl Styles {
    pub(super) fn of<'a>(names: impl Iterator<Item = &'a str>) -> Self {
        let numbered = names.enumerate();
        Self(
            numbered
                .map(|(number, name)| (name.to_owned(), Style::numbered(number)))
                .collect(),
        )
    }

    pub(super) fn get(&self, name: &str) -> Option<Style> {
        self.0.get(name).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fifty_six_branches_look_different() {
        let all: Vec<Style> = (0..56).map(Style::numbered).collect();
        assert!((1..56).all(|i| !all[..i].contains(&all[i])));
    }
}
