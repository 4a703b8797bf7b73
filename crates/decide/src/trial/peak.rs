//! How far solutions from the initial set may be from the periodic one near a trial (derivation, 14.5).

use super::conclude::{Concluded, length};
use crate::linear::{Loop, PRECISION, Start};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::{Level, Metric};

/// What the corollaries of 14.5 about forms on a box around a trial say.
#[derive(Clone, Debug)]
pub struct Peaks {
    /// For each form `V_0` of the level, at the largest gain of the actuator.
    pub levels: Vec<Enclosure>,
    /// How far the solutions come from the trial by each form, in x and in e.
    pub reach: Vec<[Enclosure; 2]>,
    /// Of |e - e_per| at all times, by the best form.
    pub error: Enclosure,
    /// Of |u - u_per| of the law, by the best form.
    pub control: Enclosure,
}

impl Peaks {
    /// The bounds, for solutions from the start. They hold if `reach` of one of the forms is below the radii of the box; then these solutions converge to
    /// the periodic one.
    ///
    /// Hypotheses: those of [`Concluded::of`], and each form has (14.4a) on the box, or (14.5a), with eta not below the distance of e. `None` without a form.
    #[must_use]
    pub fn of(
        (forms, has_states): (&[(Metric, Level)], bool),
        concluded: &Concluded,
        own: &Loop,
        start: &Start,
    ) -> Option<Peaks> {
        let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
        let [x, e, z] = start.distances(own, [&concluded.states, &concluded.error, &concluded.zeta]);
        let n_bar_squared = &own.n_bar_squared;
        let [low, high] = &own.gain;
        let level = |b: &Enclosure, (Metric { cross, weight, k_p, .. }, Level { p_up, .. }): &(Metric, Level)| {
            let of_states = match has_states {
                true => exact(p_up) * x.sqr() + length(cross) * &x * &e * 2,
                false => Enclosure::zero(PRECISION),
            };
            of_states + exact(weight) * e.sqr() + exact(k_p) * b * &own.mu / 2 * z.sqr()
        };
        let levels: Vec<Enclosure> = forms.iter().map(|form| level(high, form)).collect();
        let each = || forms.iter().zip(&levels);
        let of_error =
            |((_, Level { e_low, .. }), level): (&(Metric, Level), &Enclosure)| (level / exact(e_low)).sqrt();
        // Convex in b.
        let of_control = |form @ (Metric { k_p, .. }, Level { e_low, .. }): &(Metric, Level)| {
            let at = |b: &Enclosure| {
                let factor = own.sigma.sqr() / exact(e_low) + &own.mu * n_bar_squared * 2 / (b * exact(k_p));
                level(b, form) * factor
            };
            at(low).max(&at(high)).sqrt()
        };
        let least = |a: Enclosure, b: Enclosure| a.min(&b);
        let [s_x, s_e] = &concluded.distances;
        let of_both = |both: (&(Metric, Level), &Enclosure)| {
            let ((_, Level { x_low, .. }), level) = both;
            let of_x = if has_states { (level / exact(x_low)).sqrt() } else { Enclosure::zero(PRECISION) };
            [of_x + s_x, of_error(both) + s_e]
        };
        Some(Peaks {
            reach: each().map(of_both).collect(),
            error: each().map(of_error).reduce(least)?,
            control: forms.iter().map(of_control).reduce(least)?,
            levels,
        })
    }
}
