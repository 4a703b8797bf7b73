//! What a claim says besides at its gain alone, with given oscillators: rates, and bounds of the error and of the control.

use super::{rounded_down, rounded_up};
use rug::Rational;
use serde_json::Value;
use sigmastar_exact::number::parse_rational;

/// That with so many oscillators every solution from the initial set has `|e - e_per| <= factor exp(-rate (t - t_0))`, at samples at the sampling instants,
/// in the loop without noise. Each number is rounded to the safe side.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ClaimedRate {
    /// The harmonics of the oscillators, 0 among them.
    pub harmonics: Vec<u32>,
    /// In 1/time.
    pub rate: f64,
    /// In the unit of e.
    pub factor: f64,
    /// What |e - e_per| is at most in the end with the noise, disturbance and rounding of the document, and at all times; none where the document has none
    /// of these, or nothing is proved.
    pub noise: Option<[f64; 2]>,
}

/// Bounds for oscillators at some harmonics, for every plant and gain of the actuator of the claim. Each number is rounded up.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ClaimedBounds {
    /// The harmonics of the oscillators, 0 among them.
    pub harmonics: Vec<u32>,
    /// Whether every larger number of oscillators has these bounds, too.
    pub or_more: bool,
    /// Of |e| along the periodic solution.
    pub steady_error: f64,
    /// Of the root mean square of e along the periodic solution.
    pub steady_rms: f64,
    /// Of what is put out along the periodic solution.
    pub steady_control: f64,
    /// Of |e| and of what is put out at all times, for every solution from the initial set; none where that is not proved.
    pub largest: Option<[f64; 2]>,
}

impl ClaimedRate {
    /// The number of oscillators, where they are at the first harmonics.
    #[must_use]
    pub fn n_o(&self) -> Option<u32> {
        number(&self.harmonics)
    }
}

impl ClaimedBounds {
    /// The number of oscillators, where they are at the first harmonics.
    #[must_use]
    pub fn n_o(&self) -> Option<u32> {
        number(&self.harmonics)
    }
}

/// n_o, where these are the first harmonics.
fn number(harmonics: &[u32]) -> Option<u32> {
    let last = u32::try_from(harmonics.len()).ok()?.checked_sub(1)?;
    (harmonics.last() == Some(&last)).then_some(last)
}

/// The harmonics of the oscillators that an entry is about.
fn harmonics(part: &Value) -> Option<Vec<u32>> {
    match part.get("harmonics") {
        Some(all) => all.as_array()?.iter().map(whole).collect(),
        None => Some((0..=whole(&part["n_o"])?).collect()),
    }
}

/// The rates of the claim of a certificate.
pub(super) fn rates(claim: &Value) -> Vec<ClaimedRate> {
    let one = |part: &Value| {
        let noise = part.get("noise");
        Some(ClaimedRate {
            harmonics: harmonics(part)?,
            rate: rounded_down(&exact(&part["rate"])?),
            factor: up(&part["factor"])?,
            noise: noise.and_then(|noise| Some([up(&noise["limit"])?, up(&noise["peak"])?])),
        })
    };
    claim["for_n_o"].as_array().into_iter().flatten().filter_map(one).collect()
}

/// The bounds of the claim of a certificate.
pub(super) fn bounds(claim: &Value) -> Vec<ClaimedBounds> {
    let one = |part: &Value| {
        let steady = &part["steady"];
        let largest = part.get("largest");
        Some(ClaimedBounds {
            harmonics: harmonics(part)?,
            or_more: part["or_more"] == true,
            steady_error: up(&steady["e"])?,
            steady_rms: up(&steady["e_rms"])?,
            steady_control: up(&steady["u"])?,
            largest: largest.and_then(|largest| Some([up(&largest["e"])?, up(&largest["u"])?])),
        })
    };
    claim["by_n_o"].as_array().into_iter().flatten().filter_map(one).collect()
}

fn whole(value: &Value) -> Option<u32> {
    u32::try_from(value.as_u64()?).ok()
}

fn exact(value: &Value) -> Option<Rational> {
    parse_rational(value.as_str()?)
}

fn up(value: &Value) -> Option<f64> {
    Some(rounded_up(&exact(value)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn each_number_is_rounded_to_the_safe_side() {
        let claim = json!({
            "for_n_o": [
                { "n_o": 0, "rate": "1/3", "factor": "1/3" },
                { "n_o": 2, "rate": "0.5", "factor": "2", "noise": { "limit": "1/3", "peak": "3" } },
                { "harmonics": [0, 5], "rate": "1", "factor": "2" },
            ],
            "by_n_o": [
                { "n_o": 0, "steady": { "e": "1/3", "e_rms": "0.25", "u": "7" }, "largest": { "e": "1", "u": "9" } },
                { "n_o": 1, "or_more": true, "steady": { "e": "0", "e_rms": "0", "u": "7" } },
                { "harmonics": [0, 1, 5], "steady": { "e": "0", "e_rms": "0", "u": "7" } },
            ],
        });
        let third = 1.0 / 3.0_f64;
        let [first, second, of_set] = rates(&claim).try_into().unwrap();
        // The double nearest to 1/3 is below it.
        assert_eq!((first.n_o(), first.rate, first.factor, first.noise), (Some(0), third, third.next_up(), None));
        assert_eq!((of_set.n_o(), of_set.harmonics, of_set.rate), (None, vec![0, 5], 1.0));
        assert_eq!((second.n_o(), second.noise), (Some(2), Some([third.next_up(), 3.0])));
        let [first, second, third_set] = bounds(&claim).try_into().unwrap();
        assert_eq!((first.n_o(), first.or_more, first.largest), (Some(0), false, Some([1.0, 9.0])));
        assert_eq!([first.steady_error, first.steady_rms, first.steady_control], [third.next_up(), 0.25, 7.0]);
        assert_eq!((second.n_o(), second.or_more, second.largest), (Some(1), true, None));
        assert_eq!((third_set.n_o(), third_set.harmonics), (None, vec![0, 1, 5]));
        assert!(rates(&json!({})).is_empty() && bounds(&json!({})).is_empty());
    }
}
