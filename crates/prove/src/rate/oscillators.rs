//! `Phi - mu M M'N` for a given n_o, and its Lyapunov function of Lemma 1 of the paper.
//!
//! In the coordinates `N^(1/2) zeta`, in which |zeta|_N is the Euclidean norm, the matrix is `A = Phi - mu b b'` with
//! `b = N^(1/2) M`: Phi commutes with N. Its order is 2 n_o + 1.

use rug::Rational;
use sigmastar_decide::rates::OscillatorMatrix;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::number::{Direction, round_f64, round_rational};
use sigmastar_lang::spec::Oscillators;
use sigmastar_matrix::ScaledMatrix;
use sigmastar_propose::rates::oscillators::{Proposed, propose};
use sigmastar_theory::data::Data;

/// What is proved of P_zeta of Lemma 1 of the paper (P:lemma:hurwitzPhiM) for one n_o.
///
/// Every kappa > 0 is admissible in the paper's Lyapunov function `N + kappa P_zeta`, and the rate that it gives the oscillators by
/// themselves, in `|.|_N`, tends to `1/(2 p)` as kappa grows.
#[derive(Clone, Debug)]
pub struct Lemma {
    /// p: there is a P_zeta with `P_zeta (Phi - mu M M'N) + (.)' <= -N` and `0 < P_zeta <= p N`.
    pub p: Rational,
    /// 1/(2 p), rounded down, in 1/time.
    pub rate: Rational,
    /// The spectral abscissa of `Phi - mu M M'N`: floating point, and no claim.
    pub abscissa: f64,
}

/// Lemma 1 of the data for one n_o; `None` where nothing is proved.
#[must_use]
pub fn lemma(data: &Data<'_>, n_o: u32) -> Option<Lemma> {
    let system = OscillatorMatrix::new(data, &Oscillators::first(n_o));
    let Proposed { p, largest, abscissa } = propose(&system)?;
    let p = proved(&system, &p, largest)?;
    let rate = round_rational(&(Rational::from(1) / (p.clone() * 2u32)), 6, Direction::Down);
    Some(Lemma { p, rate, abscissa })
}

/// An upper bound of the largest eigenvalue of P, which is about this one, where `P > 0` and `P A + A'P <= -I` are proved of it. P is taken as
/// the exact rational numbers that its doubles are; it is symmetric, by rows.
fn proved(of: &OscillatorMatrix, p: &[Vec<f64>], largest: f64) -> Option<Rational> {
    let n = of.order();
    let precision = of.mu.precision();
    let exact: Option<Vec<Enclosure>> = (0..n)
        .flat_map(|i| (0..n).map(move |j| (i.max(j), i.min(j))))
        .map(|(i, j)| Some(Enclosure::from_rational(&Rational::from_f64(p[i][j])?, precision)))
        .collect();
    let exact = exact?;
    let at = |i: usize, j: usize| &exact[i * n + j];
    // P b, with b zero at every second state.
    let image: Vec<Enclosure> = (0..n)
        .map(|i| {
            let states = (0..n).filter(|j| *j == 0 || j % 2 == 1);
            states.fold(Enclosure::zero(precision), |sum, j| sum + at(i, j) * &of.b[j])
        })
        .collect();
    let phi: Vec<Option<(usize, Enclosure)>> = (0..n).map(|column| of.phi(column)).collect();
    let decay = |i: usize, j: usize| {
        let mut sum = &of.mu * (&image[i] * &of.b[j] + &of.b[i] * &image[j]);
        for (column, other) in [(j, i), (i, j)] {
            if let Some((row, entry)) = &phi[column] {
                sum = sum - at(other, *row) * entry;
            }
        }
        if i == j { sum - Enclosure::one(precision) } else { sum }
    };
    let is_proved = |matrix: Option<ScaledMatrix>| matrix.is_some_and(|m| m.is_positive_definite() == Truth::True);
    if !is_proved(ScaledMatrix::from_enclosures(n, decay))
        || !is_proved(ScaledMatrix::from_doubles(n, |i, j| p[i][j], &vec![0.0; n]))
    {
        return None;
    }
    let largest = round_f64(largest * 1.0001, 6, Direction::Up)?;
    let bound = Enclosure::from_rational(&largest, precision);
    let below = |i: usize, j: usize| if i == j { &bound - at(i, j) } else { at(i, j).negate() };
    is_proved(ScaledMatrix::from_enclosures(n, below)).then_some(largest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::Specification;

    fn example() -> Specification {
        Specification::from_json("test", include_str!("../../../../specs/paper-example.json")).expect("a sound one")
    }

    /// The rate falls with n_o and stays below the spectral abscissa; 200 oscillators are within reach.
    #[test]
    fn the_lemma_is_proved() {
        let spec = example();
        let data = Data::new(&spec, 128);
        let mut before = f64::INFINITY;
        for n_o in [0, 1, 3, 10, 40, 200] {
            let Lemma { p, rate, abscissa } = lemma(&data, n_o).expect("proved");
            assert!(p.clone() * &rate * 2u32 <= 1 && p.to_f64() * rate.to_f64() > 0.4999, "{n_o}");
            assert!(rate.to_f64() < -abscissa && rate.to_f64() < before, "{n_o}");
            before = rate.to_f64();
        }
        // The matrix of n_o = 0 is -mu n_0 = -2: P = 1/2 is proposed.
        let Lemma { p, abscissa, .. } = lemma(&data, 0).expect("proved");
        assert!((abscissa + 2.0).abs() < 1e-12 && (0.5..0.501).contains(&p.to_f64()), "{p} {abscissa}");
    }

    /// With A = -2 any P above 1/4 serves, and its bound is not below it.
    #[test]
    fn a_wrong_p_proves_nothing() {
        let spec = example();
        let system = OscillatorMatrix::new(&Data::new(&spec, 128), &Oscillators::first(0));
        let of = |p: f64| proved(&system, &[vec![p]], p);
        assert!(of(0.251).is_some_and(|largest| largest >= Rational::from((251, 1000))));
        assert_eq!([of(0.249), of(0.0), of(-1.0)], [None, None, None]);
    }
}
