//! Constants k0, k1 for the regulator at samples: finitely many harmonics (derivation, 12.2).

use super::law::SampledLaw;
use crate::data::Data;
use crate::derivation::condition::Condition;
use crate::transfer::{TradeOff, decide_steps};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// Up to this harmonic the sum s_j is evaluated; from there on, its bound.
const SUMMED: u32 = 64;

/// Where the sum is over every |l| < N_s/2, up to so many times j they are added one by one; beyond, and above these, by their largest weight.
const NEAR: u32 = 4;

/// k0 and k1, to be held against every harmonic that samples can have.
pub struct SampledPair<'p> {
    /// The law.
    pub law: &'p SampledLaw<Enclosure>,
    /// k0.
    pub k0: &'p Rational,
    /// k1.
    pub k1: &'p Rational,
}

impl SampledPair<'_> {
    /// `k0 >= 1/(nu^2 n_0)` and `k0 + k1 (om_j/w)^2 >= max{ 2/(nu^2 n_j), s_j }` for j = 1, ..., floor(N_s/2), as one condition:
    /// the first one that is not proved, or that of j = 0.
    ///
    /// Hypotheses: W1 to W3, w = 2 pi/T. Guarantee: where it holds, the mean of |zeta_k|_N^2 is at most
    /// (1+theta)^2 (k0 R_q^2/w^2 + k1 R_1^2/w^4), for every n_o < N_s/2; of a law for every set of harmonics, for each of these below N_s/2, as s_j is
    /// that of (14.7a) then.
    #[must_use]
    pub fn condition(&self, data: &Data<'_>) -> Condition {
        let needs = Needs::new(data, self.law);
        let (k0, k1) = (data.rational(self.k0), data.rational(self.k1));
        let step =
            |what: String, lhs, rhs| Condition::at_most("T", format!("transfer bound, sampled: {what}"), lhs, rhs);
        let at_zero = step("1/(nu^2 n_0) <= k0".to_owned(), needs.at_zero(), k0.clone());
        let steps = (1..).zip(self.law.sines.iter()).flat_map(|(j, sine)| {
            let rhs = &k0 + &k1 * needs.square(sine);
            let own = step(format!("2/(nu^2 n_{j}) <= k0 + k1 (om_{j}/w)^2"), needs.own(j), rhs.clone());
            let others = needs.of_others(j, &rhs);
            [own, step(format!("s_{j} <= k0 + k1 (om_{j}/w)^2"), others, rhs)]
        });
        let (truth, found) = decide_steps(std::iter::once(at_zero.clone()).chain(steps), at_zero.clone());
        if truth.is_true() { at_zero } else { found }
    }
}

/// What k0 + k1 (om_j/w)^2 has to reach.
struct Needs<'n, 's> {
    data: &'n Data<'s>,
    law: &'n SampledLaw<Enclosure>,
    /// 1/nu^2.
    inverse: Enclosure,
    /// The first weights, which all sums take.
    weights: Vec<Enclosure>,
}

impl<'n, 's> Needs<'n, 's> {
    fn new(data: &'n Data<'s>, law: &'n SampledLaw<Enclosure>) -> Needs<'n, 's> {
        let weight = |l: u32| data.spec.internal_model.weights.weight(u64::from(l), data.precision);
        let kept = if law.every_set { NEAR * SUMMED } else { SUMMED };
        let weights = (0..=kept.min(law.samples / 2) + 1).map(weight).collect();
        Needs { data, law, inverse: law.nu(data).sqr().recip(), weights }
    }

    fn weight(&self, l: u32) -> Enclosure {
        let own = || self.data.spec.internal_model.weights.weight(u64::from(l), self.data.precision);
        self.weights.get(l as usize).cloned().unwrap_or_else(own)
    }

    /// 1/(nu^2 n_0).
    fn at_zero(&self) -> Enclosure {
        &self.inverse / &self.data.n_0
    }

    /// (om_j/w)^2.
    fn square(&self, sine: &Enclosure) -> Enclosure {
        self.law.frequency_squared(sine) / self.data.base_frequency.sqr()
    }

    /// 2/(nu^2 n_j).
    fn own(&self, j: u32) -> Enclosure {
        2 * &self.inverse / self.weight(j)
    }

    /// s_j = (wh/2)^2 sum c_l/sin^2((j-l)wh/2) over |l| < j, for every set over |l| < N_s/2 with |l| != j, or a bound of it: the first of these that is at most `enough`, else the
    /// sum.
    fn of_others(&self, j: u32, enough: &Enclosure) -> Enclosure {
        let crude = self.law.pi.sqr() / 4 * &self.law.weight_sum;
        if crude.le(enough).is_true() {
            return crude;
        }
        if j > SUMMED {
            return crude.min(&self.in_halves(j));
        }
        self.sum(j)
    }

    /// (pi^2/4) (4 Nb2/j^2 + (pi^2/6) n_ceil(j/2)): |sin x| >= 2|x|/pi, and |l| below and above j/2.
    fn in_halves(&self, j: u32) -> Enclosure {
        let quarter = self.law.pi.sqr() / 4;
        let square = Enclosure::from_integer(i64::from(j) * i64::from(j), self.data.precision);
        let near = self.law.pi.sqr() / 6 * self.weight(j.div_ceil(2));
        quarter * (4 * &self.law.weight_sum / square + near)
    }

    fn sum(&self, j: u32) -> Enclosure {
        let samples = self.law.samples;
        // sin^2(pi d/N_s), d from 1 to N_s - 1; there is one for each.
        let sine = |d: u32| &self.law.sines[d.min(samples - d) as usize - 1];
        let mut sum = self.data.n_0.clone() / sine(j);
        // The largest l below N_s/2.
        let largest = (samples - 1) / 2;
        let last = if self.law.every_set { largest.min(NEAR * j) } else { j - 1 };
        for l in (1..=last).filter(|l| *l != j) {
            sum = sum + self.weight(l) / 2 * (sine(j.abs_diff(l)).clone().recip() + sine(j + l).clone().recip());
        }
        let half = self.data.base_frequency.clone() * &self.law.step / 2;
        let near = half.sqr() * sum;
        match self.law.every_set && last < largest {
            true => near + self.law.pi.sqr() / 6 * self.weight(last + 1),
            false => near,
        }
    }
}

/// The pairs (k0, k1) of the trade-off, in doubles: the edges of the upper hull of what is needed over (om_j/w)^2.
#[must_use]
pub fn sampled_trade_off(data: &Data<'_>, law: &SampledLaw<Enclosure>) -> TradeOff {
    let needs = Needs::new(data, law);
    let nothing = data.zero();
    let points = (1..).zip(law.sines.iter()).map(|(j, sine)| {
        let need = needs.own(j).max(&needs.of_others(j, &nothing));
        (needs.square(sine).midpoint_f64(), need.upper_f64())
    });
    let mut hull: Vec<(f64, f64)> = Vec::new();
    let slope = |a: (f64, f64), b: (f64, f64)| (b.1 - a.1) / (b.0 - a.0);
    for point in std::iter::once((0.0, needs.at_zero().upper_f64())).chain(points) {
        while let [.., before, last] = hull[..]
            && slope(before, last) <= slope(last, point)
        {
            hull.pop();
        }
        hull.push(point);
    }
    // Lines through edges that rise; and the level one through the highest point.
    let rising = hull.windows(2).filter_map(|edge| {
        let k1 = slope(edge[0], edge[1]);
        (k1 > 0.0).then(|| (edge[0].1 - k1 * edge[0].0, k1, 0))
    });
    let level = hull.iter().map(|point| point.1).fold(0.0, f64::max);
    let at_zero = hull.first().map_or(0.0, |point| point.1);
    // Each reaches its edge only up to rounding.
    let raised = |(k0, k1, k): (f64, f64, u32)| (k0.max(at_zero) * (1.0 + 1e-12), k1 * (1.0 + 1e-12), k);
    TradeOff { candidates: rising.chain([(level, 0.0, 0)]).map(raised).collect(), slack: 0.0 }
}

/// s_j by its sum, for tests of the bounds.
#[cfg(test)]
mod tests {
    use super::*;
    use crate::derivation::sampled::examples::{example, law};

    /// T_d(j) of 12.2 for n_o oscillators, by its definition, in doubles and in units of 1/w^2.
    fn mean_gain(law: &SampledLaw<f64>, data: &Data<'_>, n_o: i64, j: i64) -> f64 {
        let weights = &data.spec.internal_model.weights;
        let unit = std::f64::consts::PI / f64::from(law.samples);
        let c = |l: i64| weights.weight_f64(l.unsigned_abs()) * if l == 0 { 1.0 } else { 0.5 };
        let w = data.base_frequency.midpoint_f64();
        if j <= n_o {
            return w * w / (law.gain * law.gain * c(j));
        }
        let at = |l: i64| (j - l) as f64 * unit;
        let squares: f64 = (-n_o..=n_o).map(|l| c(l) / at(l).sin().powi(2)).sum();
        let cotangents: f64 = (-n_o..=n_o).map(|l| c(l) / at(l).tan()).sum();
        let b: f64 = (-n_o..=n_o).map(c).sum();
        let (k, h) = (law.gain, law.step);
        w * w * h * h / 4.0 * squares / ((1.0 - k * h * b / 2.0).powi(2) + (k * h / 2.0 * cotangents).powi(2))
    }

    #[test]
    fn every_pair_of_the_trade_off_is_proved_and_bounds_every_harmonic() {
        for (samples, mu) in [(2, "1"), (7, "1"), (40, "1"), (41, "60"), (200, "1/5"), (300, "40")] {
            let spec = example(samples, mu, |_| ());
            let data = Data::new(&spec, 128);
            let law = law(&data);
            let float = law.to_f64();
            let trade_off = sampled_trade_off(&data, &law);
            assert!(!trade_off.candidates.is_empty());
            for (k0, k1, _) in trade_off.candidates {
                let up = |value: f64| Rational::from_f64(value * (1.0 + 1e-9)).unwrap();
                let (k0, k1) = (up(k0), up(k1));
                let pair = SampledPair { law: &law, k0: &k0, k1: &k1 };
                let condition = pair.condition(&data);
                assert!(condition.truth().is_true(), "{samples} {mu}: {}", condition.what);
                let bound = |j: i64| {
                    let sine = if j == 0 { 0.0 } else { float.sines[j as usize - 1] };
                    let square = float.frequency_squared(&sine) / data.base_frequency.midpoint_f64().powi(2);
                    float.enlarged.powi(2) * (k0.to_f64() + k1.to_f64() * square)
                };
                for n_o in [0, 1, i64::from((samples - 1) / 2) / 2, i64::from((samples - 1) / 2)] {
                    for j in 0..=i64::from(samples / 2) {
                        let gain = mean_gain(&float, &data, n_o, j);
                        assert!(gain <= bound(j) * (1.0 + 1e-9), "{samples} {mu} n_o = {n_o}, j = {j}");
                    }
                }
            }
        }
    }

    /// Of every set: what the pairs are held against bounds `T_d(j)` of sets with gaps, where that of the first n_o does not.
    #[test]
    fn pairs_for_every_set_bound_sets_with_gaps() {
        let own = |samples: u32, mu: &str, sets: bool, harmonics: &[i64]| {
            let spec = example(samples, mu, |file| {
                if sets {
                    file["internal_model"]["harmonics"] = serde_json::json!("every-set");
                }
            });
            let data = Data::new(&spec, 128);
            let law = law(&data);
            let (float, needs) = (law.to_f64(), Needs::new(&data, &law));
            let unit = std::f64::consts::PI / f64::from(samples);
            let c =
                |l: i64| data.spec.internal_model.weights.weight_f64(l.unsigned_abs()) * if l == 0 { 1.0 } else { 0.5 };
            let poles: Vec<i64> =
                harmonics.iter().flat_map(|l| if *l == 0 { vec![0] } else { vec![*l, -*l] }).collect();
            let b: f64 = poles.iter().map(|l| c(*l)).sum();
            let (k, h, w) = (float.gain, float.step, data.base_frequency.midpoint_f64());
            let shares = (1..=i64::from(samples / 2)).filter(|j| !harmonics.contains(j)).map(|j| {
                let at = |l: i64| (j - l) as f64 * unit;
                let squares: f64 = poles.iter().map(|l| c(*l) / at(*l).sin().powi(2)).sum();
                let cotangents: f64 = poles.iter().map(|l| c(*l) / at(*l).tan()).sum();
                let own = w * w * h * h / 4.0 * squares
                    / ((1.0 - k * h * b / 2.0).powi(2) + (k * h / 2.0 * cotangents).powi(2));
                own / (float.enlarged.powi(2) * needs.sum(j as u32).upper_f64())
            });
            shares.fold(0.0, f64::max)
        };
        for (samples, mu) in [(9, "1"), (40, "1/50"), (41, "1"), (400, "1/5")] {
            for harmonics in [&[0, 2][..], &[0, 3], &[0, 1, 4], &[0, 2, 4]] {
                let share = own(samples, mu, true, harmonics);
                assert!(share <= 1.0 + 1e-9, "{samples} {mu} {harmonics:?}: {share}");
            }
        }
        // The sum over |l| < j leaves out the oscillators above j, which sets with gaps have.
        assert!(own(40, "1/50", false, &[0, 2]) > 1.0);
    }

    #[test]
    fn smaller_pairs_are_refused() {
        let spec = example(60, "1", |_| ());
        let data = Data::new(&spec, 128);
        let law = law(&data);
        let refused = |k0: f64, k1: f64| {
            let [k0, k1] = [k0, k1].map(|value| Rational::from_f64(value).unwrap());
            let condition = SampledPair { law: &law, k0: &k0, k1: &k1 }.condition(&data);
            (condition.truth().is_false(), condition.what)
        };
        for (k0, k1, _) in sampled_trade_off(&data, &law).candidates {
            assert!(refused(k0 * (1.0 - 1e-6), k1 * (1.0 - 1e-6)).0);
        }
        let (truth, what) = refused(data.transfer_at_zero().upper_f64() * 1.001, 1e-9);
        assert!(truth && what.contains("n_1"), "{what}");
        let (truth, what) = refused(0.1, 1e9);
        assert!(truth && what.contains("n_0"), "{what}");
    }

    #[test]
    fn what_is_left_of_a_harmonic_is_bounded() {
        let spec = example(400, "40", |_| ());
        let data = Data::new(&spec, 128);
        let law = law(&data);
        let needs = Needs::new(&data, &law);
        let crude = law.pi.sqr() / 4 * &law.weight_sum;
        for j in 1..=200 {
            let sum = needs.sum(j);
            assert!(sum.le(&crude).is_true() && sum.le(&needs.in_halves(j)).is_true(), "{j}");
        }
    }
}
