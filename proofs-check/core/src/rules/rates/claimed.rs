//! What a claim says of given oscillators, the first n_o or those at a set of harmonics, as it is written and in words (docs/mathematics.md, section 13.6).

use crate::json::{Field, Fields};
use crate::noise::{Noise, apart};
use crate::rules::by_n_o::oscillators::Oscillators;
use crate::verdict::{Outcome, bad};
use rug::Rational;

/// The name of the rule.
pub const RULE: &str = "rates";

/// That `|e - e_per| <= factor exp(-rate (t - t_0))` with these oscillators, at the gain of the claim; at samples for the sampling instants t.
pub struct Rate<'a> {
    pub pointer: String,
    pub oscillators: Oscillators,
    pub rate: Rational,
    pub factor: Rational,
    pub noise: Option<Limits<'a>>,
    /// The two numbers as they are written.
    texts: [&'a str; 2],
}

/// That with the noise of the file `|e - e_per| <= peak` at all times, and its limit superior is at most `limit`.
pub struct Limits<'a> {
    pub pointer: String,
    pub limit: Rational,
    pub peak: Rational,
    texts: [&'a str; 2],
}

impl<'a> Rate<'a> {
    /// Reads the part `for_n_o`: each n_o once, in order, and then each set once.
    pub fn read_all(field: &Field<'a>) -> Outcome<Vec<Rate<'a>>> {
        let mut rates: Vec<Rate<'a>> = Vec::new();
        for field in field.elements()? {
            let mut fields = field.fields()?;
            let oscillators = Oscillators::take(&mut fields)?;
            if oscillators.n_o().is_none() && oscillators.next() == oscillators.largest() + 1 {
                return bad(&oscillators.place(&field.pointer), "expected `n_o`, for a set without a gap");
            }
            oscillators.demand_order(rates.iter().map(|before| &before.oscillators), &field.pointer)?;
            let ([rate, factor], texts) = written(&mut fields, ["rate", "factor"])?;
            let noise = fields.part("noise", Limits::read)?;
            fields.finish()?;
            rates.push(Rate { pointer: field.pointer.clone(), oscillators, rate, factor, noise, texts });
        }
        Ok(rates)
    }

    /// Its sentences in the claim, with a space before each; `aligned`: the regulator sets z = M e at its first instant.
    pub fn in_words(&self, sigma: &str, [at_samples, aligned]: [bool; 2], noise: &Noise) -> String {
        let [rate, factor] = self.texts.map(apart);
        let about = self.oscillators.about();
        let instants = if at_samples { " at the sampling instants t" } else { "" };
        let mut words = format!(
            " With {about} and sigma = {sigma} exactly, |e(t) - e_per(t)| <= {factor} exp(-{rate} (t - t_0)){instants} for these \
             solutions, where e_per is the e of the periodic solution and t_0 the initial time."
        );
        if let Some(Limits { texts, .. }) = &self.noise {
            let [limit, peak] = texts.map(apart);
            let starts = if aligned { " (z = M e of the measured e)" } else { "" };
            words += &format!(
                " With {about} and sigma = {sigma} exactly, {}: |e(t) - e_per(t)| <= {peak} for these starts{starts} and all t >= t_0, \
                 and its limit superior is at most {limit}.",
                noise.in_words(at_samples)
            );
        }
        words
    }
}

impl<'a> Limits<'a> {
    fn read(field: &Field<'a>) -> Outcome<Limits<'a>> {
        let ([limit, peak], texts) = field.object(|fields| written(fields, ["limit", "peak"]))?;
        Ok(Limits { pointer: field.pointer.clone(), limit, peak, texts })
    }
}

/// Two numbers, and as they are written.
fn written<'a>(fields: &mut Fields<'a>, names: [&str; 2]) -> Outcome<([Rational; 2], [&'a str; 2])> {
    let [a, b] = names.map(|name| fields.required(name));
    let (a, b) = (a?, b?);
    Ok(([a.rational()?, b.rational()?], [a.numeral()?, b.numeral()?]))
}
