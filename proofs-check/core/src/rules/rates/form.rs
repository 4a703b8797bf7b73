//! Quadratic forms that are sums of products of linear functions of their variables.

use crate::interval::Interval;
use std::ops::Add;

/// A linear function: the variables that it has, each once, with what stands before them.
#[derive(Clone)]
pub struct Linear(Vec<(usize, Interval)>);

impl Linear {
    /// A variable.
    pub fn of(variable: usize, factor: Interval) -> Linear {
        Linear(vec![(variable, factor)])
    }

    /// The function 0.
    pub fn zero() -> Linear {
        Linear(Vec::new())
    }

    /// The function times a number.
    pub fn times(&self, factor: &Interval) -> Linear {
        Linear(self.0.iter().map(|(variable, before)| (*variable, before * factor)).collect())
    }
}

impl Add for Linear {
    type Output = Linear;
    fn add(mut self, other: Linear) -> Linear {
        for (variable, factor) in other.0 {
            match self.0.iter_mut().find(|(own, _)| *own == variable) {
                Some((_, own)) => *own = &*own + factor,
                None => self.0.push((variable, factor)),
            }
        }
        self
    }
}

/// The symmetric matrix of a form, its lower triangle by rows.
pub struct Form {
    pub rows: Vec<Vec<Interval>>,
}

impl Form {
    /// The form 0 in so many variables.
    pub fn zero(variables: usize, precision: u32) -> Form {
        let row = |i: usize| vec![Interval::int(0, precision); i + 1];
        Form { rows: (0..variables).map(row).collect() }
    }

    /// Adds `factor a b`.
    pub fn add(&mut self, factor: &Interval, a: &Linear, b: &Linear) {
        for (i, before) in a.times(factor).0 {
            for (j, other) in &b.0 {
                let product = &before * other;
                let entry = &mut self.rows[i.max(*j)][i.min(*j)];
                *entry = &*entry + if i == *j { product } else { product / 2 };
            }
        }
    }

    /// Adds `factor a^2`.
    pub fn add_square(&mut self, factor: &Interval, a: &Linear) {
        self.add(factor, a, a);
    }
}
