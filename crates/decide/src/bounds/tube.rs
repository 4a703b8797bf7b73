//! The two inequalities of the tube theorem (derivation, 14.4), decided with enclosures by subdivision.

use super::PRECISION;
use super::centred::negated;
use super::decide::{Decision, Values};
use super::definite::SymmetricValues;
use super::engine::Engine;
use super::joint::{fits, lies_between};
use super::metric_form::MetricForm;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::{Level, Metric};
use sigmastar_matrix::{is_positive_definite, is_symmetric};
use sigmastar_theory::evidence::Part;

/// What bounds the states by the error (14.4b).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StatesForm {
    /// Q by rows: symmetric, with a row for each state.
    pub matrix: Vec<Vec<Rational>>,
    /// `Q >= q_low I`.
    pub q_low: Rational,
    /// `Q <= q_up I`.
    pub q_up: Rational,
    /// c, in 1/time.
    pub c: Rational,
    /// gamma.
    pub gamma: Rational,
}

/// The form of a metric at sigma, and one end of the gain of the actuator.
fn form_of(metric: &Metric, sigma: &Rational, moved: &Rational) -> MetricForm {
    MetricForm {
        metric: metric.clone(),
        pulled: metric.cross.iter().map(|entry| Rational::from(entry * sigma)).collect(),
        of_e: Rational::from(&metric.weight * sigma) * 2,
        moved: moved.clone(),
    }
}

impl Engine {
    /// Decides (14.4a) at a gain for each of these metrics, with so many boxes for all of them at most.
    ///
    /// Guarantee: `True` only if at every t and every point of `|y| <= X`, `|e| <= E` around the orbit of the region, with the derivatives of f and q
    /// there in the coordinates y, the matrix (14.4a) of each metric is positive definite, its margins and k_p are positive, and it is
    /// strictly between what its level says, for every member and gain of the actuator. For the caller to prove: what [`Engine::decide`] leaves to him.
    #[must_use]
    pub fn decide_forms(
        &self,
        forms: &[(Metric, Level)],
        sigma: &Rational,
        [x, e]: [&Rational; 2],
        effort: usize,
    ) -> Decision {
        let fits = |(metric, level): &(Metric, Level)| fits(metric, self.states()) && lies_between(metric, level);
        if !forms.iter().all(fits) || *sigma <= 0 {
            return Decision::FALSE;
        }
        if *x < 0 || *e < 0 {
            return Decision::UNDECIDED;
        }
        let ends = self.moved_slopes(sigma);
        let of_ends =
            |(metric, _): &(Metric, Level)| ends.iter().map(|moved| form_of(metric, sigma, moved)).collect::<Vec<_>>();
        let forms: Vec<MetricForm> = forms.iter().flat_map(of_ends).collect();
        self.decide_all(&forms, (Part::All, [x, e]), effort, |values, form| form.matrix(values))
    }

    /// Decides (14.5a) at a gain for each of these metrics with its S, with so many boxes for each of the parts at most.
    ///
    /// Guarantee: `True` only if with J and r at every point of `|y| <= X`, `|e| <= eta` around the orbit of the region, and with g and d at every point of
    /// `|y| <= X`, `|e| <= E`, both matrices of each metric are positive definite, its margins and k_p are positive, p is 0, and it is strictly between
    /// what its level says, for every member and gain of the actuator. For the caller to prove: what [`Engine::decide`] leaves to him.
    #[must_use]
    pub fn decide_forms_x_first(
        &self,
        forms: &[(Metric, Level)],
        splittings: &[Vec<Vec<Rational>>],
        sigma: &Rational,
        ([x, e], eta): ([&Rational; 2], &Rational),
        effort: usize,
    ) -> Decision {
        let fits = |((metric, level), s): (&(Metric, Level), &Vec<Vec<Rational>>)| {
            let alone = metric.cross.iter().all(|entry| *entry == 0) && is_symmetric(s, self.states() + 1);
            fits(metric, self.states()) && lies_between(metric, level) && alone
        };
        if forms.len() != splittings.len() || !forms.iter().zip(splittings).all(fits) || *sigma <= 0 {
            return Decision::FALSE;
        }
        if *x < 0 || *eta < 0 || eta > e {
            return Decision::UNDECIDED;
        }
        let at = |moved: &Rational| {
            let metrics = forms.iter().map(|(metric, _)| form_of(metric, sigma, moved));
            metrics.zip(splittings).collect::<Vec<_>>()
        };
        // J and r do not have the gain.
        let own = at(&Rational::new());
        let first = self.decide_all(&own, (Part::States, [x, eta]), effort, |values, (form, s)| form.beyond(s, values));
        let ends: Vec<_> = self.moved_slopes(sigma).iter().flat_map(at).collect();
        first.and(|| self.decide_all(&ends, (Part::Error, [x, e]), effort, |values, (form, s)| form.beside(s, values)))
    }

    /// Decides (14.4b), with so many boxes at most; of a plant without states it says nothing, and is true.
    ///
    /// Guarantee: `True` only if `[[-(Q J + J'Q) - 2 c I, -Q g], [., gamma]]` is positive definite at every point of the region, and the numbers
    /// are positive, with `q_low I <= Q <= q_up I`.
    #[must_use]
    pub fn decide_states(&self, form: &StatesForm, [x, e]: [&Rational; 2], effort: usize) -> Decision {
        let StatesForm { matrix, q_low, q_up, c, gamma } = form;
        let n = self.states();
        if n == 0 {
            return Decision::TRUE;
        }
        if !is_symmetric(matrix, n) || [q_low, q_up, c, gamma].into_iter().any(|number| *number <= 0) {
            return Decision::FALSE;
        }
        let apart = |sign: i32, number: &Rational| -> Vec<Vec<Rational>> {
            let entry = |i: usize, j: usize| {
                let own = Rational::from(&matrix[i][j] * sign);
                if i == j { own - Rational::from(number * sign) } else { own }
            };
            (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
        };
        if !is_positive_definite(&apart(1, q_low)) || !is_positive_definite(&apart(-1, q_up)) {
            return Decision::FALSE;
        }
        let twice = Rational::from(c * 2u32);
        let form = |values: &Values<'_>| {
            let frame = values.frame;
            let all = values.in_y(Part::All)?;
            let mut entries = values.steady_decay(matrix, &all.jacobian, &twice);
            let driven = values.product(matrix, &all.column, false).concat();
            entries.extend(driven.iter().enumerate().map(|(i, value)| (i, n, negated(value))));
            entries.push((n, n, frame.constant(Enclosure::from_rational(gamma, PRECISION))));
            Some(SymmetricValues { order: n + 1, entries })
        };
        self.decide_part(Part::All, [x, e], effort, form)
    }
}
