//! A mode on the wetted surface, seen from above, ahead and port.
//!
//! The surface is drawn deflected, visible triangles from far to near, over its
//! outline at rest. Colour is the displacement along the direction of the largest
//! one: node lines are pale, what moves the other way is blue.

use super::svg::{Anchor, Svg, Type};
use super::view::{HEIGHT, LIGHT, MARGIN, Page, View, WIDTH, heading};
use fladder_mesh::{TriMesh, Vec3};
use std::collections::BTreeMap;

/// What a picture shows.
#[derive(Clone, Copy, Debug)]
pub struct ModePicture<'a> {
    /// Heading: name and frequency.
    pub title: &'a str,
    /// The surface at rest.
    pub mesh: &'a TriMesh,
    /// One displacement a vertex.
    pub displacement: &'a [Vec3],
}

/// Largest displacement in the picture, relative to the diagonal of the surface.
const DEFLECTION: f64 = 0.08;

/// Edges sharper than this cosine between normals belong to the outline at rest.
const SHARP: f64 = 0.6;

/// Triangles above which corners are put on a coarser raster, so that small ones
/// vanish: a picture for the eye needs no more.
const MOST_TRIANGLES: usize = 3500;

/// Steps of colour on each side, and of shade.
const COLOURS: f64 = 10.0;
const SHADES: f64 = 8.0;

/// The picture as an SVG file; `None` where the surface or the mode is not
/// finite or has no extent.
pub fn mode_shape(picture: &ModePicture<'_>) -> Option<String> {
    let ModePicture {
        title,
        mesh,
        displacement,
    } = *picture;
    let (low, high) = mesh.bounds()?;
    let size = (high - low).norm();
    let peak = displacement
        .iter()
        .max_by(|a, b| a.norm().total_cmp(&b.norm()))?;
    let largest = peak.norm();
    if !(size > 0.0 && size.is_finite() && largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let view = View::new();
    let factor = DEFLECTION * size / largest;
    let rest: Vec<Vec3> = mesh.vertices.iter().map(|p| view.turn(p)).collect();
    let moved: Vec<Vec3> = mesh
        .vertices
        .iter()
        .zip(displacement)
        .map(|(p, u)| view.turn(&(p + u * factor)))
        .collect();
    let along = peak / largest;
    let value: Vec<f64> = displacement
        .iter()
        .map(|u| u.dot(&along) / largest)
        .collect();
    let page = Page::around(rest.iter().chain(&moved));
    let mut svg = Svg::new(WIDTH, HEIGHT);
    let caption = format!(
        "deflected so that the largest displacement is {:.0} % of the diagonal; grey: at rest",
        100.0 * DEFLECTION
    );
    heading(&mut svg, title, &caption);
    for [a, b] in outline(mesh, &rest) {
        svg.line(
            page.place(&rest[a as usize]),
            page.place(&rest[b as usize]),
            "#a0a0a0",
            0.8,
        );
    }
    paint(&mut svg, mesh, &moved, &value, &page);
    legend(&mut svg, &along);
    Some(svg.finish())
}

/// Edges between what the eye sees and what it does not, and sharp ones.
fn outline(mesh: &TriMesh, rest: &[Vec3]) -> Vec<[u32; 2]> {
    let mut normals: BTreeMap<[u32; 2], Vec<Vec3>> = BTreeMap::new();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| rest[v as usize]);
        let normal = (b - a)
            .cross(&(c - a))
            .try_normalize(0.0)
            .unwrap_or_default();
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            normals
                .entry([a.min(b), a.max(b)])
                .or_default()
                .push(normal);
        }
    }
    let is_line = |normals: &Vec<Vec3>| match normals[..] {
        [a, b] => (a.z > 0.0) != (b.z > 0.0) || (a.dot(&b) < SHARP && a.z.max(b.z) > 0.0),
        _ => true,
    };
    let lines = normals.into_iter().filter(|(_, normals)| is_line(normals));
    lines.map(|(edge, _)| edge).collect()
}

/// A triangle ready to be drawn.
struct Facet {
    depth: f64,
    corners: [[i32; 2]; 3],
    fill: [u8; 3],
}

fn paint(svg: &mut Svg, mesh: &TriMesh, moved: &[Vec3], value: &[f64], page: &Page) {
    let mut raster = 1.0;
    let mut facets = facets(mesh, moved, value, page, raster);
    while facets.len() > MOST_TRIANGLES && raster < 12.0 {
        raster += 1.0;
        facets = self::facets(mesh, moved, value, page, raster);
    }
    facets.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    for run in facets.chunk_by(|a, b| a.fill == b.fill) {
        let triangles: Vec<[[i32; 2]; 3]> = run.iter().map(|facet| facet.corners).collect();
        let [r, g, b] = run[0].fill;
        svg.triangles(&triangles, &format!("#{r:02x}{g:02x}{b:02x}"));
    }
}

fn facets(
    mesh: &TriMesh,
    moved: &[Vec3],
    value: &[f64],
    page: &Page,
    raster: f64,
) -> Vec<Facet> {
    let light = Vec3::from(LIGHT).normalize();
    let facet = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|v| moved[v as usize]);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        let corners = [a, b, c].map(|p| {
            page.place(&p)
                .map(|x| ((x / raster).round() * raster) as i32)
        });
        let collapsed =
            corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
        if normal.z <= 0.0 || collapsed {
            return None;
        }
        let mean = triangle.iter().map(|v| value[*v as usize]).sum::<f64>() / 3.0;
        let shade = 0.62 + 0.38 * (normal.dot(&light).max(0.0) * SHADES).round() / SHADES;
        Some(Facet {
            depth: a.z + b.z + c.z,
            corners,
            fill: colour(mean).map(|part| (part * shade).round() as u8),
        })
    };
    mesh.triangles.iter().filter_map(facet).collect()
}

/// Blue, pale grey, red: parts of 255, in steps.
fn colour(value: f64) -> [f64; 3] {
    let step = (value.clamp(-1.0, 1.0) * COLOURS).round() / COLOURS;
    let end = if step < 0.0 {
        [33.0, 102.0, 172.0]
    } else {
        [178.0, 24.0, 43.0]
    };
    let share = step.abs().powf(0.8);
    [0, 1, 2].map(|k| 240.0 + (end[k] - 240.0) * share)
}

fn legend(svg: &mut Svg, along: &Vec3) {
    let (left, top, width) = (MARGIN, HEIGHT - 26.0, 12.0);
    for k in -5..=5 {
        let [r, g, b] = colour(f64::from(k) / 5.0).map(|part| part.round() as u8);
        let corner = [left + f64::from(k + 5) * width, top];
        svg.rectangle(
            corner,
            [width, 10.0],
            &format!("fill=\"#{r:02x}{g:02x}{b:02x}\""),
        );
    }
    let parts = [along.x, along.y, along.z].map(|part| crate::figures::fixed(part, 2));
    let text = format!(
        "−1 to 1: displacement along ({}), the direction of the largest; x aft, y starboard, z up",
        parts.join(", ")
    );
    svg.text(
        [left + 11.0 * width + 10.0, top + 9.0],
        &text,
        Type::new(11.0, Anchor::Start),
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use fladder_mesh::shapes::icosphere;

    #[test]
    fn a_mode_is_drawn_in_both_colours_and_a_motionless_one_is_not() {
        let mesh = icosphere(3);
        let bend: Vec<Vec3> = mesh.vertices.iter().map(|p| Vec3::z() * p.y).collect();
        let picture = ModePicture {
            title: "elastic:1, <7> Hz",
            mesh: &mesh,
            displacement: &bend,
        };
        let text = mode_shape(&picture).expect("a picture");
        assert!(text.contains("elastic:1, &lt;7&gt; Hz") && text.ends_with("</svg>\n"));
        let runs = text.matches("<path").count();
        assert!(runs > 20 && runs < mesh.triangles.len(), "{runs}");
        assert_eq!(text, mode_shape(&picture).expect("the same"));
        let still = vec![Vec3::zeros(); mesh.vertices.len()];
        assert!(
            mode_shape(&ModePicture {
                displacement: &still,
                ..picture
            })
            .is_none()
        );
    }

    #[test]
    fn large_surfaces_are_drawn_with_fewer_triangles() {
        let mesh = icosphere(65);
        let shape: Vec<Vec3> = mesh.vertices.clone();
        let picture = ModePicture {
            title: "",
            mesh: &mesh,
            displacement: &shape,
        };
        let text = mode_shape(&picture).expect("a picture");
        assert!(
            mesh.triangles.len() > 80_000 && text.len() < 600_000,
            "{}",
            text.len()
        );
    }
}
