//! Implicit steps with control of their length, for loops in which stability limits explicit ones.
//!
//! The lengths are the span divided by powers of 2, so that times carry no rounding and the weights of a length are computed
//! once. Each step is made as a whole and as two halves: the difference is the estimate of its error, the halves count.

use super::collocation::{Collocation, Table};
use super::integration::{IntegrationFailure, Span, Tolerance, is_bounded};
use super::radau::NODES;
use super::{ClosedLoop, Disturbance};
use std::collections::BTreeMap;

/// The shortest step is the span divided by 2 to this power.
const FINEST: u32 = 48;

/// The longest one, as a share of the period: nothing periodic is missed.
const LONGEST: f64 = 0.125;

/// A step whose error is this small beside the tolerance is followed by one of twice its length, if it ends where such a
/// step may begin. The order would allow more; the error of the interpolation between nodes grows with the power 8.
const EASY: f64 = 1e-3;

/// Two integrations agree on a component of size s where they differ by no more than this many relative tolerances of s.
const AGREEMENT: f64 = 1e3;

/// No agreement is asked for below this share of the natural size of a component, which is rounding.
const ROUNDING: f64 = 1e-12;

/// What rounding leaves of a step, beside the largest component.
const STEP_ROUNDING: f64 = 1e-15;

/// Integrates over a span like [`super::adaptive`], twice: what is returned is of the tighter tolerance, and both agree on it.
///
/// # Errors
/// [`IntegrationFailure`]; [`IntegrationFailure::Stiff`] where the two do not agree.
pub(super) fn implicit(
    closed_loop: &ClosedLoop,
    span: Span,
    y: &[f64],
    tolerance: Tolerance,
) -> Result<Vec<Vec<f64>>, IntegrationFailure> {
    let tolerance = tolerance.for_implicit();
    let mut steps = Steps::new(closed_loop, span);
    let states = steps.integrate(y, tolerance)?;
    let others = steps.integrate(y, tolerance.tighter())?;
    match disagreement(closed_loop, &states, &others, tolerance) {
        None => Ok(others),
        Some(difference) => Err(IntegrationFailure::Stiff { t: span.end(), difference }),
    }
}

/// The largest difference of two solutions, relative to a component in which they do not agree; `None` where they do in
/// all.
fn disagreement(
    closed_loop: &ClosedLoop,
    states: &[Vec<f64>],
    others: &[Vec<f64>],
    tolerance: Tolerance,
) -> Option<f64> {
    let sizes = closed_loop.natural_sizes();
    let relative = |(i, natural): (usize, &f64)| {
        let size = states.iter().chain(others).fold(0.0_f64, |size, y| size.max(y[i].abs()));
        // What is undefined agrees with nothing.
        let apart = |a: f64, b: f64| if (a - b).is_nan() { f64::INFINITY } else { (a - b).abs() };
        let most = states.iter().zip(others).fold(0.0_f64, |most, (a, b)| most.max(apart(a[i], b[i])));
        let share = most / size.max(natural * ROUNDING / (AGREEMENT * tolerance.relative));
        (share > AGREEMENT * tolerance.relative).then_some(share)
    };
    sizes.iter().enumerate().filter_map(relative).max_by(f64::total_cmp)
}

/// The lengths that were used in a span.
struct Steps<'l> {
    collocation: Collocation<'l>,
    span: Span,
    sizes: Vec<f64>,
    /// The level of the longest steps.
    coarsest: u32,
    tables: BTreeMap<u32, Table>,
}

/// A step that was made.
struct Made {
    t: f64,
    stages: Vec<f64>,
    end: Vec<f64>,
}

impl<'l> Steps<'l> {
    fn new(closed_loop: &'l ClosedLoop, span: Span) -> Steps<'l> {
        let longest = Table::longest(closed_loop).min(LONGEST * closed_loop.period);
        let halvings = libm::ceil(libm::log2(span.length() / longest)).clamp(0.0, f64::from(FINEST));
        Steps {
            collocation: Collocation::new(closed_loop),
            span,
            sizes: closed_loop.natural_sizes(),
            coarsest: halvings as u32,
            tables: BTreeMap::new(),
        }
    }

    /// The time at which `place` finest steps are over.
    fn time(&self, place: u64) -> f64 {
        self.span.t + self.span.length() * (place as f64 / (1_u64 << FINEST) as f64)
    }

    /// One step of the length `level` from a place.
    fn make(&mut self, level: u32, place: u64, y: &[f64]) -> Result<Option<Made>, IntegrationFailure> {
        let t = self.time(place);
        let closed_loop = self.collocation.closed_loop;
        closed_loop.pay(t, closed_loop.implicit_step_cost(0))?;
        let h = self.span.length() / (1_u64 << level) as f64;
        let table = self.tables.entry(level).or_insert_with(|| Table::new(closed_loop, h));
        let Some(stages) = self.collocation.stages(table, t, y) else { return Ok(None) };
        let end = self.collocation.end(table, y, &stages);
        if [y, &end].into_iter().any(|y| closed_loop.saturates(y, Disturbance::default())) {
            return Err(IntegrationFailure::Saturated { t });
        }
        Ok(Some(Made { t, stages, end }))
    }

    /// The error of a step beside its halves, as a share of the tolerance: at the end, and between the nodes, where samples
    /// are taken.
    fn error(&self, y: &[f64], whole: &Made, halves: [&Made; 2], tolerance: Tolerance) -> f64 {
        let n = self.collocation.closed_loop.states() + 1;
        let scaled = y.iter().chain(&halves[1].end).zip(self.sizes.iter().cycle());
        let largest = scaled.fold(0.0_f64, |largest, (value, size)| largest.max(value.abs() / size));
        let absolute = tolerance.absolute + STEP_ROUNDING * largest;
        let mut most = 0.0_f64;
        let mut compare = |component: usize, a: f64, b: f64| {
            let size = if component < n {
                let values = whole.stages.iter().skip(component).step_by(n);
                values.fold(y[component].abs().min(b.abs()), |size, value| size.max(value.abs()))
            } else {
                y[component].abs().max(b.abs())
            };
            let allowed = tolerance.relative * size + absolute * self.sizes[component];
            let share = (a - b).abs() / allowed;
            // What is undefined is no small error.
            most = if share.is_nan() { f64::INFINITY } else { most.max(share) };
        };
        let end = &halves[1].end;
        whole.end.iter().zip(end).enumerate().for_each(|(component, (a, b))| compare(component, *a, *b));
        for (half, made) in halves.iter().enumerate() {
            for (node, stage) in NODES.iter().zip(made.stages.chunks_exact(n)) {
                let place = 0.5 * (half as f64 + node);
                let between = self.collocation.between(place, y, &whole.stages);
                between.iter().zip(stage).enumerate().for_each(|(component, (a, b))| compare(component, *a, *b));
            }
        }
        most
    }

    /// The states at the units of the span, the first and the last included.
    fn integrate(&mut self, y: &[f64], tolerance: Tolerance) -> Result<Vec<Vec<f64>>, IntegrationFailure> {
        let end = 1_u64 << FINEST;
        let (mut place, mut level) = (0_u64, self.coarsest + 4);
        let mut y = y.to_vec();
        let mut states = vec![y.clone()];
        while place < end {
            let escaped = IntegrationFailure::Escaped { t: self.time(place) };
            if level + 1 > FINEST {
                return Err(escaped);
            }
            let half = 1_u64 << (FINEST - level - 1);
            let whole = self.make(level, place, &y)?;
            let first = match &whole {
                Some(_) => self.make(level + 1, place, &y)?,
                None => None,
            };
            let second = match &first {
                Some(first) => self.make(level + 1, place + half, &first.end.clone())?,
                None => None,
            };
            let (Some(whole), Some(first), Some(second)) = (whole, first, second) else {
                level += 1;
                continue;
            };
            let error = self.error(&y, &whole, [&first, &second], tolerance);
            if error > 1.0 {
                level += 1;
                continue;
            }
            for (at, (made, start)) in [(&first, &y), (&second, &first.end)].into_iter().enumerate() {
                self.sample(level + 1, made, start, at == 1 && place + 2 * half == end, &mut states);
            }
            y = second.end;
            if !is_bounded(&y) {
                return Err(escaped);
            }
            place += 2 * half;
            if error < EASY && level > self.coarsest && place.is_multiple_of(4 * half) {
                level -= 1;
            }
        }
        Ok(states)
    }

    /// Appends the units of the span within a step.
    fn sample(&self, level: u32, made: &Made, start: &[f64], last: bool, states: &mut Vec<Vec<f64>>) {
        let Some(table) = self.tables.get(&level) else { return };
        loop {
            let t = self.span.t + self.span.unit * states.len() as f64;
            let place = (t - made.t) / table.h;
            if states.len() > self.span.units || (place > 1.0 - 1e-12 && !last) {
                // What is at the end of a step is the start of the next.
                if states.len() <= self.span.units && place <= 1.0 + 1e-12 {
                    states.push(made.end.clone());
                }
                return;
            }
            let end = states.len() == self.span.units;
            states.push(if end {
                made.end.clone()
            } else {
                let row = table.row(self.collocation.closed_loop, place);
                self.collocation.sample(&row, place, start, &made.stages)
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::plant::Plant;
    use sigmastar_regulator::Regulator;

    fn closed_loop(sigma: f64) -> ClosedLoop {
        let text = include_str!("../../../../specs/plants/paper-example.json");
        let plant = Plant::from_json("paper-example", text).unwrap();
        ClosedLoop::new(&plant, Regulator::new(sigma, 1.0, std::f64::consts::TAU, vec![2.0, 1.0]))
    }

    /// Each component is held to its own size: e to that of the last samples, however small.
    #[test]
    fn another_solution_is_told() {
        let closed_loop = closed_loop(1e6);
        let y = |e: f64| vec![vec![1.0, -2.0, e, 0.5, 0.1, 0.2]];
        let differ = |a: f64, b: f64| disagreement(&closed_loop, &y(a), &y(b), Tolerance::ORDINARY);
        assert_eq!(differ(1e-6, 1e-6 * (1.0 + 5e-7)), None);
        let found = differ(1e-6, 1e-6 * (1.0 + 2e-6)).unwrap();
        assert!((found - 2e-6).abs() < 1e-9, "{found}");
        assert_eq!(differ(1e-19, 2e-19), None);
        assert!(differ(1e-6, f64::NAN).is_some());
    }

    #[test]
    fn the_first_and_the_last_sample_are_the_ends() {
        let closed_loop = closed_loop(1e4);
        let start = closed_loop.start(&[1.0, -2.0], 4.0);
        let run = |units: usize| {
            let span = Span { t: 0.25, unit: 0.5 / units as f64, units };
            implicit(&closed_loop, span, &start, Tolerance::ORDINARY).unwrap()
        };
        let (one, many) = (run(1), run(300));
        assert_eq!((one.len(), many.len()), (2, 301));
        assert_eq!((&one[0], &many[0], &one[1]), (&start, &start, &many[300]));
        // Samples between are those of a shorter span.
        let span = Span { t: 0.25, unit: 0.5 / 3.0, units: 1 };
        let exact = implicit(&closed_loop, span, &start, Tolerance::ORDINARY).unwrap();
        for (a, b) in exact[1].iter().zip(&many[100]) {
            assert!((a - b).abs() < 1e-9 * (1e-4 + a.abs()), "{a} {b}");
        }
    }
}
