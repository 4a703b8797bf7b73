//! The defects of a trial (derivation, 14.4), of all members at once: by polynomials with a rest in the time and in what the members differ by.

use super::curves::Trial;
use crate::orbit::OrbitNotProved;
use crate::orbit::model::{Model, PRECISION, Space};
use crate::orbit::models::Models;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::parallel;
use sigmastar_lang::expr::{PlantVariable, Walk};
use sigmastar_lang::plant::{CurveTerm, Plant};
use sigmastar_lang::spec::{Interval, Wave};

/// The degree of the polynomials in the time and so many numbers of which intervals are known, from none on.
const DEGREES: [usize; 6] = [12, 9, 8, 6, 5, 4];

/// The parts of the period at first, at least, and for each harmonic (the last ones are small); and how often they are halved.
const FIRST_PARTS: usize = 16;
const PARTS: usize = 1;
const HALVINGS: u32 = 4;

/// A half of a part is halved again where its bound is below this share of that of the part.
const HELPFUL: f64 = 0.7;

/// How often the box is halved where the sizes of polynomials are bounded.
const BOX_HALVINGS: u32 = 8;

impl Trial {
    /// Upper bounds of `|f(t,xhat,ehat) - xhat'|` in the norm of `L^-1 x`, of `|q(t,xhat,ehat) + b uhat - ehat'|`, and of a trial without ehat of the
    /// derivative of that sum in t, over all t and members; kappa is not in the second. Parts of the period are halved while they are not at most `enough`.
    ///
    /// # Errors
    /// The formulas are not seen to be smooth along the trial, or there are too many intervals.
    pub fn defects(
        &self,
        plant: &Plant,
        inverse: &[Vec<Rational>],
        enough: [f64; 3],
    ) -> Result<[Enclosure; 3], OrbitNotProved> {
        let sides = self.intervals().count();
        let degree = DEGREES.get(sides).ok_or(OrbitNotProved::Shape("there are too many intervals"))?;
        let space = Space::new(1 + sides, *degree);
        let along = Along::new(self, plant, inverse, &space);
        let count = (PARTS * along.harmonics).next_power_of_two().max(FIRST_PARTS);
        let bounds = parallel::numbered(count, |part| {
            let place = [part, count];
            along.refined(place, along.once(place, enough), enough, HALVINGS)
        });
        let mut all = [(); 3].map(|()| Enclosure::zero(PRECISION));
        for (part, bound) in bounds.iter().enumerate() {
            if !bound.iter().all(Enclosure::is_bounded) {
                return Err(OrbitNotProved::NotSmooth { s: (part as f64 + 0.5) / count as f64, cause: None });
            }
            all = [0, 1, 2].map(|i| all[i].max(&bound[i]));
        }
        Ok(all)
    }
}

fn exact(value: &Rational) -> Enclosure {
    Enclosure::from_rational(value, PRECISION)
}

/// A wave in enclosures: its mean, (a_k, b_k) and their lengths.
struct Enclosed {
    mean: Enclosure,
    harmonics: Vec<([Enclosure; 2], Enclosure)>,
}

impl Enclosed {
    fn new(wave: &Wave) -> Enclosed {
        let harmonic = |pair: &[Rational; 2]| {
            let [a, b] = pair.each_ref().map(exact);
            let length = (a.sqr() + b.sqr()).sqrt();
            ([a, b], length)
        };
        Enclosed { mean: exact(&wave.mean), harmonics: wave.harmonics.iter().map(harmonic).collect() }
    }
}

/// The curves of a term, and the product of its powers.
struct Term {
    states: Vec<Enclosed>,
    error: Enclosed,
    control: Enclosed,
    powers: Model,
}

/// A part of the period: `s = middle + half x_0`, in periods.
struct Part {
    middle: Enclosure,
    half: Enclosure,
    /// For k = 1, 2, ... the coefficients of 1, x_0, x_0^2, ... in cos(2 pi k s) and sin(2 pi k s), one more than the degree; and what is left from the
    /// first power on that is above the degree.
    waves: Vec<[Vec<Enclosure>; 2]>,
    rests: Vec<Enclosure>,
}

impl Part {
    fn new([part, count]: [usize; 2], harmonics: usize, degree: usize) -> Part {
        let share = |a: usize, b: usize| exact(&Rational::from((a, b)));
        let [middle, half] = [share(2 * part + 1, 2 * count), share(1, 2 * count)];
        let turn = Enclosure::pi(PRECISION) * 2;
        let (mut waves, mut rests) = (Vec::new(), Vec::new());
        // By the addition theorem: a cosine costs as much as fifty products.
        let first = (&turn * &middle).cos_sin();
        let mut next = first.clone();
        for k in 1..=harmonics as i64 {
            let [cos, sin] = next;
            next = [&cos * &first[0] - &sin * &first[1], &sin * &first[0] + &cos * &first[1]];
            let reach = &turn * &half * k;
            let mut factor = Enclosure::one(PRECISION);
            let mut pair = [Vec::new(), Vec::new()];
            for j in 0..=degree + 1 {
                if j == degree + 1 {
                    rests.push(factor.clone());
                }
                // The derivative of cos is -sin, that of sin is cos.
                let [of_cos, of_sin] = match j % 4 {
                    0 => [cos.clone(), sin.clone()],
                    1 => [sin.negate(), cos.clone()],
                    2 => [cos.negate(), sin.negate()],
                    _ => [sin.clone(), cos.negate()],
                };
                pair[0].push(of_cos * &factor);
                pair[1].push(of_sin * &factor);
                factor = factor * &reach / (j as i64 + 1);
            }
            waves.push(pair);
        }
        Part { middle, half, waves, rests }
    }
}

/// What is evaluated along the curves of all members.
struct Along<'a> {
    trial: &'a Trial,
    space: &'a Space,
    inverse: Vec<Vec<Enclosure>>,
    /// f and q, and of a trial for every larger number q_t and q_x.
    formulas: Walk,
    period: Enclosure,
    /// delta_i.
    deviations: Vec<Model>,
    terms: Vec<Term>,
    harmonics: usize,
}

impl<'a> Along<'a> {
    fn new(trial: &'a Trial, plant: &Plant, inverse: &[Vec<Rational>], space: &'a Space) -> Along<'a> {
        let (mut formulas, mut outputs) = plant.formulas();
        if trial.or_more {
            let q = outputs[plant.states()..].to_vec();
            outputs.extend(plant.derivatives_in_time(&mut formulas, &q));
            for state in 0..plant.states() {
                outputs.extend(formulas.derivatives(&q, PlantVariable::State(state)));
            }
        }
        let deviation = |(i, interval): (usize, &Interval)| {
            let [low, high] = interval.deviations();
            space.variable(1 + i, exact(&Rational::from(&low + &high)) / 2, exact(&(high - low)) / 2)
        };
        let deviations: Vec<Model> = trial.intervals().enumerate().map(deviation).collect();
        let one = || space.constant(Enclosure::one(PRECISION));
        let product = |term: &CurveTerm| {
            term.powers.iter().zip(&deviations).fold(one(), |product, (power, deviation)| {
                (0..*power).fold(product, |product, _| space.product(&product, deviation))
            })
        };
        let term = |term: &CurveTerm| Term {
            states: (0..plant.states()).map(|i| Enclosed::new(&term.state(i))).collect(),
            error: Enclosed::new(&term.error),
            control: Enclosed::new(&term.control),
            powers: product(term),
        };
        let degree_of = |CurveTerm { states, error, control, .. }: &CurveTerm| {
            states.harmonics.len().max(error.harmonics.len()).max(control.harmonics.len())
        };
        Along {
            inverse: inverse.iter().map(|row| row.iter().map(exact).collect()).collect(),
            formulas: formulas.walk(&outputs),
            period: plant.period.nominal().enclose(PRECISION),
            terms: trial.terms.iter().map(term).collect(),
            harmonics: trial.terms.iter().map(degree_of).max().unwrap_or(0),
            deviations,
            trial,
            space,
        }
    }

    /// A curve and its derivative in time on a part of the period.
    fn curve(&self, part: &Part, of: impl Fn(&Term) -> &Enclosed) -> [Model; 2] {
        let Along { space, period, .. } = self;
        let degree = space.degree();
        let zero = || Enclosure::zero(PRECISION);
        let nothing = || space.constant(zero());
        let speed = (&part.half * period).recip();
        let frequency = Enclosure::pi(PRECISION) * 2 / period;
        self.terms.iter().fold([nothing(), nothing()], |[value, slope], term| {
            let wave = of(term);
            let mut values = vec![zero(); degree + 2];
            values[0] = wave.mean.clone();
            let [mut rest, mut rest_of_slope] = [zero(), zero()];
            let harmonics = wave.harmonics.iter().zip(&part.waves).zip(&part.rests);
            for (k, ((([a, b], length), [cos, sin]), left)) in (1_i64..).zip(harmonics) {
                for ((value, cos), sin) in values.iter_mut().zip(cos).zip(sin) {
                    *value = &*value + a * cos + b * sin;
                }
                // The rest of the derivative is one of the same order.
                let left = length * left;
                rest_of_slope = rest_of_slope + &left * &frequency * k;
                rest = rest + left;
            }
            let slopes = values.iter().zip(0_i64..).skip(1).map(|(value, j)| value * j * &speed).collect::<Vec<_>>();
            let add = |sum: &Model, own: Model| space.sum(sum, &space.product(&own, &term.powers));
            let value = add(&value, space.in_time(&values[..=degree], rest));
            [value, add(&slope, space.in_time(&slopes, rest_of_slope))]
        })
    }

    /// The bounds on part `part` of `count` of the period from those that are `found` there: on halves of it while that helps, up to so many times.
    fn refined(
        &self,
        [part, count]: [usize; 2],
        found: [Enclosure; 3],
        enough: [f64; 3],
        halvings: u32,
    ) -> [Enclosure; 3] {
        let is_wrong = |bound: &[Enclosure; 3], i: usize| !bound[i].is_bounded() || bound[i].upper_f64() > enough[i];
        if halvings == 0 || !(0..3).any(|i| is_wrong(&found, i)) {
            return found;
        }
        let halves = [0, 1].map(|half| [2 * part + half, 2 * count]);
        let of_halves = halves.map(|half| self.once(half, enough));
        // What is left of the largest value is there on halves of any length.
        let helps = |of_half: &[Enclosure; 3], i: usize| {
            is_wrong(of_half, i) && of_half[i].upper_f64() <= HELPFUL * found[i].upper_f64()
        };
        let [first, second] = [0, 1].map(|which| {
            let of_half = of_halves[which].clone();
            let goes_on = (0..3).any(|i| helps(&of_half, i) || !found[i].is_bounded() || !of_half[i].is_bounded());
            self.refined(halves[which], of_half, enough, if goes_on { halvings - 1 } else { 0 })
        });
        let both: [Enclosure; 3] = [0, 1, 2].map(|i| first[i].max(&second[i]));
        // What is not seen to be smooth on the whole may be on both halves.
        let better = |i: usize| if found[i].is_bounded() { both[i].min(&found[i]) } else { both[i].clone() };
        [0, 1, 2].map(better)
    }

    /// Those of all of a part.
    fn once(&self, place: [usize; 2], enough: [f64; 3]) -> [Enclosure; 3] {
        let part = &Part::new(place, self.harmonics, self.space.degree());
        let Along { trial, space, inverse, formulas, period, deviations, .. } = self;
        let n = inverse.len();
        let zero = || Enclosure::zero(PRECISION);
        let nothing = || space.constant(zero());
        let states: Vec<[Model; 2]> = (0..n).map(|i| self.curve(part, |term| &term.states[i])).collect();
        let [error, error_slope] = self.curve(part, |term| &term.error);
        let [control, control_slope] = self.curve(part, |term| &term.control);
        let parameter = |(interval, deviation): (&Interval, &Model)| {
            space.sum(&space.constant(exact(&interval.nominal)), deviation)
        };
        let mut algebra = Models {
            space,
            time: space.variable(0, period * &part.middle, period * &part.half),
            states: states.iter().map(|[value, _]| value.clone()).collect(),
            error,
            parameters: trial.parameters.iter().zip(deviations).map(parameter).collect(),
        };
        let outputs = formulas.evaluate(&mut algebra);
        let minus = |a: &Model, b: &Model| space.sum(a, &space.scaled(b, &Enclosure::from_integer(-1, PRECISION)));
        // b = 1 + (b - 1).
        let with_gain = |own: &Model| match (&trial.gain, deviations.last()) {
            (Some(_), Some(deviation)) => space.sum(own, &space.product(own, deviation)),
            _ => own.clone(),
        };
        let apart: Vec<Model> = outputs.iter().zip(&states).map(|(f, [_, slope])| minus(f, slope)).collect();
        let component = |row: &Vec<Enclosure>| {
            let sum = row.iter().zip(&apart).fold(nothing(), |sum, (l, x)| space.sum(&sum, &space.scaled(x, l)));
            space.largest(&sum, enough[0], BOX_HALVINGS)
        };
        let of_states = inverse.iter().map(|row| component(row).sqr()).fold(zero(), |sum, square| sum + square).sqrt();
        let of_error = minus(&space.sum(&outputs[n], &with_gain(&control)), &error_slope);
        let in_time = outputs.get(n + 1).map_or_else(zero, |q_t| {
            let own = space.sum(q_t, &with_gain(&control_slope));
            let along = states.iter().zip(outputs.iter().skip(n + 2));
            let all = along.fold(own, |sum, ([_, slope], q_x)| space.sum(&sum, &space.product(q_x, slope)));
            space.largest(&all, enough[2], BOX_HALVINGS)
        });
        [of_states, space.largest(&of_error, enough[1], BOX_HALVINGS), in_time]
    }
}
