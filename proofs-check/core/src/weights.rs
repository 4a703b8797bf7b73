//! Rule: the weights satisfy W1-W3 and decrease strictly (docs/mathematics.md, section 1), and what the other rules need of them.
//!
//! Power family n_l = l^-(1+eps): the three hold for 0 < eps <= 1, and n_0 > 1 = n_1 is left. Explicit list with tail
//! c l^-p: for c > 0, 1 < p <= 2 the tail satisfies them by itself; left are n_l > 0, n_0 > n_1, and W2, W3 from each
//! listed l >= 1 to l + 1, the first of the tail included. W2 gives the rest of the strict decrease.

use crate::constant::{Constant, Number};
use crate::exact::Exact;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::verdict::{Outcome, bad, demand};
use rug::Rational;

/// The most weights that are listed.
const MAX_WEIGHTS: usize = 1000;
const RULE: &str = "weights";

/// Weights that satisfy this rule.
#[derive(Clone, Debug)]
pub struct Weights {
    /// n_0, n_1, ...: one for the power family.
    values: Vec<Constant>,
    /// The tail's coefficient; 1 for the power family.
    coefficient: Option<Constant>,
    /// The exponent of the tail, or eps of the power family.
    exponent: Constant,
}

impl Weights {
    /// Reads and checks.
    pub fn read(field: &Field<'_>) -> Outcome<Weights> {
        let mut fields = field.fields()?;
        let family = fields.required("family")?;
        let weights = match family.text()? {
            "power" => {
                let values = vec![Constant::read(&fields.required("n0")?)?];
                Weights { values, coefficient: None, exponent: Constant::read(&fields.required("epsilon")?)? }
            }
            "explicit" => {
                let list = fields.required("values")?;
                if !(1..=MAX_WEIGHTS).contains(&list.elements()?.len()) {
                    return bad(&list.pointer, format!("expected 1 to {MAX_WEIGHTS} weights"));
                }
                let values = list.list(Constant::read)?;
                let tail = |name, fields: &mut Fields<'_>| Constant::read(&fields.required(name)?);
                let tail = |fields: &mut Fields<'_>| Ok((tail("coefficient", fields)?, tail("exponent", fields)?));
                let (coefficient, exponent) = fields.required("tail")?.object(tail)?;
                Weights { values, coefficient: Some(coefficient), exponent }
            }
            _ => return bad(&family.pointer, "expected `power` or `explicit`"),
        };
        fields.finish()?;
        weights.prove(&field.pointer)?;
        Ok(weights)
    }

    /// The weights that are listed, the tail's coefficient, and its exponent; of the power family n_0, nothing and eps.
    pub fn written(&self) -> (&[Constant], Option<&Constant>, &Constant) {
        (&self.values, self.coefficient.as_ref(), &self.exponent)
    }

    fn prove(&self, pointer: &str) -> Outcome<()> {
        let whole = |n: usize| Number::rational(Rational::from(n));
        // eps for the power family, p - 1 is eps otherwise.
        let least = usize::from(self.coefficient.is_some());
        let exponent = self.exponent.number();
        demand(whole(least).lt(&exponent), RULE, pointer, "W1: the sum of the weights is finite")?;
        demand(exponent.le(&whole(least + 1)), RULE, pointer, "W3: l^2 n_l does not decrease in the tail")?;
        if let Some(coefficient) = &self.coefficient {
            demand(whole(0).lt(&coefficient.number()), RULE, pointer, "the tail's coefficient is positive")?;
        }
        for (l, value) in self.values.iter().enumerate() {
            demand(whole(0).lt(&value.number()), RULE, pointer, format!("n_{l} > 0"))?;
        }
        demand(self.number(1).lt(&self.number(0)), RULE, pointer, "n_0 > n_1")?;
        for l in 1..self.values.len() {
            let scaled = |index: usize, factor: usize| self.number(index as u64).times(whole(factor));
            let next = l + 1;
            let w2 = scaled(next, next).le(&scaled(l, l));
            demand(w2, RULE, pointer, format!("W2 at l = {l}: l n_l does not increase"))?;
            let w3 = scaled(l, l * l).le(&scaled(next, next * next));
            demand(w3, RULE, pointer, format!("W3 at l = {l}: l^2 n_l does not decrease"))?;
        }
        Ok(())
    }

    fn tail_exponent(&self, precision: u32) -> Interval {
        let exponent = self.exponent.enclose(precision);
        if self.coefficient.is_some() { exponent } else { exponent + 1 }
    }

    /// n_l.
    pub fn weight(&self, l: u64, precision: u32) -> Interval {
        if let Some(value) = self.values.get(l as usize) {
            return value.enclose(precision);
        }
        let l = Interval::rational(&Rational::from(l), precision);
        let power = l.pow(&self.tail_exponent(precision)).recip();
        self.coefficient.as_ref().map_or(power.clone(), |coefficient| coefficient.enclose(precision) * &power)
    }

    fn number(&self, l: u64) -> Number<'_> {
        match self.values.get(l as usize) {
            Some(value) => value.number(),
            None => Number { exact: self.exact_tail(l), enclose: Box::new(move |p| self.weight(l, p)) },
        }
    }

    /// A tail weight exactly, where twice its exponent is an integer or l = 1.
    fn exact_tail(&self, l: u64) -> Option<Exact> {
        let one = Exact::rational(&Rational::from(1))?;
        let coefficient = self.coefficient.as_ref().map_or(Some(one), |c| c.exact.clone())?;
        if l == 1 {
            return Some(coefficient);
        }
        let exponent = self.exponent.rational()? + u32::from(self.coefficient.is_none());
        let doubled = exponent * 2u32;
        let halves = (*doubled.denom() == 1).then(|| doubled.numer().to_i32()).flatten()?;
        let root = Exact::rational(&Rational::from(l))?.sqrt()?;
        coefficient.mul(&root.pow(halves)?.recip()?)
    }

    /// Nbar^2 = n_0 + n_1 + ...: the listed ones, and c (zeta(p) - 1 - 2^-p - ...) for the tail.
    pub fn total(&self, precision: u32) -> Interval {
        // Near p = 1 and for long lists the difference cancels; more bits make up for it.
        let work = precision + 64;
        let p = self.tail_exponent(work);
        let before = |l: usize| Interval::rational(&Rational::from(l), work).pow(&p).recip();
        let tail = (1..self.values.len()).fold(p.zeta(), |sum, l| sum - before(l));
        let coefficient = self.coefficient.as_ref().map_or(Interval::int(1, work), |c| c.enclose(work));
        self.values.iter().fold(coefficient * tail, |sum, value| sum + value.enclose(work))
    }

    /// th, an upper bound of sum_{l >= N} n_l/l^2 for N >= 1: N^-(2+eps)/(2+eps) + N^-(3+eps) for the power family (an
    /// integral), and by W2 n_N (1/(2N) + 1/N^2) otherwise.
    pub fn square_tail(&self, n: u32, precision: u32) -> Interval {
        let whole = Interval::int(i64::from(n), precision);
        match self.coefficient {
            None => {
                let exponent = 2 + self.exponent.enclose(precision);
                let power = whole.pow(&exponent).recip();
                &power / exponent + power / whole
            }
            Some(_) => self.weight(u64::from(n), precision) * ((&whole * 2).recip() + whole.sqr().recip()),
        }
    }
}
