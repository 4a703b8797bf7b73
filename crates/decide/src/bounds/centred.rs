//! Values on a box with slopes about its middle.
//!
//! For a function F on a box with middle c: `F(z) - F(c) = sum G_i (z_i - c_i)` with `G_i` in the slopes, for every z of the box.
//! So F lies in `F(c) + sum [-h_i, h_i] G_i`, whose excess is of second order in the half-widths h_i. Slopes of products and
//! quotients are those of differences (`uv - u(c)v(c) = u(c) (v - v(c)) + v (u - u(c))`), which are tighter than derivatives and need
//! none; those of functions of one argument are derivatives over the range.

use rug::{Integer, Rational};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::{Binary, Operations, PlantVariable, Unary, enclosed_step};

/// A value on a box; slopes that are `None` are 0.
#[derive(Clone, Debug)]
pub(super) struct Centred {
    /// Contains the value in the middle.
    pub(super) centre: Enclosure,
    /// Contains the value everywhere on the box.
    pub(super) range: Enclosure,
    /// One for each side of the box. Undefined ones say that nothing is known.
    pub(super) slopes: Vec<Option<Enclosure>>,
}

/// The sides of a box.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    /// The half-widths.
    pub(super) halves: Vec<Enclosure>,
    pub(super) precision: u32,
}

impl Centred {
    /// Whether it is exactly 0 all over the box.
    pub(super) fn is_zero(&self) -> bool {
        self.range.is_exact() && self.range.contains_zero()
    }
}

/// `[-r, r]` for a bound r of a magnitude.
fn around_zero(magnitude: &Enclosure) -> Enclosure {
    magnitude.negate().hull(magnitude)
}

/// The opposite.
pub(super) fn negated(a: &Centred) -> Centred {
    let slopes = a.slopes.iter().map(|slope| slope.as_ref().map(Enclosure::negate)).collect();
    Centred { centre: a.centre.negate(), range: a.range.negate(), slopes }
}

fn sum(a: &Option<Enclosure>, b: &Option<Enclosure>) -> Option<Enclosure> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a + b),
        (Some(a), None) => Some(a.clone()),
        (None, b) => b.clone(),
    }
}

/// The sum, not yet tightened.
pub(super) fn plus(a: &Centred, b: &Centred) -> Centred {
    let slopes = a.slopes.iter().zip(&b.slopes).map(|(a, b)| sum(a, b)).collect();
    Centred { centre: &a.centre + &b.centre, range: &a.range + &b.range, slopes }
}

impl Frame {
    /// The number of sides.
    pub(super) fn sides(&self) -> usize {
        self.halves.len()
    }

    /// A value that is the same all over the box.
    pub(super) fn constant(&self, value: Enclosure) -> Centred {
        Centred { centre: value.clone(), range: value, slopes: vec![None; self.sides()] }
    }

    pub(super) fn rational(&self, value: &Rational) -> Centred {
        self.constant(Enclosure::from_rational(value, self.precision))
    }

    /// `sum h_i |G_i|`, an upper bound of how far the value is from that in the middle; `None` if nothing varies.
    pub(super) fn reach(&self, slopes: &[Option<Enclosure>]) -> Option<Enclosure> {
        let terms = slopes.iter().zip(&self.halves).filter_map(|(slope, half)| Some(slope.as_ref()?.abs() * half));
        terms.reduce(|sum, term| sum + term)
    }

    /// The value with its range intersected with what the slopes say.
    pub(super) fn tightened(&self, mut value: Centred) -> Centred {
        if let Some(reach) = self.reach(&value.slopes) {
            let linear = &value.centre + around_zero(&reach);
            if linear.is_defined() && value.range.is_defined() {
                value.range = value.range.intersect(&linear);
            }
        } else if value.centre.is_defined() && value.range.is_defined() {
            // Nothing varies: the value in the middle is that of every point.
            value.range = value.range.intersect(&value.centre);
        }
        value
    }

    pub(super) fn add(&self, a: &Centred, b: &Centred) -> Centred {
        self.tightened(plus(a, b))
    }

    pub(super) fn sub(&self, a: &Centred, b: &Centred) -> Centred {
        let minus = |b: &Option<Enclosure>| b.as_ref().map(Enclosure::negate);
        let slopes = a.slopes.iter().zip(&b.slopes).map(|(a, b)| sum(a, &minus(b))).collect();
        self.tightened(Centred { centre: &a.centre - &b.centre, range: &a.range - &b.range, slopes })
    }

    pub(super) fn mul(&self, a: &Centred, b: &Centred) -> Centred {
        let slopes = a.slopes.iter().zip(&b.slopes);
        let slopes =
            slopes.map(|(da, db)| sum(&da.as_ref().map(|da| da * &b.range), &db.as_ref().map(|db| &a.centre * db)));
        let slopes = slopes.collect();
        self.tightened(Centred { centre: &a.centre * &b.centre, range: &a.range * &b.range, slopes })
    }

    /// The product with a constant.
    pub(super) fn scale(&self, a: &Centred, factor: &Enclosure) -> Centred {
        let slopes = a.slopes.iter().map(|slope| slope.as_ref().map(|slope| slope * factor)).collect();
        Centred { centre: &a.centre * factor, range: &a.range * factor, slopes }
    }

    /// The larger of two values.
    pub(super) fn greater(&self, a: &Centred, b: &Centred) -> Centred {
        self.combine(Binary::Max, a, b)
    }

    /// The absolute value.
    pub(super) fn magnitude(&self, a: &Centred) -> Centred {
        self.apply(Unary::Abs, a)
    }

    /// The Euclidean norm of the sides that are members, of which the low end, the middle and the high end are given.
    ///
    /// `|s| - |c| = sum (s_i + c_i)/(|s| + |c|) (s_i - c_i)`, with factors in [-1, 1].
    pub(super) fn norm(&self, ends: &[[Enclosure; 3]], member: &[bool]) -> Centred {
        let squares = |of: &dyn Fn(&[Enclosure; 3]) -> Enclosure| {
            let members = ends.iter().zip(member).filter(|(_, member)| **member);
            members.fold(Enclosure::zero(self.precision), |sum, (ends, _)| sum + of(ends).sqr()).sqrt()
        };
        let centre = squares(&|[_, middle, _]| middle.clone());
        let range = squares(&|[low, _, high]| low.hull(high));
        let within = around_zero(&Enclosure::one(self.precision));
        let both = &centre + &range;
        let slope = |[low, middle, high]: &[Enclosure; 3]| {
            let factor = (low.hull(high) + middle) / &both;
            if factor.is_defined() { factor.intersect(&within) } else { within.clone() }
        };
        let slopes = ends.iter().zip(member).map(|(ends, member)| member.then(|| slope(ends))).collect();
        self.tightened(Centred { centre, range, slopes })
    }

    fn div(&self, a: &Centred, b: &Centred) -> Centred {
        let centre = &a.centre / &b.centre;
        let slopes = a.slopes.iter().zip(&b.slopes).map(|(da, db)| {
            let numerator = sum(da, &db.as_ref().map(|db| (&centre * db).negate()));
            numerator.map(|numerator| numerator / &b.range)
        });
        let slopes = slopes.collect();
        self.tightened(Centred { centre, range: &a.range / &b.range, slopes })
    }

    /// `f(u)` with these values, where `f(u) - f(u(c)) = factor (u - u(c))`.
    fn chain(&self, centre: Enclosure, range: Enclosure, factor: &Enclosure, u: &Centred) -> Centred {
        let slopes = u.slopes.iter().map(|slope| slope.as_ref().map(|slope| factor * slope)).collect();
        self.tightened(Centred { centre, range, slopes })
    }

    fn apply(&self, operation: Unary, a: &Centred) -> Centred {
        let (centre, range) = (&a.centre, &a.range);
        let one = || Enclosure::one(self.precision);
        match operation {
            Unary::Neg => negated(a),
            Unary::Sqrt => {
                let (root, roots) = (centre.sqrt(), range.sqrt());
                let factor = (&root + &roots).recip();
                self.chain(root, roots, &factor, a)
            }
            Unary::Exp => {
                let values = range.exp();
                self.chain(centre.exp(), values.clone(), &values, a)
            }
            Unary::Log => self.chain(centre.log(), range.log(), &range.recip(), a),
            Unary::Sin => {
                let [cosines, sines] = range.cos_sin();
                self.chain(centre.sin(), sines, &cosines, a)
            }
            Unary::Cos => {
                let [cosines, sines] = range.cos_sin();
                self.chain(centre.cos(), cosines, &sines.negate(), a)
            }
            Unary::Tan => {
                let values = range.tan();
                let factor = values.sqr() + one();
                self.chain(centre.tan(), values, &factor, a)
            }
            Unary::Atan => self.chain(centre.atan(), range.atan(), &(range.sqr() + one()).recip(), a),
            Unary::Tanh => {
                let values = range.tanh();
                let factor = one() - values.sqr();
                self.chain(centre.tanh(), values, &factor, a)
            }
            Unary::Exprelr(order) => {
                self.chain(centre.exprelr(order), range.exprelr(order), &range.exprelr(order + 1), a)
            }
            Unary::Sinc(order) => self.chain(centre.sinc(order), range.sinc(order), &range.sinc(order + 1), a),
            Unary::Abs => {
                // The triangle inequality, where 0 may lie in the range.
                let factor = if range.is_nonnegative().is_true() {
                    one()
                } else if range.is_positive().is_false() {
                    one().negate()
                } else {
                    around_zero(&one())
                };
                self.chain(centre.abs(), range.abs(), &factor, a)
            }
        }
    }

    fn combine(&self, operation: Binary, a: &Centred, b: &Centred) -> Centred {
        match operation {
            Binary::Add => self.add(a, b),
            Binary::Sub => self.sub(a, b),
            Binary::Mul => self.mul(a, b),
            Binary::Div => self.div(a, b),
            Binary::Pow if b.slopes.iter().all(Option::is_none) => {
                let factor = &b.range * a.range.pow(&(&b.range - 1));
                self.chain(a.centre.pow(&b.centre), a.range.pow(&b.range), &factor, a)
            }
            // u^v = exp(v log u)
            Binary::Pow => {
                let exponent = self.mul(b, &self.apply(Unary::Log, a));
                let mut power = self.apply(Unary::Exp, &exponent);
                power.range = a.range.pow(&b.range);
                self.tightened(power)
            }
            Binary::Min | Binary::Max => {
                let (centre, range) = match operation {
                    Binary::Max => (a.centre.max(&b.centre), a.range.max(&b.range)),
                    _ => (a.centre.min(&b.centre), a.range.min(&b.range)),
                };
                // `max(u,v) - max(u,v)(c)` lies between `u - u(c)` and `v - v(c)`, whichever is larger at z and c; min as well.
                let zero = Enclosure::zero(self.precision);
                let slopes = a.slopes.iter().zip(&b.slopes).map(|(da, db)| match (da, db) {
                    (None, None) => None,
                    (da, db) => Some(da.as_ref().unwrap_or(&zero).hull(db.as_ref().unwrap_or(&zero))),
                });
                let slopes = slopes.collect();
                let above = a.range.gt(&b.range);
                match (operation, above.is_true(), above.is_false()) {
                    (Binary::Max, true, _) | (Binary::Min, _, true) => a.clone(),
                    (Binary::Min, true, _) | (Binary::Max, _, true) => b.clone(),
                    _ => self.tightened(Centred { centre, range, slopes }),
                }
            }
        }
    }

    fn raise(&self, base: &Centred, exponent: i32) -> Centred {
        let power = |base: &Enclosure, n: i32| base.pow_integer(&Integer::from(n));
        let factor = match exponent {
            0 => Enclosure::zero(self.precision),
            2 => &base.range + &base.centre,
            n => power(&base.range, n - 1) * i64::from(n),
        };
        self.chain(power(&base.centre, exponent), power(&base.range, exponent), &factor, base)
    }
}

/// The algebra of centred values on a box.
pub(super) struct OnBox<'a> {
    pub(super) frame: &'a Frame,
    pub(super) t: &'a Centred,
    pub(super) x: &'a [Centred],
    pub(super) e: &'a Centred,
    pub(super) p: &'a [Centred],
}

impl Operations for OnBox<'_> {
    type Value = Centred;

    fn number(&mut self, value: &Rational) -> Centred {
        self.frame.rational(value)
    }

    fn pi(&mut self) -> Centred {
        self.frame.constant(Enclosure::pi(self.frame.precision))
    }

    fn variable(&mut self, variable: PlantVariable) -> Centred {
        match variable {
            PlantVariable::Time => self.t.clone(),
            PlantVariable::Error => self.e.clone(),
            PlantVariable::State(index) => {
                let none = || self.frame.constant(Enclosure::undefined(self.frame.precision));
                self.x.get(index).cloned().unwrap_or_else(none)
            }
            PlantVariable::Parameter(index) => {
                let none = || self.frame.constant(Enclosure::undefined(self.frame.precision));
                self.p.get(index).cloned().unwrap_or_else(none)
            }
        }
    }

    fn unary(&mut self, operation: Unary, a: &Centred) -> Centred {
        self.frame.apply(operation, a)
    }

    fn binary(&mut self, operation: Binary, a: &Centred, b: &Centred) -> Centred {
        self.frame.combine(operation, a, b)
    }

    fn power(&mut self, base: &Centred, exponent: i32) -> Centred {
        self.frame.raise(base, exponent)
    }

    fn step(&mut self, a: &Centred) -> Centred {
        self.frame.constant(enclosed_step(&a.range))
    }
}
