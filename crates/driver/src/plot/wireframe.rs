//! Cells of a surface or a structure as lines, near ones before far ones.

use super::svg::Svg;
use super::view::{HEIGHT, LIGHT, Page, View, WIDTH, heading};
use fladder_mesh::Vec3;

/// What a picture shows.
#[derive(Clone, Copy, Debug)]
pub struct Wireframe<'a> {
    /// Heading.
    pub title: &'a str,
    /// A line under it.
    pub caption: &'a str,
    /// Points of the cells.
    pub points: &'a [Vec3],
    /// Triangles, of any orientation.
    pub triangles: &'a [[u32; 3]],
    /// Lines.
    pub lines: &'a [[u32; 2]],
    /// Whether triangles seen from behind are left out: right for closed surfaces, whose
    /// normals point outward.
    pub is_closed: bool,
}

/// Steps of shade.
const SHADES: f64 = 8.0;
/// Triangles above which borders are thin.
const MANY: usize = 8000;

/// The picture as an SVG file; `None` where there is nothing finite to draw.
pub fn wireframe(picture: &Wireframe<'_>) -> Option<String> {
    let view = View::new();
    let points: Vec<Vec3> = picture.points.iter().map(|p| view.turn(p)).collect();
    let point = |number: &u32| points.get(*number as usize).copied();
    let used = picture.triangles.as_flattened().iter();
    let used: Option<Vec<Vec3>> = used
        .chain(picture.lines.as_flattened())
        .map(point)
        .collect();
    let used = used.filter(|used| {
        !used.is_empty() && used.iter().all(|p| p.iter().all(|x| x.is_finite()))
    })?;
    let page = Page::around(used.iter());
    let light = Vec3::from(LIGHT).normalize();
    let mut facets: Vec<(f64, [[i32; 2]; 3], u8)> = Vec::new();
    for triangle in picture.triangles {
        let [a, b, c] = triangle.map(|v| points[v as usize]);
        let Some(normal) = (b - a).cross(&(c - a)).try_normalize(0.0) else {
            continue;
        };
        if picture.is_closed && normal.z <= 0.0 {
            continue;
        }
        let facing = if normal.z < 0.0 { -normal } else { normal };
        let step = (facing.dot(&light).max(0.0) * SHADES).round() / SHADES;
        let corners = [a, b, c].map(|p| page.place(&p).map(|x| (10.0 * x).round() as i32));
        facets.push((a.z + b.z + c.z, corners, (200.0 + 50.0 * step) as u8));
    }
    facets.sort_by(|a, b| a.0.total_cmp(&b.0));
    let width = if facets.len() > MANY { 0.25 } else { 0.5 };
    let mut svg = Svg::new(WIDTH, HEIGHT);
    heading(&mut svg, picture.title, picture.caption);
    for run in facets.chunk_by(|a, b| a.2 == b.2) {
        let corners: Vec<[[i32; 2]; 3]> = run.iter().map(|facet| facet.1).collect();
        let shade = run[0].2;
        let fill = format!("#{shade:02x}{shade:02x}{shade:02x}");
        svg.outlined_triangles(&corners, 0.1, &fill, LINE, width);
    }
    for [a, b] in picture.lines {
        let [a, b] = [a, b].map(|v| page.place(&points[*v as usize]));
        svg.line(a, b, STICK, 1.5);
    }
    Some(svg.finish())
}

/// Colour of borders.
const LINE: &str = "#24506e";
/// Colour of lines that are cells of their own.
const STICK: &str = "#d55e00";

#[cfg(test)]
mod tests {
    use super::*;
    use fladder_mesh::shapes::icosphere;

    #[test]
    fn a_closed_surface_shows_its_near_half_and_nothing_is_no_picture() {
        let mesh = icosphere(2);
        let picture = Wireframe {
            title: "a <mesh>",
            caption: "",
            points: &mesh.vertices,
            triangles: &mesh.triangles,
            lines: &[[0, 1]],
            is_closed: true,
        };
        let near = wireframe(&picture).expect("a picture");
        let all = wireframe(&Wireframe {
            is_closed: false,
            ..picture
        })
        .expect("a picture");
        assert!(near.contains("a &lt;mesh&gt;") && near.len() < all.len());
        let nothing = Wireframe {
            triangles: &[],
            lines: &[],
            ..picture
        };
        assert!(wireframe(&nothing).is_none());
        let beyond = Wireframe {
            lines: &[[0, 1_000_000]],
            ..picture
        };
        assert!(wireframe(&beyond).is_none());
    }
}
