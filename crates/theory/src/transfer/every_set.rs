//! Which proofs of the transfer bound serve every finite set of harmonics that contains 0 (derivation, 14.7).

use super::TransferProof;
use super::matched::MAX_HARMONICS;
use crate::data::Data;
use sigmastar_exact::enclosure::Enclosure;

/// Whether an admissible pair with this proof bounds `T_H(x)` for every finite set H of harmonics that contains 0, too, at every x at which it bounds
/// `T_N`, and `2/(nu^2 n_k)` bounds `T_H(k)` where that is used.
///
/// The closed form does; where `2/(nu^2 n_k)` is used beside it, and a matched pair, under (14.7b),
/// `nu^2 (n_k s_k/2 - max{ga_k, 0}^2) <= 1` for every k >= 1, with `s_k = sum over |l| != k of c_l/(l-k)^2` and
/// `ga_k = n_0/k - sum over l > k of n_l k/(l^2-k^2)`. Boxes are about n_o.
///
/// Hypotheses: W1 to W3; nu is that of the least input gain. Guarantee: `true` is proved; `false` says nothing.
#[must_use]
pub fn serves_every_set(data: &Data<'_>, proof: &TransferProof) -> bool {
    match proof {
        TransferProof::ClosedForm => !takes_poles(data) || EverySet::new(data).is_served(),
        TransferProof::Matched { .. } => EverySet::new(data).is_served(),
        TransferProof::Boxes(_) => false,
    }
}

/// Whether `2/(nu^2 n_k)` is used whatever proves the pair: at a matched frequency with known harmonics of q(t,0,0).
fn takes_poles(data: &Data<'_>) -> bool {
    data.matched && (data.spec.q_0.is_some() || data.spec.plant().is_some())
}

struct EverySet<'d, 's> {
    data: &'d Data<'s>,
    /// nu^2.
    square: Enclosure,
    /// pi^2/6.
    sixth: Enclosure,
    /// The sum of all weights.
    total: Enclosure,
}

impl<'d, 's> EverySet<'d, 's> {
    fn new(data: &'d Data<'s>) -> EverySet<'d, 's> {
        let total = data.spec.internal_model.weights.total(data.precision);
        let sixth = Enclosure::pi(data.precision).sqr() / 6;
        EverySet { data, square: data.nu.sqr(), sixth, total }
    }

    /// (14.7b): (14.7c) for every k from some K on, and those below K one by one.
    fn is_served(&self) -> bool {
        let Some(first_of_tail) = (1..=MAX_HARMONICS).find(|k| self.tail(*k)) else { return false };
        let weights: Vec<Enclosure> = (0..=last(first_of_tail) + 1).map(|l| self.weight(l)).collect();
        (1..first_of_tail).all(|k| self.at(k, &weights))
    }

    fn weight(&self, l: u32) -> Enclosure {
        self.data.spec.internal_model.weights.weight(u64::from(l), self.data.precision)
    }

    fn int(&self, value: u32) -> Enclosure {
        Enclosure::from_integer(i64::from(value), self.data.precision)
    }

    /// (14.7c): `nu^2 n_K/2 (4 Nbar^2/K^2 + (pi^2/6) n_(floor(K/2)+1)) <= 1`, which settles every k >= K.
    fn tail(&self, first: u32) -> bool {
        let sum = 4 * &self.total / self.int(first).sqr() + &self.sixth * self.weight(first / 2 + 1);
        (&self.square * self.weight(first) / 2 * sum).le(&Enclosure::one(self.data.precision)).is_true()
    }

    /// (14.7b) of one k, from `n_0` to `n_(L+1)`: the terms up to L, and what is beyond: at most `n_(L+1)/(L-k)` in `s_k`, and `n_(L+1) k/(L+1-k)` in `ga_k`.
    fn at(&self, k: u32, weights: &[Enclosure]) -> bool {
        let last = last(k);
        let of_k = self.int(k);
        let n_0 = &weights[0];
        let (mut sum, mut gamma) = (n_0 / of_k.sqr(), n_0 / &of_k);
        for (l, n_l) in (1..=last).zip(&weights[1..]).filter(|(l, _)| *l != k) {
            let [near, far] = [self.int(l.abs_diff(k)), self.int(l + k)];
            sum = sum + n_l / 2 * (near.sqr().recip() + far.sqr().recip());
            if l > k {
                gamma = gamma - n_l * &of_k / (near * far);
            }
        }
        let next = &weights[last as usize + 1];
        sum = sum + next / self.int(last - k);
        gamma = gamma - next * &of_k / self.int(last + 1 - k);
        let gained = gamma.max(&self.data.zero()).sqr();
        let left = &self.square * (&weights[k as usize] * sum / 2 - gained);
        left.le(&Enclosure::one(self.data.precision)).is_true()
    }
}

/// L of one k: what is beyond it hardly counts.
fn last(k: u32) -> u32 {
    4 * k + 64
}

#[cfg(test)]
mod tests {
    use super::super::weights_only::weights_only;
    use super::*;

    fn served(n_0: &str, epsilon: &str, mu: &str) -> bool {
        let spec = weights_only(n_0, epsilon, mu, "1");
        serves_every_set(&Data::new(&spec, 128), &TransferProof::Matched { k: 1 })
    }

    /// T_H(k) of a set, in doubles.
    fn transfer(harmonics: &[f64], k: f64, nu: f64, weight: impl Fn(f64) -> f64) -> f64 {
        let poles = harmonics.iter().flat_map(|l| if *l == 0.0 { vec![0.0] } else { vec![*l, -*l] });
        let share = |l: f64| if l == 0.0 { weight(0.0) } else { weight(l.abs()) / 2.0 };
        let (g, slope) =
            poles.fold((0.0, 0.0), |(g, slope), l| (g + share(l) / (l - k), slope + share(l) / (l - k).powi(2)));
        slope / (1.0 + nu * nu * g * g)
    }

    /// For the power family with eps >= 0.12 every nu serves; with eps near 0 large ones do not.
    #[test]
    fn most_weights_serve_at_every_nu() {
        for mu in ["1/1000", "1/6", "1", "20", "200"] {
            assert!(served("2", "3/25", mu) && served("2", "1/2", mu) && served("2", "1", mu), "{mu}");
        }
        assert!(served("2", "1/1000", "10") && !served("2", "1/1000", "100"));
    }

    /// Where it is served no set exceeds the bound of the first harmonics, and where it is not one does.
    #[test]
    fn what_is_served_bounds_sets_with_gaps() {
        let weight = |epsilon: f64| move |l: f64| if l == 0.0 { 2.0 } else { l.powf(-(1.0 + epsilon)) };
        let of = |epsilon: f64, nu: f64, harmonics: &[f64], k: f64| {
            let n = weight(epsilon);
            transfer(harmonics, k, nu, n) * nu * nu * n(k) / 2.0
        };
        for nu in [0.01, 0.5, 3.0, 30.0] {
            for harmonics in
                [&[0.0, 2.0][..], &[0.0, 1.0, 3.0, 5.0, 7.0], &[0.0, 1.0, 5.0, 7.0, 11.0, 13.0], &[0.0, 40.0]]
            {
                for k in (1..60).map(f64::from).filter(|k| !harmonics.contains(k)) {
                    assert!(of(0.5, nu, harmonics, k) <= 1.0, "{nu} {harmonics:?} {k}");
                }
            }
        }
        // The gaps that make g small: everything above k, nothing below.
        let gap: Vec<f64> = std::iter::once(0.0).chain((0..4000).map(|l| 31.0 + f64::from(l))).collect();
        let worst = (10..31).map(|k| of(0.001, 100.0, &gap, f64::from(k))).fold(0.0, f64::max);
        assert!(worst > 1.0, "{worst}");
    }

    #[test]
    fn boxes_are_about_the_first_harmonics() {
        let spec = weights_only("2", "1/2", "1", "1");
        let data = Data::new(&spec, 128);
        let pair = super::super::smallest_k1(&data, &rug::Rational::from(7)).unwrap();
        assert!(!serves_every_set(&data, &TransferProof::Boxes(pair.proof)));
        assert!(serves_every_set(&data, &TransferProof::ClosedForm));
    }
}
