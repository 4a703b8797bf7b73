//! Whether mu is of the scale of the period. Floating point: no claim rests on it.

use sigmastar_exact::number::{Direction, round_f64, write_exact};
use sigmastar_lang::spec::{InternalModel, Period};

/// mu times the period of regulators as they are built, and how many times outside of it is far.
const USUAL: [f64; 2] = [1.0, 20.0];
const FAR: f64 = 10.0;

/// That mu is far from 1/T to 20/T, and what that does, in a sentence without a final stop.
#[must_use]
pub fn unusual_mu(model: &InternalModel, period: &Period) -> Option<String> {
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
