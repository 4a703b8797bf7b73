//! Numbers by n_o of drawn plants that are linear in x and e, against the closed loop with its oscillators, whose equations are solved harmonic by
//! harmonic; and plants that are not linear (docs/mathematics.md, section 14.3).

use crate::by_n_o_support::{Formulas, Loop, Numbers};
use crate::common::{drawn, every};
use proofs_check::verdict::Verdict::{Invalid, Undecided};

/// A plant with so many states: skew couplings and damping, K harmonics, an uncertain factor k of the damping, and a gain.
pub fn made(case: u64, states: usize) -> Loop {
    let mut draw = drawn(case);
    let mut size = |lo: f64, hi: f64| {
        let value = lo * (hi / lo).powf(draw());
        // As it is written.
        format!("{:.6}", if draw() < 0.5 { -value } else { value }).parse::<f64>().unwrap()
    };
    let harmonics = 1 + case as usize % 3;
    let skew = if states > 1 { size(0.3, 6.0) } else { 0.0 };
    let a = (0..states)
        .map(|i| {
            (0..states)
                .map(|j| match () {
                    () if i == j => -size(0.5, 4.0).abs(),
                    () if i < j => skew,
                    () => -skew,
                })
                .collect()
        })
        .collect();
    let mut row = |count: usize, lo: f64, hi: f64| (0..count).map(|_| size(lo, hi)).collect::<Vec<f64>>();
    let (b, c, d) = (row(states, 0.1, 1.0), row(states, 0.1, 1.0), row(1, 0.1, 2.0)[0]);
    let mut waves = |_| {
        (0..harmonics)
            .map(|_| {
                let pair = row(2, 0.1, 3.0);
                [pair[0], pair[1]]
            })
            .collect::<Vec<_>>()
    };
    let f_0 = (0..states).map(&mut waves).collect();
    let (q_0, mean) = (waves(0), if case.is_multiple_of(2) { 0.0 } else { row(1, 0.1, 3.0)[0] });
    let (sigma, mu) = (row(1, 8.0, 30.0)[0].abs(), row(1, 0.5, 5.0)[0].abs());
    Loop { a, b, c, d, f_0, q_0, mean, sigma, mu, factor: [0.9, 1.1], gain: [0.9, 1.2] }
}

/// The exact answers are accepted with 1 % room, and refused with a number that is 1 % too small.
#[test]
fn answers_of_drawn_loops() {
    let stride = every(3);
    let mut others = 0;
    for case in (0..36).step_by(stride) {
        let of = made(case, case as usize % 3);
        let form = of.form();
        let most = of.q_0.len();
        for n_o in [0, 1, most] {
            let exact = of.largest(n_o);
            let judged = |factors: [f64; 5]| of.judged(&form, n_o, n_o >= most, &exact.times(factors));
            if let Err(finding) = judged([1.01; 5]) {
                panic!("case {case}, n_o = {n_o}: {finding:?}");
            }
            for which in 0..5 {
                let mut factors = [1.01; 5];
                factors[which] = 0.99;
                if exact.all()[which] < 1e-12 {
                    continue;
                }
                let finding = judged(factors).expect_err("it is too small");
                let place = Numbers::place(which);
                // What bounds |zeta|_N is not its largest value.
                let verdict = if which == 4 { Undecided } else { Invalid };
                assert_eq!((finding.verdict, finding.rule), (verdict, "by n_o"), "case {case}: {finding:?}");
                assert_eq!(finding.pointer, place, "case {case}, n_o = {n_o}");
            }
            // Those of another number, where one of them is too small.
            let other = of.largest(n_o + 1).times([1.01; 5]);
            if other.all().iter().zip(exact.all()).any(|(other, own)| own > 1e-9 && *other < 0.97 * own) {
                assert!(of.judged(&form, n_o, false, &other).is_err(), "case {case}, n_o = {n_o}");
                others += 1;
            }
        }
    }
    assert!(others * stride >= 36, "{others}");
}

/// The bound of |zeta|_N is one.
#[test]
fn the_oscillators_stay_below_their_bound() {
    let mut closest = 0.0_f64;
    for case in 0..12 {
        let of = made(case, case as usize % 3);
        for n_o in [0, 1, 2, 3] {
            let [bound, largest] = of.oscillators(n_o, 1.0, 1.0);
            assert!(largest <= bound * (1.0 + 1e-9), "case {case}, n_o = {n_o}: {largest} > {bound}");
            closest = closest.max(largest / bound);
        }
    }
    assert!(closest > 0.99, "{closest}");
}

/// Without a gain, a parameter, or a harmonic.
#[test]
fn what_need_not_be_there() {
    for states in 0..3 {
        let mut of = made(30 + states as u64, states);
        (of.factor, of.gain) = ([1.0; 2], [1.0; 2]);
        for remaining in [of.q_0.len(), 0] {
            of.q_0.truncate(remaining);
            of.f_0.iter_mut().for_each(|waves| waves.truncate(remaining));
            for n_o in [0, 2] {
                let exact = of.largest(n_o);
                let form = of.form();
                // One number of oscillators, or every one.
                let accepted = of.judged(&form, n_o, n_o >= remaining, &exact.times([1.000_2; 5]));
                assert!(accepted.is_ok(), "{states} states: {accepted:?}");
                let few = of.judged(&form, n_o, true, &exact.times([1.000_2; 5]));
                assert_eq!(few.is_ok(), n_o >= remaining, "{states} states, n_o = {n_o}, {remaining} harmonics");
            }
        }
    }
}

/// A form for another loop does not fall in this one.
#[test]
fn forms_of_other_loops() {
    let of = made(4, 1);
    let (form, numbers) = (of.form(), of.largest(0).times([1.01; 5]));
    assert!(of.judged(&form, 0, false, &numbers).is_ok());
    for (change, less) in [
        (&(|of: &mut Loop| of.d = 9.0 * of.sigma) as &dyn Fn(&mut Loop), false),
        (&|of: &mut Loop| of.c[0] *= 90.0, false),
        (&|of: &mut Loop| of.b[0] *= 90.0, false),
        (&|of: &mut Loop| of.a[0][0] *= -1.0, false),
        (&|of: &mut Loop| of.gain = [0.9, 9.0], false),
        (&|of: &mut Loop| of.gain = [0.9, 1.21], true),
    ] {
        let mut other = made(4, 1);
        change(&mut other);
        let judged = other.judged(&form, 0, false, &Numbers::large());
        match less {
            true => assert!(judged.is_ok(), "{judged:?}"),
            false => {
                let finding = judged.expect_err("it does not fall");
                assert_eq!((finding.verdict, finding.rule), (Invalid, "by n_o"), "{finding:?}");
                assert!(finding.pointer.starts_with("/witness/by_n_o/linear/forms/0"), "{finding:?}");
            }
        }
    }
}

/// Each end of the gain counts.
#[test]
fn forms_fall_at_both_ends_of_the_gain() {
    let mut of = made(4, 1);
    of.d = 0.4 * of.sigma;
    let form = of.form();
    assert!(of.judged(&form, 0, false, &Numbers::large()).is_ok());
    for (gain, end) in [([0.02, 1.2], "at b_lo"), ([0.9, 9.0], "at b_hi")] {
        of.gain = gain;
        let finding = of.judged(&form, 0, false, &Numbers::large()).expect_err("it does not fall");
        assert!(finding.verdict == Invalid && finding.message.contains(end), "{finding:?}");
    }
}

#[test]
fn plants_that_are_not_linear() {
    let of = made(4, 1);
    let linear = Formulas { f: "-x + e/4 + cos(2*pi*t)".to_owned(), q: "x/4 + k*sin(2*pi*t)".to_owned() };
    let judged = |f: Option<&str>, q: Option<&str>| {
        let given = |text: Option<&str>, own: &String| text.map_or_else(|| own.clone(), str::to_owned);
        let formulas = Formulas { f: given(f, &linear.f), q: given(q, &linear.q) };
        of.judged_as(&formulas, &of.form_of(&[vec![-1.0]], [&[0.25], &[0.25]], 0.0), 0, false, &Numbers::large())
    };
    assert!(judged(None, None).is_ok());
    for text in [
        "x/4 + 0.001*x^2",
        "x/4 + 0.001*e*x",
        "x/4 + 0.001*e*sin(2*pi*t)",
        "x*cos(2*pi*t)",
        "x/4 + 0.01/(4 + x)",
        "x^2/(4*x)",
        "(x*e)/(4*e)",
        "abs(x)/4",
        "sqrt(x^2)/4",
        "min(x/4, x/5)",
        "tanh(x)/4",
        "x/4 + 0.01*sin(e)",
        "x/4 + exp(e - e*cos(2*pi*t)^2 - e*sin(2*pi*t)^2)",
        "exp(log(x))",
        "x/4 + 0*log(x)",
        "x/4 + 0/(2 + cos(2*pi*t))",
        "x/4 + cos(2*pi*t)/(2 + cos(2*pi*t))",
        "x/4 + sqrt(2 + cos(2*pi*t))",
        "x/4 + cos(2*pi*t*k)",
        "x/4 + t",
    ] {
        for judged in [judged(None, Some(text)), judged(Some(&format!("-x + {text}")), None)] {
            let finding = judged.expect_err("it is not linear");
            assert_eq!((finding.verdict, finding.rule), (Undecided, "by n_o"), "{text}: {finding:?}");
            assert!(finding.pointer.starts_with("/plant"), "{text}: {finding:?}");
        }
    }
    for text in [
        "x*k/4 + sqrt(k)*e/9 + cos(2*pi*t + k)*exp(k)",
        "(x + e)/(4 + abs(k)) - min(k, 3)*cos(2*pi*t)^3",
        "x/4 - x^1/8 + (e + 1)*(k/9) + log(k)*sin(-4*pi*t)",
        "sinc(k)*x/4 + tan(k - 1)*e/9",
    ] {
        assert!(judged(None, Some(text)).is_ok(), "{text}: {:?}", judged(None, Some(text)));
    }
}
