//! The design table, and the pair of a gain and a number of oscillators to take.

use super::certificate::Certificate;
use super::certify::{not_certified, with_rates};
use super::error::{Error, ErrorKind};
use super::report::Report;
use super::subject::Subject;
use super::{positive, rational};
use rug::Rational;
use sigmastar_exact::enclosure::DEFAULT_PRECISION;
use sigmastar_exact::number::write_exact;
use sigmastar_exact::parallel;
use sigmastar_lang::spec::Document;
use sigmastar_prove::certify::{NoRatesOfClaim, Options, rate_counts};
use sigmastar_prove::reduction::{AtGains, Prepared, Subject as Read, Unwatched, at_samples};
use sigmastar_report::run_set_and_assumptions;
use sigmastar_studies::design::{Choice, Claims, DesignReport, Requirements, Row, choose, design_table};

/// The numbers of oscillators where none are asked for.
const N_O: [u32; 5] = [0, 1, 2, 3, 5];

/// The most gains of one call.
const MAX_GAINS: usize = 20;

/// What is required of a loop, and of which table. The defaults are those of `sigmastar design`.
///
/// ```
/// use sigmastar::DesignOptions;
/// let options = DesignOptions::new().steady_error("1/10").peak_error("2").n_o([0, 2, 4]);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DesignOptions {
    n_o: Option<Vec<u32>>,
    sigmas: Vec<String>,
    sampling_period: Option<String>,
    /// Of the steady error, the peak, the control, the periods to settle, the noise.
    required: [Option<String>; 5],
    simulate: bool,
}

impl Default for DesignOptions {
    fn default() -> DesignOptions {
        DesignOptions::new()
    }
}

impl DesignOptions {
    /// Nothing is required, and the table has 0, 1, 2, 3 and 5 oscillators, as far as the samples tell these apart, at the smallest gain and multiples of it.
    #[must_use]
    pub fn new() -> DesignOptions {
        DesignOptions {
            n_o: None,
            sigmas: Vec::new(),
            sampling_period: None,
            required: [const { None }; 5],
            simulate: true,
        }
    }

    /// The numbers of oscillators of the table (at most 8, up to 100).
    #[must_use]
    pub fn n_o(mut self, counts: impl Into<Vec<u32>>) -> DesignOptions {
        self.n_o = Some(counts.into());
        self
    }

    /// The gains of the table, positive rational numbers (at most 20), in the place of the smallest one and multiples of it.
    #[must_use]
    pub fn sigmas<S: Into<String>>(mut self, sigmas: impl IntoIterator<Item = S>) -> DesignOptions {
        self.sigmas = sigmas.into_iter().map(Into::into).collect();
        self
    }

    /// The regulator at samples this far apart, as [`CertifyOptions::sampling_period`](crate::CertifyOptions::sampling_period).
    #[must_use]
    pub fn sampling_period(mut self, period: impl Into<String>) -> DesignOptions {
        self.sampling_period = Some(period.into());
        self
    }

    /// |e| of the periodic solution is to be at most this, a positive rational number.
    #[must_use]
    pub fn steady_error(self, limit: impl Into<String>) -> DesignOptions {
        self.requiring(0, limit.into())
    }

    /// |e| at all times is to be at most this, a positive rational number.
    #[must_use]
    pub fn peak_error(self, limit: impl Into<String>) -> DesignOptions {
        self.requiring(1, limit.into())
    }

    /// The control at all times is to be at most this, a positive rational number.
    #[must_use]
    pub fn max_control(self, limit: impl Into<String>) -> DesignOptions {
        self.requiring(2, limit.into())
    }

    /// |e| is to be at most [`DesignOptions::steady_error`] for good after so many periods, a positive rational number; at samples at the sampling
    /// instants.
    #[must_use]
    pub fn settle(self, periods: impl Into<String>) -> DesignOptions {
        self.requiring(3, periods.into())
    }

    /// What noise, the disturbance and rounding of the document make of e in the limit is to be at most this, a positive rational number.
    #[must_use]
    pub fn noise(self, limit: impl Into<String>) -> DesignOptions {
        self.requiring(4, limit.into())
    }

    /// Whether simulations of the nominal plant stand beside what is proved (default: yes). Without the feature `lab` there are none.
    #[must_use]
    pub fn simulate(mut self, simulate: bool) -> DesignOptions {
        self.simulate = simulate;
        self
    }

    fn requiring(mut self, which: usize, limit: String) -> DesignOptions {
        self.required[which] = Some(limit);
        self
    }
}

/// What arguments are called in errors.
#[derive(Clone, Copy, Debug)]
pub struct DesignNames {
    /// The numbers of oscillators, the gains, the sampling period.
    pub asked: [&'static str; 3],
    /// The requirements.
    pub required: [&'static str; 5],
}

const NAMES: DesignNames = DesignNames {
    asked: ["`n_o`", "sigmas", "sampling_period"],
    required: ["steady_error", "peak_error", "max_control", "settle", "noise"],
};

/// A design table, and the pair to take.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Design {
    sigma: String,
    n_o: Option<u32>,
    is_met: bool,
    certificate: Certificate,
    report: Report,
}

impl Design {
    /// The gain to take, exactly: a decimal or a fraction.
    #[must_use]
    pub fn sigma(&self) -> &str {
        &self.sigma
    }

    /// The number of oscillators to take; `None` where nothing is required: the gain is for each number of the table.
    #[must_use]
    pub fn n_o(&self) -> Option<u32> {
        self.n_o
    }

    /// Whether every requirement is proved to be met with this pair; so it is where nothing is required.
    #[must_use]
    pub fn is_met(&self) -> bool {
        self.is_met
    }

    /// The certificate of the claim with the gain to take.
    #[must_use]
    pub fn certificate(&self) -> &Certificate {
        &self.certificate
    }

    /// The report of `sigmastar design`, with the table.
    #[must_use]
    pub fn report(&self) -> &Report {
        &self.report
    }
}

/// What is proved at several gains with several numbers of oscillators, beside what is required; and the pair to take: the smallest gain of the table, and there
/// the fewest oscillators, with which every requirement is proved to be met.
///
/// Guarantee: each row is a claim of its own that the independent checker decides. A requirement is met only where an upper bound that is proved is not above it.
///
/// # Errors
/// Those of [`certify`](crate::certify) for the document and for the smallest gain, where no gains are asked for;
/// [`Options`](ErrorKind::Options) for a requirement that does not go with the document or with the others, and too many gains; of gains that are asked
/// for [`NotCertified`](ErrorKind::NotCertified) where none is certified.
pub fn design(subject: impl Into<Subject>, options: &DesignOptions) -> Result<Design, Error> {
    let Subject { read, source } = subject.into();
    design_of((read, source), options, &NAMES)
}

/// [`design`] of a document that was read, with other names of arguments.
///
/// # Errors
/// Those of [`design`].
pub fn design_of(
    (read, source): (Read, Document),
    options: &DesignOptions,
    names: &DesignNames,
) -> Result<Design, Error> {
    let [of_counts, of_sigmas, of_step] = names.asked;
    let asked = match &options.sampling_period {
        None => Subject { read, source },
        Some(step) => {
            let read = Read::read(&at_samples(&source, &positive(of_step, step)?)?)?;
            Subject { read, source }
        }
    };
    let asked_counts = options.n_o.clone().unwrap_or_else(|| {
        // Those that the samples tell apart.
        let fits = |n_o: &u32| asked.read.sampling().is_none_or(|sampling| 2 * n_o < sampling.samples);
        N_O.into_iter().filter(fits).collect()
    });
    let counts = rate_counts(&asked_counts).map_err(|reason| Error::no_rates(reason, of_counts))?;
    if counts.is_empty() {
        let message = format!("{of_counts}: a design table needs a number of oscillators, and there is none");
        return Err(Error::new(ErrorKind::Options, message, "ask for some, as 0,1,2,3"));
    }
    if let Some((sampling, n_o)) = asked.read.sampling().zip(counts.last())
        && 2 * u64::from(*n_o) >= u64::from(sampling.samples)
    {
        return Err(Error::no_rates(NoRatesOfClaim::NotBelowHalf(*n_o, sampling.samples), of_counts));
    }
    let mut sigmas: Vec<Rational> =
        options.sigmas.iter().map(|sigma| rational(of_sigmas, sigma)).collect::<Result<_, _>>()?;
    sigmas.sort();
    sigmas.dedup();
    if sigmas.len() > MAX_GAINS {
        let message = format!("{of_sigmas}: {} gains; at most {MAX_GAINS} go into one table", sigmas.len());
        return Err(Error::new(ErrorKind::Options, message, "ask for fewer"));
    }
    let requirements = requirements(&asked.read, options, names)?;
    let period = asked.read.period().shortest().enclose(DEFAULT_PRECISION);
    let run_options = Options { compare: false, ..Options::default() };
    let gains = AtGains::new(&asked.read, &counts, run_options, &Unwatched).map_err(|all| Error::documents(&all))?;
    let mut claims = Proved {
        gains: &gains,
        options: run_options,
        counts: &counts,
        asked: &asked,
        simulate: options.simulate,
        certificates: Vec::new(),
        refused: Vec::new(),
    };
    let rows = design_table(&mut claims, (&requirements, &period), &sigmas)?;
    let Proved { certificates, mut refused, .. } = claims;
    let Some(choice) = choose(&rows, &requirements, &period) else {
        let none = || Error::new(ErrorKind::NotCertified, "none of these gains is certified", "ask for larger ones");
        return Err(if refused.is_empty() { none() } else { refused.swap_remove(0).1 });
    };
    let refused: Vec<(Rational, String)> = refused.into_iter().map(|(sigma, why)| (sigma, why.sentence())).collect();
    let taken = certificates.into_iter().find(|proved| proved.sigma == rows[choice.row].sigma);
    let Some(Taken { sigma, certificate, set_and_assumptions }) = taken else {
        return Err(Error::new(ErrorKind::NotCertified, "the gain to take has no certificate", "report this"));
    };
    let report = DesignReport {
        rows: &rows,
        choice: &choice,
        requirements: &requirements,
        period: &period,
        refused: &refused,
        disturbed: has_disturbances(&asked.read),
        states_e0: asked.read.states_e0(),
        notes: certificate.remarks(),
        set_and_assumptions: &set_and_assumptions,
        sampling: asked.read.sampling().map(|sampling| (sampling.text(), sampling.samples)),
        name: asked.read.name(),
        sha256: asked.read.sha256(),
    };
    let report = Report::of(&report);
    let Choice { row, cell, is_met, .. } = choice;
    let n_o = cell.map(|cell| rows[row].cells[cell].n_o);
    let is_met = is_met || requirements.is_empty();
    Ok(Design { sigma: write_exact(&sigma), n_o, is_met, certificate, report })
}

fn requirements(subject: &Read, options: &DesignOptions, names: &DesignNames) -> Result<Requirements, Error> {
    let value =
        |which: usize| options.required[which].as_ref().map(|text| rational(names.required[which], text)).transpose();
    let requirements = Requirements {
        steady_error: value(0)?,
        peak_error: value(1)?,
        control: value(2)?,
        settling: value(3)?,
        noise: value(4)?,
    };
    let [of_steady, _, _, of_settling, of_noise] = names.required;
    if requirements.settling.is_some() && requirements.steady_error.is_none() {
        let message = format!("{of_settling}: |e| is to settle to something, and no steady error is required");
        return Err(Error::new(ErrorKind::Options, message, &format!("say with {of_steady} to what")));
    }
    if requirements.settling.is_some() && subject.sampling().is_some_and(|sampling| sampling.delayed) {
        return Err(Error::no_rates(NoRatesOfClaim::WithDelay, of_settling));
    }
    let of_no_noise = match subject.sampling() {
        Some(sampling) if sampling.delayed => Some("`delay_samples`"),
        _ => subject.actuator().map(|_| "an `actuator`"),
    };
    if let Some(other) = of_no_noise.filter(|_| requirements.noise.is_some()) {
        let message = format!("{of_noise}: nothing is proved of noise with {other}");
        return Err(Error::new(ErrorKind::Options, message, "leave one of both out"));
    }
    if requirements.noise.is_some() && !has_disturbances(subject) {
        let message = format!("{of_noise}: the document states neither noise nor a disturbance");
        let help = "state `noise` or `disturbance` in the document, or leave this out";
        return Err(Error::new(ErrorKind::Options, message, help));
    }
    Ok(requirements)
}

/// Whether something is stated that moves e in the limit; at samples rounding is such a thing.
fn has_disturbances(subject: &Read) -> bool {
    let stated = subject.disturbances();
    if subject.sampling().is_some() { stated.any_at_samples() } else { stated.any() }
}

/// A gain that is certified, with what its report says of the set and of what is assumed.
struct Taken {
    sigma: Rational,
    certificate: Certificate,
    set_and_assumptions: [String; 2],
}

/// Rows that are proved and decided by the independent checker, with their certificates.
struct Proved<'a> {
    gains: &'a AtGains<'a>,
    options: Options,
    counts: &'a [u32],
    asked: &'a Subject,
    simulate: bool,
    certificates: Vec<Taken>,
    /// The gains that are not certified, and why.
    refused: Vec<(Rational, Error)>,
}

impl Claims for Proved<'_> {
    type Refusal = Error;

    fn smallest(&mut self) -> Result<Row, Error> {
        let (row, certified) = self.row(&self.gains.smallest())?;
        self.certificates.push(certified);
        Ok(row)
    }

    fn at(&mut self, sigmas: &[Rational]) -> Vec<Option<Row>> {
        let at = |sigma: &Rational| {
            let prepared = self.gains.at(sigma).map_err(|all| Error::documents(&all));
            prepared.and_then(|prepared| self.row(&prepared))
        };
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
    fn row(&self, prepared: &Prepared) -> Result<(Row, Taken), Error> {
        let run = with_rates(prepared, (self.options, self.counts))?;
        let row = Row::of(&run, self.counts);
        let certificate = Certificate::new(&run, self.asked, false).zip(run_set_and_assumptions(&run));
        let (row, (certificate, set_and_assumptions)) = row.zip(certificate).ok_or_else(|| not_certified(&run))?;
        let row = if self.simulate { simulated(row, &certificate) } else { row };
        let sigma = row.sigma.clone();
        Ok((row, Taken { sigma, certificate, set_and_assumptions }))
    }
}

/// A row with what simulations of the nominal plant come to.
#[cfg(feature = "lab")]
fn simulated(mut row: Row, certificate: &Certificate) -> Row {
    use sigmastar_lab::falsify::{LoopFigures, TriedClaim, nominal_figures};
    use sigmastar_studies::design::Simulated;
    let document = Document::parse("the certificate", certificate.to_json());
    let claim = document.and_then(|document| TriedClaim::from_document(&document));
    let Ok(claim) = claim else { return row };
    let counts: Vec<u32> = row.cells.iter().map(|cell| cell.n_o).collect();
    let found = parallel::map(&counts, |n_o| nominal_figures(&claim, *n_o));
    for (cell, found) in row.cells.iter_mut().zip(found) {
        cell.simulated = found.map(|LoopFigures { steady_error, largest }| Simulated { steady_error, largest });
    }
    row
}

#[cfg(not(feature = "lab"))]
fn simulated(row: Row, _: &Certificate) -> Row {
    row
}
