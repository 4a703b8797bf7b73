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
use super::norm::positive;
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
    pointer: String,
    n_o: u32,
    pub slopes: Slopes,
    /// The lower triangle of Pi, by rows.
    pi: Matrix,
    /// None without states.
    x_up: Option<Rational>,
    e_low: Rational,
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
        let what = "one for each state, one for e and one for each state of zeta";
        let pi = triangle(&fields.required("Pi")?, states + 2 * n_o as usize + 2, what)?;
        let slopes = Slopes::read(&fields.required("slopes")?, states + 1)?;
        let mut number = |name| fields.required(name)?.rational();
        let x_up = if states > 0 { Some(number("x_up")?) } else { None };
        let e_low = number("e_low")?;
        Ok(Proof { pointer: fields.pointer.clone(), n_o, slopes, pi, x_up, e_low })
    }
}

fn enclosed(d: &Data<'_>, rows: &Matrix) -> Vec<Vec<Interval>> {
    rows.iter().map(|row| row.iter().map(|value| d.number(value)).collect()).collect()
}

/// The error system of one n_o, with Pi.
struct Loop<'a> {
    d: &'a Data<'a>,
    witness: &'a Proof,
    sigma: Interval,
    /// The place of e, after the states.
    of_e: usize,
    /// `b = sqrt(n_l)`, from the place after e on; 0 at the second state of an oscillator.
    b: Vec<Interval>,
    pi: Vec<Vec<Interval>>,
    /// Pi B.
    image: Vec<Interval>,
}

impl<'a> Loop<'a> {
    fn new(d: &'a Data<'a>, sigma: &Rational, witness: &'a Proof) -> Loop<'a> {
        let root = |l: u32| d.spec.weights.weight(u64::from(l), d.precision).sqrt();
        let oscillators = (1..=witness.n_o).flat_map(|l| [root(l), d.int(0)]);
        let b: Vec<Interval> = [root(0)].into_iter().chain(oscillators).collect();
        let of_e = witness.slopes.h.len() - 1;
        let pi = enclosed(d, &witness.pi);
        let mut made = Loop { d, witness, sigma: d.number(sigma), of_e, b, pi, image: Vec::new() };
        let image = |i: usize| {
            let rest = (of_e + 1..).zip(&made.b).filter(|(_, b)| !b.is_zero());
            rest.fold(made.at(i, of_e).clone(), |sum, (k, b)| sum - made.at(i, k) * b)
        };
        made.image = (0..made.order()).map(image).collect();
        made
    }

    fn order(&self) -> usize {
        self.pi.len()
    }

    fn at(&self, i: usize, j: usize) -> &Interval {
        &self.pi[i.max(j)][i.min(j)]
    }

    /// `b_u mu` and `(1 - b_u) sigma` at both ends of an input gain.
    fn ends(&self) -> Vec<(&'static str, [Interval; 2])> {
        let Some(gain) = &self.d.gain else { return vec![("", [self.d.mu.clone(), self.d.int(0)])] };
        let [low, high] = gain.shifts(&self.sigma);
        let end = |of: &Interval, shift| [of * &self.d.mu, shift];
        vec![(", at b_lo", end(&gain.low, low)), (", at b_hi", end(&gain.high, high))]
    }

    /// `(Pi A)_ij`, A the part of the loop that has no slopes: `B (shift, b_u mu b')`, -sigma for e, and `Phi = l w [0, 1; -1, 0]`.
    fn moved(&self, i: usize, j: usize, [mu, shift]: &[Interval; 2]) -> Interval {
        let Some(place) = j.checked_sub(self.of_e) else { return self.d.int(0) };
        let turn = &self.d.w * (place / 2) as i64;
        match place {
            0 => &self.image[i] * shift - self.at(i, j) * &self.sigma,
            _ => {
                let through = &self.image[i] * &(mu * &self.b[place - 1]);
                match place {
                    1 => through,
                    first if first % 2 == 0 => through - self.at(i, j + 1) * turn,
                    _ => through + self.at(i, j - 1) * turn,
                }
            }
        }
    }

    /// The lower triangle of the form of (K) in (x, e, zs, omega).
    fn form(&self, rate: &Interval, end: &[Interval; 2]) -> Vec<Vec<Interval>> {
        let [q, g, h] =
            [&self.witness.slopes.q, &self.witness.slopes.g, &self.witness.slopes.h].map(|m| enclosed(self.d, m));
        let entry = |i: usize, j: usize| {
            let falls = -(self.moved(i, j, end) + self.moved(j, i, end) + self.at(i, j) * rate * 2);
            if i <= self.of_e { falls - &q[i][j] } else { falls }
        };
        let mut rows: Vec<Vec<Interval>> = (0..self.order()).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect();
        for (i, own) in h.into_iter().enumerate() {
            let beside = |j: usize| {
                let driven = -if i < self.of_e { self.at(j, i) } else { &self.image[j] };
                if j <= self.of_e { driven + &g[j][i] } else { driven }
            };
            rows.push((0..self.order()).map(beside).chain(own).collect());
        }
        rows
    }
}

/// Proves (K), and bounds W of a start within dX, dE and dZ from above; this and e_low.
pub fn rate(
    d: &Data<'_>,
    sigma: &Rational,
    (claimed, proof, ends): (&Rate<'_>, &Proof, &[Rational; 2]),
    [of_x, of_e, of_zeta]: &[Interval; 3],
) -> Outcome<[Interval; 2]> {
    let pointer = &proof.pointer;
    positive("e_low", &proof.e_low, pointer)?;
    proof.slopes.demand_concave()?;
    let made = Loop::new(d, sigma, proof);
    let [e_low, rate] = [&proof.e_low, &claimed.rate].map(|value| d.number(value));
    let [e_up, z_up] = ends.each_ref().map(|value| d.number(value));
    // Without states there is no place that it stands in.
    let x_up = proof.x_up.as_ref().map_or_else(|| d.int(0), |value| d.number(value));
    let triangle = |entry: &dyn Fn(usize, usize) -> Interval| -> Vec<Vec<Interval>> {
        (0..made.order()).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect()
    };
    let above = triangle(&|i, j| {
        let own = made.at(i, j);
        if i == made.of_e && j == i { own - &e_low } else { own.clone() }
    });
    demand(positive_definite(above), RULE, &format!("{pointer}/e_low"), "Pi > diag(0, e_low, 0)")?;
    let below = triangle(&|i, j| match (i == j, i) {
        (true, i) if i < made.of_e => &x_up - made.at(i, i),
        (true, i) if i == made.of_e => &e_up - made.at(i, i),
        (true, i) => &z_up - made.at(i, i),
        (false, i) => -made.at(i, j),
    });
    demand(positive_definite(below), RULE, &format!("{pointer}/z_up"), "Pi < diag(x_up I, e_up, z_up I)")?;
    for (at, end) in made.ends() {
        let what = format!("(K) for n_o = {}, rate {}{at}", proof.n_o, claimed.rate);
        demand(positive_definite(made.form(&rate, &end)), RULE, &format!("{pointer}/Pi"), what)?;
    }
    Ok([x_up * of_x.sqr() + e_up * of_e.sqr() + z_up * of_zeta.sqr(), e_low])
}
