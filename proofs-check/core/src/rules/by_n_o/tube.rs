//! What follows from a trial: Theorem T of section 14.4 of docs/mathematics.md and its corollary, and Theorem T_s of section 14.6 (`held`). Which solution it is and the peaks are in [`peaks`].
//!
//! Guarantee of [`prove`], with the trial's inequalities and defects proved of the formulas on its box for every member, the boxes in the domain of the
//! plant, and with [`Sizes`] as they are: the loop of every member with the oscillators of the entry and the gain sigma has exactly one T-periodic solution in its
//! box, it is that of the claim, and `steady` of the entry and `sizes` of the trial are true of it. `largest`, where it is there, is true of every solution from the claimed set. With an entry about so many
//! oscillators or more that is so for each number of them: then `k0` and `k1` have to be proved, too, and what the trial has for it.

use super::About;
use super::claimed::{Entry, RULE};
use super::oscillators::Oscillators;
use super::peaks::{self, Solution};
use super::trials::{OrMore, Trial};
use crate::data::Data;
use crate::interval::Interval;
use crate::rules::control::{by_parts, put_out};
use crate::rules::gains::kappas;
use crate::rules::inequality::{Extent, Metric};
use crate::rules::joint::size_of_cross;
use crate::verdict::{Condition, Outcome};
use rug::Rational;

/// What is known of the curves of a trial, for all members.
pub struct Sizes {
    /// `sup|L^-1 (xhat - xb)| + r`: how far xhat is from x_0. 0 without states.
    pub x: Interval,
    /// sup|ehat|.
    pub e: Interval,
    /// The root mean square of ehat.
    pub e_rms: Interval,
    /// `sup|uhat| + kappa`.
    pub u: Interval,
    /// zhat.
    pub zeta: Interval,
    /// Of uhat'.
    pub slope: Slope,
}

/// How fast uhat moves, by all members.
pub struct Slope {
    /// sup|uhat'|.
    pub sup: Interval,
    /// The root mean square of uhat'.
    pub rms: Interval,
}

/// How far the periodic solution is from the trial.
pub(super) struct Tube {
    pub(super) x: Interval,
    pub(super) e: Interval,
    pub(super) e_rms: Interval,
    /// Of the e that the law has.
    pub(super) e_at_law: Interval,
    pub(super) zeta: Interval,
}

impl Tube {
    /// The numbers of Theorem T, or of its corollary with k0 and k1: then the oscillators are the fewest that it is about.
    fn new(d: &Data<'_>, (sigma, own): (&Interval, &Oscillators), trial: &Trial, pair: [&Rational; 2]) -> Tube {
        let [[d_x, d_q], [b_x, b_e]] =
            [&trial.defects, &trial.slopes].map(|pair| pair.each_ref().map(|of| d.number(of)));
        let [rho_x, rho_e, rho_y] = match trial.forms.first() {
            Some(first) => means(d, (sigma, own.next()), first, [&d_x, &d_q]),
            // A trial has a form.
            None => [(); 3].map(|()| Interval::undefined(d.precision)),
        };
        let e = (d.period.only() * &rho_e * &rho_y).sqrt();
        let x = trial.states.as_ref().map_or_else(|| d.int(0), |states| states.follow(d, &e, &trial.defects[0]));
        // That of `d_b = d + (1-b) sigma`.
        let b_e = b_e + shift(d, sigma);
        let input = &b_x * &rho_x + &b_e * &rho_e + d_q;
        let low = d.by_gain(|gain| &gain.low, &d.int(1));
        let of_swing = d.period.only() / (&low * &d.mu * 2);
        let square = match &trial.or_more {
            None => (of_swing + swing(d, own, &low)) * input.sqr(),
            Some(OrMore { defect, rates, slopes }) => {
                let [q_tx, q_te, f_x, f_e] =
                    [&rates[0], &rates[1], &slopes[0], &slopes[1]].map(|value| d.number(value));
                let velocity = f_x * &rho_x + f_e * &rho_e + d_x;
                // R_1.
                let rate = q_tx * rho_x + q_te * &rho_e + b_x * velocity + b_e * rho_y + d.number(defect);
                let [k0, k1] = pair.map(|value| d.number(value));
                let [kappa_0, kappa_1] = kappas(d, &k0, &k1);
                (of_swing + kappa_0 / low.sqr()) * input.sqr() + kappa_1 / low.sqr() * rate.sqr()
            }
        };
        Tube { x, e_rms: rho_e, e_at_law: e.clone(), e, zeta: square.sqrt() }
    }
}

/// rho_x, rho_e and rho_y; `next`: the first harmonic without an oscillator.
fn means(
    d: &Data<'_>,
    (sigma, next): (&Interval, u32),
    (metric, extent): &(Metric, Extent),
    [d_x, d_q]: [&Interval; 2],
) -> [Interval; 3] {
    let [c_x, c_e, c_y] = metric.least.each_ref().map(|value| d.number(value));
    let (p_up, k_p) = (d.number(&extent.p_up), d.number(&metric.half) * 2);
    let of_x = p_up.sqr() / &c_x + size_of_cross(d, metric).sqr() / &c_e;
    let g = d_x.sqr() * of_x * 4 + (k_p * d_q).sqr() / &c_y;
    let [rho_x, rho_e, rho_y] = [c_x, c_e, c_y].map(|c| (&g / c).sqrt());
    let next = d.period.slowest() * i64::from(next);
    let by_y = &rho_y / (sigma.sqr() + next.sqr()).sqrt();
    [rho_x, rho_e.min(&by_y), rho_y]
}

/// `sigma max{b_hi - 1, 1 - b_lo}`.
fn shift(d: &Data<'_>, sigma: &Interval) -> Interval {
    let Some(gain) = &d.gain else { return d.int(0) };
    let [low, high] = gain.shifts(sigma).map(|shift| shift.abs());
    low.max(&high)
}

/// kappa_N, or kappa_H of a set: `d` has the sum of the weights of these oscillators. That all terms of g_N(k) have one sign, from which the `N + 1` is,
/// they have beyond the last pole alone; of a set `g_H'(k) <= Nbar_H^2` where there is none at k, for the distances are 1 or more.
fn swing(d: &Data<'_>, own: &Oscillators, low: &Interval) -> Interval {
    let of = |k: &u32| 2 / d.weight(u64::from(*k));
    let at_mean = own.n_o().map_or(1, |n_o| i64::from(n_o) + 1) / d.weight(0);
    let later = own.harmonics().iter().skip(1);
    let poles = later.fold(at_mean, |most, k| most.max(&of(k))) / d.mu.sqr() / low.sqr();
    match own.n_o() {
        Some(_) => poles,
        None => poles.max(&(&d.n_bar / d.period.slowest()).sqr()),
    }
}

/// Proves an entry with its trial; `d` has the sum of all weights.
pub fn prove(d: &Data<'_>, about: &About<'_>, (entry, trial): (&Entry<'_>, &Trial), curves: &Sizes) -> Outcome<()> {
    // Of so many oscillators or more the sum of all weights counts.
    let mut own = match entry.or_more {
        true => Data::new(d.spec, d.precision),
        false => Data::of_oscillators(d.spec, d.precision, entry.oscillators.harmonics()),
    };
    let n_bar = match (entry.or_more, entry.oscillators.n_o()) {
        (true, _) => "Nbar",
        (false, Some(_)) => "Nbar_N",
        (false, None) => "Nbar_H",
    };
    let sigma = d.number(about.sigma);
    let law = about.at_samples.map(|law| law.terms);
    if let Some(law) = law {
        // The loop at samples has K for mu.
        own.mu = own.number(&law.gain);
    }
    let d = &own;
    let tube = match law {
        None => Tube::new(d, (&sigma, &entry.oscillators), trial, about.transfer),
        Some(law) => Tube::at_samples(d, (law, &entry.oscillators), (trial, entry.or_more), &curves.slope),
    };
    let has_states = trial.states.is_some();
    let [d_x, d_e] = trial.radii.each_ref().map(|value| d.number(value));
    let less = |what: &str, left: Interval, right: &Interval, place: String| {
        Condition::less("T", format!("{what}, {}", entry.about()), left, right.clone()).demand(RULE, &place)
    };
    let of_trial = |name: &str| format!("{}/{name}", trial.pointer);
    if has_states {
        less("s_x < D_x", tube.x.clone(), &d_x, of_trial("box/x"))?;
    }
    less("s_e < D_e", tube.e.clone(), &d_e, of_trial("box/e"))?;

    let [x, e] = [&curves.x + &tube.x, &curves.e + &tube.e];
    let zeta = &curves.zeta + &tube.zeta;
    let u = &curves.u + by_parts(d, [&sigma, &d.mu], [&tube.e_at_law, &tube.zeta]);
    let at_most = |what: &str, bound: Interval, claimed: &Rational, place: &str| {
        let what = format!("{what} <= {place}, {}", entry.about());
        Condition::at_most("T", what, bound, d.number(claimed)).demand(RULE, &format!("{}/{place}", entry.pointer))
    };
    let [put, _] = put_out(d, [u.clone(), d.int(0)]);
    let [claimed_e, claimed_rms, claimed_u] = &entry.steady;
    if let Some(sizes) = &trial.sizes {
        for (place, bound, stated) in [("x", &x, &sizes.x), ("zeta", &zeta, &sizes.zeta)] {
            let what = format!("what bounds it <= {place} of `sizes`, {}", entry.about());
            let condition = Condition::at_most("T", what, bound.clone(), d.number(stated));
            condition.demand(RULE, &format!("{}/{place}", sizes.pointer))?;
        }
    }
    at_most("sup|ehat| + s_e", e.clone(), claimed_e, "steady/e")?;
    at_most("rms(ehat) + rho_e", &curves.e_rms + &tube.e_rms, claimed_rms, "steady/e_rms")?;
    let what = match law {
        None => format!("sup|uhat| + kappa + sigma s_e + mu {n_bar} s_z"),
        Some(_) => format!("sup|uhat| + kappa + sigma s_k + K {n_bar} s_z"),
    };
    at_most(&what, put, claimed_u, "steady/u")?;

    let solution = Solution { sizes: [x, e, zeta], off: [tube.x, tube.e], u };
    peaks::prove(d, about, (entry, trial), &solution, n_bar)
}
