//! The gains at samples, against loops whose harmonics are summed one by one.

use super::*;
use crate::data::{Data, Problem};
use crate::derivation::sampled::examples::{example, law};
use crate::derivation::sampled::sampled_trade_off;
use num_complex::Complex;
use serde_json::json;
use std::f64::consts::{PI, TAU};

/// [sup|e_k|, sup|e|, rms(e), rms(e'), sup|zeta_k|_N, sup|u_k|] of the periodic answer to q = mean + 2 Re sum_m c_m e^{i m Om t}, T = 1,
/// at the input gain b, by its harmonics at samples and the law between them; in doubles.
fn answer(
    data: &Data<'_>,
    law: &SampledLaw<f64>,
    (sigma, b, n_o): (f64, f64, i64),
    (q_mean, q): (f64, &[(i64, Complex<f64>)]),
) -> [f64; 6] {
    let weights = &data.spec.internal_model.weights;
    let (n, h, i) = (i64::from(law.samples), law.step, Complex::i());
    let turn = |angle: f64| Complex::new(0.0, angle).exp();
    let both: Vec<(i64, Complex<f64>)> = q.iter().flat_map(|(m, c)| [(*m, *c), (-m, c.conj())]).collect();
    let mut e = vec![Complex::new(0.0, 0.0); n as usize];
    let mut means = vec![Complex::new(q_mean, 0.0); n as usize];
    let c = |l: i64| weights.weight_f64(l.unsigned_abs()) * if l == 0 { 1.0 } else { 0.5 };
    // y of the sample before, and M'N R M.
    let mut last = e.clone();
    let through: f64 = (-n_o..=n_o).map(|l| c(l) * (TAU * l as f64 / n as f64).cos()).sum();
    // Of each oscillator, by the frequency at which it turns.
    let mut zeta = vec![e.clone(); 2 * n_o as usize + 1];
    for (m, c) in &both {
        let angle = TAU * *m as f64 * h;
        let mean = c * (turn(angle) - 1.0) / (i * angle);
        for k in 0..n {
            means[k as usize] += mean * turn(TAU * (*m * k).rem_euclid(n) as f64 / n as f64);
        }
    }
    for j in 0..n {
        let mean: Complex<f64> = (0..n)
            .map(|k| means[k as usize] * turn(-TAU * (j * k).rem_euclid(n) as f64 / n as f64))
            .sum::<Complex<f64>>()
            / n as f64;
        let phi = TAU * j as f64 / n as f64;
        let within = |l: i64| turn(phi - TAU * l as f64 / n as f64);
        let at = |k: i64| turn(TAU * (j * k).rem_euclid(n) as f64 / n as f64);
        if j.min(n - j) <= n_o {
            // At resonance y = 0: the one oscillator that turns with it answers with v = -q/(b K), and v is that of R zeta.
            let l = if j <= n_o { j } else { j - n };
            let own = -mean / (b * law.gain * c(l)) * turn(-phi);
            (0..n).for_each(|k| zeta[(l + n_o) as usize][k as usize] += own * at(k));
            continue;
        }
        let g: Complex<f64> = (-n_o..=n_o).map(|l| c(l) / (within(l) - 1.0)).sum();
        let d = (turn(phi) - (1.0 - h * sigma)) / h;
        // y, and e from it: without a delay y/D.
        let (y, own) = if law.delayed {
            let back = turn(-phi);
            let y = mean / (1.0 + b * law.gain * h * (g - through * back) - (1.0 - b) * sigma * back / d);
            (y, (1.0 + h * sigma * back) * y / d)
        } else {
            let own = mean / (d * (1.0 + b * law.gain * h * g) - (1.0 - b) * sigma);
            (d * own, own)
        };
        for k in 0..n {
            e[k as usize] += own * at(k);
            last[k as usize] += y * turn(-phi) * at(k);
            for l in -n_o..=n_o {
                let factor = turn(TAU * l as f64 / n as f64) * (within(l) - 1.0);
                zeta[(l + n_o) as usize][k as usize] -= h * y / factor * at(k);
            }
        }
    }
    let (mut at_samples, mut sup, mut squares, mut rates) = (0.0_f64, 0.0_f64, 0.0, 0.0);
    let (mut of_zeta, mut control) = (0.0_f64, 0.0_f64);
    const FINE: u32 = 40;
    for k in 0..n {
        let (here, next) = (e[k as usize].re, e[((k + 1) % n) as usize].re);
        // What is put in, b u.
        let u = (next - here) / h - means[k as usize].re;
        at_samples = at_samples.max(here.abs());
        control = control.max(u.abs() / b);
        of_zeta = of_zeta.max((-n_o..=n_o).map(|l| c(l) * zeta[(l + n_o) as usize][k as usize].norm_sqr()).sum());
        let v: Complex<f64> =
            (-n_o..=n_o).map(|l| c(l) * turn(TAU * l as f64 / n as f64) * zeta[(l + n_o) as usize][k as usize]).sum();
        // It is what the law puts out.
        let off = if law.delayed { h * last[k as usize].re } else { 0.0 };
        let law_u = law.gain * (v.re + through * off) - sigma * (here - off);
        assert!((law_u - u / b).abs() < 1e-8 * (1.0 + law_u.abs()), "{law_u} {u} {b}");
        for step in 0..FINE {
            let s = h * (f64::from(step) + 0.5) / f64::from(FINE);
            let start = k as f64 * h;
            let moved: Complex<f64> = both
                .iter()
                .map(|(m, c)| {
                    c * turn(TAU * *m as f64 * start) * (turn(TAU * *m as f64 * s) - 1.0) / (i * TAU * *m as f64)
                })
                .sum();
            let value: Complex<f64> = both.iter().map(|(m, c)| c * turn(TAU * *m as f64 * (start + s))).sum();
            let error = here + s * (u + q_mean) + moved.re;
            sup = sup.max(error.abs());
            squares += error * error;
            rates += (q_mean + value.re + u).powi(2);
        }
    }
    let count = (n * i64::from(FINE)) as f64;
    [at_samples, sup, (squares / count).sqrt(), (rates / count).sqrt(), of_zeta.sqrt(), control]
}

#[test]
fn answers_of_the_law_stay_within_their_bounds() {
    let mut state = 5_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / 2f64.powi(23) - 1.0
    };
    let (mut own_worst, mut own_gain) = (0.0_f64, 1.0_f64);
    let (mut worst, mut with_gain, mut with_delay, mut seen) = ([0.0_f64; 6], [0.0_f64; 6], [0.0_f64; 6], 0);
    let models = [(2, "1"), (3, "1"), (12, "1"), (25, "1"), (25, "30")];
    let intervals = [[1.0, 1.0], [0.8, 1.25], [0.5, 1.1], [0.95, 1.8]];
    let cases = models.into_iter().flat_map(|model| intervals.map(|interval| (model, interval)));
    for (((samples, mu), [low, high]), delayed) in cases.flat_map(|case| [false, true].map(|delayed| (case, delayed))) {
        let spec = example(samples, mu, |file| {
            file["input_gain"] = json!({ "nominal": 1, "low": low.to_string(), "high": high.to_string() });
            file["internal_model"]["delay_samples"] = u8::from(delayed).into();
        });
        let data = Data::new(&spec, 128);
        let enclosed = law(&data);
        let law = enclosed.to_f64();
        // The law with a delay needs more samples.
        if delayed && 3.0 * law.load() >= 2.0 {
            continue;
        }
        let pairs = sampled_trade_off(&data, &enclosed).candidates;
        let worst = match (delayed, high > low) {
            (true, _) => &mut with_delay,
            (false, true) => &mut with_gain,
            (false, false) => &mut worst,
        };
        for product in [0.02, 0.3, 1.0] {
            let sigma = product / law.step;
            let gains = SampledGains::new(&law, &sigma, &1.0);
            // So few samples are too few for so wide an interval.
            if gains.room.is_some_and(|room| room <= 0.0) {
                continue;
            }
            seen += 1;
            let by_count = gains.by_count(&law, &sigma, Clone::clone);
            assert_eq!(by_count.len(), samples as usize / 2 + samples as usize % 2);
            for trial in 0..24 {
                let b = match trial % 4 {
                    0 | 2 => low,
                    1 => high,
                    _ => low + (high - low) * 0.5 * (next() + 1.0),
                };
                let n_o = i64::from(trial % 3) * i64::from((samples - 1) / 2) / 2;
                let q: Vec<(i64, Complex<f64>)> = match trial {
                    // One harmonic alone, the first that the oscillators leave.
                    0..3 => vec![(n_o + 1, Complex::new(1.0, next()))],
                    _ => (1..=i64::from(samples) + 5)
                        .filter(|m| trial % 2 == 0 || *m > n_o)
                        .map(|m| (m, Complex::new(next(), next()) / (m as f64).powi(trial % 4)))
                        .collect(),
                };
                let rms = |rate: bool| {
                    let factor = |m: i64| if rate { TAU * m as f64 } else { 1.0 };
                    q.iter().map(|(m, c)| 2.0 * c.norm_sqr() * factor(*m).powi(2)).sum::<f64>().sqrt()
                };
                let mean = if trial % 5 == 0 { next() } else { 0.0 };
                let (size, rate) = (rms(false).hypot(mean), rms(true));
                let of_answer = law.answer(&sigma, &1.0, &gains.means);
                let least = |by_size: f64, by_rate: f64| (by_size * size).min(by_rate * rate);
                let at_samples = least(gains.sup, gains.sup_by_rate);
                let bounds = [
                    at_samples,
                    at_samples + gains.between * rate,
                    least(gains.rms, gains.rms_by_rate) + gains.between_rms * rate,
                    least(gains.rate, gains.rate_by_rate),
                    z(&gains, &law, &data, [size, rate], &pairs),
                    of_answer.mean * mean.abs() + of_answer.by_rate * rate,
                ];
                let found = answer(&data, &law, (sigma, b, n_o), (mean, &q));
                // The bounds for these oscillators alone.
                let own = &by_count[n_o as usize];
                let own_at_samples = least(own.sup, own.sup_by_rate);
                let own_bounds = [
                    own_at_samples,
                    own_at_samples + own.between * rate,
                    least(own.rms, own.rms_by_rate) + own.between_rms * rate,
                ];
                for ((found, own), bound) in found.iter().zip(own_bounds).zip(bounds) {
                    // Where no harmonic is left e vanishes at the samples, up to rounding.
                    assert!(
                        *found <= own * (1.0 + 1e-3) + 1e-9,
                        "{samples} {mu} {low} {high} {product} {trial}: {found} {own}"
                    );
                    assert!(own <= bound * (1.0 + 1e-12), "{own} {bound}");
                    if n_o > 0 && !delayed {
                        own_worst = own_worst.max(found / own);
                        own_gain = own_gain.min(own / bound);
                    }
                }
                for ((found, bound), worst) in found.iter().zip(bounds).zip(&mut *worst) {
                    assert!(
                        found <= &(bound * (1.0 + 1e-3)),
                        "{samples} {mu} {low} {high} {product} {trial}: {found} {bound}"
                    );
                    *worst = worst.max(found / bound);
                }
            }
        }
    }
    // None of the bounds is idle, and more oscillators lower them.
    assert!(own_worst > 0.6 && own_gain < 0.3, "{own_worst} {own_gain}");
    assert!(seen >= 40, "{seen}");
    for worst in [worst, with_gain] {
        let least = [0.6, 0.6, 0.6, 0.6, 0.6, 0.3];
        assert!(worst.iter().zip(least).all(|(ratio, least)| *ratio > least), "{worst:?}");
    }
    // 1 + h sigma, and |b1| for b1 E^-1, lose something.
    assert!(
        with_delay.iter().zip([0.5, 0.5, 0.5, 0.5, 0.5, 0.2]).all(|(ratio, least)| *ratio > least),
        "{with_delay:?}"
    );
}

/// Z for the best pair (k0, k1).
fn z(
    gains: &SampledGains<f64>,
    law: &SampledLaw<f64>,
    data: &Data<'_>,
    [size, rate]: [f64; 2],
    pairs: &[(f64, f64, u32)],
) -> f64 {
    let w = data.base_frequency.midpoint_f64();
    if let Some(swing) = gains.swing {
        // T = 1.
        let of = |(k0, k1, _): &(f64, f64, u32)| k0 / (w * w) * size * size + k1 / w.powi(4) * rate * rate;
        let mean = pairs.iter().map(of).fold(f64::INFINITY, f64::min);
        return (swing * size * size + gains.enlarged.powi(2) * mean).sqrt();
    }
    let of = |(k0, k1, _): &(f64, f64, u32)| {
        (1.0 / (2.0 * law.mu) + k0 / (w * w)) * size * size + k1 / w.powi(4) * rate * rate
    };
    gains.enlarged * pairs.iter().map(of).fold(f64::INFINITY, f64::min).sqrt()
}

/// What one harmonic may make of e with an input gain is reached: at the worst point of the line that 1 + b K h G runs over, at an end
/// of b; theta counts for the largest gain.
#[test]
fn the_factors_of_an_input_gain_are_reached() {
    let (mut largest, mut control) = ([0.0_f64; 2], 0.0_f64);
    for (low, high) in [("0.8", "1"), ("1", "1.25"), ("0.5", "1.5"), ("0.1", "1")] {
        for mu in ["1/1000", "40"] {
            let spec = example(24, mu, |file| {
                file["input_gain"] = json!({ "nominal": 1, "low": low, "high": high });
            });
            let data = Data::new(&spec, 128);
            let law = law(&data).to_f64();
            let ends = [low, high].map(|end| end.parse::<f64>().unwrap());
            for (product, (j, sine)) in [0.05, 0.4, 1.0]
                .into_iter()
                .flat_map(|product| (1..).zip(law.sines.iter()).map(move |at| (product, at)))
            {
                let sigma = product / law.step;
                let size = sigma * sigma + (1.0 - product) * law.frequency_squared(sine);
                let gain = law.input_gain.clone().unwrap();
                let of_y = Worst::new(&gain).take(&law, &sigma, [sine, &size]);
                // b_hi K h Nb2 is 2 or more, or a denominator may vanish.
                if of_y.is_nan() {
                    continue;
                }
                let factor = (of_y / size).sqrt();
                let d = (Complex::new(0.0, PI * f64::from(2 * j) / 24.0).exp() - (1.0 - product)) / law.step;
                for (end, b) in ends.into_iter().enumerate() {
                    let beta = b * law.load() / ends[1] / 2.0;
                    // Where the line comes nearest.
                    let at = |eta: f64| d * Complex::new(1.0 - beta, eta) - (1.0 - b) * sigma;
                    let nearest = -(at(0.0) * (Complex::<f64>::i() * d).conj()).re / size;
                    for eta in [nearest, nearest + 0.1, nearest - 3.0] {
                        let e = 1.0 / at(eta);
                        let found = e.norm();
                        assert!(found <= factor * (1.0 + 1e-9), "{low} {high} {mu} {product} {j} {b}");
                        // b u = (E - 1) e/h - q.
                        let u = ((d - sigma) * e - 1.0).norm() / b;
                        let most = law.answer(&sigma, &1.0, &(factor * size.sqrt())).harmonic;
                        assert!(u <= most * (1.0 + 1e-9), "{low} {high} {mu} {product} {j} {b}: {u} {most}");
                        control = control.max(u / most);
                        // With little theta it makes no difference of which gain it is.
                        if mu == "1/1000" || end == 1 {
                            largest[end] = largest[end].max(found / factor);
                        }
                    }
                }
            }
        }
    }
    assert!(largest.iter().all(|ratio| *ratio > 0.9999), "{largest:?}");
    assert!(control > 0.75, "{control}");
}

/// Without an interval there are no factors of one; where a denominator may vanish nothing is known of what rests on it.
#[test]
fn an_interval_that_is_too_wide_has_no_bounds() {
    let of = |low: &str, high: &str| {
        let spec = example(24, "1", |file| {
            file["input_gain"] = json!({ "nominal": 1, "low": low, "high": high });
        });
        let data = Data::new(&spec, 128);
        let law = law(&data);
        SampledGains::new(&law, &(data.rational(&rug::Rational::from(24))), &data.period)
    };
    assert!(of("1", "1").room.is_none());
    let good = of("0.5", "1.5");
    assert!(good.room.unwrap().is_certainly_positive() && !good.sup.is_unknown());
    // What drives zeta is q + (1-b) sigma e: at h sigma = 1, the largest F_j is at j = 1, and sigma F_j at most 1/(1/(1+theta) - 1/2).
    let plain = of("1", "1");
    let (excess, share) = ((&good.enlarged / &plain.enlarged).midpoint_f64(), (&good.rms * 24).midpoint_f64());
    assert!(share > 1.9 && share < 3.0 && excess > 1.0 + 0.5 * share && excess < 1.3 * (1.0 + 0.5 * share));
    // h sigma = 1, where (2 - h sigma)/(1 + theta) > (b_hi - 1) h sigma: b_hi below 2.
    let wide = of("0.5", "2.2");
    assert!(!wide.room.unwrap().is_certainly_positive());
    for unknown in [&wide.sup, &wide.sup_by_rate, &wide.rms, &wide.rate, &wide.means, &wide.enlarged] {
        assert!(unknown.is_unknown());
    }
    // The bounds by the mean square of y do not rest on it.
    assert!(!wide.sup_of_means.is_unknown() && !wide.rate_of_means.is_unknown());
}

/// The closed forms of the sums where theta plays no part: those of the resolvent at samples.
#[test]
fn the_sums_have_their_closed_forms() {
    let spec = example(40, "1/1000000", |_| ());
    let data = Data::new(&spec, 128);
    let law = law(&data).to_f64();
    let (h, t, n) = (law.step, data.numbers().period.midpoint_f64(), 40);
    for sigma in [0.5, 7.0, 39.0] {
        let gains = SampledGains::new(&law, &sigma, &t);
        let a = 1.0 - h * sigma;
        let power = a.powi(n);
        let sup = t * (1.0 + power) / (sigma * (2.0 - h * sigma) * (1.0 - power)) - 1.0 / (sigma * sigma);
        let by_rate = ((t * t - h * h) / 12.0 - a * sup) / (sigma * sigma);
        assert!((gains.sup.powi(2) / sup - 1.0).abs() < 1e-5, "{sigma}");
        assert!((gains.sup_by_rate.powi(2) / by_rate - 1.0).abs() < 1e-4, "{sigma}");
        let first = 2.0 / h * (PI / 40.0).sin();
        assert!((gains.rms - 1.0 / (sigma * sigma + a * first * first).sqrt()).abs() < 1e-5 * gains.rms, "{sigma}");
    }
}
