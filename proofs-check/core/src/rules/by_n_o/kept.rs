//! Rule: a claim that keeps to its actuator by what it says by the number of oscillators, in the place of C6 (docs/mathematics.md, sections 13.5 and 14.5).

use super::claimed::Entry;
use crate::actuator::{Actuator, KEPT_BY, RULE};
use crate::constant::Number;
use crate::verdict::{Outcome, demand, invalid};

/// That a claim keeps to its actuator by what it says by the number of oscillators (docs/mathematics.md, section 14.5): of every number of them, from 0 on, it
/// says how large what is put out is at all times, and that is not above `max`. Hypothesis: what it says by n_o is proved of the loop without the saturation.
///
/// Guarantee: for every n_o no solution from the claimed set saturates, so it is one of the loop with the saturation, too, whose solutions are unique. Of
/// oscillators at other harmonics nothing follows: `every_set` is refused.
pub fn demand_kept(actuator: &Actuator, entries: &[Entry<'_>], every_set: bool, claim: &str) -> Outcome<()> {
    let pointer = format!("{claim}/actuator/{KEPT_BY}");
    if every_set {
        return invalid(
            RULE,
            &pointer,
            "what is said by n_o is about the first harmonics, and the claim is about every set",
        );
    }
    let first: Vec<&Entry<'_>> = entries.iter().filter(|entry| entry.oscillators.n_o().is_some()).collect();
    for (n_o, entry) in (0_u32..).zip(&first) {
        let is_next = entry.oscillators.n_o() == Some(n_o);
        demand(Some(is_next), RULE, &entry.pointer, format!("something is said of n_o = {n_o}"))?;
    }
    let all = first.last().is_some_and(|last| last.or_more);
    demand(Some(all), RULE, &pointer, "something is said of every n_o")?;
    for entry in first {
        let Some([_, u]) = &entry.largest else {
            return invalid(RULE, &entry.pointer, "it says nothing of what is put out at all times");
        };
        let kept = Number::rational(u.clone()).le(&actuator.max.number());
        demand(kept, RULE, &entry.pointer, "what is put out <= max of the actuator")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actuator;
    use crate::json::{Field, parse};

    /// Whether entries, as a claim has them, keep to an actuator that takes 3.
    fn keeps(entries: &str) -> bool {
        let text = format!(r#"{{ "actuator": {{ "max": "3" }}, "by_n_o": [{entries}] }}"#);
        let json = parse(text.as_bytes()).unwrap();
        let mut file = Field { json: &json, pointer: String::new() }.fields().unwrap();
        let actuator = actuator::read(&mut file, &[], true).unwrap().unwrap();
        let entries = Entry::read_all(&file.required("by_n_o").unwrap(), None).unwrap();
        demand_kept(&actuator, &entries, false, "/claim").is_ok()
    }

    fn entry(n_o: u32, u: &str, more: &str) -> String {
        let steady = r#""steady": { "e": "1", "e_rms": "1", "u": "1" }"#;
        format!(r#"{{ "n_o": {n_o}, {more}{steady}, "largest": {{ "e": "1", "u": "{u}" }} }}"#)
    }

    #[test]
    fn every_number_once_and_none_above_the_limit() {
        const OR_MORE: &str = r#""or_more": true, "#;
        let all = |list: &[String]| keeps(&list.join(", "));
        let last = |n_o| entry(n_o, "3", OR_MORE);
        assert!(all(&[last(0)]) && all(&[entry(0, "2", ""), entry(1, "3", ""), last(2)]));
        // A number that is left out, at the start too; no last one; one that is above the limit.
        assert!(!all(&[entry(0, "2", ""), last(2)]) && !all(&[last(1)]));
        assert!(!all(&[entry(0, "2", ""), entry(1, "2", "")]));
        assert!(!all(&[entry(0, "3.0001", ""), last(1)]));
        // A set beside them is not looked at: the claim is about the first harmonics.
        let set = r#"{ "harmonics": [0, 2], "steady": { "e": "1", "e_rms": "1", "u": "9" } }"#;
        assert!(all(&[last(0), set.to_owned()]) && !all(&[set.to_owned()]));
    }
}
