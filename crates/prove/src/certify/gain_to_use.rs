//! Which gain to use where nothing is required of a loop: the smallest one is certified with the least effort, and its bounds of the transient are often far
//! larger than the initial set.

use super::gain_row::GainRow;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// |e| is to be at most so many times the larger of E0 and the steady error at all times, and the largest rate at most so many times a rate.
const TIMES: u32 = 2;

/// What is proved of the transient at a gain, for one number of oscillators or for every one.
#[derive(Clone, Copy, Debug)]
pub struct Transient<'a> {
    /// E0.
    pub start: &'a Rational,
    /// Of |e| along the periodic solution.
    pub steady: &'a Enclosure,
    /// Of |e| at all times.
    pub peak: &'a Enclosure,
    /// The rate, where one is proved.
    pub rate: Option<&'a Rational>,
}

/// Of gains in rising order, each with the transients of the same numbers of oscillators, which one to use: the first at which each peak is at most twice the
/// larger of E0 and the steady error, and each rate at least half of the largest for its number of oscillators; or the one that comes closest, and false.
/// `None` where there are no gains.
///
/// Guarantee: the rule is decided from the upper ends of the bounds, exactly; which gain comes closest is seen in doubles.
#[must_use]
pub fn gain_to_use(gains: &[Vec<Transient<'_>>]) -> Option<(usize, bool)> {
    let best = |index: usize| gains.iter().filter_map(|gain| gain.get(index)?.rate).max();
    let keeps_rule = |gain: &Vec<Transient<'_>>| {
        gain.iter().enumerate().all(|(index, Transient { start, steady, peak, rate })| {
            let is_fast = best(index).is_none_or(|best| rate.is_some_and(|rate| *best <= Rational::from(TIMES * rate)));
            let ends = steady.upper_rational().zip(peak.upper_rational());
            is_fast && ends.is_some_and(|(steady, peak)| peak <= TIMES * steady.max((*start).clone()))
        })
    };
    if let Some(index) = gains.iter().position(keeps_rule) {
        return Some((index, true));
    }
    let miss = |gain: &Vec<Transient<'_>>| {
        let of_one = |(index, Transient { start, steady, peak, rate }): (usize, &Transient<'_>)| {
            let slow = best(index).map_or(0.0, |best| best.to_f64() / rate.map_or(0.0, Rational::to_f64));
            slow.max(peak.upper_f64() / start.to_f64().max(steady.upper_f64()))
        };
        gain.iter().enumerate().map(of_one).fold(0.0, f64::max)
    };
    let misses: Vec<f64> = gains.iter().map(miss).collect();
    (0..misses.len()).reduce(|a, b| if misses[b] < misses[a] { b } else { a }).map(|index| (index, false))
}

impl GainRow {
    /// The row of the gain to use ([`gain_to_use`]), and whether it keeps to the rule; the rates are those that were asked about.
    #[must_use]
    pub fn to_use(rows: &[GainRow]) -> Option<(&GainRow, bool)> {
        fn transients(GainRow { e0, steady, peak, rates, .. }: &GainRow) -> Vec<Transient<'_>> {
            let with = |rate| Transient { start: e0, steady, peak, rate };
            let all: Vec<Transient<'_>> = rates.iter().map(|(_, rate)| with(rate.as_ref())).collect();
            if all.is_empty() { vec![with(None)] } else { all }
        }
        let gains: Vec<Vec<Transient<'_>>> = rows.iter().map(transients).collect();
        gain_to_use(&gains).map(|(index, keeps)| (&rows[index], keeps))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transient_and_the_rate_count() {
        let numbers: Vec<Rational> = (0..4).map(Rational::from).collect();
        let bounds: Vec<Enclosure> = [0.5, 1.5, 2.0, 2.1, 5.0].into_iter().map(Enclosure::exactly).collect();
        // A peak by its place, and rates for two numbers of oscillators.
        let gain = |peak: usize, rates: [Option<usize>; 2]| {
            let one = |rate: Option<usize>| Transient {
                start: &numbers[1],
                steady: &bounds[0],
                peak: &bounds[peak],
                rate: rate.map(|rate| &numbers[rate]),
            };
            rates.map(one).to_vec()
        };
        let to_use = |gains: &[Vec<Transient<'_>>]| gain_to_use(gains);
        let slow = [gain(4, [Some(1); 2]), gain(2, [Some(1); 2]), gain(1, [Some(2), Some(3)])];
        // The second rate of the second gain is below half of the best.
        assert_eq!(to_use(&slow), Some((2, true)));
        let fast = [gain(4, [Some(1); 2]), gain(2, [Some(1); 2]), gain(1, [Some(2); 2])];
        assert_eq!(to_use(&fast), Some((1, true)));
        // 2.1 is more than twice E0, and no gain keeps to it.
        assert_eq!(to_use(&[gain(4, [None; 2]), gain(3, [None; 2])]), Some((1, false)));
        assert_eq!(to_use(&[gain(2, [None; 2]), gain(1, [None; 2])]), Some((0, true)));
        // A rate that is not proved is none.
        assert_eq!(to_use(&[gain(2, [Some(1), None]), gain(2, [Some(1), Some(1)])]), Some((1, true)));
        // The steady error counts where it is larger than E0.
        let large = Transient { start: &numbers[0], steady: &bounds[1], peak: &bounds[3], rate: None };
        assert_eq!(to_use(&[vec![large]]), Some((0, true)));
        assert_eq!(to_use(&[]), None);
    }
}
