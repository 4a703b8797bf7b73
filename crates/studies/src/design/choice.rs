//! Which pair of a gain and a number of oscillators to take.

use super::requirements::{Compared, Requirements, distance};
use super::row::{Cell, Row};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_prove::certify::{Transient, gain_to_use};

/// The pair that is proposed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Which row.
    pub row: usize,
    /// Which cell of it; none where nothing is required: the gain is for every number of oscillators of the table.
    pub cell: Option<usize>,
    /// Whether all requirements are proved to be met, or the rule for a gain without requirements is.
    pub is_met: bool,
    /// What is required beside what is proved.
    pub compared: Vec<Compared>,
    /// For each other number of oscillators of the table the row with the smallest gain that meets all that is required.
    pub others: Vec<[usize; 2]>,
}

/// The pair with the smallest gain, and there with the fewest oscillators, that is proved to meet all requirements; where none does, the one that misses the
/// fewest of them, has something proved of the most of these, and misses these by least. Without requirements the gain to use ([`gain_to_use`]). `None` for a table without rows or cells. Hypothesis: the rows are in the order of their gains, with the same numbers of oscillators.
#[must_use]
pub fn choose(rows: &[Row], requirements: &Requirements, period: &Enclosure) -> Option<Choice> {
    let counts = rows.first()?.cells.len();
    if requirements.is_empty() {
        return without_requirements(rows);
    }
    let compared = |[row, cell]: [usize; 2]| requirements.compared(&rows[row].cells[cell], period);
    let pairs = || (0..rows.len()).flat_map(|row| (0..counts).map(move |cell| [row, cell]));
    let is_met = |pair: &[usize; 2]| compared(*pair).iter().all(Compared::is_met);
    let miss = |pair: [usize; 2]| {
        let all = compared(pair);
        (all.iter().filter(|one| !one.is_met()).count(), distance(&all))
    };
    let found = pairs().find(is_met);
    let [row, cell] = match found {
        Some(pair) => pair,
        None => pairs().reduce(|a, b| if miss(b) < miss(a) { b } else { a })?,
    };
    let smallest = |other: usize| (0..rows.len()).map(|row| [row, other]).find(is_met);
    let others = (0..counts).filter(|other| *other != cell).filter_map(smallest).collect();
    Some(Choice { row, cell: Some(cell), is_met: found.is_some(), compared: compared([row, cell]), others })
}

fn without_requirements(rows: &[Row]) -> Option<Choice> {
    fn transient<'r>(row: &'r Row, cell: &'r Cell) -> Transient<'r> {
        let rate = cell.decay.as_ref().map(|decay| &decay.rate);
        Transient { start: &row.e0, steady: &cell.steady_error, peak: &cell.peak_error, rate }
    }
    let gains: Vec<Vec<Transient<'_>>> =
        rows.iter().map(|row| row.cells.iter().map(|cell| transient(row, cell)).collect()).collect();
    let (row, is_met) = gain_to_use(&gains)?;
    Some(Choice { row, cell: None, is_met, compared: Vec::new(), others: Vec::new() })
}

#[cfg(test)]
mod tests {
    use super::super::row::tests::{cell, falling};
    use super::*;

    fn row(sigma: u32, cells: Vec<Cell>) -> Row {
        Row { sigma: sigma.into(), e0: 1.into(), cells }
    }

    fn of(steady_error: (u32, u32), control: u32) -> Requirements {
        let (steady_error, control) = (Some(steady_error.into()), Some(control.into()));
        Requirements { steady_error, control, ..Requirements::default() }
    }

    fn chosen(rows: &[Row], requirements: &Requirements) -> (usize, Option<usize>, bool) {
        let choice = choose(rows, requirements, &Enclosure::exactly(1.0)).unwrap();
        (choice.row, choice.cell, choice.is_met)
    }

    #[test]
    fn the_smallest_gain_then_the_fewest_oscillators() {
        let rows = [
            row(10, vec![cell(0, [1.0, 3.0, 5.0]), cell(2, [0.5, 3.0, 5.0]), cell(5, [0.1, 3.0, 6.0])]),
            row(20, vec![cell(0, [0.5, 2.0, 9.0]), cell(2, [0.2, 2.0, 9.0]), cell(5, [0.05, 2.0, 9.0])]),
        ];
        assert_eq!(chosen(&rows, &of((1, 1), 5)), (0, Some(0), true));
        assert_eq!(chosen(&rows, &of((1, 2), 9)), (0, Some(1), true));
        assert!(!chosen(&rows, &of((1, 2), 4)).2);
        assert_eq!(chosen(&rows, &of((2, 10), 6)), (0, Some(2), true));
        assert_eq!(chosen(&rows, &of((6, 100), 9)), (1, Some(2), true));
        // With fewer oscillators it takes the larger gain.
        let choice = choose(&rows, &of((1, 2), 9), &Enclosure::exactly(1.0)).unwrap();
        assert_eq!(choice.others, [[1, 0], [0, 2]]);
        // The one that misses by least: 0.05/0.04 with |u| at 9/9.
        assert_eq!(chosen(&rows, &of((4, 100), 9)), (1, Some(2), false));
        assert!(choose(&[], &of((1, 1), 1), &Enclosure::exactly(1.0)).is_none());
    }

    #[test]
    fn what_is_not_proved_at_any_gain_does_not_hide_what_is() {
        // No rate is proved anywhere, so nothing is of the time to settle.
        let rows = [row(10, vec![cell(0, [5.0, 3.0, 5.0])]), row(20, vec![cell(0, [2.0, 3.0, 5.0])])];
        let required = Requirements { settling: Some(4.into()), ..of((1, 1), 9) };
        assert_eq!(chosen(&rows, &required), (1, Some(0), false));
        // One that is proved and missed is closer than one of which nothing is proved.
        let slow = falling(cell(0, [0.5, 3.0, 5.0]), (1, 100), (8, 1));
        let rows = [row(10, vec![cell(0, [0.5, 3.0, 5.0])]), row(20, vec![slow])];
        assert_eq!(chosen(&rows, &required), (1, Some(0), false));
    }

    #[test]
    fn without_requirements_the_transient_and_the_rate_count() {
        let none = Requirements::default();
        let with = |sigma, peak, rates: [(u32, u32); 2]| {
            let cells = [(0, rates[0]), (3, rates[1])];
            row(sigma, cells.map(|(n_o, rate)| falling(cell(n_o, [0.5, peak, 1.0]), rate, (1, 1))).into())
        };
        let rows = [with(10, 5.0, [(1, 1); 2]), with(15, 2.0, [(1, 1); 2]), with(30, 1.5, [(2, 1), (3, 1)])];
        // The rate of three oscillators is below half of the best with the second gain.
        assert_eq!(chosen(&rows, &none), (2, None, true));
        let rows = [with(10, 5.0, [(1, 1); 2]), with(15, 2.0, [(1, 1); 2]), with(30, 1.5, [(2, 1), (2, 1)])];
        assert_eq!(chosen(&rows, &none), (1, None, true));
        // Nothing keeps to it: the one that comes closest.
        let rows = [with(10, 5.0, [(1, 1); 2]), with(15, 3.0, [(1, 1); 2]), with(30, 4.0, [(1, 1); 2])];
        assert_eq!(chosen(&rows, &none), (1, None, false));
    }
}
