//! What an oscillator leaves of a harmonic whose frequency is not exactly its own (derivation, 13.3).

use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// The harmonics that are looked at: an oscillator beyond them is taken to be of no use, which is true of any.
pub const MAX_TUNED: usize = 256;

/// The least mistuning that is counted with, as a power of two; so that it is positive.
const LEAST_EXPONENT: u32 = 100;

/// How far the oscillators are from the harmonics, and what they leave of these.
#[derive(Clone, Debug)]
pub struct Mistuning {
    /// dm, not below `|Om/w - 1|` for every period T that there may be, Om = 2 pi/T.
    pub largest: Enclosure,
    /// For k = 1, 2, ... the factor s_k < 1, as far as there is one: with n_o >= k oscillators, and any such number, the harmonic k
    /// of the answer e to q is at most s_k times the bound that it has with none.
    pub factors: Vec<Enclosure>,
}

impl Mistuning {
    /// Evaluates the factors; `None` at a matched base frequency, which takes the harmonics away.
    ///
    /// Hypotheses: W1, W2. With an input gain s_k is Sb_k b_m/c_m, for without an oscillator the harmonic is bounded by
    /// `|q_k|/(b_m sg_k)` and with it by `Sb_k |q_k|/(c_m sg_k)` (13.1).
    #[must_use]
    pub fn new(data: &Data<'_>) -> Option<Mistuning> {
        if data.matched {
            return None;
        }
        let away = |omega: &Enclosure| (omega / &data.base_frequency - 1).abs();
        let least = data.rational(&(Rational::from(1) >> LEAST_EXPONENT));
        let largest = away(&data.fundamental).max(&away(&data.fastest)).max(&least).ceiling();
        let mut tuning = Tuning { data, largest: &largest, weights: Vec::new() };
        let relative = data.input_gain.as_ref().map(|gain| gain.of_error() / gain.of_steady_state());
        let factors = (1..=MAX_TUNED).map_while(|k| {
            let left = tuning.left(k)?;
            let left = relative.as_ref().map_or_else(|| left.clone(), |relative| &left * relative).ceiling();
            left.lt(&Enclosure::one(data.precision)).is_true().then_some(left)
        });
        Some(Mistuning { factors: factors.collect(), largest })
    }

    /// The number of the last oscillator that pays: with more of them no bound falls.
    #[must_use]
    pub fn last_that_pays(&self) -> u64 {
        self.factors.len() as u64
    }
}

struct Tuning<'a, 's> {
    data: &'a Data<'s>,
    largest: &'a Enclosure,
    /// n_0, n_1, ..., as many as were needed.
    weights: Vec<Enclosure>,
}

impl Tuning<'_, '_> {
    fn weight(&mut self, l: usize) -> Enclosure {
        let Tuning { data, weights, .. } = self;
        let model = &data.spec.internal_model;
        weights.extend((weights.len()..=l).map(|l| model.weights.weight(l as u64, data.precision)));
        weights[l].clone()
    }

    /// Sb_k: with d = k dm < 1 and every N >= k, `|x - k| <= d` has `|S| = (1 + nu^2 g_N(x)^2)^(-1/2) <= Sb_k`. `None` where nothing
    /// is known, or d is not below 1.
    ///
    /// g_N increases between k - 1, k and k + 1, where it has poles, so that it is at least g_N(k - d) below k and at most
    /// g_N(k + d) above; for l > k the oscillators l and -l add `n_l x/(l^2 - x^2) > 0` to it, so that the first is not below g_k(k - d),
    /// and the second not above what all of them make of it; those beyond L = 2k + 2 at most `n_L x/(2 L (1 - (x/L)^2))`, by W2.
    fn left(&mut self, k: usize) -> Option<Enclosure> {
        let integer = |l: usize| Enclosure::from_integer(l as i64, self.data.precision);
        let d = (integer(k) * self.largest).ceiling();
        if !d.lt(&integer(1)).is_true() {
            return None;
        }
        let last = 2 * k + 2;
        let [below, above] = [integer(k) - &d, integer(k) + &d];
        let own = self.weight(k) / 2;
        // Of k itself, of -k, and of 0.
        let n_0 = self.weight(0);
        let mut least = &own / &d - &own / (integer(k) + &below) - &n_0 / &below;
        let mut most = (&own / &d).negate() - &own / (integer(k) + &above) - &n_0 / &above;
        for l in (1..=last).filter(|l| *l != k) {
            let weight = self.weight(l);
            let pair = |x: &Enclosure| &weight * x / ((integer(l) - x) * (integer(l) + x));
            if l < k {
                least = least + pair(&below);
            }
            most = most + pair(&above);
        }
        let rest = self.weight(last) * &above / (2 * integer(last) * (1 - (&above / integer(last)).sqr()));
        let size = least.min(&(most + rest).negate());
        size.is_positive().is_true().then(|| (1 + (&self.data.nu * size).sqr()).sqrt().recip())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transfer::weights_only::weights_only;
    use sigmastar_lang::spec::Specification;

    /// |e_k| b_m sg_k/|q_k| at x with n oscillators and the input gain b, from the sum itself: (13.1).
    fn left(x: f64, n: usize, [nu, b, least]: [f64; 3], ratio: f64) -> f64 {
        let weight = |l: usize| if l == 0 { 2.0 } else { 1.0 / (l as f64).powf(1.5) };
        let g = (1..=n).map(|l| weight(l) * x / ((l as f64 - x) * (l as f64 + x))).sum::<f64>() - 2.0 / x;
        // sigma = ratio omega: |D|^2/omega^2 at eta = b nu g.
        let eta = b * nu * g;
        let square = (b * ratio).powi(2) + 1.0 + 2.0 * (1.0 - b) * ratio * eta + eta.powi(2) * (1.0 + ratio.powi(2));
        least * ((1.0 + ratio.powi(2)) / square).sqrt()
    }

    fn at(frequency: &str, gain: Option<[&str; 2]>) -> Specification {
        let mut document = weights_only("2", "1/2", "6", frequency).document;
        if let Some([low, high]) = gain {
            document["input_gain"] = serde_json::json!({ "nominal": 1, "low": low, "high": high });
        }
        Specification::from_json("test", &document.to_string()).unwrap()
    }

    /// The factor bounds what is left at every frequency within the mistuning and with every number of oscillators from k on, and
    /// there is one at which nearly all of it is.
    #[test]
    fn what_is_left_of_a_harmonic_is_bounded_and_nearly_reached() {
        for (frequency, gain, nearly) in [
            ("1.001*2*pi", None, 0.999),
            ("2*pi/1.02", None, 0.999),
            ("2*pi/1.02", Some(["0.8", "1"]), 0.7),
            ("2*pi*1.005", Some(["0.9", "1.25"]), 0.7),
        ] {
            let spec = at(frequency, gain);
            let data = Data::new(&spec, 128);
            let mistuning = Mistuning::new(&data).unwrap();
            assert!(mistuning.last_that_pays() >= 3, "{frequency}: {}", mistuning.last_that_pays());
            let dm = mistuning.largest.upper_f64();
            let nu = 6.0 / data.base_frequency.midpoint_f64();
            let gains = gain.map_or([1.0, 1.0], |ends| ends.map(|end| end.parse::<f64>().unwrap()));
            for (k, factor) in (1..).zip(&mistuning.factors) {
                let mut largest: f64 = 0.0;
                for step in -20..=20 {
                    let x = k as f64 * (1.0 + dm * f64::from(step) / 20.0);
                    if step == 0 {
                        continue;
                    }
                    for (n, b) in [k, k + 1, 2 * k + 3, 400].into_iter().flat_map(|n| gains.map(|b| (n, b))) {
                        for ratio in [1e-3, 0.3, 1.0, 3.0, 1e3] {
                            largest = largest.max(left(x, n, [nu, b, gains[0].min(1.0)], ratio));
                        }
                    }
                }
                let factor = factor.upper_f64();
                let bounded = largest <= factor * (1.0 + 1e-12);
                assert!(bounded && largest >= nearly * factor, "{frequency}, k = {k}: {largest} and {factor}");
            }
        }
    }

    #[test]
    fn a_matched_frequency_has_none_and_a_distant_one_none_that_pays() {
        assert!(Mistuning::new(&Data::new(&at("1.7*2*pi", None), 128)).unwrap().factors.is_empty());
        let exact = Mistuning::new(&Data::new(&at("2*pi", None), 128)).unwrap();
        assert_eq!(exact.last_that_pays(), MAX_TUNED as u64);
        assert!(exact.factors.iter().all(|factor| factor.upper_f64() < 1e-18));
        let mut document = at("2*pi", None).document;
        document["internal_model"]["matched"] = true.into();
        let matched = Specification::from_json("test", &document.to_string()).unwrap();
        assert!(Mistuning::new(&Data::new(&matched, 128)).is_none());
    }
}
