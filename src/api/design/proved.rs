//! Rows of a design table: claims that the independent checker decides.

use super::super::certificate::Certificate;
use super::super::certify::{not_certified, with_rates};
use super::super::error::Error;
use super::super::subject::Subject;
use rug::Rational;
use sigmastar_exact::number::write_exact;
use sigmastar_exact::parallel;
use sigmastar_lang::spec::Oscillators;
use sigmastar_prove::certify::Options;
use sigmastar_prove::reduction::{AtGains, Prepared};
use sigmastar_report::{ClaimInWords, run_in_words};
use sigmastar_studies::design::{Claims, Row};

/// A gain that is certified, with what its report says of the set and of what is assumed.
pub(super) struct Taken {
    pub(super) sigma: Rational,
    pub(super) certificate: Certificate,
    pub(super) in_words: ClaimInWords,
}

/// Rows that are proved and decided by the independent checker, with their certificates.
pub(super) struct Proved<'a> {
    pub(super) gains: &'a AtGains<'a>,
    pub(super) options: Options,
    /// Numbers of oscillators and sets of harmonics, those with the fewest oscillators first.
    pub(super) oscillators: &'a [Oscillators],
    pub(super) asked: &'a Subject,
    pub(super) simulate: bool,
    /// Of |e|, to which runs are to settle.
    pub(super) limit: Option<&'a Rational>,
    /// Hears of what is proved next.
    pub(super) tell: &'a (dyn Fn(&str) + Sync),
    pub(super) certificates: Vec<Taken>,
    /// The gains that are not certified, and why.
    pub(super) refused: Vec<(Rational, Error)>,
}

impl Claims for Proved<'_> {
    type Refusal = Error;

    fn smallest(&mut self) -> Result<Row, Error> {
        (self.tell)("proving the row of the smallest gain");
        let (row, certified) = self.row(self.gains.smallest())?;
        self.certificates.push(certified);
        Ok(row)
    }

    fn at(&mut self, sigmas: &[Rational]) -> Vec<Option<Row>> {
        let at = |sigma: &Rational| {
            let prepared = self.gains.at(sigma).map_err(|all| Error::documents(&all))?;
            self.row(prepared)
        };
        let shown: Vec<String> = sigmas.iter().map(write_exact).collect();
        (self.tell)(&format!("proving sigma = {}", shown.join(", ")));
        let found = parallel::map(sigmas, at);
        let mut rows = Vec::with_capacity(found.len());
        for (found, sigma) in found.into_iter().zip(sigmas) {
            match found {
                Ok((row, certified)) => {
                    self.certificates.push(certified);
                    rows.push(Some(row));
                }
                Err(error) => {
                    self.refused.push((sigma.clone(), error));
                    rows.push(None);
                }
            }
        }
        rows
    }
}

impl Proved<'_> {
    fn row(&self, prepared: Prepared) -> Result<(Row, Taken), Error> {
        let sets = self.oscillators.iter().filter(|asked| asked.n_o().is_none()).cloned().collect();
        let prepared = prepared.with_sets(sets);
        let run = with_rates(&prepared, (self.options, self.oscillators))?;
        let row = Row::of(&run, self.oscillators);
        let certificate = Certificate::new(&run, self.asked, false).zip(run_in_words(&run));
        let (row, (certificate, in_words)) = row.zip(certificate).ok_or_else(|| not_certified(&run))?;
        let row = if self.simulate { simulated(row, &certificate, self.limit) } else { row };
        let sigma = row.sigma.clone();
        Ok((row, Taken { sigma, certificate, in_words }))
    }
}

/// A row with what simulations of the nominal plant come to.
#[cfg(feature = "lab")]
fn simulated(mut row: Row, certificate: &Certificate, limit: Option<&Rational>) -> Row {
    use sigmastar_lab::falsify::{LoopFigures, TriedClaim, nominal_figures};
    use sigmastar_studies::design::Simulated;
    let document = sigmastar_lang::spec::Document::parse("the certificate", certificate.to_json());
    let claim = document.and_then(|document| TriedClaim::from_document(&document));
    let Ok(claim) = claim else { return row };
    let limit = limit.map(Rational::to_f64);
    let found = parallel::map(&row.cells, |cell| nominal_figures(&claim, &cell.oscillators, limit));
    for (cell, found) in row.cells.iter_mut().zip(found) {
        cell.simulated =
            found.map(|LoopFigures { steady_error, largest, settling }| Simulated { steady_error, largest, settling });
    }
    row
}

#[cfg(not(feature = "lab"))]
fn simulated(row: Row, _: &Certificate, _: Option<&Rational>) -> Row {
    row
}
