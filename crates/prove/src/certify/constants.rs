//! The paper's constants, printed and repaired, beside those of a claim: one table, worked out where it is asked for, at a precision at
//! which its numbers are known well.

use super::certification::{Certification, Constants, PrintedFigure};
use super::matrix_checks::SylvesterCheck;
use super::outcome::Outcome;
use super::pool::model;
use super::precision::{is_rough, known_well, raise, rough};
use super::produce::proved_up_to_arguments;
use super::round::{TransferKind, round_repaired};
use rug::Rational;
use sigmastar_decide::conditions::{Proof, RepairedProof};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_propose::search::{FloatModel, search_printed, search_repaired};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::printed::{PrintedEvaluation, level_condition};
use sigmastar_theory::derivation::table::{At, Row, TableInput, Value, table};
use sigmastar_theory::transfer::printed_transfer;

impl Certification<'_> {
    /// The paper's constants beside those of the claim; worked out the first time that they are asked for.
    #[must_use]
    pub fn constants(&self) -> &Constants {
        self.constants.get_or_init(|| Constants::of(self))
    }
}

impl Constants {
    /// Searches and decides what is compared, and evaluates the table; proofs are decided again at a doubled precision
    /// while a number is not known well: where a bounding function cancels, fewer bits decide a condition than tell its sides.
    ///
    /// Guarantee: a proof stays one; an evaluation is replaced only by one of more bits that is proved too.
    fn of(run: &Certification<'_>) -> Constants {
        let (spec, ladder) = (run.spec, run.options.ladder);
        let data = Data::new(spec, ladder.start.max(53));
        let (repaired, printed) = compared(run, &data);
        let sylvester = repaired.as_ref().and_then(Outcome::proved).and_then(|proof| SylvesterCheck::new(spec, proof));
        let mut all = Constants { sharp: run.sharp.clone(), repaired, printed, sylvester, rows: Vec::new() };
        let exact = run.exact.as_ref().map(|claim| claim.witness.sigma.clone());
        known_well(run.precision, ladder, |ladder| {
            raise(&mut all.sharp, spec, ladder);
            all.repaired.iter_mut().for_each(|outcome| raise(outcome, spec, ladder));
            all.rows = all.evaluated(&Data::new(spec, ladder.start), exact.clone());
            !all.is_rough()
        });
        all
    }

    fn repaired_proof(&self) -> Option<&RepairedProof> {
        self.repaired.as_ref().and_then(Outcome::proved)
    }

    /// The table, at the witness of the claim; nothing where that is not proved, and with an input gain or an interval of the period, of
    /// which the formulas that are compared know nothing.
    fn evaluated(&self, data: &Data<'_>, sigma_exact: Option<Rational>) -> Vec<Row> {
        let known = data.input_gain.is_none() && data.spec.period.interval().is_none();
        let Some(sharp) = self.sharp.proved().filter(|_| known) else { return Vec::new() };
        let rows = table(&TableInput {
            data,
            sharp: (&sharp.witness, &sharp.evaluation),
            repaired: self.repaired_proof().map(|proof| (&proof.witness, &proof.evaluation)),
            printed: self.printed.evaluation.as_ref(),
            printed_sigma: self.printed.sigma.clone(),
            sigma_exact,
        });
        if data.spec.plant().is_some() { rows.into_iter().filter_map(of_a_plant).collect() } else { rows }
    }

    fn is_rough(&self) -> bool {
        // What the printed formulas say at free numbers of their own is evaluated once, and not stored.
        let printed = |row: &Row| row.printed.clone().filter(|_| row.at != At::Own);
        let cells = self.rows.iter().flat_map(|row| [printed(row), row.repaired.clone(), row.sharp.clone()]).flatten();
        let mut numbers = cells.filter_map(|cell| match cell.value {
            Value::Number(value) => Some(value),
            Value::Span(_) | Value::Infeasible(_) | Value::Unavailable(_) => None,
        });
        let proofs = [self.sharp.proved().map(Proof::decided), self.repaired_proof().map(Proof::decided)];
        numbers.any(|number| rough(&number)) || proofs.iter().flatten().any(is_rough)
    }
}

/// The repaired and the printed derivation. Both know of no input gain, of no actuator, and of no interval of the period (their K_alpha falls
/// as T grows), and they need data that are not computed from a plant's formulas.
fn compared(run: &Certification<'_>, data: &Data<'_>) -> (Option<Outcome<RepairedProof>>, PrintedFigure) {
    let spec = run.spec;
    let known = spec.plant().is_none() && data.input_gain.is_none() && spec.period.interval().is_none();
    if !known || spec.actuator.is_some() {
        return (None, PrintedFigure::default());
    }
    let refutation = level_condition(data).err();
    if !run.options.compare {
        return (None, PrintedFigure { refutation, ..PrintedFigure::default() });
    }
    let model = model(data, TransferKind::ClosedForm);
    let repaired = match search_repaired(&model) {
        Err(obstacle) => Outcome::NotFound(obstacle),
        Ok(proposal) => {
            proved_up_to_arguments(spec, round_repaired(data, &model, &proposal, run.options.ladder).into())
        }
    };
    let evaluation = printed_evaluation(data, &model);
    let sigma = evaluation
        .as_ref()
        .and_then(|evaluation| Some(evaluation.sigma_p.as_ref().ok()?.max(evaluation.sigma_a.as_ref().ok()?)));
    (Some(repaired), PrintedFigure { refutation, evaluation, sigma: sigma.filter(Enclosure::is_bounded) })
}

fn printed_evaluation(data: &Data<'_>, model: &FloatModel) -> Option<PrintedEvaluation<Enclosure>> {
    let proposal = search_printed(data, model)?;
    let short = |value: f64, direction| round_f64(value, 8, direction);
    let (x_a, e_a) = (short(proposal.x_a, Direction::Nearest)?, short(proposal.e_a, Direction::Down)?);
    let h = data.rational(&short(proposal.h, Direction::Down)?);
    let printed = printed_transfer(data);
    let kappas = [&printed.kappa_0, &printed.kappa_1];
    Some(PrintedEvaluation::new(data, kappas, &data.rational(&x_a), &data.rational(&e_a), |_| h))
}

/// A row without the figures that rest on data which are not computed from a plant's formulas.
fn of_a_plant(row: Row) -> Option<Row> {
    let known = |value: &Value| matches!(value, Value::Number(value) | Value::Span(value) if value.is_bounded());
    let sharp = row.sharp.filter(|entry| known(&entry.value))?;
    Some(Row { printed: None, repaired: None, sharp: Some(sharp), ..row })
}
