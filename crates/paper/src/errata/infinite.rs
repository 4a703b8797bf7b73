//! E13 and E23: exact regulation with infinitely many oscillators.

use super::evidence::Evidence;
use super::evidence::Relation::{Different, Equal, Greater, Less};
use super::numbers::{PRECISION, integer, pi, ratio, rational};
use super::{Bearing, Class, Erratum, ForData};
use rug::Rational;
use sigmastar_exact::enclosure::Truth;
use sigmastar_theory::data::{Bound, Data, Problem};

/// E13: the friend.
pub(super) fn e13(data: Option<&Data<'_>>) -> Erratum {
    // q = 1, mu = 1, n_0 = 2: c_0 = -1. The equation mu n_0 z_0 = c_0 has the solution c_0/(mu n_0).
    let (n_0, c_0) = (Rational::from(2), Rational::from(-1));
    let component = Rational::from(&c_0 / &n_0);
    let norm_squared = Rational::from(component.square_ref()) * &n_0;
    // q = cos(2 pi t/T), T = 10, mu = n_1 = 1: |z_p|_N = 1/(mu sqrt(n_1)) = 1, b_qt = 2 pi/T.
    let printed = pi() / 5;
    let evidence = vec![
        Evidence::rigorous(
            "$`q = 1`$, $`mu = 1`$, $`n_0 = 2`$: $`c_0 = -1`$, and the printed component $`z_p0 = c_0/mu`$ gives $`mu M'N z_p = n_0 c_0`$",
            (Rational::from(&n_0 * &c_0), Different, c_0.clone()),
        ),
        Evidence::rigorous("while $`z_p0 = c_0/(mu n_0)`$ gives", (Rational::from(&n_0 * &component), Equal, c_0)),
        Evidence::rigorous(
            "its norm $`|z_p|_N^2 = n_0 z_p0^2`$, against the printed bound $`b_qt(0,0)/(mu^2 n_1) = 0`$ of $`|z_p|_N`$",
            (norm_squared, Greater, 0),
        ),
        Evidence::rigorous(
            "$`q = cos(2 pi t/T)`$, $`T = 10`$, $`mu = n_1 = 1`$: $`|z_p|_N = 1`$ against the printed bound $`2 pi/T`$",
            (1, Greater, printed),
        ),
    ];
    Erratum {
        id: "E13",
        place: "P:lemma:friend, proof of P:thm2",
        class: Class::A,
        printed: "$`z_p0 = c_0/mu`$; $`|z_p|_N <= b_qt(0,0)/(mu^2 n_1)`$",
        instead: "$`z_p0 = c_0/(mu n_0)`$; $`|z_p|_N <= (1/mu) sqrt(b_q(0,0)^2/n_0 + (2/n_1)(T/2 pi)^2 b_qt(0,0)^2)`$: the mean, a square \
                  root and $`T`$ are missing",
        evidence,
        for_data: data.map(e13_for_data),
    }
}

fn e13_for_data(data: &Data<'_>) -> ForData {
    let zero = data.zero();
    let (q, q_t) = (data.bound(Bound::Q, &zero, &zero), data.bound(Bound::Qt, &zero, &zero));
    let printed = &q_t / (data.mu.sqr() * &data.n_1);
    let turns = (&data.period / (2 * pi()) * &q_t).sqr();
    let proved = (q.sqr() / &data.n_0 + 2 * turns / &data.n_1).sqrt() / &data.mu;
    let (bearing, summary) = match printed.lt(&proved) {
        Truth::True => (Bearing::Bites, "the printed bound of $`|z_p|_N`$ is below what is proved"),
        Truth::False => (Bearing::Harmless, "the printed bound of $`|z_p|_N`$ is not below the proved one"),
        Truth::Undecided => (Bearing::Depends, "the printed bound is too close to the proved one to tell"),
    };
    ForData::new(bearing, summary).figure("printed bound", printed).figure("proved bound", proved)
}

/// E23: existence of solutions and the level set.
pub(super) fn e23() -> Erratum {
    let block = 1_000_000;
    // The level set at 9 P_up x_a^2 = 9 e_a^2 = 9 h zeta_a^2 = 1.
    let (minimum, level) = (Rational::from(1), Rational::from(3));
    let evidence = vec![
        Evidence::rigorous(
            "$`T = 1`$: on the block l of the sequence space $`|Phi z| = (2 pi l/T) |z|`$, so $`Phi`$ is unbounded; at $`l = 10^6`$ the factor",
            (2 * pi() * integer(block), Greater, block),
        ),
        Evidence::rigorous(
            "$`9 P_up x_a^2 = 9 e_a^2 = 9 h zeta_a^2 = 1`$: the minimum of $`P_up |x|^2 + e^2 + h |zeta|^2`$ outside the initial set is \
             taken on one face; its largest value inside, at a corner, is above",
            (minimum, Less, level),
        ),
        Evidence::rigorous(
            "the perturbation is bounded, $`|M M'N zeta|_N <= Nbar^2 |zeta|_N`$: with $`n_0 = 2`$, $`n_l = l^-2`$ the factor $`Nbar^2 = 2 + \
             pi^2/6`$",
            (2 + sigmastar_exact::enclosure::Enclosure::pi(PRECISION).sqr() / 6, Less, rational(&ratio(37, 10))),
        ),
    ];
    Erratum {
        id: "E23",
        place: "before P:prop:existence_solution_inf; P:prop:exponential_solution_inf",
        class: Class::AProof,
        printed: "\"all functions being locally Lipschitz\" on the sequence space; upsilon is a minimum outside the initial set",
        instead: "$`Phi`$ generates a unitary group and the rest is locally Lipschitz: mild solutions in $`zeta`$; $`upsilon = 9 P_up x_a^2 + \
                  9 e_a^2 + 9 h zeta_a^2`$, an upper bound over the set. The conclusion (bounded, $`x`$ and $`e`$ to 0) stands under \
                  C4 and C5",
        evidence,
        for_data: None,
    }
}
