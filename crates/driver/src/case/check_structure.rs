//! What a structure must satisfy before its files are read.

use super::check::{At, Checked};
use super::structure::{Matrices, RigidBody, Structure};
use super::structure_edits;

pub(super) fn structure(given: &Structure, at: &At<'_>) -> Checked {
    if let (Some(_), Some(_)) = (&given.file, &given.matrices) {
        return Err(at.refuse(
            "structure.matrices",
            "both `structure.file` and [structure.matrices] are given",
            "each of them sets mass and stiffness",
            "remove one of the two",
        ));
    }
    if let Some([first, last]) = given.modes
        && (first == 0 || last < first)
    {
        return Err(at.refuse(
            "structure.modes",
            format!("`structure.modes` is [{first}, {last}]"),
            "elastic modes are counted from 1, the first one first",
            "write for example modes = [1, 20]",
        ));
    }
    if let (Some(_), Some(_)) = (&given.damping, &given.matrices) {
        return Err(at.refuse(
            "structure.damping",
            "`structure.damping` is given beside [structure.matrices]",
            "the matrices are taken as they are, so the coefficient would have no effect",
            "put the damping into structure.matrices.damping",
        ));
    }
    structure_edits::check(given, at)?;
    if let Some(damping) = &given.damping {
        damping
            .as_slice()
            .iter()
            .try_for_each(|value| at.not_negative("structure.damping", *value))?;
    }
    at.all_finite("structure.origin", &given.origin)?;
    if let Some(axes) = &given.axes {
        orientation(axes, at)?;
    }
    if let Some(body) = &given.rigid_body {
        rigid_body(body, given.file.is_some(), at)?;
    }
    given
        .matrices
        .as_ref()
        .map_or(Ok(()), |matrices| check_matrices(matrices, at))
}

/// The three axes must be a right-handed permutation with signs.
fn orientation(axes: &[String; 3], at: &At<'_>) -> Checked {
    let handedness = structure_axes(axes).map(|m| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    });
    if handedness == Some(1.0) {
        return Ok(());
    }
    Err(at.refuse(
        "structure.axes",
        format!("`structure.axes` is [\"{}\"]", axes.join("\", \"")),
        "the axes must be x, y, z in some order, with signs, and right-handed",
        "write for example axes = [\"-x\", \"y\", \"-z\"]",
    ))
}

/// Rows: the structure's axes as unit vectors in mesh axes.
pub(crate) fn structure_axes(axes: &[String; 3]) -> Option<[[f64; 3]; 3]> {
    let mut rows = [[0.0; 3]; 3];
    for (row, text) in rows.iter_mut().zip(axes) {
        let (sign, letter) = match text.strip_prefix('-') {
            Some(letter) => (-1.0, letter),
            None => (1.0, text.strip_prefix('+').unwrap_or(text)),
        };
        let column = ["x", "y", "z"].iter().position(|axis| *axis == letter)?;
        row[column] = sign;
    }
    Some(rows)
}

fn rigid_body(body: &RigidBody, has_file: bool, at: &At<'_>) -> Checked {
    let key = "structure.rigid_body";
    let complete = body.mass.is_some() && body.cg.is_some() && body.inertia.is_some();
    if !has_file && !complete {
        return Err(at.refuse(
            key,
            "[structure.rigid_body] lacks mass, cg or inertia, and there is no `structure.file`",
            "six rigid modes need all of them",
            "add mass (kg), cg (m) and inertia = { xx, yy, zz, xz } (kg m²)",
        ));
    }
    if let Some(mass) = body.mass {
        at.positive(&format!("{key}.mass"), mass)?;
    }
    if let Some(cg) = &body.cg {
        at.all_finite(&format!("{key}.cg"), cg)?;
    }
    let Some(inertia) = &body.inertia else {
        return Ok(());
    };
    let key = format!("{key}.inertia");
    for (axis, value) in [("xx", inertia.xx), ("yy", inertia.yy), ("zz", inertia.zz)] {
        at.positive(&format!("{key}.{axis}"), value)?;
    }
    at.finite(&format!("{key}.xz"), inertia.xz)?;
    let smallest_two = inertia.xx + inertia.yy >= inertia.zz
        && inertia.yy + inertia.zz >= inertia.xx
        && inertia.zz + inertia.xx >= inertia.yy;
    if !smallest_two || inertia.xz * inertia.xz >= inertia.xx * inertia.zz {
        return Err(at.refuse(
            &key,
            "no body has these moments of inertia",
            "two moments together are never less than the third, and xz² is less than xx · zz",
            "check the units (kg m²) and that the moments are about the centre of mass",
        ));
    }
    Ok(())
}

fn check_matrices(matrices: &Matrices, at: &At<'_>) -> Checked {
    let order = matrices.mass.len();
    let named = [
        ("mass", Some(&matrices.mass)),
        ("damping", matrices.damping.as_ref()),
        ("stiffness", Some(&matrices.stiffness)),
    ];
    for (name, matrix) in named {
        let Some(matrix) = matrix else { continue };
        let key = format!("structure.matrices.{name}");
        let is_square = matrix.len() == order && matrix.iter().all(|row| row.len() == order);
        if order == 0 || !is_square {
            return Err(at.refuse(
                &key,
                format!("`{key}` is not {order} × {order}"),
                "mass, damping and stiffness are square and of one size",
                "give one row and one column for each mode, in the order of the modes",
            ));
        }
        matrix.iter().try_for_each(|row| at.all_finite(&key, row))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_read_with_signs() {
        let axes = ["-x", "y", "-z"].map(String::from);
        let rows = structure_axes(&axes).unwrap();
        assert_eq!(rows, [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]);
        assert!(structure_axes(&["x", "y", "w"].map(String::from)).is_none());
    }
}
