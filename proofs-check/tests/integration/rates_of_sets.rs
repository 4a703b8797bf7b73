//! Rates, and bounds under noise, with oscillators at a set of harmonics (docs/mathematics.md, sections 13.6 and 14.7): stored certificates of every kind of
//! proof, and forgeries of what is about the set.

use crate::common::{accepted, deleted, edited, judged, names, parsed, rehash, said};
use crate::rates::{rates_in_words, refused, times};
use proofs_check::verdict::Verdict::{BadInput, Invalid};
use serde_json::{Value, json};

const CLAIM: &str = "/claim/for_n_o";
const WITNESS: &str = "/witness/for_n_o";

fn stored(name: &str) -> Value {
    parsed("sets", name)
}

fn rates(certificate: &Value) -> &[Value] {
    certificate["claim"]["for_n_o"].as_array().unwrap()
}

/// The entries about sets, by their place.
fn sets(certificate: &Value) -> Vec<(usize, Vec<u64>)> {
    let set = |entry: &Value| entry["harmonics"].as_array()?.iter().map(Value::as_u64).collect::<Option<Vec<u64>>>();
    rates(certificate).iter().enumerate().filter_map(|(place, entry)| Some((place, set(entry)?))).collect()
}

/// Another set, or n_o, in the claim and the witness of an entry.
fn renamed(certificate: &Value, place: usize, field: &str, value: &Value) -> Value {
    let mut made = certificate.clone();
    for part in ["claim", "witness"] {
        let entry = made[part]["for_n_o"][place].as_object_mut().unwrap();
        entry.remove("harmonics").unwrap();
        entry.insert(field.to_owned(), value.clone());
    }
    made
}

/// The smallest change of each number that claims more is refused, in continuous time and at samples, with noise, with rounding, by norms and by slopes.
#[test]
fn stored_ones_are_accepted_and_nothing_better() {
    for name in names("sets") {
        let certificate = stored(&name);
        assert!(!sets(&certificate).is_empty(), "{name}");
        assert!(said(&accepted(&certificate)).contains(&rates_in_words(&certificate)), "{name}");
        for (place, _) in sets(&certificate) {
            let factor = format!("{CLAIM}/{place}/factor");
            refused(
                edited(certificate.clone(), &[(&factor, times(&certificate, &factor, 0.99))]),
                Invalid,
                "rates",
                &factor,
            );
            // At samples a larger rate needs another c, and in continuous time Pi proves no rate that is twice as large.
            let rate = format!("{CLAIM}/{place}/rate");
            let faster = edited(certificate.clone(), &[(&rate, times(&certificate, &rate, 2.0))]);
            let at = if certificate["claim"]["regulator"].is_null() { format!("{WITNESS}/{place}/Pi") } else { rate };
            refused(faster, Invalid, "rates", &at);
            for bound in ["limit", "peak"].iter().filter(|_| rates(&certificate)[place].get("noise").is_some()) {
                let bound = format!("{CLAIM}/{place}/noise/{bound}");
                let smaller = edited(certificate.clone(), &[(&bound, times(&certificate, &bound, 0.99))]);
                refused(smaller, Invalid, "rates", &bound);
            }
        }
    }
}

/// Pi of one set proves nothing of another one of as many oscillators: a harmonic that is moved, and the first ones.
#[test]
fn a_rate_is_that_of_its_own_set() {
    let mut tried = 0;
    for name in names("sets") {
        let certificate = stored(&name);
        for (place, set) in sets(&certificate) {
            let pi = format!("{WITNESS}/{place}/Pi");
            let mut moved = set.clone();
            *moved.last_mut().unwrap() += 1;
            if !rates(&certificate).iter().any(|entry| entry["harmonics"] == json!(moved)) {
                refused(renamed(&certificate, place, "harmonics", &json!(moved)), Invalid, "rates", &pi);
                tried += 1;
            }
            // In the claim alone, and in the witness alone.
            for part in [CLAIM, WITNESS] {
                let one = edited(certificate.clone(), &[(format!("{part}/{place}/harmonics"), json!(moved))]);
                refused(one, BadInput, "format", &format!("{WITNESS}/{place}/harmonics"));
            }
            // A set without a gap is an n_o.
            let first: Vec<usize> = (0..set.len()).collect();
            let at = format!("{CLAIM}/{place}/harmonics");
            refused(renamed(&certificate, place, "harmonics", &json!(first)), BadInput, "format", &at);
            // The number of the oscillators, and the largest harmonic, alone: the set is before every set and behind every smaller number.
            for (n_o, same_order) in [(set.len() as u64 - 1, true), (*set.last().unwrap(), false)] {
                let mut alone = renamed(&certificate, place, "n_o", &json!(n_o));
                for part in ["claim", "witness"] {
                    let own = alone[part]["for_n_o"][place].clone();
                    alone[part]["for_n_o"] = json!([own]);
                }
                match same_order {
                    true => refused(alone, Invalid, "rates", &format!("{WITNESS}/0/Pi")),
                    // Of noise or of the rate, whichever is read first.
                    false => refused(alone, BadInput, "format", &format!("{WITNESS}/0")),
                }
            }
        }
    }
    assert!(tried >= 8, "{tried}");
}

/// A gap that is closed, or an oscillator that is left out, makes Pi one of another order.
#[test]
fn every_oscillator_has_two_states() {
    let certificate = stored("slopes");
    let (place, set) = sets(&certificate).pop().unwrap();
    assert_eq!(set, [0, 2, 3, 7]);
    for other in [json!([0, 2, 3]), json!([0, 2, 3, 5, 7]), json!([0, 7])] {
        refused(
            renamed(&certificate, place, "harmonics", &other),
            BadInput,
            "format",
            &format!("{WITNESS}/{place}/Pi"),
        );
    }
}

/// A claim about the first n_o harmonics, for every n_o, says nothing of other sets.
#[test]
fn only_a_claim_about_every_set_speaks_of_one() {
    for name in names("sets") {
        let certificate = stored(&name);
        let (first, _) = sets(&certificate)[0];
        let about_first = deleted(&certificate, "/claim/harmonics");
        refused(about_first, BadInput, "format", &format!("{CLAIM}/{first}/harmonics"));
        let document = if certificate["plant"].is_null() { "specification" } else { "plant" };
        let mut declined = certificate.clone();
        declined[document]["internal_model"]["harmonics"] = "first".into();
        rehash(&mut declined);
        refused(declined, Invalid, "oscillators", "/claim/harmonics");
    }
}

#[test]
fn the_samples_tell_the_oscillators_apart() {
    for name in ["noise-at-samples", "rounded"] {
        let certificate = stored(name);
        assert_eq!(certificate["claim"]["samples"], 200);
        let (place, set) = sets(&certificate).pop().unwrap();
        let with = |last: u64| {
            let other = [&set[..set.len() - 1], &[last]].concat();
            renamed(&certificate, place, "harmonics", &json!(other))
        };
        refused(with(100), Invalid, "rates", &format!("{WITNESS}/{place}/harmonics"));
        refused(with(99), Invalid, "rates", &format!("{WITNESS}/{place}/Pi"));
        refused(with(101), BadInput, "format", &format!("{CLAIM}/{place}/harmonics/{}", set.len() - 1));
    }
}

/// Numbers in rising order, then each set once, in one field.
#[test]
fn entries_have_an_order() {
    let certificate = stored("continuous");
    assert_eq!(sets(&certificate), [(1, vec![0, 1, 5]), (2, vec![0, 2])]);
    let both = |order: &[usize]| {
        let mut made = certificate.clone();
        for part in ["claim", "witness"] {
            made[part]["for_n_o"] = order.iter().map(|place| certificate[part]["for_n_o"][*place].clone()).collect();
        }
        made
    };
    accepted(&both(&[0, 2, 1]));
    accepted(&both(&[2]));
    refused(both(&[1, 0]), BadInput, "format", &format!("{CLAIM}/1/n_o"));
    refused(both(&[1, 2, 1]), BadInput, "format", &format!("{CLAIM}/2/harmonics"));
    for part in [CLAIM, WITNESS] {
        let place = format!("{part}/1/n_o");
        refused(edited(certificate.clone(), &[(&place, json!(2))]), BadInput, "format", &place);
        refused(deleted(&certificate, &format!("{part}/1/harmonics")), BadInput, "format", &format!("{part}/1"));
    }
}

/// How far starts are is known from the entry about exactly these oscillators: neither from one of so many or more, nor from that of another set.
#[test]
fn sizes_are_those_of_the_set() {
    for (name, list) in [("by-n-o-trials", "trials"), ("by-n-o-linear", "linear/sizes")] {
        let certificate = stored(name);
        let said = certificate["claim"]["by_n_o"].as_array().unwrap().clone();
        assert!(said.iter().any(|entry| entry["or_more"] == true), "{name}");
        for (place, set) in sets(&certificate) {
            let own = said.iter().position(|entry| entry["harmonics"] == json!(set)).unwrap();
            let proof = format!("/witness/by_n_o/{list}/{own}");
            let without = deleted(&deleted(&certificate, &format!("/claim/by_n_o/{own}")), &proof);
            refused(without, Invalid, "rates", &format!("{CLAIM}/{place}/factor"));
        }
    }
    // That of another set in its place: then it is the entry itself that is not true.
    let certificate = stored("by-n-o-linear");
    let smaller = edited(certificate.clone(), &[("/witness/by_n_o/linear/sizes/2/zeta", json!("0"))]);
    assert!(!judged(&smaller).is_valid());
}
