//! Values of numbers that are free, as `mu`, with each of which a design table is made; and which of them is best.

use super::choice::Choice;
use super::requirements::distance;
use super::row::{Cell, Row};
use crate::tune::Parameter;
use rug::Rational;
use sigmastar_exact::number::{Direction, Portable, round_f64, write_exact};
use sigmastar_lang::spec::{Oscillators, Period};

/// So many values of each number are tried beside its own.
const TRIED: u32 = 4;

/// Digits of a value that is tried.
const DIGITS: u32 = 2;

/// What the pair to take of a table comes to, as far as tables with other values are held against it.
#[derive(Clone, Debug, PartialEq)]
pub struct Merit {
    /// The gain.
    pub sigma: Rational,
    /// The oscillators; none where nothing is required.
    pub oscillators: Option<Oscillators>,
    /// Of how many requirements it is not proved that they are met.
    pub missed: usize,
    /// The rate that is proved with these oscillators; where nothing is required, the least of those of the table.
    pub rate: Option<Rational>,
    /// How far it is from the requirements.
    distance: (usize, f64),
}

impl Merit {
    /// Of the pair of a table that is chosen.
    #[must_use]
    pub fn of(rows: &[Row], choice: &Choice) -> Merit {
        let row = &rows[choice.row];
        let rate = |cell: &Cell| cell.decay.as_ref().map(|decay| decay.rate.clone());
        let missed = choice.compared.iter().filter(|one| !one.is_met()).count();
        Merit {
            sigma: row.sigma.clone(),
            oscillators: choice.cell.map(|cell| row.cells[cell].oscillators.clone()),
            missed,
            rate: match choice.cell {
                Some(cell) => rate(&row.cells[cell]),
                // None is less than all that are proved.
                None => row.cells.iter().map(rate).min().flatten(),
            },
            distance: if missed == 0 { (0, 0.0) } else { distance(&choice.compared) },
        }
    }

    /// Whether it is better: fewer requirements are missed, or the same number by less; where these are equal the rate is larger, and where these are
    /// the gain is smaller.
    #[must_use]
    pub fn is_better_than(&self, other: &Merit) -> bool {
        let misses = |merit: &Merit| (merit.missed, merit.distance);
        if misses(self) != misses(other) {
            return misses(self) < misses(other);
        }
        if self.rate == other.rate { self.sigma < other.sigma } else { self.rate > other.rate }
    }
}

/// Values that were tried, and what their table comes to; why there is none otherwise.
#[derive(Clone, Debug)]
pub struct TriedValues {
    /// As they are written, in the order of the numbers.
    pub values: Vec<String>,
    /// The pair to take, or a sentence.
    pub outcome: Result<Merit, String>,
}

/// The ends between which mu is sought where none are given, times the period: the rate that mu allows has its largest value near 3/T.
const MU: [f64; 2] = [1.0, 8.0];

/// The numbers to choose, in the notation of [`parameters`](crate::tune::parameters), with the usual range of mu, from 1/T to 8/T, where it has none.
#[must_use]
pub fn mu_by_the_period(over: &str, period: &Period) -> String {
    let period = period.nominal().to_f64();
    let [low, high] = MU.map(|end| round_f64(end / period, DIGITS, Direction::Nearest));
    let range = low.zip(high).map(|(low, high)| format!("mu={}..{}", write_exact(&low), write_exact(&high)));
    let with_range = |name: &str| range.clone().filter(|_| name.trim() == "mu").unwrap_or_else(|| name.to_owned());
    over.split(',').map(with_range).collect::<Vec<_>>().join(",")
}

/// Numbers that were to be chosen, and what was tried.
#[derive(Clone, Debug, Default)]
pub struct ValuesTried {
    /// The numbers, as the document has them.
    pub parameters: Vec<Parameter>,
    /// What was tried, in this order; the values of the document first.
    pub all: Vec<TriedValues>,
    /// Which of these are best.
    pub best: usize,
}

/// The values that are tried, beside its own, of a number that is sought between two positive ends: in the middle of equal parts of that range in
/// logarithms, rounded to two digits.
#[must_use]
pub fn values_of(parameter: &Parameter) -> Vec<String> {
    let [low, high] = parameter.logarithms();
    let value = |index: u32| {
        let share = (2.0 * f64::from(index) + 1.0) / (2.0 * f64::from(TRIED));
        let value = round_f64((low + share * (high - low)).portable_exp(), DIGITS, Direction::Nearest)?;
        let [low, high] = &parameter.range;
        Some(write_exact((&value).clamp(low, high)))
    };
    let mut all: Vec<String> = (0..TRIED).filter_map(value).filter(|value| *value != parameter.written).collect();
    all.dedup();
    all
}

/// Makes a table of the values of the document and then, number by number, of other values of it with the best ones of those before. Returns all that
/// were tried, and the best table; where there is none, why there is none with the values of the document. Of equals the first is best.
///
/// Guarantee: `made` is asked once for each combination of values, the tables themselves are not looked into.
///
/// # Errors
/// No values have a table.
pub fn best_values<T, E>(
    parameters: Vec<Parameter>,
    mut made: impl FnMut(&[String]) -> Result<(Merit, T), E>,
    told: impl Fn(&E) -> String,
) -> Result<(ValuesTried, T), E> {
    let mut tried = Vec::new();
    let mut try_values = |values: &[String]| {
        let found = made(values);
        let outcome = found.as_ref().map(|(merit, _)| merit.clone()).map_err(&told);
        tried.push(TriedValues { values: values.to_vec(), outcome });
        (tried.len() - 1, found)
    };
    let mut values: Vec<String> = parameters.iter().map(|parameter| parameter.written.clone()).collect();
    let (mut index, mut best) = try_values(&values);
    for (place, parameter) in parameters.iter().enumerate() {
        let mut next = values.clone();
        for value in values_of(parameter) {
            values[place] = value;
            let (at, Ok((merit, table))) = try_values(&values) else { continue };
            if best.as_ref().map_or(true, |(known, _)| merit.is_better_than(known)) {
                next.clone_from(&values);
                (index, best) = (at, Ok((merit, table)));
            }
        }
        values = next;
    }
    best.map(|(_, table)| (ValuesTried { parameters, all: tried, best: index }, table))
}

#[cfg(test)]
mod tests {
    use super::super::row::tests::{cell, falling};
    use super::super::{Requirements, choose};
    use super::*;
    use sigmastar_exact::enclosure::Enclosure;
    use sigmastar_lang::spec::Document;
    use sigmastar_prove::reduction::Subject;

    fn document() -> Document {
        let text = r#"{ "format": "sigmastar/plant", "version": 1, "name": "p", "period": "1/50", "states": ["v"], "f": ["-v"], "q": "v",
                        "initial_set": { "kind": "aligned" },
                        "internal_model": { "mu": "1", "base_frequency": "100*pi", "matched": true,
                                            "weights": { "family": "power", "n0": 2, "epsilon": "1/2" } } }"#;
        Document::parse("plant", text).unwrap()
    }

    fn subject() -> Subject {
        Subject::read(&document()).unwrap()
    }

    fn parameters(text: &str) -> Vec<Parameter> {
        crate::tune::parameters(text, &document(), subject().internal_model()).unwrap()
    }

    fn merit(sigma: u32, rate: Option<(u32, u32)>, missed: usize, share: f64) -> Merit {
        Merit { sigma: sigma.into(), oscillators: None, missed, rate: rate.map(Rational::from), distance: (0, share) }
    }

    #[test]
    fn values_are_spread_over_the_range() {
        // 16^(1/8), 16^(3/8), ...
        assert_eq!(values_of(&parameters("mu=1..16")[0]), ["1.4", "2.8", "5.7", "11"]);
        // Its own value is not tried again, nor one twice.
        assert_eq!(values_of(&parameters("mu=0.98..1.02")[0]), ["0.98", "0.99"]);
    }

    #[test]
    fn mu_is_sought_around_what_the_period_asks_for() {
        let subject = subject();
        assert_eq!(mu_by_the_period("n0, mu", subject.period()), "n0,mu=50..400");
        assert_eq!(mu_by_the_period("mu=1..2,epsilon", subject.period()), "mu=1..2,epsilon");
    }

    #[test]
    fn requirements_count_first_then_the_rate_then_the_gain() {
        let slow = merit(10, Some((1, 1)), 0, 0.0);
        for (better, than) in [
            (merit(90, Some((2, 1)), 0, 0.0), &slow),
            (merit(9, Some((1, 1)), 0, 0.0), &slow),
            (slow.clone(), &merit(5, Some((9, 1)), 1, 1.1)),
            (merit(10, None, 1, 1.1), &merit(5, Some((9, 1)), 1, 1.2)),
            (slow.clone(), &merit(1, None, 0, 0.0)),
        ] {
            assert!(better.is_better_than(than) && !than.is_better_than(&better), "{better:?} {than:?}");
        }
        assert!(!slow.is_better_than(&slow));
    }

    /// Without requirements the slowest number of oscillators counts, and one without a rate is slower than all.
    #[test]
    fn the_rate_is_that_of_the_oscillators_to_take() {
        let fast = || falling(cell(0, [0.5, 2.0, 1.0]), (3, 1), (1, 1));
        let slow = || falling(cell(2, [0.1, 2.0, 1.0]), (1, 1), (1, 1));
        let of = |cells: Vec<Cell>, required: &Requirements| {
            let rows = [Row { sigma: 7.into(), e0: 1.into(), cells }];
            Merit::of(&rows, &choose(&rows, required, &Enclosure::exactly(1.0)).unwrap())
        };
        let none = Requirements::default();
        assert_eq!(of(vec![fast(), slow()], &none).rate, Some(1.into()));
        assert_eq!(of(vec![fast(), cell(2, [0.1, 2.0, 1.0])], &none).rate, None);
        let steady = Requirements { steady_error: Some(1.into()), ..Requirements::default() };
        let found = of(vec![fast(), slow()], &steady);
        assert_eq!((found.rate, found.oscillators, found.missed), (Some(3.into()), Some(0.into()), 0));
        let steady = Requirements { steady_error: Some((1, 100).into()), ..Requirements::default() };
        assert_eq!(of(vec![fast(), slow()], &steady).missed, 1);
    }

    /// One number after the other, with the best of those before; what has no table is passed over.
    #[test]
    fn each_number_in_turn() {
        let free = parameters("mu=1..16,n0=2..32");
        let mut asked = Vec::new();
        let made = |values: &[String]| {
            asked.push(values.to_vec());
            // The best mu is 5.7, the best n0 the largest; nothing is certified with 11.
            let [mu, n0]: [f64; 2] = [0, 1].map(|index: usize| values[index].parse().unwrap());
            if mu > 10.0 {
                return Err(format!("mu = {mu}"));
            }
            let rate = Rational::from_f64(n0 - (mu - 5.0).abs()).unwrap();
            Ok((Merit { rate: Some(rate), ..merit(10, None, 0, 0.0) }, values.to_vec()))
        };
        let (found, best) = best_values(free.clone(), made, Clone::clone).unwrap();
        let tried = &found.all;
        assert_eq!((&best[..], &tried[found.best].values), (&["5.7".to_owned(), "23".to_owned()][..], &best));
        assert_eq!((tried.len(), asked.len(), &tried[0].values[..]), (9, 9, &["1".to_owned(), "2".to_owned()][..]));
        assert!(tried[5..].iter().all(|one| one.values[0] == "5.7"), "{tried:?}");
        assert_eq!(tried[4].outcome, Err("mu = 11".to_owned()));
        // None of them: the reason is that of the document itself.
        let none = best_values::<(), _>(free, |values| Err(values.join(" ")), Clone::clone).unwrap_err();
        assert_eq!(none, "1 2");
    }
}
