//! Hostile input: an answer at once, in words, and never a panic.

use crate::common::{BOXES, PAPER, assert_refused, certificate, changed, said, text, with};
use proofs_check::check;
use proofs_check::verdict::Verdict::{BadInput, Invalid, Undecided};

fn ratio(text: &str) -> rug::Rational {
    let (numerator, denominator) = text.split_once('/').unwrap_or((text, "1"));
    let part = |text| proofs_check::json::decimal(text).expect("a decimal");
    part(numerator) / part(denominator)
}

fn refused(bytes: &[u8]) -> String {
    let report = check(bytes);
    assert_eq!(report.verdict, BadInput);
    report.finding.unwrap().message
}

#[test]
fn no_certificate_at_all() {
    for bytes in
        [&b""[..], b" ", b"{", b"[]", b"nul", b"\xff\xfe", b"\xef\xbb\xbf{}", b"{} {}", b"\"\\ud800\"", b"1e999999999"]
    {
        refused(bytes);
    }
}

#[test]
fn deep_nesting() {
    let deep = |n: usize| format!("{}{}", "[".repeat(n), "]".repeat(n));
    assert!(refused(deep(100_000).as_bytes()).contains("nested"));
    assert!(refused("{\"a\":".repeat(100_000).as_bytes()).contains("nested"));
    assert_refused(
        &changed(PAPER, "/witness/D_x", serde_json::from_str::<serde_json::Value>(&deep(10)).unwrap()),
        BadInput,
        "format",
        "/witness/D_x",
    );
}

#[test]
fn long_keys() {
    let key = "k".repeat(2_000_000);
    assert!(refused(format!("{{\"{key}\": 1}}").as_bytes()).contains("key"));
    let nested = format!("{{\"{}\":", "k".repeat(200_000)).repeat(10) + "1" + &"}".repeat(10);
    assert!(refused(nested.as_bytes()).contains("key"));
    // A quote, a colon or a bracket inside a string begins nothing.
    let report = changed(PAPER, "/specification/name", format!("\"{}\": [{{", "k".repeat(200)));
    assert_eq!(report.verdict, proofs_check::verdict::Verdict::Valid, "{}", report.text(false));
}

#[test]
fn effort_is_counted() {
    let certificate = text("certificates", PAPER);
    let whole = check(certificate.as_bytes());
    assert!((1_000..1_000_000).contains(&whole.steps), "{}", whole.steps);
    // Whatever is left out of it, the answer is that nothing is decided; what is spent never exceeds what may be.
    for limit in (0..whole.steps).step_by(whole.steps as usize / 40) {
        let report = proofs_check::check_within(certificate.as_bytes(), None, limit);
        assert!(report.verdict == Undecided && report.steps <= limit, "{limit}: {}", report.text(false));
    }
    // Where the last step is the one that is missing, it is missing too.
    let report = proofs_check::check_within(certificate.as_bytes(), None, whole.steps);
    assert_eq!(report.verdict, Undecided);
    let report = proofs_check::check_within(certificate.as_bytes(), None, whole.steps + 1);
    assert_eq!((report.verdict, report.steps), (whole.verdict, whole.steps));
}

#[test]
fn thousands_of_boxes() {
    // Every box of a valid certificate cut into many: as true as before, and within the steps, at any precision it names.
    let mut certificate = certificate(BOXES);
    for list in certificate["witness"]["transfer"]["boxes"].as_array_mut().unwrap() {
        let points: Vec<rug::Rational> =
            list.as_array().unwrap().iter().map(|point| ratio(point.as_str().unwrap())).collect();
        let cut = |pair: &[rug::Rational]| {
            let (a, step) = (pair[0].clone(), rug::Rational::from(&pair[1] - &pair[0]) / 60u32);
            (0..60u32).map(|i| (rug::Rational::from(&step * i) + &a).to_string()).collect::<Vec<_>>()
        };
        let mut fine: Vec<String> = points.windows(2).flat_map(cut).collect();
        fine.extend(points.last().map(ToString::to_string));
        *list = fine.into();
    }
    certificate["precision_bits"] = 4096.into();
    let report = check(certificate.to_string().as_bytes());
    assert!(report.is_valid() && report.steps < proofs_check::effort::LIMIT / 5, "{}", report.text(false));
}

#[test]
fn large_files() {
    assert!(refused(&vec![b' '; 100 << 20]).contains("bytes"));
    let report = proofs_check::check_reader(&mut std::io::repeat(b'['), None).unwrap();
    assert_eq!(report.verdict, BadInput);
    let million = format!("[{}0]", "0,".repeat(1_000_000));
    assert!(refused(million.as_bytes()).contains("values"));
}

#[test]
fn a_million_boxes() {
    let mut list = vec!["0".to_owned()];
    list.extend((1..30_000).map(|i| format!("{i}/60000")));
    let mut certificate = certificate(BOXES);
    certificate["witness"]["transfer"]["boxes"][0] = list.into();
    assert_refused(&check(certificate.to_string().as_bytes()), Invalid, "transfer bound", "/witness/transfer");
    let million: Vec<_> = (0..1_000_000).map(|_| "1").collect();
    certificate["witness"]["transfer"]["boxes"][0] = million.into();
    assert_eq!(check(certificate.to_string().as_bytes()).verdict, BadInput);
}

#[test]
fn numbers_too_large_to_form() {
    for number in [
        "1e999999999",
        "-1e999999999",
        "1e-999999999",
        "1e99999999999999999999",
        "1/1e4001",
        "1/0",
        "0/0",
        "NaN",
        "1e",
        "",
    ] {
        assert_refused(&changed(PAPER, "/witness/D_x", number), BadInput, "format", "/witness/D_x");
    }
    let long = "9".repeat(100_000);
    assert_refused(&changed(PAPER, "/claim/sigma_star", long.as_str()), BadInput, "format", "/claim/sigma_star");
    let original = text("certificates", PAPER);
    let raw = original.replacen("\"precision_bits\": 128", "\"precision_bits\": 1e999999999", 1);
    assert_ne!(raw, original);
    assert_eq!(check(raw.as_bytes()).verdict, BadInput);
    for bits in [0_u64, 52, 5000, 4_000_000_000] {
        assert_refused(&changed(PAPER, "/precision_bits", bits), BadInput, "format", "/precision_bits");
    }
}

#[test]
fn numbers_near_the_limits_are_formed_and_refused() {
    for number in ["1e4000", "1e-4000", "-1e4000"] {
        for pointer in
            ["/witness/D_x", "/witness/r_e", "/witness/h", "/witness/k1", "/claim/sigma_star", "/witness/X_p"]
        {
            let report = changed(PAPER, pointer, number);
            if (pointer, number) == ("/claim/sigma_star", "1e4000") {
                // What is proved of every gain from a smaller one on.
                assert!(said(&report).contains("every gain sigma >= 1e4000,"), "{}", report.text(false));
                continue;
            }
            assert!([Invalid, Undecided].contains(&report.verdict), "{pointer} = {number}: {}", report.text(false));
        }
    }
}

#[test]
fn expressions_that_explode() {
    let towers = [
        "10^10^10",
        "2^(2^(2^100))",
        "1/0",
        "0^(0-1)",
        "exp(exp(exp(exp(9))))",
        "tan(pi/2)",
        "log(0)",
        "(1e4000)^1000",
    ];
    for text in towers {
        for pointer in ["/specification/period", "/specification/bounds/q", "/specification/internal_model/mu"] {
            let report = changed(PAPER, pointer, text);
            assert_ne!(report.verdict, proofs_check::verdict::Verdict::Valid, "{pointer} = {text}");
        }
    }
    let deep = format!("{}1{}", "(".repeat(5000), ")".repeat(5000));
    assert_refused(&changed(PAPER, "/specification/bounds/q", deep), BadInput, "format", "/specification/bounds/q");
    let long = "X+".repeat(4999) + "X";
    assert_refused(&changed(PAPER, "/specification/bounds/q", long), BadInput, "format", "/specification/bounds/q");
    // An odd number of signs: a negative bound.
    let signs = "-".repeat(9_001) + "1";
    assert_refused(
        &changed(PAPER, "/specification/bounds/q", signs),
        Invalid,
        "bounding functions",
        "/specification/bounds/q",
    );
}

#[test]
fn many_weights() {
    let values: Vec<_> = (0..1001).map(|_| "1").collect();
    let weights = serde_json::json!({ "family": "explicit", "values": values, "tail": { "coefficient": "1", "exponent": "3/2" } });
    let report = with(PAPER, "/specification/internal_model", "weights", weights);
    assert_refused(&report, BadInput, "format", "/specification/internal_model/weights");
}
