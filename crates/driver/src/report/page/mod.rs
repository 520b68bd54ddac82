//! `report.html`: verdict, diagrams, tables and what moves, on one page that needs nothing else.
//!
//! Everything is in the page, so that it opens without network and can be sent on. Its
//! script draws the diagrams again to be read off, and the surface to be turned; without
//! it, and on paper, the pictures stand.

mod data;

pub(crate) use data::Wetted;

use super::flight::flight_table;
use super::mode_pictures::{Motion, Named};
use super::roots::{best, crossing_table, margin_words, verdicts};
use crate::plot::escape;
use data::Data;
use fladder_stability::SweepResult;
use std::fmt::Write as _;

/// What the page shows.
pub(crate) struct Page<'a> {
    pub(crate) title: &'a str,
    pub(crate) conditions: &'a str,
    pub(crate) result: &'a SweepResult,
    pub(crate) speeds: &'a [f64],
    pub(crate) root_locus: &'a str,
    pub(crate) flutter_diagram: &'a str,
    /// Fit of the forces, wake jump over the span.
    pub(crate) curves: &'a [Named],
    pub(crate) surface: Option<Wetted<'a>>,
    /// Crossings, then structural modes.
    pub(crate) motions: &'a [Motion],
    /// Pictures of the first crossings, for paper.
    pub(crate) stills: &'a [Named],
    /// Inputs and effort: name and value.
    pub(crate) facts: &'a [(String, String)],
}

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

const CONVENTIONS: &str = "x aft, y starboard, z up. p = g + ik = s b/U with the reference \
semichord b: oscillation grows where g > 0, k = ωb/U; positive structural damping 2σ/ω grows. \
Rigid motions have the signs of flight mechanics: bank starboard wing down, nose up, heading to \
starboard, wind from starboard; u is speed over U, the phase that by which the first is ahead. \
Forces are for small motion about the steady flow of the incidence above; incompressible, \
inviscid. Colours of motions: red moves along the direction of the largest displacement, blue \
against it.";

const LOCUS_HINT: &str = "Point at a line to read it; Shift and wheel zooms, a double click goes \
back. Lines: best method; crosses: p-k; rings: crossings into growth.";

const CONTROLS: &str = "<div class=\"live\"><div class=\"controls\"><label>abscissa of speed \
<select id=\"abscissa\"><option value=\"tas\">true airspeed</option><option value=\"eas\">\
equivalent airspeed</option><option value=\"pressure\">dynamic pressure</option></select></label>\
<span><button id=\"all\" type=\"button\">all branches</button> \
<button id=\"none\" type=\"button\">none</button></span></div>\
<div class=\"legend\" id=\"legend\"></div></div>\n";

const VIEWER: &str = "<div class=\"live\"><div class=\"controls\"><label>motion \
<select id=\"motion\"></select></label><label>amplitude \
<input id=\"amplitude\" type=\"range\" min=\"0\" max=\"20\" value=\"6\" step=\"0.5\"></label>\
<button id=\"play\" type=\"button\">pause</button></div>\
<canvas id=\"viewer\" width=\"1040\" height=\"560\" tabindex=\"0\" \
aria-label=\"wetted surface with the chosen motion\"></canvas><p class=\"hint\">Drag to turn; the wheel \
zooms once the surface is clicked, or with Ctrl; arrows, + and − and the space bar do the same.</p></div>\n";

/// The whole page.
pub(crate) fn page(page: &Page<'_>) -> String {
    let title = escape(page.title);
    let methods = &page.result.methods;
    let lines = verdicts(methods, page.speeds);
    let is_stable = lines.len() == 1 && lines[0].starts_with("stable");
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\
         <title>{title}</title><style>{STYLE}</style></head><body>\n<h1>{title}</h1>\n\
         <p class=\"conditions\">{}</p>\n<div class=\"verdict{}\">\n",
        escape(page.conditions),
        if is_stable { " stable" } else { "" },
    );
    for line in lines {
        let _ = writeln!(out, "<p>{}</p>", escape(&line));
    }
    if let Some(margin) = &page.result.margin {
        let _ = writeln!(out, "<p>{}</p>", escape(&margin_words(margin)));
    }
    out.push_str("</div>\n");
    out.push_str("<h2>Root locus</h2>\n");
    out.push_str(CONTROLS);
    plot(&mut out, &["plot-locus"], page.root_locus, 0);
    let _ = writeln!(out, "<p class=\"hint live\">{LOCUS_HINT}</p>");
    out.push_str("<h2>Frequency and damping over speed</h2>\n");
    plot(
        &mut out,
        &["plot-frequency", "plot-damping"],
        page.flutter_diagram,
        1,
    );
    let (head, rows) = crossing_table(methods);
    table(&mut out, "Crossings", "words3", &head, &rows);
    if let Some(best) = best(methods) {
        let (head, rows) = flight_table(best, page.result);
        table(&mut out, "Rigid motions", "words3 motions", &head, &rows);
    }
    if page.surface.is_some() {
        out.push_str("<h2>What moves</h2>\n");
        out.push_str(VIEWER);
        out.push_str("<div class=\"still\"><div class=\"pair\">\n");
        for (number, still) in page.stills.iter().enumerate() {
            let _ = writeln!(
                out,
                "<figure>{}<figcaption>{}</figcaption></figure>",
                inline(&still.picture, 10 + number),
                escape(&still.name)
            );
        }
        out.push_str("</div></div>\n");
    }
    for (number, curve) in page.curves.iter().enumerate() {
        let _ = writeln!(
            out,
            "<h2>{}</h2>\n<figure>{}</figure>",
            escape(&curve.name),
            inline(&curve.picture, 100 + number)
        );
    }
    let _ = writeln!(out, "<h2>Conventions</h2>\n<p>{CONVENTIONS}</p>");
    if !page.facts.is_empty() {
        out.push_str("<h2>Inputs and effort</h2>\n<table class=\"facts\"><tbody>");
        for (name, value) in page.facts {
            row(&mut out, "td", &[name.clone(), value.clone()]);
        }
        out.push_str("</tbody></table>\n");
    }
    let data = Data::new(
        methods,
        best(methods),
        page.result.density,
        page.surface,
        page.motions,
    );
    let _ = write!(
        out,
        "<script type=\"application/json\" id=\"data\">{}</script>\n<script>\n{SCRIPT}</script>\n\
         </body></html>\n",
        data.json()
    );
    out
}

/// Places for the script's diagrams, and the picture that stands without it.
fn plot(out: &mut String, places: &[&str], picture: &str, number: usize) {
    for place in places {
        let _ = writeln!(out, "<div class=\"plot live\" id=\"{place}\"></div>");
    }
    let _ = writeln!(
        out,
        "<figure class=\"still\">{}</figure>",
        inline(picture, number)
    );
}

fn table(out: &mut String, heading: &str, class: &str, head: &[String], rows: &[Vec<String>]) {
    if rows.is_empty() {
        return;
    }
    let _ = write!(
        out,
        "<h2>{heading}</h2>\n<div class=\"scroll\"><table class=\"{class}\"><thead>"
    );
    row(out, "th", head);
    out.push_str("</thead><tbody>");
    for cells in rows {
        row(out, "td", cells);
    }
    out.push_str("</tbody></table></div>\n");
}

fn row(out: &mut String, tag: &str, cells: &[String]) {
    out.push_str("<tr>");
    for cell in cells {
        let _ = write!(out, "<{tag}>{}</{tag}>", escape(cell));
    }
    out.push_str("</tr>");
}

/// A picture as an element of the page: without its declaration, and with names of its own
/// for the areas it clips to.
fn inline(svg: &str, number: usize) -> String {
    let start = svg.find("<svg").unwrap_or(0);
    svg[start..]
        .replace("<clipPath id=\"", &format!("<clipPath id=\"p{number}-"))
        .replace("url(#", &format!("url(#p{number}-"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fladder_stability::{Methods, SCHEMA};

    #[test]
    fn markup_in_names_and_pictures_stays_text() {
        let result = SweepResult {
            schema: SCHEMA,
            density: Some(1.2),
            semichord: 1.0,
            methods: Methods::default(),
            margin: None,
            rigid_aircraft: Vec::new(),
        };
        let curve = Named {
            name: "a <b> & \"c\"".to_owned(),
            picture: "<?xml?><svg><clipPath id=\"x\"/><g clip-path=\"url(#x)\"/></svg>"
                .to_owned(),
        };
        let text = page(&Page {
            title: "<script>alert(1)</script>",
            conditions: "",
            result: &result,
            speeds: &[],
            root_locus: "<svg/>",
            flutter_diagram: "<svg/>",
            curves: &[curve],
            surface: None,
            motions: &[],
            stills: &[],
            facts: &[],
        });
        assert!(!text.contains("<script>alert"));
        assert!(text.contains("a &lt;b&gt; &amp; &quot;c&quot;"));
        assert!(text.contains("id=\"p100-x\"") && text.contains("url(#p100-x)"));
        assert!(!text.contains("<?xml"));
        for outside in ["src=\"http", "href=\"http", "@import", "fetch("] {
            assert!(!text.contains(outside), "{outside}");
        }
    }
}
