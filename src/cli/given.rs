//! A certificate that a command is given, as far as a regulator goes.

use super::failure::Failure;
use rug::Rational;
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, Enclosure};
use sigmastar_exact::number::write_exact;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{
    Constant, Document, Errors, InternalModel, Oscillators, SampledGain, Sampling, any_constant,
};
use sigmastar_prove::certificate::{claim_in_words, read_for, read_numbers, stated_with_noise};
use sigmastar_prove::certify::FarStart;
use sigmastar_prove::reduction::{FreeNumbers, Subject, WitnessData};
use sigmastar_regulator::export::{Provenance, Scope};

/// A certificate, as far as a regulator goes. What it says is taken as it is.
pub struct Given {
    sigma_star: Rational,
    /// The sampling period, K and Nb2, where it is about the regulator at samples: sigma* then is its only gain.
    sampled: Option<(Sampling, SampledGain)>,
    /// Whether it is about its gain alone because of an actuator.
    with_actuator: bool,
    /// Whether it is about every set of harmonics.
    every_set: bool,
    /// The oscillators of which it says something that counts rounding.
    rounding: Vec<Oscillators>,
    /// The digests that it states, of a specification and of a plant.
    made_for: [Option<String>; 2],
    /// All of it.
    document: Document,
}

impl Given {
    /// Reads sigma* and the digests.
    ///
    /// # Errors
    /// What cannot be read, in its place.
    pub fn read(document: &Document) -> Result<Given, Failure> {
        let (sigma_star, sampled) = match read_numbers(document)? {
            FreeNumbers::Sampled(witness) => (witness.sigma, Some((witness.sampling, witness.law))),
            FreeNumbers::Continuous(witness) => (witness.witness.sigma.clone(), None),
        };
        let text = |pointer: &str| document.at(pointer).and_then(|value| value.text().map(str::to_owned));
        let made_for = ["/specification_sha256", "/plant_sha256"].map(text);
        let with_actuator = document.at("/claim/actuator").is_some();
        let every_set = document.at("/claim/harmonics").is_some();
        let in_doubles = ["/specification/arithmetic", "/plant/arithmetic"]
            .into_iter()
            .any(|pointer| text(pointer).as_deref() == Some("double"));
        let rounding = if in_doubles { stated_with_noise(document) } else { Vec::new() };
        Ok(Given { sigma_star, sampled, with_actuator, every_set, rounding, made_for, document: document.clone() })
    }

    /// sigma*, rounded up to a double: the gain that is exported is certified too. Of the regulator at samples, and with an actuator,
    /// exactly its gain.
    pub fn gain(&self) -> Option<Constant> {
        if self.sampled.is_some() || self.with_actuator {
            return Some(Constant::rational(&self.sigma_star));
        }
        let up = Enclosure::from_rational(&self.sigma_star, DEFAULT_PRECISION).upper_f64();
        Rational::from_f64(up).map(|gain| Constant::rational(&gain))
    }

    /// Its gain, as it states it.
    pub fn sigma(&self) -> &Rational {
        &self.sigma_star
    }

    /// The sampling period, where it is about the regulator at samples.
    pub fn step(&self) -> Option<&Constant> {
        self.sampled.as_ref().map(|(sampling, _)| &sampling.step)
    }

    /// Whether its law has a delay, where it is about the regulator at samples.
    pub fn delayed(&self) -> Option<bool> {
        self.sampled.as_ref().map(|(sampling, _)| sampling.delayed)
    }

    /// Whether this regulator is the one at samples that it is about: the same gain, sampling period, delay, K and Nb2, exactly, and few
    /// enough oscillators. `None` where it is about the regulator in continuous time.
    fn covers_samples(&self, regulator: &Regulated<'_>) -> Option<bool> {
        let (sampling, law) = self.sampled.as_ref()?;
        let same_step = regulator.step.is_some_and(|step| sampling.is(step)) && regulator.delayed == sampling.delayed;
        let same_law = regulator.step.and_then(|step| regulator.model.sampled_gain(step)).as_ref() == Some(law);
        let same_gain = regulator.sigma.as_rational() == Some(&self.sigma_star);
        Some(
            same_step
                && same_law
                && same_gain
                && 2 * u64::from(regulator.oscillators.largest()) < u64::from(sampling.samples),
        )
    }

    /// Whether it says something of this number of oscillators alone, beside its claim for every one: a rate, or bounds.
    pub fn says_of(&self, n_o: u32) -> bool {
        let number = |pointer: &str| self.document.at(pointer).and_then(|value| value.integer(&mut Errors::new()).ok());
        let entries = |part: &'static str| {
            (0..).map(move |i| format!("/claim/{part}/{i}")).take_while(|entry| self.document.at(entry).is_some())
        };
        let is_about = |entry: String| {
            let or_more = self
                .document
                .at(&format!("{entry}/or_more"))
                .is_some_and(|value| value.boolean(&mut Errors::new()) == Ok(true));
            number(&format!("{entry}/n_o"))
                .is_some_and(|own| own == u64::from(n_o) || (or_more && own < u64::from(n_o)))
        };
        ["for_n_o", "by_n_o"].into_iter().flat_map(entries).any(is_about)
    }

    /// Where a simulation of its plant starts, far outside of its set.
    pub fn far_start(&self, plant: &Plant) -> Option<FarStart> {
        let size = |name: &str| {
            let value = self.document.at(&format!("/claim/initial_set/{name}"))?;
            any_constant(&value, &mut Errors::new()).ok()?.as_rational().cloned()
        };
        let set = [size("X0").unwrap_or_default(), size("E0")?];
        let witness = read_for(&self.document, &Subject::Plant(Box::new(plant.clone()))).ok()?;
        match &witness.data {
            WitnessData::OfPlant(parts) => FarStart::of(&parts.0, &plant.initial, set.each_ref()),
            WitnessData::Given | WitnessData::Triples(_) => None,
        }
    }

    /// Whether it was made for the document with this digest.
    pub fn is_about(&self, sha256: &str) -> bool {
        self.made_for.iter().flatten().any(|digest| digest == sha256)
    }

    /// Its part in the export of a regulator: its claim in words that are made of its numbers, whatever the words are that it holds.
    ///
    /// # Errors
    /// What cannot be read of the claim, in its place.
    pub fn provenance(&self, regulator: &Regulated<'_>) -> Result<Provenance, Failure> {
        let sigma = regulator.sigma;
        let covers_sigma = || match sigma.as_rational() {
            Some(sigma) => *sigma >= self.sigma_star,
            None => {
                let sigma_star = Enclosure::from_rational(&self.sigma_star, DEFAULT_PRECISION);
                sigma.enclose(DEFAULT_PRECISION).ge(&sigma_star).is_true()
            }
        };
        Ok(Provenance {
            sha256: self.document.root().sha256(),
            sigma_star: write_exact(&self.sigma_star),
            one_gain: self.sampled.is_some() || self.with_actuator,
            statement: claim_in_words(&self.document)?,
            rounding: self.rounding.iter().find(|stated| *stated == regulator.oscillators).cloned(),
            scope: match self.covers_samples(regulator) {
                Some(true) | None if !self.every_set && regulator.oscillators.n_o().is_none() => {
                    Scope::OtherHarmonics { at_samples: self.sampled.is_some() }
                }
                Some(true) => Scope::Samples,
                Some(false) => Scope::OtherSamples,
                None if self.with_actuator => match sigma.as_rational() {
                    Some(sigma) if *sigma == self.sigma_star => Scope::Continuous,
                    _ => Scope::OtherGain,
                },
                None if covers_sigma() => Scope::Continuous,
                None => Scope::BelowSigmaStar,
            },
        })
    }
}

/// The regulator that is asked for.
pub struct Regulated<'a> {
    /// The internal model.
    pub model: &'a InternalModel,
    /// The gain.
    pub sigma: &'a Constant,
    /// The sampling period, if any.
    pub step: Option<&'a Constant>,
    /// Whether its law at samples has a delay.
    pub delayed: bool,
    /// Its oscillators.
    pub oscillators: &'a Oscillators,
}
