//! Trigonometric polynomials of the period with rational coefficients, as a file has them.

use crate::jacobian::harmonics;
use crate::json::{Field, Fields};
use crate::verdict::{Outcome, bad};
use rug::Rational;

/// `mean + sum over k of a_k cos(k Om t) + b_k sin(k Om t)`.
#[derive(Clone, Debug)]
pub struct Wave {
    pub mean: Rational,
    /// a_k, b_k for k = 1, 2, ...
    pub harmonics: Vec<[Rational; 2]>,
}

impl Wave {
    /// Whether it has no harmonics.
    pub fn is_constant(&self) -> bool {
        self.harmonics.iter().flatten().all(Rational::is_zero)
    }

    /// a_k and b_k, of any k >= 1.
    pub fn harmonic(&self, k: usize) -> [Rational; 2] {
        k.checked_sub(1).and_then(|place| self.harmonics.get(place).cloned()).unwrap_or_default()
    }

    /// Takes `mean` and at most so many `harmonics` out of an object.
    pub fn read(fields: &mut Fields<'_>, most: usize) -> Outcome<Wave> {
        Ok(Wave { mean: fields.number("mean")?, ..Wave::read_without_mean(fields, most)? })
    }

    /// Takes at most so many `harmonics` out of an object, with no mean.
    pub fn read_without_mean(fields: &mut Fields<'_>, most: usize) -> Outcome<Wave> {
        Ok(Wave { mean: Rational::new(), harmonics: harmonics(fields, most, |field| field.rational())? })
    }

    /// As [`Wave::read`], of lists of `order` numbers, one for each state: the waves of these.
    pub fn read_all(fields: &mut Fields<'_>, order: usize, most: usize) -> Outcome<Vec<Wave>> {
        let vector = |field: &Field<'_>| {
            let list = field.list(Field::rational)?;
            let right = list.len() == order;
            if right { Ok(list) } else { bad(&field.pointer, format!("expected {order} numbers, one for each state")) }
        };
        let (mean, harmonics) = (vector(&fields.required("mean")?)?, harmonics(fields, most, vector)?);
        let of = |(i, mean): (usize, Rational)| Wave {
            mean,
            harmonics: harmonics.iter().map(|[cos, sin]| [cos[i].clone(), sin[i].clone()]).collect(),
        };
        Ok(mean.into_iter().enumerate().map(of).collect())
    }
}
