//! Rules S1-S3: existence and size of the periodic solution by mean squares, without a contraction (docs/mathematics.md,
//! sections 10.3 and 10.4).
//!
//! Guarantee of S1 and S2: for every n_o and every sigma' >= sigma there is a T-periodic solution with sup|x| <= X_p, sup|e| <= E_p,
//! rms(x) <= r_x, rms(e) <= r_e, rms(e') <= r_d. All that `Bounds::at` and `Bounds::means` say of such a solution then holds together,
//! for its own root mean squares rho too: rho <= G(rho), where G is what they say of them. With an inequality of existence its conditions
//! stand in the place of S1b to S2c, and it has a part in G.
//!
//! Guarantee of S3 besides: rho <= r'. For G is nondecreasing and concave with G(0) >= 0 (it is made of constants that are
//! nonnegative, sums and minima), so G(l r') <= l G(r') for l >= 1. If l = max rho_i/r'_i > 1, then rho <= G(rho) <= G(l r') <=
//! l G(r') < l r' in every place, against the choice of l. Strictness matters.

use super::control::{self, Along};
use super::existence::Answer;
use super::gains::{Forced, beta_s, bt, damped, tau, twice_sum};
use super::inequality::Inequality;
use super::stability::one_sided;
use crate::bound::Bound;
use crate::data::Data;
use crate::input_gain::Gain;
use crate::interval::Interval;
use crate::json::Field;
use crate::verdict::{Condition, Outcome, Relation};
use rug::Rational;

/// The root mean squares of x, e and e'.
pub type Means = [Rational; 3];

/// The free numbers.
#[derive(Clone, Debug)]
pub struct Witness {
    /// r_x, r_e, r_d.
    pub r: Means,
    /// The linear part -kap e that the map of existence has; 0 for none.
    pub kap: Rational,
    /// Root mean squares that are proved of the solution itself.
    pub refined: Option<Means>,
}

/// Reads r'_x, r'_e, r'_d.
pub fn read(field: &Field<'_>) -> Outcome<Means> {
    field.object(|fields| fields.numbers(["r_x", "r_e", "r_d"]))
}

/// What a witness proves of the periodic solution.
#[derive(Clone, Debug)]
pub struct Solution {
    pub x: Interval,
    pub e: Interval,
    /// R_q, R_1: the root mean squares of q along it and of its derivative in t.
    pub rates: [Interval; 2],
    pub z_squared: Interval,
    /// A bound of |u| along it at sigma.
    pub steady: Interval,
    pub conditions: Vec<Condition>,
}

/// The bounding functions at (X_p, E_p), b_fx at (X_p, 0), and the gains at sigma. What is not given is undefined, and the least
/// of several bounds leaves it out (docs/mathematics.md, section 11.3). Those that do not name sigma serve every regulator.
pub struct Bounds<'a> {
    d: &'a Data<'a>,
    x_p: Interval,
    e_p: Interval,
    /// a_1.
    rate: Interval,
    f_x: Interval,
    f_e: Interval,
    q_x: Interval,
    q_e: Interval,
    /// b_q_rms, b_qt_rms.
    rates: [Interval; 2],
    /// b_qt_rms(0,0).
    q_t_start: Interval,
    /// b_qtx and b_qte, where both are given.
    bends: Option<[Interval; 2]>,
    /// Q_0 >= rms(q(t,0,0)).
    start: Interval,
    forced: Option<Forced>,
    pub(super) x_gain: Interval,
    /// K2(a_1) b_fe: sup|x| over rms(e).
    from_rms: Interval,
    /// bt and tau, with a gain over b_m.
    bt: Interval,
    tau: Interval,
    /// Om and sg = sqrt(sigma^2 + Om^2), with a gain times b_m: what they divide is largest with the longest period.
    om: Interval,
    sg: Interval,
    /// bt and sg themselves: they serve y, whatever the gain is.
    of_y: [Interval; 2],
}

/// What follows for a solution with given root mean squares.
pub struct Follows {
    pub sup_e: Interval,
    rms_e: Interval,
    rms_e_t: Interval,
    /// R_q, R_1.
    rates: [Interval; 2],
    /// d_0, d_1: the root mean squares of q(t,x,e) - q(t,0,0) and of its derivative.
    apart: [Interval; 2],
}

impl<'a> Bounds<'a> {
    /// At (X_p, E_p) and sigma.
    pub fn new(d: &'a Data<'a>, sigma: &Interval, [x_p, e_p]: [&Interval; 2]) -> Bounds<'a> {
        let zero = d.int(0);
        let [c, alpha] = &d.existence;
        let bent = alpha - c * d.bound(Bound::Fxx, x_p, &zero) * x_p / 2;
        let a_1 = d.better_rate(&bent, true, x_p, &zero);
        let at = |which| d.bound(which, x_p, e_p);
        let secant = d.bound(Bound::F, x_p, &zero) / x_p + d.bound(Bound::Fxx, x_p, &zero) * x_p;
        let forced = d.spec.q_0.as_ref().map(|given| Forced::new(d, sigma, given));
        let start = d.bound(Bound::QRms, &zero, &zero);
        let bends = d.given(Bound::Qtx, x_p, e_p).zip(d.given(Bound::Qte, x_p, e_p));
        let om = d.period.slowest();
        let of_y = [bt(d, sigma), (sigma.sqr() + om.sqr()).sqrt()];
        let sg = d.by_gain(Gain::of_error, &of_y[1]);
        Bounds {
            f_x: d.given(Bound::Fx, x_p, &zero).map_or(secant.clone(), |f_x| f_x.least(&secant)),
            f_e: at(Bound::Fe),
            q_x: at(Bound::Qx),
            q_e: at(Bound::Qe),
            rates: [at(Bound::QRms), at(Bound::QtRms)],
            q_t_start: d.bound(Bound::QtRms, &zero, &zero),
            bends: bends.map(|(q_tx, q_te)| [q_tx, q_te]),
            start: forced.as_ref().map_or(start.clone(), |forced| forced.rms(d).least(&start)),
            forced,
            x_gain: c / &a_1 * at(Bound::Fe),
            from_rms: c * beta_s(d, &a_1) * at(Bound::Fe),
            rate: a_1,
            x_p: x_p.clone(),
            e_p: e_p.clone(),
            bt: d.of_error(of_y[0].clone()),
            tau: d.of_error(tau(d, sigma)),
            of_y,
            sg,
            om,
            d,
        }
    }

    /// S1, and S1b to S2c: sup|x|, rms(x), and these sup|e|, rms(e), rms(e'). With what an inequality of existence says, `answer` with its bound of
    /// rms(x) in words, they are strict, and the last four are the least of several bounds.
    pub(super) fn stay(
        &self,
        [r_x, r_e, r_d]: &[Interval; 3],
        [sup_e, rms_e, rms_e_t]: &[Interval; 3],
        [of_sup, of_rms, of_rms_t]: [&str; 3],
        answer: Option<(&Answer, &str)>,
    ) -> Vec<Condition> {
        let (sup_x, mut rms_x, mut of_x) = (self.sup_x_in_box(r_e), &self.x_gain * r_e, "(c/a_1) b_fe r_e".to_owned());
        if let Some((answer, said)) = answer {
            rms_x = rms_x.least(&answer.rms_x);
            of_x += &format!(", {said}");
        }
        let relation = if answer.is_some() { Relation::Less } else { Relation::AtMost };
        let least = |what: &str| if answer.is_some() { format!("min{{{what}}}") } else { what.to_owned() };
        let all = [
            ("S1b", "min{(c/a_1) b_fe E_p, K2(a_1) b_fe r_e}".to_owned(), "X_p", [&sup_x, &self.x_p]),
            ("S1c", least(&of_x), "r_x", [&rms_x, r_x]),
            ("S2", least(of_sup), "E_p", [sup_e, &self.e_p]),
            ("S2b", least(of_rms), "r_e", [rms_e, r_e]),
            ("S2c", least(of_rms_t), "r_d", [rms_e_t, r_d]),
        ];
        let condition = |(id, what, end, [lhs, rhs]): (_, String, &str, [&Interval; 2])| {
            let what = format!("{what} {} {end}", relation.symbol());
            Condition { id, what, lhs: lhs.clone(), relation, rhs: rhs.clone() }
        };
        [Condition::less("S1", "0 < a_1", self.d.int(0), self.rate.clone())]
            .into_iter()
            .chain(all.map(condition))
            .collect()
    }

    /// A bound of sup|x|, from sup|e| <= E_p and rms(e) <= r_e.
    pub(super) fn sup_x_in_box(&self, r_e: &Interval) -> Interval {
        (&self.x_gain * &self.e_p).min(&(&self.from_rms * r_e))
    }

    /// Without b_q_rms and b_qt_rms, which are of q with all of q(t,0,0) in it (section 13.7). Plants do not have them.
    pub(super) fn for_any_share_of_forcing(self) -> Bounds<'a> {
        let none = || Interval::undefined(self.d.precision);
        Bounds { rates: [none(), none()], ..self }
    }

    /// Q_m >= rms(q(t,0,0) without its mean).
    pub(super) fn oscillation(&self) -> Interval {
        let none = || Interval::undefined(self.d.precision);
        self.forced.as_ref().map_or_else(none, |forced| forced.with_mean(self.d, self.d.int(0)))
    }

    /// What is known of q along a solution with these root mean squares.
    pub(super) fn along(&self, r: &[Interval; 3]) -> Along {
        let harmonics = self.forced.as_ref().map(|Forced { harmonics, rest: [rest, rest_t], .. }| {
            [harmonics[0].clone(), twice_sum(self.d, harmonics, |_, c| c.clone()), rest.clone(), rest_t.clone()]
        });
        Along { inputs: self.inputs(r), harmonics }
    }

    /// x_per, from e_per and rms(e). Where S1 fails X_p stands for what is not defined.
    pub fn sup_x(&self, e: &Interval, rms_e: &Interval) -> Interval {
        if !self.rate.is_positive() {
            return self.x_p.clone();
        }
        self.x_p.min(&(&self.x_gain * e)).min(&(&self.from_rms * rms_e))
    }

    /// R_q and R_1 at (r_x, r_e, r_d), and d_0, d_1: they are of q along the solution, whatever the regulator is.
    pub fn inputs(&self, [r_x, r_e, r_d]: &[Interval; 3]) -> [[Interval; 2]; 2] {
        let d_0 = &self.q_x * r_x + &self.q_e * r_e;
        let along = &self.q_x * (&self.f_x * r_x + &self.f_e * r_e) + &self.q_e * r_d;
        let generic = &self.rates[1] + &self.q_t_start + &along;
        let d_1 = match &self.bends {
            Some([q_tx, q_te]) => generic.least(&(q_tx * r_x + q_te * r_e + &along)),
            None => generic,
        };
        let r_q = self.rates[0].least(&(&self.start + &d_0));
        let r_1 = &self.rates[1] + along;
        let r_1 = self.forced.as_ref().map_or(r_1.clone(), |f| r_1.least(&(&f.rate + &f.rest[1] + &d_1)));
        [[r_q, r_1], [d_0, d_1]]
    }

    /// Section 10.3 at (r_x, r_e, r_d); of an actual solution with what `answer` says of it.
    fn at(&self, r: &[Interval; 3], answer: Option<&Answer>) -> Follows {
        let [[r_q, r_1], [d_0, d_1]] = self.inputs(r);
        let [_, r_e, r_d] = r;
        // Of the response to an input with these root mean squares of itself and of its derivative.
        let sup = |q: &Interval, q_t: &Interval| (&self.bt * q).least(&(&self.tau * q_t));
        let rms = |q: &Interval, q_t: &Interval| (q / &self.sg).least(&(q_t / (&self.om * &self.sg)));
        let mut sup_e = sup(&r_q, &r_1).least(&(self.d.period.longest() * r_e * r_d).sqrt());
        let mut rms_e = rms(&r_q, &r_1);
        if let Some(f) = &self.forced {
            sup_e = sup_e.least(&(&f.sup_e + sup(&f.rest[0], &f.rest[1]) + sup(&d_0, &d_1)));
            rms_e = rms_e.least(&(&f.rms_e + rms(&f.rest[0], &f.rest[1]) + rms(&d_0, &d_1)));
        }
        let slope = self.d.gain.as_ref().map_or_else(|| r_q.clone(), |gain| gain.of_slope() * &r_q);
        let mut rms_e_t = slope.least(&(&r_1 / &self.sg));
        if let Some(answer) = answer {
            let [bt, sg] = &self.of_y;
            sup_e = sup_e.least(&(bt * &answer.rms_y));
            rms_e = rms_e.least(&(&answer.rms_y / sg)).least(&answer.rms_e);
            rms_e_t = rms_e_t.least(&answer.rms_y);
        }
        Follows { sup_e, rms_e, rms_e_t, rates: [r_q, r_1], apart: [d_0, d_1] }
    }

    /// S1 and S2, of e without `damping` by section 10.3, with it by 10.4 alone.
    fn stays(&self, r: &[Interval; 3], damping: Option<&[Interval; 3]>) -> Vec<Condition> {
        if let Some(damping) = damping {
            let [rms_e, rms_e_t] = self.damped(r, damping);
            let sup_e = (self.d.period.longest() * &r[1] * &r[2]).sqrt();
            return self.stay(r, &[sup_e, rms_e, rms_e_t], ["sqrt(T r_e r_d)", "g_k Rt", "Rt + kap r_e"], None);
        }
        let Follows { sup_e, rms_e, rms_e_t, .. } = self.at(r, None);
        let forced = if self.forced.is_some() { ", q_0 form" } else { "" };
        let of_sup = format!("min{{bt R_q, tau R_1, sqrt(T r_e r_d){forced}}}");
        let of_rms = format!("min{{R_q/sg, R_1/(Om sg){forced}}}");
        self.stay(r, &[sup_e, rms_e, rms_e_t], [&of_sup, &of_rms, "min{R_q, R_1/sg}"], None)
    }

    /// G: the least of all bounds of rms(x), rms(e), rms(e') of an actual solution at (r_x, r_e, r_d), those of 10.4 with `damping`.
    fn means(
        &self,
        r: &[Interval; 3],
        follows: &Follows,
        damping: Option<&[Interval; 3]>,
        answer: Option<&Answer>,
    ) -> [Interval; 3] {
        let mut rms_x = &self.x_gain * &r[1];
        let (mut rms_e, mut rms_e_t) = (follows.rms_e.clone(), follows.rms_e_t.clone());
        if let Some(damping) = damping {
            let damped = self.damped(r, damping);
            (rms_e, rms_e_t) = (rms_e.least(&damped[0]), rms_e_t.least(&damped[1]));
        }
        if let Some(answer) = answer {
            rms_x = rms_x.least(&answer.rms_x);
        }
        [rms_x, rms_e, rms_e_t]
    }

    /// Section 10.4 at (r_x, r_e): rms(e) <= g_k Rt and rms(e') <= Rt + kap r_e, with Rt = Q_0 + b_qx r_x + rho r_e; with a gain
    /// rms(e') <= d_b Rt, for `|om| sqrt(sigma^2 + om^2)/(beta sigma + om^2)` with `beta = b sigma + kap` is no larger than with kap = 0.
    fn damped(&self, [r_x, r_e, _]: &[Interval; 3], [gain, kap, rho]: &[Interval; 3]) -> [Interval; 2] {
        let input = &self.start + &self.q_x * r_x + rho * r_e;
        let slope = match &self.d.gain {
            Some(gain) => gain.of_slope() * &input,
            None => &input + kap * r_e,
        };
        [gain * &input, slope]
    }

    /// Z^2, the least of `(T/(2 mu) + kappa_0) R_q^2 + kappa_1 R_1^2` and the form of `q_0`; with a gain the part of T is over `b_lo^3`, and
    /// what the transfer bound gives is over c_m.
    fn z_squared(
        &self,
        follows: &Follows,
        (pair, at_poles): ([&Interval; 2], bool),
        kappa: &[Interval; 2],
    ) -> Interval {
        let d = self.d;
        let of_answer = d.gain.as_ref().map_or_else(|| d.int(1), Gain::of_answer);
        let mean = |[q, q_t]: &[Interval; 2]| (&kappa[0] * q.sqr() + &kappa[1] * q_t.sqr()) / of_answer.sqr();
        let swing = d.period.longest() * follows.rates[0].sqr() / (&d.mu * 2);
        let swing = d.gain.as_ref().map_or_else(|| swing.clone(), |gain| &swing / gain.of_swing());
        let plain = &swing + mean(&follows.rates);
        let Some(forced) = &self.forced else { return plain };
        // Bounds of T(k Om/w) with all oscillators that the claim is about.
        let inverse = d.nu.sqr().recip();
        let transfer = |k: i64| {
            let bound = pair[0] + pair[1] * (d.period.fastest() * k / &d.w).sqr();
            let pole = || &inverse * 2 / d.weight(k.unsigned_abs());
            if at_poles { bound.min(&pole()) } else { bound }
        };
        let mean_part = &inverse / &d.n_0 * forced.harmonics[0].sqr();
        let harmonics = mean_part + twice_sum(d, &forced.harmonics, |k, c| transfer(k) * c.sqr());
        let z = harmonics.sqrt() / &d.w / &of_answer + mean(&forced.rest).sqrt() + mean(&follows.apart).sqrt();
        plain.least(&(swing + z.sqr()))
    }
}

/// Evaluates S1-S3; `pair` is (k0, k1), which the transfer proof has to settle, and whether `T(k) <= 2/(nu^2 n_k)` is proved besides
/// ([`super::transfer::at_poles`]). The inequality of existence has a part in S1b to S2c, where it is given.
pub fn evaluate(
    d: &Data<'_>,
    (w, inequality): (&Witness, Option<&Inequality>),
    sigma: &Rational,
    [x_p, e_p]: [&Interval; 2],
    pair: ([&Interval; 2], bool),
    kappa: &[Interval; 2],
) -> Solution {
    let mut bounds = Bounds::new(d, &d.number(sigma), [x_p, e_p]);
    if inequality.is_some() {
        bounds = bounds.for_any_share_of_forcing();
    }
    let answer = inequality.map(|inequality| inequality.answer(d, sigma, &bounds.oscillation()));
    let r = w.r.each_ref().map(|value| d.number(value));
    let most = d.q_e_max(x_p, e_p);
    let upper = most.as_ref().map_or(bounds.q_e.clone(), |most| most.min(&bounds.q_e));
    let kap = d.number(&w.kap);
    let rho = (upper + &kap).max(&(&bounds.q_e - &kap));
    let with_kap = w.kap > 0;
    let damping = [damped(d, sigma, &w.kap), kap, rho];
    let (damping, answer) = (with_kap.then_some(&damping), answer.as_ref());

    let mut conditions = match inequality {
        Some(inequality) => {
            let follows = bounds.at(&r, answer);
            let means = bounds.means(&r, &follows, damping, answer);
            let [_, rms_e, rms_e_t] = means;
            let c_e = if inequality.far.is_some() { "c_e" } else { "2 (sigma - threshold)" };
            let [damped, damped_t] = if with_kap { ["g_k Rt, ", "Rt + kap r_e, "] } else { [""; 2] };
            let what = [
                "bt R_q, tau R_1, sqrt(T r_e r_d), q_0 form, bt r_y",
                &format!("R_q/sg, R_1/(Om sg), q_0 form, {damped}r_y/sg, k_p Q_m/(2 sqrt({c_e} c_y))"),
                &format!("R_q, R_1/sg, {damped_t}r_y"),
            ];
            let said = answer.map(|answer| (answer, "k_p Q_m/(2 sqrt(c_x c_y))"));
            let mut conditions = inequality.enough(d, (sigma, "sigma"));
            conditions.extend(bounds.stay(&r, &[follows.sup_e, rms_e, rms_e_t], what, said));
            conditions
        }
        None => bounds.stays(&r, damping),
    };
    if with_kap {
        conditions.extend(one_sided("(X_p, E_p)", &bounds.q_e, most.as_ref()));
    }
    let last = w.refined.as_ref().unwrap_or(&w.r).each_ref().map(|value| d.number(value));
    let follows = bounds.at(&last, answer);
    if w.refined.is_some() {
        let sides = bounds.means(&last, &follows, damping, answer).into_iter().zip(last.iter().cloned());
        let names = [("S3", "G_x(r') < r'_x"), ("S3b", "G_e(r') < r'_e"), ("S3c", "G_d(r') < r'_d")];
        conditions
            .extend(names.into_iter().zip(sides).map(|((id, what), (lhs, rhs))| Condition::less(id, what, lhs, rhs)));
    }
    let e = e_p.min(&follows.sup_e);
    let x = bounds.sup_x(&e, &last[1]);
    let z_squared = bounds.z_squared(&follows, pair, kappa);
    let sigma = d.number(sigma);
    let by_parts = control::by_parts(d, [&sigma, &d.mu], [&e, &z_squared.sqrt()]);
    let steady = control::Answer::continuous(d).steady(&bounds.along(&last), &by_parts);
    Solution { steady, x, e, rates: follows.rates, z_squared, conditions }
}
