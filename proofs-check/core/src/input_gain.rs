//! Rule: an input gain that is known to an interval (docs/guide.md), and its numbers b (docs/mathematics.md, section 13.1).
//!
//! The gain of the actuator signal is one constant in `[low, high]`, and the regulator puts out u/nominal. So what reaches the plant is
//! b u with a constant b in `[b_lo, b_hi] = [low/nominal, high/nominal]`.
//!
//! Guarantee: `0 < low <= nominal <= high`, so `0 < b_lo <= 1 <= b_hi`.

use crate::constant::{Constant, Number, positive};
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::verdict::{Outcome, demand, invalid};

/// The name of the rule.
pub const RULE: &str = "input gain";

/// The three numbers of `input_gain`.
#[derive(Clone, Debug)]
pub struct InputGain {
    pub nominal: Constant,
    pub low: Constant,
    pub high: Constant,
}

impl InputGain {
    /// Takes the part out of a file, if it is there.
    pub fn read(file: &mut Fields<'_>) -> Outcome<Option<InputGain>> {
        let Some(field) = file.optional("input_gain") else { return Ok(None) };
        let mut fields = field.fields()?;
        let [nominal, low, high] = ["nominal", "low", "high"].map(|name| positive(&mut fields, name));
        let gain = InputGain { nominal: nominal?, low: low?, high: high? };
        fields.finish()?;
        let in_order =
            |a: &Constant, b: &Constant, what| demand(a.number().le(&b.number()), RULE, &field.pointer, what);
        in_order(&gain.low, &gain.nominal, "low <= nominal")?;
        in_order(&gain.nominal, &gain.high, "nominal <= high")?;
        Ok(Some(gain))
    }

    /// The ends with their names in a file.
    pub fn ends(&self) -> [(&'static str, &Constant); 2] {
        [("low", &self.low), ("high", &self.high)]
    }

    /// Whether the gain is certainly the nominal one, so that both b are 1.
    pub fn is_nominal(&self) -> bool {
        self.ends().iter().all(|(_, end)| is_same(end, &self.nominal))
    }

    /// b_lo and b_hi.
    pub fn factors(&self, precision: u32) -> [Interval; 2] {
        let one = Interval::int(1, precision);
        let [low, high] = self.ends().map(|(_, end)| match end.rational().zip(self.nominal.rational()) {
            Some((end, nominal)) => Interval::rational(&(end / nominal), precision),
            None => end.enclose(precision) / self.nominal.enclose(precision),
        });
        [low.min(&one), high.max(&one)]
    }

    /// That a claim names the gain of the file, and names none where the file has none.
    pub fn agrees(asked: Option<&InputGain>, claimed: Option<&Field<'_>>, claim: &str) -> Outcome<()> {
        let (asked, field) = match (asked, claimed) {
            (None, None) => return Ok(()),
            (Some(asked), Some(field)) => (asked, field),
            (Some(_), None) => return invalid(RULE, claim, "`input_gain` of the file is not in the claim"),
            (None, Some(field)) => return invalid(RULE, &field.pointer, "the file has no `input_gain`"),
        };
        let mut fields = field.fields()?;
        for (name, end) in [("nominal", &asked.nominal)].into_iter().chain(asked.ends()) {
            let stated = fields.required(name)?;
            let same = is_same(&Constant::read(&stated)?, end);
            demand(Some(same), RULE, &stated.pointer, format!("it is that of the file, {}", end.text))?;
        }
        fields.finish()
    }

    /// What a claim is about besides.
    pub fn in_words(&self) -> String {
        let InputGain { nominal, low, high } = self;
        format!(
            " and every input gain in [{}, {}] (one constant; the regulator divides by the nominal {})",
            low.text, high.text, nominal.text
        )
    }
}

/// Whether two constants are the same by their texts or by their exact forms.
fn is_same(a: &Constant, b: &Constant) -> bool {
    let Number { exact: of_a, .. } = a.number();
    a.text == b.text || of_a.as_ref().zip(b.exact.as_ref()).is_some_and(|(a, b)| a.equals(b))
}
