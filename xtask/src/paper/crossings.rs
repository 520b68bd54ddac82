//! Crossings into growth.

use fladder_stability::{Crossing, Kind, MethodResult};

use super::PaperError;
use super::published::Published;
use super::words::{Table, number};
use super::work::Work;

/// Elastic ones, refined, lowest speed first.
pub(super) fn elastic(work: &Work) -> impl Iterator<Item = &Crossing> {
    let refined = work.refined().into_iter();
    refined
        .flat_map(|refined| &refined.flutter)
        .filter(|crossing| crossing.kind == Kind::Elastic)
}

/// The elastic crossing nearest to the paper's in speed, frequency and reduced frequency,
/// all by ratio.
pub(super) fn of_the_kind<'a>(
    work: &'a Work,
    published: &Published,
) -> Result<Option<&'a Crossing>, PaperError> {
    let speed = published.get("flutter_speed")?.value;
    let frequency = published.get("flutter_frequency")?.value;
    let k = published.get("flutter_k")?.value;
    let distance = |crossing: &Crossing| {
        let speeds = (crossing.speed / speed).ln();
        let frequencies = (crossing.frequency_hz / frequency).ln();
        speeds.hypot(frequencies).hypot((crossing.k / k).ln())
    };
    Ok(elastic(work).min_by(|a, b| distance(a).total_cmp(&distance(b))))
}

/// All crossings into growth, and how far p2 and p-k are from the refined ones.
pub(super) fn table(work: &Work) -> Table {
    let mut table = Table::new(&[
        "crossing",
        "speed",
        "frequency",
        "k",
        "p2",
        "p-k",
        "1 % more frequency of … changes the speed by … m/s",
    ]);
    let methods = &work.main.methods;
    let refined = work.refined().map_or(&[][..], |refined| &refined.flutter);
    for crossing in refined {
        let beside = |result: &Option<MethodResult>| {
            let others = result.iter().flat_map(|result| &result.flutter);
            let near = others
                .map(|other| (other.speed / crossing.speed - 1.0, other))
                .filter(|(apart, other)| {
                    let ratio = other.frequency_hz / crossing.frequency_hz;
                    apart.abs() < 0.05 && (0.8..1.25).contains(&ratio)
                })
                .min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
            near.map_or_else(
                || "–".to_owned(),
                |(apart, _)| format!("{:+.3} %", 100.0 * apart).replace('-', "−"),
            )
        };
        let kind = match crossing.kind {
            Kind::Rigid => "rigid motion",
            Kind::Elastic => "flutter",
        };
        table.push([
            kind.to_owned(),
            format!("{:.1} m/s", crossing.speed),
            format!("{} Hz", number(crossing.frequency_hz)),
            format!("{:.3}", crossing.k),
            beside(&methods.p2),
            beside(&methods.pk),
            sensitivities(crossing),
        ]);
    }
    table
}

/// The modes whose frequencies matter most to the speed of a crossing.
fn sensitivities(crossing: &Crossing) -> String {
    let words: Vec<String> = crossing
        .owed_to_frequencies()
        .iter()
        .take(3)
        .map(|(mode, change)| format!("{mode} {change:+.2}").replace('-', "−"))
        .collect();
    words.join(", ")
}
