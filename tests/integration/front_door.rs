//! The library as a program outside of this package uses it: the crate root alone.

use crate::support::{EXAMPLE, EXAMPLE_TEXT, ROOT, json, program, utf8};
use sigmastar::{
    BoundingFunction as Bound, Certificate, CertifyOptions, CheckReport, CheckVerdict, Error, ErrorKind, JacobianEntry,
    RegulatorMatrices, Report, ReportFormat, Specification, SpecificationBuilder, Study, Subject, TransferChoice,
    TransferOptions, Verdict, certify, check, check_against, regulator_matrices, sampled_regulator, transfer_bound,
    transfer_study,
};

/// The paper's example without its Lyapunov data.
fn without_lyapunov() -> SpecificationBuilder {
    Specification::builder("Example of the paper")
        .period("1")
        .bound(Bound::F, "2.302*X + 0.112*X^2 + (X + 0.189)*E")
        .bound(Bound::Fe, "X + 0.189")
        .bound(Bound::Fxx, "0.2237")
        .bound(Bound::Fex, "1")
        .bound(Bound::Q, "4.822 + X + atan(E*(X + 0.189))")
        .bound(Bound::Qe, "X + 0.189")
        .bound(Bound::Qx, "sqrt(1 + E^2)")
        .bound(Bound::Qt, "24.18 + 2.106*E")
        .domain("10", "10")
        .mu("1")
        .matched_base_frequency("2*pi")
        .power_weights("2", "1/2")
        .initial_set_of_the_paper()
}

fn builder() -> SpecificationBuilder {
    without_lyapunov().lyapunov("1", "1.5512", "0.58")
}

fn example() -> Specification {
    builder().build().expect("it is the paper's example")
}

/// The optional data of the builder are those of a file.
/// The package outside of the workspace, with this package's features.
#[path = "../../examples/outside/src/main.rs"]
#[allow(dead_code, reason = "its `main` prints")]
mod outside;

#[test]
fn the_package_outside_certifies_and_checks() {
    let (certificate, answer) = outside::certified_and_checked().unwrap();
    assert_eq!(certificate.claim().sigma_star(), "1.32369");
    assert!(answer.is_valid(), "{}", answer.text());
}

#[test]
fn optional_data_lower_the_gain() {
    let sigma = |builder: SpecificationBuilder| {
        let certificate = certify(builder.build().expect("it is read"), &quick()).expect("it certifies");
        assert!(check(certificate.to_json()).is_valid());
        certificate.claim().sigma_star_f64()
    };
    let known = ["1.8756", "0.79156", "0.49414", "0.12493", "0.062502"];
    let with = builder().known_forcing(known, "1e-5", Some("1e-3")).bound(Bound::QeMax, "X/2 + 0.05");
    assert!(sigma(with) < 0.9 * sigma(builder()));
    let refused = builder().known_forcing(["-1"], "0", None).build();
    assert_eq!(kind(refused), ErrorKind::Range);
}

fn quick() -> CertifyOptions {
    CertifyOptions::new().compare(false)
}

fn kind<T>(result: Result<T, Error>) -> ErrorKind {
    result.err().expect("an error").kind()
}

#[test]
fn the_example_built_in_rust_is_certified_and_checked() {
    let specification = example();
    let certificate = certify(&specification, &CertifyOptions::new()).unwrap();
    let claim = certificate.claim();
    assert_eq!(claim.sigma_star(), "39.8018");
    // Rounded up: the nearest double to 39.8018, or the one above it.
    assert!((0.0..1e-14).contains(&(claim.sigma_star_f64() - 39.8018)), "{}", claim.sigma_star_f64());
    assert!(claim.statement().contains("every gain sigma >= 39.8018"));
    assert_eq!(claim.specification_sha256(), specification.sha256());
    let (set, periodic) = (claim.initial_set(), claim.periodic_solution());
    let (x0, e0, z0) = set.exact();
    for (exact, down) in [(x0, set.x0()), (e0, set.e0()), (z0.unwrap(), set.z0().unwrap())] {
        let exact: f64 = exact.parse().unwrap();
        assert!(down <= exact && down > exact * (1.0 - 1e-14), "{down} {exact}");
    }
    assert!((periodic.e - 0.166660).abs() < 1e-5 && periodic.zeta < periodic.z, "{periodic:?}");
    assert!(2.0 * periodic.x <= set.x0() * (1.0 + 1e-6));
    assert!(certificate.remarks().is_empty());

    let ids: Vec<&str> = certificate.conditions().iter().map(|condition| condition.id()).collect();
    for id in ["S1", "S2", "C4", "C5"] {
        assert!(ids.contains(&id), "{id}: {ids:?}");
    }
    for condition in certificate.conditions() {
        assert_eq!(condition.holds(), Some(true), "{condition:?}");
        assert!(condition.lhs()[0] <= condition.lhs()[1] && condition.rhs()[0] <= condition.rhs()[1]);
        assert!(condition.lhs()[0] <= condition.rhs()[1] && !condition.text().is_empty());
        assert!(["<", "<="].contains(&condition.relation()));
    }

    let report = check(certificate.to_json());
    assert!(report.is_valid(), "{}", report.text());
    assert_eq!(report.statement(), Some(claim.statement()));
    assert_eq!(report.specification_sha256(), Some(specification.sha256()));
    assert!(!report.assumed().is_empty());
    assert!(check_against(certificate.to_json(), &specification).is_valid());
    let other = builder().period("2").matched_base_frequency("pi").build().unwrap();
    assert_eq!(check_against(certificate.to_json(), &other).verdict(), CheckVerdict::Invalid);
}

#[test]
fn a_forged_certificate_is_refused() {
    let certificate = certify(example(), &quick()).unwrap();
    let forged = certificate.to_json().replace("\"sigma_star\": \"39.8018\"", "\"sigma_star\": \"39\"");
    assert_ne!(forged, certificate.to_json());
    let report = check(&forged);
    assert_eq!((report.verdict(), report.statement()), (CheckVerdict::Invalid, None));
    assert!(!report.is_valid() && report.text().contains("rule:"));
    assert_eq!(check("no certificate").verdict(), CheckVerdict::BadInput);
}

#[test]
fn the_certificate_is_that_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("certificate.json");
    program().args(["certify", EXAMPLE, "--no-alternatives", "-o"]).arg(&file).current_dir(ROOT).assert().success();
    let specification = Specification::from_json(EXAMPLE_TEXT).unwrap();
    let certificate = certify(&specification, &quick()).unwrap();
    assert_eq!(certificate.to_json(), std::fs::read_to_string(file).unwrap());
    assert_eq!(specification.name(), "Example of the paper");
    // The document is kept as it is written.
    let again = Specification::from_json(&specification.to_json()).unwrap();
    assert_eq!(again.sha256(), specification.sha256());
}

#[test]
fn a_specification_with_a_jacobian_is_certified() {
    let rows: [[JacobianEntry; 2]; 2] = [
        ["-1/5".into(), ("sqrt(3) + cos(0.189)/10", "sqrt(3) + 1/10").into()],
        ["-sqrt(3)".into(), ("-1 - 0.143/5", "-1 + 0.189/5").into()],
    ];
    let specification = without_lyapunov().jacobian(rows).build().unwrap();
    let certificate = certify(&specification, &quick()).unwrap();
    assert!(certificate.claim().statement().contains("its Lyapunov triple is proved"));
    let report = check_against(certificate.to_json(), &specification);
    assert!(report.is_valid(), "{}", report.text());

    // No triple can be found for an unstable one.
    let unstable = without_lyapunov().jacobian([[JacobianEntry::from("1/5")]]).build().unwrap();
    let error = certify(&unstable, &quick()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Undecided);
    assert!(error.to_string().contains("/lyapunov/jacobian") && error.to_string().contains("help: "), "{error}");
}

#[test]
fn options_choose_the_transfer_proof_and_the_precision() {
    let sigma = |options: CertifyOptions| certify(example(), &options).unwrap().claim().sigma_star_f64();
    let sharp = sigma(quick());
    assert!(sigma(quick().transfer(TransferChoice::ClosedForm)) > sharp);
    assert!((sigma(quick().precision_limit(CertifyOptions::LEAST_PRECISION_LIMIT)) - sharp).abs() < 1.0);
    for bits in [0, 127, 1025, u32::MAX] {
        assert_eq!(kind(certify(example(), &quick().precision_limit(bits))), ErrorKind::Range);
    }
}

#[test]
fn every_kind_of_weights_and_initial_set_can_be_built() {
    let tail = ["2", "1", "0.35"];
    for builder in [
        builder().initial_set_at_rest(None, None),
        builder().initial_set_at_rest(Some("1/10"), Some("0.1")),
        builder().initial_set_box("0.1", "0.2", "0"),
        builder().explicit_weights(tail, "1", "3/2").base_frequency("6").description("any frequency"),
        builder().relative_degree(["3", "2"]).bound(Bound::QRms, "3.5 + X").bound(Bound::QtRms, "18 + 2*E"),
    ] {
        let specification = builder.build().unwrap_or_else(|error| panic!("{error}\n{}", builder.to_json()));
        assert_eq!(specification.to_json(), builder.to_json());
    }
}

#[test]
fn errors_have_kinds_places_and_help() {
    let read = |old: &str, new: &str| {
        assert!(EXAMPLE_TEXT.contains(old), "{old}");
        Specification::from_json(&EXAMPLE_TEXT.replace(old, new)).expect_err("an error")
    };
    for (old, new, expected, place) in [
        ("\"period\": \"1\",", "\"period\": ", ErrorKind::Document, "specification:6:"),
        ("\"version\": 1", "\"version\": 7", ErrorKind::Format, "/version"),
        ("\"f_xx\"", "\"f_xy\"", ErrorKind::Field, "/bounds"),
        ("X + 0.189)*E", "X + 0.189)*", ErrorKind::Expression, "/bounds/f"),
        ("\"0.58\"", "\"-0.58\"", ErrorKind::Range, "/lyapunov/alpha"),
        ("\"2*pi\"", "\"6.28\"", ErrorKind::Range, "/internal_model/base_frequency"),
    ] {
        let error = read(old, new);
        assert_eq!(error.kind(), expected, "{error}");
        assert!(error.to_string().contains(place), "{place}: {error}");
        assert!(error.conditions().is_empty());
    }
    assert!(read("\"2*pi\"", "\"6.28\"").to_string().contains("help: or set `matched` to false"));

    // What is missing is missing in Rust too, and all of it is told.
    let error = Specification::builder("empty").build().unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Field);
    for field in ["period", "lyapunov", "bounds", "internal_model", "initial_set"] {
        assert!(error.to_string().contains(field), "{field}: {error}");
    }
    let text: &dyn std::error::Error = &error;
    assert!(text.source().is_none());
}

#[test]
fn what_is_not_certified_says_why() {
    let falling = builder().bound(Bound::Q, "5 - X").build().unwrap();
    let error = certify(&falling, &quick()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Range, "{error}");
    assert!(error.to_string().contains("/bounds/q"), "{error}");

    // An initial set that is too large for the domain.
    let large = builder().domain("1", "1").initial_set_box("1", "4", "0").build().unwrap();
    let error = certify(&large, &quick()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::NotCertified, "{error}");
    assert!(error.to_string().contains("domain"), "{error}");

    let unstable_filter = builder().relative_degree(["1", "-1"]).build().unwrap();
    assert_eq!(kind(certify(&unstable_filter, &quick())), ErrorKind::Range);
}

#[test]
fn the_transfer_bound() {
    let specification = example();
    let bound = transfer_bound(&specification, "20").unwrap();
    let k1: f64 = bound.k1().parse().unwrap();
    assert_eq!((bound.k0(), bound.k0_f64()), ("20", 20.0));
    assert!(bound.k1_f64() >= k1 && (70.0..75.0).contains(&k1), "{bound:?}");
    assert!(bound.excess().is_some_and(|excess| excess < 0.01), "{bound:?}");
    // T_N(0) = 2 pi^2 for nu = 1/(2 pi) and n_0 = 2.
    let error = transfer_bound(&specification, "19.7").unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Refuted);
    assert!(error.to_string().contains("19.739"), "{error}");
    assert_eq!(kind(transfer_bound(&specification, "-1")), ErrorKind::Range);
    assert_eq!(kind(transfer_bound(&specification, "2*")), ErrorKind::Expression);
    // Not a rational number, and rounded up.
    let irrational = transfer_bound(&specification, "2*pi^2").unwrap();
    assert!(irrational.k0_f64() > 2.0 * std::f64::consts::PI.powi(2), "{irrational:?}");
}

#[test]
fn the_matrices_of_the_regulator() {
    let specification = example();
    let regulator = regulator_matrices(&specification, "48", 2).unwrap();
    let w = 2.0 * std::f64::consts::PI;
    assert_eq!((regulator.sigma, regulator.mu), (48.0, 1.0));
    assert_eq!(regulator.phi[1], [0.0, 0.0, w, 0.0, 0.0]);
    assert_eq!(regulator.phi[4], [0.0, 0.0, 0.0, -2.0 * w, 0.0]);
    assert_eq!(regulator.gamma, [-48.0, -48.0, w, -48.0, 2.0 * w]);
    assert_eq!(regulator.m, [1.0, 1.0, 0.0, 1.0, 0.0]);
    assert_eq!(regulator.n_diagonal[..3], [2.0, 1.0, 1.0]);
    // u = -sigma e + mu (n_0 (z_0 - e) + ...).
    let u = regulator.control(&[1.0, 0.0, 7.0, 0.0, 7.0], 0.0);
    assert_eq!(u, Some(2.0));
    assert_eq!(regulator.control(&[1.0], 0.0), None);
    assert!((regulator.control(&[0.0; 5], 1.0).unwrap() + 48.0 + 3.0 + regulator.n_diagonal[3]).abs() < 1e-12);

    let sampled = sampled_regulator(&specification, "48", 2, "1/1000").unwrap();
    assert_eq!((sampled.step, sampled.gamma[0]), (1e-3, -0.048));
    assert_eq!(sampled.phi[1][1..3], [(w / 1e3).cos(), (w / 1e3).sin()]);
    assert!(sampled.spectral_radius < 1.0);
    assert_eq!(kind(sampled_regulator(&specification, "48", 2, "1/24")), ErrorKind::Range);
    assert_eq!(kind(sampled_regulator(&specification, "48", 2, "0")), ErrorKind::Range);
    let most = RegulatorMatrices::MAX_OSCILLATORS;
    assert_eq!(kind(regulator_matrices(&specification, "48", most + 1)), ErrorKind::Range);
    assert_eq!(kind(regulator_matrices(&specification, "1e4000", 0)), ErrorKind::Overflow);
    let error = regulator_matrices(&specification, "48 *", 1).unwrap_err();
    assert!(error.kind() == ErrorKind::Expression && error.to_string().starts_with("sigma: "), "{error}");
}

#[test]
fn its_types_cross_threads() {
    fn crosses<T: Send + Sync + Clone + std::fmt::Debug + 'static>() {}
    crosses::<Specification>();
    crosses::<SpecificationBuilder>();
    crosses::<Certificate>();
    crosses::<CheckReport>();
    crosses::<Error>();
    crosses::<Subject>();
    crosses::<Study>();
    crosses::<Report>();
}

const PLANT_PATH: &str = "specs/plants/relative-degree-2.json";
const PLANT: &str = include_str!("../../specs/plants/relative-degree-2.json");
const STUDY: &str = "specs/studies/linear.json";

fn plant() -> Subject {
    Subject::from_json(PLANT).expect("shipped")
}

/// What the program writes for `certify`.
fn told(args: &[&str]) -> Vec<u8> {
    program()
        .arg("certify")
        .args(args)
        .args(["--no-alternatives", "--quiet"])
        .output()
        .expect("the program runs")
        .stdout
}

#[test]
fn a_plant_is_certified_and_checked() {
    let plant = plant();
    assert!(plant.is_plant());
    let certificate = certify(&plant, &CertifyOptions::new().compare(false)).unwrap();
    let report = told(&[PLANT_PATH, "--format", "json"]);
    assert_eq!(certificate.report().render(ReportFormat::Json).as_bytes(), report);
    assert_eq!(certificate.claim().sigma_star(), json(&report)["sigma_star"]);
    assert_eq!(certificate.claim().specification_sha256(), plant.sha256());
    assert!(certificate.claim().statement().contains("the plant of these formulas"));
    assert!(certificate.claim().initial_set().ball().is_some() && certificate.claim().samples().is_none());
    assert!(check_against(certificate.to_json(), &plant).is_valid());
    assert_eq!(check_against(certificate.to_json(), example()).verdict(), CheckVerdict::Invalid);
    assert_eq!(certificate.subject().to_json(), plant.to_json());
    assert_eq!(regulator_matrices(&plant, certificate.claim().sigma_star(), 1).unwrap().phi.len(), 3);

    let unstable = include_str!("../../specs/plants/invalid/unstable.json");
    let error = certify(Subject::from_bytes("unstable.json", unstable.as_bytes()).unwrap(), &quick()).unwrap_err();
    assert_eq!((error.kind(), error.verdict()), (ErrorKind::Undecided, Verdict::Undecided), "{error}");
    let first = &error.diagnostics()[0];
    assert_eq!((first.file.as_str(), first.pointer.as_str()), ("unstable.json", "/f"));
    assert!(first.place.is_some_and(|(line, _)| line > 1) && error.to_string().contains(&first.message));
}

#[test]
fn the_regulator_at_samples_is_certified() {
    let options = quick().sampling_period("1/500");
    let certificate = certify(example(), &options).unwrap();
    let report = json(&told(&[EXAMPLE, "--sampling-period", "1/500", "--format", "json"]));
    let claim = certificate.claim();
    let samples = claim.samples().unwrap();
    assert_eq!(
        (claim.sigma_star(), samples.period.as_str(), samples.count),
        (report["sigma"].as_str().unwrap(), "0.002", 500)
    );
    assert_eq!(samples.gain, report["gain"].as_str().unwrap());
    assert!(claim.statement().contains("n_o < 500/2"));
    assert!(check(certificate.to_json()).is_valid());
    // The subject has the sampling period, as the certificate says.
    assert_eq!(certificate.subject().sha256(), claim.specification_sha256());
    assert_ne!(claim.specification_sha256(), example().sha256());

    // A document with a sampling period is about the regulator at samples by itself.
    let again = certify(certificate.subject(), &quick()).unwrap();
    assert_eq!(again.to_json(), certificate.to_json());

    let boxes = options.clone().transfer(TransferChoice::Boxes);
    let error = certify(example(), &boxes).unwrap_err();
    assert_eq!((error.kind(), error.verdict()), (ErrorKind::Options, Verdict::BadInput));
    assert_eq!(kind(certify(example(), &quick().sampling_period("1/3.5"))), ErrorKind::Range);
    assert_eq!(kind(certify(example(), &quick().sampling_period("0"))), ErrorKind::Range);
    let error = certify(example(), &options.sigma("600")).unwrap_err();
    assert_eq!((error.kind(), error.verdict()), (ErrorKind::NotCertified, Verdict::Undecided));
    assert!(error.to_string().contains("h sigma exceeds 1"), "{error}");
}

/// What is said by the number of oscillators, and for sets of harmonics, is that of the certificate, rounded to the safe side.
#[test]
fn rates_and_bounds_are_those_of_the_certificate() {
    let plant = Subject::from_json(include_str!("../../specs/plants/linear.json")).unwrap();
    let options = CertifyOptions::new().sigma("5").n_o([0, 3]).harmonics([0, 1, 3]).harmonics([2, 0]);
    let certificate = certify(&plant, &options).unwrap();
    let written = json(certificate.to_json().as_bytes());
    let number = |value: &serde_json::Value| value.as_str().unwrap().parse::<f64>().unwrap();
    let claim = certificate.claim();
    let entries = written["claim"]["by_n_o"].as_array().unwrap();
    assert!(claim.bounds().len() == entries.len() && entries.len() > 2);
    for (bounds, entry) in claim.bounds().iter().zip(entries) {
        assert_eq!(bounds.n_o().map(u64::from), entry["n_o"].as_u64());
        let [error, control] = bounds.largest.unwrap();
        let found = [bounds.steady_error, bounds.steady_rms, bounds.steady_control, error, control];
        let (steady, largest) = (&entry["steady"], &entry["largest"]);
        let stated = [&steady["e"], &steady["e_rms"], &steady["u"], &largest["e"], &largest["u"]].map(number);
        // Either the double nearest to it or the next one.
        assert!(found.iter().zip(stated).all(|(found, stated)| *found == stated || *found == stated.next_up()));
    }
    let sets: Vec<&[u32]> = claim.bounds().iter().rev().take(2).map(|bounds| &bounds.harmonics[..]).collect();
    assert_eq!(sets, [&[0, 2][..], &[0, 1, 3]]);
    let rates = written["claim"]["for_n_o"].as_array().unwrap();
    let of_rates: Vec<&[u32]> = claim.rates().iter().map(|rate| &rate.harmonics[..]).collect();
    assert_eq!(of_rates, [&[0][..], &[0, 1, 2, 3], &[0, 1, 3], &[0, 2]]);
    assert_eq!(claim.rates().iter().map(|rate| rate.n_o()).collect::<Vec<_>>(), [Some(0), Some(3), None, None]);
    for (rate, entry) in claim.rates().iter().zip(rates) {
        assert!(rate.rate <= number(&entry["rate"]) && rate.factor >= number(&entry["factor"]) && rate.rate > 0.0);
    }
    assert!(claim.statement().contains("every finite set of harmonics"), "{}", claim.statement());
    assert!(check(certificate.to_json()).is_valid());

    // At samples every set that they tell apart.
    let text = include_str!("../../specs/machines/boost-converter.toml");
    let machine = Subject::from_bytes("boost-converter.toml", text.as_bytes()).unwrap();
    let at_samples = CertifyOptions::new().sampling_period("1/20000").harmonics([0, 1, 5]);
    let sampled = certify(&machine, &at_samples).unwrap();
    assert_eq!(sampled.claim().bounds().last().unwrap().harmonics, [0, 1, 5]);
    for (set, said) in [
        (vec![0, 100], "100 is not"),
        (vec![1, 5], "without it there is no integrator"),
        (vec![0, 1, 1], "harmonic 1 is there twice"),
        (vec![0, 101], "101 is beyond 100"),
    ] {
        let error = certify(&machine, &at_samples.clone().harmonics(set)).unwrap_err();
        assert!(error.kind() == ErrorKind::Options && error.to_string().contains(said), "{error}");
    }
    // Without them there is nothing of this kind.
    let plain = certify(example(), &quick()).unwrap();
    assert!(plain.claim().bounds().is_empty() && plain.claim().rates().is_empty());
}

#[test]
fn a_given_gain_is_certified_or_not() {
    let certificate = certify(example(), &quick().sigma("85/2")).unwrap();
    assert_eq!(certificate.claim().sigma_star(), "42.5");
    let error = certify(example(), &quick().sigma("39")).unwrap_err();
    assert_eq!((error.kind(), error.verdict()), (ErrorKind::NotCertified, Verdict::Undecided));
    assert!(error.diagnostics().is_empty());
    let report = error.report().expect("a run was made").to_string();
    assert!(report.contains("What to try:") && report.contains("no sigma is certified"), "{report}");
    assert_eq!(kind(certify(example(), &quick().sigma("pi"))), ErrorKind::Range);
    assert_eq!(kind(certify(example(), &quick().sigma("-1"))), ErrorKind::Range);
}

#[test]
fn the_report_is_that_of_the_program() {
    let certificate = certify(example(), &CertifyOptions::new()).unwrap();
    let formats = [ReportFormat::Text, ReportFormat::Markdown, ReportFormat::Html, ReportFormat::Json];
    // The builder leaves the description out, which no report shows; the digest is another one.
    let file = Subject::from_json(EXAMPLE_TEXT).unwrap();
    let of_file = certify(&file, &CertifyOptions::new()).unwrap();
    for (format, word) in formats.into_iter().zip(["text", "markdown", "html", "json"]) {
        let output = program().args(["certify", EXAMPLE, "--format", word, "--quiet", "--full"]).output().unwrap();
        let (own, shown) = (of_file.report().render(format), utf8(output.stdout));
        if word == "html" {
            // The page of the program has a simulation besides, which is of no report.
            let alike = |of: &mut dyn Iterator<Item = (u8, u8)>| of.take_while(|(a, b)| a == b).count();
            let before = alike(&mut own.bytes().zip(shown.bytes()));
            let after = alike(&mut own.bytes().rev().zip(shown.bytes().rev()));
            assert!(before + after >= own.len(), "{} of {}", before + after, own.len());
            let added = &shown[before..shown.len() - (own.len() - before)];
            assert!(added.contains("a simulation"), "{added}");
        } else {
            assert_eq!(own, shown, "{word}");
        }
    }
    let [built, read] = [&certificate, &of_file].map(|of| (of.claim().specification_sha256(), of.report().to_string()));
    assert!(built.0 != read.0 && read.1.contains(read.0), "{}", read.1);
    assert_eq!(built.1.replace(built.0, read.0), read.1);
    let answer = check(certificate.to_json());
    assert_eq!(answer.report().to_string(), answer.text());
    assert!(answer.report().render(ReportFormat::Html).contains("<pre"));
}

#[test]
fn errors_say_the_verdict_of_the_program() {
    for name in
        ["undecided-sign", "matched-undecided", "decreasing-bound", "many-errors", "not-json", "weights-undecided"]
    {
        let path = format!("specs/invalid/{name}.json");
        let report = json(&told(&[&path, "--format", "json"]));
        let bytes = std::fs::read(format!("{ROOT}/{path}")).unwrap();
        let error = Subject::from_bytes(&path, &bytes).and_then(|subject| certify(subject, &quick())).unwrap_err();
        assert_eq!(error.verdict().to_string(), report["verdict"], "{name}");
        let listed: Vec<_> =
            report["errors"].as_array().unwrap().iter().filter(|error| error.get("code").is_some()).collect();
        assert_eq!(error.diagnostics().len(), listed.len(), "{name}");
        for (diagnostic, told) in error.diagnostics().iter().zip(listed) {
            assert_eq!(
                (diagnostic.code, diagnostic.message.as_str()),
                (told["code"].as_str().unwrap(), told["message"].as_str().unwrap())
            );
            assert_eq!((diagnostic.pointer.as_str(), &diagnostic.file), (told["pointer"].as_str().unwrap(), &path));
            let place = diagnostic.place.map(|(line, column)| (line as u64, column as u64));
            assert_eq!(place, told["line"].as_u64().zip(told["column"].as_u64()), "{name}");
        }
    }
}

#[test]
fn the_transfer_study() {
    let study = transfer_study(example(), &TransferOptions::new().k0("20").n_o([Some(1), None])).unwrap();
    assert_eq!(study.bound(), &transfer_bound(example(), "20").unwrap());
    let [one, all] = study.shares() else { panic!("{study:?}") };
    assert_eq!((one.n_o, all.n_o), (Some(1), None));
    for share in [one, all] {
        assert!(share.ratio[0] <= share.ratio[1] && share.ratio[0] > 0.98 && share.ratio[1] <= 1.0, "{study:?}");
    }
    let cheapest = transfer_study(example(), &TransferOptions::new().cheapest("1", "2/3").n_o([])).unwrap();
    assert!(cheapest.bound().k0_f64() > 19.7);
    assert_eq!(kind(transfer_study(example(), &TransferOptions::new().k0("19.7"))), ErrorKind::Refuted);
    assert_eq!(kind(transfer_study(example(), &TransferOptions::new().cheapest("0", "1"))), ErrorKind::Range);
    let many = TransferOptions::new().n_o(vec![None; TransferOptions::MOST + 1]);
    assert_eq!(kind(transfer_study(example(), &many)), ErrorKind::Range);
}

#[test]
fn a_study_is_run_case_by_case_to_the_bytes_of_sweep() {
    let text = std::fs::read(format!("{ROOT}/{STUDY}")).unwrap();
    let subject = |path: &str| {
        assert_eq!(path, "../linear.json");
        std::fs::read(format!("{ROOT}/specs/studies/{path}")).map_err(|error| error.to_string())
    };
    let study = Study::from_bytes(STUDY, &text, subject).unwrap();
    let lines: Vec<String> = (0..study.cases()).map(|index| study.run_case(index).unwrap()).collect();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("results.csv");
    program().args(["sweep", STUDY, "--quiet", "-o"]).arg(&file).assert().success();
    let results = study.results(lines.iter().rev().map(String::as_str)).unwrap();
    assert_eq!(results, std::fs::read_to_string(file).unwrap());

    let case = study.case(12).unwrap();
    assert_eq!(
        case.values,
        [("alpha", "1.5"), ("p_up", "11/10")].map(|(name, value)| (name.to_owned(), value.to_owned()))
    );
    assert_eq!(Subject::from_json(&case.json).unwrap().sha256(), case.sha256);
    assert_eq!(kind(study.case(15)), ErrorKind::Range);
    assert_eq!(kind(study.run_case(u64::MAX)), ErrorKind::Range);

    // Lines that are missing, of another case, changed, or none.
    let all = || lines.iter().map(String::as_str);
    let moved = lines[0].replacen("\"index\":0", "\"index\":1", 1);
    let changed = lines[0].replacen("\"certified\"", "\"undecided\"", 1);
    for (wrong, words) in [
        (all().skip(1).collect::<Vec<_>>(), "1 of 15 cases are missing"),
        (all().chain([moved.as_str()]).collect(), "is not of case 1"),
        (all().chain([changed.as_str()]).collect(), "line 16"),
        (all().chain(["{}"]).collect(), "is no result"),
    ] {
        let error = study.results(wrong).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Results);
        assert!(error.to_string().contains(words), "{words}: {error}");
    }
    let missing = Study::from_bytes(STUDY, &text, |_| Err("it is gone".to_owned())).unwrap_err();
    assert!(missing.to_string().contains("it is gone") && missing.diagnostics()[0].pointer == "/subject", "{missing}");
}
