//! The list of errata: complete, in order, proved where it says so, and to the digits that are quoted for it.

use rug::Rational;
use sigmastar_document::{Block, Readable, plain};
use sigmastar_exact::enclosure::Truth;
use sigmastar_exact::number::parse_decimal;
use sigmastar_paper::errata::ErrataReport;
use sigmastar_paper::errata::{Class, Erratum, Evidence, Kind, Relation, Side, errata};

/// The only evidence of an item whose statement contains the fragment.
fn find<'l>(list: &'l [Erratum], id: &str, fragment: &str) -> &'l Evidence {
    let item = list.iter().find(|item| item.id == id).unwrap();
    let found: Vec<&Evidence> = item.evidence.iter().filter(|e| plain(&e.statement).contains(fragment)).collect();
    assert_eq!(found.len(), 1, "{id}: `{fragment}` is in {} statements", found.len());
    found[0]
}

/// Whether every number in the enclosure rounds to the decimal as written.
fn rounds_to(side: &Side, text: &str) {
    let value = parse_decimal(text).unwrap();
    let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let places = mantissa.split_once('.').map_or(0, |(_, fraction)| fraction.len());
    let half_unit = parse_decimal(&format!("5e{}", exponent.parse::<i64>().unwrap() - places as i64 - 1)).unwrap();
    let enclosure = side.enclosure();
    let (lower, upper) = (enclosure.lower_rational().unwrap(), enclosure.upper_rational().unwrap());
    assert!(
        lower >= Rational::from(&value - &half_unit) && upper <= Rational::from(&value + &half_unit),
        "{side} is not {text}"
    );
}

#[test]
fn every_item_once_and_in_order() {
    let list = errata(None);
    let ids: Vec<String> = list.iter().map(|item| item.id.to_owned()).collect();
    let expected: Vec<String> = (1..=23).map(|number| format!("E{number}")).collect();
    assert_eq!(ids, expected);
    for item in &list {
        assert!(item.for_data.is_none(), "{}", item.id);
        assert!(!item.place.is_empty() && !item.printed.is_empty() && !item.instead.is_empty(), "{}", item.id);
        assert!(!item.evidence.is_empty(), "{}", item.id);
    }
}

#[test]
fn classes() {
    use Class::{A, AClaim, AExample, AProof, B, C};
    let expected = [A, A, A, A, A, A, A, AProof, B, AProof, A, A, A, A, AClaim, B, C, AExample, C, C, C, C, AProof];
    assert_eq!(errata(None).iter().map(|item| item.class).collect::<Vec<_>>(), expected);
}

#[test]
fn rigorous_evidence_is_proved_and_cited_evidence_never() {
    for item in errata(None) {
        for evidence in &item.evidence {
            match evidence.kind {
                Kind::Rigorous => assert_eq!(evidence.truth, Truth::True, "{}: {evidence}", item.id),
                Kind::Cited => {
                    assert_eq!(evidence.truth, Truth::Undecided, "{}: {evidence}", item.id);
                    assert!(!evidence.is_proved() && evidence.to_string().ends_with("(cited, not proved)"));
                    // Not proved, but the quoted numbers must at least say what they are quoted for.
                    let says = evidence.relation.decide(&evidence.lhs, &evidence.rhs);
                    assert_eq!(says, Truth::True, "{}: {evidence}", item.id);
                }
            }
        }
        // E21 rests on a simulation altogether.
        assert_eq!(item.is_proved(), item.id != "E21", "{}", item.id);
    }
}

#[test]
fn size_conditions_to_the_quoted_digits() {
    let list = errata(None);
    rounds_to(&find(&list, "E1", "multiplied").lhs, "16.60");
    assert_eq!(find(&list, "E1", "multiplied").rhs, Side::from(81));
    assert_eq!(find(&list, "E1", "second member").lhs, Side::from(Rational::from((7, 2))));
    assert_eq!(find(&list, "E1", "first member").lhs, Side::from(9));
    rounds_to(&find(&list, "E2", "its root").lhs, "1.29521");
}

#[test]
fn stability_to_the_quoted_digits() {
    let list = errata(None);
    rounds_to(&find(&list, "E3", "Floquet").lhs, "0.18");
    rounds_to(&find(&list, "E3", "mean of psi").lhs, "0.8863");
    assert_eq!(find(&list, "E3", "printed rho_0").lhs, Side::from(Rational::from((2, 3))));
    assert_eq!(find(&list, "E3", "factor P_up").lhs, Side::from(Rational::from((8, 3))));
    // P F + F'P + P has the eigenvalues -101 and 0.
    let lyapunov = |what: &str| find(&list, "E4", &format!("2 alpha P) >= 0, {what}")).lhs.clone();
    assert_eq!(lyapunov("first diagonal entry"), Side::from(1));
    assert_eq!(lyapunov("second diagonal entry"), Side::from(100));
    assert_eq!(lyapunov("determinant"), Side::from(0));
    let shifted = |what: &str| find(&list, "E4", &format!("12 I >= 0, {what}")).lhs.clone();
    assert_eq!(shifted("first diagonal entry"), Side::from(10));
    assert_eq!(shifted("second diagonal entry"), Side::from(10));
    assert_eq!(shifted("determinant"), Side::from(0));
    // d = 4 (101 e^-2 - 1) = 50.6755, 5 d^3 and the time bound at X = 1, and the same at X = 0.2.
    rounds_to(&find(&list, "E4", "X = 1: the nonlinear").lhs, "6.507e5");
    rounds_to(&find(&list, "E4", "X = 0.2: the nonlinear").lhs, "41.64");
    rounds_to(&find(&list, "E4", "X = 0.2: from there").lhs, "0.00300");
    rounds_to(&find(&list, "E4", "X = 1: from there").lhs, "1.781e-7");
    for (fragment, value) in
        [("passes the first", "0.99"), ("printed second one", "-3.99"), ("read 1 > det", "3.99"), ("its rows", "2.1")]
    {
        assert_eq!(find(&list, "E5", fragment).lhs, Side::from(parse_decimal(value).unwrap()), "{fragment}");
    }
    assert_eq!(find(&list, "E5", "third line").lhs, Side::from(-2));
}

#[test]
fn transfer_to_the_quoted_digits() {
    let list = errata(None);
    assert_eq!(find(&list, "E6", "w = 0.03").lhs, Side::from(20_000));
    rounds_to(&find(&list, "E6", "w = 0.03").rhs, "7860");
    assert_eq!(find(&list, "E6", "g_1(x)^2").lhs, Side::from(0));
    assert_eq!(find(&list, "E6", "g_1'").lhs, Side::from(18));
    rounds_to(&find(&list, "E7", "nu = 1/(2 pi)").lhs, "19.739");
    assert_eq!(find(&list, "E7", "nu = 1/(2 pi)").rhs, Side::from(7));
    assert_eq!(find(&list, "E7", "is printed").lhs, Side::from(Rational::from((1, 2))));
    assert_eq!(find(&list, "E7", "is printed").rhs, Side::from(1));
    assert_eq!(find(&list, "E7", "at equality").lhs, Side::from(7));
    assert_eq!(find(&list, "E8", "disappears").lhs, Side::from(4));
    assert_eq!(find(&list, "E8", "along that route").lhs, Side::from(2048));
    rounds_to(&find(&list, "E8", "coefficients").lhs, "158.22");
    rounds_to(&find(&list, "E8", "on |x| <= 1/2").lhs, "3.9348");
    // (pi^2 - 4)/2 + 6 + 158.22/4
    rounds_to(&find(&list, "E8", "at x = 1/2").lhs, "48.490");
    rounds_to(&find(&list, "E9", "weights: S").lhs, "7.2190");
    rounds_to(&find(&list, "E9", "a = ").lhs, "24.647");
    rounds_to(&find(&list, "E9", "varpi = ").lhs, "7.818e-4");
    rounds_to(&find(&list, "E9", "the printed kappa_1").lhs, "1.3088e7");
    rounds_to(&find(&list, "E9", "closed form k1").lhs, "8.272e4");
    rounds_to(&find(&list, "E9", "no k1 below").lhs, "17.6");
    rounds_to(&find(&list, "E9", "root of kappa_1").lhs, "862");
}

#[test]
fn regulation_to_the_quoted_digits() {
    let list = errata(None);
    let integrator = find(&list, "E10", "Nbar = sqrt(n_0)");
    rounds_to(&integrator.lhs, "1.940");
    assert_eq!(integrator.rhs, Side::from(Rational::from((11, 10))));
    rounds_to(&find(&list, "E10", "zeta(1.5)").rhs, "1.152");
    rounds_to(&find(&list, "E10", "not contradicted").rhs, "4.742");
    let energy = find(&list, "E11", "against the printed psi_2");
    rounds_to(&energy.lhs, "1.2337e-3");
    rounds_to(&energy.rhs, "2.4831e-4");
    rounds_to(&find(&list, "E11", "with the factor T").rhs, "2.4831e-3");
    let solution = find(&list, "E12", "periodic solution is 1");
    assert_eq!(solution.lhs, Side::from(1));
    rounds_to(&solution.rhs, "0.3164");
    rounds_to(&find(&list, "E12", "without the factor T").rhs, "1.0004");
    assert_eq!(find(&list, "E13", "c_0/mu gives").lhs, Side::from(-2));
    assert_eq!(find(&list, "E13", "its norm").lhs, Side::from(Rational::from((1, 2))));
    rounds_to(&find(&list, "E13", "cos(2 pi t/T)").rhs, "0.62832");
}

#[test]
fn relative_degree_to_the_quoted_digits() {
    let list = errata(None);
    rounds_to(&find(&list, "E14", "real part").lhs, "0.683");
    rounds_to(&find(&list, "E14", "imaginary part").lhs, "1.940");
    rounds_to(&find(&list, "E14", "real zero").lhs, "-2.365");
    let determinant = find(&list, "E14", "det(2 I - A)");
    assert_eq!((&determinant.lhs, &determinant.rhs), (&Side::from(24), &Side::from(24)));
}

#[test]
fn claims_and_slips() {
    let list = errata(None);
    assert_eq!(find(&list, "E15", "common h = 1/4").lhs, Side::from(Rational::from((14, 3))));
    assert_eq!(find(&list, "E15", "2/n_100").lhs, Side::from(2000));
    let increase = find(&list, "E15", "increases with n_o");
    assert_eq!((&increase.lhs, &increase.rhs), (&Side::from(1), &Side::from(7)));
    rounds_to(&find(&list, "E16", "K_alpha/c").lhs, "1.1374");
    rounds_to(&find(&list, "E16", "beta_s").lhs, "2.000");
    assert_eq!(find(&list, "E16", "54 = 9").lhs, Side::from(60));
    for (fragment, lhs, rhs) in [
        ("S_m(x)", (1, 5), (1, 8)),
        ("z_a with m_p", (-59, 18), (-175, 54)),
        ("lambda_b without", (147, 1600), (0, 1)),
        ("Q_m: ", (13, 1), (12, 1)),
        ("corrected sum", (53, 25), (7, 2)),
        ("interval", (1, 5), (1, 144)),
        ("5 e_b", (30, 1), (5, 1)),
        ("Fourier sums", (1, 2), (1, 4)),
    ] {
        let evidence = find(&list, "E17", fragment);
        let sides = (Side::from(Rational::from(lhs)), Side::from(Rational::from(rhs)));
        assert_eq!((evidence.lhs.clone(), evidence.rhs.clone()), sides, "{fragment}");
    }
}

#[test]
fn example_and_tables() {
    let list = errata(None);
    rounds_to(&find(&list, "E18", "first component").lhs, "0.000000");
    rounds_to(&find(&list, "E18", "the second, cos").lhs, "1.000000");
    let forty = find(&list, "E19", "first table, sigma = 40");
    assert_eq!(forty.lhs, Side::from(Rational::from((5715, 100_000))));
    rounds_to(&forty.rhs, "0.0140");
    assert_eq!(find(&list, "E20", "P:27").relation, Relation::GreaterOrEqual);
    // 0.940^150 = 9.3e-5
    rounds_to(&find(&list, "E21", "0.940^150").lhs, "9.3e-8");
    rounds_to(&find(&list, "E21", "150th period").lhs, "1.50e-6");
    rounds_to(&find(&list, "E21", "150th period").rhs, "3.04e-8");
    rounds_to(&find(&list, "E21", "steady state").lhs, "3.04e-8");
    assert_eq!(find(&list, "E22", "variance").lhs, Side::from(100));
    assert_eq!(find(&list, "E23", "corner").rhs, Side::from(3));
    rounds_to(&find(&list, "E23", "unbounded").lhs, "6.283e6");
    rounds_to(&find(&list, "E23", "pi^2/6").lhs, "3.645");
}

#[test]
fn the_noise_is_never_within_the_stated_bound() {
    let list = errata(None);
    let probability = &find(&list, "E22", "probability").lhs;
    // p n = 2 phi(4) (1/4 - 1/64) 1.5e7 = 940.9, and e^-940.9 = 10^-408.6.
    let enclosure = probability.enclosure();
    assert!(enclosure.lower_decimal(3).ends_with("e-409"), "{probability}");
}

#[test]
fn texts_are_plain() {
    let (items, blocks) = (errata(None), ErrataReport::new(None, None).blocks());
    // Two blocks for each item, below the title and the sentence at the top.
    assert_eq!(blocks.len(), 2 + 2 * items.len());
    for (item, blocks) in items.iter().zip(blocks[2..].chunks(2)) {
        let [Block::Heading(title), Block::Facts(facts)] = blocks else { panic!("{}: {blocks:?}", item.id) };
        assert_eq!(*title, format!("{} [{}]", item.id, item.class));
        let names: Vec<&str> = facts.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names[..3], ["place", "printed", "instead"], "{}", item.id);
        assert_eq!(names[3..], vec!["evidence"; item.evidence.len()], "{}", item.id);
        for (_, text) in facts {
            assert!(text.is_ascii() && !text.contains("  ") && !text.contains("undefined"), "{text}");
        }
    }
}

#[test]
fn relations_decide_exactly_and_by_enclosures() {
    use Relation::{Different, Equal, Greater, GreaterOrEqual, Less, LessOrEqual};
    use Truth::{False, True, Undecided};
    let (one, two) = (Side::from(1), Side::from(2));
    let third = Side::from(Side::from(Rational::from((1, 3))).enclosure());
    for (relation, expected) in [
        (Less, True),
        (LessOrEqual, True),
        (Greater, False),
        (GreaterOrEqual, False),
        (Equal, False),
        (Different, True),
    ] {
        assert_eq!(relation.decide(&one, &two), expected, "{relation}");
        assert_eq!(relation.decide(&third, &one), expected, "{relation}");
    }
    for (relation, expected) in [
        (Less, False),
        (LessOrEqual, True),
        (Greater, False),
        (GreaterOrEqual, True),
        (Equal, True),
        (Different, False),
    ] {
        assert_eq!(relation.decide(&one, &one), expected, "{relation}");
        assert_eq!(relation.decide(&third, &third), Undecided, "{relation}");
    }
    let exact = Side::from(one.enclosure());
    assert_eq!(Equal.decide(&exact, &one), True);
    assert!(!Evidence::rigorous("false", (2, Less, 1)).is_proved());
    assert!(!Evidence::cited("true", (1, Less, 2)).is_proved());
}
