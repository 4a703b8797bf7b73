//! Every named constant in the three derivations, side by side.

use super::consequences::Psi;
use super::data::{Bound, Data};
use super::existence::{PeriodicBounds, kappas};
use super::gains;
use super::printed::{Infeasible, PrintedEvaluation, level_condition};
use super::repaired::{LyapunovMatrix, RepairedEvaluation};
use super::sharp::SharpEvaluation;
use crate::enclosure::Enclosure;
use crate::transfer::{PrintedTransfer, closed_form_pair, lambda_interval, printed_transfer};
use rug::Rational;

/// A value of the table.
#[derive(Clone, Debug)]
pub enum Value {
    /// An enclosure.
    Number(Enclosure),
    /// The defining condition has no solution.
    Infeasible(String),
    /// There is no value here, for the stated reason.
    Unavailable(String),
}

/// What a value is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// A theorem rests on it: the derivation proves that it bounds what it says.
    Sound,
    /// Printed, and not proved (or refuted) for these data.
    PrintedUnsound,
    /// Printed, and without a solution.
    PrintedInfeasible,
}

impl Status {
    /// The word in certificates.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Status::Sound => "sound",
            Status::PrintedUnsound => "printed, unsound",
            Status::PrintedInfeasible => "printed, infeasible",
        }
    }
}

/// One cell of the table.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The value.
    pub value: Value,
    /// What it is worth.
    pub status: Status,
    /// The paper's label or the section of the derivation.
    pub source: &'static str,
}

/// One constant.
#[derive(Clone, Debug)]
pub struct Row {
    /// Its name.
    pub name: String,
    /// Where it is evaluated.
    pub at: At,
    /// As printed.
    pub printed: Option<Entry>,
    /// Repaired.
    pub repaired: Option<Entry>,
    /// Sharp.
    pub sharp: Option<Entry>,
}

/// Where a row is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// From the specification alone.
    Data,
    /// All three columns at X_p, E_p, sigma of the certificate, so that they differ by the formula only.
    Common,
    /// Each column at the free numbers that its own derivation found best.
    Own,
}

impl At {
    /// The word in certificates and reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            At::Data => "the data",
            At::Common => "X_p, E_p, sigma of the certificate",
            At::Own => "the free numbers of each derivation",
        }
    }
}

/// What the table is made from.
pub struct TableInput<'a> {
    /// The data.
    pub data: &'a Data<'a>,
    /// X_p, E_p, sigma for the common rows.
    pub common: [Rational; 3],
    /// k0, k1 proved for the sharp derivation.
    pub sharp_pair: (Rational, Rational),
    /// The sharp evaluation, when there is one.
    pub sharp: Option<&'a SharpEvaluation>,
    /// h, w_x, D_x, D_e of the sharp witness.
    pub sharp_free: Option<[Rational; 4]>,
    /// The repaired evaluation, when there is one.
    pub repaired: Option<&'a RepairedEvaluation>,
    /// The printed evaluation at its own free numbers, when some were found.
    pub printed: Option<&'a PrintedEvaluation>,
    /// The claimed sigma of each derivation: printed figure, repaired, sharp.
    pub sigmas: [Option<Enclosure>; 3],
    /// sigma*_oo.
    pub sigma_exact: Option<Rational>,
}

fn number(value: Enclosure, status: Status, source: &'static str) -> Option<Entry> {
    Some(Entry { value: Value::Number(value), status, source })
}

fn sound(value: Enclosure, source: &'static str) -> Option<Entry> {
    number(value, Status::Sound, source)
}

/// A printed value: sound where it certainly dominates a sound one.
fn printed(value: Enclosure, dominates: &Enclosure, source: &'static str) -> Option<Entry> {
    let status = if value.ge(dominates).is_true() { Status::Sound } else { Status::PrintedUnsound };
    number(value, status, source)
}

fn infeasible(reason: &Infeasible, source: &'static str) -> Option<Entry> {
    Some(Entry { value: Value::Infeasible(reason.to_string()), status: Status::PrintedInfeasible, source })
}

fn row(name: &str, at: At, printed: Option<Entry>, repaired: Option<Entry>, sharp: Option<Entry>) -> Row {
    Row { name: name.to_owned(), at, printed, repaired, sharp }
}

/// Builds the table.
#[must_use]
pub fn table(input: &TableInput<'_>) -> Vec<Row> {
    let data = input.data;
    let [x_p, e_p, sigma] = input.common.each_ref().map(|value| data.rational(value));
    let common = Common::new(input, x_p, e_p, sigma);
    let mut rows = gain_rows(data, &common);
    rows.extend(contraction_rows(data, &common));
    rows.extend(transfer_rows(input, &common));
    rows.extend(size_rows(data, &common));
    rows.extend(own_rows(input));
    rows
}

/// The three derivations at common arguments.
struct Common {
    sigma: Enclosure,
    bounds: PeriodicBounds,
    k_alpha: Enclosure,
    closed: (Enclosure, Enclosure),
    sharp: (Enclosure, Enclosure),
    transfer: PrintedTransfer,
    z_printed: Enclosure,
    z_repaired: Enclosure,
    z_sharp: Enclosure,
}

impl Common {
    fn new(input: &TableInput<'_>, x_p: Enclosure, e_p: Enclosure, sigma: Enclosure) -> Common {
        let data = input.data;
        let bounds = PeriodicBounds::new(data, x_p, e_p);
        let (k0, k1) = closed_form_pair(data);
        let closed = kappas(data, &k0, &k1);
        let sharp = kappas(data, &data.rational(&input.sharp_pair.0), &data.rational(&input.sharp_pair.1));
        let transfer = printed_transfer(data);
        Common {
            k_alpha: gains::k_alpha(&data.c, &data.alpha, &data.period),
            z_printed: bounds.z_squared_printed(data, &transfer.kappa_0, &transfer.kappa_1).sqrt(),
            z_repaired: bounds.z_squared_printed(data, &closed.0, &closed.1).sqrt(),
            z_sharp: bounds.z_squared_sharp(data, &sharp.0, &sharp.1).sqrt(),
            sigma,
            bounds,
            closed,
            sharp,
            transfer,
        }
    }
}

fn gain_rows(data: &Data<'_>, common: &Common) -> Vec<Row> {
    let (k, c) = (&common.k_alpha, &data.c);
    let second = |k: &Enclosure| gains::k_alpha_2(k, &data.alpha, &data.period);
    let beta = gains::beta(&common.sigma, &data.period);
    vec![
        row(
            "K_alpha",
            At::Data,
            sound(k.clone(), "P:app:Kalpha1"),
            sound(k.clone(), "P:app:Kalpha1"),
            sound(gains::k_alpha_sharp(c), "section 3, lemma K"),
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
            sound(gains::beta_s(&common.sigma, &data.period), "section 3, beta_s"),
        ),
        row("tau", At::Common, None, None, sound(gains::tau(&common.sigma, &data.period), "section 3")),
    ]
}

fn contraction_rows(data: &Data<'_>, common: &Common) -> Vec<Row> {
    let paper = common.bounds.contraction(data, &common.k_alpha, 2, &gains::beta(&common.sigma, &data.period));
    let sharp = common.bounds.contraction(data, &data.c, 1, &gains::beta_s(&common.sigma, &data.period));
    let label = "P:eq:def_ypsilon";
    let three = |name: &str, of: &dyn Fn(&super::contraction::ContractionMatrix) -> Enclosure| {
        row(name, At::Common, sound(of(&paper), label), sound(of(&paper), label), sound(of(&sharp), "section 4, C3"))
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
        sound(sharp.jury_second(), "section 4, 1 - det"),
    ));
    rows
}

fn transfer_rows(input: &TableInput<'_>, common: &Common) -> Vec<Row> {
    let data = input.data;
    let (transfer, closed) = (&common.transfer, &common.closed);
    // The printed pair is believed only where both members dominate the closed form.
    let dominates = transfer.kappa_0.ge(&closed.0).and(transfer.kappa_1.ge(&closed.1));
    let status = if dominates.is_true() { Status::Sound } else { Status::PrintedUnsound };
    let mut rows = vec![
        row("S", At::Data, number(transfer.s.clone(), status, "P:29"), None, None),
        row("a", At::Data, number(transfer.a.clone(), status, "P:30"), None, None),
        row("varpi", At::Data, number(transfer.varpi.clone(), status, "P:31"), None, None),
    ];
    for m in [1, 2, 3] {
        if let Some((low, high)) = lambda_interval(transfer, m) {
            let name = format!("lambda interval, m = {m}");
            rows.push(row(&name, At::Data, number(low.hull(&high), status, "P:eq:ineq_lambda"), None, None));
        }
    }
    rows.push(row(
        "kappa_0",
        At::Common,
        number(transfer.kappa_0.clone(), status, "P:lemma:transfer_function"),
        sound(closed.0.clone(), "section 2, closed form / w^2"),
        sound(common.sharp.0.clone(), "section 2, k0/w^2"),
    ));
    rows.push(row(
        "kappa_1",
        At::Common,
        number(transfer.kappa_1.clone(), status, "P:lemma:transfer_function"),
        sound(closed.1.clone(), "section 2, closed form / w^4"),
        sound(common.sharp.1.clone(), "section 2, k1/w^4"),
    ));
    let z_status = if dominates.is_true() { Status::Sound } else { Status::PrintedUnsound };
    rows.push(row(
        "Z",
        At::Common,
        number(common.z_printed.clone(), z_status, "P:prop:periodic_solution, zeta_p"),
        sound(common.z_repaired.clone(), "section 4"),
        sound(common.z_sharp.clone(), "section 4"),
    ));
    let n_bar = &data.n_bar;
    let paper_r_e = &common.bounds.q + n_bar * &common.z_printed;
    let repaired_r_e = &common.bounds.q + &data.mu * n_bar * &common.z_repaired;
    let k = &common.k_alpha;
    let gain = k * &common.bounds.f_e / (&data.alpha - k * &common.bounds.f_xx * &common.bounds.x_p / 2);
    let psi = Psi::new(data, &common.bounds);
    rows.push(row(
        "r_e = psi_1",
        At::Common,
        printed(paper_r_e.clone(), &psi.psi_1, "P:prop:periodic_solution, r_e"),
        sound(repaired_r_e.clone(), "section 6, with mu"),
        sound(psi.psi_1, "section 6, T q1/sqrt(12)"),
    ));
    rows.push(row(
        "r_x = psi_x",
        At::Common,
        printed(&gain * paper_r_e, &psi.psi_x, "P:prop:periodic_solution, r_x"),
        sound(gain * repaired_r_e, "section 6"),
        sound(psi.psi_x, "section 6"),
    ));
    let t_over_two_pi = &data.period / (2 * Enclosure::pi(data.precision));
    let psi_2_printed = t_over_two_pi.sqr() * common.bounds.q.sqr();
    let matched = data.spec.internal_model.matched;
    let psi_2 = |value: Enclosure| if matched { sound(value, "section 6, with T") } else { None };
    rows.push(row(
        "psi_2",
        At::Common,
        printed(psi_2_printed.clone(), &psi.psi_2, "P:eq:theorem_2_bound_e2"),
        psi_2(&data.period * psi_2_printed),
        psi_2(psi.psi_2),
    ));
    rows
}

fn size_rows(data: &Data<'_>, common: &Common) -> Vec<Row> {
    let k = &common.k_alpha;
    let limit = |gain: &Enclosure, factor: i64| largest_x(data, gain, factor);
    let double = |gain: &Enclosure| gain * 2;
    let mut rows = vec![row(
        "x_p*",
        At::Data,
        limit(&double(k), 1).map(|value| Entry { value, status: Status::Sound, source: "P:prop:periodic_solution" }),
        limit(&double(k), 1).map(|value| Entry { value, status: Status::Sound, source: "P:prop:periodic_solution" }),
        limit(&data.c, 1).map(|value| Entry { value, status: Status::Sound, source: "section 4, C3" }),
    )];
    let e_limit = |gain: &Enclosure, factor: i64| largest_e(data, gain, factor, &common.bounds);
    rows.push(row(
        "e_p*(X_p)",
        At::Common,
        e_limit(k, 2).map(|value| Entry { value, status: Status::Sound, source: "P:prop:periodic_solution" }),
        e_limit(k, 2).map(|value| Entry { value, status: Status::Sound, source: "P:prop:periodic_solution" }),
        e_limit(&data.c, 1).map(|value| Entry { value, status: Status::Sound, source: "section 4, C1 and C3" }),
    ));
    rows
}

/// Encloses the largest argument below `limit` with `holds`, for a property that is true below a threshold, by
/// bisection on certain answers; `None` if it does not certainly hold near 0.
fn threshold(
    data: &Data<'_>,
    limit: Option<Rational>,
    holds: impl Fn(&Enclosure) -> crate::enclosure::Truth,
) -> Option<Value> {
    let at = |value: &Rational| holds(&data.rational(value));
    let mut high = limit.clone().unwrap_or_else(|| Rational::from(1) << 200);
    if at(&high).is_true() {
        return Some(Value::Unavailable(if limit.is_some() {
            "the whole domain".to_owned()
        } else {
            "unbounded".to_owned()
        }));
    }
    let mut low = Rational::from(&high >> 400);
    if !at(&low).is_true() {
        return Some(Value::Unavailable("no positive value".to_owned()));
    }
    // First in the exponent, then in the mantissa: 60 + 60 halvings.
    while high > Rational::from(&low * 2u32) {
        let exponent = |q: &Rational| i64::from(q.numer().significant_bits()) - i64::from(q.denom().significant_bits());
        let shift = ((exponent(&high) - exponent(&low)) / 2).clamp(1, 400) as u32;
        let middle = Rational::from(&low << shift);
        if middle >= high {
            break;
        }
        match at(&middle) {
            crate::enclosure::Truth::True => low = middle,
            crate::enclosure::Truth::False => high = middle,
            crate::enclosure::Truth::Undecided => break,
        }
    }
    for _ in 0..60 {
        let middle = Rational::from(&low + &high) / 2u32;
        match at(&middle) {
            crate::enclosure::Truth::True => low = middle,
            crate::enclosure::Truth::False => high = middle,
            crate::enclosure::Truth::Undecided => break,
        }
    }
    Some(Value::Number(Enclosure::between(&low, &high, data.precision)))
}

/// The X with `gain b_fxx(X,0) X = alpha`: x_p* with gain 2 K_alpha (paper) or c (sharp).
fn largest_x(data: &Data<'_>, gain: &Enclosure, factor: i64) -> Option<Value> {
    let limit = data.spec.domain.as_ref().and_then(|domain| domain.x.as_rational().cloned());
    threshold(data, limit, |x| (factor * (gain * data.bound(Bound::Fxx, x, &data.zero()) * x)).lt(&data.alpha))
}

/// The largest E with the two conditions of e_p*(X_p); factor 2 (paper) or 1 (sharp) in front of b_fxx X_p.
fn largest_e(data: &Data<'_>, gain: &Enclosure, factor: i64, bounds: &PeriodicBounds) -> Option<Value> {
    let limit = data.spec.domain.as_ref().and_then(|domain| domain.e.as_rational().cloned());
    let x_p = &bounds.x_p;
    let invariance = &data.alpha / gain * x_p - &bounds.f_xx * x_p.sqr() / 2;
    let contraction = &data.alpha / gain - factor * (&bounds.f_xx * x_p);
    threshold(data, limit, |e| {
        (e * data.bound(Bound::Fe, x_p, e)).le(&invariance).and((e * data.bound(Bound::Fex, x_p, e)).lt(&contraction))
    })
}

/// The rows in which each derivation has its own free numbers.
fn own_rows(input: &TableInput<'_>) -> Vec<Row> {
    let data = input.data;
    let mut rows = Vec::new();
    let level = level_condition(data).err();
    let from_level = |source| level.as_ref().and_then(|reason| infeasible(reason, source));
    rows.push(row("x_a, e_a of P:eq:boundx_bounde_1", At::Own, from_level("P:eq:boundx_bounde_1"), None, None));
    let sharp_value =
        |of: &dyn Fn(&SharpEvaluation) -> Enclosure, source| input.sharp.and_then(|sharp| sound(of(sharp), source));
    let paper_value = |of: &dyn Fn(&PrintedEvaluation) -> Enclosure, source| {
        input.printed.and_then(|p| number(of(p), Status::PrintedUnsound, source))
    };
    let repaired_value =
        |of: &dyn Fn(&RepairedEvaluation) -> Enclosure, source| input.repaired.and_then(|r| sound(of(r), source));
    let sharp_free =
        |index: usize| input.sharp_free.as_ref().and_then(|free| sound(data.rational(&free[index]), "section 5, free"));
    rows.push(row(
        "X_b",
        At::Own,
        paper_value(&|p| p.point.x_b.clone(), "P:eq:temp_bound_xe2"),
        repaired_value(&|r| r.point.x_b.clone(), "section 5"),
        sharp_value(&|s| s.error_box.x_b.clone(), "section 5"),
    ));
    rows.push(row(
        "E_b",
        At::Own,
        paper_value(&|p| p.point.e_b.clone(), "P:eq:temp_bound_xe2"),
        repaired_value(&|r| r.point.e_b.clone(), "section 5"),
        sharp_value(&|s| s.error_box.e_b.clone(), "section 5"),
    ));
    // rho_0 as printed is sound only where it dominates the repaired form at the same arguments.
    let rho_0 = input.printed.and_then(|p| {
        let repaired = LyapunovMatrix::new(data, &p.point, false);
        printed(p.lyapunov.rho_0.clone(), &repaired.rho_0, "P:eq:def_rho_0")
    });
    rows.push(row("rho_0", At::Own, rho_0, repaired_value(&|r| r.lyapunov.rho_0.clone(), "section 5"), None));
    let label = "P:eq:R-lyap2";
    rows.push(row(
        "rho_11",
        At::Own,
        paper_value(&|p| p.lyapunov.rho_11.clone(), label),
        repaired_value(&|r| r.lyapunov.rho_11.clone(), label),
        None,
    ));
    rows.push(row(
        "rho_12",
        At::Own,
        paper_value(&|p| p.lyapunov.rho_12.clone(), label),
        repaired_value(&|r| r.lyapunov.rho_12.clone(), label),
        None,
    ));
    rows.push(row(
        "rho_22",
        At::Own,
        paper_value(&|p| p.lyapunov.rho_22.clone(), label),
        repaired_value(&|r| r.lyapunov.rho_22.clone(), label),
        None,
    ));
    rows.push(row("gam", At::Own, None, None, sharp_value(&|s| s.error_box.gamma.clone(), "section 5, C5")));
    rows.push(row(
        "h",
        At::Own,
        paper_value(&|p| p.point.h.clone(), "P:eq:ineq_bounds_b"),
        repaired_value(&|r| r.point.h.clone(), "section 5, free"),
        sharp_free(0),
    ));
    rows.push(row("w_x", At::Own, None, None, sharp_free(1)));
    rows.push(row("D_x", At::Own, None, None, sharp_free(2)));
    rows.push(row("D_e", At::Own, None, None, sharp_free(3)));
    for index in 0..3 {
        let name = ["first minor of R", "second minor of R", "third minor of R"][index];
        rows.push(row(
            name,
            At::Own,
            input.printed.zip(input.sigmas[0].as_ref()).and_then(|(p, sigma)| {
                let minors = p.lyapunov.leading_minors(data, sigma, &p.point.h);
                number(minors[index].clone(), Status::PrintedUnsound, "P:eq:R-lyap1")
            }),
            input.repaired.and_then(|r| {
                sound(r.lyapunov.leading_minors(data, &r.sigma, &r.point.h)[index].clone(), "P:eq:R-lyap1")
            }),
            None,
        ));
    }
    let result = |value: &Result<Enclosure, Infeasible>, source| match value {
        Ok(value) => number(value.clone(), Status::PrintedUnsound, source),
        Err(reason) => infeasible(reason, source),
    };
    rows.push(row("sigma_p*", At::Own, input.printed.and_then(|p| result(&p.sigma_p, "P:19")), None, None));
    rows.push(row(
        "sigma_a*",
        At::Own,
        input.printed.and_then(|p| result(&p.sigma_a, "P:eq:ineq_bounds_sigma")),
        repaired_value(&|r| r.lyapunov.sigma_a.clone(), "section 5"),
        sharp_value(&|s| s.decay.sigma_threshold.clone(), "section 5, C5"),
    ));
    let [figure, repaired, sharp] = input.sigmas.clone();
    let printed_sigma = from_level("P:thm1");
    rows.push(row(
        "sigma*",
        At::Own,
        printed_sigma,
        repaired.and_then(|value| sound(value, "section 5")),
        sharp.and_then(|value| sound(value, "section 5")),
    ));
    rows.push(row(
        "sigma* without P:eq:boundx_bounde_1",
        At::Own,
        figure.and_then(|value| number(value, Status::PrintedUnsound, "P:thm1")),
        None,
        None,
    ));
    let exact_printed = super::printed::level_condition_infinite(data).err();
    rows.push(row(
        "sigma*_oo",
        At::Own,
        exact_printed.as_ref().and_then(|reason| infeasible(reason, "P:eq:bound_sigma_inf")),
        None,
        input.sigma_exact.as_ref().and_then(|value| sound(data.rational(value), "section 6")),
    ));
    rows
}
