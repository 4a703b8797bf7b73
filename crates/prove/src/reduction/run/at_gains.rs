//! One subject at several gains, each a claim of its own with bounds for given numbers of oscillators (derivation, 13.5, 14).

use super::seeking::Search;
use super::{Prepared, Subject, Watch};
use crate::certify::{Limits, Options};
use rug::Rational;
use sigmastar_lang::spec::SpecErrors;

/// A subject, and what is proved of it for the smallest gain that is found.
pub struct AtGains<'q> {
    subject: &'q Subject,
    counts: &'q [u32],
    options: Options,
    watch: &'q dyn Watch,
    smallest: Prepared,
}

impl<'q> AtGains<'q> {
    /// Proves the data of a subject for the smallest gain. Bounds will be sought for these numbers of oscillators.
    ///
    /// # Errors
    /// Those of [`Prepared::new`].
    pub fn new(
        subject: &'q Subject,
        counts: &'q [u32],
        options: Options,
        watch: &'q dyn Watch,
    ) -> Result<AtGains<'q>, Vec<SpecErrors>> {
        let smallest = search((subject, counts), &Limits::default(), options, watch).at(None)?;
        Ok(AtGains { subject, counts, options, watch, smallest })
    }

    /// What is prepared for the smallest gain. With an actuator it is the smallest that keeps to that.
    #[must_use]
    pub fn smallest(&self) -> Prepared {
        self.keeping(self.asked(self.smallest.clone()), None)
    }

    /// What is prepared, or what keeps to an actuator by the number of oscillators ([`Prepared::keeping_actuator`]).
    fn keeping(&self, prepared: Prepared, gain: Option<Rational>) -> Prepared {
        prepared.keeping_actuator(self.subject, gain, (&Limits::default(), self.counts), self.options, self.watch)
    }

    /// What is prepared for a gain: in continuous time with the data of the smallest one, at samples and where these are for larger gains with data of its own.
    ///
    /// # Errors
    /// Those of [`Prepared::new`].
    pub fn at(&self, gain: &Rational) -> Result<Prepared, Vec<SpecErrors>> {
        let prepared = match self.subject.sampling() {
            None if self.smallest.reaches(Some(gain)) => Prepared { gain: Some(gain.clone()), ..self.smallest.clone() },
            _ => search((self.subject, self.counts), &Limits::default(), self.options, self.watch)
                .at(Some(gain.clone()))?,
        };
        Ok(self.keeping(self.asked(prepared), Some(gain.clone())))
    }

    fn asked(&self, prepared: Prepared) -> Prepared {
        let limits = Limits { by_count: Some(self.counts.to_vec()), ..Limits::default() };
        Prepared { counts: self.counts.to_vec(), ..prepared.within(limits, self.watch) }
    }
}

fn search<'q>(
    (subject, counts): (&'q Subject, &'q [u32]),
    limits: &'q Limits,
    options: Options,
    watch: &'q dyn Watch,
) -> Search<'q> {
    Search { subject, limits, counts, options: Options { compare: false, ..options }, rows: true, watch }
}
