//! What the page's script reads: branches, crossings, and the surface with its motions.

use super::super::mode_pictures::Motion;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use fladder_mesh::{TriMesh, Vec3};
use fladder_stability::{Branch, MethodResult, Methods};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(super) struct Data {
    density: Option<f64>,
    branches: Vec<Line>,
    /// Of p-k, shown as crosses.
    crosses: Vec<Line>,
    crossings: Vec<Mark>,
    #[serde(skip_serializing_if = "Option::is_none")]
    surface: Option<Surface>,
    motions: Vec<Shape>,
}

#[derive(Debug, Serialize)]
struct Line {
    name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    method: Option<&'static str>,
    speed: Vec<f64>,
    g: Vec<f64>,
    k: Vec<f64>,
    f: Vec<f64>,
    d: Vec<Option<f64>>,
    ratio: Vec<Option<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    density: Option<Vec<f64>>,
}

#[derive(Debug, Serialize)]
struct Mark {
    branch: String,
    speed: f64,
    f: f64,
    k: f64,
    density: f64,
}

/// Whole numbers of 16 bits times a scale, in base 64.
#[derive(Debug, Serialize)]
struct Packed {
    scale: f64,
    values: String,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
struct Surface {
    points: Packed,
    /// Corners, 32 bits each.
    triangles: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pressure: Option<Packed>,
    /// End of the scale of colours of the pressure coefficient.
    pressure_limit: f64,
}

#[derive(Debug, Serialize)]
struct Shape {
    name: String,
    re: Packed,
    #[serde(skip_serializing_if = "Option::is_none")]
    im: Option<Packed>,
    /// Of the largest displacement.
    direction: [f64; 3],
}

/// The surface of the page with the pressure coefficient of every triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wetted<'a> {
    pub(crate) mesh: &'a TriMesh,
    pub(crate) pressure: &'a [f32],
}

/// Digits of the numbers of diagrams: a thousandth of a pixel.
const DIGITS: i32 = 6;

impl Data {
    pub(super) fn new(
        methods: &Methods,
        best: Option<&MethodResult>,
        density: Option<f64>,
        surface: Option<Wetted<'_>>,
        motions: &[Motion],
    ) -> Self {
        let lines = |result: Option<&MethodResult>, method| -> Vec<Line> {
            let branches = result.map_or(&[][..], |result| &result.branches);
            branches.iter().map(|branch| line(branch, method)).collect()
        };
        let beside = methods
            .pk
            .as_ref()
            .filter(|_| methods.p2.is_some() || methods.polished.is_some());
        let crossings = best.map_or(&[][..], |best| &best.flutter);
        Self {
            density,
            branches: lines(best, None),
            crosses: lines(beside, Some("p-k")),
            crossings: crossings
                .iter()
                .map(|crossing| Mark {
                    branch: crossing.branch.clone(),
                    speed: crossing.speed,
                    f: crossing.frequency_hz,
                    k: crossing.k,
                    density: 2.0 * crossing.dynamic_pressure / crossing.speed.powi(2),
                })
                .collect(),
            surface: surface.map(packed_surface),
            motions: motions.iter().filter_map(shape).collect(),
        }
    }

    /// As text in which no markup of the page can end.
    pub(super) fn json(&self) -> String {
        let text = serde_json::to_string(self).unwrap_or_else(|_| "{}".to_owned());
        text.replace('<', "\\u003c")
    }
}

fn line(branch: &Branch, method: Option<&'static str>) -> Line {
    let short = |list: &[f64]| list.iter().map(|value| rounded(*value)).collect();
    let optional = |list: &[Option<f64>]| list.iter().map(|value| value.map(rounded)).collect();
    Line {
        name: branch.name.clone(),
        method,
        speed: short(&branch.speed),
        g: short(&branch.g),
        k: short(&branch.k),
        f: short(&branch.frequency_hz),
        d: optional(&branch.structural_damping),
        ratio: optional(&branch.damping_ratio),
        density: branch.density.as_deref().map(short),
    }
}

/// To so many digits behind the point.
fn rounded(value: f64) -> f64 {
    let unit = 10.0_f64.powi(DIGITS);
    (value * unit).round() / unit
}

fn pack(values: impl Iterator<Item = f64> + Clone) -> Packed {
    let largest = values.clone().map(f64::abs).fold(0.0, f64::max);
    let scale = largest.max(f64::MIN_POSITIVE) / f64::from(i16::MAX);
    let bytes: Vec<u8> = values
        .flat_map(|value| ((value / scale).round() as i16).to_le_bytes())
        .collect();
    Packed {
        scale,
        values: STANDARD.encode(bytes),
    }
}

fn pack_vectors(vectors: &[Vec3], factor: f64) -> Packed {
    pack(
        vectors
            .iter()
            .flat_map(move |v| [v.x, v.y, v.z])
            .map(move |c| c * factor),
    )
}

fn packed_surface(surface: Wetted<'_>) -> Surface {
    let corners = surface.mesh.triangles.iter().flatten();
    let triangles: Vec<u8> = corners.flat_map(|corner| corner.to_le_bytes()).collect();
    // One triangle at a leading edge must not set the scale.
    let mut sizes: Vec<f64> = surface
        .pressure
        .iter()
        .map(|p| f64::from(p.abs()))
        .collect();
    sizes.sort_by(f64::total_cmp);
    let limit = sizes.get(sizes.len() * 98 / 100).copied().unwrap_or(1.0);
    let has_pressure = surface.pressure.len() == surface.mesh.triangles.len();
    Surface {
        points: pack_vectors(&surface.mesh.vertices, 1.0),
        triangles: STANDARD.encode(triangles),
        pressure: has_pressure.then(|| pack(surface.pressure.iter().map(|p| f64::from(*p)))),
        pressure_limit: limit.max(1e-6),
    }
}

/// Largest displacement one; none where nothing moves.
fn shape(motion: &Motion) -> Option<Shape> {
    let size = |v: usize| {
        let other = motion.imaginary.get(v).map_or(0.0, Vec3::norm_squared);
        (motion.real[v].norm_squared() + other).sqrt()
    };
    let largest = (0..motion.real.len()).max_by(|a, b| size(*a).total_cmp(&size(*b)))?;
    let (length, along) = (size(largest), motion.real[largest]);
    if length <= 0.0 || !length.is_finite() || along.norm() <= 0.0 {
        return None;
    }
    let has_phase = motion.imaginary.iter().any(|v| v.norm() > 1e-9 * length);
    Some(Shape {
        name: motion.name.clone(),
        re: pack_vectors(&motion.real, 1.0 / length),
        im: has_phase.then(|| pack_vectors(&motion.imaginary, 1.0 / length)),
        direction: along.normalize().into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Packed values come back to half a unit of the last place.
    #[test]
    fn packing_keeps_four_digits() {
        let values = [0.5, -1.25, 0.0, 1e-4];
        let packed = pack(values.iter().copied());
        let bytes = STANDARD.decode(&packed.values).unwrap();
        for (value, pair) in values.iter().zip(bytes.chunks(2)) {
            let back = f64::from(i16::from_le_bytes([pair[0], pair[1]])) * packed.scale;
            assert!((back - value).abs() <= 0.5 * packed.scale + 1e-15);
        }
    }

    #[test]
    fn the_script_of_the_page_cannot_be_ended_by_a_name() {
        let branch = Branch {
            name: "</script><script>alert(1)".to_owned(),
            ..Branch::default()
        };
        let result = MethodResult {
            branches: vec![branch],
            ..MethodResult::default()
        };
        let data = Data::new(&Methods::default(), Some(&result), Some(1.2), None, &[]);
        let text = data.json();
        assert!(!text.contains('<'));
        let back: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(back["branches"][0]["name"], "</script><script>alert(1)");
    }
}
