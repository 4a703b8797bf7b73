//! The design table, and the pair of a gain and a number of oscillators to take.

mod options;
mod proved;

pub use options::{DesignNames, DesignOptions};

use super::certificate::Certificate;
use super::certify::not_told_apart;
use super::error::{Error, ErrorKind};
use super::options::oscillators;
use super::report::Report;
use super::sampling::SamplingPairs;
use super::subject::Subject;
use super::{rational, with_sampling_period};
use options::{MAX_GAINS, N_O, NAMES, excludes_noise, has_disturbances, requirements};
use proved::{Proved, Taken};
use rug::Rational;
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, Enclosure};
use sigmastar_exact::number::write_exact;
use sigmastar_lang::spec::{Document, Oscillators};
use sigmastar_prove::certify::{NoRatesOfClaim, Options, rate_counts};
use sigmastar_prove::rate::bound::MAX_COUNTS;
use sigmastar_prove::reduction::{AtGains, Subject as Read, Unwatched, for_every_set};
use sigmastar_studies::design::{
    Choice, DesignReport, LongestPeriod, Merit, Requirements, Row, ValuesTried, best_values, choose, design_table,
    mu_by_the_period,
};
use sigmastar_studies::tune::{Parameter, parameters, with_values};

/// A design table, and the pair to take.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Design {
    sigma: String,
    oscillators: Option<Oscillators>,
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

    /// The number of oscillators to take; `None` where nothing is required, as the gain is for each number of the table, and where it is a set of harmonics.
    #[must_use]
    pub fn n_o(&self) -> Option<u32> {
        self.oscillators.as_ref().and_then(Oscillators::n_o)
    }

    /// The set of harmonics to take, 0 the first; `None` where it is a number of oscillators, and where nothing is required.
    #[must_use]
    pub fn harmonics(&self) -> Option<Vec<u32>> {
        self.oscillators.as_ref().filter(|set| set.n_o().is_none()).map(|set| set.all().collect())
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
    design_telling(subject, options, &|_| {})
}

/// [`design`], which tells what it is at: a phrase for each set of values of free numbers, and for each group of gains, as its proofs begin. Nothing that is
/// found depends on it.
///
/// # Errors
/// Those of [`design`].
pub fn design_telling(
    subject: impl Into<Subject>,
    options: &DesignOptions,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Design, Error> {
    let Subject { read, source } = subject.into();
    design_of((read, source), options, &NAMES, tell)
}

/// [`design_telling`] of a document that was read, with other names of arguments.
///
/// # Errors
/// Those of [`design`].
pub fn design_of(
    (read, source): (Read, Document),
    options: &DesignOptions,
    names: &DesignNames,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Design, Error> {
    let Some(over) = &options.choose else {
        let table = Table::new(Subject { read, source }, options, names, tell)?;
        return table.design(None, options.sampling_periods, tell);
    };
    let wrong = |error: sigmastar_studies::tune::TuneError| {
        Error::new(ErrorKind::Options, format!("{}: {error}", names.choose), &error.way_out())
    };
    let over = mu_by_the_period(over, read.period());
    let free: Vec<Parameter> = parameters(&over, &source, read.internal_model()).map_err(wrong)?;
    // What the values of the document are refused for, all are.
    Asked::new(&Subject { read, source: source.clone() }, options, names)?;
    let made = |values: &[String]| {
        let named = free.iter().zip(values).map(|(parameter, value)| format!("{} = {value}", parameter.name));
        tell(&format!("proving a table with {}", named.collect::<Vec<_>>().join(", ")));
        let document = with_values(&source, &free, values)?;
        let table = Table::new(Subject { read: Read::read(&document)?, source: document }, options, names, tell)?;
        Ok((Merit::of(&table.rows, &table.choice), table))
    };
    let (tried, table) = best_values(free.clone(), made, Error::sentence)?;
    table.design(Some(&tried), options.sampling_periods, tell)
}

/// What is asked of a document, read.
struct Asked {
    subject: Subject,
    counts: Vec<u32>,
    oscillators: Vec<Oscillators>,
    sigmas: Vec<Rational>,
    requirements: Requirements,
}

impl Asked {
    fn new(subject: &Subject, options: &DesignOptions, names: &DesignNames) -> Result<Asked, Error> {
        let [of_counts, of_sets, of_sigmas, of_step] = names.asked;
        let mut subject = subject.clone();
        let sets = options.harmonics.iter().map(|set| oscillators(of_sets, set)).collect::<Result<Vec<_>, _>>()?;
        if options.sampling_period.is_some() || !sets.is_empty() {
            let mut document = match &options.sampling_period {
                Some(step) => with_sampling_period(&subject.source, of_step, step)?,
                None => subject.source.clone(),
            };
            if !sets.is_empty() {
                document = for_every_set(&document)?;
            }
            subject.read = Read::read(&document)?;
        }
        if let Some([message, help]) = not_told_apart(&sets, &subject.read, of_sets) {
            return Err(Error::new(ErrorKind::Options, message, &help));
        }
        let read = &subject.read;
        let asked_counts = options.n_o.clone().unwrap_or_else(|| {
            // Those that the samples tell apart.
            let fits = |n_o: &u32| read.sampling().is_none_or(|sampling| 2 * n_o < sampling.samples);
            N_O.into_iter().filter(fits).collect()
        });
        let counts = rate_counts(&asked_counts).map_err(|reason| Error::no_rates(reason, of_counts))?;
        if counts.is_empty() {
            let message = format!("{of_counts}: a design table needs a number of oscillators, and there is none");
            return Err(Error::new(ErrorKind::Options, message, "ask for some, as 0,1,2,3"));
        }
        if let Some((sampling, n_o)) = read.sampling().zip(counts.last())
            && 2 * u64::from(*n_o) >= u64::from(sampling.samples)
        {
            return Err(Error::no_rates(NoRatesOfClaim::NotBelowHalf(*n_o, sampling.samples), of_counts));
        }
        let mut all: Vec<Oscillators> = counts.iter().copied().map(Oscillators::first).chain(sets).collect();
        // Of as many a number is before a set.
        all.sort_by_key(|one| (one.count(), one.n_o().is_none()));
        all.dedup();
        if all.len() > MAX_COUNTS {
            let message = format!(
                "{of_counts} and {of_sets}: {} numbers and sets; at most {MAX_COUNTS} go into one table",
                all.len()
            );
            return Err(Error::new(ErrorKind::Options, message, "ask for fewer"));
        }
        let mut sigmas: Vec<Rational> =
            options.sigmas.iter().map(|sigma| rational(of_sigmas, sigma)).collect::<Result<_, _>>()?;
        sigmas.sort();
        sigmas.dedup();
        if sigmas.len() > MAX_GAINS {
            let message = format!("{of_sigmas}: {} gains; at most {MAX_GAINS} go into one table", sigmas.len());
            return Err(Error::new(ErrorKind::Options, message, "ask for fewer"));
        }
        let of_periods = names.sampling_periods;
        if options.sampling_periods && read.sampling().is_some() {
            let message = format!("{of_periods}: the table is about samples that are given");
            return Err(Error::new(ErrorKind::Options, message, "leave it or the sampling period out"));
        }
        if options.sampling_periods && !read.is_matched() {
            let message = format!("{of_periods}: no regulator at samples is proved without a matched base frequency");
            return Err(Error::new(
                ErrorKind::Options,
                message,
                "leave it out; or state `matched`: true, with 2 pi over the period as the base frequency",
            ));
        }
        let requirements = requirements(read, options, names)?;
        Ok(Asked { subject, counts, oscillators: all, sigmas, requirements })
    }
}

/// A table with the pair to take.
struct Table {
    asked: Asked,
    period: Enclosure,
    rows: Vec<Row>,
    choice: Choice,
    taken: Taken,
    refused: Vec<(Rational, String)>,
}

impl Table {
    fn new(
        subject: Subject,
        options: &DesignOptions,
        names: &DesignNames,
        tell: &(dyn Fn(&str) + Sync),
    ) -> Result<Table, Error> {
        let asked = Asked::new(&subject, options, names)?;
        let read = &asked.subject.read;
        let period = read.period().shortest().enclose(DEFAULT_PRECISION);
        let run_options = Options { compare: false, ..Options::default() };
        let gains = AtGains::new(read, &asked.counts, run_options, &Unwatched).map_err(|all| Error::documents(&all))?;
        let mut claims = Proved {
            gains: &gains,
            options: run_options,
            oscillators: &asked.oscillators,
            asked: &asked.subject,
            simulate: options.simulate,
            limit: asked.requirements.steady_error.as_ref(),
            tell,
            certificates: Vec::new(),
            refused: Vec::new(),
        };
        let rows = design_table(&mut claims, (&asked.requirements, &period), &asked.sigmas)?;
        let Proved { certificates, mut refused, .. } = claims;
        let Some(choice) = choose(&rows, &asked.requirements, &period) else {
            let none =
                || Error::new(ErrorKind::NotCertified, "none of these gains is certified", "ask for larger ones");
            return Err(if refused.is_empty() { none() } else { refused.swap_remove(0).1 });
        };
        let refused = refused.into_iter().map(|(sigma, why)| (sigma, why.sentence())).collect();
        let taken = certificates.into_iter().find(|proved| proved.sigma == rows[choice.row].sigma);
        let no_certificate =
            || Error::new(ErrorKind::NotCertified, "the gain to take has no certificate", "report this");
        let taken = taken.ok_or_else(no_certificate)?;
        drop(gains);
        Ok(Table { asked, period, rows, choice, taken, refused })
    }

    /// The answer, with what was tried before it.
    fn design(
        self,
        values: Option<&ValuesTried>,
        periods: bool,
        tell: &(dyn Fn(&str) + Sync),
    ) -> Result<Design, Error> {
        let Table { asked: Asked { subject, requirements, .. }, period, rows, choice, taken, refused } = self;
        let Taken { sigma, certificate, in_words } = taken;
        let read = &subject.read;
        if periods {
            tell("seeking the longest sampling period of each gain");
        }
        let longest = periods.then(|| longest(read, &rows)).transpose()?;
        let report = DesignReport {
            rows: &rows,
            choice: &choice,
            requirements: &requirements,
            period: &period,
            refused: &refused,
            longest: longest.as_deref(),
            values,
            disturbed: has_disturbances(read),
            no_noise_with: excludes_noise(read),
            states_e0: read.states_e0(),
            leaves_sizes_open: read.leaves_sizes_open(),
            notes: certificate.remarks(),
            in_words: &in_words,
            sampling: read.sampling().map(|sampling| (sampling.text(), sampling.samples)),
            name: read.name(),
            sha256: read.sha256(),
        };
        let report = Report::of(&report);
        let Choice { row, cell, is_met, .. } = choice;
        let oscillators = cell.map(|cell| rows[row].cells[cell].oscillators.clone());
        let is_met = is_met || requirements.is_empty();
        Ok(Design { sigma: write_exact(&sigma), oscillators, is_met, certificate, report })
    }
}

/// The longest sampling periods that are certified with the gains of a table.
fn longest(read: &Read, rows: &[Row]) -> Result<Vec<Option<LongestPeriod>>, Error> {
    let gains: Vec<String> = rows.iter().map(|row| write_exact(&row.sigma)).collect();
    let gains: Vec<&str> = gains.iter().map(String::as_str).collect();
    let pairs = SamplingPairs::of_gains(read.clone(), &gains)?;
    Ok(rows.iter().map(|row| LongestPeriod::of(pairs.study(), &row.sigma)).collect())
}
