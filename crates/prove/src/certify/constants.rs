//! What is reported of a proof beside its claim, at a precision at which it is known well.

use super::certification::{ExactClaim, PrintedFigure};
use super::outcome::Outcome;
use rug::Rational;
use sigmastar_decide::conditions::Ladder;
use sigmastar_decide::conditions::decide;
use sigmastar_decide::conditions::{Decided, Proof, RepairedProof, SharpProof, Witness};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::model::Specification;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::table::{At, Row, TableInput, Value, table};

/// Binary digits that a reported number has, where the precision allows it.
const DIGITS: u32 = 56;

/// The most bits that are spent on that: a number that is 0, and not exactly so, is never known to any digit.
const FINEST: u32 = 512;

/// What the table of constants is made from.
pub(super) struct Columns<'a> {
    pub(super) sharp: Outcome<SharpProof>,
    pub(super) repaired: Option<Outcome<RepairedProof>>,
    pub(super) printed: &'a PrintedFigure,
    pub(super) exact: Option<&'a ExactClaim>,
}

/// The table of constants, and the precision at which it was evaluated.
pub(super) struct Table {
    pub(super) precision: u32,
    pub(super) rows: Vec<Row>,
}

impl Columns<'_> {
    /// The proofs and the table, evaluated again at a doubled precision up to [`FINEST`] while a number is not known to
    /// [`DIGITS`]: where a bounding function cancels, fewer bits decide a condition than tell its sides.
    ///
    /// Guarantee: a proof stays one; an evaluation is replaced only by one of more bits that is proved too.
    pub(super) fn evaluated(mut self, spec: &Specification, start: u32, ladder: Ladder) -> (Self, Table) {
        let mut precision = start;
        let finest = FINEST.min(ladder.limit);
        loop {
            let rows = constants(&Data::new(spec, precision), &self);
            if precision >= finest || !self.is_rough(&rows) {
                return (self, Table { precision, rows });
            }
            precision = (2 * precision).min(finest);
            let ladder = Ladder { start: precision, ..ladder };
            raise(&mut self.sharp, spec, ladder);
            self.repaired.iter_mut().for_each(|outcome| raise(outcome, spec, ladder));
        }
    }

    fn repaired_proof(&self) -> Option<&RepairedProof> {
        self.repaired.as_ref().and_then(Outcome::proved)
    }

    fn is_rough(&self, rows: &[Row]) -> bool {
        // What the printed formulas say at free numbers of their own is evaluated once, and not stored.
        let printed = |row: &Row| row.printed.clone().filter(|_| row.at != At::Own);
        let cells = rows.iter().flat_map(|row| [printed(row), row.repaired.clone(), row.sharp.clone()]).flatten();
        let mut numbers = cells.filter_map(|cell| match cell.value {
            Value::Number(value) => Some(value),
            Value::Span(_) | Value::Infeasible(_) | Value::Unavailable(_) => None,
        });
        let proofs = [self.sharp.proved().map(Proof::decided), self.repaired_proof().map(Proof::decided)];
        let unknown = |proof: Decided<'_>| {
            let [x_per, e_per, _] = proof.periodic;
            rough(x_per) || rough(e_per) || proof.conditions.iter().any(|c| rough(&c.lhs) || rough(&c.rhs))
        };
        numbers.any(|number| rough(&number)) || proofs.into_iter().flatten().any(unknown)
    }
}

/// Decides a proof again where it was decided with fewer bits; it gives way only to one that is proved too.
fn raise<W: Witness + Clone>(outcome: &mut Outcome<Proof<W>>, spec: &Specification, ladder: Ladder) {
    if let Outcome::Proved(proof) = outcome
        && proof.precision < ladder.start
    {
        let again = decide(spec, proof.witness.clone(), ladder);
        if again.truth().is_true() {
            **proof = again;
        }
    }
}

/// Whether a number that has bounds is known to less than [`DIGITS`].
fn rough(value: &Enclosure) -> bool {
    if !value.is_bounded() {
        return false;
    }
    let width = Enclosure::point(&value.upper()) - Enclosure::point(&value.lower());
    let unit = Enclosure::from_rational(&(Rational::from(1) >> DIGITS), DIGITS);
    !width.le(&(value.abs().ceiling() * unit)).is_true()
}

/// The table, at the witness of the claim; nothing where that is not proved, and with an input gain or an interval of the period, of which
/// the formulas that are compared know nothing.
fn constants(data: &Data<'_>, columns: &Columns<'_>) -> Vec<Row> {
    let known = data.input_gain.is_none() && data.spec.period.interval().is_none();
    let Some(sharp) = columns.sharp.proved().filter(|_| known) else { return Vec::new() };
    let rows = table(&TableInput {
        data,
        sharp: (&sharp.witness, &sharp.evaluation),
        repaired: columns.repaired_proof().map(|proof| (&proof.witness, &proof.evaluation)),
        printed: columns.printed.evaluation.as_ref(),
        printed_sigma: columns.printed.sigma.clone(),
        sigma_exact: columns.exact.map(|claim| claim.witness.sigma.clone()),
    });
    if data.spec.plant().is_some() { rows.into_iter().filter_map(of_a_plant).collect() } else { rows }
}

/// A row without the figures that rest on data which are not computed from a plant's formulas.
fn of_a_plant(row: Row) -> Option<Row> {
    let known = |value: &Value| matches!(value, Value::Number(value) | Value::Span(value) if value.is_bounded());
    let sharp = row.sharp.filter(|entry| known(&entry.value))?;
    Some(Row { printed: None, repaired: None, sharp: Some(sharp), ..row })
}
