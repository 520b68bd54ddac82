//! `report.html`: verdict, crossings and pictures on one page that needs nothing else.
//!
//! Pictures are data in the page, so that it opens without network and can be sent on.

use super::mode_pictures::Named;
use super::roots::{crossing_table, verdicts};
use crate::plot::escape;
use fladder_stability::Methods;
use std::fmt::Write as _;

/// What the page shows.
pub(crate) struct Page<'a> {
    pub(crate) title: &'a str,
    pub(crate) conditions: &'a str,
    pub(crate) methods: &'a Methods,
    pub(crate) speeds: &'a [f64],
    /// Root locus and V-g-f diagram, with what they are.
    pub(crate) diagrams: &'a [Named],
    /// What moves at each crossing.
    pub(crate) flutter_modes: &'a [Named],
    /// Modes of the structure on the surface.
    pub(crate) modes: &'a [Named],
    /// Inputs and effort: name and value.
    pub(crate) facts: &'a [(String, String)],
}

const STYLE: &str = "\
body{font:16px/1.5 'DejaVu Sans',Verdana,Helvetica,Arial,sans-serif;color:#222;background:#fff;\
margin:0 auto;max-width:1040px;padding:1.5rem}\
h1{font-size:1.6rem;margin:0}h2{font-size:1.2rem;margin:2.2rem 0 .6rem}\
.conditions{color:#666;margin:.2rem 0 1rem}\
.verdict{border-left:5px solid #b2182b;background:#faf3f2;padding:.6rem 1rem}\
.verdict p{margin:.15rem 0}.verdict p:first-child{font-weight:bold}\
.scroll{overflow-x:auto}\
table{border-collapse:collapse;font-size:.88rem}\
th,td{padding:.25rem .7rem;text-align:right;border-bottom:1px solid #ddd;white-space:nowrap}\
th:first-child,td:first-child,th:nth-child(2),td:nth-child(2),th:nth-child(3),td:nth-child(3)\
{text-align:left}\
img{width:100%;height:auto;display:block}figure{margin:0}figcaption{font-size:.85rem;color:#666}\
.pair{display:grid;grid-template-columns:repeat(auto-fill,minmax(300px,1fr));gap:1rem}\
.facts td{white-space:normal;text-align:left}\
summary{cursor:pointer;font-weight:bold}\
@media print{details>*{display:block}h2{break-after:avoid}figure{break-inside:avoid}}";

const CONVENTIONS: &str = "x aft, y starboard, z up. p = g + ik = s b/U with the reference \
semichord b: oscillation grows where g > 0, k = ωb/U. Forces are for small motion about the \
steady flow of the incidence above; incompressible, inviscid. Colours of modes: red moves \
along the direction of the largest displacement, blue against it, pale does not move.";

/// The whole page.
pub(crate) fn page(page: &Page<'_>) -> String {
    let title = escape(page.title);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\
         <title>{title}</title><style>{STYLE}</style></head><body>\n<h1>{title}</h1>\n\
         <p class=\"conditions\">{}</p>\n<div class=\"verdict\">\n",
        escape(page.conditions)
    );
    for line in verdicts(page.methods, page.speeds) {
        let _ = writeln!(out, "<p>{}</p>", escape(&line));
    }
    out.push_str("</div>\n");
    for diagram in page.diagrams {
        let _ = writeln!(
            out,
            "<h2>{}</h2>\n{}",
            escape(&diagram.name),
            figure(diagram, false)
        );
    }
    let (head, rows) = crossing_table(page.methods);
    if !rows.is_empty() {
        out.push_str("<h2>Crossings</h2>\n<div class=\"scroll\"><table><thead>");
        row(&mut out, "th", &head);
        out.push_str("</thead><tbody>");
        for cells in &rows {
            row(&mut out, "td", cells);
        }
        out.push_str("</tbody></table></div>\n");
    }
    gallery(
        &mut out,
        "What moves at the crossings",
        page.flutter_modes,
        true,
    );
    gallery(
        &mut out,
        "Modes of the structure on the wetted surface",
        page.modes,
        false,
    );
    let _ = writeln!(out, "<h2>Conventions</h2>\n<p>{CONVENTIONS}</p>");
    if !page.facts.is_empty() {
        out.push_str("<h2>Inputs and effort</h2>\n<table class=\"facts\"><tbody>");
        for (name, value) in page.facts {
            row(&mut out, "td", &[name.clone(), value.clone()]);
        }
        out.push_str("</tbody></table>\n");
    }
    out.push_str("</body></html>\n");
    out
}

fn row(out: &mut String, tag: &str, cells: &[String]) {
    out.push_str("<tr>");
    for cell in cells {
        let _ = write!(out, "<{tag}>{}</{tag}>", escape(cell));
    }
    out.push_str("</tr>");
}

fn gallery(out: &mut String, heading: &str, pictures: &[Named], is_open: bool) {
    if pictures.is_empty() {
        return;
    }
    let open = if is_open { " open" } else { "" };
    let _ = write!(
        out,
        "<h2>{heading}</h2>\n<details{open}><summary>{} pictures</summary><div class=\"pair\">\n",
        pictures.len()
    );
    for picture in pictures {
        out.push_str(&figure(picture, true));
    }
    out.push_str("</div></details>\n");
}

fn figure(picture: &Named, with_caption: bool) -> String {
    let caption = if with_caption {
        format!("<figcaption>{}</figcaption>", escape(&picture.name))
    } else {
        String::new()
    };
    format!(
        "<figure><img alt=\"{}\" src=\"data:image/svg+xml,{}\">{caption}</figure>\n",
        escape(&picture.name),
        data(&picture.picture)
    )
}

/// A picture as a data address in double quotes: what would end or change it in percent form
/// (RFC 3986), and its own double quotes as single ones, of which it has none.
fn data(svg: &str) -> String {
    let mut out = String::with_capacity(svg.len() + svg.len() / 16);
    for letter in svg.chars() {
        match letter {
            '%' | '#' | '&' | '\'' => {
                let _ = write!(out, "%{:02X}", letter as u32);
            }
            '"' => out.push('\''),
            '\n' | '\r' | '\t' => out.push(' '),
            other => out.push(other),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_names_and_pictures_stays_text() {
        let picture = Named {
            name: "a <b> & \"c\"".to_owned(),
            picture: "<svg id=\"x\">50 % #</svg>\n".to_owned(),
        };
        let text = page(&Page {
            title: "<script>alert(1)</script>",
            conditions: "",
            methods: &Methods::default(),
            speeds: &[],
            diagrams: &[],
            flutter_modes: &[picture],
            modes: &[],
            facts: &[],
        });
        assert!(!text.contains("<script>"));
        assert!(text.contains("a &lt;b&gt; &amp; &quot;c&quot;"));
        assert!(text.contains("src=\"data:image/svg+xml,<svg id='x'>50 %25 %23</svg> \""));
        assert!(!text.contains("http"));
    }
}
