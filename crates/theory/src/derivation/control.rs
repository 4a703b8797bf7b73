//! How large the control gets (derivation, 13.5), at the gain of a claim; it grows with the gain, so of a larger one nothing is said.
//!
//! Inside of this file u is the control of the law; what an actuator with an input gain is given is that over its nominal value.

use super::condition::Condition;
use super::harmonics::AtOrigin;
use super::joint;
use super::mean_squares::Forcing;
use crate::data::{Data, Numbers, Problem};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};
use sigmastar_lang::spec::JointStability;

/// Bounds of the |u| that is put out, for every n_o.
#[derive(Clone, Debug)]
pub struct Control<R> {
    /// Of |u| along the periodic solution.
    pub steady: R,
    /// Of |u - u_per(t)| of every solution from the claimed set, at all times.
    pub transient: R,
}

impl<R: Real> Control<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Of the u that is put out: of the law's over the nominal input gain, where there is one.
    #[must_use]
    pub fn over(self, nominal: Option<&R>) -> Control<R> {
        match nominal {
            Some(nominal) => Control { steady: &self.steady / nominal, transient: &self.transient / nominal },
            None => self,
        }
    }
}

impl Control<Enclosure> {
    /// (C6), where the specification has an actuator. Hypothesis: these bound what is put out.
    ///
    /// Guarantee: of every solution from the claimed set what is put out is never larger than the actuator takes, at this gain. So it is the
    /// solution of the loop with the saturation, too.
    #[must_use]
    pub fn condition(&self, data: &Data<'_>) -> Option<Condition> {
        let actuator = data.spec.actuator.as_ref().filter(|actuator| !actuator.by_count)?;
        let max = actuator.max.enclose(data.precision);
        Some(Condition::at_most("C6", "steady + transient <= max of the actuator", &self.steady + &self.transient, max))
    }
}

/// What the control makes of the harmonics of q but for the mean, which it answers by its opposite.
#[derive(Clone, Debug)]
pub struct Answer<R> {
    /// |u_0| over |q_0|.
    pub mean: R,
    /// F: |u_j| <= F |q_j|.
    pub harmonic: R,
    /// Of the sum of all |u_j| over rms(q').
    pub by_rate: R,
}

impl<R: Real> Answer<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// In continuous time F = 2/sqrt(3) and `F T/sqrt(12) = T/3`, by Cauchy-Schwarz; with an input gain b_lo stands for b in
    /// F = sqrt(1 + 2/(4b - 1 + sqrt(1 + 8b)))/b and in 1/b, both of which fall in b.
    ///
    /// u_j = (P S - 1) q_j where P = i om/(i om + sigma) and S both are on the circle |z - 1/2| = 1/2.
    #[must_use]
    pub fn continuous(problem: &impl Problem<R>) -> Answer<R> {
        let Numbers { period, input_gain, .. } = problem.numbers();
        let Some(gain) = input_gain else {
            return Answer { mean: R::int(1), harmonic: R::int(2) / R::int(3).sqrt(), by_rate: period / R::int(3) };
        };
        let b = &gain.low;
        let more = R::int(2) / (R::int(4) * b - R::int(1) + (R::int(1) + R::int(8) * b).sqrt());
        let harmonic = (R::int(1) + more).sqrt() / b;
        Answer { mean: R::int(1) / b, by_rate: &harmonic * period / R::int(12).sqrt(), harmonic }
    }

    /// min{ m_0 + F' R_1, m_0 + F 2 sum_{k>=1} C_k + F' (r_1 + d_1), `by_parts` } with m_0 = min{ R_q, C_0 + r_0 + d_0 }, where `by_parts`
    /// bounds |u| by the sizes of e and zeta.
    ///
    /// Hypothesis: `forcing` bounds q along the periodic solution. Guarantee: |u| of that solution is not larger.
    #[must_use]
    pub fn steady(&self, origin: &AtOrigin<R>, forcing: &Forcing<R>, by_parts: &R) -> R {
        let Answer { mean: of_mean, harmonic, by_rate } = self;
        let Forcing { q_rms, q_rate_rms, change: [change, change_rate] } = forcing;
        let Some(known) = &origin.known else { return (of_mean * q_rms + by_rate * q_rate_rms).min_known(by_parts) };
        let mean = of_mean * &q_rms.min_known(&(&known.mean + &known.rest_rms + change));
        let superposed = harmonic * &known.sum + by_rate * (&known.rest_t_rms + change_rate);
        (&mean + by_rate * q_rate_rms).min_known(&(&mean + superposed)).min_known(by_parts)
    }
}

/// `sigma e_per + mu Nbar Z`, from u = -sigma e + mu M'N zeta and |M'N zeta| <= Nbar |zeta|_N; at samples with K for mu.
#[must_use]
pub fn by_parts<R: Real>(problem: &impl Problem<R>, [sigma, mu]: [&R; 2], [e_per, z]: [&R; 2]) -> R
where
    for<'a> &'a R: Operand<R>,
{
    sigma * e_per + mu * &problem.numbers().n_bar * z
}

/// How far a solution from the claimed set is from the periodic one, at all times.
#[derive(Clone, Debug)]
pub struct Reach<R> {
    /// Of |e - e_per(t)|.
    pub error: R,
    /// Of |u - u_per(t)|.
    pub transient: R,
}

impl<R: Real> Reach<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// What bounds both.
    #[must_use]
    pub fn max(self, other: &Reach<R>) -> Reach<R> {
        Reach { error: self.error.max(&other.error), transient: self.transient.max(&other.transient) }
    }
}

/// h (sigma + K Nb2)^2/gm, for |b1| <= Nb2: what the last y has in the control of a law with a delay,
/// u = -sigma e + K M'N R zeta + h (sigma + K b1) y_last, where U + gm h y_last^2 stays below its value at the start.
#[must_use]
pub fn of_past<R: Real>([sigma, gain]: [&R; 2], [step, weight_sum]: [&R; 2], gm: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    step * (sigma + gain * weight_sum).sqr() / gm
}

/// sqrt(L_0) and sqrt(L_0 (sigma^2 + mu^2 Nbar^2/h)), by Cauchy-Schwarz: U = w_x x'P x + e^2 + h |zeta|_N^2 stays below its value L_0 at the
/// start. At samples K stands for mu, and eta for h, and U does so between them, too. With a delay [`of_past`] is added to the square, and L_0 is that
/// of U + gm h y_last^2.
#[must_use]
pub fn reach<R: Real>(
    problem: &impl Problem<R>,
    [sigma, mu]: [&R; 2],
    h: &R,
    (level, past): (&R, Option<&R>),
) -> Reach<R>
where
    for<'a> &'a R: Operand<R>,
{
    let squares = sigma.sqr() + (mu * &problem.numbers().n_bar).sqr() / h;
    let squares = past.map_or_else(|| squares.clone(), |past| &squares + past);
    let transient = (level * squares).sqrt();
    Reach { error: level.sqrt(), transient }
}

/// How far |et| and |ut| reach by the metric `lam Pi_1 + (1 - lam) Pi_2`, lam = threshold/sigma (section 13.7, (Jm)): sqrt(V_0/e_low) and
/// sqrt(V_0 (sigma^2/e_low + 2 mu Nbar^2/k_p)), where V_0 is not above that share of both left sides of C4, and e_low and k_p are that share of both.
#[must_use]
pub fn joint_reach<R: Real>(
    problem: &impl Problem<R>,
    JointStability { inequality, levels }: &JointStability,
    number: impl Fn(&Rational) -> R,
    sigma: &Rational,
    distances: [&R; 3],
) -> Reach<R>
where
    for<'a> &'a R: Operand<R>,
{
    let Numbers { mu, n_bar, .. } = problem.numbers();
    let near = Rational::from(&inequality.value / sigma);
    let shares = [number(&near), number(&(1 - near))];
    let both = inequality.metrics().into_iter().zip(levels).zip(&shares);
    let [mut start, mut e_low, mut k_p] = [0, 1, 2].map(|_| problem.zero());
    for ((metric, level), share) in both {
        start = start + share * joint::at_the_start(problem, (metric, level), &number, distances);
        e_low = e_low + share * number(&level.e_low);
        k_p = k_p + share * number(&metric.k_p);
    }
    let sigma = number(sigma);
    let transient = (&start * (sigma.sqr() / &e_low + R::int(2) * (mu * n_bar.sqr()) / k_p)).sqrt();
    Reach { error: (start / e_low).sqrt(), transient }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Data;
    use crate::derivation::sampled::SampledLaw;
    use crate::derivation::sampled::examples::{example, law};
    use num_complex::Complex;
    use serde_json::json;
    use sigmastar_exact::enclosure::Enclosure;
    use std::f64::consts::{PI, TAU};

    /// Numbers in [-1, 1) that are the same in every run.
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 40) as f64 / 2f64.powi(23) - 1.0
        }

        fn exponential(&mut self, largest: f64) -> f64 {
            (self.next() * largest.ln()).exp()
        }
    }

    /// c_l for |l| <= n_o, with weights (1 + l)^-2.
    fn poles(n_o: i32) -> impl Iterator<Item = (i32, f64)> {
        (-n_o..=n_o).map(|l| (l, if l == 0 { 1.0 } else { 0.5 / f64::from(1 + l.abs()).powi(2) }))
    }

    /// |u_j|/|q_j| by the equations of the loop: y + mu G y = q, e = y/(i om + sigma), u = -sigma e + y - q.
    #[test]
    fn harmonics_in_continuous_time() {
        let (mut random, mut worst) = (Random(5), 0.0_f64);
        let i = Complex::<f64>::i();
        for _ in 0..40_000 {
            let (sigma, mu, om) = (random.exponential(1e3), random.exponential(1e3), random.exponential(30.0));
            let n_o = (random.next().abs() * 4.0) as i32;
            let g: Complex<f64> = poles(n_o).map(|(l, c)| c / (i * (om - f64::from(l)))).sum();
            let y = 1.0 / (1.0 + mu * g);
            let e = y / (i * om + sigma);
            worst = worst.max((y - 1.0 - sigma * e).norm());
        }
        let spec = example(2, "1", |_| ());
        let data = Data::new(&spec, 128);
        let Answer { harmonic, by_rate, .. } = Answer::continuous(&data);
        let [factor, by_rate, period] = [&harmonic, &by_rate, &data.period].map(Enclosure::midpoint_f64);
        assert!((by_rate - factor * period / 12f64.sqrt()).abs() < 1e-12);
        assert!(worst <= factor * (1.0 + 1e-9) && worst > 0.995 * factor, "{worst} {factor}");
    }

    /// The answer to harmonics with an input gain: u = (y - q - sigma e)/b.
    #[test]
    fn harmonics_with_an_input_gain() {
        let spec = example(2, "1", |file| file["input_gain"] = json!({ "nominal": 1, "low": "0.4", "high": "3" }));
        let Answer { mean, harmonic, .. } = Answer::continuous(&Data::new(&spec, 128));
        let (mut random, mut worst) = (Random(9), 0.0_f64);
        let i = Complex::<f64>::i();
        for _ in 0..40_000 {
            let (sigma, eta) = (random.exponential(1e2), random.next() * random.exponential(1e2));
            let b = 0.4 + (1.3 * (1.0 + random.next())).min(2.6) * f64::from(u8::from(random.next() > 0.5));
            let e = 1.0 / (i + b * sigma + i * eta * (i + sigma));
            worst = worst.max((i * e - 1.0).norm() / b);
        }
        let factor = harmonic.midpoint_f64();
        assert!(worst <= factor * (1.0 + 1e-9) && worst > 0.99 * factor, "{worst} {factor}");
        assert!((mean.midpoint_f64() - 2.5).abs() < 1e-12);
    }

    /// The answer to harmonics at samples, for every load K h Nb2 and every h sigma: (12.1).
    #[test]
    fn harmonics_at_samples() {
        let (mut random, mut worst) = (Random(7), [0.0_f64; 2]);
        let spec = example(2, "1", |_| ());
        let known = law(&Data::new(&spec, 128)).to_f64();
        for trial in 0..40_000 {
            let n_o = (random.next().abs() * 4.0) as i32;
            let sum: f64 = poles(n_o).map(|(_, c)| c).sum();
            let load = 1.9 * random.next().abs();
            let product = random.next().abs();
            let samples = 2 * n_o + 2 + (random.next().abs() * 30.0) as i32;
            // A harmonic that the oscillators leave, or any real frequency.
            let phi = if trial % 2 == 0 { TAU * f64::from(n_o + 1) / f64::from(samples) } else { PI * random.next() };
            let point = |angle: f64| Complex::from_polar(1.0, angle);
            let angle = |l: i32| phi - TAU * f64::from(l) / f64::from(samples);
            let h: Complex<f64> = poles(n_o).map(|(l, c)| c / sum / (point(angle(l)) - 1.0)).sum();
            let y = 1.0 / (1.0 + load * h);
            let found = (y * (point(phi) - 1.0) / (point(phi) - (1.0 - product)) - 1.0).norm();
            let g = 2.0 / ((2.0 - product) * (1.0 - load / 2.0));
            let of = SampledLaw { step: 1.0, enlarged: 1.0 / (1.0 - load / 2.0), ..known.clone() };
            let Answer { harmonic: factor, by_rate, .. } = of.answer(&product, &f64::from(samples), &of.enlarged);
            let sum: f64 = (1..samples).map(|j| (2.0 * (PI * f64::from(j) / f64::from(samples)).sin()).powi(-2)).sum();
            assert!((by_rate / (factor * sum.sqrt()) - 1.0).abs() < 1e-9);
            assert!(found <= factor * (1.0 + 1e-6), "{n_o} {load} {product} {phi}: {found} {factor}");
            let branch = usize::from(g > 3.0);
            worst[branch] = worst[branch].max(found / factor);
        }
        assert!(worst.iter().all(|share| *share > 0.97), "{worst:?}");
    }
}
