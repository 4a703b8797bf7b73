//! The norm `y'Pi y` of a witness for one n_o, in `y = (e, zs)`, `zs = N^(1/2) zeta` (docs/mathematics.md, section 13.6).
//!
//! Guarantee: with [`Norm::lies_above`] and [`Norm::start`] `e_low e^2 <= y'Pi y <= e_up e^2 + z_up |zeta|_N^2` for y not 0.

use super::claimed::RULE;
use super::stored::triangle;
use crate::data::Data;
use crate::interval::Interval;
use crate::jacobian::Matrix;
use crate::json::Fields;
use crate::matrix::positive_definite;
use crate::verdict::{Outcome, demand, invalid};
use rug::Rational;

/// Pi as a witness has it.
pub struct Stored {
    /// Where it stands in the file.
    pub pointer: String,
    pub n_o: u32,
    /// The lower triangle of Pi, by rows.
    rows: Matrix,
    e_low: Rational,
}

impl Stored {
    /// Takes `Pi` and `e_low` out of the part for this n_o.
    pub fn read(fields: &mut Fields<'_>, n_o: u32) -> Outcome<Stored> {
        let order = 2 * n_o as usize + 2;
        let rows = triangle(&fields.required("Pi")?, order, "one for e and one for each state of zeta")?;
        let e_low = fields.required("e_low")?.rational()?;
        Ok(Stored { pointer: fields.pointer.clone(), n_o, rows, e_low })
    }
}

/// The same, enclosed, with `B = (1, -b)`, `b = N^(1/2) M`.
pub struct Norm {
    pointer: String,
    pub e_low: Interval,
    rows: Vec<Vec<Interval>>,
    /// 1 at e, and sqrt(n_l) at the states of zs, 0 at the second one of an oscillator.
    pub b: Vec<Interval>,
    /// Pi B.
    pub image: Vec<Interval>,
}

impl Norm {
    /// Encloses it; e_low is demanded to be above 0.
    pub fn new(d: &Data<'_>, stored: &Stored) -> Outcome<Norm> {
        positive("e_low", &stored.e_low, &stored.pointer)?;
        let root = |l: u32| d.spec.weights.weight(u64::from(l), d.precision).sqrt();
        let mut b = vec![d.int(1), root(0)];
        (1..=stored.n_o).for_each(|l| b.extend([root(l), d.int(0)]));
        let rows = stored.rows.iter().map(|row| row.iter().map(|value| d.number(value)).collect()).collect();
        let (pointer, e_low) = (stored.pointer.clone(), d.number(&stored.e_low));
        let mut norm = Norm { pointer, e_low, rows, b, image: Vec::new() };
        let direction: Vec<Interval> = (0..norm.order()).map(|k| norm.at_input(k)).collect();
        norm.image = norm.times(&direction);
        Ok(norm)
    }

    /// The number of states.
    pub fn order(&self) -> usize {
        self.b.len()
    }

    /// An entry of Pi.
    pub fn at(&self, i: usize, j: usize) -> &Interval {
        &self.rows[i.max(j)][i.min(j)]
    }

    /// An entry of B.
    pub fn at_input(&self, k: usize) -> Interval {
        if k == 0 { self.b[0].clone() } else { -&self.b[k] }
    }

    /// `Pi` times a vector.
    pub fn times(&self, vector: &[Interval]) -> Vec<Interval> {
        let zero = Interval::int(0, self.e_low.precision());
        let row = |i: usize| {
            let parts = vector.iter().enumerate().filter(|(_, value)| !value.is_zero());
            parts.fold(zero.clone(), |sum, (k, value)| sum + self.at(i, k) * value)
        };
        (0..self.order()).map(row).collect()
    }

    fn triangle(&self, entry: &dyn Fn(usize, usize) -> Interval) -> Vec<Vec<Interval>> {
        (0..self.order()).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect()
    }

    /// `Pi > diag(e_low, 0)`.
    pub fn lies_above(&self) -> Outcome<()> {
        let rest = self.triangle(&|i, j| if i == 0 { self.at(0, 0) - &self.e_low } else { self.at(i, j).clone() });
        demand(positive_definite(rest), RULE, &format!("{}/e_low", self.pointer), "Pi > diag(e_low, 0)")
    }

    /// Demands `Pi < diag(e_up, z_up I)`, and bounds `w xi^2 + y'Pi y` from above at a start within dX, dE and dZ.
    pub fn start(
        &self,
        d: &Data<'_>,
        w: Option<&Interval>,
        ends: &[Rational; 2],
        [of_x, of_e, of_zeta]: &[Interval; 3],
    ) -> Outcome<Interval> {
        let [e_up, z_up] = ends.each_ref().map(|value| d.number(value));
        let rest = self.triangle(&|i, j| match (i == j, i) {
            (true, 0) => &e_up - self.at(0, 0),
            (true, _) => &z_up - self.at(i, i),
            (false, _) => -self.at(i, j),
        });
        demand(positive_definite(rest), RULE, &format!("{}/z_up", self.pointer), "Pi < diag(e_up, z_up I)")?;
        let of_x = w.map_or_else(|| d.int(0), |w| w * &d.p_up * of_x.sqr());
        Ok(of_x + e_up * of_e.sqr() + z_up * of_zeta.sqr())
    }
}

/// That a number of a witness or a claim is above 0.
pub fn positive(name: &str, value: &Rational, pointer: &str) -> Outcome<()> {
    if *value > 0 {
        return Ok(());
    }
    invalid(RULE, &format!("{pointer}/{name}"), format!("0 < {name} fails: {name} = {value}"))
}

/// That the parts for x are left out only where x has no part in e.
pub fn no_part_of_x(k_x: &Interval, pointer: &str) -> Outcome<()> {
    let truth = if k_x.is_zero() { Some(true) } else { k_x.is_positive().then_some(false) };
    demand(truth, RULE, pointer, "k_x = 0, where there is no `w`")
}
