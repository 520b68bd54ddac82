//! Skins, webs, ribs, controls and fuselage as shell elements.
//!
//! Sets of the wing begin with W, of bend and winglet with L: LE skin round the leading edge,
//! CAP spar caps, BOX skin to the rear spar, TE fixed trailing edge, WEB spars, CS control,
//! CSW its spar, RIB and RIBCS ribs. FUS is the bare fuselage, FUSZ0 … its loaded zones, FUSN
//! and FUST nose and tail, BULK bulkheads.

use super::frame::{ControlFrame, Frame, SAME};
use super::mesh::ShellMesh;
use super::table::{Places, Table};
use crate::scaneagle::body::root;

/// All shells of the aircraft.
pub(super) fn shells(frame: &Frame<'_>, table: &Table, refine: usize) -> ShellMesh {
    let mut mesh = ShellMesh::new(refine);
    for (control, stations) in frame.controls.iter().zip(&frame.stations) {
        lifting(&mut mesh, frame, table, (control, stations));
    }
    fuselage(&mut mesh, frame, table);
    mesh
}

/// One of wing and winglet with its control.
fn lifting(
    mesh: &mut ShellMesh,
    frame: &Frame<'_>,
    table: &Table,
    (control, stations): (&ControlFrame, &[f64]),
) {
    let (wing, places) = (&frame.wing, &table.places);
    let name = |ending: &str| format!("{}{ending}", control.letter);
    let from_body = |s: &&f64| **s > places.side_of_body - SAME;
    let outside: Vec<f64> = stations.iter().filter(from_body).copied().collect();
    let [front, rear] = [places.front_spar, places.rear_spar];
    let [caps, boxes] = chords(places);
    // Finer towards the leading edge, where place = front u².
    let round = [-1.0, -0.5, 0.0, 0.5, 1.0];
    mesh.patch(&name("LE"), (&round, &outside), false, |u, s| {
        wing.point(front * u * u, if u == 0.0 { 0.0 } else { u.signum() }, s)
    });
    let trailing = [rear, f64::midpoint(rear, 1.0), 1.0];
    for face in [1.0, -1.0] {
        let skin =
            |place: f64, s: f64| wing.point(place, if place < 1.0 { face } else { 0.0 }, s);
        let under = face < 0.0;
        mesh.patch(&name("CAP"), (&caps, stations), under, skin);
        mesh.patch(&name("BOX"), (&boxes, &outside), under, skin);
        let [a, b] = control.ends;
        for part in [
            outside
                .iter()
                .filter(|s| **s < a + SAME)
                .copied()
                .collect::<Vec<_>>(),
            outside.iter().filter(|s| **s > b - SAME).copied().collect(),
        ] {
            mesh.patch(&name("TE"), (&trailing, &part), under, skin);
        }
    }
    let across = [-1.0, 1.0];
    for (place, along) in [(front, stations), (rear, &*outside)] {
        mesh.patch(&name("WEB"), (&across, along), false, |t, s| {
            wing.point(place, t, s)
        });
    }
    moving(mesh, frame, table, (control, stations));
    let ribs: Vec<f64> = stations
        .iter()
        .copied()
        .filter(|s| is_rib(*s, frame, places, control))
        .collect();
    for s in ribs {
        for places in [&caps, &boxes] {
            mesh.patch(&name("RIB"), (&places[..], &across), false, |place, t| {
                wing.point(place, t, s)
            });
        }
    }
}

/// Ribs are at the hinges, at the ends of elevon, bend and winglet, and where the table says.
fn is_rib(s: f64, frame: &Frame<'_>, places: &Places, control: &ControlFrame) -> bool {
    let [begin, end, tip] = frame.wing.marks;
    let ends: &[f64] = if control.letter == 'W' {
        &[control.ends[0], control.ends[1], begin]
    } else {
        &[end, tip]
    };
    let wanted = [&places.ribs, &control.hinges, ends];
    wanted
        .into_iter()
        .flatten()
        .any(|rib| (rib - s).abs() < SAME)
}

/// The control: a body of its own with a spar, skins to the trailing edge, and ribs.
fn moving(
    mesh: &mut ShellMesh,
    frame: &Frame<'_>,
    table: &Table,
    (control, stations): (&ControlFrame, &[f64]),
) {
    let (wing, places) = (&frame.wing, &table.places);
    let name = |ending: &str| format!("{}{ending}", control.letter);
    let [a, b] = control.ends;
    let mut along = vec![a + places.slot];
    along.extend(stations.iter().filter(|s| **s > a + SAME && **s < b - SAME));
    along.push(b - places.slot);
    let skin = [places.control_spar, places.control_middle, 1.0];
    for face in [1.0, -1.0] {
        mesh.patch(&name("CS"), (&skin, &along), face < 0.0, |place, s| {
            wing.point(place, if place < 1.0 { face } else { 0.0 }, s)
        });
    }
    let across = [-1.0, 1.0];
    mesh.patch(&name("CSW"), (&across, &along), false, |t, s| {
        wing.point(places.control_spar, t, s)
    });
    let mut ribs = vec![along[0]];
    ribs.extend(&control.hinges);
    ribs.push(b - places.slot);
    for s in ribs {
        mesh.patch(&name("RIBCS"), (&skin[..2], &across), false, |place, t| {
            wing.point(place, t, s)
        });
    }
}

/// Chordwise lines of caps and box.
fn chords(places: &Places) -> [[f64; 3]; 2] {
    let split = |a: f64, b: f64| [a, f64::midpoint(a, b), b];
    [
        split(places.front_spar, places.cap_end),
        split(places.cap_end, places.rear_spar),
    ]
}

/// The place between cap and rear spar to which hinges are fixed.
pub(super) fn box_middle(places: &Places) -> f64 {
    chords(places)[1][1]
}

fn fuselage(mesh: &mut ShellMesh, frame: &Frame<'_>, table: &Table) {
    let (body, shell) = (&frame.body, &table.fuselage);
    for pair in frame.rings.windows(2) {
        let middle = f64::midpoint(pair[0], pair[1]);
        let inside = |zone: &super::table::Zone| zone.from < middle && middle < zone.to;
        let set = match table.zone.iter().position(inside) {
            Some(zone) => format!("FUSZ{zone}"),
            None => "FUS".to_owned(),
        };
        mesh.patch(&set, (pair, &frame.angles), false, |x, angle| {
            body.point(x, angle)
        });
    }
    for x in &shell.bulkheads {
        mesh.fan("BULK", &frame.angles, |part, angle| {
            let rim = body.point(*x, angle);
            fladder_mesh::Vec3::new(*x, part * rim.y, part * rim.z)
        });
    }
    // Half-way to the tip the radius is half that of the ring.
    let (nose, tail) = (body.radius(shell.nose) / 2.0, body.radius(shell.tail) / 2.0);
    let half = [
        root(0.0, shell.nose, |x| body.radius(x) - nose),
        root(shell.tail, body.length(), |x| tail - body.radius(x)),
    ];
    let place = |part: f64, [tip, half, ring]: [f64; 3]| {
        if part == 0.0 {
            tip
        } else if part == 1.0 {
            ring
        } else {
            half
        }
    };
    mesh.fan("FUSN", &frame.angles, |part, angle| {
        body.point(place(part, [0.0, half[0], shell.nose]), angle)
    });
    mesh.fan("FUST", &frame.angles, |part, angle| {
        body.point(place(part, [body.length(), half[1], shell.tail]), angle)
    });
}
