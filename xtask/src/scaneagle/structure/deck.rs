//! The model as CalculiX input.
//!
//! Of CalculiX 2.20: layered shells and springs exclude each other; six and eight nodes are
//! the only shells with an offset-free thick section; a data line of one character is dropped,
//! so numbers stand with a point or a comma.

use std::fmt::Write;

use fladder_mesh::Vec3;

use super::mesh::{PORT, starboard};
use super::model::Model;

/// Sets that carry the surface, by the begin or end of their names.
fn is_skin(set: &str) -> bool {
    let set = starboard(set);
    set.starts_with("FUS")
        || ["LE", "CAP", "BOX", "TE", "CS"]
            .iter()
            .any(|end| set.len() == end.len() + 1 && set.ends_with(end))
}

/// The whole file; the same bytes for the same tables.
pub(super) fn deck(model: &Model) -> String {
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = write_deck(&mut text, model);
    text
}

fn write_deck(text: &mut String, model: &Model) -> std::fmt::Result {
    let (mesh, joints) = (&model.mesh, &model.joints);
    let first = mesh.nodes.len() + 1;
    write_nodes(text, "SHELL", 1, &mesh.nodes)?;
    write_nodes(text, "JOINT", first, &joints.nodes)?;
    for (set, cells) in &mesh.sets {
        let kind = if mesh.cells[cells[0] - 1].len() == 8 {
            "S8R"
        } else {
            "S6"
        };
        writeln!(text, "*ELEMENT, TYPE={kind}, ELSET={set}")?;
        for cell in cells {
            write!(text, "{cell}")?;
            for node in &mesh.cells[cell - 1] {
                write!(text, ",{node}")?;
            }
            writeln!(text)?;
        }
    }
    let mut element = mesh.cells.len();
    for (number, balance) in joints.masses.iter().enumerate() {
        element += 1;
        let (node, mass) = (balance.node, balance.mass);
        writeln!(
            text,
            "*ELEMENT, TYPE=MASS, ELSET=BAL{number}\n{element},{node}"
        )?;
        writeln!(text, "*MASS, ELSET=BAL{number}\n{mass:.6e}")?;
    }
    for (number, spring) in joints.springs.iter().enumerate() {
        element += 1;
        let (scalar, fixed) = (spring.scalar, spring.fixed);
        writeln!(text, "** {}", spring.name)?;
        writeln!(text, "*ELEMENT, TYPE=SPRINGA, ELSET=SPR{number}")?;
        writeln!(text, "{element},{scalar},{fixed}")?;
        writeln!(
            text,
            "*SPRING, ELSET=SPR{number}\n\n{:.6e}",
            spring.stiffness
        )?;
        writeln!(text, "*BOUNDARY\n{scalar},2,3\n{fixed},1,3")?;
    }
    write_sections(text, model)?;
    for (number, rigid) in joints.rigid.iter().enumerate() {
        write_set(text, &format!("RB{number}"), &rigid.nodes)?;
        let (reference, rotation) = (rigid.reference, rigid.rotation);
        writeln!(
            text,
            "*RIGID BODY, NSET=RB{number}, REF NODE={reference}, ROT NODE={rotation}"
        )?;
    }
    for equation in &joints.equations {
        writeln!(text, "*EQUATION\n{},", equation.len())?;
        for terms in equation.chunks(4) {
            let terms: Vec<String> = terms
                .iter()
                .map(|(node, direction, factor)| format!("{node},{direction},{factor:.9e}"))
                .collect();
            writeln!(text, "{}", terms.join(","))?;
        }
    }
    let mut out = mesh.nodes_of(is_skin);
    out.extend(joints.springs.iter().map(|spring| spring.scalar));
    write_set(text, "OUT", &out)?;
    writeln!(text, "*STEP\n*FREQUENCY\n{},", model.modes)?;
    writeln!(text, "*NODE FILE, OUTPUT=2D, NSET=OUT\nU\n*END STEP")
}

/// A tenth of a micrometre.
fn write_nodes(text: &mut String, set: &str, first: usize, nodes: &[Vec3]) -> std::fmt::Result {
    writeln!(text, "*NODE, NSET={set}")?;
    for (number, node) in (first..).zip(nodes) {
        writeln!(text, "{number},{:.7},{:.7},{:.7}", node.x, node.y, node.z)?;
    }
    Ok(())
}

fn write_set(text: &mut String, name: &str, nodes: &[usize]) -> std::fmt::Result {
    writeln!(text, "*NSET, NSET={name}")?;
    for row in nodes.chunks(12) {
        let row: Vec<String> = row.iter().map(usize::to_string).collect();
        writeln!(text, "{},", row.join(","))?;
    }
    Ok(())
}

/// Layers of the wing run along it, those of the fuselage along x.
fn write_sections(text: &mut String, model: &Model) -> std::fmt::Result {
    for (letter, grain) in ['W', 'L'].into_iter().zip(model.grain) {
        for (side, sign) in [("", 1.0), (PORT, -1.0)] {
            writeln!(
                text,
                "*ORIENTATION, NAME=O{letter}{side}, SYSTEM=RECTANGULAR"
            )?;
            let y = sign * grain.y;
            writeln!(text, "{:.8},{y:.8},{:.8},1.0,0.0,0.0", grain.x, grain.z)?;
        }
    }
    writeln!(
        text,
        "*ORIENTATION, NAME=OF, SYSTEM=RECTANGULAR\n1.0,0.0,0.0,0.0,1.0,0.05"
    )?;
    for (set, laminate) in &model.laminates {
        if !model.mesh.sets.contains_key(set) {
            continue;
        }
        let [along, across, shear, transverse] = laminate.moduli;
        let nu = laminate.poisson;
        writeln!(
            text,
            "*MATERIAL, NAME=M{set}\n*ELASTIC,TYPE=ENGINEERING CONSTANTS"
        )?;
        writeln!(
            text,
            "{along:.6e},{across:.6e},{across:.6e},{nu:.6},{nu:.6},{nu:.6},{shear:.6e},{transverse:.6e}"
        )?;
        writeln!(text, "{transverse:.6e}")?;
        let density = laminate.area_density / laminate.thickness;
        writeln!(text, "*DENSITY\n{density:.8e}")?;
        for side in ["", PORT] {
            let orientation = match set.chars().next() {
                Some(letter @ ('W' | 'L')) => format!("O{letter}{side}"),
                _ => "OF".to_owned(),
            };
            writeln!(
                text,
                "*SHELL SECTION, ELSET={set}{side}, MATERIAL=M{set}, ORIENTATION={orientation}"
            )?;
            writeln!(text, "{:.8e}", laminate.thickness)?;
        }
    }
    Ok(())
}
