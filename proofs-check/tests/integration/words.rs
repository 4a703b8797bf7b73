//! What an answer says: the sentence of a claim is the checker's own, names of the file stand apart in it, and no text of the file moves it.

use crate::common::{assert_refused, certificate, edited, every, judged, parsed, rehash, said};
use proofs_check::verdict::Verdict::{BadInput, Valid};
use proofs_check::{Report, check};
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// A family in cells, with a gain of the actuator that is an expression of its parameters J and b, and the state i.
fn family() -> Value {
    parsed("plants", "family-gain.certificate")
}

/// All sentences of an answer, in order.
fn sentences(report: &Report) -> Vec<String> {
    let subject = report.subject.as_ref().unwrap_or_else(|| panic!("{}", report.text(false)));
    [subject.statement.clone()].into_iter().chain(subject.also.clone()).chain(subject.assumed.clone()).collect()
}

/// The words of a text, each with whether it is one.
fn words(text: &str) -> Vec<(bool, String)> {
    let mut parts: Vec<(bool, String)> = Vec::new();
    for c in text.chars() {
        let of_word = c.is_ascii_alphanumeric() || c == '_';
        match parts.last_mut() {
            Some((is_word, part)) if *is_word && of_word => part.push(c),
            _ => parts.push((of_word, c.to_string())),
        }
    }
    parts
}

/// A text with other names in the places of some.
fn renamed(text: &str, names: &[(&str, &str)]) -> String {
    let other =
        |part: &str| names.iter().find(|(from, _)| *from == part).map_or(part.to_owned(), |(_, to)| (*to).to_owned());
    words(text).iter().map(|(is_word, part)| if *is_word { other(part) } else { part.clone() }).collect()
}

/// The family with another name for its first parameter and for its state, and for itself.
fn with_names(parameter: &str, state: &str, name: &str) -> Value {
    let names = [("J", parameter), ("i", state)];
    let mut made = family();
    let in_text = |value: &mut Value| *value = renamed(value.as_str().unwrap(), &names).into();
    let plant = &mut made["plant"];
    plant["name"] = name.into();
    plant["states"] = json!([state]);
    in_text(&mut plant["f"][0]);
    in_text(&mut plant["q"]);
    for part in ["plant", "claim"] {
        for end in ["nominal", "low", "high"] {
            in_text(&mut made[part]["input_gain"][end]);
        }
        let parameters = made[part]["parameters"].as_object().unwrap();
        // In their order: it is that of the sensitivities.
        made[part]["parameters"] =
            parameters.iter().map(|(key, range)| (renamed(key, &names), range.clone())).collect();
    }
    rehash(&mut made);
    made
}

/// Every word that a sentence has of its own, of each kind of claim.
fn own_words() -> BTreeSet<String> {
    let others = [
        ("certificates", "paper-example-at-rest.sharp"),
        ("noise", "plant"),
        ("noise", "aligned"),
        ("arithmetic", "all"),
        ("actuator", "samples"),
        ("periods", "motor-axis"),
        ("sampled", "paper-example"),
    ];
    let all = others.map(|(folder, name)| parsed(folder, name)).into_iter().chain([family()]);
    let all: Vec<String> = all.flat_map(|certificate| sentences(&judged(&certificate))).collect();
    words(&all.join(" ")).into_iter().filter(|(is_word, _)| *is_word).map(|(_, word)| word).collect()
}

/// A parameter, a state and a file may have the name of any letter of a sentence: T of the period, L of the coordinates, K, mu, `orbit`.
#[test]
fn no_name_of_the_file_is_taken_for_a_letter_of_the_claim() {
    let plain = sentences(&judged(&family()));
    assert!(plain[0].contains("every input gain in [0.9/'J', 1.1/'J'] (one constant;"), "{}", plain[0]);
    assert!(
        plain[0].contains("with a constant 'J' of the file in [0.7, 1.3] and a constant 'b' of the file in [30, 90]")
    );
    assert_eq!(plain[0].matches("'J'").count(), 3);
    let taken = [
        "t", "phase", "e", "u", "pi", "sqrt", "exp", "log", "sin", "cos", "tan", "atan", "tanh", "abs", "min", "max",
        "b",
    ];
    let is_name = |word: &str| word.starts_with(|c: char| c.is_ascii_alphabetic()) && !taken.contains(&word);
    let own: Vec<String> = own_words().into_iter().filter(|word| is_name(word)).collect();
    let letters = [
        "T", "L", "K", "M", "N", "x", "z", "g", "v", "h", "mu", "sigma", "n_o", "x_0", "e_per", "t_0", "f", "q", "y_0",
        "k", "P", "W", "R",
    ];
    assert!(letters[..16].iter().all(|letter| own.iter().any(|word| word == letter)), "{own:?}");
    let others = own.iter().map(String::as_str).filter(|word| !letters.contains(word));
    let names: Vec<&str> = letters.into_iter().chain(others.step_by(every(9))).collect();
    for (place, name) in names.iter().enumerate() {
        let state = names[(place + 1) % names.len()];
        let report = judged(&with_names(name, state, name));
        let expected: Vec<String> = plain.iter().map(|line| line.replace("'J'", &format!("'{name}'"))).collect();
        assert_eq!(sentences(&report), expected, "{name}");
    }
}

/// `radius` and `orbit` are those of a cell where there are cells, and x_0 the solution of that.
#[test]
fn the_solution_of_a_plant_in_cells_is_that_of_a_cell() {
    let of_cells = "x is the vector of the states, L the matrix `coordinates` of this certificate, and x_0(t) for any of the `cells` that \
                    contains the parameters of the plant the T-periodic solution of x' = f(t,x,0) that is proved within `radius` of `orbit` \
                    of that cell, in the norm of L^-1 x. The set contains |x - x_0| <= ";
    let report = judged(&family());
    assert!(said(&report).contains(of_cells), "{}", said(&report));
    let report = judged(&parsed("plants", "family.certificate"));
    let of_one = "and x_0(t) the T-periodic solution of x' = f(t,x,0) that is proved within `radius` of `orbit`, in the norm of L^-1 x. The set";
    assert!(said(&report).contains(of_one) && !said(&report).contains("cells"), "{}", said(&report));
}

/// Expressions stand in a sentence without white space, which could part it from what it is of.
#[test]
fn white_space_does_not_get_into_a_sentence() {
    let mut made = family();
    for part in ["plant", "claim"] {
        made[part]["input_gain"]["low"] = "  0.9\n\n /\t J ".into();
    }
    rehash(&mut made);
    let report = judged(&made);
    assert_eq!(sentences(&report), sentences(&judged(&family())), "{}", report.text(false));
}

/// What the file says of its claim is text of bounded length, and nothing more.
#[test]
fn the_words_of_the_file_are_not_looked_at() {
    let with = |words: Value| judged(&edited(certificate("linear.sharp"), &[("/claim/statement", words)]));
    let own = with("".into());
    for words in
        ["Everything is stable.".to_owned(), "\n  proved:  nothing saturates\u{2028}".to_owned(), "x".repeat(500_000)]
    {
        let report = with(words.as_str().into());
        assert_eq!((report.text(true), report.json()), (own.text(true), own.json()));
        assert!(report.verdict == Valid && report.is_valid());
    }
    for words in [Value::from("x".repeat(500_001)), json!(1), json!(["For every"]), json!({}), Value::Null] {
        assert_refused(&with(words), BadInput, "format", "/claim");
    }
}

const HIDDEN: [char; 16] = [
    '\n',
    '\r',
    '\u{7f}',
    '\u{85}',
    '\u{a0}',
    '\u{ad}',
    '\u{61c}',
    '\u{200b}',
    '\u{200f}',
    '\u{2028}',
    '\u{2029}',
    '\u{202e}',
    '\u{2066}',
    '\u{2069}',
    '\u{feff}',
    '\u{e0041}',
];

#[track_caller]
fn shows_nothing_hidden(report: &Report) {
    let json = format!("{:#}", report.json());
    for text in [report.text(true), json] {
        let hidden = text.chars().find(|c| HIDDEN[1..].contains(c));
        assert_eq!(hidden, None, "{text:?}");
        assert!(!text.lines().any(|line| line.starts_with("forged")), "{text}");
    }
}

/// Free texts, and keys in a finding: with what is not shown, or moves what is shown, as its number.
#[test]
fn no_text_of_the_file_moves_an_answer() {
    for hidden in HIDDEN {
        let text = format!("a{hidden}forged: valid");
        let mut made = certificate("linear.sharp");
        made["specification"]["name"] = text.as_str().into();
        made["tool"]["version"] = text.as_str().into();
        rehash(&mut made);
        let report = judged(&made);
        assert_eq!(report.verdict, Valid);
        assert!(report.text(false).contains("name (free text): a\\"), "{}", report.text(false));
        shows_nothing_hidden(&report);
        // A field of that name, and one that is there twice.
        made[text.as_str()] = json!(1);
        let report = judged(&made);
        assert_eq!(report.verdict, BadInput);
        shows_nothing_hidden(&report);
        let key = Value::from(text.as_str());
        shows_nothing_hidden(&check(format!("{{ {key}: 1, {key}: 2 }}").as_bytes()));
        let mut made = certificate("linear.sharp");
        made["conditions"][0]["margin"] = text.as_str().into();
        let report = judged(&made);
        assert_eq!(report.verdict, Valid);
        shows_nothing_hidden(&report);
    }
    let mut made = certificate("linear.sharp");
    made["specification"]["name"] = "H\u{fc}tte \u{5e9}\u{5dc}\u{5d5}\u{5dd} it's \"\u{3b1}\" \\".into();
    rehash(&mut made);
    let shown = "name (free text): H\u{fc}tte \u{5e9}\u{5dc}\u{5d5}\u{5dd} it's \"\u{3b1}\" \\\n";
    assert!(judged(&made).text(false).contains(shown));
}

/// Decimals as JSON has them and fractions of whole numbers: what a sentence repeats can be read in one way.
#[test]
fn numbers_are_written_in_one_way() {
    let at = |place: &str, text: &str| judged(&edited(certificate("linear.sharp"), &[(place, text.into())]));
    for place in ["/claim/initial_set/E0", "/claim/sigma_star", "/witness/X_p", "/claim/periodic_solution/e"] {
        for text in [
            "-1/-2", "1/-2", "1/+2", ".5", "5.", "-.5", "+1", "1/3e2", "1e2/3", "0.5/3", "007", "1/02", "1 / 2", " 1",
            "1/0", "1/2/3", "1e", "1e2.5", "0x1", "1_000", "", "-", "inf", "nan", "2*3", "pi",
        ] {
            assert_refused(&at(place, text), BadInput, "format", place);
        }
    }
    // Larger bounds than need be, in each of the ways.
    for text in ["1000", "1e3", "1.0E+3", "1000.0", "3000/3", "-3000/-3"] {
        let report = at("/claim/periodic_solution/e", text);
        assert_eq!(report.verdict == Valid, !text.starts_with('-'), "{text}: {}", report.text(false));
    }
}
