//! Oscillators at a set of harmonics with gaps: bounds of the certificate against simulations that share nothing with them.

use super::support::{
    assert_valid, certified_in, checked, in_one_line, json, number, program, read, stored, told, utf8,
};
use super::trials_support::{document, simulated};
use serde_json::{Value, json};

const SETS: [&[usize]; 3] = [&[2], &[1, 3], &[1, 2, 4]];

fn entry_of<'c>(certificate: &'c Value, set: &[usize]) -> &'c Value {
    let all: Vec<usize> = std::iter::once(0).chain(set.iter().copied()).collect();
    let entries = certificate["claim"]["by_n_o"].as_array().unwrap();
    entries.iter().find(|entry| entry["harmonics"] == json!(all)).unwrap_or_else(|| panic!("{all:?}: {entries:?}"))
}

#[test]
fn simulations_with_gaps_meet_the_bounds_and_do_not_exceed_them() {
    let folder = tempfile::tempdir().unwrap();
    let flags = ["--harmonics", "0,2", "--harmonics", "3,0,1", "--harmonics", "0,1,2,4", "--harmonics", "0,1,3"];
    let (file, report) = certified_in(folder.path(), &document(), &flags);
    assert_valid(&file);
    let certificate = read(&file);
    assert_eq!(certificate["claim"]["harmonics"], "every finite set that contains 0");
    let sigma = number(&report["sigma_star"]);
    let orbit = &certificate["witness"]["orbit"];
    let cosines = orbit["harmonics"].as_array().unwrap().iter().map(|pair| number(&pair["cos"][0]));
    let at_0 = number(&orbit["mean"][0]) + cosines.sum::<f64>();
    let x_0 = number(&certificate["claim"]["initial_set"]["ball"]);
    for set in SETS {
        let entry = entry_of(&certificate, set);
        let bound = |part: &str, name: &str| number(&entry[part][name]);
        for start in [[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0]] {
            let start = [at_0 + start[0] * x_0, start[1] * 0.5];
            let [e, u, steady, steady_u, rms] = simulated(sigma, set, [0.5, 1.0], start, 400);
            assert!(e <= bound("largest", "e") && u <= bound("largest", "u"), "{set:?}: {e} {u} {entry}");
            let meets =
                |value: f64, bound: f64| value <= bound * (1.0 + 1e-6) + 1e-9 && bound <= value * (1.0 + 1e-5) + 1e-5;
            assert!(meets(steady, bound("steady", "e")), "{set:?}: {steady} {entry}");
            assert!(meets(rms, bound("steady", "e_rms")), "{set:?}: {rms} {entry}");
            assert!(meets(steady_u, bound("steady", "u")), "{set:?}: {steady_u} {entry}");
        }
    }
    let sentence = certificate["claim"]["statement"].as_str().unwrap();
    for said in [
        "For oscillators at every finite set of harmonics that contains 0 (so for every number of oscillators n_o >= 0) and every gain",
        "With oscillators at the harmonics 0, 1, 3 and sigma = ",
    ] {
        assert!(sentence.contains(said), "{sentence}");
    }
    // The numbers of one set are none of another one, nor a millionth smaller.
    let place = certificate["claim"]["by_n_o"].as_array().unwrap().len() - 1;
    let mut forged = certificate.clone();
    forged["claim"]["by_n_o"][place]["harmonics"] = json!([0, 1, 2, 5]);
    let mut smaller = certificate.clone();
    let e = &mut smaller["claim"]["by_n_o"][place]["steady"]["e"];
    *e = (number(e) * (1.0 - 4e-6)).to_string().into();
    for broken in [forged, smaller] {
        let answer = checked(&stored(folder.path(), "forged.json", &broken));
        assert_ne!(answer["verdict"], "valid", "{answer}");
    }
}

/// What a document asks for is what its claim is about.
#[test]
fn a_claim_is_about_the_sets_that_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let about = |harmonics: Option<&str>| {
        let mut document = document();
        if let Some(harmonics) = harmonics {
            document["internal_model"]["harmonics"] = json!(harmonics);
        }
        let (file, _) = certified_in(folder.path(), &document, &["--no-alternatives"]);
        assert_valid(&file);
        let certificate = read(&file);
        let sentence = certificate["claim"]["statement"].as_str().unwrap().to_owned();
        (certificate["claim"]["harmonics"].clone(), sentence.starts_with("For oscillators at every finite set"))
    };
    let every = json!("every finite set that contains 0");
    assert_eq!(about(None), (every.clone(), true));
    assert_eq!(about(Some("every-set")), (every, true));
    assert_eq!(about(Some("first")), (Value::Null, false));
}

/// A claim by the set is kept to what samples tell apart, and to proofs that are about every set; where a set has no bounds of its own that is said.
#[test]
fn what_does_not_go_with_a_set_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let input = stored(folder.path(), "plant.json", &document());
    let told = |flags: &[&str]| told(program().arg("certify").arg(&input).args(flags));
    let samples = ["--sampling-period", "1/10", "--harmonics"];
    for (flags, said) in [
        (
            &[&samples[..], &["0,1,10"]].concat(),
            "the claim is about harmonics below 20/2, half of the samples in a period, and 10 is not",
        ),
        (&vec!["--harmonics", "0,3", "--transfer", "boxes"], "--transfer boxes is about the first n_o harmonics"),
        (&vec!["--harmonics", "1,3"], "write `0,1,3`"),
        (&vec!["--harmonics", "0,101"], "a whole number up to 100"),
    ] {
        let (code, text) = told(flags);
        assert!(code == 2 && text.contains(said), "{flags:?}: {code} {text}");
    }
    let (code, text) = told(&["--no-alternatives", "--harmonics", "0,3"]);
    let said =
        "no bounds of their own but rates were proved for oscillators at the harmonics 0, 3, which the claim covers";
    let text = in_one_line(&text);
    assert!(code == 0 && text.contains(said) && text.contains("`--no-alternatives` leaves them out"), "{code} {text}");
}

/// A number of oscillators that no certificate may state is refused at once: nothing is made of it.
#[test]
fn a_number_that_nobody_may_state_takes_no_memory() {
    let folder = tempfile::tempdir().unwrap();
    let (file, _) = certified_in(folder.path(), &document(), &[]);
    let mut forged = read(&file);
    forged["claim"]["by_n_o"][1]["n_o"] = json!(u32::MAX);
    let error = sigmastar::reread("forged", forged.to_string().as_bytes()).unwrap_err();
    assert_eq!(error.kind(), sigmastar::ErrorKind::Claim, "{error}");
}

/// The six-step converter of the guide: the set leaves what as many oscillators as its largest harmonic leave, with five in the place of thirteen in the C code.
#[test]
fn five_oscillators_do_what_thirteen_do() {
    const FILE: &str = "specs/shipping/six-step.toml";
    let folder = tempfile::tempdir().unwrap();
    let certificate = folder.path().join("converter.certificate.json");
    let call = |command: &str, file: &std::path::Path, flags: &[&str]| {
        let output = program().arg(command).arg(file).args(flags).output().unwrap();
        assert!(output.status.success(), "{}", utf8(output.stderr));
        output.stdout
    };
    let set = ["--harmonics", "0,1,5,7,11,13"];
    let report = json(&call("certify", FILE.as_ref(), &["--sigma", "200", set[0], set[1], "--format", "json"]));
    let rows = report["by_n_o"].as_array().unwrap();
    let find =
        |what: &str, value: Value| rows.iter().find(|row| row[what] == value).unwrap_or_else(|| panic!("{rows:?}"));
    let (own, first) = (find("harmonics", json!([0, 1, 5, 7, 11, 13])), find("n_o", json!(13)));
    assert_eq!(number(&own["steady_error"]), 0.0);
    for name in ["steady_error", "mean_square", "peak_error", "control"] {
        assert_eq!(own[name], first[name], "{name}");
    }
    assert!(number(&find("n_o", json!(5))["steady_error"]) > 0.01);
    let made = certificate.to_str().unwrap();
    call("certify", FILE.as_ref(), &["--sigma", "200", set[0], set[1], "--sampling-period", "1/20000", "-o", made]);
    assert_valid(&certificate);
    let code = folder.path().join("converter.c");
    call("controller", &certificate, &[set[0], set[1], "--format", "c", "-o", code.to_str().unwrap()][..]);
    let header = std::fs::read_to_string(code.with_extension("h")).unwrap();
    assert!(
        header.contains("_OSCILLATORS 5\n") && header.contains("oscillators at the harmonics 0, 1, 5, 7, 11, 13"),
        "{header}"
    );
}
