//! Numbers of a file that can be certified and are likely to be meant in another way. Floating point: no claim rests on it.

use sigmastar_exact::number::{Direction, round_f64, write_exact};
use sigmastar_lang::spec::{InputGain, InternalModel, Period, in_another_unit, matched_frequency, rounded_from};

/// mu times the period of regulators as they are built, and how many times outside of it is far.
const USUAL: [f64; 2] = [1.0, 20.0];
const FAR: f64 = 10.0;

/// From so many times the low end on the high end of an input gain is far above it.
const WIDE: f64 = 3.0;

/// What of these data is likely to be meant in another way, each in a sentence without a final stop.
#[must_use]
pub fn unusual(model: &InternalModel, period: &Period, gain: Option<&InputGain>) -> Vec<String> {
    [rounded(period), unmatched(model, period), unusual_mu(model, period), gain.and_then(wide)]
        .into_iter()
        .flatten()
        .collect()
}

/// That the period is likely to be a rounded fraction.
fn rounded(period: &Period) -> Option<String> {
    let meant = rounded_from(period)?;
    Some(format!("the period is exactly {} here: if {meant} is meant, write \"{meant}\"", period.nominal().text))
}

/// That a base frequency that is not matched is 2 pi/period in another unit.
fn unmatched(model: &InternalModel, period: &Period) -> Option<String> {
    let frequency = &model.base_frequency;
    let unit = in_another_unit(frequency, period.nominal()).filter(|_| !model.matched)?;
    Some(format!(
        "the base frequency {} is about {unit}: if that is meant, the oscillators miss the harmonics; in radians per unit of time it is {}, with `matched`",
        frequency.text,
        matched_frequency(period.nominal())
    ))
}

/// That the interval of an input gain is wide.
fn wide(gain: &InputGain) -> Option<String> {
    let ratio = gain.high.to_f64() / gain.low.to_f64();
    (ratio >= WIDE).then(|| {
        let shown = round_f64(ratio, 3, Direction::Nearest).map_or_else(|| ratio.to_string(), |ratio| write_exact(&ratio));
        format!(
            "the input gain is known to a factor of {shown} only, from {} to {}: `nominal`, `low` and `high` are in the same unit, as 1/C, 0.9/C \
             and 1.1/C; a narrower interval needs a smaller gain",
            gain.low.text, gain.high.text
        )
    })
}

/// That mu is far from 1/T to 20/T, and what that does, in a sentence without a final stop.
fn unusual_mu(model: &InternalModel, period: &Period) -> Option<String> {
    let share = model.mu.to_f64() * period.nominal().to_f64();
    let [low, high] = USUAL;
    let does = if share < low / FAR {
        "so small a mu makes the oscillators slow (`sigmastar certify FILE --n-o N` shows what is proved of that)"
    } else if share > high * FAR {
        "so large a mu makes the law multiply e by as much, at most by sigma + mu Nbar^2, and asks for short sampling periods"
    } else {
        return None;
    };
    let shown = round_f64(share, 3, Direction::Nearest).map_or_else(|| share.to_string(), |share| write_exact(&share));
    Some(format!(
        "mu times the period T is {shown}: mu is in 1/time, and from {low}/T to {high}/T is usual; {does}; `sigmastar tune FILE --over mu` looks \
         for another"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::plant::Plant;

    #[test]
    fn mu_is_held_against_the_period() {
        let told = |period: &str, mu: &str| {
            let text = include_str!("../../../../specs/plants/linear.json");
            let text = text.replace("\"period\": \"1\"", &format!("\"period\": \"{period}\""));
            let text = text.replace("2*pi", &format!("2*pi/({period})"));
            let plant = Plant::from_json("test", &text.replace("\"mu\": \"1\"", &format!("\"mu\": \"{mu}\""))).unwrap();
            unusual_mu(&plant.internal_model, &plant.period)
        };
        assert!(told("1/100", "9").unwrap().starts_with("mu times the period T is 0.09: "));
        assert!(told("100", "2.1").unwrap().contains("so large a mu"));
        for (period, mu) in [("1/100", "10"), ("1", "1"), ("100", "2")] {
            assert_eq!(told(period, mu), None, "{period} {mu}");
        }
    }
}
