//! The table of constants, in the derivations and at the arguments it names (docs/mathematics.md, sections 2-6).
//!
//! What agrees is the figure, the status and the source that the witnesses of the file determine. A cell of a
//! derivation's own numbers is there only if that derivation's witness is in the file and is proved; a row or a cell that
//! they do not determine differs.

use super::compare::{PRECISE_DIGITS, number, precise, span, stored, text, tolerance};
use super::existence::Existence;
use super::repaired::{Repaired, Witness as RepairedWitness};
use super::unknown;
use proofs_core::bound::Bound;
use proofs_core::constant::Constant;
use proofs_core::data::Data;
use proofs_core::interval::Interval;
use proofs_core::json::{Field, join};
use proofs_core::rules::gains::{beta_s, bt, k_alpha, kappas, tau};
use proofs_core::rules::sharp::{Sharp, Stability, Witness as SharpWitness};
use proofs_core::rules::transfer::closed_form;
use proofs_core::verdict::{Outcome, bad, demand, invalid};
use rug::Rational;

const RULE: &str = "constants";
const DATA: &str = "the data";
const COMMON: &str = "X_p, E_p, sigma of the certificate";
const OWN: &str = "the free numbers of each derivation";

type Holds<'a> = Box<dyn Fn(&Interval) -> Option<bool> + 'a>;

enum Value<'a> {
    Number(Interval),
    /// From the lower end of one number to the upper end of another.
    Span(Interval, Interval),
    /// The largest argument, below the limit if there is one, with a property that holds below it.
    Largest(Holds<'a>, Option<Rational>),
    /// The smallest argument with a property that holds above it, and whether that is every positive one.
    Least(Holds<'a>, Option<bool>),
    /// No solution; the text up to and after a figure, which bounds the number from above (true) or below.
    Reason(&'static str, Interval, bool, &'static str),
}

type Cell<'a> = Option<(Value<'a>, bool, &'static str)>;
type Row<'a> = (String, &'static str, [Cell<'a>; 3]);

fn sound<'a>(value: &Interval, source: &'static str) -> Cell<'a> {
    Some((Value::Number(value.clone()), true, source))
}

/// A printed figure is sound where it certainly dominates a sound one.
fn printed<'a>(value: &Interval, dominated: &Interval, source: &'static str) -> Cell<'a> {
    Some((Value::Number(value.clone()), dominated.le(value) == Some(true), source))
}

/// What the table is made from.
pub struct Input<'a> {
    /// The derivation of the claim.
    pub sharp: (&'a SharpWitness, &'a Sharp),
    /// The repaired derivation, where it is proved.
    pub repaired: Option<(&'a RepairedWitness, &'a Repaired)>,
    /// sigma*_oo, where it is proved.
    pub regulation: Option<&'a Rational>,
}

/// Rows that all derivations evaluate at X_p, E_p, sigma of the claim.
fn common<'a>(d: &'a Data<'a>, input: &Input<'_>) -> Vec<Row<'a>> {
    let (w, proved) = input.sharp;
    let [x_p, e_p, sigma, k0, k1] =
        [&w.free.x_p, &w.free.e_p, &w.sigma, &w.free.k0, &w.free.k1].map(|value| d.number(value));
    let ex = Existence::new(d, x_p.clone(), e_p);
    let (k, beta) = (k_alpha(d), beta_s(d, &sigma) * 2);
    let mut rows: Vec<Row<'a>> = Vec::new();
    let mut row = |name: &str, at, cells| rows.push((name.to_owned(), at, cells));

    let root = ((&d.alpha * d.period.only() / 2).coth() / 2).sqrt();
    let (label, lemma) = ("P:app:Kalpha1", "section 3, lemma K");
    row("K_alpha", DATA, [sound(&k, label), sound(&k, label), sound(&d.c, lemma)]);
    let (slip, least) = (&k * &root * d.period.only().sqrt(), &d.c * &root);
    row("K_alpha2", DATA, [printed(&slip, &least, "P:app:Kalpha2"), sound(&(&k * &root), lemma), sound(&least, lemma)]);
    row("Nbar", DATA, [sound(&d.n_bar, "P:eq:sequence_nzk"), None, None]);
    let label = "P:eq:beta_definition";
    row("beta", COMMON, [sound(&beta, label), sound(&beta, label), sound(&bt(d, &sigma), "section 10.2, bt")]);
    row("tau", COMMON, [None, None, sound(&tau(d, &sigma), "section 3")]);

    let derived = |m: [Interval; 4]| {
        let (trace, determinant) = (&m[0] + &m[3], &m[0] * &m[3] - &m[1] * &m[2]);
        let radius = &trace / 2 + (((&m[0] - &m[3]) / 2).sqr() + &m[1] * &m[2]).sqrt();
        let [xx, xe, ex, ee] = m;
        ([xx, xe, ex, ee, radius, 1 - trace + &determinant], determinant)
    };
    let (paper, paper_det) = derived(ex.contraction(d, &k, &beta));
    let [c, alpha] = &d.existence;
    let gain = c / alpha;
    let sg = (sigma.sqr() + d.period.slowest().sqr()).sqrt();
    let at_box = |which| d.bound(which, &ex.x_p, &ex.e_p);
    let bent = at_box(Bound::Fex) * &ex.e_p + d.bound(Bound::Fxx, &ex.x_p, &d.int(0)) * &ex.x_p;
    let (sharp, sharp_det) =
        derived([&gain * bent, gain * at_box(Bound::Fe), at_box(Bound::Qx) / &sg, at_box(Bound::Qe) / sg]);
    let names = ["Upsilon_xx", "Upsilon_xe", "Upsilon_ex", "Upsilon_ee", "spectral radius of Upsilon", "1 - tr + det"];
    for ((name, paper), sharp) in names.iter().zip(&paper).zip(&sharp) {
        let label = "P:eq:def_ypsilon";
        row(name, COMMON, [sound(paper, label), sound(paper, label), sound(sharp, "section 10.3, uniqueness")]);
    }
    let slip = Some((Value::Number(1 + &paper_det), false, "P:eq:ypsilon_xx, 1 + det"));
    let label = "section 4, 1 - det";
    let of_sharp = sound(&(1 - sharp_det), "section 10.3, 1 - det");
    row("second Jury quantity", COMMON, [slip, sound(&(1 - paper_det), label), of_sharp]);

    // The paper's transfer lemma is believed only where both its kappas dominate the closed form.
    let third = d.weight(2) * 3;
    let s = &d.n_0 / &d.n_1 + &d.n_0 / third + d.ratio(10, 3);
    let a = ((d.int(2).sqrt() + 2) * &s).max(&d.ratio(25, 8));
    let varpi = ((&a + 2) * 48).recip();
    let closed = closed_form(d);
    let closed = kappas(d, &closed[0], &closed[1]);
    let lemma = [&d.n_0 * 7 / 2, &d.n_0 * 4 / varpi.sqr() + 512 / (d.mu.sqr() * &d.n_1)];
    let believed = [0, 1].iter().all(|&i| closed[i].le(&lemma[i]) == Some(true));
    let as_printed = |value: &Interval, source| Some((Value::Number(value.clone()), believed, source));
    row("S", DATA, [as_printed(&s, "P:29"), None, None]);
    row("a", DATA, [as_printed(&a, "P:30"), None, None]);
    row("varpi", DATA, [as_printed(&varpi, "P:31"), None, None]);
    for m in 1..4 {
        let range = Value::Span(&varpi / m, d.ratio(1, 5));
        row(&format!("lambda interval, m = {m}"), DATA, [Some((range, believed, "P:eq:ineq_lambda")), None, None]);
    }
    let own = kappas(d, &k0, &k1);
    let sources =
        [["section 2, closed form / w^2", "section 2, k0/w^2"], ["section 2, closed form / w^4", "section 2, k1/w^4"]];
    for (i, [for_closed, for_own]) in sources.into_iter().enumerate() {
        let label = "P:lemma:transfer_function";
        let cells = [as_printed(&lemma[i], label), sound(&closed[i], for_closed), sound(&own[i], for_own)];
        row(["kappa_0", "kappa_1"][i], COMMON, cells);
    }
    let [z_printed, z_repaired] = [&lemma, &closed].map(|kappa| ex.z_squared_paper(d, kappa).sqrt());
    let cells = [
        as_printed(&z_printed, "P:prop:periodic_solution, zeta_p"),
        sound(&z_repaired, "section 4"),
        sound(&proved.evaluated.sizes.zeta, "section 10.3"),
    ];
    row("Z", COMMON, cells);
    let [r_printed, r_repaired] = [&ex.q + &d.n_bar * z_printed, &ex.q + &d.mu * &d.n_bar * z_repaired];
    let psi = d.period.only() * &proved.solution.rates[1] / d.int(12).sqrt();
    let cells = [
        printed(&r_printed, &psi, "P:prop:periodic_solution, r_e"),
        sound(&r_repaired, "section 6, with mu"),
        sound(&psi, "section 6, T R_1/sqrt(12)"),
    ];
    row("r_e = psi_1", COMMON, cells);
    let gain = &k * &ex.f_e / (&d.alpha - &k * &ex.f_xx * &ex.x_p / 2);
    let psi_x = &proved.solution.x_gain * psi;
    let cells = [
        printed(&(&gain * r_printed), &psi_x, "P:prop:periodic_solution, r_x"),
        sound(&(gain * r_repaired), "section 6"),
        sound(&psi_x, "section 6, 10.6"),
    ];
    row("r_x = psi_x", COMMON, cells);
    let [psi_2_paper, psi_2] =
        [&ex.q, &proved.solution.rates[0]].map(|q| (d.period.only() / (Interval::pi(d.precision) * 2)).sqr() * q.sqr());
    let psi_2 = psi_2 * d.period.only();
    let matched = |value: Interval| if d.spec.regulator.matched { sound(&value, "section 6, with T") } else { None };
    let label = "P:eq:theorem_2_bound_e2";
    row(
        "psi_2",
        COMMON,
        [printed(&psi_2_paper, &psi_2, label), matched(&psi_2_paper * d.period.only()), matched(psi_2)],
    );

    let limit = |i: usize| d.spec.domain.as_ref().and_then(|ends: &[Constant; 2]| ends[i].rational());
    let largest_x = |gain: Interval, source| {
        let holds: Holds<'a> = Box::new(move |x| (&gain * d.bound(Bound::Fxx, x, &d.int(0)) * x).lt(&d.alpha));
        Some((Value::Largest(holds, limit(0)), true, source))
    };
    let label = "P:prop:periodic_solution";
    row("x_p*", DATA, [largest_x(&k * 2, label), largest_x(&k * 2, label), None]);
    let largest_e = || -> Cell<'a> {
        let x_p = x_p.clone();
        let invariance = &d.alpha / &k * &x_p - &ex.f_xx * x_p.sqr() / 2;
        let contraction = &d.alpha / &k - &ex.f_xx * &x_p * 2;
        let holds: Holds<'a> = Box::new(move |e| {
            let first = (e * d.bound(Bound::Fe, &x_p, e)).le(&invariance);
            both(first, (e * d.bound(Bound::Fex, &x_p, e)).lt(&contraction))
        });
        Some((Value::Largest(holds, limit(1)), true, label))
    };
    row("e_p*(X_p)", COMMON, [largest_e(), largest_e(), None]);
    rows
}

fn both(a: Option<bool>, b: Option<bool>) -> Option<bool> {
    match (a, b) {
        (Some(false), _) | (_, Some(false)) => Some(false),
        (Some(true), Some(true)) => Some(true),
        _ => None,
    }
}

/// C2 and C3 of the repaired derivation at (X_p, E_p) as a property of sigma.
fn sigma_p<'a>(d: &'a Data<'a>, ex: &'a Existence) -> Value<'a> {
    let [xx, xe, ex_unit, ee] = ex.contraction(d, &k_alpha(d), &d.int(1));
    // From 1 - tr + det > 0: beta ((1 - A) b_qe + B b_qx) < 1 - A.
    let free = 1 - xx;
    let demand = &free * ee + xe * ex_unit;
    // As sigma tends to 0, beta grows beyond all bounds.
    let contracts = both(demand.is_zero().then_some(true), d.int(0).le(&free));
    let at_zero = both(ex.q.is_zero().then_some(true), contracts);
    let holds = move |sigma: &Interval| {
        let gain = beta_s(d, sigma) * 2;
        both((&gain * &ex.q).le(&ex.e_p), (gain * &demand).le(&free))
    };
    Value::Least(Box::new(holds), at_zero)
}

/// Rows in which each derivation has its own free numbers. (The printed figures at the paper's own free numbers are in
/// the report only: no claim rests on them.)
fn own<'a>(d: &'a Data<'a>, input: &Input<'a>) -> Vec<Row<'a>> {
    let mut rows: Vec<Row<'a>> = Vec::new();
    let reached = d.ratio(7, 2) * (d.int(2).sqrt() * 3 / &d.c + (d.c.sqr() * 2).recip());
    let no_level = |source| -> Cell<'a> {
        let before = "P:eq:boundx_bounde_1 has no solution x_a, e_a > 0: multiplying its two parts gives 81 <= 3.5 (3 sqrt(2)/c + 1/(2 c^2)), which is at most ";
        let after = " for c = sqrt(P_up/P_low) of this specification (E1)";
        let reason = Value::Reason(before, reached.clone(), true, after);
        (reached.lt(&d.int(81)) == Some(true)).then_some((reason, false, source))
    };
    let mut row = |name: &str, cells| rows.push((name.to_owned(), OWN, cells));
    row("x_a, e_a of P:eq:boundx_bounde_1", [no_level("P:eq:boundx_bounde_1"), None, None]);
    let (w, s) = input.sharp;
    let r = input.repaired;
    for (i, name) in ["X_b", "E_b"].into_iter().enumerate() {
        let sharp = sound([&s.error_box.x_b, &s.error_box.e_b][i], "section 5");
        row(name, [None, r.and_then(|(_, r)| sound(&r.arguments[i], "section 5")), sharp]);
    }
    for (i, name) in ["rho_0", "rho_11", "rho_12", "rho_22"].into_iter().enumerate() {
        let label = if i == 0 { "section 5" } else { "P:eq:R-lyap2" };
        row(name, [None, r.and_then(|(_, r)| sound(&r.rho[i], label)), None]);
    }
    row("gam", [None, None, sound(&s.error_box.gam, "section 5, C5")]);
    let free = |value: &Rational| sound(&d.number(value), "section 5, free");
    row("h", [None, r.and_then(|(w, _)| free(&w.h)), free(&w.free.h)]);
    for (i, name) in ["w_x", "D_x", "D_e"].into_iter().enumerate() {
        row(name, [None, None, free([&w.free.w_x, &w.free.d_x, &w.free.d_e][i])]);
    }
    let (a_1, means) = &s.solution.shown;
    let ours = ["a_1", "r_x", "r_e", "r_d", "R_q", "R_1"].into_iter();
    for (name, value) in ours.zip(std::iter::once(a_1).chain(means).chain(&s.solution.rates)) {
        row(name, [None, None, sound(value, "section 10.3")]);
    }
    row("a_2", [None, None, sound(&s.error_box.rate, "section 10.1")]);
    for (i, name) in ["first minor of R", "second minor of R", "third minor of R"].into_iter().enumerate() {
        row(name, [None, r.and_then(|(_, r)| sound(&r.minors[i], "P:eq:R-lyap1")), None]);
    }
    let label = "section 4, C2 and C3 with beta, K_alpha";
    row("sigma_p*", [None, r.map(|(_, r)| (sigma_p(d, &r.existence), true, label)), None]);
    let section = match w.stability {
        Stability::Norms => "section 5, C5",
        Stability::Matrix(_) => "section 13.7, (M)",
        Stability::Joint(_) => "section 13.7, (Jm)",
    };
    let threshold = sound(&s.threshold, section);
    row("sigma_a*", [None, r.and_then(|(_, r)| sound(&r.sigma_a, "section 5")), threshold]);
    for (i, (name, size)) in w.free.set.named().enumerate() {
        let covered = |size: &Rational| sound(&d.number(size), "section 5, the set that is covered");
        let repaired = r.and_then(|(w, _)| w.set.named().nth(i)).and_then(|(_, size)| covered(size));
        row(name, [None, repaired, covered(size)]);
    }
    let gain = |sigma: &Rational| sound(&d.number(sigma), "section 5");
    row("sigma*", [no_level("P:thm1"), r.and_then(|(w, _)| gain(&w.sigma)), gain(&w.sigma)]);
    let ratio = &d.p_up / &d.p_low;
    let before = "P:eq:bound_xe_inf has no solution: it needs P_up/P_low <= (6 + 4 sqrt(2))/9 = 1.2952, here at least ";
    let refuted = ((d.int(2).sqrt() * 4 + 6) / 9).lt(&ratio) == Some(true);
    let reason = (Value::Reason(before, ratio, false, " (E2)"), false, "P:eq:bound_sigma_inf");
    let exact = input.regulation.and_then(|sigma| sound(&d.number(sigma), "section 6"));
    row("sigma*_oo", [refuted.then_some(reason), None, exact]);
    rows
}

/// From a plant's formulas only the data of the sharp derivation are computed: what rests on others has no value.
fn of_a_plant([_, _, sharp]: [Cell<'_>; 3]) -> [Cell<'_>; 3] {
    let bounded = |(value, ..): &(Value<'_>, bool, &str)| matches!(value, Value::Number(value) if value.is_bounded());
    [None, None, sharp.filter(bounded)]
}

/// Compares the stored table with the computed one; `note` receives each cell. With an interval of the input gain or
/// the period it has no rows: printed and repaired figures are about one number of each.
pub fn check(d: &Data<'_>, table: &Field<'_>, input: &Input<'_>, note: &mut dyn FnMut(String, Outcome<()>)) {
    let mut stored = match table.fields() {
        Ok(stored) => stored,
        Err(finding) => return note(table.pointer.clone(), Err(finding)),
    };
    if super::is_family(d) {
        return unknown(stored, note);
    }
    for (name, at, mut row) in common(d, input).into_iter().chain(own(d, input)) {
        if d.spec.plant.is_some() {
            row = of_a_plant(row);
        }
        if row.iter().all(Option::is_none) {
            continue;
        }
        let place = join(&table.pointer, &name);
        let mut fields = match stored.required(&name).and_then(|field| field.fields()) {
            Ok(fields) => fields,
            Err(finding) => {
                note(place, Err(finding));
                continue;
            }
        };
        note(join(&place, "evaluated_at"), fields.required("evaluated_at").and_then(|field| text(&field, at)));
        for (derivation, cell) in ["printed", "repaired", "sharp"].into_iter().zip(row) {
            let Some(expected) = cell else { continue };
            let outcome = match fields.optional(derivation) {
                None => bad(&place, format!("the field `{derivation}` is missing")),
                Some(field) => entry(d, &field, expected),
            };
            note(join(&place, derivation), outcome);
        }
        unknown(fields, note);
    }
    unknown(stored, note);
}

/// One cell: its figure or reason, its status and its source.
fn entry(d: &Data<'_>, field: &Field<'_>, (value, is_sound, source): (Value<'_>, bool, &str)) -> Outcome<()> {
    let mut cell = field.fields()?;
    let status = match (is_sound, &value) {
        (true, _) => "sound",
        (false, Value::Reason(..)) => "printed, infeasible",
        (false, _) => "printed, unsound",
    };
    text(&cell.required("status")?, status)?;
    text(&cell.required("source")?, source)?;
    compare(d, &mut cell, value)?;
    cell.finish()
}

fn compare(d: &Data<'_>, cell: &mut proofs_core::json::Fields<'_>, value: Value<'_>) -> Outcome<()> {
    match value {
        Value::Number(value) => {
            let field = cell.required("value")?;
            precise(&field, &value).and_then(|()| span(&field, &value, &value))
        }
        Value::Span(low, high) => {
            let field = cell.required("value")?;
            precise(&field, &low).and_then(|()| precise(&field, &high)).and_then(|()| span(&field, &low, &high))
        }
        Value::Reason(before, value, above, after) => reason(&cell.required("reason")?, before, &value, above, after),
        Value::Least(holds, at_zero) => {
            threshold(&cell.required("value")?, &|at| holds(at).map(|holds| !holds), at_zero)
        }
        Value::Largest(holds, limit) => {
            let top = limit.clone().unwrap_or_else(|| Rational::from(1) << 200);
            let words = match holds(&d.number(&top)) {
                Some(true) if limit.is_some() => "the whole domain",
                Some(true) => "unbounded",
                None => "not decided",
                Some(false) if holds(&d.number(&(top >> 400))) == Some(true) => {
                    return threshold(&cell.required("value")?, &*holds, Some(false));
                }
                Some(false) => "no positive value",
            };
            text(&cell.required("reason")?, words)
        }
    }
}

/// A number that is the boundary of a property: it holds just below the stored enclosure and not just above, or the
/// other way round. Nothing is searched. `at_zero`: whether the property changes at no positive number.
fn threshold(field: &Field<'_>, below: &dyn Fn(&Interval) -> Option<bool>, at_zero: Option<bool>) -> Outcome<()> {
    let ends = field.elements()?;
    let [lo, hi] = &ends[..] else { return invalid(RULE, &field.pointer, "expected [lower end, upper end]") };
    let (low, high) = (stored(lo)?, stored(hi)?);
    if low.is_zero() && high.is_zero() {
        return demand(at_zero, RULE, &field.pointer, "the property holds for every positive number");
    }
    let room = tolerance(&high, 15);
    let ordered = low.is_positive() && low.le(&high) == Some(true);
    // Or as narrow as the data let it be: in its middle quarter the property is open at this precision.
    let width = &high - &low;
    let open = |at: Interval| below(&at).is_none();
    let within = width.le(&tolerance(&high, PRECISE_DIGITS)) == Some(true);
    let narrow =
        width.le(&room) == Some(true) || (within && open(&low + &width * 3 / 8) && open(&high - &width * 3 / 8));
    let what =
        "the property that defines this number changes inside the stored enclosure, which is as narrow as its digits";
    let begins = below(&(&low - &room));
    let ends = below(&(&high + &room)).map(|holds| !holds);
    demand(both(Some(ordered && narrow), both(begins, ends)), RULE, &field.pointer, what).map_err(|mut finding| {
        let sides = [low, high].map(|end| proofs_core::verdict::shown(&end));
        finding.sides = Some([sides.join(" to "), "-".to_owned(), "-".to_owned()]);
        finding
    })
}

/// A reason with a figure of six digits, which bounds the number from the side that the words say.
fn reason(field: &Field<'_>, before: &str, value: &Interval, above: bool, after: &str) -> Outcome<()> {
    precise(field, value)?;
    let words = field.text()?;
    let figure = words.strip_prefix(before).and_then(|rest| rest.strip_suffix(after)).and_then(number);
    let right = figure.is_some_and(|figure| {
        // An exact number bounds itself, whatever rounding makes of it here.
        let wrong = if above { figure.lt(value) } else { value.lt(&figure) };
        wrong != Some(true) && (figure - value).abs().le(&tolerance(value, 5)) == Some(true)
    });
    if right {
        Ok(())
    } else {
        let expected = format!("it should read: {before}(a bound of {}){after}", proofs_core::verdict::shown(value));
        invalid(RULE, &field.pointer, expected)
    }
}
