//! Rule: rates for given numbers of oscillators of a plant whose claim rests on a matrix inequality or on joint metrics, at the gain of the
//! claim and no other (docs/mathematics.md, section 13.6).
//!
//! Differences to the periodic solution, in the coordinates of the claim: `a = (x, e)`, `zs = N^(1/2) zeta`, `b = N^(1/2) M`, and omega those of
//! (f, q). With `B = (1, -b)` for (e, zs), and an input gain b_u (1 without),
//! `x' = omega_f`, `(e, zs)' = (-sigma e, Phi zs) + B (omega_q + (1 - b_u) sigma e + b_u mu b'zs)`.
//! A witness for one n_o is Pi of (x, e, zs), Q, G and H of order n + 1, e_low, e_up, z_up and, with states, x_up; `W = eta'Pi eta`.
//!
//! Guarantee of [`rate`], with (D) proved of the plant's formulas (the crate `proofs-plants` does): in the error box, where the
//! matrix inequality or the metrics keep the solution, omega is D a with the average D of the derivatives along the straight segment, on which
//! (D), `Q - G D - D'G' - D'H D >= 0`, holds at every point; it is concave in D, for H >= 0, so that it holds of the average, whatever path
//! the claim is proved on. So `a'Q a - 2 a'G omega - omega'H omega >= 0`, and as `-2 eta'Pi eta' - 2 rate eta'Pi eta` less that is positive definite (K)
//! at both ends of b_u, in which it is affine, `W' <= -2 rate W`. With `Pi > diag(0, e_low, 0)` then `e^2 <= W/e_low`, and with `Pi < diag(x_up I, e_up, z_up I)`
//! W of a start is at most `x_up dX^2 + e_up dE^2 + z_up dZ^2`, which `factor^2 e_low` is not below.

use super::claimed::{RULE, Rate};
use super::norm::{Norm, Stored, enclosed};
use super::stored::{numbers, triangle};
use crate::data::Data;
use crate::interval::Interval;
use crate::jacobian::Matrix;
use crate::json::{Field, Fields};
use crate::matrix::positive_definite;
use crate::plant::coordinates::semidefinite;
use crate::verdict::{Outcome, bad, demand};
use rug::Rational;

/// Q and H by their lower triangles, G by its rows: what is said of the slopes of (f, q) in (x, e).
#[derive(Clone, Debug)]
pub struct Slopes {
    /// Where they stand in the file.
    pub pointer: String,
    /// Q, its lower triangle.
    pub q: Matrix,
    /// G, all of it.
    pub g: Matrix,
    /// H, its lower triangle.
    pub h: Matrix,
}

impl Slopes {
    fn read(field: &Field<'_>, order: usize) -> Outcome<Slopes> {
        let mut fields = field.fields()?;
        let what = "one for each state and one for e";
        let q = triangle(&fields.required("Q")?, order, what)?;
        let rows = fields.required("G")?;
        let g = rows.elements()?.iter().map(numbers).collect::<Outcome<Matrix>>()?;
        if g.len() != order || g.iter().any(|row| row.len() != order) {
            return bad(&rows.pointer, format!("expected {order} rows of {order} numbers, {what}"));
        }
        let h = triangle(&fields.required("H")?, order, what)?;
        fields.finish()?;
        Ok(Slopes { pointer: field.pointer.clone(), q, g, h })
    }

    /// Whether they are the same three matrices.
    pub fn are(&self, other: &Slopes) -> bool {
        [(&self.q, &other.q), (&self.g, &other.g), (&self.h, &other.h)].into_iter().all(|(own, other)| own == other)
    }

    /// H >= 0, in exact arithmetic, so that (D) is concave. (K) has H as its part in omega: it is definite too.
    fn demand_concave(&self) -> Outcome<()> {
        let h = &self.h;
        let row = |i: usize| (0..h.len()).map(|j| h[i.max(j)][i.min(j)].clone()).collect();
        let truth = semidefinite((0..h.len()).map(row).collect());
        demand(Some(truth), RULE, &format!("{}/H", self.pointer), "H >= 0")
    }
}

/// What proves the rate of one n_o, but for e_up and z_up.
pub struct Proof {
    stored: Stored,
    pub slopes: Slopes,
    /// None without states.
    x_up: Option<Rational>,
}

impl Proof {
    /// Takes it out of a part for this n_o, of a plant with so many states.
    pub fn read(fields: &mut Fields<'_>, n_o: u32, states: usize) -> Outcome<Proof> {
        if let Some(norms) = ["w", "l"].into_iter().find_map(|name| fields.optional(name)) {
            return bad(
                &norms.pointer,
                "it is of a claim by norms: this one rests on a matrix inequality, and has `slopes`",
            );
        }
        let stored = Stored::read(fields, n_o, states)?;
        let slopes = Slopes::read(&fields.required("slopes")?, states + 1)?;
        let x_up = if states > 0 { Some(fields.required("x_up")?.rational()?) } else { None };
        Ok(Proof { stored, slopes, x_up })
    }
}

/// The error system of one n_o, with Pi and Q, G and H.
struct Loop {
    sigma: Interval,
    norm: Norm,
    /// Q, G, H.
    slopes: [Vec<Vec<Interval>>; 3],
}

impl Loop {
    /// `b_u mu` and `(1 - b_u) sigma` at both ends of an input gain.
    fn ends(&self, d: &Data<'_>) -> Vec<(&'static str, [Interval; 2])> {
        let Some(gain) = &d.gain else { return vec![("", [d.mu.clone(), d.int(0)])] };
        let [low, high] = gain.shifts(&self.sigma);
        let end = |of: &Interval, shift| [of * &d.mu, shift];
        vec![(", at b_lo", end(&gain.low, low)), (", at b_hi", end(&gain.high, high))]
    }

    /// The lower triangle of the form of (K) in (x, e, zs, omega); what comes back through B beside omega is `(1 - b_u) sigma e + b_u mu b'zs`.
    fn form(&self, rate: &Interval, end: &[Interval; 2]) -> Vec<Vec<Interval>> {
        let Loop { sigma, norm, slopes: [q, g, h] } = self;
        let (order, of_e) = (norm.order(), norm.of_e);
        let moved = |i: usize, j: usize| norm.moved(i, j, sigma, end.each_ref());
        let entry = |i: usize, j: usize| {
            let falls = -(moved(i, j) + moved(j, i) + norm.at(i, j) * rate * 2);
            if i <= of_e { falls - &q[i][j] } else { falls }
        };
        let mut rows: Vec<Vec<Interval>> = (0..order).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect();
        for (i, own) in h.iter().enumerate() {
            let beside = |j: usize| {
                let driven = -if i < of_e { norm.at(j, i) } else { &norm.image[j] };
                if j <= of_e { driven + &g[j][i] } else { driven }
            };
            rows.push((0..order).map(beside).chain(own.iter().cloned()).collect());
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
    let Proof { stored, slopes, x_up } = proof;
    slopes.demand_concave()?;
    let of_slopes = [&slopes.q, &slopes.g, &slopes.h].map(|rows| enclosed(d, rows));
    let made = Loop { sigma: d.number(sigma), norm: Norm::new(d, stored)?, slopes: of_slopes };
    made.norm.lies_above()?;
    let rate = d.number(&claimed.rate);
    for (at, end) in made.ends(d) {
        let what = format!("(K) for n_o = {}, rate {}{at}", stored.n_o, claimed.rate);
        demand(positive_definite(made.form(&rate, &end)), RULE, &format!("{}/Pi", stored.pointer), what)?;
    }
    let x_up = x_up.as_ref().map(|value| d.number(value));
    Ok([made.norm.start(d, x_up.as_ref(), ends, reach)?, made.norm.e_low])
}
