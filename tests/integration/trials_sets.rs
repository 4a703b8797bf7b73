//! Oscillators at a set of harmonics with gaps: bounds of the certificate against simulations that share nothing with them.

use super::support::{assert_valid, certified_in, checked, number, read, stored};
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
    // The row of a set with a gap is not that of the numbers around it.
    let first = number(&certificate["claim"]["by_n_o"][2]["steady"]["e"]);
    let with_a_gap = number(&entry_of(&certificate, &[1, 2, 4])["steady"]["e"]);
    assert!(with_a_gap > 0.0 && first > 0.0 && with_a_gap != first, "{with_a_gap} {first}");
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
