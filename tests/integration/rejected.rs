//! Each condition refused by itself: a witness with room in every condition, and one number changed.

use rug::Rational;
use sigmastar_decide::conditions::{Ladder, decide, decide_exact};
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_lang::spec::Specification;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::consequences::{Psi, error_bounds, smallest_n_o};
use sigmastar_theory::derivation::exact_regulation::ExactWitness;
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::mean_squares::MeanSquares;
use sigmastar_theory::derivation::paths::Paths;
use sigmastar_theory::derivation::repaired::RepairedWitness;
use sigmastar_theory::derivation::sharp::SharpWitness;
use sigmastar_theory::transfer::TransferProof;
use std::collections::BTreeSet;

const TEXT: &str = r#"{"format": "sigmastar/bounding-spec", "version": 1, "name": "roomy", "period": "1",
    "lyapunov": {"p_low": 1, "p_up": 4, "alpha": 1},
    "bounds": {"f": "X + E", "f_e": "1", "f_xx": "0.0001", "f_ex": "0.0001", "q": "1 + X/100 + E/100", "q_e": "0.01",
      "q_x": "0.01", "q_t": "1"},
    "domain": {"X": "DOMAIN", "E": "DOMAIN"},
    "internal_model": {"mu": "1", "base_frequency": "2*pi", "matched": true,
      "weights": {"family": "power", "n0": "2", "epsilon": "1/2"}},
    "initial_set": {"kind": "box", "X0": "1", "E0": "1", "Z0": "0"}}"#;

fn roomy(domain: &str) -> Specification {
    Specification::from_json("roomy", &TEXT.replace("DOMAIN", domain)).unwrap()
}

fn q(n: i64, d: i64) -> Rational {
    Rational::from((n, d))
}

fn witness() -> SharpWitness {
    SharpWitness {
        sigma: q(100_000, 1),
        x_p: q(10, 1),
        e_p: q(1, 1),
        r_x: q(1, 5),
        r_e: q(1, 20),
        r_d: q(2, 1),
        kap: q(0, 1),
        refined: None,
        d_x: q(10, 1),
        d_e: q(10, 1),
        w_x: q(1, 1),
        h: q(1, 100),
        k0: q(100, 1),
        k1: q(1000, 1),
        transfer: TransferProof::Matched { k: 1 },
        set: ClaimedSet { x0: q(1, 1), e0: q(1, 1), z0: Some(q(0, 1)) },
        paths: Paths::UNNAMED,
    }
}

/// With the form of S2 in which kap > 0.
fn damped(witness: &mut SharpWitness) {
    witness.kap = q(1, 1);
}

/// With smaller mean squares of the periodic solution.
fn refined(witness: &mut SharpWitness, [x, e, e_rate]: [Rational; 3]) {
    witness.refined = Some(MeanSquares { x, e, e_rate });
}

fn broken(domain: &str, change: impl Fn(&mut SharpWitness)) -> BTreeSet<&'static str> {
    let mut witness = witness();
    change(&mut witness);
    let evaluation = decide(&roomy(domain), witness, Ladder::default()).evaluation;
    let failing: BTreeSet<_> = evaluation.conditions.iter().filter(|c| !c.truth().is_true()).map(|c| c.id).collect();
    assert_eq!(failing.is_empty(), evaluation.truth().is_true());
    failing
}

#[test]
fn every_sharp_condition_is_refused_by_itself() {
    let set = |ids: &[&'static str]| ids.iter().copied().collect::<BTreeSet<_>>();
    let far = "1e9";
    assert_eq!(broken(far, |_| ()), set(&[]));
    assert!(broken(far, |w| w.x_p = q(10_001, 1)).contains("S1"));
    assert_eq!(broken(far, |w| w.x_p = q(1, 100)), set(&["S1b"]));
    assert_eq!(broken(far, |w| w.r_x = q(1, 100)), set(&["S1c"]));
    assert_eq!(broken(far, |w| w.e_p = q(1, 1_000_000)), set(&["S2"]));
    assert_eq!(broken(far, |w| w.r_e = q(1, 1_000_000)), set(&["S2b"]));
    assert_eq!(broken(far, |w| w.r_d = q(1, 1_000_000)), set(&["S2c"]));
    let damped_with = |change: fn(&mut SharpWitness)| {
        broken(far, |w| {
            damped(w);
            change(w);
        })
    };
    assert_eq!(damped_with(|_| ()), set(&[]));
    assert_eq!(damped_with(|w| w.e_p = q(1, 100)), set(&["S2"]));
    assert_eq!(damped_with(|w| w.r_e = q(1, 1_000_000)), set(&["S2b"]));
    assert_eq!(damped_with(|w| w.r_d = q(1, 1)), set(&["S2c"]));
    // What the plain form would have allowed does not count: g_k Rt alone must reach r_e.
    assert_eq!(damped_with(|w| (w.r_e, w.r_x, w.r_d) = (q(1, 200_000), q(1, 5), q(2, 1))), set(&["S2b"]));
    let kept = || [q(1, 5), q(1, 20), q(2, 1)];
    assert_eq!(broken(far, |w| refined(w, kept())), set(&[]));
    for (index, id) in ["S3", "S3b", "S3c"].into_iter().enumerate() {
        let mut smaller = kept();
        smaller[index] = if index == 0 { q(1, 100) } else { q(1, 1_000_000) };
        assert_eq!(broken(far, |w| refined(w, smaller.clone())), set(&[id]));
    }
    assert_eq!(broken(far, |w| w.d_e = q(2, 1)), set(&["C4"]));
    assert_eq!(broken(far, |w| w.set.z0 = Some(q(1000, 1))), set(&["C4"]));
    assert_eq!(broken(far, |w| w.d_x = q(11_000, 1)), set(&["C5", "C5b"]));
    assert_eq!(broken(far, |w| w.sigma = q(25, 1)), set(&["C5b"]));
    assert_eq!(broken(far, |w| w.k0 = q(19, 1)), set(&["T"]));
    assert_eq!(broken(far, |w| w.k1 = q(78, 1)), set(&["T"]));
    assert_eq!(broken(far, |w| (w.transfer, w.k1) = (TransferProof::ClosedForm, q(400, 1))), set(&["T"]));
    assert_eq!(broken(far, |w| w.set.x0 = q(999, 1000)), set(&["set"]));
    assert_eq!(broken(far, |w| w.set.e0 = q(999, 1000)), set(&["set"]));
    assert_eq!(broken(far, |w| w.set.z0 = Some(q(-1, 1000))), set(&["set"]));
    assert_eq!(broken("10", |_| ()), set(&["domain"]));
    // X_p and E_p count too, not only the error box.
    assert_eq!(broken("19", |w| w.x_p = q(20, 1)), set(&["domain"]));
    let signs: [fn(&mut SharpWitness) -> &mut Rational; 11] = [
        |w| &mut w.sigma,
        |w| &mut w.x_p,
        |w| &mut w.e_p,
        |w| &mut w.d_x,
        |w| &mut w.d_e,
        |w| &mut w.r_x,
        |w| &mut w.r_e,
        |w| &mut w.r_d,
        |w| &mut w.w_x,
        |w| &mut w.h,
        |w| &mut w.k1,
    ];
    for number in signs {
        for factor in [0, -1] {
            assert!(broken(far, |w| *number(w) *= factor).contains("sign"));
        }
    }
    assert!(broken(far, |w| w.kap = q(-1, 1)).contains("sign"));
    for index in 0..3 {
        for factor in [0, -1] {
            let mut wrong = kept();
            wrong[index] *= factor;
            assert!(broken(far, |w| refined(w, wrong.clone())).contains("sign"));
        }
    }
    assert_eq!(broken(far, |w| w.d_x = q(-10, 1)), set(&["sign"]));
}

/// The refined mean squares must be strictly above their right sides: a point that the map keeps proves nothing.
#[test]
fn refined_mean_squares_are_strict() {
    // With b_fe = 0 the right side of rms(x) is exactly 0.
    let text =
        TEXT.replace("DOMAIN", "1e9").replace("\"f\": \"X + E\", \"f_e\": \"1\"", "\"f\": \"X + E\", \"f_e\": \"0\"");
    let spec = Specification::from_json("roomy", &text).unwrap();
    let conditions = |x: Rational| {
        let mut witness = witness();
        refined(&mut witness, [x, q(1, 20), q(2, 1)]);
        let evaluation = decide(&spec, witness, Ladder::default()).evaluation;
        evaluation.conditions.into_iter().filter(|c| !c.truth().is_true()).map(|c| c.id).collect::<Vec<_>>()
    };
    assert!(conditions(q(1, 1_000_000_000)).is_empty());
    assert!(conditions(q(0, 1)).contains(&"S3"));
}

/// (M): a bound of dq/de from above that lies below -q_e has no plant, and is refused wherever it is used.
#[test]
fn a_one_sided_bound_below_its_norm_is_refused() {
    let failing = |q_e_max: &str, change: fn(&mut SharpWitness)| {
        let text = TEXT.replace("DOMAIN", "1e9");
        let text = text.replace("\"q_e\": \"0.01\"", &format!("\"q_e\": \"1/128\", \"q_e_max\": \"{q_e_max}\""));
        let spec = Specification::from_json("roomy", &text).unwrap();
        let mut witness = witness();
        change(&mut witness);
        let evaluation = decide(&spec, witness, Ladder::default()).evaluation;
        evaluation.conditions.into_iter().filter(|c| !c.truth().is_true()).map(|c| c.what).collect::<Vec<_>>()
    };
    assert!(failing("-1/128", |_| ()).is_empty());
    assert!(failing("-1/128", damped).is_empty());
    assert_eq!(failing("-1.00001/128", |_| ()), ["-b_qe <= q_e_max at (X_b, E_b)"]);
    let both = ["-b_qe <= q_e_max at (X_p, E_p)", "-b_qe <= q_e_max at (X_b, E_b)"];
    assert_eq!(failing("-1.00001/128", damped), both);
    // Only below the error box: at (X_p, E_p) it is too small, at (X_b, E_b) not.
    assert_eq!(failing("-1/64 + E/1000", damped), both[..1]);
}

#[test]
fn every_condition_of_exact_regulation_is_refused_by_itself() {
    let base = ExactWitness {
        sigma: q(100_000, 1),
        d_x: q(10, 1),
        d_e: q(10, 1),
        w_x: q(1, 1),
        h: q(1, 100),
        paths: Paths::UNNAMED,
    };
    let decided = |domain: &str, matched: bool, change: &dyn Fn(&mut ExactWitness)| {
        let mut witness = base.clone();
        change(&mut witness);
        let text = TEXT.replace("DOMAIN", domain).replace("\"matched\": true", &format!("\"matched\": {matched}"));
        let spec = Specification::from_json("roomy", &text).unwrap();
        let evaluation = decide_exact(&spec, &self::witness().set, &witness, Ladder::default());
        let failing = evaluation.conditions.iter().filter(|c| !c.truth().is_true()).map(|c| c.id);
        failing.collect::<BTreeSet<_>>().into_iter().collect::<Vec<_>>()
    };
    assert!(decided("1e9", true, &|_| ()).is_empty());
    assert_eq!(decided("1e9", false, &|_| ()), ["matched"]);
    assert_eq!(decided("9", true, &|_| ()), ["domain"]);
    assert_eq!(decided("1e9", true, &|w| w.d_e = q(1, 1)), ["C4"]);
    assert_eq!(decided("1e9", true, &|w| w.d_x = q(11_000, 1)), ["C5", "C5b"]);
    assert_eq!(decided("1e9", true, &|w| w.sigma = q(25, 1)), ["C5b"]);
    assert_eq!(decided("1e9", true, &|w| w.d_e = q(-10, 1)), ["sign"]);
}

fn repaired() -> RepairedWitness {
    RepairedWitness {
        sigma: q(1_000_000, 1),
        x: q(40, 1),
        e: q(1, 1),
        level: q(10_000, 1),
        h: q(1, 1000),
        p_x: q(1, 4),
        p_e: q(1, 1),
        k0: q(100, 1),
        k1: q(1000, 1),
        transfer: TransferProof::Matched { k: 1 },
        set: ClaimedSet { x0: q(1, 1), e0: q(1, 1), z0: Some(q(0, 1)) },
    }
}

#[test]
fn every_repaired_condition_is_refused_by_itself() {
    let decided = |domain: &str, change: &dyn Fn(&mut RepairedWitness)| {
        let mut witness = repaired();
        change(&mut witness);
        let evaluation = decide(&roomy(domain), witness, Ladder::default()).evaluation;
        let failing = evaluation.conditions.iter().filter(|c| !c.truth().is_true()).map(|c| c.id);
        failing.collect::<BTreeSet<_>>().into_iter().collect::<Vec<_>>()
    };
    let far = "1e9";
    assert!(decided(far, &|_| ()).is_empty());
    assert_eq!(decided(far, &|w| w.e = q(39, 1)), ["C1"]);
    assert_eq!(decided(far, &|w| w.e = q(1, 1_000_000)), ["C2"]);
    assert_eq!(decided(far, &|w| w.p_x = q(1, 10_000_000)), ["C3"]);
    assert_eq!(decided(far, &|w| w.p_x = q(10, 1)), ["C3b"]);
    assert_eq!(decided(far, &|w| w.set.z0 = Some(q(100_000, 1))), ["C4"]);
    assert_eq!(decided(far, &|w| w.level = q(100_000_000, 1)), ["C5", "C5b"]);
    assert_eq!(decided(far, &|w| w.sigma = q(400, 1)), ["C5b"]);
    assert_eq!(decided(far, &|w| w.k1 = q(78, 1)), ["T"]);
    assert_eq!(decided(far, &|w| w.set.x0 = q(1, 2)), ["set"]);
    assert_eq!(decided("100", &|_| ()), ["domain"]);
    assert!(decided(far, &|w| w.level = q(-10_000, 1)).contains(&"sign"));
}

/// R > 0 by its determinant, and by sigma > sigma_a.
#[test]
fn the_minors_of_r_are_its_minors_and_sigma_a_is_their_zero() {
    let spec = roomy("1e9");
    let evaluation = decide(&spec, repaired(), Ladder::default()).evaluation;
    let data = Data::new(&spec, 128);
    let lyapunov = &evaluation.lyapunov;
    let plain = |value: &Enclosure| value.lower_rational().unwrap();
    let (mu, h) = (plain(&data.mu), q(1, 1000));
    let sigma_a = plain(&lyapunov.sigma_a);
    for (factor, above) in
        [((1, 100), false), ((999_999, 1_000_000), false), ((1_000_001, 1_000_000), true), ((9, 1), true)]
    {
        let sigma = &sigma_a * Rational::from(factor);
        let minors = lyapunov.leading_minors(&data, &data.rational(&sigma), &data.rational(&h));
        let a = (plain(&data.alpha) * plain(&data.p_low) - plain(&lyapunov.rho_11)) * 2u32;
        let b = -plain(&lyapunov.rho_12);
        let d = (sigma - plain(&lyapunov.rho_22)) * 2u32;
        let (e, f) = (-mu.clone(), Rational::from(&mu * &h));
        // [[a, b, 0], [b, d, e], [0, e, f]] by the rule of Sarrus.
        let two = Rational::from(&a * &d) - Rational::from(&b * &b);
        let three = Rational::from(&a * &d) * &f - Rational::from(&e * &e) * &a - Rational::from(&b * &b) * &f;
        for (minor, expected) in minors.iter().zip([a, two, three]) {
            let expected = expected.to_f64();
            assert!((minor.midpoint_f64() - expected).abs() <= 1e-12 * expected.abs(), "{factor:?}");
        }
        let definite = minors.iter().all(|minor| minor.is_positive().is_true());
        assert_eq!(definite, above, "{factor:?}");
    }
    assert!(lyapunov.sigma_a.lt(&lyapunov.sigma_a_printed).is_true());
}

/// The bounds of the regulated error against direct sums over the harmonics.
#[test]
fn error_bounds_are_above_the_direct_sums_and_close() {
    let spec = roomy("1e9");
    let evaluation = decide(&spec, witness(), Ladder::default()).evaluation;
    let data = Data::new(&spec, 128);
    let bounds = &evaluation.excitation;
    let (qr, q1) = (bounds.q_rms.midpoint_f64(), bounds.q_rate_rms.midpoint_f64());
    let omega = 2.0 * std::f64::consts::PI;
    let huge = Enclosure::from_integer(1 << 40, 128);
    for sigma in [0.01, 3.0, 500.0] {
        let exact = Enclosure::from_rational(&Rational::from_f64(sigma).unwrap(), 128);
        for n_o in [0_u64, 1, 5, 63, 200] {
            let (mut size, mut rate) = (0.0_f64, 0.0_f64);
            let last = 400_000_u64;
            for k in (n_o + 1..=last).rev() {
                let square = (k as f64 * omega).powi(2);
                size += 1.0 / (square + sigma * sigma);
                rate += 1.0 / (square * (square + sigma * sigma));
            }
            // The rest of the first sum, from its integral.
            size += 1.0 / (omega * omega * (last as f64 + 0.5));
            let a = (n_o + 1) as f64 * omega;
            let modulus = a.hypot(sigma);
            let (sup, rms) =
                ((qr * (2.0 * size).sqrt()).min(q1 * (2.0 * rate).sqrt()), (qr / modulus).min(q1 / (a * modulus)));
            let found = error_bounds(&data, bounds, None, &exact, &huge, n_o);
            for (bound, direct) in [(found.sup.upper_f64(), sup), (found.rms.upper_f64(), rms)] {
                assert!(bound >= direct * (1.0 - 1e-10) && bound <= direct * 1.5, "{sigma} {n_o}: {bound} {direct}");
            }
            // Each sum by itself: the other bound made useless.
            let mut only_size = bounds.clone();
            only_size.q_rate_rms = huge.clone();
            let by_size = error_bounds(&data, &only_size, None, &exact, &huge, n_o).sup.upper_f64();
            let direct = qr * (2.0 * size).sqrt();
            assert!(by_size >= direct * (1.0 - 1e-9) && by_size <= direct * 1.01, "{sigma} {n_o}: {by_size} {direct}");
            // A smaller bound of the periodic error is kept.
            let tiny = Enclosure::from_rational(&q(1, 1 << 40), 128);
            let kept = error_bounds(&data, bounds, None, &exact, &tiny, n_o);
            assert!(kept.sup == tiny && kept.rms == tiny);
        }
        let all = Psi::new(&data, bounds);
        assert!((all.psi_1.midpoint_f64() / (q1 / 12.0_f64.sqrt()) - 1.0).abs() < 1e-12);
        assert!((all.psi_2.midpoint_f64() / (qr / omega).powi(2) - 1.0).abs() < 1e-12);
        // Beyond every i64 the bounds are still positive and small.
        for n_o in [i64::MAX as u64, u64::MAX] {
            let found = error_bounds(&data, bounds, None, &exact, &huge, n_o);
            assert!(found.sup.is_positive().is_true() && found.rms.is_positive().is_true(), "{n_o}");
            assert!(found.rms.upper_f64() < 1e-15);
        }
    }
}

#[test]
fn the_smallest_number_of_oscillators_is_the_smallest() {
    let falling = |n_o: u64| Enclosure::one(64) / Enclosure::from_rational(&Rational::from(n_o + 1), 64);
    for wanted in [1_i64, 2, 3, 17, 1000, 65_537] {
        let target = Enclosure::one(64) / wanted;
        let found = smallest_n_o(&target, |n_o| falling(n_o).ceiling()).unwrap();
        assert!(found == wanted as u64 - 1 || found == wanted as u64, "{wanted}: {found}");
        assert_eq!(falling(found).ceiling().le(&target), Truth::True);
    }
    assert_eq!(smallest_n_o(&Enclosure::zero(64), falling), None);
}
