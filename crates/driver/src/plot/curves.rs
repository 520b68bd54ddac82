//! A few curves over one variable: a fit and its samples, a distribution over the span.

use super::axis::Axis;
use super::panel::Panel;
use super::svg::{Anchor, GREY, Svg, Type, text_width};

const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 420.0;
const AREA: [f64; 4] = [84.0, 64.0, 880.0, 290.0];
/// Told apart by colour-blind people (Okabe and Ito).
const COLOURS: [&str; 6] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#000000",
];

/// How points are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// Joined.
    Line,
    /// Each by itself.
    Dots,
}

/// Points with a name.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Name in the legend.
    pub name: String,
    /// How they are drawn.
    pub drawn: Drawn,
    /// Curves of one group share a colour.
    pub group: usize,
    /// Points.
    pub points: Vec<[f64; 2]>,
}

/// A picture of curves.
#[derive(Clone, Copy, Debug)]
pub struct Curves<'a> {
    /// Heading.
    pub title: &'a str,
    /// Quantity, symbol and unit of both axes.
    pub labels: [&'a str; 2],
    /// What is drawn.
    pub curves: &'a [Curve],
}

/// Draws curves over a common abscissa; points that are not finite are left out.
pub fn curves(picture: &Curves<'_>) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT);
    let heading = Type {
        is_bold: true,
        ..Type::new(16.0, Anchor::Start)
    };
    svg.text([20.0, 26.0], picture.title, heading);
    let all = || {
        let points = picture.curves.iter().flat_map(|curve| &curve.points);
        points.filter(|[x, y]| x.is_finite() && y.is_finite())
    };
    let ends = |axis: usize| {
        all().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| {
            [low.min(point[axis]), high.max(point[axis])]
        })
    };
    if all().next().is_none() {
        svg.text(
            [20.0, 60.0],
            "nothing to show",
            Type::new(13.0, Anchor::Start),
        );
        return svg.finish();
    }
    let ([left, right], [bottom, top]) = (ends(0), ends(1));
    let margin = 0.05 * (top - bottom);
    let panel = Panel {
        area: AREA,
        x: Axis::exact(left, right, 9),
        y: Axis::exact(bottom - margin, top + margin, 6),
        x_label: picture.labels[0],
        y_label: picture.labels[1],
    };
    panel.draw_axes(&mut svg);
    let mut place = AREA[0];
    for curve in picture.curves {
        let colour = COLOURS[curve.group % COLOURS.len()];
        let points: Vec<[f64; 2]> = curve
            .points
            .iter()
            .filter(|[x, y]| x.is_finite() && y.is_finite())
            .map(|[x, y]| panel.at(*x, *y))
            .collect();
        match curve.drawn {
            Drawn::Line => {
                svg.polyline(&points, colour, 1.8);
                svg.line([place, 47.0], [place + 24.0, 47.0], colour, 1.8);
            }
            Drawn::Dots => {
                for point in &points {
                    svg.circle(*point, 3.6, "#ffffff", colour, 1.6);
                }
                svg.circle([place + 12.0, 47.0], 3.6, "#ffffff", colour, 1.6);
            }
        }
        let look = Type {
            colour: GREY,
            ..Type::new(12.0, Anchor::Start)
        };
        svg.text([place + 30.0, 51.0], &curve.name, look);
        place += 46.0 + text_width(&curve.name, 12.0);
    }
    svg.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_drawn_and_what_is_not_finite_is_left_out() {
        let curve = |drawn, points: Vec<[f64; 2]>| Curve {
            name: "Q <1>".to_owned(),
            drawn,
            group: 0,
            points,
        };
        let all = [
            curve(Drawn::Line, vec![[0.0, 1.0], [1.0, 2.0]]),
            curve(Drawn::Dots, vec![[0.5, f64::NAN], [0.5, 1.5]]),
        ];
        let text = curves(&Curves {
            title: "fit",
            labels: ["k", "Q"],
            curves: &all,
        });
        assert!(text.contains("Q &lt;1&gt;") && !text.contains("NaN"));
        assert_eq!(text.matches("<circle").count(), 2);
        let empty = curves(&Curves {
            title: "fit",
            labels: ["k", "Q"],
            curves: &[],
        });
        assert!(empty.contains("nothing to show"));
    }
}
