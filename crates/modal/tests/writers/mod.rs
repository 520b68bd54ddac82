//! Writers of every format read, for random contents: layouts as in files of
//! the programs, which other tests read.

#![allow(dead_code, reason = "every test file uses another part of it")]

mod binary;
mod gmsh;
mod matrices;
mod nastran;
mod universal;

pub(crate) use binary::{frd_binary, op2};
pub(crate) use gmsh::msh;
pub(crate) use matrices::{Form, op4};
pub(crate) use nastran::{Fields, bdf, f06, pch};
pub(crate) use universal::unv;

use fladder_mesh::Vec3;
use fladder_modal::{ModalResult, Mode};
use std::f64::consts::TAU;

/// Eigenvalue of a mode.
pub(crate) fn lambda(mode: &Mode) -> f64 {
    (TAU * mode.frequency_hz).powi(2)
}

/// Rotations that go with a mode: none in the contents, so that they are made.
pub(crate) fn rotation(displacement: &Vec3) -> Vec3 {
    displacement.yzx() * -0.5
}

/// One way to write contents.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Way {
    Punch,
    Printed,
    Op2 { wide: bool, big_endian: bool },
    Op4(Form),
    Universal { results: bool },
    Gmsh { version_4: bool, binary: bool },
    FrdBinary,
    FrdText,
    Neutral,
}

/// All of them.
pub(crate) const WAYS: [Way; 21] = [
    Way::Punch,
    Way::Printed,
    Way::Op2 {
        wide: false,
        big_endian: false,
    },
    Way::Op2 {
        wide: false,
        big_endian: true,
    },
    Way::Op2 {
        wide: true,
        big_endian: false,
    },
    Way::Op2 {
        wide: true,
        big_endian: true,
    },
    Way::Op4(Form::TextDense),
    Way::Op4(Form::TextSparse),
    Way::Op4(Form::TextBig),
    Way::Op4(Form::BinaryDense),
    Way::Op4(Form::BinarySparse),
    Way::Op4(Form::BinaryBig),
    Way::Universal { results: false },
    Way::Universal { results: true },
    Way::Gmsh {
        version_4: false,
        binary: false,
    },
    Way::Gmsh {
        version_4: true,
        binary: true,
    },
    Way::Gmsh {
        version_4: false,
        binary: true,
    },
    Way::Gmsh {
        version_4: true,
        binary: false,
    },
    Way::FrdBinary,
    Way::FrdText,
    Way::Neutral,
];

impl Way {
    pub(crate) fn write(self, contents: &ModalResult) -> Vec<u8> {
        match self {
            Self::Punch => pch(contents).into_bytes(),
            Self::Printed => f06(contents).into_bytes(),
            Self::Op2 { wide, big_endian } => op2(contents, wide, big_endian),
            Self::Op4(form) => op4(contents, form),
            Self::Universal { results } => unv(contents, results).into_bytes(),
            Self::Gmsh { version_4, binary } => msh(contents, version_4, binary),
            Self::FrdBinary => frd_binary(contents),
            Self::FrdText => super::common::frd(contents).into_bytes(),
            Self::Neutral => {
                let mut bytes = Vec::new();
                fladder_modal::write_neutral(contents, &mut bytes).unwrap();
                bytes
            }
        }
    }

    /// Whether nodes come from a file of their own.
    pub(crate) fn needs_geometry(self) -> bool {
        matches!(self, Self::Punch | Self::Printed | Self::Op4(_))
    }

    /// A file that says where it ends.
    pub(crate) fn has_end(self) -> bool {
        matches!(
            self,
            Self::Op2 { .. } | Self::FrdBinary | Self::FrdText | Self::Neutral
        )
    }

    /// Rounding of a value relative to itself.
    pub(crate) fn rounding(self) -> f64 {
        match self {
            Self::Op2 { wide: true, .. } | Self::Gmsh { .. } | Self::Neutral => 0.0,
            Self::Op4(_) => 1e-15,
            Self::Op2 { wide: false, .. } | Self::FrdBinary => 6e-8,
            Self::Punch | Self::Printed => 5.1e-7,
            Self::Universal { .. } | Self::FrdText => 5.1e-6,
        }
    }

    pub(crate) fn has_rotations(self) -> bool {
        !matches!(
            self,
            Self::Gmsh { .. } | Self::FrdBinary | Self::FrdText | Self::Neutral
        )
    }

    pub(crate) fn has_masses(self) -> bool {
        matches!(
            self,
            Self::Printed
                | Self::Op2 { .. }
                | Self::Universal { .. }
                | Self::FrdBinary
                | Self::FrdText
                | Self::Neutral
        )
    }
}
