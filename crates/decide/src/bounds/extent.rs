//! The interval through which a component of the orbit moves.

use super::PRECISION;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::TrigonometricVector;

/// Points of a period at which the component is enclosed.
const SAMPLES: usize = 512;

/// An interval that contains the component at all t.
///
/// In the angle a the second derivative is at most `B = sum k^2 (|a_k| + |b_k|)`, and the derivative vanishes at a maximum; so the
/// value at the nearest sample, no farther than `h = pi/SAMPLES < (22/7)/SAMPLES`, is at least the maximum minus `B h^2/2`. As much for
/// a minimum.
pub(super) fn extent(orbit: &TrigonometricVector, index: usize) -> [Rational; 2] {
    let mean = &orbit.mean[index];
    let pairs: Vec<[&Rational; 2]> = orbit.harmonics.iter().map(|[a, b]| [&a[index], &b[index]]).collect();
    let size = |pair: &[&Rational; 2]| Rational::from(pair[0].abs_ref()) + Rational::from(pair[1].abs_ref());
    let amplitude = pairs.iter().fold(Rational::new(), |sum, pair| sum + size(pair));
    if amplitude.is_zero() {
        return [mean.clone(), mean.clone()];
    }
    let bend = pairs.iter().zip(1_u64..).fold(Rational::new(), |sum, (pair, k)| sum + size(pair) * (k * k));
    let step = Rational::from((22, 7 * SAMPLES as u64));
    let missed = bend * step.square() / 2u32;
    let turn = Enclosure::pi(PRECISION) * 2;
    let waves: Vec<[Enclosure; 2]> = (0..SAMPLES as i64)
        .map(|sample| {
            let angle = &turn * sample / SAMPLES as i64;
            angle.cos_sin()
        })
        .collect();
    let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
    let coefficients: Vec<[Enclosure; 2]> = pairs.iter().map(|pair| pair.map(exact)).collect();
    let value = |sample: usize| {
        coefficients.iter().zip(1..).fold(exact(mean), |sum, ([a, b], k)| {
            let [cos, sin] = &waves[sample * k % SAMPLES];
            sum + a * cos + b * sin
        })
    };
    let hull = (1..SAMPLES).map(value).fold(value(0), |hull, value| hull.hull(&value));
    match hull.lower_rational().zip(hull.upper_rational()) {
        Some((low, high)) => [low - &missed, high + missed],
        // Beyond the range of exact ends: what the amplitudes say.
        None => [Rational::from(mean - &amplitude), mean + amplitude],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_are_met_from_outside() {
        let rational = |value: i32| vec![Rational::from(value)];
        // 1 + 3 cos a + 4 sin a lies in [-4, 6]; with a third harmonic of size 2 more it still lies in [-6, 8].
        let mut orbit = TrigonometricVector { mean: rational(1), harmonics: vec![[rational(3), rational(4)]] };
        let [low, high] = extent(&orbit, 0);
        assert!(low <= -4 && high >= 6 && low.to_f64() > -4.001 && high.to_f64() < 6.001);
        orbit.harmonics.extend([[rational(0), rational(0)], [rational(0), rational(2)]]);
        let [low, high] = extent(&orbit, 0);
        assert!(low.to_f64() > -6.01 && high.to_f64() < 8.01 && high > 6);
        orbit.harmonics.clear();
        assert_eq!(extent(&orbit, 0), [1, 1]);
    }
}
