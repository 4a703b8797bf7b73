//! What the errata mean for given specifications.

use crate::support::specification_text;
use rug::Rational;
use sigmastar_document::plain;
use sigmastar_lang::spec::Specification;
use sigmastar_paper::errata::{Bearing, Erratum, ForData, Side, errata};

fn list(text: &str) -> Vec<Erratum> {
    errata(Some(&Specification::from_json("test", text).unwrap()))
}

fn for_data<'l>(list: &'l [Erratum], id: &str) -> &'l ForData {
    list.iter().find(|item| item.id == id).unwrap().for_data.as_ref().unwrap()
}

fn figure(list: &[Erratum], id: &str, name: &str) -> Side {
    let found: Vec<_> = for_data(list, id).figures.iter().filter(|f| plain(&f.name).starts_with(name)).collect();
    assert_eq!(found.len(), 1, "{id}: `{name}`");
    found[0].value.clone()
}

/// Whether the figure lies between two decimals.
fn between(list: &[Erratum], id: &str, name: &str, lower: f64, upper: f64) {
    let value = figure(list, id, name).enclosure();
    assert!(value.lower_f64() >= lower && value.upper_f64() <= upper, "{id}: {name} = {:?}", value.decimals());
}

fn bearings(list: &[Erratum], expected: &[(&str, Bearing)]) {
    for (id, bearing) in expected {
        assert_eq!(for_data(list, id).bearing, *bearing, "{id}: {}", for_data(list, id));
    }
}

use Bearing::{Bites, Costs, Depends, Harmless};

#[test]
fn items_about_data_have_an_answer() {
    for name in ["paper-example", "short-period", "ill-conditioned", "no-x", "linear", "explicit-weights"] {
        let list = list(&specification_text(name));
        for item in &list {
            let about_data = !["E17", "E19", "E20", "E21", "E22", "E23"].contains(&item.id);
            assert_eq!(item.for_data.is_some(), about_data, "{name} {}", item.id);
            if let Some(data) = &item.for_data {
                assert!(!data.figures.is_empty() || item.id == "E14", "{name} {}", item.id);
                assert!(data.figures.iter().all(|f| f.value.enclosure().is_bounded()), "{name} {} {data}", item.id);
            }
        }
        // The evidence does not depend on the specification.
        assert!(list.iter().all(|item| item.is_proved() == (item.id != "E21")), "{name}");
    }
}

#[test]
fn paper_example() {
    let list = list(&specification_text("paper-example"));
    let expected = [
        ("E1", Bites),
        ("E2", Bites),
        ("E3", Bites),
        ("E4", Bites),
        ("E5", Harmless),
        ("E6", Harmless),
        ("E7", Bites),
        ("E8", Harmless),
        ("E9", Costs),
        ("E10", Harmless),
        ("E11", Harmless),
        ("E12", Harmless),
        ("E13", Harmless),
        ("E14", Harmless),
        ("E15", Depends),
        ("E16", Costs),
        ("E18", Harmless),
    ];
    bearings(&list, &expected);
    between(&list, "E1", "3.5 (", 13.05, 13.06);
    between(&list, "E2", "P_up/P_low", 1.5511, 1.5513);
    // 3 sqrt(2) sqrt(1.5512) + 2, and the domain 10 divided by it.
    between(&list, "E4", "x_b/x_a", 7.284, 7.2841);
    between(&list, "E4", "largest x_a", 1.3728, 1.3729);
    between(&list, "E6", "nu", 0.1591, 0.1592);
    between(&list, "E7", "T(0)", 19.739, 19.740);
    // 8 (4 pi^2 + (13/3)^2)/(2 pi)^4 = 0.29903.
    between(&list, "E9", "proved", 0.29902, 0.29904);
    between(&list, "E9", "printed", 1.3088e7, 1.3089e7);
    between(&list, "E13", "printed", 24.1799, 24.1801);
    // sqrt(4.822^2/2 + 2 (24.18/(2 pi))^2)
    between(&list, "E13", "proved", 6.422, 6.423);
    between(&list, "E16", "K_alpha/c", 1.1374, 1.1375);
    between(&list, "E8", "2048", 2048.0, 2048.0);
}

#[test]
fn short_period() {
    let list = list(&specification_text("short-period"));
    bearings(&list, &[("E1", Bites), ("E2", Bites), ("E6", Harmless), ("E7", Bites), ("E9", Costs)]);
    bearings(&list, &[("E10", Bites), ("E11", Costs), ("E12", Bites)]);
    assert_eq!(figure(&list, "E10", "mu"), Side::from(1000));
    assert_eq!(figure(&list, "E11", "T"), Side::from(Rational::from((1, 1000))));
    // The quotient of the two is sqrt(T).
    between(&list, "E12", "printed", 0.06288, 0.06289);
    between(&list, "E12", "without", 1.98846, 1.98847);
}

#[test]
fn ill_conditioned() {
    let list = list(&specification_text("ill-conditioned"));
    bearings(&list, &[("E1", Bites), ("E2", Bites), ("E3", Bites), ("E4", Bites), ("E16", Costs)]);
    assert_eq!(figure(&list, "E2", "P_up/P_low").enclosure().decimals(), ["10000", "10000"]);
    between(&list, "E4", "x_b/x_a", 426.26, 426.27);
    // 1 + 99 e^(-1/2)
    between(&list, "E16", "K_alpha/c", 61.04, 61.05);
}

#[test]
fn without_zero_dynamics() {
    let list = list(&specification_text("no-x"));
    bearings(&list, &[("E1", Bites), ("E2", Harmless), ("E3", Harmless), ("E5", Depends), ("E15", Bites)]);
}

#[test]
fn a_long_period_and_a_slow_base_frequency() {
    let text = specification_text("paper-example")
        .replace(r#""period": "1""#, r#""period": "10""#)
        .replace(r#""base_frequency": "2*pi""#, r#""base_frequency": "3/100""#)
        .replace(r#""matched": true"#, r#""matched": false"#)
        .replace(r#""mu": "1""#, r#""mu": "1/10""#);
    let list = list(&text);
    // kappa_0 = 7 against T_N(0)/w^2 = 1/(mu^2 n_0) = 50.
    bearings(&list, &[("E6", Bites), ("E8", Bites), ("E9", Bites), ("E10", Costs), ("E11", Bites), ("E12", Costs)]);
    // nu = 10/3: T_N(0) = 0.045 is below 7 in its own units.
    bearings(&list, &[("E7", Harmless), ("E15", Depends)]);
    between(&list, "E7", "T(0)", 0.0449, 0.0451);
    between(&list, "E15", "T_N(0)/w^2", 49.9, 50.1);
}

#[test]
fn unit_base_frequency_and_large_gain() {
    let text = specification_text("paper-example")
        .replace(r#""base_frequency": "2*pi""#, r#""base_frequency": "1""#)
        .replace(r#""matched": true"#, r#""matched": false"#)
        .replace(r#""p_low": "1", "p_up": "1.5512""#, r#""p_low": "1/4", "p_up": "0.3""#)
        .replace(r#""q_t": "24.18 + 2.106*E""#, r#""q_t": "0""#);
    let list = list(&text);
    bearings(&list, &[("E2", Harmless), ("E3", Harmless), ("E6", Harmless), ("E7", Harmless), ("E13", Bites)]);
    assert!(for_data(&list, "E6").summary.starts_with("$`w = 1`$"));
    assert_eq!(figure(&list, "E3", "2 P_low"), Side::from(Rational::from((1, 2))));
}

#[test]
fn relative_degree_filters() {
    let text = specification_text("relative-degree-4");
    let with = |coefficients: &str| {
        let spec: serde_json::Value = serde_json::from_str(&text).unwrap();
        let mut spec = spec;
        spec["relative_degree"]["a"] = serde_json::from_str(coefficients).unwrap();
        list(&spec.to_string())
    };
    bearings(&list(&text), &[("E14", Harmless)]);
    let printed_accepts = with(r#"["10", "1", "1"]"#);
    bearings(&printed_accepts, &[("E14", Bites)]);
    assert!(for_data(&printed_accepts, "E14").summary.contains("accepts"));
    assert_eq!(figure(&printed_accepts, "E14", "a_1"), Side::from(10));
    let printed_refuses = with(r#"["1", "1", "10"]"#);
    bearings(&printed_refuses, &[("E14", Bites)]);
    assert!(for_data(&printed_refuses, "E14").summary.contains("refuses"));
    bearings(&with(r#"["1", "1", "1"]"#), &[("E14", Harmless)]);
}
