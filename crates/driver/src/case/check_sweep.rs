//! What flight and sweep must say of themselves.

use super::check::{At, Checked};
use super::{Case, OneOrMany, Range, Speeds, Stability, Trim};
use crate::atmosphere;

/// More points than this in a sweep are taken for a slip of the keyboard: it
/// is a hundred times what a picture can show.
const MOST_POINTS: usize = 100_000;

pub(super) fn flight(case: &Case, at: &At<'_>) -> Checked {
    let Some(flight) = &case.flight else {
        return Ok(());
    };
    if case
        .structure
        .as_ref()
        .is_none_or(|structure| structure.rigid_body.is_none())
    {
        return Err(at.refuse(
            "flight",
            "[flight] is there without [structure.rigid_body]",
            "gravity and drag act on the rigid modes",
            "add [structure.rigid_body], or remove [flight]",
        ));
    }
    at.positive("flight.gravity", flight.gravity)?;
    at.finite("flight.climb_deg", flight.climb_deg)?;
    at.not_negative("flight.parasite_drag_area", flight.parasite_drag_area)?;
    at.not_negative("flight.induced_drag_factor", flight.induced_drag_factor)?;
    if flight.climb_deg.abs() >= 90.0 {
        return Err(at.refuse(
            "flight.climb_deg",
            format!("`flight.climb_deg` is {}", flight.climb_deg),
            "no lift balances the weight in a vertical climb",
            "give an angle between -90 and 90 degrees",
        ));
    }
    if flight.trim == Trim::Level && case.flow.beta_deg != 0.0 {
        return Err(at.refuse(
            "flight.trim",
            format!(
                "`flight.trim = \"level\"` with `flow.beta_deg` = {}",
                case.flow.beta_deg
            ),
            "level flight is symmetric; a sideslip needs rudder and bank, which are not solved for",
            "set flow.beta_deg = 0, or trim = \"none\"",
        ));
    }
    let controls = flight.trim_control.iter().flat_map(OneOrMany::as_slice);
    if flight.trim == Trim::None && controls.clone().count() > 0 {
        return Err(at.refuse(
            "flight.trim_control",
            "`flight.trim_control` is given, but `flight.trim` is \"none\"",
            "no control is deflected without a trim",
            "set trim = \"level\", or remove trim_control",
        ));
    }
    let formulae = case.modes.formulae();
    for name in controls {
        if !formulae.iter().any(|(_, mode)| mode.name == *name) {
            let known: Vec<&str> = formulae
                .iter()
                .map(|(_, mode)| mode.name.as_str())
                .collect();
            return Err(at.refuse(
                "flight.trim_control",
                format!(
                    "there is no control `{name}`; there are: {}",
                    if known.is_empty() {
                        "none".to_owned()
                    } else {
                        known.join(", ")
                    }
                ),
                "the pitching moment is balanced by a control of [[modes.control]]",
                "give the name of one of them, or add it",
            ));
        }
    }
    Ok(())
}

pub(super) fn stability(case: &Case, swept: &Stability, at: &At<'_>) -> Checked {
    if let Some(speed) = swept.margin_speed {
        margin_speed(speed, swept, at)?;
    }
    if let Some(altitudes) = &swept.altitude {
        return over_altitude(case, swept, altitudes, at);
    }
    let Some(speeds) = &swept.speed else {
        return Err(at.refuse(
            "stability",
            "[stability] names no speeds",
            "there is nothing to sweep",
            "add speed = { from = 20.0, to = 75.0, count = 56 }",
        ));
    };
    if let Speeds::Range(range) = speeds {
        check_range("stability.speed", range, at)?;
    }
    let values = speeds.values();
    at.all_finite("stability.speed", &values)?;
    let first = values.first().copied().unwrap_or_default();
    if first <= 0.0 || values.windows(2).any(|pair| pair[0] >= pair[1]) {
        return Err(at.refuse(
            "stability.speed",
            "the speeds must be positive and ascend",
            "roots are followed from one speed to the next, and p = sb/U needs U > 0",
            "give positive speeds in m/s, lowest first, none twice",
        ));
    }
    if swept.matched && case.flow.altitude.is_none() {
        return Err(at.refuse(
            "stability.matched",
            "a matched sweep over speed needs `flow.altitude`",
            "the Mach number M = U/a needs the speed of sound, which a density does not give",
            "give flow.altitude instead of flow.density",
        ));
    }
    Ok(())
}

/// A margin is told at a speed within the sweep.
fn margin_speed(speed: f64, swept: &Stability, at: &At<'_>) -> Checked {
    let key = "stability.margin_speed";
    at.positive(key, speed)?;
    let speeds = swept.speed.as_ref().map(Speeds::values).unwrap_or_default();
    let is_within = speeds.first().is_some_and(|first| *first <= speed)
        && speeds.last().is_some_and(|last| speed <= *last);
    if is_within {
        return Ok(());
    }
    Err(at.refuse(
        key,
        format!("`{key}` is {speed} m/s, which is not within `stability.speed`"),
        "damping at that speed is unknown",
        "give a speed within those of the sweep, or sweep further",
    ))
}

fn over_altitude(case: &Case, swept: &Stability, altitudes: &Range, at: &At<'_>) -> Checked {
    if swept.speed.is_some() {
        return Err(at.refuse(
            "stability.altitude",
            "both `stability.speed` and `stability.altitude` are given",
            "a sweep has one variable",
            "remove one of the two",
        ));
    }
    if case.flow.density.is_some() || case.flow.altitude.is_some() {
        let key = if case.flow.density.is_some() {
            "flow.density"
        } else {
            "flow.altitude"
        };
        return Err(at.refuse(
            key,
            format!("`{key}` is given in a sweep over altitude"),
            "the density follows from the altitude of every point",
            "remove it",
        ));
    }
    check_range("stability.altitude", altitudes, at)?;
    for (name, value) in [("from", altitudes.from), ("to", altitudes.to)] {
        if !atmosphere::RANGE.contains(&value) {
            return Err(at.refuse(
                &format!("stability.altitude.{name}"),
                format!("`stability.altitude.{name}` is {value} m"),
                "the standard atmosphere is known here from -2000 m to 20000 m",
                "give altitudes in that range",
            ));
        }
    }
    if altitudes.count > 1 && altitudes.from == altitudes.to {
        return Err(at.refuse(
            "stability.altitude.to",
            "all altitudes of the sweep are the same",
            "there is nothing to sweep",
            "give two different altitudes, or count = 1",
        ));
    }
    if case.flow.mach <= 0.0 {
        return Err(at.refuse(
            "flow.mach",
            "a sweep over altitude needs `flow.mach`",
            "the speed at an altitude is U = M a",
            "set flow.mach, and give the forces of that Mach number, or of Mach numbers on both sides, with gaf.file",
        ));
    }
    Ok(())
}

fn check_range(key: &str, range: &Range, at: &At<'_>) -> Checked {
    at.finite(&format!("{key}.from"), range.from)?;
    at.finite(&format!("{key}.to"), range.to)?;
    if range.count == 0 || range.count > MOST_POINTS {
        return Err(at.refuse(
            &format!("{key}.count"),
            format!("`{key}.count` is {}", range.count),
            "a sweep has between 1 and 100000 points",
            "56 or 200 are usual",
        ));
    }
    Ok(())
}
