//! Pictures as SVG: the root locus and the V-g-f diagram of a sweep, sheets of diagrams,
//! modes on the surface, meshes.

mod axis;
mod curves;
mod flutter_diagram;
mod label;
mod layout;
mod mode_shape;
mod panel;
mod root_locus;
mod sheet;
mod style;
mod svg;
mod view;
mod wireframe;

pub(crate) use svg::escape;

pub use curves::{Curve, Curves, Drawn, curves};
pub use flutter_diagram::flutter_diagram;
pub use mode_shape::{ModePicture, mode_shape};
pub use root_locus::root_locus;
pub use sheet::{Graph, Mark, Series, Sheet, sheet};
pub use wireframe::{Wireframe, wireframe};

use fladder_stability::{MethodResult, Methods};

/// What both pictures show.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// Heading.
    pub title: &'a str,
    /// Conditions, one line under the heading.
    pub conditions: &'a str,
    /// Outcome of the sweep.
    pub methods: &'a Methods,
}

impl<'a> Subject<'a> {
    /// The outcome drawn as lines, and the method's name.
    fn lines(&self) -> Option<(&'a MethodResult, &'static str)> {
        let methods = self.methods;
        methods
            .polished
            .as_ref()
            .map(|result| (result, "p2, refined"))
            .or_else(|| methods.p2.as_ref().map(|result| (result, "p2")))
            .or_else(|| methods.pk.as_ref().map(|result| (result, "p-k")))
    }

    /// The outcome drawn as crosses beside the lines.
    fn crosses(&self) -> Option<&'a MethodResult> {
        let beside = self.methods.polished.is_some() || self.methods.p2.is_some();
        self.methods.pk.as_ref().filter(|_| beside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fladder_stability::{Branch, Crossing, Kind};

    fn methods() -> Methods {
        let branch = Branch {
            name: "elastic:<1>".to_owned(),
            speed: vec![20.0, 30.0, 40.0],
            g: vec![-0.05, -0.01, 0.02],
            k: vec![0.9, 0.7, 0.5],
            sigma: vec![-8.0, -2.0, 6.0],
            omega: vec![150.0, 160.0, 170.0],
            frequency_hz: vec![23.9, 25.5, 27.1],
            damping_ratio: vec![Some(0.05), Some(0.01), Some(-0.04)],
            structural_damping: vec![Some(-0.1), Some(-0.03), Some(0.08)],
            ..Branch::default()
        };
        let crossing = Crossing {
            speed: 33.3,
            dynamic_pressure: 680.0,
            frequency_hz: 26.1,
            k: 0.63,
            branch: branch.name.clone(),
            kind: Kind::Elastic,
            altitude: None,
            sensitivities: None,
            shape: Vec::new(),
        };
        let result = MethodResult {
            branches: vec![branch],
            flutter: vec![crossing],
            ..MethodResult::default()
        };
        Methods {
            polished: Some(result.clone()),
            pk: Some(result),
            ..Methods::default()
        }
    }

    /// Axes have quantity, symbol and unit; the crossing is ringed and written
    /// out; markup in names stays text; every group is closed.
    #[test]
    fn pictures_carry_labels_legend_and_crossings() {
        let methods = methods();
        let subject = Subject {
            title: "a & b",
            conditions: "sea level",
            methods: &methods,
        };
        let (locus, diagram) = (root_locus(&subject), flutter_diagram(&subject));
        for text in ["g = σb/U", "k = ωb/U", "33.3 m/s, 26.1 Hz"] {
            assert!(locus.contains(text), "{text}");
        }
        for text in ["V  [m/s]", "f  [Hz]", "2σ/ω", "33.3 m/s, 26.1 Hz"] {
            assert!(diagram.contains(text), "{text}");
        }
        for picture in [locus, diagram] {
            assert!(picture.contains("a &amp; b") && picture.contains("elastic:&lt;1&gt;"));
            assert!(picture.contains(">p-k<") && picture.contains("<circle"));
            let count = |text: &str| picture.matches(text).count();
            assert_eq!(count("<g ") + count("<g>"), count("</g>"));
            assert_eq!(count("<text"), count("</text>"));
        }
    }

    #[test]
    fn nothing_to_draw_gives_a_picture_that_says_so() {
        let methods = Methods::default();
        let subject = Subject {
            title: "",
            conditions: "",
            methods: &methods,
        };
        assert!(root_locus(&subject).contains("no roots"));
        assert!(flutter_diagram(&subject).contains("no roots"));
        let methods = Methods {
            pk: Some(MethodResult::default()),
            ..Methods::default()
        };
        let subject = Subject {
            title: "",
            conditions: "",
            methods: &methods,
        };
        assert!(root_locus(&subject).ends_with("</svg>\n"));
        assert!(flutter_diagram(&subject).ends_with("</svg>\n"));
    }
}
