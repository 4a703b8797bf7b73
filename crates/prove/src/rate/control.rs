//! What noise, a disturbance and rounding add to what is put out, for some oscillators and one gain (derivation, 13.6).
//!
//! Of the differences u is a linear function `c'y` of y = (e, zs), with as much more as v and rounding are in it at the same time. Where `y'Pi y` is at most
//! `level^2`, `|c'y| <= level max |c'y|` over `y'Pi y <= 1`: of the part with the inputs by the form that bounds what they do, and of the one by which an
//! aligned start is misled by that of a rate.

use super::bound::{ByForm, RateBound, up};
use rug::Rational;
use sigmastar_decide::rates::at_samples::SampledRateWitness;
use sigmastar_decide::rates::inequality::is_definite;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_exact::real::Real;
use sigmastar_lang::spec::Oscillators;
use sigmastar_propose::rates::largest_square;
use sigmastar_theory::data::Data;

/// By what share a square is above the one that is proposed.
const ROOM: f64 = 1e-6;

/// The W of a rate: `Pi > diag(e_low, 0)`, and at most z_up on zs.
pub struct RateForm<'r> {
    /// The oscillators.
    pub oscillators: &'r Oscillators,
    /// Pi by the rows of its lower triangle.
    pub pi: &'r [Vec<Rational>],
    /// e_low.
    pub e_low: &'r Rational,
    /// z_up.
    pub z_up: &'r Rational,
}

impl<'r> From<&'r RateBound<ByForm>> for RateForm<'r> {
    fn from(RateBound { oscillators, proof, e_low, upper: [_, z_up], .. }: &'r RateBound<ByForm>) -> RateForm<'r> {
        RateForm { oscillators, pi: &proof.witness.pi, e_low, z_up }
    }
}

impl<'r> From<&'r RateBound<SampledRateWitness>> for RateForm<'r> {
    fn from(
        RateBound { oscillators, proof, e_low, upper: [_, z_up], .. }: &'r RateBound<SampledRateWitness>,
    ) -> RateForm<'r> {
        RateForm { oscillators, pi: &proof.pi, e_low, z_up }
    }
}

impl RateForm<'_> {
    /// The root of W of the part of an aligned start that aligns to e + v with |v| <= v_bar: zeta is M v in place of 0, and `|M v|_N <= Nbar |v|`. 0 where the start
    /// is another.
    pub(super) fn misled(&self, data: &Data<'_>, v_bar: &Enclosure) -> Enclosure {
        match data.spec.initial_set.is_aligned() {
            true => data.rational(self.z_up).sqrt() * &data.n_bar * v_bar,
            false => data.zero(),
        }
    }
}

/// What is added to what is put out at all times, rounded up; `None` where nothing is proved. `control` is u of y, `level` bounds the root of W of the part with
/// the inputs, `misled` that of the part by which the start is misled; `gain` v is in u at the same time, of either sign, with |v| <= v_bar, and `rounding` bounds
/// what that adds to u.
pub(super) fn of_noise(
    data: &Data<'_>,
    control: &[Enclosure],
    (pi, level): (&[Vec<Rational>], &Enclosure),
    (rate, misled): (&RateForm<'_>, &Enclosure),
    [gain, v_bar, rounding]: [&Enclosure; 3],
) -> Option<Rational> {
    let of_inputs = largest(pi, control)? * level;
    let of_start = if misled.is_zero() { data.zero() } else { largest(rate.pi, control)? * misled };
    let nominal = data.spec.input_gain.as_ref().map(|gain| gain.nominal.enclose(data.precision));
    let all = of_inputs + of_start + gain.abs() * v_bar + rounding;
    up(&nominal.map_or_else(|| all.clone(), |nominal| &all / nominal))
}

/// The largest |c'y| where `y'Pi y <= 1`, at most: its square is proposed in doubles, and `Pi - c c'/square` is proved positive definite.
fn largest(pi: &[Vec<Rational>], c: &[Enclosure]) -> Option<Enclosure> {
    let precision = c.first()?.precision();
    let number = |value: &Rational| Enclosure::from_rational(value, precision);
    let along: Vec<f64> = c.iter().map(Enclosure::midpoint_f64).collect();
    let square = number(&round_f64(largest_square(pi, &along)? * (1.0 + ROOM), 9, Direction::Up)?);
    let rest = |i: usize, j: usize| &square * number(&pi[i.max(j)][i.min(j)]) - &c[i] * &c[j];
    is_definite(pi.len(), rest).then(|| square.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::Specification;

    /// Noise counts by the size of what it is in u, whose sign goes with the angles of the oscillators; an input gain divides all of it.
    #[test]
    fn noise_counts_whatever_its_sign() {
        let text = include_str!("../../../../specs/linear.json").replace(r#""kind": "paper""#, r#""kind": "aligned""#);
        let gain = r#"{ "input_gain": { "nominal": 4, "low": 4, "high": 4 },"#;
        let pi = vec![vec![Rational::from(2)], vec![Rational::from(1), Rational::from(1)]];
        let e_low = Rational::from((1, 2));
        let z_up = Rational::from(9);
        let oscillators = Oscillators::first(0);
        let rate = RateForm { oscillators: &oscillators, pi: &pi, e_low: &e_low, z_up: &z_up };
        for (text, nominal) in [(text.clone(), 1.0), (text.replacen('{', gain, 1), 4.0)] {
            let spec = Specification::from_json("test", &text).unwrap();
            let data = Data::new(&spec, 128);
            let control = [3.0, -1.0].map(|entry| data.rational(&Rational::from_f64(entry).unwrap()));
            let [level, v_bar, rounding] = [2.0, 0.5, 0.25].map(Enclosure::exactly);
            let misled = rate.misled(&data, &v_bar);
            // 3 |M v|_N, and sqrt(17) for c by Pi in both parts.
            let start = 1.5 * data.n_bar.midpoint_f64();
            let expected = ((2.0 + start) * 17f64.sqrt() + 10.0 * 0.5 + 0.25) / nominal;
            for gain in [10.0, -10.0].map(Enclosure::exactly) {
                let found = of_noise(&data, &control, (&pi, &level), (&rate, &misled), [&gain, &v_bar, &rounding]);
                let found = found.unwrap().to_f64();
                assert!(found >= expected * (1.0 - 1e-12) && found < expected * (1.0 + 1e-4), "{found} {expected}");
            }
        }
    }

    /// By hand: Pi^-1 of [[2, 1], [1, 1]] is [[1, -1], [-1, 2]], of which c = (3, -1) takes 9 + 6 + 2.
    #[test]
    fn the_largest_value_of_a_linear_function() {
        let pi = vec![vec![Rational::from(2)], vec![Rational::from(1), Rational::from(1)]];
        let found = largest(&pi, &[3.0, -1.0].map(Enclosure::exactly)).unwrap();
        let least = 17f64.sqrt();
        assert!(found.lower_f64() >= least && found.upper_f64() < least * (1.0 + 1e-5), "{found:?}");
        // Of what is not definite there is none.
        let pi = vec![vec![Rational::from(1)], vec![Rational::from(2), Rational::from(1)]];
        assert!(largest(&pi, &[1.0, 1.0].map(Enclosure::exactly)).is_none());
    }
}
