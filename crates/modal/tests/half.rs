//! Half models: kinds of motion told from formulae and shapes, masses of the
//! whole, and what the symmetry plane lets a surface do.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use common::{file, mode, sample};
use fladder_mesh::{Symmetry, TriMesh, Vec3, mirrored};
use fladder_modal::{
    AnalyticMode, Component, HalfError, Inertia, ModalResult, Motion, Node, PolynomialTerm,
    RIGID_KINDS, RigidBody, StructuralModel, StructureError, StructureSettings, load,
    rigid_modes, transfer, write_neutral,
};
use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeMap;

/// The kind by definition: u(Sr) against ±S u(r) at a few places.
fn kind_by_definition(field: impl Fn(&[Vec3]) -> Vec<Vec3>) -> Symmetry {
    let points = [
        Vec3::new(0.5, 2.0, -0.25),
        Vec3::new(-1.0, 3.0, 4.0),
        Vec3::new(2.0, 0.7, 1.0),
    ];
    let images = points.map(mirrored);
    let (here, there) = (field(&points), field(&images));
    let differs = |sign: f64| {
        here.iter()
            .zip(&there)
            .any(|(u, v)| (v - mirrored(*u) * sign).norm() > 1e-12)
    };
    match (differs(1.0), differs(-1.0)) {
        (false, _) => Symmetry::Symmetric,
        (true, false) => Symmetry::Antisymmetric,
        (true, true) => Symmetry::None,
    }
}

fn term(component: Component, powers: [u32; 3], odd_y: bool) -> PolynomialTerm {
    PolynomialTerm {
        component,
        coefficient: -2.0,
        powers,
        odd_y,
    }
}

#[test]
fn the_kind_of_a_formula_is_that_of_its_field() {
    let rotation = |axis: [f64; 3], point: [f64; 3]| Motion::Rotation {
        axis: axis.into(),
        point: point.into(),
    };
    let mut motions = vec![
        Motion::Translation(Vec3::new(1.0, 0.0, 2.0)),
        Motion::Translation(Vec3::y()),
        Motion::Translation(Vec3::new(0.0, 1.0, 1.0)),
        rotation([0.0, 3.0, 0.0], [0.5, 1.0, 0.1]),
        rotation([1.0, 0.0, -2.0], [0.5, 0.0, 0.1]),
        rotation([1.0, 0.0, 0.0], [0.5, 0.2, 0.1]),
        rotation([1.0, 1.0, 0.0], [0.0; 3]),
    ];
    for component in [Component::X, Component::Y, Component::Z] {
        for (powers, odd_y) in [([1, 2, 0], false), ([0, 1, 1], true), ([2, 0, 0], true)] {
            motions.push(Motion::Polynomial(vec![term(component, powers, odd_y)]));
        }
    }
    motions.push(Motion::Polynomial(vec![
        term(Component::Z, [0, 2, 0], false),
        term(Component::Y, [0, 1, 0], true),
    ]));
    motions.push(Motion::Polynomial(vec![
        term(Component::Z, [0, 2, 0], false),
        term(Component::Z, [0, 1, 0], true),
    ]));
    let mut found = BTreeMap::new();
    for motion in motions {
        let mode = AnalyticMode {
            name: "test".to_owned(),
            motion,
        };
        let expected = kind_by_definition(|points| mode.on(points).unwrap().displacement);
        assert_eq!(mode.symmetry(), expected, "{mode:?}");
        *found.entry(expected.word()).or_insert(0) += 1;
    }
    assert_eq!(found.values().copied().collect::<Vec<i32>>(), [7, 4, 7]);
}

fn whole_body() -> RigidBody {
    RigidBody {
        mass: 17.9,
        cg: Vec3::new(0.35, 0.0, 0.02),
        inertia: Inertia {
            xx: 21.0,
            yy: 1.4,
            zz: 22.0,
            xz: 0.3,
        },
    }
}

#[test]
fn rigid_modes_are_of_the_kinds_named() {
    for (number, kind) in RIGID_KINDS.into_iter().enumerate() {
        let field = |points: &[Vec3]| {
            rigid_modes(&whole_body(), points)
                .swap_remove(number)
                .displacement
        };
        assert_eq!(kind_by_definition(field), kind);
    }
}

fn loaded(
    name: &str,
    result: &ModalResult,
    change: impl Fn(&mut StructureSettings),
) -> Result<StructuralModel, StructureError> {
    let mut bytes = Vec::new();
    write_neutral(result, &mut bytes).unwrap();
    let mut settings = StructureSettings {
        file: file(name, "half.json", bytes),
        ..StructureSettings::default()
    };
    change(&mut settings);
    load(&settings)
}

/// Three rigid modes of one kind, mixed, with generalised masses of the half.
fn half_with_rigid_modes(kind: Symmetry) -> ModalResult {
    let mut result = common::wing().result();
    let positions = result.positions();
    let unit: Vec<Vec<Vec3>> = rigid_modes(&whole_body(), &positions)
        .into_iter()
        .zip(RIGID_KINDS)
        .filter(|(_, of)| *of == kind)
        .map(|(mode, _)| mode.displacement)
        .collect();
    let Inertia { xx, zz, xz, .. } = whole_body().inertia;
    let mut mass = Matrix3::identity();
    if kind == Symmetry::Antisymmetric {
        mass[(1, 2)] = -xz / (xx * zz).sqrt();
        mass[(2, 1)] = mass[(1, 2)];
    }
    let root = mass.cholesky().unwrap().inverse();
    let orthogonal = root.cholesky().unwrap().l()
        * Matrix3::from_fn(|i, j| ((3 * i + 7 * j + i * j) as f64).sin())
            .qr()
            .q();
    for k in 0..3 {
        let [a, b, c]: [f64; 3] = Vector3::from(orthogonal.column(k)).into();
        let shape = (0..positions.len())
            .map(|n| unit[0][n] * a + unit[1][n] * b + unit[2][n] * c)
            .collect();
        result.modes.push(mode(k as u32 + 1, 0.0, 0.5, shape));
    }
    let bend = |p: &Vec3| Vec3::new(0.0, 0.0, p.y * p.y);
    result
        .modes
        .push(mode(4, 12.0, 4.0, sample(&positions, bend)));
    result
}

#[test]
fn three_rigid_modes_of_a_half_hold_the_masses_of_their_motion() {
    for kind in [Symmetry::Symmetric, Symmetry::Antisymmetric] {
        let result = half_with_rigid_modes(kind);
        let model = loaded(kind.word(), &result, |settings| {
            settings.half = true;
            settings.symmetry = kind;
        });
        let model = model.unwrap();
        let (found, expected) = (model.rigid_body.unwrap(), whole_body());
        let (a, b) = (found.inertia, expected.inertia);
        let moments = if kind == Symmetry::Symmetric {
            vec![(a.yy, b.yy)]
        } else {
            vec![(a.xx, b.xx), (a.zz, b.zz), (a.xz, b.xz)]
        };
        assert!(
            (found.mass / expected.mass - 1.0).abs() < 1e-11,
            "{found:?}"
        );
        assert!((found.cg - expected.cg).norm() < 1e-11, "{found:?}");
        for (a, b) in moments {
            assert!((a - b).abs() < 1e-10, "{found:?}");
        }
        assert_eq!(model.elastic.len(), 1);
        assert_eq!(model.elastic[0].generalised_mass, 8.0);
        // φ of unit generalised mass of the whole: divided by √(2 m).
        let tip = model.elastic[0]
            .shape
            .iter()
            .map(|u| u.z)
            .fold(0.0, f64::max);
        assert!((tip - common::SPAN.powi(2) / 8.0_f64.sqrt()).abs() < 1e-12);
    }
}

/// The wing and its mirror image, joined in the plane.
fn whole_wing() -> ModalResult {
    let mut result = common::wing().result();
    let count = result.nodes.len();
    let mut image = Vec::with_capacity(count);
    for n in 0..count {
        let Node { id, position } = result.nodes[n];
        if position.y == 0.0 {
            image.push(n as u32);
            continue;
        }
        image.push(result.nodes.len() as u32);
        result.nodes.push(Node {
            id: id + 100_000,
            position: mirrored(position),
        });
    }
    for element in result.elements.clone() {
        let mut element = element;
        element.id += 100_000;
        for node in &mut element.nodes {
            *node = image[*node as usize];
        }
        result.elements.push(element);
    }
    result
}

fn with_fields(mut result: ModalResult, fields: &[fn(&Vec3) -> Vec3]) -> ModalResult {
    let positions = result.positions();
    for (k, field) in fields.iter().enumerate() {
        let shape = sample(&positions, field);
        let frequency = 10.0 + k as f64;
        result.modes.push(mode(k as u32 + 1, frequency, 1.0, shape));
    }
    result
}

const FIELDS: [fn(&Vec3) -> Vec3; 4] = [
    |p| Vec3::new(0.0, 0.3 * p.y, 1.0 + p.y * p.y),
    |p| Vec3::new(0.2 * p.y, 0.0, p.y * p.y.abs()),
    |p| Vec3::new(0.1 * p.y * p.y, 0.0, p.x),
    |p| Vec3::new(0.0, 0.0, p.y * p.y + 0.3 * p.y),
];

#[test]
fn modes_of_the_other_kind_are_refused_by_name_or_left_out() {
    let result = with_fields(whole_wing(), &FIELDS);
    let of = |kind: Symmetry, leave_out: bool| {
        loaded("kinds", &result, |settings| {
            settings.symmetry = kind;
            settings.leave_out_other = leave_out;
        })
    };
    let names = |model: &StructuralModel| -> Vec<String> {
        model.elastic.iter().map(|mode| mode.name.clone()).collect()
    };
    let error = of(Symmetry::Symmetric, false).unwrap_err();
    println!("{error}");
    let StructureError::Half(HalfError::OtherKind { modes, .. }) = &error else {
        panic!("{error}");
    };
    assert_eq!(modes.len(), 2);
    assert!(modes[0].starts_with("elastic:2") && modes[0].contains("antisymmetric"));
    assert!(modes[1].starts_with("elastic:4") && modes[1].contains("neither"));
    let symmetric = of(Symmetry::Symmetric, true).unwrap();
    assert_eq!(names(&symmetric), ["elastic:1", "elastic:3"]);
    assert!(
        symmetric
            .notes
            .iter()
            .any(|note| note.starts_with("left out"))
    );
    let antisymmetric = of(Symmetry::Antisymmetric, true).unwrap();
    assert_eq!(names(&antisymmetric), ["elastic:2"]);
    let all = of(Symmetry::None, false).unwrap();
    assert_eq!(all.elastic.len(), 4);
    // The masses of a whole structure are those of the whole.
    assert_eq!(symmetric.elastic[0].generalised_mass, 1.0);
}

#[test]
fn a_structure_without_mirror_images_or_on_the_wrong_side_is_refused() {
    let lone = with_fields(common::wing().result(), &FIELDS);
    let error = loaded("lone", &lone, |s| s.symmetry = Symmetry::Symmetric).unwrap_err();
    let no_images = matches!(error, StructureError::Half(HalfError::NoImages { .. }));
    assert!(no_images, "{error}");
    let whole = with_fields(whole_wing(), &FIELDS);
    let error = loaded("side", &whole, |settings| {
        settings.half = true;
        settings.symmetry = Symmetry::Symmetric;
    });
    let error = error.unwrap_err();
    let is_side = matches!(error, StructureError::Half(HalfError::Side { .. }));
    assert!(is_side, "{error}");
}

/// In the plane of a half structure symmetric motion has no u_y.
#[test]
fn the_plane_of_a_half_structure_tells_the_kind() {
    let fields: [fn(&Vec3) -> Vec3; 2] = [
        |p| Vec3::new(0.0, 0.3 * p.y, 1.0 + p.y * p.y),
        |p| Vec3::new(0.2 * p.y, 1.0 + p.y * p.y, p.y),
    ];
    let result = with_fields(common::wing().result(), &fields);
    for (kind, kept) in [
        (Symmetry::Symmetric, "elastic:1"),
        (Symmetry::Antisymmetric, "elastic:2"),
    ] {
        let of = |leave_out: bool| {
            loaded("plane", &result, |settings| {
                settings.half = true;
                settings.symmetry = kind;
                settings.leave_out_other = leave_out;
            })
        };
        assert!(of(false).unwrap_err().to_string().contains("mesh.symmetry"));
        let model = of(true).unwrap();
        assert_eq!(model.elastic.len(), 1);
        assert_eq!(model.elastic[0].name, kept);
        assert_eq!(model.elastic[0].generalised_mass, 2.0);
    }
}

/// On the half surface, half and whole structure give one field: the half's
/// shapes are smaller by √2 before the masses are counted.
#[test]
fn half_and_whole_structure_move_a_half_surface_alike() {
    let surface: TriMesh = common::surface();
    let whole = with_fields(whole_wing(), &FIELDS[..1]);
    let mut half = with_fields(common::wing().result(), &FIELDS[..1]);
    half.modes[0].generalised_mass = 0.5;
    let moved = |name: &str, result: &ModalResult, is_half: bool| {
        let model = loaded(name, result, |settings| {
            settings.half = is_half;
            settings.symmetry = Symmetry::Symmetric;
        });
        let (modes, _) = transfer(&model.unwrap(), &surface, &common::mapping()).unwrap();
        modes.into_iter().next().unwrap().displacement
    };
    let (of_whole, of_half) = (moved("whole", &whole, false), moved("alike", &half, true));
    let error = common::largest_error(&of_whole, &of_half);
    println!("half against whole structure: {error:e}");
    assert!(error < 1e-13, "{error}");
    let mut in_plane = 0;
    for (u, p) in of_half
        .iter()
        .zip(&surface.vertices)
        .filter(|(_, p)| p.y == 0.0)
    {
        assert_eq!(u.y, 0.0, "{p}");
        in_plane += 1;
    }
    assert!(in_plane > 0);
}
