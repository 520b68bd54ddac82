use super::compare::{Row, Verdict};
use super::published::{Published, Quoted};
use super::words::{Table, amplitude, number};

#[test]
fn every_number_of_the_paper_has_a_source_and_a_tolerance_or_is_a_cost() {
    let published = Published::read().expect("paper.toml");
    let mut ids: Vec<&str> = published.value.iter().map(|v| v.id.as_str()).collect();
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count, "an id stands twice");
    for value in &published.value {
        let source = value.source.strip_prefix("IFASD-2009-119, ");
        let places = ["table", "figure", "section"];
        let has_place = source.is_some_and(|s| places.iter().any(|p| s.starts_with(p)));
        assert!(has_place, "{}: {}", value.id, value.source);
        assert!(value.value.is_finite() && !value.quantity.is_empty());
        assert!(value.is_cost || value.tolerance > 0.0, "{}", value.id);
        // Texts must stay true when the structure changes.
        let why = value.why.clone().unwrap_or_default();
        assert!(!why.contains("elastic:"), "{}", value.id);
    }
}

fn value(why: Option<&str>) -> Quoted {
    Quoted {
        id: "x".to_owned(),
        quantity: "x".to_owned(),
        value: 2.0,
        unit: "s".to_owned(),
        source: "IFASD-2009-119, table 1".to_owned(),
        tolerance: 0.05,
        why: why.map(str::to_owned),
        is_time_of_amplitude: false,
        is_cost: false,
    }
}

#[test]
fn a_difference_without_a_cause_is_open() {
    let verdict = |why, here| Row::new(&value(why), here).verdict;
    assert_eq!(verdict(None, Some(2.05)), Verdict::Agrees);
    assert_eq!(verdict(None, Some(2.5)), Verdict::Open);
    assert_eq!(verdict(Some("other mass"), Some(2.5)), Verdict::Differs);
    assert_eq!(verdict(Some("other mass"), None), Verdict::Differs);
    assert_eq!(verdict(None, Some(f64::NAN)), Verdict::Open);
}

#[test]
fn growth_against_decay_is_a_negative_ratio() {
    let growth = Quoted {
        is_time_of_amplitude: true,
        ..value(None)
    };
    let row = Row::new(&growth, Some(-4.0));
    assert_eq!((row.ratio, row.verdict), (Some(-0.5), Verdict::Open));
    assert_eq!(row.paper, "doubles in 2.00 s");
    assert_eq!(row.here, "halves in 4.00 s");
    assert_eq!(amplitude(-1e3), "halves in 0.000693 s");
}

#[test]
fn a_cost_is_faster_or_slower() {
    let cost = Quoted {
        is_cost: true,
        ..value(None)
    };
    let verdict = |here| Row::new(&cost, Some(here)).verdict;
    assert_eq!(
        [verdict(0.1), verdict(3.0)],
        [Verdict::Faster, Verdict::Slower]
    );
}

#[test]
fn tables_are_markdown_csv_and_html() {
    let mut table = Table::new(&["a", "b"]);
    table.push(["1, 2".to_owned(), "<x>".to_owned()]);
    assert_eq!(table.markdown(), "| a | b |\n|---|---|\n| 1, 2 | <x> |\n");
    assert_eq!(table.csv(), "a,b\n\"1, 2\",<x>\n");
    assert!(table.html().contains("<td>&lt;x&gt;</td>"));
    assert_eq!(table.text(), "a     b\n1, 2  <x>\n");
    assert_eq!(
        [number(1020.0), number(0.0234), number(-4.8)],
        ["1020", "0.0234", "−4.80"]
    );
}
