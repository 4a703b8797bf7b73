//! Rates of convergence.

use super::certify::not_certified;
use super::error::{Error, ErrorKind};
use super::report::Report;
use super::subject::Subject;
use super::{rational, rounded_down};
use rug::Rational;
use sigmastar_exact::number::write_exact;
use sigmastar_prove::certify::{
    Options, Verdict, WITHOUT_INPUT_GAIN, Wanted, certify_for, not_available_with_input_gain,
};
use sigmastar_prove::reduction::Run;
use sigmastar_report::RateReport;
use sigmastar_studies::rate::{self, MAX_OSCILLATORS, NoRates, certified_rates};

pub use sigmastar_studies::rate::Method as RateMethod;

/// Rates of convergence at one gain, for several numbers of oscillators. They are no part of a certificate, and no independent
/// program checks them.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Rates {
    sigma: String,
    sigma_star: String,
    rates: Vec<Rate>,
    report: Report,
}

/// What is proved for one number of oscillators, in 1/time. `None` says that nothing was proved, not that there is none.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Rate {
    n_o: u32,
    closed_loop: Option<(String, f64, RateMethod)>,
    oscillators: Option<(String, f64)>,
    spectral: Option<f64>,
}

impl Rates {
    /// The most oscillators for which rates are worked out.
    pub const MAX_OSCILLATORS: u32 = MAX_OSCILLATORS;

    /// The gain, exactly.
    #[must_use]
    pub fn sigma(&self) -> &str {
        &self.sigma
    }

    /// The certified gain, exactly.
    #[must_use]
    pub fn sigma_star(&self) -> &str {
        &self.sigma_star
    }

    /// One for each number of oscillators that was asked for, in that order.
    #[must_use]
    pub fn rates(&self) -> &[Rate] {
        &self.rates
    }

    /// The report of `sigmastar rate`.
    #[must_use]
    pub fn report(&self) -> &Report {
        &self.report
    }
}

impl Rate {
    fn new(rates: &rate::Rates) -> Rate {
        let both = |rate: &Rational| (write_exact(rate), rounded_down(rate));
        Rate {
            n_o: rates.n_o,
            closed_loop: rates.closed_loop.as_ref().map(|(rate, method)| {
                let (exact, down) = both(rate);
                (exact, down, *method)
            }),
            oscillators: rates.oscillators.as_ref().map(both),
            spectral: rates.spectral,
        }
    }

    /// The number of oscillators.
    #[must_use]
    pub fn n_o(&self) -> u32 {
        self.n_o
    }

    /// A proved rate at which every solution from the certified initial set approaches the periodic solution, exactly.
    #[must_use]
    pub fn closed_loop(&self) -> Option<&str> {
        self.closed_loop.as_ref().map(|(exact, ..)| exact.as_str())
    }

    /// A proved rate at which every solution from the certified initial set approaches the periodic solution, rounded down.
    #[must_use]
    pub fn closed_loop_f64(&self) -> Option<f64> {
        self.closed_loop.as_ref().map(|(_, down, _)| *down)
    }

    /// How it was proved.
    #[must_use]
    pub fn method(&self) -> Option<RateMethod> {
        self.closed_loop.as_ref().map(|(.., method)| *method)
    }

    /// A proved decay rate of the oscillators by themselves, exactly.
    #[must_use]
    pub fn oscillators(&self) -> Option<&str> {
        self.oscillators.as_ref().map(|(exact, _)| exact.as_str())
    }

    /// A proved decay rate of the oscillators by themselves, rounded down.
    #[must_use]
    pub fn oscillators_f64(&self) -> Option<f64> {
        self.oscillators.as_ref().map(|(_, down)| *down)
    }

    /// Minus the spectral abscissa of the oscillators: floating point, no claim.
    #[must_use]
    pub fn spectral_estimate(&self) -> Option<f64> {
        self.spectral
    }
}

/// Certifies a specification or plant and proves rates of convergence for some numbers of oscillators, at the gain sigma, an
/// exact rational number of at least sigma*, or at sigma* itself.
///
/// # Errors
/// Those of [`certify`](sigmastar_prove::certify); [`Range`](ErrorKind::Range) for a gain below sigma* and beyond
/// [`Rates::MAX_OSCILLATORS`]; [`Undecided`](ErrorKind::Undecided) where no plant with a state has these data.
pub fn rates(subject: impl Into<Subject>, sigma: Option<&str>, n_o: &[u32]) -> Result<Rates, Error> {
    found(subject.into(), sigma, n_o)
}

fn found(subject: Subject, sigma: Option<&str>, n_o: &[u32]) -> Result<Rates, Error> {
    if let Some(n_o) = n_o.iter().find(|n_o| **n_o > MAX_OSCILLATORS) {
        let help = format!("choose at most {MAX_OSCILLATORS}");
        return Err(Error::new(ErrorKind::Range, format!("n_o: {n_o} oscillators are too many"), &help));
    }
    let sigma = sigma.map(|text| rational("sigma", text)).transpose()?;
    let (spec, start) = subject.read.proved().map_err(|all| Error::documents(&all))?;
    let options = Options { compare: false, ..Options::default() };
    let wanted = Wanted { start: start.as_ref(), ..Wanted::default() };
    let run = certify_for(&spec, options, wanted).map_err(|refusal| Error::documents(&refusal.errors(&spec)))?;
    let (sigma, rates) = match certified_rates(&run, sigma, n_o) {
        Ok(found) => found,
        Err(NoRates::BelowSigmaStar(sigma_star)) => {
            let message = format!("sigma is below the certified sigma* = {}", write_exact(&sigma_star));
            let help = "give a gain of at least sigma*, or none for sigma* itself";
            return Err(Error::new(ErrorKind::Range, message, help));
        }
        Err(NoRates::OtherGain(sigma)) => {
            let message = format!("with `actuator` only sigma = {} is certified", write_exact(&sigma));
            return Err(Error::new(ErrorKind::Range, message, "give no gain, or leave `actuator` out"));
        }
        Err(NoRates::InputGain) => {
            let message = not_available_with_input_gain("a rate of convergence");
            return Err(Error::new(ErrorKind::NotAvailable, message, WITHOUT_INPUT_GAIN));
        }
        Err(NoRates::NotCertified(_)) => return Err(not_certified(&Run::Continuous(Box::new(run)))),
        Err(NoRates::NoPlant(reason)) => {
            let help = "look at the remarks of the certificate: its data are of no plant with a state";
            return Err(Error::new(ErrorKind::Undecided, format!("{}: {reason}", Verdict::Undecided), help));
        }
    };
    let (Some(sigma_star), Some(report)) = (run.sigma_star(), RateReport::new(&run, &sigma, rates.clone())) else {
        return Err(not_certified(&Run::Continuous(Box::new(run))));
    };
    Ok(Rates {
        sigma: write_exact(&sigma),
        sigma_star: write_exact(sigma_star),
        rates: rates.iter().map(Rate::new).collect(),
        report: Report::of(&report),
    })
}
