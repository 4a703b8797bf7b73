//! What a claim says of given numbers of oscillators, as it is written and in words (docs/mathematics.md, section 13.6).

use crate::json::{Field, Fields};
use crate::noise::{Noise, apart};
use crate::verdict::{Outcome, bad};
use rug::Rational;

/// The name of the rule.
pub const RULE: &str = "rates";

/// The largest n_o.
pub const LARGEST: u32 = 100;

/// That `|e - e_per| <= factor exp(-rate (t - t_0))` with n_o oscillators, at the gain of the claim; at samples for the sampling instants t.
pub struct Rate<'a> {
    pub pointer: String,
    pub n_o: u32,
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
    /// Reads the part `for_n_o`: each n_o once, in order.
    pub fn read_all(field: &Field<'a>) -> Outcome<Vec<Rate<'a>>> {
        let mut rates: Vec<Rate<'a>> = Vec::new();
        for field in field.elements()? {
            let mut fields = field.fields()?;
            let n_o = read_count(&mut fields)?;
            if rates.last().is_some_and(|before| before.n_o >= n_o) {
                return bad(&format!("{}/n_o", field.pointer), "expected each n_o once, in rising order");
            }
            let ([rate, factor], texts) = written(&mut fields, ["rate", "factor"])?;
            let noise = fields.part("noise", Limits::read)?;
            fields.finish()?;
            rates.push(Rate { pointer: field.pointer.clone(), n_o, rate, factor, noise, texts });
        }
        Ok(rates)
    }

    /// Its sentences in the claim, with a space before each; `aligned`: the regulator sets z = M e at its first instant.
    pub fn in_words(&self, sigma: &str, [at_samples, aligned]: [bool; 2], noise: &Noise) -> String {
        let [rate, factor] = self.texts.map(apart);
        let n_o = self.n_o;
        let instants = if at_samples { " at the sampling instants t" } else { "" };
        let mut words = format!(
            " With n_o = {n_o} and sigma = {sigma} exactly, |e(t) - e_per(t)| <= {factor} exp(-{rate} (t - t_0)){instants} for these \
             solutions, where e_per is the e of the periodic solution and t_0 the initial time."
        );
        if let Some(Limits { texts, .. }) = &self.noise {
            let [limit, peak] = texts.map(apart);
            let starts = if aligned { " (z = M e of the measured e)" } else { "" };
            words += &format!(
                " With n_o = {n_o} and sigma = {sigma} exactly, {}: |e(t) - e_per(t)| <= {peak} for these starts{starts} and all t >= t_0, \
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

/// An n_o that is not too large.
pub fn read_count(fields: &mut Fields<'_>) -> Outcome<u32> {
    let field = fields.required("n_o")?;
    let n_o = field.whole()?;
    if n_o > LARGEST { bad(&field.pointer, format!("expected at most {LARGEST}")) } else { Ok(n_o) }
}
