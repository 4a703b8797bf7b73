//! What a run of [`certify`](super::certify) does.

use super::error::{Error, ErrorKind};
use super::{rational, steady_error};
use rug::Rational;
use sigmastar_decide::conditions::Ladder;
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, MAX_PRECISION};
use sigmastar_lang::spec::Oscillators;
use sigmastar_prove::certify::{Limits, TransferChoice, rate_counts};
use sigmastar_prove::rate::bound::MAX_OSCILLATORS;

pub use sigmastar_prove::certify::Options;

/// What a run of [`certify`](sigmastar_prove::certify) does. The defaults are those of the command `sigmastar certify`.
///
/// ```
/// use sigmastar::CertifyOptions;
/// let options = CertifyOptions::new().precision_limit(512).compare(false);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct CertifyOptions {
    transfer: TransferChoice,
    precision_limit: u32,
    compare: bool,
    sigma: Option<String>,
    sampling_period: Option<String>,
    n_o: Vec<u32>,
    harmonics: Vec<Vec<u32>>,
    /// Of the steady error, of the error in the transient, of the control, of the rates.
    limits: [Option<String>; 4],
}

/// Options that are in range.
pub(super) struct Asked {
    pub(super) options: Options,
    pub(super) gain: Option<Rational>,
    pub(super) step: Option<String>,
    pub(super) counts: Vec<u32>,
    pub(super) sets: Vec<Oscillators>,
    pub(super) limits: Limits,
}

impl Default for CertifyOptions {
    fn default() -> CertifyOptions {
        CertifyOptions {
            transfer: TransferChoice::default(),
            precision_limit: MAX_PRECISION,
            compare: true,
            sigma: None,
            sampling_period: None,
            n_o: Vec::new(),
            harmonics: Vec::new(),
            limits: [const { None }; 4],
        }
    }
}

impl CertifyOptions {
    /// The smallest limit of the working precision, in bits.
    pub const LEAST_PRECISION_LIMIT: u32 = DEFAULT_PRECISION;

    /// The largest limit of the working precision, in bits.
    pub const LARGEST_PRECISION_LIMIT: u32 = MAX_PRECISION;

    /// The defaults.
    #[must_use]
    pub fn new() -> CertifyOptions {
        CertifyOptions::default()
    }

    /// The proof of the transfer bound (default: [`TransferChoice::Best`]).
    #[must_use]
    pub fn transfer(mut self, transfer: TransferChoice) -> CertifyOptions {
        self.transfer = transfer;
        self
    }

    /// The precision in bits at which an undecided condition is given up (default: 1024). It is to lie between
    /// [`CertifyOptions::LEAST_PRECISION_LIMIT`] and [`CertifyOptions::LARGEST_PRECISION_LIMIT`]; `certify` refuses
    /// others.
    #[must_use]
    pub fn precision_limit(mut self, bits: u32) -> CertifyOptions {
        self.precision_limit = bits;
        self
    }

    /// Whether what else would give is worked out too, as bounds at larger gains and what intervals of parameters cost, for a plant also the bounds by the
    /// number of oscillators, and the repaired derivation, whose free numbers are in the certificate (default: yes). Without it a run is faster, and
    /// the claim is the same or nearly so. Bounds by the number of oscillators are worked out without it where a limit needs them.
    #[must_use]
    pub fn compare(mut self, compare: bool) -> CertifyOptions {
        self.compare = compare;
        self
    }

    /// Certify this gain, a positive rational number, and not the smallest one found.
    #[must_use]
    pub fn sigma(mut self, sigma: impl Into<String>) -> CertifyOptions {
        self.sigma = Some(sigma.into());
        self
    }

    /// Certify the regulator at samples this far apart, an exact positive constant of which the period is a whole multiple. It
    /// takes the place of `sampling_period` in the document.
    ///
    /// ```
    /// use sigmastar::CertifyOptions;
    /// let options = CertifyOptions::new().sampling_period("1/500").sigma("50");
    /// ```
    #[must_use]
    pub fn sampling_period(mut self, period: impl Into<String>) -> CertifyOptions {
        self.sampling_period = Some(period.into());
        self
    }

    /// Prove for each of these numbers of oscillators (at most 8, up to 100), at the gain of the claim alone, a rate and a factor with
    /// `|e - e_per| <= factor exp(-rate (t - t_0))` in the undisturbed loop, and put them into the certificate; at samples at the sampling instants, of a claim by norms. Bounds by
    /// the number of oscillators, where there are some, are for these too.
    ///
    /// ```
    /// use sigmastar::CertifyOptions;
    /// let options = CertifyOptions::new().n_o([0, 4, 10]);
    /// ```
    #[must_use]
    pub fn n_o(mut self, counts: impl Into<Vec<u32>>) -> CertifyOptions {
        self.n_o = counts.into();
        self
    }

    /// Certify for every finite set of harmonics that contains 0, and put bounds for oscillators at these into the certificate where they are proved, and a rate
    /// and a factor as [`CertifyOptions::n_o`] does, but with a delay; several times for several sets, each of 0 and at most 100 others up to 100. With the
    /// numbers of oscillators there are at most 8. It takes the place of `harmonics` in the document.
    ///
    /// ```
    /// use sigmastar::CertifyOptions;
    /// let options = CertifyOptions::new().harmonics([0, 1, 5, 7, 11, 13]);
    /// ```
    #[must_use]
    pub fn harmonics(mut self, set: impl Into<Vec<u32>>) -> CertifyOptions {
        self.harmonics.push(set.into());
        self
    }

    /// Certify a gain that keeps |e| of the periodic solution at most this, a positive rational number (the smallest found), for
    /// every number of oscillators, or for those of [`CertifyOptions::n_o`], where there are some, which often needs a far smaller gain. Without
    /// [`CertifyOptions::rate`] bounds by the number of oscillators count, too. With [`CertifyOptions::sigma`] refuse a gain with which that is not proved.
    #[must_use]
    pub fn steady_error(self, limit: impl Into<String>) -> CertifyOptions {
        self.limited(0, limit.into())
    }

    /// Certify a gain that keeps |e| at all times from the initial set at most this, a positive rational number (the smallest found), in the same
    /// way; with [`CertifyOptions::sigma`] refuse a gain with which that is not proved.
    #[must_use]
    pub fn peak_error(self, limit: impl Into<String>) -> CertifyOptions {
        self.limited(1, limit.into())
    }

    /// Certify a gain that keeps the control, with an input gain over the nominal one, at all times from the initial set at most this, a
    /// positive rational number (the smallest found), in the same way. The bound grows with the gain. With [`CertifyOptions::sigma`] refuse a gain with which that is not proved.
    #[must_use]
    pub fn max_control(self, limit: impl Into<String>) -> CertifyOptions {
        self.limited(2, limit.into())
    }

    /// Certify a gain with which the rates for the numbers of [`CertifyOptions::n_o`] are at least this, a positive rational number, in 1/time
    /// (the smallest found); with [`CertifyOptions::sigma`] refuse a gain with which that is not proved.
    #[must_use]
    pub fn rate(self, least: impl Into<String>) -> CertifyOptions {
        self.limited(3, least.into())
    }

    fn limited(mut self, which: usize, limit: String) -> CertifyOptions {
        self.limits[which] = Some(limit);
        self
    }

    /// What goes for every run, for the layers below; that the limit of the precision is in range is for who sets it.
    #[doc(hidden)]
    #[must_use]
    pub fn of_run(&self) -> Options {
        Options {
            transfer: self.transfer,
            ladder: Ladder { start: DEFAULT_PRECISION, limit: self.precision_limit },
            compare: self.compare,
        }
    }

    /// All of them, for the layers below.
    ///
    /// # Errors
    /// A limit of the precision out of range, and texts that are no such constants.
    pub(super) fn checked(&self) -> Result<Asked, Error> {
        let range = CertifyOptions::LEAST_PRECISION_LIMIT..=CertifyOptions::LARGEST_PRECISION_LIMIT;
        if !range.contains(&self.precision_limit) {
            let message = format!("precision_limit: {} bits are out of range", self.precision_limit);
            let help = format!("choose {} to {} bits", range.start(), range.end());
            return Err(Error::new(ErrorKind::Range, message, &help));
        }
        let options = self.of_run();
        let gain = self.sigma.as_ref().map(|text| rational("sigma", text)).transpose()?;
        let counts = rate_counts(&self.n_o).map_err(|reason| Error::no_rates(reason, "`n_o`"))?;
        let sets = self.harmonics.iter().map(|set| oscillators("harmonics", set)).collect::<Result<_, _>>()?;
        let limit = |name, text: &Option<String>| text.as_ref().map(|text| rational(name, text)).transpose();
        let [steady, peak, control, rate] = &self.limits;
        let limits = Limits {
            steady_error: steady.as_ref().map(|text| steady_error("steady_error", text)).transpose()?,
            peak_error: limit("peak_error", peak)?,
            control: limit("max_control", control)?,
            rate: limit("rate", rate)?,
            ..Limits::default()
        };
        if limits.rate.is_some() && counts.is_empty() {
            let help = "say with n_o for which numbers of oscillators";
            return Err(Error::new(
                ErrorKind::Options,
                "rate: a rate is one for given n_o, and none is given".to_owned(),
                help,
            ));
        }
        Ok(Asked { options, gain, step: self.sampling_period.clone(), counts, sets, limits })
    }
}

/// The set of these harmonics; `option` is what the argument is called.
pub(super) fn oscillators(option: &str, set: &[u32]) -> Result<Oscillators, Error> {
    let wrong = |message: String, help: &str| Error::new(ErrorKind::Options, format!("{option}: {message}"), help);
    let found =
        Oscillators::at(set).map_err(|error| wrong(error.to_string(), "give each harmonic once, 0 among them"))?;
    if found.largest() > MAX_OSCILLATORS {
        return Err(wrong(format!("{} is beyond {MAX_OSCILLATORS}", found.largest()), "give smaller harmonics"));
    }
    Ok(found)
}
