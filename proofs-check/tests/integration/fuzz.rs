//! A bounded random run of what the fuzz targets do, from a fixed seed: no panic, and no changed certificate is valid
//! unless its meaning is unchanged.

use crate::common::{PAPER, text};
use proofs_check::check;
use proofs_check::expr::{ARGUMENTS, Expr};
use proofs_check::interval::Interval;
use proofs_check::json::decimal;
use proofs_check::verdict::Verdict;
use rug::Rational;
use serde_json::Value;

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
        if report.verdict == Verdict::Valid && report.is_flawless() {
            valid.push(serde_json::from_slice::<Value>(&bytes).unwrap());
        }
    }
    // What survives differs in white space, in words for people, in free numbers that no stored value shows and that are proved again, or in an
    // end of a stored enclosure by no more than its rounding.
    let original: Value = serde_json::from_str(&original).unwrap();
    for mut survivor in valid {
        for pointer in
            ["/witness/lmi", "/witness/exact_regulation", "/comparison", "/tool", "/precision_bits", "/claim/statement"]
        {
            let free = original.pointer(pointer).unwrap();
            *survivor.pointer_mut(pointer).unwrap() = free.clone();
        }
        assert!(same(&survivor, &original), "{survivor} is not {original}");
    }
}

/// Equal, or two decimals within 1e-15 of each other.
fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Object(a), Value::Object(b)) => {
            a.len() == b.len() && a.iter().all(|(key, a)| b.get(key).is_some_and(|b| same(a, b)))
        }
        (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        (Value::String(x), Value::String(y)) if x != y => decimal(x)
            .zip(decimal(y))
            .is_some_and(|(x, y)| Rational::from(&x - &y).abs() <= y.abs() / Rational::from(10_u64.pow(15))),
        _ => a == b,
    }
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
