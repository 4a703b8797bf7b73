//! A plant that is linear in x and e, read off its formulas.

use super::PRECISION;
use super::member::{Family, Member};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::{Enclosing, Formulas, Monomial, PlantVariable, VariableSet, Walk};
use sigmastar_lang::plant::Plant;

/// The most harmonics of f(t,0,0) and q(t,0,0): for each number of oscillators below it the periodic solution is another one.
pub const MAX_LINES: usize = 16;

/// A plant `x' = A x + b e + f_0(t)`, `e' = c x + d e + q_0(t) + u` whose A, b, c, d depend on nothing but the parameters and whose f_0, q_0
/// are trigonometric polynomials of the period, in the coordinates of its file.
#[derive(Clone, Debug)]
pub struct LinearPlant {
    states: usize,
    lines: usize,
    /// The rows of f and then q; in each the derivatives by x and then by e.
    slopes: Walk,
    /// f(t,0,0) and then q(t,0,0).
    origin: Walk,
    /// The derivatives of both along each parameter.
    along: Vec<[Walk; 2]>,
    period: Monomial,
    /// The box of the parameters.
    whole: Vec<[Rational; 2]>,
}

impl LinearPlant {
    /// The plant as a linear one.
    ///
    /// Guarantee: `Some` only if, for all parameters of the box, f and q are defined wherever they are at one x and e, their first
    /// derivatives by x and e depend on the parameters alone, and f(t,0,0) and q(t,0,0) are trigonometric polynomials of the period, of
    /// degree [`MAX_LINES`] at most. `None` also where the period is known to an interval only, or is no number in closed form.
    #[must_use]
    pub fn of(plant: &Plant) -> Option<LinearPlant> {
        if plant.period.interval().is_some() {
            return None;
        }
        let states = plant.states();
        let variables: Vec<PlantVariable> =
            (0..states).map(PlantVariable::State).chain([PlantVariable::Error]).collect();
        let state_and_error =
            variables.iter().fold(VariableSet::NONE, |all, variable| all.and(VariableSet::of(*variable)));
        let mut formulas = Formulas::new();
        let mut sides = Vec::new();
        for expr in plant.f.iter().chain([&plant.q]) {
            let (side, demands) = formulas.insert_with_demands(expr);
            // What must not vanish, or must be positive, is so at every x and e once it is at one.
            let of: Vec<_> = demands.iter().map(|demand| demand.of).collect();
            if formulas.walk(&of).all_variables().meets(state_and_error) {
                return None;
            }
            sides.push(side);
        }
        let columns: Vec<Vec<_>> = variables.iter().map(|variable| formulas.derivatives(&sides, *variable)).collect();
        let entries: Vec<_> = (0..=states).flat_map(|row| columns.iter().map(move |column| column[row])).collect();
        let slopes = formulas.walk(&entries);
        if slopes.all_variables().meets(state_and_error.and(VariableSet::of(PlantVariable::Time))) {
            return None;
        }
        let whole = plant.parameters.intervals().map(|known| [known.low.clone(), known.high.clone()]).collect();
        let period = plant.period.nominal().exact.clone()?;
        let along = (0..plant.parameters.intervals().count())
            .map(|place| {
                let parameter = PlantVariable::Parameter(place);
                [&entries, &sides].map(|outputs| {
                    let slopes = formulas.derivatives(outputs, parameter);
                    formulas.walk(&slopes)
                })
            })
            .collect();
        let mut linear = LinearPlant { states, lines: 0, slopes, origin: formulas.walk(&sides), along, period, whole };
        linear.lines =
            linear.member(&linear.enclosed(&linear.whole))?.waves.iter().map(|wave| wave.harmonics.len()).max()?;
        (linear.lines <= MAX_LINES).then_some(linear)
    }

    /// The number of states.
    #[must_use]
    pub fn states(&self) -> usize {
        self.states
    }

    /// K: no member has a harmonic of f(t,0,0) or q(t,0,0) beyond it.
    #[must_use]
    pub fn lines(&self) -> usize {
        self.lines
    }

    /// The box of the parameters.
    #[must_use]
    pub fn whole(&self) -> &[[Rational; 2]] {
        &self.whole
    }

    /// A box of parameters as enclosures.
    #[must_use]
    pub fn enclosed(&self, ends: &[[Rational; 2]]) -> Vec<Enclosure> {
        ends.iter().map(|[low, high]| Enclosure::between(low, high, PRECISION)).collect()
    }

    /// The coefficients of all members with parameters in these enclosures; `None` where one is not bounded.
    #[must_use]
    pub fn member(&self, parameters: &[Enclosure]) -> Option<Member> {
        self.evaluated([&self.slopes, &self.origin], parameters)
    }

    /// The members with parameters in a box, as they depend on these; `None` where a coefficient is not bounded.
    pub(super) fn family(&self, ends: &[[Rational; 2]]) -> Option<Family> {
        let all = self.enclosed(ends);
        let of_all = self.member(&all)?;
        let middles: Vec<Enclosure> = ends
            .iter()
            .map(|[low, high]| Enclosure::from_rational(&(Rational::from(low + high) / 2), PRECISION))
            .collect();
        let open: Vec<usize> = (0..ends.len()).filter(|side| ends[*side][0] != ends[*side][1]).collect();
        // Where a formula has no derivative there is nothing to be gained.
        let slopes =
            open.iter().map(|side| self.evaluated(self.along[*side].each_ref(), &all)).collect::<Option<Vec<_>>>();
        let found = slopes.zip(self.member(&middles)).filter(|_| !open.is_empty());
        Some(match found {
            None => Family::of_one(of_all),
            Some((slopes, middle)) => {
                let offsets = open.iter().map(|side| &all[*side] - &middles[*side]).collect();
                Family::new([middle, of_all], slopes, offsets)
            }
        })
    }

    fn evaluated(&self, [slopes, origin]: [&Walk; 2], parameters: &[Enclosure]) -> Option<Member> {
        let zero = Enclosure::zero(PRECISION);
        let x = vec![zero.clone(); self.states];
        let mut at = Enclosing { t: &zero, x: &x, e: &zero, p: parameters, precision: PRECISION };
        let slopes = slopes.evaluate(&mut at);
        let waves = origin.trigonometric_at_origin(parameters, &self.period, PRECISION).ok()?;
        let bounded = slopes.iter().chain(waves.iter().flat_map(|wave| wave.parts())).all(Enclosure::is_bounded);
        bounded.then(|| Member { rows: slopes.chunks(self.states + 1).map(<[Enclosure]>::to_vec).collect(), waves })
    }
}
