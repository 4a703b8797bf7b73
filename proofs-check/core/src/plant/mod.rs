//! What a claim needs of a plant that is given by its formulas (docs/mathematics.md, sections 11.3 and 11.5): the values that
//! stand in the place of bounding functions, its coordinates, and what is asked of it. That the values are true of the
//! formulas is proved by whoever reads these (the crate `proofs-plants`).

pub mod coordinates;
pub mod entries;
pub mod parameters;

use crate::constant::{Constant, Number};
use crate::interval::Interval;
use crate::verdict::{Outcome, demand};
use coordinates::Coordinates;
use entries::Entries;
use parameters::Parameter;
use rug::{Float, Rational};

/// The precision, in bits, at which an irrational domain is rounded down.
const DOMAIN_PRECISION: u32 = 256;

/// A plant as a claim sees it.
#[derive(Clone, Debug)]
pub struct OfPlant {
    pub states: usize,
    pub domain: Option<[Constant; 2]>,
    /// The ball that the initial set has to contain, if one is given.
    pub ball: Option<Constant>,
    pub coordinates: Coordinates,
    pub entries: Entries,
    /// Those of which intervals are given, in the order of the file.
    pub parameters: Vec<Parameter>,
    /// Whether the box of these is cut into cells, each with an orbit of its own.
    pub in_cells: bool,
    /// Whether existence has a P of its own.
    pub two_matrices: bool,
}

impl OfPlant {
    /// Whether the ball that is asked for is no larger than this one.
    pub fn asks_for(&self, ball: &Rational) -> Option<bool> {
        match &self.ball {
            None => Some(true),
            Some(asked) => asked.number().le(&Number::rational(ball.clone())),
        }
    }

    /// The largest arguments that are used lie in the domain of a plant (section 11.5).
    pub fn lies_within(&self, [x, e]: [&Float; 2], pointer: &str) -> Outcome<()> {
        let Some(ends) = &self.domain else { return Ok(()) };
        let exactly = |end: &Float| Interval::point(end).upper();
        // Constants that are not rational are rounded down.
        let [to_x, to_e] = ends.each_ref().map(|end| end.rational().or_else(|| end.enclose(DOMAIN_PRECISION).lower()));
        let x_lies_within = exactly(x).zip(to_x).map(|(x, to)| self.coordinates.lies_within(&x, &to));
        let e_lies_within = exactly(e).zip(to_e).map(|(e, to)| e <= to);
        demand(
            x_lies_within,
            coordinates::RULE,
            pointer,
            "domain x^2 I - X^2 L'L >= 0 for the largest X that is used",
        )?;
        demand(e_lies_within, coordinates::RULE, pointer, "the largest E that is used <= domain e")
    }
}
