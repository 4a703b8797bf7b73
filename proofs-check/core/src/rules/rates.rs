//! Rule: rates for given numbers of oscillators, at the gain of the claim and no other (docs/mathematics.md, section 13.6).
//!
//! With `zs = N^(1/2) zeta`, `b = N^(1/2) M`, `y = (e, zs)` and `B = (1, -b)`, all of them differences to the periodic solution, in the
//! error box `y' = A y + B (delta e + u)`, `A = [-sigma, mu b'; 0, Phi - mu b b']`, `delta` in `[-k_e, most]`, `|u| <= k_x xi`, and
//! `(xi^2)' <= -2 a_2 xi^2 + 2 sqrt(P_up) k_f xi |e|`. A witness for one n_o is Pi, w, l, e_low, e_up and z_up, with `W = w xi^2 + y'Pi y`.
//!
//! Guarantee of [`prove`], for each of them: with `w > 0`, `Pi >= diag(e_low, 0)`, `e_low > 0`, and the form of (R),
//! `2 w (a_2 - rate) xi^2 - 2 w sqrt(P_up) k_f xi e - 2 y'Pi ((A + rate) y + B delta e + B u) + l (u^2 - k_x^2 xi^2)`,
//! positive definite at both ends of delta, in which it is affine, `W' <= -2 rate W` while the solution is in the box, where C4 and C5 keep it
//! (for e < 0 by the form at (xi, -y, -u); its corner l is above 0). So `e^2 <= W/e_low`, and with `Pi <= diag(e_up, z_up I)` the W of a start
//! is at most `w P_up dX^2 + e_up dE^2 + z_up dZ^2`, which `factor^2 e_low` is not below. Without w and l, k_x is 0: then the equations of
//! y do not have xi, and `W = y'Pi y` serves. With an input gain b the loop has `b mu` for mu and `delta + (1-b) sigma` for delta
//! (section 13.1): affine in b too, so that the four corners serve.

use super::common::{Free, Sizes};
use super::stability::{ErrorBox, distances};
use crate::data::Data;
use crate::interval::Interval;
use crate::jacobian::Matrix;
use crate::json::{Field, Fields};
use crate::matrix::positive_definite;
use crate::verdict::{Condition, Outcome, bad, demand, invalid};
use rug::Rational;

/// The name of the rule.
pub const RULE: &str = "rates";

/// The most of them, and the largest n_o.
pub const MOST: usize = 8;
pub const LARGEST: u32 = 50;

/// That `|e - e_per| <= factor exp(-rate (t - t_0))` with n_o oscillators, at the gain of the claim.
pub struct Rate<'a> {
    pub pointer: String,
    pub n_o: u32,
    pub rate: Rational,
    pub factor: Rational,
    /// The two numbers as they are written.
    texts: [&'a str; 2],
}

impl<'a> Rate<'a> {
    /// Reads the part `for_n_o`: each n_o once, in order.
    pub fn read_all(field: &Field<'a>) -> Outcome<Vec<Rate<'a>>> {
        let mut rates: Vec<Rate<'a>> = Vec::new();
        for field in field.elements()? {
            let mut fields = field.fields()?;
            let n_o = read_count(&mut fields)?;
            if rates.last().is_some_and(|before| before.n_o >= n_o) {
                return bad(&format!("{}/n_o", field.pointer), "expected each n_o once, in rising order");
            }
            let [rate, factor] = [fields.required("rate")?, fields.required("factor")?];
            fields.finish()?;
            rates.push(Rate {
                pointer: field.pointer.clone(),
                n_o,
                rate: rate.rational()?,
                factor: factor.rational()?,
                texts: [rate.numeral()?, factor.numeral()?],
            });
        }
        Ok(rates)
    }

    /// Its sentence in the claim, with a space before it.
    pub fn in_words(&self, sigma: &str) -> String {
        // A fraction stands in front of a product.
        let [rate, factor] = self.texts.map(|text| match text.contains('/') {
            true => format!("({text})"),
            false => text.to_owned(),
        });
        format!(
            " With n_o = {} and sigma = {sigma} exactly also |e(t) - e_per(t)| <= {factor} exp(-{rate} (t - t_0)) for these solutions, e_per \
             that of the periodic solution and t_0 the initial time.",
            self.n_o
        )
    }
}

/// What proves the rate of one n_o.
pub struct Witness {
    pointer: String,
    n_o: u32,
    /// w and l; none where x has no part in it.
    of_x: Option<[Rational; 2]>,
    /// The lower triangle of Pi, by rows.
    pi: Matrix,
    e_low: Rational,
    e_up: Rational,
    z_up: Rational,
}

impl Witness {
    /// Reads the part `for_n_o` of a witness.
    pub fn read_all(field: &Field<'_>) -> Outcome<Vec<Witness>> {
        read_list(field, Witness::read)
    }

    fn read(field: &Field<'_>) -> Outcome<Witness> {
        let mut fields = field.fields()?;
        let n_o = read_count(&mut fields)?;
        let pi = triangle(&fields.required("Pi")?, 2 * n_o as usize + 2, "one for e and one for each state of zeta")?;
        let of_x = match (fields.optional("w"), fields.optional("l")) {
            (None, None) => None,
            (Some(w), Some(l)) => Some([w.rational()?, l.rational()?]),
            _ => return bad(&field.pointer, "`w` and `l` go together"),
        };
        let mut number = |name| fields.required(name)?.rational();
        let [e_low, e_up, z_up] = [number("e_low")?, number("e_up")?, number("z_up")?];
        fields.finish()?;
        Ok(Witness { pointer: field.pointer.clone(), n_o, of_x, pi, e_low, e_up, z_up })
    }
}

/// What proves the rates of a claim, each by itself.
pub(super) fn read_list<T>(field: &Field<'_>, read: impl Fn(&Field<'_>) -> Outcome<T>) -> Outcome<Vec<T>> {
    let list = field.elements()?;
    if list.is_empty() || list.len() > MOST {
        return bad(&field.pointer, format!("expected 1 to {MOST} rates"));
    }
    list.iter().map(read).collect()
}

/// The numbers of a row.
pub(super) fn numbers(row: &Field<'_>) -> Outcome<Vec<Rational>> {
    row.elements()?.iter().map(Field::rational).collect()
}

/// The lower triangle of a matrix of so many rows; `what` they are.
pub(super) fn triangle(rows: &Field<'_>, order: usize, what: &str) -> Outcome<Matrix> {
    let list = rows.elements()?;
    if list.len() != order {
        return bad(&rows.pointer, format!("expected {order} rows, {what}"));
    }
    let matrix = list.iter().map(numbers).collect::<Outcome<Matrix>>()?;
    if let Some(i) = matrix.iter().enumerate().position(|(i, row)| row.len() != i + 1) {
        return bad(&list[i].pointer, format!("expected {} numbers, up to the diagonal", i + 1));
    }
    Ok(matrix)
}

/// An n_o that is not too large.
pub(super) fn read_count(fields: &mut Fields<'_>) -> Outcome<u32> {
    let field = fields.required("n_o")?;
    let n_o = field.whole()?;
    if n_o > LARGEST { bad(&field.pointer, format!("expected at most {LARGEST}")) } else { Ok(n_o) }
}

/// Proves every rate of a claim at its gain, around a periodic solution of these sizes: of a claim that rests on norms.
pub fn prove(
    d: &Data<'_>,
    (free, sizes, sigma): (&Free, &Sizes, &Rational),
    (claimed, witnesses): (&[Rate<'_>], &[Witness]),
    lines: &mut Vec<String>,
) -> Outcome<()> {
    let radii = [&free.d_x, &free.d_e].map(|value| d.number(value));
    let error_box = ErrorBox::new(d, free.paths, [&sizes.x, &sizes.e], radii.each_ref());
    let start = distances(d, &free.set, [&sizes.x, &sizes.e, &sizes.zeta]);
    for (rate, witness) in claimed.iter().zip(witnesses) {
        if rate.n_o != witness.n_o {
            return bad(&format!("{}/n_o", witness.pointer), format!("the claim has n_o = {} here", rate.n_o));
        }
        Loop::new(d, &error_box, sigma, witness).prove(rate, witness, &start, lines)?;
    }
    Ok(())
}

/// The error system of one n_o, with Pi.
struct Loop<'a> {
    d: &'a Data<'a>,
    error_box: &'a ErrorBox,
    sigma: Interval,
    /// sqrt(n_l) at e (as 1, for B) and at the states of zs; 0 at the second state of an oscillator.
    b: Vec<Interval>,
    pi: Vec<Vec<Interval>>,
    /// Pi B.
    image: Vec<Interval>,
}

impl<'a> Loop<'a> {
    fn new(d: &'a Data<'a>, error_box: &'a ErrorBox, sigma: &Rational, witness: &Witness) -> Loop<'a> {
        let root = |l: u32| d.spec.weights.weight(u64::from(l), d.precision).sqrt();
        let mut b = vec![d.int(1), root(0)];
        (1..=witness.n_o).for_each(|l| b.extend([root(l), d.int(0)]));
        let pi: Vec<Vec<Interval>> =
            witness.pi.iter().map(|row| row.iter().map(|value| d.number(value)).collect()).collect();
        let mut made = Loop { d, error_box, sigma: d.number(sigma), b, pi, image: Vec::new() };
        let order = made.b.len();
        let image = |i: usize| {
            let rest = (1..order).filter(|k| !made.b[*k].is_zero());
            rest.fold(made.at(i, 0).clone(), |sum, k| sum - made.at(i, k) * &made.b[k])
        };
        made.image = (0..order).map(image).collect();
        made
    }

    fn at(&self, i: usize, j: usize) -> &Interval {
        &self.pi[i.max(j)][i.min(j)]
    }

    /// The corners: b mu and delta.
    fn corners(&self) -> Vec<[Interval; 2]> {
        let ErrorBox { k_e, most, .. } = self.error_box;
        let slopes = [-k_e, most.clone()];
        match &self.d.gain {
            None => slopes.map(|slope| [self.d.mu.clone(), slope]).to_vec(),
            Some(gain) => {
                let moved = gain.shifts(&self.sigma);
                let ends = [&gain.low, &gain.high].into_iter().zip(&moved);
                ends.flat_map(|(end, moved)| slopes.each_ref().map(|slope| [end * &self.d.mu, slope + moved])).collect()
            }
        }
    }

    /// `(Pi A)_ij` with `delta e` as one more input: `(delta, mu b')` comes back through B, -sigma stands with e, and
    /// `Phi = l w [0, 1; -1, 0]`.
    fn moved(&self, i: usize, j: usize, [mu, delta]: &[Interval; 2]) -> Interval {
        let through = &self.image[i] * &(if j == 0 { delta.clone() } else { mu * &self.b[j] });
        let turn = |l: usize| &self.d.w * l as i64;
        match j {
            0 => through - self.at(i, 0) * &self.sigma,
            1 => through,
            first if first % 2 == 0 => through - self.at(i, j + 1) * &turn(j / 2),
            _ => through + self.at(i, j - 1) * &turn(j / 2),
        }
    }

    /// The lower triangle of the form of (R) in (y, u, xi), or in y where x has no part in it.
    fn form(&self, rate: &Interval, of_x: Option<[&Interval; 2]>, corner: &[Interval; 2]) -> Vec<Vec<Interval>> {
        let order = self.b.len();
        let entry =
            |i: usize, j: usize| -(self.moved(i, j, corner) + self.moved(j, i, corner) + self.at(i, j) * rate * 2);
        let mut rows: Vec<Vec<Interval>> = (0..order).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect();
        if let Some([w, l]) = of_x {
            let ErrorBox { k_x, k_f, rate: a_2, .. } = self.error_box;
            rows.push(self.image.iter().map(|value| -value).chain([l.clone()]).collect());
            let mut last = vec![self.d.int(0); order + 1];
            last[0] = -(w * self.d.p_up.sqrt() * k_f);
            last.push(w * (a_2 - rate) * 2 - l * k_x.sqr());
            rows.push(last);
        }
        rows
    }

    fn prove(
        &self,
        claimed: &Rate<'_>,
        witness: &Witness,
        [of_x, of_e, of_zeta]: &[Interval; 3],
        lines: &mut Vec<String>,
    ) -> Outcome<()> {
        let (d, pointer) = (self.d, &witness.pointer);
        let of_sign = |name: &str, value: &Rational, at: &str| match *value > 0 {
            true => Ok(()),
            false => invalid(RULE, &format!("{at}/{name}"), format!("0 < {name} fails: {name} = {value}")),
        };
        of_sign("rate", &claimed.rate, &claimed.pointer)?;
        of_sign("factor", &claimed.factor, &claimed.pointer)?;
        of_sign("e_low", &witness.e_low, pointer)?;
        match &witness.of_x {
            Some([w, l]) => {
                of_sign("w", w, pointer)?;
                of_sign("l", l, pointer)?;
            }
            None => {
                let k_x = &self.error_box.k_x;
                let truth = if k_x.is_zero() { Some(true) } else { k_x.is_positive().then_some(false) };
                demand(truth, RULE, pointer, "k_x = 0, where there is no `w`")?;
            }
        }
        let [e_low, e_up, z_up, rate, factor] =
            [&witness.e_low, &witness.e_up, &witness.z_up, &claimed.rate, &claimed.factor].map(|value| d.number(value));
        let order = self.b.len();
        let triangle = |entry: &dyn Fn(usize, usize) -> Interval| -> Vec<Vec<Interval>> {
            (0..order).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect()
        };
        let above = triangle(&|i, j| if i == 0 { self.at(0, 0) - &e_low } else { self.at(i, j).clone() });
        demand(positive_definite(above), RULE, &format!("{pointer}/e_low"), "Pi > diag(e_low, 0)")?;
        let below = triangle(&|i, j| match (i == j, i) {
            (true, 0) => &e_up - self.at(0, 0),
            (true, _) => &z_up - self.at(i, i),
            (false, _) => -self.at(i, j),
        });
        demand(positive_definite(below), RULE, &format!("{pointer}/z_up"), "Pi < diag(e_up, z_up I)")?;
        let of_x_numbers = witness.of_x.as_ref().map(|both| both.each_ref().map(|value| d.number(value)));
        for corner in self.corners() {
            let form = self.form(&rate, of_x_numbers.as_ref().map(|both| both.each_ref()), &corner);
            let what = format!("(R) for n_o = {}, rate {}", witness.n_o, claimed.rate);
            demand(positive_definite(form), RULE, &format!("{pointer}/Pi"), what)?;
        }
        let w = of_x_numbers.map_or_else(|| d.int(0), |[w, _]| w);
        let level = w * &d.p_up * of_x.sqr() + e_up * of_e.sqr() + z_up * of_zeta.sqr();
        let what = format!("w P_up dX^2 + e_up dE^2 + z_up dZ^2 <= factor^2 e_low, n_o = {}", witness.n_o);
        let condition = Condition::at_most("R", what, level, factor.sqr() * e_low);
        lines.push(condition.line());
        condition.demand(RULE, &format!("{}/factor", claimed.pointer))
    }
}
