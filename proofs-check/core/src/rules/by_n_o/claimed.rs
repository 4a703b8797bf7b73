//! What a claim says by the number of oscillators, as it is written and in words (docs/mathematics.md, section 14).

use super::oscillators::Oscillators;
use crate::json::{Field, Fields};
use crate::noise::{Noise, apart};
use crate::verdict::{Outcome, bad, demand};
use rug::Rational;

/// The name of the rule.
pub const RULE: &str = "by n_o";

/// The most entries.
const MOST: usize = 64;

/// What is said of one n_o, or of it and every larger one, or of a set of harmonics, at the gain of the claim.
pub struct Entry<'a> {
    /// Where it stands in the file.
    pub pointer: String,
    /// Its oscillators.
    pub oscillators: Oscillators,
    /// Whether it is said of every larger number, too. Of the last entry with n_o alone.
    pub or_more: bool,
    /// Along the T-periodic solution: bounds of |e|, of the root mean square of e, and of what is put out.
    pub steady: [Rational; 3],
    /// At all times, of every solution from the claimed set: bounds of |e| and of what is put out.
    pub largest: Option<[Rational; 2]>,
    /// The samples in a period, of a claim at samples.
    samples: Option<u32>,
    steady_texts: [&'a str; 3],
    largest_texts: [&'a str; 2],
}

impl<'a> Entry<'a> {
    /// Reads the part `by_n_o`: each n_o once, in order, and then each set once. Of a claim at samples these can tell all harmonics of the oscillators
    /// apart.
    pub fn read_all(field: &Field<'a>, samples: Option<u32>) -> Outcome<Vec<Entry<'a>>> {
        let list = field.elements()?;
        if list.is_empty() || list.len() > MOST {
            return bad(&field.pointer, format!("expected 1 to {MOST} entries"));
        }
        let mut entries: Vec<Entry<'a>> = Vec::new();
        for field in list {
            let entry = field.object(|fields| Entry::take(fields, samples))?;
            if let Some(before) = entries.last().filter(|last| last.or_more && entry.oscillators.n_o().is_some()) {
                let what = "expected in the last entry with `n_o` alone";
                return bad(&format!("{}/or_more", before.pointer), what);
            }
            entry.oscillators.demand_order(entries.iter().map(|other| &other.oscillators), &entry.pointer)?;
            entries.push(entry);
        }
        Ok(entries)
    }

    fn take(fields: &mut Fields<'a>, samples: Option<u32>) -> Outcome<Entry<'a>> {
        let oscillators = Oscillators::take(fields)?;
        // Of a set nothing is said of more.
        let or_more = match oscillators.n_o() {
            None => None,
            Some(_) => fields.part("or_more", |field| match field.truth()? {
                true => Ok(()),
                false => bad(&field.pointer, "expected `true`, or no such field"),
            })?,
        };
        samples.map_or(Ok(()), |samples| oscillators.demand_apart(samples, RULE, &fields.pointer))?;
        let steady = fields.required("steady")?;
        let (steady, steady_texts) = steady.object(|fields| sizes(fields, ["e", "e_rms", "u"]))?;
        let largest = fields.part("largest", |field| field.object(|fields| sizes(fields, ["e", "u"])))?;
        let (largest, largest_texts) = largest.map_or((None, [""; 2]), |(numbers, texts)| (Some(numbers), texts));
        let pointer = fields.pointer.clone();
        Ok(Entry {
            pointer,
            oscillators,
            or_more: or_more.is_some(),
            steady,
            largest,
            samples,
            steady_texts,
            largest_texts,
        })
    }

    /// Which oscillators it is about.
    pub fn about(&self) -> String {
        self.oscillators.in_words(self.or_more, self.samples)
    }

    /// Its sentence in the claim, with a space before it; `output`: what is put out. Nothing of it is about the noise of the file.
    pub fn in_words(&self, sigma: &str, output: &str, noise: &Noise) -> String {
        let ([e, e_rms, u], about) = (self.steady_texts.map(apart), self.about());
        let largest = self.largest.as_ref().map_or_else(String::new, |_| {
            let [e, u] = self.largest_texts.map(apart);
            format!(", and |e| <= {e} and |{output}| <= {u} at all times for these solutions")
        });
        let undisturbed = match noise.is_none(self.samples.is_some()) {
            true => "",
            false => " without noise, disturbance and rounding,",
        };
        format!(
            " With {about} and sigma = {sigma} exactly,{undisturbed} |e| <= {e} (root mean square <= {e_rms}) and |{output}| <= {u} along the T-periodic \
             solution{largest}."
        )
    }
}

/// Numbers that are not negative, and as they are written.
fn sizes<'a, const N: usize>(fields: &mut Fields<'a>, names: [&str; N]) -> Outcome<([Rational; N], [&'a str; N])> {
    let mut texts = [""; N];
    let mut numbers = [(); N].map(|()| Rational::new());
    for ((number, text), name) in numbers.iter_mut().zip(&mut texts).zip(names) {
        let field = fields.required(name)?;
        (*number, *text) = (field.rational()?, field.numeral()?);
        demand(Some(*number >= 0), RULE, &field.pointer, "a bound is not negative")?;
    }
    Ok((numbers, texts))
}
