//! All roots as comma-separated values.

use fladder_stability::{Kind, MethodResult, Methods};
use std::fmt::Write;

const HEADER: &str = "method,branch,kind,speed_m_s,g,k,sigma_1_s,omega_rad_s,frequency_hz,\
                      damping_ratio,structural_damping,extrapolated";

/// One line a root, branch by branch; undefined values are empty.
pub(crate) fn roots_csv(methods: &Methods) -> String {
    let mut text = format!("{HEADER}\n");
    let named = [
        ("p2", &methods.p2),
        ("polished", &methods.polished),
        ("pk", &methods.pk),
        ("g", &methods.g),
    ];
    for (name, result) in named {
        if let Some(result) = result {
            add(&mut text, name, result);
        }
    }
    text
}

fn add(text: &mut String, method: &str, result: &MethodResult) {
    for branch in &result.branches {
        let kind = match branch.kind {
            Kind::Rigid => "rigid",
            Kind::Elastic => "elastic",
        };
        let name = quoted(&branch.name);
        for i in 0..branch.speed.len() {
            let optional =
                |value: Option<f64>| value.map_or_else(String::new, |v| v.to_string());
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "{method},{name},{kind},{},{},{},{},{},{},{},{},{}",
                branch.speed[i],
                branch.g[i],
                branch.k[i],
                branch.sigma[i],
                branch.omega[i],
                branch.frequency_hz[i],
                optional(branch.damping_ratio[i]),
                optional(branch.structural_damping[i]),
                branch.extrapolated.as_ref().is_some_and(|list| list[i]),
            );
        }
    }
}

/// Roots counted along the border of the region and found, speed by speed; empty where the
/// border runs through a root.
pub(crate) fn counts_csv(result: &MethodResult, speeds: &[f64]) -> Option<String> {
    let (complete, counts) = (result.complete.as_ref()?, result.count.as_ref()?);
    let mut text = "speed_m_s,counted,found,complete\n".to_owned();
    for ((speed, count), met) in speeds.iter().zip(counts).zip(complete) {
        let [counted, found] = count.map_or_else(
            || [String::new(), String::new()],
            |count| [count.counted.to_string(), count.found.to_string()],
        );
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{speed},{counted},{found},{met}");
    }
    Some(text)
}

/// Every crossing of every method: speed, frequency and what moves.
pub(crate) fn crossings_csv(methods: &Methods) -> String {
    let mut text =
        "method,crossing,branch,kind,speed_m_s,dynamic_pressure_pa,frequency_hz,k\n".to_owned();
    let named = [
        ("p2", &methods.p2),
        ("polished", &methods.polished),
        ("pk", &methods.pk),
        ("g", &methods.g),
    ];
    for (name, result) in named {
        let Some(result) = result else { continue };
        let kind = |kind: Kind| match kind {
            Kind::Rigid => "rigid",
            Kind::Elastic => "elastic",
        };
        for (word, list) in [
            ("flutter", &result.flutter),
            ("restabilised", &result.restabilised),
        ] {
            for crossing in list {
                // Writing to a string cannot fail.
                let _ = writeln!(
                    text,
                    "{name},{word},{},{},{},{},{},{}",
                    quoted(&crossing.branch),
                    kind(crossing.kind),
                    crossing.speed,
                    crossing.dynamic_pressure,
                    crossing.frequency_hz,
                    crossing.k
                );
            }
        }
        for divergence in &result.divergence {
            let _ = writeln!(
                text,
                "{name},divergence,{},{},{},{},0,0",
                quoted(&divergence.branch),
                kind(divergence.kind),
                divergence.speed,
                divergence.dynamic_pressure
            );
        }
    }
    text
}

/// A name in quotes where it holds a separator.
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fladder_stability::Branch;

    #[test]
    fn a_root_is_a_line_and_names_are_quoted_where_needed() {
        let branch = Branch {
            name: "a,\"b\"".to_owned(),
            speed: vec![10.0],
            g: vec![-0.1],
            k: vec![0.0],
            sigma: vec![-2.0],
            omega: vec![0.0],
            frequency_hz: vec![0.0],
            damping_ratio: vec![Some(1.0)],
            structural_damping: vec![None],
            ..Branch::default()
        };
        let result = MethodResult {
            branches: vec![branch],
            ..MethodResult::default()
        };
        let methods = Methods {
            pk: Some(result),
            ..Methods::default()
        };
        let text = roots_csv(&methods);
        assert_eq!(
            text.lines().nth(1),
            Some("pk,\"a,\"\"b\"\"\",elastic,10,-0.1,0,-2,0,0,1,,false")
        );
    }
}
