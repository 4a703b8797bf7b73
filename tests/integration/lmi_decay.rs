//! The matrix inequality of C5 against its closed form, on random data over many orders of magnitude.

use proptest::prelude::*;
use rug::Rational;
use rug::ops::Pow;
use sigmastar_propose::semidefinite::SolverFailure;
use sigmastar_prove::lmi::{
    DecayData, DecayProposal, propose_multipliers, propose_sigma, two_sided_threshold, verify_decay,
};

/// The closed form of C5, exactly: `D^2/(4 ht) + (w_x p k_f + k_x D/2)^2/(4A - ht k_x^2)` with
/// D = max{|1 + ht m|, |1 - ht k_l|}; also ht, D and the worst xi for et = 1.
struct ClosedForm {
    threshold: Rational,
    ht: Rational,
    worst: Rational,
    xi: Rational,
}

fn closed_form(data: &DecayData) -> ClosedForm {
    let ht = Rational::from(&data.h / &data.mu[0]);
    let [below, above] = &data.sector;
    let [first, second]: [Rational; 2] =
        [Rational::from(&ht * above) + 1, Rational::from(1) - Rational::from(&ht * below)];
    let one_plus = first.abs().max(second.abs());
    let cross = Rational::from(&data.w_x * &data.root_p_up) * &data.k_f + Rational::from(&data.k_x * &one_plus) / 2;
    let margin = Rational::from(&data.w_x * &data.rate) * 4 - Rational::from(&data.k_x * &data.k_x) * &ht;
    assert!(margin > 0);
    let xi = Rational::from(&cross / &margin) * 2;
    let threshold = Rational::from(&one_plus * &one_plus) / (4 * ht.clone()) + cross * &xi / 2;
    ClosedForm { threshold, ht, worst: one_plus, xi }
}

/// The multipliers at the threshold, exactly, for k_x, k_f > 0 and a sector that is open.
fn exact_multipliers(data: &DecayData, form: &ClosedForm) -> [Rational; 3] {
    let worst = Rational::from(&data.k_x * &form.xi);
    let one_plus = Rational::from(&worst * &form.ht) + &form.worst;
    let l_x = Rational::from(&one_plus / &worst) / 2 * (Rational::from(1) - exact(1e-60));
    let [below, above] = &data.sector;
    let l_e = Rational::from(&one_plus / &Rational::from(below + above));
    [l_x, l_e, Rational::from(&data.w_x * &data.root_p_up) * &form.xi / &data.k_f]
}

fn exact(value: f64) -> Rational {
    Rational::from_f64(value).expect("finite")
}

/// 10^exponent.
fn magnitude(span: f64) -> impl Strategy<Value = Rational> {
    (-span..span).prop_map(|exponent| exact(10f64.powf(exponent)))
}

/// k_x, k_e or k_f; zero now and then, unless all are to be positive.
fn gain(zeros: bool) -> BoxedStrategy<Rational> {
    if zeros { prop_oneof![1 => Just(Rational::new()), 4 => magnitude(4.0)].boxed() } else { magnitude(4.0).boxed() }
}

prop_compose! {
    /// The distance from ht k_x^2 = 4 A is `10^distance` relative to ht k_x^2 (or, with k_x = 0, 10^distance).
    fn decay_data(zeros: bool)(
        w_x in magnitude(6.0), h in magnitude(6.0), mu in magnitude(6.0), root_p_up in magnitude(3.0),
        k_x in gain(zeros), k_l in gain(zeros), k_f in gain(zeros), distance in -1.0..6.0,
        share in prop_oneof![Just(1.0), Just(0.0), -0.999..0.999],
    ) -> DecayData {
        let coupling = Rational::from(&h / &mu) * &k_x * &k_x;
        let four_a = if k_x == 0 { exact(10f64.powf(distance)) } else { coupling * (exact(10f64.powf(distance)) + 1) };
        let rate = four_a / (4 * w_x.clone());
        let sector = [k_l.clone(), k_l * exact(share)];
        DecayData { w_x, h, mu: [mu.clone(), mu], rate, root_p_up, k_x, sector, k_f }
    }
}

/// The threshold and 10^-digits of its scale, which is larger where most of it cancels.
fn near_threshold(data: &DecayData, sign: i32, digits: i32) -> Rational {
    let threshold = closed_form(data).threshold;
    let scale = exact(two_sided_threshold(data)).max(threshold.clone());
    threshold + scale * exact(10f64.powi(-digits)) * sign
}

/// value (1 + 10^-digits sign).
fn beside(value: &Rational, sign: i32, digits: i32) -> Rational {
    Rational::from(value * &(Rational::from(1) + exact(10f64.powi(-digits)) * sign))
}

/// Whether the proposed multipliers prove C5 at sigma, and the proposed margin.
fn at(data: &DecayData, sigma: &Rational) -> Result<(bool, f64), SolverFailure> {
    let proposal = propose_multipliers(data, sigma)?;
    if let Some(remark) = proposal.remark {
        return Err(SolverFailure::Stopped(remark));
    }
    Ok((verify_decay(data, sigma, &proposal.exact_multipliers().expect("finite")), proposal.margin))
}

/// A solver that stops short of its tolerance is not an error of the tool, but it must be rare: see `max_global_rejects`.
fn solved<T>(answer: Result<T, SolverFailure>) -> Result<T, TestCaseError> {
    answer.map_err(|failure| match failure {
        SolverFailure::Stopped(_) => TestCaseError::reject(failure.to_string()),
        _ => TestCaseError::fail(failure.to_string()),
    })
}

fn complete(proposal: &DecayProposal) -> Result<(), TestCaseError> {
    proposal.remark.as_ref().map_or(Ok(()), |remark| Err(TestCaseError::reject(remark.clone())))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, max_global_rejects: 10, ..ProptestConfig::default() })]

    #[test]
    fn the_solver_finds_the_threshold_of_the_closed_form(data in decay_data(true)) {
        let proposal = solved(propose_sigma(&data))?;
        complete(&proposal)?;
        let threshold = closed_form(&data).threshold.to_f64();
        let difference = (proposal.sigma - threshold).abs() / threshold.max(two_sided_threshold(&data));
        prop_assert!(difference <= 1e-6, "{difference}");
    }

    #[test]
    fn just_above_the_threshold_multipliers_are_found_and_proved(data in decay_data(true)) {
        let (proved, margin) = solved(at(&data, &near_threshold(&data, 1, 6)))?;
        prop_assert!(proved && margin > 0.0, "{margin}");
    }

    #[test]
    fn just_below_the_threshold_there_are_no_multipliers(data in decay_data(true)) {
        let (proved, margin) = solved(at(&data, &near_threshold(&data, -1, 6)))?;
        prop_assert!(!proved && margin < 0.0, "{margin}");
    }

    /// Without the solver: the multipliers of the closed form stop being a proof at the threshold, exactly. (l_x is a
    /// little lower, because (xi, phi) and (et, s, u_x, u_e) are separate blocks that share the margin.)
    #[test]
    fn the_threshold_is_where_the_exact_multipliers_stop(data in decay_data(false)) {
        let form = closed_form(&data);
        let multipliers = exact_multipliers(&data, &form);
        prop_assert!(verify_decay(&data, &beside(&form.threshold, 1, 30), &multipliers));
        prop_assert!(!verify_decay(&data, &form.threshold, &multipliers));
        prop_assert!(!verify_decay(&data, &beside(&form.threshold, -1, 30), &multipliers));
    }

    /// The matrix against the form of C5 with its multipliers, written out, on random vectors.
    #[test]
    fn the_matrix_is_that_of_the_quadratic_form(
        data in decay_data(true), vector in prop::array::uniform6(-9..10i32), unknowns in prop::array::uniform4(-9..10i32),
    ) {
        let present = data.present();
        let kept = |k: usize, value: i32| if present[k] { Rational::from(value) } else { Rational::new() };
        let [xi, et, s] = [vector[0], vector[1], vector[2]].map(Rational::from);
        let [ux, ue, phi] = [kept(0, vector[3]), kept(1, vector[4]), kept(2, vector[5])];
        let sigma = Rational::from(unknowns[0]);
        let [l_x, l_e, l_f] = [kept(0, unknowns[1]), kept(1, unknowns[2]), kept(2, unknowns[3])];
        let square = |value: &Rational| Rational::from(value * value);
        let product = |factors: &[&Rational]| factors.iter().fold(Rational::from(1), |product, factor| product * *factor);
        let u = Rational::from(&ux + &ue);
        let mu = &data.mu[0];
        let form = product(&[&data.w_x, &data.rate, &xi, &xi]) * 2 - product(&[&data.w_x, &data.root_p_up, &xi, &phi]) * 2
            + product(&[&sigma, &et, &et]) * 2 - product(&[&et, &u]) * 2 - product(&[mu, &et, &s]) * 2
            + product(&[&data.h, mu, &s, &s]) * 2 + product(&[&data.h, &s, &u]) * 2
            + l_x.clone() * (square(&ux) - square(&data.k_x) * square(&xi))
            + l_e.clone() * (&ue - product(&[&data.sector[1], &et]))
                * (&ue + product(&[&data.sector[0], &et]))
            + l_f.clone() * (square(&phi) - square(&data.k_f) * square(&et));
        let keep = |values: [Rational; 3]| values.into_iter().zip(present).filter_map(|(v, p)| p.then_some(v));
        let numbers: Vec<Rational> = std::iter::once(sigma).chain(keep([l_x, l_e, l_f])).collect();
        // The matrix is written in v = u_e - c_0 et; u_e without a row of its own is c_0 et.
        let [middle, _] = data.middle();
        let v = &ue - product(&[&middle, &et]);
        let signals: Vec<Rational> = [xi, et, s].into_iter().chain(keep([ux, v, phi])).collect();
        let rows = data.matrix(mu).substitute(&numbers).constant().rows();
        prop_assert_eq!(rows.len(), signals.len());
        let mut value = Rational::new();
        for (row, left) in rows.iter().zip(&signals) {
            for (entry, right) in row.iter().zip(&signals) {
                value += product(&[entry, left, right]);
            }
        }
        prop_assert_eq!(value, form);
    }
}

/// h = mu = w_x = p = k_x = k_l = m = k_f = 1 and a_2 = 1: margin 3, C = 2, threshold 1 + 4/3.
fn ones() -> DecayData {
    let one = Rational::from(1);
    DecayData {
        w_x: one.clone(),
        h: one.clone(),
        mu: [one.clone(), one.clone()],
        rate: one.clone(),
        root_p_up: one.clone(),
        k_x: one.clone(),
        sector: [one.clone(), one.clone()],
        k_f: one,
    }
}

#[test]
fn a_case_by_hand() {
    let proposal = propose_sigma(&ones()).expect("solved");
    assert!((proposal.sigma - 7.0 / 3.0).abs() <= 1e-7, "{proposal:?}");
    // xi = 4/3 and u = 7/3: l_x = (10/3)/(8/3), l_e = (10/3)/2, l_f = 4/3.
    for (found, expected) in proposal.multipliers.iter().zip([1.25, 5.0 / 3.0, 4.0 / 3.0]) {
        assert!((found - expected).abs() <= 1e-3, "{proposal:?}");
    }
}

#[test]
fn every_harmful_change_beyond_the_bounds_is_noticed() {
    let sigma = Rational::from((7, 3)) + exact(1e-9);
    let multipliers = exact_multipliers(&ones(), &closed_form(&ones()));
    let proved = |data: &DecayData| verify_decay(data, &sigma, &multipliers);
    assert!(proved(&ones()));
    let more = Rational::from((1001, 1000));
    let less = Rational::from((999, 1000));
    assert!(!proved(&DecayData { rate: less.clone(), ..ones() }));
    assert!(!proved(&DecayData { root_p_up: more.clone(), ..ones() }));
    assert!(!proved(&DecayData { k_x: more.clone(), ..ones() }));
    assert!(!proved(&DecayData { sector: [Rational::from(1), more.clone()], ..ones() }));
    assert!(!proved(&DecayData { k_f: more.clone(), ..ones() }));
    // Harmless changes: the same multipliers still do, with a k that is 0 as well.
    assert!(proved(&DecayData { rate: more.clone(), ..ones() }));
    for smaller in [less.clone(), Rational::new()] {
        assert!(proved(&DecayData { root_p_up: smaller.clone(), ..ones() }));
        assert!(proved(&DecayData { k_x: smaller.clone(), ..ones() }));
        assert!(proved(&DecayData { sector: [smaller.clone(), smaller.clone()], ..ones() }));
        assert!(proved(&DecayData { k_f: smaller, ..ones() }));
    }
}

/// Both ends of the interval of mu are looked at, and wrong signs prove nothing.
#[test]
fn the_ends_of_mu_and_the_signs_are_checked() {
    let multipliers = exact_multipliers(&ones(), &closed_form(&ones()));
    let proved = |data: &DecayData| verify_decay(data, &Rational::from(3), &multipliers);
    let (one, low, high) = (Rational::from(1), Rational::from((1, 100)), Rational::from(100));
    assert!(proved(&ones()));
    assert!(proved(&DecayData { mu: [one.clone(), Rational::from((101, 100))], ..ones() }));
    assert!(!proved(&DecayData { mu: [one.clone(), high.clone()], ..ones() }));
    assert!(!proved(&DecayData { mu: [low, one.clone()], ..ones() }));
    assert!(!proved(&DecayData { mu: [Rational::from((101, 100)), one], ..ones() }));
    let minus = Rational::from((-1, 1000));
    assert!(!proved(&DecayData { root_p_up: minus.clone(), ..ones() }));
    assert!(!proved(&DecayData { k_x: minus.clone(), ..ones() }));
    // An empty sector: the lower end is above the upper one.
    assert!(!proved(&DecayData { sector: [Rational::from(1), Rational::from((-1001, 1000))], ..ones() }));
    assert!(!proved(&DecayData { sector: [minus.clone(), Rational::from(1)], ..ones() }));
    assert!(!proved(&DecayData { k_f: minus.clone(), ..ones() }));
    // A multiplier that is not positive proves nothing, unless its signal is absent.
    let [_, l_e, l_f] = multipliers;
    let negative = [minus, l_e, l_f];
    assert!(!verify_decay(&ones(), &Rational::from(3), &negative));
    assert!(verify_decay(&DecayData { k_x: Rational::new(), ..ones() }, &Rational::from(3), &negative));
}

#[test]
fn what_cannot_be_solved_is_said() {
    // ht k_x^2 = 1 >= 4A: no sigma is enough.
    let weak = DecayData { rate: Rational::from((1, 5)), ..ones() };
    assert_eq!(propose_sigma(&weak), Err(SolverFailure::Infeasible));
    let huge = Rational::from(rug::Integer::from(10).pow(400));
    for odd in [
        DecayData { rate: Rational::from(-1), ..ones() },
        DecayData { rate: Rational::new(), ..ones() },
        DecayData { rate: Rational::new(), k_x: Rational::new(), k_f: Rational::new(), ..ones() },
        DecayData { h: Rational::from(-1), ..ones() },
        DecayData { mu: [Rational::new(), Rational::from(1)], ..ones() },
        DecayData { k_x: Rational::from(-1), ..ones() },
        DecayData { k_f: huge.clone(), ..ones() },
        DecayData { w_x: huge.clone(), ..ones() },
    ] {
        assert_eq!(propose_sigma(&odd), Err(SolverFailure::Unusable), "{odd:?}");
        assert_eq!(propose_multipliers(&odd, &Rational::from(3)), Err(SolverFailure::Unusable), "{odd:?}");
    }
    assert_eq!(propose_multipliers(&ones(), &huge), Err(SolverFailure::Unusable));
}
