//! Gmsh files.

use fladder_modal::ModalResult;
use std::io::Write;

struct Out {
    bytes: Vec<u8>,
    binary: bool,
}

impl Out {
    fn text(&mut self, text: &str) {
        self.bytes.extend_from_slice(text.as_bytes());
    }

    fn int(&mut self, value: i32) {
        if self.binary {
            self.bytes.extend(value.to_le_bytes());
        } else {
            write!(self.bytes, "{value} ").unwrap();
        }
    }

    fn size(&mut self, value: u64) {
        if self.binary {
            self.bytes.extend(value.to_le_bytes());
        } else {
            write!(self.bytes, "{value} ").unwrap();
        }
    }

    fn double(&mut self, value: f64) {
        if self.binary {
            self.bytes.extend(value.to_le_bytes());
        } else {
            write!(self.bytes, "{value:?} ").unwrap();
        }
    }

    fn line(&mut self) {
        if !self.binary {
            self.text("\n");
        }
    }
}

pub(crate) fn msh(contents: &ModalResult, version_4: bool, binary: bool) -> Vec<u8> {
    let mut out = Out {
        bytes: Vec::new(),
        binary,
    };
    let version = if version_4 { "4.1" } else { "2.2" };
    out.text(&format!("$MeshFormat\n{version} {} 8\n", u8::from(binary)));
    if binary {
        out.int(1);
        out.text("\n");
    }
    out.text("$EndMeshFormat\n$Nodes\n");
    let count = contents.nodes.len() as u64;
    if version_4 {
        let last = contents.nodes.last().map_or(0, |node| node.id);
        for value in [1, count, 1, last] {
            out.size(value);
        }
        out.line();
        for value in [2, 1, 0] {
            out.int(value);
        }
        out.size(count);
        out.line();
        for node in &contents.nodes {
            out.size(node.id);
            out.line();
        }
    } else {
        out.text(&format!("{count}\n"));
    }
    for node in &contents.nodes {
        if !version_4 {
            out.int(node.id as i32);
        }
        node.position.iter().for_each(|x| out.double(*x));
        out.line();
    }
    out.text("\n$EndNodes\n");
    for mode in &contents.modes {
        let time = mode.frequency_hz;
        out.text(&format!(
            "$NodeData\n1\n\"a mode\"\n1\n{time:?}\n3\n{}\n3\n{count}\n",
            mode.index
        ));
        for (node, u) in contents.nodes.iter().zip(&mode.displacement) {
            out.int(node.id as i32);
            u.iter().for_each(|x| out.double(*x));
            out.line();
        }
        out.text("\n$EndNodeData\n");
    }
    out.bytes
}
