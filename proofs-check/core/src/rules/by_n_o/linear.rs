//! What proves the numbers by n_o of a plant that is linear in x and e: `f = A x + b_e e + f_0(t)`, `q = c x + d e + q_0(t)` (docs/mathematics.md,
//! sections 14.3 and 14.5, and 14.6 at samples).
//!
//! A witness has one or two forms `V = y'P y + w e^2 + (b mu k_p/2) |zeta|_N^2`, `P <= p_up I`, and of each entry bounds of `|L^-1 (x - x_0)|` and of
//! `|zeta|_N` along the periodic solution. That V falls along the difference of two solutions (14.3a), and that the bounds are true, is proved of
//! the formulas (the crate `proofs-plants`).
//!
//! Guarantee of [`Linear::peaks`]: the corollary of section 14.5. With bounds E, X and Z of the periodic solution, dX, dE and dZ as in C4, and
//! `V_0(b) = p_up dX^2 + w dE^2 + (b mu k_p/2) dZ^2`, at all times `|e| <= E + sqrt(V_0(b_hi)/w)`, and
//! `|u - u_per|^2 <= V_0(b) (sigma^2/w + 2 mu Nbar^2/(b k_p))` at the gain b, which is convex in b: the larger one of both ends serves. Of several
//! forms each is true, so that the least bound is.
//!
//! At samples (the corollary of section 14.6) V falls from sample to sample and is at least `x'P x + w e^2` between them, with K in the place of mu and
//! Nb2 in that of Nbar^2. With a delay V has `g_m h y_(k-1)^2` besides, which is `g_m h (Y_0 + Y)^2` at most at the start, where Y bounds |y| along the
//! periodic solution, and u has `h (sigma + K b_1) y_(k-1)`, |b_1| <= Nb2. The bound of |e| at all times serves for that at the sampling instants.

use super::AtSamples;
use super::claimed::{Entry, RULE};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::matrix::{Matrix, is_definite, is_semidefinite, is_symmetric, shifted};
use crate::rules::set::{ClaimedSet, positive};
use crate::rules::stability::distances;
use crate::verdict::{Condition, Outcome, bad, demand};
use rug::Rational;

/// The most forms.
const MOST_FORMS: usize = 2;

/// A form that falls.
#[derive(Clone, Debug)]
pub struct Form {
    /// Where it stands in the file.
    pub pointer: String,
    /// P, in the coordinates of the claim; symmetric and positive definite.
    pub p: Matrix,
    /// `P <= p_up I`.
    pub p_up: Rational,
    /// The weight of `e^2`.
    pub w: Rational,
    /// `b mu k_p/2` is the weight of `|zeta|_N^2`; at samples `b K k_p/2`.
    pub k_p: Rational,
    /// What it has besides at samples.
    pub at_samples: Option<Within>,
}

/// What a form has for what moves within a sample.
#[derive(Clone, Debug)]
pub struct Within {
    /// The multiplier lambda.
    pub lambda: Rational,
    /// With a delay `g_m h` is the weight of `y_(k-1)^2`.
    pub g_m: Option<Rational>,
}

/// Bounds along the periodic solution of an entry.
#[derive(Clone, Debug)]
pub struct Sizes {
    /// Where they stand in the file.
    pub pointer: String,
    /// Of `|L^-1 (x - x_0)|`; 0 without states.
    pub x: Rational,
    /// Of `|zeta|_N`.
    pub zeta: Rational,
    /// Of |y|, of a law with a delay.
    pub y: Option<Rational>,
}

/// The witness.
#[derive(Clone, Debug)]
pub struct Linear {
    /// One or two.
    pub forms: Vec<Form>,
    /// One for each entry of the claim.
    pub sizes: Vec<Sizes>,
}

impl Linear {
    /// Takes it out of its object; the claim has these entries. `of`: the number of states, and at samples whether there is a delay.
    pub fn take(fields: &mut Fields<'_>, claimed: &[Entry<'_>], of: (usize, Option<bool>)) -> Outcome<Linear> {
        let list = fields.required("forms")?;
        let forms = list.list(|field| field.object(|fields| Form::take(fields, of)))?;
        if forms.is_empty() || forms.len() > MOST_FORMS {
            return bad(&list.pointer, format!("expected 1 to {MOST_FORMS} forms"));
        }
        let list = fields.required("sizes")?;
        let sizes = list.list(|field| Sizes::read(field, of))?;
        if sizes.len() != claimed.len() {
            return bad(&list.pointer, format!("expected {}, one for each entry of the claim", claimed.len()));
        }
        if let Some(entry) = claimed.iter().find(|entry| entry.largest.is_none()) {
            return bad(&entry.pointer, "the field `largest` is missing, which `linear` proves of each entry");
        }
        Ok(Linear { forms, sizes })
    }

    /// Proves `largest` of each entry, from its `steady` and its sizes.
    pub fn peaks(
        &self,
        d: &Data<'_>,
        (set, sigma, at_samples): (&ClaimedSet, &Rational, Option<AtSamples<'_>>),
        claimed: &[Entry<'_>],
        lines: &mut Vec<String>,
    ) -> Outcome<()> {
        for (entry, sizes) in claimed.iter().zip(&self.sizes) {
            let Some(largest) = &entry.largest else { continue };
            let [e, _, u] = entry.steady.each_ref().map(|value| d.number(value));
            let [x, zeta] = [&sizes.x, &sizes.zeta].map(|value| d.number(value));
            let reach = distances(d, set, [&x, &e, &zeta]);
            let law = Law::new(d, at_samples, sizes);
            let moved = self.forms.iter().map(|form| form.moves(d, (sigma, &law), &reach));
            // The least bound of each, where one need not be known.
            let least = moved.reduce(|[e, u], [of_e, of_u]| [e.least(&of_e), u.least(&of_u)]);
            let Some([of_e, of_u]) = least else { continue };
            let of_u = d
                .spec
                .input_gain
                .as_ref()
                .map_or_else(|| of_u.clone(), |gain| &of_u / gain.nominal.enclose(d.precision));
            let about = entry.about();
            for (name, what, bound, claimed) in
                [("e", "|e_per| + sqrt(V_0/w)", e + of_e, &largest[0]), ("u", law.of_control, u + of_u, &largest[1])]
            {
                let what = format!("{what} <= largest {name}, {about}");
                let condition = Condition::at_most("peak", what, bound, d.number(claimed));
                lines.push(condition.line());
                condition.demand(RULE, &format!("{}/largest/{name}", entry.pointer))?;
            }
        }
        Ok(())
    }
}

impl Form {
    fn take(fields: &mut Fields<'_>, (states, delayed): (usize, Option<bool>)) -> Outcome<Form> {
        let pointer = fields.pointer.clone();
        let field = fields.required("P")?;
        let p = field.matrix([states; 2], "one for each state")?;
        let [p_up, w, k_p] = fields.numbers(["p_up", "w", "k_p"])?;
        positive(&[("p_up", &p_up), ("w", &w), ("k_p", &k_p)], &pointer)?;
        let at_samples = delayed.map(|delayed| Within::take(fields, delayed)).transpose()?;
        demand(Some(is_symmetric(&p)), RULE, &field.pointer, "P is symmetric")?;
        demand(Some(is_definite(p.clone())), RULE, &field.pointer, "P > 0")?;
        let below = is_semidefinite(shifted(&p, &Rational::from(-1), &Rational::from(-&p_up)));
        demand(Some(below), RULE, &format!("{pointer}/p_up"), "P <= p_up I")?;
        Ok(Form { pointer, p, p_up, w, k_p, at_samples })
    }

    /// What is stored in the last y at the start, and what that adds to the square of the control over V: 0 without a delay.
    fn of_past(&self, d: &Data<'_>, sigma: &Interval, law: &Law) -> [Interval; 2] {
        let g_m = self.at_samples.as_ref().and_then(|within| within.g_m.as_ref());
        let Some((g_m, [h, y])) = g_m.zip(law.past.as_ref()) else { return [0; 2].map(|zero| d.int(zero)) };
        let g_m = d.number(g_m);
        [&g_m * h * y.sqr(), h * (sigma + &law.gain * &law.sum).sqr() / g_m]
    }

    /// `sqrt(V_0(b_hi)/w)`, and the larger one of `sqrt(V_0(b) (sigma^2/w + 2 mu Nbar^2/(b k_p)))` at both ends of b, or what the law has for that.
    fn moves(&self, d: &Data<'_>, (sigma, law): (&Rational, &Law), [x, e, zeta]: &[Interval; 3]) -> [Interval; 2] {
        let [p_up, w, k_p, sigma] = [&self.p_up, &self.w, &self.k_p, sigma].map(|value| d.number(value));
        let [stored, of_past] = self.of_past(d, &sigma, law);
        let start = if self.p.is_empty() { d.int(0) } else { p_up * x.sqr() } + &w * e.sqr() + stored;
        let weight = &law.gain * &k_p / 2;
        let at_end = |[b, _]: [Interval; 2]| {
            let level = &start + &b * &weight * zeta.sqr();
            let rate = sigma.sqr() / &w + &law.gain * &law.sum * 2 / (b * &k_p) + &of_past;
            [(&level / &w).sqrt(), (level * rate).sqrt()]
        };
        let ends = d.ends(&sigma).into_iter().map(|(_, end)| at_end(end));
        let both = ends.reduce(|[e, u], [of_e, of_u]| [e.max(&of_e), u.max(&of_u)]);
        both.unwrap_or_else(|| [(); 2].map(|()| Interval::undefined(d.precision)))
    }
}

impl Within {
    fn take(fields: &mut Fields<'_>, delayed: bool) -> Outcome<Within> {
        let pointer = fields.pointer.clone();
        let lambda = fields.number("lambda")?;
        let g_m = if delayed { Some(fields.number("gm")?) } else { None };
        positive(&[("lambda", &lambda)], &pointer)?;
        g_m.iter().try_for_each(|g_m| positive(&[("gm", g_m)], &pointer))?;
        Ok(Within { lambda, g_m })
    }
}

/// The numbers of the law, at all times or at samples.
struct Law {
    /// mu, or K.
    gain: Interval,
    /// Nbar^2, or Nb2.
    sum: Interval,
    /// With a delay h, and Y_0 + Y for an entry.
    past: Option<[Interval; 2]>,
    /// How far the control goes, in words.
    of_control: &'static str,
}

impl Law {
    fn new(d: &Data<'_>, at_samples: Option<AtSamples<'_>>, sizes: &Sizes) -> Law {
        let Some(AtSamples { terms, y_0 }) = at_samples else {
            let of_control = "|u_per| + sqrt(V_0 (sigma^2/w + 2 mu Nbar^2/(b k_p)))";
            return Law { gain: d.mu.clone(), sum: d.n_bar.sqr(), past: None, of_control };
        };
        let h = || d.period.only() / i64::from(terms.samples);
        let past = y_0.zip(sizes.y.as_ref()).map(|(y_0, y)| [h(), d.number(y_0) + d.number(y)]);
        let of_control = match past {
            None => "|u_per| + sqrt(V_0 (sigma^2/w + 2 K Nb2/(b k_p)))",
            Some(_) => "|u_per| + sqrt(V_0 (sigma^2/w + 2 K Nb2/(b k_p) + h (sigma + K Nb2)^2/gm))",
        };
        Law { gain: d.number(&terms.gain), sum: d.number(&terms.weight_sum), past, of_control }
    }
}

impl Sizes {
    fn read(field: &Field<'_>, (states, delayed): (usize, Option<bool>)) -> Outcome<Sizes> {
        let ([x, zeta], y) = field.object(|fields| {
            let x = if states > 0 { fields.number("x")? } else { Rational::new() };
            let zeta = fields.number("zeta")?;
            let y = if delayed == Some(true) { Some(fields.number("y")?) } else { None };
            Ok(([x, zeta], y))
        })?;
        for (name, size) in [("x", &x), ("zeta", &zeta)].into_iter().chain(y.iter().map(|y| ("y", y))) {
            demand(Some(*size >= 0), RULE, &format!("{}/{name}", field.pointer), "a bound is not negative")?;
        }
        Ok(Sizes { pointer: field.pointer.clone(), x, zeta, y })
    }
}
