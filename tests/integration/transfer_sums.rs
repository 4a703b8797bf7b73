//! g_N, T_N and the poles of the internal model against plain sums at 320 bits that share nothing with them.

use rug::float::Constant;
use rug::ops::Pow;
use rug::{Float, Rational};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::parse_decimal;
use sigmastar_lang::spec::Specification;
use sigmastar_theory::data::Data;
use sigmastar_theory::transfer::{
    AroundPole, MAX_DIRECT_POLES, MAX_POLE_OSCILLATORS, OscillatorCount, PoleDisc, PoleSums, PolesError,
    internal_model_poles, slowest_decay,
};

const BITS: u32 = 320;

/// Weights as JSON and as numbers, n_0, ..., n_L and then coefficient * l^-p; and mu, with nu = mu for the base frequency 1.
#[derive(Clone)]
pub struct Family {
    pub json: String,
    listed: Vec<Float>,
    coefficient: Float,
    p: Float,
    pub nu: Float,
    mu: String,
}

/// A decimal or a quotient of two.
fn float(text: &str) -> Float {
    let decimal = |text: &str| Float::with_val(BITS, parse_decimal(text).unwrap());
    text.split_once('/').map_or_else(|| decimal(text), |(over, under)| decimal(over) / decimal(under))
}

/// n_l = 1/l as far as it is listed, much further than the first pole that a formula may take, and then 80/l^2.
#[test]
fn a_long_list_of_weights_is_summed_to_its_end() {
    let list: Vec<String> = (0..=80).map(|l| if l == 0 { "2".to_owned() } else { format!("1/{l}") }).collect();
    let texts: Vec<&str> = list.iter().map(String::as_str).collect();
    let family = explicit(&texts, "80", "2", "1");
    let spec = family.specification();
    let data = Data::new(&spec, 128);
    let weights = family.weights(400);
    for x in [(1, 3), (5, 4), (33, 10), (799, 10)].map(Rational::from) {
        for n in [50, 79, 80, 81, 200, 400] {
            let truth = plain_at(&family, &weights[..=n], &x);
            let value = PoleSums::new(&data, OscillatorCount::Finite(n as u64)).transfer_at(&thin(&x));
            assert!(holds(&value, &truth) && relative_width(&value) < 1e-25, "N = {n}, x = {x}");
        }
    }
}

pub fn power(n0: &str, epsilon: &str, mu: &str) -> Family {
    Family {
        json: format!(r#"{{"family": "power", "n0": "{n0}", "epsilon": "{epsilon}"}}"#),
        listed: vec![float(n0)],
        coefficient: float("1"),
        p: float(epsilon) + 1u32,
        nu: float(mu),
        mu: mu.to_owned(),
    }
}

pub fn explicit(values: &[&str], coefficient: &str, exponent: &str, mu: &str) -> Family {
    let list: Vec<String> = values.iter().map(|value| format!("\"{value}\"")).collect();
    let tail = format!(r#"{{"coefficient": "{coefficient}", "exponent": "{exponent}"}}"#);
    Family {
        json: format!(r#"{{"family": "explicit", "values": [{}], "tail": {tail}}}"#, list.join(", ")),
        listed: values.iter().map(|value| float(value)).collect(),
        coefficient: float(coefficient),
        p: float(exponent),
        nu: float(mu),
        mu: mu.to_owned(),
    }
}

fn families() -> Vec<Family> {
    vec![
        power("2", "0.5", "1"),
        power("2", "1", "0.159"),
        power("1.01", "0.0078125", "10"),
        power("50", "0.3", "0.01"),
        explicit(&["2", "1", "0.375", "0.25"], "1.25", "1.5", "1"),
        explicit(&["1.5"], "1.25", "2", "3"),
    ]
}

impl Family {
    pub fn with_mu(&self, mu: &str) -> Family {
        Family { nu: float(mu), mu: mu.to_owned(), ..self.clone() }
    }

    pub fn specification(&self) -> Specification {
        self.specification_at("1", false)
    }

    /// Nothing but the weights; the period is 1.
    pub fn specification_at(&self, frequency: &str, matched: bool) -> Specification {
        let text = format!(
            r#"{{"format": "sigmastar/bounding-spec", "version": 1, "name": "sums", "period": "1",
            "lyapunov": {{"p_low": 1, "p_up": 1, "alpha": 1}},
            "bounds": {{"f": 0, "f_e": 0, "f_xx": 0, "f_ex": 0, "q": 1, "q_e": 0, "q_x": 0, "q_t": 1}},
            "internal_model": {{"mu": "{}", "base_frequency": "{frequency}", "matched": {matched}, "weights": {}}},
            "initial_set": {{"kind": "paper"}}}}"#,
            self.mu, self.json
        );
        Specification::from_json("sums", &text).unwrap()
    }

    pub fn weights(&self, last: u64) -> Vec<Float> {
        let tail = |l: u64| Float::with_val(BITS, l).pow(Float::with_val(BITS, -&self.p)) * &self.coefficient;
        (0..=last).map(|l| self.listed.get(l as usize).cloned().unwrap_or_else(|| tail(l))).collect()
    }

    /// T at the pole m.
    fn at_pole(&self, m: u64) -> Float {
        let n = self.weights(m)[m as usize].clone();
        let numerator = if m == 0 { 1 } else { 2 };
        numerator / (n * self.nu.clone().square())
    }
}

/// g and g' by their definition, for x that is no pole.
fn plain_group(weights: &[Float], x: &Rational) -> [Float; 2] {
    let (mut g, mut slope) = (Float::new(BITS), Float::new(BITS));
    let mut add = |l: i64, c: Float| {
        let inverse = Float::with_val(BITS, Rational::from(l - x)).recip();
        g += Float::with_val(BITS, &c * &inverse);
        slope += c * inverse.square();
    };
    for (l, weight) in weights.iter().enumerate() {
        if l == 0 {
            add(0, weight.clone());
        } else {
            add(l as i64, Float::with_val(BITS, weight / 2u32));
            add(-(l as i64), Float::with_val(BITS, weight / 2u32));
        }
    }
    [g, slope]
}

/// `[g_N(x), g_N'(x)]` from what is around the pole that is nearest to x.
fn group(sums: &PoleSums, x: &Enclosure) -> [Enclosure; 2] {
    let nearest = Float::with_val(BITS, x.lower()).to_integer().and_then(|nearest| nearest.to_u64()).unwrap();
    let AroundPole { distance, sum, slope, residue } = sums.around(x, nearest);
    match residue {
        Some(residue) => [sum - &residue / &distance, slope + residue / distance.sqr()],
        None => [sum, slope],
    }
}

/// T by its definition, for x that is no pole.
pub fn plain_transfer(weights: &[Float], nu: &Float, x: &Rational) -> Float {
    let [g, slope] = plain_group(weights, x);
    slope / ((g * nu).square() + 1u32)
}

fn holds(value: &Enclosure, truth: &Float) -> bool {
    value.lower() <= *truth && value.upper() >= *truth
}

fn relative_width(value: &Enclosure) -> f64 {
    (Float::with_val(64, value.upper() - value.lower()) / Float::with_val(64, value.lower()).abs()).to_f64()
}

fn thin(x: &Rational) -> Enclosure {
    Enclosure::from_rational(x, 128)
}

/// The same pseudo-random numbers in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % bound
    }

    /// A number in [0, reach]: an integer, close to one, a half-integer, or anywhere.
    fn point(&mut self, reach: u64) -> Rational {
        let m = Rational::from(self.below(reach + 1));
        let side = if self.below(2) == 0 { 1 } else { -1 };
        let offset = match self.below(5) {
            0 => Rational::new(),
            1 => Rational::from((side, 2)),
            2 | 3 => {
                let scale = 10_u64.pow(self.below(18) as u32);
                Rational::from((side * (1 + self.below(99)) as i64, 100)) / scale
            }
            _ => Rational::from((side * self.below(1_000_003) as i64, 2_000_006)),
        };
        (m + offset).abs()
    }
}

fn plain_at(family: &Family, weights: &[Float], x: &Rational) -> Float {
    match x.numer().to_u64().filter(|m| x.is_integer() && (*m as usize) < weights.len()) {
        Some(m) => family.at_pole(m),
        None => plain_transfer(weights, &family.nu, x),
    }
}

#[test]
fn the_transfer_function_contains_the_plain_sum() {
    let mut random = Random(1);
    for family in families() {
        let spec = family.specification();
        let data = Data::new(&spec, 128);
        for n in [0, 1, 2, 3, 5, 20, 35, 48, 60, 61, 100, 400, 1000, 10_000] {
            let weights = family.weights(n);
            let sums = PoleSums::new(&data, OscillatorCount::Finite(n));
            let cases = if n < 1000 { 40 } else { 12 };
            for case in 0..cases {
                let x = random.point(if case % 4 == 3 { 2 * n.min(500) + 3 } else { n.min(12) });
                let value = sums.transfer_at(&thin(&x));
                let truth = plain_at(&family, &weights, &x);
                assert!(holds(&value, &truth), "{} N = {n}, x = {x}: {value:?} {truth}", family.json);
                assert!(relative_width(&value) < 1e-25, "{} N = {n}, x = {x}: {}", family.json, relative_width(&value));
            }
        }
    }
}

#[test]
fn the_last_of_many_poles_and_beyond() {
    for family in [&families()[0], &families()[4]] {
        let spec = family.specification();
        let data = Data::new(&spec, 128);
        let n = 10_000;
        let weights = family.weights(n);
        let sums = PoleSums::new(&data, OscillatorCount::Finite(n));
        for (numerator, denominator) in
            [(19_999, 2), (10_000, 1), (100_001, 10), (20_001, 2), (12_000, 1), (90_000_001, 3)]
        {
            let x = Rational::from((numerator, denominator));
            let (value, truth) = (sums.transfer_at(&thin(&x)), plain_at(family, &weights, &x));
            assert!(holds(&value, &truth) && relative_width(&value) < 1e-25, "x = {x}: {value:?} {truth}");
        }
    }
}

#[test]
fn the_poles_are_removable() {
    for family in families() {
        let spec = family.specification();
        let data = Data::new(&spec, 128);
        for count in [OscillatorCount::Finite(7), OscillatorCount::Finite(1 << 40), OscillatorCount::Infinite] {
            let sums = PoleSums::new(&data, count);
            for m in 0..=7 {
                let x = Enclosure::from_integer(m as i64, 128);
                let around = sums.around(&x, m);
                assert!(around.distance.is_exact() && around.distance.contains_zero());
                let value = sums.transfer(&x, m);
                assert!(holds(&value, &family.at_pole(m)) && relative_width(&value) < 1e-36, "{count:?}, m = {m}");
                let [g, slope] = group(&sums, &x);
                assert!(!g.is_defined() && !slope.is_defined());
            }
        }
        assert!(PoleSums::new(&data, OscillatorCount::Finite(7)).residue(8).is_none());
    }
}

/// For n_l = l^-2, g is elementary: sum x/(l^2 (l^2 - x^2)) = ((1 - pi x cot(pi x))/(2 x^2) - pi^2/6)/x.
#[test]
fn infinitely_many_oscillators_have_a_closed_form() {
    let family = power("2", "1", "1");
    let spec = family.specification();
    let data = Data::new(&spec, 128);
    let sums = PoleSums::new(&data, OscillatorCount::Infinite);
    for (numerator, denominator) in [(1, 1000), (1, 3), (1, 2), (7, 5), (19, 2), (1000, 7), (30_001, 10)] {
        let x = Rational::from((numerator, denominator));
        let pi = Float::with_val(BITS, Constant::Pi);
        let x_float = Float::with_val(BITS, &x);
        let angle = Float::with_val(BITS, &pi * &x_float);
        let cotangent = 1 - Float::with_val(BITS, &angle * angle.clone().cot());
        let sum = (cotangent / x_float.clone().square() / 2u32 - pi.clone().square() / 6u32) / &x_float;
        let truth = sum - Float::with_val(BITS, 2u32 / &x_float);
        let [g, _] = group(&sums, &thin(&x));
        assert!(holds(&g, &truth) && relative_width(&g) < 1e-25, "x = {x}: {g:?} {truth}");
    }
}

/// The poles beyond N >= 2 x add `sum n_l x/(l^2 - x^2)`, between two integrals, and likewise to g'.
#[test]
fn huge_numbers_of_oscillators_approach_the_limit() {
    for family in families() {
        let spec = family.specification();
        let data = Data::new(&spec, 128);
        let finite = |n: u64| PoleSums::new(&data, OscillatorCount::Finite(n));
        let infinite = PoleSums::new(&data, OscillatorCount::Infinite);
        let few = 3000;
        let weights = family.weights(few);
        for (numerator, denominator) in [(1, 7), (13, 10), (201, 100), (57, 4)] {
            let x = Rational::from((numerator, denominator));
            let x_float = Float::with_val(BITS, &x);
            let [limit, limit_slope] = group(&infinite, &thin(&x));
            let mut previous = group(&finite(few), &thin(&x));
            for n in [10_000, 1_000_000, 1_000_000_000, 1 << 50] {
                let [g, slope] = group(&finite(n), &thin(&x));
                assert!(g.upper() > previous[0].lower() && slope.upper() > previous[1].lower(), "x = {x}, N = {n}");
                assert!(g.lower() < limit.upper() && slope.lower() < limit_slope.upper(), "x = {x}, N = {n}");
                previous = [g, slope];
            }
            // The plain sum to 3000 and the bracket of the rest, for N = 10^9 and for all.
            let [head, head_slope] = plain_group(&weights, &x);
            let power = |n: u64, more: u32| {
                Float::with_val(BITS, n).pow(-Float::with_val(BITS, &family.p + more))
                    / Float::with_val(BITS, &family.p + more)
            };
            let squeeze = 1 - (Float::with_val(BITS, &x_float / few)).square();
            for (last, sums) in [(Some(1_000_000_000_u64), &finite(1_000_000_000)), (None, &infinite)] {
                let [g, slope] = group(sums, &thin(&x));
                let cut = last.map_or(Float::new(BITS), |n| power(n + 1, 1));
                let least = Float::with_val(BITS, power(few + 1, 1) - &cut) * &family.coefficient;
                let cut = last.map_or(Float::new(BITS), |n| power(n, 1));
                let most = Float::with_val(BITS, power(few, 1) - &cut) * &family.coefficient / &squeeze;
                let (low, high) = (Float::with_val(BITS, &least * &x_float), Float::with_val(BITS, &most * &x_float));
                assert!(
                    g.upper() >= Float::with_val(BITS, &head + low) && g.lower() <= Float::with_val(BITS, &head + high)
                );
                let high = most * 2u32 / &squeeze;
                assert!(slope.upper() >= Float::with_val(BITS, &head_slope + least));
                assert!(slope.lower() <= Float::with_val(BITS, &head_slope + high));
                assert!(relative_width(&sums.transfer_at(&thin(&x))) < 1e-25, "x = {x}, N = {last:?}");
                assert!(relative_width(&g) < 1e-25, "{g:?}");
            }
        }
    }
}

#[test]
fn wide_intervals_contain_their_points() {
    let mut random = Random(2);
    for family in families() {
        let spec = family.specification();
        let data = Data::new(&spec, 128);
        for n in [0, 1, 4, 60, 200] {
            let weights = family.weights(n);
            let sums = PoleSums::new(&data, OscillatorCount::Finite(n));
            for case in 0..30 {
                let (mut a, mut b) = (random.point(7), random.point(7));
                if case % 2 == 0 {
                    b = &a + Rational::from((random.below(30) as i64, 1000));
                }
                if a > b {
                    std::mem::swap(&mut a, &mut b);
                }
                let value = sums.transfer_at(&Enclosure::between(&a, &b, 128));
                assert!(value.is_bounded(), "N = {n}, [{a}, {b}]");
                for step in 0..=8 {
                    let x = &a + Rational::from(&b - &a) * step / 8;
                    let truth = plain_at(&family, &weights, &x);
                    assert!(holds(&value, &truth), "{} N = {n}, [{a}, {b}] at {x}: {value:?} {truth}", family.json);
                }
            }
        }
    }
}

/// On a cell between half-integers the sums without the pole are as good as their values at the ends.
#[test]
fn sums_on_wide_intervals_are_attained_at_the_ends() {
    let family = power("2", "0.5", "1");
    let spec = family.specification();
    let data = Data::new(&spec, 128);
    for count in [OscillatorCount::Finite(9), OscillatorCount::Infinite] {
        let sums = PoleSums::new(&data, count);
        for (m, a, b) in [(0, (0, 1), (1, 2)), (2, (3, 2), (5, 2)), (3, (31, 10), (33, 10))] {
            let (a, b) = (Rational::from(a), Rational::from(b));
            let wide = sums.around(&Enclosure::between(&a, &b, 128), m);
            let (left, right) = (sums.around(&thin(&a), m), sums.around(&thin(&b), m));
            assert!(wide.sum.lower() >= left.sum.lower() && wide.sum.upper() <= right.sum.upper());
            let largest = left.slope.max(&right.slope);
            assert!(wide.slope.upper() <= largest.upper());
            for step in 1..8 {
                let x = thin(&(&a + Rational::from(&b - &a) * step / 8));
                let inside = sums.around(&x, m);
                assert!(wide.sum.lower() <= inside.sum.lower() && inside.sum.upper() <= wide.sum.upper());
                assert!(wide.slope.lower() <= inside.slope.lower() && inside.slope.upper() <= wide.slope.upper());
            }
        }
    }
}

/// `T_N(x) = (1/nu) sum_k Im z_k/|x - z_k|^2`, from all 2N + 1 poles.
fn transfer_from_poles(data: &Data<'_>, poles: &[PoleDisc], x: &Enclosure) -> Enclosure {
    let sum = poles.iter().fold(data.zero(), |sum, pole| {
        let rate = pole.imaginary_part();
        let distance = (x - pole.real_part()).sqr() + rate.sqr();
        sum + rate / distance
    });
    sum / &data.nu
}

#[test]
fn the_poles_give_the_transfer_function_as_lorentzians() {
    let mut random = Random(4);
    for family in families() {
        let spec = family.specification();
        let data = Data::new(&spec, 128);
        for n in [0, 1, 2, 5, 20, 64] {
            let poles = internal_model_poles(&data, n).unwrap();
            assert_eq!(poles.len() as u64, 2 * n + 1);
            // The trace: sum z_k = sum l + i nu sum c_l.
            let zero = data.zero();
            let (mut re, mut im) = (zero.clone(), zero);
            for pole in &poles {
                re = re + pole.real_part();
                im = im + pole.imaginary_part();
                assert!(
                    pole.imaginary_part().is_positive().is_true() && relative_width(&pole.imaginary_part()) < 1e-20
                );
            }
            let total = family.weights(n).iter().fold(Float::new(BITS), |sum, weight| sum + weight) * &family.nu;
            assert!(re.contains_zero() && holds(&im, &total), "{} N = {n}: {im:?} {total}", family.json);
            let sums = PoleSums::new(&data, OscillatorCount::Finite(n));
            for _ in 0..10 {
                let x = thin(&random.point(n + 2));
                let lorentzians = transfer_from_poles(&data, &poles, &x);
                let direct = sums.transfer_at(&x);
                assert!(lorentzians.intersect(&direct).is_defined(), "N = {n}, {x:?}: {lorentzians:?} {direct:?}");
                assert!(relative_width(&lorentzians) < 1e-18);
            }
            let slowest = slowest_decay(&data, &poles);
            // In 1/time: the same poles over the base frequency are three times as fast at three times that.
            let faster = slowest_decay(&Data::new(&family.specification_at("3", false), 128), &poles);
            assert!((faster / &slowest).contains(&Rational::from(3)));
            assert!(slowest.is_positive().is_true());
            assert!(poles.iter().all(|pole| slowest.lower() <= pole.imaginary_part().upper()));
        }
    }
}

#[test]
fn one_oscillator_has_the_poles_of_its_cubic() {
    // N = 0: z = i nu n_0. N = 1, n_0 = 2, n_1 = 1, nu = 1: with z = i y, y^3 - 3 y^2 + y - 2 = 0.
    let family = power("2", "0.5", "1");
    let spec = family.specification();
    let data = Data::new(&spec, 128);
    let single = internal_model_poles(&data, 0).unwrap();
    assert!(single[0].imaginary_part().contains(&Rational::from(2)) && single[0].real_part().contains_zero());
    for pole in internal_model_poles(&data, 1).unwrap() {
        let (re, im) = (pole.real_part(), pole.imaginary_part());
        // y = -i z = im - i re.
        let multiply =
            |a: &[Enclosure; 2], b: &[Enclosure; 2]| [&a[0] * &b[0] - &a[1] * &b[1], &a[0] * &b[1] + &a[1] * &b[0]];
        let y = [im, -re];
        let square = multiply(&y, &y);
        let cube = multiply(&square, &y);
        assert!((&cube[0] - 3 * &square[0] + &y[0] - 2).contains_zero());
        assert!((&cube[1] - 3 * &square[1] + &y[1]).contains_zero());
    }
}

/// w enters T only in nu = mu/w, and the decay rates as a factor.
#[test]
fn decay_rates_are_in_the_units_of_the_base_frequency() {
    let slow = power("2", "0.5", "1").specification();
    let mut fast = power("2", "0.5", "3").specification();
    fast.internal_model.base_frequency = fast.internal_model.mu.clone();
    let (slow, fast) = (Data::new(&slow, 128), Data::new(&fast, 128));
    for n in [0, 2, 7] {
        let rate = |data: &Data<'_>| slowest_decay(data, &internal_model_poles(data, n).unwrap());
        let (slow, fast) = (rate(&slow), rate(&fast));
        assert!((3 * slow).intersect(&fast).is_defined() && relative_width(&fast) < 1e-30, "N = {n}");
    }
    // N = 0: mu n_0.
    assert!(slowest_decay(&fast, &internal_model_poles(&fast, 0).unwrap()).contains(&Rational::from(6)));
}

#[test]
fn poles_that_cannot_be_proved_are_errors() {
    let spec = power("2", "0.5", "1").specification();
    let data = Data::new(&spec, 128);
    let too_many = MAX_POLE_OSCILLATORS + 1;
    let error = internal_model_poles(&data, too_many).unwrap_err();
    assert_eq!(error, PolesError::TooMany { n: too_many, max: MAX_POLE_OSCILLATORS });
    assert!(error.to_string().contains("65") && error.to_string().contains("64"));
    // nu known to three bits only: the discs are wide.
    let third = power("2", "0.5", "1/3").specification();
    let coarse = Data::new(&third, 3);
    assert!(matches!(internal_model_poles(&coarse, 12), Err(PolesError::Undecided { degree: 25, .. })));
    // nu out of the range of doubles: no pole can be told from the real axis.
    let tiny = power("2", "0.5", "1e-400").specification();
    assert!(internal_model_poles(&Data::new(&tiny, 128), 3).is_err());
}

#[test]
fn hypotheses_are_enforced() {
    let spec = power("2", "0.5", "1").specification();
    let data = Data::new(&spec, 128);
    let between = |a: i64, b: i64| Enclosure::between(&Rational::from((a, 10)), &Rational::from((b, 10)), 128);
    let (three, infinite) =
        (PoleSums::new(&data, OscillatorCount::Finite(3)), PoleSums::new(&data, OscillatorCount::Infinite));
    for x in [between(-1, 1), between(-20, -10), Enclosure::undefined(128), Enclosure::entire(128)] {
        for sums in [&three, &infinite] {
            assert!(!sums.transfer_at(&x).is_defined(), "{x:?}");
            assert!(!sums.transfer(&x, 0).is_defined(), "{x:?}");
        }
    }
    // A pole other than the nearest one in the interval, or x not beyond the last pole.
    assert!(!infinite.transfer(&between(5, 25), 2).is_defined());
    assert!(!infinite.transfer(&between(15, 31), 2).is_defined());
    assert!(!infinite.transfer(&between(-1, 3), 0).is_defined());
    assert!(!three.transfer(&between(29, 36), 4).is_defined());
    assert!(three.transfer(&between(31, 90), 4).is_defined());
    assert!(three.transfer_at(&between(0, 1_000_000)).is_defined());
    // Nor is the sum without the slope, which wide intervals take from their ends.
    assert!(!three.around(&between(12, 27), 9).sum.is_defined() && !three.around(&between(5, 32), 3).sum.is_defined());
    assert!(!three.around(&between(2, 22), 1).sum.is_defined());
    // Too many pieces, and beyond the direct sums.
    assert!(!infinite.transfer_at(&between(0, 10_000)).is_defined());
    let far = Enclosure::from_integer(MAX_DIRECT_POLES as i64, 128);
    assert!(!infinite.transfer_at(&far).is_defined() && three.transfer_at(&far).is_defined());
    assert!(!infinite.transfer_at(&Enclosure::from_rational(&Rational::from(u64::MAX), 128)).is_defined());
    let huge = Enclosure::from_rational(&(Rational::from(u64::MAX) * 1000), 200);
    assert!(!infinite.transfer_at(&huge).is_defined());
}
