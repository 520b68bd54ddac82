//! Nastran `.op2` and binary `.frd` files.

use super::{lambda, rotation};
use fladder_modal::ModalResult;

/// Writes tables.
pub(crate) struct Tables {
    bytes: Vec<u8>,
    wide: bool,
    big_endian: bool,
}

/// One word.
#[derive(Clone, Copy)]
pub(crate) enum Word {
    Int(i64),
    Real(f64),
    /// Four letters.
    Text([u8; 4]),
}

impl Tables {
    fn word(&self, word: Word) -> Vec<u8> {
        let mut bytes = match (word, self.wide) {
            (Word::Int(value), true) => value.to_le_bytes().to_vec(),
            (Word::Int(value), false) => (value as i32).to_le_bytes().to_vec(),
            (Word::Real(value), true) => value.to_le_bytes().to_vec(),
            (Word::Real(value), false) => (value as f32).to_le_bytes().to_vec(),
            (Word::Text(letters), wide) => {
                let mut text = letters.to_vec();
                text.resize(if wide { 8 } else { 4 }, b' ');
                return text;
            }
        };
        if self.big_endian {
            bytes.reverse();
        }
        bytes
    }

    fn record(&mut self, words: &[Word]) {
        let content: Vec<u8> = words.iter().flat_map(|word| self.word(*word)).collect();
        let mut length = (content.len() as i32).to_le_bytes();
        if self.big_endian {
            length.reverse();
        }
        self.bytes.extend(length);
        self.bytes.extend(content);
        self.bytes.extend(length);
    }

    fn key(&mut self, key: i64) {
        self.record(&[Word::Int(key)]);
    }

    fn data(&mut self, words: &[Word]) {
        // Long runs come in several records.
        for part in words.chunks(101) {
            self.key(part.len() as i64);
            self.record(part);
        }
    }

    fn table(&mut self, name: &str, blocks: &[Vec<Word>]) {
        let letters = format!("{name:<8}");
        let name: Vec<Word> = letters
            .as_bytes()
            .chunks(4)
            .map(|part| Word::Text(part.try_into().unwrap()))
            .collect();
        self.data(&name);
        self.key(-1);
        self.data(&[Word::Int(0); 7]);
        self.key(-2);
        self.data(&[Word::Int(0)]);
        self.data(&name);
        for (number, block) in (3..).zip(blocks) {
            self.key(-number);
            self.data(&[Word::Int(0)]);
            self.data(block);
        }
        self.key(-3 - blocks.len() as i64);
        self.data(&[Word::Int(0)]);
        self.key(0);
    }
}

pub(crate) fn op2(contents: &ModalResult, wide: bool, big_endian: bool) -> Vec<u8> {
    let mut out = Tables {
        bytes: Vec::new(),
        wide,
        big_endian,
    };
    out.data(&[Word::Int(1); 3]);
    out.data(&[Word::Text(*b"TAPE"); 7]);
    out.data(&[Word::Text(*b"XXXX"); 2]);
    out.key(-1);
    out.key(0);
    let mut grids = [4501, 45, 1].map(Word::Int).to_vec();
    for node in &contents.nodes {
        let p = node.position;
        grids.extend([node.id as i64, 0].map(Word::Int));
        grids.extend([p.x, p.y, p.z].map(Word::Real));
        grids.extend([0; 3].map(Word::Int));
    }
    out.table("GEOM1", &[grids, [65535; 3].map(Word::Int).to_vec()]);
    let mut rows = Vec::new();
    for mode in &contents.modes {
        let (l, f, m) = (lambda(mode), mode.frequency_hz, mode.generalised_mass);
        rows.extend([i64::from(mode.index); 2].map(Word::Int));
        rows.extend([l, l.sqrt(), f, m, l * m].map(Word::Real));
    }
    out.table("LAMA", &[vec![Word::Int(0); 146], rows]);
    let mut blocks = Vec::new();
    for mode in &contents.modes {
        let mut head = vec![Word::Int(0); 146];
        for (at, value) in [
            (1, 21),
            (2, 7),
            (4, 1),
            (5, i64::from(mode.index)),
            (9, 1),
            (10, 8),
        ] {
            head[at - 1] = Word::Int(value);
        }
        head[5] = Word::Real(lambda(mode));
        blocks.push(head);
        let mut values = Vec::new();
        for (node, u) in contents.nodes.iter().zip(&mode.displacement) {
            values.extend([10 * node.id as i64 + 1, 1].map(Word::Int));
            values.extend([u.x, u.y, u.z].map(Word::Real));
            let r = rotation(u);
            values.extend([r.x, r.y, r.z].map(Word::Real));
        }
        blocks.push(values);
    }
    out.table("OUGV1", &blocks);
    out.key(0);
    out.bytes
}

pub(crate) fn frd_binary(contents: &ModalResult) -> Vec<u8> {
    let mut out = b"    1C\n".to_vec();
    let count = contents.nodes.len();
    out.extend(format!("    2C                  {count:12}{:37}3\n", "").bytes());
    for node in &contents.nodes {
        out.extend((node.id as i32).to_le_bytes());
        node.position
            .iter()
            .for_each(|x| out.extend(x.to_le_bytes()));
    }
    for mode in &contents.modes {
        let index = mode.index;
        for (name, value) in [
            ("GM ", mode.generalised_mass),
            ("GK ", lambda(mode) * mode.generalised_mass),
        ] {
            out.extend(format!("    1P{name}                {value:.16E}\n").bytes());
        }
        out.extend(format!("    1PMODE{index:26}\n").bytes());
        let frequency = super::super::common::e12(mode.frequency_hz);
        let head = format!("  100CL{:5}{frequency}{count:12}", 100 + index);
        out.extend(format!("{head}{:20} 2{index:5}MODAL      2\n", "").bytes());
        out.extend(b" -4  DISP        4    1\n");
        for component in 1..=3 {
            out.extend(
                format!(" -5  D{component}          1    2    {component}    0\n").bytes(),
            );
        }
        out.extend(b" -5  ALL         1    2    0    0    1ALL\n");
        for (node, u) in contents.nodes.iter().zip(&mode.displacement) {
            out.extend((node.id as i32).to_le_bytes());
            u.iter().for_each(|x| out.extend((*x as f32).to_le_bytes()));
        }
    }
    out.extend(b" 9999\n");
    out
}
