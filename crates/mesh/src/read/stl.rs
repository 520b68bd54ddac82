//! STL, the triangle soup.
//!
//! Text: `facet` … `endfacet` inside `solid NAME` … `endsolid`, as many solids
//! as there are. Binary: 80 bytes of header, a count, 50 bytes a triangle.
//! Equal corners are welded into vertices; the file's normals are not used.

use super::cursor::{Cursor, Malformed, WRITE_AGAIN};
use super::draft::Draft;
use crate::Vec3;
use crate::weld::{WELD_TOLERANCE, weld};

/// Bytes before the first triangle of a binary file.
pub(super) const HEADER: usize = 84;
/// Bytes of a triangle in a binary file.
const RECORD: usize = 50;

/// Number of triangles a binary file announces.
fn announced(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(80..HEADER)?.first_chunk()?;
    usize::try_from(u32::from_le_bytes(*count)).ok()
}

/// Whether size and count agree as those of a binary STL do.
pub(super) fn is_whole_binary(bytes: &[u8]) -> bool {
    announced(bytes).is_some_and(|count| {
        count > 0
            && Some(bytes.len())
                == count
                    .checked_mul(RECORD)
                    .and_then(|n| n.checked_add(HEADER))
    })
}

pub(super) fn parse_binary(bytes: &[u8]) -> Result<Draft, Malformed> {
    let count = announced(bytes).unwrap_or(0);
    if !is_whole_binary(bytes) {
        let room = bytes.len().saturating_sub(HEADER);
        return Err(Malformed::whole(
            format!(
                "taken as binary STL, the file announces {count} triangles, but {room} bytes follow, \
                 which hold {} and {} bytes over",
                room / RECORD,
                room % RECORD
            ),
            WRITE_AGAIN,
        ));
    }
    // A header that begins with `solid` would be taken for text.
    let mut copy = bytes.to_vec();
    copy[..80].fill(0);
    let fault = |error: std::io::Error| Malformed::whole(error.to_string(), WRITE_AGAIN);
    let mut source = std::io::Cursor::new(copy);
    let mut corners = Vec::with_capacity(3 * count);
    for triangle in stl_io::create_stl_reader(&mut source).map_err(fault)? {
        let triangle = triangle.map_err(fault)?;
        corners.extend(
            triangle
                .vertices
                .iter()
                .map(|v| Vec3::from(v.0.map(f64::from))),
        );
    }
    let mut draft = Draft::default();
    join(&mut draft, &corners);
    Ok(draft)
}

pub(super) fn parse_ascii(bytes: &[u8]) -> Result<Draft, Malformed> {
    let mut cursor = Cursor::new(bytes);
    let mut draft = Draft::default();
    let mut corners: Vec<Vec3> = Vec::new();
    let mut solid: Option<(String, u32)> = None;
    loop {
        cursor.skip_space();
        if cursor.remaining() == 0 {
            break;
        }
        let word = cursor.word()?;
        let n_triangles = (corners.len() / 3) as u32;
        match (word.to_ascii_lowercase().as_str(), &solid) {
            ("solid", None) => {
                let name = String::from_utf8_lossy(cursor.line().unwrap_or_default())
                    .trim()
                    .to_owned();
                solid = Some((name, n_triangles));
            }
            ("endsolid", Some((name, first))) => {
                if !name.is_empty() {
                    draft.add_to_surface(name, *first..n_triangles);
                }
                solid = None;
                cursor.line();
            }
            ("facet", Some(_)) => corners.extend(facet(&mut cursor)?),
            (_, state) => {
                let wanted = if state.is_some() {
                    "`facet` or `endsolid`"
                } else {
                    "`solid`"
                };
                let shown: String = word.chars().take(40).collect();
                return Err(cursor.fault(
                    format!("{wanted} should stand here, not `{shown}`"),
                    WRITE_AGAIN,
                ));
            }
        }
    }
    if solid.is_some() {
        return Err(cursor.fault("the file ends inside a solid", WRITE_AGAIN));
    }
    draft.notes.extend(cursor.note_of_not_finite());
    join(&mut draft, &corners);
    Ok(draft)
}

/// The three corners of a facet, after its first word.
fn facet(cursor: &mut Cursor) -> Result<[Vec3; 3], Malformed> {
    expect(cursor, "normal")?;
    for _ in 0..3 {
        // Any word will do: the normal is not used, and some programs write nan.
        cursor.word()?;
    }
    expect(cursor, "outer")?;
    expect(cursor, "loop")?;
    let mut corners = [Vec3::zeros(); 3];
    for corner in &mut corners {
        expect(cursor, "vertex")?;
        *corner = cursor.position()?;
    }
    expect(cursor, "endloop")?;
    expect(cursor, "endfacet")?;
    Ok(corners)
}

fn expect(cursor: &mut Cursor, wanted: &str) -> Result<(), Malformed> {
    let word = cursor.word()?;
    if word.eq_ignore_ascii_case(wanted) {
        return Ok(());
    }
    let shown: String = word.chars().take(40).collect();
    Err(cursor.fault(
        format!("`{wanted}` should stand here, not `{shown}`"),
        WRITE_AGAIN,
    ))
}

/// Welds the soup; a triangle that would collapse keeps its own corners, so
/// that the judge sees its area.
fn join(draft: &mut Draft, corners: &[Vec3]) {
    let soup: Vec<[u32; 3]> = (0..corners.len() as u32 / 3)
        .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
        .collect();
    let welded = weld(corners, WELD_TOLERANCE);
    let n_vertices = welded.kept.len();
    draft.notes.push(format!(
        "{} corners of {} triangles welded to {n_vertices} vertices, tolerance {:.3e} file units",
        corners.len(),
        soup.len(),
        welded.tolerance
    ));
    draft.vertices = welded.kept.iter().map(|&v| corners[v as usize]).collect();
    for t in soup {
        let joined = t.map(|v| welded.image[v as usize]);
        let [a, b, c] = joined;
        if a != b && b != c && c != a {
            draft.triangles.push(joined);
            continue;
        }
        let own = draft.vertices.len() as u32;
        draft.vertices.extend(t.map(|v| corners[v as usize]));
        draft.triangles.push([own, own + 1, own + 2]);
    }
}
