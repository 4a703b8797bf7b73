//! The algebra of polynomials with a rest: formulas of a plant on a box of the time and of parameters.

use super::model::{Model, PRECISION, Space};
use super::taylor::{Taylor, TaylorAlgebra};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::{Binary, Operations, PlantVariable, Unary, enclosed_step};

/// Powers up to this one are products.
const MULTIPLIED: u32 = 6;

/// The algebra of models.
pub(crate) struct Models<'a> {
    /// The monomials.
    pub(crate) space: &'a Space,
    /// t.
    pub(crate) time: Model,
    /// The states.
    pub(crate) states: Vec<Model>,
    /// e.
    pub(crate) error: Model,
    /// The parameters of which intervals are known.
    pub(crate) parameters: Vec<Model>,
}

impl Models<'_> {
    fn undefined(&self) -> Model {
        Model { coefficients: Vec::new(), rest: Enclosure::undefined(PRECISION) }
    }

    fn by_series(&self, a: &Model, of: impl Fn(&mut TaylorAlgebra<'_>, &Taylor) -> Taylor) -> Model {
        self.space.composed(a, |series, order| {
            let time = Taylor::new();
            let precision = series.first().map_or(PRECISION, Enclosure::precision);
            let mut algebra = TaylorAlgebra { time: &time, states: &[], parameters: &[], order, precision };
            of(&mut algebra, series)
        })
    }
}

impl Operations for Models<'_> {
    type Value = Model;

    fn number(&mut self, value: &Rational) -> Model {
        self.space.constant(Enclosure::from_rational(value, PRECISION))
    }

    fn pi(&mut self) -> Model {
        self.space.constant(Enclosure::pi(PRECISION))
    }

    fn variable(&mut self, variable: PlantVariable) -> Model {
        let known = match variable {
            PlantVariable::Time => Some(&self.time),
            PlantVariable::Error => Some(&self.error),
            PlantVariable::State(index) => self.states.get(index),
            PlantVariable::Parameter(index) => self.parameters.get(index),
        };
        known.cloned().unwrap_or_else(|| self.undefined())
    }

    fn unary(&mut self, operation: Unary, a: &Model) -> Model {
        match operation {
            Unary::Neg => self.space.scaled(a, &Enclosure::from_integer(-1, PRECISION)),
            Unary::Abs => {
                let range = self.space.range(a);
                if range.is_positive().is_true() {
                    a.clone()
                } else if range.negate().is_positive().is_true() {
                    self.space.scaled(a, &Enclosure::from_integer(-1, PRECISION))
                } else {
                    self.undefined()
                }
            }
            _ => self.by_series(a, |algebra, series| algebra.unary(operation, series)),
        }
    }

    fn binary(&mut self, operation: Binary, a: &Model, b: &Model) -> Model {
        let minus = |b: &Model| self.space.scaled(b, &Enclosure::from_integer(-1, PRECISION));
        match operation {
            Binary::Add => self.space.sum(a, b),
            Binary::Sub => self.space.sum(a, &minus(b)),
            Binary::Mul => self.space.product(a, b),
            Binary::Div => {
                let over = self.by_series(b, |algebra, series| algebra.power(series, -1));
                self.space.product(a, &over)
            }
            Binary::Pow => {
                // Smooth where the base is positive: where it is not, the logarithm is undefined.
                let logarithm = self.by_series(a, |algebra, series| algebra.unary(Unary::Log, series));
                let exponent = self.space.product(b, &logarithm);
                self.by_series(&exponent, |algebra, series| algebra.unary(Unary::Exp, series))
            }
            Binary::Min | Binary::Max => {
                let apart = self.space.range(&self.space.sum(a, &minus(b)));
                // What is not chosen must exist as well.
                let defined = a.rest.is_defined() && b.rest.is_defined();
                let (above, below) = (apart.is_positive().is_true(), apart.negate().is_positive().is_true());
                match (defined && (above || below), above == (operation == Binary::Max)) {
                    (false, _) => self.undefined(),
                    (true, true) => a.clone(),
                    (true, false) => b.clone(),
                }
            }
        }
    }

    fn power(&mut self, base: &Model, exponent: i32) -> Model {
        match u32::try_from(exponent) {
            Ok(exponent @ 1..=MULTIPLIED) => {
                (1..exponent).fold(base.clone(), |power, _| self.space.product(&power, base))
            }
            _ => self.by_series(base, |algebra, series| algebra.power(series, exponent)),
        }
    }

    /// A constant where it is known.
    fn step(&mut self, a: &Model) -> Model {
        self.space.constant(enclosed_step(&self.space.range(a)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::expr::{Formulas, PlantExpr, PlantNames};

    /// t, one state, e and x_1 on t = 1/4 + x_0/8, state = 2 + x_0/4, e = x_1/2.
    fn models(space: &Space) -> Models<'_> {
        let exact = |a: i32, b: i32| Enclosure::from_rational(&Rational::from((a, b)), PRECISION);
        Models {
            space,
            time: space.variable(0, exact(1, 4), exact(1, 8)),
            states: vec![space.variable(0, exact(2, 1), exact(1, 4))],
            error: space.variable(1, exact(0, 1), exact(1, 2)),
            parameters: Vec::new(),
        }
    }

    fn evaluated(text: &str, space: &Space) -> Model {
        let names = PlantNames::new(vec!["v".to_owned()]).unwrap();
        let mut formulas = Formulas::new();
        let formula = formulas.insert(&PlantExpr::parse(text, &names).unwrap());
        formulas.walk(&[formula]).evaluate(&mut models(space)).remove(0)
    }

    /// The value at a point of the box, with the rest.
    fn at(space: &Space, model: &Model, x: [f64; 2]) -> Enclosure {
        let terms = model.coefficients.iter().zip(&space.monomials).map(|(value, powers)| {
            let power = |i: usize| Enclosure::exactly(x[i]).pow_integer(&powers[i].into());
            value * power(0) * power(1)
        });
        let rest = model.rest.negate().hull(&model.rest);
        terms.fold(rest, |sum, term| sum + term)
    }

    type Case = (&'static str, fn(f64, f64, f64) -> f64);

    const SMOOTH: [Case; 8] = [
        ("v*e - t/v + 3", |t, v, e| v * e - t / v + 3.0),
        ("exp(-e^2)*cos(3*t)", |t, _, e| (-e * e).exp() * (3.0 * t).cos()),
        ("sqrt(1 + v^2 + e)", |_, v, e| (1.0 + v * v + e).sqrt()),
        ("log(v)*tanh(t + e)", |t, v, e| v.ln() * (t + e).tanh()),
        ("v^(e/3)", |_, v, e| v.powf(e / 3.0)),
        ("abs(e - 1)*max(v, t) + min(v, e)", |_, v, e| (e - 1.0).abs() * v + e),
        ("(6 - v)^-2 + atan(e/4)^3", |_, v, e| (6.0 - v).powi(-2) + (e / 4.0).atan().powi(3)),
        ("0*e + v^0", |_, _, _| 1.0),
    ];

    #[test]
    fn models_contain_the_values() {
        for (text, value) in SMOOTH {
            let mut rests = Vec::new();
            for degree in [3, 7] {
                let space = Space::new(2, degree);
                let model = evaluated(text, &space);
                rests.push(model.rest.upper_f64());
                let mut largest = 0.0_f64;
                for [x, y] in [[-1.0, -1.0], [-1.0, 1.0], [0.0, 0.0], [0.5, -0.75], [1.0, 1.0], [1.0, -1.0]] {
                    let expected = value(0.25 + x / 8.0, 2.0 + x / 4.0, y / 2.0);
                    let found = at(&space, &model, [x, y]);
                    let close = 1e-12 * (1.0 + expected.abs());
                    assert!(found.lower_f64() - close <= expected && expected <= found.upper_f64() + close, "{text}");
                    largest = largest.max(expected.abs());
                }
                let bound = space.largest(&model, 1.01 * largest, 12).upper_f64();
                assert!(largest <= bound * (1.0 + 1e-12) && bound <= space.bound(&model).upper_f64(), "{text}");
            }
            // The higher the degree, the less is left.
            assert!(rests[1] <= 0.25 * rests[0], "{text}: {rests:?}");
        }
    }

    /// About a point so near a singularity that its series has coefficients beyond the range of doubles.
    #[test]
    fn a_root_of_what_is_tiny_is_smooth() {
        for (text, value) in [("sqrt(1e-60*v)", 1e-30 * 2.25_f64.sqrt()), ("log(1e-340*(v + 1)/v)", -782.0)] {
            let space = Space::new(2, 12);
            let bound = space.bound(&evaluated(text, &space)).upper_f64();
            assert!(bound >= value.abs() && bound <= 2.0 * value.abs() + 1.0, "{text}: {bound}");
        }
    }

    #[test]
    fn what_is_not_smooth_on_the_box_has_no_bound() {
        let space = Space::new(2, 5);
        for text in [
            "1/e",
            "sqrt(e)",
            "log(t - 1/4)",
            "abs(e)",
            "max(e, 0)",
            "tan(pi/2 + e)",
            "0*abs(e)",
            "e^(1/3)",
            "1/(v - 2)",
        ] {
            let model = evaluated(text, &space);
            assert!(!space.bound(&model).is_bounded(), "{text}: {model:?}");
            assert!(!space.largest(&model, 1.0, 4).is_bounded(), "{text}");
        }
    }
}
