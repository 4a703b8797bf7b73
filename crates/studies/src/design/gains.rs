//! At which gains a design table is made.

use super::choice::choose;
use super::requirements::{Compared, Requirements, closest};
use super::row::Row;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64, round_rational};
use sigmastar_prove::certify::{ROWS, unit_of_gains};

/// The gains beyond those of [`ROWS`], in tenths of [`unit_of_gains`], where a requirement is missed that a larger gain helps to meet.
const FURTHER: [u32; 5] = [80, 120, 200, 500, 1000];

/// So many of them in turn that bring the table no closer to what is required.
const RISES: usize = 2;

/// Gains that are tried between one that keeps what falls with the gain and one that does not.
const STEPS: usize = 4;

/// So many more where only a gain between these may keep everything.
const MORE_STEPS: usize = 4;

/// Two gains that are closer are not told apart where one keeps everything.
const CLOSE: f64 = 1.03;

/// Nor two that are closer where none does.
const CLOSER: f64 = 1.002;

/// Digits of a gain.
const DIGITS: u32 = 4;

/// Who proves what is asked.
pub trait Claims {
    /// Why nothing is proved.
    type Refusal;

    /// What is proved at the smallest gain.
    ///
    /// # Errors
    /// Nothing is certified.
    fn smallest(&mut self) -> Result<Row, Self::Refusal>;

    /// What is proved at each of some gains; `None` where that is nothing.
    fn at(&mut self, sigmas: &[Rational]) -> Vec<Option<Row>>;
}

/// The rows of a design table in the order of their gains: at those that are asked for; or at the smallest one and multiples of it, further ones where what
/// is required needs them, and then at some between a gain that keeps what falls with the gain and one that does not.
///
/// # Errors
/// Nothing is certified at the smallest gain.
pub fn design_table<C: Claims>(
    claims: &mut C,
    (requirements, period): (&Requirements, &Enclosure),
    asked: &[Rational],
) -> Result<Vec<Row>, C::Refusal> {
    if !asked.is_empty() {
        return Ok(claims.at(asked).into_iter().flatten().collect());
    }
    let smallest = claims.smallest()?;
    let unit = unit_of_gains(&smallest.sigma, period);
    let times = |tenths: &u32| round_rational(&(Rational::from((*tenths, 10)) * &unit), DIGITS, Direction::Up);
    let mut rows = vec![smallest];
    rows.extend(claims.at(&ROWS.each_ref().map(times)).into_iter().flatten());
    let is_met = |rows: &[Row]| choose(rows, requirements, period).is_none_or(|choice| choice.is_met);
    let distance = |rows: &[Row]| closest(rows.iter().map(|row| requirements.distance(row, period)));
    let helps = |rows: &[Row]| rows.last().is_some_and(|row| misses_what_falls(row, requirements, period));
    let (mut nearest, mut rises) = (distance(&rows), 0);
    for tenths in &FURTHER {
        if requirements.is_empty() || is_met(&rows) || rises >= RISES || !helps(&rows) {
            break;
        }
        rows.extend(claims.at(&[times(tenths)]).into_iter().flatten());
        let now = distance(&rows);
        rises = if now < nearest { 0 } else { rises + 1 };
        nearest = now;
    }
    between(claims, &mut rows, (requirements, period));
    Ok(rows)
}

/// Whether with each number of oscillators something is missed that falls with the gain.
fn misses_what_falls(row: &Row, requirements: &Requirements, period: &Enclosure) -> bool {
    row.cells.iter().all(|cell| !keeps_what_falls(&requirements.compared(cell, period)))
}

fn keeps_what_falls(compared: &[Compared]) -> bool {
    compared.iter().filter(|one| one.requirement.falls()).all(Compared::is_met)
}

fn keeps_what_grows(compared: &[Compared]) -> bool {
    compared.iter().filter(|one| !one.requirement.falls()).all(Compared::is_met)
}

/// Puts rows in between: with the number of oscillators of the choice, below the smallest gain that keeps what falls with the gain.
fn between<C: Claims>(claims: &mut C, rows: &mut Vec<Row>, (requirements, period): (&Requirements, &Enclosure)) {
    let Some(cell) = choose(rows, requirements, period).and_then(|choice| choice.cell) else { return };
    let keeps = |row: &Row| keeps_what_falls(&requirements.compared(&row.cells[cell], period));
    for step in 0..STEPS + MORE_STEPS {
        let Some(above) = rows.iter().position(keeps).filter(|above| *above > 0) else { return };
        let is_met = choose(rows, requirements, period).is_some_and(|choice| choice.is_met);
        // What grows with the gain and is missed by the smaller one is missed between them, too.
        let may_do = keeps_what_grows(&requirements.compared(&rows[above - 1].cells[cell], period));
        if step >= STEPS && (is_met || !may_do) {
            return;
        }
        let [low, high] = [above - 1, above].map(|row| rows[row].sigma.to_f64());
        let middle = round_f64((low * high).sqrt(), DIGITS, Direction::Up);
        let Some(middle) = middle.filter(|_| high > low * if is_met { CLOSE } else { CLOSER }) else { return };
        if middle <= rows[above - 1].sigma || middle >= rows[above].sigma {
            return;
        }
        let Some(row) = claims.at(&[middle]).pop().flatten() else { return };
        rows.insert(above, row);
    }
}

#[cfg(test)]
mod tests {
    use super::super::row::tests::cell;
    use super::*;

    /// A plant whose steady error is 100/sigma with no oscillator and 10/sigma with one, and whose control is sigma.
    struct Simple {
        smallest: u32,
        asked: Vec<Rational>,
    }

    impl Claims for Simple {
        type Refusal = ();

        fn smallest(&mut self) -> Result<Row, ()> {
            self.at(&[self.smallest.into()]).pop().flatten().ok_or(())
        }

        fn at(&mut self, sigmas: &[Rational]) -> Vec<Option<Row>> {
            self.asked.extend_from_slice(sigmas);
            let row = |sigma: &Rational| {
                let value = sigma.to_f64();
                let cells = [(0, 100.0), (1, 10.0)].map(|(n_o, size)| cell(n_o, [size / value, 1.0, value]));
                Some(Row { sigma: sigma.clone(), e0: 1.into(), cells: cells.into() })
            };
            sigmas.iter().map(row).collect()
        }
    }

    fn table(steady_error: (u32, u32), control: Option<u32>) -> (Vec<f64>, Option<(f64, u32)>) {
        let mut plant = Simple { smallest: 10, asked: Vec::new() };
        let requirements = Requirements {
            steady_error: Some(steady_error.into()),
            control: control.map(Rational::from),
            ..Requirements::default()
        };
        let period = Enclosure::exactly(1.0);
        let rows = design_table(&mut plant, (&requirements, &period), &[]).unwrap();
        assert_eq!(plant.asked.len(), rows.len());
        let found = choose(&rows, &requirements, &period).filter(|choice| choice.is_met);
        let found = found.map(|choice| {
            (rows[choice.row].sigma.to_f64(), rows[choice.row].cells[choice.cell.unwrap()].oscillators.n_o().unwrap())
        });
        (rows.iter().map(|row| row.sigma.to_f64()).collect(), found)
    }

    #[test]
    fn further_gains_where_they_help_and_some_in_between() {
        let (gains, found) = table((1, 1), None);
        assert_eq!((&gains[..], found), (&[10.0, 12.0, 15.0, 20.0, 30.0, 50.0][..], Some((10.0, 1))));
        // 10/sigma is 0.025 at 400: up to 500, and between 200 and 500.
        let (gains, found) = table((25, 1000), None);
        let (sigma, n_o) = found.unwrap();
        assert!(n_o == 1 && (400.0..=424.0).contains(&sigma), "{sigma} {gains:?}");
        assert!(gains.windows(2).all(|pair| pair[0] < pair[1]), "{gains:?}");
        // Only gains from 35 to 36 do: none of the first table.
        let (gains, found) = table((10, 35), Some(36));
        assert!(found.is_some_and(|(sigma, n_o)| n_o == 1 && (35.0..=36.0).contains(&sigma)), "{found:?} {gains:?}");
        // Gains from 35.2 to 36 do.
        let (gains, found) = table((1000, 3520), Some(36));
        assert!(found.is_some(), "{gains:?}");
        // Nothing does, and no gain beyond the table helps.
        let (gains, found) = table((10, 35), Some(5));
        assert!(found.is_none() && gains.len() <= 6 + STEPS, "{gains:?}");
    }

    #[test]
    fn gains_that_are_asked_for_are_the_only_ones() {
        let mut plant = Simple { smallest: 10, asked: Vec::new() };
        let (requirements, period) = (Requirements::default(), Enclosure::exactly(1.0));
        let asked = [Rational::from(7), Rational::from(70)];
        let rows = design_table(&mut plant, (&requirements, &period), &asked).unwrap();
        assert_eq!(rows.iter().map(|row| row.sigma.clone()).collect::<Vec<_>>(), asked);
    }
}
