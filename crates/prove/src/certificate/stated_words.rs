//! The claim of a certificate in words of this program: what it holds as its statement is for people, and anybody may have written it.

use super::by_count::counts_in_words;
use super::fields::{exact_rational, rational};
use super::read::{each, read_oscillators};
use super::stated::{StatedClaim, read_claim};
use super::words::{at_samples, in_continuous_time};
use crate::certify::{SaidOfCount, rates_in_words};
use crate::reduction::FreeNumbers;
use rug::Rational;
use sigmastar_lang::spec::{Document, Object, Oscillators, Reported, SpecErrors};

/// The claim of a certificate in words, from its numbers: the sentence that it holds is for people, and not looked at.
///
/// # Errors
/// Those of [`read_claim`]; rates of given numbers of oscillators that cannot be read.
pub fn claim_in_words(certificate: &Document) -> Result<String, SpecErrors> {
    let StatedClaim { spec, witness, .. } = read_claim(certificate)?;
    let rates = stated_rates(certificate)?;
    let said = rates.iter().map(|StatedRate { oscillators, numbers: [rate, factor], noise }| SaidOfCount {
        oscillators,
        rate,
        factor,
        noise: noise.as_ref().map(|[peak, limit]| [peak, limit]),
    });
    let ball = stated_ball(certificate)?;
    let reach = (ball.as_ref(), certificate.at("/claim/harmonics").is_some());
    let (sigma, samples, words) = match &witness {
        FreeNumbers::Sampled(witness) => {
            (&witness.sigma, Some(witness.sampling.samples), at_samples(&spec, witness, reach))
        }
        FreeNumbers::Continuous(given) => {
            let witness = &given.witness;
            (&witness.sigma, None, in_continuous_time(&spec, &witness.sigma, &witness.set, reach))
        }
    };
    let counts = certificate.at("/claim/by_n_o").map(|part| part.to_json()).unwrap_or_default();
    let of_rates = rates_in_words(&spec, sigma, samples.is_some(), said);
    Ok(words + &of_rates + &counts_in_words(&spec, (sigma, samples), &counts))
}

/// What a certificate states of some oscillators.
struct StatedRate {
    oscillators: Oscillators,
    /// The rate and the factor.
    numbers: [Rational; 2],
    /// The peak and the limit under noise.
    noise: Option<[Rational; 2]>,
}

/// The ball that the set contains, of a plant with states.
fn stated_ball(certificate: &Document) -> Result<Option<Rational>, SpecErrors> {
    let value = certificate.at("/claim/initial_set/ball");
    certificate.root().read(|_, errors| value.map(|value| exact_rational(&value, "`ball`", errors)).transpose())
}

fn stated_rates(certificate: &Document) -> Result<Vec<StatedRate>, SpecErrors> {
    certificate.root().read(|root, errors| {
        let two = |fields: &mut Object<'_>, names: [&'static str; 2], errors: &mut _| -> Result<_, Reported> {
            let [a, b] = names.map(|name| rational(fields, name, errors));
            Ok([a?, b?])
        };
        let rates = root.member("claim").and_then(|claim| claim.member("for_n_o"));
        let one = |fields: &mut Object<'_>, errors: &mut _| {
            let noise = fields.optional("noise").map(|value| {
                let mut fields = value.object(errors)?;
                let numbers = two(&mut fields, ["peak", "limit"], errors);
                fields.finish(errors);
                numbers
            });
            let oscillators = read_oscillators(fields, errors);
            Ok(StatedRate {
                oscillators: oscillators?,
                numbers: two(fields, ["rate", "factor"], errors)?,
                noise: noise.transpose()?,
            })
        };
        rates.map_or_else(|| Ok(Vec::new()), |rates| each(&rates, errors, one))
    })
}
