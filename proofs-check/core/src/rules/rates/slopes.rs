//! Rule: rates for given oscillators of a plant whose claim rests on a matrix inequality or on joint metrics, at the gain of the
//! claim and no other (docs/mathematics.md, section 13.6).
//!
//! Differences to the periodic solution, in the coordinates of the claim: `a = (x, e)`, `zs = N^(1/2) zeta`, `b = N^(1/2) M`, and omega those of
//! (f, q). With `B = (1, -b)` for (e, zs), and an input gain b_u (1 without),
//! `x' = omega_f`, `(e, zs)' = (-sigma e, Phi zs) + B (omega_q + (1 - b_u) sigma e + b_u mu b'zs)`.
//! A witness for some oscillators is Pi of (x, e, zs), Q, G and H of order n + 1, e_low, e_up, z_up and, with states, x_up; `W = eta'Pi eta`.
//!
//! A claim whose matrix inequality is proved with a splitting, on a path with a corner, may have two of them in the place of Q, G, H: of the columns
//! of D that belong to x and of the one that belongs to e, each with Q of as many rows as there are columns, G of these rows and n + 1 columns and H
//! of order n + 1. Then omega is the sum of one for each.
//!
//! Guarantee of [`rate`], with (D) of each part proved of the plant's formulas (the crate `proofs-plants` does): in the error box, where the
//! matrix inequality or the metrics keep the solution, omega is D a with the average D of the derivatives along the straight segment, whatever path
//! the claim is proved on; with two parts each has its columns of D averaged over its own segment of the path of that claim. On a segment (D),
//! `Q - G D - D'G' - D'H D >= 0`, holds at every point; it is concave in D, for H >= 0, so that it holds of the average.
//! So `a'Q a - 2 a'G omega - omega'H omega >= 0` of each part, and as `-2 eta'Pi eta' - 2 rate eta'Pi eta` less all of that is positive definite (K)
//! at both ends of b_u, in which it is affine, `W' <= -2 rate W`. With `Pi > diag(0, e_low, 0)` then `e^2 <= W/e_low`, and with `Pi < diag(x_up I, e_up, z_up I)`
//! W of a start is at most `x_up dX^2 + e_up dE^2 + z_up dZ^2`, which `factor^2 e_low` is not below.

use super::claimed::{RULE, Rate};
use super::norm::{Norm, Stored, enclosed, triangle};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::matrix::{Matrix, is_semidefinite, positive_definite};
use crate::rules::by_n_o::oscillators::Oscillators;
use crate::verdict::{Outcome, bad, demand};
use rug::Rational;
use std::ops::Range;

/// Which columns of D something is said of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Columns {
    /// All of them.
    All,
    /// `[J; r]`.
    States,
    /// `[g; d]`.
    Error,
}

impl Columns {
    /// Their places in a.
    pub fn places(self, states: usize) -> Range<usize> {
        match self {
            Columns::All => 0..states + 1,
            Columns::States => 0..states,
            Columns::Error => states..states + 1,
        }
    }

    /// What their places are, and the name of (D).
    pub fn words(self) -> [&'static str; 2] {
        match self {
            Columns::All => ["one for each state and one for e", "(D)"],
            Columns::States => ["one for each state", "(D_s)"],
            Columns::Error => ["one for e", "(D_e)"],
        }
    }
}

/// Q and H by their lower triangles, G by its rows: what is said of the slopes of (f, q) in (x, e), or in one of these.
#[derive(Clone, Debug)]
pub struct Slopes {
    /// Where they stand in the file.
    pub pointer: String,
    /// What they are about.
    pub columns: Columns,
    /// Q, its lower triangle.
    pub q: Matrix,
    /// G, all of it.
    pub g: Matrix,
    /// H, its lower triangle.
    pub h: Matrix,
}

impl Slopes {
    /// Those of all columns of D, or, where the claim rests on a path with a corner, those of its two parts.
    fn read(field: &Field<'_>, states: usize, corner: bool) -> Outcome<Vec<Slopes>> {
        let mut fields = field.fields()?;
        let Some(of_states) = fields.optional("states") else {
            let all = Slopes::take(&mut fields, Columns::All, states)?;
            return fields.finish().map(|()| vec![all]);
        };
        if !corner {
            let corner = "a path with a corner: a matrix inequality with a splitting";
            return bad(&of_states.pointer, format!("the slopes of its parts need {corner}"));
        }
        let parts = [(of_states, Columns::States), (fields.required("error")?, Columns::Error)];
        fields.finish()?;
        let part = |(field, columns): (Field<'_>, _)| field.object(|fields| Slopes::take(fields, columns, states));
        parts.into_iter().map(part).collect()
    }

    /// Takes Q, G and H out of an object.
    fn take(fields: &mut Fields<'_>, columns: Columns, states: usize) -> Outcome<Slopes> {
        let (count, order, [what, _]) = (columns.places(states).len(), states + 1, columns.words());
        let q = triangle(&fields.required("Q")?, count, what)?;
        let g = fields.required("G")?.matrix([count, order], &format!("{what} in rows"))?;
        let h = triangle(&fields.required("H")?, order, Columns::All.words()[0])?;
        Ok(Slopes { pointer: fields.pointer.clone(), columns, q, g, h })
    }

    /// Whether they are the same three matrices, of the same columns.
    pub fn are(&self, other: &Slopes) -> bool {
        let matrices = [(&self.q, &other.q), (&self.g, &other.g), (&self.h, &other.h)];
        self.columns == other.columns && matrices.into_iter().all(|(own, other)| own == other)
    }

    /// H >= 0, in exact arithmetic, so that (D) is concave. (K) has H as its part in omega: it is definite too.
    fn demand_concave(&self) -> Outcome<()> {
        let h = &self.h;
        let row = |i: usize| (0..h.len()).map(|j| h[i.max(j)][i.min(j)].clone()).collect();
        let truth = is_semidefinite((0..h.len()).map(row).collect());
        demand(Some(truth), RULE, &format!("{}/H", self.pointer), "H >= 0")
    }
}

/// What proves the rate of some oscillators, but for e_up and z_up.
pub struct Proof {
    stored: Stored,
    /// One of all columns of D, or one of each of its two parts.
    pub parts: Vec<Slopes>,
    /// None without states.
    x_up: Option<Rational>,
}

impl Proof {
    /// Takes it out of a part for these oscillators, of a plant with so many states; `corner`: whether the claim rests on a path with a corner.
    pub fn read(fields: &mut Fields<'_>, oscillators: &Oscillators, states: usize, corner: bool) -> Outcome<Proof> {
        if let Some(norms) = ["w", "l"].into_iter().find_map(|name| fields.optional(name)) {
            let own = "this one rests on a matrix inequality, and has `slopes`";
            return bad(&norms.pointer, format!("it is of a claim by norms: {own}"));
        }
        let stored = Stored::read(fields, oscillators, states)?;
        let parts = Slopes::read(&fields.required("slopes")?, states, corner)?;
        let x_up = if states > 0 { Some(fields.number("x_up")?) } else { None };
        Ok(Proof { stored, parts, x_up })
    }
}

/// Q, G and H of a part of D, enclosed, and where its columns begin.
struct Part {
    first: usize,
    q: Vec<Vec<Interval>>,
    g: Vec<Vec<Interval>>,
    h: Vec<Vec<Interval>>,
}

/// The error system of some oscillators, with Pi and what is said of the parts of D.
struct Loop {
    sigma: Interval,
    norm: Norm,
    parts: Vec<Part>,
}

impl Loop {
    /// The lower triangle of the form of (K) in (x, e, zs) and the omega of each part; what comes back through B beside them is
    /// `(1 - b_u) sigma e + b_u mu b'zs`; `end`: b_u mu and (1 - b_u) sigma.
    fn form(&self, rate: &Interval, end: &[Interval; 2]) -> Vec<Vec<Interval>> {
        let Loop { sigma, norm, parts } = self;
        let (order, of_e) = (norm.order(), norm.of_e);
        let mut rows = norm.falls(sigma, end.each_ref(), rate);
        for Part { first, q, g, h } in parts {
            for (own, taken) in rows[*first..].iter_mut().zip(q) {
                own[*first..].iter_mut().zip(taken).for_each(|(entry, value)| *entry = &*entry - value);
            }
            let before = rows.len() - order;
            for (i, own) in h.iter().enumerate() {
                let beside = |j: usize| {
                    let driven = -if i < of_e { norm.at(j, i) } else { &norm.image[j] };
                    let said = j.checked_sub(*first).and_then(|place| g.get(place));
                    said.map_or_else(|| driven.clone(), |row| &driven + &row[i])
                };
                let apart = std::iter::repeat_n(Interval::int(0, rate.precision()), before);
                rows.push((0..order).map(beside).chain(apart).chain(own.iter().cloned()).collect());
            }
        }
        rows
    }
}

/// Proves (K), and bounds W of a start within dX, dE and dZ from above; this and e_low.
pub fn rate(
    d: &Data<'_>,
    sigma: &Rational,
    (claimed, proof, ends): (&Rate<'_>, &Proof, &[Rational; 2]),
    reach: &[Interval; 3],
) -> Outcome<[Interval; 2]> {
    let Proof { stored, parts, x_up } = proof;
    parts.iter().try_for_each(Slopes::demand_concave)?;
    let norm = Norm::new(d, stored)?;
    let part = |slopes: &Slopes| {
        let [q, g, h] = [&slopes.q, &slopes.g, &slopes.h].map(|rows| enclosed(d, rows));
        Part { first: slopes.columns.places(norm.of_e).start, q, g, h }
    };
    let parts = parts.iter().map(part).collect();
    let made = Loop { sigma: d.number(sigma), norm, parts };
    made.norm.lies_above()?;
    let rate = d.number(&claimed.rate);
    for (at, [b_u, shift]) in d.ends(&made.sigma) {
        let what = format!("(K) for {}, rate {}{at}", stored.oscillators.about(), claimed.rate);
        demand(
            positive_definite(made.form(&rate, &[b_u * &d.mu, shift])),
            RULE,
            &format!("{}/Pi", stored.pointer),
            what,
        )?;
    }
    let x_up = x_up.as_ref().map(|value| d.number(value));
    Ok([made.norm.start(d, x_up.as_ref(), ends, reach)?, made.norm.e_low])
}
