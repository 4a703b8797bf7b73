//! What is asked of a design table.

use super::super::error::{Error, ErrorKind};
use super::super::{at_argument, rational, steady_error};
use rug::Rational;
use sigmastar_lang::spec::{Constant, Document};
use sigmastar_prove::certify::NoRatesOfClaim;
use sigmastar_prove::reduction::Subject as Read;
use sigmastar_studies::design::Requirements;

/// The numbers of oscillators where none are asked for.
pub(super) const N_O: [u32; 5] = [0, 1, 2, 3, 5];

/// The most gains of one call.
pub(super) const MAX_GAINS: usize = 20;

/// What is required of a loop, and of which table. The defaults are those of `sigmastar design`.
///
/// The requirements are about the loop with the noise, the disturbance and the rounding that the document states. With an `actuator` or `delay_samples` 1 in
/// the document nothing is proved about these, and the requirements are about the loop without them.
///
/// ```
/// use sigmastar::DesignOptions;
/// let options = DesignOptions::new().steady_error("1/10").peak_error("2").n_o([0, 2, 4]);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DesignOptions {
    pub(super) n_o: Option<Vec<u32>>,
    pub(super) harmonics: Vec<Vec<u32>>,
    pub(super) sigmas: Vec<String>,
    pub(super) sampling_period: Option<String>,
    /// Of the steady error, the peak, the control, the periods to settle, the noise.
    pub(super) required: [Option<String>; 5],
    pub(super) simulate: bool,
    pub(super) sampling_periods: bool,
    pub(super) choose: Option<String>,
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
            harmonics: Vec::new(),
            sigmas: Vec::new(),
            sampling_period: None,
            required: [const { None }; 5],
            simulate: true,
            sampling_periods: false,
            choose: None,
        }
    }

    /// The numbers of oscillators of the table (at most 8, up to 100).
    #[must_use]
    pub fn n_o(mut self, counts: impl Into<Vec<u32>>) -> DesignOptions {
        self.n_o = Some(counts.into());
        self
    }

    /// Oscillators at these harmonics in the table, too, of 0 and at most 100 others up to 100; several times for several sets. Each row is about every finite set
    /// of harmonics that contains 0 then, as with [`CertifyOptions::harmonics`](crate::CertifyOptions::harmonics). Numbers and sets are 8 together at most.
    #[must_use]
    pub fn harmonics(mut self, set: impl Into<Vec<u32>>) -> DesignOptions {
        self.harmonics.push(set.into());
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

    /// |e| of the periodic solution, with noise the limit superior of |e|, is to be at most this, a positive rational number.
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

    /// |e - e_per| in the limit, with the noise, disturbance and rounding of the document, is to be at most this, a positive rational number. Refused where
    /// the document states none, or something with which nothing is proved about them.
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

    /// Whether the longest sampling period that is certified with each gain stands beside it (default: no). For a document about continuous time with a
    /// matched base frequency.
    #[must_use]
    pub fn sampling_periods(mut self, periods: bool) -> DesignOptions {
        self.sampling_periods = periods;
        self
    }

    /// The numbers of the document that are to be chosen, as [`TuneOptions::over`](crate::TuneOptions::over) names them: `mu`, or `mu=1/10..10,n0`. A table
    /// is made of the values of the document, and then, number by number, of four others. Best is what misses the fewest requirements, then what has the
    /// largest rate. The range of `mu` is from 1/T to 8/T where none is given, with the period T.
    #[must_use]
    pub fn choose(mut self, numbers: impl Into<String>) -> DesignOptions {
        self.choose = Some(numbers.into());
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
    /// The numbers of oscillators, the sets of harmonics, the gains, the sampling period.
    pub asked: [&'static str; 4],
    /// The requirements.
    pub required: [&'static str; 5],
    /// The numbers to choose.
    pub choose: &'static str,
    /// The longest sampling periods.
    pub sampling_periods: &'static str,
}

pub(super) const NAMES: DesignNames = DesignNames {
    asked: ["`n_o`", "harmonics", "sigmas", "sampling_period"],
    required: ["steady_error", "peak_error", "max_control", "settle", "noise"],
    choose: "choose",
    sampling_periods: "sampling_periods",
};

pub(super) fn requirements(
    subject: &Read,
    options: &DesignOptions,
    names: &DesignNames,
) -> Result<Requirements, Error> {
    let value =
        |which: usize| options.required[which].as_ref().map(|text| rational(names.required[which], text)).transpose();
    let text = options.required[0].as_ref();
    let of_steady = text.map(|text| steady_error(names.required[0], text)).transpose()?;
    let requirements = Requirements {
        steady_error: of_steady,
        peak_error: value(1)?,
        control: value(2)?,
        settling: periods(names.required[3], options.required[3].as_deref(), subject.period().nominal())?,
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
    if let Some(other) = excludes_noise(subject).filter(|_| requirements.noise.is_some()) {
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

/// A number of periods: where the text has a unit it is a time, which is told.
fn periods(name: &str, text: Option<&str>, period: &Constant) -> Result<Option<Rational>, Error> {
    let Some(text) = text else { return Ok(None) };
    rational(name, text).map(Some).map_err(|error| {
        if error.kind() != ErrorKind::Expression {
            return error;
        }
        let help =
            format!("{name} counts periods and has no unit: divide a time by the period, which is {}", period.text);
        let told = error.sources().iter().flat_map(|told| told.errors()).map(|told| told.clone().help(help.clone()));
        at_argument((name, &Document::flag(name, text)), told)
    })
}

/// What of a document excludes bounds with noise.
pub(super) fn excludes_noise(subject: &Read) -> Option<&'static str> {
    match subject.sampling() {
        Some(sampling) if sampling.delayed => Some("`delay_samples`"),
        _ => subject.actuator().map(|_| "an `actuator`"),
    }
}

/// Whether something is stated that moves e in the limit; at samples rounding is such a thing.
pub(super) fn has_disturbances(subject: &Read) -> bool {
    subject.disturbances().disturb(subject.sampling().is_some())
}
