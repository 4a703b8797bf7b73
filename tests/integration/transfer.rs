//! The transfer bound against its plain definition: T_N(x) = g_N'(x)/(1 + nu^2 g_N(x)^2), summed pole by pole.

use rug::ops::Pow;
use rug::{Float, Rational};
use sigmastar_exact::enclosure::Truth;
use sigmastar_exact::number::{Direction, round_rational};
use sigmastar_lang::spec::Specification;
use sigmastar_theory::data::Data;
use sigmastar_theory::transfer::{BoxProof, TradeOff, TransferProof, closed_form_pair, decide};

const BITS: u32 = 200;

fn specification(mu: &str, matched: bool, weights: &str) -> Specification {
    let frequency = if matched { "2*pi" } else { "1" };
    let text = format!(
        r#"{{"format": "sigmastar/bounding-spec", "version": 1, "name": "transfer", "period": "1",
        "lyapunov": {{"p_low": 1, "p_up": 1, "alpha": 1}},
        "bounds": {{"f": 0, "f_e": 0, "f_xx": 0, "f_ex": 0, "q": 1, "q_e": 0, "q_x": 0, "q_t": 1}},
        "internal_model": {{"mu": "{mu}", "base_frequency": "{frequency}", "matched": {matched}, "weights": {weights}}},
        "initial_set": {{"kind": "paper"}}}}"#
    );
    Specification::from_json("transfer", &text).unwrap()
}

/// Weights as JSON, and the same weights as numbers.
type Family = (String, Box<dyn Fn(u32) -> Float>);

fn float(value: f64) -> Float {
    Float::with_val(BITS, value)
}

fn power(n0: f64, epsilon: f64) -> Family {
    let json = format!(r#"{{"family": "power", "n0": "{n0}", "epsilon": "{epsilon}"}}"#);
    (json, Box::new(move |l| if l == 0 { float(n0) } else { float(f64::from(l)).pow(float(-1.0 - epsilon)) }))
}

fn explicit(values: &'static [f64], coefficient: f64, exponent: f64) -> Family {
    let list: Vec<String> = values.iter().map(|v| format!("\"{v}\"")).collect();
    let json = format!(
        r#"{{"family": "explicit", "values": [{}], "tail": {{"coefficient": "{coefficient}", "exponent": "{exponent}"}}}}"#,
        list.join(", ")
    );
    let value = move |l: u32| match values.get(l as usize) {
        Some(value) => float(*value),
        None => float(coefficient) * float(f64::from(l)).pow(float(-exponent)),
    };
    (json, Box::new(value))
}

fn families() -> Vec<Family> {
    vec![
        power(2.0, 0.5),
        power(1.0009765625, 0.0078125),
        power(50.0, 1.0),
        explicit(&[2.0, 1.0, 0.375, 0.25], 1.25, 1.5),
        explicit(&[1.5], 1.0, 2.0),
    ]
}

/// T_N(x) by the definition, for x that is no integer.
fn transfer(n: &dyn Fn(u32) -> Float, poles: u32, x: &Float, nu: &Float) -> Float {
    let (mut g, mut slope) = (float(0.0), float(0.0));
    let mut pole = |l: f64, c: &Float| {
        let distance = Float::with_val(BITS, l - x);
        g += Float::with_val(BITS, c / &distance);
        slope += Float::with_val(BITS, c / distance.square());
    };
    pole(0.0, &n(0));
    for l in 1..=poles {
        let half = n(l) / 2u32;
        pole(l.into(), &half);
        pole(-f64::from(l), &half);
    }
    let scaled = Float::with_val(BITS, nu * &g).square();
    slope / (scaled + 1u32)
}

fn up(value: &sigmastar_exact::enclosure::Enclosure) -> Rational {
    round_rational(&value.upper_rational().unwrap(), 8, Direction::Up)
}

#[test]
fn the_closed_form_is_above_the_definition() {
    for (json, n) in families() {
        for mu in ["0.01", "0.159", "1", "30"] {
            let spec = specification(mu, false, &json);
            let data = Data::new(&spec, 128);
            let (k0, k1) = closed_form_pair(&data);
            let (k0, k1) = (up(&k0), up(&k1));
            assert_eq!(decide(&data, &k0, &k1, &TransferProof::ClosedForm).0, Truth::True);
            for (k0, k1) in
                [(&k0 * Rational::from((98, 100)), k1.clone()), (k0.clone(), &k1 * Rational::from((98, 100)))]
            {
                assert_ne!(decide(&data, &k0, &k1, &TransferProof::ClosedForm).0, Truth::True);
            }
            let nu = Float::with_val(BITS, Float::parse(mu).unwrap());
            for poles in [0, 1, 2, 3, 7, 20] {
                for m in [0_u32, 1, 2, 3, 5, 7, 8, 20, 21] {
                    for j in [1, 2, 3, 5, 10, 30] {
                        for sign in [-1.0, 1.0] {
                            let x: Float = float(f64::from(m)) + float(sign * 0.49) * float(2.0).pow(1 - j);
                            if x < 0 {
                                continue;
                            }
                            let bound = Float::with_val(BITS, x.square_ref()) * &k1 + &k0;
                            let value = transfer(&*n, poles, &x, &nu);
                            assert!(value <= bound, "{json} mu = {mu} N = {poles} x = {x}: {value} > {bound}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn matched_pairs_are_above_the_definition_at_integers_and_tight() {
    for (json, n) in families() {
        for mu in ["0.01", "1", "6", "200"] {
            let spec = specification(mu, true, &json);
            let data = Data::new(&spec, 128);
            let pi = Float::with_val(BITS, rug::float::Constant::Pi);
            let nu = Float::with_val(BITS, Float::parse(mu).unwrap()) / (pi * 2u32);
            let candidates = TradeOff::matched(&data).candidates;
            assert!(!candidates.is_empty());
            for (index, (k0, k1, k)) in candidates.into_iter().enumerate() {
                let slightly_up = |v: f64| Rational::from_f64(v * (1.0 + 1e-10)).unwrap();
                let (k0, k1) = (slightly_up(k0), slightly_up(k1));
                let proof = TransferProof::Matched { k };
                assert_eq!(decide(&data, &k0, &k1, &proof).0, Truth::True, "{json} {mu} {index}");
                let lower = &k1 * Rational::from((98, 100));
                assert_eq!(decide(&data, &k0, &lower, &proof).0, Truth::False, "{json} {mu} {index}");
                if index % 8 != 0 {
                    continue;
                }
                for poles in [0, 1, 2, 6, 40] {
                    for m in [0_u32, 1, 2, 3, 6, 7, 40, 41] {
                        // The pole itself is removable; this close to it the value has settled.
                        let x: Float = float(f64::from(m)) + float(2.0).pow(-60);
                        let bound = Float::with_val(BITS, x.square_ref()) * &k1 + &k0;
                        let value = transfer(&*n, poles, &x, &nu);
                        assert!(value <= bound, "{json} mu = {mu} N = {poles} x = {m}: {value} > {bound}");
                    }
                }
            }
        }
    }
}

#[test]
fn matched_proofs_need_a_matched_frequency_and_a_moderate_k() {
    let (json, _) = power(2.0, 0.5);
    let (large, proof) = (Rational::from(1_000_000_000), |k| TransferProof::Matched { k });
    let matched = specification("1", true, &json);
    let data = Data::new(&matched, 128);
    assert_eq!(decide(&data, &large, &large, &proof(1)).0, Truth::True);
    assert_eq!(decide(&data, &large, &large, &proof(4096)).0, Truth::True);
    for k in [0, 4097, 65_536, u32::MAX] {
        assert_eq!(decide(&data, &large, &large, &proof(k)).0, Truth::False, "{k}");
    }
    // T_N(0) = 1/(nu^2 n_0) = 2 pi^2 must be reached, however large k1 is.
    for (k0, expected) in [((19_739, 1000), Truth::False), ((19_740, 1000), Truth::True)] {
        assert_eq!(decide(&data, &Rational::from(k0), &large, &proof(1)).0, expected);
    }
    let unmatched = specification("1", false, &json);
    assert_eq!(decide(&Data::new(&unmatched, 128), &large, &large, &proof(1)).0, Truth::False);
}

#[test]
fn proofs_by_boxes_are_above_the_definition() {
    let (mut tried, mut proved) = (0, 0);
    for (json, n) in families() {
        for mu in ["0.05", "0.3", "1"] {
            let spec = specification(mu, false, &json);
            let data = Data::new(&spec, 128);
            let nu = Float::with_val(BITS, Float::parse(mu).unwrap());
            let candidates = TradeOff::curve(&data).candidates;
            for (k0, k1, _) in candidates.into_iter().skip(20).step_by(25).take(2) {
                let (k0, k1) = (Rational::from_f64(k0).unwrap(), Rational::from_f64(k1 * 1.03).unwrap());
                tried += 1;
                // Where none is found, `certify` falls back on the closed form.
                let Some(proof) = BoxProof::find(&data, &k0, &k1) else { continue };
                proved += 1;
                let proof = TransferProof::Boxes(proof);
                assert_eq!(decide(&data, &k0, &k1, &proof).0, Truth::True);
                for poles in [0, 1, 2, 3, 7, 40] {
                    for m in [0_u32, 1, 2, 3, 5, 20, 40, 41] {
                        for j in 1..14 {
                            for sign in [-1.0, 1.0] {
                                let x: Float = float(f64::from(m)) + float(sign * 0.49) * float(2.0).pow(1 - j);
                                if x < 0 {
                                    continue;
                                }
                                let bound = Float::with_val(BITS, x.square_ref()) * &k1 + &k0;
                                let value = transfer(&*n, poles, &x, &nu);
                                assert!(value <= bound, "{json} mu = {mu} N = {poles} x = {x}: {value} > {bound}");
                            }
                        }
                    }
                }
            }
        }
    }
    assert!(3 * proved >= 2 * tried, "{proved} of {tried} pairs near the curve are proved");
}
