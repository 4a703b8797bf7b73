//! What is proved on a box around a trial (derivation, 14.4, 14.5).

use super::Forms;
use super::around::{Around, Prepared, SHORT, up};
use super::boxes::Fit;
use crate::attempt::prove_value;
use rug::Rational;
use sigmastar_decide::bounds::{Decision, StatesForm};
use sigmastar_decide::linear::PRECISION;
use sigmastar_decide::trial::{Concluded, OrMore, Peaks, TubeProof, XFirst};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64, round_rational};
use sigmastar_lang::spec::{Bound, Level, Metric};
use sigmastar_propose::bounds::{FallingForm, FloatSuprema};
use std::ops::Range;

/// Digits of the numbers of a form.
pub(super) const DIGITS: u32 = 9;

/// How much of the margins of a form is claimed.
const KEPT: f64 = 0.5;

/// How far a metric is from what a level says of it.
pub(super) const ROOM: f64 = 1e-5;

/// Boxes of the proof of a form; of a family, where each of them costs the check more.
const EFFORT: usize = 20_000;
const EFFORT_OF_FAMILY: usize = 4_000;

/// The share of the distance of e that eta is.
const SMALL_ETA: f64 = 1e-4;

/// The radii of a box in short numbers.
pub(super) fn short(radii: [f64; 2]) -> Option<[Rational; 2]> {
    let [x, e] = radii.map(|radius| round_f64(radius, DIGITS, Direction::Down));
    Some([x?, e?])
}

impl Around<'_> {
    /// The peaks by forms on a box, if solutions from the set do not leave it.
    pub(super) fn peaks(
        &self,
        prepared: &Prepared,
        concluded: &Concluded,
        (radii, forms): (&[Rational; 2], &[(Metric, Level)]),
    ) -> Option<Peaks> {
        let has_states = self.asked.plant.states() > 0;
        let peaks = Peaks::of((forms, has_states), concluded, &prepared.own, &prepared.start)?;
        let is_inside = |reach: &[Enclosure; 2]| {
            let mut ends = reach.iter().zip(radii).zip([has_states, true]);
            ends.all(|((reach, end), asked)| !asked || reach.lt(&Enclosure::from_rational(end, PRECISION)).is_true())
        };
        peaks.reach.iter().any(is_inside).then_some(peaks)
    }

    /// What falls along x first on a box that solutions from the set do not leave; `other`: that of another number of oscillators.
    pub(super) fn along_x_first(
        &self,
        prepared: &Prepared,
        concluded: &Concluded,
        other: Option<&XFirst>,
    ) -> Option<(XFirst, Peaks)> {
        let eta = round_f64(SMALL_ETA * prepared.distances[1], SHORT, Direction::Up)?;
        if !concluded.distances[1].le(&Enclosure::from_rational(&eta, PRECISION)).is_true() {
            return None;
        }
        let of_other = || self.decided_x_first(prepared, concluded, XFirst { eta: eta.clone(), ..other?.clone() });
        let found = |margin: f64| {
            let near = other.map(|other| &other.radii);
            let Fit { radii, forms, .. } = self.peak_box(prepared, margin, (Some(eta.to_f64()), near))?;
            let splitting = |form: &FallingForm| form.splitting.as_ref()?.iter().map(|row| short_row(row)).collect();
            let splittings = forms.iter().map(splitting).collect::<Option<_>>()?;
            let forms = forms.iter().map(rounded).collect::<Option<_>>()?;
            let x_first = XFirst { radii: short(radii)?, eta: eta.clone(), forms, splittings };
            self.decided_x_first(prepared, concluded, x_first)
        };
        of_other().or_else(|| self.margins().into_iter().find_map(found))
    }

    /// What is proved of it: at least the first form.
    fn decided_x_first(
        &self,
        prepared: &Prepared,
        concluded: &Concluded,
        mut x_first: XFirst,
    ) -> Option<(XFirst, Peaks)> {
        let Prepared { engine, .. } = prepared;
        let [x, e] = x_first.radii.each_ref();
        self.in_domain(prepared, [x, e])?;
        engine.smooth(x, e).ok()?;
        // To decide forms costs most: none is decided from which no peak would follow.
        self.peaks(prepared, concluded, (&x_first.radii, &x_first.forms))?;
        // The box was fitted to the first.
        let holding = holding(x_first.forms.len(), |those| {
            let place = ([x, e], &x_first.eta);
            let (forms, splittings) = (&x_first.forms[those.clone()], &x_first.splittings[those]);
            engine.decide_forms_x_first(forms, splittings, self.asked.sigma, place, self.effort())
        })?;
        x_first.forms = kept(x_first.forms, &holding);
        x_first.splittings = kept(x_first.splittings, &holding);
        let peaks = self.peaks(prepared, concluded, (&x_first.radii, &x_first.forms))?;
        Some((x_first, peaks))
    }

    /// What is proved around a trial if forms fall on a box, with everything but that proved.
    pub(super) fn promised(
        &self,
        prepared: &Prepared,
        [x, e]: [Rational; 2],
        (forms, within): Forms,
    ) -> Option<Promised> {
        let Prepared { engine, samples, .. } = prepared;
        let has_states = self.asked.plant.states() > 0;
        self.in_domain(prepared, [&x, &e])?;
        engine.smooth(&x, &e).ok()?;
        let first = forms.first()?;
        let slope = |bound| prove_value(engine, samples, bound, &x, &e).map(|proved| proved.value);
        let of_states = |bound| if has_states { slope(bound) } else { Some(Rational::new()) };
        let slopes = [of_states(Bound::Qx)?, slope(Bound::Qe)?];
        let [d_x, d_q, d_t] = prepared.defects.clone();
        let or_more = match self.or_more && within.is_empty() {
            false => None,
            true => Some(OrMore {
                defect_t: d_t,
                in_time: [roomy(of_states(Bound::Qtx)?, &slopes[0]), roomy(slope(Bound::Qte)?, &slopes[1])],
                states: [of_states(Bound::Fx)?, of_states(Bound::Fe)?],
            }),
        };
        let states = match has_states {
            false => None,
            true => {
                let form = self.states_form(samples, first, [&x, &e])?;
                engine.decide_states(&form, [&x, &e], self.effort()).truth.is_true().then_some(())?;
                Some(form)
            }
        };
        let proof =
            TubeProof { defects: [d_x, d_q], radii: [x, e], slopes, forms, states, or_more, x_first: None, within };
        Some(Promised(proof))
    }

    /// The proof, with the forms that are decided: at least the first.
    pub(super) fn decided(&self, prepared: &Prepared, Promised(promised): Promised) -> Option<TubeProof> {
        let TubeProof { radii: [x, e], forms, within, .. } = &promised;
        // The first is that of Theorem T.
        let holding = holding(forms.len(), |those| match self.asked.law() {
            Some(law) => {
                let (forms, within) = (&forms[those.clone()], &within[those]);
                prepared.engine.decide_held_forms(forms, within, law, [x, e], self.effort())
            }
            None => prepared.engine.decide_forms(&forms[those], self.asked.sigma, [x, e], self.effort()),
        })?;
        let within = kept(promised.within, &holding);
        Some(TubeProof { forms: kept(promised.forms, &holding), within, ..promised })
    }

    fn effort(&self) -> usize {
        if self.is_family() { EFFORT_OF_FAMILY } else { EFFORT }
    }

    /// That the box lies where the model holds.
    fn in_domain(&self, prepared: &Prepared, [x, e]: [&Rational; 2]) -> Option<()> {
        let Some(domain) = &self.asked.spec.domain else { return Some(()) };
        let [of_x, of_e, _] = Concluded::sizes_of(&prepared.trial, &self.known(prepared))?;
        let reach = [(of_x, x, &domain.x), (of_e, e, &domain.e)];
        let within = |(size, radius, end): &(Enclosure, &Rational, &sigmastar_lang::spec::Constant)| {
            (size + Enclosure::from_rational(radius, PRECISION)).le(&end.enclose(PRECISION)).is_true()
        };
        reach.iter().all(within).then_some(())
    }

    /// (14.4b) with the P of a form.
    fn states_form(
        &self,
        samples: &FloatSuprema,
        (metric, level): &(Metric, Level),
        [x, e]: [&Rational; 2],
    ) -> Option<StatesForm> {
        let pushed = samples.refined(Bound::Fe, x.to_f64(), e.to_f64()).value;
        if self.asked.law().is_some() {
            return self.held_states_form(samples, &metric.matrix, ([x, e], pushed));
        }
        let c_x = metric.c_x.to_f64();
        let p_up = level.p_up.to_f64();
        // |P g|^2 <= gamma (c_x - 2 c).
        let gamma = 2.2 * (p_up * pushed) * (p_up * pushed) / c_x;
        Some(StatesForm {
            matrix: metric.matrix.clone(),
            q_low: level.x_low.clone(),
            q_up: level.p_up.clone(),
            c: round_rational(&Rational::from(&metric.c_x / 4u32), DIGITS, Direction::Down),
            gamma: up(gamma, SHORT)?,
        })
    }
}

/// A proof whose forms are not decided yet.
pub(super) struct Promised(TubeProof);

impl Promised {
    /// What would be proved.
    pub(super) fn if_decided(&self) -> &TubeProof {
        &self.0
    }
}

/// Which of so many forms hold, by what decides all of some at once; `None` where the first does not.
fn holding(count: usize, decide: impl Fn(Range<usize>) -> Decision) -> Option<Vec<bool>> {
    let holds = |those: Range<usize>| decide(those).truth.is_true();
    if count == 0 || holds(0..count) {
        return (count > 0).then(|| vec![true; count]);
    }
    if count == 1 || !holds(0..1) {
        return None;
    }
    let others = (1..count).map(|one| holds(one..one + 1));
    Some(std::iter::once(true).chain(others).collect())
}

/// Those that hold.
fn kept<T>(all: Vec<T>, holding: &[bool]) -> Vec<T> {
    all.into_iter().zip(holding).filter(|(_, holds)| **holds).map(|(one, _)| one).collect()
}

/// With room for a velocity of the states that is known to d_x alone, also where the value is 0; what follows hardly depends on it.
fn roomy(value: Rational, slope: &Rational) -> Rational {
    let more = Rational::from(slope / 1_000_000);
    round_rational(&(value * Rational::from((51, 50)) + more), DIGITS, Direction::Up)
}

/// A row of a matrix in short numbers.
pub(super) fn short_row(row: &[f64]) -> Option<Vec<Rational>> {
    row.iter().map(|entry| round_f64(*entry, DIGITS, Direction::Nearest)).collect()
}

/// A form in short numbers.
pub(super) fn rounded(form: &FallingForm) -> Option<(Metric, Level)> {
    let FallingForm { matrix, cross, weight, k_p, p_up, x_low, e_low, margins, .. } = form;
    let short = |value: f64| round_f64(value, DIGITS, Direction::Nearest);
    let [c_x, c_e, c_y] = margins.map(|margin| round_f64(KEPT * margin, SHORT, Direction::Down));
    let has_states = !matrix.is_empty();
    let metric = Metric {
        matrix: matrix.iter().map(|row| short_row(row)).collect::<Option<_>>()?,
        cross: short_row(cross)?,
        weight: short(*weight)?,
        k_p: short(*k_p)?,
        c_x: if has_states { c_x? } else { Rational::from(1) },
        c_e: c_e?,
        c_y: c_y?,
    };
    let level = Level {
        p_up: round_f64(if has_states { p_up * (1.0 + ROOM) } else { 1.0 }, DIGITS, Direction::Up)?,
        x_low: round_f64(x_low * (1.0 - ROOM), DIGITS, Direction::Down)?,
        e_low: round_f64(e_low * (1.0 - ROOM), DIGITS, Direction::Down)?,
    };
    Some((metric, level))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_exact::enclosure::Truth;

    /// The forms that are kept of some with these answers, which are asked about alone and together.
    fn kept_of(answers: &[Truth]) -> Option<Vec<usize>> {
        let decide = |those: Range<usize>| {
            let truth = answers[those].iter().fold(Truth::True, |all, one| all.and(*one));
            Decision { truth, boxes: 1 }
        };
        holding(answers.len(), decide).map(|holding| kept((0..answers.len()).collect(), &holding))
    }

    /// Only what is certainly so is kept, and nothing without the first form, on which Theorem T rests.
    #[test]
    fn forms_that_are_not_decided_are_left_out() {
        use Truth::{False, True, Undecided};
        for other in [False, Undecided] {
            for (answers, expected) in [
                (vec![], None),
                (vec![True], Some(vec![0])),
                (vec![other], None),
                (vec![other, True], None),
                (vec![True, other], Some(vec![0])),
                (vec![True, other, True], Some(vec![0, 2])),
                (vec![True, True, True], Some(vec![0, 1, 2])),
            ] {
                assert_eq!(kept_of(&answers), expected, "{answers:?}");
            }
        }
    }
}
