//! Modes that move a part of the surface: deflections of controls.

use fladder_mesh::{SurfaceMode, TriMesh, Vec3};

/// Leaves the displacement on the vertices of the named groups' triangles and
/// sets it to zero elsewhere.
///
/// Vertices that the group shares with its neighbours move with the group: on
/// the hinge line they hardly do, and beside the ends of the control the
/// neighbouring triangles are sheared.
///
/// # Errors
/// A sentence for a name the mesh does not have, and for a field that is zero
/// on the groups.
pub(crate) fn restrict(
    mode: &mut SurfaceMode,
    mesh: &TriMesh,
    groups: &[String],
) -> Result<(), String> {
    let mut moves = vec![false; mesh.vertices.len()];
    for name in groups {
        let Some(group) = mesh.surface(name) else {
            let there: Vec<&str> = mesh.surfaces.iter().map(|g| g.name.as_str()).collect();
            return Err(format!(
                "the mesh has no surface group `{name}`; it has {there:?}"
            ));
        };
        for &t in &group.triangles {
            for v in mesh.triangles[t as usize] {
                moves[v as usize] = true;
            }
        }
    }
    for (u, moves) in mode.displacement.iter_mut().zip(moves) {
        if !moves {
            *u = Vec3::zeros();
        }
    }
    if mode.displacement.iter().all(|u| *u == Vec3::zeros()) {
        return Err(format!("mode {} moves no vertex of {groups:?}", mode.name));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use fladder_mesh::{Frame, SurfaceGroup, shapes::icosphere};

    fn mode(count: usize) -> SurfaceMode {
        SurfaceMode {
            name: "flap".to_owned(),
            frame: Frame::Inertial,
            displacement: vec![Vec3::z(); count],
        }
    }

    #[test]
    fn only_the_vertices_of_the_group_move() {
        let mut mesh = icosphere(2);
        mesh.surfaces.push(SurfaceGroup {
            name: "flap".to_owned(),
            triangles: vec![3, 4],
        });
        let mut flap = mode(mesh.vertices.len());
        restrict(&mut flap, &mesh, &["flap".to_owned()]).unwrap();
        for (v, u) in (0..).zip(&flap.displacement) {
            let belongs = [3, 4]
                .iter()
                .any(|&t: &usize| mesh.triangles[t].contains(&v));
            assert_eq!(u.norm(), f64::from(belongs));
        }
        let error = restrict(&mut flap, &mesh, &["flaps".to_owned()]).unwrap_err();
        assert_eq!(
            error,
            "the mesh has no surface group `flaps`; it has [\"body\", \"flap\"]"
        );
    }
}
