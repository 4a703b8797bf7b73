//! A bounded random run of what the fuzz targets do, from a fixed seed: no panic, and no changed certificate is valid
//! unless its meaning is unchanged.

use crate::common::{PAPER, said, text, without};
use proofs_check::check;
use proofs_check::expr::{ARGUMENTS, Expr};
use proofs_check::interval::Interval;
use rug::Rational;
use serde_json::Value;

/// What no claim rests on.
const FIGURES: [&str; 3] = ["/conditions", "/constants", "/comparison"];

/// A small generator (xorshift64), so that every run is the same.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n as u64) as usize
    }
}

#[test]
fn damaged_certificates() {
    let original = text("certificates", PAPER);
    let mut random = Random(0x5eed);
    let mut valid = Vec::new();
    for _ in 0..1500 {
        let mut bytes = original.trim_end().as_bytes().to_vec();
        for _ in 0..=random.below(3) {
            let at = random.below(bytes.len());
            match random.below(4) {
                0 => bytes[at] = b"0123456789eE+-.,:[]{}\"\\nu \xff"[random.below(27)],
                1 => drop(bytes.drain(at..(at + 1 + random.below(40)).min(bytes.len()))),
                2 => {
                    let piece = bytes[at..(at + random.below(60)).min(bytes.len())].to_vec();
                    let to = random.below(bytes.len());
                    bytes.splice(to..to, piece);
                }
                _ => bytes.truncate(at.max(1)),
            }
        }
        let report = check(&bytes);
        if report.is_valid() {
            valid.push((serde_json::from_slice::<Value>(&bytes).unwrap(), report));
        }
    }
    // What survives differs in white space, in words for people, in figures, in a free number that is proved again, in a larger bound of the
    // periodic solution, or is another claim, whose numbers the sentence names.
    let original: Value = serde_json::from_str(&original).unwrap();
    for (mut survivor, report) in valid {
        for (name, of_solution) in original["claim"]["periodic_solution"].as_object().unwrap() {
            let [own, other] = [of_solution, &survivor["claim"]["periodic_solution"][name]].map(number);
            // No bound is below what is proved, from which it is rounded up to 12 digits.
            assert!(other >= own * Rational::from((99_999_999_999_i64, 100_000_000_000_i64)), "{survivor}: {name}");
        }
        let claimed = ["/initial_set/X0", "/initial_set/E0", "/initial_set/Z0", "/sigma_star"];
        for place in claimed.map(|place| format!("/claim{place}")) {
            let text = survivor.pointer(&place).and_then(Value::as_str).unwrap();
            assert!(said(&report).contains(text), "{survivor}: {place}");
            *survivor.pointer_mut(&place).unwrap() = original.pointer(&place).unwrap().clone();
        }
        for pointer in ["/claim/periodic_solution", "/claim/statement", "/witness", "/precision_bits", "/tool"] {
            *survivor.pointer_mut(pointer).unwrap() = original.pointer(pointer).unwrap().clone();
        }
        assert_eq!(without(&survivor, FIGURES), without(&original, FIGURES));
    }
}

fn number(text: &Value) -> Rational {
    proofs_check::json::rational(text.as_str().unwrap()).unwrap()
}

#[test]
fn random_expressions() {
    let words = [
        "X", "E", "pi", "1", "0", "2.5", "1e3", "1e-9", "+", "-", "*", "/", "^", "(", ")", ",", "sqrt(", "exp(",
        "log(", "sin(", "cos(", "tan(", "atan(", "tanh(", "abs(", "exprelr(", "sinc(", "min(", "max(", " ", "e", ".",
        "\u{e9}",
    ];
    let mut random = Random(0xbad_5eed);
    let side = Interval::int(0, 64).hull(&Interval::int(3, 64));
    let mut read = 0;
    for _ in 0..60_000 {
        let text: String = (0..1 + random.below(9)).map(|_| words[random.below(words.len())]).collect();
        let Ok(expr) = Expr::parse(&text, ARGUMENTS) else { continue };
        read += 1;
        let value = expr.enclose(&side, &side);
        let inside = Interval::int(1, 64);
        let point = expr.enclose(&inside, &inside);
        // The value on a part lies in the value on the whole.
        if value.is_defined() && point.is_defined() {
            assert!(point.lo() >= value.lo() && point.hi() <= value.hi(), "{text}");
        }
        let _ = expr.exact();
    }
    assert!(read > 1000, "{read}");
}
