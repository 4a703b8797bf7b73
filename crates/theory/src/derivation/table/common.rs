//! The rows in which all three derivations are evaluated at the same arguments.

use super::{At, Entry, Row, Status, TableInput, Value, number, printed, row, sound};
use crate::data::Data;
use crate::derivation::consequences::Psi;
use crate::derivation::contraction::ContractionMatrix;
use crate::derivation::existence::PeriodicBounds;
use crate::derivation::gains;
use crate::derivation::sharp::SharpEvaluation;
use crate::transfer::{PrintedTransfer, closed_form_pair, lambda_interval, printed_transfer};
use sigmastar_exact::enclosure::Enclosure;

/// The three derivations at the arguments of the claim.
pub(super) struct Common<'a> {
    sigma: Enclosure,
    own: &'a SharpEvaluation,
    pub(super) bounds: PeriodicBounds<Enclosure>,
    pub(super) k_alpha: Enclosure,
    closed: [Enclosure; 2],
    sharp: [Enclosure; 2],
    transfer: PrintedTransfer,
    z_printed: Enclosure,
    z_repaired: Enclosure,
}

impl<'a> Common<'a> {
    pub(super) fn new(input: &TableInput<'a>) -> Common<'a> {
        let (data, (witness, own)) = (input.data, input.sharp);
        let [x_p, e_p, sigma] = [&witness.x_p, &witness.e_p, &witness.sigma].map(|value| data.rational(value));
        let bounds = PeriodicBounds::new(data, x_p, e_p);
        let (k0, k1) = closed_form_pair(data);
        let closed = data.kappas(&k0, &k1);
        let sharp = data.kappas(&data.rational(&witness.k0), &data.rational(&witness.k1));
        let transfer = printed_transfer(data);
        Common {
            k_alpha: gains::k_alpha(&data.c, &data.alpha, &data.period),
            z_printed: bounds.z_squared_printed(data, &transfer.kappa_0, &transfer.kappa_1).sqrt(),
            z_repaired: bounds.z_squared_printed(data, &closed[0], &closed[1]).sqrt(),
            own,
            sigma,
            bounds,
            closed,
            sharp,
            transfer,
        }
    }
}

pub(super) fn gain_rows(data: &Data<'_>, common: &Common<'_>) -> Vec<Row> {
    let (k, c) = (&common.k_alpha, &data.c);
    let second = |k: &Enclosure| gains::k_alpha_2(k, &data.alpha, &data.period);
    let beta = gains::beta(&common.sigma, &data.period);
    vec![
        row(
            "K_alpha",
            At::Data,
            sound(k.clone(), "P:app:Kalpha1"),
            sound(k.clone(), "P:app:Kalpha1"),
            sound(c.clone(), "section 3, lemma K"),
        ),
        row(
            "K_alpha2",
            At::Data,
            printed(gains::k_alpha_2_printed(k, &data.alpha, &data.period), &second(c), "P:app:Kalpha2"),
            sound(second(k), "section 3, lemma K"),
            sound(second(c), "section 3, lemma K"),
        ),
        row("Nbar", At::Data, sound(data.n_bar.clone(), "P:eq:sequence_nzk"), None, None),
        row(
            "beta",
            At::Common,
            sound(beta.clone(), "P:eq:beta_definition"),
            sound(beta, "P:eq:beta_definition"),
            sound(gains::zero_mean_gain(&common.sigma, &data.period), "section 10.2, bt"),
        ),
        row("tau", At::Common, None, None, sound(gains::tau(&common.sigma, &data.period), "section 3")),
    ]
}

pub(super) fn contraction_rows(data: &Data<'_>, common: &Common<'_>) -> Vec<Row> {
    let paper = common.bounds.contraction(data, &common.k_alpha, 2, &gains::beta(&common.sigma, &data.period));
    let sharp = &common.own.contraction;
    let label = "P:eq:def_ypsilon";
    let three = |name: &str, of: &dyn Fn(&ContractionMatrix<Enclosure>) -> Enclosure| {
        row(
            name,
            At::Common,
            sound(of(&paper), label),
            sound(of(&paper), label),
            sound(of(sharp), "section 10.3, uniqueness"),
        )
    };
    let mut rows = vec![
        three("Upsilon_xx", &|m| m.xx.clone()),
        three("Upsilon_xe", &|m| m.xe.clone()),
        three("Upsilon_ex", &|m| m.ex.clone()),
        three("Upsilon_ee", &|m| m.ee.clone()),
        three("spectral radius of Upsilon", &|m| m.spectral_radius()),
        three("1 - tr + det", &|m| m.jury_first()),
    ];
    rows.push(row(
        "second Jury quantity",
        At::Common,
        number(paper.jury_second_printed(), Status::PrintedUnsound, "P:eq:ypsilon_xx, 1 + det"),
        sound(paper.jury_second(), "section 4, 1 - det"),
        sound(sharp.jury_second(), "section 10.3, 1 - det"),
    ));
    rows
}

pub(super) fn transfer_rows(data: &Data<'_>, common: &Common<'_>) -> Vec<Row> {
    let (transfer, closed) = (&common.transfer, &common.closed);
    // The printed pair is believed only where both members dominate the closed form.
    let dominates = transfer.kappa_0.ge(&closed[0]).and(transfer.kappa_1.ge(&closed[1]));
    let status = if dominates.is_true() { Status::Sound } else { Status::PrintedUnsound };
    let mut rows = vec![
        row("S", At::Data, number(transfer.s.clone(), status, "P:29"), None, None),
        row("a", At::Data, number(transfer.a.clone(), status, "P:30"), None, None),
        row("varpi", At::Data, number(transfer.varpi.clone(), status, "P:31"), None, None),
    ];
    for m in [1, 2, 3] {
        if let Some((low, high)) = lambda_interval(transfer, m) {
            let name = format!("lambda interval, m = {m}");
            let span = Entry { value: Value::Span(low.hull(&high)), status, source: "P:eq:ineq_lambda" };
            rows.push(row(&name, At::Data, Some(span), None, None));
        }
    }
    rows.push(row(
        "kappa_0",
        At::Common,
        number(transfer.kappa_0.clone(), status, "P:lemma:transfer_function"),
        sound(closed[0].clone(), "section 2, closed form / w^2"),
        sound(common.sharp[0].clone(), "section 2, k0/w^2"),
    ));
    rows.push(row(
        "kappa_1",
        At::Common,
        number(transfer.kappa_1.clone(), status, "P:lemma:transfer_function"),
        sound(closed[1].clone(), "section 2, closed form / w^4"),
        sound(common.sharp[1].clone(), "section 2, k1/w^4"),
    ));
    rows.push(row(
        "Z",
        At::Common,
        number(common.z_printed.clone(), status, "P:prop:periodic_solution, zeta_p"),
        sound(common.z_repaired.clone(), "section 4"),
        sound(common.own.z.clone(), "section 10.3"),
    ));
    let n_bar = &data.n_bar;
    let paper_r_e = common.bounds.q(data) + n_bar * &common.z_printed;
    let repaired_r_e = common.bounds.q(data) + &data.mu * n_bar * &common.z_repaired;
    let k = &common.k_alpha;
    let gain =
        k * &common.bounds.state.f_e / (&data.alpha - k * &common.bounds.state.f_xx * &common.bounds.state.x_p / 2);
    let own = Psi::new(data, &common.own.excitation);
    rows.push(row(
        "r_e = psi_1",
        At::Common,
        printed(paper_r_e.clone(), &own.psi_1, "P:prop:periodic_solution, r_e"),
        sound(repaired_r_e.clone(), "section 6, with mu"),
        sound(own.psi_1.clone(), "section 6, T R_1/sqrt(12)"),
    ));
    rows.push(row(
        "r_x = psi_x",
        At::Common,
        printed(&gain * paper_r_e, &own.psi_x, "P:prop:periodic_solution, r_x"),
        sound(gain * repaired_r_e, "section 6"),
        sound(own.psi_x.clone(), "section 6, 10.6"),
    ));
    let t_over_two_pi = &data.period / (2 * Enclosure::pi(data.precision));
    let psi_2_printed = t_over_two_pi.sqr() * common.bounds.q(data).sqr();
    let matched = data.spec.internal_model.matched;
    let psi_2 = |value: Enclosure| if matched { sound(value, "section 6, with T") } else { None };
    rows.push(row(
        "psi_2",
        At::Common,
        printed(psi_2_printed.clone(), &own.psi_2, "P:eq:theorem_2_bound_e2"),
        psi_2(&data.period * psi_2_printed),
        psi_2(own.psi_2.clone()),
    ));
    rows
}
